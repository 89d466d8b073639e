// `gpgp vector`: converts an SVG to a drawing, rasterises it on the GPU and writes a picture.
#include "cli/shared/command.h"
#include "cli/shared/css_color.h"
#include "cli/shared/session.h"
#include "cli/shared/textures.h"
#include "cli/vector/canvas_room.h"
#include "cli/vector/images.h"
#include "cli/vector/in_pass.h"
#include "cli/vector/lottie.h"
#include "cli/vector/patch_tiles.h"
#include "cli/vector/reference.h"
#include "cli/vector/svg_files.h"
#include "cli/vector/svg_messages.h"
#ifdef GPGP_CLI_TEXT
#include "cli/vector/svg_text.h"
#endif
#include "host/files.h"
#include "host/picture.h"
#include "vector/import/svg/import.h"
#include "vector/raster/segments.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <sstream>

namespace gpgp::cli {
namespace {

constexpr float kLargest = 4096; ///< pixels of a side, where no option says
constexpr double kLongMilliseconds = 500;

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

/// Fits a page into the picture as its preserveAspectRatio says.
void fit(std::span<const char> bytes, const float (&page)[4], const Size& size, float (&transform)[6]) {
  const auto fitted = gpgp::vector::svg::fitPage(std::as_bytes(bytes), page, size.width, size.height);
  if (!fitted) throw Failure(fitted.error().text);
  const double values[6] = {fitted->a, fitted->b, fitted->c, fitted->d, fitted->e, fitted->f};
  for (size_t i = 0; i < 6; ++i) transform[i] = static_cast<float>(values[i]);
}

/// What the picture shows: the fitted page, magnified around a point of it, and tilted about the picture's horizontal
/// middle line, seen from as far away as the picture is high.
PlaneMap mapOf(const VectorOptions& options, const float (&fitted)[6], const Size& size) {
  const auto of = [&](int i) { return static_cast<double>(fitted[i]); };
  const double middle[2] = {size.width / 2.0, size.height / 2.0};
  double center[2] = {middle[0], middle[1]}; // in the picture
  if (!options.center.empty())
    for (int i = 0; i < 2; ++i) center[i] = of(i) * options.center[0] + of(2 + i) * options.center[1] + of(4 + i);
  PlaneMap map{};
  for (size_t i = 0; i < 2; ++i) {
    map[i][0] = options.zoom * of(static_cast<int>(i));
    map[i][1] = options.zoom * of(static_cast<int>(2 + i));
    map[i][2] = options.zoom * (of(static_cast<int>(4 + i)) - center[i]);
  }
  const double angle = options.tilt * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
  for (size_t k = 0; k < 3; ++k) {
    const double x = map[0][k], y = map[1][k], w = (k == 2 ? 1 : 0) - s * y / size.height;
    map[0][k] = x + middle[0] * w;
    map[1][k] = c * y + middle[1] * w;
    map[2][k] = w;
  }
  return map;
}

/// The drawing's page: x, y, width, height; none where it has no extent or cannot be read.
std::optional<std::array<float, 4>> pageOf(std::span<const char> bytes, GpgpSvgSource source) {
  const auto said = gpgp::vector::svg::pageSize(std::as_bytes(bytes), source.fileSystem);
  if (!said) return std::nullopt;
  std::array<float, 4> page{0, 0, static_cast<float>(said->width), static_cast<float>(said->height)};
  if (page[2] > 0 && page[3] > 0) return page;
  source.messageFn = nullptr; // the ink is the page
  source.stageFn = nullptr;
  const Result<Blob> blob = compileSvg(source);
  if (!blob) return std::nullopt;
  const auto drawing = gpgp::vector::loadBaked({static_cast<const std::byte*>(blob->data()), blob->size()},
                                               std::pmr::get_default_resource());
  if (!drawing || !(drawing->viewport[2] > 0 && drawing->viewport[3] > 0)) return std::nullopt;
  std::copy_n(drawing->viewport, 4, page.begin());
  return page;
}

/// At what scale a picture shows the page; 0: at its own, or there is none.
float scaleInto(const Size& size, std::span<const char> bytes, const std::optional<std::array<float, 4>>& page) {
  if (size.width == 0 || !page) return 0;
  float transform[6], place[4];
  std::copy_n(page->begin(), 4, place);
  fit(bytes, place, size, transform);
  return std::min(std::max(transform[0], transform[3]), 1e6f);
}

/// Decibels between what the device painted (as it lies in the image) and samples composited by winding numbers.
double compareWithReference(std::span<const char> bytes, std::span<const uint8_t> painted, const float (&transform)[6],
                            const std::array<float, 4>& background, const Size& size, const GpgpSvgSource& source) {
  gpgp::vector::svg::Reporter quiet(nullptr, nullptr, "");
  gpgp::vector::svg::ImportDetail detail;
  if (source.scale > 0) detail.scale = static_cast<double>(source.scale);
  detail.strokes /= 16; // so that what strokes are off by is seen
  const auto svg = gpgp::vector::svg::importSvg(std::as_bytes(bytes), quiet, {}, {}, detail, source.fileSystem,
                                                {source.textFn, source.textUserData});
  if (!svg) throw Failure(svg.error().text);
  const gpgp::vector::svg::ImportedViews views(*svg);
  std::vector<float> pixels(painted.size());
  for (size_t i = 0; i < painted.size(); ++i) pixels[i] = static_cast<float>(painted[i]) / 255.0f;
  return psnrOverWhite(
      pixels,
      vectorReference(views.paths, views.groups, transform, background.data(), size.width, size.height, Blend::Srgb),
      Blend::Srgb);
}

/// Draws inside a render pass, and says what came of it. `reference`: decibels of pixels.
Outcome outcomeInPass(Session& session, const Drawing& drawing, const GpgpDrawingInfo& facts,
                      const VectorOptions& options, InPassInfo info,
                      const std::function<double(std::span<const uint8_t>)>& reference) {
  const bool area = options.antialiasing.empty() || options.antialiasing == "area";
  info.samples = area ? 1 : static_cast<uint32_t>(std::stoul(options.antialiasing));
  session.upload();
  const InPassPicture picture = drawInPass(session, drawing, info);
  session.checkValidation();
  if (!options.out.empty())
    host::writePng(options.out, host::fromPremultiplied(info.width, info.height, picture.bytes));
  Outcome outcome;
  std::ostringstream text;
  text << inputName(options.file) << ": " << facts.paths << " paths, " << info.width << " x " << info.height
       << " pixels, in the pass, " << (area ? "exact coverage" : std::to_string(info.samples) + " samples each")
       << "; GPU " << milliseconds(picture.times.median()) << " (median of " << picture.times.totals.size() << ") on "
       << session.device().name() << '\n';
  if (facts.pathsLeftOut) text << facts.pathsLeftOut << " paths are left out, as patches do not draw them\n";
  outcome.json = {{"file", options.file},
                  {"device", session.device().name()},
                  {"method", options.method},
                  {"width", info.width},
                  {"height", info.height},
                  {"aa", area ? "area" : options.antialiasing},
                  {"samples", info.samples},
                  {"paths", facts.paths},
                  {"paths_left_out", facts.pathsLeftOut},
                  {"gpu_ms_median", picture.times.median()},
                  {"image", options.out.empty() ? Json() : Json(options.out)}};
  if (options.reference) {
    const double psnr = reference(picture.bytes);
    text << psnr << " dB against 256 samples a pixel by winding numbers\n";
    outcome.json["psnr_db"] = psnr;
  }
  if (!options.out.empty()) text << "picture: " << options.out << '\n';
  outcome.text = text.str();
  return outcome;
}

Outcome vector(const VectorOptions& options, const CommonOptions& common) {
  const std::array<float, 4> background = parseBackground(options.background);
  const std::string bytes = readInput(options.file), name = inputName(options.file);
  if (bytes.starts_with("GPVD")) throw Failure(name + ": a baked drawing; SVG is wanted, from which it was made");
  if (isLottie(bytes)) return lottie(options, common, bytes);
  if (options.frame || options.sheet.width)
    throw Failure(name + ": no animation; --frame and --sheet are for Lottie files");
  SvgMessages messages(options.allWarnings ? SIZE_MAX : kShownMessages);
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.name = name.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  messages.attach(source);
  const SvgFiles files(options.file);
  source.fileSystem = files.fileSystem();
  GpgpSvgReport converted{};
  source.report = &converted;
  VectorImages images;
  images.attach(source);
#ifdef GPGP_CLI_TEXT
  SvgText fonts(options.fonts, true);
  fonts.attach(source);
#endif
  Stages stages{options.stages, {}};
  if (!options.stages.empty()) {
    source.stageFn = onStage;
    source.stageUserData = &stages;
  }
  const bool inPass = options.method == "in-pass";
  source.methods = inPass ? GPGP_DRAWING_IN_PASS : GPGP_DRAWING_FLATTENED;
  const bool isSized = options.size.width || options.width || options.height;
  const std::optional<std::array<float, 4>> page = isSized ? pageOf(bytes, source) : std::nullopt;
  const std::array<float, 4> shown = page.value_or(std::array<float, 4>{});
  const Size asked = sizeAsked(options, static_cast<double>(shown[2]), static_cast<double>(shown[3]));
  source.scale = scaleInto(asked, bytes, page);
  if (options.zoom > 1) source.scale = std::min(std::max(source.scale, 1.0f) * static_cast<float>(options.zoom), 1e6f);
  Session session(common);
  host::HeadlessDevice& device = session.device();
  source.maxStorageBufferRange = device.properties().limits.maxStorageBufferRange;
  const Result<Blob> blob = compileSvg(source);
  if (!blob) throw Failure(messages.count() ? messages.failure() : name + ": " + blob.name());
  messages.finish();
  if (options.reference && options.tilt != 0)
    throw Failure("the reference knows no perspective; draw without --tilt or without --reference");
  if (options.reference && !images.pictures().empty())
    throw Failure(name + ": the reference knows no images; draw it without --reference");
  if (!stages.failure.empty()) throw Failure(stages.failure);

  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  drawingInfo.label = name.c_str();
  drawingInfo.data = blob->data();
  drawingInfo.size = blob->size();
  const bool patches = options.method == "patches";
  if (patches) drawingInfo.methods = GPGP_DRAWING_FLATTENED | GPGP_DRAWING_PATCHES;
  const Drawing drawing = session.take(Drawing::create(session.context(), drawingInfo), "gpgpCreateDrawing");
  const GpgpDrawingInfo facts = session.take(drawing.info(), "gpgpGetDrawingInfo");
  if (!(facts.viewport[2] > 0) || !(facts.viewport[3] > 0)) throw Failure(name + ": the drawing has no extent");
  Size size = asked;
  float shrink = 1;
  if (size.width == 0) {
    shrink = std::min(1.0f, kLargest / std::max(facts.viewport[2], facts.viewport[3]));
    size.width = static_cast<uint32_t>(std::max(std::ceil(facts.viewport[2] * shrink), 1.0f));
    size.height = static_cast<uint32_t>(std::max(std::ceil(facts.viewport[3] * shrink), 1.0f));
  }

  GpgpCanvasItem item{};
  item.drawing = drawing;
  item.opacity = 1.0f;
  fit(bytes, facts.viewport, size, item.transform);
  const PlaneMap map = mapOf(options, item.transform, size);
  for (size_t k = 0; k < 3; ++k) {
    item.transform[2 * k] = static_cast<float>(map[0][k]);
    item.transform[2 * k + 1] = static_cast<float>(map[1][k]);
    if (options.tilt != 0) item.perspective[k] = static_cast<float>(map[2][k]);
  }
  if (inPass)
    return outcomeInPass(session, drawing, facts, options,
                         {map, size.width, size.height, 1, background, options.repeat},
                         [&](std::span<const uint8_t> pixels) {
                           return compareWithReference(bytes, pixels, item.transform, background, size, source);
                         });

  GpgpCanvasCreateInfo canvasInfo = GPGP_CANVAS_CREATE_INFO_INIT;
  canvasInfo.base = session.recorderInfo("canvas");
  canvasInfo.maxWidth = size.width;
  canvasInfo.maxHeight = size.height;
  canvasInfo.maxPaths = std::max(facts.paths, 1024u);
  canvasInfo.maxTileEntries = options.maxTileEntries;
  canvasInfo.targets = GPGP_CANVAS_TARGET_RGBA8;
  canvasInfo.method = patches ? GPGP_CANVAS_PATCHES : GPGP_CANVAS_FLATTENED;
  canvasInfo.maxImages = static_cast<uint32_t>(images.pictures().size());
  const auto table = gpgp::vector::loadBaked({static_cast<const std::byte*>(blob->data()), blob->size()},
                                             std::pmr::get_default_resource());
  if (!table) throw Failure(table.error().text);
  if (options.reference && !table->plan.empty())
    throw Failure(name + ": the reference knows no masks, filters and blend modes; draw it without --reference");
  if (!table->plan.empty()) { // a first guess; the report says what is needed
    canvasInfo.maxLayerPixels = firstLayerPixels(device, size);
    canvasInfo.maxDrawings = static_cast<uint32_t>(std::clamp<size_t>(table->plan.runs.size() * 2, 64, 65536));
  }
  Canvas canvas = session.take(Canvas::create(session.context(), canvasInfo), "gpgpCreateCanvas");
  session.check(canvas.prewarm(), "gpgpPrewarm");
  session.upload();

  const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                           "picture");
  // What is uploaded are outlines; the library makes them with the asset, where the time also holds the upload's.
  const auto beforeOutlines = std::chrono::steady_clock::now();
  gpgp::vector::makeOutlines(*table, std::pmr::get_default_resource());
  const double convertMilliseconds =
      converted.convertMilliseconds +
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - beforeOutlines).count();
  const Textures textures(device, shrunkToShown(images.pictures(), *table, item.transform));
  const Antialiasing antialiasing = antialiasingOf(options);
  const CanvasPicture picture{item, textures, target, size, background, antialiasing};
  const auto rasterise = [&](uint32_t repeat) { return drawPicture(session, canvas, picture, repeat); };
  // The report says what the drawing needs.
  auto drawn = rasterise(1);
  while (drawn.report.pathsDropped && options.maxTileEntries == 0) {
    std::optional<Canvas> larger = largerCanvas(session, canvasInfo, drawn.report);
    if (!larger) break;
    canvas = std::move(*larger);
    session.check(canvas.prewarm(), "gpgpPrewarm");
    drawn = rasterise(1);
  }
  // What memory costs that is used the first time is not counted, but where it is little beside the rest.
  if (options.repeat > 1 || drawn.times.median() < kLongMilliseconds) drawn = rasterise(options.repeat);
  const auto& [times, report] = drawn;
  std::vector<uint8_t> pixels;
  if (!options.out.empty() || options.reference) pixels = host::downloadImage(device, target, VK_IMAGE_LAYOUT_GENERAL);
  double psnr = 0;
  if (options.reference) psnr = compareWithReference(bytes, pixels, item.transform, background, size, source);
  if (!options.out.empty()) {
    host::writePng(options.out, host::fromPremultiplied(size.width, size.height, pixels));
  }
  session.checkValidation();

