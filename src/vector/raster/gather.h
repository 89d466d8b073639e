// A recording's items as the GPU takes them: sources (maps), placements (what is drawn by which of them), tables of
// shapes.
//
// Items come in painting order. Where a budget ends, everything from there on is left out, and counted, so that the
// report can say what all would have needed.
#pragma once
#include "core/recorder.h"
#include "vector/raster/drawing_asset.h"
#include "vector/raster/glyph_set.h"
#include "vector/raster/kept.h"
#include "vector/raster/layer_plan.h"
#include "vector/ui/list.h"

namespace gpgp::vector {

/// What an item shows: one of them.
struct ItemAsset {
  const DrawingAsset* drawing = nullptr;
  const GlyphSet* glyphSet = nullptr;
  const List* list = nullptr;
  bool layered() const; ///< whether it shows a list or drawing with layers
};

struct ItemBudgets {
  uint32_t items, glyphs, shapes, paths;
};
/// Different drawings and glyph sets of a recording; and with the pages of drawings, of which a buffer holds one.
constexpr uint32_t maxDrawnAssets(const ItemBudgets& budgets) { return std::min(budgets.items, shader::kMaxAssets); }
constexpr uint32_t maxAssets(const ItemBudgets& budgets) {
  return std::min(budgets.items + shader::kMaxBuffers, shader::kMaxAssets);
}
/// Placements that stand for pages of drawings, beside those of items, glyphs and shapes.
constexpr uint32_t kMaxPlacedPages = 64;
constexpr size_t maxPlacements(const ItemBudgets& budgets) {
  return size_t(budgets.items) + budgets.glyphs + budgets.shapes + kMaxPlacedPages;
}

/// Room for what one recording has, made once.
struct ItemTables {
  ItemTables(const ItemBudgets& budgets, std::pmr::memory_resource* memory);
  /// What is around a thing.
  struct ClipState {
    shader::vec4 scissor;
    uint32_t chain;     ///< 1 + index of the last of its clips that is no scissor; 0: none
    bool hidden;        ///< nothing shows
    uint32_t layer = 0; ///< 1 + index of the innermost group that fades it; 0: none
  };
  struct GroupState {
    uint32_t layer;
    float opacity; ///< of each thing in it
  };
  std::pmr::vector<shader::ItemRecord> sources;
  std::pmr::vector<uint64_t> sourceStates, clipStateHashes; ///< of sources and clips, as Gather::shows() needs them
  std::pmr::vector<shader::ShapeRecord> shapes;
  std::pmr::vector<shader::PaintRecord> paints;
  std::pmr::vector<shader::StopRecord> stops;
  std::pmr::vector<shader::ItemClipRecord> clips;
  std::pmr::vector<shader::LayerRecord> layers;
  std::pmr::vector<shader::PatchItemRecord> patchItems;
  std::pmr::vector<ClipState> clipStates; ///< of the list at hand, as are these
  std::pmr::vector<GroupState> groupStates;
  std::pmr::vector<uint8_t> clipsWanted, groupsWanted; ///< of lists with layers: 1: in the run at hand
  std::pmr::vector<const core::Resident*> assets;      ///< different ones
  std::pmr::vector<uint32_t> assetSlots;               ///< theirs
  std::pmr::vector<shader::SlotRecord> slots;          ///< by asset; the first one is the recording's own
  std::pmr::vector<uint16_t> assetCells; ///< hash table, open addresses: 1 + index; 0: empty; half full at most
};

class Gather {
public:
  /// `placed`: room for one of each item, glyph and shape of the budgets; only written. `smallGlyphRoom`: how many tile
  /// entries small glyphs may take for themselves (small_glyphs.comp). `planner`: of recordings that show layers; null
  /// in others. `kept`: takes the things that are placed; where `damagedOnly` it has them, and says which are.
  Gather(core::Context& context, const ItemBudgets& budgets, ItemTables& tables, shader::PlacementRecord* placed,
         const GpgpCanvasInfo& info, uint32_t smallGlyphRoom, bool patches, LayerPlanner* planner = nullptr,
         KeptRecording* kept = nullptr, bool damagedOnly = false)
      : patched_(patches), kept_(kept), damagedOnly_(damagedOnly),
        planner_(planner), base_{{0, 0, static_cast<int>(info.width), static_cast<int>(info.height)}, 0, 0},
        region_(base_), context_(context), budgets_(budgets), tables_(tables), placed_(placed), info_(info),
        smallGlyphRoom_(smallGlyphRoom) {
    std::fill(tables.assetCells.begin(), tables.assetCells.end(), uint16_t(0));
    std::fill_n(tables.slots.begin(), shader::kSlots, shader::SlotRecord{});
  }

