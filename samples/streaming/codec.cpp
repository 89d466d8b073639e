#include "codec.h"

#include "compression.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <stdexcept>

namespace streaming {
namespace {

// ---------------------------------------------------------------- changed tiles, zstd

class TileEncoder : public Encoder {
public:
  Bytes encode(const Atlas& atlas, const std::vector<uint32_t>& changed, bool key) override {
    std::vector<uint32_t> all;
    if (key)
      for (uint32_t tile = 0; tile < atlas.tileCount(); ++tile) all.push_back(tile);
    const std::vector<uint32_t>& tiles = key ? all : changed;
    Writer writer;
    writer.put(static_cast<uint32_t>(tiles.size()));
    uint32_t last = 0;
    for (const uint32_t tile : tiles) {
      writer.put(tile - last);
      last = tile;
    }
    for (int channel = 0; channel < 3; ++channel)
      for (const uint32_t tile : tiles)
        for (uint32_t i = 0; i < 16; ++i) {
          const size_t x = tile % atlas.tileColumns() * 4 + i % 4, y = tile / atlas.tileColumns() * 4 + i / 4;
          writer.put(static_cast<uint8_t>(atlas.texels[y * atlas.width + x] >> (8 * channel)));
        }
    Writer result;
    result.put(static_cast<uint32_t>(writer.bytes.size()));
    result.putBytes(compress(writer.bytes));
    return result.bytes;
  }
};

class TileDecoder : public Decoder {
public:
  bool decode(ByteSpan bytes, Atlas& atlas) override {
    Reader packed(bytes);
    const auto size = packed.get<uint32_t>();
    if (!packed.well() || size > 4 + size_t{atlas.tileCount()} * 52) return false;
    const auto plain = decompress(packed.take(packed.left()), size);
    if (!plain) return false;
    Reader reader(*plain);
    const auto count = reader.get<uint32_t>();
    std::vector<uint32_t> tiles = reader.getAll<uint32_t>(count);
    const ByteSpan texels = reader.take(size_t{count} * 48);
    if (!reader.ended()) return false;
    uint32_t last = 0;
    for (uint32_t& tile : tiles) {
      last = tile += last;
      if (tile >= atlas.tileCount()) return false;
    }
    for (size_t n = 0; n < tiles.size(); ++n)
      for (uint32_t i = 0; i < 16; ++i) {
        const size_t x = tiles[n] % atlas.tileColumns() * 4 + i % 4, y = tiles[n] / atlas.tileColumns() * 4 + i / 4;
        uint32_t texel = 0xff000000u;
        for (size_t channel = 0; channel < 3; ++channel)
          texel |= static_cast<uint32_t>(texels[(channel * tiles.size() + n) * 16 + i]) << (8 * channel);
        atlas.texels[y * atlas.width + x] = texel;
      }
    return true;
  }
};

// ---------------------------------------------------------------- pictures, H.264

struct Free {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
template <class T> using Owned = std::unique_ptr<T, Free>;

void check(int result, const char* what) {
  if (result >= 0) return;
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(result, text, sizeof text);
  throw std::runtime_error(std::string(what) + ": " + text);
}

/// Between RGBA and planes of full range that are as large as the picture.
Owned<SwsContext> makeScaler(uint32_t width, uint32_t height, AVPixelFormat from, AVPixelFormat to) {
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  Owned<SwsContext> scaler(
      sws_getContext(w, h, from, w, h, to, SWS_POINT | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
  if (!scaler) throw std::runtime_error("sws_getContext failed");
  const int* table = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler.get(), table, 1, table, 1, 0, 1 << 16, 1 << 16);
  return scaler;
}

Owned<AVFrame> makePicture(uint32_t width, uint32_t height) {
  Owned<AVFrame> picture(av_frame_alloc());
  if (!picture) throw std::bad_alloc();
  picture->format = AV_PIX_FMT_YUV444P;
  picture->color_range = AVCOL_RANGE_JPEG;
  picture->width = static_cast<int>(width);
  picture->height = static_cast<int>(height);
  check(av_frame_get_buffer(picture.get(), 0), "av_frame_get_buffer");
  return picture;
}

class VideoEncoder : public Encoder {
public:
  VideoEncoder(const EncoderOptions& options, uint32_t width, uint32_t height) {
    const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
    if (!codec) throw std::runtime_error("libavcodec has no libx264");
    context_.reset(avcodec_alloc_context3(codec));
    context_->width = static_cast<int>(width);
    context_->height = static_cast<int>(height);
    context_->pix_fmt = AV_PIX_FMT_YUV444P; // blocks of 4 x 4 texels: no colour is shared by neighbours
    context_->color_range = AVCOL_RANGE_JPEG;
    context_->colorspace = AVCOL_SPC_BT709;
    context_->time_base = {1, std::max(1, static_cast<int>(options.rate + 0.5))};
    context_->framerate = {context_->time_base.den, 1};
    context_->gop_size = 1 << 30; // key frames where they are asked for
    context_->max_b_frames = 0;
    if (options.megabits > 0) {
      context_->bit_rate = static_cast<int64_t>(options.megabits * 1e6);
      context_->rc_max_rate = context_->bit_rate;
      context_->rc_buffer_size = static_cast<int>(options.megabits * 1e6 / 4);
    } else {
      check(av_opt_set(context_->priv_data, "crf", "20", 0), "crf");
    }
    check(av_opt_set(context_->priv_data, "preset", "veryfast", 0), "preset");
    check(av_opt_set(context_->priv_data, "tune", "zerolatency", 0), "tune");
    check(av_opt_set(context_->priv_data, "forced-idr", "1", 0), "forced-idr");
    // The deblocking filter would mix blocks of triangles that have nothing to do with each other.
    check(av_opt_set(context_->priv_data, "x264-params", "no-deblock=1:scenecut=0:keyint=infinite", 0), "x264-params");
    check(avcodec_open2(context_.get(), codec, nullptr), "avcodec_open2 (libx264)");
    scaler_ = makeScaler(width, height, AV_PIX_FMT_RGBA, AV_PIX_FMT_YUV444P);
    picture_ = makePicture(width, height);
    packet_.reset(av_packet_alloc());
  }

  Bytes encode(const Atlas& atlas, const std::vector<uint32_t>&, bool key) override {
    check(av_frame_make_writable(picture_.get()), "av_frame_make_writable");
    const uint8_t* from[] = {reinterpret_cast<const uint8_t*>(atlas.texels.data())};
    const int stride[] = {static_cast<int>(atlas.width * 4)};
    sws_scale(scaler_.get(), from, stride, 0, context_->height, picture_->data, picture_->linesize);
    picture_->pts = count_++;
    picture_->pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    check(avcodec_send_frame(context_.get(), picture_.get()), "avcodec_send_frame");
    Bytes bytes;
    for (;;) { // one frame in, one out
      const int result = avcodec_receive_packet(context_.get(), packet_.get());
      if (result == AVERROR(EAGAIN)) break;
      check(result, "avcodec_receive_packet");
      bytes.insert(bytes.end(), packet_->data, packet_->data + packet_->size);
      av_packet_unref(packet_.get());
    }
    if (bytes.empty()) throw std::runtime_error("libx264 kept a frame back");
    return bytes;
  }

private:
  Owned<AVCodecContext> context_;
  Owned<SwsContext> scaler_;
  Owned<AVFrame> picture_;
  Owned<AVPacket> packet_;
  int64_t count_ = 0;
};

class VideoDecoder : public Decoder {
public:
  VideoDecoder(uint32_t width, uint32_t height) {
    const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_H264);
    if (!codec) throw std::runtime_error("libavcodec has no H.264 decoder");
    context_.reset(avcodec_alloc_context3(codec));
    context_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    context_->thread_type = FF_THREAD_SLICE; // threads of frames would hold frames back
    context_->thread_count = 2;
    context_->err_recognition = AV_EF_EXPLODE; // what is damaged is refused, not guessed
    check(avcodec_open2(context_.get(), codec, nullptr), "avcodec_open2 (h264)");
    scaler_ = makeScaler(width, height, AV_PIX_FMT_YUV444P, AV_PIX_FMT_RGBA);
    picture_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
  }

  bool decode(ByteSpan bytes, Atlas& atlas) override {
    // The decoder reads a little beyond the end.
    padded_.assign(bytes.begin(), bytes.end());
    padded_.resize(bytes.size() + AV_INPUT_BUFFER_PADDING_SIZE);
    packet_->data = padded_.data();
    packet_->size = static_cast<int>(bytes.size());
    int result = avcodec_send_packet(context_.get(), packet_.get());
    if (result >= 0) result = avcodec_receive_frame(context_.get(), picture_.get());
    if (result < 0) {
      avcodec_flush_buffers(context_.get());
      return false;
    }
    const bool fits = picture_->width == static_cast<int>(atlas.width) &&
                      picture_->height == static_cast<int>(atlas.height) &&
                      (picture_->format == AV_PIX_FMT_YUV444P || picture_->format == AV_PIX_FMT_YUVJ444P);
    if (fits) {
      uint8_t* to[] = {reinterpret_cast<uint8_t*>(atlas.texels.data())};
      const int stride[] = {static_cast<int>(atlas.width * 4)};
      sws_scale(scaler_.get(), picture_->data, picture_->linesize, 0, picture_->height, to, stride);
    }
    av_frame_unref(picture_.get());
    return fits;
  }

private:
  Owned<AVCodecContext> context_;
  Owned<SwsContext> scaler_;
  Owned<AVFrame> picture_;
  Owned<AVPacket> packet_;
  Bytes padded_;
};

} // namespace

std::unique_ptr<Encoder> makeEncoder(const EncoderOptions& options, uint32_t width, uint32_t height) {
  av_log_set_level(AV_LOG_ERROR);
  if (options.codec == Codec::zstd) return std::make_unique<TileEncoder>();
  return std::make_unique<VideoEncoder>(options, width, height);
}

std::unique_ptr<Decoder> makeDecoder(Codec codec, uint32_t width, uint32_t height) {
  av_log_set_level(AV_LOG_QUIET); // damaged frames are refused and counted
  if (codec == Codec::zstd) return std::make_unique<TileDecoder>();
  return std::make_unique<VideoDecoder>(width, height);
}

} // namespace streaming
