// Drawings and canvas histories as the engine holds them: resident after upload.
#pragma once
#include "core/resident.h"
#include "vector/patch/patches.h"
#include "vector/raster/kept.h"
#include "vector/raster/segments.h"

#include <optional>

namespace gpgp::vector {

/// A drawing's tables, one behind the other: paths with their boxes, paints, stops, clips, layers. And its segments,
/// which may lie elsewhere.
struct DrawingTables {
  explicit DrawingTables(std::pmr::memory_resource* memory) : bytes(memory), segments(memory), lattices(memory) {}
  std::pmr::vector<std::byte> bytes;
  std::pmr::vector<shader::SegmentRecord> segments;
  uint32_t paths = 0;                  ///< where BoxedPaths begin, in vec4
  shader::SlotRecord slots{};          ///< and the other tables
  uint32_t entries = 0;                ///< tables of filters, four numbers in each vec4
  std::pmr::vector<uint32_t> lattices; ///< of the steps of filters that make noise
};
DrawingTables packDrawing(const Drawing& drawing, const Outlines& outlines, std::pmr::memory_resource* memory);

/// Segments of a drawing that has more than a device binds at once: as many as one buffer holds.
class SegmentPage final : public core::Resident {
public:
  static core::Result<core::Unique<SegmentPage>> create(core::Context& context, const char* label,
                                                        std::span<const shader::SegmentRecord> segments);
  SegmentPage(core::Context& owner, const char* name) : Resident(owner, core::Kind::drawing, name) {}
  uint32_t end = 0; ///< in the drawing's segments: those of the next page begin there
};

/// Bits that there are, and that go together.
core::Result<void> checkMethods(GpgpDrawingMethods methods);

class DrawingAsset final : public core::Resident {
public:
  /// What edited drawings are made from.
  struct Kept {
    Drawing drawing;
    Outlines outlines;
  };
  /// What hit tests ask.
  struct Shown {
    const Outlines& outlines;
    std::span<const PathRecord> paths;
    std::span<const ClipRecord> clips;
  };
  /// Converts what the info has, or loads what was baked. base: the asset of info.base, or null.
  static core::Result<core::Unique<DrawingAsset>> create(core::Context& context, const GpgpDrawingCreateInfo& info,
                                                         const DrawingAsset* base);
  DrawingAsset(core::Context& owner, const char* name)
      : Resident(owner, core::Kind::drawing, name), plan_(&owner.host()), layerBounds_(&owner.host()),
        lattices_(&owner.host()), ends_(&owner.host()), tilePatchEnds_(&owner.host()), pages_(&owner.host()) {}
  void attach() override;
  void retire() override;
  bool resident() const override;

