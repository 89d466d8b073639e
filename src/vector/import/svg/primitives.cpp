// The primitives of filters (Filter Effects 1, chapters 9 and 10) as steps. What is in error passes its input on or
// shows nothing, as the chapter of each says.
#include "vector/import/svg/data_uri.h"
#include "vector/import/svg/filter_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gpgp::vector::svg {
namespace {
constexpr double kMaxDeviation = 65536;
constexpr size_t kMaxOrder = 32;
constexpr double kReach = 3e7; // of a step's numbers

double radiansOf(double degrees) { return degrees * std::numbers::pi / 180; }
} // namespace

std::array<double, 9> saturation(double s) {
  return {0.213 + 0.787 * s, 0.715 - 0.715 * s, 0.072 - 0.072 * s, 0.213 - 0.213 * s, 0.715 + 0.285 * s,
          0.072 - 0.072 * s, 0.213 - 0.213 * s, 0.715 - 0.715 * s, 0.072 + 0.928 * s};
}

std::array<double, 9> hueRotation(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {0.213 + c * 0.787 - s * 0.213, 0.715 - c * 0.715 - s * 0.715, 0.072 - c * 0.072 + s * 0.928,
          0.213 - c * 0.213 + s * 0.143, 0.715 + c * 0.285 + s * 0.140, 0.072 - c * 0.072 - s * 0.283,
          0.213 - c * 0.213 - s * 0.787, 0.715 - c * 0.715 + s * 0.715, 0.072 + c * 0.928 + s * 0.072};
}

void Importer::FilterReader::unsupported(pugi::xml_node from, const std::string& what) {
  importer.reporter_.warn(importer.document_.place(from),
                          what + " is not supported: " + importer.element(from) + " is drawn without it");
}

std::vector<double> Importer::FilterReader::numbers(pugi::xml_node from, const char* name, size_t most) {
  const pugi::xml_attribute a = from.attribute(name);
  std::vector<double> list;
  Scanner s(trim(a.value()));
  while (!s.done() && list.size() <= most) {
    double value = 0;
    if (!s.number(value)) {
      importer.ignored(from, a);
      return {};
    }
    list.push_back(value);
    s.skipCommaSpace();
  }
  return list;
}

double Importer::FilterReader::number(pugi::xml_node from, const char* name, double otherwise) {
  const pugi::xml_attribute a = from.attribute(name);
  if (!a) return otherwise;
  Scanner s(trim(a.value()));
  double value = 0;
  if (s.number(value) && s.done()) return value;
  importer.ignored(from, a);
  return otherwise;
}

/// One number stands for both.
std::array<double, 2> Importer::FilterReader::pair(const Primitive& p, const char* name, double otherwise) {
  const std::vector<double> list = numbers(p.node, name, 2);
  if (list.empty() || list.size() > 2) {
    if (!list.empty()) importer.ignored(p.node, p.node.attribute(name));
    return {otherwise, otherwise};
  }
  return {list[0], list.back()};
}

const float* Importer::FilterReader::table(std::vector<float> numbers, GpgpFilterStep& step) {
  importer.filterNumbers_ += numbers.size();
  if (importer.filterNumbers_ > importer.limits_.filterNumbers) tooMany = true, numbers.clear();
  layer.tables.push_back(std::make_shared<const std::vector<float>>(std::move(numbers)));
  step.table = layer.tables.back()->data();
  step.tableCount = static_cast<uint32_t>(layer.tables.back()->size());
  return step.table;
}

std::array<double, 4> Importer::FilterReader::colorOf(const Style::StopColor& color, double opacity,
                                                      const Style& style) const {
  const Color c = color.isCurrent ? style.color : color.color;
  return {linearFromSrgb(c.r), linearFromSrgb(c.g), linearFromSrgb(c.b), c.a * opacity};
}

void Importer::FilterReader::blend(Primitive& p) {
  const uint32_t below = inputOf(p.node, "in2");
  GpgpBlendMode mode = GPGP_BLEND_NORMAL;
  const pugi::xml_attribute a = p.node.attribute("mode");
  if (a && (!parseBlendMode(trim(a.value()), mode) || mode == GPGP_BLEND_PLUS_LIGHTER)) { // not one of <blend-mode>
    importer.ignored(p.node, a);
    mode = GPGP_BLEND_NORMAL;
  }
  add(GPGP_FILTER_BLEND, p.region, p.encoding, {}, p.input, below).mode = mode;
}

