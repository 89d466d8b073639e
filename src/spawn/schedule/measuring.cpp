#include "spawn/schedule/measuring.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace gpgp::spawn {
using namespace shader;

static_assert(sizeof(Measuring) == 96 && offsetof(Measuring, measures) == 48 && offsetof(Measuring, count) == 80);
static_assert(sizeof(GpgpAxiomMeasures) == 4 * kMeasuredWords &&
              offsetof(GpgpAxiomMeasures, terminals) == 4 * kMeasuredTerminals &&
              offsetof(GpgpAxiomMeasures, sums) == 4 * kMeasuredSums &&
              offsetof(GpgpAxiomMeasures, occupiedCells) == 4 * kMeasuredCells);
static_assert(kMostMeasures == GPGP_MAX_MEASURES && kAllTerminals == GPGP_ALL_TERMINALS);
static_assert(std::endian::native == std::endian::little, "sums are two words, the lower one first");

namespace {
constexpr GpgpMeasureFactors kAllFactors = GPGP_MEASURE_X | GPGP_MEASURE_Y | GPGP_MEASURE_Z | GPGP_MEASURE_ATTRIBUTE;

uint64_t wordsOf(const GpgpOccupancy& grid) {
  const uint64_t row = (uint64_t(grid.cells[0]) + 31) / 32;
  return uint64_t(grid.cells[1]) * grid.cells[2] > kMostGridWords ? UINT32_MAX : row * grid.cells[1] * grid.cells[2];
}
} // namespace

uint32_t gridWords(const GpgpMeasureInfo& info) {
  return info.occupancy ? static_cast<uint32_t>(std::min<uint64_t>(wordsOf(*info.occupancy), UINT32_MAX)) : 0;
}

core::Result<Measuring> measuringOf(const GpgpMeasureInfo& info, uint32_t terminals) {
  Measuring measuring{};
  if (info.measureCount > kMostMeasures)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "measures->measureCount is %u; it is at most %u",
                           info.measureCount, kMostMeasures);
  if (info.measureCount && !info.measures)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "measures->measures is NULL, measureCount is %u",
                           info.measureCount);
  measuring.count = info.measureCount;
  for (uint32_t m = 0; m < info.measureCount; ++m) {
    const GpgpMeasure& measure = info.measures[m];
    if (measure.terminal != GPGP_ALL_TERMINALS && measure.terminal >= terminals)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                             "measures->measures[%u].terminal is %u; the grammar has %u terminals", m, measure.terminal,
                             terminals);
    if (measure.factors & ~kAllFactors)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "measures->measures[%u].factors has unknown bits", m);
    measuring.measures[m / 2][static_cast<int>(m % 2 * 2)] = measure.terminal;
    measuring.measures[m / 2][static_cast<int>(m % 2 * 2 + 1)] = measure.factors;
  }
  if (!info.occupancy) return measuring;
  const GpgpOccupancy& grid = *info.occupancy;
  const uint64_t words = wordsOf(grid);
  if (words == 0 || words > kMostGridWords)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "measures->occupancy->cells are %u x %u x %u; a grid has 1 to %u words of 32 cells along x",
                           grid.cells[0], grid.cells[1], grid.cells[2], kMostGridWords);
  if (!grid.target) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "measures->occupancy->target is NULL");
  measuring.gridWords = static_cast<uint32_t>(words);
  measuring.cells = uvec4(grid.cells[0], grid.cells[1], grid.cells[2], (grid.cells[0] + 31) / 32);
  for (int axis = 0; axis < 3; ++axis) {
    const float low = grid.box.min[axis], extent = grid.box.max[axis] - low;
    const float perMetre = static_cast<float>(grid.cells[axis]) / extent;
    if (!(extent > 0) || !std::isfinite(low) || !std::isfinite(extent) || !std::isfinite(perMetre))
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                             "measures->occupancy->box is empty or not finite along axis %d", axis);
    measuring.origin[axis] = low;
    measuring.perMetre[axis] = perMetre;
  }
  return measuring;
}

void measure(const Measuring& measuring, const GpgpInstance& instance, uint32_t* words, uint32_t* grid) {
  const bool withoutZ = instance.size[2] == 0;
  vec4 rows[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float* row = instance.transform + 4 * axis;
    rows[axis] = vec4(row[0], row[1], row[2], row[3]);
    words[axis] = std::max(words[axis], ~boundKey(boxLow(rows[axis], withoutZ)));
    words[axis + 3] = std::max(words[axis + 3], boundKey(boxHigh(rows[axis], withoutZ)));
  }
  ++words[kMeasuredTerminals];
  const vec3 size(instance.size[0], instance.size[1], instance.size[2]);
  for (uint32_t m = 0; m < measuring.count; ++m) {
    const uvec4& pair = measuring.measures[m / 2];
    const uint32_t terminal = m % 2 ? pair.z : pair.x, factors = m % 2 ? pair.w : pair.y;
    if (terminal != kAllTerminals && terminal != instance.terminal) continue;
    const float value = measuredValue(factors, size, instance.attribute);
    if (measuresTooMuch(value)) ++words[kMeasuredClamped];
    const uvec2 added = fixedOf(value);
    uint64_t sum = 0;
    std::memcpy(&sum, words + kMeasuredSums + 2 * m, sizeof sum);
    sum += uint64_t(added.y) << 32 | added.x;
    std::memcpy(words + kMeasuredSums + 2 * m, &sum, sizeof sum);
  }
  if (!measuring.gridWords) return;
  uvec2 cells[3];
  for (int axis = 0; axis < 3; ++axis) {
    cells[axis] = cellsBetween(boxLow(rows[axis], withoutZ), boxHigh(rows[axis], withoutZ), measuring.origin[axis],
                               measuring.perMetre[axis], measuring.cells[axis]);
    if (cells[axis].x > cells[axis].y) return;
  }
  for (uint32_t z = cells[2].x; z <= cells[2].y; ++z)
    for (uint32_t y = cells[1].x; y <= cells[1].y; ++y)
      for (uint32_t word = cells[0].x / 32; word <= cells[0].y / 32; ++word)
        grid[(z * measuring.cells.y + y) * measuring.cells.w + word] |= cellBits(word, cells[0].x, cells[0].y);
}

GpgpAxiomMeasures finishMeasures(const Measuring& measuring, const uint32_t* target, const uint32_t* words,
                                 const uint32_t* grid) {
  GpgpAxiomMeasures measures;
  std::memcpy(&measures, words, sizeof measures);
  for (int axis = 0; axis < 3; ++axis) {
    measures.bounds.min[axis] = lowOf(words[axis]);
    measures.bounds.max[axis] = highOf(words[axis + 3]);
  }
  for (uint32_t word = 0; word < measuring.gridWords; ++word) {
    measures.occupiedCells += static_cast<uint32_t>(std::popcount(grid[word]));
    measures.matchingCells += static_cast<uint32_t>(std::popcount(grid[word] & target[word]));
  }
  return measures;
}

} // namespace gpgp::spawn
