// The CPU reference of place's bins, sift and split: which paths a tile's list has, and which shader takes the tile.
#include "vector/cpu_reference/cpu_reference.h"

#include <algorithm>

namespace gpgp::vector {
using shader::ItemRecord;
using shader::kItemGrouped;
using shader::kShapeSlot;
using shader::PlacedPath;

namespace {

/// What a path does to a tile.
struct Touch {
  bool edges = false, inside = false;
  bool any() const { return edges || inside; }
  bool all() const { return inside && !edges; }
};

Touch touchOf(const CpuPlaces& places, uint32_t path, uint32_t x, uint32_t y) {
  const PlacedPath& p = places.paths[path];
  if (x < p.left || x >= p.right || y < p.top || y >= p.bottom) return {};
  const uint32_t column = x - p.left, bit = 1u << (column & 31);
  const shader::TileWord& word = places.words[p.firstWord + (y - p.top) * ((p.right - p.left + 31) / 32) + column / 32];
  return {(word.edges & bit) != 0, (word.inside & bit) != 0};
}

enum class Shown { hidden, even, rich };

/// What clips leave of a tile, and whether the path needs the general shader there.
Shown shownIn(const CpuInput& input, const CpuPlaces& places, const PlacedPath& p, uint32_t x, uint32_t y) {
  constexpr uint32_t kManyClipPaths = 64; // as in lists.glsl
  const ItemRecord& item = places.items[p.item];
  if (p.paint && item.perspective.w > 0) return Shown::rich;
  Shown found = Shown::even;
  const auto clip = [&](bool hidden, bool whole) {
    if (hidden)
      found = Shown::hidden;
    else if (!whole && found == Shown::even)
      found = Shown::rich;
  };
  if (const uint32_t own = p.group & ~kItemGrouped) {
    if (input.word(item.slot, own - 1, 2)) return Shown::rich; // a group that fades
    for (uint32_t k = input.word(item.slot, own - 1, 1); k;) {
      const size_t at = input.slots(item.slot).clips + k - 1;
      const uint32_t first = input.word(item.slot, at, 0), count = input.word(item.slot, at, 1);
      if (count > kManyClipPaths) return Shown::rich;
      Touch all; // their union: whole where the first one that is, or else the last one that touches, says so
      for (uint32_t i = 0; i < count && !all.all(); ++i) {
        const Touch touch = touchOf(places, item.firstPath + first + i, x, y);
        if (touch.any()) all = touch;
      }
      clip(!all.any(), all.all());
      if (found == Shown::hidden) return found;
      k = input.word(item.slot, at, 2);
    }
  }
  if ((p.group & kItemGrouped) == 0) return found;
  if (item.layer) found = Shown::rich;
  for (uint32_t k = item.clip; k;) {
    const size_t at = input.slots(kShapeSlot).clips + k - 1;
    const Touch touch = touchOf(places, input.word(kShapeSlot, at, 0), x, y);
    clip(!touch.any(), touch.all());
    if (found == Shown::hidden) return found;
    k = input.word(kShapeSlot, at, 1);
  }
  return found;
}

/// Calls visit(path) for those that paint, front to back, until it says that that is all.
template <class Visit> void frontToBack(const CpuPlaces& places, Visit&& visit) {
  for (uint32_t i = static_cast<uint32_t>(places.paths.size()); i > 0; --i)
    if (places.paths[i - 1].color.w > 0 && visit(i - 1)) return;
}

} // namespace

std::vector<CpuList> listOnCpu(const CpuInput& input, const CpuPlaces& places, uint32_t room) {
  const bool split = input.header.flags & shader::kSplitRich;
  std::vector<CpuList> lists;
  for (uint32_t y = 0; y < input.header.tilesY; ++y)
    for (uint32_t x = 0; x < input.header.tilesX; ++x) {
      CpuList& list = lists.emplace_back();
      bool full = false, painted = false, soft = false, rich = false;
      frontToBack(places, [&](uint32_t i) {
        const PlacedPath& p = places.paths[i];
        const Touch touch = touchOf(places, i, x, y);
        if (!touch.any()) return false;
        Shown shown = Shown::even;
        if (split && (p.paint || p.group)) shown = shownIn(input, places, p, x, y);
        if (shown == Shown::hidden) return false;
        full = list.paths.size() == room;
        if (full) return true;
        list.paths.push_back({i, touch.edges, touch.inside});
        const bool painting = split ? p.paint != 0 : (p.paint | p.group) != 0;
        painted = painted || painting || touch.edges;
        soft = soft || painting || p.color.w != 1;
        rich = rich || shown == Shown::rich;
        return !painting && p.color.w >= 1 && touch.all() && shown != Shown::rich;
      });
      list.kind = full       ? CpuList::crowded
                  : rich     ? CpuList::rich
                  : !painted ? CpuList::solid
                  : soft     ? CpuList::pixels
                             : CpuList::rows;
    }
  return lists;
}

std::vector<bool> splitOnCpu(const CpuInput& input, const CpuPlaces& places) {
  std::vector<bool> rich;
  for (uint32_t y = 0; y < input.header.tilesY; ++y)
    for (uint32_t x = 0; x < input.header.tilesX; ++x) {
      bool general = false;
      frontToBack(places, [&](uint32_t i) {
        const PlacedPath& p = places.paths[i];
        const Touch touch = touchOf(places, i, x, y);
        if ((p.group | p.paint) == 0) return p.color.w >= 1 && touch.all();
        general = touch.any() && shownIn(input, places, p, x, y) == Shown::rich;
        return general;
      });
      rich.push_back(general);
    }
  return rich;
}

std::vector<std::vector<uint32_t>> binOnCpu(const CpuInput& input, const CpuPlaces& places) {
  const shader::CanvasHeader& header = input.header;
  std::vector<std::vector<uint32_t>> bins(header.binCount);
  frontToBack(places, [&](uint32_t i) {
    const PlacedPath& p = places.paths[i];
    if (p.left == p.right || p.top == p.bottom) return false;
    for (uint32_t y = p.top >> header.binShift; y <= (p.bottom - 1) >> header.binShift; ++y)
      for (uint32_t x = p.left >> header.binShift; x <= (p.right - 1) >> header.binShift; ++x)
        bins[y * header.binsX + x].push_back(i);
    return false;
  });
  return bins;
}

} // namespace gpgp::vector
