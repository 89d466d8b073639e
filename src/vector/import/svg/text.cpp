// Text (SVG 2, chapter 11) as outlines: characters with their places, lines that whoever compiles shapes in fonts, and
// glyphs as the shapes of the element that they stand in.
#include "vector/import/svg/importer.h"
#include "vector/import/svg/track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {

constexpr size_t kMaxCharacters = 100'000, kMaxLine = 20'000;

/// How far glyphs of a font go down for the baseline that is asked for, in em.
double baselineOffset(std::string_view baseline, const GpgpSvgGlyph& g) {
  const auto em = [](float v) { return static_cast<double>(v); };
  if (baseline == "middle") return (g.xHeight > 0 ? em(g.xHeight) : 0.5) / 2;
  if (baseline == "central") return (em(g.ascent) - em(g.descent)) / 2;
  if (baseline == "hanging") return em(g.ascent) * 0.8;
  if (baseline == "mathematical") return em(g.ascent) * 0.5;
  if (baseline == "text-before-edge" || baseline == "before-edge" || baseline == "text-top" || baseline == "top")
    return em(g.ascent);
  if (baseline == "text-after-edge" || baseline == "after-edge" || baseline == "text-bottom" || baseline == "bottom" ||
      baseline == "ideographic")
    return -em(g.descent);
  return 0;
}

Shape shapeOfGlyph(const GpgpPath& path) {
  Shape shape;
  const float* p = path.points;
  const auto next = [&p] {
    const Point point{static_cast<double>(p[0]), static_cast<double>(p[1])};
    p += 2;
    return point;
  };
  for (uint32_t i = 0; i < path.verbCount; ++i) switch (path.verbs[i]) {
    case GPGP_PATH_MOVE: shape.move(next()); break;
    case GPGP_PATH_LINE: shape.line(next()); break;
    case GPGP_PATH_QUAD: {
      const Point c = next();
      shape.quad(c, next());
      break;
    }
    case GPGP_PATH_CUBIC: {
      const Point a = next(), b = next();
      shape.cubic(a, b, next());
      break;
    }
    default: shape.close(); break;
    }
  return shape;
}

void append(Shape& to, const Shape& from, const Affine& map) {
  to.verbs.insert(to.verbs.end(), from.verbs.begin(), from.verbs.end());
  for (const Point& p : from.points) to.points.push_back(map(p));
}

} // namespace

struct Importer::Text {
  struct Decoration {
    std::string kinds; ///< of text-decoration
    size_t run;        ///< whose paints it has
  };
  struct Run { // an element's own characters
    State state;
    pugi::xml_node node;
    std::string language;
    double shift = 0; ///< of its baseline, up
    size_t track = 0; ///< 1 + index
    std::vector<Decoration> decorations;
  };
  struct Element { // with what it says of its characters
    pugi::xml_node node;
    State state;
    size_t first = 0, last = 0; ///< its characters
  };
  struct Character {
    size_t offset = 0, run = 0;
    std::optional<double> x, y;
    double dx = 0, dy = 0, rotate = 0;
  };
  struct Part { // of a glyph
    Shape shape;
    bool isForeground = true;
    Color color;
  };
  struct Glyph {
    size_t character = 0;
    Affine map; ///< from em
    Point at;   ///< where it begins on its baseline
    double advance = 0, angle = 0, size = 0;
    bool hidden = false; ///< beyond a track's ends
    GpgpSvgGlyph metrics{};
    std::vector<Part> parts;
  };
  pugi::xml_node node;
  std::string bytes;
  std::vector<Run> runs;
  std::vector<Element> elements;
  std::vector<Character> characters;
  std::vector<Track> tracks;
  std::vector<Glyph> glyphs;
  Box box; ///< of all glyphs' cells
  bool afterSpace = true;
  Point at; ///< the current text position
};

