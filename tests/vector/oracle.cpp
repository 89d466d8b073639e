#include "oracle.h"

#include <algorithm>
#include <cmath>

namespace gpgp::test {
namespace {
double bernstein(const std::array<double, 8>& c, int axis, double t) {
  const double s = 1 - t;
  return s * s * s * c[axis] + 3 * s * s * t * c[2 + axis] + 3 * s * t * t * c[4 + axis] + t * t * t * c[6 + axis];
}
} // namespace

PathOracle::PathOracle(const GpgpPath& path) : evenOdd_(path.fillRule == GPGP_FILL_EVEN_ODD) {
  const float* p = path.points;
  double sx = 0, sy = 0, x = 0, y = 0;
  const auto line = [&](double a, double b) {
    addCurve({x, y, x + (a - x) / 3, y + (b - y) / 3, x + (a - x) * 2 / 3, y + (b - y) * 2 / 3, a, b});
    x = a, y = b;
  };
  for (uint32_t i = 0; i < path.verbCount; ++i) switch (path.verbs[i]) {
    case GPGP_PATH_MOVE:
      if (i) line(sx, sy);
      sx = x = p[0], sy = y = p[1], p += 2;
      break;
    case GPGP_PATH_LINE: line(p[0], p[1]), p += 2; break;
    case GPGP_PATH_QUAD:
      addCurve({x, y, x + (p[0] - x) * 2 / 3, y + (p[1] - y) * 2 / 3, p[2] + (double(p[0]) - p[2]) * 2 / 3,
                p[3] + (double(p[1]) - p[3]) * 2 / 3, p[2], p[3]});
      x = p[2], y = p[3], p += 4;
      break;
    case GPGP_PATH_CUBIC:
      addCurve({x, y, p[0], p[1], p[2], p[3], p[4], p[5]});
      x = p[4], y = p[5], p += 6;
      break;
    default: line(sx, sy); break;
    }
  if (path.verbCount) line(sx, sy);
}

double PathOracle::magnitude() const {
  return std::max({std::abs(left), std::abs(top), std::abs(right), std::abs(bottom)});
}

void PathOracle::addCurve(const std::array<double, 8>& c) {
  // y'(t) / 3 = a t^2 + b t + d
  const double a = c[7] - 3 * c[5] + 3 * c[3] - c[1], b = 2 * (c[5] - 2 * c[3] + c[1]), d = c[3] - c[1];
  std::vector<double> cuts{0, 1};
  const auto cut = [&](double t) {
    if (t > 0 && t < 1) cuts.push_back(t);
  };
  if (std::abs(a) < 1e-12 * (std::abs(b) + std::abs(d))) {
    if (b != 0) cut(-d / b);
  } else if (const double disc = b * b - 4 * a * d; disc >= 0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(disc), b));
    cut(q / a);
    if (q != 0) cut(d / q);
  }
  std::sort(cuts.begin(), cuts.end());
  for (size_t i = 0; i + 1 < cuts.size(); ++i) {
    Piece piece{c, cuts[i], cuts[i + 1], 0, 0, 0, 0};
    piece.y0 = piece.t0 == 0 ? c[1] : bernstein(c, 1, piece.t0);
    piece.y1 = piece.t1 == 1 ? c[7] : bernstein(c, 1, piece.t1);
    piece.xMin = std::min({c[0], c[2], c[4], c[6]});
    piece.xMax = std::max({c[0], c[2], c[4], c[6]});
    for (double t : {piece.t0, 0.5 * (piece.t0 + piece.t1), piece.t1}) {
      left = std::min(left, bernstein(c, 0, t)), right = std::max(right, bernstein(c, 0, t));
      top = std::min(top, bernstein(c, 1, t)), bottom = std::max(bottom, bernstein(c, 1, t));
    }
    pieces_.push_back(piece);
  }
}

int PathOracle::winding(double x, double y) const {
  int winding = 0;
  for (const Piece& p : pieces_) {
    const bool down = p.y0 <= y && y < p.y1, up = p.y1 <= y && y < p.y0;
    if ((!down && !up) || x < p.xMin) continue;
    bool counts = x >= p.xMax;
    if (!counts) {
      double low = p.t0, high = p.t1;
      for (int i = 0; i < 52; ++i) {
        const double t = 0.5 * (low + high);
        ((bernstein(p.c, 1, t) <= y) == down ? low : high) = t;
      }
      counts = bernstein(p.c, 0, 0.5 * (low + high)) <= x;
    }
    if (counts) winding += down ? 1 : -1;
  }
  return winding;
}

double PathOracle::distance(double x, double y) const {
  constexpr int kFlatSegments = 1024;
  double least = 1e300;
  for (const Piece& p : pieces_) {
    double fromX = bernstein(p.c, 0, p.t0) - x, fromY = bernstein(p.c, 1, p.t0) - y;
    for (int i = 1; i <= kFlatSegments; ++i) {
      const double t = p.t0 + (p.t1 - p.t0) * i / kFlatSegments;
      const double toX = bernstein(p.c, 0, t) - x, toY = bernstein(p.c, 1, t) - y;
      const double dx = toX - fromX, dy = toY - fromY, square = dx * dx + dy * dy;
      const double at = square > 0 ? std::clamp(-(fromX * dx + fromY * dy) / square, 0.0, 1.0) : 0;
      least = std::min(least, std::hypot(fromX + at * dx, fromY + at * dy));
      fromX = toX, fromY = toY;
    }
  }
  return least;
}

std::vector<PathOracle::Crossing> PathOracle::crossings(double y) const {
  std::vector<Crossing> row;
  for (const Piece& p : pieces_) {
    const bool down = p.y0 <= y && y < p.y1, up = p.y1 <= y && y < p.y0;
    if (!down && !up) continue;
    double low = p.t0, high = p.t1;
    for (int i = 0; i < 40; ++i) {
      const double t = 0.5 * (low + high);
      ((bernstein(p.c, 1, t) <= y) == down ? low : high) = t;
    }
    row.push_back({bernstein(p.c, 0, 0.5 * (low + high)), down ? 1 : -1});
  }
  std::sort(row.begin(), row.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
  return row;
}

} // namespace gpgp::test
