// Any bytes as SVG or compressed SVG: an error, or a baked drawing that loads again.
#include "vector/patch/drawing.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.name = "fuzz.svg";
  source.data = data;
  source.size = size;
  source.imageFn = [](void*, uint32_t, const void* bytes, size_t count, uint32_t* width, uint32_t* height) -> VkBool32 {
    const auto* first = static_cast<const uint8_t*>(bytes);
    *width = first[0] * 1000u; // 0 as well
    *height = static_cast<uint32_t>(count);
    return VK_TRUE;
  };
  GpgpBlob blob{};
  if (gpgpCompileSvg(&source, &blob) == GPGP_SUCCESS) {
    const auto bytes = std::span(static_cast<const std::byte*>(blob.data), blob.size);
    if (!gpgp::vector::loadBaked(bytes, std::pmr::get_default_resource())) std::abort();
  } else if (blob.data) {
    std::abort(); // a failure hands out nothing
  }
  gpgpFreeBlob(&blob);
  return 0;
}
