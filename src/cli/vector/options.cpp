#include "cli/vector/options.h"

#include "cli/shared/common.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {

Antialiasing antialiasingOf(const VectorOptions& options) {
  if (options.antialiasing.empty()) return {16, false};
  if (options.antialiasing == "area") return {16, true};
  return {static_cast<uint32_t>(std::stoul(options.antialiasing)), false};
}

Size sizeAsked(const VectorOptions& options, double pageWidth, double pageHeight) {
  if (options.width && options.height) return {options.width, options.height};
  const bool hasPage = pageWidth > 0 && pageHeight > 0;
  if (!hasPage || (!options.width && !options.height)) return options.size;
  const double other = options.width ? options.width * pageHeight / pageWidth : options.height * pageWidth / pageHeight;
  const double whole = std::max(std::ceil(other - 1e-3), 1.0);
  if (whole > kLargestSide)
    throw Failure(inputName(options.file) + ": the picture would be more than " + std::to_string(kLargestSide) +
                  (options.width ? " pixels high; --width must be smaller" : " pixels wide; --height must be smaller"));
  const auto side = static_cast<uint32_t>(whole);
  return options.width ? Size{options.width, side} : Size{side, options.height};
}

} // namespace gpgp::cli
