#include "filters.h"

#include "gpgp_srgb.hpp"

#include <RmlUi/Core/DecorationTypes.h>
#include <RmlUi/Core/Variant.h>

#include <algorithm>
#include <cmath>

namespace gpgp::rmlui {
using integration::linearFromSrgb;
namespace {

/// What is mixed into red, green and blue: a matrix between the identity and `full`.
using Rows = std::array<std::array<float, 3>, 3>;
void setMatrix(GpgpFilterStep& step, const Rows& rows, float constant = 0) {
  step.kind = GPGP_FILTER_COLOR_MATRIX;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t column = 0; column < 3; ++column) step.values[row * 5 + column] = rows[row][column];
    step.values[row * 5 + 4] = constant;
  }
  step.values[3 * 5 + 3] = 1;
}
Rows diagonal(float v) { return {{{v, 0, 0}, {0, v, 0}, {0, 0, v}}}; }
Rows mix(const Rows& full, float part) {
  Rows rows = diagonal(1 - part);
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) rows[i][k] += part * full[i][k];
  return rows;
}

constexpr Rows kGray{{{0.2126f, 0.7152f, 0.0722f}, {0.2126f, 0.7152f, 0.0722f}, {0.2126f, 0.7152f, 0.0722f}}};
constexpr Rows kSepia{{{0.393f, 0.769f, 0.189f}, {0.349f, 0.686f, 0.168f}, {0.272f, 0.534f, 0.131f}}};
// Filter Effects 1: saturate and hueRotate. Luminance, and what sine turns.
constexpr Rows kLuminance{{{0.213f, 0.715f, 0.072f}, {0.213f, 0.715f, 0.072f}, {0.213f, 0.715f, 0.072f}}};
constexpr Rows kTurn{{{-0.213f, -0.715f, 0.928f}, {0.143f, 0.140f, -0.283f}, {-0.787f, 0.715f, 0.072f}}};

} // namespace

FilterPointer makeFilter(const Rml::String& name, const Rml::Dictionary& parameters) {
  auto filter = std::make_shared<Filter>();
  GpgpFilterStep& step = filter->step;
  const float value = Rml::Get(parameters, "value", 1.0f);
  const float sigma = std::max(Rml::Get(parameters, "sigma", name == "blur" ? 1.0f : 0.0f), 0.0f);
  if (name == "opacity") {
    filter->kind = Filter::Kind::opacity;
    filter->opacity = value;
  } else if (name == "blur") {
    step.kind = GPGP_FILTER_GAUSSIAN_BLUR;
    step.values[0] = step.values[1] = sigma;
  } else if (name == "drop-shadow") {
    const auto color = Rml::Get(parameters, "color", Rml::Colourb());
    const auto offset = Rml::Get(parameters, "offset", Rml::Vector2f(0.f));
    step.kind = GPGP_FILTER_DROP_SHADOW;
    step.values[0] = step.values[1] = sigma;
    step.values[2] = offset.x;
    step.values[3] = offset.y;
    for (int c = 0; c < 3; ++c) step.values[4 + c] = linearFromSrgb(static_cast<float>(color[c]) / 255);
    step.values[7] = static_cast<float>(color.alpha) / 255;
  } else if (name == "brightness") {
    setMatrix(step, diagonal(value));
  } else if (name == "contrast") {
    setMatrix(step, diagonal(value), 0.5f - 0.5f * value);
  } else if (name == "invert") {
    const float part = std::clamp(value, 0.0f, 1.0f);
    setMatrix(step, diagonal(1 - 2 * part), part);
  } else if (name == "grayscale") {
    setMatrix(step, mix(kGray, value));
  } else if (name == "sepia") {
    setMatrix(step, mix(kSepia, value));
  } else if (name == "saturate") {
    setMatrix(step, mix(kLuminance, 1 - value));
  } else if (name == "hue-rotate") {
    Rows rows = mix(kLuminance, 1 - std::cos(value));
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 3; ++k) rows[i][k] += std::sin(value) * kTurn[i][k];
    setMatrix(step, rows);
  } else {
    return nullptr;
  }
  return filter;
}

PaintPointer makeGradient(const Rml::String& name, const Rml::Dictionary& parameters) {
  auto paint = std::make_shared<Paint>();
  paint->kind = Paint::Kind::gradient;
  Gradient& gradient = paint->gradient;
  gradient.repeating = Rml::Get(parameters, "repeating", false);
  const auto point = [&](const char* key, float otherwise) {
    const auto v = Rml::Get(parameters, key, Rml::Vector2f(otherwise));
    return std::array{v.x, v.y};
  };
  if (name == "linear-gradient") {
    gradient.kind = Gradient::Kind::linear;
    gradient.start = point("p0", 0);
    gradient.extent = point("p1", 0);
    for (size_t axis = 0; axis < 2; ++axis) gradient.extent[axis] -= gradient.start[axis];
  } else if (name == "radial-gradient") {
    gradient.kind = Gradient::Kind::radial;
    gradient.start = point("center", 0);
    gradient.extent = point("radius", 1);
  } else if (name == "conic-gradient") {
    gradient.kind = Gradient::Kind::conic;
    gradient.start = point("center", 0);
    gradient.angle = Rml::Get(parameters, "angle", 0.0f);
  } else {
    return nullptr;
  }
  const auto found = parameters.find("color_stop_list");
  if (found == parameters.end() || found->second.GetType() != Rml::Variant::COLORSTOPLIST) return nullptr;
  for (const Rml::ColorStop& from : found->second.GetReference<Rml::ColorStopList>()) {
    Gradient::Stop& to = gradient.stops.emplace_back();
    to.position = from.position.number;
    for (size_t c = 0; c < 4; ++c) to.color[c] = static_cast<float>(from.color[c]) / 255;
  }
  return gradient.stops.empty() ? nullptr : paint;
}

} // namespace gpgp::rmlui
