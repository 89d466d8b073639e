// Text (SVG 2, chapter 11) as outlines: characters with their places, lines that whoever compiles shapes in fonts, and
// glyphs as the shapes of the element that they stand in.
#include "vector/import/svg/text.h"
#include "vector/import/svg/text_characters.h"
#include "vector/import/svg/track.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gpgp::vector::svg {
namespace {

constexpr size_t kMaxCharacters = 100'000, kMaxLine = 20'000;

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

} // namespace

void Importer::reportUndrawn(pugi::xml_node node, const Style& style, const Style* above) {
  const auto properties = textPropertiesUndrawn();
  for (size_t i = 0; i < properties.size(); ++i) {
    const UndrawnProperty& p = properties[i];
    if (!style.text.undrawn[i] || (p.isOfVerticalLines && !style.text.vertical)) continue;
    if (p.isInherited && above && above->text.undrawn[i]) continue;
    reporter_.warn(document_.place(node),
                   std::string(p.name) + " is not supported: " + element(node) + " is drawn without it");
  }
}

/// Appends what an element holds, and what is in it.
void Importer::collectText(pugi::xml_node node, const State& state, bool preserves, Text& text) {
  using Space = TextStyle::Space;
  const std::string_view xmlSpace = node.attribute("xml:space").value();
  if (!xmlSpace.empty()) preserves = xmlSpace == "preserve";
  const bool keeps = state.style.text.space == Space::AsXml ? preserves : state.style.text.space == Space::Preserve;
  const size_t own = text.runs.size(), element = text.elements.size();
  const BidiMarks marks = bidiMarksOf(state.style.text);
  const bool isCopy = document_.name(node) == "tref"; // which has no words of its own
  text.marks += marks.before;
  text.runs.back().state = state;
  text.elements.push_back({node, state, text.characters.size(), 0});
  size_t run = own - 1;
  const Text::Run kept = text.runs[run];
  const auto append = [&](std::string_view value) {
    if (!(state.style.fontSize > 0)) return; // nothing is seen
    if (run != text.runs.size() - 1) text.runs.push_back(kept), run = text.runs.size() - 1;
    for (const char c : withoutBreaks(value)) {
      const bool isSpace = c == ' ' || c == '\t' || c == '\n' || c == '\r';
      if (c == 0x7f || (isSpace && !keeps && text.afterSpace)) continue; // what deletes is not seen
      if ((c & 0xc0) != 0x80) {
        if (text.characters.size() >= kMaxCharacters) return stop(node, "more than 100000 characters of text");
        Text::Character character;
        character.begin = text.bytes.size();
        text.bytes += std::exchange(text.marks, {});
        character.offset = text.bytes.size();
        character.run = run;
        text.characters.push_back(character);
      }
      text.bytes += isSpace ? ' ' : c;
      text.afterSpace = isSpace && !keeps;
    }
  };
  if (isCopy) { // SVG 1.1, 10.6: all characters of another element
    const pugi::xml_node target = document_.find(trim(hrefOf(node).value()));
    if (!target) reporter_.ignored(document_.place(node), "<tref> refers to an element that does not exist");
    std::string all;
    for (pugi::xml_node at = target; at; ++steps_) {
      if (at.type() == pugi::node_pcdata || at.type() == pugi::node_cdata) all += at.value();
      if (at.first_child()) {
        at = at.first_child();
        continue;
      }
      while (at && at != target && !at.next_sibling()) at = at.parent();
      at = at == target ? pugi::xml_node() : at.next_sibling();
    }
    append(all);
  }
  for (const pugi::xml_node child : node.children()) {
    if (stopped_) break;
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
      if (!isCopy) append(child.value());
      continue;
    }
    if (isCopy) continue; // in place of what it holds
    const std::string_view name = document_.name(child);
    constexpr std::string_view silent[] = {"title",        "desc",          "metadata",         "animate", "set",
                                           "animateColor", "animateMotion", "animateTransform", "script"};
    if (name.empty() || oneOf(name, silent) || stopped(child)) continue;
    if (name == "textPath" && document_.name(node) != "text") {
      reporter_.ignored(document_.place(child), "<textPath> stands in a " + this->element(node) +
                                                    ", not in a <text>; it "
                                                    "is not drawn");
      continue;
    }
    if (name != "tspan" && name != "a" && name != "textPath" && name != "tref") {
      reporter_.warn(document_.place(child), this->element(child) + " is not supported");
      continue;
    }
    std::optional<State> entered = enter(child, state);
    if (!entered || !isFor(child)) continue;
    State& inner = *entered;
    reportUnsupported(child, name, inner.style);
    reportUndrawn(child, inner.style, &state.style);
    const struct {
      bool is;
      const char* what;
    } effects[] = {{inner.style.opacity < 1, "opacity"},
                   {!inner.style.clipPath.empty(), "clip-path"},
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
    lengths.width = lengths.height = lengths.fontSize = inner.style.fontSize;
    double length = 0;
    if (shift == "sub")
      ++next.subscripts;
    else if (shift == "super")
      ++next.superscripts;
    else if (!shift.empty() && shift != "baseline" && parseLength(shift, lengths, LengthAxis::X, length))
      next.shift += length;
    if (name == "textPath") {
      const std::string_view href = trim(hrefOf(child).value());
      const pugi::xml_node target = document_.find(href);
      const std::string_view kind = target ? document_.name(target) : std::string_view();
      if (!oneOf(kind, kShapes)) {
        reporter_.ignored(document_.place(child), "<textPath> refers to '" + std::string(href.substr(0, 60)) +
                                                      "', which is not a shape of this file; it is not drawn");
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
  text.marks += marks.behind;
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
    if (document_.name(e.node) == "textPath") continue; // it has none of these
    list("x", LengthAxis::X, [](Character& c, double v) { c.x = v; });
    list("y", LengthAxis::Y, [](Character& c, double v) { c.y = v; });
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
  const size_t from = begin.begin, to = last < text.characters.size() ? text.characters[last].begin : text.bytes.size();
  std::vector<GpgpSvgTextSpan> spans;
  const bool isVertical = text.vertical && text.runs[begin.run].track == 0;
  for (size_t i = first; i < last; ++i) {
    const Text::Character& c = text.characters[i];
    const auto end = static_cast<uint32_t>((i + 1 < last ? text.characters[i + 1].begin : to) - from);
    if (i > first && text.characters[i - 1].run == c.run) {
      spans.back().end = end;
      continue;
    }
    const Text::Run& run = text.runs[c.run];
    const TextStyle& style = run.state.style.text;
    spans.push_back({static_cast<uint32_t>(c.begin - from), end, style.families.c_str(), run.language.c_str(),
                     static_cast<float>(run.state.style.fontSize), static_cast<float>(style.weight), 0, style.italic,
                     style.smallCaps, style.unkerned, style.letterSpacing != 0, static_cast<float>(style.stretch),
                     isVertical});
  }
  const Text::Run& run = text.runs[begin.run];
  const TextStyle& style = run.state.style.text;
  if (last - first > kMaxLine)
    return reporter_.warn(document_.place(run.node),
                          element(run.node) + " has a line of more than 20000 characters; not drawn");
  const GpgpSvgText line{text.bytes.data() + from, static_cast<uint32_t>(to - from), spans.data(),
                         static_cast<uint32_t>(spans.size()), style.rightToLeft};
  struct Taken {
    Importer& importer;
    std::vector<Text::Glyph> glyphs;
    bool incomplete = false;
  } taken{*this, {}, false};
  const GpgpResult result = text_.fn(
      text_.userData, &line,
      [](void* user, const GpgpSvgGlyph* glyph) {
        auto& into = *static_cast<Taken*>(user);
        Text::Glyph made;
        for (uint32_t i = 0; i < glyph->pathCount; ++i) {
          const GpgpPath& path = glyph->paths[i];
          Text::Part part;
          part.shape = shapeOfGlyph(path);
          part.isForeground = !glyph->foreground || glyph->foreground[i];
          if (!part.isForeground && path.gradient) part.gradient = gradientMoved(*path.gradient, Affine{});
          const auto encoded = [](float v) { return srgbFromLinear(static_cast<double>(v)); };
          part.color = {encoded(path.color[0]), encoded(path.color[1]), encoded(path.color[2]),
                        static_cast<double>(path.color[3])};
          made.parts.push_back(std::move(part));
        }
        into.incomplete |= glyph->incomplete != 0;
        if (glyph->image) {
          const auto at = [glyph](size_t i) { return static_cast<double>(glyph->imageBox[i]); };
          Text::Part part;
          part.isForeground = false;
          part.picture = into.importer.pictureOfGlyph(*glyph);
          part.place = {at(2) - at(0), 0, 0, at(3) - at(1), at(0), at(1)};
          into.incomplete |= !part.picture;
          if (part.picture) made.parts.push_back(std::move(part));
        }
        made.metrics = *glyph;
        made.metrics.paths = nullptr, made.metrics.foreground = nullptr, made.metrics.image = nullptr;
        into.glyphs.push_back(std::move(made));
      },
      &taken);
  if (result != GPGP_SUCCESS)
    return reporter_.warn(document_.place(run.node), element(run.node) + " has text that is not shaped; not drawn");
  if (taken.incomplete)
    reporter_.warn(document_.place(run.node), element(run.node) + " has glyphs with parts that are not supported");
  const Track* track = run.track ? &text.tracks[run.track - 1] : nullptr;
  const bool vertical = text.vertical && !track;
  // Along the line, before it is anchored.
  double width = 0, shift = 0, down = 0, lead = 0;
  size_t previous = SIZE_MAX, begun = 0;
  std::vector<Point> places;
  for (size_t k = 0; k < taken.glyphs.size(); ++k) {
    Text::Glyph& g = taken.glyphs[k];
    const auto place =
        std::upper_bound(text.characters.begin() + static_cast<ptrdiff_t>(first) + 1,
                         text.characters.begin() + static_cast<ptrdiff_t>(last), g.metrics.cluster + from,
                         [](size_t offset, const Text::Character& c) { return offset < c.begin; });
    const size_t i = static_cast<size_t>(place - text.characters.begin()) - 1;
    g.character = i;
    const Text::Character& c = text.characters[i];
    // A vertical line is one on its side: its way goes down the page, and its underside is on the left.
    if (i != previous) {
      shift += vertical ? c.dy : c.dx;
      down += vertical ? -c.dx : c.dy;
      g.apart = c.x || c.y || std::fabs(c.dx) > 0 || std::fabs(c.dy) > 0;
    }
    if (k == 0) lead = shift; // which does not count as a part of the line
    previous = i;
    g.advance = static_cast<double>(g.metrics.advance);
    g.size = static_cast<double>(g.metrics.size);
    places.push_back({static_cast<double>(g.metrics.x) + shift, static_cast<double>(g.metrics.y) + down});
    if (k == 0 || g.metrics.advance > 0) width = static_cast<double>(g.metrics.x) + g.advance + shift - lead;
    const TextStyle& of = text.runs[c.run].state.style.text;
    const uint32_t character = characterAt(text.bytes, c.offset);
    if (g.metrics.advance > 0 && isWordSpace(character)) shift += of.wordSpacing;
    const bool endsCluster = k + 1 < taken.glyphs.size() && taken.glyphs[k + 1].metrics.cluster != g.metrics.cluster;
    if (g.metrics.cluster != taken.glyphs[begun].metrics.cluster) begun = k;
    if (!endsCluster || isJoined(character)) continue;
    const double room = taken.glyphs[begun].advance + of.letterSpacing; // resvg shows no letters that have none
    for (size_t each = begun; room < 0 && each <= k; ++each) taken.glyphs[each].hidden = true;
    shift += std::max(of.letterSpacing, -taken.glyphs[begun].advance);
  }
  // Elements that say how long they are, the inner ones first (SVG 2, 11.5).
  std::vector<double> stretches(taken.glyphs.size(), 1);
  for (size_t n = text.elements.size(); n-- > 0;) {
    const Text::Element& e = text.elements[n];
    const pugi::xml_attribute said = e.node.attribute("textLength");
    if (said && e.first >= first && e.first < last && e.last > last)
      reporter_.warn(document_.place(said, 0),
                     "textLength of several lines is not supported: " + element(e.node) + " is drawn without it");
    if (!said || e.first < first || e.last > last || e.first == e.last) continue;
    LengthContext lengths = e.state.lengths;
    lengths.fontSize = e.state.style.fontSize;
    double wanted = 0;
    if (!parseLength(said.value(), lengths, LengthAxis::X, wanted) || !(wanted >= 0)) {
      noLength(e.node, document_.place(said, 0), "textLength", said.value());
      continue;
    }
    const auto isInside = [&](size_t k) {
      return taken.glyphs[k].character >= e.first && taken.glyphs[k].character < e.last;
    };
    const auto endOf = [&](size_t k) { return places[k].x + stretches[k] * taken.glyphs[k].advance; };
    double low = 1e300, high = -1e300;
    size_t steps = 0, previousOne = SIZE_MAX;
    for (size_t k = 0; k < places.size(); ++k) {
      if (!isInside(k)) continue;
      low = std::min(low, places[k].x), high = std::max(high, endOf(k));
      steps += previousOne != SIZE_MAX && taken.glyphs[k].character != previousOne;
      previousOne = taken.glyphs[k].character;
    }
    if (!(high > low)) continue;
    const bool squeezes = trim(e.node.attribute("lengthAdjust").value()) == "spacingAndGlyphs";
    const double factor = squeezes ? wanted / (high - low) : 1;
    if (squeezes ? !(factor > 0) : steps == 0) continue;
    const double each = squeezes ? 0 : (wanted - (high - low)) / static_cast<double>(steps);
    size_t passed = 0;
    previousOne = SIZE_MAX;
    width = 0;
    for (size_t k = 0; k < places.size(); ++k) {
      if (isInside(k)) {
        passed += previousOne != SIZE_MAX && taken.glyphs[k].character != previousOne;
        previousOne = taken.glyphs[k].character;
        places[k].x = low + factor * (places[k].x - low) + each * static_cast<double>(passed);
        stretches[k] *= factor;
      } else if (places[k].x >= high - 1e-6) {
        places[k].x += wanted - (high - low) + each; // browsers space the last letter as well
      }
      width = std::max(width, endOf(k));
    }
  }
  const double before = style.rightToLeft ? 1 - style.anchor : style.anchor;
  if (track && (begin.x || first == 0 || text.runs[text.characters[first - 1].run].track != run.track))
    text.along = begin.x.value_or(0); // of its path, whatever the current text position is
  const double left = (track ? track->offset + text.along : vertical ? text.at.y : text.at.x) - before * width;
  size_t base = 0, baseGlyph = 0; // of the cluster: in the line, and in the text
  for (size_t k = 0; k < taken.glyphs.size(); ++k) {
    Text::Glyph& g = taken.glyphs[k];
    const Text::Run& of = text.runs[text.characters[g.character].run];
    const std::string& own = of.state.style.text.alignmentBaseline;
    const std::string& dominant = of.state.style.text.dominantBaseline;
    constexpr std::string_view alignments[] = {"alphabetic",   "middle",           "central",         "hanging",
                                               "mathematical", "text-before-edge", "text-after-edge", "before-edge",
                                               "after-edge",   "ideographic"};
    const bool isDominant = !oneOf(own, alignments);
    const bool isEdge = dominant == "before-edge" || dominant == "after-edge"; // of alignment-baseline alone
    const std::string_view baseline = !isDominant ? std::string_view(own) : isEdge ? std::string_view() : dominant;
    const bool isMiddle = text.vertical && (baseline.empty() || baseline == "auto"); // lines run through small letters
    const double raised = of.shift + g.size * (of.superscripts * static_cast<double>(g.metrics.superscript) -
                                               of.subscripts * static_cast<double>(g.metrics.subscript));
    const double lower = baselineOffset(isMiddle ? "middle" : baseline, g.metrics) * g.size - raised + places[k].y;
    const double x = left + places[k].x;
    g.advance *= stretches[k];
    g.angle = text.characters[g.character].rotate * (std::numbers::pi / 180);
    g.at = {x, text.at.y + lower};
    if (vertical && (g.metrics.vertical || isUpright(characterAt(text.bytes, text.characters[g.character].offset)))) {
      const double middle = baselineOffset("central", g.metrics) * g.size; // of its square
      g.at = {text.at.x - places[k].y + raised - g.advance / 2, x + g.advance / 2 + middle};
    } else if (vertical) {
      g.at = {text.at.x - lower, x};
      g.angle += std::numbers::pi / 2;
    }
    const bool isAttached = k > 0 && taken.glyphs[k - 1].metrics.cluster == g.metrics.cluster; // a mark on its letter
    if (!isAttached) base = k, baseGlyph = text.glyphs.size();
    if (track) {
      Point place;
      double angle = 0;
      g.hidden |= !track->at(x + g.advance / 2, place, angle);
      const double c = std::cos(angle), s = std::sin(angle);
      g.at = place + Point{-c * g.advance / 2 - s * lower, -s * g.advance / 2 + c * lower};
      g.angle += angle;
    }
    g.line = vertical ? Point{text.at.x - places[k].y + raised, x} : g.at;
    g.lineAngle = vertical ? std::numbers::pi / 2 : g.angle;
    if (isAttached) { // goes with it as one
      const Text::Glyph& letter = text.glyphs[baseGlyph];
      const double c = std::cos(letter.angle), s = std::sin(letter.angle);
      g.at = letter.at + Affine{c, s, -s, c, 0, 0}(places[k] - places[base]);
      g.angle = letter.angle, g.hidden = letter.hidden;
      g.line = letter.line, g.lineAngle = letter.lineAngle;
    }
    const double c = std::cos(g.angle), s = std::sin(g.angle);
    g.map = Affine{c, s, -s, c, g.at.x, g.at.y} * Affine{stretches[k] * g.size, 0, 0, g.size, 0, 0};
    if (!g.hidden) {
      const Affine cell{c, s, -s, c, g.at.x, g.at.y};
      const double up = static_cast<double>(g.metrics.ascent) * g.size,
                   deep = static_cast<double>(g.metrics.descent) * g.size;
      for (const Point corner : {Point{0, -up}, Point{g.advance, -up}, Point{0, deep}, Point{g.advance, deep}})
        text.box.add(cell(corner));
    }
    text.glyphs.push_back(std::move(g));
  }
  text.along += lead + (1 - style.anchor) * width;
  if (track)
    text.at = track->points.empty() ? text.at : track->points.back();
  else if (vertical)
    text.at = text.at + Point{-down, lead + (style.rightToLeft ? -1 : 1) * (1 - style.anchor) * width};
  else
    text.at = text.at + Point{lead + (style.rightToLeft ? -1 : 1) * (1 - style.anchor) * width, down};
}

void Importer::drawText(pugi::xml_node node, const State& state) {
  reportUndrawn(node, state.style, nullptr);
  Text text;
  text.node = node;
  Text::Run run;
  run.node = node;
  for (pugi::xml_node up = node; up && run.language.empty(); up = up.parent())
    run.language = up.attribute("xml:lang").value();
  for (pugi::xml_node up = node; up.type() == pugi::node_element; up = up.parent()) { // with the paints of the text
    const std::string decoration =
        up == node ? state.style.text.decoration : styleOf(up, state.lengths).text.decoration;
    if (!decoration.empty() && decoration != "none") run.decorations.push_back({decoration, 0});
  }
  text.runs.push_back(std::move(run));
  text.vertical = state.style.text.vertical;
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
