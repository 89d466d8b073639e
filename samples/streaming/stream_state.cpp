// What frames change of the client's state.
#include "atlas_on_cpu.h"
#include "display.h"

namespace streaming {

StreamState::StreamState(const Welcome& welcome)
    : decoder_(makeDecoder(welcome.codec, welcome.atlasWidth, welcome.atlasHeight)), blocks_(welcome.triangleCount),
      bits_((welcome.triangleCount + 31) / 32), colours_(welcome.triangleCount) {
  atlas_.resize(welcome.atlasWidth, welcome.atlasHeight);
}

bool StreamState::isInAtlas(uint32_t word) const {
  if (!gpgpAtlasHasBlock(word)) return word == 0;
  const GpgpAtlasBlock block = gpgpAtlasBlock(word);
  return block.width <= 128 && block.height <= 128 && block.corner < 3 && block.x + block.width <= atlas_.width &&
         block.y + block.height <= atlas_.height;
}

/// The mean of a block's texels that show the triangle, before the block goes.
void StreamState::keepColour(uint32_t triangle) {
  const GpgpAtlasBlock block = gpgpAtlasBlock(blocks_[triangle]);
  uint32_t sums[3] = {}, count = 0;
  for (uint32_t y = 0; y < block.height; ++y)
    for (uint32_t x = 0; x < block.width; ++x) {
      const bool second = x * block.height + y * block.width > block.width * block.height;
      if (second != (block.second != 0)) continue;
      const uint32_t texel = atlas_.texels[size_t{block.y + y} * atlas_.width + block.x + x];
      for (int i = 0; i < 3; ++i) sums[i] += texel >> (8 * i) & 255;
      ++count;
    }
  if (count == 0) return;
  colours_[triangle] = 0xff000000u | sums[0] / count | sums[1] / count << 8 | sums[2] / count << 16;
}

bool StreamState::apply(const ParsedFrame& frame) {
  for (const uint32_t word : frame.blocks.words)
    if (!isInAtlas(word)) return false;
  const bool key = frame.header.key != 0;
  if (key) {
    for (uint32_t triangle = 0; triangle < blocks_.size(); ++triangle)
      if (blocks_[triangle]) keepColour(triangle);
  } else {
    for (const uint32_t triangle : frame.blocks.triangles)
      if (blocks_[triangle]) keepColour(triangle);
  }
  if (!decoder_->decode(frame.texels, atlas_)) return false;
  if (key) {
    blocks_.assign(blocks_.size(), 0);
    bits_.assign(bits_.size(), 0);
  }
  for (size_t i = 0; i < frame.blocks.triangles.size(); ++i) blocks_[frame.blocks.triangles[i]] = frame.blocks.words[i];
  for (size_t i = 0; i < bits_.size(); ++i) bits_[i] ^= frame.blocks.visibleBits[i];
  return true;
}

} // namespace streaming
