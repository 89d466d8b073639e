#include "cli/vector/svg_text.h"

#include "cli/shared/command.h"
#include "vector/import/svg/text_characters.h"

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

/// Likewise, in percent.
float stretchOf(const std::string& style) {
  static constexpr struct {
    const char* word;
    float stretch;
  } kStretches[] = {{"ultracondensed", 50},     {"ultra condensed", 50},  {"extracondensed", 62.5f},
                    {"extra condensed", 62.5f}, {"semicondensed", 87.5f}, {"semi condensed", 87.5f},
                    {"condensed", 75},          {"narrow", 75},           {"semiexpanded", 112.5f},
                    {"semi expanded", 112.5f},  {"extraexpanded", 150},   {"extra expanded", 150},
                    {"ultraexpanded", 200},     {"ultra expanded", 200},  {"expanded", 125}};
  for (const auto& s : kStretches)
    if (style.find(s.word) != std::string::npos) return s.stretch;
  return 100;
}

/// How far a stretch is from the one that is wanted (CSS Fonts 4, 5.2): first those on its own side.
float stretchDistance(float wanted, float stretch) {
  constexpr float otherSide = 1000;
  const bool isOwnSide = wanted <= 100 ? stretch <= wanted : stretch >= wanted;
  return std::fabs(stretch - wanted) + (isOwnSide ? 0 : otherSide);
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

constexpr float kEm = 1024; ///< lines are laid out at this size

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
    faces_.push_back({std::move(*font),
                      *about,
                      lowered(about->family ? about->family : ""),
                      weightOf(style),
                      stretchOf(style),
                      has("italic") || has("oblique"),
                      {file, 0, {}}});
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
       system_->find(familiesOf(span.families), {span.weight, span.stretch > 0 ? span.stretch : 100, span.italic != 0},
                     span.language, text)) {
    auto face =
        std::find_if(faces_.begin(), faces_.end(), [&](const Face& f) { return !f.isInstance && f.source == wanted; });
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
      faces_.push_back({std::move(*font), *about, {}, span.weight, 100, span.italic != 0, std::move(wanted)});
      face = faces_.end() - 1;
    }
    fonts.push_back(
        instance(static_cast<size_t>(face - faces_.begin()), span)); // fontconfig may name one by its number
  }
  return fonts;
}

GpgpFont SvgText::instance(size_t index, const GpgpSvgTextSpan& span) {
  const struct {
    GpgpTag tag;
    float value;
  } asked[] = {{GPGP_TAG('w', 'g', 'h', 't'), span.weight},
               {GPGP_TAG('w', 'd', 't', 'h'), span.stretch > 0 ? span.stretch : 100},
               {GPGP_TAG('i', 't', 'a', 'l'), span.italic ? 1.0f : 0.0f}};
  SystemFont at = faces_[index].source;
  at.axes.clear();
  std::vector<GpgpFontAxisValue> axes;
  for (const GpgpFontAxis& axis : std::span(faces_[index].info.axes, faces_[index].info.axisCount))
    for (const auto& a : asked)
      if (a.tag == axis.tag) axes.push_back({axis.tag, std::clamp(a.value, axis.minimum, axis.maximum)});
  if (axes.empty()) return faces_[index].font.get();
  for (const GpgpFontAxisValue& axis : axes) {
    const char tag[4] = {static_cast<char>(axis.tag >> 24), static_cast<char>(axis.tag >> 16),
                         static_cast<char>(axis.tag >> 8), static_cast<char>(axis.tag)};
    at.axes.emplace_back(std::string(tag, 4), axis.value);
  }
  for (const Face& face : faces_)
    if (face.isInstance && face.source == at) return face.font.get();
  GpgpFontCreateInfo info = init<GpgpFontCreateInfo>();
  info.filePath = at.file.c_str();
  info.face = at.face;
  info.axes = axes.data();
  info.axisCount = static_cast<uint32_t>(axes.size());
  Result<Font> font = Font::create(info);
  if (!font) return faces_[index].font.get();
  const Result<GpgpFontInfo> about = font->info();
  if (!about) return faces_[index].font.get();
  faces_.push_back({std::move(*font), *about, {}, span.weight, 100, span.italic != 0, std::move(at), true});
  return faces_.back().font.get();
}

std::vector<GpgpFont> SvgText::chosen(const GpgpSvgTextSpan& span, std::string_view text) {
  if (fromSystem_) return chosenOfSystem(span, text);
  const std::vector<std::string> families = familiesOf(span.families);
  const auto rank = [&](const Face& face) { // the smallest first
    const auto at = std::find_if(families.begin(), families.end(),
                                 [&](const std::string& name) { return isFamily(face.family, lowered(name)); });
    return std::tuple(at - families.begin(), stretchDistance(span.stretch > 0 ? span.stretch : 100, face.stretch),
                      face.italic != (span.italic != 0), weightDistance(span.weight, face.weight));
  };
  std::vector<size_t> order;
  for (size_t i = 0; i < faces_.size(); ++i)
    if (!faces_[i].isInstance) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return rank(faces_[a]) < rank(faces_[b]); });
  std::vector<GpgpFont> fonts;
  for (const size_t face : order) fonts.push_back(instance(face, span));
  return fonts;
}