  /// How many segments the first n paths have.
  uint32_t segments(size_t paths) const { return paths ? ends_[paths - 1] : 0; }
  uint32_t paths() const { return static_cast<uint32_t>(ends_.size()); }
  uint32_t curves() const { return curves_; }
  uint32_t patches() const { return patches_; }
  uint32_t pathTable() const { return pathTable_; } ///< where BoxedPaths begin, in vec4
  GpgpDrawingMethods methods() const { return methods_; }
  uint32_t patchWords() const { return patchWords_; } ///< where its patches begin, in vec4
  const PatchQuads& quads() const { return quads_; }  ///< that a draw of its patches has
  uint32_t pathsLeftOut() const { return pathsLeftOut_; }
  /// Patches for canvases of GPGP_CANVAS_PATCHES: where they and their curves begin in its buffer, in vec4; which are
  /// those of the first n paths.
  uint32_t tilePatchTable() const { return tilePatchTable_; }
  uint32_t tileCurveTable() const { return tileCurveTable_; }
  uint32_t tilePatches(size_t paths) const { return paths ? tilePatchEnds_[paths - 1] : 0; }
  const shader::SlotRecord& tables() const { return tables_; }
  bool groups() const { return tables_.layers > tables_.clips || layerDepth_; } ///< that clip or fade
  uint32_t layerDepth() const { return layerDepth_; }                           ///< groups that fade in each other
  const LayerPlan& plan() const { return plan_; }                               ///< empty where it has no layers
  const LayerBounds& layerBounds() const { return layerBounds_; }
  uint32_t tableOf(uint32_t entry) const { return entryTable_ + entry / 4; } ///< of a filter, in vec4
  uint32_t latticeOf(uint32_t step) const { return lattices_[step]; }        ///< of a filter's noise, likewise
  /// Where its segments lie; none: in its own buffer.
  std::span<const core::Unique<SegmentPage>> pages() const { return pages_; }
  /// A part that is placed by itself: where its segments and paths begin in its buffer, in vec4, and how many there
  /// are. Where there are pages, its segments begin in one of them.
  struct Run {
    uint32_t segmentTable, pathTable, firstPath, paths;
  };
  Run run(uint32_t index) const {
    if (plan_.empty()) return {segmentTable_, pathTable_, 0, paths()};
    const LayerRun& r = plan_.runs[index];
    return {segmentTable_ + segments(r.firstPath) * uint32_t(sizeof(shader::SegmentRecord) / 16),
            pathTable_ + r.firstPath * uint32_t(sizeof(shader::BoxedPath) / 16), r.firstPath, r.pathCount};
  }
  bool gradients() const { return tables_.stops > tables_.paints; }
  uint32_t images() const { return images_; } ///< how many of the recording's images it needs
  const Kept* kept() const { return kept_ ? &*kept_ : nullptr; }
  /// Where it is hit-testable.
  std::optional<Shown> shown() const {
    if (kept_) return Shown{kept_->outlines, kept_->drawing.paths, kept_->drawing.clips};
    if (hit_) return Shown{hit_->outlines, hit_->paths, hit_->clips};
    return std::nullopt;
  }
  const float* bounds() const { return bounds_; }
  /// The box of all boxes of its paths, those of clips included; turned over without any.
  const shader::vec4& ink() const { return ink_; }
  const float* viewport() const { return viewport_; }

private:
  core::Result<void> placeSegments(DrawingTables& tables);
  /// `base` and `edits`: where the drawing comes from replacePaths, what its other outlines are taken from. `patches`:
  /// those of the file that it comes from; none: they are made where `methods` asks for them.
  static core::Result<core::Unique<DrawingAsset>> make(core::Context& context, const char* label, Drawing&& drawing,
                                                       bool editable, bool hitTestable, GpgpDrawingMethods methods,
                                                       const DrawingAsset* base = nullptr,
                                                       std::span<const GpgpPathEdit> edits = {});
  void setLayers(const Drawing& drawing, const Outlines& outlines);
  LayerPlan plan_;
  LayerBounds layerBounds_;
  uint32_t entryTable_ = 0;
  std::pmr::vector<uint32_t> lattices_;
  std::pmr::vector<uint32_t> ends_;          // of segments, by path
  std::pmr::vector<uint32_t> tilePatchEnds_; // of patches, by path
  std::pmr::vector<core::Unique<SegmentPage>> pages_;
  uint32_t tilePatchTable_ = 0, tileCurveTable_ = 0;
  std::optional<Kept> kept_; // where it is editable
  struct Hit {
    Outlines outlines;
    std::pmr::vector<PathRecord> paths;
    std::pmr::vector<ClipRecord> clips;
  };
  std::optional<Hit> hit_; // where it is hit-testable, but not editable
  uint32_t curves_ = 0, patches_ = 0, images_ = 0, segmentTable_ = 0, pathTable_ = 0, layerDepth_ = 0;
  GpgpDrawingMethods methods_ = GPGP_DRAWING_FLATTENED;
  uint32_t patchWords_ = 0, pathsLeftOut_ = 0;
  PatchQuads quads_;
  shader::SlotRecord tables_{};
  shader::vec4 ink_{3e38f, 3e38f, -3e38f, -3e38f};
  float bounds_[4] = {}, viewport_[4] = {};
};

/// One rasterised canvas: packed half4, premultiplied linear. And what the recording of it was, where it is to be kept.
class CanvasHistory final : public core::Resident {
public:
  static core::Result<core::Unique<CanvasHistory>> create(core::Context& context,
                                                          const GpgpCanvasHistoryCreateInfo& info);
  CanvasHistory(core::Context& owner, const char* name) : Resident(owner, core::Kind::canvasHistory, name) {}
  uint32_t width = 0, height = 0;                 ///< room; 0: it holds no picture
  uint32_t preparedWidth = 0, preparedHeight = 0; ///< what the last recording leaves; 0: nothing yet
  std::optional<KeptRecording> kept;
};

} // namespace gpgp::vector
