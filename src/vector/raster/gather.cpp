#include "vector/raster/gather.h"

#include "vector/edge.h"
#include "vector/shape.h"

#include <algorithm>
#include <bit>
#include <cstdarg>

namespace gpgp::vector {
using core::Result;
using shader::ItemRecord;
using shader::kShapeSlot;
using shader::PlacementRecord;

ItemTables::ItemTables(const ItemBudgets& budgets, std::pmr::memory_resource* memory)
    : sources(budgets.items, memory), shapes(budgets.shapes, memory), paints(budgets.shapes, memory),
      stops(size_t(budgets.shapes) * 2, memory), clips(budgets.items, memory), layers(budgets.items, memory),
      clipStates(budgets.items, memory), groupStates(budgets.items, memory) {}

core::Error Gather::wrong(GpgpResult code, const char* format, ...) const {
  char text[256];
  std::va_list args;
  va_start(args, format);
  std::vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (entry_ == kNone) return core::makeError(code, "items[%u]%s", index_, text);
  return core::makeError(code, "items[%u].list, entry %u%s", index_, entry_, text);
}

Result<uint32_t> Gather::bind(const core::Resident& asset) { // to a slot, if one is left
  uint32_t slot = 0;
  while (slot < slotCount && bound[slot] != &asset) ++slot;
  if (slot == shader::kMaxSlots)
    return wrong(GPGP_ERROR_UNSUPPORTED, ": a record draws at most %u different drawings and glyph sets",
                 shader::kMaxSlots);
  if (slot == slotCount) bound[slotCount++] = &asset;
  return slot;
}

/// Its index; kNone where it covers nothing or finds no room.
uint32_t Gather::addSource(const Map& map, float opacity, uint32_t firstImage, const Chain& clip) {
  ItemRecord item{};
  if (clip.hidden || !placeItem(map, info_.width, info_.height, item)) return kNone;
  full_ = full_ || sources == budgets_.items;
  ++sourcesNeeded_;
  if (full_) return kNone;
  item.color.w = opacity;
  item.firstImage = firstImage;
  item.scissor = clip.scissor;
  item.clip = clip.chain;
  item.layer = clip.layer;
  groups = groups || item.clip || item.layer;
  lists = lists || item.clip || shader::hasScissor(item);
  projective = projective || item.perspective.w > 0;
  tables_.sources[sources] = item;
  return sources++;
}

Result<void> Gather::add(uint32_t index, const ItemAsset& asset) {
  index_ = index;
  entry_ = kNone;
  const GpgpCanvasItem& item = info_.items[index];
  const float* s = item.scissor;
  const bool cut = s[0] != 0 || s[1] != 0 || s[2] != 0 || s[3] != 0;
  constexpr float kFar = shader::kUnbounded;
  const Chain own{cut ? shader::vec4(s[0], s[1], s[2], s[3]) : shader::vec4(-kFar, -kFar, kFar, kFar), 0,
                  cut && !(s[0] < s[2] && s[1] < s[3])};
  if (asset.list) return addList(*asset.list, item, own);
  const Map map = toMap(item.transform, item.perspective);
  if (asset.drawing) return addDrawing(*asset.drawing, map, item.opacity, item.firstImage, own);
  const uint32_t source = addSource(map, item.opacity, 0, own);
  return addGlyphs(*asset.glyphSet, {item.glyphs, item.glyphCount}, source);
}

/// A drawing with as many of its first paths as there is room for.
Result<void> Gather::addDrawing(const DrawingAsset& drawing, const Map& map, float opacity, uint32_t firstImage,
                                const Chain& clip) {
  if (drawing.images() && (firstImage > info_.imageCount || drawing.images() > info_.imageCount - firstImage))
    return wrong(GPGP_ERROR_INVALID_ARGUMENT, ": its drawing needs %u images from images[%u] on; imageCount is %u",
                 drawing.images(), firstImage, info_.imageCount);
  if (clip.layer && tables_.layers[clip.layer - 1].depth + drawing.layerDepth() > shader::kMaxLayerDepth)
    return wrong(GPGP_ERROR_UNSUPPORTED, ": with those of its drawing, more than %u groups fade in each other",
                 shader::kMaxLayerDepth);
  const uint32_t source = addSource(map, opacity, firstImage, clip);
  if (source == kNone && !full_) return {}; // covers nothing
  const uint32_t room = budgets_.patches - static_cast<uint32_t>(used_.patches);
  uint32_t paths = full_ ? 0 : std::min(drawing.paths(), budgets_.patches - used_.paths);
  if (drawing.first(paths).patches > room) { // the largest number of first paths that fits
    uint32_t low = 0, high = paths;
    while (low + 1 < high) {
      const uint32_t middle = low + (high - low) / 2;
      (drawing.first(middle).patches <= room ? low : high) = middle;
    }
    paths = low;
  }
  pathsDropped_ += drawing.paths() - paths;
  patchesDropped_ += drawing.first(drawing.paths()).patches - drawing.first(paths).patches;
  full_ = full_ || paths < drawing.paths();
  if (paths == 0) return {};
  const auto slot = bind(drawing);
  if (!slot) return slot.error();
  slots[*slot] = drawing.tables();
  gradients = gradients || drawing.gradients();
  images = images || drawing.images();
  groups = groups || drawing.groups();
  placed_[used_.placements++] = {
      0, 0, 1, source | *slot << shader::kSlotBit, {0, 0, 0, 1}, used_.segments, used_.paths, 0, drawing.pathTable()};
  used_.segments += drawing.first(paths).segments;
  used_.paths += paths;
  used_.patches += drawing.first(paths).patches;
  return {};
}

/// Some glyphs of a text, in arrays that compilers take several of at a time.
struct GlyphBlock {
  static constexpr size_t kMost = 64;
  const GpgpGlyphInstance* from[kMost];
  const GlyphSet::Glyph* glyph[kMost];
  float x[kMost], y[kMost], reachX[kMost], reachY[kMost]; ///< their boxes: middles, and from there to the sides
  uint32_t tiles[kMost];                                  ///< see countTiles
  size_t count = 0;

