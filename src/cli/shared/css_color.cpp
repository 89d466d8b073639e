#include "cli/shared/css_color.h"

#include "cli/shared/common.h"
#include "vector/import/svg/style.h"

namespace gpgp::cli {

std::array<float, 4> parseCssColor(const std::string& option, const std::string& text) {
  if (text.empty()) return {};
  vector::svg::Color c;
  if (!vector::svg::parseColor(text, c))
    throw Usage(option + " '" + text +
                "' is not a CSS colour; write for example white, '#fff' or 'rgb(255 0 0 / 50%)'");
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)};
}

std::array<float, 4> parseBackground(const std::string& text) {
  std::array<float, 4> colour = parseCssColor("--background", text);
  for (size_t i = 0; i < 3; ++i) colour[i] *= colour[3];
  return colour;
}

} // namespace gpgp::cli
