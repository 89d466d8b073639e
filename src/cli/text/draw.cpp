#include "cli/text/draw.h"

#include "gpgp_glyph_pictures.hpp"

#include <algorithm>

namespace gpgp::cli {
namespace {

// What a recording holds, on devices that bind no more than 128 MiB too.
constexpr uint64_t kPaths = 1u << 18, kPixels = 1u << 24, kEntries = 1u << 18;

/// Bitmap glyphs in a texture.
struct Pictures {
  std::unique_ptr<integration::GlyphPictures> texture; ///< null: there are none
  std::vector<uint32_t> places;                        ///< for each glyph of the page
};

Pictures makePictures(Session& session, const PageGlyphs& all) {
  Pictures pictures;
  const auto count = std::count_if(all.glyphs.begin(), all.glyphs.end(), [](const auto& g) { return g.isPicture(); });
  if (count == 0) return pictures;
  host::HeadlessDevice& device = session.device();
  integration::PictureDevice on;
  on.device = device.device();
  on.getDeviceProcAddr =
      reinterpret_cast<PFN_vkGetDeviceProcAddr>(device.getInstanceProcAddr()(device.instance(), "vkGetDeviceProcAddr"));
  device.vki().getPhysicalDeviceMemoryProperties(device.physicalDevice(), &on.memory);
  on.maxSide = device.properties().limits.maxImageDimension2D;
  on.blendSrgb = true;
  pictures.texture = std::make_unique<integration::GlyphPictures>(on, static_cast<uint32_t>(count));
  for (const PageGlyph& glyph : all.glyphs) {
    uint32_t& place = pictures.places.emplace_back(integration::GlyphPictures::kNone);
    if (!glyph.isPicture()) continue;
    const host::Picture& from = glyph.picture;
    const GpgpResult added = pictures.texture->add({from.rgba.data(), from.width, from.height, {}}, place);
    if (session.check(added, "a texture for glyphs that are pictures") == GPGP_BUDGET_EXCEEDED)
      throw Failure("the text has " + std::to_string(count) +
                    " different glyphs that are pictures; a texture of this device has room for " +
                    std::to_string(pictures.texture->capacity()));
  }
  return pictures;
}

/// A glyph of the set, or a shape: a picture, an underline or a strike.
struct Placed {
  double top, bottom; ///< rows of the picture that it may touch
  uint64_t paths;     ///< that it has
  GpgpGlyphInstance glyph{};
  std::optional<GpgpListShape> shape;
  std::optional<GpgpListImage> image; ///< the shape's
};

/// In painting order: all outlines, so that none covers the letter beside it, underlines, glyphs, pictures, strikes.
std::vector<Placed> placeAll(const GpgpLayoutInfo& layout, const PageGlyphs& all, const std::vector<uint32_t>& indices,
                             const Pictures& pictures, const PageFrame& frame) {
  std::vector<Placed> placed;
  const auto placeGlyphs = [&](const std::vector<uint32_t>& which, const float* color) {
    for (size_t i = 0; i < which.size(); ++i) {
      const GpgpTextGlyph& at = layout.glyphs[i];
      const PageGlyph& glyph = all.glyphs[which[i]];
      if (glyph.isPicture() || glyph.paths.empty()) continue;
      const double y = double(frame.top) + double(at.y), size = double(at.size);
      Placed& one = placed.emplace_back(Placed{y + size * double(glyph.box[1]) - 1,
                                               y + size * double(glyph.box[3]) + 1,
                                               uint64_t{glyph.paths.size()},
                                               {indices[which[i]], at.x, at.y, at.size, {}},
                                               {},
                                               {}});
      std::copy_n(color ? color : at.color, 4, one.glyph.color);
    }
  };
  const auto placeShape = [&](const float(&box)[4], const float(&color)[4]) -> Placed& {
    Placed& one = placed.emplace_back(Placed{double(frame.top + box[1]), double(frame.top + box[3]), 1, {}, {}, {}});
    GpgpListShape& shape = one.shape.emplace();
    std::copy_n(box, 4, shape.box);
    std::copy_n(color, 4, shape.color);
    return one;
  };
  const auto placeLines = [&](bool strikes) {
    for (uint32_t i = 0; i < layout.decorationCount; ++i) {
      const GpgpTextDecoration& line = layout.decorations[i];
      const auto& [x, y, width, height] = line.rect;
      if ((line.strike != 0) == strikes) placeShape({x, y, x + width, y + height}, line.color);
    }
  };
  placeGlyphs(all.outlines, frame.outlineColor.data());
  placeLines(false);
  placeGlyphs(all.which, nullptr);
  for (uint32_t i = 0; i < layout.glyphCount; ++i) {
    const PageGlyph& glyph = all.glyphs[all.which[i]];
    if (!glyph.isPicture()) continue;
    const GpgpTextGlyph& at = layout.glyphs[i];
    const float(&b)[4] = glyph.box;
    Placed& one =
        placeShape({at.x + b[0] * at.size, at.y + b[1] * at.size, at.x + b[2] * at.size, at.y + b[3] * at.size},
                   {1, 1, 1, at.color[3]});
    const auto& source = pictures.texture->source(pictures.places[all.which[i]]);
    std::copy(source.begin(), source.end(), one.image.emplace().source);
  }
  placeLines(true);
  return placed;
}

struct Band {
  uint32_t first, end; ///< rows
  uint64_t paths = 0;
  uint32_t glyphs = 0, shapes = 0;
  std::vector<const Placed*> placed;
};

Band bandOf(const std::vector<Placed>& placed, uint32_t first, uint32_t end) {
  Band band{first, end, 0, 0, 0, {}};
  for (const Placed& one : placed)
    if (one.top < end && one.bottom > first) {
      band.paths += one.paths;
      ++(one.shape ? band.shapes : band.glyphs);
      band.placed.push_back(&one);
    }
  return band;
}

class Drawer {
public:
  Drawer(Session& session, const PageFrame& frame, const GpgpLayoutInfo& layout, const PageGlyphs& glyphs,
         uint32_t repeat)
      : session_(session), frame_(frame), repeat_(repeat), pictures_(makePictures(session, glyphs)) {
    std::vector<uint32_t> indices;
    std::tie(glyphSet_, indices) = makeGlyphSet(session, glyphs);
    placed_ = placeAll(layout, glyphs, indices, pictures_, frame);
    const Size size = frame.size;
    page_.picture = {size.width, size.height, std::vector<uint8_t>(size_t{size.width} * size.height * 4)};
  }
  DrawnPage draw() {
    std::vector<Band> bands;
    plan(0, frame_.size.height, bands);
    for (const Band& band : bands) {
      canvasFor_.rows = std::max(canvasFor_.rows, band.end - band.first);
      canvasFor_.paths = std::max(canvasFor_.paths, band.paths);
      canvasFor_.glyphs = std::max(canvasFor_.glyphs, band.glyphs);
      canvasFor_.shapes = std::max(canvasFor_.shapes, band.shapes);
    }
    makeCanvas();
    for (const Band& band : bands) draw(band);
    return std::move(page_);
  }

private:
  void plan(uint32_t first, uint32_t end, std::vector<Band>& bands) const {
    Band band = bandOf(placed_, first, end);
    const uint32_t rows = end - first;
    if (rows == 1 || (band.paths <= kPaths && uint64_t{rows} * frame_.size.width <= kPixels)) {
      bands.push_back(std::move(band));
      return;
    }
    plan(first, first + rows / 2, bands);
    plan(first + rows / 2, end, bands);
  }