  void add(const GpgpGlyphInstance& instance, const GlyphSet::Glyph& which) {
    from[count] = &instance;
    glyph[count] = &which;
    x[count] = instance.x + instance.size * which.middle.x;
    y[count] = instance.y + instance.size * which.middle.y;
    reachX[count] = instance.size * which.reach.x;
    reachY[count++] = instance.size * which.reach.y;
  }
  void countTiles(const ItemRecord& source, const GpgpCanvasInfo& info);
};

/// How many tiles each may have edges in, if it is one for stamp.comp: small, and no scissor cuts it; otherwise 0.
void GlyphBlock::countTiles(const ItemRecord& source, const GpgpCanvasInfo& info) {
  const shader::vec4 map = source.transform, scissor = source.scissor;
  const float left = source.offsets.z, top = source.offsets.w;
  const float width = static_cast<float>(info.width), height = static_cast<float>(info.height);
  constexpr int kSide = int(shader::kTileSize), kPairs = int(shader::kStampPairs), kTiles = int(shader::kStampTiles);
  // With room for the margins that shaders take: placeOf in stamp.comp, place.comp.
  const auto across = [](float middle, float reach, float end) {
    const float side = reach + 1.1f + 2e-5f * std::abs(middle), low = middle - side, high = middle + side;
    const float inLow = low > 0 ? low : 0, inHigh = high > 0 ? high : 0;
    const float first = inLow < end ? inLow : end, last = inHigh < end ? inHigh : end;
    return static_cast<int>(last) / kSide + 1 - static_cast<int>(first) / kSide;
  };
  constexpr float kFar = 128; // has too many pairs of pixels, as have infinity and NaN
  for (size_t k = 0; k < count; ++k) {
    const float px = map.x * x[k] + map.z * y[k] + left, py = map.y * x[k] + map.w * y[k] + top;
    const float farX = std::abs(map.x) * reachX[k] + std::abs(map.z) * reachY[k],
                farY = std::abs(map.y) * reachX[k] + std::abs(map.w) * reachY[k];
    const float sideX = farX < kFar ? farX : kFar, sideY = farY < kFar ? farY : kFar;
    const int pairs = static_cast<int>(sideX + 0.95f) + 2, rows = static_cast<int>(2 * sideY + 2.5f);
    const int most = across(px, sideX, width) * across(py, sideY, height);
    // Numbers instead of bools: no branch, and compilers take them for what is meant.
    const int small =
        int(pairs * rows <= kPairs) & int(most <= kTiles) & int(std::abs(px) < 1e9f) & int(std::abs(py) < 1e9f);
    const int whole = int(px - sideX - 1 > scissor.x) & int(px + sideX + 1 < scissor.z) &
                      int(py - sideY - 1 > scissor.y) & int(py + sideY + 1 < scissor.w);
    tiles[k] = static_cast<uint32_t>((small & whole) * most);
  }
}

namespace {
/// Notes, without a branch, whether a colour is doubtful: as bits, numbers from 0 on are in order.
struct Doubt {
  uint32_t bits[4] = {};
  void see(const float (&color)[4]) {
    constexpr float kMost[] = {kMaxColor, kMaxColor, kMaxColor, 1};
    for (int k = 0; k < 4; ++k) {
      const uint32_t number = std::bit_cast<uint32_t>(color[k]);
      bits[k] |= number | (std::bit_cast<uint32_t>(kMost[k]) - number);
    }
  }
  bool any() const { return (bits[0] | bits[1] | bits[2] | bits[3]) >> 31 != 0; }
};
} // namespace

/// A placement for each glyph that has paths, as long as there is room. This loop is what changing text costs.
Result<void> Gather::addGlyphs(const GlyphSet& set, std::span<const GpgpGlyphInstance> glyphs, uint32_t source) {
  const uint64_t frame = context_.current();
  constexpr float kMost = kMaxCoordinate;
  const bool hidden = source == kNone && !full_;
  const ItemRecord* stamping = nullptr; // the source, if small glyphs may be stamped
  if (source != kNone) {
    ItemRecord& item = tables_.sources[source];
    item.whole = 1;
    if (!placesGlyphs(item)) return {}; // covers nothing
    if (stampRoom_ && item.perspective.w == 0) stamping = &item;
    const auto slot = bind(set);
    if (!slot) return slot.error();
    source |= *slot << shader::kSlotBit;
  }
  GlyphBlock block;
  for (size_t i = 0; i < glyphs.size();) {
    const size_t first = i;
    Doubt doubt;
    for (block.count = 0; i < glyphs.size() && block.count < GlyphBlock::kMost; ++i) {
      const GpgpGlyphInstance& from = glyphs[i];
      if (from.glyph == GPGP_GLYPH_NONE) continue;
      const GlyphSet::Glyph* glyph = set.glyph(from.glyph);
      if (!glyph)
        return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".glyphs[%zu].glyph is not, or no longer, in the set: it was evicted",
                     i);
      if (!(std::abs(from.x) <= kMost && std::abs(from.y) <= kMost && from.size >= 0 && from.size <= kMost))
        return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".glyphs[%zu]: x, y or size is out of range", i);
      doubt.see(from.color);
      if (!set.hasArrived(glyph->upload)) return core::makeError(GPGP_NOT_READY, "a glyph is not resident");
      glyph->use(frame);
      if (glyph->paths > 0 && !hidden) block.add(from, *glyph);
    }
    for (size_t k = first; k < i && doubt.any(); ++k)
      if (glyphs[k].glyph != GPGP_GLYPH_NONE && !inColorRange(glyphs[k].color))
        return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".glyphs[%zu].color is out of range", k);
    if (stamping)
      block.countTiles(*stamping, info_);
    else
      std::fill_n(block.tiles, block.count, 0u);
    addBlock(block, source);
  }
  return {};
}