/// Appends what an element holds, and what is in it.
void Importer::collectText(pugi::xml_node node, const State& state, bool preserves, Text& text) {
  using Space = TextStyle::Space;
  const std::string_view xmlSpace = node.attribute("xml:space").value();
  if (!xmlSpace.empty()) preserves = xmlSpace == "preserve";
  const bool keeps = state.style.text.space == Space::AsXml ? preserves : state.style.text.space == Space::Preserve;
  const size_t own = text.runs.size(), element = text.elements.size();
  text.runs.back().state = state;
  text.elements.push_back({node, state, text.characters.size(), 0});
  size_t run = own - 1;
  const Text::Run kept = text.runs[run];
  for (const pugi::xml_node child : node.children()) {
    if (stopped_) break;
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
      if (run != text.runs.size() - 1) text.runs.push_back(kept), run = text.runs.size() - 1;
      const std::string_view value = child.value();
      for (size_t i = 0; i < value.size(); ++i) {
        const char c = value[i];
        const bool isSpace = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        if (isSpace && !keeps && text.afterSpace) continue;
        if ((c & 0xc0) != 0x80) {
          if (text.characters.size() >= kMaxCharacters) return stop(node, "more than 100000 characters of text");
          Text::Character character;
          character.offset = text.bytes.size();
          character.run = run;
          text.characters.push_back(character);
        }
        text.bytes += isSpace ? ' ' : c;
        text.afterSpace = isSpace && !keeps;
      }
      continue;
    }
    const std::string_view name = document_.name(child);
    constexpr std::string_view silent[] = {"title",        "desc",          "metadata",         "animate", "set",
                                           "animateColor", "animateMotion", "animateTransform", "script"};
    if (name.empty() || oneOf(name, silent) || stopped(child)) continue;
    if (name != "tspan" && name != "a" && name != "textPath") {
      reporter_.warn(document_.place(child), this->element(child) + " is not supported");
      continue;
    }
    std::optional<State> entered = enter(child, state);
    if (!entered || !isFor(child)) continue;
    State& inner = *entered;
    inner.opacity *= inner.style.opacity;
    reportUnsupported(child, name, inner.style);
    const struct {
      bool is;
      const char* what;
    } effects[] = {{!inner.style.clipPath.empty(), "clip-path"},
                   {!inner.style.mask.empty(), "mask"},
                   {!inner.style.filter.empty(), "filter"},
                   {inner.style.blend != GPGP_BLEND_NORMAL, "mix-blend-mode"}};
    for (const auto& effect : effects)
      if (effect.is)
        reporter_.warn(document_.place(child), std::string(effect.what) + " of a part of text is not supported: " +
                                                   this->element(child) + " is drawn without it");
    Text::Run next = kept;
    next.node = child;
    if (const pugi::xml_attribute language = child.attribute("xml:lang")) next.language = language.value();
    const std::string& shift = inner.style.text.baselineShift;
    LengthContext lengths = inner.lengths;
    lengths.width = lengths.height = lengths.fontSize = state.style.fontSize;
    double length = 0;
    if (shift == "sub")
      next.shift -= 0.2 * state.style.fontSize;
    else if (shift == "super")
      next.shift += 0.4 * state.style.fontSize;
    else if (!shift.empty() && shift != "baseline" && parseLength(shift, lengths, LengthAxis::X, length))
      next.shift += length;
    if (name == "textPath") {
      const std::string_view href = trim(hrefOf(child).value());
      const pugi::xml_node target = document_.find(href);
      const std::string_view kind = target ? document_.name(target) : std::string_view();
      if (!oneOf(kind, kShapes)) {
        reporter_.ignored(document_.place(child), "<textPath> refers to '" + std::string(href.substr(0, 60)) +
                                                      "', which is no shape of this file; it is not drawn");
        continue;
      }
      for (const char* unsupported : {"side", "method", "path"})
        if (const std::string_view value = trim(child.attribute(unsupported).value());
            !value.empty() && value != "left" && value != "align")
          reporter_.warn(document_.place(child), std::string(unsupported) + " is not supported: <textPath> is drawn "
                                                                            "without it");
      State shown = inner;
      shown.style = styleOf(target, inner.lengths);
      Shape shape = shapeOf(target, kind, shown);
      const Affine map = transformOf(target, shown.style, inner.lengths);
      for (Point& p : shape.points) p = map(p);
      Track track = trackOf(shape);
      LengthContext along = inner.lengths;
      along.fontSize = inner.style.fontSize;
      along.width = track.length();
      const pugi::xml_attribute start = child.attribute("startOffset");
      if (start && !parseLength(start.value(), along, LengthAxis::X, track.offset))
        noLength(child, document_.place(start, 0), "startOffset", start.value());
      if (start && std::string_view(start.value()).find('%') == std::string_view::npos)
        track.offset *= dashUnit(shape, 1, target);
      text.tracks.push_back(std::move(track));
      next.track = text.tracks.size();
    }
    text.runs.push_back(std::move(next));
    const std::string& decoration = inner.style.text.decoration;
    if (!decoration.empty() && decoration != "none")
      text.runs.back().decorations.push_back({decoration, text.runs.size() - 1});
    collectText(child, inner, keeps, text);
  }
  text.elements[element].last = text.characters.size();
}

