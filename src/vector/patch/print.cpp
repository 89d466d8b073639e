// Stages as SVG.
#include "vector/geometry/order.h"
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

namespace {

void open(std::pmr::string& out, std::span<const GpgpPath> paths, double& unit) {
  double box[4] = {1e30, 1e30, -1e30, -1e30};
  for (const GpgpPath& path : paths)
    for (uint32_t i = 0; i < path.pointCount; ++i)
      for (uint32_t k = 0; k < 2; ++k) {
        const double v = path.points[2 * i + k];
        box[k] = std::min(box[k], v);
        box[2 + k] = std::max(box[2 + k], v);
      }
  const double width = std::max(box[2] - box[0], 0.0), height = std::max(box[3] - box[1], 0.0);
  unit = std::max({width, height, 1e-6}) / 2000;
  append(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"%.9g %.9g %.9g %.9g\">\n", box[0] - unit,
         box[1] - unit, width + 2 * unit, height + 2 * unit);
}

void curve(std::pmr::string& out, const Cubic& c) {
  append(out, "M%.9g %.9gC%.9g %.9g %.9g %.9g %.9g %.9g", c.p[0].x, c.p[0].y, c.p[1].x, c.p[1].y, c.p[2].x, c.p[2].y,
         c.p[3].x, c.p[3].y);
}

template <class Draw> void forPieces(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory, Draw&& draw) {
  for (const GpgpPath& path : paths) {
    std::pmr::vector<Monotone> pieces(memory);
    if (!outline(path, pieces)) continue;
    mergeCoincident(pieces);
    draw(pieces);
  }
}

} // namespace

std::pmr::string pathsToSvg(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory) {
  std::pmr::string out(memory);
  double unit = 0;
  open(out, paths, unit);
  for (const GpgpPath& path : paths) {
    append(out,
           "<path fill-rule=\"%s\" fill=\"#%02x%02x%02x\" fill-opacity=\"%.3g\" stroke=\"#06f\" "
           "stroke-width=\"%.4g\" d=\"",
           path.fillRule == GPGP_FILL_EVEN_ODD ? "evenodd" : "nonzero", byteFromLinear(path.color[0]),
           byteFromLinear(path.color[1]), byteFromLinear(path.color[2]), static_cast<double>(path.color[3]), unit);
    constexpr uint32_t kPoints[] = {1, 1, 2, 3, 0};
    const float* p = path.points;
    for (uint32_t i = 0; i < path.verbCount; ++i) {
      append(out, "%c", "MLQCZ"[path.verbs[i]]);
      for (uint32_t k = 0; k < 2 * kPoints[path.verbs[i]]; ++k) append(out, "%.9g ", static_cast<double>(*p++));
    }
    out += "\"/>\n";
  }
  out += "</svg>\n";
  return out;
}

std::pmr::string piecesToSvg(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory) {
  std::pmr::string out(memory);
  double unit = 0;
  open(out, paths, unit);
  append(out, "<g fill=\"none\" stroke-width=\"%.4g\" stroke-linecap=\"round\">\n", unit);
  forPieces(paths, memory, [&](std::span<const Monotone> pieces) {
    for (const Monotone& piece : pieces) {
      append(out, "<path stroke=\"%s\" d=\"", piece.winding > 0 ? "#06f" : "#e30");
      curve(out, piece.curve);
      append(out, "\"/><path stroke=\"#000\" stroke-width=\"%.4g\" d=\"M%.9g %.9gzM%.9g %.9gz\"/>\n", 3 * unit,
             piece.curve.p[0].x, piece.curve.p[0].y, piece.curve.p[3].x, piece.curve.p[3].y);
    }
  });
  out += "</g>\n</svg>\n";
  return out;
}

std::pmr::string crossingsToSvg(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory) {
  std::pmr::string out(memory);
  double unit = 0;
  open(out, paths, unit);
  append(out, "<g fill=\"none\" stroke=\"#999\" stroke-width=\"%.4g\" stroke-linecap=\"round\">\n", unit);
  forPieces(paths, memory, [&](std::span<const Monotone> pieces) {
    std::pmr::vector<Cut> cuts(memory);
    if (!findCrossings(pieces, cuts)) return;
    for (const Monotone& piece : pieces) {
      out += "<path d=\"";
      curve(out, piece.curve);
      out += "\"/>\n";
    }
    for (const Cut cut : cuts) {
      const double y = heightOfKey(cut);
      append(out, "<path stroke=\"#e30\" stroke-width=\"%.4g\" d=\"M%.9g %.9gz\"/>\n", 4 * unit,
             pieces[numberOfKey(cut)].xAt(y), y);
    }
  });
  out += "</g>\n</svg>\n";
  return out;
}

std::pmr::string patchesToSvg(std::span<const GpgpPath> paths, const Drawing& d, std::pmr::memory_resource* memory) {
  std::pmr::string out(memory);
  double unit = 0;
  open(out, paths, unit);
  append(out, "<g stroke=\"#06f\" stroke-width=\"%.4g\">\n", unit);
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
