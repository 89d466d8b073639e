// The server's renderer: what may be seen until the result is displayed, a block for each triangle of it, and texels in
// these blocks. gpgp finds and allocates; the texels are shaded by this sample's own shader.
#pragma once
#include "codec.h"
#include "frame_format.h"
#include "scene_gpu.h"

namespace streaming {

struct ShadingOptions {
  GpgpSamplingMethod method = GPGP_SAMPLING_EXACT;
  uint32_t width = 640, height = 360; ///< the viewer's picture
  float fieldOfView = 1.05f;
  uint32_t atlasWidth = 2048, atlasHeight = 2048, gutter = 0;
  float texelsPerPixel = 1;
  uint32_t reshade = 1; ///< each block in one of so many frames, new and changed ones always
};

/// What changed by one frame; lists of triangles are ascending.
struct Shaded {
  std::vector<uint32_t> updated;      ///< triangles with another word in `blocks`
  std::vector<uint32_t> changedTiles; ///< tiles of the atlas in which a texel differs
  ServerTimes times;                  ///< without waiting and encoding
  GpgpVisibilityReport visibility;    ///< of the recording that came last
  GpgpAtlasReport atlas;
  uint32_t tiles = 0, cameras = 0; ///< shaded; of the view cell
};

class ShadingRenderer {
public:
  ShadingRenderer(Stage& stage, const World& world, const ShadingOptions& options);
  Shaded shade(const PoseMessage& pose);

  const Atlas& atlas() const { return atlasTexels_; }
  const std::vector<uint32_t>& blocks() const { return blockWords_; }
  const std::vector<uint32_t>& visibleBits() const { return bits_; }

private:
  void recordVisibility(VkCommandBuffer commands, const GpgpFrame& frame, const PoseMessage& pose, Shaded& result);
  void recordAtlas(VkCommandBuffer commands, const GpgpFrame& frame);
  void recordShading(VkCommandBuffer commands, double seconds);
  void readBack(Shaded& result);

  Stage& stage_;
  const World& world_;
  ShadingOptions options_;
  SceneBuffers scene_;
  Shadow shadow_;
  mini::Buffer visible_, sizes_, blocks_, tiles_, dispatches_, texels_, new_, changed_, gone_, counts_;
  mini::Buffer shadeBits_, read_; ///< of the host
  gpgp::GeometrySet geometry_;
  gpgp::VisibilityRecorder visibilityRecorder_;
  gpgp::Atlas atlas_;
  gpgp::AtlasRecorder atlasRecorder_;
  mini::BufferSet set_;
  mini::ComputePipeline pipeline_;
  Atlas atlasTexels_;
  std::vector<uint32_t> blockWords_, bits_;
  uint32_t maxWidth_, maxHeight_, frame_ = 0;
};

} // namespace streaming
