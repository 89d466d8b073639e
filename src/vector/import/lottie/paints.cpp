// Fills, strokes, gradients and text.
#include "vector/import/lottie/evaluator.h"

#include <cmath>

namespace gpgp::vector::lottie {
namespace {
constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr const char* kFunction = "gpgpEvaluateLottie";

/// Stops of colours and of opacities, each ascending, as stops of both.
std::vector<GpgpGradientStop> stopsOf(const Gradient& gradient, double frame) {
  const std::vector<double> n = gradient.stops.at(frame);
  struct Stop {
    double offset, values[3];
  };
  std::vector<Stop> colors, alphas;
  const size_t count = std::min(gradient.colors ? gradient.colors : n.size() / 4, n.size() / 4);
  const auto sorted = [](std::vector<Stop>& stops) {
    std::stable_sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.offset < b.offset; });
  };
  for (size_t i = 0; i < count; ++i)
    colors.push_back({std::clamp(n[4 * i], 0.0, 1.0), {n[4 * i + 1], n[4 * i + 2], n[4 * i + 3]}});
  for (size_t i = 4 * count; i + 1 < n.size(); i += 2) alphas.push_back({std::clamp(n[i], 0.0, 1.0), {n[i + 1], 0, 0}});
  sorted(colors);
  sorted(alphas);
  std::vector<GpgpGradientStop> result;
  if (colors.empty()) return result;
  const auto at = [](const std::vector<Stop>& stops, double offset, size_t k, bool behind) {
    // Where several stops share a place, the first counts before it and the last behind it.
    size_t next = 0;
    while (next < stops.size() && (stops[next].offset < offset || (behind && stops[next].offset == offset))) ++next;
    if (next == 0) return stops[0].values[k];
    if (next == stops.size()) return stops.back().values[k];
    const Stop &a = stops[next - 1], &b = stops[next];
    return a.values[k] + (b.values[k] - a.values[k]) * (offset - a.offset) / (b.offset - a.offset);
  };
  std::vector<double> offsets;
  for (const std::vector<Stop>* list : {&colors, &alphas})
    for (const Stop& stop : *list) offsets.push_back(stop.offset);
  std::sort(offsets.begin(), offsets.end());
  offsets.erase(std::unique(offsets.begin(), offsets.end()), offsets.end());
  for (const double offset : offsets)
    for (const bool behind : {false, true}) {
      GpgpGradientStop stop{};
      stop.offset = static_cast<float>(offset);
      for (size_t k = 0; k < 3; ++k) stop.color[k] = linearOf(at(colors, offset, k, behind));
      stop.color[3] = alphas.empty() ? 1 : static_cast<float>(std::clamp(at(alphas, offset, 0, behind), 0.0, 1.0));
      if (behind && std::equal(std::begin(stop.color), std::end(stop.color), std::begin(result.back().color))) continue;
      result.push_back(stop);
    }
  return result;
}
Cap capOf(int cap) { return cap == 2 ? Cap::Round : cap == 3 ? Cap::Square : Cap::Butt; }
Join joinOf(int join) { return join == 2 ? Join::Round : join == 3 ? Join::Bevel : Join::Miter; }

/// Bytes of the character that begins a text.
size_t characterBytes(std::string_view text) {
  size_t n = 1;
  while (n < text.size() && (static_cast<unsigned char>(text[n]) & 0xc0) == 0x80) ++n;
  return n;
}
} // namespace

std::shared_ptr<const svg::Gradient> Evaluator::gradient(const Gradient& from, double frame, const Affine& map) {
  auto made = std::make_shared<svg::Gradient>();
  made->stops = stopsOf(from, frame);
  if (made->stops.empty() || !spend(made->stops.size())) return nullptr;
  GpgpGradient& g = made->gradient;
  const Point start = from.start.point(frame), end = from.end.point(frame);
  const double to[6] = {map.a, map.b, map.c, map.d, map.e, map.f};
  for (size_t i = 0; i < 6; ++i) g.transform[i] = static_cast<float>(to[i]);
  const auto put = [](float(&at)[2], Point p) {
    at[0] = static_cast<float>(std::clamp(p.x, -1e7, 1e7)), at[1] = static_cast<float>(std::clamp(p.y, -1e7, 1e7));
  };
  put(g.start, start);
  put(g.end, end);
  g.interpolateSrgb = VK_TRUE;
  if (from.radial) { // from the highlight to the circle around the start
    const double radius = std::min(std::hypot(end.x - start.x, end.y - start.y), 1e7);
    const double far = radius * std::clamp(from.highlight.number(frame) / 100, -0.99, 0.99);
    const double angle = std::atan2(end.y - start.y, end.x - start.x) + from.angle.number(frame) * kRadians;
    g.kind = GPGP_GRADIENT_RADIAL;
    put(g.start, {start.x + far * std::cos(angle), start.y + far * std::sin(angle)});
    put(g.end, start);
    g.endRadius = static_cast<float>(radius);
    if (!(radius > 0)) g.end[0] = std::nextafter(g.start[0] = g.end[0], 1e8f), g.kind = GPGP_GRADIENT_LINEAR;
  }
  g.stops = made->stops.data();
  g.stopCount = static_cast<uint32_t>(made->stops.size());
  return made;
}

