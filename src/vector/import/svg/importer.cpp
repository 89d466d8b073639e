// The walk: structure, use, viewports, and each shape's fill and stroke as paths.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace gpgp::vector::svg {
namespace {

constexpr std::string_view kMarked[] = {"path", "line", "polyline", "polygon"}; ///< the shapes that have markers
/// Drawn only where something refers to them, or never.
constexpr std::string_view kSilent[] = {
    "defs",           "symbol",    "title",      "desc",          "metadata",     "style",  "stop",  "linearGradient",
    "radialGradient", "pattern",   "clipPath",   "mask",          "filter",       "marker", "view",  "cursor",
    "font",           "font-face", "solidColor", "color-profile", "meshgradient", "hatch",  "glyph", "missing-glyph"};

constexpr double kMaxReach = 1e7; // pixels

/// Whether a text has characters, or elements that can bring some.
bool hasText(pugi::xml_node node) {
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_element || !trim(child.value()).empty()) return true;
  return false;
}

} // namespace

/// No extension is known, and the reader's language is English.
bool isFor(pugi::xml_node node) {
  if (node.attribute("requiredExtensions")) return false;
  if (const pugi::xml_attribute features = node.attribute("requiredFeatures")) { // of SVG 1.1
    std::string_view rest = trim(features.value());
    if (rest.empty()) return false;
    for (; !rest.empty(); rest = trim(rest.substr(std::min(rest.find_first_of(" \t\r\n\f"), rest.size()))))
      if (!rest.starts_with("http://www.w3.org/TR/SVG") && !rest.starts_with("org.w3c.")) return false;
  }
  const pugi::xml_attribute languages = node.attribute("systemLanguage");
  for (std::string_view rest = languages.value(); !rest.empty();) {
    const size_t end = std::min(rest.find(','), rest.size());
    const std::string_view tag = trim(rest.substr(0, end));
    if (tag.substr(0, tag.find('-')) == "en") return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return !languages;
}

core::Result<Imported> importSvg(std::span<const std::byte> bytes, Reporter& reporter, const ImportLimits& limits,
                                 const ImageDecoder& images, const ImportDetail& detail, const GpgpFileSystem* files,
                                 const TextShaper& text) {
  Document document;
  if (auto ok = document.load(bytes); !ok) return ok.error();
  return Importer(document, reporter, limits, images, detail, files, text).run();
}

/// "<rect> has x 'wide', which is ".
std::string Importer::valueOf(pugi::xml_node node, std::string_view name, std::string_view value) const {
  return element(node) + " has " + std::string(name) + " '" + std::string(value.substr(0, 60)) + "', which is ";
}

std::string Importer::element(pugi::xml_node node) const {
  return std::string("<") + std::string(std::string_view(node.name()).substr(0, 40)) + ">";
}

void Importer::ignored(pugi::xml_node node, const Place& place, std::string_view name, std::string_view value) {
  const std::string text = valueOf(node, name, value);
  hasUnsupported(value) ? reporter_.warn(place, text + "not supported; ignored")
                        : reporter_.ignored(place, text + "not valid; ignored");
}

void Importer::noLength(pugi::xml_node node, const Place& place, std::string_view name, std::string_view value) {
  hasUnsupported(value) ? ignored(node, place, name, value)
                        : reporter_.error(place, valueOf(node, name, value) + "not a length");
}

AspectRatio Importer::aspectRatio(pugi::xml_node node) {
  const pugi::xml_attribute a = node.attribute("preserveAspectRatio");
  const std::optional<AspectRatio> ratio = parseAspectRatio(a.value());
  if (a && !ratio) ignored(node, a);
  return ratio.value_or(AspectRatio{});
}

void Importer::stop(pugi::xml_node node, const std::string& why) {
  if (!stopped_) reporter_.error(document_.place(node), why + "; the rest is not drawn", GPGP_ERROR_UNSUPPORTED);
  stopped_ = true;
}

bool Importer::stopped(pugi::xml_node node) {
  if (++elements_ > limits_.elements)
    stop(node, std::string("more than ") + std::to_string(limits_.elements) + " elements");
  return stopped_;
}

core::Result<Imported> Importer::run() {
  reportEverywhere();
  const State state = begin();
  const Place place = document_.place(document_.root());
  if (result_.width > kMaxReach || result_.height > kMaxReach)
    return core::makeError(GPGP_ERROR_INVALID_DATA, "%zu:%zu: <svg> is wider or taller than 10000000 pixels",
                           place.line, place.column);
  if (!empty_) visit(document_.root(), state);
  result_.paths.insert(result_.paths.end(), std::make_move_iterator(aside_.begin()),
                       std::make_move_iterator(aside_.end()));
  return std::move(result_);
}

std::optional<Importer::State> Importer::enter(pugi::xml_node node, const State& parent) {
  if (parent.depth >= limits_.depth) {
    reporter_.error(document_.place(node),
                    "elements are nested deeper than " + std::to_string(limits_.depth) + "; its contents are not drawn",
                    GPGP_ERROR_UNSUPPORTED);
    return std::nullopt;
  }
  State state = parent;
  state.style = parent.style.inherited();
  ++state.depth;
  cascade(node, parent.style, parent.lengths, state.style);
  return state.style.displayed ? std::optional(std::move(state)) : std::nullopt;
}

void Importer::visit(pugi::xml_node node, const State& parent, const double* useSize) {
  const std::string_view name = document_.name(node);
  if (name.empty() || stopped(node) || !isFor(node)) return;
  const bool isSymbol = name == "symbol" && useSize;
  if (oneOf(name, kSilent) && !isSymbol) return;
  std::optional<State> entered = enter(node, parent);
  if (!entered) return;
  State& state = *entered;
  const Affine around = state.transform;
  state.transform =
      around * transformOf(node, state.style, parent.lengths, [&] { return boxAround(node, name, state, around); });
  if (!state.transform.finite()) {
    reporter_.error(document_.place(node), element(node) + " has a transform beyond all numbers; not drawn");
    return;
  }
  if (mode_ == Mode::Clip && !oneOf(name, kShapes) && name != "use" && name != "text") {
    reporter_.ignored(document_.place(node), element(node) + " shows nothing inside a <clipPath>");
    return;
  }
  if (mode_ == Mode::Clip && !state.style.clipPath.empty()) {
    clipsInside_ = true;
    if (clipsApart_) clip(node, name, state, nullptr);
  }
  if (mode_ != Mode::Paint) return content(node, name, state, useSize);
  const bool isEmpty = oneOf(name, kShapes) ? shapeOf(node, name, state).empty() : name == "text" && !hasText(node);
  if (!state.style.filter.empty() && isEmpty) return; // not rendered
  const auto inside = [&](State& own) { content(node, name, own, useSize); };
  if ((name != "svg" && name != "symbol") || node == document_.root()) return grouped(node, name, state, inside);
  const std::optional<Viewport> viewport = viewportOf(node, state, useSize);
  if (!viewport) return;
  // Its clip, mask and filter are in its own coordinates, as browsers and resvg have it.
  const std::function<Box()> box = [&, own = state] { return boxAround(node, name, own, viewport->space, useSize); };
  const Frame frame{viewport->space, box};
  grouped(node, name, state, inside, &frame);
}

void Importer::content(pugi::xml_node node, std::string_view name, State& state, const double* useSize) {
  reportUnsupported(node, name, state.style);
  if (oneOf(name, kShapes)) {
    draw(node, name, state);
  } else if (name == "g" || name == "a" || name == "marker" || name == "pattern") {
    visitChildren(node, state);
  } else if (name == "svg" || name == "symbol") {
    visitViewport(node, state, useSize);
  } else if (name == "use") {
    visitUse(node, state);
  } else if (name == "image") {
    drawImage(node, state);
  } else if (name == "text" && text_.fn) {
    drawText(node, state);
  } else if (name == "switch") {
    visitSwitch(node, state);
  } else {
    reporter_.warn(document_.place(node), element(node) + " is not supported");
  }
}

void Importer::visitChildren(pugi::xml_node node, const State& state) {
  for (const pugi::xml_node child : node.children()) {
    if (stopped_) return;
    visit(child, state);
  }
}

void Importer::visitSwitch(pugi::xml_node node, const State& state) {
  for (const pugi::xml_node child : node.children()) {
    const std::string_view name = document_.name(child);
    constexpr std::string_view about[] = {"title", "desc", "metadata", "style"};
    if (name.empty() || oneOf(name, about) || !isFor(child)) continue;
    if (name != "foreignObject") return visit(child, state);
    reporter_.warn(document_.place(child), element(child) + " is not supported: <switch> shows what follows it");
  }
}

void Importer::visitUse(pugi::xml_node node, const State& state) {
  reportChildren(node);
  const pugi::xml_attribute href = hrefOf(node);
  const pugi::xml_node target = document_.find(trim(href.value()));
  const Place place = document_.place(node);
  const std::string shown = std::string("'") + std::string(href.value()).substr(0, 60) + "'";
  if (!target) {
    const bool outside = href && href.value()[0] != '#' && href.value()[0] != '\0';
    outside ? reporter_.warn(place, "<use> of another file, " + shown + ", is not supported")
            : reporter_.error(place, "<use> refers to " + shown + ", which does not exist");
    return;
  }
  bool inside = std::find(used_.begin(), used_.end(), target) != used_.end();
  for (pugi::xml_node up = node; up && !inside; up = up.parent()) inside = up == target;
  if (inside) {
    reporter_.error(place, "<use> of " + shown + " contains itself; not drawn");
    return;
  }
  const std::string_view kind = document_.name(target);
  if (oneOf(kind, kSilent) && kind != "symbol")
    return reporter_.ignored(place, "<use> refers to " + shown + ", a " + element(target) + ", which shows nothing");
  State moved = state;
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  const double x = length(node, state.style, "x", lengths, LengthAxis::X, 0),
               y = length(node, state.style, "y", lengths, LengthAxis::Y, 0);
  moved.transform = moved.transform * Affine{1, 0, 0, 1, x, y};
  constexpr double unset = -1;
  const double size[2] = {extent(node, {}, "width", lengths, LengthAxis::X, unset), // by no style sheet, as browsers do
                          extent(node, {}, "height", lengths, LengthAxis::Y, unset)};
  const Context context{&state, node, used_.size(), moved.transform};
  moved.context = &context;
  used_.push_back(target);
  visit(target, moved, size);
  used_.pop_back();
}

bool Importer::hasExtent(pugi::xml_node node, double width, double height, const std::optional<ViewBox>& box) {
  if (width > 0 && height > 0 && (!box || (box->width > 0 && box->height > 0))) return true;
  reporter_.ignored(document_.place(node), element(node) + " has a width, height or viewBox of zero; not drawn");
  return false;
}

std::optional<Importer::Viewport> Importer::viewportOf(pugi::xml_node node, const State& state, const double* useSize) {
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  const double x = length(node, state.style, "x", lengths, LengthAxis::X, 0),
               y = length(node, state.style, "y", lengths, LengthAxis::Y, 0);
  double w = extent(node, state.style, "width", lengths, LengthAxis::X, lengths.width);
  double h = extent(node, state.style, "height", lengths, LengthAxis::Y, lengths.height);
  if (useSize && useSize[0] >= 0) w = useSize[0];
  if (useSize && useSize[1] >= 0) h = useSize[1];
  const pugi::xml_attribute text = node.attribute("viewBox");
  const std::optional<ViewBox> box = parseViewBox(text.value());
  if (text && !box) ignored(node, text);
  if (!hasExtent(node, w, h, box)) return std::nullopt;
  Viewport viewport{state.transform * Affine{1, 0, 0, 1, x, y}, {}, w, h, state.lengths};
  viewport.lengths.width = w;
  viewport.lengths.height = h;
  Affine fit;
  if (box) {
    fit = fitViewBox(*box, w, h, aspectRatio(node));
    viewport.lengths.width = box->width;
    viewport.lengths.height = box->height;
  }
  if (document_.name(node) == "symbol" && (node.attribute("refX") || node.attribute("refY"))) { // (SVG 2, 5.5.2)
    const ViewBox whole = box.value_or(ViewBox{0, 0, w, h});
    const Point at = fit({referenceAlong(node, "refX", viewport.lengths, LengthAxis::X, whole.x, whole.width),
                          referenceAlong(node, "refY", viewport.lengths, LengthAxis::Y, whole.y, whole.height)});
    viewport.frame =
        viewport.frame * Affine{1, 0, 0, 1, node.attribute("refX") ? -at.x : 0, node.attribute("refY") ? -at.y : 0};
  }
  viewport.space = viewport.frame * fit;
  return viewport;
}

/// <svg> inside another, or <symbol>: its own coordinates, and a clip where something reaches beyond its edge.
void Importer::visitViewport(pugi::xml_node node, State& state, const double* useSize) {
  if (node == document_.root()) {
    if (mode_ == Mode::Paint) paintBackground(state);
    return visitChildren(node, state);
  }
  const std::optional<Viewport> viewport = viewportOf(node, state, useSize);
  if (!viewport) return;
  state.transform = viewport->space;
  state.lengths = viewport->lengths;
  if (mode_ != Mode::Paint || state.style.overflowVisible) return visitChildren(node, state);
  clipped(node, viewport->frame, viewport->width, viewport->height, state, [&] { visitChildren(node, state); });
}

void Importer::clipped(pugi::xml_node node, const Affine& frame, double w, double h, State& state,
                       const std::function<void()>& inside) {
  const size_t before = result_.paths.size();
  Shape edge = rectangle(0, 0, w, h, 0, 0, 1);
  for (Point& p : edge.points) p = frame(p);
  const bool clips = state.clips < shader::kMaxClipDepth &&
                     std::all_of(edge.points.begin(), edge.points.end(),
                                 [](const Point& p) { return std::fabs(p.x) <= 1e7 && std::fabs(p.y) <= 1e7; });
  if (clips) {
    std::vector<ImportedPath> paths;
    std::swap(paths, result_.paths);
    emit(edge, {}, GPGP_FILL_NON_ZERO, {}, 1, node);
    std::swap(paths, result_.paths);
    result_.groups.push_back({state.group, 1, true, std::move(paths)});
    state.group = static_cast<uint32_t>(result_.groups.size());
    ++state.clips;
  }
  const size_t inner = result_.groups.size();
  inside();
  for (size_t g = inner; g < result_.groups.size(); ++g) // what filters make reaches further than paths do
    if (clips && result_.groups[g].layer && !result_.groups[g].layer->steps.empty()) return;
  const double slack = 1e-3 * std::max(w, h), area = frame.a * frame.d - frame.b * frame.c;
  for (size_t i = before; i < result_.paths.size(); ++i)
    for (size_t k = 0; k + 1 < result_.paths[i].points.size(); k += 2) {
      const double px = result_.paths[i].points[k] - frame.e, py = result_.paths[i].points[k + 1] - frame.f;
      const double u = (frame.d * px - frame.c * py) / area, v = (frame.a * py - frame.b * px) / area;
      if (++steps_ > 8 * limits_.points) return;
      if (u >= -slack && v >= -slack && u <= w + slack && v <= h + slack) continue;
      if (!clips)
        reporter_.warn(document_.place(node),
                       element(node) + " is not clipped to its viewport; its content reaches beyond");
      return;
    }
  if (clips) { // nothing reaches beyond
    ImportedGroup& group = result_.groups[state.group - 1];
    group.clipped = false;
    group.clip.clear();
  }
}

void Importer::reportUnsupported(pugi::xml_node node, std::string_view name, const Style& style) {
  const bool isShape = oneOf(name, kShapes);
  const bool isFaint = style.opacity * style.fillOpacity * style.strokeOpacity < 1 || style.fill.color.a < 1;
  const struct {
    bool is;
    const char* what;
  } features[] = {{style.unsupportedEffect, "vector-effect other than non-scaling-stroke"},
                  {isShape && style.mixesLinear && isFaint, "color-interpolation linearRGB of a painted element"}};
  for (const auto& f : features)
    if (f.is)
      reporter_.warn(document_.place(node),
                     std::string(f.what) + " is not supported: " + element(node) + " is drawn without it");
}

/// Animations, mostly.
void Importer::reportChildren(pugi::xml_node node) {
  for (const pugi::xml_node child : node.children())
    if (const std::string_view inner = document_.name(child); !inner.empty() && !oneOf(inner, kSilent))
      reporter_.warn(document_.place(child), element(child) + " is not supported");
}

void Importer::draw(pugi::xml_node node, std::string_view name, const State& state) {
  reportChildren(node);
  const Style& style = state.style;
  if (!style.visible && mode_ != Mode::Measure) return;
  std::vector<size_t> silent;
  const Shape shape = shapeOf(node, name, state, &silent);
  if (shape.empty()) return;
  if (mode_ == Mode::Measure) return measure(shape, toBox_ * state.transform);
  group_ = state.group;
  if (mode_ == Mode::Clip) {
    if (shape.points.size() > 2) emit(shape, state.transform, style.clipRule, {}, 1, node);
    return;
  }
  const Surface surface{state, state.transform, [&shape] { return boxOf(shape); }};
  const auto fill = [&] {
    if (shape.points.size() < 3) return;
    const std::optional<Ink> ink = resolve(style.fill, surface, node, "fill");
    if (ink) emit(shape, state.transform, style.fillRule, *ink, style.fillOpacity * state.opacity, node);
  };
  for (const Style::Part part : style.paintOrder) {
    group_ = state.group;
    if (part == Style::Part::Fill) {
      fill();
    } else if (part == Style::Part::Stroke) {
      if (!(style.strokeWidth > 0)) continue;
      if (const auto ink = resolve(style.stroke, surface, node, "stroke")) stroke(shape, state, *ink, node);
    } else if (oneOf(name, kMarked)) {
      drawMarkers(node, shape, silent, state);
    }
  }
}

/// What a dash of length 1 is long: where the element says how long its path is, dashes are in such units.
double Importer::dashUnit(const Shape& shape, double otherwise, pugi::xml_node node) {
  const pugi::xml_attribute said = node.attribute("pathLength");
  if (!said) return otherwise;
  double length = 0;
  Scanner s(trim(said.value()));
  if (!s.number(length) || !s.done() || length < 0) {
    ignored(node, said);
    return otherwise;
  }
  return lengthOf(shape) / length;
}

void Importer::stroke(const Shape& shape, const State& state, const Ink& ink, pugi::xml_node node) {
  const Style& style = state.style;
  Affine transform = state.transform;
  Shape moved;
  if (style.nonScalingStroke) {
    moved = shape;
    for (Point& p : moved.points) p = transform(p);
    transform = Affine{};
  }
  const Shape& from = style.nonScalingStroke ? moved : shape;
  const double scale = transform.scale();
  if (!(scale > 0)) return;
  const double shown = style.nonScalingStroke ? 1 / detail_.scale : 1; // of its width and dashes
  // In its own space, so that an uneven transform bends the stroke as it should; what is out of reach is told below.
  for (const Point& p : from.points) {
    const Point q = transform(p);
    if (!(std::fabs(q.x) <= 1e7 && std::fabs(q.y) <= 1e7) || !(style.strokeWidth * shown * scale <= 2e7)) {
      reporter_.error(document_.place(node), element(node) + " reaches beyond 10000000 pixels; not drawn");
      return;
    }
  }
  std::vector<double> dashes = style.dashes;
  const double unit = dashes.empty() ? shown : dashUnit(from, shown, node); // of dashes
  for (double& d : dashes) d *= unit;
  if (!(unit > 0 && std::isfinite(unit))) dashes.clear();
  const StrokeStyle whole{style.strokeWidth * shown, style.cap, style.join, style.miterLimit, {}, 0};
  StrokeStyle s = whole;
  s.dashes = dashes;
  s.dashOffset = dashes.empty() ? 0 : style.dashOffset * unit;
  Shape area;
  const double tolerance = detail_.strokes / (scale * detail_.scale);
  const auto begin = std::chrono::steady_clock::now();
  bool done = strokeShape(from, s, tolerance, {}, area);
  if (!done && !s.dashes.empty()) {
    reporter_.error(document_.place(node),
                    element(node) + " has too many dashes (more than " + std::to_string(StrokeLimits{}.dashes) +
                        "); drawn without",
                    GPGP_ERROR_UNSUPPORTED);
    done = strokeShape(from, whole, tolerance, {}, area);
  }
  result_.strokeMilliseconds +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  if (!done) {
    reporter_.error(document_.place(node), element(node) + " has a stroke of too many points; not drawn",
                    GPGP_ERROR_UNSUPPORTED);
    return;
  }
  emit(area, transform, GPGP_FILL_NON_ZERO, ink, style.strokeOpacity * state.opacity, node);
}

void Importer::emit(const Shape& shape, const Affine& transform, GpgpFillRule rule, const Ink& ink, double opacity,
                    pugi::xml_node node) {
  if (ink.tiling) return emitTiles(shape, transform, rule, *ink.tiling, opacity, node);
  const Color& color = ink.color;
  const double alpha = color.a * opacity;
  if (shape.empty() || !(alpha > 0)) return;
  points_ += shape.points.size() + shape.verbs.size();
  if (points_ > limits_.points)
    return stop(node, std::string("more than ") + std::to_string(limits_.points) + " points");
  if (result_.paths.size() + aside_.size() >= limits_.paths)
    return stop(node, std::string("more than ") + std::to_string(limits_.paths) + " paths");
  ImportedPath path;
  path.points.reserve(2 * shape.points.size());
  for (const Point& p : shape.points) {
    const Point q = transform(p);
    if (!(std::fabs(q.x) <= 1e7 && std::fabs(q.y) <= 1e7)) {
      reporter_.error(document_.place(node), element(node) + " reaches beyond 10000000 pixels; not drawn");
      return;
    }
    path.points.push_back(static_cast<float>(q.x));
    path.points.push_back(static_cast<float>(q.y));
  }
  path.verbs.assign(shape.verbs.begin(), shape.verbs.end());
  path.rule = rule;
  path.gradient = ink.gradient;
  path.image = ink.image;
  path.place = document_.place(node);
  path.element = element(node);
  path.group = group_;
  const double linear[4] = {linearFromSrgb(color.r), linearFromSrgb(color.g), linearFromSrgb(color.b), alpha};
  for (size_t i = 0; i < 4; ++i) path.color[i] = static_cast<float>(std::clamp(linear[i], 0.0, 1.0));
  result_.paths.push_back(std::move(path));
}

} // namespace gpgp::vector::svg
