// Text as what is painted: glyphs with the paints of their elements or fonts, and the lines along them.
#include "vector/import/svg/text.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {
namespace {

void append(Shape& to, const Shape& from, const Affine& map) {
  to.verbs.insert(to.verbs.end(), from.verbs.begin(), from.verbs.end());
  for (const Point& p : from.points) to.points.push_back(map(p));
}

} // namespace

std::shared_ptr<const Gradient> gradientMoved(const GpgpGradient& from, const Affine& map) {
  const auto moved = std::make_shared<Gradient>();
  moved->stops.assign(from.stops, from.stops + from.stopCount);
  moved->gradient = from;
  moved->gradient.stops = moved->stops.data();
  const auto at = [&from](size_t i) { return static_cast<double>(from.transform[i]); };
  const Affine to = map * Affine{at(0), at(1), at(2), at(3), at(4), at(5)};
  const double all[6] = {to.a, to.b, to.c, to.d, to.e, to.f};
  for (size_t i = 0; i < 6; ++i) moved->gradient.transform[i] = static_cast<float>(all[i]);
  return moved;
}

/// Runs in painting order: lines below, glyphs, lines through.
void Importer::paintText(Text& text) {
  // With the paints of a run, which may be around what is seen.
  const auto paint = [&](const Text::Run& run, const Shape& shape, const std::optional<Color>& own, bool isSeen) {
    const State& state = run.state;
    const Style& style = state.style;
    if (shape.empty() || !isSeen || !(state.opacity > 0)) return;
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
    const bool isVisible = run.state.style.visible;
    const auto decorate = [&](bool through) {
      for (const Text::Decoration& d : run.decorations)
        for (const std::string_view kind : {"underline", "overline", "line-through"}) {
          if ((kind == "line-through") != through || d.kinds.find(kind) == std::string::npos) continue;
          Shape lines;
          for (size_t i = begin, next = begin; i < end; i = next) { // glyphs on one straight line have one
            const Text::Glyph& g = text.glyphs[i];
            const double c = std::cos(g.lineAngle), s = std::sin(g.lineAngle);
            double width = g.advance;
            for (next = i + 1; next < end && !run.track && !text.glyphs[next].apart; ++next) {
              const Text::Glyph& other = text.glyphs[next];
              const Point way{other.line.x - g.line.x, other.line.y - g.line.y};
              const bool isTurned = std::fabs(other.lineAngle - g.lineAngle) > 1e-9;
              if (isTurned || std::fabs(c * way.y - s * way.x) > 1e-6) break;
              width = std::max(width, c * way.x + s * way.y + other.advance);
            }
            if (g.hidden || !(width > 0)) continue;
            const GpgpSvgGlyph& m = g.metrics;
            const double thick = static_cast<double>(through ? m.strikeThickness : m.underlineThickness);
            // Other renderers take the positions for those of the middle of the line, which fonts give of its top.
            double y = static_cast<double>(through               ? m.strikePosition
                                           : kind == "underline" ? m.underlinePosition
                                                                 : -m.ascent) -
                       (kind == "overline" ? 0 : thick / 2);
            if (text.vertical && !run.track) { // through the middle, and along both edges
              const double half = static_cast<double>(m.ascent + m.descent) / 2;
              y = through ? 0 : kind == "underline" ? half : -half;
            }
            append(lines, rectangle(0, g.size * (y - thick / 2), width, g.size * thick, 0, 0, 1),
                   Affine{c, s, -s, c, g.line.x, g.line.y});
          }
          paint(text.runs[d.run], lines, std::nullopt, isVisible);
        }
    };
    decorate(false);
    Shape all; // of those that have the run's paint, one after another
    for (size_t i = begin; i < end; ++i) {
      if (text.glyphs[i].hidden) continue;
      for (const Text::Part& part : text.glyphs[i].parts) {
        if (part.isForeground) {
          append(all, part.shape, text.glyphs[i].map);
          continue;
        }
        paint(run, all, std::nullopt, isVisible), all = Shape();
        const bool isSeen = isVisible && mode_ != Mode::Clip;
        group_ = run.state.group;
        if (part.picture && isSeen)
          emitPicture(rectangle(0, 0, 1, 1, 0, 0, 1), run.state, text.glyphs[i].map * part.place, *part.picture,
                      run.node);
        Shape one;
        append(one, part.shape, text.glyphs[i].map);
        if (part.gradient && isSeen)
          emit(one, run.state.transform, GPGP_FILL_NON_ZERO,
               {{}, gradientMoved(part.gradient->gradient, run.state.transform * text.glyphs[i].map)},
               run.state.style.fillOpacity * run.state.opacity, run.node);
        else
          paint(run, one, part.color, isVisible);
      }
    }
    paint(run, all, std::nullopt, isVisible);
    decorate(true);
  }
}

} // namespace gpgp::vector::svg
