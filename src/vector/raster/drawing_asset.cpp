#include "vector/raster/drawing_asset.h"

#include "vector/patch/patches.h"

#include <algorithm>
#include <cstring>

namespace gpgp::vector {
namespace {

/// Returns where they lie, in vec4.
template <class Records> uint32_t append(const Records& records, std::pmr::vector<std::byte>& bytes) {
  const auto part = std::as_bytes(std::span(records));
  const size_t at = bytes.size() / sizeof(shader::vec4);
  bytes.insert(bytes.end(), part.begin(), part.end());
  return static_cast<uint32_t>(at);
}

} // namespace

DrawingTables packDrawing(const Drawing& drawing, const Outlines& outlines, std::pmr::memory_resource* memory) {
  DrawingTables tables(memory);
  const auto add = [&](const auto& records) { return append(records, tables.bytes); };
  // Runs are drawings of their own: paths count from the run's first one.
  std::pmr::vector<shader::SegmentRecord>& segments = tables.segments;
  segments.assign(outlines.segments.begin(), outlines.segments.end());
  std::pmr::vector<ClipRecord> clips(drawing.clips.begin(), drawing.clips.end(), memory);
  for (const LayerRun& run : drawing.plan.runs) {
    const uint32_t begin = run.firstPath, end = begin + run.pathCount;
    for (uint32_t i = begin ? outlines.ends[begin - 1] : 0; i < (end ? outlines.ends[end - 1] : 0); ++i)
      segments[i].path -= begin;
    for (size_t i = 0; i < clips.size(); ++i)
      if (drawing.clips[i].firstPath >= begin && drawing.clips[i].firstPath < end) clips[i].firstPath -= begin;
  }
  std::pmr::vector<shader::BoxedPath> paths(memory);
  for (size_t i = 0; i < drawing.paths.size(); ++i) paths.push_back({outlines.boxes[i], drawing.paths[i]});
  tables.paths = add(paths);
  tables.slots.paints = add(drawing.paints);
  tables.slots.stops = add(drawing.stops);
  tables.slots.clips = add(clips);
  tables.slots.layers = add(drawing.layers);
  tables.entries = add(drawing.plan.tables);
  for (const LayerStep& step : drawing.plan.steps) {
    std::pmr::vector<float> lattice(memory);
    if (step.kind == GPGP_FILTER_TURBULENCE) appendLattice(step.values[3], lattice);
    tables.lattices.push_back(add(lattice));
  }
  return tables;
}

core::Result<core::Unique<SegmentPage>> SegmentPage::create(core::Context& context, const char* label,
                                                            std::span<const shader::SegmentRecord> segments) {
  auto page = core::makeUnique<SegmentPage>(context.host(), context, label);
  const auto from = std::as_bytes(segments);
  std::pmr::vector<std::byte> bytes(from.begin(), from.end(), &context.host());
  if (auto ok = page->makeResident(GPGP_SERVICE_VECTOR, std::move(bytes), 16, Room::shared); !ok) return ok.error();
  return page;
}

core::Result<void> checkMethods(GpgpDrawingMethods methods) {
  if (methods & ~(GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS | GPGP_DRAWING_PATCHES))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "methods has unknown bits");
  if ((methods & GPGP_DRAWING_PATCHES) && !(methods & GPGP_DRAWING_FLATTENED))
    return core::makeError(
        GPGP_ERROR_INVALID_ARGUMENT,
        "methods has GPGP_DRAWING_PATCHES without GPGP_DRAWING_FLATTENED, which canvases need as well");
  return {};
}

