// Rays through a lattice of points are cast a tile at a time: the triangles of a tile, nearest first, are drawn into
// it, and those behind all that is there are passed over.
#include "visibility/reference/ray_reference.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace gpgp::visibility {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity(), kTie = 0x1p-30;
constexpr double kMostRim = 0x1p-10; // pixels
constexpr uint32_t kNone = UINT32_MAX;
constexpr int kBlock = 16, kTile = 128, kField = 2048; // points of a side
constexpr int kTileBlocks = kTile / kBlock;

/// A camera over a lattice whose points are `samples` a pixel apart, point (0, 0) in the middle of its part.
struct Lattice {
  glm::dmat4 matrix;
  bool reversed, perspective;
  double width, height, samples; ///< in pixels; points a pixel
  double across;                 ///< the rate at which pixels change with the world, times w
};

Lattice latticeOf(const GpgpCamera& camera, uint32_t width, uint32_t height, uint32_t samples) {
  Lattice lattice{};
  for (int i = 0; i < 16; ++i) lattice.matrix[i / 4][i % 4] = camera.viewProjection[i];
  const auto row = [&](int i) { return glm::dvec3(lattice.matrix[0][i], lattice.matrix[1][i], lattice.matrix[2][i]); };
  lattice.reversed = camera.reversedDepth != 0;
  lattice.perspective = glm::length(row(3)) > 0;
  lattice.width = width, lattice.height = height, lattice.samples = samples;
  lattice.across = std::hypot(0.5 * width * (glm::length(row(0)) + glm::length(row(3))),
                              0.5 * height * (glm::length(row(1)) + glm::length(row(3))));
  return lattice;
}

/// A corner on the lattice. Nearness is linear on the picture, and larger where it is nearer: 1 / w, or for parallel
/// cameras depth.
struct Corner {
  glm::dvec2 at;
  double nearness;
  glm::dvec3 texture; ///< coordinates, and 1, over w
};

/// What is left of a triangle between the near and the far plane, a fan of triangles.
struct Polygon {
  std::array<Corner, 5> corners;
  int count = 0;
  double rim = 0; ///< in points
};

struct Clipped {
  glm::dvec4 p;
  glm::dvec2 coordinates;
};
Clipped between(const Clipped& a, const Clipped& b, double part) {
  return {a.p + (b.p - a.p) * part, a.coordinates + (b.coordinates - a.coordinates) * part};
}

/// Sutherland and Hodgman, from the inner to the outer corner, so that neighbours cut a common edge at one point.
template <class Distance> int clip(std::array<Clipped, 5>& corners, int count, const Distance& distance) {
  std::array<Clipped, 5> kept;
  int number = 0;
  for (int i = 0; i < count; ++i) {
    const Clipped &a = corners[static_cast<size_t>(i)], &b = corners[static_cast<size_t>((i + 1) % count)];
    const double da = distance(a.p), db = distance(b.p);
    if (da >= 0) kept[static_cast<size_t>(number++)] = a;
    if ((da >= 0) != (db >= 0) && number < 5)
      kept[static_cast<size_t>(number++)] = da >= 0 ? between(a, b, da / (da - db)) : between(b, a, db / (db - da));
  }
  corners = kept;
  return number;
}

