// `gpgp text`: lays out a string in fonts, draws it on the GPU and writes a picture.
#include "cli/css_color.h"
#include "cli/session.h"
#include "cli/text_glyphs.h"
#include "cli/text_overlay.h"
#include "cli/text_page.h"
#include "host/picture.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace gpgp::cli {
namespace {

struct TextOptions {
  PageOptions page;
  std::string font, out, color = "black", background, features;
  std::vector<std::string> fallbacks;
  uint32_t repeat = 1;
};

constexpr uint32_t kLargest = 16384; // pixels a side, as Size's

/// "liga=0,smcp": what CSS calls font-feature-settings.
std::vector<GpgpFontFeature> parseFeatures(const std::string& text) {
  std::vector<GpgpFontFeature> features;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    const bool named = part.size() >= 4 && std::all_of(part.begin(), part.begin() + 4,
                                                       [](char c) { return c > ' ' && c <= '~' && c != '='; });
    char* end = nullptr;
    const bool valued = part.size() > 5 && part[4] == '=' && part[5] >= '0' && part[5] <= '9';
    const unsigned long value = valued ? std::strtoul(part.c_str() + 5, &end, 10) : 1;
    if (!named || !(part.size() == 4 || (valued && *end == 0 && value <= 65535)))
      throw Usage("--features '" + part + "' is no feature; write four letters and a value, for example liga=0,smcp");
    features.push_back({GPGP_TAG(part[0], part[1], part[2], part[3]), static_cast<uint32_t>(value)});
  }
  return features;
}

/// What is seen of the page: all lines, across as wide as lines may be, and ink beyond.
struct PageBox {
  float left = 0, top = 0, right = 0, bottom = 0;
  void take(float l, float t, float r, float b) {
    left = std::min(left, l);
    top = std::min(top, t);
    right = std::max(right, r);
    bottom = std::max(bottom, b);
  }
};

PageBox boxOf(const GpgpLayoutInfo& layout, const PageGlyphs& glyphs, float width) {
  PageBox box{0, 0, width, layout.height};
  for (uint32_t i = 0; i < layout.lineCount; ++i) {
    const GpgpTextLine& line = layout.lines[i];
    box.take(line.left, line.top, line.left + line.width, line.top + line.height);
  }
  for (uint32_t i = 0; i < layout.glyphCount; ++i) {
    const GpgpTextGlyph& at = layout.glyphs[i];
    const float(&ink)[4] = glyphs.glyphs[glyphs.which[i]].box;
    if (ink[0] < ink[2])
      box.take(at.x + ink[0] * at.size, at.y + ink[1] * at.size, at.x + ink[2] * at.size, at.y + ink[3] * at.size);
  }
  return box;
}

