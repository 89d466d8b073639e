// Patches to outlines.
//
// The region of a path is the union of its patches, and a sample is inside where an odd number of its patches' sides
// lies left of it. So each curve bounds the region wherever an odd number of patches uses it: rows that follow each
// other are joined, rows used from both sides cancel. What is left over at a height, sorted by x, is joined in pairs by
// level segments: the outlines are then closed whatever the transform, and share their vertices bit for bit.
#include "vector/raster/segments.h"

#include "vector/geometry/order.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {
namespace {
using shader::SegmentRecord;
using shader::vec4;

struct Rise { // a patch's side begins (or ends) to bound there
  uint32_t curve;
  float y;
  int side;
};
struct End { // of a segment
  float y, x;
  uint32_t segment;
  bool bottom;
};

float xAt(const CurveRecord& c, float y) {
  if (y <= c.ends.y) return c.ends.x;
  if (y >= c.endY) return c.endX;
  const double height = static_cast<double>(c.endY) - static_cast<double>(c.ends.y);
  const double width = static_cast<double>(c.endX) - static_cast<double>(c.ends.x);
  const double wanted = static_cast<double>(y) - static_cast<double>(c.ends.y);
  double t = wanted / height;
  double x = t * width;
  if (c.bend >= 0) {
    const double y1 = static_cast<double>(c.controls.y), y2 = static_cast<double>(c.controls.w);
    const double x1 = static_cast<double>(c.controls.x), x2 = static_cast<double>(c.controls.z);
    t = parameterAt(y1, y2, height, wanted);
    const double u = 1 - t;
    x = 3 * u * u * t * x1 + 3 * u * t * t * x2 + t * t * t * width;
  }
  return std::clamp(static_cast<float>(static_cast<double>(c.ends.x) + x), std::min(c.ends.x, c.endX),
                    std::max(c.ends.x, c.endX));
}

SegmentRecord wholeCurve(const CurveRecord& c) {
  SegmentRecord s{};
  s.first = {c.ends.x, c.ends.y, c.ends.x + c.controls.x, c.ends.y + c.controls.y};
  s.second = {c.ends.x + c.controls.z, c.ends.y + c.controls.w, c.endX, c.endY};
  s.line = c.bend < 0;
  return s;
}

class PathOutline {
public:
  PathOutline(const Drawing& drawing, Outlines& outlines)
      : drawing_(drawing), segments_(outlines.segments), memory_(segments_.get_allocator().resource()), rises_(memory_),
        counts_(memory_), ends_(memory_), sorted_(memory_) {}

  void run(uint32_t path, size_t firstPatch, size_t lastPatch) {
    ends_.clear();
    sortRises(std::span(drawing_.patches).subspan(firstPatch, lastPatch - firstPatch));
    const size_t first = segments_.size();
    int side = 0;
    for (size_t i = 0; i < rises_.size();) {
      const Rise at = rises_[i];
      int next = side;
      for (; i < rises_.size() && rises_[i].curve == at.curve && rises_[i].y == at.y; ++i) next += rises_[i].side;
      if (next == side) continue;
      if (side & 1) end(at.curve, at.y);
      if (next & 1) begin(path, at.curve, at.y, next);
      side = next;
    }
    close(path);
    // Neighbours in the table run through the same tiles.
    const auto own = std::span(segments_).subspan(first);
    const auto order = orderBy(
        static_cast<uint32_t>(own.size()), memory_, [&own](uint32_t i) { return own[i].ends.y; },
        [&own](uint32_t i, uint32_t k) {
          return own[i].ends.x != own[k].ends.x ? own[i].ends.x < own[k].ends.x : i < k;
        });
    sorted_.clear();
    for (const uint32_t i : order) sorted_.push_back(own[i]);
    std::copy(sorted_.begin(), sorted_.end(), own.begin());
  }

private:
  /// By curve, then height. A path's curves lie beside each other in the table, but a file may say otherwise.
  void sortRises(std::span<const PatchRecord> patches) {
    rises_.clear();
    if (patches.empty()) return;
    uint32_t low = UINT32_MAX, high = 0;
    for (const PatchRecord& p : patches) {
      low = std::min({low, p.left, p.right});
      high = std::max({high, p.left, p.right});
    }
    const bool counted = (high - low) / 8 <= patches.size();
    counts_.assign(counted ? high - low + 2 : 0, 0);
    for (const PatchRecord& p : counted ? patches : patches.first(0)) {
      counts_[p.left - low + 1] += 2;
      counts_[p.right - low + 1] += 2;
    }
    for (size_t i = 1; i < counts_.size(); ++i) counts_[i] += counts_[i - 1];
    rises_.resize(patches.size() * 4);
    size_t added = 0;
    const auto add = [&](uint32_t curve, float y, int side) {
      rises_[counted ? counts_[curve - low]++ : added++] = {curve, y, side};
    };
    for (const PatchRecord& p : patches) {
      add(p.left, p.top, 1);
      add(p.left, p.bottom, -1);
      add(p.right, p.top, -1);
      add(p.right, p.bottom, 1);
    }
    const auto before = [](const Rise& a, const Rise& b) { return a.curve != b.curve ? a.curve < b.curve : a.y < b.y; };
    if (!counted) std::sort(rises_.begin(), rises_.end(), before);
    size_t first = 0;
    for (size_t curve = 0; curve + 1 < counts_.size(); first = counts_[curve++]) // where the next one's begin, now
      std::sort(rises_.begin() + static_cast<std::ptrdiff_t>(first), rises_.begin() + counts_[curve], before);
  }
  void begin(uint32_t path, uint32_t curve, float y, int side) {
    SegmentRecord s = wholeCurve(drawing_.curves[curve]);
    s.path = path;
    s.side = side > 0 ? 1.0f : -1.0f;
    s.ends = {xAt(drawing_.curves[curve], y), y, 0, 0};
    ends_.push_back({y, s.ends.x, static_cast<uint32_t>(segments_.size()), false});
    segments_.push_back(s);
  }
  void end(uint32_t curve, float y) {
    SegmentRecord& s = segments_.back();
    s.ends.z = xAt(drawing_.curves[curve], y);
    s.ends.w = y;
    ends_.push_back({y, s.ends.z, static_cast<uint32_t>(segments_.size() - 1), true});
  }