  Json passes = Json::object();
  for (const auto& [pass, time] : times.passes) passes[pass] = time;
  const PatchTiles tiles = countPatchTiles(*table, item.transform, size.width, size.height);
  Outcome outcome;
  std::ostringstream text;
  text << name << ": " << facts.paths << " paths, " << facts.curves << " curves, " << facts.patches
       << " patches; parsed in " << milliseconds(converted.parseMilliseconds) << ", converted in "
       << milliseconds(convertMilliseconds) << '\n'
       << size.width << " x " << size.height << " pixels"
       << (shrink < 1 ? " (shrunk to them; --size makes more), " : ", ") << antialiasing.samples
       << (antialiasing.area ? " samples and exact areas each, " : " samples each, ") << report.tileEntries
       << " tile entries" << (patches ? " of " + std::to_string(report.tilePatches) + " patches" : "") << "; GPU "
       << milliseconds(times.median()) << " (median of " << times.totals.size() << ") on " << device.name() << '\n';
  if (facts.paths == 0) text << "nothing is drawn: the drawing has no shape with an area or a stroke\n";
  if (messages.count()) text << messages.count() << " parts of the drawing are approximated, left out or not valid\n";
  if (options.reference) text << psnr << " dB against 256 samples a pixel by winding numbers\n";
  if (!options.out.empty()) text << "picture: " << options.out << '\n';
  outcome.text = text.str();
  if (!report.pathsDropped) {
    outcome.failure = messages.firstRefusal();
    outcome.errorsShown = messages.refusals();
  } else
    outcome.failure = name + ": " + omitted(report, facts.paths, options.maxTileEntries != 0);
  outcome.json = {{"file", options.file},
                  {"device", device.name()},
                  {"status", statusName(report.base.status)},
                  {"width", size.width},
                  {"height", size.height},
                  {"method", options.method},
                  {"aa", options.antialiasing.empty() ? "16" : options.antialiasing},
                  {"samples", antialiasing.samples},
                  {"paths", facts.paths},
                  {"curves", facts.curves},
                  {"patches", facts.patches},
                  {"tile_entries_given", report.tileEntriesGiven},
                  {"tile_words", report.tileWords},
                  {"tile_words_given", report.tileWordsGiven},
                  {"paths_dropped", report.pathsDropped},
                  {"warnings", messages.count()},
                  {"messages", messages.json()},
                  {"curves_per_patch", tiles.curvesPerPatch},
                  {"tile_entries", report.tileEntries},
                  {"tile_patches", report.tilePatches},
                  {"patches_per_tile", tiles.patchesPerTile},
                  {"curves_per_patch_tiled", tiles.curvesPerPatchTiled},
                  {"parse_ms", converted.parseMilliseconds},
                  {"convert_ms", convertMilliseconds},
                  {"gpu_ms_median", times.median()},
                  {"passes", passes},
                  {"unsupported", messages.unsupported()},
                  {"image", options.out.empty() ? Json() : Json(options.out)}};
  if (options.reference) outcome.json["psnr_db"] = psnr;
  return outcome;
}

} // namespace

