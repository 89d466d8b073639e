#include "level.h"

#include <cmath>

namespace mini {
namespace {
constexpr float kBlock = 26.0f; // metres from block to block; backdrop.frag draws the streets
constexpr int kBlocks = 6;      // to each side of the square in the middle
} // namespace

std::vector<GpgpAxiom> levelAxioms() {
  std::vector<GpgpAxiom> axioms;
  for (int z = -kBlocks; z <= kBlocks; ++z)
    for (int x = -kBlocks; x <= kBlocks; ++x) {
      if (std::abs(x) <= 1 && std::abs(z) <= 1) continue; // the square
      if ((x == 0 || x == 1) && z > 1) continue;          // an avenue, through which the camera looks
      GpgpAxiom axiom{};
      axiom.id = static_cast<uint32_t>((z + kBlocks) * (2 * kBlocks + 1) + x + kBlocks);
      axiom.seed = 7919u * (axiom.id + 1u);
      const uint32_t random = (axiom.seed * 2654435761u) >> 16;
      const float fromMiddle = std::sqrt(static_cast<float>(x * x + z * z)); // in blocks
      const float floors = std::round(2.0f + 1.6f * fromMiddle + static_cast<float>(random % 4u));
      axiom.size[0] = 12.0f + static_cast<float>(random / 4u % 3u) * 2.0f;
      axiom.size[1] = floors * 3.0f + 1.0f;
      axiom.size[2] = 12.0f + static_cast<float>(random / 12u % 3u) * 2.0f;
      axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1.0f;
      axiom.transform[3] = static_cast<float>(x) * kBlock;
      axiom.transform[7] =
          axiom.size[1] * 0.5f; // shapes have their origin in the middle; buildings stand on the ground
      axiom.transform[11] = static_cast<float>(z) * kBlock;
      axiom.start = GPGP_AXIOM_DEFAULT_START;
      axiom.attribute = std::nanf("");
      axioms.push_back(axiom);
    }
  return axioms;
}

} // namespace mini
