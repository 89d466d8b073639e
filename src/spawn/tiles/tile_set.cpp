#include "spawn/tiles/tile_set.h"

#include <algorithm>

namespace gpgp::spawn {
namespace {
constexpr uint32_t kMostUnit = 256; // a power of two: what aligns quads of 4-byte vertices with 16-bit indices to 1024
constexpr uint32_t kGenerations = (1u << 28) - 1;
constexpr VkDeviceSize kCommandBytes = sizeof(VkDrawIndexedIndirectCommand);

VkDeviceSize alignmentOf(const core::Device& device) {
  return std::max<VkDeviceSize>(device.limits.minStorageBufferOffsetAlignment, 4);
}
/// The least power of two of things of so many bytes whose size keeps offsets aligned.
uint32_t unitFor(VkDeviceSize bytes, VkDeviceSize alignment) {
  uint32_t unit = 1;
  while (unit < kMostUnit && (unit * bytes) % alignment) unit *= 2;
  return unit;
}
VkDeviceSize indexBytes(VkIndexType type) { return type == VK_INDEX_TYPE_UINT16 ? 2 : 4; }
} // namespace

// ---------------------------------------------------------------- free ranges

FreeRanges::FreeRanges(uint32_t size, uint32_t mostUsed, std::pmr::memory_resource* memory) : ranges_(memory) {
  ranges_.reserve(size_t(mostUsed) + 2); // one before each used range, one behind the last, one while two are joined
  if (size) ranges_.push_back({0, size});
}

void FreeRanges::cut(size_t at, Range range) {
  Range& free = ranges_[at];
  const Range behind{range.first + range.size, free.first + free.size - range.first - range.size};
  free.size = range.first - free.first;
  if (!free.size && !behind.size)
    ranges_.erase(ranges_.begin() + static_cast<std::ptrdiff_t>(at));
  else if (!free.size)
    free = behind;
  else if (behind.size)
    ranges_.insert(ranges_.begin() + static_cast<std::ptrdiff_t>(at) + 1, behind);
}

uint32_t FreeRanges::take(uint32_t size) {
  for (size_t at = 0; at < ranges_.size(); ++at) {
    if (ranges_[at].size < size) continue;
    const uint32_t first = ranges_[at].first;
    cut(at, {first, size});
    return first;
  }
  return UINT32_MAX;
}

void FreeRanges::takeAt(Range range) {
  for (size_t at = 0; at < ranges_.size(); ++at)
    if (ranges_[at].first <= range.first && range.first + range.size <= ranges_[at].first + ranges_[at].size)
      return cut(at, range);
}

void FreeRanges::give(Range range) {
  if (!range.size) return;
  auto next = std::upper_bound(ranges_.begin(), ranges_.end(), range.first,
                               [](uint32_t first, const Range& free) { return first < free.first; });
  if (next != ranges_.begin() && (next - 1)->first + (next - 1)->size == range.first) {
    --next;
    next->size += range.size;
  } else {
    next = ranges_.insert(next, range);
  }
  const auto behind = next + 1;
  if (behind == ranges_.end() || next->first + next->size != behind->first) return;
  next->size += behind->size;
  ranges_.erase(behind);
}

uint32_t FreeRanges::largest() const {
  uint32_t most = 0;
  for (const Range& range : ranges_) most = std::max(most, range.size);
  return most;
}

// ---------------------------------------------------------------- the set

VkDeviceSize TileSet::strideOf(const Spawner& spawner, const Grammar& grammar) {
  const VkDeviceSize alignment = alignmentOf(spawner.context.device);
  const VkDeviceSize bytes = kCommandBytes * (spawner.vertices() ? 1 : std::max(grammar.graph.buckets, 1u));
  return (bytes + alignment - 1) / alignment * alignment;
}

core::Result<core::Unique<TileSet>> TileSet::create(core::Context& context, const GpgpTileSetCreateInfo& info,
                                                    const Spawner& spawner, const Grammar& grammar) {
  if (info.maxTiles < 1 || info.maxTiles > kMostTiles)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxTiles is %u; expected 1 to %u", info.maxTiles, kMostTiles);
  const auto invalid = [](const char* what) { return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s", what); };
  const VkDeviceSize alignment = alignmentOf(context.device), stride = strideOf(spawner, grammar);
  const bool vertices = spawner.vertices();
  if (!info.draws.buffer) return invalid("draws.buffer is NULL");
  if (vertices ? !info.vertices.buffer : !info.instances.buffer)
    return invalid(vertices ? "vertices.buffer is NULL" : "instances.buffer is NULL");
  if (vertices ? info.instances.buffer != VK_NULL_HANDLE
               : info.vertices.buffer != VK_NULL_HANDLE || info.indices.buffer != VK_NULL_HANDLE)
    return invalid(vertices ? "instances.buffer is set; the spawner was made for vertices"
                            : "vertices.buffer or indices.buffer is set; the spawner was made for instances");
  if (vertices && info.indices.buffer && info.indexType != VK_INDEX_TYPE_UINT16 &&
      info.indexType != VK_INDEX_TYPE_UINT32)
    return invalid("indexType is neither UINT16 nor UINT32");
  for (const GpgpBuffer* buffer : {&info.instances, &info.vertices, &info.indices, &info.draws})
    if (buffer->size > UINT64_MAX - buffer->offset) return invalid("offset and size of a buffer exceed 64 bits");
  for (const GpgpBuffer* buffer : {&info.instances, &info.vertices, &info.indices, &info.draws})
    if (buffer->buffer && buffer->offset % alignment)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                             "an offset is %llu; it must be a multiple of minStorageBufferOffsetAlignment, %llu",
                             static_cast<unsigned long long>(buffer->offset),
                             static_cast<unsigned long long>(alignment));
  if (info.draws.size < stride * info.maxTiles)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "draws.size is %llu bytes; %u tiles need %llu",
                           static_cast<unsigned long long>(info.draws.size), info.maxTiles,
                           static_cast<unsigned long long>(stride * info.maxTiles));
  const VkDeviceSize bytes = vertices ? VkDeviceSize(16) * spawner.layout().strideWords : spawner.instanceBytes();
  VkDeviceSize things = (vertices ? info.vertices.size : info.instances.size) / bytes;
  uint32_t unit = unitFor(bytes, alignment);
  if (vertices && info.indices.buffer) {
    things = std::min(things, info.indices.size / (6 * indexBytes(info.indexType)));
    unit = std::max(unit, unitFor(6 * indexBytes(info.indexType), alignment));
  }
  const VkDeviceSize units = things / unit;
  if (!units)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "the shared buffers do not hold %u %s, the smallest tile", unit,
                           vertices ? "quads" : "instances");
  if (units * unit > UINT32_MAX / 6) return invalid("the shared buffers hold more than indirect draws can count");
  return core::makeUnique<TileSet>(context.host(), context, info, unit, static_cast<uint32_t>(units), stride,
                                   vertices ? 1 : std::max(grammar.graph.buckets, 1u), bytes, vertices);
}