/// Gives the characters what elements say of their places; what is further in counts (SVG 2, 11.10.1).
void Importer::placeText(Text& text) {
  for (const Text::Element& e : text.elements) {
    LengthContext lengths = e.state.lengths;
    lengths.fontSize = e.state.style.fontSize;
    const auto list = [&](const char* name, LengthAxis axis, const auto& set) {
      const pugi::xml_attribute a = e.node.attribute(name);
      size_t i = e.first;
      for (std::string_view rest = a.value(); !(rest = trim(rest)).empty(); ++i) {
        const size_t end = std::min(rest.find_first_of(", \t\r\n\f"), rest.size());
        double value = 0;
        if (!parseLength(rest.substr(0, end), lengths, axis, value))
          return noLength(e.node, document_.place(a, 0), name, a.value()), i;
        if (i < e.last) set(text.characters[i], value);
        rest = trim(rest.substr(end));
        if (!rest.empty() && rest[0] == ',') rest.remove_prefix(1);
      }
      return i;
    };
    using Character = Text::Character;
    if (document_.name(e.node) != "textPath") {
      list("x", LengthAxis::X, [](Character& c, double v) { c.x = v; });
      list("y", LengthAxis::Y, [](Character& c, double v) { c.y = v; });
    }
    list("dx", LengthAxis::X, [](Character& c, double v) { c.dx = v; });
    list("dy", LengthAxis::Y, [](Character& c, double v) { c.dy = v; });
    double last = 0;
    const size_t end = list("rotate", LengthAxis::X, [&](Character& c, double v) { c.rotate = last = v; });
    if (end > e.first)
      for (size_t i = end; i < e.last; ++i) text.characters[i].rotate = last;
  }
}