core::Result<core::Unique<DrawingAsset>> DrawingAsset::create(core::Context& context, const GpgpDrawingCreateInfo& info,
                                                              const DrawingAsset* base) {
  if (auto ok = checkMethods(info.methods); !ok) return ok.error();
  if ((info.editable || info.hitTestable || info.base) && info.methods && !(info.methods & GPGP_DRAWING_FLATTENED))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "methods has no GPGP_DRAWING_FLATTENED, which edits and hit tests need");
  if (base && !base->kept()) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "base was not made editable");
  std::pmr::memory_resource* memory = &context.host();
  const std::span edits(info.edits, info.editCount);
  const bool flattened = info.methods == 0 || (info.methods & GPGP_DRAWING_FLATTENED);
  const uint64_t mostBytes = flattened ? outlineBytes(context.device.limits.maxStorageBufferRange) : UINT64_MAX;
  const auto convert = [&]() -> core::Result<Drawing> {
    if (base) return replacePaths(base->kept()->drawing, edits, memory, mostBytes);
    if (info.paths)
      return makeDrawing(std::span(info.paths, info.pathCount), std::span(info.groups, info.groupCount), memory,
                         &context.jobSystem, nullptr, mostBytes);
    if (info.data) return loadBaked(std::span(static_cast<const std::byte*>(info.data), info.size), memory);
    const auto bytes = context.readFile(info.filePath);
    if (!bytes) return bytes.error();
    return loadBaked(*bytes, memory);
  };
  auto made = convert();
  if (!made) return made.error();
  const GpgpDrawingMethods held = methodsOf(*made), methods = info.methods ? info.methods : held;
  if ((held & GPGP_DRAWING_FLATTENED) == 0 && (methods != GPGP_DRAWING_IN_PASS || info.editable || info.hitTestable))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "the drawing was baked without GPGP_DRAWING_FLATTENED; bake it with both methods");
  if (!made->plan.empty() && (info.editable || info.hitTestable || (methods & GPGP_DRAWING_IN_PASS)))
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the drawing has layers: it cannot be %s",
                           info.editable      ? "editable"
                           : info.hitTestable ? "hitTestable"
                                              : "drawn inside a render pass (GPGP_DRAWING_IN_PASS)");
  return make(context, info.label, std::move(*made), info.editable != VK_FALSE, info.hitTestable != VK_FALSE, methods,
              base, edits);
}

core::Result<core::Unique<DrawingAsset>> DrawingAsset::make(core::Context& context, const char* label,
                                                            Drawing&& drawing, bool editable, bool hitTestable,
                                                            GpgpDrawingMethods methods, const DrawingAsset* base,
                                                            std::span<const GpgpPathEdit> edits) {
  auto asset = core::makeUnique<DrawingAsset>(context.host(), context, label);
  asset->curves_ = static_cast<uint32_t>(drawing.curves.size());
  const bool flattened = (methods & GPGP_DRAWING_FLATTENED) != 0;
  Outlines outlines = !flattened ? Outlines(&context.host())
                      : base     ? editOutlines(drawing, base->kept_->outlines, edits, &context.host())
                                 : makeOutlines(drawing, &context.host());
  asset->methods_ = methods;
  if (!flattened) outlines.ends.resize(drawing.paths.size(), 0);
  for (const shader::vec4& box : outlines.boxes)
    if (box.x <= box.z)
      asset->ink_ = {std::min(asset->ink_.x, box.x), std::min(asset->ink_.y, box.y), std::max(asset->ink_.z, box.z),
                     std::max(asset->ink_.w, box.w)};
  asset->patches_ = static_cast<uint32_t>(drawing.patches.size());
  asset->ends_.assign(outlines.ends.begin(), outlines.ends.end());
  for (const PaintRecord& paint : drawing.paints)
    if (paint.kind == shader::kPaintImage) asset->images_ = std::max(asset->images_, paint.firstStop + 1);
  for (const LayerRecord& layer : drawing.layers) asset->layerDepth_ = std::max(asset->layerDepth_, layer.depth);
  std::copy_n(drawing.bounds, 4, asset->bounds_);
  std::copy_n(drawing.viewport, 4, asset->viewport_);
  DrawingTables tables(&context.host());
  if (flattened) tables = packDrawing(drawing, outlines, &context.host());
  if (methods & GPGP_DRAWING_IN_PASS) {
    auto patches =
        drawing.words.empty() ? makePatches(drawing, &context.host()) : core::Result<Patches>(Patches(&context.host()));
    if (!patches) return patches.error();
    if (!drawing.words.empty()) patches->words = std::move(drawing.words);
    asset->patchWords_ = append(patches->words, tables.bytes);
    asset->quads_ = quadsOf(patches->words);
    asset->pathsLeftOut_ = patches->words[0].z;
    for (const Patches::LeftOut& left : patches->leftOut)
      context.message(
          GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, "gpgpCreateDrawing", label,
          core::makeError(GPGP_ERROR_UNSUPPORTED, "paths[%u] is left out of the patches: %s", left.path, left.reason)
              .text);
  }
  if (methods & GPGP_DRAWING_PATCHES) {
    const auto patches = makeTilePatches(drawing, &context.host());
    if (!patches) return patches.error();
    asset->tilePatchTable_ = append(patches->patches, tables.bytes);
    asset->tileCurveTable_ = append(patches->curves, tables.bytes);
    asset->tilePatchEnds_.assign(patches->ends.begin(), patches->ends.end());
  }
  if (!drawing.plan.empty()) asset->setLayers(drawing, outlines);
  if (auto ok = asset->placeSegments(tables); !ok) return ok.error();
  if (auto ok = asset->makeResident(GPGP_SERVICE_VECTOR, std::move(tables.bytes), 16, Room::shared); !ok)
    return ok.error();
  // From here on, what lies in the buffer is counted from its beginning.
  const uint32_t first = static_cast<uint32_t>(asset->offset() / sizeof(shader::vec4));
  asset->segmentTable_ += first;
  asset->pathTable_ = first + tables.paths;
  asset->patchWords_ += first;
  asset->tilePatchTable_ += first;
  asset->tileCurveTable_ += first;
  const shader::SlotRecord& t = tables.slots;
  asset->tables_ = {first + t.paints, first + t.stops, first + t.clips, first + t.layers};
  asset->entryTable_ = first + tables.entries;
  for (const uint32_t lattice : tables.lattices) asset->lattices_.push_back(first + lattice);
  if (!editable && hitTestable)
    asset->hit_.emplace(Hit{std::move(outlines), std::move(drawing.paths), std::move(drawing.clips)});
  if (editable) asset->kept_.emplace(Kept{std::move(drawing), std::move(outlines)});
  return asset;
}