  /// Joins what ends at a height in pairs. Ends that only rounding keeps apart, at least one of them inside its curve,
  /// become one instead.
  void close(uint32_t path) {
    const auto order = orderBy(
        static_cast<uint32_t>(ends_.size()), memory_, [this](uint32_t i) { return ends_[i].y; },
        [this](uint32_t i, uint32_t k) {
          const End &a = ends_[i], &b = ends_[k];
          return a.x != b.x ? a.x < b.x : a.segment < b.segment;
        });
    for (size_t i = 0; i + 1 < order.size(); i += 2) {
      const End &a = ends_[order[i]], &b = ends_[order[i + 1]];
      if (a.x == b.x) continue;
      if (b.x - a.x <= 1e-6f * (std::abs(a.x) + std::abs(a.y)) && (free(a) || free(b))) {
        const End &moved = free(a) ? a : b, &kept = free(a) ? b : a;
        SegmentRecord& s = segments_[moved.segment];
        (moved.bottom ? s.ends.z : s.ends.x) = kept.x;
        continue;
      }
      SegmentRecord s{};
      s.first = {a.x, a.y, a.x, a.y};
      s.second = {b.x, a.y, b.x, a.y};
      s.ends = {a.x, a.y, b.x, a.y};
      s.line = 1;
      s.path = path;
      // Outlines run down where the region lies right and up where it lies left, so they leave a point that a left
      // side reaches from above or a right side from below.
      const bool arrives = (segments_[a.segment].side > 0) == a.bottom;
      s.side = arrives ? 1.0f : -1.0f;
      segments_.push_back(s);
    }
  }
  bool free(const End& e) const { // inside its curve
    const SegmentRecord& s = segments_[e.segment];
    return e.bottom ? e.y < s.second.w : e.y > s.first.y;
  }

  const Drawing& drawing_;
  std::pmr::vector<SegmentRecord>& segments_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<Rise> rises_;
  std::pmr::vector<uint32_t> counts_;
  std::pmr::vector<End> ends_;
  std::pmr::vector<SegmentRecord> sorted_;
};

} // namespace

namespace {
/// `base`: outlines that are taken over for paths whose `edited` is 0; NULL: none.
Outlines outlinesOf(const Drawing& drawing, const Outlines* base, std::span<const uint8_t> edited,
                    std::pmr::memory_resource* memory) {
  Outlines outlines(memory);
  PathOutline outline(drawing, outlines);
  outlines.segments.reserve(drawing.patches.size());
  outlines.boxes.reserve(drawing.paths.size());
  outlines.ends.reserve(drawing.paths.size());
  size_t patch = 0;
  for (uint32_t path = 0; path < drawing.paths.size(); ++path) {
    const size_t first = patch;
    if (base && !edited[path]) {
      while (patch < drawing.patches.size() && drawing.patches[patch].path == path) ++patch;
      const auto segments = base->segments.begin();
      outlines.segments.insert(outlines.segments.end(), segments + (path ? base->ends[path - 1] : 0),
                               segments + base->ends[path]);
      outlines.boxes.push_back(base->boxes[path]);
      outlines.ends.push_back(static_cast<uint32_t>(outlines.segments.size()));
      continue;
    }
    float left = 3e38f, top = 3e38f, right = -3e38f, bottom = -3e38f;
    for (; patch < drawing.patches.size() && drawing.patches[patch].path == path; ++patch) {
      const PatchRecord& p = drawing.patches[patch];
      left = std::min(left, p.x0), top = std::min(top, p.top);
      right = std::max(right, p.x1), bottom = std::max(bottom, p.bottom);
    }
    outline.run(path, first, patch);
    outlines.boxes.push_back({left, top, right, bottom});
    outlines.ends.push_back(static_cast<uint32_t>(outlines.segments.size()));
  }
  return outlines;
}
} // namespace

double parameterAt(double y1, double y2, double height, double wanted) {
  double t = wanted / height;
  double low = 0, high = 1;
  for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
    const double u = 1 - t, f = 3 * u * u * t * y1 + 3 * u * t * t * y2 + t * t * t * height - wanted;
    if (f == 0) break;
    (f < 0 ? low : high) = t;
    const double slope = 3 * (u * u * y1 + 2 * u * t * (y2 - y1) + t * t * (height - y2));
    const double next = t - f / slope;
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return t;
}

Outlines makeOutlines(const Drawing& drawing, std::pmr::memory_resource* memory) {
  return outlinesOf(drawing, nullptr, {}, memory);
}

Outlines editOutlines(const Drawing& drawing, const Outlines& base, std::span<const GpgpPathEdit> edits,
                      std::pmr::memory_resource* memory) {
  std::pmr::vector<uint8_t> edited(drawing.paths.size(), 0, memory);
  const uint32_t hidden = clipPaths(drawing);
  for (const GpgpPathEdit& edit : edits) edited[hidden + edit.index] = 1;
  return outlinesOf(drawing, &base, edited, memory);
}

} // namespace gpgp::vector