/// No corners where nothing of the triangle faces the camera.
Polygon place(const RayTriangles::Triangle& triangle, const Lattice& lattice) {
  Polygon polygon;
  if (!triangle.usable) return polygon;
  std::array<Clipped, 5> clipped{};
  for (size_t i = 0; i < 3; ++i)
    clipped[i] = {lattice.matrix * glm::dvec4(triangle.corners[i], 1), triangle.coordinates[i]};
  int count = 3;
  count = clip(clipped, count, [](const glm::dvec4& p) { return p.z; });
  count = clip(clipped, count, [](const glm::dvec4& p) { return p.w - p.z; });
  double leastW = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) {
    const glm::dvec4& p = clipped[static_cast<size_t>(i)].p;
    if (!(p.w > 0)) return polygon; // z = w = 0: the eye itself
    leastW = std::min(leastW, p.w);
    const double depth = p.z / p.w;
    polygon.corners[static_cast<size_t>(i)] = {{(p.x / p.w + 1) / 2 * lattice.width * lattice.samples - 0.5,
                                                (p.y / p.w + 1) / 2 * lattice.height * lattice.samples - 0.5},
                                               lattice.perspective ? 1 / p.w
                                               : lattice.reversed  ? depth
                                                                   : -depth,
                                               glm::dvec3(clipped[static_cast<size_t>(i)].coordinates, 1) / p.w};
  }
  for (int i = 0; i < count; ++i)
    if (const Corner& c = polygon.corners[static_cast<size_t>(i)]; !std::isfinite(c.at.x + c.at.y + c.nearness))
      return polygon;
  double area = 0; // twice; negative is counter-clockwise as seen, because y goes down
  for (int i = 1; i + 1 < count; ++i) {
    const glm::dvec2 o = polygon.corners[0].at, a = polygon.corners[static_cast<size_t>(i)].at - o,
                     b = polygon.corners[static_cast<size_t>(i) + 1].at - o;
    area += a.x * b.y - a.y * b.x;
  }
  const bool clockwise = ((triangle.flags & GPGP_DRAW_CLOCKWISE) != 0) != triangle.turned;
  if (area == 0 || (!(triangle.flags & GPGP_DRAW_TWO_SIDED) && (area > 0) != clockwise)) return polygon;
  if (area < 0) std::reverse(polygon.corners.begin(), polygon.corners.begin() + count);
  polygon.rim = std::min(triangle.rounding * lattice.across / leastW, kMostRim) * lattice.samples;
  polygon.count = count;
  return polygon;
}

/// A triangle of such a fan, clockwise as seen.
struct Piece {
  std::array<Corner, 3> corners;
  double rim, nearest, farthest;
  glm::dvec2 slope; ///< of nearness
  glm::dvec2 low, high;
  uint32_t number, flags;
  glm::dvec3 texture, textureX, textureY; ///< at the first corner, and how it changes

  bool isSeeThrough() const { return (flags & GPGP_DRAW_SEE_THROUGH) != 0; }
  uint32_t test() const { return flags >> 8 & 31; } ///< 1 and the alpha test's index; 0: none
};

bool makePiece(const Polygon& polygon, int i, uint32_t number, uint32_t flags, Piece& piece) {
  piece.corners = {polygon.corners[0], polygon.corners[static_cast<size_t>(i)],
                   polygon.corners[static_cast<size_t>(i) + 1]};
  const auto& c = piece.corners;
  const glm::dvec2 a = c[1].at - c[0].at, b = c[2].at - c[0].at;
  const double area = a.x * b.y - a.y * b.x;
  if (!(area > 0)) return false;
  const double na = c[1].nearness - c[0].nearness, nb = c[2].nearness - c[0].nearness;
  piece.slope = {(na * b.y - nb * a.y) / area, (nb * a.x - na * b.x) / area};
  piece.nearest = std::max({c[0].nearness, c[1].nearness, c[2].nearness});
  piece.farthest = std::min({c[0].nearness, c[1].nearness, c[2].nearness});
  piece.rim = polygon.rim;
  piece.low = glm::min(c[0].at, glm::min(c[1].at, c[2].at)) - piece.rim;
  piece.high = glm::max(c[0].at, glm::max(c[1].at, c[2].at)) + piece.rim;
  piece.number = number;
  piece.flags = flags;
  piece.texture = c[0].texture;
  const glm::dvec3 ta = c[1].texture - c[0].texture, tb = c[2].texture - c[0].texture;
  piece.textureX = (ta * b.y - tb * a.y) / area;
  piece.textureY = (tb * a.x - ta * b.x) / area;
  return std::isfinite(piece.slope.x + piece.slope.y);
}

/// First and one past the last point of a side that a piece may reach, within [begin, end).
struct Range {
  int begin, end;
};
Range rangeOf(double low, double high, int begin, int end) {
  return {static_cast<int>(std::clamp<double>(std::ceil(low), begin, end)),
          static_cast<int>(std::clamp<double>(std::floor(high) + 1, begin, end))};
}

/// Points of the lattice from `left`, `top` on, and what the rays through them see.
class Tile {
public:
  explicit Tile(const RayScene& scene) : scene_(scene), nearness_(size_t{kTile} * kTile), number_(nearness_.size()) {}