void SvgText::shapeAs(const GpgpSvgText& text, const GpgpSvgTextSpan& span, std::vector<Cluster>& clusters) {
  shapeWith(text, span, false, clusters);
  if (!span.vertical) return;
  std::vector<Cluster> replaced;
  shapeWith(text, span, true, replaced);
  const auto isSame = [](const Cluster::Glyph& a, const Cluster::Glyph& b) { return a.glyph == b.glyph; };
  std::vector<Cluster*> from(text.size, nullptr); // by their first bytes
  for (Cluster& cluster : replaced) from[cluster.begin] = &cluster;
  for (Cluster& cluster : clusters) {
    Cluster* own = from[cluster.begin];
    if (!own || own->end != cluster.end ||
        !gpgp::vector::svg::hasVerticalForm(gpgp::vector::svg::characterAt({text.text, text.size}, cluster.begin)))
      continue;
    if (std::ranges::equal(own->glyphs, cluster.glyphs, isSame)) continue;
    cluster = std::move(*own);
    for (Cluster::Glyph& glyph : cluster.glyphs) glyph.vertical = true;
  }
}

void SvgText::shapeWith(const GpgpSvgText& text, const GpgpSvgTextSpan& span, bool vertical,
                        std::vector<Cluster>& clusters) {
  const std::vector<GpgpFont> fonts = chosen(span, {text.text, text.size});
  std::vector<GpgpFontFeature> features;
  if (span.smallCaps) features.push_back({GPGP_TAG('s', 'm', 'c', 'p'), 1});
  if (span.unkerned) features.push_back({GPGP_TAG('k', 'e', 'r', 'n'), 0});
  if (span.unligated)
    for (const GpgpTag tag : {GPGP_TAG('l', 'i', 'g', 'a'), GPGP_TAG('c', 'l', 'i', 'g')}) features.push_back({tag, 0});
  if (vertical) features.push_back({GPGP_TAG('v', 'e', 'r', 't'), 1});
  GpgpTextInfo info = init<GpgpTextInfo>();
  info.text = text.text;
  info.size = text.size;
  info.style.fonts = fonts.data();
  info.style.fontCount = static_cast<uint32_t>(fonts.size());
  info.style.size = kEm;
  info.style.letterSpacing = span.letterSpacing / span.size * kEm;
  info.style.language = *span.language ? span.language : nullptr;
  info.style.features = features.data();
  info.style.featureCount = static_cast<uint32_t>(features.size());
  info.direction = text.rightToLeft ? GPGP_TEXT_RIGHT_TO_LEFT : GPGP_TEXT_LEFT_TO_RIGHT;
  info.align = GPGP_TEXT_ALIGN_LEFT;
  check(layout_.set(info));
  const Result<GpgpLayoutInfo> made = layout_.info();
  check(made.code());
  const GpgpTextLine& line = made->lines[0];
  const GpgpTextGlyph* glyphs = made->glyphs + line.firstGlyph;
  std::vector<uint32_t> ends{text.size}; // of clusters
  for (uint32_t i = 0; i < line.glyphCount; ++i) ends.push_back(glyphs[i].cluster);
  std::sort(ends.begin(), ends.end());
  float pen = 0; // white space may hang out on the left
  for (uint32_t i = 0; i < line.glyphCount; ++i) pen = std::min(pen, glyphs[i].x);
  for (uint32_t i = 0; i < line.glyphCount; ++i) {
    const GpgpTextGlyph& glyph = glyphs[i];
    if (i == 0 || glyph.cluster != glyphs[i - 1].cluster) {
      // Where several stand for one grapheme, the layout knows the width of all of them alone.
      const bool goesOn =
          i > 0 && !(clusters.back().width > 0) &&
          clusters.back().begin<glyph.cluster&& * layout_.moveCaret(clusters.back().begin, GPGP_CARET_NEXT)>
              glyph.cluster;
      if (!goesOn) clusters.push_back({glyph.cluster, 0, pen, 0, 0, fonts.empty() ? nullptr : fonts[0], {}});
      Cluster& cluster = clusters.back();
      cluster.end = *std::upper_bound(ends.begin(), ends.end() - 1, glyph.cluster);
      GpgpTextRect rects[8];
      uint32_t count = 8;
      if (layout_.selection(cluster.begin, cluster.end, count, rects) != GPGP_SUCCESS) count = 0;
      if (count > 0 && !goesOn) cluster.left = rects[0].x;
      for (uint32_t k = 0; k < count; ++k) cluster.width += rects[k].width;
      pen = cluster.left + cluster.width;
    }
    Cluster& cluster = clusters.back();
    cluster.glyphs.push_back({glyph.font, glyph.glyph, glyph.x - cluster.left, glyph.y - line.baseline, false});
  }
  // The first, which has the advance, stands where the cluster begins; from right to left marks come before it.
  const auto isNearer = [](const Cluster::Glyph& a, const Cluster::Glyph& b) {
    return std::fabs(a.x) < std::fabs(b.x);
  };
  for (Cluster& cluster : clusters)
    std::iter_swap(cluster.glyphs.begin(), std::min_element(cluster.glyphs.begin(), cluster.glyphs.end(), isNearer));
}

