// `gpgp vector`: converts an SVG to a drawing, rasterises it on the GPU and writes a picture.
#include "cli/session.h"
#include "cli/vector_truth.h"
#include "host/files.h"
#include "host/picture.h"
#include "vector/import/svg/import.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gpgp::cli {
namespace {

struct VectorOptions {
  std::string file, out, background, stages;
  Size size;
  bool allWarnings = false;
  bool area = false;
  bool truth = false;
  uint32_t samples = 16, repeat = 1, maxTileEntries = 0;
};

constexpr uint32_t kShownWarnings = 10;

struct Messages {
  std::string error;
  uint32_t warnings = 0;
  Json list = Json::array(); // of what is not supported
  bool showAll = false;
};

void GPGP_CALL onSvgMessage(void* userData, const GpgpMessage* message) {
  auto* messages = static_cast<Messages*>(userData);
  if (message->severity == GPGP_SEVERITY_ERROR) {
    if (messages->error.empty()) messages->error = message->text;
    return;
  }
  if (message->severity == GPGP_SEVERITY_WARNING) messages->list.push_back(message->text);
  if (message->severity == GPGP_SEVERITY_WARNING && ++messages->warnings > kShownWarnings && !messages->showAll) return;
  std::fprintf(stderr, "%s: %s\n", message->label, message->text);
}

void GPGP_CALL onStage(void* userData, const char* stage, const char* svg, size_t size) {
  const std::string file = *static_cast<const std::string*>(userData) + "/" + stage + ".svg";
  std::ofstream(file, std::ios::binary).write(svg, static_cast<std::streamsize>(size));
}

/// "rrggbb" as linear premultiplied colour; empty: nothing behind the drawing.
void parseBackground(const std::string& text, float (&colour)[4]) {
  if (text.empty()) return;
  const std::string digits = text[0] == '#' ? text.substr(1) : text;
  char* end = nullptr;
  const unsigned long rgb = std::strtoul(digits.c_str(), &end, 16);
  if (digits.size() != 6 || *end != 0) throw Usage("--background takes six hexadecimal digits, for example ffffff");
  for (unsigned i = 0; i < 3; ++i)
    colour[i] = host::linearFromSrgb(static_cast<float>(rgb >> (16 - 8 * i) & 255ul) / 255.0f);
  colour[3] = 1.0f;
}

/// Fits the drawing's page into the picture, in the middle, undistorted.
void fit(const GpgpDrawingInfo& drawing, const Size& size, float (&transform)[6]) {
  const float width = drawing.viewport[2], height = drawing.viewport[3];
  const float scale = std::min(static_cast<float>(size.width) / width, static_cast<float>(size.height) / height);
  transform[0] = transform[3] = scale;
  transform[1] = transform[2] = 0.0f;
  transform[4] = (static_cast<float>(size.width) - width * scale) * 0.5f - drawing.viewport[0] * scale;
  transform[5] = (static_cast<float>(size.height) - height * scale) * 0.5f - drawing.viewport[1] * scale;
}

/// Decibels between what the device painted (as it lies in the image) and samples composited by winding numbers.
double compareWithTruth(std::span<const uint8_t> bytes, std::span<const uint8_t> painted, const float (&transform)[6],
                        const float (&background)[4], const Size& size) {
  gpgp::vector::svg::Reporter quiet(nullptr, nullptr, "");
  const auto svg = gpgp::vector::svg::importSvg(std::as_bytes(bytes), quiet);
  if (!svg) throw Failure(svg.error().text);
  const gpgp::vector::svg::ImportedViews views(*svg);
  std::vector<float> pixels(painted.size());
  for (size_t i = 0; i < painted.size(); ++i) {
    const float alpha = static_cast<float>(painted[i | 3]) / 255.0f, value = static_cast<float>(painted[i]) / 255.0f;
    pixels[i] = i % 4 == 3 ? alpha : alpha > 0.0f ? host::linearFromSrgb(std::min(1.0f, value / alpha)) * alpha : 0.0f;
  }
  return psnrOverWhite(pixels, vectorTruth(views.paths, views.groups, transform, background, size.width, size.height));
}

Outcome vector(const VectorOptions& options, const CommonOptions& common) {
  float background[4] = {};
  parseBackground(options.background, background);
  const std::vector<uint8_t> bytes = host::readFile(options.file);
  Messages messages;
  messages.showAll = options.allWarnings;
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.name = options.file.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  source.messageFn = onSvgMessage;
  source.messageUserData = &messages;
  GpgpSvgReport converted{};
  source.report = &converted;
  if (!options.stages.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(options.stages, failed);
    if (failed) throw Failure(options.stages + ": " + failed.message());
    source.stageFn = onStage;
    source.stageUserData = const_cast<std::string*>(&options.stages);
  }
  const Result<Blob> blob = compileSvg(source);
  if (!blob) throw Failure(options.file + ": " + (messages.error.empty() ? blob.name() : messages.error));
  if (!options.allWarnings && messages.warnings > kShownWarnings)
    std::fprintf(stderr, "%s: %u more; --all-warnings shows them\n", options.file.c_str(),
                 messages.warnings - kShownWarnings);

  Session session(common);
  host::HeadlessDevice& device = session.device();
  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  drawingInfo.label = options.file.c_str();
  drawingInfo.data = blob->data();
  drawingInfo.size = blob->size();
  const Drawing drawing = session.take(Drawing::create(session.context(), drawingInfo), "gpgpCreateDrawing");
  const GpgpDrawingInfo facts = session.take(drawing.info(), "gpgpGetDrawingInfo");
  if (!(facts.viewport[2] > 0) || !(facts.viewport[3] > 0)) throw Failure(options.file + ": the drawing has no extent");
  Size size = options.size;
  if (size.width == 0) {
    size.width = static_cast<uint32_t>(std::clamp(std::ceil(facts.viewport[2]), 1.0f, 4096.0f));
    size.height = static_cast<uint32_t>(std::clamp(std::ceil(facts.viewport[3]), 1.0f, 4096.0f));
  }

  GpgpCanvasCreateInfo canvasInfo = GPGP_CANVAS_CREATE_INFO_INIT;
  canvasInfo.base = session.workerInfo("canvas");
  canvasInfo.maxWidth = size.width;
  canvasInfo.maxHeight = size.height;
  canvasInfo.maxPatches = std::max(facts.patches, 1024u);
  canvasInfo.maxTileEntries = options.maxTileEntries;
  Canvas canvas = session.take(Canvas::create(session.context(), canvasInfo), "gpgpCreateCanvas");
  session.check(canvas.prewarm(), "gpgpPrewarm");
  session.upload();

  const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                           "picture");
  GpgpCanvasItem item{};
  item.drawing = drawing;
  item.opacity = 1.0f;
  fit(facts, size, item.transform);
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
  const auto [times, report] =
      session.measure(canvas, "rasterising", options.repeat,
                      [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                        GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
                        info.base = base;
                        info.width = size.width;
                        info.height = size.height;
                        info.items = &item;
                        info.itemCount = 1;
                        info.samples = options.samples;
                        info.exactArea = options.area ? VK_TRUE : VK_FALSE;
                        std::copy(std::begin(background), std::end(background), info.background);
                        info.target = target.target({}, after);
                        info.encodeSrgb = VK_TRUE;
                        return canvas.recordPrepare(commands, frame, info);
                      });
  std::vector<uint8_t> pixels;
  if (!options.out.empty() || options.truth) pixels = host::downloadImage(device, target, VK_IMAGE_LAYOUT_GENERAL);
  double psnr = 0;
  if (options.truth) psnr = compareWithTruth(bytes, pixels, item.transform, background, size);
  if (!options.out.empty()) {
    host::writePng(options.out, host::fromPremultiplied(size.width, size.height, pixels));
  }
  session.checkValidation();

