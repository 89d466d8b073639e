// The boundary of a drawing's paths, worked out from their patches: what the raster walks along.
#pragma once
#include "vector/patch/drawing.h"

namespace gpgp::vector {

/// A drawing's paths as closed outlines, in the order of the paths.
struct Outlines {
  explicit Outlines(std::pmr::memory_resource* memory) : segments(memory), boxes(memory), ends(memory) {}
  std::pmr::vector<shader::SegmentRecord> segments;
  std::pmr::vector<shader::vec4> boxes; ///< of each path: left, top, right, bottom; an empty one where it has no ink
  std::pmr::vector<uint32_t> ends;      ///< of each path: one past its last segment
};
/// The parameter at which a cubic that never turns in y is `wanted` below its begin: control points there at y1 and
/// y2, its end at height.
double parameterAt(double y1, double y2, double height, double wanted);
Outlines makeOutlines(const Drawing& drawing, std::pmr::memory_resource* memory);
/// The same for a drawing that replacePaths has made: those of other paths are the base's.
Outlines editOutlines(const Drawing& drawing, const Outlines& base, std::span<const GpgpPathEdit> edits,
                      std::pmr::memory_resource* memory);

} // namespace gpgp::vector
