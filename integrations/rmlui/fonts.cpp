// RmlUi's font engine: faces by family, widths and meshes of glyphs by libgpgp_text.
#include "effects.h"
#include "gpgp_glyph_cache.hpp"
#include "gpgp_rmlui.hpp"
#include "text_mesh.h"

#include <RmlUi/Core/Core.h>
#include <RmlUi/Core/FileInterface.h>
#include <RmlUi/Core/Log.h>
#include <RmlUi/Core/Mesh.h>
#include <RmlUi/Core/RenderManager.h>
#include <RmlUi/Core/StringUtilities.h>
#include <RmlUi/Core/TextShapingContext.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

namespace gpgp::rmlui {
namespace {

constexpr GpgpTag kWeight = GPGP_TAG('w', 'g', 'h', 't');

/// A weight that the name of a style says, as files of one weight have no other place for it that is read here.
int weightOf(const Rml::String& style) {
  constexpr std::pair<const char*, int> names[] = {{"thin", 100},      {"extralight", 200}, {"ultralight", 200},
                                                   {"semibold", 600},  {"demibold", 600},   {"extrabold", 800},
                                                   {"ultrabold", 800}, {"black", 900},      {"heavy", 900},
                                                   {"light", 300},     {"medium", 500},     {"bold", 700}};
  Rml::String flat;
  for (const char c : Rml::StringUtilities::ToLower(style))
    if (c != ' ' && c != '-') flat += c;
  for (const auto& [name, weight] : names)
    if (flat.find(name) != Rml::String::npos) return weight;
  return 400;
}

void GPGP_CALL onMessage(void*, const GpgpMessage* message) {
  const auto type = message->severity == GPGP_SEVERITY_ERROR ? Rml::Log::LT_ERROR : Rml::Log::LT_WARNING;
  Rml::Log::Message(type, "gpgp: %s: %s", message->label, message->text);
}

struct Face {
  Rml::String family;
  bool italic = false, fallback = false;
  int weight = 400;
  uint32_t number = 0;
};

/// A face at a size.
struct SizedFace {
  size_t face = 0;
  Rml::FontMetrics metrics{};
  std::vector<Rml::FontEffectList> effects; ///< handle i + 1
};

} // namespace

struct FontEngine::Impl {
  std::vector<Font> fonts; // by number
  std::map<GpgpFont, uint32_t> numbers;
  std::vector<Face> faces;
  std::map<std::pair<size_t, int>, std::unique_ptr<SizedFace>> sized;
  std::map<std::pair<uint32_t, uint32_t>, std::array<float, 4>> boxes; // of glyphs' ink, em
  std::unique_ptr<EffectInstancers> effects;
  Shaper shaper;
  Layout layout;
  int version = 1;

