// Scenes for visibility_bench that gpgp spawn derives: its vertices and indices, read back.
#pragma once
#include "../visibility/measured_scenes.h"

namespace gpgp::bench {

/// Figure 4.1's city on a square of lots; 200 triangles a lot, so 10 million at 50 000.
test::Scene spawnedCity(uint32_t lots);
/// The mini-engine's houses and model, without its ground, as its camera shows them first.
test::Scene miniEngineLevel(uint32_t width, uint32_t height);

} // namespace gpgp::bench