// Each style shapes the whole line, and its spans take their clusters of that: letters are kerned across styles.
void SvgText::shape(const GpgpSvgText& text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  const auto styleOf = [](const GpgpSvgTextSpan& s) {
    return std::tuple(std::string_view(s.families), std::string_view(s.language), s.weight, s.letterSpacing / s.size,
                      s.italic != 0, s.smallCaps != 0, s.unkerned != 0, s.unligated != 0, s.stretch, s.vertical != 0);
  };
  // Spans of further styles are shaped by themselves, so that long lines are not shaped again and again.
  const size_t mostStyles = std::clamp<size_t>(65536 / std::max(text.size, 1u), 1, 64);
  std::vector<uint32_t> leaders; // a span of each style
  std::vector<size_t> styles;    // by span
  for (uint32_t i = 0; i < text.spanCount; ++i) {
    const auto same = std::find_if(leaders.begin(), leaders.end(),
                                   [&](uint32_t f) { return styleOf(text.spans[f]) == styleOf(text.spans[i]); });
    styles.push_back(static_cast<size_t>(same - leaders.begin()));
    if (same == leaders.end() && leaders.size() < mostStyles) leaders.push_back(i);
  }
  std::vector<Cluster> taken;
  std::vector<uint32_t> order(text.size); // of bytes, from left to right
  for (size_t style = 0; style < leaders.size(); ++style) {
    std::vector<Cluster> clusters;
    shapeAs(text, text.spans[leaders[style]], clusters);
    for (uint32_t i = 0; i < clusters.size(); ++i) {
      Cluster& cluster = clusters[i];
      if (style == 0) std::fill(order.begin() + cluster.begin, order.begin() + cluster.end, i);
      const GpgpSvgTextSpan* span = std::upper_bound(text.spans, text.spans + text.spanCount - 1, cluster.begin,
                                                     [](uint32_t at, const auto& s) { return at < s.end; });
      if (styles[static_cast<size_t>(span - text.spans)] != style) continue;
      cluster.size = span->size;
      taken.push_back(std::move(cluster));
    }
  }
  for (uint32_t i = 0; i < text.spanCount; ++i) {
    if (styles[i] < leaders.size()) continue;
    const GpgpSvgTextSpan& span = text.spans[i];
    std::vector<Cluster> clusters;
    shapeAs({text.text + span.begin, span.end - span.begin, &span, 1, text.rightToLeft}, span, clusters);
    for (Cluster& cluster : clusters) {
      cluster.begin += span.begin, cluster.end += span.begin;
      cluster.size = span.size;
      taken.push_back(std::move(cluster));
    }
  }
  std::stable_sort(taken.begin(), taken.end(), [&](const Cluster& a, const Cluster& b) {
    return std::pair(order[a.begin], a.begin) < std::pair(order[b.begin], b.begin);
  });
  const auto faceOf = [this](GpgpFont font) {
    return std::find_if(faces_.begin(), faces_.end(), [&](const Face& f) { return f.font.get() == font; });
  };
  float pen = 0;
  for (const Cluster& cluster : taken) {
    const float scale = cluster.size / kEm;
    for (const Cluster::Glyph& glyph : cluster.glyphs) {
      const auto face = faceOf(glyph.font);
      if (face == faces_.end()) continue;
      GpgpSvgGlyph out{};
      out.cluster = cluster.begin;
      out.x = pen + glyph.x * scale;
      out.y = glyph.y * scale;
      out.size = cluster.size;
      out.vertical = glyph.vertical;
      out.advance = &glyph == cluster.glyphs.data() ? cluster.width * scale : 0;
      const GpgpFontInfo& own = face->info;
      out.ascent = own.ascent, out.descent = own.descent, out.xHeight = own.xHeight;
      const auto first = faceOf(cluster.first); // lines and baselines are those of the font that is asked for
      const GpgpFontInfo& f = first == faces_.end() ? own : first->info;
      out.underlinePosition = f.underlinePosition, out.underlineThickness = f.underlineThickness;
      out.strikePosition = f.strikePosition, out.strikeThickness = f.strikeThickness;
      out.subscript = f.subscript, out.superscript = f.superscript;
      GpgpGlyphOutlineInfo outlineInfo = init<GpgpGlyphOutlineInfo>();
      outlineInfo.glyph = glyph.glyph;
      check(face->font.outline(outlineInfo, [&](const GpgpGlyphOutline& outline) {
        out.paths = outline.paths;
        out.pathCount = outline.pathCount;
        out.foreground = outline.foreground;
        out.incomplete = outline.incomplete;
        if (outline.image) {
          out.image = outline.image->pixels;
          out.imageWidth = outline.image->width, out.imageHeight = outline.image->height;
          std::copy_n(outline.image->box, 4, out.imageBox);
        }
        glyphFn(glyphData, &out);
      }));
    }
    pen += cluster.width * scale;
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
