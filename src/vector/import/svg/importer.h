// The walk over the tree; one per import.
#pragma once
#include "vector/import/svg/document.h"
#include "vector/import/svg/import.h"
#include "vector/import/svg/style.h"
#include "vector/import/svg/stylesheet.h"
#include "vector/shared/layout.h"

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <unordered_map>

namespace gpgp::vector::svg {

struct ViewBox {
  double x = 0, y = 0, width = 0, height = 0;
};
/// Nothing where it is malformed or negative; sizes of zero mean that nothing is drawn (SVG 2, 8.6).
std::optional<ViewBox> parseViewBox(std::string_view text);
/// A preserveAspectRatio (SVG 2, 8.6); as it is made, what counts where there is none.
struct AspectRatio {
  double alignX = 0.5, alignY = 0.5; ///< how much of the room that is left lies before the box
  bool uniform = true;               ///< false: the box is stretched
  bool slice = false;                ///< the box covers the viewport instead of lying in it
};
std::optional<AspectRatio> parseAspectRatio(std::string_view text);
/// The map from a viewBox that is not empty into a viewport of the given size (SVG 2, 8.2).
Affine fitViewBox(const ViewBox& box, double width, double height, const AspectRatio& ratio);

/// The smallest box around a shape's curves.
struct Box {
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  void add(Point p);
};
Box boxOf(const Shape& shape);
/// Whether an element's conditions hold (SVG 2, 5.7).
bool isFor(pugi::xml_node node);
/// Zeros where there is none.
Affine inverseOf(const Affine& m);

/// "#id" of url(#id), with or without quotes; empty where it is something else.
std::string referenceOf(std::string_view text);

inline constexpr std::string_view kShapes[] = {"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"};
inline constexpr std::string_view kGradients[] = {"linearGradient", "radialGradient"};

class Importer {
public:
  Importer(const Document& document, Reporter& reporter, const ImportLimits& limits, const ImageDecoder& images,
           const ImportDetail& detail, const GpgpFileSystem* files, const TextShaper& text)
      : document_(document), reporter_(reporter), limits_(limits), images_(images), detail_(detail), files_(files),
        text_(text) {}
  core::Result<Imported> run();
  PageSize pageSize();

private:
  /// What an element gets from above.
  struct Context;
  struct State {
    Style style;
    Affine transform;
    LengthContext lengths; ///< of the nearest viewport
    double opacity = 1;    ///< of groups around that could not be one
    size_t depth = 0;
    const Context* context = nullptr; ///< the innermost <use> around, whose paints context-fill and -stroke are
    uint32_t group = 0;               ///< 1 + index in the result
    uint32_t fading = 0, clips = 0, layers = 0; ///< groups around that fade, that clip, and layers
  };
  /// By what an element's effects are measured.
  struct Frame {
    const Affine& space; ///< from the element's coordinates
    const std::function<Box()>& box;
  };

  /// A <use>, or a shape with markers, that is being shown.
  struct Context {
    const State* state = nullptr; ///< lives as long as it is shown
    pugi::xml_node node;
    size_t used = 0; ///< how many were being shown before
    Affine space;    ///< from its own coordinates
    mutable std::optional<Box> box{};
  };
  /// What a paint goes onto.
  struct Surface {
    const State& state;
    Affine space; ///< from its coordinates
    std::function<Box()> box;
  };

  // page.cpp
  /// The style sheets, and the root's page with what is measured by it.
  State begin();
  void paintBackground(const State& state);
  /// Of what has an effect wherever it stands, also where nothing is drawn from.
  void reportEverywhere();

  // sheets.cpp
  /// Reads all style sheets: those that instructions name, then elements in the file's order.
  void readSheets();
  /// Whether a style sheet's media are ours; what cannot be told is said.
  bool isForScreen(std::string_view media, const Place& place, const std::string& who);
  void readStyleElement(pugi::xml_node node, const Place& place, std::string_view name);
  /// Why a file is not read: what it does; else it was.
  struct Read {
    const char* why = nullptr;
    bool isInvalid = false, isTooLarge = false, isRefused = false; ///< the last: it is not wanted
  };
  /// Reads a file that lies in the drawing's folder or below it, by its name relative to `folder`.
  Read readBeside(std::string_view href, std::string_view folder, size_t limit, std::string& path, std::string& bytes,
                  const std::function<bool()>& isWanted = {});
  /// Reads a sheet of another file, whose name is relative to the folder of the one that refers to it.
  void readSheet(std::string_view href, std::string_view folder, const Place& place, size_t depth);
  void parseSheet(std::string_view text, std::string_view folder, const Place& place, size_t depth);