  /// What the planner must know of an item; before all that follows.
  core::Result<void> plan(uint32_t index, const ItemAsset& asset);
  /// NOT_READY where a glyph or a list's drawing is not resident.
  core::Result<void> add(uint32_t index, const ItemAsset& asset);
  /// Counts into the header, and where the tables of shapes will lie.
  void finish(shader::CanvasHeader& header);

  /// Records of the first slots, as they lie behind the header.
  std::span<const shader::SlotRecord> firstSlots() const { return std::span(tables_.slots).first(shader::kSlots); }
  std::span<const core::Resident* const> assets() const { return std::span(tables_.assets).first(assetCount); }
  uint32_t assetCount = 0; ///< different drawings and glyph sets
  struct BoundBuffer {
    VkBuffer buffer;
    VkDeviceSize size;
  };
  std::span<const BoundBuffer> buffers() const { return std::span(buffers_).first(bufferCount_); }
  /// Of the recording's items that patches draw; none: zeros.
  shader::PatchTableRecord patchTable{};
  /// Writes it behind the records of slots, where shaders find it. `limit`: patches in tiles, at most.
  void placePatchTable(uint32_t limit);
  /// Of the table of slots: as many records, with the table of patches.
  uint32_t slots() const { return assetCount + 1 + (patchItems ? kPatchTableSlots : 0); }
  static constexpr uint32_t kPatchTableSlots = sizeof(shader::PatchTableRecord) / sizeof(shader::SlotRecord);
  bool gradients = false, projective = false, images = false, groups = false; ///< whether there are any
  bool lists = false; ///< there are scissors or clips, which shaders for one drawing do not know, nor shapes
  uint32_t smallGlyphs() const { return used_.smallGlyphs; }             ///< small glyphs
  uint32_t smallGlyphEntries() const { return used_.smallGlyphEntries; } ///< what they take at most
  uint32_t placements() const { return used_.placements; }
  bool complete() const { return !full_; } ///< nothing was left out
  uint32_t sources = 0, shapes = 0, paints = 0, stops = 0, clips = 0, layers = 0, patchItems = 0; ///< used

private:
  static constexpr uint32_t kNone = UINT32_MAX;
  using Chain = ItemTables::ClipState;
  core::Result<void> addDrawing(const DrawingAsset& drawing, const Map& map, float opacity, uint32_t firstImage,
                                const Chain& clip, bool plain = true);
  core::Result<void> planDrawing(const DrawingAsset& drawing, const Map& map, float opacity, const Chain& own);
  void addPatches(const DrawingAsset& drawing, uint32_t first, uint32_t end);
  core::Result<void> addRun(const DrawingAsset& drawing, uint32_t run, uint32_t source, uint32_t slot);
  core::Result<bool> addPages(const DrawingAsset& drawing, uint32_t begin, uint32_t end, uint32_t source);
  core::Result<void> addLayered(const DrawingAsset& drawing, uint32_t firstImage);
  bool lookAtPlain();
  void beginPlain();
  Chain ownOf(const GpgpCanvasItem& item) const;
  struct Block;
  class SmallGlyph;
  core::Result<void> addGlyphs(const GlyphSet& set, std::span<const GpgpGlyphInstance> glyphs, uint32_t source);
  void addBlock(const Block& block, uint32_t source);
  bool showsGlyph(const Block& block, size_t k, uint32_t source);
  core::Result<void> checkInstances(std::span<const GpgpGlyphInstance> glyphs, size_t first, size_t end) const;
  core::Result<void> addList(const List& list, const GpgpCanvasItem& item, const Chain& own);
  core::Result<void> addLayeredList(const List& list, const GpgpCanvasItem& item, const Map& map, const Chain& own);
  void wantClips(const List& list, const PlacedRun& run);
  /// As sources go: what follows each other in the same space shares one.
  struct Last {
    uint32_t source = kNone, base = kNone, clip = kNone, group = kNone;
    LayerRegion region;
  };
  /// `plain`: it is a unit of the planner's.
  core::Result<void> addCommand(const List& list, const List::Command& command, const GpgpCanvasItem& item,
                                const Map& map, float opacity, const Chain& own, bool plain, Last& last);
  core::Result<void> resolveClips(const List& list, const Map& map, const Chain& own, bool all);
  void resolveGroups(const List& list, float opacity, bool all);
  void addShapes(const List& list, std::span<const List::Shape> from, uint32_t source);
  bool addShape(const shader::ShapeRecord& shape, uint32_t source, const shader::vec4& color);
  bool showsShape(const List& list, const List::Shape& shape, uint32_t source);
  uint32_t addSource(const Map& map, float opacity, uint32_t firstImage, const Chain& clip);
  /// Whether a thing is placed: `state` adds what its pixels depend on to a hash, `tiles` finds its box.
  template <class State, class Tiles> bool shows(uint32_t source, const State& state, const Tiles& tiles) {
    if (!kept_) return true;
    if (damagedOnly_) return kept_->shows(thing_++);
    StateHash hash;
    state(hash.add(tables_.sourceStates[source]));
    kept_->add(hash.value(), tiles);
    return true;
  }
  TileBox tilesOf(const shader::ItemRecord& item, const shader::vec4& box, const shader::vec4& frame) const;
  TileBox tilesOf(const shader::ShapeRecord& shape, uint32_t source) const;
  uint64_t stateOf(const shader::ItemRecord& source) const;
  void addImage(StateHash& hash, uint64_t image) const;
  static uint64_t identityOf(const core::Object& asset);
  static constexpr shader::vec4 kNoFrame{0, 0, 1, 0};
  /// kNone where there is no room for another asset.
  core::Result<uint32_t> bind(const core::Resident& asset, const shader::SlotRecord& tables, bool page = false);
  [[gnu::format(printf, 3, 4)]] core::Error wrong(GpgpResult code, const char* format, ...) const;