TileSet::TileSet(core::Context& owner, const GpgpTileSetCreateInfo& info, uint32_t unit, uint32_t units,
                 VkDeviceSize stride, uint32_t drawsEach, VkDeviceSize bytesEach, bool isVertices)
    : Object(owner, core::Kind::tileSet, info.label), spawner(info.spawner), grammar(info.grammar),
      number_(owner.tileSets.fetch_add(1) & 0xffffu), instances_(info.instances), vertices_(info.vertices),
      indices_(info.indices), draws_(info.draws), indexType_(info.indexType), unit_(unit), stride_(stride),
      drawsEach_(drawsEach), bytesEach_(bytesEach), isVertices_(isVertices), units_(units),
      tiles_(info.maxTiles, &owner.host()), freeSlots_(&owner.host()), free_(units, info.maxTiles, &owner.host()) {
  freeSlots_.reserve(info.maxTiles);
  for (uint32_t slot = info.maxTiles; slot-- > 0;) freeSlots_.push_back(slot);
}

TileSet::Tile* TileSet::find(GpgpTile tile) {
  const uint32_t slot = slotOf(tile);
  return slot < tiles_.size() && (tiles_[slot].generation & 1) && handleOf(slot) == tile ? &tiles_[slot] : nullptr;
}

GpgpBuffer TileSet::part(const GpgpBuffer& buffer, VkDeviceSize offset, VkDeviceSize size) {
  GpgpBuffer range = buffer;
  range.offset += offset;
  range.size = size;
  return range;
}
GpgpBuffer TileSet::drawsOf(uint32_t slot) const { return part(draws_, stride_ * slot, kCommandBytes * drawsEach_); }
void TileSet::fill(VkCommandBuffer commandBuffer, uint32_t slot, uint32_t word, uint32_t value) const {
  for (uint32_t draw = 0; draw < drawsEach_; ++draw)
    context.device.vk.CmdFillBuffer(commandBuffer, draws_.buffer,
                                    draws_.offset + stride_ * slot + kCommandBytes * draw + 4 * word, 4, value);
}