/// Shapes the characters of a line and places its glyphs, from the current text position on.
void Importer::shapeLine(Text& text, size_t first, size_t last) {
  const Text::Character& begin = text.characters[first];
  const size_t from = begin.offset,
               to = last < text.characters.size() ? text.characters[last].offset : text.bytes.size();
  std::vector<GpgpSvgTextSpan> spans;
  for (size_t i = first; i < last; ++i) {
    const Text::Character& c = text.characters[i];
    const auto end = static_cast<uint32_t>((i + 1 < last ? text.characters[i + 1].offset : to) - from);
    if (i > first && text.characters[i - 1].run == c.run) {
      spans.back().end = end;
      continue;
    }
    const Text::Run& run = text.runs[c.run];
    const TextStyle& style = run.state.style.text;
    spans.push_back({static_cast<uint32_t>(c.offset - from), end, style.families.c_str(), run.language.c_str(),
                     static_cast<float>(run.state.style.fontSize), static_cast<float>(style.weight),
                     static_cast<float>(style.letterSpacing), style.italic, style.smallCaps});
  }
  const Text::Run& run = text.runs[begin.run];
  const TextStyle& style = run.state.style.text;
  if (last - first > kMaxLine)
    return reporter_.warn(document_.place(run.node),
                          element(run.node) + " has a line of more than 20000 characters; not drawn");
  for (const GpgpSvgTextSpan& span : spans)
    if (!(span.size > 0)) return; // nothing is seen
  const GpgpSvgText line{text.bytes.data() + from, static_cast<uint32_t>(to - from), spans.data(),
                         static_cast<uint32_t>(spans.size()), style.rightToLeft};
  struct Taken {
    std::vector<Text::Glyph> glyphs;
    std::vector<GpgpSvgGlyph> given;
    bool incomplete = false;
  } taken;
  const GpgpResult result = text_.fn(
      text_.userData, &line,
      [](void* user, const GpgpSvgGlyph* glyph) {
        auto& into = *static_cast<Taken*>(user);
        Text::Glyph made;
        for (uint32_t i = 0; i < glyph->pathCount; ++i) {
          const GpgpPath& path = glyph->paths[i];
          Text::Part part{shapeOfGlyph(path), !glyph->foreground || glyph->foreground[i], {}};
          into.incomplete |= !part.isForeground && path.gradient;
          const auto encoded = [](float v) { return srgbFromLinear(static_cast<double>(v)); };
          part.color = {encoded(path.color[0]), encoded(path.color[1]), encoded(path.color[2]),
                        static_cast<double>(path.color[3])};
          made.parts.push_back(std::move(part));
        }
        into.incomplete |= glyph->incomplete != 0;
        made.metrics = *glyph;
        made.metrics.paths = nullptr, made.metrics.foreground = nullptr;
        into.glyphs.push_back(std::move(made));
      },
      &taken);
  if (result != GPGP_SUCCESS)
    return reporter_.warn(document_.place(run.node), element(run.node) + " has text that is not shaped; not drawn");
  if (taken.incomplete)
    reporter_.warn(document_.place(run.node), element(run.node) + " has glyphs with parts that are not supported");
  // Along the line, before it is anchored.
  double width = 0, shift = 0, down = 0;
  size_t previous = SIZE_MAX;
  std::vector<Point> places;
  for (Text::Glyph& g : taken.glyphs) {
    const auto place =
        std::upper_bound(text.characters.begin() + static_cast<ptrdiff_t>(first) + 1,
                         text.characters.begin() + static_cast<ptrdiff_t>(last), g.metrics.cluster + from,
                         [](size_t offset, const Text::Character& c) { return offset < c.offset; });
    const size_t i = static_cast<size_t>(place - text.characters.begin()) - 1;
    g.character = i;
    const Text::Character& c = text.characters[i];
    if (i != previous && i != first) shift += c.dx;
    if (i != previous) down += c.dy;
    previous = i;
    g.advance = static_cast<double>(g.metrics.advance);
    g.size = static_cast<double>(g.metrics.size);
    places.push_back({static_cast<double>(g.metrics.x) + shift, static_cast<double>(g.metrics.y) + down});
    if (g.metrics.advance > 0 && text.bytes[c.offset] == ' ') shift += text.runs[c.run].state.style.text.wordSpacing;
    width = std::max(width, static_cast<double>(g.metrics.x) + g.advance + shift);
  }
  // Of an element that says how long it is, the whole of the line.
  double stretch = 1;
  auto next = std::lower_bound(text.elements.begin(), text.elements.end(), first,
                               [](const Text::Element& e, size_t at) { return e.first < at; });
  for (; next != text.elements.end() && next->first < last; ++next) {
    const Text::Element& e = *next;
    const pugi::xml_attribute said = e.node.attribute("textLength");
    if (!said || e.first < first || e.last > last || e.first == e.last) continue;
    if (e.first != first || e.last != last) {
      reporter_.warn(document_.place(e.node),
                     "textLength of a part of a line is not supported: " + element(e.node) + " is drawn without it");
      continue;
    }
    double wanted = 0;
    LengthContext lengths = e.state.lengths;
    lengths.fontSize = e.state.style.fontSize;
    if (!parseLength(said.value(), lengths, LengthAxis::X, wanted) || wanted < 0) {
      noLength(e.node, document_.place(said, 0), "textLength", said.value());
    } else if (width > 0 && trim(e.node.attribute("lengthAdjust").value()) == "spacingAndGlyphs") {
      stretch = wanted / width;
    } else if (last - first > 1) {
      double added = 0;
      const double each = (wanted - width) / static_cast<double>(last - first - 1);
      for (size_t k = 0; k < places.size(); ++k) {
        if (k > 0 && taken.glyphs[k].character != taken.glyphs[k - 1].character) added += each;
        places[k].x += added;
      }
    }
    width = wanted;
    break;
  }
  const double before = style.rightToLeft ? 1 - style.anchor : style.anchor;
  const Track* track = run.track ? &text.tracks[run.track - 1] : nullptr;
  const double left = (track ? track->offset : text.at.x) + begin.dx - before * width;
  for (size_t k = 0; k < taken.glyphs.size(); ++k) {
    Text::Glyph& g = taken.glyphs[k];
    const Text::Run& of = text.runs[text.characters[g.character].run];
    const std::string& own = of.state.style.text.alignmentBaseline;
    const std::string& baseline =
        own.empty() || own == "auto" || own == "baseline" ? of.state.style.text.dominantBaseline : own;
    const double lower = baselineOffset(baseline, g.metrics) * g.size - of.shift + places[k].y;
    const double x = left + stretch * places[k].x;
    g.advance *= stretch;
    g.angle = text.characters[g.character].rotate * (std::numbers::pi / 180);
    g.at = {x, text.at.y + lower};
    if (track) {
      Point place;
      double angle = 0;
      g.hidden = !track->at(x + g.advance / 2, place, angle);
      const double c = std::cos(angle), s = std::sin(angle);
      g.at = place + Point{-c * g.advance / 2 - s * lower, -s * g.advance / 2 + c * lower};
      g.angle += angle;
    }
    const double c = std::cos(g.angle), s = std::sin(g.angle);
    g.map = Affine{c, s, -s, c, g.at.x, g.at.y} * Affine{stretch * g.size, 0, 0, g.size, 0, 0};
    if (!g.hidden) {
      const Affine cell{c, s, -s, c, g.at.x, g.at.y};
      const double up = static_cast<double>(g.metrics.ascent) * g.size,
                   deep = static_cast<double>(g.metrics.descent) * g.size;
      for (const Point corner : {Point{0, -up}, Point{g.advance, -up}, Point{0, deep}, Point{g.advance, deep}})
        text.box.add(cell(corner));
    }
    text.glyphs.push_back(std::move(g));
  }
  if (track)
    text.at = track->points.empty() ? text.at : track->points.back();
  else
    text.at = text.at + Point{begin.dx + (style.rightToLeft ? -1 : 1) * (1 - style.anchor) * width, down};
}