Outcome text(TextOptions options, const CommonOptions& common) {
  const std::array<float, 4> color = parseCssColor("--color", options.color),
                             background = parseBackground(options.background);
  for (size_t i = 0; i < 4; ++i) options.page.color[i] = i < 3 ? host::linearFromSrgb(color[i]) : color[i];
  options.page.features = parseFeatures(options.features);
  options.page.fonts = {options.font};
  options.page.fonts.insert(options.page.fonts.end(), options.fallbacks.begin(), options.fallbacks.end());
  TextPage page(options.page);
  const GpgpLayoutInfo& layout = page.layout();
  const PageGlyphs glyphs = collectGlyphs(page);

  const float margin = std::ceil(std::max(2.0f, options.page.size / 8));
  const PageBox box = boxOf(layout, glyphs, options.page.width);
  const float left = margin - std::floor(box.left), top = margin - std::floor(box.top);
  const float across = left + std::ceil(box.right) + margin, down = top + std::ceil(box.bottom) + margin;
  if (!(across <= kLargest && down <= kLargest))
    throw Failure("the text takes " + std::to_string(std::llround(across)) + " x " +
                  std::to_string(std::llround(down)) + " pixels; pictures have at most " + std::to_string(kLargest) +
                  " a side: --width breaks lines, --size makes letters smaller");
  const Size size{static_cast<uint32_t>(across), static_cast<uint32_t>(down)};

  Session session(common);
  host::HeadlessDevice& device = session.device();
  const auto [glyphSet, indices] = makeGlyphSet(session, glyphs);
  const TextOverlay overlay = makeOverlay(session, layout, glyphs);
  std::vector<GpgpGlyphInstance> instances;
  uint64_t patches = overlay.patches;
  for (uint32_t i = 0; i < layout.glyphCount; ++i) {
    const GpgpTextGlyph& at = layout.glyphs[i];
    const PageGlyph& glyph = glyphs.glyphs[glyphs.which[i]];
    if (glyph.isPicture() || glyph.paths.empty()) continue;
    instances.push_back({indices[glyphs.which[i]], at.x, at.y, at.size, {}});
    std::copy(std::begin(at.color), std::end(at.color), instances.back().color);
    patches += uint64_t{glyph.verbs} * 4; // a curve is two or three
  }
  std::vector<GpgpCanvasItem> items;
  const auto addItem = [&](GpgpAsset drawing) -> GpgpCanvasItem& {
    return items.emplace_back(GpgpCanvasItem{drawing, {1, 0, 0, 1, left, top}, 1.0f});
  };
  if (!instances.empty()) {
    GpgpCanvasItem& item = addItem(nullptr);
    item.glyphSet = glyphSet;
    item.glyphs = instances.data();
    item.glyphCount = static_cast<uint32_t>(instances.size());
  }
  if (overlay.drawing) addItem(overlay.drawing);

  const host::Image target(device, {.format = VK_FORMAT_R8G8B8A8_UNORM, .width = size.width, .height = size.height},
                           "picture");
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
  const auto draw = [&](uint32_t maxTileEntries, uint32_t repeat) {
    GpgpCanvasCreateInfo canvasInfo = GPGP_CANVAS_CREATE_INFO_INIT;
    canvasInfo.base = session.workerInfo("canvas");
    canvasInfo.maxWidth = size.width;
    canvasInfo.maxHeight = size.height;
    canvasInfo.maxPatches = static_cast<uint32_t>(std::clamp<uint64_t>(patches, 1024, 1u << 22));
    canvasInfo.maxTileEntries = maxTileEntries;
    canvasInfo.maxGlyphs = std::max(static_cast<uint32_t>(instances.size()), 1u);
    Canvas canvas = session.take(Canvas::create(session.context(), canvasInfo), "gpgpCreateCanvas");
    session.check(canvas.prewarm(), "gpgpPrewarm");
    session.upload();
    return session.measure(canvas, "drawing", repeat,
                           [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordInfo& base) {
                             GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
                             info.base = base;
                             info.width = size.width;
                             info.height = size.height;
                             info.items = items.data();
                             info.itemCount = static_cast<uint32_t>(items.size());
                             if (overlay.atlas) {
                               info.images = overlay.atlas->views().data();
                               info.imageCount = static_cast<uint32_t>(overlay.atlas->views().size());
                             }
                             info.exactArea = VK_TRUE; // small letters want it
                             std::copy(background.begin(), background.end(), info.background);
                             info.target = target.target({}, after);
                             info.encodeSrgb = info.blendSrgb = VK_TRUE;
                             return canvas.recordPrepare(commands, frame, info);
                           });
  };
  auto drawn = draw(0, options.repeat);
  while (drawn.report.pathsDropped && drawn.report.tileEntries > drawn.report.tileEntriesGiven)
    drawn = draw(drawn.report.tileEntries, options.repeat); // now that it is known, or that it is more
  if (drawn.report.pathsDropped)
    throw Failure("the text is too much for one record: " + std::to_string(drawn.report.pathsDropped) +
                  " paths were left out");
  host::writePng(options.out, host::fromPremultiplied(size.width, size.height,
                                                      host::downloadImage(device, target, VK_IMAGE_LAYOUT_GENERAL)));
  session.checkValidation();

  Outcome outcome;
  std::ostringstream words;
  words << layout.glyphCount << " glyphs (" << glyphs.glyphs.size() << " different) in " << layout.lineCount
        << " lines; laid out in " << milliseconds(page.shapeMilliseconds()) << '\n'
        << size.width << " x " << size.height << " pixels; GPU " << milliseconds(drawn.times.median()) << " (median of "
        << drawn.times.totals.size() << ") on " << device.name() << '\n';
  if (!page.missing().empty()) words << page.missing().size() << " characters are in no font\n";
  words << "picture: " << options.out << '\n';
  outcome.text = words.str();
  outcome.json = {{"device", device.name()},
                  {"status", statusName(drawn.report.base.status)},
                  {"glyphs", layout.glyphCount},
                  {"lines", layout.lineCount},
                  {"width", size.width},
                  {"height", size.height},
                  {"shape_ms", page.shapeMilliseconds()},
                  {"gpu_ms_median", drawn.times.median()},
                  {"missing", page.missing()},
                  {"image", options.out}};
  return outcome;
}

} // namespace