void Importer::FilterReader::colorMatrix(Primitive& p) {
  constexpr std::string_view types[] = {"matrix", "saturate", "hueRotate", "luminanceToAlpha"};
  const int32_t type = choice(p.node, "type", types, 0);
  const pugi::xml_attribute text = p.node.attribute("values");
  std::vector<double> values = numbers(p.node, "values", 20);
  if ((type == 1 || type == 2) && values.size() > 1) values.resize(1); // librsvg and resvg take the first one
  const size_t wanted = type == 0 ? 20 : type == 3 ? values.size() : 1;
  if (text && values.size() != wanted) {
    if (!values.empty()) importer.ignored(p.node, text);
    values.clear();
  }
  if (values.empty() && type != 3) {
    if (type == 0) return passOn(p);
    values = {type == 1 ? 1.0 : 0.0};
  }
  GpgpFilterStep& step = add(GPGP_FILTER_COLOR_MATRIX, p.region, p.encoding, {}, p.input);
  float* m = step.values;
  if (type == 0) {
    for (size_t i = 0; i < 20; ++i) m[i] = std::clamp(static_cast<float>(values[i]), -3e7f, 3e7f);
  } else if (type == 3) {
    m[15] = 0.2125f, m[16] = 0.7154f, m[17] = 0.0721f;
  } else {
    const auto rows = type == 1 ? saturation(std::clamp(values[0], 0.0, kReach)) : hueRotation(radiansOf(values[0]));
    for (size_t i = 0; i < 9; ++i) m[i / 3 * 5 + i % 3] = static_cast<float>(rows[i]);
    m[18] = 1;
  }
}

void Importer::FilterReader::componentTransfer(Primitive& p) {
  constexpr std::string_view functions[] = {"feFuncR", "feFuncG", "feFuncB", "feFuncA"},
                             types[] = {"identity", "table", "discrete", "linear", "gamma"};
  constexpr size_t kInputs = 256, kMostValues = 4096;
  std::vector<float> results(4 * kInputs);
  for (size_t i = 0; i < results.size(); ++i) results[i] = static_cast<float>(i % kInputs) / (kInputs - 1);
  for (const pugi::xml_node child : p.node.children()) { // of several for a channel the last counts
    const std::string_view name = importer.document_.name(child);
    const auto* found = std::find(std::begin(functions), std::end(functions), name);
    if (found == std::end(functions)) continue;
    const int32_t type = choice(child, "type", types, 0);
    const std::vector<double> values =
        type == 1 || type == 2 ? numbers(child, "tableValues", kMostValues) : std::vector<double>{};
    if (values.size() > kMostValues) {
      unsupported(child, "tableValues of more than " + std::to_string(kMostValues) + " numbers");
      continue;
    }
    const double slope = number(child, "slope", 1), intercept = number(child, "intercept", 0),
                 amplitude = number(child, "amplitude", 1), exponent = number(child, "exponent", 1),
                 offset = number(child, "offset", 0);
    const size_t n = values.size();
    for (size_t i = 0; i < kInputs; ++i) {
      const double c = static_cast<double>(i) / (kInputs - 1);
      double v = c;
      if (type == 1 && n > 0) {
        const double at = c * static_cast<double>(n - 1);
        const size_t k = std::min(static_cast<size_t>(at), n - 1), next = std::min(k + 1, n - 1);
        v = values[k] + (at - static_cast<double>(k)) * (values[next] - values[k]);
      } else if (type == 2 && n > 0) {
        v = values[std::min(static_cast<size_t>(c * static_cast<double>(n)), n - 1)];
      } else if (type == 3) {
        v = slope * c + intercept;
      } else if (type == 4) {
        v = amplitude * std::pow(c, exponent) + offset;
      }
      results[static_cast<size_t>(found - functions) * kInputs + i] =
          static_cast<float>(std::isnan(v) ? 0 : std::clamp(v, 0.0, 1.0));
    }
  }
  table(std::move(results), add(GPGP_FILTER_COMPONENT_TRANSFER, p.region, p.encoding, {}, p.input));
}

void Importer::FilterReader::composite(Primitive& p) {
  constexpr std::string_view operators[] = {"over", "in", "out", "atop", "xor", "lighter", "arithmetic"};
  const uint32_t below = inputOf(p.node, "in2");
  const int32_t mode = choice(p.node, "operator", operators, 0);
  add(GPGP_FILTER_COMPOSITE, p.region, p.encoding,
      {number(p.node, "k1", 0), number(p.node, "k2", 0), number(p.node, "k3", 0), number(p.node, "k4", 0)}, p.input,
      below)
      .mode = mode;
}