namespace {
core::Result<void> checkInfo(const GpgpTileInfo& info) {
  if (info.flags & ~GPGP_TILE_MOVE) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "flags has unknown bits");
  if (!info.capacity) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "capacity is 0");
  if (!info.axiomCount) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "axiomCount is 0; free the tile instead");
  if (info.contextCount >= info.axiomCount)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "contextCount is %u, axiomCount is %u: the tile has no axiom",
                           info.contextCount, info.axiomCount);
  if ((info.hostAxioms != nullptr) == (info.axioms.buffer != VK_NULL_HANDLE))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "exactly one of hostAxioms and axioms.buffer must be set");
  if (info.axioms.buffer && info.axioms.size / sizeof(GpgpAxiom) < info.axiomCount)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "axioms.size is %llu bytes, axiomCount %u needs %llu",
                           static_cast<unsigned long long>(info.axioms.size), info.axiomCount,
                           static_cast<unsigned long long>(info.axiomCount) * sizeof(GpgpAxiom));
  return {};
}
} // namespace

core::Result<void> TileSet::record(VkCommandBuffer commandBuffer, const GpgpTileInfo& info, Spawner& derives,
                                   const Grammar& asset, GpgpTile& tile) {
  if (auto ok = checkInfo(info); !ok) return ok;
  Tile* const old = tile ? find(tile) : nullptr;
  const auto full = [](const char* what) { return core::makeError(GPGP_BUDGET_EXCEEDED, "%s", what); };
  if (!old && freeSlots_.empty()) return full("there are maxTiles tiles");
  // A place: the old one where it is large enough, else the lowest, for which the old one is free, too.
  const uint32_t size = unitsOf(info.capacity);
  FreeRanges::Range range{0, size};
  const bool stays = old && size <= old->range.size && !(info.flags & GPGP_TILE_MOVE);
  if (stays) {
    range = old->range;
  } else {
    if (old) free_.give(old->range);
    range.first = free_.take(size);
    if (range.first == UINT32_MAX) {
      if (old) free_.takeAt(old->range);
      return full("no free range is large enough");
    }
  }
  const uint32_t slot = old ? slotOf(tile) : freeSlots_.back();
  const uint32_t first = range.first * unit_, room = range.size * unit_;
  GpgpSpawnInfo spawn = GPGP_SPAWN_INFO_INIT;
  GpgpVertexOutput output{};
  spawn.base = info.base;
  spawn.grammar = grammar;
  spawn.axioms = info.axioms;
  spawn.hostAxioms = info.hostAxioms;
  spawn.axiomCount = info.axiomCount;
  spawn.camera = info.camera;
  spawn.fields = info.fields;
  spawn.fieldCount = info.fieldCount;
  spawn.fieldValues = info.fieldValues;
  spawn.contextCount = info.contextCount;
  spawn.draws = drawsOf(slot);
  if (isVertices_) {
    output.vertices = part(vertices_, bytesEach_ * first, bytesEach_ * room);
    const VkDeviceSize indexSize = 6 * indexBytes(indexType_);
    if (indices_.buffer) output.indices = part(indices_, indexSize * first, indexSize * room);
    output.indexType = indices_.buffer ? indexType_ : VK_INDEX_TYPE_UINT32;
    spawn.vertices = &output;
  } else {
    spawn.instances = part(instances_, bytesEach_ * first, bytesEach_ * room);
    spawn.firstInstance = first;
  }
  if (auto ok = derives.prepare(commandBuffer, spawn, asset); !ok) {
    if (!stays) {
      free_.give(range);
      if (old) free_.takeAt(old->range);
    }
    return ok;
  }
  if (isVertices_) { // where its commands begin, which the spawner leaves to the engine
    const bool external = info.base.accessMode & GPGP_ACCESS_EXTERNAL_BARRIERS;
    core::recordFillBarrier(context.device, commandBuffer, {}, true);
    fill(commandBuffer, slot, 2, first * 6);
    fill(commandBuffer, slot, 3, first * 4);
    core::recordFillBarrier(context.device, commandBuffer, external ? GpgpAccess{} : draws_.after, false);
  }
  Tile& made = tiles_[slot];
  made.range = range;
  if (!old) {
    freeSlots_.pop_back();
    made.generation = (made.generation + 1) & kGenerations;
    tile = handleOf(slot);
  }
  return {};
}

