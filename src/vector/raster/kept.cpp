#include "vector/raster/kept.h"

#include <algorithm>

namespace gpgp::vector {
namespace {
constexpr uint32_t kNone = UINT32_MAX;
constexpr uint32_t kProbes = 64; // of match()'s table: where many things are equal, some count as changed

/// Whether `is` holds for one of the words that a box has bits in. Takes a word's index and the box's bits in it.
template <class Is> bool anyWord(const TileBox& box, uint32_t inRow, const Is& is) {
  if (box.left >= box.right) return false;
  const uint32_t first = box.left / 32u, last = (box.right - 1u) / 32u;
  for (uint32_t row = box.top; row < box.bottom; ++row)
    for (uint32_t word = first; word <= last; ++word) {
      uint32_t bits = ~0u;
      if (word == first) bits &= ~0u << (box.left & 31u);
      if (word == last) bits &= ~0u >> (31u - ((box.right - 1u) & 31u));
      if (is(size_t(row) * inRow + word, bits)) return true;
    }
  return false;
}
} // namespace

KeptRecording::KeptRecording(uint32_t most, std::pmr::memory_resource* memory)
    : most_(most), last_(most, memory), next_(most, memory), cells_(std::bit_ceil(2 * size_t(most)), memory),
      matches_(most, memory), runs_(most, memory), before_(most, memory) {}

void KeptRecording::begin(uint32_t tilesX, uint32_t tilesY, std::span<uint32_t> damage) {
  tilesX_ = tilesX;
  tilesY_ = tilesY;
  inRow_ = (tilesX + 31) / 32;
  fits_ = tilesX == lastX_ && tilesY == lastY_;
  bits_ = damage.first(damageWords(tilesX, tilesY));
  next_.count = cursor_ = missed_ = damaged_ = 0;
}

/// A thing of before with the hash, which mostly lies near the one that was found last.
const KeptRecording::Thing* KeptRecording::find(uint64_t hash) {
  constexpr uint32_t kNear = 8;
  if (!fits_) return nullptr; // boxes were those of another canvas
  const uint32_t from = cursor_ - std::min(cursor_, kNear), to = std::min(cursor_ + kNear, last_.count);
  if (cursor_ < last_.count && last_.things[cursor_].hash == hash) return &last_.things[cursor_++];
  for (uint32_t i = from; i < to; ++i)
    if (last_.things[i].hash == hash) {
      cursor_ = i + 1;
      return &last_.things[i];
    }
  ++cursor_;
  return nullptr;
}

void KeptRecording::mark(const TileBox& box) {
  anyWord(box, inRow_, [&](size_t word, uint32_t bits) {
    bits_[word] |= bits;
    return false;
  });
}

bool KeptRecording::meets(const TileBox& box) const {
  return anyWord(box, inRow_, [&](size_t word, uint32_t bits) { return (bits_[word] & bits) != 0; });
}

/// Marks what is not in a longest sequence that things from `begin` on have in common with those of before.
void KeptRecording::match(uint32_t begin, uint32_t lastEnd, uint32_t nextEnd) {
  const size_t mask = cells_.size() - 1;
  std::fill(cells_.begin(), cells_.end(), 0u);
  for (uint32_t i = begin; i < lastEnd; ++i) { // equal ones in their order, as each is put behind those that are there
    size_t cell = last_.things[i].hash & mask, probes = 0;
    while (cells_[cell] && ++probes < kProbes) cell = (cell + 1) & mask;
    if (!cells_[cell]) cells_[cell] = i + 1;
  }
  // The longest increasing sequence of matches: runs_[k] ends the one of length k + 1 whose end is the smallest.
  uint32_t length = 0;
  for (uint32_t j = begin; j < nextEnd; ++j) {
    uint32_t& own = matches_[j] = kNone;
    const uint64_t hash = next_.things[j].hash;
    size_t cell = hash & mask;
    for (uint32_t probes = 0; cells_[cell] && own == kNone && probes < kProbes; ++probes, cell = (cell + 1) & mask) {
      if (cells_[cell] == kNone || last_.things[cells_[cell] - 1].hash != hash) continue;
      own = cells_[cell] - 1;
      cells_[cell] = kNone; // taken
    }
    if (own == kNone) continue;
    const auto at = std::lower_bound(runs_.begin(), runs_.begin() + length, own,
                                     [&](uint32_t thing, uint32_t value) { return matches_[thing] < value; });
    const auto place = static_cast<uint32_t>(at - runs_.begin());
    before_[j] = place ? runs_[place - 1] : kNone;
    *at = j;
    length = std::max(length, place + 1);
  }
  uint32_t i = lastEnd, j = nextEnd; // backwards along the longest one
  for (uint32_t thing = length ? runs_[length - 1] : kNone; thing != kNone; thing = before_[thing]) {
    while (--j != thing) mark(next_.things[j].box);
    while (--i != matches_[thing]) mark(last_.things[i].box);
  }
  while (j-- > begin) mark(next_.things[j].box);
  while (i-- > begin) mark(last_.things[i].box);
}

GpgpCanvasRedraw KeptRecording::compare(const Whole& whole, uint32_t brokenSince) {
  if (!valid_) return GPGP_CANVAS_REDRAW_FIRST;
  if (!fits_ || whole.settings != whole_.settings) return GPGP_CANVAS_REDRAW_SETTINGS;
  if (missed_) return GPGP_CANVAS_REDRAW_ROOM;
  if (!whole.complete || static_cast<int32_t>(brokenSince - redrawn_) >= 0) return GPGP_CANVAS_REDRAW_INCOMPLETE;
  if (whole.layers != whole_.layers) return GPGP_CANVAS_REDRAW_LAYERS;
  if (whole.shaders != whole_.shaders) return GPGP_CANVAS_REDRAW_SHADERS;
  const uint32_t common = std::min(last_.count, next_.count);
  uint32_t begin = 0, end = 0;
  while (begin < common && last_.things[begin].hash == next_.things[begin].hash) ++begin;
  const bool same = begin == last_.count && begin == next_.count;
  if (same) return GPGP_CANVAS_REDRAW_NONE;
  if (whole.layers) return GPGP_CANVAS_REDRAW_LAYERS; // pictures lie elsewhere, and filters carry what changed on
  while (end < common - begin && last_.things[last_.count - 1 - end].hash == next_.things[next_.count - 1 - end].hash)
    ++end;
  std::fill(bits_.begin(), bits_.end(), 0u);
  match(begin, last_.count - end, next_.count - end);
  for (const uint32_t bits : damage()) damaged_ += static_cast<uint32_t>(std::popcount(bits));
  return damaged_ > tilesX_ * tilesY_ / 2 ? GPGP_CANVAS_REDRAW_MOST : GPGP_CANVAS_REDRAW_NONE;
}

void KeptRecording::commit(const Whole& whole, bool redrawn) {
  std::swap(last_.things, next_.things);
  std::swap(last_.count, next_.count);
  whole_ = whole;
  lastX_ = tilesX_;
  lastY_ = tilesY_;
  if (redrawn) redrawn_ = whole.number;
  valid_ = whole.complete && missed_ == 0;
}

} // namespace gpgp::vector