void Importer::FilterReader::convolveMatrix(Primitive& p) {
  auto order = pair(p, "order", 3);
  const auto wrong = [&](const char* name) { // shows nothing
    importer.ignored(p.node, p.node.attribute(name) ? p.node.attribute(name) : p.node.attribute("order"));
    transparent(p);
  };
  const auto whole = [&](double& value, const char* name) { // as browsers and resvg read it
    if (value == std::trunc(value)) return;
    importer.reporter_.ignored(importer.document_.place(p.node.attribute(name), 0),
                               importer.valueOf(p.node, name, p.node.attribute(name).value()) +
                                   "no whole number; its fraction is ignored");
    value = std::trunc(value);
  };
  for (double& o : order) whole(o, "order");
  if (!(order[0] > 0 && order[1] > 0)) { // counts as not said (Filter Effects 1, 9.9)
    importer.ignored(p.node, p.node.attribute("order"));
    order = {3, 3};
  }
  if (std::max(order[0], order[1]) > static_cast<double>(kMaxOrder)) {
    unsupported(p.node, "order above " + std::to_string(kMaxOrder));
    return passOn(p);
  }
  const auto columns = static_cast<size_t>(order[0]), rows = static_cast<size_t>(order[1]);
  std::vector<double> kernel = numbers(p.node, "kernelMatrix", columns * rows);
  if (kernel.size() != columns * rows) {
    if (p.node.attribute("kernelMatrix")) return wrong("kernelMatrix");
    importer.reporter_.ignored(importer.document_.place(p.node), importer.element(p.node) + " has no kernelMatrix");
    return transparent(p);
  }
  // Only the kernel's ratio to the divisor shows: where one is beyond what a step holds, both become smaller.
  constexpr double unsaid = std::numeric_limits<double>::infinity();
  const double said = number(p.node, "divisor", unsaid);
  if (said == 0) return wrong("divisor"); // as browsers and resvg have it
  double divisor = said == unsaid ? 0 : said, sum = 0, most = 0;
  const auto shrink = [&](double largest) {
    if (!(largest > kReach)) return;
    for (double& k : kernel) k *= kReach / largest;
    divisor *= kReach / largest;
  };
  const auto isZero = [](double v) { return std::abs(v) < static_cast<double>(std::numeric_limits<float>::min()); };
  for (const double k : kernel) most = std::max(most, std::abs(k));
  shrink(most);
  for (const double k : kernel) sum += k;
  if (isZero(divisor)) divisor = isZero(sum) ? 1 : sum;
  shrink(std::abs(divisor));
  double x = number(p.node, "targetX", std::floor(order[0] / 2)),
         y = number(p.node, "targetY", std::floor(order[1] / 2));
  whole(x, "targetX"), whole(y, "targetY");
  if (!(x >= 0 && x < order[0])) return wrong("targetX");
  if (!(y >= 0 && y < order[1])) return wrong("targetY");
  constexpr std::string_view edges[] = {"none", "duplicate", "wrap"}, booleans[] = {"false", "true"};
  const int32_t edge = choice(p.node, "edgeMode", edges, GPGP_EDGE_DUPLICATE),
                keeps = choice(p.node, "preserveAlpha", booleans, 0);
  if (p.node.attribute("kernelUnitLength")) unsupported(p.node, "kernelUnitLength");
  const double bias = number(p.node, "bias", 0);
  GpgpFilterStep& step = add(GPGP_FILTER_CONVOLVE_MATRIX, p.region, p.encoding,
                             {order[0], order[1], x, y, divisor, bias, static_cast<double>(keeps)}, p.input);
  step.mode = edge;
  setDistances(step, 7);
  table(std::vector<float>(kernel.begin(), kernel.end()), step);
}