  Json passes = Json::object();
  for (const auto& [name, time] : times.passes) passes[name] = time;
  const auto ratio = [](uint32_t a, uint32_t b) { return b ? static_cast<double>(a) / static_cast<double>(b) : 0.0; };
  Outcome outcome;
  std::ostringstream text;
  text << options.file << ": " << facts.paths << " paths, " << facts.curves << " curves, " << facts.patches
       << " patches; parsed in " << milliseconds(converted.parseMilliseconds) << ", converted in "
       << milliseconds(converted.convertMilliseconds) << '\n'
       << size.width << " x " << size.height << " pixels, " << options.samples << " samples each, "
       << report.tileEntries << " tile entries; GPU " << milliseconds(times.median()) << " (median of "
       << times.totals.size() << ") on " << device.name() << '\n';
  if (report.pathsDropped)
    text << "budget exceeded: " << report.pathsDropped << " paths were left out; --max-tile-entries "
         << report.tileEntries << " would have held them\n";
  if (messages.warnings) text << messages.warnings << " parts of the drawing are approximated or left out\n";
  if (options.truth) text << psnr << " dB against 256 samples a pixel by winding numbers\n";
  if (!options.out.empty()) text << "picture: " << options.out << '\n';
  outcome.text = text.str();
  outcome.json = {{"file", options.file},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"width", size.width},
                  {"height", size.height},
                  {"samples", options.samples},
                  {"paths", facts.paths},
                  {"curves", facts.curves},
                  {"patches", facts.patches},
                  {"tile_entries_given", report.tileEntriesGiven},
                  {"paths_dropped", report.pathsDropped},
                  {"warnings", messages.warnings},
                  {"curves_per_patch", ratio(facts.curves, facts.patches)},
                  {"tile_entries", report.tileEntries},
                  {"patches_per_tile", ratio(report.tileEntries, ((size.width + 15) / 16) * ((size.height + 15) / 16))},
                  {"parse_ms", converted.parseMilliseconds},
                  {"convert_ms", converted.convertMilliseconds},
                  {"gpu_ms_median", times.median()},
                  {"passes", passes},
                  {"unsupported", messages.list},
                  {"image", options.out.empty() ? Json() : Json(options.out)}};
  if (options.truth) outcome.json["psnr_db"] = psnr;
  return outcome;
}

} // namespace