/// Behind the other tables, or in pages where that is more than the device binds.
core::Result<void> DrawingAsset::placeSegments(DrawingTables& tables) {
  const std::span<const shader::SegmentRecord> segments(tables.segments);
  const size_t most = context.device.limits.maxStorageBufferRange, ofPage = most / sizeof segments[0];
  if (tables.bytes.size() + segments.size_bytes() <= most) {
    segmentTable_ = append(segments, tables.bytes);
    return {};
  }
  if (segments.size_bytes() > outlineBytes(context.device.limits.maxStorageBufferRange))
    return OutlineRoom(outlineBytes(context.device.limits.maxStorageBufferRange)).error();
  for (size_t begin = 0; begin < segments.size(); begin += ofPage) {
    const size_t count = std::min(ofPage, segments.size() - begin);
    auto page = SegmentPage::create(context, label.text, segments.subspan(begin, count));
    if (!page) return page.error();
    (*page)->end = static_cast<uint32_t>(begin + count);
    pages_.push_back(std::move(*page));
  }
  return {};
}

void DrawingAsset::attach() {
  Resident::attach();
  for (const auto& page : pages_) page->attach();
}

void DrawingAsset::retire() {
  Resident::retire();
  for (const auto& page : pages_) page->retire();
}

bool DrawingAsset::resident() const {
  return Resident::resident() && std::all_of(pages_.begin(), pages_.end(), [](const auto& p) { return p->resident(); });
}

void DrawingAsset::setLayers(const Drawing& drawing, const Outlines& outlines) {
  std::pmr::memory_resource* memory = &context.host();
  std::pmr::vector<Box> boxes(memory), runs(memory);
  for (const shader::vec4& b : outlines.boxes) boxes.push_back({b.x, b.y, b.z, b.w});
  for (const ClipRecord& clip : drawing.clips) std::fill_n(boxes.begin() + clip.firstPath, clip.pathCount, Box{});
  for (const LayerRun& run : drawing.plan.runs) {
    Box box;
    for (uint32_t i = 0; i < run.pathCount; ++i) box = join(box, boxes[run.firstPath + i]);
    runs.push_back(box);
  }
  plan_ = drawing.plan;
  layerBounds_ = boundsOf(plan_, runs, memory);
}

core::Result<core::Unique<CanvasHistory>> CanvasHistory::create(core::Context& context,
                                                                const GpgpCanvasHistoryCreateInfo& info) {
  const bool pictured = info.width || info.height || info.maxKept == 0;
  if (pictured && (info.width == 0 || info.height == 0 || info.width > 16384 || info.height > 16384))
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "width x height is %u x %u; expected 1 x 1 to 16384 x 16384",
                           info.width, info.height);
  if (info.maxKept > 1u << 22)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxKept is %u; at most 4194304", info.maxKept);
  auto view = core::makeUnique<CanvasHistory>(context.host(), context, info.label);
  view->width = info.width;
  view->height = info.height;
  if (info.maxKept) view->kept.emplace(info.maxKept, &context.host());
  const std::pmr::vector<std::byte> none(&context.host());
  if (auto ok = view->makeResident(GPGP_SERVICE_VECTOR, none, VkDeviceSize(info.width) * info.height * 8); !ok)
    return ok.error();
  return view;
}

} // namespace gpgp::vector
