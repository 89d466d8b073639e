// Polygons for the tests of geometry: known ones, and random ones with holes.
#pragma once
#include "spawn/geometry/geometry.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace gpgp::spawn::test {

using shader::vec2;
using shader::vec3;

struct Polygon {
  std::vector<std::vector<vec2>> loops; ///< the first counter-clockwise, the others clockwise

  double area() const {
    double sum = 0;
    for (const auto& loop : loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
        sum += 0.5 * (double(a.x) * b.y - double(a.y) * b.x);
      }
    }
    return sum;
  }
  double perimeter() const {
    double sum = 0;
    for (const auto& loop : loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
        sum += std::hypot(double(a.x) - b.x, double(a.y) - b.y);
      }
    }
    return sum;
  }
  uint32_t corners() const {
    uint32_t sum = 0;
    for (const auto& loop : loops) {
      sum += uint32_t(loop.size());
    }
    return sum;
  }
};

/// (x, y) lies at (x, 0, -y), so that the normal is up.
inline Status makeForm(MeshPool& pool, const Polygon& polygon, Form& form) {
  std::vector<vec3> points;
  std::vector<uint32_t> sizes;
  for (const auto& loop : polygon.loops) {
    for (const vec2& p : loop) {
      points.emplace_back(p.x, 0.0f, -p.y);
    }
    sizes.push_back(uint32_t(loop.size()));
  }
  return makePolygon(pool, points, sizes, form);
}

class Random {
public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  float between(float low, float high) { return low + (high - low) * float(engine_() >> 8) / 16777216.0f; }
  uint32_t below(uint32_t count) { return uint32_t(engine_()) % count; }

  /// Corners on a circle: convex.
  Polygon convex(uint32_t most = 12) {
    const uint32_t n = 3 + below(most - 2);
    const float rx = between(1, 8), ry = between(1, 8), turn = between(0, 6.28f);
    Polygon p{{{}}};
    for (uint32_t i = 0; i < n; ++i) {
      const float a = (float(i) + between(0, 0.7f)) * 6.2831853f / float(n);
      const float x = rx * std::cos(a), y = ry * std::sin(a);
      p.loops[0].emplace_back(x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn));
    }
    return p;
  }
  /// Seen whole from its middle, with up to five holes about that.
  Polygon concave(uint32_t most = 30, bool holes = true) {
    const uint32_t n = 3 + below(most - 2);
    const float inner = between(1.5f, 3), outer = between(3, 9);
    Polygon p{{{}}};
    for (uint32_t i = 0; i < n; ++i) {
      const float a = (float(i) + between(0, 0.8f)) * 6.2831853f / float(n), r = between(inner, outer);
      p.loops[0].emplace_back(r * std::cos(a), r * std::sin(a));
    }
    if (!holes || n < 7) return p;
    const uint32_t count = below(6);
    for (uint32_t h = 0; h < count; ++h) {
      const float angle = float(h) * 6.2831853f / float(count);
      const float away = count == 1 ? 0.0f : 0.6f * inner, radius = count == 1 ? 0.5f * inner : 0.2f * inner;
      const uint32_t m = 3 + below(5);
      std::vector<vec2> hole;
      for (uint32_t i = 0; i < m; ++i) {
        const float a = -(float(i) + between(0, 0.6f)) * 6.2831853f / float(m), r = radius * between(0.4f, 1);
        hole.emplace_back(away * std::cos(angle) + r * std::cos(a), away * std::sin(angle) + r * std::sin(a));
      }
      p.loops.push_back(hole);
    }
    // The hull of few far corners may miss the middle: the outline is moved out until all holes are well inside.
    for (size_t i = 0; i < n; ++i) {
      const vec2 a = p.loops[0][i], b = p.loops[0][(i + 1) % n];
      const float distance = (a.x * b.y - a.y * b.x) / std::hypot(b.x - a.x, b.y - a.y);
      if (distance < 0.9f * inner) return Polygon{{p.loops[0]}};
    }
    return p;
  }
  /// Towers of whole numbers on a common base: many simultaneous events. turned: not along the axes.
  Polygon towers(bool turned) {
    const uint32_t n = 1 + below(12);
    Polygon p{{{{0, 0}, {float(n), 0}}}};
    auto& loop = p.loops[0];
    uint32_t last = 0;
    for (uint32_t i = n; i-- > 0;) {
      const uint32_t h = 1 + below(5);
      if (h == last) {
        loop.back().x = float(i);
        continue;
      }
      loop.emplace_back(float(i + 1), float(h));
      loop.emplace_back(float(i), float(h));
      last = h;
    }
    if (turned)
      for (vec2& v : loop) {
        v = {v.x * 0.8f - v.y * 0.6f, v.x * 0.6f + v.y * 0.8f};
      }
    return p;
  }
  /// Whole numbers, square or diamond holes in a grid, some touching nothing but in time.
  Polygon grid() {
    Polygon p{{{{0, 0}, {12, 0}, {12, 12}, {0, 12}}}};
    const uint32_t sides = 3 + below(5);
    for (int x = 0; x < 3; ++x) {
      for (int y = 0; y < 3; ++y) {
        if (below(2)) continue;
        std::vector<vec2> hole;
        for (uint32_t i = 0; i < sides; ++i) {
          const float a = -float(i) * 6.2831853f / float(sides);
          hole.emplace_back(2 + 4 * float(x) + std::cos(a), 2 + 4 * float(y) + std::sin(a));
        }
        p.loops.push_back(hole);
      }
    }
    return p;
  }

private:
  std::mt19937 engine_;
};

inline Polygon rectangle(float x, float y) { return {{{{0, 0}, {x, 0}, {x, y}, {0, y}}}}; }
inline Polygon shapeOfL() { return {{{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 9}, {0, 9}}}}; }
inline Polygon shapeOfT() { return {{{{0, 0}, {2, 0}, {2, 4}, {4, 4}, {4, 6}, {-2, 6}, {-2, 4}, {0, 4}}}}; }
inline Polygon shapeOfU() { return {{{{0, 0}, {9, 0}, {9, 6}, {6, 6}, {6, 3}, {3, 3}, {3, 6}, {0, 6}}}}; }
inline Polygon shapeOfPlus() {
  return {{{{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}}}};
}
inline Polygon ring() { return {{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{4, 4}, {4, 6}, {6, 6}, {6, 4}}}}; }

} // namespace gpgp::spawn::test