Work addVector(CLI::App& app) {
  auto options = std::make_shared<VectorOptions>();
  CLI::App* command = app.add_subcommand("vector", "Rasterise an SVG, or frames of a Lottie animation, on the GPU");
  command
      ->add_option("FILE", options->file,
                   "SVG, gzip-compressed SVG (.svgz), or Lottie animation (.json, .lottie); - is standard input")
      ->required()
      ->check(existingInput());
  CLI::Option* size =
      addSize(*command, "--size", options->size, "Picture size in pixels (default: the drawing's own, at most 4096)");
  command->add_option("--width", options->width, "Picture width; its height follows the page unless --height is given")
      ->check(CLI::Range(1u, kLargestSide))
      ->excludes(size);
  command->add_option("--height", options->height, "Picture height; its width follows the page unless --width is given")
      ->check(CLI::Range(1u, kLargestSide))
      ->excludes(size);
  command
      ->add_option(
          "--aa", options->antialiasing,
          "Samples per pixel, or area: 16, and a pixel's first edge counts by its exact area. Default: 16; in-pass: "
          "area")
      ->check(CLI::IsMember({"1", "4", "8", "16", "area"}));
  command
      ->add_option(
          "--method", options->method,
          "flattened: outlines rasterised into a picture; patches: the same from CPatches, whose implicit forms "
          "decide every sample; in-pass: drawn as geometry inside a render pass, with exact "
          "coverage or as many samples as --aa says")
      ->check(CLI::IsMember({"flattened", "patches", "in-pass"}))
      ->capture_default_str();
#ifdef GPGP_CLI_TEXT
  command
      ->add_option("--font", options->fonts,
                   "Font of the drawing's text; may be given several times (default: the system's fonts)")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
#endif
  command->add_option("--zoom", options->zoom, "Magnify the picture around its middle")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  command->add_option("--center", options->center, "The point of the page in the middle of the picture")
      ->expected(2)
      ->delimiter(',')
      ->type_name("X,Y");
  command->add_option("--tilt", options->tilt, "Tilt the page by this many degrees, in perspective")
      ->check(CLI::Range(-89.0, 89.0))
      ->capture_default_str();
  CLI::Option* frame =
      command->add_option("--frame", options->frame, "Lottie: the frame, which may be a fraction (default: the first)")
          ->type_name("N");
  addSize(*command, "--sheet", options->sheet,
          "Lottie: a sheet of W columns and H rows of frames, equally spaced over the animation")
      ->excludes(frame);
  command->add_option("--background", options->background, "CSS colour behind the drawing (default: transparent)")
      ->type_name("COLOUR");
  command->add_option("-o,--out,OUT", options->out, "Write the picture")->check(pngFile())->type_name("FILE.png");
  command->add_flag("--reference", options->reference,
                    "Compare with 256 samples a pixel, composited by winding numbers on the CPU (slow)");
  command->add_option("--stages", options->stages, "Write each stage of the conversion as SVG")->type_name("FOLDER");
  command
      ->add_option(
          "--repeat", options->repeat,
          "Rasterise N times and report the median time; a first run before them is not counted, unless N is 1 "
          "and it takes more than half a second")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->add_flag("--all-warnings", options->allWarnings, "Name every part that is approximated or left out");
  command->add_option("--max-tile-entries", options->maxTileEntries,
                      "Budget: tiles that paths' edges pass through (0: as many as are needed)");
  command->footer(R"(
Examples:
  gpgp vector tiger.svg --out tiger.png
  gpgp vector tiger.svgz --size 2048x2048 --background white --out tiger.png
  gpgp vector icon.svg --width 300 --out icon.png
  cat icon.svg | gpgp vector - icon.png
  gpgp vector map.svg --aa 4 --repeat 100 --json | jq .gpu_ms_median
  gpgp vector spinner.json --frame 12.5 --out spinner.png
  gpgp vector spinner.lottie --sheet 6x4 --size 160x160 --out sheet.png

Parts that are approximated or left out are counted, and named on standard error with their place: the first ten, or all
with --all-warnings. --json lists all of them as messages, and unsupported ones also as unsupported.)");
  return [options](const CommonOptions& common) { return vector(*options, common); };
}

} // namespace gpgp::cli
