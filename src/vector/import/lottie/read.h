// Lottie files to the animation that they describe.
//
// JSON, or a .lottie archive of it. What is not supported is named once a kind, at the first place that asks for it.
// Any bytes are safe: the file's size, its depth and its number of values are limited, and so is each list.
#pragma once
#include "core/result.h"
#include "vector/import/lottie/model.h"

#include <gpgp/lottie.h>

#include <functional>
#include <set>
#include <span>
#include <string>

namespace gpgp::vector::lottie {

struct ReadLimits {
  size_t bytes = size_t(64) << 20; ///< of the JSON, also when it is unpacked
  size_t depth = 128;              ///< of lists and objects in each other
  size_t values = 4'000'000;
  size_t keyframes = 1'000'000;
  size_t vertices = 65'536; ///< of a path
  size_t compositions = 4096;
  size_t imageBytes = size_t(64) << 20; ///< of all images
};

/// Messages, each text once. The label is "file: place".
class Reporter {
public:
  Reporter(GpgpMessageFn function, void* userData, const char* name)
      : function_(function), userData_(userData), name_(name ? name : "") {}
  void say(GpgpSeverity severity, GpgpResult code, const std::string& place, const std::string& text,
           const char* apiFunction = "gpgpCreateLottie");
  void error(const core::Error& error, const char* apiFunction);

private:
  GpgpMessageFn function_;
  void* userData_;
  std::string name_;
  std::set<std::string> said_;
};

/// Decodes images and reads files beside the animation.
struct Outside {
  GpgpSvgImageFn imageFn = nullptr;
  void* imageUserData = nullptr;
  const GpgpFileSystem* files = nullptr;
};

/// Errors begin with the place in the file, and ": ".
core::Result<Animation> readAnimation(std::span<const std::byte> bytes, const Outside& outside, Reporter& reporter,
                                      const ReadLimits& limits = {});

} // namespace gpgp::vector::lottie
