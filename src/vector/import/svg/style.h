// Presentation properties: what an element looks like, from its parent, its attributes and the style sheets.
#pragma once
#include "vector/geometry/stroke.h"
#include "vector/import/svg/scanner.h"
#include "vector/import/svg/values.h"

#include <gpgp/layers.h>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gpgp::vector::svg {

/// sRGB as files write it, 0 to 1, straight alpha.
struct Color {
  double r = 0, g = 0, b = 0, a = 1;
};
bool parseColor(std::string_view text, Color& color);
double linearFromSrgb(double value);
double srgbFromLinear(double value);

struct Paint {
  enum class Kind { None, Solid, Current, Reference, ContextFill, ContextStroke };
  Kind kind = Kind::None;
  Color color;
  std::string reference;      ///< "#id"
  Kind fallback = Kind::None; ///< of a reference that cannot be followed
  bool hasFallback = false;
};

struct TextStyle {
  // inherited
  std::string families, dominantBaseline;
  double weight = 400, stretch = 100, letterSpacing = 0, wordSpacing = 0;
  bool italic = false, smallCaps = false, unkerned = false, rightToLeft = false, vertical = false;
  double anchor = 0; ///< how much of a line lies before its place
  enum class Space { AsXml, Collapse, Preserve } space = Space::AsXml;
  static constexpr size_t kUndrawn = 18;
  std::array<bool, kUndrawn> undrawn{}; ///< asks for what textPropertiesUndrawn() lists
  // not inherited
  std::string baselineShift, alignmentBaseline, decoration;
  enum class Bidi { Normal, Embed, Override, Isolate, IsolateOverride, Plaintext } bidi = Bidi::Normal;
};

/// A property that would change how text looks and is not supported.
struct UndrawnProperty {
  std::string_view name;
  bool isInherited, isOfVerticalLines;
};
std::span<const UndrawnProperty, TextStyle::kUndrawn> textPropertiesUndrawn();

/// A part of the property filter (Filter Effects 1, chapter 5).
struct FilterFunction {
  enum class Kind {
    Reference,
    Blur,
    DropShadow,
    Brightness,
    Contrast,
    Grayscale,
    HueRotate,
    Invert,
    Opacity,
    Saturate,
    Sepia
  };
  Kind kind = Kind::Reference;
  std::string reference;      ///< "#id"; empty: what is no reference into this file
  double amount = 0;          ///< a standard deviation, an angle in radians, or a factor
  double x = 0, y = 0;        ///< a shadow's offset
  std::optional<Color> color; ///< a shadow's; none: that of the element
};

struct Style {
  // inherited
  Paint fill{Paint::Kind::Solid, {}, {}, Paint::Kind::None, false}, stroke;
  GpgpFillRule fillRule = GPGP_FILL_NON_ZERO, clipRule = GPGP_FILL_NON_ZERO;
  double fillOpacity = 1, strokeOpacity = 1, strokeWidth = 1, miterLimit = 4, dashOffset = 0;
  Cap cap = Cap::Butt;
  Join join = Join::Miter;
  std::vector<double> dashes;
  Color color;
  bool visible = true, mixesLinear = false; ///< the last: of its gradient's stops
  bool filtersLinear = true;
  double fontSize = 12; ///< where nothing says one, as librsvg and resvg have it
  enum class Part { Fill, Stroke, Markers };
  std::array<Part, 3> paintOrder{Part::Fill, Part::Stroke, Part::Markers};
  std::array<std::string, 3> markers; ///< at the start, in the middle, at the end: what they say, unless none
  TextStyle text;
  std::shared_ptr<const CustomProperties> variables;
  // not inherited
  double opacity = 1;
  bool displayed = true, nonScalingStroke = false, overflowVisible = false;
  struct StopColor {
    Color color;
    bool isCurrent = false; ///< whatever `color` of the stop says
  } stopColor;
  double stopOpacity = 1;
  std::string clipPath, mask; ///< what they say, unless none
  std::vector<FilterFunction> filter;
  GpgpBlendMode blend = GPGP_BLEND_NORMAL;
  bool isolated = false, masksByAlpha = false;
  StopColor floodColor, lightingColor{{1, 1, 1, 1}, false};
  double floodOpacity = 1;
  std::string transform, transformOrigin, translate, rotate, scale;
  bool byOwnBox = false; ///< transform-box
  bool isMoved() const { return !(transform.empty() && translate.empty() && rotate.empty() && scale.empty()); }
  /// x, y, r, d and others that style sheets may set in place of attributes; the last of a name counts.
  std::vector<std::pair<std::string, std::string>> geometry;
  const std::string* geometryOf(std::string_view name) const;
  struct Background {
    StopColor color{{0, 0, 0, 0}, false};
    bool hasImage = false;
  } background;                   ///< counts for the outermost element
  bool unsupportedEffect = false; ///< vector-effect asks for more than lines that do not scale

  /// What a child begins with.
  Style inherited() const;
};

/// A list of filter functions and references; false where it is malformed.
bool parseFilter(std::string_view text, const LengthContext& lengths, std::vector<FilterFunction>& functions);
/// A mode of mixing by its name in CSS.
bool parseBlendMode(std::string_view text, GpgpBlendMode& mode);

/// Whether an attribute of this name sets a property, supported or not, on every element.
bool isPresentationAttribute(std::string_view name);
/// Whether it is an attribute that style sheets may set as well (SVG 2, 2.5).
bool isGeometry(std::string_view name);
/// Whether it is a property that would change the picture, and is not supported.
bool isUnsupported(std::string_view name, std::string_view value);
/// The same of properties that count for the outermost element's box alone.
bool isUnsupportedOnRoot(std::string_view name, std::string_view value);

/// Whether a value that is not understood has functions or units of CSS that are not supported.
bool hasUnsupported(std::string_view value);

enum class Applied { Yes, Unknown, Invalid };
/// Sets one property. `parent` answers "inherit" and "unset". Lengths in the value use `lengths` (its font size is the
/// element's).
Applied applyProperty(Style& style, const Style& parent, std::string_view name, std::string_view value,
                      const LengthContext& lengths);

} // namespace gpgp::vector::svg