  void makeCanvas() {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = session_.recorderInfo("canvas");
    info.maxWidth = frame_.size.width;
    info.maxHeight = canvasFor_.rows;
    info.maxPaths = static_cast<uint32_t>(std::clamp<uint64_t>(canvasFor_.paths, 1024, 1u << 22));
    info.maxTileEntries = canvasFor_.entries;
    info.maxGlyphs = std::max(canvasFor_.glyphs, 1u);
    info.maxShapes = std::max(canvasFor_.shapes, 1u);
    info.targets = GPGP_CANVAS_TARGET_RGBA8;
    canvas_ = session_.take(Canvas::create(session_.context(), info), "gpgpCreateCanvas");
    session_.check(canvas_.prewarm(), "gpgpPrewarm");
    session_.upload();
  }

  List listOf(const Band& band) {
    List list = session_.take(List::create(session_.context()), "gpgpCreateList");
    std::vector<GpgpGlyphInstance> run;
    const auto addRun = [&] {
      const auto count = static_cast<uint32_t>(run.size());
      if (count > 0) session_.check(gpgpAddText(list, glyphSet_, run.data(), count, 0), "gpgpAddText");
      run.clear();
    };
    for (const Placed* one : band.placed) {
      if (!one->shape) {
        run.push_back(one->glyph);
        continue;
      }
      addRun();
      GpgpListShape shape = *one->shape;
      shape.image = one->image ? &*one->image : nullptr;
      session_.check(gpgpAddShapes(list, &shape, 1), "gpgpAddShapes");
    }
    addRun();
    return list;
  }

  void draw(const Band& band) {
    const Size size{frame_.size.width, band.end - band.first};
    host::HeadlessDevice& device = session_.device();
    const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                             "picture");
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    const List list = listOf(band);
    GpgpCanvasItem item{};
    item.list = list;
    item.transform[0] = item.transform[3] = item.opacity = 1;
    item.transform[4] = frame_.left;
    item.transform[5] = frame_.top - static_cast<float>(band.first);
    auto drawn = session_.measure(canvas_, "drawing", repeat_ + 1,
                                  [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                                    GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
                                    info.base = base;
                                    info.width = size.width;
                                    info.height = size.height;
                                    info.items = &item;
                                    info.itemCount = 1;
                                    std::optional<GpgpCanvasImage> image;
                                    if (pictures_.texture) {
                                      session_.check(pictures_.texture->recordUpload(commands, frame), // the first time
                                                     "the upload of glyphs that are pictures");
                                      image = pictures_.texture->image();
                                    }
                                    info.images = image ? &*image : nullptr;
                                    info.imageCount = image ? 1 : 0;
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
      throw Failure("the text is too much for one recording: row " + std::to_string(band.first) +
                    " of the picture has " + std::to_string(band.glyphs) + " glyphs, of whose paths " +
                    std::to_string(report.pathsDropped) + " found no room; --width breaks lines");
    const host::Picture rows =
        host::fromPremultiplied(size.width, size.height, host::downloadImage(device, target, VK_IMAGE_LAYOUT_GENERAL));
    std::copy(rows.rgba.begin(), rows.rgba.end(),
              page_.picture.rgba.begin() + static_cast<std::ptrdiff_t>(size_t{band.first} * size.width * 4));
    if (!drawn.times.totals.empty()) {
      drawn.times.totals.erase(drawn.times.totals.begin()); // cold
      page_.milliseconds += drawn.times.median();
    }
    ++page_.recordings;
    page_.status = report.base.status;
  }

  Session& session_;
  const PageFrame& frame_;
  uint32_t repeat_;
  Pictures pictures_;
  GlyphSet glyphSet_;
  std::vector<Placed> placed_;
  struct {
    uint32_t rows = 0, entries = 0, glyphs = 0, shapes = 0;
    uint64_t paths = 0;
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
