#include "cli/vector/svg_text.h"

#include "cli/shared/command.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace gpgp::cli {
namespace {

std::string lowered(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
  return small;
}

/// "Arial, 'DejaVu Sans'" as names.
std::vector<std::string> familiesOf(std::string_view list) {
  std::vector<std::string> names;
  while (!list.empty()) {
    const size_t end = std::min(list.find(','), list.size());
    std::string_view name = list.substr(0, end);
    const size_t first = name.find_first_not_of(" \t\n'\""), last = name.find_last_not_of(" \t\n'\"");
    if (first != name.npos) names.emplace_back(name.substr(first, last + 1 - first));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return names;
}

/// By the words that styles have for it.
float weightOf(const std::string& style) {
  static constexpr struct {
    const char* word;
    float weight;
  } kWeights[] = {{"thin", 100},       {"hairline", 100},   {"extralight", 200}, {"extra light", 200},
                  {"ultralight", 200}, {"demibold", 600},   {"semibold", 600},   {"semi bold", 600},
                  {"extrabold", 800},  {"extra bold", 800}, {"light", 300},      {"ultrabold", 800},
                  {"medium", 500},     {"black", 900},      {"heavy", 900},      {"bold", 700}};
  for (const auto& w : kWeights)
    if (style.find(w.word) != std::string::npos) return w.weight;
  return 400;
}

/// How far a weight is from the one that is wanted (CSS Fonts 4, 5.2): first those on its own side.
float weightDistance(float wanted, float weight) {
  constexpr float otherSide = 1000;
  if (wanted >= 400 && wanted <= 500)
    return weight >= wanted && weight <= 500 ? weight - wanted
           : weight < wanted                 ? otherSide + wanted - weight
                                             : 2 * otherSide + weight - wanted;
  const bool isOwnSide = wanted < 400 ? weight <= wanted : weight >= wanted;
  return std::fabs(weight - wanted) + (isOwnSide ? 0 : otherSide);
}

/// Whether a family's name, in small letters, is what a name of font-family means.
bool isFamily(const std::string& family, const std::string& wanted) {
  const auto has = [&family](const char* word) { return family.find(word) != std::string::npos; };
  if (wanted == "serif") return has("serif") && !has("sans");
  if (wanted == "sans-serif") return has("sans") && !has("mono");
  if (wanted == "monospace") return has("mono") || has("courier");
  return family == wanted;
}

void check(GpgpResult result) {
  if (result != GPGP_SUCCESS) throw std::runtime_error("text");
}

} // namespace

SvgText::SvgText(const std::vector<std::string>& files, bool fromSystem) {
  for (const std::string& file : files) {
    GpgpFontCreateInfo info = init<GpgpFontCreateInfo>();
    info.filePath = file.c_str();
    Result<Font> font = Font::create(info);
    if (!font) throw Failure(file + ": no font that can be read (" + font.name() + ")");
    const Result<GpgpFontInfo> about = font->info();
    if (!about) throw Failure(file + ": " + about.name());
    const std::string style = lowered(about->style ? about->style : "");
    const auto has = [&style](const char* word) { return style.find(word) != std::string::npos; };
    faces_.push_back({std::move(*font), *about, lowered(about->family ? about->family : ""), weightOf(style),
                      has("italic") || has("oblique")});
  }
  fromSystem_ = files.empty() && fromSystem && SystemFonts::areThere();
  if (faces_.empty() && !fromSystem_) return;
  Result<Shaper> shaper = Shaper::create();
  if (!shaper) throw Failure(std::string("text cannot be shaped: ") + shaper.name());
  shaper_ = std::move(*shaper);
  Result<Layout> layout = shaper_.layout();
  if (!layout) throw Failure(std::string("text cannot be shaped: ") + layout.name());
  layout_ = std::move(*layout);
}

std::vector<GpgpFont> SvgText::chosenOfSystem(const GpgpSvgTextSpan& span, std::string_view text) {
  if (!system_) system_.emplace();
  std::vector<GpgpFont> fonts;
  for (SystemFont& wanted :
       system_->find(familiesOf(span.families), span.weight, span.italic != 0, span.language, text)) {
    auto face = std::find_if(faces_.begin(), faces_.end(), [&](const Face& f) { return f.source == wanted; });
    if (face == faces_.end()) {
      GpgpFontCreateInfo info = init<GpgpFontCreateInfo>();
      std::vector<GpgpFontAxisValue> axes;
      for (const auto& [tag, value] : wanted.axes) axes.push_back({GPGP_TAG(tag[0], tag[1], tag[2], tag[3]), value});
      info.filePath = wanted.file.c_str();
      info.face = wanted.face;
      info.axes = axes.data();
      info.axisCount = static_cast<uint32_t>(axes.size());
      Result<Font> font = Font::create(info);
      if (!font) continue;
      const Result<GpgpFontInfo> about = font->info();
      if (!about) continue;
      faces_.push_back({std::move(*font), *about, {}, span.weight, span.italic != 0, std::move(wanted)});
      face = faces_.end() - 1;
    }
    fonts.push_back(face->font.get());
  }
  return fonts;
}

std::vector<GpgpFont> SvgText::chosen(const GpgpSvgTextSpan& span, std::string_view text) {
  if (fromSystem_) return chosenOfSystem(span, text);
  const std::vector<std::string> families = familiesOf(span.families);
  const auto rank = [&](const Face& face) { // the smallest first
    const auto at = std::find_if(families.begin(), families.end(),
                                 [&](const std::string& name) { return isFamily(face.family, lowered(name)); });
    return std::tuple(at - families.begin(), face.italic != (span.italic != 0),
                      weightDistance(span.weight, face.weight));
  };
  std::vector<const Face*> order;
  for (const Face& face : faces_) order.push_back(&face);
  std::stable_sort(order.begin(), order.end(), [&](const Face* a, const Face* b) { return rank(*a) < rank(*b); });
  std::vector<GpgpFont> fonts;
  for (const Face* face : order) fonts.push_back(face->font.get());
  return fonts;
}

void SvgText::shape(const GpgpSvgText& text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  // Of a span: those in front, behind or both.
  const GpgpFontFeature features[] = {{GPGP_TAG('s', 'm', 'c', 'p'), 1}, {GPGP_TAG('k', 'e', 'r', 'n'), 0}};
  std::vector<std::vector<GpgpFont>> fonts(text.spanCount);
  std::vector<GpgpTextSpan> spans(text.spanCount);
  for (uint32_t i = 0; i < text.spanCount; ++i) {
    const GpgpSvgTextSpan& from = text.spans[i];
    fonts[i] = chosen(from, {text.text + from.begin, from.end - from.begin});
    spans[i].begin = from.begin, spans[i].end = from.end;
    GpgpTextStyle& style = spans[i].style;
    style.fonts = fonts[i].data();
    style.fontCount = static_cast<uint32_t>(fonts[i].size());
    style.size = from.size;
    style.letterSpacing = from.letterSpacing;
    style.language = *from.language ? from.language : nullptr;
    style.features = features + (from.smallCaps ? 0 : 1);
    style.featureCount = uint32_t(from.smallCaps != 0) + uint32_t(from.unkerned != 0);
  }
  GpgpTextInfo info = init<GpgpTextInfo>();
  info.text = text.text;
  info.size = text.size;
  info.style = spans[0].style;
  info.spans = spans.data();
  info.spanCount = text.spanCount;
  info.direction = text.rightToLeft ? GPGP_TEXT_RIGHT_TO_LEFT : GPGP_TEXT_LEFT_TO_RIGHT;
  info.align = GPGP_TEXT_ALIGN_LEFT;
  check(layout_.set(info));
  const Result<GpgpLayoutInfo> made = layout_.info();
  check(made.code());
  const GpgpTextLine& line = made->lines[0];
  float edge = 0; // what the glyphs are measured from: white space may hang out on the left
  for (uint32_t i = 0; i < line.glyphCount; ++i) edge = std::min(edge, made->glyphs[line.firstGlyph + i].x);
  std::vector<uint32_t> ends{text.size}; // of clusters
  for (uint32_t i = 0; i < line.glyphCount; ++i) ends.push_back(made->glyphs[line.firstGlyph + i].cluster);
  std::sort(ends.begin(), ends.end());
  uint32_t previous = UINT32_MAX;
  for (uint32_t i = 0; i < line.glyphCount; ++i) {
    const GpgpTextGlyph& glyph = made->glyphs[line.firstGlyph + i];
    const auto face =
        std::find_if(faces_.begin(), faces_.end(), [&](const Face& f) { return f.font.get() == glyph.font; });
    if (face == faces_.end()) continue;
    GpgpSvgGlyph out{};
    out.cluster = glyph.cluster;
    out.x = glyph.x - edge;
    out.y = glyph.y - line.baseline;
    out.size = glyph.size;
    if (glyph.cluster != previous) { // up to the next cluster
      const auto behind = std::upper_bound(ends.begin(), ends.end(), glyph.cluster);
      const uint32_t end = behind == ends.end() ? text.size : *behind;
      GpgpTextRect rects[8];
      uint32_t count = 8;
      if (layout_.selection(glyph.cluster, end, count, rects) == GPGP_SUCCESS)
        for (uint32_t k = 0; k < count; ++k) out.advance += rects[k].width;
    }
    previous = glyph.cluster;
    const GpgpFontInfo& f = face->info;
    out.ascent = f.ascent, out.descent = f.descent, out.xHeight = f.xHeight;
    out.underlinePosition = f.underlinePosition, out.underlineThickness = f.underlineThickness;
    out.strikePosition = f.strikePosition, out.strikeThickness = f.strikeThickness;
    GpgpGlyphOutlineInfo outlineInfo = init<GpgpGlyphOutlineInfo>();
    outlineInfo.glyph = glyph.glyph;
    check(face->font.outline(outlineInfo, [&](const GpgpGlyphOutline& outline) {
      out.paths = outline.paths;
      out.pathCount = outline.pathCount;
      out.foreground = outline.foreground;
      out.incomplete = outline.incomplete || outline.image;
      glyphFn(glyphData, &out);
    }));
  }
}

GpgpResult GPGP_CALL SvgText::shape(void* userData, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  try {
    static_cast<SvgText*>(userData)->shape(*text, glyphFn, glyphData);
    return GPGP_SUCCESS;
  } catch (...) { // the compiler, which calls this, throws nothing on
    return GPGP_ERROR_UNSUPPORTED;
  }
}

} // namespace gpgp::cli
