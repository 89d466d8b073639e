// Wavefronts of faces, as the operators on outlines need them.
#pragma once
#include "spawn/geometry/internal.h"

namespace gpgp::spawn {

/// What an edge of an outline sweeps. The first side is the edge itself.
struct WaveFace {
  uint32_t edge;                ///< the outline's point that it begins at
  std::vector<uint32_t> nodes;  ///< counter-clockwise
  std::vector<uint32_t> beside; ///< for the side from each node: the edge whose face is there, kNone: none
};

struct Waves {
  shader::Outline outline;
  std::vector<vec3> nodes; ///< x, y in the outline's plane, and time; the first are the outline's points
  std::vector<WaveFace> faces;
  std::vector<std::vector<vec2>> fronts;         ///< loops of the wavefront at its end, interior to their left
  std::vector<std::vector<uint32_t>> frontEdges; ///< for each point the outline's edge that the front's edge is of
  std::vector<std::pair<vec2, vec2>> edges;      ///< the outline's edges
  std::vector<uint32_t> cornerOf;                ///< for each of them the mesh's corner
};

/// Moves the edges of a face inwards (outwards: out of it) until a time; negative: until nothing is left. speeds: one
/// for each of the mesh's corners from the face's first on, or none: 1. Lengths are metres.
Status makeWaves(MeshPool& pool, const Form& form, uint32_t face, std::span<const float> speeds, float until,
                 bool outwards, Waves& waves);

/// A polygon of the outline's plane into a builder, at a height above it. Loops of both kinds: each outer one becomes a
/// face, with the holes in it.
void addLoops(MeshPool& pool, shader::Builder& b, const shader::PlaneBasis& basis,
              const std::vector<std::vector<vec2>>& loops, float height, bool reversed, uint32_t tags,
              uint32_t edgeTags);

} // namespace gpgp::spawn
