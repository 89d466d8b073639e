// The atlas's texels, coded: whole pictures by H.264 (libavcodec, x264), or the changed tiles without loss by zstd.
#pragma once
#include "bytes.h"
#include "messages.h"

#include <memory>
#include <string>

namespace streaming {

/// Texels RGBA8, row by row; A is not sent.
struct Atlas {
  uint32_t width = 0, height = 0;
  std::vector<uint32_t> texels;
  void resize(uint32_t w, uint32_t h) {
    width = w;
    height = h;
    texels.assign(size_t{w} * h, 0xff000000u);
  }
  uint32_t tileColumns() const { return width / 4; }
  uint32_t tileCount() const { return width / 4 * (height / 4); }
};

struct EncoderOptions {
  Codec codec = Codec::x264;
  double megabits = 0; ///< per second; 0: constant quality
  double rate = 30;    ///< frames per second
};

class Encoder {
public:
  virtual ~Encoder() = default;
  /// changed: numbers of 4 x 4 tiles of the atlas, row by row, ascending, in which a texel differs from the frame
  /// before. key: the decoder knows no frame before.
  virtual Bytes encode(const Atlas& atlas, const std::vector<uint32_t>& changed, bool key) = 0;
};
/// Throws std::runtime_error where libavcodec has no such encoder.
std::unique_ptr<Encoder> makeEncoder(const EncoderOptions& options, uint32_t width, uint32_t height);

class Decoder {
public:
  virtual ~Decoder() = default;
  /// False: the bytes are refused; the atlas may have changed in part, and a key frame is needed.
  virtual bool decode(ByteSpan bytes, Atlas& atlas) = 0;
};
std::unique_ptr<Decoder> makeDecoder(Codec codec, uint32_t width, uint32_t height);

} // namespace streaming
