// What an atlas recording is given, on the CPU and, as an engine would have it, on the GPU; and what must hold of every
// result.
#pragma once
#include "../device_test.h"
#include "host/memory.h"
#include "visibility/atlas/atlas.h"
#include "visibility/cpu_reference/atlas.h"

#include <gpgp/atlas.h>
#include <gpgp/shaders/atlas.h>
#include <gtest/gtest.h>
#include <random>

namespace gpgp::test {

/// A strip of quads whose triangles are pairs, some of them turned, and single triangles between them.
struct AtlasWorld {
  uint32_t triangles, width, height, bucketCount = 1;
  std::vector<uint32_t> bits, sizes, buckets, shadeBits, indices;
  std::vector<shader::Mesh> meshes;
  std::vector<shader::Draw> draws;
  bool hasShade = false, findsPairs = true;
  uint32_t tileCapacity = 0, listCapacity = 0; ///< 0: as many as there can be

  AtlasWorld(uint32_t triangleCount, uint32_t atlasWidth, uint32_t atlasHeight, std::mt19937& random);
  void setVisible(uint32_t triangle, bool visible);
  bool isVisible(uint32_t triangle) const { return bits[triangle / 32] >> triangle % 32 & 1; }
  void setSize(uint32_t triangle, float area, float side);
  visibility::CpuAtlasInput input() const;
  uint32_t allTiles() const { return tileCapacity ? tileCapacity : width * height / 16; }
  uint32_t allListed() const { return listCapacity ? listCapacity : triangles; }
};

/// No two blocks overlap, each lies in the atlas, each visible triangle has one or is counted, all sums agree. before:
/// the previous result's blocks, or empty.
void expectSound(const AtlasWorld& world, const visibility::CpuAtlasResult& result,
                 const std::vector<uint32_t>& before);

/// The engine's side: its buffers, an atlas and a recorder.
class AtlasGpu {
public:
  AtlasGpu(DeviceTest& fixture, GpgpRecorder recorder, const AtlasWorld& world);
  ~AtlasGpu();
  AtlasGpu(const AtlasGpu&) = delete;
  AtlasGpu& operator=(const AtlasGpu&) = delete;
  /// Records once, with outputs that were poisoned before, waits, and brings all back. Lists end at their budgets.
  visibility::CpuAtlasResult step(const AtlasWorld& world, GpgpAtlasReport& report);

  host::Buffer blocks, tiles;

private:
  DeviceTest& fixture_;
  GpgpRecorder recorder_;
  GpgpHistory atlas_ = nullptr;
  GpgpAsset geometry_ = nullptr;
};

} // namespace gpgp::test
