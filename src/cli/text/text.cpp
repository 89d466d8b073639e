// `gpgp text`: lays out a string in fonts, draws it on the GPU and writes a picture.
#include "cli/shared/command.h"
#include "cli/shared/css_color.h"
#include "cli/shared/session.h"
#include "cli/text/draw.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace gpgp::cli {
namespace {

struct TextOptions {
  PageOptions page;
  std::string font, out, color = "black", outlineColor = "white", background, features, axes;
  std::vector<std::string> fallbacks;
  uint32_t repeat = 1;
};

constexpr uint32_t kLargest = 16384; // pixels a side, as Size's
constexpr uint32_t kWidest = 8192;   // of lines, so that there is room for margins and what hangs out

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
      throw Usage("--features '" + part +
                  "' is not a feature; write four letters and a value, for example liga=0,smcp");
    features.push_back({GPGP_TAG(part[0], part[1], part[2], part[3]), static_cast<uint32_t>(value)});
  }
  return features;
}

std::array<float, 4> parseLinear(const char* option, const std::string& text) {
  std::array<float, 4> color = parseCssColor(option, text);
  for (size_t i = 0; i < 3; ++i) color[i] = color[3] > 0 ? host::linearFromSrgb(color[i]) : 1; // all 0 is black
  return color;
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
    for (const auto* which : {&glyphs.which, &glyphs.outlines}) {
      if (which->empty()) continue;
      const float(&ink)[4] = glyphs.glyphs[(*which)[i]].box;
      if (ink[0] < ink[2])
        box.take(at.x + ink[0] * at.size, at.y + ink[1] * at.size, at.x + ink[2] * at.size, at.y + ink[3] * at.size);
    }
  }
  for (uint32_t i = 0; i < layout.decorationCount; ++i) {
    const auto& [x, y, w, h] = layout.decorations[i].rect;
    box.take(x, y, x + w, y + h);
  }
  return box;
}

Outcome text(TextOptions options, const CommonOptions& common) {
  const std::array<float, 4> background = parseBackground(options.background),
                             color = parseLinear("--color", options.color),
                             outlineColor = parseLinear("--outline-color", options.outlineColor);
  std::copy(color.begin(), color.end(), options.page.color);
  std::copy(outlineColor.begin(), outlineColor.end(), options.page.outlineColor);
  options.page.features = parseFeatures(options.features);
  options.page.axes = parseAxes(options.axes);
  options.page.fonts = {options.font};
  options.page.fonts.insert(options.page.fonts.end(), options.fallbacks.begin(), options.fallbacks.end());
  TextPage page(options.page);
  const GpgpLayoutInfo& layout = page.layout();
  const PageGlyphs glyphs = collectGlyphs(page);

  const float margin = std::ceil(std::max(2.0f, options.page.size / 8));
  const PageBox box = boxOf(layout, glyphs, options.page.width);
  constexpr float kNothing = 1.0f / 64; // of a pixel: sums are rounded
  const float left = margin - std::floor(box.left + kNothing), top = margin - std::floor(box.top + kNothing);
  const float across = left + std::ceil(box.right - kNothing) + margin,
              down = top + std::ceil(box.bottom - kNothing) + margin;
  if (!(across <= kLargest && down <= kLargest))
    throw Failure("the text takes " + std::to_string(std::llround(across)) + " x " +
                  std::to_string(std::llround(down)) + " pixels; pictures have at most " + std::to_string(kLargest) +
                  " a side: --width breaks lines, --size makes letters smaller");
  Session session(common);
  const PageFrame frame{
      {static_cast<uint32_t>(across), static_cast<uint32_t>(down)}, left, top, background, outlineColor};
  const auto [width, height] = frame.size;
  const DrawnPage drawn = drawPage(session, layout, glyphs, frame, options.repeat);
  host::writePng(options.out, drawn.picture);
  session.checkValidation();

  Outcome outcome;
  std::ostringstream words;
  words << layout.glyphCount << " glyphs (" << glyphs.glyphs.size() << " different) in " << layout.lineCount
        << " lines; laid out in " << milliseconds(page.shapeMilliseconds()) << '\n'
        << width << " x " << height << " pixels; GPU " << milliseconds(drawn.milliseconds) << " (median of "
        << options.repeat << ", the first run not counted";
  if (drawn.recordings > 1) words << "; " << drawn.recordings << " recordings";
  words << ") on " << session.device().name() << '\n';
  if (layout.truncated) words << "the text was cut off\n";
  if (!page.missing().empty()) words << page.missing().size() << " characters are in no font\n";
  words << "picture: " << options.out << '\n';
  outcome.text = words.str();
  Json broken = Json::array();
  for (const auto& [font, glyph] : glyphs.broken)
    broken.push_back({{"font", options.page.fonts[font]}, {"glyph", glyph}});
  outcome.json = {{"device", session.device().name()},
                  {"status", statusName(drawn.status)},
                  {"glyphs", layout.glyphCount},
                  {"lines", layout.lineCount},
                  {"truncated", layout.truncated != 0},
                  {"width", width},
                  {"height", height},
                  {"shape_ms", page.shapeMilliseconds()},
                  {"gpu_ms_median", drawn.milliseconds},
                  {"recordings", drawn.recordings},
                  {"missing", page.missing()},
                  {"broken", broken},
                  {"image", options.out}};
  return outcome;
}

} // namespace