  // importer.cpp
  /// The state inside an element, with its style; nothing where it is not displayed, or nested too deep, which is said.
  std::optional<State> enter(pugi::xml_node node, const State& parent);
  void visit(pugi::xml_node node, const State& parent, const double* useSize = nullptr);
  void visitChildren(pugi::xml_node node, const State& state);
  void visitUse(pugi::xml_node node, const State& state);
  void visitSwitch(pugi::xml_node node, const State& state);
  void visitViewport(pugi::xml_node node, State& state, const double* useSize);
  struct Viewport {
    Affine frame;         ///< from its rectangle, which begins at the origin
    Affine space;         ///< from its own coordinates
    double width, height; ///< of the rectangle
    LengthContext lengths;
  };
  /// Of an <svg> inside another or a <symbol>; nothing where it has no extent.
  std::optional<Viewport> viewportOf(pugi::xml_node node, const State& state, const double* useSize);
  /// False where a size of zero keeps the element from being drawn, which is said.
  bool hasExtent(pugi::xml_node node, double width, double height, const std::optional<ViewBox>& box);
  /// What is inside of an element whose own properties are in the state.
  void content(pugi::xml_node node, std::string_view name, State& state, const double* useSize = nullptr);
  void reportChildren(pugi::xml_node node);
  void draw(pugi::xml_node node, std::string_view name, const State& state);
  /// Draws what `inside` draws, clipped to (0, 0, width, height) of the coordinates `frame` where it reaches beyond.
  void clipped(pugi::xml_node node, const Affine& frame, double width, double height, State& state,
               const std::function<void()>& inside);

  // marker.cpp
  struct Marker;
  /// False where there is none to draw; what is wrong is said.
  bool readMarker(const std::string& value, pugi::xml_node node, const State& state, Marker& marker);
  /// refX or refY of a marker or symbol, where its box begins and how large it is.
  double referenceAlong(pugi::xml_node node, const char* name, const LengthContext& lengths, LengthAxis axis,
                        double from, double size);
  /// `silent`: the verbs that end where the shape has no vertex.
  void drawMarkers(pugi::xml_node node, const Shape& shape, const std::vector<size_t>& silent, const State& state);

  // clip.cpp
  /// Puts what the element refers to around it; says so where that cannot be.
  void clip(pugi::xml_node node, std::string_view name, State& state, const Frame* of);
  /// What a clipPath or mask and all that is inside refer to by the property.
  const std::vector<pugi::xml_node>& referencesIn(pugi::xml_node from, std::string Style::*property,
                                                  const LengthContext& lengths);
  /// Whether a clipPath or mask leads back, by the property, to one that is being shown.
  bool refersBack(pugi::xml_node from, std::string Style::*property, const LengthContext& lengths);
  /// Of an element that others refer to: what it has from where it stands, not from them.
  Style styleOf(pugi::xml_node node, const LengthContext& lengths);
  /// Of all shapes inside, strokes and clips aside, in coordinates given by their transform to the page.
  Box boxAround(pugi::xml_node node, std::string_view name, State state, const Affine& space,
                const double* useSize = nullptr);
  void measure(const Shape& shape, const Affine& transform);
  /// A pattern for one surface.
  struct Tiling {
    pugi::xml_node node, content; ///< the pattern, and the one along its references that has elements
    State state;                  ///< of what is in the tile at its origin
    Affine space{};               ///< from coordinates in which that tile's corner is the origin
    double width = 0, height = 0; ///< of a tile
  };
  /// What a paint property comes to.
  struct Ink {
    Color color;
    std::shared_ptr<const Gradient> gradient;
    std::shared_ptr<const GpgpImagePaint> image = nullptr;
    std::shared_ptr<const Tiling> tiling = nullptr;
  };
  void emit(const Shape& shape, const Affine& transform, GpgpFillRule rule, const Ink& ink, double opacity,
            pugi::xml_node node);
  double dashUnit(const Shape& shape, double otherwise, pugi::xml_node node);
  void stroke(const Shape& shape, const State& state, const Ink& ink, pugi::xml_node node);
  void reportUnsupported(pugi::xml_node node, std::string_view name, const Style& style);
  bool stopped(pugi::xml_node node);
  void stop(pugi::xml_node node, const std::string& why);

