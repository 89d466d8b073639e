// What an element looks like: presentation attributes, then style sheets, then the style attribute, then what is
// important (CSS Cascade 4); and what a paint comes to.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {
namespace {
/// The attribute that an element has for the property transform.
const char* transformAttribute(std::string_view name) {
  return oneOf(name, kGradients) ? "gradientTransform" : name == "pattern" ? "patternTransform" : "transform";
}
} // namespace

void Importer::cascade(pugi::xml_node node, const Style& parent, const LengthContext& outer, Style& style) {
  struct Setting {
    std::string_view name, value;
  };
  std::vector<Setting> settings;
  const bool isRoot = node == document_.root();
  const std::string_view ownTransform = transformAttribute(document_.name(node));
  for (const pugi::xml_attribute a : node.attributes()) {
    std::string_view name = a.name(), value = a.value();
    if (name == "transform" && name != ownTransform) continue; // paints have another attribute for it (SVG 2, 8.5)
    if (name == ownTransform && name != "transform") {
      name = "transform";
      if (trim(value).empty()) value = "none"; // is one, which is no template's
    }
    if (name == "transform" && value != "none" && !isPlainTransform(value)) {
      badTransform(node, document_.place(a, 0), a.name(), value);
      continue;
    }
    if (isPresentationAttribute(name)) settings.push_back({name, value});
  }
  std::vector<const Declaration*> declared;
  if (!sheet_.empty() && work_ < limits_.matches) {
    declared = sheet_.match(document_, node, work_, limits_.matches);
    if (work_ >= limits_.matches)
      reporter_.error(document_.place(node), "the style sheets ask for too much; from here on they are left out",
                      GPGP_ERROR_UNSUPPORTED);
  }
  const std::vector<Declaration> own = parseDeclarations(node.attribute("style").value());
  for (const Declaration& d : own) declared.push_back(&d);
  for (const bool important : {false, true})
    for (const Declaration* d : declared)
      if (d->important == important) settings.push_back({d->name, d->value});

  LengthContext lengths = outer;
  lengths.fontSize = parent.fontSize;
  if (isRoot) lengths.rootFontSize = Style{}.fontSize; // for its own size; not for its other lengths
  const auto set = [&](const Setting& s) {
    const Applied applied = applyProperty(style, parent, s.name, s.value, lengths);
    if (applied == Applied::Unknown && isGeometry(s.name)) style.geometry.emplace_back(s.name, s.value);
    if (applied == Applied::Unknown &&
        (isUnsupported(s.name, s.value) || (isRoot && isUnsupportedOnRoot(s.name, s.value))))
      reporter_.warn(document_.place(node),
                     std::string(s.name) + " is not supported: " + element(node) + " is drawn without it");
    if (applied == Applied::Invalid) ignored(node, document_.place(node), s.name, s.value);
  };
  const auto apply = [&](const Setting& s) {
    if (s.name.empty()) return ignored(node, document_.place(node), "the declaration", s.value);
    if (s.name.starts_with("--")) return;
    if (hasVariables(s.value)) {
      const std::optional<std::string> value = withoutVariables(s.value, style.variables.get());
      work_ += s.value.size() / 16 + (value ? value->size() / 16 : 0);
      if (!value) {
        reporter_.ignored(document_.place(node),
                          valueOf(node, s.name, s.value) + "a variable without a value; it is as if it were unset");
        return (void)applyProperty(style, parent, s.name, "unset", lengths);
      }
      return set({s.name, *value});
    }
    set(s);
  };
  CustomProperties variables;
  for (const Setting& s : settings)
    if (s.name.starts_with("--")) variables.insert_or_assign(std::string(s.name), std::string(s.value));
  if (!variables.empty()) style.variables = cascadeVariables(parent.variables, variables);
  const auto isOfFont = [](const Setting& s) { return s.name.starts_with("font"); };
  for (const Setting& s : settings) { // lengths in em need its size, and `font` sets all of the font
    constexpr std::string_view all[] = {"font-size", "font-family", "font-weight", "font-style", "font-variant"};
    constexpr std::string_view keywords[] = {"inherit", "initial", "unset"};
    if (s.name == "font" && oneOf(lowered(trim(s.value)), keywords))
      for (const std::string_view name : all) apply({name, s.value});
    else if (isOfFont(s))
      apply(s);
  }
  lengths.fontSize = style.fontSize;
  if (isRoot) lengths.rootFontSize = style.fontSize;
  for (const Setting& s : settings)
    if (!isOfFont(s)) apply(s);
}

void Importer::badTransform(pugi::xml_node node, const Place& place, std::string_view name, std::string_view value) {
  if (hasUnsupported(value)) return ignored(node, place, "transform", value);
  reporter_.error(place, element(node) + " has an error in its " + std::string(name) + ", which is ignored");
}