void Gather::addBlock(const GlyphBlock& block, uint32_t source) {
  Used used = used_; // a copy, which what is placed cannot be part of
  for (size_t k = 0; k < block.count; ++k) {
    const GpgpGlyphInstance& from = *block.from[k];
    const GlyphSet::Glyph& glyph = *block.glyph[k];
    if (glyph.gradients) gradients = true;
    if (used.glyphs >= budgets_.glyphs || glyph.paths > budgets_.patches - used.paths ||
        glyph.patches > budgets_.patches - used.patches)
      full_ = true;
    ++used.glyphs;
    if (full_) {
      pathsDropped_ += glyph.paths;
      patchesDropped_ += glyph.patches;
      continue;
    }
    const uint32_t tiles = block.tiles[k];
    const bool stamped = tiles && tiles <= stampRoom_ - used.stampEntries;
    const float* c = from.color;
    placed_[used.placements++] = {from.x,
                                  from.y,
                                  from.size,
                                  source | uint32_t(stamped) << shader::kStampedBit,
                                  {c[0], c[1], c[2], c[3]},
                                  used.segments,
                                  used.paths,
                                  glyph.first,
                                  glyph.first + glyph.segments * uint32_t(sizeof(shader::SegmentRecord) / 16)};
    if (stamped) {
      used.stampEntries += tiles;
      ++used.stamps;
    } else {
      used.segments += glyph.segments;
    }
    used.paths += glyph.paths;
    used.patches += glyph.patches;
  }
  used_ = used;
}