Work addVector(CLI::App& app) {
  auto options = std::make_shared<VectorOptions>();
  CLI::App* command = app.add_subcommand("vector", "Rasterise an SVG on the GPU");
  command->add_option("FILE", options->file, "SVG or gzip-compressed SVG (.svgz)")
      ->required()
      ->check(CLI::ExistingFile);
  addSize(*command, "--size", options->size, "Picture size in pixels (default: the drawing's own)");
  command->add_option("--samples", options->samples, "Samples per pixel")
      ->check(CLI::IsMember({1u, 4u, 8u, 16u}))
      ->capture_default_str();
  command->add_option("--background", options->background, "Colour behind the drawing (default: transparent)")
      ->type_name("RRGGBB");
  command->add_option("-o,--out,OUT", options->out, "Write the picture")->type_name("FILE.png");
  command->add_flag("--area", options->area, "A pixel's first edge counts by its exact area");
  command->add_flag("--truth", options->truth,
                    "Compare with 256 samples a pixel, composited by winding numbers on the CPU (slow)");
  command->add_option("--stages", options->stages, "Write each stage of the conversion as SVG")->type_name("FOLDER");
  command->add_option("--repeat", options->repeat, "Rasterise N times and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->add_flag("--all-warnings", options->allWarnings, "Name every part that is approximated or left out");
  command->add_option("--max-tile-entries", options->maxTileEntries,
                      "Budget: patch references over all tiles (0: the library's default)");
  command->footer(R"(
Examples:
  gpgp vector tiger.svg --out tiger.png
  gpgp vector tiger.svgz --size 2048x2048 --background ffffff --out tiger.png
  gpgp vector map.svg --samples 4 --repeat 100 --json | jq .gpu_ms_median

What is approximated or left out is named on standard error with its line, the first ten unless --all-warnings is given,
and counted.)");
  return [options](const CommonOptions& common) { return vector(*options, common); };
}

} // namespace gpgp::cli
