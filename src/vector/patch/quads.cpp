// The quads that a draw of patches is made of, from a path's cells.
//
// Solid cells become rectangles: runs of a row, continued downwards as long as the next row has the same run. A quad
// knows which of its sides have an empty cell beyond them, corners included: to those sides alone it grows by what a
// pixel's coverage reaches.
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gpgp::vector {
namespace {
using shader::PatchReader;
using shader::uvec4;

class PathQuads {
public:
  PathQuads(std::span<const uvec4> words, uint32_t index, std::pmr::vector<uvec4>& quads)
      : words_(words), path_(PatchReader(words).gpgpLoadPath(0, 0, index)), index_(index), quads_(quads),
        taken_(quads.get_allocator().resource()) {}

  float run() {
    const bool single = path_.columns * path_.rows == 1;
    const bool solid = path_.box.x < path_.box.z && single && at(0, 0) == PatchReader::kPatchSolid;
    push(0, 0, path_.columns, path_.rows, PatchReader::kPatchQuadWhole | (solid ? PatchReader::kPatchQuadInside : 0u));
    if (single) return 0;
    const size_t first = quads_.size();
    uint32_t border = 0; // cells
    taken_.assign(size_t(path_.columns) * path_.rows, false);
    for (uint32_t row = 0; row < path_.rows; ++row)
      for (uint32_t column = 0; column < path_.columns; ++column) {
        const uint32_t count = at(column, row);
        if (!count || taken_[size_t(row) * path_.columns + column]) continue;
        if (count != PatchReader::kPatchSolid) {
          push(column, row, column + 1, row + 1, 0);
          ++border;
          continue;
        }
        uint32_t right = column + 1, bottom = row + 1;
        while (right < path_.columns && free(right, row)) ++right;
        while (bottom < path_.rows && free(column, right, bottom)) ++bottom;
        for (uint32_t r = row; r < bottom; ++r)
          for (uint32_t c = column; c < right; ++c) taken_[size_t(r) * path_.columns + c] = true;
        push(column, row, right, bottom, PatchReader::kPatchQuadInside);
      }
    // A quad's four vertices are about as much work as kPixels pixels that an edge does not come near. Cells of these
    // are saved.
    constexpr float kPixels = 30, kFewest = 3, kNever = 0;
    const uint32_t saved = path_.columns * path_.rows - border;
    if (!saved) return kNever;
    return std::max(kFewest,
                    std::sqrt(kPixels * static_cast<float>(quads_.size() - first) / static_cast<float>(saved)));
  }

private:
  uint32_t at(uint32_t column, uint32_t row) const {
    const uint32_t cell = row * path_.columns + column;
    const uvec4& pair = words_[path_.cells + cell / 2];
    return cell % 2 ? pair.w : pair.y;
  }
  bool free(uint32_t column, uint32_t row) const {
    return at(column, row) == PatchReader::kPatchSolid && !taken_[size_t(row) * path_.columns + column];
  }
  bool free(uint32_t column, uint32_t right, uint32_t row) const {
    for (uint32_t c = column; c < right; ++c)
      if (!free(c, row)) return false;
    return true;
  }
  /// Whether cells are empty, or outside of the box, in columns and rows that may begin at -1.
  bool open(int64_t column0, int64_t row0, int64_t column1, int64_t row1) const {
    for (int64_t row = row0; row < row1; ++row)
      for (int64_t column = column0; column < column1; ++column)
        if (row < 0 || column < 0 || row >= path_.rows || column >= path_.columns ||
            !at(static_cast<uint32_t>(column), static_cast<uint32_t>(row)))
          return true;
    return false;
  }
  void push(uint32_t column0, uint32_t row0, uint32_t column1, uint32_t row1, uint32_t flags) {
    const int64_t left = column0, top = row0, right = column1, bottom = row1;
    if (open(left - 1, top - 1, left, bottom + 1)) flags |= PatchReader::kPatchQuadLeft;
    if (open(left - 1, top - 1, right + 1, top)) flags |= PatchReader::kPatchQuadTop;
    if (open(right, top - 1, right + 1, bottom + 1)) flags |= PatchReader::kPatchQuadRight;
    if (open(left - 1, bottom, right + 1, bottom + 1)) flags |= PatchReader::kPatchQuadBottom;
    quads_.push_back({index_, column0 | row0 << 16, column1 | row1 << 16, flags});
  }

  std::span<const uvec4> words_;
  const PatchReader::GpgpPatchPath path_;
  const uint32_t index_;
  std::pmr::vector<uvec4>& quads_;
  std::pmr::vector<bool> taken_;
};

} // namespace

float appendQuads(std::span<const uvec4> words, uint32_t path, std::pmr::vector<uvec4>& quads) {
  return PathQuads(words, path, quads).run();
}

PatchQuads quadsOf(std::span<const uvec4> words) { return {words[0].x, words[1].y, std::bit_cast<float>(words[1].z)}; }

} // namespace gpgp::vector
