// A drawing as patches: the intermediate form of the vector service, and the stages that make it.
//
// Stages (each a function on values, a file each): outline -> crossings -> sweep -> drawing; baked reads and writes the
// result, print shows it. Everything here is run-time code: memory comes from the resource that is passed in.
#pragma once
#include "core/result.h"
#include "vector/geometry/shape.h"
#include "vector/patch/layers.h"
#include "vector/patch/outline_room.h"
#include "vector/shared/layout.h"

#include <gpgp/vector.h>

#include <optional>
#include <string>

namespace gpgp::vector {

using shader::ClipRecord;
using shader::CurveRecord;
using shader::LayerRecord;
using shader::PaintRecord;
using shader::PatchRecord;
using shader::PathRecord;
using shader::StopRecord;

struct Drawing {
  explicit Drawing(std::pmr::memory_resource* memory)
      : curves(memory), patches(memory), paths(memory), paints(memory), stops(memory), clips(memory), layers(memory),
        plan(memory), words(memory) {}
  std::pmr::vector<CurveRecord> curves;
  std::pmr::vector<PatchRecord> patches; ///< grouped by path, paths in painting order
  std::pmr::vector<PathRecord> paths;
  std::pmr::vector<PaintRecord> paints; ///< gradients and images that paths refer to
  std::pmr::vector<StopRecord> stops;   ///< of all gradients, each one's in a row
  std::pmr::vector<ClipRecord> clips;
  std::pmr::vector<LayerRecord> layers;
  LayerPlan plan;         ///< where it has layers (layers.h); their runs' clips' paths lie in front of each run's own
  float bounds[4] = {};   ///< left, top, right, bottom of the ink; all 0 where there is none
  float viewport[4] = {}; ///< x, y, width, height
  /// Of baked drawings: what makePatches made of it (patches.h). Where these are there and `patches` is empty, the file
  /// serves draws inside a render pass alone.
  std::pmr::vector<shader::uvec4> words;
};

constexpr float kMaxCoordinate = 1e7f;
constexpr float kMaxColor = 1e4f; // what becomes of it must be within what half floats hold

/// Whether a straight colour has what is allowed: RGB up to kMaxColor, alpha up to 1.
inline bool inColorRange(const float* c) {
  return c[0] >= 0 && c[0] <= kMaxColor && c[1] >= 0 && c[1] <= kMaxColor && c[2] >= 0 && c[2] <= kMaxColor &&
         c[3] >= 0 && c[3] <= 1;
}

/// Checks one path (verbs known, points enough, finite and within kMaxCoordinate, colour in range) and appends its
/// monotone pieces, open contours closed by a line. The error names the verb or point. `ellipses`: receives those that
/// arcs are parts of (Cubic::arc), strokes excepted.
core::Result<void> outline(const GpgpPath& path, std::pmr::vector<Monotone>& pieces,
                           std::pmr::vector<Ellipse>* ellipses = nullptr);

/// Where a piece must be cut because another crosses it there: its height and the piece (heightKey in order.h).
using Cut = uint64_t;
/// All heights at which two pieces change sides, for both pieces; by height, then by piece, each cut once. Cost near
/// linear for drawings whose pieces are short against the whole: pieces are dealt into horizontal bands of about their
/// own height, and within a band only those whose x ranges overlap are compared; where that would be too many, strips
/// (strips.h) find who is near. UNSUPPORTED where a path has more than kMaxCrossings, most often before they are looked
/// for (inversions.h), or where telling its curves apart takes far more work than the crossings do, as it does where
/// many coincide all but exactly, or in part. A pair of curves in a strip is 1, a row in which two are compared
/// kWorkOfRow.
constexpr size_t kMaxCrossings = size_t(1) << 22, kMaxWork = size_t(1) << 26;
constexpr size_t kWorkOfRow = 16, kWorkOfCrossing = 32, kWorkOfPiece = 1024;
core::Result<void> findCrossings(std::span<const Monotone> pieces, std::pmr::vector<Cut>& cuts);

/// A patch before it has a place in a table: pieces left and right, rows.
struct Slab {
  uint32_t left, right;
  float top, bottom;
};
/// Sweeps from top to bottom over pieces cut at `cuts`, as findCrossings gives them, and appends what the fill rule
/// calls inside as slabs, each as tall as its pair of pieces stays neighbours, by their tops, then by left and right
/// piece. The time is about that of the cuts, of level lines that pass other pieces, which no cut says, and of the
/// slabs. UNSUPPORTED where level lines pass others more than kMaxLevelCrossings times. The limit is that of other
/// crossings: a grid of bars may have as many of them when it stands upright as when it is turned.
constexpr size_t kMaxLevelCrossings = kMaxCrossings;
core::Result<void> sweep(std::span<const Monotone> pieces, std::span<const Cut> cuts, GpgpFillRule rule,
                         std::pmr::vector<Slab>& slabs);

/// Checks a gradient and appends its paint and stops; returns its index. A gradient that has no area to spread over
/// (equal ends, a transform without inverse) paints its last stop's colour, as SVG says; between equal circles or
/// points nothing is painted.
core::Result<uint32_t> addGradient(const GpgpGradient& gradient, Drawing& drawing);

/// Checks an image paint and appends it; returns its index.
core::Result<uint32_t> addImage(const GpgpImagePaint& image, Drawing& drawing);

/// All stages for one path; appends its patches, the curves they use and its colour. One that crosses itself more than
/// kMaxCrossings times is an error; with `tooMany`, where the error goes then, it is appended without patches. One
/// whose outline finds no room is an error; where it is known without looking for crossings, that is soon said.
core::Result<void> addPath(const GpgpPath& path, Drawing& drawing, OutlineRoom& room,
                           std::optional<core::Error>* tooMany = nullptr);

/// Grows bounds by the ink of a patch, whose own box has a float's step to spare; `first`: sets them.
void addInk(const PatchRecord& patch, bool first, float (&bounds)[4]);

/// Paints another drawing on top: how paths that were converted apart, or earlier, become one.
core::Result<void> append(const Drawing& part, Drawing& drawing);

/// A path that was left empty as it crosses itself too often, or that the drawing was refused for.
struct LeftEmpty {
  size_t group, index; ///< 0: of the paths; else 1 + a group's index, of its clip
  core::Error error;   ///< does not say which path
  bool refused = false;
};

/// The same with groups: their clips' paths come first, and paths know their clip and layer. Errors name the group.
/// `mostBytes`: of its outlines on the GPU; UNSUPPORTED as soon as it is known that they need more.
core::Result<Drawing> makeDrawing(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups,
                                  std::pmr::memory_resource* memory, const GpgpJobSystem* jobs = nullptr,
                                  std::pmr::vector<LeftEmpty>* leftEmpty = nullptr,
                                  uint64_t mostBytes = outlineBytes(0));

/// The drawing of paths in painting order; the same with and without jobs, which then call the memory resource side by
/// side. Errors name the path, `first` being the first one; with `leftEmpty`, paths that cross themselves too often go
/// there instead, and the path of an error does as well, as the last one.
core::Result<Drawing> makeDrawing(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory,
                                  const GpgpJobSystem* jobs = nullptr, std::pmr::vector<LeftEmpty>* leftEmpty = nullptr,
                                  size_t first = 0, OutlineRoom* room = nullptr);

/// How many paths at the front are there for clips alone.
uint32_t clipPaths(const Drawing& drawing);

/// The drawing with some paths replaced, which alone are converted: the same tables as if all were converted anew. An
/// index counts from the first path that is no clip's; of two edits of one path the later counts. Paths keep their clip
/// and layer, and a page that is not just the ink stays. Errors name the edit or the path. `mostBytes`: as above, of
/// the paths that are replaced.
core::Result<Drawing> replacePaths(const Drawing& base, std::span<const GpgpPathEdit> edits,
                                   std::pmr::memory_resource* memory, uint64_t mostBytes = outlineBytes(0));

/// FNV-1a over 8-byte words: every input bit reaches the result.
uint64_t checksum(std::span<const std::byte> bytes);
/// What a drawing from a file serves.
inline GpgpDrawingMethods methodsOf(const Drawing& drawing) {
  if (drawing.words.empty()) return GPGP_DRAWING_FLATTENED;
  return drawing.patches.empty() ? GPGP_DRAWING_IN_PASS : GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS;
}
/// Baked form: little-endian, versioned, checksummed. Into bakedSize() bytes, or into a table of its own.
size_t bakedSize(const Drawing& drawing);
void bake(const Drawing& drawing, std::span<std::byte> bytes);
std::pmr::vector<std::byte> bake(const Drawing& drawing, std::pmr::memory_resource* memory);
/// Checks everything that a shader would trust: sizes, indices, finite numbers, order. Errors: INVALID_DATA.
core::Result<Drawing> loadBaked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory);

/// The stages as SVG, for people to look at: paths as they came, filled; pieces, blue where they run down and red where
/// up, with their ends; where pieces are cut; and the patches, outlined over their fill. Bad paths are left out. All
/// four show the same part of the plane, the box around the paths' points.
std::pmr::string pathsToSvg(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory);
std::pmr::string piecesToSvg(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory);
std::pmr::string crossingsToSvg(std::span<const GpgpPath> paths, std::pmr::memory_resource* memory);
std::pmr::string patchesToSvg(std::span<const GpgpPath> paths, const Drawing& drawing,
                              std::pmr::memory_resource* memory);

} // namespace gpgp::vector