Work addText(CLI::App& app) {
  auto options = std::make_shared<TextOptions>();
  CLI::App* command = app.add_subcommand("text", "Draw a string on the GPU");
  command->add_option("FONT", options->font, "TTF, OTF or TTC file")->required()->check(CLI::ExistingFile);
  command->add_option("TEXT", options->page.text, "UTF-8; write -- before the positions where it begins with a dash")
      ->required();
  command->add_option("OUT", options->out, "The picture, which fits the text and a margin")
      ->required()
      ->type_name("FILE.png");
  command->add_option("--size", options->page.size, "Pixels an em")
      ->check(CLI::Range(1.0, 4096.0))
      ->type_name("PX")
      ->capture_default_str();
  command->add_option("--width", options->page.width, "Lines break to fit this (default: only where the text says)")
      ->check(CLI::Range(1.0, double(kLargest)))
      ->type_name("PX");
  command
      ->add_option("--fallback", options->fallbacks,
                   "Font for what those before do not have; may be given several times")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false)
      ->type_name("FONT");
  command->add_option("--align", options->page.align, "start, end, left, center, right or justify (default: start)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, GpgpTextAlign>{{"start", GPGP_TEXT_ALIGN_START},
                                                                               {"end", GPGP_TEXT_ALIGN_END},
                                                                               {"left", GPGP_TEXT_ALIGN_LEFT},
                                                                               {"center", GPGP_TEXT_ALIGN_CENTER},
                                                                               {"right", GPGP_TEXT_ALIGN_RIGHT},
                                                                               {"justify", GPGP_TEXT_ALIGN_JUSTIFY}})
                      .description(""))
      ->type_name("SIDE");
  command->add_option("--color", options->color, "CSS colour of the text")->type_name("COLOUR")->capture_default_str();
  command->add_option("--background", options->background, "CSS colour behind the text (default: transparent)")
      ->type_name("COLOUR");
  command
      ->add_option("--language", options->page.language,
                   "BCP 47, for example ja or tr; chooses forms of glyphs, and where lines break")
      ->type_name("TAG");
  command->add_option("--features", options->features, "OpenType features, for example liga=0,smcp")->type_name("LIST");
  command->add_option("--direction", options->page.direction, "auto, ltr or rtl (default: auto)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, GpgpTextDirection>{{"auto", GPGP_TEXT_AUTO},
                                                                                   {"ltr", GPGP_TEXT_LEFT_TO_RIGHT},
                                                                                   {"rtl", GPGP_TEXT_RIGHT_TO_LEFT}})
                      .description(""))
      ->type_name("WAY");
  command->add_flag("--underline", options->page.underline, "Draw a line under the text");
  command->add_flag("--strike", options->page.strike, "Draw a line through the text");
  command->add_option("--repeat", options->repeat, "Draw N times and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->footer(R"(
Examples:
  gpgp text DejaVuSans.ttf "Hello, world" hello.png --size 48
  gpgp text NotoSans-Regular.ttf "Tea ☕ شاي" tea.png --fallback NotoSansArabic-Regular.ttf --fallback NotoColorEmoji.ttf
  gpgp text DejaVuSerif.ttf $'A title\n\nAnd text' page.png --size 16 --width 480 --align justify --background white
  gpgp text DejaVuSans.ttf office office.png --features liga=0 --json | jq .glyphs

Characters that no font has are named on standard error and drawn as the font's sign for them.)");
  return [options](const CommonOptions& common) { return text(*options, common); };
}

} // namespace gpgp::cli
