// Drawings as gpgp and as librsvg show them.
//
//   librsvg_compare [--size PIXELS] [--count N] [--out FOLDER] [--spoil] FILE|FOLDER...
//
// Beside the files, N drawings below the folders (links left out) are taken, evenly spread over their sorted names.
// Both renderers draw each at the same size, PIXELS on its longer side, over white. Two pictures agree where at most
// 1 % of the pixels differ by more than 48 of 255 in a channel, and the channels by less than 2 on average. Only
// drawings that use nothing that the importer calls unsupported count. With --out the pictures of the worst twenty go
// to FOLDER, side by side in worst.png and index.html, with how far each is from 256 samples a pixel by winding
// numbers, and all results to results.txt.
//
// No tile of 8 x 8 pixels may be wrong: a hundredth of a percent of a picture, which the shares above do not show. Two
// honest renderers may differ in a whole tile, as they treat lines thinner than a pixel, and edges on one another,
// differently. A tile is wrong where it differs from librsvg's by more than kWrongTile on average, and from 256 samples
// a pixel by winding numbers as well, and these two are nearer to each other than to ours: two renderers that share no
// code with the passes agree on something else. In drawings with images and layers, which the samples have not, tiles
// are not judged. Of 130 tiles that differed from librsvg's by more than 8, in 56 drawings, those furthest from the
// samples were 5.6 from them, where the bound is 8. --spoil turns one row of a tile in each of our pictures to its
// opposite before they are compared, and ends with 0 where each such tile is found wrong.
//
// Ends with 0 where no tile is wrong and at least 99 %, or all but one, agree, 1 where not, 77 where rsvg-convert or
// the drawings are not there.
#include "../cli/process.h"
#include "cli/shared/command.h"
#include "cli/shared/session.h"
#include "cli/shared/textures.h"
#include "cli/vector/images.h"
#include "cli/vector/reference.h"
#include "cli/vector/svg_files.h"
#include "host/files.h"
#include "host/picture.h"
#include "tile_difference.h"
#include "vector/import/svg/import.h"
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <random>
#include <set>

namespace {
using namespace gpgp;
namespace fs = std::filesystem;

constexpr int kSkipped = 77;
constexpr uint32_t kLarge = 48;    // difference of a channel, of 255
constexpr double kWrongTile = 8;   // the largest channel's, of 255, on average over a tile
constexpr size_t kMostTiles = 200; // of a picture, the most different, that are sampled

struct Options {
  uint32_t size = 256;
  size_t count = 500;
  bool spoil = false;
  fs::path out;
  std::vector<fs::path> files;
};

struct Messages {
  std::string error, unsupported;
};

void GPGP_CALL onMessage(void* userData, const GpgpMessage* message) {
  auto& messages = *static_cast<Messages*>(userData);
  if (message->code == GPGP_ERROR_UNSUPPORTED) messages.unsupported = message->text;
  if (message->severity == GPGP_SEVERITY_ERROR) messages.error = message->text;
}

/// How far the three pictures of a tile are apart: the largest channel's difference, of 255, on average.
struct WrongTile {
  uint32_t x = 0, y = 0;
  double fromLibrsvg = 0, fromReference = 0, betweenThem = 0;
};

struct Compared {
  fs::path file;
  std::string verdict;        // "agrees", "differs", or why it does not count
  double large = 0;           // share of pixels
  double mean = 0;            // difference of channels, of 255
  test::TileDifference worst; // the largest channel's, of 255
  std::vector<WrongTile> wrong;
  bool found = false; // the tile that was spoilt
  float transform[6] = {};
  bool unsampled = false; // it has images or layers
  bool counts() const { return verdict == "agrees" || verdict == "differs"; }
};

/// Draws one file after another with the same canvas.
class Ours {
public:
  explicit Ours(uint32_t size) : session_({}) {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = session_.recorderInfo("comparison");
    info.maxWidth = info.maxHeight = size;
    info.maxPaths = 1 << 18;
    info.maxTileEntries = 1 << 18;
    info.maxLayerPixels = 16 << 20; // as much as lavapipe binds
    info.maxLayerOperations = 1 << 14;
    info.maxDrawings = 1 << 10;
    canvas_ = session_.take(Canvas::create(session_.context(), info), "gpgpCreateCanvas");
    session_.check(canvas_.prewarm(), "gpgpPrewarm");
  }

