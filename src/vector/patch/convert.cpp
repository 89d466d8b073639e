// The stages in a row, and the tables that the GPU reads.
#include "vector/patch/drawing.h"
#include "vector/patch/inversions.h"
#include "vector/patch/scratch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <optional>

namespace gpgp::vector {
namespace {

/// An arc as the cubic whose controls lie on its tangents, at the part of them that its weight says: from both the
/// rational quadratic that it is can be had again. Returns the weight.
double fitArc(const Ellipse& e, Cubic& arc) {
  const double turn = e.u.x * e.v.y - e.u.y * e.v.x;
  const auto angleOf = [&](Point p) {
    const Point q = p - e.center;
    return std::atan2(e.u.x * q.y - e.u.y * q.x, q.x * e.v.y - q.y * e.v.x); // both times `turn`
  };
  constexpr double kPi = 3.14159265358979323846;
  double a = angleOf(arc.p[0]), b = angleOf(arc.p[3]);
  if (turn < 0) a += kPi, b += kPi;
  if (b - a > kPi) b -= 2 * kPi;
  if (a - b > kPi) b += 2 * kPi;
  const double weight = std::cos(0.5 * (b - a)), middle = 0.5 * (a + b);
  if (!(weight > 1e-3 && weight < 1)) return 0;
  const Point meet = e.center + (1 / weight) * (std::cos(middle) * e.u + std::sin(middle) * e.v);
  const double part = 4 * weight / (3 * (1 + weight));
  arc.p[1] = arc.p[0] + part * (meet - arc.p[0]);
  arc.p[2] = arc.p[3] + part * (meet - arc.p[3]);
  return weight;
}

CurveRecord curveRecord(const Monotone& source, std::span<const Ellipse> ellipses) {
  Monotone piece = source;
  const double weight = piece.curve.arc ? fitArc(ellipses[piece.curve.arc - 1], piece.curve) : 0;
  const Point* p = piece.curve.p;
  const auto relative = [&](int i, double Point::*axis) { return static_cast<float>(p[i].*axis - p[0].*axis); };
  CurveRecord r{};
  r.ends = {static_cast<float>(p[0].x), static_cast<float>(p[0].y), relative(3, &Point::x), relative(3, &Point::y)};
  r.controls = {relative(1, &Point::x), relative(1, &Point::y), relative(2, &Point::x), relative(2, &Point::y)};
  r.bend = piece.curve.line ? -1.0f : static_cast<float>(piece.curve.bend());
  r.endX = static_cast<float>(p[3].x);
  r.endY = static_cast<float>(p[3].y);
  r.weight = static_cast<float>(weight);
  return r;
}

/// The next float above. What GPUs take for 0 is 0.
float above(double v) {
  const float f = static_cast<float>(v);
  const uint32_t bits = std::bit_cast<uint32_t>(f);
  const float next = f == 0 ? 0 : std::bit_cast<float>(f > 0 ? bits + 1 : bits - 1);
  return std::abs(next) < std::numeric_limits<float>::min() ? 0 : next;
}
float below(double v) { return -above(-v); }

core::Error tooManyPatches() {
  return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing needs more than %u patches", shader::kEntryPatch);
}

// With fewer pieces beside each other, conversion takes no time worth saving.
constexpr double kMany = 256;

/// Whether many pieces lie beside each other; where they do, how often they cross at least.
std::optional<size_t> crossingsOfMany(std::span<const Monotone> pieces, std::pmr::memory_resource* memory) {
  if (static_cast<double>(pieces.size()) < kMany) return {};
  double top = pieces[0].top(), bottom = pieces[0].bottom(), heights = 0;
  for (const Monotone& piece : pieces) {
    top = std::min(top, piece.top());
    bottom = std::max(bottom, piece.bottom());
    heights += piece.bottom() - piece.top();
  }
  if (!(heights > kMany * (bottom - top))) return {};
  return leastCrossings(pieces, top, bottom, 32, kMaxCrossings, memory);
}

/// Whether the outline of pieces, were each of their crossings a corner of it, would not fit.
bool mayOutgrow(std::span<const Monotone> pieces, const OutlineRoom& room, std::pmr::memory_resource* memory) {
  const auto crossings = crossingsOfMany(pieces, memory);
  // More are refused anyway, by themselves.
  return crossings && *crossings <= kMaxCrossings && !room.has(2 * uint64_t(*crossings));
}

/// Whether a path's lines and controls pass its rows so often that many pieces may lie beside each other.
bool maybeTangled(const GpgpPath& path) {
  if (path.stroke || path.verbCount < kMany || !path.points || !path.pointCount) return false;
  float low = path.points[1], high = low;
  double heights = 0;
  for (uint64_t i = 1; i < path.pointCount; ++i) {
    const float y = path.points[2 * i + 1];
    low = std::min(low, y), high = std::max(high, y);
    heights += static_cast<double>(std::abs(y - path.points[2 * i - 1]));
  }
  return heights > kMany * (static_cast<double>(high) - static_cast<double>(low));
}

struct TooMany {
  size_t path;
  core::Error error;
};
/// The first of several tangled paths with which they outgrow the room together, or cross themselves too often, as far
/// as that is known without converting them. Takes less than a tenth of the time that converting them takes.
std::optional<TooMany> firstTooMany(std::span<const GpgpPath> paths, const OutlineRoom& room,
                                    std::pmr::memory_resource* heap) {
  std::pmr::vector<size_t> tangled(heap);
  for (size_t i = 0; i < paths.size(); ++i)
    if (maybeTangled(paths[i])) tangled.push_back(i);
  if (tangled.size() < 2) return {};
  /// Calls work(pieces, rule, memory) for each of them until it says that this is enough.
  const auto find = [&](auto&& work) -> std::optional<size_t> {
    for (const size_t i : tangled) {
      Scratch scratch(heap);
      std::pmr::vector<Monotone> pieces(&scratch);
      if (!outline(paths[i], pieces)) return {}; // an error; conversion says which
      mergeCoincident(pieces);
      if (work(pieces, paths[i].fillRule, &scratch)) return i;
    }
    return {};
  };
  uint64_t crossings = 0;
  // Paths that cross themselves more often than one may are refused anyway, by themselves.
  const auto crossed = find([&](const auto& pieces, GpgpFillRule, auto* memory) {
    const size_t own = crossingsOfMany(pieces, memory).value_or(0);
    if (own <= kMaxCrossings) crossings += own;
    return !room.allowsCrossings(crossings);
  });
  if (crossed) return TooMany{*crossed, room.crossingsError()};
  if (room.has(2 * crossings)) return {}; // were each of them a corner
  const uint64_t places = std::min(kMostPlaces, 8 * kMostPlaces / tangled.size());
  uint64_t segments = 0;
  const auto outgrown = find([&](const auto& pieces, GpgpFillRule rule, auto* memory) {
    segments += leastSegments(pieces, rule, room.left(), memory, places);
    return !room.has(segments);
  });
  if (outgrown) return TooMany{*outgrown, room.error()};
  return {};
}

} // namespace

void addInk(const PatchRecord& patch, bool first, float (&bounds)[4]) {
  const float box[4] = {above(patch.x0), patch.top, below(patch.x1), patch.bottom};
  for (size_t side = 0; side < 4; ++side)
    bounds[side] = first ? box[side] : side < 2 ? std::min(bounds[side], box[side]) : std::max(bounds[side], box[side]);
}

core::Result<void> addPath(const GpgpPath& path, Drawing& drawing, OutlineRoom& room,
                           std::optional<core::Error>* tooMany) {
  Scratch scratch(drawing.curves.get_allocator().resource());
  std::pmr::memory_resource* memory = &scratch;
  std::pmr::vector<Monotone> pieces(memory);
  pieces.reserve(path.verbCount + path.verbCount / 2);
  std::pmr::vector<Ellipse> ellipses(memory);
  if (auto ok = outline(path, pieces, &ellipses); !ok) return ok;
  mergeCoincident(pieces);
  std::pmr::vector<Slab> slabs(memory);
  const GpgpFillRule rule = path.stroke ? GPGP_FILL_NON_ZERO : path.fillRule;
  if (mayOutgrow(pieces, room, memory) && !room.has(leastSegments(pieces, rule, room.left(), memory)))
    return room.error();
  const auto swept = [&]() -> core::Result<void> {
    std::pmr::vector<Cut> cuts(memory);
    if (auto ok = findCrossings(pieces, cuts); !ok) return ok;
    room.countCrossings(cuts.size() / 2); // each cuts two pieces
    return sweep(pieces, cuts, rule, slabs);
  }();
  if (!swept) {
    if (!tooMany) return swept;
    *tooMany = swept.error();
    slabs.clear();
  }
  if (slabs.size() + drawing.patches.size() > shader::kEntryPatch) return tooManyPatches();
  if (const size_t all = drawing.patches.size() + slabs.size(); all > drawing.patches.capacity())
    drawing.patches.reserve(std::max(all, 2 * drawing.patches.capacity()));
  constexpr uint32_t kNone = UINT32_MAX;
  std::pmr::vector<uint32_t> places(pieces.size(), kNone, memory);
  const auto place = [&](uint32_t piece) {
    if (places[piece] == kNone) {
      places[piece] = static_cast<uint32_t>(drawing.curves.size());
      drawing.curves.push_back(curveRecord(pieces[piece], ellipses));
    }
    return places[piece];
  };
  // A piece's slabs mostly follow each other, so where one ends is where the next begins.
  struct Last {
    float y;
    int side; ///< 1: the patch lies right of the piece, -1: left
    double x, t;
  };
  std::pmr::vector<Last> lasts(pieces.size(), Last{std::numeric_limits<float>::quiet_NaN(), 0, 0, 0}, memory);
  uint64_t segments = 0; // of the outline, but for level ones
  const auto segmentGoesOn = [&](uint32_t piece, float y, int side) {
    return lasts[piece].y == y && lasts[piece].side == side;
  };
  const auto known = [&](uint32_t piece, float y) { return lasts[piece].y == y; };
  /// Left's and right's x at the top and bottom of a slab, in this order.
  const auto corners = [&](const Slab& slab) {
    const Monotone &left = pieces[slab.left], &right = pieces[slab.right];
    std::array<double, 2> top{lasts[slab.left].x, lasts[slab.right].x}, t{lasts[slab.left].t, lasts[slab.right].t};
    const double y = static_cast<double>(slab.top);
    if (!known(slab.left, slab.top) && !known(slab.right, slab.top))
      top = xsNear(left, right, y, t);
    else if (!known(slab.left, slab.top))
      top[0] = left.xNear(y, t[0]);
    else if (!known(slab.right, slab.top))
      top[1] = right.xNear(y, t[1]);
    const auto bottom = xsNear(left, right, static_cast<double>(slab.bottom), t);
    segments += !segmentGoesOn(slab.left, slab.top, 1);
    segments += !segmentGoesOn(slab.right, slab.top, -1);
    lasts[slab.left] = {slab.bottom, 1, bottom[0], t[0]};
    lasts[slab.right] = {slab.bottom, -1, bottom[1], t[1]};
    return std::array{top, bottom};
  };
  const uint32_t pathIndex = static_cast<uint32_t>(drawing.paths.size());
  // Neighbours in the list share boxes at the raster's upper level, so the order of the sweep is kept.
  for (const Slab& slab : slabs) {
    PatchRecord p{};
    p.left = place(slab.left);
    p.right = place(slab.right);
    p.top = slab.top;
    p.bottom = slab.bottom;
    const auto [top, bottom] = corners(slab);
    p.x0 = below(std::min(top[0], bottom[0]));
    p.x1 = above(std::max(top[1], bottom[1]));
    p.path = pathIndex;
    drawing.patches.push_back(p);
    addInk(p, drawing.patches.size() == 1, drawing.bounds);
  }
  if (!room.take(segments)) return room.error();
  PathRecord record{};
  record.color = {path.color[0], path.color[1], path.color[2], path.color[3]};
  if (path.gradient) {
    const auto paint = addGradient(*path.gradient, drawing);
    if (!paint) return paint.error();
    record.paint = 1 + *paint;
  }
  if (path.image) {
    if (path.gradient) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "both gradient and image are given");
    const auto paint = addImage(*path.image, drawing);
    if (!paint) return paint.error();
    record.paint = 1 + *paint;
  }
  drawing.paths.push_back(record);
  return {};
}

