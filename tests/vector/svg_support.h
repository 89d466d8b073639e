// What svg_support_test finds: what an attribute or a declaration changes of a drawing.
#pragma once
#include "svg_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace gpgp::test::support {

using Texts = std::vector<std::string>;

/// Squares whose size, place and number say what was asked for.
inline GpgpResult GPGP_CALL shapeAsked(void*, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn, void* glyphData) {
  struct Asked {
    GpgpSvgGlyphFn fn;
    void* data;
    const GpgpSvgText* text;
  } asked{glyphFn, glyphData, text};
  return shapeSquares(
      nullptr, text,
      [](void* user, const GpgpSvgGlyph* square) {
        const auto& a = *static_cast<const Asked*>(user);
        const GpgpSvgTextSpan* span = a.text->spans;
        while (span->end <= square->cluster) ++span;
        GpgpSvgGlyph glyph = *square;
        glyph.size += 0.001f * (static_cast<float>(std::strlen(span->families)) + span->weight + span->stretch +
                                10.f * static_cast<float>(std::strlen(span->language))) +
                      (span->italic ? 2.f : 0.f) + (span->smallCaps ? 3.f : 0.f) + (span->unkerned ? 4.f : 0.f) +
                      (a.text->rightToLeft ? 5.f : 0.f);
        a.fn(a.data, &glyph);
      },
      &asked);
}

/// All that a recording would draw, as text.
class Print {
public:
  explicit Print(const vector::svg::Imported& drawing) {
    out_ << drawing.width << ' ' << drawing.height << '\n';
    for (const auto& path : drawing.paths) add(path);
    for (const auto& group : drawing.groups) {
      out_ << "group " << group.parent << ' ' << group.opacity << ' ' << group.clipped << '\n';
      for (const auto& path : group.clip) add(path);
      if (!group.layer) continue;
      const GpgpLayer& l = group.layer->layer;
      out_ << l.blend << ' ' << l.isolated << ' ' << l.mask << ' ' << l.maskKind << ' ' << l.maskEncoding;
      all(l.maskRegion), all(l.maskTransform), all(l.filterTransform), all(l.filterRegion);
      for (const GpgpFilterStep& step : group.layer->steps) {
        out_ << "step " << step.kind << ' ' << step.mode << ' ' << step.input << ' ' << step.input2 << ' '
             << step.encoding << ' ' << step.group;
        all(step.region), all(step.values);
        for (uint32_t i = 0; i < step.tableCount; ++i) out_ << ' ' << step.table[i];
      }
    }
  }
  std::string text() const { return out_.str(); }

private:
  template <size_t N> void all(const float (&numbers)[N]) {
    for (const float number : numbers) out_ << ' ' << number;
    out_ << '\n';
  }
  void add(const vector::svg::ImportedPath& path) {
    out_ << "path " << path.rule << ' ' << path.group;
    for (const float p : path.points) out_ << ' ' << p;
    all(path.color);
    if (path.image) out_ << "image " << path.image->image, all(path.image->transform);
    if (!path.gradient) return;
    const GpgpGradient& g = path.gradient->gradient;
    out_ << "gradient " << g.kind << ' ' << g.spread << ' ' << g.interpolateSrgb << ' ' << g.startRadius << ' '
         << g.endRadius;
    all(g.start), all(g.end), all(g.transform);
    for (const GpgpGradientStop& stop : path.gradient->stops) out_ << ' ' << stop.offset, all(stop.color);
  }
  std::ostringstream out_;
};

struct Drawn {
  std::string print;
  Texts said;
};

inline Drawn drawn(const std::string& inside, const std::string& root = "") {
  const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' "
                           "width='100' height='100' font-size='20' " +
                           root + ">\n" + inside + "</svg>";
  Drawn result;
  const auto listen = [](void* user, const GpgpMessage* m) { static_cast<Texts*>(user)->push_back(m->text); };
  vector::svg::Reporter reporter(listen, &result.said, "test.svg");
  const auto decode = [](void*, uint32_t, const void* data, size_t, uint32_t* width, uint32_t* height) -> VkBool32 {
    *width = 8 + *static_cast<const uint8_t*>(data), *height = 4;
    return VK_TRUE;
  };
  const auto made = vector::svg::importSvg(std::as_bytes(std::span(text.data(), text.size())), reporter, {},
                                           {decode, nullptr}, {}, nullptr, {shapeAsked, nullptr});
  if (made) result.print = Print(*made).text();
  return result;
}

// Parts of drawings.
inline const std::string kFill = "fill='#0a0' stroke='#00a' stroke-width='4' stroke-dasharray='9 5' ";
inline const std::string kBlock = "<rect x='20' y='20' width='60' height='60' " + kFill;
inline const std::string kImage = "xlink:href='data:image/png;base64,AAAA' ";
inline std::string filtered(const std::string& primitive) {
  return "<g id='e'><path d='M0 0h9v9'/></g><filter id='f' color-interpolation-filters='sRGB'>" + primitive +
         "</filter>" + kBlock + "filter='url(#f)'/>";
}
inline std::string lit(const std::string& light) {
  return filtered("<feDiffuseLighting surfaceScale='2'><" + light + " @/></feDiffuseLighting>");
}
inline std::string painted(const std::string& server) {
  return server + "<rect x='20' y='20' width='60' height='60' fill='url(#p)'/>";
}
inline const std::string kStops = "<stop stop-color='red'/><stop offset='1' stop-color='blue'/>";
inline std::string marked(const std::string& marker) {
  return "<marker id='m' " + marker +
         "<rect width='4' height='8' fill='#a00'/></marker>"
         "<path d='M20 20H60L80 80' stroke='#000' stroke-width='2' marker-mid='url(#m)'/>";
}
inline std::string alongPath(const std::string& own) {
  return "<path id='t' d='M10 50H90' fill='none'/><path id='u' d='M10 70H90' fill='none'/><text>" + own + "</text>";
}

enum class Outcome { Drawn, Named, Nothing };

/// What an attribute or a declaration changes. A name in a message counts; any other message does not.
inline Outcome outcomeOf(const std::string& what, const Drawn& with, const Drawn& without) {
  for (const std::string& message : with.said)
    if ((message.find("not supported") != message.npos && message.find(what) != message.npos) ||
        message.find("a " + what + ">, which") != message.npos) // a paint, for example
      return Outcome::Named;
  EXPECT_LE(with.said.size(), without.said.size()) << what << ": " << (with.said.empty() ? "" : with.said.back());
  return with.print != without.print ? Outcome::Drawn : Outcome::Nothing;
}

inline std::string replaced(const std::string& text, const std::string& by) {
  std::string out = text;
  out.replace(out.find('@'), 1, by);
  return out;
}

/// Lines of at most 120 characters.
inline std::string wrapped(const std::string& text) {
  std::string out;
  size_t column = 0;
  std::istringstream words(text);
  for (std::string word; words >> word; column += word.size() + 1) {
    if (column > 0 && column + word.size() > 119)
      out += "\n  ", column = 2;
    else if (column > 0)
      out += ' ';
    out += word;
  }
  return out + "\n";
}

inline std::string listed(const std::set<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "`" : ", `") + name + "`";
  return out;
}

/// Rows of a table: what is drawn, named, and without effect.
struct Row {
  std::set<std::string> of[3];
  std::string cells() const { return listed(of[0]) + " | " + listed(of[1]) + " | " + listed(of[2]) + " |\n"; }
};

/// The page's part on properties. svg_support_properties.cpp
std::string properties();

} // namespace gpgp::test::support
