// Follows the OpenType specification, version 1.9: glyf, COLR, CPAL, CFF2, fvar, HVAR and what a font must have
// besides.
#include "tiny_font.h"

#include <hb.h>

#include <array>
#include <cstddef>
#include <span>

namespace gpgp::test {
namespace {

class Bytes {
public:
  Bytes& u8(uint32_t value) {
    bytes.push_back(static_cast<char>(value & 255));
    return *this;
  }
  Bytes& u16(uint32_t value) { return u8(value >> 8).u8(value); }
  Bytes& i16(int value) { return u16(static_cast<uint32_t>(value)); }
  Bytes& u24(uint32_t value) { return u8(value >> 16).u16(value); }
  Bytes& u32(uint32_t value) { return u16(value >> 16).u16(value); }
  Bytes& f2dot14(double value) { return i16(static_cast<int>(value * 16384)); }
  Bytes& fixed(double value) { return u32(static_cast<uint32_t>(static_cast<int32_t>(value * 65536))); }
  Bytes& add(const Bytes& other) {
    bytes.insert(bytes.end(), other.bytes.begin(), other.bytes.end());
    return *this;
  }
  uint32_t size() const { return static_cast<uint32_t>(bytes.size()); }
  std::vector<char> bytes;
};

using Points = std::vector<std::array<int, 2>>;

Bytes glyph(const Points& points) {
  Bytes out;
  if (points.empty()) return out;
  int box[4] = {1000, 1000, -1000, -1000};
  for (const auto& [x, y] : points) {
    box[0] = x < box[0] ? x : box[0];
    box[1] = y < box[1] ? y : box[1];
    box[2] = x > box[2] ? x : box[2];
    box[3] = y > box[3] ? y : box[3];
  }
  out.i16(1);
  for (const int value : box) out.i16(value);
  out.u16(static_cast<uint32_t>(points.size()) - 1).u16(0);
  for (std::size_t i = 0; i < points.size(); ++i) out.u8(1); // on the curve, two bytes a coordinate
  for (int axis = 0; axis < 2; ++axis) {
    int last = 0;
    for (const auto& point : points) {
      out.i16(point[static_cast<std::size_t>(axis)] - last);
      last = point[static_cast<std::size_t>(axis)];
    }
  }
  while (out.size() % 4) out.u8(0);
  return out;
}

Bytes solid(uint32_t entry, double alpha) { return Bytes().u8(2).u16(entry).f2dot14(alpha); }
Bytes ofGlyph(uint32_t id, const Bytes& paint) { return Bytes().u8(10).u24(6).u16(id).add(paint); }
Bytes translate(int x, int y, const Bytes& paint) { return Bytes().u8(14).u24(8).i16(x).i16(y).add(paint); }
Bytes rotate(double halfTurns, const Bytes& paint) { return Bytes().u8(24).u24(6).f2dot14(halfTurns).add(paint); }
Bytes transform(const std::array<double, 6>& m, const Bytes& paint) {
  Bytes out = Bytes().u8(12).u24(7 + 24).u24(7);
  for (const double value : m) out.fixed(value);
  return out.add(paint);
}
/// Red at the beginning, entry 1 at half alpha at the end.
Bytes colorLine() { return Bytes().u8(2).u16(2).f2dot14(0).u16(0).f2dot14(1).f2dot14(1).u16(1).f2dot14(0.5); }
Bytes linearGradient(const std::array<int, 6>& points) {
  Bytes out = Bytes().u8(4).u24(16);
  for (const int value : points) out.i16(value);
  return out.add(colorLine());
}
Bytes radialGradient(const std::array<int, 6>& circles) {
  Bytes out = Bytes().u8(6).u24(16);
  for (const int value : circles) out.i16(value);
  return out.add(colorLine());
}
Bytes sweepGradient() { return Bytes().u8(8).u24(12).i16(0).i16(0).f2dot14(0).f2dot14(1).add(colorLine()); }

/// The square in entry 0; the corner, moved by (100, 200), in a linear gradient; the square turned by a quarter in a
/// radial one; the corner scaled and sheared in the text's colour at half alpha.
std::vector<Bytes> paints() {
  return {ofGlyph(tiny::kSquare, solid(0, 1)),
          translate(100, 200, ofGlyph(tiny::kCorner, linearGradient({0, 0, 400, 0, 100, 400}))),
          rotate(0.5, ofGlyph(tiny::kSquare, radialGradient({250, 250, 0, 250, 250, 300}))),
          transform({2, 0, 0.5, 1, 10, 20}, ofGlyph(tiny::kCorner, solid(0xffff, 0.5)))};
}

Bytes colr(const Bytes& sweep) {
  // Version 0: one base glyph of two layers. Version 1: four layers, and three base glyphs.
  const Bytes bases = Bytes().u16(tiny::kLayers).u16(0).u16(2);
  const Bytes layers = Bytes().u16(tiny::kSquare).u16(0).u16(tiny::kCorner).u16(0xffff);
  const std::vector<Bytes> all = paints();
  Bytes list = Bytes().u32(static_cast<uint32_t>(all.size())), bodies;
  for (const Bytes& paint : all) {
    list.u32(4 + 4 * static_cast<uint32_t>(all.size()) + bodies.size());
    bodies.add(paint);
  }
  list.add(bodies);
  const Bytes roots[] = {Bytes().u8(1).u8(4).u32(0), // all four layers
                         sweep, Bytes().u8(11).u16(tiny::kCircle)};
  Bytes graph = Bytes().u32(3), rootBodies;
  uint32_t id = tiny::kPaints;
  for (const Bytes& root : roots) {
    graph.u16(id++).u32(4 + 3 * 6 + rootBodies.size());
    rootBodies.add(root);
  }
  graph.add(rootBodies);
  const uint32_t header = 34, atLayers = header + bases.size(), atGraph = atLayers + layers.size();
  return Bytes()
      .u16(1)
      .u16(1)
      .u32(header)
      .u32(atLayers)
      .u16(2)
      .u32(atGraph)
      .u32(atGraph + graph.size())
      .u32(0)
      .u32(0)
      .u32(0)
      .add(bases)
      .add(layers)
      .add(graph)
      .add(list);
}

Bytes head() {
  return Bytes()
      .u32(0x10000)
      .u32(0x10000)
      .u32(0)
      .u32(0x5f0f3cf5)
      .u16(0)
      .u16(1000)
      .u32(0)
      .u32(0)
      .u32(0)
      .u32(0)
      .i16(0)
      .i16(0)
      .i16(500)
      .i16(800)
      .u16(0)
      .u16(8)
      .i16(2)
      .i16(1)
      .i16(0);
}
Bytes hhea(uint32_t glyphs) {
  return Bytes()
      .u32(0x10000)
      .i16(800)
      .i16(-200)
      .i16(90)
      .u16(600)
      .i16(0)
      .i16(0)
      .i16(500)
      .i16(1)
      .i16(0)
      .i16(0)
      .u32(0)
      .u32(0)
      .i16(0)
      .u16(glyphs);
}
/// Characters in a row, for the glyphs from 1 on: a segment, and the end that format 4 wants.
Bytes cmap(int first, int last) {
  const Bytes segments = Bytes()
                             .u16(4)
                             .u16(32)
                             .u16(0)
                             .u16(4)
                             .u16(4)
                             .u16(1)
                             .u16(0)
                             .i16(last)
                             .u16(0xffff)
                             .u16(0)
                             .i16(first)
                             .u16(0xffff)
                             .i16(1 - first)
                             .i16(1)
                             .u16(0)
                             .u16(0);
  return Bytes().u16(0).u16(1).u16(3).u16(1).u32(12).add(segments);
}

struct Table {
  const char* tag;
  Bytes bytes;
};

std::vector<char> assemble(std::span<const Table> tables) {
  hb_face_t* builder = hb_face_builder_create();
  for (const auto& [tag, bytes] : tables) {
    hb_blob_t* blob = hb_blob_create(bytes.bytes.data(), bytes.size(), HB_MEMORY_MODE_READONLY, nullptr, nullptr);
    hb_face_builder_add_table(builder, hb_tag_from_string(tag, 4), blob);
    hb_blob_destroy(blob);
  }
  hb_blob_t* made = hb_face_reference_blob(builder);
  unsigned size = 0;
  const char* data = hb_blob_get_data(made, &size);
  std::vector<char> font(data, data + size);
  hb_blob_destroy(made);
  hb_face_destroy(builder);
  return font;
}

} // namespace

namespace {

std::vector<char> tinyFontWith(const Bytes& sweep) {
  const Points square = {{0, 0}, {0, 500}, {500, 500}, {500, 0}}, corner = {{0, 0}, {0, 800}, {400, 0}};
  const Points shapes[tiny::kGlyphs] = {square, square, corner, square, square, square, square};
  Bytes glyf, loca, hmtx;
  for (const Points& shape : shapes) {
    loca.u32(glyf.size());
    glyf.add(glyph(shape));
    hmtx.u16(600).i16(0);
  }
  loca.u32(glyf.size());
  const Table tables[] = {{"head", head()},
                          {"hhea", hhea(tiny::kGlyphs)},
                          {"maxp", Bytes()
                                       .u32(0x10000)
                                       .u16(tiny::kGlyphs)
                                       .u16(4)
                                       .u16(1)
                                       .u16(0)
                                       .u16(0)
                                       .u16(1)
                                       .u16(0)
                                       .u16(0)
                                       .u16(0)
                                       .u16(0)
                                       .u16(0)
                                       .u16(0)
                                       .u16(0)
                                       .u16(0)},
                          {"hmtx", hmtx},
                          {"cmap", cmap('A', 'F')},
                          {"loca", loca},
                          {"glyf", glyf},
                          {"COLR", colr(sweep)},
                          // two palettes of two entries, blue green red alpha
                          {"CPAL", Bytes()
                                       .u16(0)
                                       .u16(2)
                                       .u16(2)
                                       .u16(4)
                                       .u32(16)
                                       .u16(0)
                                       .u16(2)
                                       .u32(0x0000ffff)
                                       .u32(0xff0000ff)
                                       .u32(0x00ff0080)
                                       .u32(0x80808080)}};
  return assemble(tables);
}

} // namespace

std::vector<char> tinyFont() { return tinyFontWith(ofGlyph(tiny::kCorner, sweepGradient())); }

std::vector<char> tinyCompositeFont(uint32_t mode) {
  const Bytes source = ofGlyph(tiny::kCorner, solid(0, 0.75)), backdrop = ofGlyph(tiny::kSquare, solid(1, 1));
  return tinyFontWith(Bytes().u8(32).u24(8).u8(mode).u24(8 + source.size()).add(source).add(backdrop));
}

std::vector<char> tinyNestedFont() { return tinyFontWith(ofGlyph(tiny::kCorner, ofGlyph(tiny::kSquare, solid(0, 1)))); }

namespace {

/// A number of a charstring or DICT.
Bytes number(int value) { return Bytes().u8(28).i16(value); }
Bytes place(uint32_t offset) { return Bytes().u8(29).u32(offset); } // as long for each

/// An INDEX of CFF2.
Bytes indexOf(const std::vector<Bytes>& items) {
  Bytes out = Bytes().u32(static_cast<uint32_t>(items.size())), data;
  if (items.empty()) return out;
  out.u8(2);
  for (const Bytes& item : items) {
    out.u16(data.size() + 1);
    data.add(item);
  }
  return out.u16(data.size() + 1).add(data);
}

/// From the middle of the axis to its end, and to its beginning; items have a delta for each.
Bytes variationStore(const std::vector<std::array<int, 2>>& items) {
  Bytes out = Bytes().u16(1).u32(12).u16(1).u32(12 + 16);
  out.u16(1).u16(2).f2dot14(0).f2dot14(1).f2dot14(1).f2dot14(-1).f2dot14(-1).f2dot14(0);
  out.u16(static_cast<uint32_t>(items.size())).u16(items.empty() ? 0 : 2).u16(2).u16(0).u16(1);
  for (const auto& [more, less] : items) out.i16(more).i16(less);
  return out;
}

using Varied = std::array<int, 3>; // at the axis's middle, and what its end and its beginning add
/// Numbers that vary, and an operator that takes them.
Bytes varied(const std::vector<Varied>& values, uint32_t operation) {
  Bytes out, deltas;
  for (const auto& [value, more, less] : values) {
    out.add(number(value));
    deltas.add(number(more)).add(number(less));
  }
  return out.add(deltas).add(number(static_cast<int>(values.size()))).u8(16).u8(operation);
}

Bytes cff2() {
  constexpr uint32_t kMove = 21, kLine = 5, kCurve = 8;
  const Bytes pillar =
      Bytes()
          .add(varied({{100, 0, 0}, {0, 0, 0}}, kMove))
          .add(varied({{100, 200, -60}, {0, 0, 0}}, kLine))
          .add(varied({{0, 0, 0}, {700, 0, 0}}, kLine))
          .add(varied({{-25, -50, 15}, {100, 40, -20}, {-50, -100, 30}, {0, 0, 0}, {-25, -50, 15}, {-100, -40, 20}},
                      kCurve));
  const Bytes charstrings = indexOf({Bytes(), pillar}), globals = indexOf({}), store = variationStore({});
  const Bytes hints = number(80).u8(10); // a private DICT: the width of level stems
  constexpr uint32_t kHeader = 5, kTop = 3 * 5 + 4, kDict = 2 * 5 + 1, kArray = 4 + 1 + 2 * 2 + kDict;
  const uint32_t atStore = kHeader + kTop + globals.size(), atCharstrings = atStore + 2 + store.size(),
                 atArray = atCharstrings + charstrings.size();
  const Bytes top = place(atCharstrings).u8(17).add(place(atStore)).u8(24).add(place(atArray)).u8(12).u8(36);
  const Bytes dict = place(hints.size()).add(place(atArray + kArray)).u8(18);
  return Bytes()
      .u8(2)
      .u8(0)
      .u8(kHeader)
      .u16(top.size())
      .add(top)
      .add(globals)
      .u16(store.size())
      .add(store)
      .add(charstrings)
      .add(indexOf({dict}))
      .add(hints);
}

} // namespace

std::vector<char> tinyVariableFont() {
  const Table tables[] = {
      {"head", head()},
      {"hhea", hhea(2)},
      {"maxp", Bytes().u32(0x5000).u16(2)},
      {"hmtx", Bytes().u16(600).i16(0).u16(300).i16(100)},
      {"cmap", cmap('A', 'A')},
      {"fvar", Bytes()
                   .u32(0x10000)
                   .u16(16)
                   .u16(2)
                   .u16(1)
                   .u16(20)
                   .u16(0)
                   .u16(8)
                   .u32(HB_TAG('w', 'g', 'h', 't'))
                   .fixed(100)
                   .fixed(400)
                   .fixed(900)
                   .u16(0)
                   .u16(256)},
      {"HVAR", Bytes().u32(0x10000).u32(20).u32(0).u32(0).u32(0).add(variationStore({{0, 0}, {200, -60}}))},
      {"CFF2", cff2()}};
  return assemble(tables);
}

} // namespace gpgp::test