void Importer::FilterReader::lighting(Primitive& p) {
  constexpr std::string_view lights[] = {"feDistantLight", "fePointLight", "feSpotLight"};
  const bool specular = p.name == "feSpecularLighting";
  pugi::xml_node light;
  for (const pugi::xml_node child : p.node.children())
    if (!light && oneOf(importer.document_.name(child), lights)) light = child;
  if (!light) {
    importer.reporter_.ignored(importer.document_.place(p.node),
                               importer.element(p.node) + " has no light; it shows nothing");
    return transparent(p);
  }
  if (p.node.attribute("kernelUnitLength")) unsupported(p.node, "kernelUnitLength");
  double constant = number(p.node, specular ? "specularConstant" : "diffuseConstant", 1);
  const double surface = number(p.node, "surfaceScale", 1);
  double exponent = specular ? number(p.node, "specularExponent", 1) : 1;
  if (constant < 0) {
    importer.ignored(p.node, p.node.attribute(specular ? "specularConstant" : "diffuseConstant"));
    if (specular) return transparent(p);
    constant = 0;
  }
  exponent = std::clamp(exponent, 1.0, 128.0);
  // As it is written, whatever the primitive works in: librsvg and resvg agree on that.
  auto color = colorOf(p.style.lightingColor, 1, p.style);
  if (p.encoding == GPGP_IMAGE_LINEAR)
    for (size_t i = 0; i < 3; ++i) color[i] = srgbFromLinear(color[i]);
  const auto* kind = std::find(std::begin(lights), std::end(lights), importer.document_.name(light));
  std::vector<double> values = {surface, constant, color[0], color[1], color[2]};
  if (specular) values.push_back(exponent);
  const double bw = unit_.right - unit_.left, bh = unit_.bottom - unit_.top;
  const auto point = [&](const char* x, const char* y, const char* z) {
    const double at[3] = {number(light, x, 0), number(light, y, 0), number(light, z, 0)};
    values.push_back(byBox_ ? unit_.left + at[0] * bw : at[0]);
    values.push_back(byBox_ ? unit_.top + at[1] * bh : at[1]);
    values.push_back(byBox_ ? at[2] * std::hypot(bw, bh) / std::numbers::sqrt2 : at[2]);
  };
  if (kind == lights) {
    values.push_back(radiansOf(number(light, "azimuth", 0)));
    values.push_back(radiansOf(number(light, "elevation", 0)));
  } else {
    point("x", "y", "z");
    if (kind == lights + 2) {
      point("pointsAtX", "pointsAtY", "pointsAtZ");
      const double focus = number(light, "specularExponent", 1);
      values.push_back(focus > 0 ? focus : 1);
      const double cone = std::fabs(number(light, "limitingConeAngle", 180));
      values.push_back(light.attribute("limitingConeAngle") ? std::cos(radiansOf(std::min(cone, 180.0))) : -1);
    }
  }
  GpgpFilterStep& step =
      add(specular ? GPGP_FILTER_SPECULAR_LIGHTING : GPGP_FILTER_DIFFUSE_LIGHTING, p.region, p.encoding, {}, p.input);
  step.mode = static_cast<int32_t>(kind - lights);
  for (size_t i = 0; i < values.size(); ++i) step.values[i] = std::clamp(static_cast<float>(values[i]), -3e7f, 3e7f);
  setDistances(step, 14);
  for (const size_t k : {14u, 15u}) step.values[k] = std::abs(step.values[k]); // the light is not mirrored
}

void Importer::FilterReader::displacementMap(Primitive& p) {
  constexpr std::string_view channels[] = {"R", "G", "B", "A"};
  const uint32_t map = inputOf(p.node, "in2");
  double scale = number(p.node, "scale", 0);
  if (byBox_) scale *= std::hypot(unit_.right - unit_.left, unit_.bottom - unit_.top) / std::numbers::sqrt2;
  const int32_t x = choice(p.node, "xChannelSelector", channels, 3),
                y = choice(p.node, "yChannelSelector", channels, 3);
  add(GPGP_FILTER_DISPLACEMENT_MAP, p.region, p.encoding, {scale}, p.input, map).mode = x + 4 * y;
}

void Importer::FilterReader::dropShadow(Primitive& p) {
  const double bw = byBox_ ? unit_.right - unit_.left : 1, bh = byBox_ ? unit_.bottom - unit_.top : 1;
  auto deviation = pair(p, "stdDeviation", 2);
  if (deviation[0] < 0 || deviation[1] < 0) {
    importer.ignored(p.node, p.node.attribute("stdDeviation"));
    deviation = {0, 0};
  }
  const auto c = colorOf(p.style.floodColor, p.style.floodOpacity, p.style);
  add(GPGP_FILTER_DROP_SHADOW, p.region, p.encoding,
      {std::min(deviation[0] * bw, kMaxDeviation), std::min(deviation[1] * bh, kMaxDeviation),
       number(p.node, "dx", 2) * bw, number(p.node, "dy", 2) * bh, c[0], c[1], c[2], c[3]},
      p.input);
}

