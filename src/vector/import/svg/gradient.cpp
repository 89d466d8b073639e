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

const Importer::GradientChain& Importer::chainOf(pugi::xml_node gradient) {
  constexpr size_t kLongest = 32;
  const auto [known, isNew] = chains_.try_emplace(gradient.hash_value());
  GradientChain& chain = known->second;
  if (!isNew) return chain;
  for (chain.gradients.push_back(gradient);; chain.gradients.push_back(gradient)) {
    const pugi::xml_attribute attribute = hrefOf(gradient);
    const std::string_view href = trim(attribute.value());
    if (!attribute) return chain;
    const auto noTemplate = [&](const std::string& why) {
      reporter_.ignored(document_.place(attribute, 0), element(gradient) + " refers to '" +
                                                           std::string(href.substr(0, 60)) + "', which " + why +
                                                           "; ignored");
    };
    if (!href.empty() && href[0] != '#') return chain.otherFile = href, chain;
    const pugi::xml_node next = document_.find(href);
    if (!next) return noTemplate("does not exist"), chain;
    const std::string_view name = document_.name(gradient), kind = oneOf(name, kGradients) ? "gradient" : name;
    if (kind == "gradient" ? !oneOf(document_.name(next), kGradients) : document_.name(next) != name)
      return noTemplate("is not a " + std::string(kind) + " but a " + element(next)), chain;
    if (std::find(chain.gradients.begin(), chain.gradients.end(), next) != chain.gradients.end())
      return noTemplate("is one of its own templates"), chain;
    if (chain.gradients.size() == kLongest) return noTemplate("is one more than 32 in a row"), chain;
    gradient = next;
  }
}

/// The first along the references that has the attribute. What the other kind of gradient does not have is none of its
/// attributes (SVG 2, 14.2.2 and 14.2.3).
pugi::xml_attribute Importer::gradientAttribute(const GradientChain& chain, const char* name) const {
  constexpr std::string_view linear[] = {"x1", "y1", "x2", "y2"}, radial[] = {"cx", "cy", "r", "fx", "fy", "fr"};
  for (const pugi::xml_node gradient : chain.gradients) {
    const pugi::xml_attribute a = gradient.attribute(name);
    const bool isLinear = document_.name(gradient) == "linearGradient";
    if (a && !(isLinear ? oneOf(name, radial) : oneOf(name, linear))) return a;
  }
  return {};
}

std::vector<GpgpGradientStop> Importer::gradientStops(const GradientChain& chain, const LengthContext& lengths) {
  std::vector<GpgpGradientStop> stops;
  for (const pugi::xml_node gradient : chain.gradients) {
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
      cascade(child, around, lengths, own);
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
    if (!stops.empty()) break;
  }
  return stops;
}

std::shared_ptr<const Gradient> Importer::gradientOf(const GradientChain& chain, bool radial, const Surface& surface) {
  const pugi::xml_node node = chain.gradients[0];
  const State& state = surface.state;
  auto made = std::make_shared<Gradient>();
  made->stops = gradientStops(chain, state.lengths);
  if (made->stops.empty()) return nullptr;
  const auto text = [&](const char* name) { return std::string_view(gradientAttribute(chain, name).value()); };
  const auto isOneOf = [&](const char* name, std::initializer_list<std::string_view> words) {
    const pugi::xml_attribute a = gradientAttribute(chain, name);
    if (a && std::find(words.begin(), words.end(), trim(a.value())) == words.end()) ignored(node, a);
  };
  isOneOf("gradientUnits", {"userSpaceOnUse", "objectBoundingBox"});
  isOneOf("spreadMethod", {"pad", "reflect", "repeat"});
  const bool userSpace = trim(text("gradientUnits")) == "userSpaceOnUse";
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  if (!userSpace) lengths.width = lengths.height = 1;
  const auto number = [&](const char* name, LengthAxis axis, double percent) {
    const double whole = axis == LengthAxis::X   ? lengths.width
                         : axis == LengthAxis::Y ? lengths.height
                                                 : std::hypot(lengths.width, lengths.height) / std::sqrt(2);
    const pugi::xml_attribute a = gradientAttribute(chain, name);
    double value = percent / 100 * whole;
    if (a && !parseLength(trim(a.value()), lengths, axis, value)) {
      noLength(node, document_.place(a, 0), name, a.value());
      value = percent / 100 * whole;
    }
    if (value < 0 && axis == LengthAxis::Diagonal) { // a radius
      reporter_.error(document_.place(a, 0), element(node) + " has a negative " + name + ", which counts as none");
      value = 0;
    }
    return static_cast<float>(value);
  };
  GpgpGradient& g = made->gradient;
  g.kind = radial ? GPGP_GRADIENT_RADIAL : GPGP_GRADIENT_LINEAR;
  if (radial) {
    g.end[0] = number("cx", LengthAxis::X, 50);
    g.end[1] = number("cy", LengthAxis::Y, 50);
    g.endRadius = number("r", LengthAxis::Diagonal, 50);
    g.start[0] = gradientAttribute(chain, "fx") ? number("fx", LengthAxis::X, 50) : g.end[0];
    g.start[1] = gradientAttribute(chain, "fy") ? number("fy", LengthAxis::Y, 50) : g.end[1];
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
  const bool isEdge = radial && g.startRadius == g.endRadius && g.start[0] == g.end[0] && g.start[1] == g.end[1];
  if (isEdge && g.spread == GPGP_SPREAD_PAD) g.endRadius *= 1.0001f; // the first colour inside, the last around it
  g.interpolateSrgb = !styleOf(node, state.lengths).mixesLinear;
  Affine map = surface.space;
  if (!userSpace) {
    const Box box = surface.box();
    const double w = box.right - box.left, h = box.bottom - box.top;
    if (!(w > 0 && h > 0)) return nullptr; // nothing to measure by: not painted
    map = map * Affine{w, 0, 0, h, box.left, box.top};
  }
  for (const pugi::xml_node gradient : chain.gradients) { // the property, whose attribute gradientTransform is
    const Style style = styleOf(gradient, state.lengths);
    if (!style.isMoved()) continue;
    const Affine own = transformOf(gradient, style, lengths); // its box is what its units measure by
    if (own.a * own.d == own.b * own.c) return nullptr;       // it has no extent
    map = map * own;
    break;
  }
  const double to[6] = {map.a, map.b, map.c, map.d, map.e, map.f};
  bool finite = true;
  for (size_t i = 0; i < 6; ++i) finite = finite && std::isfinite(g.transform[i] = static_cast<float>(to[i]));
  for (const float v : {g.start[0], g.start[1], g.end[0], g.end[1], g.startRadius, g.endRadius})
    finite = finite && std::isfinite(v);
  if (!finite) {
    reporter_.error(document_.place(node), element(node) + " reaches beyond all numbers; not painted");
    return nullptr;
  }
  g.stops = made->stops.data();
  g.stopCount = static_cast<uint32_t>(made->stops.size());
  return made;
}

} // namespace gpgp::vector::svg
