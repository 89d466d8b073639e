// What an element looks like: presentation attributes, then style sheets, then the style attribute, then what is
// important (CSS Cascade 4); and the colour a paint comes to.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {

void Importer::cascade(pugi::xml_node node, std::string_view name, const Style& parent, const LengthContext& outer,
                       Style& style) {
  struct Setting {
    std::string_view name, value;
  };
  std::vector<Setting> settings;
  for (const pugi::xml_attribute a : node.attributes())
    if (isProperty(a.name())) settings.push_back({a.name(), a.value()});
  std::vector<const Declaration*> declared;
  if (!sheet_.empty() && work_ < limits_.matches) {
    declared = sheet_.match(name, node.attribute("id").value(), node.attribute("class").value(), work_);
    if (work_ >= limits_.matches)
      reporter_.error(document_.line(node), "the style sheets ask for too much; from here on they are left out",
                      GPGP_ERROR_UNSUPPORTED);
  }
  const std::vector<Declaration> own = parseDeclarations(node.attribute("style").value());
  for (const Declaration& d : own) declared.push_back(&d);
  for (const bool important : {false, true})
    for (const Declaration* d : declared)
      if (d->important == important) settings.push_back({d->name, d->value});

  LengthContext lengths = outer;
  lengths.fontSize = parent.fontSize;
  const auto apply = [&](const Setting& s) {
    if (applyProperty(style, parent, s.name, s.value, lengths) == Applied::Invalid)
      reporter_.warn(document_.line(node), element(node) + " has " + std::string(s.name) + " '" +
                                               std::string(s.value.substr(0, 60)) + "', which is not valid; ignored");
  };
  for (const Setting& s : settings) // lengths in em need it
    if (s.name == "font-size") apply(s);
  lengths.fontSize = style.fontSize;
  for (const Setting& s : settings)
    if (s.name != "font-size") apply(s);
}

std::optional<Color> Importer::resolve(const Paint& paint, const Style& style, pugi::xml_node node,
                                       const char* property) {
  const auto plain = [&](Paint::Kind kind) -> std::optional<Color> {
    if (kind == Paint::Kind::Solid) return paint.color;
    if (kind == Paint::Kind::Current) return style.color;
    return std::nullopt;
  };
  if (paint.kind != Paint::Kind::Reference) return plain(paint.kind);
  const pugi::xml_node target = document_.find(paint.reference);
  const std::string_view name = target ? document_.name(target) : std::string_view();
  const std::string who = element(node) + " " + property;
  const std::string instead = paint.hasFallback ? "its fallback is used" : "it is not painted";
  if (name == "linearGradient" || name == "radialGradient") {
    const auto known = averages_.find(target.hash_value());
    const std::optional<Color> average =
        known != averages_.end() ? known->second : (averages_[target.hash_value()] = averageOfStops(target, style));
    if (average) {
      reporter_.warn(document_.line(node), std::string("gradient approximated by its average colour: ") + who);
      return average;
    }
    reporter_.warn(document_.line(node), who + " refers to a gradient without stops; " + instead);
    return plain(paint.fallback);
  }
  const std::string shown = std::string("'") + paint.reference.substr(0, 60) + "'";
  if (name.empty())
    reporter_.warn(document_.line(node), who + " refers to " + shown + ", which is not there; " + instead);
  else
    reporter_.warn(document_.line(node),
                   who + " refers to a <" + std::string(name.substr(0, 40)) + ">, which is not supported; " + instead);
  return plain(paint.fallback);
}

/// The mean over the gradient's length, of premultiplied linear light, so that a transparent end takes nothing along.
std::optional<Color> Importer::averageOfStops(pugi::xml_node gradient, const Style& style) {
  std::vector<std::pair<double, Color>> stops; // linear, premultiplied
  for (int hops = 0; gradient && hops < 32 && stops.empty(); ++hops) {
    for (const pugi::xml_node child : gradient.children()) {
      if (document_.name(child) != "stop") continue;
      if (++steps_ > limits_.points) return std::nullopt;
      Style own = style.inherited();
      cascade(child, "stop", style, {}, own);
      double offset = 0;
      Scanner s(trim(child.attribute("offset").value()));
      if (s.number(offset) && s.take("%")) offset /= 100;
      offset = std::clamp(offset, stops.empty() ? 0.0 : stops.back().first, 1.0);
      const Color c = own.stopIsCurrent ? own.color : own.stopColor;
      const double alpha = c.a * own.stopOpacity;
      stops.push_back(
          {offset, {linearFromSrgb(c.r) * alpha, linearFromSrgb(c.g) * alpha, linearFromSrgb(c.b) * alpha, alpha}});
    }
    gradient = document_.find(hrefOf(gradient).value());
  }
  if (stops.empty()) return std::nullopt;
  Color sum{0, 0, 0, 0};
  const auto add = [&sum](double weight, const Color& c) {
    sum = {sum.r + weight * c.r, sum.g + weight * c.g, sum.b + weight * c.b, sum.a + weight * c.a};
  };
  add(stops.front().first, stops.front().second);
  add(1 - stops.back().first, stops.back().second);
  for (size_t i = 0; i + 1 < stops.size(); ++i) {
    const double half = (stops[i + 1].first - stops[i].first) / 2;
    add(half, stops[i].second);
    add(half, stops[i + 1].second);
  }
  if (!(sum.a > 0)) return Color{0, 0, 0, 0};
  const auto srgb = [&sum](double v) {
    v = std::clamp(v / sum.a, 0.0, 1.0);
    return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  };
  return Color{srgb(sum.r), srgb(sum.g), srgb(sum.b), std::min(sum.a, 1.0)};
}

} // namespace gpgp::vector::svg
