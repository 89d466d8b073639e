#include "cli/text_draw.h"

#include "cli/text_overlay.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {
namespace {

// What a record holds, on devices that bind no more than 128 MiB too.
constexpr uint64_t kPatches = 1u << 18, kPixels = 1u << 24, kEntries = 1u << 18;

struct Placed {
  GpgpGlyphInstance glyph;
  double top, bottom; ///< rows of the picture that it may touch
  uint64_t patches;   ///< more than it has, as a rule; where not, a band is drawn in two
};

/// In painting order: all outlines, so that none covers the letter beside it, then all glyphs.
std::vector<Placed> placeGlyphs(const GpgpLayoutInfo& layout, const PageGlyphs& all,
                                const std::vector<uint32_t>& indices, const PageFrame& frame) {
  std::vector<Placed> placed;
  const auto place = [&](const std::vector<uint32_t>& which, const float* color) {
    for (size_t i = 0; i < which.size(); ++i) {
      const GpgpTextGlyph& at = layout.glyphs[i];
      const PageGlyph& glyph = all.glyphs[which[i]];
      if (glyph.isPicture() || glyph.paths.empty()) continue;
      const double y = double(frame.top) + double(at.y), size = double(at.size);
      const uint64_t patches = uint64_t{glyph.verbs} * (color ? 8 : 2); // an outline has two sides, and joins
      Placed& one = placed.emplace_back(Placed{{indices[which[i]], at.x, at.y, at.size, {}},
                                               y + size * double(glyph.box[1]) - 1,
                                               y + size * double(glyph.box[3]) + 1,
                                               patches});
      std::copy_n(color ? color : at.color, 4, one.glyph.color);
    }
  };
  place(all.outlines, frame.outlineColor.data());
  place(all.which, nullptr);
  return placed;
}

struct Band {
  uint32_t first, end; ///< rows
  uint64_t patches = 0;
  std::vector<GpgpGlyphInstance> glyphs;
};

Band bandOf(const std::vector<Placed>& placed, uint32_t first, uint32_t end) {
  Band band{first, end, 0, {}};
  for (const Placed& one : placed)
    if (one.top < end && one.bottom > first) {
      band.patches += one.patches;
      band.glyphs.push_back(one.glyph);
    }
  return band;
}

class Drawer {
public:
  Drawer(Session& session, const PageFrame& frame, const GpgpLayoutInfo& layout, const PageGlyphs& glyphs,
         uint32_t repeat)
      : session_(session), frame_(frame), repeat_(repeat), overlay_(makeOverlay(session, layout, glyphs)) {
    std::vector<uint32_t> indices;
    std::tie(glyphSet_, indices) = makeGlyphSet(session, glyphs);
    placed_ = placeGlyphs(layout, glyphs, indices, frame);
    const Size size = frame.size;
    page_.picture = {size.width, size.height, std::vector<uint8_t>(size_t{size.width} * size.height * 4)};
  }
  DrawnPage draw() {
    std::vector<Band> bands;
    plan(0, frame_.size.height, bands);
    for (const Band& band : bands) {
      canvasFor_.rows = std::max(canvasFor_.rows, band.end - band.first);
      canvasFor_.patches = std::max(canvasFor_.patches, band.patches + overlay_.patches);
      canvasFor_.glyphs = std::max(canvasFor_.glyphs, band.glyphs.size());
    }
    makeCanvas();
    for (const Band& band : bands) draw(band);
    return std::move(page_);
  }

private:
  void plan(uint32_t first, uint32_t end, std::vector<Band>& bands) const {
    Band band = bandOf(placed_, first, end);
    const uint32_t rows = end - first;
    if (rows == 1 || (band.patches <= kPatches && uint64_t{rows} * frame_.size.width <= kPixels)) {
      bands.push_back(std::move(band));
      return;
    }
    plan(first, first + rows / 2, bands);
    plan(first + rows / 2, end, bands);
  }