Affine Importer::transformOf(pugi::xml_node node, const Style& style, const LengthContext& outer,
                             const std::function<Box()>& box) {
  Affine own;
  if (!style.isMoved()) return own;
  const char* name = transformAttribute(document_.name(node));
  const pugi::xml_attribute text = node.attribute(name);
  const Place place = text && text.value() == style.transform ? document_.place(text, 0) : document_.place(node);
  LengthContext lengths = outer;
  lengths.fontSize = style.fontSize;
  Point corner;
  if (style.byOwnBox && box) {
    const Box b = box();
    const bool isThere = b.right >= b.left && b.bottom >= b.top;
    lengths.width = isThere ? b.right - b.left : 0, lengths.height = isThere ? b.bottom - b.top : 0;
    if (isThere) corner = {b.left, b.top};
  }
  // The properties of CSS Transforms 2, in their order, are functions of these names.
  const struct {
    const char* name;
    const std::string& value;
  } singles[] = {{"translate", style.translate}, {"rotate", style.rotate}, {"scale", style.scale}};
  for (const auto& single : singles) {
    if (single.value.empty()) continue;
    Affine one;
    std::string values;
    for (std::string_view rest = single.value; !(rest = trim(rest)).empty();) {
      const size_t end = rest.find('(') == rest.npos ? rest.find_first_of(" \t\r\n\f") : rest.npos;
      values.append(values.empty() ? "" : ",").append(rest.substr(0, end));
      rest = end == rest.npos ? std::string_view() : rest.substr(end);
    }
    if (!parseTransform(std::string(single.name) + "(" + values + ")", lengths, one))
      ignored(node, document_.place(node), single.name, single.value);
    own = own * one;
  }
  Affine listed;
  if (!style.transform.empty() && !parseTransform(style.transform, lengths, listed)) {
    badTransform(node, place, text ? name : "transform", style.transform);
    listed = {};
  }
  own = own * listed;
  Point origin;
  if (!style.transformOrigin.empty() && !parseOrigin(style.transformOrigin, lengths, origin)) {
    ignored(node, place, "transform-origin", style.transformOrigin);
    origin = {};
    if (!style.byOwnBox) return own;
  }
  origin = origin + corner;
  return Affine{1, 0, 0, 1, origin.x, origin.y} * own * Affine{1, 0, 0, 1, -origin.x, -origin.y};
}

Box Importer::boxOfContext(const Context& context) {
  if (!context.box) {
    std::vector<pugi::xml_node> inside(used_.begin() + static_cast<ptrdiff_t>(context.used), used_.end());
    used_.resize(context.used); // as the <use> was met
    context.box = boxAround(context.node, document_.name(context.node), *context.state, context.space);
    used_.insert(used_.end(), inside.begin(), inside.end());
  }
  return *context.box;
}

std::optional<Importer::Ink> Importer::resolve(const Paint& paint, const Surface& surface, pugi::xml_node node,
                                               const char* property) {
  const State& state = surface.state;
  if (paint.kind == Paint::Kind::ContextFill || paint.kind == Paint::Kind::ContextStroke) {
    const Context* context = state.context;
    const bool isFill = paint.kind == Paint::Kind::ContextFill;
    if (!context) {
      reporter_.ignored(document_.place(node), element(node) + " " + property + " is context-" +
                                                   (isFill ? "fill" : "stroke") +
                                                   " outside of what a <use> or a marker shows; it is not painted");
      return std::nullopt;
    }
    const Style& style = context->state->style;
    return resolve(isFill ? style.fill : style.stroke,
                   {*context->state, context->space, [&] { return boxOfContext(*context); }}, node, property);
  }
  const auto plain = [&](Paint::Kind kind) -> std::optional<Ink> {
    if (kind == Paint::Kind::Solid) return Ink{paint.color, nullptr};
    if (kind == Paint::Kind::Current) return Ink{state.style.color, nullptr};
    return std::nullopt;
  };
  if (paint.kind != Paint::Kind::Reference) return plain(paint.kind);
  const pugi::xml_node target = document_.find(paint.reference);
  const std::string_view name = target ? document_.name(target) : std::string_view();
  const std::string who = element(node) + " " + property;
  const std::string instead = paint.hasFallback ? "its fallback is used" : "it is not painted";
  if (name == "pattern") {
    const GradientChain& chain = chainOf(target);
    if (std::find(used_.begin(), used_.end(), target) != used_.end()) {
      reporter_.ignored(document_.place(node), who + " refers to a pattern that contains itself; " + instead);
      return plain(paint.fallback);
    }
    if (!chain.otherFile.empty())
      reporter_.warn(document_.place(node), who + " refers to a pattern that refers to another file, '" +
                                                std::string(chain.otherFile.substr(0, 60)) +
                                                "', which is not supported");
    const bool isEmpty = !contentOf(chain);
    if (!isEmpty)
      if (auto tiling = tilingOf(chain, surface)) return Ink{{0, 0, 0, 1}, nullptr, nullptr, std::move(tiling)};
    reporter_.ignored(document_.place(node),
                      who + " refers to a pattern without " + (isEmpty ? "content; " : "extent; ") + instead);
    return plain(paint.fallback);
  }
  if (oneOf(name, kGradients)) {
    const GradientChain& chain = chainOf(target);
    if (!chain.otherFile.empty())
      reporter_.warn(document_.place(node), who + " refers to a gradient that refers to another file, '" +
                                                std::string(chain.otherFile.substr(0, 60)) +
                                                "', which is not supported");
    if (auto gradient = gradientOf(chain, name == "radialGradient", surface))
      return Ink{{0, 0, 0, 1}, std::move(gradient)};
    if (gradientStops(chain, state.lengths).empty()) { // is there, so that the fallback does not count
      reporter_.ignored(document_.place(node), who + " refers to a gradient without stops; it is not painted");
      return std::nullopt;
    }
    reporter_.ignored(document_.place(node), who + " refers to a gradient without extent; " + instead);
    return plain(paint.fallback);
  }
  const std::string shown = std::string("'") + paint.reference.substr(0, 60) + "'";
  if (!paint.reference.starts_with('#'))
    reporter_.warn(document_.place(node),
                   who + " refers to another file, " + shown + ", which is not supported; " + instead);
  else if (name.empty())
    reporter_.ignored(document_.place(node), who + " refers to " + shown + ", which does not exist; " + instead);
  else
    reporter_.warn(document_.place(node),
                   who + " refers to a <" + std::string(name.substr(0, 40)) + ">, which is not supported; " + instead);
  return plain(paint.fallback);
}

} // namespace gpgp::vector::svg
