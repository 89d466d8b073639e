// The client's renderer: its own raster finds each pixel's triangle, the atlas gives the colour.
#pragma once
#include "codec.h"
#include "frame_format.h"
#include "scene_gpu.h"

namespace streaming {

/// What the client knows of the stream: texels, blocks and the colours that triangles had last.
class StreamState {
public:
  StreamState(const Welcome& welcome);
  /// False: the frame is refused, and only a key frame helps.
  bool apply(const ParsedFrame& frame);

  const Atlas& atlas() const { return atlas_; }
  const std::vector<uint32_t>& blocks() const { return blocks_; }
  const std::vector<uint32_t>& visibleBits() const { return bits_; }
  const std::vector<uint32_t>& lastColours() const { return colours_; } ///< RGBA8; 0: never seen

private:
  bool isInAtlas(uint32_t word) const;
  void keepColour(uint32_t triangle);
  std::unique_ptr<Decoder> decoder_;
  Atlas atlas_;
  std::vector<uint32_t> blocks_, bits_, colours_;
};

/// Pixels of one picture, as the display shader counted them.
struct PixelCounts {
  uint32_t geometry = 0; ///< that show a triangle
  uint32_t atlas = 0;    ///< of these, from the atlas
  uint32_t last = 0;     ///< by the colour that the triangle had last
  uint32_t mean = 0;     ///< by the draw's colour
  uint32_t holes = 0;    ///< by nothing
  uint32_t unseen = 0;   ///< of last and mean: triangles that the server did not find visible
  uint32_t fallback() const { return last + mean; }
};

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<uint32_t> pixels; ///< RGBA8, sRGB-encoded
};

class DisplayRenderer {
public:
  enum Flag : uint32_t { compare = 1, mark = 2 }; // display.comp

  DisplayRenderer(Stage& stage, const World& world, const Welcome& welcome, uint32_t width, uint32_t height,
                  float fieldOfView);
  /// To the GPU; before the first picture and whenever the state has changed.
  void upload(const StreamState& state);
  /// flags: compare renders locally beside it; mark shows fallback shades in magenta.
  PixelCounts render(const View& view, double seconds, uint32_t flags);
  const Picture& picture() const { return picture_; }
  const Picture& local() const { return local_; }

private:
  Stage& stage_;
  const World& world_;
  Welcome welcome_;
  float fieldOfView_;
  SceneBuffers scene_;
  Shadow shadow_;
  TrianglePicture triangles_;
  mini::Buffer blocks_, atlas_, lastColours_, drawColours_, bits_, pixels_, localPixels_, counters_;
  mini::Buffer staging_, read_; ///< of the host
  mini::BufferSet set_;
  mini::ComputePipeline pipeline_;
  Picture picture_, local_;
};

} // namespace streaming
