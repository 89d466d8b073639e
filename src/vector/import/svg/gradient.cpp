// Gradients (SVG 2, 14.2): attributes and stops along a chain of references, and the maps into the drawing.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {
void Box::add(Point p) {
  left = std::min(left, p.x);
  right = std::max(right, p.x);
  top = std::min(top, p.y);
  bottom = std::max(bottom, p.y);
}

Box boxOf(const Shape& shape) {
  Box box;
  const Point* p = shape.points.data();
  Point at;
  const auto add = [&box](const Cubic& c) {
    box.add(c.p[0]);
    box.add(c.p[3]);
    for (double Point::*axis : {&Point::x, &Point::y}) {
      const double a = c.p[0].*axis, b = c.p[1].*axis, d = c.p[2].*axis, e = c.p[3].*axis;
      double turns[2];
      for (int i = rootsInside(e - 3 * d + 3 * b - a, 2 * (d - 2 * b + a), b - a, turns); i-- > 0;)
        box.add(c.at(turns[i]));
    }
  };
  for (const GpgpPathVerb verb : shape.verbs) switch (verb) {
    case GPGP_PATH_MOVE:
    case GPGP_PATH_LINE: box.add(at = *p++); break;
    case GPGP_PATH_QUAD: add(Cubic::fromQuadratic(at, p[0], p[1])), at = p[1], p += 2; break;
    case GPGP_PATH_CUBIC: add({{at, p[0], p[1], p[2]}}), at = p[2], p += 3; break;
    default: break;
    }
  return box;
}

/// The first along the references that has the attribute.
pugi::xml_attribute Importer::gradientAttribute(pugi::xml_node gradient, const char* name) const {
  for (int hops = 0; gradient && hops < 32; ++hops, gradient = document_.find(trim(hrefOf(gradient).value())))
    if (const pugi::xml_attribute a = gradient.attribute(name)) return a;
  return {};
}

bool Importer::isCyclic(pugi::xml_node gradient) const {
  std::vector<pugi::xml_node> seen;
  for (; gradient && seen.size() < 32; gradient = document_.find(trim(hrefOf(gradient).value()))) {
    if (std::find(seen.begin(), seen.end(), gradient) != seen.end()) return true;
    seen.push_back(gradient);
  }
  return false;
}

std::string_view Importer::otherFileOf(pugi::xml_node gradient) const {
  for (int hops = 0; gradient && hops < 32; ++hops) {
    const std::string_view href = trim(hrefOf(gradient).value());
    if (!href.empty() && !href.starts_with('#')) return href;
    gradient = document_.find(href);
  }
  return {};
}

std::vector<GpgpGradientStop> Importer::gradientStops(pugi::xml_node gradient, const LengthContext& lengths) {
  std::vector<GpgpGradientStop> stops;
  for (int hops = 0; gradient && hops < 32 && stops.empty(); ++hops) {
    const Style around = styleOf(gradient, lengths);
    reportChildren(gradient);
    for (const pugi::xml_node child : gradient.children()) {
      if (document_.name(child) != "stop") continue;
      if (++steps_ > limits_.points || stops.size() >= 65536) {
        stop(child, "more stops of gradients than are allowed");
        return stops;
      }
      reportChildren(child);
      Style own = around.inherited();
      cascade(child, around, {}, own);
      double offset = 0;
      const pugi::xml_attribute place = child.attribute("offset");
      Scanner s(trim(place.value()));
      const bool isNumber = s.number(offset);
      if (isNumber && s.take("%")) offset /= 100;
      if (place && !(isNumber && s.done())) {
        ignored(child, place);
        offset = 0;
      }
      offset = std::clamp(offset, stops.empty() ? 0.0 : static_cast<double>(stops.back().offset), 1.0);
      const Color c = own.stopColor.isCurrent ? own.color : own.stopColor.color;
      const double linear[4] = {linearFromSrgb(c.r), linearFromSrgb(c.g), linearFromSrgb(c.b), c.a * own.stopOpacity};
      GpgpGradientStop stop{static_cast<float>(offset), {}};
      for (size_t i = 0; i < 4; ++i) stop.color[i] = static_cast<float>(std::clamp(linear[i], 0.0, 1.0));
      stops.push_back(stop);
    }
    gradient = document_.find(trim(hrefOf(gradient).value()));
  }
  return stops;
}

