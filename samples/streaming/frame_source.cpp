#include "frame_source.h"

#include <chrono>

namespace streaming {

FrameSource::FrameSource(Stage& stage, const World& world, const ShadingOptions& shading, const EncoderOptions& coding)
    : world_(world), options_(shading), renderer_(stage, world, shading), codec_(coding.codec),
      encoder_(makeEncoder(coding, shading.atlasWidth, shading.atlasHeight)),
      sentBits_((world.model.triangleCount + 31) / 32) {}

Welcome FrameSource::welcome() const {
  Welcome welcome;
  welcome.atlasWidth = options_.atlasWidth;
  welcome.atlasHeight = options_.atlasHeight;
  welcome.triangleCount = world_.model.triangleCount;
  welcome.gutter = static_cast<uint8_t>(options_.gutter);
  welcome.codec = codec_;
  welcome.drawColours = world_.meanColours();
  return welcome;
}

void FrameSource::warmUp() {
  PoseMessage pose;
  pose.view = walkAt(0, world_);
  pose.view.velocity = {1, 0, 0}; // more than one camera
  renderer_.shade(pose);
}

Bytes FrameSource::next(const PoseMessage& pose, float waited) {
  shaded_ = renderer_.shade(pose);
  const auto begin = std::chrono::steady_clock::now();
  FrameBlocks blocks;
  if (key_) {
    for (uint32_t triangle = 0; triangle < world_.model.triangleCount; ++triangle)
      if (renderer_.blocks()[triangle]) blocks.triangles.push_back(triangle);
    sentBits_.assign(sentBits_.size(), 0);
  } else {
    blocks.triangles = shaded_.updated;
  }
  for (const uint32_t triangle : blocks.triangles) blocks.words.push_back(renderer_.blocks()[triangle]);
  blocks.visibleBits = renderer_.visibleBits();
  for (size_t i = 0; i < sentBits_.size(); ++i) {
    const uint32_t now = blocks.visibleBits[i];
    blocks.visibleBits[i] ^= sentBits_[i];
    sentBits_[i] = now;
  }
  const Bytes texels = encoder_->encode(renderer_.atlas(), shaded_.changedTiles, key_);
  header_ = {};
  header_.number = number_++;
  header_.key = key_ ? 1 : 0;
  header_.codec = codec_;
  header_.pose = pose.number;
  header_.seconds = pose.seconds;
  header_.times = shaded_.times;
  header_.times.waiting = waited;
  header_.times.encoding = std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - begin).count();
  header_.visible = shaded_.atlas.visibleTriangles;
  header_.blocks = shaded_.atlas.blocks;
  header_.lowered = shaded_.atlas.loweredBlocks;
  header_.dropped = shaded_.atlas.droppedBlocks;
  header_.tiles = shaded_.tiles;
  key_ = false;
  return writeFrame(header_, blocks, texels);
}

} // namespace streaming