  void begin(int left, int top, int width, int height) {
    left_ = left, top_ = top, width_ = width, height_ = height;
    std::fill(nearness_.begin(), nearness_.end(), kNothing);
    std::fill(number_.begin(), number_.end(), kNone);
    for (Block& block : blocks_) block = {};
  }
  /// Whether all rays have met something nearer than that, for sure.
  bool hides(double nearest) {
    for (int y = 0; y * kBlock < height_; ++y)
      for (int x = 0; x * kBlock < width_; ++x)
        if (!isHidden(x, y, nearest)) return false;
    return true;
  }
  void draw(const Piece& piece) {
    const Range xs = rangeOf(piece.low.x - left_, piece.high.x - left_, 0, width_);
    const Range ys = rangeOf(piece.low.y - top_, piece.high.y - top_, 0, height_);
    if (xs.begin >= xs.end || ys.begin >= ys.end) return;
    for (int by = ys.begin / kBlock; by * kBlock < ys.end; ++by)
      for (int bx = xs.begin / kBlock; bx * kBlock < xs.end; ++bx) {
        if (isHidden(bx, by, piece.nearest)) continue;
        for (int y = std::max(ys.begin, by * kBlock); y < std::min(ys.end, (by + 1) * kBlock); ++y)
          drawRow(piece, y, std::max(xs.begin, bx * kBlock), std::min(xs.end, (bx + 1) * kBlock),
                  blocks_[static_cast<size_t>(by * kTileBlocks + bx)]);
      }
  }
  /// Once all that hides is drawn: the points that see a triangle which hides nothing.
  template <class Tell> void tellThrough(const Piece& piece, const Tell& told) const {
    const Range xs = rangeOf(piece.low.x - left_, piece.high.x - left_, 0, width_);
    const Range ys = rangeOf(piece.low.y - top_, piece.high.y - top_, 0, height_);
    uint64_t rays = 0;
    for (int y = ys.begin; y < ys.end; ++y)
      for (int x = xs.begin; x < xs.end; ++x) {
        const double px = left_ + x, py = top_ + y;
        bool inside = true;
        if (!reaches(piece, px, py, inside) || !inside || !isThere(piece, px, py)) continue;
        const Corner& c = piece.corners[0];
        const double nearness = std::clamp(c.nearness + piece.slope.x * (px - c.at.x) + piece.slope.y * (py - c.at.y),
                                           piece.farthest, piece.nearest);
        const double best = nearness_[static_cast<size_t>(y * kTile + x)];
        rays += best == kNothing || nearness >= best - kTie * std::max(std::abs(best), std::abs(nearness));
      }
    if (rays) told(piece.number, rays);
  }
  /// Each run of points that see one triangle.
  template <class Tell> void tell(const Tell& told) const {
    for (int y = 0; y < height_; ++y)
      for (int x = 0, run = 0; x < width_; x += run) {
        const uint32_t* row = &number_[static_cast<size_t>(y * kTile)];
        for (run = 1; x + run < width_ && row[x + run] == row[x];) ++run;
        if (row[x] != kNone) told(row[x], static_cast<uint64_t>(run));
      }
  }

private:
  struct Block {
    int met = 0; ///< points whose rays meet something
    bool changed = false;
    double farthest = kNothing;
  };

  bool isHidden(int x, int y, double nearest) {
    Block& block = blocks_[static_cast<size_t>(y * kTileBlocks + x)];
    const int right = std::min(width_ - x * kBlock, kBlock), bottom = std::min(height_ - y * kBlock, kBlock);
    if (block.met < right * bottom) return false;
    if (block.changed) {
      block.farthest = -kNothing;
      for (int j = 0; j < bottom; ++j)
        for (int i = 0; i < right; ++i)
          block.farthest =
              std::min(block.farthest, nearness_[static_cast<size_t>((y * kBlock + j) * kTile + x * kBlock + i)]);
      block.changed = false;
    }
    return nearest < block.farthest - kTie * std::abs(block.farthest);
  }

