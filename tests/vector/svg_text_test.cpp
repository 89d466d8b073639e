// Where letters of SVG's text stand, and the lines along them, beside the same squares written as shapes.
#include "svg_squares.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp::test;

struct Pair {
  const char* name;
  std::string with, without;
};

void expectSame(const Pair& pair) {
  SCOPED_TRACE(pair.name);
  const Import given = written(pair.with), reference = page(pair.without);
  EXPECT_EQ(given.placed, std::vector<std::string>());
  EXPECT_LE(worst(picture(given), picture(reference)), 0.51); // of 255: rounding of points to floats on an edge
}

std::string box(double x, double y, double w, double h) {
  return "<rect x='" + std::to_string(x) + "' y='" + std::to_string(y) + "' width='" + std::to_string(w) +
         "' height='" + std::to_string(h) + "'/>";
}
/// A letter of 20 units.
std::string at(double x, double y) { return box(x, y - 8, 8, 8); }
/// One that stands on a baseline which goes down.
std::string onSide(double x, double y) { return box(x, y, 8, 8); }

TEST(SvgText, LettersAreSpacedButTheLast) {
  const Pair pairs[] = {
      {"at the end", "<text x='50' y='40' text-anchor='end' letter-spacing='5'>ab</text>", at(25, 40) + at(40, 40)},
      {"in the middle", "<text x='50' y='40' text-anchor='middle' letter-spacing='10'>ab</text>",
       at(35, 40) + at(55, 40)},
      {"before what has none", "<text x='10' y='40'><tspan letter-spacing='5'>ab</tspan>c</text>",
       at(10, 40) + at(25, 40) + at(40, 40)},
      {"not where letters join", // two bytes, which are two squares of this font
       "<text x='10' y='40' letter-spacing='5'>\u0645</text>", at(10, 40) + at(20, 40)},
      {"where others do", "<text x='10' y='40' letter-spacing='5'>a\u0645</text>",
       at(10, 40) + at(25, 40) + at(35, 40)},
      {"no room is no letter", "<text x='10' y='40' letter-spacing='-15'>abc</text>", at(10, 40)},
      {"as long as nothing", "<text x='10' y='40' textLength='0'>ab</text>", at(10, 40) + at(0, 40)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, IndicesLieWhereTheFontHasThem) {
  const Pair pairs[] = {
      {"above and below", // by 10 and by 5
       "<text x='10' y='40'>a<tspan baseline-shift='super'>b</tspan><tspan baseline-shift='sub'>c</tspan></text>",
       at(10, 40) + at(20, 30) + at(30, 45)},
      {"inside of others",
       "<text x='10' y='40'><tspan baseline-shift='sub'>a<tspan baseline-shift='super'>b<tspan "
       "baseline-shift='super'>c</tspan></tspan></tspan></text>",
       at(10, 45) + at(20, 35) + at(30, 25)},
      {"with lengths",
       "<text x='10' y='40'><tspan baseline-shift='5'><tspan baseline-shift='super'>a</tspan></tspan></text>",
       at(10, 25)},
      {"by the letters' size",
       "<text x='10' y='60'><tspan baseline-shift='super'>a<tspan font-size='40'>b</tspan></tspan></text>",
       at(10, 50) + box(20, 24, 16, 16)},
      {"a baseline that does not change",
       "<text x='10' y='40' dominant-baseline='hanging'>a<tspan dominant-baseline='no-change'>b</tspan></text>",
       at(10, 52.8) + at(20, 52.8)},
      {"a negative size shows nothing", "<text x='10' y='40'>a<tspan font-size='-5'>b</tspan>c</text>",
       at(10, 40) + at(20, 40)},
      {"words of a tref are those of another element",
       "<text x='10' y='40'><tref href='#o'>no</tref>b</text><defs><text id='o'>x</text></defs>",
       at(10, 40) + at(20, 40)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

TEST(SvgText, LinesBeginAnewWhereALetterIsPlaced) {
  const Pair pairs[] = {
      {"in a row", "<text x='10' y='40' text-decoration='underline'>ab</text>",
       at(10, 40) + at(20, 40) + box(10, 40, 20, 2)},
      {"at places", "<text x='10 40' y='40' text-decoration='underline'>ab</text>",
       at(10, 40) + at(40, 40) + box(10, 40, 10, 2) + box(40, 40, 10, 2)},
      {"moved", "<text x='10' y='40' dx='0 5' text-decoration='underline'>abc</text>",
       at(10, 40) + at(25, 40) + at(35, 40) + box(10, 40, 10, 2) + box(25, 40, 20, 2)},
      {"from above: along both edges and through the middle",
       "<text x='40' y='10' writing-mode='tb' text-decoration='underline overline line-through'>ab</text>",
       onSide(34, 10) + onSide(34, 20) + box(29, 10, 2, 20) + box(49, 10, 2, 20) + box(39, 10, 2, 20)},
  };
  for (const Pair& pair : pairs) expectSame(pair);
}

} // namespace
