// A town of meshes: what a .cga file makes of the level's lots, drawn in the forward pass with one call.
#pragma once
#include "forward.h"
#include "live_cga.h"

namespace mini {

/// A lot on each block, a square of grass and a house for the sample grammars.
std::vector<GpgpCgaLot> townLots();

class Town {
public:
  Town(Device& device, const Forward& forward);
  /// Another mesh from this frame on. The old one stays until its frames are over.
  void use(TownMesh mesh, const GpgpFrame& frame);
  /// Once a frame: frees what no frame uses any more.
  void collect(const GpgpFrame& frame);
  void draw(VkCommandBuffer commands, const Camera& camera);
  uint32_t triangles() const { return shown_.indices / 3; }
  uint64_t hash() const { return hash_; }

private:
  struct Mesh {
    Buffer vertices, triangles;
    uint32_t indices = 0;
    uint64_t last = 0; ///< frame that draws it
  };
  Device& device_;
  Pipeline pipeline_;
  Mesh shown_;
  std::vector<Mesh> old_;
  uint64_t hash_ = 0;
};

} // namespace mini
