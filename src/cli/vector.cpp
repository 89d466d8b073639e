// `gpgp vector`: converts an SVG to a drawing, rasterises it on the GPU and writes a picture.
#include "cli/css_color.h"
#include "cli/patch_tiles.h"
#include "cli/session.h"
#include "cli/textures.h"
#include "cli/vector_images.h"
#include "cli/vector_truth.h"
#include "host/files.h"
#include "host/picture.h"
#include "vector/import/svg/import.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace gpgp::cli {
namespace {

struct VectorOptions {
  std::string file, out, background, stages, antialiasing = "16";
  Size size;
  bool allWarnings = false;
  bool truth = false;
  uint32_t repeat = 1, maxTileEntries = 0;
};

constexpr uint32_t kShownWarnings = 10;

struct Messages {
  std::string error;
  uint32_t warnings = 0;
  Json unsupported = Json::array();
  bool showAll = false;
};

/// "line 3: <path> has a ..." as an object: what is named first is what it is about.
Json unsupportedPart(const std::string& text) {
  const size_t colon = text.find(": "), open = text.find('<'), close = text.find('>', open);
  const bool hasLine = text.rfind("line ", 0) == 0 && colon != text.npos;
  return {{"element", close != text.npos ? text.substr(open + 1, close - open - 1) : "style"},
          {"line", hasLine ? Json(std::strtoul(text.c_str() + 5, nullptr, 10)) : Json()},
          {"text", hasLine ? text.substr(colon + 2) : text}};
}

void GPGP_CALL onSvgMessage(void* userData, const GpgpMessage* message) {
  auto* messages = static_cast<Messages*>(userData);
  if (message->code == GPGP_ERROR_UNSUPPORTED) messages->unsupported.push_back(unsupportedPart(message->text));
  if (message->severity == GPGP_SEVERITY_ERROR && messages->error.empty()) messages->error = message->text;
  if (++messages->warnings > kShownWarnings && !messages->showAll) return;
  std::fprintf(stderr, "%s: %s\n", message->label, message->text);
}

struct Stages {
  std::string folder, failure;
};

void GPGP_CALL onStage(void* userData, const char* stage, const char* svg, size_t size) {
  auto* stages = static_cast<Stages*>(userData);
  try {
    host::writeFile(stages->folder + "/" + stage + ".svg", {svg, size});
  } catch (const std::exception& failed) { // the compiler, which calls this, throws nothing on
    stages->failure = failed.what();
  }
}

/// Fits the drawing into the picture as its preserveAspectRatio says.
void fit(std::span<const uint8_t> bytes, const GpgpDrawingInfo& drawing, const Size& size, float (&transform)[6]) {
  const auto fitted = gpgp::vector::svg::fitPage(std::as_bytes(bytes), drawing.viewport, size.width, size.height);
  if (!fitted) throw Failure(fitted.error().text);
  const double values[6] = {fitted->a, fitted->b, fitted->c, fitted->d, fitted->e, fitted->f};
  for (size_t i = 0; i < 6; ++i) transform[i] = static_cast<float>(values[i]);
}

/// Decibels between what the device painted (as it lies in the image) and samples composited by winding numbers.
double compareWithTruth(std::span<const uint8_t> bytes, std::span<const uint8_t> painted, const float (&transform)[6],
                        const std::array<float, 4>& background, const Size& size) {
  gpgp::vector::svg::Reporter quiet(nullptr, nullptr, "");
  const auto svg = gpgp::vector::svg::importSvg(std::as_bytes(bytes), quiet);
  if (!svg) throw Failure(svg.error().text);
  const gpgp::vector::svg::ImportedViews views(*svg);
  std::vector<float> pixels(painted.size());
  for (size_t i = 0; i < painted.size(); ++i) pixels[i] = static_cast<float>(painted[i]) / 255.0f;
  return psnrOverWhite(
      pixels,
      vectorTruth(views.paths, views.groups, transform, background.data(), size.width, size.height, Blend::Srgb),
      Blend::Srgb);
}

Outcome vector(const VectorOptions& options, const CommonOptions& common) {
  const std::array<float, 4> background = parseBackground(options.background);
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
  VectorImages images;
  images.attach(source);
  Stages stages{options.stages, {}};
  if (!options.stages.empty()) {
    source.stageFn = onStage;
    source.stageUserData = &stages;
  }
  const Result<Blob> blob = compileSvg(source);
  if (!blob) throw Failure(options.file + ": " + (messages.error.empty() ? blob.name() : messages.error));
  if (options.truth && !images.pictures().empty())
    throw Failure(options.file + ": the truth knows no images; draw it without --truth");
  if (!stages.failure.empty()) throw Failure(stages.failure);
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
    const float shrink = std::min(1.0f, 4096.0f / std::max(facts.viewport[2], facts.viewport[3]));
    size.width = static_cast<uint32_t>(std::max(std::ceil(facts.viewport[2] * shrink), 1.0f));
    size.height = static_cast<uint32_t>(std::max(std::ceil(facts.viewport[3] * shrink), 1.0f));
  }