  // text.cpp
  struct Text;
  /// What of a text's style is not drawn, unless `above`, which it stands in, asks for it as well.
  void reportUndrawn(pugi::xml_node node, const Style& style, const Style* above);
  void drawText(pugi::xml_node node, const State& state);
  void collectText(pugi::xml_node node, const State& state, bool preserves, Text& text);
  void placeText(Text& text);
  void shapeLine(Text& text, size_t first, size_t last);
  void paintText(Text& text);

  // image.cpp
  struct Picture { // that was decoded; width 0: it could not be
    uint32_t index = 0, width = 0, height = 0;
    const char* format = nullptr;                      ///< of one that is not decoded
    const char* why = nullptr;                         ///< of a file that is not read
    std::shared_ptr<const Document> drawing = nullptr; ///< instead of a picture
  };
  const Picture* pictureOf(pugi::xml_node node);
  /// Of a bitmap glyph; nothing where no one decodes it.
  const Picture* pictureOfGlyph(const GpgpSvgGlyph& glyph);
  /// A part of the unit square, which the picture fills. `map`: from there to the state's coordinates.
  void emitPicture(const Shape& shape, const State& state, const Affine& map, const Picture& picture,
                   pugi::xml_node node);
  void drawImage(pugi::xml_node node, const State& state);
  /// The node's picture where it lies: x, y, width, height. What cannot be drawn is said.
  void drawPicture(pugi::xml_node node, const State& state, const ViewBox& place);
  /// The same of an SVG.
  void drawDrawing(pugi::xml_node node, const State& state, const ViewBox& place, const Document& drawing);
  /// What is made, and counted against the limits, goes over to another importer, and back.
  void exchange(Importer& other);

  // shapes.cpp
  /// `silent` receives the verbs of a path that end where it has no vertex.
  Shape shapeOf(pugi::xml_node node, std::string_view name, const State& state, std::vector<size_t>* silent = nullptr);
  /// A length of an element: as style sheets say, else its attribute.
  double length(pugi::xml_node node, const Style& style, const char* name, const LengthContext& lengths,
                LengthAxis axis, double otherwise, bool* given = nullptr);
  /// The same of a width or height, which is said and does not count where it is negative.
  double extent(pugi::xml_node node, const Style& style, const char* name, const LengthContext& lengths,
                LengthAxis axis, double otherwise, bool* given = nullptr, std::optional<double> negative = {});

  // cascade.cpp
  void cascade(pugi::xml_node node, const Style& parent, const LengthContext& lengths, Style& style);
  /// What the properties that transform come to. `box`: the element's own, for transform-box.
  Affine transformOf(pugi::xml_node node, const Style& style, const LengthContext& lengths,
                     const std::function<Box()>& box = {});
  void badTransform(pugi::xml_node node, const Place& place, std::string_view name, std::string_view value);
  std::optional<Ink> resolve(const Paint& paint, const Surface& surface, pugi::xml_node node, const char* property);
  Box boxOfContext(const Context& context);

  // gradient.cpp
  /// A gradient, pattern or filter, the one it refers to, and so on.
  struct GradientChain {
    std::vector<pugi::xml_node> gradients;
    std::string_view otherFile; ///< which the last refers to
  };
  const GradientChain& chainOf(pugi::xml_node gradient);
  pugi::xml_attribute gradientAttribute(const GradientChain& chain, const char* name) const;
  std::vector<GpgpGradientStop> gradientStops(const GradientChain& chain, const LengthContext& lengths);

  // layer.cpp
  /// Draws what `inside` draws with the state's clip path, mask, filter, opacity and mode of mixing around it. Those of
  /// a mask are measured by what it masks.
  void grouped(pugi::xml_node node, std::string_view name, State& state, const std::function<void(State&)>& inside,
               const Frame* of = nullptr);
  /// x, y, width and height of a mask or filter; nothing where it has no extent.
  std::optional<Box> effectRegion(const GradientChain& chain, const char* unitsName, const State& state,
                                  const std::function<Box()>& box);
  /// From the coordinates in which an element's effects are given.
  Affine spaceOf(pugi::xml_node node, std::string_view name, const State& state);
  Box boxOfElement(pugi::xml_node node, std::string_view name, const State& state, const Affine& space);
  /// Puts what `show` draws into a group that is shown only where something refers to it: 1 + index; 0: it is empty.
  uint32_t aside(State inner, const std::function<void(State&)>& show);
  /// What a mask property refers to; what is wrong is said.
  pugi::xml_node maskOf(pugi::xml_node from, const State& state);
  /// False where nothing is shown through it.
  bool mask(pugi::xml_node target, pugi::xml_node node, const State& state, const Affine& space,
            const std::function<Box()>& box, ImportedLayer& layer);
  /// Around what was drawn since, effects included.
  Box drawnBox(size_t firstPath, size_t firstGroup, const Affine& back) const;

