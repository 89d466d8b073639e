// Small drawings beside pictures of them that another renderer made.
//
//   svg_pictures_compare FOLDER [--out FOLDER] [--font FILE]... [--all]
//
// Draws NAME.svg of the folder at 200 x 200 pixels over white, where NAME.png is what it should look like, and compares
// the worst tile of 8 x 8 pixels. A file's comment "differs:" says why we draw it otherwise on purpose; it must differ
// then. Without NAME.png a drawing is only drawn. tests/data/svg/conformance/README.md says how pictures are made.
//
// Ends with 0 where all agree, 1 where not, 77 without fonts where the drawings have text.
#include "cli/shared/command.h"
#include "cli/shared/session.h"
#include "cli/shared/textures.h"
#include "cli/vector/images.h"
#include "cli/vector/svg_files.h"
#include "cli/vector/svg_text.h"
#include "host/files.h"
#include "host/picture.h"
#include "tile_difference.h"
#include "vector/import/svg/import.h"
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

namespace {
using namespace gpgp;
namespace fs = std::filesystem;

constexpr uint32_t kSide = 200;
constexpr double kWorst = 30; // of 255: the largest channel's difference on average over a tile

struct Options {
  fs::path folder, out;
  std::vector<std::string> fonts;
  bool all = false;
};

/// Draws one file after another with the same canvas and fonts.
class Drawer {
public:
  explicit Drawer(const Options& options) : session_({}), fonts_(options.fonts) {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = session_.recorderInfo("comparison");
    info.maxWidth = info.maxHeight = kSide;
    info.maxPaths = 1 << 17;
    info.maxTileEntries = 1 << 17;
    info.maxLayerPixels = 8 << 20;
    info.maxLayerOperations = 1 << 14;
    info.maxDrawings = 1 << 12;
    canvas_ = session_.take(Canvas::create(session_.context(), info), "gpgpCreateCanvas");
    session_.check(canvas_.prewarm(), "gpgpPrewarm");
  }

