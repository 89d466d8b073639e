// CPatches as shaders evaluate them (gpgp/shaders/patches.h): the implicit forms of a drawing's curves, slabs joined to
// patches of at most kMaxPatchCurves curves, and cells that say which patches meet them.
//
// Stages (a file each): forms (a curve's) -> join (a path's slabs) -> cells (its cells, and the drawing's words) ->
// quads (what is drawn).
#pragma once
#include "vector/patch/drawing.h"

namespace gpgp::vector {

/// What a patch may have: 4, or up to 8.
constexpr uint32_t kPatchCurves = 4, kMaxPatchCurves = 8;
/// Of a grid along an axis, and of a cell's list: a shader's loop ends on every device.
constexpr uint32_t kMostCells = 512, kMostInCell = 4096;

/// A curve with its implicit form: it runs down and never turns in x, in y or from bending left to bending right.
struct FormCurve {
  uint32_t kind = 0; ///< shader::PatchReader::kPatchLine, ...
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  float control[2] = {}, control2[2] = {}; ///< from the start
  float weight = 0;                        ///< of a conic
  float form[7] = {}; ///< of a cubic, from the start: factors of x, y, x^2, x y, y^2; then x and y of what is cubed
  double xAt(double y) const; ///< heights outside give the ends
};

/// Which kind of cubic a form was made for.
enum class CubicType { serpentine, cusp, loop };

/// Appends a curve as one or more of these, from top to bottom, ends shared bit for bit. A cubic whose form would not
/// tell sides apart, for its continuation comes back or rounding blurs it, is halved; `types`, where given, receives
/// the type of each curve that stays cubic.
void appendForms(const CurveRecord& curve, std::pmr::vector<FormCurve>& forms,
                 std::pmr::vector<CubicType>* types = nullptr);

/// Two arcs of one ellipse, the second from the first one's end on, as one; nothing where they are not that, or where
/// the whole would turn.
std::optional<FormCurve> joinArcs(const FormCurve& first, const FormCurve& second);

/// A patch of a path: rows, and curves by number, those on the left first, each side from top to bottom.
struct JoinedPatch {
  float top = 0, bottom = 0;
  uint32_t curves[kMaxPatchCurves] = {};
  uint32_t curveCount = 0, lefts = 0;
};

/// What a path's slabs become: curves that stand once in a table, arcs of an ellipse as long as they can be, and
/// patches. Slabs that lie above each other are joined as long as no more than `maxCurves` curves bound them.
struct JoinedPath {
  explicit JoinedPath(std::pmr::memory_resource* memory) : curves(memory), patches(memory) {}
  std::pmr::vector<FormCurve> curves;
  std::pmr::vector<JoinedPatch> patches;
};
JoinedPath joinSlabs(const Drawing& drawing, std::span<const PatchRecord> slabs, uint32_t maxCurves,
                     std::pmr::memory_resource* memory);

/// Appends a curve as shaders read it: its ends, and what its kind needs besides.
void appendCurve(const FormCurve& curve, std::pmr::vector<shader::uvec4>& words);

/// A drawing's patches for canvases that rasterise them tile by tile: of all paths, those of clips included.
struct TilePatches {
  explicit TilePatches(std::pmr::memory_resource* memory) : curves(memory), patches(memory), ends(memory) {}
  std::pmr::vector<shader::uvec4> curves;
  std::pmr::vector<shader::TilePatchRecord> patches; ///< grouped by path; curves count from the first one
  std::pmr::vector<uint32_t> ends;                   ///< of patches, by path
};
core::Result<TilePatches> makeTilePatches(const Drawing& drawing, std::pmr::memory_resource* memory);

/// A drawing as shaders read it, and what it holds.
struct Patches {
  struct LeftOut {
    uint32_t path; ///< counted from the first that paints
    const char* reason;
  };
  explicit Patches(std::pmr::memory_resource* memory) : words(memory), leftOut(memory) {}
  static constexpr uint32_t kVersion = 2;
  std::pmr::vector<shader::uvec4> words;
  uint32_t paths = 0, quads = 0, patches = 0, curves = 0, cells = 0, solidCells = 0, cellPatches = 0;
  std::pmr::vector<LeftOut> leftOut; ///< paths that patches do not draw, and so have none
};

/// What a draw of patches must know of them.
struct PatchQuads {
  uint32_t paths = 0, all = 0; ///< quads, one for each path and with those of cells
  float largestPixel = 0;      ///< in drawing units: where pixels are as large as that, no path's cells are drawn
};
PatchQuads quadsOf(std::span<const shader::uvec4> words);

/// All paths that paint, or `count` of them from `first` on. UNSUPPORTED where one cell has too many patches for a
/// shader's loop.
core::Result<Patches> makePatches(const Drawing& drawing, std::pmr::memory_resource* memory,
                                  uint32_t maxCurves = kPatchCurves, uint32_t first = 0, uint32_t count = UINT32_MAX);

/// Appends the quads of a path (gpgp/shaders/patch_quads.h) for the cells that its words hold: the first for all of it,
/// then cells that its edge passes and rectangles of solid ones, row by row.
/// Returns `smallest` of the path's record: how many pixels long cells are from which on it is less work to draw them.
float appendQuads(std::span<const shader::uvec4> words, uint32_t path, std::pmr::vector<shader::uvec4>& quads);

/// Checks everything that a shader would trust, in words from a file that has so many paths that paint. INVALID_DATA.
core::Result<void> checkPatches(std::span<const shader::uvec4> words, uint32_t paths,
                                std::pmr::memory_resource* memory = std::pmr::get_default_resource());

} // namespace gpgp::vector
