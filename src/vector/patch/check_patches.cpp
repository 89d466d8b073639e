// What a shader would trust in the words of a drawing's patches: places within them, finite numbers, loops that end.
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gpgp::vector {
namespace {
using core::makeError;
using shader::PatchReader;
using shader::uvec4;
using shader::vec4;

bool finite(const vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

class Checker {
public:
  explicit Checker(std::span<const uvec4> words) : words_(words), reader_(words) {}

  bool path(uint32_t index) {
    const PatchReader::GpgpPatchPath p = reader_.gpgpLoadPath(0, 0, index);
    if (!inColorRange(&p.color.x) || p.flags > PatchReader::kPatchForeground || !finite(p.box)) return false;
    if (p.paint && !paint(p.paint)) return false;
    if (!(p.box.x < p.box.z)) return p.box.x == 1 && p.box.y == 1 && p.box.z == -1 && p.box.w == -1; // without ink
    if (!(p.box.y < p.box.w) || !finite(p.cell) || !(p.cell.x > 0 && p.cell.y > 0 && p.cell.z > 0 && p.cell.w > 0))
      return false;
    if (!p.columns || !p.rows || p.columns > kMostCells || p.rows > kMostCells) return false;
    if (!fits(p.cells, (uint64_t(p.columns) * p.rows + 1) / 2) || !fits(p.patches, 0) || !fits(p.curves, 0))
      return false;
    const bool many = p.columns > PatchReader::kPatchFewCells || p.rows > PatchReader::kPatchFewCells;
    if (many != (p.sums != 0)) return false;
    if (many && !fits(p.sums, (uint64_t(p.columns + 1) * (p.rows + 1) + 3) / 4)) return false;
    for (uint32_t i = 0; i < p.columns * p.rows; ++i) {
      const uvec4& pair = words_[p.cells + i / 2];
      if (!cell(p, i % 2 ? pair.z : pair.x, i % 2 ? pair.w : pair.y)) return false;
    }
    return true;
  }

private:
  bool fits(uint64_t first, uint64_t count) const { return first + count <= words_.size(); }
  vec4 floats(uint32_t index) { return reader_.gpgpBits(words_[index]); }

  bool paint(uint32_t place) {
    if (!fits(place, 4)) return false;
    const uvec4 &kinds = words_[place + 2], &ramp = words_[place + 3];
    if (!finite(floats(place)) || !finite(floats(place + 1)) || !std::isfinite(std::bit_cast<float>(kinds.x)) ||
        kinds.y > shader::kPaintRadial || kinds.z > shader::kSpreadReflect || kinds.w > shader::kInterpolateSrgb ||
        !ramp.y || !fits(ramp.x, uint64_t(ramp.y) * 2) || !std::isfinite(std::bit_cast<float>(ramp.w)))
      return false;
    float last = 0;
    for (uint32_t i = 0; i < ramp.y; ++i) {
      const vec4 color = floats(ramp.x + i * 2);
      const float offset = floats(ramp.x + i * 2 + 1).x;
      if (!inColorRange(&color.x) || !(offset >= last && offset <= 1)) return false;
      last = offset;
    }
    return true;
  }
  bool cell(const PatchReader::GpgpPatchPath& p, uint32_t first, uint32_t count) {
    if (count == PatchReader::kPatchSolid) return true;
    if (count > kMostInCell) return false;
    uint64_t place = uint64_t(p.patches) + first;
    for (uint32_t i = 0; i < count; ++i) {
      if (!fits(place, 1)) return false;
      const uvec4& head = words_[place];
      if (head.z > kMaxPatchCurves || head.w > head.z || !fits(place + 1, (head.z + 3) / 4)) return false;
      if (!(std::bit_cast<float>(head.x) < std::bit_cast<float>(head.y))) return false;
      for (uint32_t k = 0; k < head.z; ++k) {
        const uvec4& four = words_[place + 1 + k / 4];
        const uint32_t numbers[4] = {four.x, four.y, four.z, four.w};
        if (!curve(p.curves, numbers[k % 4])) return false;
      }
      place += 1 + (head.z + 3) / 4;
    }
    return true;
  }
  bool curve(uint32_t curves, uint32_t number) {
    const uint32_t kind = number >> PatchReader::kPatchCurveKind;
    const uint64_t place = uint64_t(curves) + (number & PatchReader::kPatchCurvePlace);
    constexpr uint32_t kSizes[] = {1, 2, 4};
    if (kind > PatchReader::kPatchCubic || !fits(place, kSizes[kind])) return false;
    const auto at = static_cast<uint32_t>(place);
    for (uint32_t i = 0; i < kSizes[kind]; ++i)
      if (!finite(floats(at + i))) return false;
    const vec4 ends = floats(at);
    return ends.y < ends.w && (kind != PatchReader::kPatchConic || floats(at + 1).z > 0);
  }

  std::span<const uvec4> words_;
  PatchReader reader_;
};

} // namespace

core::Result<void> checkPatches(std::span<const uvec4> words, uint32_t paths, std::pmr::memory_resource* memory) {
  if (words.size() < PatchReader::kPatchHeader)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: its patches are cut off");
  const uvec4& head = words[0];
  if (head.y != Patches::kVersion)
    return makeError(GPGP_ERROR_INVALID_DATA,
                     "baked drawing: its patches have version %u, this library reads %u; "
                     "bake it again",
                     head.y, Patches::kVersion);
  if (head.x != paths || head.z > paths || head.w != words.size() ||
      PatchReader::kPatchHeader + uint64_t(paths) * PatchReader::kPatchPathSize > words.size())
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: its patches are not those of its paths");
  Checker checker(words);
  std::pmr::vector<uvec4> quads(memory);
  float largest = 0;
  for (uint32_t i = 0; i < paths; ++i) {
    if (!checker.path(i))
      return makeError(GPGP_ERROR_INVALID_DATA,
                       "baked drawing: the patches of path %u refer to something that does not exist", i);
    const float smallest = appendQuads(words, i, quads);
    const uvec4* record = &words[PatchReader::kPatchHeader + i * PatchReader::kPatchPathSize];
    if (record[5] != uvec4(std::bit_cast<uint32_t>(smallest), 0, 0, 0))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: the cells of path %u are not as large as it says", i);
    if (smallest > 0)
      largest =
          std::max(largest, std::min(std::bit_cast<float>(record[2].x), std::bit_cast<float>(record[2].y)) / smallest);
  }
  const uvec4& drawn = words[1]; // quads are what the cells say
  if (uint64_t(drawn.x) + drawn.y != words.size() || drawn.y != quads.size() ||
      drawn.z != std::bit_cast<uint32_t>(largest) || drawn.w ||
      !std::equal(quads.begin(), quads.end(), words.begin() + drawn.x))
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: its quads are not those of its cells");
  return {};
}

} // namespace gpgp::vector
