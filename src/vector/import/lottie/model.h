// An animation as it is kept between frames: what the file says, checked and bounded.
#pragma once
#include "vector/import/lottie/property.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpgp::vector::lottie {

struct Transform {
  Property anchor, position, x, y, scale, rotation, opacity, skew, skewAxis;
  Property startOpacity, endOpacity; ///< of repeaters
  bool split = false;                ///< the position is x and y
};

enum class ShapeKind {
  Group,
  Path,
  Rectangle,
  Ellipse,
  Star,
  Fill,
  Stroke,
  Trim,
  Repeater,
  Round,
  Pucker,
  Twist,
  Zigzag,
  Merge
};

struct Gradient {
  bool radial = false;
  Property start, end, highlight, angle, stops;
  size_t colors = 0; ///< stops with a colour; those of opacity lie behind them
};

struct Dash {
  char kind; ///< 'd' a dash, 'g' a gap, 'o' the offset
  Property length;
};

/// One entry of a list of shapes. What its numbers mean depends on its kind.
struct ShapeItem {
  ShapeKind kind = ShapeKind::Group;
  bool backwards = false;       ///< a path that runs the other way round
  std::vector<ShapeItem> items; ///< Group
  Transform transform;          ///< Group, Repeater
  Property path;                ///< Path
  /// Rectangle, Ellipse: centre and size. Star: centre. Twist: its centre is `position`.
  Property position, size;
  /// Rectangle: radius. Round: radius. Pucker, Twist: amount. Zigzag: amplitude, ridges. Star: points, rotation, inner
  /// and outer radius, inner and outer roundness. Trim: start, end, offset. Repeater: copies, offset.
  Property numbers[6];
  int mode = 0; ///< Star: 2 is a polygon. Trim: 2 is one after another. Repeater: 2 is the last copy on top. Merge,
                ///< Zigzag: its own.
  Property color, opacity; ///< Fill, Stroke
  std::shared_ptr<const Gradient> gradient;
  bool evenOdd = false;
  Property width;
  int cap = 1, join = 1;
  double miterLimit = 4;
  std::vector<Dash> dashes;
};

struct Mask {
  char mode = 'a'; ///< add, subtract, intersect; lighten is add
  bool inverted = false;
  Property path, opacity, feather, expansion;
};

enum class EffectKind { Fill, Tint, DropShadow, Blur };
struct Effect {
  EffectKind kind = EffectKind::Fill;
  Property colors[2];
  Property numbers[4]; ///< Fill, Tint: amount. DropShadow: opacity, direction, distance, softness. Blur: amount, axes.
};

struct TextDocument {
  double time = 0;
  std::string text, font;
  double size = 10, lineHeight = 0, tracking = 0, baselineShift = 0, strokeWidth = 0;
  int justify = 0; ///< 1: to the right, 2: to the middle
  bool hasFill = false, hasStroke = false, strokeOver = true;
  double fill[3] = {}, stroke[3] = {};
  std::optional<std::array<double, 4>> box; ///< x, y, width, height
};

enum class LayerKind { Precomp, Solid, Image, Null, Shape, Text };

struct Layer {
  LayerKind kind = LayerKind::Null;
  std::optional<int64_t> index, parent; ///< as the file numbers them
  int64_t parentPlace = -1;             ///< of the parent in its composition; -1: none
  double in = 0, out = 0, start = 0, stretch = 1;
  bool hidden = false, autoOrient = false;
  Transform transform;
  int blend = 0; ///< GpgpBlendMode
  int matte = 0; ///< 1 alpha, 2 inverted alpha, 3 luma, 4 inverted luma; 0: none
  int64_t mattePlace = -1;
  bool isMatte = false; ///< shows as a matte only
  std::vector<Mask> masks;
  std::vector<Effect> effects;
  std::vector<ShapeItem> shapes;
  size_t asset = SIZE_MAX; ///< index of a composition or an image
  Property timeRemap;      ///< seconds
  double width = 0, height = 0;
  double color[3] = {};
  std::vector<TextDocument> documents;
};

struct Composition {
  std::vector<Layer> layers;
};
struct Image {
  double width = 0, height = 0;
  uint32_t index = UINT32_MAX; ///< as the engine knows it; UINT32_MAX: not there
};

struct Glyph {
  std::string character, style, family;
  double size = 100, width = 0;
  std::vector<ShapeItem> shapes;
};
struct Font {
  std::string name, family, style;
  double ascent = 75, weight = 400;
  bool italic = false;
};

struct Animation {
  double width = 0, height = 0, rate = 0, in = 0, out = 0;
  std::vector<Composition> compositions; ///< the first is the animation itself
  std::vector<Image> images;
  uint32_t imageCount = 0;
  std::vector<Glyph> glyphs;
  std::vector<Font> fonts;
  size_t layers = 0; ///< of all compositions
};

} // namespace gpgp::vector::lottie