core::Result<void> append(const Drawing& part, Drawing& drawing) {
  if (part.patches.size() + drawing.patches.size() > shader::kEntryPatch) return tooManyPatches();
  const uint32_t curve = static_cast<uint32_t>(drawing.curves.size()),
                 path = static_cast<uint32_t>(drawing.paths.size()),
                 paint = static_cast<uint32_t>(drawing.paints.size()),
                 stop = static_cast<uint32_t>(drawing.stops.size());
  drawing.curves.insert(drawing.curves.end(), part.curves.begin(), part.curves.end());
  drawing.stops.insert(drawing.stops.end(), part.stops.begin(), part.stops.end());
  for (size_t k = 0; k < 4 && !part.patches.empty(); ++k)
    drawing.bounds[k] = drawing.patches.empty() ? part.bounds[k]
                        : k < 2                 ? std::min(drawing.bounds[k], part.bounds[k])
                                                : std::max(drawing.bounds[k], part.bounds[k]);
  for (PatchRecord p : part.patches) {
    p.left += curve;
    p.right += curve;
    p.path += path;
    drawing.patches.push_back(p);
  }
  for (PathRecord p : part.paths) {
    if (p.paint) p.paint += paint;
    drawing.paths.push_back(p);
  }
  for (PaintRecord p : part.paints) {
    if (p.kind != shader::kPaintImage) p.firstStop += stop;
    drawing.paints.push_back(p);
  }
  return {};
}