  void makeCanvas() {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = session_.workerInfo("canvas");
    info.maxWidth = frame_.size.width;
    info.maxHeight = canvasFor_.rows;
    info.maxPatches = static_cast<uint32_t>(std::clamp<uint64_t>(canvasFor_.patches, 1024, 1u << 22));
    info.maxTileEntries = canvasFor_.entries;
    info.maxGlyphs = static_cast<uint32_t>(std::max<size_t>(canvasFor_.glyphs, 1));
    canvas_ = session_.take(Canvas::create(session_.context(), info), "gpgpCreateCanvas");
    session_.check(canvas_.prewarm(), "gpgpPrewarm");
    session_.upload();
  }

  void draw(const Band& band) {
    const Size size{frame_.size.width, band.end - band.first};
    host::HeadlessDevice& device = session_.device();
    const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                             "picture");
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    std::vector<GpgpCanvasItem> items;
    const auto addItem = [&](GpgpAsset drawing) -> GpgpCanvasItem& {
      return items.emplace_back(
          GpgpCanvasItem{drawing, {1, 0, 0, 1, frame_.left, frame_.top - static_cast<float>(band.first)}, 1.0f});
    };
    if (!band.glyphs.empty()) {
      GpgpCanvasItem& item = addItem(nullptr);
      item.glyphSet = glyphSet_;
      item.glyphs = band.glyphs.data();
      item.glyphCount = static_cast<uint32_t>(band.glyphs.size());
    }
    if (overlay_.drawing) addItem(overlay_.drawing);
    auto drawn = session_.measure(canvas_, "drawing", repeat_ + 1,
                                  [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                                    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
                                    info.base = base;
                                    info.width = size.width;
                                    info.height = size.height;
                                    info.items = items.data();
                                    info.itemCount = static_cast<uint32_t>(items.size());
                                    if (overlay_.atlas) {
                                      info.images = overlay_.atlas->views().data();
                                      info.imageCount = static_cast<uint32_t>(overlay_.atlas->views().size());
                                    }
                                    info.exactArea = VK_TRUE; // small letters want it
                                    std::copy(frame_.background.begin(), frame_.background.end(), info.background);
                                    info.target = target.target({}, after);
                                    info.encodeSrgb = info.blendSrgb = VK_TRUE;
                                    return canvas_.recordPrepare(commands, frame, info);
                                  });
    const GpgpCanvasReport& report = drawn.report;
    if (report.pathsDropped && report.tileEntries > report.tileEntriesGiven && report.tileEntries <= kEntries) {
      canvasFor_.entries = report.tileEntries; // now that it is known, or that it is more
      makeCanvas();
      return draw(band);
    }
    if (report.pathsDropped && size.height > 1) {
      const uint32_t middle = band.first + size.height / 2;
      draw(bandOf(placed_, band.first, middle));
      return draw(bandOf(placed_, middle, band.end));
    }
    if (report.pathsDropped)
      throw Failure("the text is too much for one record: row " + std::to_string(band.first) + " of the picture has " +
                    std::to_string(band.glyphs.size()) + " glyphs, of whose paths " +
                    std::to_string(report.pathsDropped) + " found no room; --width breaks lines");
    const host::Picture rows =
        host::fromPremultiplied(size.width, size.height, host::downloadImage(device, target, VK_IMAGE_LAYOUT_GENERAL));
    std::copy(rows.rgba.begin(), rows.rgba.end(),
              page_.picture.rgba.begin() + static_cast<std::ptrdiff_t>(size_t{band.first} * size.width * 4));
    if (!drawn.times.totals.empty()) {
      drawn.times.totals.erase(drawn.times.totals.begin()); // cold
      page_.milliseconds += drawn.times.median();
    }
    ++page_.records;
    page_.status = report.base.status;
  }

  Session& session_;
  const PageFrame& frame_;
  uint32_t repeat_;
  TextOverlay overlay_;
  GlyphSet glyphSet_;
  std::vector<Placed> placed_;
  struct {
    uint32_t rows = 0, entries = 0;
    uint64_t patches = 0;
    size_t glyphs = 0;
  } canvasFor_;
  Canvas canvas_;
  DrawnPage page_;
};

} // namespace

DrawnPage drawPage(Session& session, const GpgpLayoutInfo& layout, const PageGlyphs& glyphs, const PageFrame& frame,
                   uint32_t repeat) {
  return Drawer(session, frame, layout, glyphs, repeat).draw();
}

} // namespace gpgp::cli