/// Runs in painting order: lines below, glyphs, lines through.
void Importer::paintText(Text& text) {
  const auto paint = [&](const Text::Run& run, const Shape& shape, const std::optional<Color>& own) {
    const State& state = run.state;
    const Style& style = state.style;
    if (shape.empty() || !style.visible || !(state.opacity > 0)) return;
    group_ = state.group;
    if (mode_ == Mode::Clip) return emit(shape, state.transform, style.clipRule, {}, 1, run.node);
    if (own)
      return emit(shape, state.transform, GPGP_FILL_NON_ZERO, {*own, nullptr}, style.fillOpacity * state.opacity,
                  run.node);
    const Surface surface{state, state.transform, [&text] { return text.box; }};
    for (const Style::Part part : style.paintOrder) {
      group_ = state.group;
      if (part == Style::Part::Fill) {
        if (const auto ink = resolve(style.fill, surface, run.node, "fill"))
          emit(shape, state.transform, GPGP_FILL_NON_ZERO, *ink, style.fillOpacity * state.opacity, run.node);
      } else if (part == Style::Part::Stroke && style.strokeWidth > 0) {
        if (const auto ink = resolve(style.stroke, surface, run.node, "stroke")) stroke(shape, state, *ink, run.node);
      }
    }
  };
  for (size_t begin = 0, end = 0; begin < text.glyphs.size() && !stopped_; begin = end) {
    const size_t of = text.characters[text.glyphs[begin].character].run;
    const Text::Run& run = text.runs[of];
    while (end < text.glyphs.size() && text.characters[text.glyphs[end].character].run == of) ++end;
    const auto decorate = [&](bool through) {
      for (const Text::Decoration& d : run.decorations)
        for (const std::string_view kind : {"underline", "overline", "line-through"}) {
          if ((kind == "line-through") != through || d.kinds.find(kind) == std::string::npos) continue;
          Shape lines;
          for (size_t i = begin; i < end; ++i) {
            const Text::Glyph& g = text.glyphs[i];
            if (g.hidden || !(g.advance > 0)) continue;
            const double thick =
                static_cast<double>(through ? g.metrics.strikeThickness : g.metrics.underlineThickness);
            const double y = static_cast<double>(through               ? g.metrics.strikePosition
                                                 : kind == "underline" ? g.metrics.underlinePosition
                                                                       : -g.metrics.ascent);
            append(lines, rectangle(0, g.size * (y - thick / 2), g.advance, g.size * thick, 0, 0, 1),
                   Affine{std::cos(g.angle), std::sin(g.angle), -std::sin(g.angle), std::cos(g.angle), g.at.x, g.at.y});
          }
          paint(text.runs[d.run], lines, std::nullopt);
        }
    };
    decorate(false);
    Shape all; // of those that have the run's paint, one after another
    for (size_t i = begin; i < end; ++i) {
      if (text.glyphs[i].hidden) continue;
      for (const Text::Part& part : text.glyphs[i].parts) {
        if (!part.isForeground) paint(run, all, std::nullopt), all = Shape();
        Shape one;
        append(part.isForeground ? all : one, part.shape, text.glyphs[i].map);
        if (!part.isForeground) paint(run, one, part.color);
      }
    }
    paint(run, all, std::nullopt);
    decorate(true);
  }
}

