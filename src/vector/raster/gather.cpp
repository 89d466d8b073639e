#include "vector/raster/gather.h"

#include "vector/raster/list_layers.h"
#include "vector/shared/edge.h"
#include "vector/shared/shape.h"

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstring>

namespace gpgp::vector {
using core::Result;
using shader::ItemRecord;
using shader::kShapeSlot;
using shader::PlacementRecord;

ItemTables::ItemTables(const ItemBudgets& budgets, std::pmr::memory_resource* memory)
    : sources(budgets.items, memory), sourceStates(budgets.items, memory), clipStateHashes(budgets.items, memory),
      shapes(budgets.shapes, memory), paints(budgets.shapes, memory), stops(size_t(budgets.shapes) * 2, memory),
      clips(budgets.items, memory), layers(budgets.items, memory), patchItems(budgets.items, memory),
      clipStates(budgets.items, memory), groupStates(budgets.items, memory), clipsWanted(budgets.items, memory),
      groupsWanted(budgets.items, memory), assets(maxAssets(budgets), memory), assetSlots(assets.size(), memory),
      slots(assets.size() + 1 + Gather::kPatchTableSlots, memory),
      assetCells(std::bit_ceil(2 * assets.size()), memory) {}

bool ItemAsset::layered() const {
  if (drawing) return !drawing->plan().empty();
  return list && hasLayers(*list);
}

core::Error Gather::wrong(GpgpResult code, const char* format, ...) const {
  char text[256];
  std::va_list args;
  va_start(args, format);
  std::vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (entry_ == kNone) return core::makeError(code, "items[%u]%s", index_, text);
  return core::makeError(code, "items[%u].list, entry %u%s", index_, entry_, text);
}

/// The slot of an asset, whose tables are there.
Result<uint32_t> Gather::bind(const core::Resident& asset, const shader::SlotRecord& tables, bool page) {
  if (assetCount && tables_.assets[assetCount - 1] == &asset) return tables_.assetSlots[assetCount - 1];
  const size_t mask = tables_.assetCells.size() - 1;
  size_t cell = (reinterpret_cast<uintptr_t>(&asset) >> 4) * 0x9e3779b97f4a7c15u >> 32 & mask;
  for (; tables_.assetCells[cell]; cell = (cell + 1) & mask)
    if (const size_t index = tables_.assetCells[cell] - 1u; tables_.assets[index] == &asset)
      return tables_.assetSlots[index];
  assetsNeeded_ += !page;
  if (assetCount == tables_.assets.size()) return kNone;
  if (!page && assetCount - used_.boundPages == maxDrawnAssets(budgets_)) return kNone;
  used_.boundPages += page;
  uint32_t binding = 0;
  while (binding < bufferCount_ && buffers_[binding].buffer != asset.buffer()) ++binding;
  if (binding == shader::kMaxBuffers)
    return wrong(GPGP_ERROR_UNSUPPORTED,
                 ": the drawings and glyph sets of a recording lie in more than %u of the buffers that assets share",
                 shader::kMaxBuffers);
  if (binding == bufferCount_) buffers_[bufferCount_++] = {asset.buffer(), asset.bufferSize()};
  tables_.assets[assetCount] = &asset;
  tables_.slots[assetCount + 1] = tables;
  tables_.assetCells[cell] = static_cast<uint16_t>(assetCount + 1);
  const uint32_t slot = (assetCount + 1) << shader::kAssetBit | binding;
  tables_.assetSlots[assetCount++] = slot;
  return slot;
}

/// Its index; kNone where it covers nothing or finds no room.
uint32_t Gather::addSource(const Map& map, float opacity, uint32_t firstImage, const Chain& clip) {
  ItemRecord item{};
  const int x = region_.x - region_.box.left, y = region_.y - region_.box.top; // from the canvas to the region
  const Map moved = compose({1, 0, 0, 1, double(x), double(y)}, map);
  moved_ = moved;
  if (clip.hidden || !placeItem(moved, info_.width, info_.height, item, x, y)) return kNone;
  shader::vec4 scissor = clip.scissor;
  if (planner_ && planner_->composites()) { // other regions lie beside this one
    const PixelBox& box = region_.box;
    scissor = {std::max(scissor.x, static_cast<float>(box.left)), std::max(scissor.y, static_cast<float>(box.top)),
               std::min(scissor.z, static_cast<float>(box.right)), std::min(scissor.w, static_cast<float>(box.bottom))};
    if (!(scissor.x < scissor.z && scissor.y < scissor.w)) return kNone;
  }
  full_ = full_ || sources == budgets_.items;
  ++sourcesNeeded_;
  if (full_) return kNone;
  item.color.w = opacity;
  item.firstImage = firstImage;
  const auto side = [](float v, int by) { return std::abs(v) < shader::kUnbounded ? v + static_cast<float>(by) : v; };
  item.scissor = {side(scissor.x, x), side(scissor.y, y), side(scissor.z, x), side(scissor.w, y)};
  item.clip = clip.chain;
  item.layer = clip.layer;
  groups = groups || item.clip || item.layer;
  lists = lists || item.clip || item.layer || shader::hasScissor(item);
  projective = projective || item.perspective.w > 0;
  tables_.sources[sources] = item;
  if (kept_ && !damagedOnly_) tables_.sourceStates[sources] = stateOf(item);
  return sources++;
}

Gather::Chain Gather::ownOf(const GpgpCanvasItem& item) const {
  const float* s = item.scissor;
  const bool cut = s[0] != 0 || s[1] != 0 || s[2] != 0 || s[3] != 0;
  constexpr float kFar = shader::kUnbounded;
  return {cut ? shader::vec4(s[0], s[1], s[2], s[3]) : shader::vec4(-kFar, -kFar, kFar, kFar), 0,
          cut && !(s[0] < s[2] && s[1] < s[3])};
}

Result<void> Gather::plan(uint32_t index, const ItemAsset& asset) {
  index_ = index;
  entry_ = kNone;
  const GpgpCanvasItem& item = info_.items[index];
  const Map map = toMap(item.transform, item.perspective);
  const Chain own = ownOf(item);
  if (asset.drawing) return planDrawing(*asset.drawing, map, item.opacity, own);
  if (asset.glyphSet) {
    planner_->addPlain();
    return {};
  }
  const List& list = *asset.list;
  if (!hasLayers(list)) {
    for (size_t i = 0; i < list.commands().size(); ++i) planner_->addPlain();
    return {};
  }
  const ListLayers::Bind bindDrawing = [this](const DrawingAsset& drawing) { return bind(drawing, drawing.tables()); };
  ListLayers walk(*planner_, list, map, own.hidden ? shader::vec4(0) : own.scissor, bindDrawing);
  if (auto ok = walk.plan(item.opacity); !ok) return wrong(ok.error().code, ".list%s", ok.error().text);
  return {};
}

Result<void> Gather::planDrawing(const DrawingAsset& drawing, const Map& map, float opacity, const Chain& own) {
  if (drawing.plan().empty()) {
    planner_->addPlain();
    return {};
  }
  const shader::vec4 nothing(0);
  const auto slot = bind(drawing, drawing.tables()); // where filters find their tables
  if (!slot) return slot.error();
  if (*slot == kNone) planner_->close(); // the unit of this drawing is the first that finds no room
  if (auto ok = planner_->addLayered(drawing, *slot, map, opacity, own.hidden ? nothing : own.scissor); !ok)
    return wrong(ok.error().code, ": %s", ok.error().text);
  return {};
}

/// The region of the next thing without layers; true where the planner gave it one of its own, as it does behind a
/// drawing with layers.
bool Gather::lookAtPlain() {
  const auto runs = planner_->runs();
  const bool own = nextRun_ < runs.size() && runs[nextRun_].unit == unit_;
  region_ = own ? runs[nextRun_].region : base_;
  return own;
}

void Gather::beginPlain() {
  if (!planner_) return;
  if (lookAtPlain()) ++nextRun_;
  base_ = region_;
  full_ = full_ || unit_ >= planner_->units();
  ++unit_;
}

Result<void> Gather::addLayered(const DrawingAsset& drawing, uint32_t firstImage) {
  const uint32_t unit = unit_++;
  full_ = full_ || !planner_ || unit >= planner_->units();
  if (full_) {
    pathsDropped_ += drawing.paths();
    return {};
  }
  const auto slot = bind(drawing, drawing.tables());
  if (!slot) return slot.error();
  for (const auto runs = planner_->runs(); nextRun_ < runs.size() && runs[nextRun_].unit == unit; ++nextRun_) {
    const PlacedRun& run = runs[nextRun_];
    region_ = run.region;
    const PixelBox& box = region_.box;
    const Chain inside{{float(box.left), float(box.top), float(box.right), float(box.bottom)}, 0, false};
    const uint32_t source = addSource(run.map, run.opacity, firstImage, inside);
    if (source == kNone && !full_) continue; // covers nothing
    if (auto ok = addRun(drawing, run.run, source, *slot); !ok) return ok;
  }
  return {};
}

/// The patches of an item's paths, from `first` to `end`, for the placement that is added next.
void Gather::addPatches(const DrawingAsset& drawing, uint32_t first, uint32_t end) {
  const uint32_t begin = drawing.tilePatches(first), count = drawing.tilePatches(end) - begin;
  if (count == 0) return;
  if (patchItems == 0) firstPatchPath_ = used_.paths;
  const int x = region_.x - region_.box.left, y = region_.y - region_.box.top;
  shader::PatchItemRecord& record = tables_.patchItems[patchItems++];
  record = patchItemOf(moved_, static_cast<int>(info_.width / 2) + x, static_cast<int>(info_.height / 2) + y);
  record.item = used_.placements;
  record.firstPatch = used_.patches;
  record.patches = drawing.tilePatchTable() + begin * uint32_t(sizeof(shader::TilePatchRecord) / 16);
  record.curves = drawing.tileCurveTable();
  used_.patches += count;
}

/// The segments of a run from `begin` to `end`, which lie in pages: a placement for each page, without paths. Those of
/// the run follow at once, in a placement without segments. False where there is no room.
Result<bool> Gather::addPages(const DrawingAsset& drawing, uint32_t begin, uint32_t end, uint32_t source) {
  uint32_t first = 0; // of the page
  for (const auto& page : drawing.pages()) {
    const uint32_t from = std::max(begin, first), to = std::min(end, page->end);
    if (from < to) {
      const auto slot = bind(*page, {}, true);
      if (!slot) return slot.error();
      if (*slot == kNone || used_.pages == kMaxPlacedPages) return false;
      ++used_.pages;
      placed_[used_.placements++] = {0,
                                     0,
                                     1,
                                     source | *slot << shader::kSlotBit,
                                     {0, 0, 0, 1},
                                     used_.segments,
                                     used_.paths,
                                     static_cast<uint32_t>(page->offset() / sizeof(shader::vec4)) +
                                         (from - first) * uint32_t(sizeof(shader::SegmentRecord) / 16),
                                     0};
      used_.segments += to - from;
    }
    first = page->end;
  }
  return true;
}

/// As many of a run's first paths as there is room for.
Result<void> Gather::addRun(const DrawingAsset& drawing, uint32_t index, uint32_t source, uint32_t slot) {
  const DrawingAsset::Run run = drawing.run(index);
  const uint32_t paths = full_ ? 0 : std::min(run.paths, budgets_.paths - used_.paths);
  pathsDropped_ += run.paths - paths;
  full_ = full_ || paths < run.paths;
  if (paths == 0) return {};
  const ItemRecord* const item = &tables_.sources[source];
  const auto state = [&](StateHash& hash) {
    hash.add(identityOf(drawing)).add(index).add(paths);
    for (uint32_t i = 0; i < drawing.images(); ++i) addImage(hash, uint64_t(item->firstImage) + i);
  };
  if (!shows(source, state, [&] { return planner_ ? TileBox{} : tilesOf(*item, drawing.ink(), kNoFrame); })) return {};
  gradients = gradients || drawing.gradients();
  images = images || drawing.images();
  groups = groups || drawing.groups();
  const bool patches = patched_ && (drawing.methods() & GPGP_DRAWING_PATCHES);
  const uint32_t begin = drawing.segments(run.firstPath), end = drawing.segments(run.firstPath + paths);
  if (!patches && !drawing.pages().empty()) {
    const auto placed = addPages(drawing, begin, end, source);
    if (!placed) return placed.error();
    if (!*placed) {
      full_ = true;
      pathsDropped_ += paths;
      return {};
    }
  }
  if (patches) addPatches(drawing, run.firstPath, run.firstPath + paths);
  placed_[used_.placements++] = {0,
                                 0,
                                 1,
                                 source | slot << shader::kSlotBit,
                                 {0, 0, 0, 1},
                                 used_.segments,
                                 used_.paths,
                                 run.segmentTable,
                                 run.pathTable};
  if (!patches && drawing.pages().empty()) used_.segments += end - begin;
  used_.paths += paths;
  return {};
}

Result<void> Gather::add(uint32_t index, const ItemAsset& asset) {
  index_ = index;
  entry_ = kNone;
  const GpgpCanvasItem& item = info_.items[index];
  const Chain own = ownOf(item);
  if (asset.list) return addList(*asset.list, item, own);
  const Map map = toMap(item.transform, item.perspective);
  if (asset.drawing) return addDrawing(*asset.drawing, map, item.opacity, item.firstImage, own);
  beginPlain();
  const uint32_t source = addSource(map, item.opacity, 0, own);
  return addGlyphs(*asset.glyphSet, {item.glyphs, item.glyphCount}, source);
}

/// A drawing with as many of its first paths as there is room for.
Result<void> Gather::addDrawing(const DrawingAsset& drawing, const Map& map, float opacity, uint32_t firstImage,
                                const Chain& clip, bool plain) {
  if (drawing.images() && (firstImage > info_.imageCount || drawing.images() > info_.imageCount - firstImage))
    return wrong(GPGP_ERROR_INVALID_ARGUMENT, ": its drawing needs %u images from images[%u] on; imageCount is %u",
                 drawing.images(), firstImage, info_.imageCount);
  if (!drawing.plan().empty()) return addLayered(drawing, firstImage);
  if (plain) beginPlain();
  if (clip.layer && tables_.layers[clip.layer - 1].depth + drawing.layerDepth() > shader::kMaxLayerDepth)
    return wrong(GPGP_ERROR_UNSUPPORTED, ": with those of its drawing, more than %u nested groups fade",
                 shader::kMaxLayerDepth);
  const uint32_t source = addSource(map, opacity, firstImage, clip);
  if (source == kNone && !full_) return {}; // covers nothing
  if (full_ || drawing.paths() == 0 || used_.paths == budgets_.paths) return addRun(drawing, 0, source, 0);
  const auto slot = bind(drawing, drawing.tables());
  if (!slot) return slot.error();
  full_ = *slot == kNone;
  return addRun(drawing, 0, source, *slot);
}

/// Whether there is room. Its tables lie before all others.
bool Gather::addShape(const shader::ShapeRecord& shape, uint32_t source, const shader::vec4& color) {
  full_ = full_ || shapes == budgets_.shapes || used_.paths == budgets_.paths;
  ++shapesNeeded_;
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
  return true;
}

void Gather::addShapes(const List& list, std::span<const List::Shape> from, uint32_t source) {
  for (const List::Shape& shape : from) {
    shader::ShapeRecord record = shape.record;
    if (!full_ && !showsShape(list, shape, source)) continue;
    if (shader::isTriangle(record)) {
      record = List::toRecord(record, info_.blendSrgb);
      gradients = true;
    }
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
Result<void> Gather::resolveClips(const List& list, const Map& map, const Chain& own, bool all) {
  if (list.clips().size() > budgets_.items) {
    sourcesNeeded_ += static_cast<uint32_t>(list.clips().size());
    shapesNeeded_ += static_cast<uint32_t>(list.clips().size());
    clipsDropped_ += static_cast<uint32_t>(list.clips().size());
    full_ = true;
    return {};
  }
  for (size_t i = 0; i < list.clips().size(); ++i) {
    if (!all && !tables_.clipsWanted[i]) continue;
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
    if (kept_) {
      StateHash hash;
      hash.add(state.chain ? tables_.clipStateHashes[state.chain - 1] : 0).add(clip.shape);
      tables_.clipStateHashes[clips] = hash.add(tables_.sourceStates[source]).value();
      const auto shape = [&](StateHash& of) { of.add(tables_.clipStateHashes[clips]); };
      shows(source, shape, [&] { return tilesOf(clip.shape, source); }); // it stays where it shows nothing
    }
    tables_.clips[clips++] = {path, state.chain};
    state.chain = clips;
  }
  return {};
}

/// A layer for each group that is neither opaque nor hidden whole; `opacity` is that of each thing in the list.
void Gather::resolveGroups(const List& list, float opacity, bool all) {
  layersNeeded_ += static_cast<uint32_t>(list.groups().size());
  full_ = full_ || list.groups().size() > budgets_.items - layers;
  for (size_t i = 0; i < list.groups().size() && !full_; ++i) {
    if (!all && !tables_.groupsWanted[i]) continue;
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
  if (planner_ && hasLayers(list)) return addLayeredList(list, item, map, own);
  if (planner_) lookAtPlain(); // clips lie where what they cut lies
  if (auto ok = resolveClips(list, map, own, true); !ok) return ok;
  resolveGroups(list, item.opacity, true);
  Last last;
  last.region = region_;
  for (const List::Command& command : list.commands())
    if (auto ok = addCommand(list, command, item, map, item.opacity, own, true, last); !ok) return ok;
  return {};
}

Result<void> Gather::addCommand(const List& list, const List::Command& command, const GpgpCanvasItem& item,
                                const Map& map, float opacity, const Chain& own, bool plain, Last& last) {
  entry_ = command.firstEntry;
  const List::Space& space = command.space;
  Chain state = space.clip && !full_ ? tables_.clipStates[space.clip - 1] : own;
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
    return addDrawing(drawing, whole, opacity * command.opacity, item.firstImage + command.firstImage, state, plain);
  }
  if (plain) beginPlain();
  const core::Object* asset = nullptr;
  if (command.kind == List::Kind::text && !(asset = command.asset()))
    return wrong(GPGP_ERROR_INVALID_HANDLE, ": its glyph set was destroyed");
  if (space.base != last.base || space.clip != last.clip || space.group != last.group || region_ != last.region) {
    last = {kNone, space.base, space.clip, space.group, region_};
    last.source = addSource(compose(map, list.bases()[space.base]), opacity, item.firstImage, state);
  }
  if (command.kind == List::Kind::text) {
    const auto glyphs = list.glyphs().subspan(command.first, command.count);
    return addGlyphs(static_cast<const GlyphSet&>(*asset), glyphs, last.source);
  }
  if (last.source != kNone || full_) addShapes(list, list.shapes().subspan(command.first, command.count), last.source);
  return {};
}

/// Marks what the commands of a run lie in.
void Gather::wantClips(const List& list, const PlacedRun& run) {
  const size_t clipCount = std::min(list.clips().size(), tables_.clipsWanted.size()),
               groupCount = std::min(list.groups().size(), tables_.groupsWanted.size());
  std::fill_n(tables_.clipsWanted.begin(), clipCount, uint8_t(0));
  std::fill_n(tables_.groupsWanted.begin(), groupCount, uint8_t(0));
  const bool commands = run.count != PlacedRun::kNone && run.count > 0;
  for (uint32_t i = run.command; i < run.command + (commands ? run.count : 1); ++i) {
    const List::Space& space = list.commands()[i].space;
    for (uint32_t c = space.clip; c && c <= clipCount && !tables_.clipsWanted[c - 1]; c = list.clips()[c - 1].parent)
      tables_.clipsWanted[c - 1] = 1;
    for (uint32_t g = space.group; commands && g && g <= groupCount; g = list.groups()[g - 1].parent)
      tables_.groupsWanted[g - 1] = 1;
  }
}

/// One unit of the planner's, which has said what goes where.
Result<void> Gather::addLayeredList(const List& list, const GpgpCanvasItem& item, const Map& map, const Chain& own) {
  const uint32_t unit = unit_++;
  full_ = full_ || unit >= planner_->units();
  if (full_) {
    pathsDropped_ += static_cast<uint32_t>(std::min<size_t>(list.shapes().size() + list.glyphs().size() + 1, 1u << 30));
    return {};
  }
  constexpr float kFar = shader::kUnbounded;
  for (const auto runs = planner_->runs(); nextRun_ < runs.size() && runs[nextRun_].unit == unit; ++nextRun_) {
    const PlacedRun& run = runs[nextRun_];
    const List::Command& first = list.commands()[run.command];
    region_ = run.region;
    entry_ = first.firstEntry;
    const PixelBox& box = region_.box;
    const Chain inside{{float(box.left), float(box.top), float(box.right), float(box.bottom)}, 0, false};
    if (run.count == PlacedRun::kNone) { // of a drawing
      const auto& drawing = static_cast<const DrawingAsset&>(*first.asset());
      if (!drawing.resident()) return core::makeError(GPGP_NOT_READY, "a drawing is not resident");
      const uint64_t image = uint64_t(item.firstImage) + first.firstImage;
      if (drawing.images() && image + drawing.images() > info_.imageCount)
        return wrong(GPGP_ERROR_INVALID_ARGUMENT,
                     ": its drawing needs %u images from images[%llu] on; imageCount is %u", drawing.images(),
                     static_cast<unsigned long long>(image), info_.imageCount);
      const auto slot = bind(drawing, drawing.tables());
      if (!slot) return slot.error();
      const uint32_t source = addSource(run.map, run.opacity, static_cast<uint32_t>(image), inside);
      if (source != kNone || full_)
        if (auto ok = addRun(drawing, run.run, source, *slot); !ok) return ok;
      continue;
    }
    wantClips(list, run);
    const Chain around = run.outermost ? own : Chain{{-kFar, -kFar, kFar, kFar}, 0, false};
    if (auto ok = resolveClips(list, map, around, false); !ok) return ok;
    if (run.count == 0) { // all that the clips show
      const Chain state = first.space.clip && !full_ ? tables_.clipStates[first.space.clip - 1] : around;
      const uint32_t source = addSource(Map{}, 1, 0, state);
      shader::ShapeRecord all{};
      all.box = inside.scissor + shader::vec4(-1, -1, 1, 1);
      all.frame = {0, 0, 1, 0};
      if (source != kNone)
        shows(
            source, [](StateHash&) {}, [] { return TileBox{}; });
      if (source != kNone || full_) pathsDropped_ += !addShape(all, source, shader::vec4(1));
      continue;
    }
    if (!list.groups().empty()) resolveGroups(list, run.opacity, false);
    Last last;
    last.region = region_;
    for (const List::Command& command : list.commands().subspan(run.command, run.count))
      if (auto ok = addCommand(list, command, item, map, run.opacity, around, false, last); !ok) return ok;
  }
  return {};
}

void Gather::finish(shader::CanvasHeader& header) {
  header.sourceCount = sources;
  header.itemCount = used_.placements;
  header.segmentCount = used_.segments;
  header.pathCount = used_.paths;
  header.pathsNeeded =
      static_cast<uint32_t>(std::min<uint64_t>(uint64_t(used_.paths) + pathsDropped_ + clipsDropped_, UINT32_MAX));
  header.pathsDropped = pathsDropped_;
  header.glyphs = used_.glyphs;
  header.glyphLimit = budgets_.glyphs;
  header.shapes = std::max({shapesNeeded_, paintsNeeded_, (stopsNeeded_ + 1) / 2});
  header.shapeLimit = budgets_.shapes;
  header.sources = std::max({sourcesNeeded_, layersNeeded_, assetsNeeded_});
  header.sourceLimit = budgets_.items;
  shader::SlotRecord& own = tables_.slots[0];
  own.paints = shapes * 4;
  own.stops = own.paints + paints * 4;
  own.clips = own.stops + stops * 2;
  own.layers = own.clips + clips;
  header.assets = own.layers + layers;
  header.shapeTables = header.assets + 1 + assetCount;
  if (!patchItems) return;
  header.patchTable = header.shapeTables;
  header.shapeTables += kPatchTableSlots + patchItems * uint32_t(sizeof(shader::PatchItemRecord) / 16);
  constexpr uint32_t kMany = 16384; // fewer are dealt out to more workgroups, which then each wait for less
  patchTable = {patchItems, used_.patches, used_.patches < kMany ? 16u : 64u, 0, firstPatchPath_, 0, 0, 0};
}

void Gather::placePatchTable(uint32_t limit) {
  patchTable.limit = limit;
  if (patchItems) std::memcpy(&tables_.slots[assetCount + 1], &patchTable, sizeof patchTable);
}

} // namespace gpgp::vector
