// What was derived, as triangles: counted by terminal, and kept for a picture.
#pragma once
#include "cli/tune/deriver.h"

#include <gpgp/spawn.h>

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace gpgp::cli {

/// Each with the terminal that it belongs to.
struct Triangles {
  bool keep = false;            ///< all of them, not only their number
  std::vector<uint64_t> counts; ///< by terminal
  uint64_t total = 0;
  std::vector<std::array<glm::vec3, 3>> corners;
  std::vector<uint32_t> terminals;

  void count(uint32_t terminal, uint64_t number) {
    counts.at(terminal) += number;
    total += number;
  }
  void add(const std::array<glm::vec3, 3>& triangle, uint32_t terminal) {
    count(terminal, 1);
    if (!keep) return;
    corners.push_back(triangle);
    terminals.push_back(terminal);
  }
};

void addTriangles(Triangles& all, const std::vector<GpgpInstance>& instances);
void addTriangles(Triangles& all, const std::vector<SpawnedVertex>& vertices, const std::vector<uint32_t>& indices);

} // namespace gpgp::cli