  /// Over white. White where nothing can be drawn, as `said` tells.
  host::Picture draw(const fs::path& file, std::string& said) {
    host::Picture white{kSide, kSide, std::vector<uint8_t>(size_t{kSide} * kSide * 4, 255)};
    const std::vector<uint8_t> bytes = host::readFile(file);
    const std::string name = file.filename().string();
    GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
    source.name = name.c_str();
    source.data = bytes.data();
    source.size = bytes.size();
    const auto page = vector::svg::pageSize(std::as_bytes(std::span(bytes)));
    const double longer = page ? std::max(page->width, page->height) : 0;
    if (longer > 0) source.scale = static_cast<float>(kSide / longer);
    source.messageUserData = &said;
    source.messageFn = [](void* user, const GpgpMessage* message) {
      static_cast<std::string*>(user)->append(message->label).append(": ").append(message->text).append("\n");
    };
    cli::VectorImages images;
    images.attach(source);
    fonts_.attach(source);
    const cli::SvgFiles files(file.string());
    source.fileSystem = files.fileSystem();
    const Result<Blob> blob = compileSvg(source);
    if (!blob) return white;
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.data = blob->data();
    info.size = blob->size();
    const Drawing drawing = session_.take(Drawing::create(session_.context(), info), "gpgpCreateDrawing");
    const GpgpDrawingInfo facts = session_.take(drawing.info(), "gpgpGetDrawingInfo");
    const float width = facts.viewport[2], height = facts.viewport[3];
    if (!(width > 0 && height > 0)) return white;
    session_.upload();
    const float scale = kSide / std::max(width, height);
    const float transform[6] = {scale, 0, 0, scale, -facts.viewport[0] * scale, -facts.viewport[1] * scale};
    const host::Image target(session_.device(), {.width = kSide, .height = kSide}, "picture");
    GpgpCanvasItem item{};
    item.drawing = drawing;
    item.opacity = 1;
    std::copy_n(transform, 6, item.transform);
    const auto table = vector::loadBaked({static_cast<const std::byte*>(blob->data()), blob->size()},
                                         std::pmr::get_default_resource());
    const cli::Textures textures(session_.device(), cli::shrunkToShown(images.pictures(), *table, transform));
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    const auto measured = session_.measure(
        canvas_, "drawing", 1, [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
          GpgpCanvasInfo canvas = GPGP_CANVAS_INFO_INIT;
          canvas.base = base;
          canvas.width = canvas.height = kSide;
          canvas.items = &item;
          canvas.itemCount = 1;
          canvas.images = textures.views().data();
          canvas.imageCount = static_cast<uint32_t>(textures.views().size());
          std::fill_n(canvas.background, 4, 1.0f);
          canvas.target = target.target({}, after);
          canvas.encodeSrgb = canvas.blendSrgb = canvas.exactArea = VK_TRUE;
          return canvas_.recordPrepare(commands, frame, canvas);
        });
    const auto& report = measured.report;
    if (report.layerPixels > report.layerPixelsGiven || report.layerOperations > report.layerOperationsGiven ||
        report.items > report.itemsGiven || report.pathsDropped)
      throw std::runtime_error(file.string() + ": it does not fit");
    host::Picture made{kSide, kSide, host::downloadImage(session_.device(), target, VK_IMAGE_LAYOUT_GENERAL)};
    return made;
  }

private:
  cli::Session session_;
  Canvas canvas_;
  cli::SvgText fonts_;
};

/// Over white.
host::Picture flattened(host::Picture picture) {
  for (size_t i = 0; i < picture.rgba.size(); i += 4) {
    const uint32_t a = picture.rgba[i + 3];
    for (size_t c = 0; c < 3; ++c)
      picture.rgba[i + c] = static_cast<uint8_t>((picture.rgba[i + c] * a + 255 * (255 - a) + 127) / 255);
    picture.rgba[i + 3] = 255;
  }
  return picture;
}

int run(const Options& options) {
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(options.folder))
    if (entry.path().extension() == ".svg") files.insert(entry.path());
  if (files.empty()) throw std::runtime_error(options.folder.string() + " holds no drawings");
  for (const std::string& font : options.fonts)
    if (!fs::exists(font)) {
      std::printf("skipped: %s is not there; run tests/data/fetch.sh --only fonts\n", font.c_str());
      return 77;
    }
  if (!options.out.empty()) fs::create_directories(options.out);
  Drawer drawer(options);
  size_t compared = 0, wrong = 0, otherwise = 0;
  for (const fs::path& file : files) {
    std::string said;
    const host::Picture ours = drawer.draw(file, said);
    const std::string name = file.stem().string();
    if (!options.out.empty()) {
      host::writePng(options.out / (name + ".gpgp.png"), ours);
      host::writeFile(options.out / (name + ".says"), said);
    }
    const fs::path expected = fs::path(file).replace_extension(".png");
    if (!fs::exists(expected)) continue;
    const host::Picture theirs = flattened(host::readPng(expected));
    if (theirs.width != kSide || theirs.height != kSide)
      throw std::runtime_error(expected.string() + " is not 200 x 200 pixels");
    const test::TileDifference worst = test::worstTile(kSide, kSide, [&](uint32_t x, uint32_t y) {
      double largest = 0;
      for (size_t c = 0; c < 3; ++c) {
        const size_t i = (size_t{y} * kSide + x) * 4 + c;
        largest = std::max(largest, std::abs(double(ours.rgba[i]) - double(theirs.rgba[i])));
      }
      return largest;
    });
    const std::vector<uint8_t> bytes = host::readFile(file);
    const bool isMeant =
        std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).find("<!-- differs:") !=
        std::string_view::npos;
    const bool differs = worst.mean > kWorst;
    ++compared;
    otherwise += isMeant;
    wrong += differs != isMeant;
    if (differs != isMeant || options.all)
      std::printf("%s%5.1f at %3u %3u  %s\n",
                  differs == isMeant ? ""
                  : isMeant          ? "agrees after all: "
                                     : "differs: ",
                  worst.mean, worst.x, worst.y, file.filename().c_str());
  }
  std::printf("%zu drawings, %zu compared, %zu differ on purpose, %zu are wrong\n", files.size(), compared, otherwise,
              wrong);
  return wrong ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app("Small drawings beside pictures that another renderer made of them");
  app.add_option("FOLDER", options.folder, "Drawings and pictures")->required()->check(CLI::ExistingDirectory);
  app.add_option("--out", options.out, "Folder for what we draw and say");
  app.add_option("--font", options.fonts, "Font of the drawings' text; may be given several times");
  app.add_flag("--all", options.all, "Say how far each is off");
  CLI11_PARSE(app, argc, argv);
  return run(options);
} catch (const std::exception& error) {
  std::fprintf(stderr, "svg_pictures_compare: %s\n", error.what());
  return 1;
}
