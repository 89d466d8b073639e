#include "cli/vector/system_fonts.h"

#ifdef GPGP_CLI_FONTCONFIG
#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <cstdlib>

namespace gpgp::cli {
namespace {
template <auto destroy> struct Destroyer {
  template <class T> void operator()(T* object) const { destroy(object); }
};
using Pattern = std::unique_ptr<FcPattern, Destroyer<FcPatternDestroy>>;
using Sorted = std::unique_ptr<FcFontSet, Destroyer<FcFontSetDestroy>>;
using Characters = std::unique_ptr<FcCharSet, Destroyer<FcCharSetDestroy>>;

const FcChar8* bytes(const std::string& text) { return reinterpret_cast<const FcChar8*>(text.c_str()); }

std::string stringOf(FcPattern* pattern, const char* name) {
  FcChar8* text = nullptr;
  return FcPatternGetString(pattern, name, 0, &text) == FcResultMatch ? reinterpret_cast<const char*>(text) : "";
}

/// Of the text, without spaces and controls, which any font draws.
Characters charactersOf(std::string_view text) {
  Characters all(FcCharSetCreate());
  const auto* at = reinterpret_cast<const FcChar8*>(text.data());
  for (auto left = static_cast<int>(text.size()); left > 0;) {
    FcChar32 c = 0;
    const int length = FcUtf8ToUcs4(at, &c, left);
    if (length <= 0) break;
    const bool isSilent = c <= 0x20 || (c >= 0x7f && c <= 0xa0) || (c >= 0x200b && c <= 0x200f) ||
                          (c >= 0x2028 && c <= 0x202f) || (c >= 0x2060 && c <= 0x206f) || (c >= 0xfe00 && c <= 0xfe0f);
    if (!isSilent) FcCharSetAddChar(all.get(), c);
    at += length, left -= length;
  }
  return all;
}

/// "wght=700,wdth=100".
std::vector<std::pair<std::string, float>> axesOf(std::string_view list) {
  std::vector<std::pair<std::string, float>> axes;
  while (list.size() > 5) {
    const size_t end = std::min(list.find(','), list.size());
    if (list[4] == '=')
      axes.emplace_back(list.substr(0, 4), std::strtof(std::string(list.substr(5, end - 5)).c_str(), nullptr));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return axes;
}

/// Whether the configuration has nothing for any of the families: it is the same to it as one that cannot be.
bool areUnknown(FcConfig* config, const std::vector<std::string>& families) {
  constexpr const char* noFamily = "gpgp no family";
  const auto behind = [config](const std::vector<std::string>& names) { // what is taken where there are none of them
    const Pattern pattern(FcPatternCreate());
    for (const std::string& name : names) FcPatternAddString(pattern.get(), FC_FAMILY, bytes(name));
    FcConfigSubstitute(config, pattern.get(), FcMatchPattern);
    std::vector<std::string> all;
    FcChar8* family = nullptr;
    for (int i = 0; FcPatternGetString(pattern.get(), FC_FAMILY, i, &family) == FcResultMatch; ++i)
      if (const std::string name = reinterpret_cast<const char*>(family);
          std::find(names.begin(), names.end(), name) == names.end())
        all.push_back(name);
    return all;
  };
  const auto isInstalled = [config](const std::string& name) {
    const Pattern pattern(FcPatternBuild(nullptr, FC_FAMILY, FcTypeString, bytes(name), nullptr));
    const std::unique_ptr<FcObjectSet, Destroyer<FcObjectSetDestroy>> what(FcObjectSetBuild(FC_FAMILY, nullptr));
    const Sorted found(FcFontList(config, pattern.get(), what.get()));
    return found && found->nfont > 0;
  };
  return !families.empty() && behind(families) == behind({noFamily}) &&
         std::none_of(families.begin(), families.end(), isInstalled);
}
} // namespace

void SystemFonts::Closer::operator()(_FcConfig* config) const { FcConfigDestroy(config); }

bool SystemFonts::areThere() { return true; }

SystemFonts::SystemFonts() : config_(FcInitLoadConfigAndFonts()) {}

std::vector<SystemFont> SystemFonts::find(const std::vector<std::string>& families, const FontStyle& style,
                                          const std::string& language, std::string_view text) const {
  if (!config_) return {};
  const Pattern wanted(FcPatternCreate());
  for (const std::string& family : families) FcPatternAddString(wanted.get(), FC_FAMILY, bytes(family));
  if (areUnknown(config_.get(), families)) // as browsers and resvg have it
    FcPatternAddString(wanted.get(), FC_FAMILY, bytes("serif"));
  FcPatternAddDouble(wanted.get(), FC_WEIGHT, FcWeightFromOpenTypeDouble(static_cast<double>(style.weight)));
  FcPatternAddInteger(wanted.get(), FC_SLANT, style.italic ? FC_SLANT_ITALIC : FC_SLANT_ROMAN);
  FcPatternAddDouble(wanted.get(), FC_WIDTH, static_cast<double>(style.stretch)); // whose numbers are percent
  FcPatternAddBool(wanted.get(), FC_SCALABLE, FcTrue);
  if (!language.empty()) FcPatternAddString(wanted.get(), FC_LANG, bytes(language));
  FcConfigSubstitute(config_.get(), wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultNoMatch;
  const Sorted sorted(FcFontSort(config_.get(), wanted.get(), FcFalse, nullptr, &result));
  Characters missing = charactersOf(text);
  std::vector<SystemFont> found;
  for (int i = 0; sorted && i < sorted->nfont && (found.empty() || FcCharSetCount(missing.get()) > 0); ++i) {
    FcPattern* font = sorted->fonts[i];
    const std::string format = stringOf(font, FC_FONTFORMAT);
    if (format != "TrueType" && format != "CFF") continue;
    FcCharSet* has = nullptr;
    if (FcPatternGetCharSet(font, FC_CHARSET, 0, &has) != FcResultMatch) continue;
    if (!found.empty() && FcCharSetIntersectCount(has, missing.get()) == 0) continue;
    const Pattern prepared(FcFontRenderPrepare(config_.get(), wanted.get(), font));
    int face = 0;
    FcPatternGetInteger(prepared.get(), FC_INDEX, 0, &face);
    found.push_back({stringOf(prepared.get(), FC_FILE), static_cast<uint32_t>(face) & 0xffff,
                     axesOf(stringOf(prepared.get(), FC_FONT_VARIATIONS))});
    missing.reset(FcCharSetSubtract(missing.get(), has));
  }
  return found;
}

} // namespace gpgp::cli

#else

namespace gpgp::cli {
void SystemFonts::Closer::operator()(_FcConfig*) const {}
bool SystemFonts::areThere() { return false; }
SystemFonts::SystemFonts() = default;
std::vector<SystemFont> SystemFonts::find(const std::vector<std::string>&, const FontStyle&, const std::string&,
                                          std::string_view) const {
  return {};
}
} // namespace gpgp::cli

#endif