namespace {

/// The error of a path.
core::Error refused(size_t path, const core::Error& error, std::pmr::vector<LeftEmpty>* leftEmpty) {
  if (leftEmpty) leftEmpty->push_back({0, path, error, true});
  return core::makeError(error.code, "paths[%zu]: %s", path, error.text);
}

core::Result<Drawing> convert(std::span<const GpgpPath> paths, size_t first, OutlineRoom& room,
                              std::pmr::memory_resource* memory, std::pmr::vector<LeftEmpty>* leftEmpty) {
  Drawing drawing(memory);
  drawing.paths.reserve(paths.size());
  size_t verbs = 0;
  for (const GpgpPath& path : paths) verbs += path.verbCount;
  drawing.curves.reserve(verbs + verbs / 4); // what most need, so that little is copied while they grow
  drawing.patches.reserve(verbs + verbs / 4);
  for (size_t i = 0; i < paths.size(); ++i) {
    if (!room.has(0)) return refused(first + i, room.error(), leftEmpty); // others have taken it
    if (!room.allowsCrossings(0)) return refused(first + i, room.crossingsError(), leftEmpty);
    std::optional<core::Error> tooMany;
    if (auto ok = addPath(paths[i], drawing, room, leftEmpty ? &tooMany : nullptr); !ok)
      return refused(first + i, ok.error(), leftEmpty);
    if (tooMany) leftEmpty->push_back({0, first + i, *tooMany});
  }
  return drawing;
}

/// Paths in a row with about as many verbs as others.
struct Batch {
  std::span<const GpgpPath> paths;
  size_t first;
  OutlineRoom* room;
  std::pmr::memory_resource* memory;
  bool mayLeaveEmpty;
  std::pmr::vector<LeftEmpty> leftEmpty;
  std::optional<core::Result<Drawing>> made;

