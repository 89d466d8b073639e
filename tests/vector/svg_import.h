// SVG text imported by a test: what came of it, what was said, and what it looks like by winding numbers.
#pragma once
#include "cli/vector/reference.h"
#include "vector/import/svg/import.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace gpgp::test {

/// Files that a drawing can refer to: texts by their path.
struct TextFiles : std::map<std::string, std::string> {
  using map::map;
  GpgpFileSystem fileSystem() const { return {const_cast<TextFiles*>(this), read}; }
  static GpgpResult GPGP_CALL read(void* userData, const char* path, void* data, size_t capacity, size_t* size) {
    const auto& files = *static_cast<const TextFiles*>(userData);
    const auto found = files.find(path);
    if (found == files.end()) return GPGP_ERROR_IO;
    *size = found->second.size();
    if (data) std::memcpy(data, found->second.data(), std::min(capacity, found->second.size()));
    return GPGP_SUCCESS;
  }
};

/// As the command prints it: "a.svg:3:7: warning: text".
inline std::string placed(const GpgpMessage& message) {
  return std::string(message.label) + (message.severity == GPGP_SEVERITY_ERROR ? ": error: " : ": warning: ") +
         message.text;
}
/// "a.svg:3:7: warning: text" as "line 3: text".
inline std::string withLine(const std::string& message) {
  const size_t word = std::min(message.find(": error: "), message.find(": warning: "));
  if (word == message.npos) return message;
  std::string place = message.substr(0, message.rfind(':', word - 1)); // without its column
  return "line " + place.substr(place.rfind(':') + 1) + message.substr(message.find(": ", word + 1));
}

struct Import {
  vector::svg::Imported drawing;
  std::vector<std::string> messages; ///< "E line 3: ..." or "W line 3: ..."
  std::vector<std::string> placed;   ///< as they are: "test.svg:3:7: warning: ..."
  std::string error;                 ///< empty: it is SVG
};

inline Import import(std::string_view text, const vector::svg::ImportLimits& limits = {}, double scale = 1,
                     const GpgpFileSystem* files = nullptr, bool layers = true) {
  Import result;
  const auto listen = [](void* user, const GpgpMessage* m) {
    auto& into = *static_cast<Import*>(user);
    const std::string whole = test::placed(*m);
    into.placed.push_back(whole);
    into.messages.push_back((m->severity == GPGP_SEVERITY_ERROR ? "E " : "W ") + withLine(whole));
  };
  vector::svg::Reporter reporter(listen, &result, "test.svg");
  vector::svg::ImportDetail detail;
  detail.scale = scale, detail.layers = layers;
  auto drawing =
      vector::svg::importSvg(std::as_bytes(std::span(text.data(), text.size())), reporter, limits, {}, detail, files);
  if (drawing)
    result.drawing = std::move(*drawing);
  else
    result.error = drawing.error().text;
  return result;
}

/// A page of 100 x 100 pixels around the text, which begins in line 2.
inline Import page(const std::string& inside, const std::string& attributes = "",
                   const GpgpFileSystem* files = nullptr) {
  return import("<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'" + attributes + ">\n" + inside +
                    "</svg>",
                {}, 1, files);
}

constexpr uint32_t kPictured = 25; ///< pixels of a side

/// The page over white in 25 x 25 pixels, premultiplied as sRGB encodes it.
inline std::vector<float> picture(const Import& import) {
  const vector::svg::ImportedViews views(import.drawing);
  const double width = import.drawing.width, height = import.drawing.height;
  const float t[6] = {static_cast<float>(kPictured / width), 0, 0, static_cast<float>(kPictured / height), 0, 0};
  const float white[4] = {1, 1, 1, 1};
  return cli::vectorReference(views.paths, views.groups, t, white, kPictured, kPictured, cli::Blend::Srgb);
}

/// The largest difference of a channel of any pixel, of 255.
inline double worst(const std::vector<float>& a, const std::vector<float>& b) {
  double most = a.size() == b.size() ? 0 : 255;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, 255 * std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  return most;
}

} // namespace gpgp::test