void TileSet::recordFree(VkCommandBuffer commandBuffer, GpgpTile tile, GpgpAccessMode mode) {
  const uint32_t slot = slotOf(tile);
  const bool external = mode & GPGP_ACCESS_EXTERNAL_BARRIERS;
  core::recordFillBarrier(context.device, commandBuffer, external ? GpgpAccess{} : draws_.before, true);
  fill(commandBuffer, slot, isVertices_ ? 0 : 1, 0);
  core::recordFillBarrier(context.device, commandBuffer, external ? GpgpAccess{} : draws_.after, false);
  Tile& gone = tiles_[slot];
  free_.give(gone.range);
  gone.range = {};
  gone.generation = (gone.generation + 1) & kGenerations;
  freeSlots_.push_back(slot);
}

core::Result<void> TileSet::trim(GpgpTile tile, uint32_t used) {
  FreeRanges::Range& range = find(tile)->range;
  if (used > range.size * unit_)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "used is %u; the tile's range holds %u", used,
                           range.size * unit_);
  const uint32_t kept = unitsOf(std::max(used, 1u));
  free_.give({range.first + kept, range.size - kept});
  range.size = kept;
  return {};
}

GpgpTileRange TileSet::rangeOf(GpgpTile tile) {
  const FreeRanges::Range range = find(tile)->range;
  return {range.first * unit_, range.size * unit_, slotOf(tile)};
}

GpgpTileSetReport TileSet::report() const {
  GpgpTileSetReport report = GPGP_TILE_SET_REPORT_INIT;
  uint32_t free = 0, end = 0;
  for (const FreeRanges::Range& range : free_.ranges()) free += range.size;
  for (uint32_t slot = 0; slot < tiles_.size(); ++slot) {
    const Tile& tile = tiles_[slot];
    if (!(tile.generation & 1)) continue;
    ++report.tiles;
    if (tile.range.first + tile.range.size <= end) continue;
    end = tile.range.first + tile.range.size;
    report.highest = handleOf(slot);
  }
  for (const FreeRanges::Range& range : free_.ranges()) report.holes += range.first < end;
  report.capacity = units_ * unit_;
  report.used = (units_ - free) * unit_;
  report.largest = free_.largest() * unit_;
  report.tileStride = stride_;
  return report;
}

} // namespace gpgp::spawn
