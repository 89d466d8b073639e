// Patches as SVG: each one outlined over its fill, so that cuts can be seen.
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace gpgp::vector {
namespace {

Monotone monotone(const CurveRecord& c) {
  const Point start{c.ends.x, c.ends.y};
  Monotone m;
  m.curve.line = c.bend < 0;
  m.curve.p[0] = start;
  m.curve.p[1] = start + Point{c.controls.x, c.controls.y};
  m.curve.p[2] = start + Point{c.controls.z, c.controls.w};
  m.curve.p[3] = start + Point{c.ends.z, c.ends.w};
  return m;
}

/// The parameter at which a monotone cubic reaches a height.
double parameterAt(const Monotone& m, double y) {
  double low = 0, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double t = 0.5 * (low + high);
    (m.curve.at(t).y < y ? low : high) = t;
  }
  return 0.5 * (low + high);
}

template <size_t N, class... Args> void append(std::pmr::string& out, const char (&format)[N], Args... args) {
  char text[256];
  const int length = std::snprintf(text, sizeof text, format, args...);
  out.append(text, std::min<size_t>(static_cast<size_t>(std::max(length, 0)), sizeof text - 1));
}

int byteFromLinear(float v) {
  const double s = v <= 0.0031308f ? 12.92 * v : 1.055 * std::pow(static_cast<double>(v), 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(std::clamp(s, 0.0, 1.0) * 255));
}
} // namespace

std::pmr::string patchesToSvg(const Drawing& d, std::pmr::memory_resource* memory) {
  std::pmr::string out(memory);
  const double width = d.bounds[2] - d.bounds[0], height = d.bounds[3] - d.bounds[1];
  append(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"%.9g %.9g %.9g %.9g\">\n",
         static_cast<double>(d.bounds[0]), static_cast<double>(d.bounds[1]), width, height);
  append(out, "<g stroke=\"#06f\" stroke-width=\"%.4g\">\n", std::max(width, height) / 2000);
  for (const PatchRecord& p : d.patches) {
    const Monotone l = monotone(d.curves[p.left]), r = monotone(d.curves[p.right]);
    const double top = p.top, bottom = p.bottom;
    const Cubic left = l.curve.part(parameterAt(l, top), parameterAt(l, bottom));
    const Cubic right = r.curve.part(parameterAt(r, top), parameterAt(r, bottom));
    append(out, "<path d=\"M%.9g %.9gC%.9g %.9g %.9g %.9g %.9g %.9g", left.p[0].x, left.p[0].y, left.p[1].x,
           left.p[1].y, left.p[2].x, left.p[2].y, left.p[3].x, left.p[3].y);
    append(out, "L%.9g %.9gC%.9g %.9g %.9g %.9g %.9g %.9gZ\"", right.p[3].x, right.p[3].y, right.p[2].x, right.p[2].y,
           right.p[1].x, right.p[1].y, right.p[0].x, right.p[0].y);
    const shader::vec4 c = d.paths[p.path].color;
    append(out, " fill=\"#%02x%02x%02x\" fill-opacity=\"%.3g\"/>\n", byteFromLinear(c.x), byteFromLinear(c.y),
           byteFromLinear(c.z), static_cast<double>(c.w));
  }
  out += "</g>\n</svg>\n";
  return out;
}

} // namespace gpgp::vector