Work addText(CLI::App& app) {
  auto options = std::make_shared<TextOptions>();
  CLI::App* command = app.add_subcommand("text", "Draw a string on the GPU");
  command->add_option("FONT", options->font, "TTF, OTF or TTC file")->required()->check(CLI::ExistingFile);
  command
      ->add_option("TEXT", options->page.text,
                   "UTF-8; if it begins with a dash, write -- before the positional arguments")
      ->required();
  command->add_option("OUT", options->out, "The picture, which fits the text and a margin")
      ->required()
      ->check(pngFile())
      ->type_name("FILE.png");
  command->add_option("--size", options->page.size, "Pixels an em")
      ->check(within(1.0, 4096.0))
      ->type_name("PX")
      ->capture_default_str();
  command->add_option("--width", options->page.width, "Lines break to fit this (default: only where the text says)")
      ->check(within(1.0, kWidest))
      ->type_name("PX");
  command->add_option("--height", options->page.height, "Lines that do not fit this are cut off (default: none are)")
      ->check(within(1.0, kLargest))
      ->type_name("PX");
  command->add_option("--max-lines", options->page.maxLines, "Lines beyond these are cut off (default: none are)")
      ->check(CLI::Range(1u, 1000000u))
      ->type_name("N");
  command->add_option("--ellipsis", options->page.ellipsis, "Ends a text that was cut off (default: …)")
      ->type_name("TEXT");
  command->add_option("--letter-spacing", options->page.letterSpacing, "Added after each letter; may be negative")
      ->check(within(-4096.0, 4096.0))
      ->type_name("PX");
  command
      ->add_option("--line-spacing", options->page.lineSpacing,
                   "Line spacing as a multiple of the fonts' own (default: 1)")
      ->check(within(0.01, 100.0))
      ->type_name("TIMES");
  CLI::Option* spacing = command->get_option("--line-spacing");
  command->add_option("--line-height", options->page.lineHeight, "Distance from line to line (default: the fonts' own)")
      ->check(within(0.01, kLargest))
      ->excludes(spacing)
      ->type_name("PX");
  command->add_option("--tab-width", options->page.tabWidth, "Distance of tab stops (default: eight spaces)")
      ->check(within(1.0, kLargest))
      ->type_name("PX");
  command
      ->add_option("--fallback", options->fallbacks,
                   "Font for characters that the fonts before it lack; may be given several times")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false)
      ->type_name("FONT");
  command->add_option("--face", options->page.face, "Index of the face, if FONT is a collection")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--axes", options->axes, "Values of axes, if FONT is variable: wght=650,wdth=80")
      ->type_name("LIST");
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
  command
      ->add_option("--outline", options->page.outlineWidth, "Width of an outline behind the letters; half of it shows")
      ->check(within(0.0, 1024.0))
      ->type_name("PX");
  command->add_option("--outline-color", options->outlineColor, "CSS colour of that line")
      ->type_name("COLOUR")
      ->capture_default_str();
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
  command->add_option("--repeat", options->repeat, "Draw N times, after a first one, and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command->footer(R"(
Examples:
  gpgp text DejaVuSans.ttf "Hello, world" hello.png --size 48
  gpgp text NotoSans-Regular.ttf "Tea ☕ شاي" tea.png --fallback NotoSansArabic-Regular.ttf --fallback NotoColorEmoji.ttf
  gpgp text DejaVuSerif.ttf $'A title\n\nAnd text' page.png --size 16 --width 480 --align justify --background white
  gpgp text DejaVuSans-Bold.ttf "LEVEL 7" level.png --size 72 --color gold --outline 10 --outline-color "#402000"
  gpgp text DejaVuSans.ttf "A long message" line.png --width 120 --max-lines 1 --underline
  gpgp text DejaVuSans.ttf office office.png --features liga=0 --json | jq .glyphs

Characters that no font has are named on standard error and drawn as the font's missing-glyph sign.)");
  return [options](const CommonOptions& common) { return text(*options, common); };
}

} // namespace gpgp::cli
