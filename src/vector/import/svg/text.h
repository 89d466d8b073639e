// A text while it is drawn: its characters, their places, and the glyphs that stand for them.
#pragma once
#include "vector/import/svg/importer.h"
#include "vector/import/svg/track.h"

namespace gpgp::vector::svg {

/// A font's gradient, moved to where its glyph is.
std::shared_ptr<const Gradient> gradientMoved(const GpgpGradient& from, const Affine& map);

struct Importer::Text {
  struct Decoration {
    std::string kinds; ///< of text-decoration
    size_t run;        ///< whose paints it has
  };
  struct Run { // an element's own characters
    State state;
    pugi::xml_node node;
    std::string language;
    double shift = 0;                     ///< of its baseline, up
    int superscripts = 0, subscripts = 0; ///< elements around that shift it by what their fonts say
    size_t track = 0;                     ///< 1 + index
    std::vector<Decoration> decorations;
  };
  struct Element { // with what it says of its characters
    pugi::xml_node node;
    State state;
    size_t first = 0, last = 0; ///< its characters
  };
  struct Character {
    size_t begin = 0;  ///< of the marks of direction before it
    size_t offset = 0; ///< its own first byte
    size_t run = 0;
    std::optional<double> x, y;
    double dx = 0, dy = 0, rotate = 0;
  };
  struct Part { // of a glyph
    Shape shape;
    bool isForeground = true;
    Color color;
    std::shared_ptr<const Gradient> gradient; ///< in em, as all of it
    const Picture* picture = nullptr;
    Affine place{}; ///< of the picture: from the unit square
  };
  struct Glyph {
    size_t character = 0;
    Affine map; ///< from em
    Point at;   ///< where it begins on its baseline
    double advance = 0, angle = 0, size = 0;
    Point line; ///< where its piece of a decoration begins: on its baseline, of vertical lines in their middle
    double lineAngle = 0;
    bool hidden = false; ///< beyond a track's ends
    bool apart = false;  ///< its character is placed by itself: decorations begin anew
    GpgpSvgGlyph metrics{};
    std::vector<Part> parts;
  };
  pugi::xml_node node;
  std::string bytes;
  std::string marks; ///< of direction, before the next character
  std::vector<Run> runs;
  std::vector<Element> elements;
  std::vector<Character> characters;
  std::vector<Track> tracks;
  std::vector<Glyph> glyphs;
  Box box; ///< of all glyphs' cells
  bool afterSpace = true, vertical = false;
  Point at;         ///< the current text position
  double along = 0; ///< the same on a path, from where its text begins
};

} // namespace gpgp::vector::svg
