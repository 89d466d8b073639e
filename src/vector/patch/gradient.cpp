// A gradient or an image as the API takes it to the paint that shaders evaluate.
//
// Gradient space is turned, scaled and moved so that start lies at 0 and end on the x axis: at 1 if the gradient is
// linear; otherwise the largest of the distance between the two and of their radii becomes 1.
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {
using core::makeError;

core::Result<void> checkGradient(const GpgpGradient& g) {
  if (g.kind != GPGP_GRADIENT_LINEAR && g.kind != GPGP_GRADIENT_RADIAL)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient.kind is %d", g.kind);
  if (g.spread < GPGP_SPREAD_PAD || g.spread > GPGP_SPREAD_REFLECT)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient.spread is %d", g.spread);
  for (const float v : g.transform)
    if (!std::isfinite(v))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient.transform holds a number that is not finite");
  for (const float v : {g.start[0], g.start[1], g.end[0], g.end[1], g.startRadius, g.endRadius})
    if (!std::isfinite(v))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient: start, end or a radius is not finite");
  if (g.kind == GPGP_GRADIENT_RADIAL && (g.startRadius < 0 || g.endRadius < 0))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient: radii are %g and %g; they must not be negative",
                     static_cast<double>(g.startRadius), static_cast<double>(g.endRadius));
  if (!g.stops || g.stopCount == 0 || g.stopCount > 65536)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient: %u stops; expected 1 to 65536", g.stops ? g.stopCount : 0);
  for (uint32_t i = 0; i < g.stopCount; ++i) {
    if (!(g.stops[i].offset >= 0 && g.stops[i].offset <= 1))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient.stops[%u].offset is not within 0 to 1", i);
    if (!inColorRange(g.stops[i].color))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "gradient.stops[%u].color is out of range", i);
  }
  return {};
}

float encodeSrgb(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }
} // namespace

core::Result<uint32_t> addGradient(const GpgpGradient& g, Drawing& drawing) {
  if (auto ok = checkGradient(g); !ok) return ok.error();
  PaintRecord paint{};
  paint.kind = g.kind == GPGP_GRADIENT_LINEAR ? shader::kPaintLinear : shader::kPaintRadial;
  paint.spread = static_cast<uint32_t>(g.spread);
  paint.flags = g.interpolateSrgb ? shader::kInterpolateSrgb : 0;
  // Gradient space to ramp: u = a x + c y + e, v = b x + d y + f.
  const bool radial = g.kind == GPGP_GRADIENT_RADIAL;
  const double sx = g.start[0], sy = g.start[1], dx = g.end[0] - sx, dy = g.end[1] - sy, distance = std::hypot(dx, dy);
  const double radius = radial ? g.startRadius : 0, growth = radial ? g.endRadius - radius : 0;
  const double unit = std::max({distance, radius, radius + growth});
  const double a = (distance > 0 ? dx / distance : 1) / unit, c = (distance > 0 ? dy / distance : 0) / unit;
  const double b = -c, d = a, e = -(a * sx + c * sy), f = -(b * sx + d * sy);
  const auto narrow = [](double v) { return static_cast<float>(v); };
  if (radial) {
    const double square = distance * distance, tangent = square - growth * growth;
    paint.startRadius = narrow(radius / unit);
    paint.origin.z = narrow(distance / unit);
    paint.origin.w = narrow(growth / unit);
    // A circle that touches the other from inside does so whatever its numbers were rounded to.
    const bool touches = std::abs(tangent) <= 1e-6 * (square + growth * growth);
    paint.tangent = touches ? 0 : narrow(tangent / (unit * unit));
  }
  // Drawing to gradient space: the transform's inverse.
  const double t0 = g.transform[0], t1 = g.transform[1], t2 = g.transform[2], t3 = g.transform[3], t4 = g.transform[4],
               t5 = g.transform[5];
  const double determinant = t0 * t3 - t1 * t2;
  const double i0 = t3 / determinant, i1 = -t1 / determinant, i2 = -t2 / determinant, i3 = t0 / determinant;
  const double i4 = -(i0 * t4 + i2 * t5), i5 = -(i1 * t4 + i3 * t5);
  paint.matrix = {narrow(a * i0 + c * i1), narrow(b * i0 + d * i1), narrow(a * i2 + c * i3), narrow(b * i2 + d * i3)};
  paint.origin.x = narrow(a * i4 + c * i5 + e);
  paint.origin.y = narrow(b * i4 + d * i5 + f);
  bool spreads = true;
  for (int k = 0; k < 4; ++k) spreads = spreads && std::isfinite(paint.matrix[k]) && std::isfinite(paint.origin[k]);
  const bool nothing = radial && growth == 0 && (radius == 0 || distance == 0);
  if (nothing || !spreads) { // the last stop everywhere, or nothing
    paint.kind = shader::kPaintLinear;
    paint.spread = shader::kSpreadPad;
    paint.matrix = {0, 0, 0, 0};
    paint.origin = {1, 0, 0, 0};
    paint.startRadius = paint.tangent = 0;
    spreads = false;
  }
  paint.firstStop = static_cast<uint32_t>(drawing.stops.size());
  paint.stopCount = spreads ? g.stopCount : 1;
  float last = 0;
  for (const GpgpGradientStop& from : std::span(g.stops, g.stopCount).last(paint.stopCount)) {
    StopRecord stop{};
    for (int k = 0; k < 4; ++k)
      stop.color[k] = k < 3 && g.interpolateSrgb ? std::max(encodeSrgb(from.color[k]), 0.0f) : from.color[k];
    stop.offset = last = std::max(last, from.offset);
    if (nothing) stop.color = {0, 0, 0, 0};
    drawing.stops.push_back(stop);
  }
  drawing.paints.push_back(paint);
  return static_cast<uint32_t>(drawing.paints.size() - 1);
}

core::Result<uint32_t> addImage(const GpgpImagePaint& image, Drawing& drawing) {
  if (image.image >= GPGP_MAX_IMAGES)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.image is %u; it must be below %u", image.image,
                     GPGP_MAX_IMAGES);
  double t[6];
  for (int k = 0; k < 6; ++k) {
    t[k] = static_cast<double>(image.transform[k]);
    if (!std::isfinite(t[k]))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.transform holds a number that is not finite");
  }
  const double determinant = t[0] * t[3] - t[1] * t[2];
  PaintRecord paint{};
  const double inverse[6] = {t[3] / determinant,
                             -t[1] / determinant,
                             -t[2] / determinant,
                             t[0] / determinant,
                             (t[2] * t[5] - t[3] * t[4]) / determinant,
                             (t[1] * t[4] - t[0] * t[5]) / determinant};
  for (int k = 0; k < 6; ++k) {
    const float value = static_cast<float>(inverse[k]);
    if (!std::isfinite(value))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image.transform has no inverse that float can hold");
    (k < 4 ? paint.matrix[k] : paint.origin[k - 4]) = value;
  }
  paint.kind = shader::kPaintImage;
  paint.firstStop = image.image;
  drawing.paints.push_back(paint);
  return static_cast<uint32_t>(drawing.paints.size() - 1);
}

} // namespace gpgp::vector