  /// Over white; the verdict tells where nothing comes of it.
  host::Picture draw(const fs::path& file, uint32_t size, Compared& compared) {
    const std::vector<uint8_t> bytes = host::readFile(file);
    Messages messages;
    GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
    source.data = bytes.data();
    source.size = bytes.size();
    const auto page = vector::svg::pageSize(std::as_bytes(std::span(bytes)));
    const double longer = page ? std::max(page->width, page->height) : 0;
    if (longer > 0) source.scale = static_cast<float>(std::min(size / longer, 1e6));
    source.messageFn = onMessage;
    source.messageUserData = &messages;
    cli::VectorImages images;
    images.attach(source);
    const cli::SvgFiles files(file.string());
    source.fileSystem = files.fileSystem();
    const Result<Blob> blob = compileSvg(source);
    if (!blob) return compared.verdict = "no drawing: " + messages.error, host::Picture{};
    if (!messages.unsupported.empty()) compared.verdict = "unsupported: " + messages.unsupported;
    GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    info.data = blob->data();
    info.size = blob->size();
    Result<Drawing> created = Drawing::create(session_.context(), info);
    if (!created) return compared.verdict = "it does not fit on the device", host::Picture{};
    const Drawing drawing = std::move(*created);
    const GpgpDrawingInfo facts = session_.take(drawing.info(), "gpgpGetDrawingInfo");
    const float width = facts.viewport[2], height = facts.viewport[3];
    if (!(width > 0 && height > 0)) return compared.verdict = "empty", host::Picture{};
    session_.upload();
    const float scale = static_cast<float>(size) / std::max(width, height);
    const auto pixels = [scale](float v) { return static_cast<uint32_t>(std::max(std::lround(v * scale), 1l)); };
    const uint32_t w = pixels(width), h = pixels(height);
    const float sx = static_cast<float>(w) / width, sy = static_cast<float>(h) / height;
    const float transform[6] = {sx, 0, 0, sy, -facts.viewport[0] * sx, -facts.viewport[1] * sy};
    std::copy_n(transform, 6, compared.transform);
    const host::Image target(session_.device(), {.width = w, .height = h}, "picture");
    GpgpCanvasItem item{};
    item.drawing = drawing;
    item.opacity = 1;
    std::copy_n(transform, 6, item.transform);
    const auto table = vector::loadBaked({static_cast<const std::byte*>(blob->data()), blob->size()},
                                         std::pmr::get_default_resource());
    const cli::Textures textures(session_.device(), cli::shrunkToShown(images.pictures(), *table, transform));
    compared.unsampled = !images.pictures().empty() || !table->plan.empty();
    const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    const auto measured = session_.measure(
        canvas_, "drawing", 1, [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
          GpgpCanvasInfo canvas = GPGP_CANVAS_INFO_INIT;
          canvas.base = base;
          canvas.width = w;
          canvas.height = h;
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
        report.items > report.itemsGiven)
      compared.verdict = "its layers do not fit";
    else if (report.pathsDropped)
      throw std::runtime_error(file.string() + ": paths were dropped");
    return {w, h, host::downloadImage(session_.device(), target, VK_IMAGE_LAYOUT_GENERAL)};
  }

private:
  cli::Session session_;
  Canvas canvas_;
};

bool drawWithLibrsvg(const fs::path& file, uint32_t width, uint32_t height, host::Picture& picture) {
  static const uint32_t own = std::random_device()(); // several run side by side
  const fs::path png = fs::temp_directory_path() / ("gpgp_librsvg_" + std::to_string(own) + ".png");
  const auto result = test::runProcess({"rsvg-convert", "--width", std::to_string(width), "--height",
                                        std::to_string(height), "--output", png.string(), file.string()});
  if (result.exitCode != 0) return false;
  picture = host::readPng(png);
  fs::remove(png);
  for (size_t i = 0; i < picture.rgba.size(); i += 4) { // over white here: librsvg would mix white with what it draws
    const uint32_t a = picture.rgba[i + 3];
    for (size_t c = 0; c < 4; ++c)
      picture.rgba[i + c] = static_cast<uint8_t>((picture.rgba[i + c] * a + 255 * (255 - a) + 127) / 255);
    picture.rgba[i + 3] = 255;
  }
  return true;
}

template <class A, class B> double largestDifference(const A* a, const B* b) {
  double largest = 0;
  for (size_t c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(static_cast<double>(a[c]) - static_cast<double>(b[c])));
  return largest;
}

void compare(const host::Picture& ours, const host::Picture& theirs, Compared& compared) {
  size_t large = 0, sum = 0;
  for (size_t i = 0; i < ours.rgba.size(); i += 4) {
    bool isLarge = false;
    for (size_t c = 0; c < 3; ++c) {
      const auto difference = static_cast<uint32_t>(std::abs(ours.rgba[i + c] - theirs.rgba[i + c]));
      sum += difference;
      isLarge |= difference > kLarge;
    }
    large += isLarge;
  }
  const double pixels = static_cast<double>(ours.rgba.size()) / 4;
  compared.large = static_cast<double>(large) / pixels;
  compared.mean = static_cast<double>(sum) / (3 * pixels);
  compared.worst = test::worstTile(ours.width, ours.height, [&](uint32_t x, uint32_t y) {
    return largestDifference(&ours.rgba[(size_t{y} * ours.width + x) * 4],
                             &theirs.rgba[(size_t{y} * ours.width + x) * 4]);
  });
  if (compared.verdict.empty()) compared.verdict = compared.large <= 0.01 && compared.mean < 2 ? "agrees" : "differs";
}

/// A drawing as it was imported, and 256 samples a pixel of a part of its picture: premultiplied over white, as sRGB
/// encodes it, 4 floats a pixel.
class Reference {
public:
  explicit Reference(const Compared& compared) {
    vector::svg::Reporter quiet(nullptr, nullptr, "");
    const auto bytes = host::readFile(compared.file);
    vector::svg::ImportDetail detail;
    std::copy_n(compared.transform, 6, transform_);
    if (transform_[0] > 0) detail.scale = static_cast<double>(transform_[0]);
    svg_.emplace(*vector::svg::importSvg(std::as_bytes(std::span(bytes)), quiet, {}, {}, detail));
    views_.emplace(*svg_);
  }
  std::vector<float> part(uint32_t left, uint32_t top, uint32_t width, uint32_t height) const {
    float moved[6];
    std::copy_n(transform_, 6, moved);
    moved[4] -= static_cast<float>(left), moved[5] -= static_cast<float>(top);
    const float white[4] = {1, 1, 1, 1};
    return cli::vectorReference(views_->paths, views_->groups, moved, white, width, height, cli::Blend::Srgb);
  }

private:
  std::optional<vector::svg::Imported> svg_;
  std::optional<vector::svg::ImportedViews> views_;
  float transform_[6];
};

/// Of the tiles that differ from librsvg's, those that differ from what librsvg and samples agree upon.
void judgeTiles(const host::Picture& ours, const host::Picture& theirs, Compared& compared) {
  std::vector<test::TileDifference> suspects;
  test::forTiles(
      ours.width, ours.height,
      [&](uint32_t x, uint32_t y) {
        const size_t i = (size_t{y} * ours.width + x) * 4;
        return largestDifference(&ours.rgba[i], &theirs.rgba[i]);
      },
      [&](const test::TileDifference& tile) {
        if (tile.mean > kWrongTile) suspects.push_back(tile);
      });
  if (suspects.empty() || compared.unsampled) return;
  std::stable_sort(suspects.begin(), suspects.end(), [](const auto& a, const auto& b) { return a.mean > b.mean; });
  if (suspects.size() > kMostTiles) suspects.resize(kMostTiles);
  const Reference reference(compared);
  for (const test::TileDifference& tile : suspects) {
    const uint32_t width = std::min(test::kTileSide, ours.width - tile.x),
                   height = std::min(test::kTileSide, ours.height - tile.y);
    std::vector<float> samples = reference.part(tile.x, tile.y, width, height);
    for (float& value : samples) value *= 255;
    WrongTile found{tile.x, tile.y, tile.mean, 0, 0};
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x) {
        const size_t i = (size_t{tile.y + y} * ours.width + tile.x + x) * 4;
        const float* sample = &samples[(size_t{y} * width + x) * 4];
        found.fromReference += largestDifference(&ours.rgba[i], sample) / (width * height);
        found.betweenThem += largestDifference(&theirs.rgba[i], sample) / (width * height);
      }
    if (found.fromReference > kWrongTile && found.betweenThem < std::min(found.fromLibrsvg, found.fromReference))
      compared.wrong.push_back(found);
  }
}

/// One row of a tile to its opposite, in the middle of the picture.
std::array<uint32_t, 2> spoil(host::Picture& picture) {
  const uint32_t left = picture.width / 2 / test::kTileSide * test::kTileSide,
                 top = picture.height / 2 / test::kTileSide * test::kTileSide;
  for (uint32_t x = left; x < std::min(left + test::kTileSide, picture.width); ++x) {
    uint8_t* pixel = &picture.rgba[(size_t{top} * picture.width + x) * 4];
    for (size_t c = 0; c < 3; ++c) pixel[c] = pixel[c] < 128 ? 255 : 0;
  }
  return {left, top};
}

std::vector<fs::path> chosen(const Options& options) {
  std::vector<fs::path> some, all;
  for (const fs::path& given : options.files) {
    if (!fs::is_directory(given)) {
      if (fs::exists(given)) some.push_back(given);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(given))
      if (entry.is_regular_file() && !entry.is_symlink() &&
          (entry.path().extension() == ".svg" || entry.path().extension() == ".svgz"))
        all.push_back(entry.path());
  }
  std::sort(all.begin(), all.end());
  const size_t count = std::min(options.count, all.size());
  for (size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

/// Mean difference of channels, of 255, from 256 samples a pixel.
double distanceFromReference(const host::Picture& picture, std::span<const float> reference) {
  double sum = 0;
  for (size_t i = 0; i < reference.size(); ++i)
    if (i % 4 != 3) sum += std::abs(static_cast<double>(picture.rgba[i]) - static_cast<double>(reference[i]) * 255);
  return sum / (0.75 * static_cast<double>(reference.size()));
}

/// Ours, librsvg's and where they differ, each drawing's in a row, the rows in three columns.
void writeReport(const Options& options, const std::vector<Compared>& worst,
                 const std::vector<std::array<host::Picture, 2>>& pictures) {
  const uint32_t cell = options.size + 4;
  const size_t rows = (worst.size() + 2) / 3;
  host::Picture sheet{9 * cell, static_cast<uint32_t>(rows) * cell, {}};
  sheet.rgba.assign(size_t{sheet.width} * sheet.height * 4, 128);
  std::string page = "<!DOCTYPE html><meta charset=utf-8><title>gpgp and librsvg</title><p>gpgp, librsvg, difference"
                     "<table>\n";
  for (size_t row = 0; row < worst.size(); ++row) {
    const Compared& c = worst[row];
    host::Picture shown[3] = {pictures[row][0], pictures[row][1], pictures[row][0]};
    for (size_t i = 0; i < shown[2].rgba.size(); ++i)
      shown[2].rgba[i] = i % 4 == 3 ? 255 : static_cast<uint8_t>(255 - std::abs(shown[0].rgba[i] - shown[1].rgba[i]));
    page += "<tr>";
    for (uint32_t k = 0; k < 3; ++k) {
      const std::string name = std::to_string(row) + "-" + std::to_string(k) + ".png";
      host::writePng(options.out / name, shown[k]);
      page += "<td><img src=" + name + ">";
      for (uint32_t y = 0; y < shown[k].height; ++y)
        std::copy_n(&shown[k].rgba[size_t{y} * shown[k].width * 4], size_t{shown[k].width} * 4,
                    &sheet.rgba[((row % rows * cell + y) * sheet.width + (row / rows * 3 + k) * cell) * 4]);
    }
    const auto reference = Reference(c).part(0, 0, shown[0].width, shown[0].height);
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, "%5.2f %% of pixels, mean %5.2f; ", c.large * 100, c.mean);
    if (!c.unsampled) // the reference knows none
      std::snprintf(numbers + std::strlen(numbers), 100, "from the reference: gpgp %5.2f, librsvg %5.2f",
                    distanceFromReference(shown[0], reference), distanceFromReference(shown[1], reference));
    page += std::string("<td>") + c.file.string() + "<br>" + numbers + "\n";
    std::printf("%s  %s\n", numbers, c.file.string().c_str());
  }
  for (size_t i = 3; i < sheet.rgba.size(); i += 4) sheet.rgba[i] = 255;
  if (!worst.empty()) host::writePng(options.out / "worst.png", sheet);
  host::writeFile(options.out / "index.html", page + "</table>\n");
}

int run(const Options& options) {
  try {
    if (test::runProcess({"rsvg-convert", "--version"}).exitCode != 0) throw std::runtime_error("it does not run");
  } catch (const std::exception& missing) {
    std::printf("skipped: rsvg-convert (package librsvg2-bin) is not there: %s\n", missing.what());
    return kSkipped;
  }
  const std::vector<fs::path> files = chosen(options);
  if (files.empty()) {
    std::printf("skipped: no drawings; run tests/data/fetch.sh --only svg openclipart\n");
    return kSkipped;
  }
  Ours ours(options.size);
  std::vector<Compared> all;
  std::vector<std::pair<Compared, std::array<host::Picture, 2>>> worst;
  for (const fs::path& file : files) {
    Compared compared{file, {}};
    std::array<host::Picture, 2> pair;
    pair[0] = ours.draw(file, options.size, compared);
    if (pair[0].width && compared.verdict.empty()) {
      if (drawWithLibrsvg(file, pair[0].width, pair[0].height, pair[1])) {
        const std::array<uint32_t, 2> spoilt = options.spoil ? spoil(pair[0]) : std::array<uint32_t, 2>{};
        compare(pair[0], pair[1], compared);
        judgeTiles(pair[0], pair[1], compared);
        if (options.spoil)
          compared.found = std::any_of(compared.wrong.begin(), compared.wrong.end(), [&](const WrongTile& tile) {
            return tile.x == spoilt[0] && tile.y == spoilt[1];
          });
      } else
        compared.verdict = "librsvg refuses it";
    }
    if (compared.counts()) {
      worst.emplace_back(compared, std::move(pair));
      std::sort(worst.begin(), worst.end(), [](const auto& a, const auto& b) {
        return std::max(a.first.large * 100, a.first.mean / 2) > std::max(b.first.large * 100, b.first.mean / 2);
      });
      if (worst.size() > 20) worst.pop_back();
    }
    all.push_back(compared);
  }
  size_t count = 0, agree = 0, wrong = 0, found = 0, judged = 0;
  std::string lines;
  for (const Compared& c : all) {
    count += c.counts();
    agree += c.verdict == "agrees";
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, "%6.2f %% %6.2f %6.1f at %4u %4u  ", c.large * 100, c.mean, c.worst.mean,
                  c.worst.x, c.worst.y);
    const std::string line = std::string(numbers) + c.file.string() + "  " + c.verdict + "\n";
    if (c.verdict == "differs" && !options.spoil) std::fputs(line.c_str(), stdout);
    for (const WrongTile& tile : c.wrong)
      if (!options.spoil)
        std::printf("wrong tile at %u %u: %.1f from librsvg, %.1f from samples, these %.1f apart  %s\n", tile.x, tile.y,
                    tile.fromLibrsvg, tile.fromReference, tile.betweenThem, c.file.string().c_str());
    wrong += c.wrong.size();
    judged += c.counts() && !c.unsampled;
    found += c.found;
    if (options.spoil && c.counts() && !c.unsampled && !c.found)
      std::printf("not found to be spoilt: %s\n", c.file.string().c_str());
    lines += line;
  }
  if (options.spoil) {
    std::printf("%zu of %zu tiles that were spoilt are found\n", found, judged);
    return judged > 0 && found == judged ? 0 : 1;
  }
  std::printf("%zu drawings, %zu count, %zu agree (%.2f %%), %zu tiles are wrong\n", all.size(), count, agree,
              100.0 * static_cast<double>(agree) / static_cast<double>(std::max<size_t>(count, 1)), wrong);
  if (!options.out.empty()) {
    std::vector<Compared> rows;
    std::vector<std::array<host::Picture, 2>> pictures;
    for (auto& [compared, pair] : worst) rows.push_back(compared), pictures.push_back(std::move(pair));
    writeReport(options, rows, pictures);
    host::writeFile(options.out / "results.txt", lines);
  }
  return wrong == 0 && count > 0 && count - agree <= std::max<size_t>(count / 100, 1) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app("Drawings as gpgp and as librsvg show them");
  app.add_option("--size", options.size, "Pixels of the longer side")->check(CLI::Range(16, 4096));
  app.add_option("--count", options.count, "Drawings at most")->check(CLI::Range(1, 100000));
  app.add_option("--out", options.out, "Folder for the report");
  app.add_flag("--spoil", options.spoil, "Whether tiles that were made wrong are found");
  app.add_option("FILE", options.files, "Drawings, or folders of some")->required();
  CLI11_PARSE(app, argc, argv);
  return run(options);
} catch (const std::exception& error) {
  std::fprintf(stderr, "librsvg_compare: %s\n", error.what());
  return 1;
}