  // filter.cpp, primitives.cpp
  struct FilterReader;
  /// What counts of the state's filter; what is wrong is said.
  std::vector<FilterFunction> filtersOf(pugi::xml_node node, const State& state);

  // pattern.cpp
  /// The pattern along references that has elements; nothing where none has.
  static pugi::xml_node contentOf(const GradientChain& chain);
  /// Nothing where its tiles have no extent, or there is no box to measure them by.
  std::shared_ptr<const Tiling> tilingOf(const GradientChain& chain, const Surface& surface);
  void emitTiles(const Shape& shape, const Affine& transform, GpgpFillRule rule, const Tiling& tiling, double opacity,
                 pugi::xml_node node);

  /// Nothing where it has no stops, or no box to be measured by.
  std::shared_ptr<const Gradient> gradientOf(const GradientChain& chain, bool radial, const Surface& surface);

  std::string element(pugi::xml_node node) const;
  std::string valueOf(pugi::xml_node node, std::string_view name, std::string_view value) const;
  /// Says that a value does not count, for it is not valid, or not supported.
  void ignored(pugi::xml_node node, const Place& place, std::string_view name, std::string_view value);
  void ignored(pugi::xml_node node, pugi::xml_attribute attribute) {
    ignored(node, document_.place(attribute, 0), attribute.name(), attribute.value());
  }
  /// What is no length.
  void noLength(pugi::xml_node node, const Place& place, std::string_view name, std::string_view value);
  /// The node's preserveAspectRatio; one that is not valid is named and does not count.
  AspectRatio aspectRatio(pugi::xml_node node);

  const Document& document_;
  Reporter& reporter_;
  const ImportLimits& limits_;
  const ImageDecoder& images_;
  const ImportDetail& detail_;
  std::unordered_map<std::string_view, Picture> pictures_; // by href
  std::map<std::vector<uint8_t>, Picture> glyphPictures_;  // by their files
  uint32_t pictureCount_ = 0;
  StyleSheet sheet_;
  const GpgpFileSystem* files_;
  const TextShaper text_;
  std::deque<std::string> sheetNames_;  // which places of messages refer to
  std::vector<std::string> openSheets_; // paths, each imported by the one before
  size_t sheetCount_ = 0, sheetBytes_ = 0;
  std::unordered_map<size_t, GradientChain> chains_;                          // by their first
  std::map<std::pair<size_t, bool>, std::vector<pugi::xml_node>> references_; // by element; true: to masks
  Imported result_;
  std::vector<pugi::xml_node> used_; // the <use> targets we are inside of
  size_t elements_ = 0, points_ = 0, work_ = 0, steps_ = 0;
  std::vector<ImportedPath> aside_; // of groups that masks and filters refer to
  size_t imageBytes_ = 0;           // of other files
  size_t layerCount_ = 0, blendCount_ = 0, filterSteps_ = 0, filterNumbers_ = 0;
  bool mayBlend_ = false;   // something speaks of modes of mixing
  bool sharesClips_ = true; // neighbours may share one: there are no layers, whose paths lie in a row
  bool clipsInside_ = false, clipsApart_ = false; // shapes of a clip have clips; they are drawn with them
  size_t depthOfDrawings_ = 0;                    ///< images that are drawings, around this one
  bool stopped_ = false, empty_ = false;          ///< the last: the root has a size of zero
  enum class Mode {
    Paint,
    Clip,   // shapes alone count
    Measure // so do their boxes
  };
  Mode mode_ = Mode::Paint;
  Box box_; // of what was measured
  Affine toBox_;
  Affine toPage_;                            ///< from the outermost element's coordinates
  std::unordered_map<size_t, Style> styles_; // of what is referred to
  struct MadeClip {
    Affine transform;
    double width = 0, height = 0; // of the viewport
    uint32_t parent = 0, group = 0;
    bool operator==(const MadeClip&) const = default;
  };
  std::unordered_map<size_t, MadeClip> madeClips_; // of each clipPath the last
  uint32_t group_ = 0;                             // of what is emitted
};

} // namespace gpgp::vector::svg
