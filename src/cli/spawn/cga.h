// `gpgp spawn` of .cga files: compiles, derives on the CPU, and says what came out.
#pragma once
#include "cli/shared/command.h"
#include "cli/spawn/fields.h"
#include "cli/spawn/scene_picture.h"
#include "spawn/cga/derive.h"

#include <optional>

namespace gpgp::cli {

struct CgaOptions {
  std::string file, start, style;
  std::vector<std::string> attributes;  ///< NAME=VALUE
  std::vector<std::string> fields;      ///< as WorldFields takes them
  bool listsAttributes = false;         ///< and derives nothing
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
  uint32_t repeat = 1;                                                  ///< on the GPU
  std::string schedule = "default";                                     ///< on the GPU: default or interpreter
};

/// On the GPU where the program has an operator graph that derives all of the axioms, else on the CPU. --device cpu
/// takes the CPU, another one the GPU or nothing. Throws Usage and Failure.
Outcome spawnCga(const CgaOptions& options, const CommonOptions& common);

// --- cga_gpu.cpp ---
/// What the GPU did.
struct GpuDerivation {
  spawn::cga::Derivation all;
  std::string device, schedule;
  double milliseconds = 0; ///< median
  uint32_t rounds = 0;
  uint64_t instances = 0;
  std::string failure; ///< which budget was exceeded
};
/// Derives by the graph, and makes of instances what the CPU makes. None: rules nest in themselves without end, or too
/// deep. It throws Failure where the CPU evaluator of graphs derives something else.
std::optional<GpuDerivation> deriveOnGpu(const CgaOptions& options, const CommonOptions& common,
                                         const spawn::cga::Program& program,
                                         const std::vector<spawn::cga::Axiom>& axioms,
                                         const spawn::cga::DeriveOptions& derive, WorldFields& fields);
/// The axiom for a graph.
GpgpAxiom graphAxiom(const spawn::cga::Axiom& axiom, uint32_t id);

// --- cga_axioms.cpp ---
struct CgaAxioms {
  std::vector<spawn::cga::Axiom> axioms;
  std::vector<std::string> rules;                    ///< of each axiom; empty: the start rule
  std::optional<spawn::cga::GeographicPlace> origin; ///< of the world, where the file says where it lies
};
/// A grid of rectangles, or what the axiom file says: CSV or JSON as readAxioms() takes them, or GeoJSON. names: rules
/// that an axiom can start with.
CgaAxioms cgaAxioms(const CgaOptions& options, const std::vector<std::string>& names);

// --- cga_attributes.cpp ---
/// All attributes of a program: values, ranges, choices, groups, annotations.
Json attributesOf(const spawn::cga::Program& program);
/// The same for people.
std::string attributesText(const spawn::cga::Program& program);

// --- cga_gltf.cpp ---
/// A node for each rule that shapes end in, a primitive for each of its colours.
void writeGlb(const std::string& file, const spawn::cga::Derivation& derivation);

} // namespace gpgp::cli