void Importer::FilterReader::flood(Primitive& p) {
  const auto c = colorOf(p.style.floodColor, p.style.floodOpacity, p.style);
  add(GPGP_FILTER_FLOOD, p.region, p.encoding, {c[0], c[1], c[2], c[3]});
}

void Importer::FilterReader::gaussianBlur(Primitive& p) {
  auto deviation = pair(p, "stdDeviation", 0);
  if (const std::string_view edge = trim(p.node.attribute("edgeMode").value()); !edge.empty() && edge != "none")
    unsupported(p.node, "edgeMode '" + std::string(edge.substr(0, 40)) + "'");
  if (deviation[0] < 0 || deviation[1] < 0) {
    importer.ignored(p.node, p.node.attribute("stdDeviation"));
    for (double& d : deviation) d = std::max(d, 0.0);
  }
  if (deviation[0] == 0 && deviation[1] == 0) return passOn(p);
  const double bw = byBox_ ? unit_.right - unit_.left : 1, bh = byBox_ ? unit_.bottom - unit_.top : 1;
  add(GPGP_FILTER_GAUSSIAN_BLUR, p.region, p.encoding,
      {std::min(deviation[0] * bw, kMaxDeviation), std::min(deviation[1] * bh, kMaxDeviation)}, p.input);
}

/// An embedded image, or an element where the subregion begins.
void Importer::FilterReader::image(Primitive& p) {
  const pugi::xml_attribute href = hrefOf(p.node);
  const std::string_view target = trim(href.value());
  State inner = state;
  inner.style = p.style;
  inner.opacity = 1;
  inner.context = nullptr;
  inner.transform = space;
  std::function<void(State&)> show;
  if (target.empty() || target[0] == '#') {
    const pugi::xml_node referred = importer.document_.find(target);
    const auto wrong = [&](const std::string& why) {
      importer.reporter_.ignored(importer.document_.place(p.node), importer.element(p.node) + " refers to '" +
                                                                       std::string(target.substr(0, 60)) + "', which " +
                                                                       why + "; it shows nothing");
      transparent(p);
    };
    if (!referred) return wrong("does not exist");
    bool inside = std::find(importer.used_.begin(), importer.used_.end(), referred) != importer.used_.end();
    for (pugi::xml_node up = node; up && !inside; up = up.parent()) inside = up == referred;
    if (inside) return wrong("contains itself");
    inner.transform = space * Affine{1, 0, 0, 1, p.place.left, p.place.top};
    inner.style = importer.styleOf(referred.parent(), state.lengths);
    show = [this, referred, filter = p.node.parent()](State& own) { // what has the filter is shown without it
      importer.used_.insert(importer.used_.end(), {referred, filter});
      importer.visit(referred, own);
      importer.used_.resize(importer.used_.size() - 2);
    };
  } else {
    show = [this, &p](State& own) {
      const Box& b = p.place;
      importer.drawPicture(p.node, own, {b.left, b.top, b.right - b.left, b.bottom - b.top});
    };
  }
  const uint32_t group = importer.aside(inner, show);
  if (!group) return transparent(p);
  const Affine back = inverseOf(space);
  add(GPGP_FILTER_GROUP, p.region, p.encoding, {back.a, back.b, back.c, back.d, back.e, back.f}).group = group;
}

void Importer::FilterReader::merge(Primitive& p) {
  std::vector<uint32_t> inputs;
  for (const pugi::xml_node child : p.node.children())
    if (importer.document_.name(child) == "feMergeNode") inputs.push_back(inputOf(child, "in"));
  if (inputs.empty()) return transparent(p);
  p.place = subregion(p, inputs);
  p.region = regionOf(p.place);
  p.input = inputs[0];
  if (inputs.size() == 1) return passOn(p);
  uint32_t below = inputs[0];
  for (size_t i = 1; i < inputs.size() && !tooMany; ++i) {
    add(GPGP_FILTER_COMPOSITE, p.region, p.encoding, {}, inputs[i], below).mode = GPGP_OPERATOR_OVER;
    below = last();
  }
}

