// Any bytes as SVG or compressed SVG: an error, or a baked drawing that loads again. Every style sheet that it refers
// to is there, with the same bytes; nothing outside of the drawing's folder is asked for.
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {
std::string_view bytes; // of the drawing and of its style sheets

GpgpResult GPGP_CALL read(void*, const char* path, void* data, size_t capacity, size_t* size) {
  const std::string_view asked(path);
  const bool leads = asked.empty() || asked[0] == '/' || asked == ".." || asked.substr(0, 3) == "../" ||
                     asked.find("/../") != asked.npos || asked.find('\\') != asked.npos;
  if (leads) std::abort();
  if (asked.back() == '0') return GPGP_ERROR_IO;
  *size = bytes.size();
  if (data) std::memcpy(data, bytes.data(), std::min(capacity, bytes.size()));
  return GPGP_SUCCESS;
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.name = "fuzz.svg";
  source.data = data;
  source.size = size;
  bytes = {reinterpret_cast<const char*>(data), size};
  const GpgpFileSystem files{nullptr, read};
  source.fileSystem = &files;
  source.imageFn = [](void*, uint32_t, const void* encoded, size_t count, uint32_t* width,
                      uint32_t* height) -> VkBool32 {
    const auto* first = static_cast<const uint8_t*>(encoded);
    *width = first[0] * 1000u; // 0 as well
    *height = static_cast<uint32_t>(count);
    return VK_TRUE;
  };
  GpgpBlob blob{};
  if (gpgpCompileSvg(&source, &blob) == GPGP_SUCCESS) {
    const auto baked = std::span(static_cast<const std::byte*>(blob.data), blob.size);
    if (!gpgp::vector::loadBaked(baked, std::pmr::get_default_resource())) std::abort();
  } else if (blob.data) {
    std::abort(); // a failure hands out nothing
  }
  gpgpFreeBlob(&blob);
  return 0;
}