  bool add(Rml::Span<const Rml::byte> data, int index, const Rml::String& source, const Rml::String* family,
           const bool* italic, int weight, bool fallback);
  bool open(Rml::Span<const Rml::byte> data, int index, const Rml::String& source, int axisWeight, uint32_t& number);
  /// Lays a line out; `left` is where it begins. Its width.
  float set(const SizedFace& face, Rml::StringView string, const Rml::TextShapingContext& shaping, float& left);
  Rml::FontMetrics measure(const Face& face, int size) const;
};

FontEngine::FontEngine() : impl_(std::make_unique<Impl>()) {
  if (Result<Shaper> shaper = Shaper::create()) impl_->shaper = *std::move(shaper);
  if (impl_->shaper)
    if (Result<Layout> layout = impl_->shaper.layout()) impl_->layout = *std::move(layout);
}
FontEngine::~FontEngine() = default;

void FontEngine::Initialize() {}
void FontEngine::Shutdown() {
  ReleaseFontResources();
  impl_->faces.clear();
  impl_->effects.reset();
}
void FontEngine::ReleaseFontResources() { impl_->sized.clear(); }

GpgpFont FontEngine::font(uint32_t number) const {
  return number < impl_->fonts.size() ? impl_->fonts[number].get() : nullptr;
}

// ---------------------------------------------------------------- faces

bool FontEngine::Impl::open(Rml::Span<const Rml::byte> data, int index, const Rml::String& source, int axisWeight,
                            uint32_t& number) {
  auto info = init<GpgpFontCreateInfo>();
  info.label = source.c_str();
  info.data = data.data();
  info.size = data.size();
  info.face = static_cast<uint32_t>(std::max(index, 0));
  info.messageFn = onMessage;
  const GpgpFontAxisValue axis{kWeight, static_cast<float>(axisWeight)};
  if (axisWeight > 0) {
    info.axes = &axis;
    info.axisCount = 1;
  }
  Result<Font> font = Font::create(info);
  if (!font) return false;
  number = static_cast<uint32_t>(fonts.size());
  numbers[font->get()] = number;
  fonts.push_back(*std::move(font));
  return true;
}

bool FontEngine::Impl::add(Rml::Span<const Rml::byte> data, int index, const Rml::String& source,
                           const Rml::String* family, const bool* italic, int weight, bool fallback) {
  if (!effects) effects = std::make_unique<EffectInstancers>(); // Factory has its own by now
  uint32_t number = 0;
  if (!open(data, index, source, 0, number)) return false;
  GpgpFontInfo info = GPGP_FONT_INFO_INIT;
  if (gpgpGetFontInfo(fonts[number], &info) < 0) return false;
  Face face;
  face.family = Rml::StringUtilities::ToLower(family && !family->empty() ? *family : Rml::String(info.family));
  const Rml::String style = info.style;
  const Rml::String lower = Rml::StringUtilities::ToLower(style);
  face.italic =
      italic ? *italic : lower.find("italic") != Rml::String::npos || lower.find("oblique") != Rml::String::npos;
  face.weight = weight > 0 ? weight : weightOf(style);
  face.fallback = fallback;
  face.number = number;
  std::vector<int> weights{face.weight}; // a variable font is several
  for (uint32_t i = 0; i < info.axisCount; ++i) {
    const GpgpFontAxis& axis = info.axes[i];
    if (axis.tag != kWeight) continue;
    weights.clear();
    for (int each = weight > 0 ? weight : 100; each <= (weight > 0 ? weight : 900); each += 100)
      if (static_cast<float>(each) >= axis.minimum && static_cast<float>(each) <= axis.maximum) weights.push_back(each);
    if (weights.empty()) weights.push_back(face.weight);
    for (const int each : weights) {
      face.weight = each;
      const bool inRange = static_cast<float>(each) >= axis.minimum && static_cast<float>(each) <= axis.maximum;
      if (!open(data, index, source, inRange ? each : 0, face.number)) return false;
      faces.push_back(face);
    }
    ++version;
    return true;
  }
  faces.push_back(face);
  ++version;
  return true;
}

bool FontEngine::LoadFontFace(const Rml::String& file, int face, bool fallback, Rml::Style::FontWeight weight) {
  Rml::String data;
  if (!Rml::GetFileInterface()->LoadFile(file, data)) {
    Rml::Log::Message(Rml::Log::LT_ERROR, "Could not read the font %s", file.c_str());
    return false;
  }
  return impl_->add({reinterpret_cast<const Rml::byte*>(data.data()), data.size()}, face, file, nullptr, nullptr,
                    static_cast<int>(weight), fallback);
}

bool FontEngine::LoadFontFace(const Rml::String& file, int face, const Rml::String& family, Rml::Style::FontStyle style,
                              Rml::Style::FontWeight weight, bool fallback) {
  Rml::String data;
  if (!Rml::GetFileInterface()->LoadFile(file, data)) {
    Rml::Log::Message(Rml::Log::LT_ERROR, "Could not read the font %s", file.c_str());
    return false;
  }
  const bool italic = style == Rml::Style::FontStyle::Italic;
  return impl_->add({reinterpret_cast<const Rml::byte*>(data.data()), data.size()}, face, file, &family, &italic,
                    static_cast<int>(weight), fallback);
}

bool FontEngine::LoadFontFace(Rml::Span<const Rml::byte> data, int face, const Rml::String& family,
                              Rml::Style::FontStyle style, Rml::Style::FontWeight weight, bool fallback) {
  const bool italic = style == Rml::Style::FontStyle::Italic;
  return impl_->add(data, face, family, family.empty() ? nullptr : &family, family.empty() ? nullptr : &italic,
                    static_cast<int>(weight), fallback);
}

/// Whole pixels above and below the baseline, as RmlUi's own engine has them: documents keep their layout.
Rml::FontMetrics FontEngine::Impl::measure(const Face& face, int size) const {
  Rml::FontMetrics metrics{};
  GpgpFontInfo info = GPGP_FONT_INFO_INIT;
  if (gpgpGetFontInfo(fonts[face.number], &info) < 0) return metrics;
  const auto em = static_cast<float>(size);
  metrics.size = size;
  metrics.ascent = std::ceil(info.ascent * em - 0.01f);
  metrics.descent = std::ceil(info.descent * em - 0.01f);
  metrics.line_spacing = std::round((info.ascent + info.descent + info.lineGap) * em);
  metrics.x_height = info.xHeight > 0 ? std::round(info.xHeight * em) : metrics.line_spacing / 2;
  metrics.underline_position = info.underlinePosition * em;
  metrics.underline_thickness = std::max(info.underlineThickness * em, 1.0f);
  uint32_t glyph = 0;
  metrics.has_ellipsis = gpgpGetNominalGlyph(fonts[face.number], 0x2026, &glyph) == GPGP_SUCCESS && glyph != 0;
  return metrics;
}

Rml::FontFaceHandle FontEngine::GetFontFaceHandle(const Rml::String& family, Rml::Style::FontStyle style,
                                                  Rml::Style::FontWeight weight, int size) {
  const Rml::String lower = Rml::StringUtilities::ToLower(family);
  const int wanted = weight == Rml::Style::FontWeight::Auto ? 400 : static_cast<int>(weight);
  const bool italic = style == Rml::Style::FontStyle::Italic;
  size_t best = impl_->faces.size();
  const auto distance = [&](const Face& face) {
    return std::abs(face.weight - wanted) + (face.italic != italic ? 10000 : 0);
  };
  for (size_t i = 0; i < impl_->faces.size(); ++i)
    if (impl_->faces[i].family == lower &&
        (best == impl_->faces.size() || distance(impl_->faces[i]) < distance(impl_->faces[best])))
      best = i;
  if (best == impl_->faces.size() || size <= 0) return 0;
  std::unique_ptr<SizedFace>& sized = impl_->sized[{best, size}];
  if (!sized) {
    sized = std::make_unique<SizedFace>();
    sized->face = best;
    sized->metrics = impl_->measure(impl_->faces[best], size);
  }
  return reinterpret_cast<Rml::FontFaceHandle>(sized.get());
}

const Rml::FontMetrics& FontEngine::GetFontMetrics(Rml::FontFaceHandle handle) {
  return reinterpret_cast<SizedFace*>(handle)->metrics;
}

int FontEngine::GetVersion(Rml::FontFaceHandle) { return impl_->version; }

Rml::FontEffectsHandle FontEngine::PrepareFontEffects(Rml::FontFaceHandle handle, const Rml::FontEffectList& effects) {
  auto& known = reinterpret_cast<SizedFace*>(handle)->effects;
  if (effects.empty()) return 0;
  const auto found = std::find(known.begin(), known.end(), effects);
  if (found != known.end()) return static_cast<Rml::FontEffectsHandle>(found - known.begin()) + 1;
  known.push_back(effects);
  return static_cast<Rml::FontEffectsHandle>(known.size());
}

// ---------------------------------------------------------------- text

float FontEngine::Impl::set(const SizedFace& face, Rml::StringView string, const Rml::TextShapingContext& shaping,
                            float& left) {
  std::vector<GpgpFont> chain{fonts[faces[face.face].number]};
  for (const Face& other : faces)
    if (other.fallback && other.number != faces[face.face].number) chain.push_back(fonts[other.number]);
  auto info = init<GpgpTextInfo>();
  info.text = string.begin();
  info.size = string.size();
  info.align = GPGP_TEXT_ALIGN_LEFT;
  info.direction = shaping.text_direction == Rml::Style::Direction::Rtl   ? GPGP_TEXT_RIGHT_TO_LEFT
                   : shaping.text_direction == Rml::Style::Direction::Ltr ? GPGP_TEXT_LEFT_TO_RIGHT
                                                                          : GPGP_TEXT_AUTO;
  info.style.fonts = chain.data();
  info.style.fontCount = static_cast<uint32_t>(chain.size());
  info.style.size = static_cast<float>(face.metrics.size);
  info.style.letterSpacing = shaping.letter_spacing;
  info.style.language = shaping.language.empty() ? nullptr : shaping.language.c_str();
  const GpgpFontFeature unkerned{GPGP_TAG('k', 'e', 'r', 'n'), 0};
  if (shaping.font_kerning == Rml::Style::FontKerning::None) {
    info.style.features = &unkerned;
    info.style.featureCount = 1;
  }
  // Spaces are the face's own, whatever font is before them: RmlUi measures words alone, or with the space before.
  std::vector<GpgpTextSpan> spaces;
  for (uint32_t i = 0; i < string.size() && chain.size() > 1; ++i) {
    if (string.begin()[i] != ' ') continue;
    if (spaces.empty() || spaces.back().end != i) spaces.push_back({i, i, info.style});
    spaces.back().end = i + 1;
    spaces.back().style.fontCount = 1;
  }
  info.spans = spaces.data();
  info.spanCount = static_cast<uint32_t>(spaces.size());
  left = 0;
  GpgpLayoutInfo laid = GPGP_LAYOUT_INFO_INIT;
  if (!layout || layout.set(info) < 0 || gpgpGetLayoutInfo(layout, &laid) < 0) return 0;
  // White space at the end hangs out of the line, at its right or its left.
  GpgpCaret begin{}, end{};
  if (gpgpGetCaret(layout, 0, VK_FALSE, &begin) < 0) return 0;
  if (gpgpGetCaret(layout, static_cast<uint32_t>(string.size()), VK_FALSE, &end) < 0) return 0;
  float right = 0;
  if (laid.lineCount > 0) {
    left = laid.lines[0].left;
    right = left + laid.lines[0].width;
  }
  left = std::min({left, begin.x, end.x});
  return std::max({right, begin.x, end.x}) - left;
}

int FontEngine::GetStringWidth(Rml::FontFaceHandle handle, Rml::StringView string,
                               const Rml::TextShapingContext& shaping, Rml::Character) {
  float left = 0;
  return string.empty()
             ? 0
             : static_cast<int>(std::lround(impl_->set(*reinterpret_cast<SizedFace*>(handle), string, shaping, left)));
}

int FontEngine::GenerateString(Rml::RenderManager& manager, Rml::FontFaceHandle handle, Rml::FontEffectsHandle effects,
                               Rml::StringView string, Rml::Vector2f position, Rml::ColourbPremultiplied colour,
                               float opacity, const Rml::TextShapingContext& shaping, Rml::TexturedMeshList& meshes) {
  SizedFace& sized = *reinterpret_cast<SizedFace*>(handle);
  float left = 0;
  const float width = string.empty() ? 0 : impl_->set(sized, string, shaping, left);
  GpgpLayoutInfo laid = GPGP_LAYOUT_INFO_INIT;
  if (!string.empty() && (!impl_->layout || gpgpGetLayoutInfo(impl_->layout, &laid) < 0)) return 0;

  const Rml::FontEffectList none;
  const Rml::FontEffectList& list = effects > 0 && effects <= sized.effects.size() ? sized.effects[effects - 1] : none;
  meshes.resize(list.size() + 1); // one a line was there before: lines follow one another in it
  size_t next = 0;
  const auto add = [&](const TextStyle& style, float x, float y, Rml::ColourbPremultiplied color) {
    Rml::TexturedMesh& to = meshes[next++];
    to.texture = manager.LoadTexture(textTexture(style));
    const float baseline = laid.lineCount > 0 ? laid.lines[0].baseline : 0;
    for (uint32_t i = 0; i < laid.glyphCount; ++i) {
      const GpgpTextGlyph& glyph = laid.glyphs[i];
      const auto number = impl_->numbers.find(glyph.font);
      if (number == impl_->numbers.end()) continue;
      const auto [at, isNew] = impl_->boxes.try_emplace({number->second, glyph.glyph});
      if (isNew) at->second = integration::inkBox(glyph.font, glyph.glyph);
      const std::array<float, 4>& ink = at->second;
      if (!(ink[0] < ink[2] && ink[1] < ink[3])) continue;
      const MeshGlyph placed{number->second, glyph.glyph, position.x + glyph.x - left + x,
                             position.y + glyph.y - baseline + y, glyph.size};
      const auto corners = encode(placed);
      const auto first = static_cast<int>(to.mesh.vertices.size());
      for (size_t c = 0; c < 4; ++c)
        to.mesh.vertices.push_back(
            {{placed.x + ink[c == 1 || c == 2 ? 2 : 0] * placed.size, placed.y + ink[c < 2 ? 1 : 3] * placed.size},
             color,
             {corners[c][0], corners[c][1]}});
      for (const int corner : {0, 1, 2, 0, 2, 3}) to.mesh.indices.push_back(first + corner);
    }
  };
  bool base = false;
  for (const auto& effect : list) {
    if (!base && effect->GetLayer() == Rml::FontEffect::Layer::Front) {
      add({}, 0, 0, colour);
      base = true;
    }
    const auto* own = dynamic_cast<const Effect*>(effect.get());
    if (!own) {
      meshes[next++].texture = manager.LoadTexture(textTexture({}));
      Rml::Log::Message(Rml::Log::LT_WARNING, "gpgp: a font effect that is not RmlUi's is left out");
      continue;
    }
    add(own->style, own->x, own->y, effect->GetColour().ToPremultiplied(opacity));
  }
  if (!base) add({}, 0, 0, colour);
  return static_cast<int>(std::lround(width));
}

} // namespace gpgp::rmlui
