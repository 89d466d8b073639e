// The server without its network: a pose in, a frame's bytes out.
#pragma once
#include "codec.h"
#include "shading.h"

namespace streaming {

class FrameSource {
public:
  FrameSource(Stage& stage, const World& world, const ShadingOptions& shading, const EncoderOptions& coding);
  Welcome welcome() const;
  /// Shades once and sends nothing: software devices compile pipelines where they first run.
  void warmUp();
  /// waited: milliseconds that the pose lay here.
  Bytes next(const PoseMessage& pose, float waited);
  /// The next frame is to need none before it.
  void restart() { key_ = true; }
  const FrameHeader& header() const { return header_; } ///< of the last frame
  const Shaded& shaded() const { return shaded_; }
  const ShadingRenderer& renderer() const { return renderer_; }

private:
  const World& world_;
  ShadingOptions options_;
  ShadingRenderer renderer_;
  Codec codec_;
  std::unique_ptr<Encoder> encoder_;
  std::vector<uint32_t> sentBits_;
  FrameHeader header_;
  Shaded shaded_;
  bool key_ = true;
  uint32_t number_ = 0;
};

} // namespace streaming