/// Whether there is room. Its tables lie before all others.
bool Gather::addShape(const shader::ShapeRecord& shape, uint32_t source, const shader::vec4& color) {
  full_ = full_ || shapes == budgets_.shapes || used_.paths == budgets_.patches || used_.patches == budgets_.patches;
  ++shapesNeeded_;
  patchesDropped_ += full_;
  if (full_) return false;
  tables_.shapes[shapes] = shape;
  placed_[used_.placements++] = {0,
                                 0,
                                 1,
                                 source | kShapeSlot << shader::kSlotBit,
                                 color,
                                 used_.segments,
                                 used_.paths,
                                 0,
                                 shapes * uint32_t(sizeof shape / 16)};
  ++shapes;
  used_.segments += shader::shapeSegments(shape);
  ++used_.paths;
  ++used_.patches;
  return true;
}

void Gather::addShapes(const List& list, std::span<const List::Shape> from, uint32_t source) {
  for (const List::Shape& shape : from) {
    shader::ShapeRecord record = shape.record;
    if (record.paint) {
      shader::PaintRecord paint = list.paints().paints[record.paint - 1];
      const uint32_t first = paint.kind == shader::kPaintSlices ? paint.slices : paint.firstStop;
      full_ = full_ || paints == budgets_.shapes || paint.stopCount > 2 * size_t(budgets_.shapes) - stops;
      ++paintsNeeded_;
      stopsNeeded_ += paint.stopCount;
      if (!full_) {
        std::copy_n(list.paints().stops.begin() + first, paint.stopCount, tables_.stops.begin() + stops);
        if (paint.stopCount) (paint.kind == shader::kPaintSlices ? paint.slices : paint.firstStop) = stops;
        const bool image = paint.kind >= shader::kPaintImage;
        (image ? images : gradients) = true;
        tables_.paints[paints++] = paint;
        stops += paint.stopCount;
        record.paint = paints;
      }
    }
    pathsDropped_ += !addShape(record, source, shape.color);
  }
}

/// What each clip of a list leaves: a scissor where it is parallel to the canvas, otherwise a path that paints nothing.
Result<void> Gather::resolveClips(const List& list, const Map& map, const Chain& own) {
  if (list.clips().size() > budgets_.items) {
    sourcesNeeded_ += static_cast<uint32_t>(list.clips().size());
    shapesNeeded_ += static_cast<uint32_t>(list.clips().size());
    patchesDropped_ += list.clips().size();
    clipsDropped_ += static_cast<uint32_t>(list.clips().size());
    full_ = true;
    return {};
  }
  for (size_t i = 0; i < list.clips().size(); ++i) {
    const List::Clip& clip = list.clips()[i];
    Chain& state = tables_.clipStates[i];
    state = clip.parent ? tables_.clipStates[clip.parent - 1] : own;
    const Map placed = compose(map, list.bases()[clip.base]);
    ItemRecord item{};
    state.hidden = state.hidden || clip.shape.box.x == clip.shape.box.z || clip.shape.box.y == clip.shape.box.w ||
                   !placeItem(placed, info_.width, info_.height, item);
    if (state.hidden) continue;
    const bool parallel = (placed.b == 0 && placed.c == 0) || (placed.a == 0 && placed.d == 0);
    if (parallel && !placed.projective() && !clip.shape.kind) {
      const shader::vec2 a = shader::toPixel(item, clip.shape.box.x, clip.shape.box.y);
      const shader::vec2 b = shader::toPixel(item, clip.shape.box.z, clip.shape.box.w);
      const shader::vec4 outer = state.scissor;
      state.scissor = {std::max(outer.x, std::min(a.x, b.x)), std::max(outer.y, std::min(a.y, b.y)),
                       std::min(outer.z, std::max(a.x, b.x)), std::min(outer.w, std::max(a.y, b.y))};
      state.hidden = !(state.scissor.x < state.scissor.z && state.scissor.y < state.scissor.w);
      continue;
    }
    const uint32_t source = addSource(placed, 0, 0, state);
    const uint32_t path = used_.paths;
    if (!addShape(clip.shape, source, {})) { // as where the source found no room
      ++clipsDropped_;
      continue;
    }
    tables_.clips[clips++] = {path, state.chain};
    state.chain = clips;
  }
  return {};
}

/// A layer for each group that is neither opaque nor hidden whole; `opacity` is that of each thing in the list.
void Gather::resolveGroups(const List& list, float opacity) {
  layersNeeded_ += static_cast<uint32_t>(list.groups().size());
  full_ = full_ || list.groups().size() > budgets_.items - layers;
  for (size_t i = 0; i < list.groups().size() && !full_; ++i) {
    const List::Group& group = list.groups()[i];
    const ItemTables::GroupState outer =
        group.parent ? tables_.groupStates[group.parent - 1] : ItemTables::GroupState{0, opacity};
    ItemTables::GroupState& state = tables_.groupStates[i];
    const float whole = group.opacity * outer.opacity;
    state = {outer.layer, whole};
    if (whole == 0 || whole == 1) continue;
    const uint32_t depth = outer.layer ? tables_.layers[outer.layer - 1].depth + 1 : 1;
    tables_.layers[layers++] = {whole, outer.layer, depth, 0};
    state = {layers, 1};
  }
}