void Evaluator::shapes(const std::vector<ShapeItem>& items, double frame, const Affine& map, const Scope& scope) {
  const std::function<bool(size_t)> spender = [this](size_t points) { return spend(points); };
  const PaintTree tree = paintsOf(items, frame, spender);
  nodes(tree, tree.nodes, frame, map, scope);
}

void Evaluator::nodes(const PaintTree& tree, const std::vector<PaintNode>& list, double frame, const Affine& map,
                      const Scope& scope) {
  for (size_t i = list.size(); i-- > 0 && !stopped_;) {
    const PaintNode& node = list[i];
    if (node.paint) {
      paint(tree, node, frame, map, scope);
      continue;
    }
    Scope inner = scope;
    const Mark before = mark();
    const uint32_t group = open(inner);
    if (++inner.effects > limits_.effects) { // as if nothing in there overlapped
      result_.groups[group - 1].opacity = 1;
      std::vector<PaintNode> faded = node.children;
      for (PaintNode& child : faded) child.opacity *= node.opacity;
      nodes(tree, faded, frame, map, scope);
      continue;
    }
    result_.groups[group - 1].opacity = static_cast<float>(node.opacity);
    nodes(tree, node.children, frame, map, inner);
    if (result_.paths.size() == before.paths) undo(before);
  }
}

void Evaluator::stroke(const Shape& shape, const StrokeStyle& style, const Affine& map, const Paint& paint,
                       double opacity, const Scope& scope) {
  const double scale = map.scale();
  if (shape.empty() || !(style.width > 0) || !(scale > 1e-9) || !(scale < 1e6) || !spend(shape.points.size())) return;
  for (const Point& p : shape.points)
    if (!(std::fabs(p.x) <= 1e7 && std::fabs(p.y) <= 1e7)) return;
  const double tolerance = std::max(0.05 / (scale * info_.scale), 1e-7 * style.width);
  StrokeLimits limits;
  limits.points = std::min(limits.points, limits_.points - std::min(points_, limits_.points));
  Shape area;
  bool done = strokeShape(shape, style, tolerance, limits, area);
  if (!done && !style.dashes.empty()) {
    reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                  "a stroke has more dashes than are drawn: it is solid", kFunction);
    StrokeStyle solid = style;
    solid.dashes = {};
    done = strokeShape(shape, solid, tolerance, limits, area);
  }
  if (!done) return limited("a stroke has too many points");
  emit(area, map, paint, opacity, scope);
}

void Evaluator::paint(const PaintTree& tree, const PaintNode& node, double frame, const Affine& map,
                      const Scope& scope) {
  const ShapeItem& item = *node.paint;
  const double opacity = node.opacity * std::clamp(item.opacity.number(frame, 100) / 100, 0.0, 1.0);
  const Affine space = map * node.map;
  if (!(opacity > 0) || !space.finite()) return;
  Paint paint;
  if (item.gradient) {
    paint.gradient = gradient(*item.gradient, frame, space);
    if (!paint.gradient) return;
  } else {
    std::vector<double> color = item.color.at(frame);
    color.resize(3);
    for (size_t i = 0; i < 3; ++i) paint.color[i] = linearOf(color[i]);
  }
  Shape shape;
  bool evenOdd = item.evenOdd;
  const bool isStroke = item.kind == ShapeKind::Stroke;
  const double turns = node.map.a * node.map.d - node.map.b * node.map.c;
  if (isStroke && !(std::fabs(turns) > 1e-12)) return; // seen from its edge
  const Affine back = isStroke ? inverseOf(node.map) : Affine{};
  for (const uint32_t id : node.entries) {
    const PathEntry& entry = tree.entries[id];
    evenOdd |= entry.evenOdd;
    for (const Contour& contour : entry.contours) {
      if (!spend(contour.vertices.size())) return;
      append(contour, isStroke ? back * entry.map : entry.map, shape);
    }
  }
  if (!isStroke) {
    paint.rule = evenOdd ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    return emit(shape, map, paint, opacity, scope);
  }
  StrokeStyle style;
  style.width = std::clamp(item.width.number(frame, 1), 0.0, 1e6);
  style.cap = capOf(item.cap);
  style.join = joinOf(item.join);
  style.miterLimit = std::clamp(item.miterLimit, 1.0, 1e4);
  std::vector<double> dashes;
  double sum = 0;
  for (const Dash& dash : item.dashes) {
    const double length = dash.length.number(frame);
    if (dash.kind == 'o')
      style.dashOffset = length;
    else
      dashes.push_back(std::max(length, 0.0)), sum += dashes.back();
  }
  if (dashes.size() % 2) {
    const std::vector<double> again = dashes;
    dashes.insert(dashes.end(), again.begin(), again.end());
  }
  if (sum > 0) style.dashes = dashes;
  stroke(shape, style, space, paint, opacity, scope);
}

