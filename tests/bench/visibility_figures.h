// The figures of chapter 6 as numbers, a line each, and as pictures of such lines.
#pragma once
#include "visibility_runner.h"

#include <string>

namespace gpgp::test {

/// Views of a walking viewer's cell.
struct SmallViews {
  uint32_t divisor = 1; ///< of the picture's width and height
  uint32_t count = 0;   ///< at most
  float reach = 0;      ///< metres
  uint32_t most = 0;    ///< triangles of all views together; 0: as many as there are
};

struct FigureOptions {
  uint32_t repeat = 3;
  uint32_t largestGrid = 256;    ///< samples a pixel in each direction, figure 6.9's reference
  uint32_t largestCell = 32;     ///< pixels of figure 6.14's largest cell
  bool passes = false;           ///< of the walking viewer's views, too
  std::vector<SmallViews> views; ///< of the walking viewer; none: those of the results
};

/// Prints lines of figure, scene, series, label, x and y, separated by commas:
///   6.9   label N: share of the triangles that N x N + 1 samples find, of those of the largest grid
///   6.10  label factor of resolution: milliseconds, ratio to standard sampling (figure 6.10 and table 6.1)
///   6.11  label factor of resolution: coverage, overestimation
///   6.12  label static/dynamic epsilon: overestimation, coverage
///   6.14  label pixels and skip of the view cell: overestimation, coverage, against the reference of its middle
///   cellreference  label view points done: seconds
///   cell  label view points: overestimation, coverage of a walking viewer's cell; cellagain: likewise, where
///         false positives were sampled again, exactly, from the view points that claim them
///   cellcost  label view points: milliseconds, and in exact views; cellpairs: pairs likewise
///   cellnearby  label view points: triangles that may be seen from the cell, milliseconds of finding them
void printFigures(Runner& runner, const std::string& scene, uint32_t height, const FigureOptions& options);
/// The cell alone.
void printWalkingCell(Runner& runner, const std::string& scene, uint32_t height, const FigureOptions& options);

/// Reads files of such lines (others are skipped) and writes one SVG per figure and scene. False: nothing was written.
bool plotFigures(const std::vector<std::string>& files, const std::string& folder);

} // namespace gpgp::test
