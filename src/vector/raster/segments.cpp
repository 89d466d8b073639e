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
      : drawing_(drawing), segments_(outlines.segments), memory_(segments_.get_allocator().resource()), uses_(memory_),
        chains_(memory_), rises_(memory_), made_(memory_), ends_(memory_), order_(memory_) {}

  void run(uint32_t path, size_t firstPatch, size_t lastPatch) {
    made_.clear();
    ends_.clear();
    const auto patches = std::span(drawing_.patches).subspan(firstPatch, lastPatch - firstPatch);
    if (!followUses(path, patches)) sortRises(path, patches);
    close(path);
    // Neighbours in the table run through the same tiles. Closing has left all but in order.
    const auto before = [this](uint32_t i, uint32_t k) {
      const vec4 &a = made_[i].ends, &b = made_[k].ends;
      return a.y != b.y ? a.y < b.y : a.x != b.x ? a.x < b.x : i < k;
    };
    for (size_t i = 1; i < order_.size(); ++i) {
      const uint32_t moved = order_[i];
      size_t at = i;
      for (; at > 0 && before(moved, order_[at - 1]); --at) order_[at] = order_[at - 1];
      order_[at] = moved;
    }
    for (const uint32_t i : order_) segments_.push_back(made_[i]);
  }

private:
  /// Rows in which patches follow each other on one side of a curve.
  struct Use {
    float top, bottom;
    int side;
    uint32_t next; // of the curve
  };
  struct Chain { // a curve's uses
    uint32_t first = kNone, last = kNone;
  };
  static constexpr uint32_t kNone = UINT32_MAX;

  /// For patches as conversion makes them: a path's curves lie beside each other in the table, and a curve's patches
  /// are in the order of its rows, each beginning where those before it have ended. Otherwise false, and nothing is
  /// made.
  bool followUses(uint32_t path, std::span<const PatchRecord> patches) {
    uint32_t low = UINT32_MAX, high = 0;
    for (const PatchRecord& p : patches) {
      low = std::min(low, std::min(p.left, p.right));
      high = std::max(high, std::max(p.left, p.right));
    }
    if (patches.empty()) return true;
    if ((high - low) / 8 > patches.size()) return false;
    uses_.clear();
    chains_.assign(high - low + 1, Chain{});
    const auto use = [&](uint32_t curve, const PatchRecord& p, int side) {
      Chain& chain = chains_[curve - low];
      const auto added = static_cast<uint32_t>(uses_.size());
      if (chain.last == kNone) {
        chain.first = added;
      } else {
        Use& before = uses_[chain.last];
        if (before.bottom == p.top && before.side == side) {
          before.bottom = p.bottom;
          return true;
        }
        if (!(before.bottom <= p.top)) return false;
        before.next = added;
      }
      chain.last = added;
      uses_.push_back({p.top, p.bottom, side, kNone});
      return true;
    };
    for (const PatchRecord& p : patches)
      if (!use(p.left, p, 1) || !use(p.right, p, -1)) return false;
    for (uint32_t curve = low; curve <= high; ++curve)
      for (uint32_t i = chains_[curve - low].first; i != kNone; i = uses_[i].next) {
        begin(path, curve, uses_[i].top, uses_[i].side);
        end(curve, uses_[i].bottom);
      }
    return true;
  }
  /// For any patches, as a file may have them.
  void sortRises(uint32_t path, std::span<const PatchRecord> patches) {
    rises_.clear();
    for (const PatchRecord& p : patches) {
      rises_.insert(rises_.end(), {{p.left, p.top, 1}, {p.left, p.bottom, -1}, {p.right, p.top, -1}});
      rises_.push_back({p.right, p.bottom, 1});
    }
    std::sort(rises_.begin(), rises_.end(),
              [](const Rise& a, const Rise& b) { return a.curve != b.curve ? a.curve < b.curve : a.y < b.y; });
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
  }
  void begin(uint32_t path, uint32_t curve, float y, int side) {
    SegmentRecord s = wholeCurve(drawing_.curves[curve]);
    s.path = path;
    s.side = side > 0 ? 1.0f : -1.0f;
    s.ends = {xAt(drawing_.curves[curve], y), y, 0, 0};
    ends_.push_back({y, s.ends.x, static_cast<uint32_t>(made_.size()), false});
    made_.push_back(s);
  }
  void end(uint32_t curve, float y) {
    SegmentRecord& s = made_.back();
    s.ends.z = xAt(drawing_.curves[curve], y);
    s.ends.w = y;
    ends_.push_back({y, s.ends.z, static_cast<uint32_t>(made_.size() - 1), true});
  }

  /// Joins what ends at a height in pairs, and lists all by where they begin. Ends that only rounding keeps apart, at
  /// least one of them inside its curve, become one instead.
  void close(uint32_t path) {
    const auto order = orderBy(
        static_cast<uint32_t>(ends_.size()), memory_, [this](uint32_t i) { return ends_[i].y; },
        [this](uint32_t i, uint32_t k) {
          const End &a = ends_[i], &b = ends_[k];
          return a.x != b.x ? a.x < b.x : a.segment < b.segment;
        });
    order_.clear();
    for (size_t i = 0; i + 1 < order.size(); i += 2) {
      const End &a = ends_[order[i]], &b = ends_[order[i + 1]];
      if (!a.bottom) order_.push_back(a.segment);
      if (!b.bottom) order_.push_back(b.segment);
      if (a.x == b.x) continue;
      if (b.x - a.x <= 1e-6f * (std::abs(a.x) + std::abs(a.y)) && (free(a) || free(b))) {
        const End &moved = free(a) ? a : b, &kept = free(a) ? b : a;
        SegmentRecord& s = made_[moved.segment];
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
      const bool arrives = (made_[a.segment].side > 0) == a.bottom;
      s.side = arrives ? 1.0f : -1.0f;
      order_.push_back(static_cast<uint32_t>(made_.size()));
      made_.push_back(s);
    }
  }
  bool free(const End& e) const { // inside its curve
    const SegmentRecord& s = made_[e.segment];
    return e.bottom ? e.y < s.second.w : e.y > s.first.y;
  }

  const Drawing& drawing_;
  std::pmr::vector<SegmentRecord>& segments_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<Use> uses_;
  std::pmr::vector<Chain> chains_;
  std::pmr::vector<Rise> rises_;
  std::pmr::vector<SegmentRecord> made_; // of the path
  std::pmr::vector<End> ends_;           // of these
  std::pmr::vector<uint32_t> order_;     // in which they are kept
};

} // namespace

namespace {
/// `base`: outlines that are taken over for paths whose `edited` is 0; NULL: none.
Outlines outlinesOf(const Drawing& drawing, const Outlines* base, std::span<const uint8_t> edited,
                    std::pmr::memory_resource* memory) {
  Outlines outlines(memory);
  PathOutline outline(drawing, outlines);
  outlines.segments.reserve(drawing.patches.size() * 3 / 2 + 4 * drawing.paths.size());
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
