// Draws drawings and texts on a device and times it: whole records and passes by timestamps, recording on the CPU.
#pragma once
#include "host/busy_work.h"
#include "host/device.h"
#include "measuring.h"
#include "vector_scenes.h"

#include <memory>

namespace gpgp::bench {

/// What a scene became, and the item that shows it.
struct VectorMade {
  struct Destroy {
    void operator()(GpgpAsset made) const { gpgpDestroyAsset(made); }
  };
  std::unique_ptr<GpgpAsset_T, Destroy> asset; ///< drawing or glyph set
  GpgpDrawingInfo facts = GPGP_DRAWING_INFO_INIT;
  double milliseconds = 0; ///< of converting
  GpgpCanvasItem item{};
  std::vector<uint32_t> glyphs; ///< of a text: indices of all that are in the set
  std::vector<GpgpGlyphInstance> text;
};

struct VectorDrawn {
  double milliseconds = 0;                            ///< GPU, of whole records
  double microseconds = 0;                            ///< CPU, of recording
  std::vector<std::pair<std::string, double>> passes; ///< milliseconds of each, in order
  uint32_t entries = 0;                               ///< in tile lists
  uint32_t tiles = 0, tilesDrawn = 0;                 ///< of the last record
  std::vector<uint8_t> pixels;                        ///< RGBA, sRGB over white
};

/// Ends the program where a call fails, or a record drops paths.
class VectorRunner {
public:
  explicit VectorRunner(host::HeadlessDevice& device);
  ~VectorRunner();
  VectorRunner(const VectorRunner&) = delete;
  VectorRunner& operator=(const VectorRunner&) = delete;

  /// The drawing of a scene; or its text, where it is one.
  VectorMade makeDrawing(const Scene& scene);
  VectorMade makeText(const Scene& scene);
  /// For pictures of at most `largest` pixels a side; takes the place of the one before.
  void openCanvas(uint32_t largest, uint32_t maxPaths, uint32_t maxGlyphs = 0);

  struct Settings {
    uint32_t samples = 16;
    bool exactArea = true, blendSrgb = true;
    bool least = false; ///< least times instead of medians
    /// Whether a history keeps what did not change, and how many of a text's glyphs change from record to record, all
    /// beside each other.
    bool keep = false;
    uint32_t edits = 0;
  };
  /// The scene fitted into the picture, at its top left. Medians of `repeat` records; passes are timed in records of
  /// their own, as timestamps between them take time.
  VectorDrawn draw(VectorMade& made, const Scene& scene, uint32_t width, uint32_t height, const Settings& settings,
                   int repeat);

private:
  void closeCanvas();
  host::HeadlessDevice& device_;
  host::BusyWork busy_;
  GpgpContext context_ = nullptr;
  GpgpRecorder canvas_ = nullptr;
  std::vector<const char*> names_; // of the canvas' passes
  VkQueryPool queries_ = VK_NULL_HANDLE;
  GpgpHistory history_ = nullptr;
  uint64_t frame_ = 0;
};

} // namespace gpgp::bench
