// Any bytes as a Lottie animation: an error, or frames that convert to baked drawings that load again. Nothing outside
// of the animation's folder is asked for.
#include "vector/patch/drawing.h"

#include <gpgp/lottie.h>

#include <cstdlib>
#include <string_view>

namespace {
GpgpResult GPGP_CALL read(void*, const char* path, void*, size_t, size_t* size) {
  const std::string_view asked(path);
  if (asked.empty() || asked[0] == '/' || asked == ".." || asked.substr(0, 3) == "../" ||
      asked.find("/../") != asked.npos || asked.find('\\') != asked.npos)
    std::abort();
  *size = 0;
  return GPGP_SUCCESS;
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
  source.name = "fuzz.json";
  source.data = data;
  source.size = size;
  const GpgpFileSystem files{nullptr, read};
  source.fileSystem = &files;
  source.imageFn = [](void*, uint32_t, const void*, size_t count, uint32_t* width, uint32_t* height) -> VkBool32 {
    *width = static_cast<uint32_t>(count);
    *height = 1;
    return VK_TRUE;
  };
  GpgpLottie lottie = nullptr;
  if (gpgpCreateLottie(&source, &lottie) != GPGP_SUCCESS) {
    if (lottie) std::abort(); // a failure hands out nothing
    return 0;
  }
  for (const double frame : {0.0, 17.5}) {
    GpgpBlob blob{};
    if (gpgpCompileLottieFrame(lottie, frame, nullptr, &blob) == GPGP_SUCCESS) {
      const auto baked = std::span(static_cast<const std::byte*>(blob.data), blob.size);
      if (!gpgp::vector::loadBaked(baked, std::pmr::get_default_resource())) std::abort();
    } else if (blob.data) {
      std::abort();
    }
    gpgpFreeBlob(&blob);
  }
  gpgpDestroyLottie(lottie);
  return 0;
}