Result<void> Gather::addList(const List& list, const GpgpCanvasItem& item, const Chain& own) {
  if (list.depth()) return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".list: %u of its pushes are not popped", list.depth());
  if (list.images() && (item.firstImage > info_.imageCount || list.images() > info_.imageCount - item.firstImage))
    return wrong(GPGP_ERROR_INVALID_ARGUMENT, ".list needs %u images from images[%u] on; imageCount is %u",
                 list.images(), item.firstImage, info_.imageCount);
  const Map map = toMap(item.transform, item.perspective);
  if (auto ok = resolveClips(list, map, own); !ok) return ok;
  resolveGroups(list, item.opacity);
  // Shapes and texts that follow each other in the same space share a source.
  uint32_t source = kNone, base = kNone, clip = kNone, group = kNone;
  for (const List::Command& command : list.commands()) {
    entry_ = command.firstEntry;
    const List::Space& space = command.space;
    Chain state = space.clip && !full_ ? tables_.clipStates[space.clip - 1] : own;
    float opacity = item.opacity;
    if (space.group && !full_) {
      state.layer = tables_.groupStates[space.group - 1].layer;
      opacity = tables_.groupStates[space.group - 1].opacity;
    }
    if (command.kind == List::Kind::drawing) {
      const core::Object* asset = command.asset();
      if (!asset) return wrong(GPGP_ERROR_INVALID_HANDLE, ": its drawing was destroyed");
      const auto& drawing = static_cast<const DrawingAsset&>(*asset);
      if (!drawing.resident()) return core::makeError(GPGP_NOT_READY, "a drawing is not resident");
      const Map whole = compose(compose(map, list.bases()[space.base]), space.map());
      if (command.firstImage > UINT32_MAX - item.firstImage)
        return wrong(GPGP_ERROR_INVALID_ARGUMENT, ": firstImage is %u", command.firstImage);
      if (auto ok = addDrawing(drawing, whole, opacity * command.opacity, item.firstImage + command.firstImage, state);
          !ok)
        return ok;
      continue;
    }
    const core::Object* asset = nullptr;
    if (command.kind == List::Kind::text && !(asset = command.asset()))
      return wrong(GPGP_ERROR_INVALID_HANDLE, ": its glyph set was destroyed");
    if (space.base != base || space.clip != clip || space.group != group) {
      base = space.base, clip = space.clip, group = space.group;
      source = addSource(compose(map, list.bases()[base]), opacity, item.firstImage, state);
    }
    if (command.kind == List::Kind::text) {
      const auto glyphs = list.glyphs().subspan(command.first, command.count);
      if (auto ok = addGlyphs(static_cast<const GlyphSet&>(*asset), glyphs, source); !ok) return ok;
    } else if (source != kNone || full_) {
      addShapes(list, list.shapes().subspan(command.first, command.count), source);
    }
  }
  return {};
}

void Gather::finish(shader::CanvasHeader& header) {
  lists = lists || shapes;
  header.sourceCount = sources;
  header.itemCount = used_.placements;
  header.segmentCount = used_.segments;
  header.pathCount = used_.paths;
  // No more paths than patches fit.
  const uint64_t needed =
      std::max<uint64_t>(used_.patches + patchesDropped_, uint64_t(used_.paths) + pathsDropped_ + clipsDropped_);
  header.patchCount = static_cast<uint32_t>(std::min<uint64_t>(needed, UINT32_MAX));
  header.pathsDropped = pathsDropped_;
  header.glyphs = used_.glyphs;
  header.glyphLimit = budgets_.glyphs;
  header.shapes = std::max({shapesNeeded_, paintsNeeded_, (stopsNeeded_ + 1) / 2});
  header.shapeLimit = budgets_.shapes;
  header.sources = std::max(sourcesNeeded_, layersNeeded_);
  header.sourceLimit = budgets_.items;
  shader::SlotRecord& own = slots[kShapeSlot];
  own.paints = shapes * 4;
  own.stops = own.paints + paints * 4;
  own.clips = own.stops + stops * 2;
  own.layers = own.clips + clips;
  header.shapeTables = own.layers + layers;
}

} // namespace gpgp::vector
