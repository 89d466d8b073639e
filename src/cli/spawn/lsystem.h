// `gpgp spawn` for L-systems (.lsys): derives on the device and compares with the CPU reference.
#pragma once
#include "cli/shared/common.h"
#include "cli/spawn/spawned_gltf.h"

#include <gpgp/lsystem.h>

#include <filesystem>
#include <functional>

namespace gpgp::cli {

struct LsystemOptions {
  std::string file;
  std::string start; ///< of a file of several systems, its name; empty: the first
  std::vector<std::string> set;
  std::vector<GpgpAxiom> axioms;
  uint32_t repeat = 1;
  uint32_t maxInstances = 0, maxModules = 0; ///< 0: as many as there are
  bool string = false;                       ///< prints it
  std::string image, out;
  Size imageSize;
  float yaw = 0, pitch = 0, zoom = 1;
  GlbInstances instances = GlbInstances::triangles;
};

/// Whether a file is one by its name.
bool isLsystem(const std::string& file);
Outcome spawnLsystem(const LsystemOptions& options, const CommonOptions& common);

} // namespace gpgp::cli
