// What `gpgp spawn` was asked for.
#pragma once
#include "cli/shared/command.h"
#include "cli/spawn/scattered.h"
#include "cli/spawn/spawned_gltf.h"
#include "spawn/codegen/schedules.h"

#include <array>
#include <string>
#include <vector>

namespace gpgp::cli {

struct SpawnOptions {
  std::vector<std::string> grammars;
  uint32_t axioms = 0, seed = 1, repeat = 1; // axioms 0: one of each grammar
  std::array<float, 3> size{1, 1, 1};
  float spacing = 0;
  std::string axiomFile;
  ScatterOptions scatter;
  std::vector<std::string> set, measures, fields;
  std::string start, style;
  std::vector<std::string> attributes;
  bool hasSize = false, geographic = false, listsAttributes = false;
  std::string image, out;
  Size imageSize{1280, 720};
  float yaw = 35, pitch = 25, zoom = 1;
  std::array<float, 6> camera{}; // position, and what it looks at
  bool hasCamera = false;
  float detail = 1;    ///< of the camera
  uint32_t budget = 0; ///< terminals that choose it; 0: nothing does
  float fov = 60, changed = 0, interval = 0;
  uint32_t maxInstances = 0, maxShapes = 0, maxDepth = 0, maxColliders = 0, slice = 0;
  std::string schedule = "default", output = "instances", matching = "off", queues = "mixed";
  bool sorted = false, nodes = false, instanced = false, string = false;
  uint32_t maxModules = 0;
  uint32_t maxFaces = 0, maxVertices = 0, maxGeometry = 0, maxWork = 0;
  spawn::Heuristics heuristics;
  std::vector<std::string> given; ///< names of the options that were given
};

/// How --out writes instances.
GlbInstances glbInstances(const SpawnOptions& options);

/// Options, help and examples of the command, which write into `options`.
void addSpawnOptions(CLI::App& command, SpawnOptions& options);

} // namespace gpgp::cli
