#include "vector/raster/glyph_set.h"

#include "vector/patch/patches.h"
#include "vector/raster/drawing_asset.h"
#include "vector/raster/segments.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

namespace gpgp::vector {
namespace {
using shader::BoxedPath;
using shader::SegmentRecord;
constexpr uint32_t kSegmentSize = sizeof(SegmentRecord) / 16, kPathSize = sizeof(BoxedPath) / 16; // vec4
constexpr uint32_t kPaintSize = sizeof(PaintRecord) / 16, kStopSize = sizeof(StopRecord) / 16;
constexpr uint32_t kDefaultGlyphs = 4096;
constexpr VkDeviceSize kDefaultBytes = VkDeviceSize(8) << 20;
constexpr uint32_t kGenerations = 1u << (32 - GlyphSet::kPlaceBits);

uint32_t countPaints(const Drawing& drawing, size_t firstPath, size_t end) {
  uint32_t count = 0;
  for (size_t i = firstPath; i < end; ++i) count += drawing.paths[i].paint != 0;
  return count;
}
uint32_t divide(uint32_t a, uint32_t b) { return (a + b - 1) / b; }
} // namespace

/// The outlines of glyphs in a row, and how many segments and vec4 of gradients there are up to the end of
/// each path; and the glyphs' patches.
struct GlyphSet::Tables {
  Outlines outlines;
  std::pmr::vector<uint64_t> gradients;
  std::pmr::vector<shader::uvec4> words;
  std::pmr::vector<uint64_t> wordEnds; ///< by glyph

