// A path's cells, and the words of a drawing that shaders read.
//
// Each path's box is cut into a grid of cells, some four for each curve that bounds it. A cell lists copies of the
// patches that meet it, without the curves that leave all of the cell on their inner side; a cell without any curve is
// solid. Coverage adds up over cells, so a pixel may meet any number of them: where it meets many, a table of summed
// areas answers instead.
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace gpgp::vector {
namespace {
using core::makeError;
using shader::PatchReader;
using shader::uvec4;
using shader::vec4;

double exact(float v) { return static_cast<double>(v); }
uint32_t bits(float v) { return std::bit_cast<uint32_t>(v); }
uvec4 bits(const vec4& v) { return {bits(v.x), bits(v.y), bits(v.z), bits(v.w)}; }

/// A float that is at most the value, or at least.
float below(double v) {
  const float f = static_cast<float>(v);
  return exact(f) <= v ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float above(double v) { return -below(-v); }

struct Range {
  double low = 1e300, high = -1e300;
  void add(double v) { low = std::min(low, v), high = std::max(high, v); }
};

class PathCells {
public:
  PathCells(Patches& drawing, std::pmr::memory_resource* memory)
      : drawing_(drawing), memory_(memory), lists_(memory), cells_(memory), places_(memory) {}

  /// Appends the path's tables and fills in its record, whose place is `record`.
  core::Result<void> run(const JoinedPath& path, uint32_t record) {
    if (path.patches.empty()) return {};
    path_ = &path;
    findBox();
    chooseGrid();
    lists_.clear();
    cells_.assign(size_t(columns_) * rows_, Cell{});
    for (const JoinedPatch& patch : path.patches) enter(patch);
    return write(record);
  }

private:
  struct Copy { // of a patch, in a cell
    uint32_t next = UINT32_MAX;
    JoinedPatch patch;
  };
  struct Cell {
    uint32_t first = UINT32_MAX, last = UINT32_MAX, count = 0;
  };

  /// Where a curve passes in some rows.
  Range rangeOf(const FormCurve& c, double top, double bottom) const {
    Range range;
    range.add(c.xAt(top));
    range.add(c.xAt(bottom));
    return range;
  }
  void findBox() {
    Range x, y;
    for (const JoinedPatch& p : path_->patches) {
      y.add(exact(p.top)), y.add(exact(p.bottom));
      for (uint32_t k = 0; k < p.curveCount; ++k) {
        const FormCurve& c = path_->curves[p.curves[k]];
        const Range range = rangeOf(c, std::max(exact(p.top), exact(c.y0)), std::min(exact(p.bottom), exact(c.y1)));
        x.add(range.low), x.add(range.high);
      }
    }
    box_ = {below(x.low), below(y.low), above(x.high), above(y.high)};
  }
  void chooseGrid() {
    const double width = std::max(exact(box_.z) - exact(box_.x), 1e-30),
                 height = std::max(exact(box_.w) - exact(box_.y), 1e-30);
    size_t slanted = 0; // curves that are no upright lines
    for (const FormCurve& c : path_->curves) slanted += c.kind != PatchReader::kPatchLine || c.x0 != c.x1;
    const double cells = slanted == 0 && path_->patches.size() <= 4 ? 1 : 4 * double(path_->curves.size());
    const auto along = [&](double ratio) {
      return static_cast<uint32_t>(std::clamp(std::round(std::sqrt(cells * ratio)), 1.0, double(kMostCells)));
    };
    columns_ = along(width / height);
    rows_ = along(height / width);
    columns_ = std::min<uint32_t>(columns_, static_cast<uint32_t>(std::max(4.0, std::ceil(cells / rows_))));
    cell_.x = above(width / columns_);
    cell_.y = above(height / rows_);
    cell_.z = 1.0f / cell_.x;
    cell_.w = 1.0f / cell_.y;
    // Rounding may show a cell a point that lies beside it.
    const double magnitude =
        std::max({std::abs(exact(box_.x)), std::abs(exact(box_.y)), std::abs(exact(box_.z)), std::abs(exact(box_.w))});
    marginX_ = 1e-4 * exact(cell_.x) + 1e-6 * magnitude;
    marginY_ = 1e-4 * exact(cell_.y) + 1e-6 * magnitude;
  }
  Range rowsOf(uint32_t row) const {
    const double size = exact(cell_.y);
    return {exact(box_.y) + row * size - marginY_, exact(box_.y) + (row + 1) * size + marginY_};
  }
  Range columnsOf(uint32_t column) const {
    const double size = exact(cell_.x);
    return {exact(box_.x) + column * size - marginX_, exact(box_.x) + (column + 1) * size + marginX_};
  }
  static uint32_t indexAt(double v, uint32_t count) {
    return static_cast<uint32_t>(std::clamp(std::floor(v), 0.0, double(count - 1)));
  }

  void enter(const JoinedPatch& patch) {
    const auto rowAt = [&](double y) { return indexAt((y - exact(box_.y)) / exact(cell_.y), rows_); };
    const uint32_t lastRow = rowAt(exact(patch.bottom) + 2 * marginY_);
    for (uint32_t row = rowAt(exact(patch.top) - 2 * marginY_); row <= lastRow; ++row) {
      const Range rows = rowsOf(row);
      const double top = std::max(rows.low, exact(patch.top)), bottom = std::min(rows.high, exact(patch.bottom));
      if (top >= bottom) continue;
      Range ranges[kMaxPatchCurves], left, right;
      bool meets[kMaxPatchCurves] = {};
      for (uint32_t k = 0; k < patch.curveCount; ++k) {
        const FormCurve& c = path_->curves[patch.curves[k]];
        const double from = std::max(top, exact(c.y0)), to = std::min(bottom, exact(c.y1));
        if (from >= to) continue;
        meets[k] = true;
        ranges[k] = rangeOf(c, from, to);
        Range& side = k < patch.lefts ? left : right;
        side.add(ranges[k].low), side.add(ranges[k].high);
      }
      const auto columnAt = [&](double x) { return indexAt((x - exact(box_.x)) / exact(cell_.x), columns_); };
      const uint32_t lastColumn = columnAt(right.high + 2 * marginX_);
      for (uint32_t column = columnAt(left.low - 2 * marginX_); column <= lastColumn; ++column) {
        const Range columns = columnsOf(column);
        if (left.low > columns.high || right.high < columns.low) continue;
        JoinedPatch copy{patch.top, patch.bottom, {}, 0, 0};
        for (uint32_t k = 0; k < patch.curveCount; ++k) {
          const bool isLeft = k < patch.lefts;
          if (!meets[k] || (isLeft ? ranges[k].high < columns.low : ranges[k].low > columns.high)) continue;
          copy.curves[copy.curveCount++] = patch.curves[k];
          copy.lefts += isLeft;
        }
        add(row * columns_ + column, copy);
      }
    }
  }
  void add(uint32_t index, const JoinedPatch& copy) {
    Cell& cell = cells_[index];
    if (cell.last != UINT32_MAX) { // one that goes on where the last has ended, neither with a curve
      JoinedPatch& last = lists_[cell.last].patch;
      if (!copy.curveCount && !last.curveCount && last.bottom == copy.top) {
        last.bottom = copy.bottom;
        return;
      }
    }
    const auto place = static_cast<uint32_t>(lists_.size());
    lists_.push_back({UINT32_MAX, copy});
    if (cell.last == UINT32_MAX)
      cell.first = place;
    else
      lists_[cell.last].next = place;
    cell.last = place;
    ++cell.count;
  }

  core::Result<void> write(uint32_t record) {
    auto& words = drawing_.words;
    const auto here = [&] { return static_cast<uint32_t>(words.size()); };
    const uint32_t curves = here();
    places_.clear();
    for (const FormCurve& c : path_->curves) {
      places_.push_back((here() - curves) | c.kind << PatchReader::kPatchCurveKind);
      appendCurve(c, words);
    }
    const uint32_t cells = here();
    words.resize(words.size() + (cells_.size() + 1) / 2);
    const uint32_t patches = here();
    for (size_t i = 0; i < cells_.size(); ++i) {
      const Cell& cell = cells_[i];
      const Range rows = rowsOf(static_cast<uint32_t>(i) / columns_);
      uint32_t count = cell.count, first = here() - patches;
      if (count > kMostInCell)
        return makeError(GPGP_ERROR_UNSUPPORTED, "%u patches meet in one cell; at most %u", count, kMostInCell);
      if (count == 1 && !lists_[cell.first].patch.curveCount && exact(lists_[cell.first].patch.top) <= rows.low &&
          exact(lists_[cell.first].patch.bottom) >= rows.high) {
        count = PatchReader::kPatchSolid, first = 0;
        ++drawing_.solidCells;
      } else {
        for (uint32_t at = cell.first; at != UINT32_MAX; at = lists_[at].next) {
          const JoinedPatch& p = lists_[at].patch;
          words.push_back({bits(p.top), bits(p.bottom), p.curveCount, p.lefts});
          for (uint32_t k = 0; k < p.curveCount; k += 4) {
            uint32_t four[4] = {};
            for (uint32_t j = k; j < std::min(k + 4, p.curveCount); ++j) four[j - k] = places_[p.curves[j]];
            words.push_back({four[0], four[1], four[2], four[3]});
          }
          ++drawing_.cellPatches;
        }
      }
      uvec4& pair = words[cells + i / 2];
      (i % 2 ? pair.z : pair.x) = first;
      (i % 2 ? pair.w : pair.y) = count;
    }
    const bool summed = columns_ > PatchReader::kPatchFewCells || rows_ > PatchReader::kPatchFewCells;
    const uint32_t sums = summed ? here() : 0;
    words[record + 1] = bits(box_);
    words[record + 2] = bits(cell_);
    words[record + 3].z = columns_;
    words[record + 3].w = rows_;
    words[record + 4] = {cells, patches, curves, sums};
    if (summed) writeSums(record);
    drawing_.cells += static_cast<uint32_t>(cells_.size());
    drawing_.patches += static_cast<uint32_t>(path_->patches.size());
    drawing_.curves += static_cast<uint32_t>(path_->curves.size());
    return {};
  }
  void writeSums(uint32_t record) {
    std::pmr::vector<float> sums(size_t(columns_ + 1) * (rows_ + 1), 0.0f, memory_);
    PatchReader reader(drawing_.words);
    const PatchReader::GpgpPatchPath path =
        reader.gpgpLoadPath(0, 0, (record - PatchReader::kPatchHeader) / PatchReader::kPatchPathSize);
    std::pmr::vector<double> above_(columns_ + 1, 0.0, memory_);
    const double whole = exact(cell_.x) * exact(cell_.y);
    const shader::vec2 far{box_.z - box_.x, box_.w - box_.y};
    for (uint32_t row = 0; row < rows_; ++row) {
      double left = 0;
      for (uint32_t column = 0; column < columns_; ++column) {
        left += exact(reader.gpgpCellArea(0, path, column, row, {box_.x, box_.y}, {0, 0}, far)) / whole;
        above_[column + 1] += left;
        sums[size_t(row + 1) * (columns_ + 1) + column + 1] = static_cast<float>(above_[column + 1]);
      }
    }
    for (size_t i = 0; i < sums.size(); i += 4) {
      uint32_t four[4] = {};
      for (size_t k = i; k < std::min(i + 4, sums.size()); ++k) four[k - i] = bits(sums[k]);
      drawing_.words.push_back({four[0], four[1], four[2], four[3]});
    }
  }

  Patches& drawing_;
  std::pmr::memory_resource* memory_;
  const JoinedPath* path_ = nullptr;
  vec4 box_{}, cell_{};
  uint32_t columns_ = 0, rows_ = 0;
  double marginX_ = 0, marginY_ = 0;
  std::pmr::vector<Copy> lists_;
  std::pmr::vector<Cell> cells_;
  std::pmr::vector<uint32_t> places_; // of curves
};

/// Why patches do not draw a path; null: they do. `alpha` receives what its layers leave of its alpha.
const char* reasonAgainst(const Drawing& drawing, std::span<const uint32_t> layerPaths, const PathRecord& path,
                          float& alpha) {
  if (path.clip) return "it is clipped";
  if (path.paint && drawing.paints[path.paint - 1].kind >= shader::kPaintImage) return "it is painted with an image";
  alpha = 1;
  for (uint32_t layer = path.layer; layer; layer = drawing.layers[layer - 1].parent) {
    if (layerPaths[layer - 1] > 1) return "it is in a group that is less than opaque and has other paths";
    alpha *= drawing.layers[layer - 1].opacity;
  }
  return nullptr;
}

} // namespace

void appendCurve(const FormCurve& c, std::pmr::vector<uvec4>& words) {
  words.push_back(bits({c.x0, c.y0, c.x1, c.y1}));
  if (c.kind == PatchReader::kPatchConic) words.push_back(bits({c.control[0], c.control[1], c.weight, 0}));
  if (c.kind == PatchReader::kPatchCubic) {
    words.push_back(bits({c.control[0], c.control[1], c.control2[0], c.control2[1]}));
    words.push_back(bits({c.form[0], c.form[1], c.form[2], c.form[3]}));
    words.push_back(bits({c.form[4], c.form[5], c.form[6], 0}));
  }
}

core::Result<Patches> makePatches(const Drawing& drawing, std::pmr::memory_resource* memory, uint32_t maxCurves,
                                  uint32_t firstPath, uint32_t count) {
  constexpr uint32_t kMostWords = (1u << 30) - 1; // what a curve's number can say
  Patches made(memory);
  if (!drawing.plan.empty())
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "patches do not draw layers, which the drawing has");
  const uint32_t hidden = clipPaths(drawing);
  const uint32_t painting = static_cast<uint32_t>(drawing.paths.size()) - hidden;
  made.paths = std::min(count, painting - std::min(firstPath, painting));
  made.words.resize(PatchReader::kPatchHeader + size_t(made.paths) * PatchReader::kPatchPathSize);
  std::pmr::vector<uint32_t> layerPaths(drawing.layers.size(), 0, memory);
  for (const PathRecord& path : drawing.paths)
    for (uint32_t layer = path.layer; layer; layer = drawing.layers[layer - 1].parent) ++layerPaths[layer - 1];
  const auto append = [&](const auto& record) {
    const size_t at = made.words.size();
    made.words.resize(at + sizeof record / sizeof(uvec4));
    std::memcpy(&made.words[at], &record, sizeof record);
    return static_cast<uint32_t>(at);
  };
  PathCells cells(made, memory);
  for (uint32_t i = 0; i < made.paths; ++i) {
    const uint32_t index = hidden + firstPath + i;
    const PathRecord& path = drawing.paths[index];
    const uint32_t record = PatchReader::kPatchHeader + i * PatchReader::kPatchPathSize;
    float alpha = 1;
    const char* reason = reasonAgainst(drawing, layerPaths, path, alpha);
    made.words[record] = bits({path.color.x, path.color.y, path.color.z, path.color.w * alpha});
    made.words[record + 1] = bits({1, 1, -1, -1}); // without ink
    made.words[record + 3] = {0, path.flags, 1, 1};
    if (reason) {
      made.leftOut.push_back({firstPath + i, reason});
      continue;
    }
    if (path.paint) { // as drawings have it, but with its stops' place in the words
      PaintRecord paint = drawing.paints[path.paint - 1];
      const auto stops = std::span(drawing.stops).subspan(paint.firstStop, paint.stopCount);
      paint.firstStop = static_cast<uint32_t>(made.words.size() + sizeof paint / sizeof(uvec4));
      made.words[record + 3].x = append(paint);
      for (const StopRecord& stop : stops) append(stop);
    }
    const auto slabs = std::equal_range(drawing.patches.begin(), drawing.patches.end(), PatchRecord{.path = index},
                                        [](const PatchRecord& a, const PatchRecord& b) { return a.path < b.path; });
    const JoinedPath joined = joinSlabs(drawing, std::span(slabs.first, slabs.second), maxCurves, memory);
    if (auto ok = cells.run(joined, record); !ok)
      return makeError(ok.error().code, "paths[%u]: %s", firstPath + i, ok.error().text);
    if (made.words.size() > kMostWords)
      return makeError(GPGP_ERROR_UNSUPPORTED, "the patches take more than %u bytes", kMostWords);
  }
  std::pmr::vector<uvec4> quads(memory);
  float largest = 0;
  for (uint32_t i = 0; i < made.paths; ++i) {
    uvec4* record = &made.words[PatchReader::kPatchHeader + i * PatchReader::kPatchPathSize];
    const float smallest = appendQuads(made.words, i, quads);
    record[5].x = bits(smallest);
    if (smallest > 0)
      largest =
          std::max(largest, std::min(std::bit_cast<float>(record[2].x), std::bit_cast<float>(record[2].y)) / smallest);
  }
  made.quads = static_cast<uint32_t>(quads.size());
  made.words[1] = {static_cast<uint32_t>(made.words.size()), made.quads, bits(largest), 0};
  made.words.insert(made.words.end(), quads.begin(), quads.end());
  made.words[0] = {made.paths, Patches::kVersion, static_cast<uint32_t>(made.leftOut.size()),
                   static_cast<uint32_t>(made.words.size())};
  return made;
}

} // namespace gpgp::vector