std::shared_ptr<const Gradient> Importer::gradientOf(pugi::xml_node node, bool radial, const State& state,
                                                     const Shape& shape) {
  auto made = std::make_shared<Gradient>();
  made->stops = gradientStops(node, state.lengths);
  if (made->stops.empty()) return nullptr;
  const auto text = [&](const char* name) { return std::string_view(gradientAttribute(node, name).value()); };
  const auto oneOf = [&](const char* name, std::initializer_list<std::string_view> words) {
    const pugi::xml_attribute a = gradientAttribute(node, name);
    if (a && std::find(words.begin(), words.end(), trim(a.value())) == words.end()) ignored(node, a);
  };
  oneOf("gradientUnits", {"userSpaceOnUse", "objectBoundingBox"});
  oneOf("spreadMethod", {"pad", "reflect", "repeat"});
  const bool userSpace = trim(text("gradientUnits")) == "userSpaceOnUse";
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  if (!userSpace) lengths.width = lengths.height = 1;
  const auto number = [&](const char* name, LengthAxis axis, double percent) {
    const double whole = axis == LengthAxis::X   ? lengths.width
                         : axis == LengthAxis::Y ? lengths.height
                                                 : std::hypot(lengths.width, lengths.height) / std::sqrt(2);
    const pugi::xml_attribute a = gradientAttribute(node, name);
    double value = percent / 100 * whole;
    if (a && !parseLength(trim(a.value()), lengths, axis, value)) {
      noLength(node, document_.line(a, 0), name, a.value());
      value = percent / 100 * whole;
    }
    if (value < 0 && axis == LengthAxis::Diagonal) { // a radius
      reporter_.error(document_.line(a, 0), element(node) + " has a negative " + name + "; ignored");
      value = percent / 100 * whole;
    }
    return static_cast<float>(value);
  };
  GpgpGradient& g = made->gradient;
  g.kind = radial ? GPGP_GRADIENT_RADIAL : GPGP_GRADIENT_LINEAR;
  if (radial) {
    g.end[0] = number("cx", LengthAxis::X, 50);
    g.end[1] = number("cy", LengthAxis::Y, 50);
    g.endRadius = number("r", LengthAxis::Diagonal, 50);
    g.start[0] = gradientAttribute(node, "fx") ? number("fx", LengthAxis::X, 50) : g.end[0];
    g.start[1] = gradientAttribute(node, "fy") ? number("fy", LengthAxis::Y, 50) : g.end[1];
    g.startRadius = number("fr", LengthAxis::Diagonal, 0);
    if (g.endRadius == 0) g.kind = GPGP_GRADIENT_LINEAR, std::copy_n(g.end, 2, g.start); // all in the last colour
  } else {
    g.start[0] = number("x1", LengthAxis::X, 0);
    g.start[1] = number("y1", LengthAxis::Y, 0);
    g.end[0] = number("x2", LengthAxis::X, 100);
    g.end[1] = number("y2", LengthAxis::Y, 0);
  }
  const std::string_view spread = trim(text("spreadMethod"));
  g.spread = spread == "reflect" ? GPGP_SPREAD_REFLECT : spread == "repeat" ? GPGP_SPREAD_REPEAT : GPGP_SPREAD_PAD;
  g.interpolateSrgb = !styleOf(node, state.lengths).mixesLinear;
  Affine map = state.transform;
  if (!userSpace) {
    const Box box = boxOf(shape);
    const double w = box.right - box.left, h = box.bottom - box.top;
    if (!(w > 0 && h > 0)) return nullptr; // nothing to measure by: not painted
    map = map * Affine{w, 0, 0, h, box.left, box.top};
  }
  if (const pugi::xml_attribute a = gradientAttribute(node, "gradientTransform")) {
    Affine own;
    if (parseTransform(a.value(), state.lengths, own)) {
      if (own.a * own.d == own.b * own.c) return nullptr; // it has no extent
      map = map * own;
    } else {
      reporter_.error(document_.line(a, 0), element(node) + " has an error in its gradientTransform, which is ignored");
    }
  }
  const double to[6] = {map.a, map.b, map.c, map.d, map.e, map.f};
  bool finite = true;
  for (size_t i = 0; i < 6; ++i) finite = finite && std::isfinite(g.transform[i] = static_cast<float>(to[i]));
  for (const float v : {g.start[0], g.start[1], g.end[0], g.end[1], g.startRadius, g.endRadius})
    finite = finite && std::isfinite(v);
  if (!finite) {
    reporter_.error(document_.line(node), element(node) + " reaches beyond all numbers; not painted");
    return nullptr;
  }
  g.stops = made->stops.data();
  g.stopCount = static_cast<uint32_t>(made->stops.size());
  return made;
}

} // namespace gpgp::vector::svg