  Tables(const Glyphs& glyphs, GpgpDrawingMethods methods, core::Context& context)
      : Tables(glyphs.drawing, (methods & GPGP_DRAWING_FLATTENED) != 0, &context.host()) {
    if (!(methods & GPGP_DRAWING_IN_PASS)) return;
    uint32_t path = 0;
    for (const Glyphs::Entry& entry : glyphs.entries) {
      const auto patches = makePatches(glyphs.drawing, &context.host(), kPatchCurves, path, entry.paths);
      path += entry.paths;
      if (patches)
        words.insert(words.end(), patches->words.begin(), patches->words.end());
      else
        context.message(GPGP_SEVERITY_WARNING, patches.error().code, "gpgpAddGlyphs", nullptr, patches.error().text);
      wordEnds.push_back(words.size());
    }
  }
  uint64_t wordsBefore(size_t glyph) const { return glyph && !wordEnds.empty() ? wordEnds[glyph - 1] : 0; }
  uint64_t wordsOf(size_t glyph) const { return wordEnds.empty() ? 0 : wordEnds[glyph] - wordsBefore(glyph); }
  const bool flattened;

private:
  Tables(const Drawing& drawing, bool flat, std::pmr::memory_resource* memory)
      : outlines(flat ? makeOutlines(drawing, memory) : Outlines(memory)), gradients(drawing.paths.size(), 0, memory),
        words(memory), wordEnds(memory), flattened(flat) {
    if (!flat) return;
    for (size_t i = 0; i < gradients.size(); ++i) {
      if (const uint32_t paint = drawing.paths[i].paint)
        gradients[i] = kPaintSize + uint64_t(drawing.paints[paint - 1].stopCount) * kStopSize;
      if (i) gradients[i] += gradients[i - 1];
    }
  }

public:
  uint32_t segmentsBefore(size_t path) const { return path && flattened ? outlines.ends[path - 1] : 0; }
  uint64_t gradientsOf(size_t path, uint32_t paths) const {
    return paths ? gradients[path + paths - 1] - (path ? gradients[path - 1] : 0) : 0;
  }
  uint64_t outlinesOf(size_t path, uint32_t paths) const { // vec4
    if (!flattened) return 0;
    const uint64_t painted = gradientsOf(path, paths), segments = segmentsBefore(path + paths) - segmentsBefore(path);
    return segments * kSegmentSize + uint64_t(paths) * kPathSize + (painted ? painted + kPaintSize - 1 : 0);
  }
  uint64_t sizeOf(size_t glyph, size_t path, uint32_t paths) const { return outlinesOf(path, paths) + wordsOf(glyph); }
};

GlyphSet::GlyphSet(core::Context& owner, const char* name)
    : Resident(owner, core::Kind::glyphSet, name), glyphs_(&owner.host()), places_(&owner.host()),
      cells_(&owner.host()), freeBlocks_(&owner.host()) {}

core::Result<core::Unique<GlyphSet>> GlyphSet::create(core::Context& context, const GpgpGlyphSetCreateInfo& info,
                                                      std::span<const std::byte> bytes) {
  if (info.methods & GPGP_DRAWING_PATCHES)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "glyph sets have no GPGP_DRAWING_PATCHES: canvases flatten text");
  if (auto ok = checkMethods(info.methods); !ok) return ok.error();
  std::optional<Glyphs> baked;
  if (info.data || info.filePath) {
    auto loaded = loadBakedGlyphs(bytes, &context.host());
    if (!loaded) return loaded.error();
    baked.emplace(std::move(*loaded));
  }
  const GpgpDrawingMethods methods = info.methods ? info.methods : GPGP_DRAWING_FLATTENED;
  const size_t bakedGlyphs = baked ? baked->entries.size() : 0;
  VkDeviceSize bakedBytes = 0;
  std::optional<Tables> tables;
  if (baked) {
    tables.emplace(*baked, methods, context);
    size_t path = 0;
    for (size_t i = 0; i < bakedGlyphs; ++i) {
      bakedBytes += tables->sizeOf(i, path, baked->entries[i].paths) * 16;
      path += baked->entries[i].paths;
    }
  }
  const size_t maxGlyphs = info.maxGlyphs ? info.maxGlyphs : baked ? std::max<size_t>(bakedGlyphs, 1) : kDefaultGlyphs;
  const VkDeviceSize maxBytes = info.maxBytes ? info.maxBytes : baked ? bakedBytes : kDefaultBytes;
  if (maxGlyphs > kMaxGlyphs)
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "%zu glyphs; a set has at most %u", maxGlyphs, kMaxGlyphs);
  if (bakedGlyphs > maxGlyphs || bakedBytes > maxBytes / 16 * 16)
    return core::makeError(
        GPGP_ERROR_INVALID_ARGUMENT, "the baked glyphs need maxGlyphs %zu and maxBytes %llu; they are %zu and %llu",
        bakedGlyphs, static_cast<unsigned long long>(bakedBytes), maxGlyphs, static_cast<unsigned long long>(maxBytes));
  auto set = core::makeUnique<GlyphSet>(context.host(), context, info.label);
  set->methods_ = methods;
  set->glyphs_ = std::pmr::vector<Glyph>(maxGlyphs, &context.host());
  for (size_t i = maxGlyphs; i > 0; --i) {
    set->glyphs_[i - 1].generation = 1;
    set->places_.push_back(static_cast<uint32_t>(i - 1));
  }
  set->cells_.resize(std::bit_ceil(2 * maxGlyphs), kNone);
  set->capacity_ = static_cast<uint32_t>(maxBytes / 16);
  set->freeBlocks_.reserve(maxGlyphs + 2);
  set->freeBlocks_.push_back({0, set->capacity_});
  if (auto ok = set->makeGrowing(GPGP_SERVICE_VECTOR, maxBytes, Room::shared); !ok) return ok.error();
  if (baked) set->add(*baked, *tables, 0);
  return set;
}

bool GlyphSet::evictable(const Glyph& glyph) const {
  return glyph.living && glyph.lastUsed <= context.safe() && hasSettled(glyph.upload);
}

bool GlyphSet::add(const Glyphs& glyphs, uint64_t frame) {
  return add(glyphs, Tables(glyphs, methods_, context), frame);
}