void Importer::drawText(pugi::xml_node node, const State& state) {
  Text text;
  text.node = node;
  Text::Run run;
  run.node = node;
  for (pugi::xml_node up = node; up && run.language.empty(); up = up.parent())
    run.language = up.attribute("xml:lang").value();
  const std::string& decoration = state.style.text.decoration;
  if (!decoration.empty() && decoration != "none") run.decorations.push_back({decoration, 0});
  text.runs.push_back(std::move(run));
  if (state.style.text.vertical)
    reporter_.warn(document_.place(node), "writing-mode is not supported: <text> is drawn without it");
  bool preserves = false;
  for (pugi::xml_node up = node; up; up = up.parent())
    if (const pugi::xml_attribute space = up.attribute("xml:space")) {
      preserves = std::string_view(space.value()) == "preserve";
      break;
    }
  collectText(node, state, preserves, text);
  if (text.afterSpace && !text.characters.empty() && text.bytes.back() == ' ') { // at the end of the whole
    text.bytes.pop_back();
    text.characters.pop_back();
    for (Text::Element& e : text.elements) e.last = std::min(e.last, text.characters.size());
  }
  placeText(text);
  for (size_t first = 0, last = 0; first < text.characters.size(); first = last) {
    const auto trackOfCharacter = [&](size_t i) { return text.runs[text.characters[i].run].track; };
    const Text::Character& c = text.characters[first];
    if (c.x) text.at.x = *c.x;
    if (c.y) text.at.y = *c.y;
    for (last = first + 1; last < text.characters.size(); ++last)
      if (text.characters[last].x || text.characters[last].y || trackOfCharacter(last) != trackOfCharacter(first))
        break;
    shapeLine(text, first, last);
  }
  if (text.box.left > text.box.right) return;
  if (mode_ == Mode::Measure) {
    const Box& b = text.box;
    return measure(rectangle(b.left, b.top, b.right - b.left, b.bottom - b.top, 0, 0, 1), toBox_ * state.transform);
  }
  paintText(text);
}

} // namespace gpgp::vector::svg
