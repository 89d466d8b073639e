#include "cli/bake/font.h"

#include "cli/text/glyphs.h"
#include "host/files.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

namespace gpgp::cli {
namespace {

constexpr uint32_t kLast = 0x10ffff;

/// The characters of UTF-8; `where` says whose.
void addCharacters(const std::string& text, const std::string& where, std::set<uint32_t>& characters) {
  for (size_t i = text.starts_with("\xef\xbb\xbf") ? 3 : 0; i < text.size();) {
    const auto byte = [&](size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u; };
    const uint32_t lead = byte(0);
    const size_t length = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
    constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    uint32_t character = length < 2 ? lead : lead & (0x7f >> length);
    bool good = length > 0;
    for (size_t k = 1; k < length; ++k) {
      good = good && byte(k) >> 6 == 2;
      character = character << 6 | (byte(k) & 63);
    }
    if (!good || character < kLeast[length] || character > kLast || character >> 11 == 0x1b)
      throw Failure(where + " is not UTF-8 at byte " + std::to_string(i));
    if (character >= 0x20 && character != 0x7f) characters.insert(character); // line breaks are no glyphs
    i += length;
  }
}

/// "U+0020-007E,U+20AC,0x2190-0x21ff": what CSS calls unicode-range, and hexadecimal numbers.
void addRanges(const std::string& list, std::vector<GpgpCharacterRange>& ranges) {
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    const auto number = [](std::string text, uint32_t& value) {
      if (text.size() > 2 && (text.starts_with("U+") || text.starts_with("u+") || text.starts_with("0x")))
        text.erase(0, 2);
      if (text.empty() || text.size() > 6 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        return false;
      value = static_cast<uint32_t>(std::strtoul(text.c_str(), nullptr, 16));
      return value <= kLast;
    };
    GpgpCharacterRange range{};
    const size_t dash = part.find('-');
    const bool good =
        number(part.substr(0, dash), range.first) &&
        (dash == std::string::npos ? (range.last = range.first, true) : number(part.substr(dash + 1), range.last)) &&
        range.first <= range.last;
    if (!good)
      throw Usage("--ranges '" + part + "' is not a range of characters; write for example U+0020-007E,U+20AC");
    ranges.push_back(range);
  }
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (size_t i = 0; i < std::min<size_t>(names.size(), 16); ++i) list += (i ? ", " : "") + names[i];
  return names.size() > 16 ? list + " and " + std::to_string(names.size() - 16) + " more" : list;
}

struct Messages {
  const std::string& name;
  std::string error;
  static void GPGP_CALL take(void* userData, const GpgpMessage* message) {
    auto& self = *static_cast<Messages*>(userData);
    if (message->severity == GPGP_SEVERITY_ERROR)
      self.error = message->text; // thrown, and so printed, by check
    else
      std::fprintf(stderr, "%s: %s\n", self.name.c_str(), message->text);
  }
  void check(GpgpResult result) const {
    if (result < 0) throw Failure(name + ": " + (error.empty() ? gpgpResultString(result) : error));
  }
};

/// The glyphs that the options choose, by number.
std::vector<uint32_t> chosenGlyphs(const Font& font, const Messages& messages, const BakeFontOptions& options,
                                   uint32_t glyphCount, std::vector<std::string>& missing) {
  std::vector<uint32_t> glyphs;
  if (!options.chosen()) {
    for (uint32_t glyph = 0; glyph < glyphCount; ++glyph) glyphs.push_back(glyph);
    return glyphs;
  }
  std::set<uint32_t> single;
  for (const std::string& text : options.characters) addCharacters(text, "--characters", single);
  for (const std::string& file : options.characterFiles) addCharacters(host::readText(file), file, single);
  std::vector<GpgpCharacterRange> ranges;
  for (const std::string& list : options.ranges) addRanges(list, ranges);
  for (const uint32_t character : single) {
    ranges.push_back({character, character});
    uint32_t glyph = 0;
    messages.check(gpgpGetNominalGlyph(font, character, &glyph));
    char name[16];
    std::snprintf(name, sizeof name, "U+%04X", character);
    if (glyph == 0) missing.emplace_back(name);
  }
  uint32_t count = 0;
  messages.check(font.closure(ranges.data(), static_cast<uint32_t>(ranges.size()), count, nullptr));
  glyphs.resize(count);
  messages.check(font.closure(ranges.data(), static_cast<uint32_t>(ranges.size()), count, glyphs.data()));
  return glyphs;
}

} // namespace

void addBakeFontOptions(CLI::App& command, BakeFontOptions& options) {
  command
      .add_option(
          "--characters", options.characters,
          "Of fonts: bake all glyphs that a text of these characters needs; may be repeated (default: all glyphs)")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  command
      .add_option("--characters-file", options.characterFiles, "The same for all characters of a file; may be repeated")
      ->check(CLI::ExistingFile)
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--ranges", options.ranges, "The same for ranges of characters, U+0020-007E,U+20AC; may be repeated")
      ->type_name("LIST")
      ->allow_extra_args(false);
  command.add_option("--face", options.face, "Of fonts: index of the face in a collection")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--axes", options.axes, "Of variable fonts: values of axes, wght=650,wdth=80")->type_name("LIST");
  command
      .add_option("--outline", options.outline,
                  "Of fonts: bake each glyph's outline, too, a line of this width in em along its edges")
      ->check(within(0.0, 1.0))
      ->type_name("EM");
}

BakedFont bakeFont(const std::string& bytes, const std::string& name, const BakeFontOptions& options) {
  Messages messages{name, {}};
  const std::vector<GpgpFontAxisValue> axes = parseAxes(options.axes);
  GpgpFontCreateInfo open = GPGP_FONT_CREATE_INFO_INIT;
  open.data = bytes.data();
  open.size = bytes.size();
  open.keepData = VK_TRUE;
  open.face = options.face;
  open.axes = axes.data();
  open.axisCount = static_cast<uint32_t>(axes.size());
  open.messageFn = Messages::take;
  open.messageUserData = &messages;
  Result<Font> font = Font::create(open);
  messages.check(font.code());
  const Result<GpgpFontInfo> about = font->info();
  messages.check(about.code());
  std::vector<std::string> missing, pictures, broken;
  const std::vector<uint32_t> chosen = chosenGlyphs(*font, messages, options, about->glyphCount, missing);

  GpgpStroke stroke{};
  stroke.width = options.outline;
  stroke.join = GPGP_JOIN_ROUND;
  stroke.scale = 256; // pixels an em up to which it is exact to a twentieth of a pixel
  struct Kept {
    std::vector<KeptPath> placed;
    std::vector<GpgpPath> paths;
    std::vector<VkBool32> foreground;
  };
  std::vector<Kept> kept;
  kept.reserve(chosen.size() * 2); // not moved from here on: glyphs point into it
  std::vector<GpgpGlyph> glyphs;
  for (const uint32_t glyph : chosen)
    for (const GpgpStroke* line : {static_cast<const GpgpStroke*>(nullptr), const_cast<const GpgpStroke*>(&stroke)}) {
      if (line && !(line->width > 0)) continue;
      GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
      info.glyph = glyph;
      info.stroke = line;
      Kept& one = kept.emplace_back();
      bool picture = false;
      messages.check(font->outline(info, [&](const GpgpGlyphOutline& outline) {
        for (uint32_t i = 0; i < outline.pathCount; ++i) one.placed.emplace_back(outline.paths[i]);
        one.foreground.assign(outline.foreground, outline.foreground + outline.pathCount);
        picture = outline.image != nullptr;
        if (outline.broken && !line) broken.push_back(std::to_string(glyph));
      }));
      if (picture) {
        pictures.push_back(std::to_string(glyph));
        continue;
      }
      for (const KeptPath& path : one.placed) one.paths.push_back(path.view());
      glyphs.push_back({uint64_t{line != nullptr} << 32 | glyph, one.paths.data(),
                        static_cast<uint32_t>(one.paths.size()), one.foreground.data()});
    }
  if (!missing.empty())
    std::fprintf(stderr, "%s: warning: the font has no %s\n", name.c_str(), listed(missing).c_str());
  if (!pictures.empty())
    std::fprintf(stderr, "%s: warning: left out, as they are pictures and no outlines: glyphs %s\n", name.c_str(),
                 listed(pictures).c_str());

  GpgpGlyphSource source = GPGP_GLYPH_SOURCE_INIT;
  source.name = name.c_str();
  source.glyphs = glyphs.data();
  source.glyphCount = static_cast<uint32_t>(glyphs.size());
  source.messageFn = Messages::take;
  source.messageUserData = &messages;
  Result<Blob> blob = compileGlyphs(source);
  messages.check(blob.code());
  const size_t count = chosen.size() - pictures.size();
  return {std::move(*blob),
          {{"glyphs", count}, {"missing", missing}, {"pictures", pictures.size()}, {"broken", broken.size()}},
          std::to_string(count) + " glyphs"};
}

} // namespace gpgp::cli