  static void GPGP_CALL run(void* batches, uint32_t index) {
    Batch& b = static_cast<Batch*>(batches)[index];
    try {
      b.made.emplace(convert(b.paths, b.first, *b.room, b.memory, b.mayLeaveEmpty ? &b.leftEmpty : nullptr));
    } catch (...) { // bad_alloc; nothing else is thrown. An engine's job must not see it
      b.made.reset();
    }
  }
};

} // namespace

core::Result<Drawing> makeDrawing(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory,
                                  const GpgpJobSystem* jobs, std::pmr::vector<LeftEmpty>* leftEmpty, size_t first,
                                  OutlineRoom* given) {
  OutlineRoom own;
  OutlineRoom& room = given ? *given : own;
  if (const auto tooMany = firstTooMany(paths, room, memory))
    return refused(first + tooMany->path, tooMany->error, leftEmpty);
  constexpr uint64_t kVerbsOfBatch = 1000; // some tenths of a millisecond
  core::Result<Drawing> drawing = Drawing(memory);
  std::pmr::vector<Batch> batches(memory);
  if (jobs && jobs->parallelFor) {
    uint64_t verbs = kVerbsOfBatch;
    for (size_t i = 0; i < paths.size(); ++i) {
      if (verbs >= kVerbsOfBatch) {
        batches.push_back({paths.subspan(i, 0),
                           first + i,
                           &room,
                           memory,
                           leftEmpty != nullptr,
                           std::pmr::vector<LeftEmpty>(memory),
                           {}});
        verbs = 0;
      }
      const size_t begin = batches.back().first - first;
      batches.back().paths = paths.subspan(begin, i + 1 - begin);
      verbs += paths[i].verbCount;
    }
  }
  if (batches.size() > 1) {
    jobs->parallelFor(jobs->userData, static_cast<uint32_t>(batches.size()), Batch::run, batches.data());
    for (const Batch& batch : batches) {
      if (!batch.made) throw std::bad_alloc();
      if (leftEmpty) leftEmpty->insert(leftEmpty->end(), batch.leftEmpty.begin(), batch.leftEmpty.end());
      if (!*batch.made) return batch.made->error();
      if (auto ok = append(**batch.made, *drawing); !ok) return ok.error();
    }
  } else {
    drawing = convert(paths, first, room, memory, leftEmpty);
    if (!drawing) return drawing;
  }
  drawing->viewport[0] = drawing->bounds[0];
  drawing->viewport[1] = drawing->bounds[1];
  drawing->viewport[2] = drawing->bounds[2] - drawing->bounds[0];
  drawing->viewport[3] = drawing->bounds[3] - drawing->bounds[1];
  return drawing;
}

} // namespace gpgp::vector