void Importer::FilterReader::morphology(Primitive& p) {
  constexpr std::string_view operators[] = {"erode", "dilate"};
  const auto radius = pair(p, "radius", 0);
  const int32_t mode = choice(p.node, "operator", operators, 0);
  if (radius[0] < 0 || radius[1] < 0) importer.ignored(p.node, p.node.attribute("radius"));
  if (radius[0] < 0 || radius[1] < 0 || (radius[0] == 0 && radius[1] == 0)) return passOn(p);
  // Further away than it is large there is nothing of a region.
  const double bw = byBox_ ? unit_.right - unit_.left : 1, bh = byBox_ ? unit_.bottom - unit_.top : 1;
  constexpr double kMaxRadius = 16384;
  const double width = std::min(region_.right - region_.left, kMaxRadius),
               height = std::min(region_.bottom - region_.top, kMaxRadius);
  add(GPGP_FILTER_MORPHOLOGY, p.region, p.encoding, {std::min(radius[0] * bw, width), std::min(radius[1] * bh, height)},
      p.input)
      .mode = mode;
}

void Importer::FilterReader::offset(Primitive& p) {
  const double bw = byBox_ ? unit_.right - unit_.left : 1, bh = byBox_ ? unit_.bottom - unit_.top : 1;
  add(GPGP_FILTER_OFFSET, p.region, p.encoding, {number(p.node, "dx", 0) * bw, number(p.node, "dy", 0) * bh}, p.input);
}

void Importer::FilterReader::tile(Primitive& p) { add(GPGP_FILTER_TILE, p.region, p.encoding, {}, p.input); }

void Importer::FilterReader::turbulence(Primitive& p) {
  constexpr std::string_view types[] = {"fractalNoise", "turbulence"}, stitches[] = {"noStitch", "stitch"};
  constexpr double kMaxFrequency = 1e6, kMostOctaves = 16; // each is half of the one before
  const auto frequency = pair(p, "baseFrequency", 0);
  const double octaves = std::floor(number(p.node, "numOctaves", 1));
  const int32_t type = choice(p.node, "type", types, 1), stitch = choice(p.node, "stitchTiles", stitches, 0);
  const double seed = std::trunc(number(p.node, "seed", 0));
  if (frequency[0] < 0 || frequency[1] < 0) {
    importer.ignored(p.node, p.node.attribute("baseFrequency"));
    return transparent(p);
  }
  add(GPGP_FILTER_TURBULENCE, p.region, p.encoding,
      {std::min(frequency[0], kMaxFrequency), std::min(frequency[1], kMaxFrequency),
       std::clamp(octaves, 0.0, kMostOctaves), seed, static_cast<double>(stitch)})
      .mode = type;
}

void Importer::FilterReader::readPrimitive(Primitive& p) {
  using Reader = FilterReader;
  static constexpr struct {
    std::string_view name;
    void (Reader::*read)(Primitive&);
    int inputs; ///< by "in" and "in2"
  } kPrimitives[] = {{"feBlend", &Reader::blend, 2},
                     {"feColorMatrix", &Reader::colorMatrix, 1},
                     {"feComponentTransfer", &Reader::componentTransfer, 1},
                     {"feComposite", &Reader::composite, 2},
                     {"feConvolveMatrix", &Reader::convolveMatrix, 1},
                     {"feDiffuseLighting", &Reader::lighting, 1},
                     {"feSpecularLighting", &Reader::lighting, 1},
                     {"feDisplacementMap", &Reader::displacementMap, 2},
                     {"feDropShadow", &Reader::dropShadow, 1},
                     {"feFlood", &Reader::flood, 0},
                     {"feGaussianBlur", &Reader::gaussianBlur, 1},
                     {"feImage", &Reader::image, 0},
                     {"feMerge", &Reader::merge, 0},
                     {"feMorphology", &Reader::morphology, 1},
                     {"feOffset", &Reader::offset, 1},
                     {"feTile", &Reader::tile, 1},
                     {"feTurbulence", &Reader::turbulence, 0}};
  const auto* known =
      std::find_if(std::begin(kPrimitives), std::end(kPrimitives), [&p](const auto& k) { return k.name == p.name; });
  if (known == std::end(kPrimitives))
    return importer.reporter_.warn(importer.document_.place(p.node), importer.element(p.node) + " is not supported");
  std::vector<uint32_t> inputs;
  if (known->inputs > 0) inputs.push_back(p.input = inputOf(p.node, "in"));
  if (known->inputs > 1) inputs.push_back(inputOf(p.node, "in2"));
  p.place = subregion(p, inputs);
  p.region = regionOf(p.place);
  if (!(p.place.right > p.place.left && p.place.bottom > p.place.top)) return transparent(p);
  (this->*known->read)(p);
}

} // namespace gpgp::vector::svg
