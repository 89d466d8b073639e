// A frame as it is sent: what changed of the blocks, which triangles are visible, and the texels.
#pragma once
#include "messages.h"

namespace streaming {

/// Milliseconds that a frame took on the server (thesis, section 3.4).
struct ServerTimes {
  float waiting = 0; ///< of the pose, until a frame began
  float visibility = 0, allocation = 0, shading = 0, reading = 0, encoding = 0;
  float sum() const { return waiting + visibility + allocation + shading + reading + encoding; }
};

struct FrameHeader {
  uint32_t number = 0;
  uint8_t key = 0; ///< 1: it does not need the frames before
  Codec codec = Codec::zstd;
  uint32_t pose = 0;
  double seconds = 0; ///< of the pose
  ServerTimes times;
  uint32_t visible = 0, blocks = 0, lowered = 0, dropped = 0, tiles = 0;
};

/// What is not texels.
struct FrameBlocks {
  std::vector<uint32_t> triangles, words; ///< GpgpAtlasInfo::blocks of these triangles; in a key frame of all others 0
  std::vector<uint32_t> visibleBits;      ///< exclusive or with those of the frame before; in a key frame: as they are
};

Bytes writeFrame(const FrameHeader& header, const FrameBlocks& blocks, ByteSpan texels);

struct ParsedFrame {
  FrameHeader header;
  FrameBlocks blocks;
  ByteSpan texels;
};
/// Nothing where the bytes are not those that writeFrame made (a checksum says so), or a number is out of range.
std::optional<ParsedFrame> parseFrame(ByteSpan frame, uint32_t triangleCount);

} // namespace streaming