void Evaluator::text(const Layer& l, double frame, const Affine& map, const Scope& scope) {
  const TextDocument* document = nullptr;
  for (const TextDocument& d : l.documents)
    if (!document || d.time <= frame) document = &d;
  if (!document || document->text.empty() || !(document->size > 0)) return;
  const auto font = std::find_if(animation_.fonts.begin(), animation_.fonts.end(),
                                 [&](const Font& f) { return f.name == document->font; });
  const std::string family = font != animation_.fonts.end() ? font->family : document->font;
  const std::string style = font != animation_.fonts.end() ? font->style : std::string();
  const double size = document->size, tracking = document->tracking / 1000 * size;

  struct Placed {
    Shape shape; ///< in its own space
    Affine map;  ///< to that of the line
  };
  struct Line {
    std::vector<Placed> glyphs;
    double width = 0;
  };
  const auto glyphOf = [&](std::string_view character) -> const Glyph* {
    const Glyph* other = nullptr;
    for (const Glyph& glyph : animation_.glyphs) {
      if (glyph.character != character || glyph.family != family) continue;
      if (glyph.style == style) return &glyph;
      other = &glyph;
    }
    return other;
  };
  bool missing = false;
  const auto ownLine = [&](std::string_view text) {
    Line line;
    for (size_t at = 0; at < text.size();) {
      const size_t bytes = characterBytes(text.substr(at));
      const Glyph* glyph = glyphOf(text.substr(at, bytes));
      at += bytes;
      if (!glyph) {
        missing = missing || text[at - bytes] != ' ';
        continue;
      }
      const double scale = size / 100; // of all glyphs, whatever size they say
      const std::function<bool(size_t)> spender = [this](size_t points) { return spend(points); };
      Placed placed;
      const PaintTree tree = paintsOf(glyph->shapes, 0, spender);
      for (const PathEntry& entry : tree.entries)
        for (const Contour& contour : entry.contours) append(contour, entry.map, placed.shape);
      placed.map = Affine{scale, 0, 0, scale, line.width, 0};
      line.width += glyph->width * scale + tracking;
      line.glyphs.push_back(std::move(placed));
    }
    line.width -= line.glyphs.empty() ? 0 : tracking;
    return line;
  };
  const auto shapedLine = [&](std::string_view text) {
    struct Taken {
      Line line;
      double units;
    } taken{{}, 0};
    const GpgpSvgTextSpan span{0,
                               static_cast<uint32_t>(text.size()),
                               family.c_str(),
                               "",
                               static_cast<float>(size),
                               static_cast<float>(font != animation_.fonts.end() ? font->weight : 400),
                               static_cast<float>(tracking),
                               font != animation_.fonts.end() && font->italic ? VK_TRUE : VK_FALSE,
                               VK_FALSE};
    const GpgpSvgText whole{text.data(), static_cast<uint32_t>(text.size()), &span, 1, VK_FALSE};
    const GpgpSvgGlyphFn take = [](void* userData, const GpgpSvgGlyph* glyph) {
      Taken& to = *static_cast<Taken*>(userData);
      const auto at = [](float v) { return static_cast<double>(v); };
      to.line.width = std::max(to.line.width, at(glyph->x) + at(glyph->advance));
      Placed placed;
      placed.map = Affine{at(glyph->size), 0, 0, at(glyph->size), at(glyph->x), at(glyph->y)};
      for (uint32_t i = 0; i < glyph->pathCount; ++i) {
        const GpgpPath& path = glyph->paths[i];
        for (uint32_t k = 0, verb = 0; verb < path.verbCount; ++verb) {
          const auto next = [&] {
            const Point p{at(path.points[2 * k]), at(path.points[2 * k + 1])};
            ++k;
            return p;
          };
          switch (path.verbs[verb]) {
          case GPGP_PATH_MOVE: placed.shape.move(next()); break;
          case GPGP_PATH_LINE: placed.shape.line(next()); break;
          case GPGP_PATH_QUAD: {
            const Point c = next();
            placed.shape.quad(c, next());
            break;
          }
          case GPGP_PATH_CUBIC: {
            const Point a = next(), b = next();
            placed.shape.cubic(a, b, next());
            break;
          }
          case GPGP_PATH_CLOSE: placed.shape.close(); break;
          default: return; // outlines have no arcs
          }
        }
      }
      to.line.glyphs.push_back(std::move(placed));
    };
    if (info_.text.fn(info_.text.userData, &whole, take, &taken) != GPGP_SUCCESS) missing = true;
    return taken.line;
  };
  const bool own = std::any_of(animation_.glyphs.begin(), animation_.glyphs.end(),
                               [&](const Glyph& glyph) { return glyph.family == family; });
  if (!own && !info_.text.fn)
    return reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                         "text in '" + family.substr(0, 40) + "', whose glyphs the file does not hold, is not drawn",
                         kFunction);
  const auto makeLine = [&](std::string_view line) {
    if (line.empty() || !spend(line.size())) return Line();
    return own ? ownLine(line) : shapedLine(line);
  };

  std::vector<Line> lines;
  std::string_view rest = document->text;
  while (lines.size() < 1000) {
    const size_t end = std::min(rest.find_first_of("\r\n\x03"), rest.size());
    std::string_view paragraph = rest.substr(0, end);
    while (document->box && !paragraph.empty()) { // as many words as fit, and one at least
      size_t fits = 0, next = 0;
      while (next < paragraph.size()) {
        const size_t word = std::min(paragraph.find(' ', next + 1), paragraph.size());
        if (fits && makeLine(paragraph.substr(0, word)).width > (*document->box)[2]) break;
        fits = next = word;
        if (stopped_) return;
      }
      if (fits >= paragraph.size() || lines.size() >= 1000) break;
      lines.push_back(makeLine(paragraph.substr(0, fits)));
      paragraph.remove_prefix(fits + (paragraph[fits] == ' ' ? 1 : 0));
    }
    lines.push_back(makeLine(paragraph));
    if (end >= rest.size()) break;
    rest.remove_prefix(end + (rest.substr(end, 2) == "\r\n" ? 2 : 1));
  }
  if (missing)
    reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {}, "some characters of a text have no glyphs",
                  kFunction);
  const double ascent = (font != animation_.fonts.end() ? font->ascent : 75) / 100 * size;
  double y = document->box ? (*document->box)[1] + ascent : 0;
  y -= document->baselineShift;
  Paint fill, outline;
  for (size_t i = 0; i < 3; ++i) {
    fill.color[i] = linearOf(document->fill[i]);
    outline.color[i] = linearOf(document->stroke[i]);
  }
  StrokeStyle stroked;
  stroked.width = std::clamp(document->strokeWidth, 0.0, 1e6);
  stroked.join = Join::Round;
  for (const Line& line : lines) {
    double x = document->justify == 1 ? -line.width : document->justify == 2 ? -line.width / 2 : 0;
    if (document->box)
      x = (*document->box)[0] + (document->justify == 1   ? (*document->box)[2] - line.width
                                 : document->justify == 2 ? ((*document->box)[2] - line.width) / 2
                                                          : 0);
    Shape whole;
    for (const Placed& glyph : line.glyphs) {
      const Affine to = Affine{1, 0, 0, 1, x, y} * glyph.map;
      if (!spend(glyph.shape.points.size())) return;
      whole.verbs.insert(whole.verbs.end(), glyph.shape.verbs.begin(), glyph.shape.verbs.end());
      for (const Point& p : glyph.shape.points) whole.points.push_back(to(p));
    }
    const auto drawStroke = [&] {
      if (document->hasStroke) stroke(whole, stroked, map, outline, 1, scope);
    };
    if (!document->strokeOver) drawStroke();
    if (document->hasFill) emit(whole, map, fill, 1, scope);
    if (document->strokeOver) drawStroke();
    y += document->lineHeight;
  }
}

} // namespace gpgp::vector::lottie
