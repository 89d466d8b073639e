// Paths as the API takes them, drawn by cairo: another renderer to compare with.
//
// Cairo mixes colours and stops as sRGB encodes them, whatever a gradient says.
#pragma once
#include "host/picture.h"

#include <gpgp/vector.h>

#include <algorithm>
#include <cairo.h>
#include <span>
#include <vector>

namespace gpgp {

inline void trace(cairo_t* c, const GpgpPath& path) {
  const float* p = path.points;
  double x = 0, y = 0;
  const auto take = [&p, &x, &y] { x = static_cast<double>(p[0]), y = static_cast<double>(p[1]), p += 2; };
  for (const GpgpPathVerb verb : std::span(path.verbs, path.verbCount)) {
    if (verb == GPGP_PATH_MOVE) take(), cairo_move_to(c, x, y);
    if (verb == GPGP_PATH_LINE) take(), cairo_line_to(c, x, y);
    if (verb == GPGP_PATH_CLOSE) cairo_close_path(c);
    if (verb == GPGP_PATH_QUAD) {
      double ax, ay;
      cairo_get_current_point(c, &ax, &ay);
      take();
      const double bx = x, by = y;
      take();
      cairo_curve_to(c, (ax + 2 * bx) / 3, (ay + 2 * by) / 3, (x + 2 * bx) / 3, (y + 2 * by) / 3, x, y);
    }
    if (verb == GPGP_PATH_CUBIC) {
      take();
      const double ax = x, ay = y;
      take();
      const double bx = x, by = y;
      take();
      cairo_curve_to(c, ax, ay, bx, by, x, y);
    }
  }
  cairo_set_fill_rule(c, path.fillRule == GPGP_FILL_EVEN_ODD ? CAIRO_FILL_RULE_EVEN_ODD : CAIRO_FILL_RULE_WINDING);
}

inline void setGradient(cairo_t* c, const GpgpGradient& g, float alpha) {
  const auto at = [](float v) { return static_cast<double>(v); };
  const auto encode = [](float v) { return static_cast<double>(host::srgbFromLinear(v)); };
  cairo_pattern_t* pattern =
      g.kind == GPGP_GRADIENT_RADIAL
          ? cairo_pattern_create_radial(at(g.start[0]), at(g.start[1]), at(g.startRadius), at(g.end[0]), at(g.end[1]),
                                        at(g.endRadius))
          : cairo_pattern_create_linear(at(g.start[0]), at(g.start[1]), at(g.end[0]), at(g.end[1]));
  for (uint32_t i = 0; i < g.stopCount; ++i) {
    const float* color = g.stops[i].color;
    cairo_pattern_add_color_stop_rgba(pattern, at(g.stops[i].offset), encode(color[0]), encode(color[1]),
                                      encode(color[2]), at(color[3] * alpha));
  }
  cairo_pattern_set_extend(pattern, g.spread == GPGP_SPREAD_REPEAT    ? CAIRO_EXTEND_REPEAT
                                    : g.spread == GPGP_SPREAD_REFLECT ? CAIRO_EXTEND_REFLECT
                                                                      : CAIRO_EXTEND_PAD);
  cairo_matrix_t matrix; // from the drawing to the gradient
  cairo_matrix_init(&matrix, at(g.transform[0]), at(g.transform[1]), at(g.transform[2]), at(g.transform[3]),
                    at(g.transform[4]), at(g.transform[5]));
  if (cairo_matrix_invert(&matrix) == CAIRO_STATUS_SUCCESS) cairo_pattern_set_matrix(pattern, &matrix);
  cairo_set_source(c, pattern);
  cairo_pattern_destroy(pattern);
}

inline void drawWithCairo(cairo_t* c, std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups) {
  std::vector<uint32_t> open; // groups, the outermost first
  const auto enter = [&](uint32_t group) {
    std::vector<uint32_t> around;
    for (uint32_t g = group; g; g = groups[g - 1].parent) around.insert(around.begin(), g);
    size_t same = 0;
    while (same < std::min(open.size(), around.size()) && open[same] == around[same]) ++same;
    for (; open.size() > same; open.pop_back()) {
      const double opacity = static_cast<double>(groups[open.back() - 1].opacity);
      if (opacity < 1) cairo_pop_group_to_source(c), cairo_paint_with_alpha(c, opacity);
      cairo_restore(c);
    }
    for (; open.size() < around.size(); open.push_back(around[open.size()])) {
      const GpgpPathGroup& g = groups[around[open.size()] - 1];
      cairo_save(c);
      for (uint32_t k = 0; k < g.clipCount; ++k) trace(c, g.clip[k]); // all by the last one's fill rule
      if (g.clip) cairo_clip(c);
      if (g.opacity < 1) cairo_push_group(c);
    }
  };
  const auto encode = [](float v) { return static_cast<double>(host::srgbFromLinear(v)); };
  for (const GpgpPath& path : paths) {
    enter(path.group);
    trace(c, path);
    if (path.gradient)
      setGradient(c, *path.gradient, path.color[3]);
    else
      cairo_set_source_rgba(c, encode(path.color[0]), encode(path.color[1]), encode(path.color[2]),
                            static_cast<double>(path.color[3]));
    cairo_fill(c);
  }
  enter(0);
}

} // namespace gpgp