  BoundBuffer buffers_[shader::kMaxBuffers] = {};
  uint32_t bufferCount_ = 0;
  const bool patched_; ///< drawings that have patches are drawn by them
  KeptRecording* const kept_;
  const bool damagedOnly_;
  uint32_t thing_ = 0; ///< of kept_'s
  LayerPlanner* const planner_;
  LayerRegion base_, region_; ///< where plain things go; where what is added lies
  uint32_t unit_ = 0, nextRun_ = 0;
  Map moved_; ///< of the source that was added last, from its drawing to where it is rasterised
  uint32_t firstPatchPath_ = 0;
  core::Context& context_;
  const ItemBudgets budgets_;
  ItemTables& tables_;
  shader::PlacementRecord* const placed_;
  const GpgpCanvasInfo& info_;
  uint32_t index_ = 0, entry_ = kNone; ///< of the item and of the list's command at hand
  struct Used {
    uint32_t paths = 0, segments = 0, patches = 0, placements = 0, smallGlyphs = 0, smallGlyphEntries = 0;
    uint32_t pages = 0; ///< placements that stand for them
    uint32_t boundPages = 0;
    uint32_t glyphs = 0; ///< those without room, too
  } used_;
  uint32_t sourcesNeeded_ = 0, layersNeeded_ = 0, assetsNeeded_ = 0;
  uint32_t shapesNeeded_ = 0, paintsNeeded_ = 0, stopsNeeded_ = 0;
  uint32_t pathsDropped_ = 0, clipsDropped_ = 0;
  const uint32_t smallGlyphRoom_;
  bool full_ = false; ///< something did not fit whole: nothing more is drawn, so that what is there is what lies below
};

} // namespace gpgp::vector
