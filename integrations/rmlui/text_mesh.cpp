#include "text_mesh.h"

#include <cstdio>

namespace gpgp::rmlui {

// Hundredths of pixels, as no locale writes them otherwise.
std::string textTexture(const TextStyle& style) {
  char name[64];
  std::snprintf(name, sizeof name, "?gpgp-text %d %d", int(style.stroke * 100 + 0.5f), int(style.blur * 100 + 0.5f));
  return name;
}

std::optional<TextStyle> textStyleOf(const std::string& texture) {
  int stroke = 0, blur = 0;
  if (std::sscanf(texture.c_str(), "?gpgp-text %d %d", &stroke, &blur) != 2) return std::nullopt;
  return TextStyle{static_cast<float>(stroke) / 100, static_cast<float>(blur) / 100};
}

} // namespace gpgp::rmlui
