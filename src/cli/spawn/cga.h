// `gpgp spawn` of .cga files: compiles, derives on the CPU, and says what came out.
#pragma once
#include "cli/spawn/scene_picture.h"
#include "spawn/cga/derive.h"

#include <optional>

namespace gpgp::cli {

struct CgaOptions {
  std::string file, start, style;
  std::vector<std::string> attributes;  ///< NAME=VALUE
  uint32_t axioms = 0, seed = 1;        ///< axioms 0: one
  std::array<float, 3> size{20, 0, 20}; ///< of rectangles; y is not used
  float spacing = 0;
  std::string axiomFile;
  bool geographic = false; ///< coordinates of GeoJSON are longitude and latitude
  std::string image, out;
  SceneView view;
  uint32_t maxDepth = 0;                                                ///< 0: the default
  uint64_t maxShapes = 0;                                               ///< 0: the default
  uint32_t maxFaces = 0, maxVertices = 0, maxGeometry = 0, maxWork = 0; ///< MiB; million steps; 0: the default
};

bool isCga(const std::string& file);
/// Throws Usage and Failure.
Outcome spawnCga(const CgaOptions& options);

// --- cga_axioms.cpp ---
struct CgaAxioms {
  std::vector<spawn::cga::Axiom> axioms;
  std::vector<std::string> rules; ///< of each axiom; empty: the start rule
};
/// A grid of rectangles, or what the axiom file says: CSV or JSON as readAxioms() takes them, or GeoJSON. names: rules
/// that an axiom can start with.
CgaAxioms cgaAxioms(const CgaOptions& options, const std::vector<std::string>& names);

// --- cga_gltf.cpp ---
/// A node for each rule that shapes end in, a primitive for each of its colours.
void writeGlb(const std::string& file, const spawn::cga::Derivation& derivation);

} // namespace gpgp::cli