  void drawRow(const Piece& piece, int y, int begin, int end, Block& block) {
    const double py = top_ + y;
    // Where the row cuts the outline, give or take more than rounding, is what has to be asked: beside that nothing is
    // inside, between all of them everything.
    double from = begin, to = end - 1, sureFrom = begin, sureTo = end - 1;
    for (size_t i = 0; i < 3; ++i) {
      const glm::dvec2 a = piece.corners[i].at, b = piece.corners[(i + 1) % 3].at;
      const double dy = b.y - a.y, slack = 1 + piece.rim * (1 + std::abs((b.x - a.x) / dy));
      if (dy == 0 || !std::isfinite(slack)) {
        sureTo = -1;
        continue;
      }
      const double cut = a.x + (py - a.y) / dy * (b.x - a.x) - left_;
      if (dy > 0)
        to = std::min(to, cut + slack), sureTo = std::min(sureTo, cut - slack);
      else
        from = std::max(from, cut - slack), sureFrom = std::max(sureFrom, cut + slack);
    }
    const Range range = rangeOf(from, to, begin, end), sure = rangeOf(sureFrom, sureTo, begin, end);
    const Corner& c = piece.corners[0];
    const double start = c.nearness + piece.slope.y * (py - c.at.y) + piece.slope.x * (left_ - c.at.x);
    for (int x = range.begin; x < range.end; ++x) {
      bool inside = true;
      if ((x < sure.begin || x >= sure.end) && !reaches(piece, left_ + x, py, inside)) continue;
      if (piece.test() && !isThere(piece, left_ + x, py)) continue;
      const double nearness = std::clamp(start + piece.slope.x * x, piece.farthest, piece.nearest);
      const auto at = static_cast<size_t>(y * kTile + x);
      double& best = nearness_[at];
      if (best == kNothing) ++block.met;
      const double tie = kTie * std::max(std::abs(best), std::abs(nearness));
      if (best == kNothing || nearness > best + tie) {
        best = nearness;
        number_[at] = inside ? piece.number : kNone;
      } else if (nearness >= best - tie) {
        best = std::max(best, nearness);
        if (inside) number_[at] = std::min(number_[at], piece.number);
      } else {
        continue;
      }
      block.changed = true;
    }
  }

  /// Whether its texture lets a piece be at a point.
  bool isThere(const Piece& piece, double px, double py) const {
    if (!piece.test() || !scene_.passesAlpha) return true;
    const glm::dvec2 from = glm::dvec2(px, py) - piece.corners[0].at;
    const glm::dvec3 at = piece.texture + piece.textureX * from.x + piece.textureY * from.y;
    return scene_.passesAlpha(piece.test() - 1, glm::dvec2(at) / at.z);
  }

  /// Whether a point lies in a piece or its rim, and whether in the piece itself.
  static bool reaches(const Piece& piece, double px, double py, bool& inside) {
    for (size_t i = 0; i < 3; ++i) {
      const glm::dvec2 a = piece.corners[i].at, b = piece.corners[(i + 1) % 3].at;
      // The same number, but for its sign, for the triangle on the edge's other side.
      const double turn = (a.x - px) * (b.y - py) - (a.y - py) * (b.x - px);
      if (turn >= 0) continue;
      inside = false;
      if (turn * turn > piece.rim * piece.rim * ((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y))) return false;
    }
    return true;
  }

  const RayScene& scene_;
  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;
  std::vector<double> nearness_;
  std::vector<uint32_t> number_;
  std::array<Block, size_t{kTileBlocks} * kTileBlocks> blocks_;
};

int fieldsOf(double points) { return static_cast<int>(std::ceil(points / kField)); }