  GpgpCanvasCreateInfo canvasInfo = GPGP_CANVAS_CREATE_INFO_INIT;
  canvasInfo.base = session.workerInfo("canvas");
  canvasInfo.maxWidth = size.width;
  canvasInfo.maxHeight = size.height;
  canvasInfo.maxPatches = std::max({facts.patches, facts.paths, 1024u});
  canvasInfo.maxTileEntries = options.maxTileEntries;
  Canvas canvas = session.take(Canvas::create(session.context(), canvasInfo), "gpgpCreateCanvas");
  session.check(canvas.prewarm(), "gpgpPrewarm");
  session.upload();

  const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                           "picture");
  GpgpCanvasItem item{};
  item.drawing = drawing;
  item.opacity = 1.0f;
  fit(bytes, facts, size, item.transform);
  const auto table = gpgp::vector::loadBaked({static_cast<const std::byte*>(blob->data()), blob->size()},
                                             std::pmr::get_default_resource());
  if (!table) throw Failure(table.error().text);
  const Textures textures(device, shrunkToShown(images.pictures(), *table, item.transform));
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
  const bool area = options.antialiasing == "area";
  const uint32_t samples = area ? 16 : static_cast<uint32_t>(std::stoul(options.antialiasing));
  const auto [times, report] =
      session.measure(canvas, "rasterising", options.repeat,
                      [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                        GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
                        info.base = base;
                        info.width = size.width;
                        info.height = size.height;
                        info.items = &item;
                        info.itemCount = 1;
                        info.images = textures.views().data();
                        info.imageCount = static_cast<uint32_t>(textures.views().size());
                        info.samples = samples;
                        info.exactArea = area ? VK_TRUE : VK_FALSE;
                        std::copy(std::begin(background), std::end(background), info.background);
                        info.target = target.target({}, after);
                        info.encodeSrgb = info.blendSrgb = VK_TRUE;
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
  const PatchTiles tiles = countPatchTiles(*table, item.transform, size.width, size.height);
  Outcome outcome;
  std::ostringstream text;
  text << options.file << ": " << facts.paths << " paths, " << facts.curves << " curves, " << facts.patches
       << " patches; parsed in " << milliseconds(converted.parseMilliseconds) << ", converted in "
       << milliseconds(converted.convertMilliseconds) << '\n'
       << size.width << " x " << size.height << " pixels, " << samples
       << (area ? " samples and exact areas each, " : " samples each, ") << report.tileEntries << " tile entries; GPU "
       << milliseconds(times.median()) << " (median of " << times.totals.size() << ") on " << device.name() << '\n';
  if (messages.warnings) text << messages.warnings << " parts of the drawing are approximated, left out or not valid\n";
  if (options.truth) text << psnr << " dB against 256 samples a pixel by winding numbers\n";
  if (!options.out.empty()) text << "picture: " << options.out << '\n';
  outcome.text = text.str();
  if (report.pathsDropped)
    outcome.failure = options.file + ": " + std::to_string(report.pathsDropped) + " of " + std::to_string(facts.paths) +
                      " paths were left out; --max-tile-entries " + std::to_string(report.tileEntries) +
                      " would hold them, or somewhat more";
  outcome.json = {{"file", options.file},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"width", size.width},
                  {"height", size.height},
                  {"aa", options.antialiasing},
                  {"samples", samples},
                  {"paths", facts.paths},
                  {"curves", facts.curves},
                  {"patches", facts.patches},
                  {"tile_entries_given", report.tileEntriesGiven},
                  {"paths_dropped", report.pathsDropped},
                  {"warnings", messages.warnings},
                  {"curves_per_patch", tiles.curvesPerPatch},
                  {"tile_entries", report.tileEntries},
                  {"patches_per_tile", tiles.patchesPerTile},
                  {"curves_per_patch_tiled", tiles.curvesPerPatchTiled},
                  {"parse_ms", converted.parseMilliseconds},
                  {"convert_ms", converted.convertMilliseconds},
                  {"gpu_ms_median", times.median()},
                  {"passes", passes},
                  {"unsupported", messages.unsupported},
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
  command
      ->add_option("--aa", options->antialiasing,
                   "Samples per pixel, or area: 16, and a pixel's first edge counts by its exact area")
      ->check(CLI::IsMember({"1", "4", "8", "16", "area"}))
      ->capture_default_str();
  command->add_option("--background", options->background, "CSS colour behind the drawing (default: transparent)")
      ->type_name("COLOUR");
  command->add_option("-o,--out,OUT", options->out, "Write the picture")->type_name("FILE.png");
  command->add_flag("--truth", options->truth,
                    "Compare with 256 samples a pixel, composited by winding numbers on the CPU (slow)");
  command->add_option("--stages", options->stages, "Write each stage of the conversion as SVG")->type_name("FOLDER");
  command->add_option("--repeat", options->repeat, "Rasterise N times and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->add_flag("--all-warnings", options->allWarnings, "Name every part that is approximated or left out");
  command->add_option("--max-tile-entries", options->maxTileEntries,
                      "Budget: tiles that paths' edges pass through (0: the library's default)");
  command->footer(R"(
Examples:
  gpgp vector tiger.svg --out tiger.png
  gpgp vector tiger.svgz --size 2048x2048 --background white --out tiger.png
  gpgp vector map.svg --aa 4 --repeat 100 --json | jq .gpu_ms_median

What is approximated or left out is named on standard error with its line, the first ten unless --all-warnings is given,
and counted.)");
  return [options](const CommonOptions& common) { return vector(*options, common); };
}

} // namespace gpgp::cli
