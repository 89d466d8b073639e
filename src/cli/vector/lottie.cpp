#include "cli/vector/lottie.h"

#include "cli/shared/css_color.h"
#include "cli/shared/session.h"
#include "cli/shared/textures.h"
#include "cli/vector/canvas_room.h"
#include "cli/vector/images.h"
#include "cli/vector/svg_files.h"
#include "cli/vector/svg_messages.h"
#ifdef GPGP_CLI_TEXT
#include "cli/vector/svg_text.h"
#endif
#include "host/files.h"
#include "host/picture.h"
#include "vector/patch/drawing.h"

#include <gpgp/lottie.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <sstream>

namespace gpgp::cli {
namespace {

constexpr double kLargest = 4096; ///< pixels of a side, where --size does not say
constexpr uint32_t kLargestSheet = 16384, kMostFrames = 10'000;

double millisecondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

/// What drawing one frame needs, and what it came to.
struct Frame {
  double number = 0;
  std::vector<uint8_t> pixels;
  double evaluateMilliseconds = 0, convertMilliseconds = 0, gpuMilliseconds = 0;
  uint32_t paths = 0;
};

/// Draws frames one after another on one canvas, which grows where a frame needs more.
class FramePainter {
public:
  FramePainter(Session& session, const VectorOptions& options, const Size& size, const GpgpLottieInfo& about,
               const VectorImages& images)
      : session_(session), options_(options), size_(size), images_(images),
        background_(parseBackground(options.background)),
        target_(session.device(), {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                "picture") {
    const float scale =
        std::min(static_cast<float>(size.width) / about.width, static_cast<float>(size.height) / about.height);
    const float to[6] = {scale,
                         0,
                         0,
                         scale,
                         (static_cast<float>(size.width) - about.width * scale) / 2,
                         (static_cast<float>(size.height) - about.height * scale) / 2};
    std::copy_n(to, 6, transform_);
    info_ = GPGP_CANVAS_CREATE_INFO_INIT;
    info_.base = session.recorderInfo("canvas");
    info_.maxWidth = size.width;
    info_.maxHeight = size.height;
    info_.maxPaths = 131072;
    info_.maxTileEntries = options.maxTileEntries;
    info_.targets = GPGP_CANVAS_TARGET_RGBA8;
    info_.maxImages = static_cast<uint32_t>(images.pictures().size());
    info_.maxLayerPixels = firstLayerPixels(session.device(), size);
    canvas_ = session.take(Canvas::create(session.context(), info_), "gpgpCreateCanvas");
    session.check(canvas_.prewarm(), "gpgpPrewarm");
  }

  Frame draw(Lottie& animation, double number, std::string& failure) {
    Frame frame;
    frame.number = number;
    auto begin = std::chrono::steady_clock::now();
    session_.check(animation.evaluate(number).code(), "gpgpEvaluateLottie");
    frame.evaluateMilliseconds = millisecondsSince(begin);
    begin = std::chrono::steady_clock::now();
    const Blob blob = session_.take(animation.compile(number), "gpgpCompileLottieFrame");
    frame.convertMilliseconds = std::max(millisecondsSince(begin) - frame.evaluateMilliseconds, 0.0); // evaluates, too
    GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
    drawingInfo.data = blob.data();
    drawingInfo.size = blob.size();
    const Drawing drawing = session_.take(Drawing::create(session_.context(), drawingInfo), "gpgpCreateDrawing");
    frame.paths = session_.take(drawing.info(), "gpgpGetDrawingInfo").paths;
    session_.upload();
    GpgpCanvasItem item = GPGP_CANVAS_ITEM_INIT;
    item.drawing = drawing;
    std::copy_n(transform_, 6, item.transform);
    const auto table = gpgp::vector::loadBaked({static_cast<const std::byte*>(blob.data()), blob.size()},
                                               std::pmr::get_default_resource());
    if (!table) throw Failure(table.error().text);
    const Textures textures(session_.device(), shrunkToShown(images_.pictures(), *table, transform_));
    const CanvasPicture picture{item, textures, target_, size_, background_, antialiasingOf(options_)};
    const auto rasterise = [&] { return drawPicture(session_, canvas_, picture, options_.repeat); };
    auto drawn = rasterise();
    while (drawn.report.pathsDropped && options_.maxTileEntries == 0) {
      std::optional<Canvas> larger = largerCanvas(session_, info_, drawn.report);
      if (!larger) break;
      canvas_ = std::move(*larger);
      session_.check(canvas_.prewarm(), "gpgpPrewarm");
      drawn = rasterise();
    }
    if (drawn.report.pathsDropped && failure.empty()) {
      std::ostringstream text;
      text << "frame " << number << ": " << omitted(drawn.report, frame.paths, options_.maxTileEntries != 0);
      failure = text.str();
    }
    frame.gpuMilliseconds = drawn.times.median();
    frame.pixels = host::downloadImage(session_.device(), target_, VK_IMAGE_LAYOUT_GENERAL);
    return frame;
  }

private:
  Session& session_;
  const VectorOptions& options_;
  Size size_;
  const VectorImages& images_;
  std::array<float, 4> background_;
  host::Image target_;
  float transform_[6];
  GpgpCanvasCreateInfo info_;
  Canvas canvas_;
};

} // namespace

bool isLottie(std::string_view bytes) {
  if (bytes.starts_with("PK\x03\x04")) return true;
  const size_t first = bytes.find_first_not_of(" \t\r\n", bytes.starts_with("\xef\xbb\xbf") ? 3 : 0);
  return first != bytes.npos && bytes[first] == '{';
}

Outcome lottie(const VectorOptions& options, const CommonOptions& common, const std::string& bytes) {
  const std::string name = inputName(options.file);
  const auto refuse = [&](bool asked, const char* option) {
    if (asked) throw Failure(name + ": " + option + " is not for animations");
  };
  refuse(options.reference, "--reference");
  refuse(options.method != "flattened", "--method other than flattened");
  refuse(options.tilt != 0, "--tilt");
  refuse(options.zoom != 1 || !options.center.empty(), "--zoom or --center");
  refuse(!options.stages.empty(), "--stages");
  const bool sheet = options.sheet.width > 0;
  if (options.frame && !std::isfinite(*options.frame)) throw Failure("--frame takes a finite number");

  SvgMessages messages(options.allWarnings ? SIZE_MAX : kShownMessages);
  GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
  source.name = name.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  const SvgFiles files(options.file);
  source.fileSystem = files.fileSystem();
  VectorImages images;
  images.attach(source);
#ifdef GPGP_CLI_TEXT
  SvgText fonts(options.fonts, true);
  fonts.attach(source);
#endif
  // Once for its size, which says how fine strokes must be; then with messages, those of its frames among them.
  const auto read = [&](float scale) {
    source.scale = scale;
    messages.attach(source);
    Result<Lottie> made = Lottie::create(source);
    if (!made) throw Failure(messages.count() ? messages.failure() : name + ": " + made.name());
    return std::move(*made);
  };
  GpgpLottieSource quiet = source;
  quiet.imageFn = nullptr;
  const Result<Lottie> first = Lottie::create(quiet);
  if (!first) read(0); // which says why
  GpgpLottieInfo about = first ? *first->info() : GpgpLottieInfo{};

  const uint32_t columns = sheet ? options.sheet.width : 1, rows = sheet ? options.sheet.height : 1;
  Size size = sizeAsked(options, static_cast<double>(about.width), static_cast<double>(about.height));
  if (size.width == 0) {
    const double width = static_cast<double>(about.width), height = static_cast<double>(about.height);
    const double shrink = std::min(1.0, kLargest / std::max(width * columns, height * rows));
    size.width = static_cast<uint32_t>(std::max(std::ceil(width * shrink), 1.0));
    size.height = static_cast<uint32_t>(std::max(std::ceil(height * shrink), 1.0));
  }
  if (columns * rows > kMostFrames)
    throw Failure("--sheet: " + std::to_string(columns * rows) + " frames are more than " +
                  std::to_string(kMostFrames));
  if (uint64_t(size.width) * columns > kLargestSheet || uint64_t(size.height) * rows > kLargestSheet)
    throw Failure("--sheet: the sheet would be larger than 16384 x 16384 pixels; a smaller --size helps");
  const float scale =
      std::min(static_cast<float>(size.width) / about.width, static_cast<float>(size.height) / about.height);
  const auto begin = std::chrono::steady_clock::now();
  Lottie animation = read(scale > 1 ? std::min(scale, 1e6f) : 0);
  const double parseMilliseconds = millisecondsSince(begin);
  about = *animation.info();

  Session session(common);
  FramePainter painter(session, options, size, about, images);
  std::vector<uint8_t> pixels(size_t(size.width) * columns * size.height * rows * 4);
  Outcome outcome;
  Json frames = Json::array();
  double evaluate = 0, convert = 0, gpu = 0;
  for (uint32_t i = 0; i < columns * rows; ++i) {
    const double spacing = (about.endFrame - about.firstFrame) / (columns * rows);
    const double number = sheet ? about.firstFrame + spacing * i : options.frame.value_or(about.firstFrame);
    const Frame frame = painter.draw(animation, number, outcome.failure);
    for (uint32_t y = 0; y < size.height; ++y) {
      const size_t row = size_t(i / columns) * size.height + y;
      std::memcpy(&pixels[(row * columns + i % columns) * size.width * 4], &frame.pixels[size_t(y) * size.width * 4],
                  size_t(size.width) * 4);
    }
    frames.push_back({{"frame", number},
                      {"paths", frame.paths},
                      {"evaluate_ms", frame.evaluateMilliseconds},
                      {"convert_ms", frame.convertMilliseconds},
                      {"gpu_ms", frame.gpuMilliseconds}});
    evaluate += frame.evaluateMilliseconds, convert += frame.convertMilliseconds, gpu += frame.gpuMilliseconds;
  }
  messages.finish();
  if (!options.out.empty())
    host::writePng(options.out, host::fromPremultiplied(size.width * columns, size.height * rows, pixels));
  session.checkValidation();
  if (!outcome.failure.empty()) outcome.failure = name + ": " + outcome.failure;

  const double count = columns * rows;
  std::ostringstream text;
  text << name << ": " << about.layers << " layers, frames " << about.firstFrame << " to " << about.endFrame << " at "
       << about.frameRate << " a second; parsed in " << milliseconds(parseMilliseconds) << '\n'
       << columns * rows << (columns * rows == 1 ? " frame of " : " frames of ") << size.width << " x " << size.height
       << " pixels; each evaluated in " << milliseconds(evaluate / count) << ", converted in "
       << milliseconds(convert / count) << "; GPU " << milliseconds(gpu / count) << " on " << session.device().name()
       << '\n';
  if (messages.count())
    text << messages.count() << (messages.count() == 1 ? " kind of thing is" : " kinds of things are")
         << " approximated, left out or not valid\n";
  if (!options.out.empty()) text << "picture: " << options.out << '\n';
  outcome.text = text.str();
  outcome.json = {{"file", options.file},
                  {"device", session.device().name()},
                  {"width", size.width},
                  {"height", size.height},
                  {"columns", columns},
                  {"rows", rows},
                  {"layers", about.layers},
                  {"first_frame", about.firstFrame},
                  {"end_frame", about.endFrame},
                  {"frame_rate", about.frameRate},
                  {"parse_ms", parseMilliseconds},
                  {"frames", frames},
                  {"warnings", messages.count()},
                  {"messages", messages.json()},
                  {"unsupported", messages.unsupported()},
                  {"image", options.out.empty() ? Json() : Json(options.out)}};
  return outcome;
}

} // namespace gpgp::cli