/// The places of the triangles that may be seen in each field of the lattice.
std::vector<std::vector<uint32_t>> binned(const RayTriangles& triangles, const Lattice& lattice) {
  const double right = lattice.width * lattice.samples, bottom = lattice.height * lattice.samples;
  const int columns = fieldsOf(right), rows = fieldsOf(bottom);
  std::vector<std::vector<uint32_t>> fields(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  for (size_t place_ = 0; place_ < triangles.size(); ++place_) {
    const Polygon polygon = place(triangles.at(place_), lattice);
    if (!polygon.count) continue;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (int i = 0; i < polygon.count; ++i) {
      low = glm::min(low, polygon.corners[static_cast<size_t>(i)].at - polygon.rim);
      high = glm::max(high, polygon.corners[static_cast<size_t>(i)].at + polygon.rim);
    }
    const Range xs = rangeOf(low.x, high.x, 0, static_cast<int>(right));
    const Range ys = rangeOf(low.y, high.y, 0, static_cast<int>(bottom));
    if (xs.begin >= xs.end || ys.begin >= ys.end) continue; // between points, or beside the picture
    for (int y = ys.begin / kField; y * kField < ys.end; ++y)
      for (int x = xs.begin / kField; x * kField < xs.end; ++x)
        fields[static_cast<size_t>(y * columns + x)].push_back(static_cast<uint32_t>(place_));
  }
  return fields;
}

/// Casts the rays of one field.
template <class Tell>
void castField(const RayTriangles& triangles, const Lattice& lattice, const std::vector<uint32_t>& places, int left,
               int top, const Tell& told) {
  std::vector<Piece> pieces;
  for (const uint32_t at : places) {
    const RayTriangles::Triangle triangle = triangles.at(at);
    const Polygon polygon = place(triangle, lattice);
    for (int i = 1; i + 1 < polygon.count; ++i)
      if (Piece piece; makePiece(polygon, i, triangle.number, triangle.flags, piece)) pieces.push_back(piece);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.nearest > b.nearest; });
  const int right = std::min(left + kField, static_cast<int>(lattice.width * lattice.samples));
  const int bottom = std::min(top + kField, static_cast<int>(lattice.height * lattice.samples));
  constexpr int kTiles = kField / kTile;
  std::array<std::vector<uint32_t>, size_t{kTiles} * kTiles> lists;
  for (uint32_t i = 0; i < pieces.size(); ++i) {
    const Range xs = rangeOf(pieces[i].low.x, pieces[i].high.x, left, right);
    const Range ys = rangeOf(pieces[i].low.y, pieces[i].high.y, top, bottom);
    for (int y = ys.begin; y < ys.end; y += kTile - (y - top) % kTile)
      for (int x = xs.begin; x < xs.end; x += kTile - (x - left) % kTile)
        lists[static_cast<size_t>((y - top) / kTile * kTiles + (x - left) / kTile)].push_back(i);
  }
  Tile tile(triangles.scene());
  for (int y = top; y < bottom; y += kTile)
    for (int x = left; x < right; x += kTile) {
      const auto& list = lists[static_cast<size_t>((y - top) / kTile * kTiles + (x - left) / kTile)];
      if (list.empty()) continue;
      tile.begin(x, y, std::min(kTile, right - x), std::min(kTile, bottom - y));
      for (size_t i = 0; i < list.size(); ++i) {
        if (i % 64 == 63 && tile.hides(pieces[list[i]].nearest)) break;
        if (!pieces[list[i]].isSeeThrough()) tile.draw(pieces[list[i]]);
      }
      for (const uint32_t i : list)
        if (pieces[i].isSeeThrough()) tile.tellThrough(pieces[i], told);
      tile.tell(told);
    }
}

} // namespace

RayReference::RayReference(const RayScene& scene, ForEach forEach)
    : triangles_(scene), forEach_(std::move(forEach)), counts_(scene.triangleCount) {}

void RayReference::add(const GpgpCamera& camera, uint32_t width, uint32_t height, uint32_t samples,
                       const std::function<void(size_t, size_t)>& told) {
  std::vector<std::pair<Lattice, std::vector<std::vector<uint32_t>>>> lattices;
  size_t parts = 0;
  for (const uint32_t each : {samples, 1u}) { // the parts' middles, and the centres
    if (samples == 1 && !lattices.empty()) break;
    const Lattice lattice = latticeOf(camera, width, height, each);
    lattices.emplace_back(lattice, binned(triangles_, lattice));
    parts += lattices.back().second.size();
  }
  std::atomic<size_t> done{0};
  for (const auto& [lattice, fields] : lattices) {
    const int columns = fieldsOf(lattice.width * lattice.samples);
    forEach_(fields.size(), [&, &grid = lattice, &lists = fields](size_t field) {
      const int column = static_cast<int>(field) % columns, row = static_cast<int>(field) / columns;
      castField(triangles_, grid, lists[field], column * kField, row * kField, [&](uint32_t number, uint64_t rays) {
        std::atomic_ref(counts_[number]).fetch_add(rays, std::memory_order_relaxed);
      });
      const size_t now = ++done;
      if (told) told(now, parts);
    });
  }
}

std::vector<uint32_t> RayReference::areas() const {
  std::vector<uint32_t> areas;
  for (const uint64_t count : counts_) areas.push_back(static_cast<uint32_t>(std::min<uint64_t>(count, UINT32_MAX)));
  return areas;
}

std::vector<uint32_t> RayReference::bits() const {
  std::vector<uint32_t> bits((counts_.size() + 31) / 32);
  for (size_t i = 0; i < counts_.size(); ++i)
    if (counts_[i]) bits[i / 32] |= 1u << i % 32;
  return bits;
}

} // namespace gpgp::visibility
