// Basic shapes (SVG 2, chapter 10) and viewBoxes (8.2).
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {

namespace {
/// The data of path("M0 0..."), with either quotes; what is not written so stays as it is.
std::string_view insidePath(std::string_view text) {
  Scanner s(text);
  if (!s.take("path(") || text.back() != ')') return text;
  text = trim(text.substr(s.offset(), text.size() - s.offset() - 1));
  const bool quoted = text.size() > 1 && (text[0] == '"' || text[0] == '\'') && text.back() == text[0];
  return quoted ? text.substr(1, text.size() - 2) : text;
}
} // namespace

double Importer::length(pugi::xml_node node, const Style& style, const char* name, const LengthContext& lengths,
                        LengthAxis axis, double otherwise, bool* given) {
  const pugi::xml_attribute a = node.attribute(name);
  const std::string* styled = style.geometryOf(name);
  if (given) *given = false;
  const std::string_view text = trim(styled ? std::string_view(*styled) : a.value());
  if ((!a && !styled) || text == "auto") return otherwise;
  double value = 0;
  if (hasVariables(text)) {
    const std::optional<std::string> plain = withoutVariables(text, style.variables.get());
    if (plain && parseLength(*plain, lengths, axis, value)) return (given ? *given = true : true), value;
  }
  if (!parseLength(text, lengths, axis, value)) {
    noLength(node, styled ? document_.place(node) : document_.place(a, 0), name, text);
    return otherwise;
  }
  if (given) *given = true;
  return value;
}

double Importer::extent(pugi::xml_node node, const Style& style, const char* name, const LengthContext& lengths,
                        LengthAxis axis, double otherwise, bool* given, std::optional<double> ifNegative) {
  bool has = false;
  const double value = length(node, style, name, lengths, axis, otherwise, &has);
  const bool negative = has && value < 0;
  if (negative) reporter_.error(document_.place(node), element(node) + " has a negative " + name + "; ignored");
  if (given) *given = has && !negative;
  return negative ? ifNegative.value_or(otherwise) : value;
}

Shape Importer::shapeOf(pugi::xml_node node, std::string_view name, const State& state, std::vector<size_t>* silent) {
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  const double scale = state.transform.scale();
  const double tolerance = detail_.arcs / (std::clamp(std::isfinite(scale) ? scale : 1.0, 1e-9, 1e9) * detail_.scale);
  const auto along = [&](const char* attribute, LengthAxis axis, double otherwise = 0, bool* given = nullptr) {
    return length(node, state.style, attribute, lengths, axis, otherwise, given);
  };
  // A size below zero is an error, one of zero draws nothing.
  const auto positive = [&](const char* attribute, double value) {
    if (value < 0) reporter_.error(document_.place(node), element(node) + " has a negative " + attribute);
    return value > 0;
  };
  // One below zero is as if it were not there.
  const auto radius = [&](const char* attribute, LengthAxis axis, bool* given) {
    double value = along(attribute, axis, 0, given);
    if (value < 0) {
      reporter_.ignored(document_.place(node), element(node) + " has a negative " + attribute + "; ignored");
      value = 0;
      *given = false;
    }
    return value;
  };
  Shape shape;
  if (name == "path") {
    const pugi::xml_attribute d = node.attribute("d");
    const std::string* styled = state.style.geometryOf("d");
    const std::string_view data = styled ? insidePath(*styled) : d.value();
    const size_t bad = parsePathData(data, shape, tolerance, silent);
    if (bad != std::string_view::npos)
      reporter_.error(styled ? document_.place(node) : document_.place(d, bad),
                      element(node) + " has an error in its path data at character " + std::to_string(bad + 1) +
                          "; drawn up to there");
  } else if (name == "rect") {
    const double w = along("width", LengthAxis::X), h = along("height", LengthAxis::Y);
    bool hasX = false, hasY = false;
    double rx = radius("rx", LengthAxis::X, &hasX), ry = radius("ry", LengthAxis::Y, &hasY);
    if (!hasX) rx = ry;
    if (!hasY) ry = rx;
    if (positive("width", w) && positive("height", h))
      shape = rectangle(along("x", LengthAxis::X), along("y", LengthAxis::Y), w, h, rx, ry, tolerance);
  } else if (name == "circle") {
    const double r = along("r", LengthAxis::Diagonal);
    if (positive("r", r)) shape = ellipse(along("cx", LengthAxis::X), along("cy", LengthAxis::Y), r, r, tolerance);
  } else if (name == "ellipse") {
    bool hasX = false, hasY = false;
    double rx = radius("rx", LengthAxis::X, &hasX), ry = radius("ry", LengthAxis::Y, &hasY);
    if (!hasX) rx = ry;
    if (!hasY) ry = rx;
    if (positive("rx", rx) && positive("ry", ry))
      shape = ellipse(along("cx", LengthAxis::X), along("cy", LengthAxis::Y), rx, ry, tolerance);
  } else if (name == "line") {
    shape.move({along("x1", LengthAxis::X), along("y1", LengthAxis::Y)});
    shape.line({along("x2", LengthAxis::X), along("y2", LengthAxis::Y)});
  } else { // polyline, polygon
    const pugi::xml_attribute points = node.attribute("points");
    if (!parsePoints(points.value(), name == "polygon", shape))
      reporter_.error(document_.place(points, 0), element(node) + " has an error in its points; drawn up to there");
  }
  return shape;
}

std::optional<ViewBox> parseViewBox(std::string_view text) {
  double v[4] = {};
  Scanner s(text);
  s.skipSpace();
  for (double& n : v) {
    if (!s.number(n)) return std::nullopt;
    s.skipCommaSpace();
  }
  if (!s.done() || !(v[2] >= 0 && v[3] >= 0)) return std::nullopt;
  return ViewBox{v[0], v[1], v[2], v[3]};
}

std::optional<AspectRatio> parseAspectRatio(std::string_view text) {
  Scanner s(trim(text));
  const auto word = [&s] {
    const std::string_view name = s.name();
    s.skipSpace();
    return name;
  };
  std::string_view align = word();
  if (align == "defer") align = word();
  AspectRatio ratio;
  if (align == "none") {
    ratio = {0, 0, false, false};
  } else {
    if (align.size() != 8 || align[0] != 'x' || align[4] != 'Y') return std::nullopt;
    constexpr std::string_view places[] = {"Min", "Mid", "Max"};
    const auto x = std::find(std::begin(places), std::end(places), align.substr(1, 3)),
               y = std::find(std::begin(places), std::end(places), align.substr(5));
    if (x == std::end(places) || y == std::end(places)) return std::nullopt;
    ratio.alignX = 0.5 * static_cast<double>(x - std::begin(places));
    ratio.alignY = 0.5 * static_cast<double>(y - std::begin(places));
  }
  const std::string_view how = word();
  if (!s.done() || !(how.empty() || how == "meet" || how == "slice")) return std::nullopt;
  ratio.slice = how == "slice";
  return ratio;
}

core::Result<Affine> fitPage(std::span<const std::byte> bytes, const float (&page)[4], double width, double height) {
  Document document;
  if (auto ok = document.load(bytes); !ok) return ok.error();
  const auto at = [&page](size_t i) { return static_cast<double>(page[i]); };
  const AspectRatio how =
      parseAspectRatio(document.root().attribute("preserveAspectRatio").value()).value_or(AspectRatio{});
  const std::optional<ViewBox> box = parseViewBox(document.root().attribute("viewBox").value());
  if (!box || !(box->width > 0 && box->height > 0)) return fitViewBox({at(0), at(1), at(2), at(3)}, width, height, how);
  const Affine there = fitViewBox(*box, at(2), at(3), how), here = fitViewBox(*box, width, height, how);
  const double x = here.a / there.a, y = here.d / there.d;
  return Affine{x, 0, 0, y, here.e - x * (there.e + at(0)), here.f - y * (there.f + at(1))};
}

Affine fitViewBox(const ViewBox& box, double width, double height, const AspectRatio& ratio) {
  double sx = width / box.width, sy = height / box.height;
  if (ratio.uniform) sx = sy = ratio.slice ? std::max(sx, sy) : std::min(sx, sy);
  const double e = ratio.alignX * (width - box.width * sx) - box.x * sx;
  const double f = ratio.alignY * (height - box.height * sy) - box.y * sy;
  return {sx, 0, 0, sy, e, f};
}

} // namespace gpgp::vector::svg