bool GlyphSet::add(const Glyphs& glyphs, const Tables& tables, uint64_t frame) {
  std::pmr::memory_resource* memory = &context.host();
  std::pmr::vector<uint32_t> added(memory);
  added.reserve(glyphs.entries.size());
  reserveRanges(glyphs.entries.size());
  struct Candidate {
    uint64_t lastUsed;
    uint32_t place;
  };
  std::pmr::vector<Candidate> candidates(memory); // for eviction, in that order; gathered where room is wanted
  candidates.reserve(glyphs.entries.empty() ? 0 : glyphs_.size()); // below, nothing may fail
  size_t taken = 0;
  bool gathered = false;
  uint64_t room = capacity_ - used_; // free, and what could be
  const auto gather = [&] {
    gathered = true;
    for (uint32_t i = 0; i < glyphs_.size(); ++i)
      if (evictable(glyphs_[i])) {
        candidates.push_back({glyphs_[i].lastUsed, i});
        room += glyphs_[i].size;
      }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.lastUsed != b.lastUsed ? a.lastUsed < b.lastUsed : a.place < b.place;
    });
  };

  uint64_t missing = 0, missingSize = 0;
  size_t path = 0;
  for (const Glyphs::Entry& entry : glyphs.entries) {
    const size_t firstPath = path;
    path += entry.paths;
    if (cells_[cellOf(entry.key)] != kNone) continue;
    const size_t index = static_cast<size_t>(&entry - glyphs.entries.data());
    const uint64_t wanted = tables.sizeOf(index, firstPath, entry.paths);
    const uint32_t size = static_cast<uint32_t>(std::min<uint64_t>(wanted, kNone)); // no block is as large as that
    uint32_t block = kNone;
    while (places_.empty() || (block = takeBlock(size)) == kNone) {
      if (!gathered) gather();
      if (taken == candidates.size() || room < size) break;
      remove(candidates[taken++].place);
      ++evicted_;
    }
    if (block == kNone) {
      ++missing;
      missingSize += wanted;
      continue;
    }
    room -= size;
    const uint32_t place = places_.back();
    places_.pop_back();
    cells_[cellOf(entry.key)] = place;
    Glyph& glyph = glyphs_[place];
    glyph.first = block;
    glyph.size = size;
    const uint32_t firstSegment = tables.segmentsBefore(firstPath);
    glyph.segments = tables.segmentsBefore(path) - firstSegment;
    glyph.paths = tables.flattened ? entry.paths : 0;
    glyph.patches = block + static_cast<uint32_t>(tables.outlinesOf(firstPath, entry.paths));
    glyph.quads = {};
    if (const size_t count = tables.wordsOf(index)) {
      const auto words = std::span(tables.words).subspan(tables.wordsBefore(index), count);
      glyph.quads = quadsOf(words);
      std::memcpy(bytes().data() + size_t(glyph.patches) * 16, words.data(), words.size_bytes());
    }
    glyph.living = true;
    glyph.gradients = tables.flattened && tables.gradientsOf(firstPath, entry.paths) > 0;
    glyph.use(frame);
    glyph.upload = 0;
    glyph.key = entry.key;
    std::byte* to = bytes().data() + size_t(block) * 16;
    for (uint32_t i = 0; i < glyph.segments; ++i, to += sizeof(SegmentRecord)) {
      SegmentRecord segment = tables.outlines.segments[firstSegment + i];
      segment.path -= static_cast<uint32_t>(firstPath);
      std::memcpy(to, &segment, sizeof segment);
    }
    // Gradients are counted from the buffer's beginning, as records of their size.
    uint32_t paint = divide(block + glyph.segments * kSegmentSize + glyph.paths * kPathSize, kPaintSize);
    uint32_t stop = (paint + countPaints(glyphs.drawing, firstPath, path)) * (kPaintSize / kStopSize);
    if (glyph.paths == 1) {
      const shader::vec4& box = tables.outlines.boxes[firstPath];
      glyph.middle = {0.5f * (box.x + box.z), 0.5f * (box.y + box.w)};
      glyph.reach = {0.5f * (box.z - box.x), 0.5f * (box.w - box.y)};
    } else {
      glyph.reach = shader::vec2(std::numeric_limits<float>::infinity());
    }
    glyph.ink = {3e38f, 3e38f, -3e38f, -3e38f};
    for (size_t i = firstPath; i < path && tables.flattened; ++i) {
      const shader::vec4& box = tables.outlines.boxes[i];
      if (box.x <= box.z)
        glyph.ink = {std::min(glyph.ink.x, box.x), std::min(glyph.ink.y, box.y), std::max(glyph.ink.z, box.z),
                     std::max(glyph.ink.w, box.w)};
    }
    for (size_t i = firstPath; i < path && tables.flattened; ++i, to += sizeof(BoxedPath)) {
      BoxedPath boxed{tables.outlines.boxes[i], glyphs.drawing.paths[i]};
      if (boxed.path.paint) {
        PaintRecord record = glyphs.drawing.paints[boxed.path.paint - 1];
        const auto stops = std::span(glyphs.drawing.stops).subspan(record.firstStop, record.stopCount);
        record.firstStop = stop;
        std::memcpy(bytes().data() + size_t(paint) * sizeof record, &record, sizeof record);
        std::memcpy(bytes().data() + size_t(stop) * sizeof(StopRecord), stops.data(), stops.size_bytes());
        stop += record.stopCount;
        boxed.path.paint = ++paint;
      }
      std::memcpy(to, &boxed, sizeof boxed);
    }
    if (size) added.push_back(place);
  }
  queueBlocks(added);
  neededGlyphs_ = missing, needed_ = missingSize;
  for (const Glyph& glyph : glyphs_)
    if (glyph.living && !evictable(glyph)) {
      ++neededGlyphs_;
      needed_ += glyph.size;
    }
  return missing == 0;
}

