// Any bytes as path data, as points, as a transform and as lengths: what is read is well formed, and its area and its
// stroke, dashed and not, convert or are refused.
#include "vector/geometry/stroke.h"
#include "vector/import/svg/scanner.h"
#include "vector/patch/drawing.h"

#include <cmath>
#include <cstdlib>

namespace {
using namespace gpgp::vector;

void convert(const Shape& shape) {
  size_t points = 0;
  for (size_t i = 0; i < shape.verbs.size(); ++i) {
    const GpgpPathVerb verb = shape.verbs[i];
    if (verb > GPGP_PATH_CLOSE) std::abort();
    const bool begins = i == 0 || shape.verbs[i - 1] == GPGP_PATH_CLOSE;
    if (begins && verb != GPGP_PATH_MOVE) std::abort();
    points += verb == GPGP_PATH_CLOSE ? 0 : verb == GPGP_PATH_CUBIC ? 3 : verb == GPGP_PATH_QUAD ? 2 : 1;
  }
  if (points != shape.points.size()) std::abort();
  std::vector<float> numbers;
  for (const Point& p : shape.points) {
    if (!(std::fabs(p.x) <= 1e7 && std::fabs(p.y) <= 1e7)) return;
    numbers.push_back(static_cast<float>(p.x));
    numbers.push_back(static_cast<float>(p.y));
  }
  const GpgpPath path{shape.verbs.data(), static_cast<uint32_t>(shape.verbs.size()),
                      numbers.data(),     static_cast<uint32_t>(points),
                      GPGP_FILL_EVEN_ODD, {0, 0, 0, 1}};
  std::pmr::vector<LeftEmpty> leftEmpty;
  if (!makeDrawing(std::span(&path, 1), std::pmr::get_default_resource(), nullptr, &leftEmpty)) std::abort();
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp::vector::svg;
  if (size > 2000) return 0; // strokes of many crossings take long
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Shape shape, points;
  const size_t bad = parsePathData(text, shape, 1e-4);
  if (bad != text.npos && bad > text.size()) std::abort();
  convert(shape);
  parsePoints(text, true, points);
  convert(points);
  const double length = lengthOf(shape);
  for (const Point& p : shape.points)
    if (!(std::fabs(p.x) <= 1e7 && std::fabs(p.y) <= 1e7)) return 0;
  if (!(length >= 0)) std::abort();
  const double dashes[] = {length / 7, length / 5};
  for (const bool dashed : {false, true}) {
    StrokeStyle style{0.5, static_cast<Cap>(size % 3), static_cast<Join>(size / 3 % 3)};
    if (dashed && length > 0) style.dashes = dashes;
    Shape area;
    if (strokeShape(shape, style, 0.05, {}, area)) convert(area);
  }
  Affine transform;
  if (parseTransform(text, {}, transform) && transform.finite() && !std::isfinite(transform.scale())) std::abort();
  double value = 0;
  if (parseLength(text, {}, LengthAxis::Diagonal, value) && !std::isfinite(value)) std::abort();
  Point origin;
  if (parseOrigin(text, {}, origin) && !(std::isfinite(origin.x) && std::isfinite(origin.y))) std::abort();
  return 0;
}