void GlyphSet::queueBlocks(std::span<const uint32_t> places) {
  for (size_t i = 0; i < places.size();) { // those that lie in a row go as one
    const uint32_t first = glyphs_[places[i]].first;
    uint32_t end = first;
    size_t last = i;
    for (; last < places.size() && glyphs_[places[last]].first == end; ++last) end += glyphs_[places[last]].size;
    const uint64_t number = queue(VkDeviceSize(first) * 16, VkDeviceSize(end - first) * 16);
    for (; i < last; ++i) glyphs_[places[i]].upload = number;
  }
}

uint32_t GlyphSet::indexOf(uint64_t key) {
  const uint32_t place = cells_[cellOf(key)];
  if (place == kNone) return GPGP_GLYPH_NONE;
  glyphs_[place].use(context.current());
  return place | glyphs_[place].generation << kPlaceBits;
}

void GlyphSet::getInfo(GpgpGlyphSetInfo& info) const {
  info.maxGlyphs = static_cast<uint32_t>(glyphs_.size());
  info.glyphs = static_cast<uint32_t>(glyphs_.size() - places_.size());
  info.bytes = VkDeviceSize(used_) * 16;
  info.maxBytes = VkDeviceSize(capacity_) * 16;
  info.evicted = evicted_;
  info.glyphsNeeded = static_cast<uint32_t>(neededGlyphs_);
  info.bytesNeeded = needed_ * 16;
}

namespace {
size_t homeOf(uint64_t key, size_t cells) { // the upper bits of the product depend on all of the key's
  return static_cast<size_t>(key * 0x9e3779b97f4a7c15u >> 32) & (cells - 1);
}
} // namespace

size_t GlyphSet::cellOf(uint64_t key) const {
  size_t cell = homeOf(key, cells_.size());
  while (cells_[cell] != kNone && glyphs_[cells_[cell]].key != key) cell = (cell + 1) & (cells_.size() - 1);
  return cell;
}

void GlyphSet::remove(uint32_t place) {
  Glyph& glyph = glyphs_[place];
  const size_t mask = cells_.size() - 1;
  size_t hole = cellOf(glyph.key);
  cells_[hole] = kNone;
  for (size_t cell = (hole + 1) & mask; cells_[cell] != kNone; cell = (cell + 1) & mask) {
    const size_t home = homeOf(glyphs_[cells_[cell]].key, cells_.size());
    if (((cell - home) & mask) < ((cell - hole) & mask)) continue; // it would lie before its home
    cells_[hole] = cells_[cell];
    cells_[cell] = kNone;
    hole = cell;
  }
  freeBlock({glyph.first, glyph.size});
  glyph.living = false;
  glyph.generation = glyph.generation + 1 == kGenerations ? 1 : glyph.generation + 1;
  places_.push_back(place);
}

uint32_t GlyphSet::takeBlock(uint32_t size) {
  if (size == 0) return 0;
  for (Block& block : freeBlocks_) {
    if (block.size < size) continue;
    const uint32_t first = block.first;
    block.first += size;
    block.size -= size;
    if (block.size == 0) freeBlocks_.erase(freeBlocks_.begin() + (&block - freeBlocks_.data()));
    used_ += size;
    return first;
  }
  return kNone;
}

void GlyphSet::freeBlock(Block block) {
  if (block.size == 0) return;
  used_ -= block.size;
  auto after = std::lower_bound(freeBlocks_.begin(), freeBlocks_.end(), block,
                                [](const Block& a, const Block& b) { return a.first < b.first; });
  if (after != freeBlocks_.end() && block.first + block.size == after->first) {
    block.size += after->size;
    after = freeBlocks_.erase(after);
  }
  if (after != freeBlocks_.begin() && (after - 1)->first + (after - 1)->size == block.first)
    (after - 1)->size += block.size;
  else
    freeBlocks_.insert(after, block);
}

} // namespace gpgp::vector
