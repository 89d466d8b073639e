// Filters (Filter Effects 1): a list of functions and of <filter> elements as one list of steps, each with its region.
#include "vector/import/svg/filter_reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {
constexpr float kReach = 3e7f;
constexpr double kMaxDeviation = 65536;

bool isEmpty(const Box& b) { return !(b.right > b.left && b.bottom > b.top); }
Box cut(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}
void unite(Box& box, const Box& other) {
  if (!(other.right >= other.left && other.bottom >= other.top)) return;
  box.add({other.left, other.top});
  box.add({other.right, other.bottom});
}
void store(const Box& box, float (&region)[4]) {
  const double sides[4] = {box.left, box.top, box.right, box.bottom};
  for (size_t i = 0; i < 4; ++i) region[i] = std::clamp(static_cast<float>(sides[i]), -kReach, kReach);
}
Box boxOf(const float (&region)[4]) {
  const auto at = [&region](size_t i) { return static_cast<double>(region[i]); };
  return {at(0), at(1), at(2), at(3)};
}
} // namespace

GpgpFilterStep& Importer::FilterReader::add(GpgpFilterKind kind, const Box& region, int32_t encoding,
                                            std::initializer_list<double> values, uint32_t input, uint32_t input2) {
  if (layer.steps.size() >= GPGP_MAX_FILTER_STEPS || importer.filterSteps_ >= importer.limits_.filterSteps) {
    tooMany = true;
    return spare;
  }
  ++importer.filterSteps_;
  GpgpFilterStep step{};
  step.kind = kind;
  step.input = input, step.input2 = input2;
  step.encoding = encoding;
  store(isEmpty(region) ? Box{0, 0, 0, 0} : region, step.region);
  size_t count = 0;
  for (const double value : values) step.values[count++] = std::clamp(static_cast<float>(value), -kReach, kReach);
  layer.steps.push_back(step);
  return layer.steps.back();
}

uint32_t Importer::FilterReader::sourceAlpha() {
  if (!hasAlpha_) { // of what the function before has made
    GpgpFilterStep& step = add(GPGP_FILTER_COLOR_MATRIX, region_, GPGP_IMAGE_SRGB, {}, source_);
    step.values[18] = 1;
    alpha_ = last();
    hasAlpha_ = true;
  }
  return alpha_;
}

Box Importer::FilterReader::regionOfInput(uint32_t input) const {
  if (isStandard(input)) return region_;
  return boxOf(layer.steps[input - GPGP_FILTER_FIRST_STEP].region);
}

uint32_t Importer::FilterReader::inputOf(pugi::xml_node primitive, const char* name) {
  const pugi::xml_attribute a = primitive.attribute(name);
  const std::string_view in = trim(a.value());
  if (in.empty()) return previous_;
  if (in == "SourceGraphic") return source_;
  if (in == "SourceAlpha") return sourceAlpha();
  if (const auto found = results_.find(in); found != results_.end()) return found->second;
  constexpr std::string_view others[] = {"BackgroundImage", "BackgroundAlpha", "FillPaint", "StrokePaint"};
  if (oneOf(in, others))
    unsupported(primitive, std::string(name) + " '" + std::string(in) + "'");
  else
    importer.ignored(primitive, a);
  return previous_;
}

/// Filter Effects 1, 8.1 and 9.2: by default the region of the inputs, or of the filter.
Box Importer::FilterReader::subregion(const Primitive& p, const std::vector<uint32_t>& inputs) {
  Box whole = region_;
  const bool standard = std::any_of(inputs.begin(), inputs.end(), [this](uint32_t i) { return isStandard(i); });
  if (!inputs.empty() && !standard && p.name != "feTile") {
    whole = {};
    for (const uint32_t input : inputs) unite(whole, regionOfInput(input));
  }
  LengthContext lengths = state.lengths;
  lengths.fontSize = p.style.fontSize;
  if (byBox_) lengths.width = lengths.height = 1;
  const double bw = unit_.right - unit_.left, bh = unit_.bottom - unit_.top;
  const auto along = [&](const char* name, LengthAxis axis, double otherwise) {
    bool given = false;
    const std::string_view text = trim(p.node.attribute(name).value());
    if (byBox_ && text.find_first_not_of("+-.0123456789eE%") != text.npos) { // parts of a box have no units
      importer.noLength(p.node, importer.document_.place(p.node.attribute(name), 0), name, text);
      return otherwise;
    }
    double value = importer.length(p.node, {}, name, lengths, axis, 0, &given); // by no style sheet
    if (!given) return otherwise;
    const bool isX = axis == LengthAxis::X;
    if (byBox_) value *= isX ? bw : bh;
    if (byBox_ && name[1] == '\0') value += isX ? unit_.left : unit_.top;
    return value;
  };
  const double x = along("x", LengthAxis::X, whole.left), y = along("y", LengthAxis::Y, whole.top);
  const double w = along("width", LengthAxis::X, whole.right - whole.left);
  const double h = along("height", LengthAxis::Y, whole.bottom - whole.top);
  return onPixels({x, y, x + w, y + h});
}

Box Importer::FilterReader::onPixels(const Box& b) const {
  if (isEmpty(b) || space.b != 0 || space.c != 0 || !(space.a > 0 && space.d > 0)) return b;
  const double sx = space.a * importer.detail_.scale, sy = space.d * importer.detail_.scale;
  const double ox = space.e * importer.detail_.scale, oy = space.f * importer.detail_.scale;
  const auto low = [](double v, double s, double o) { return (std::floor(v * s + o + 1e-4) - o) / s; };
  const auto high = [](double v, double s, double o) { return (std::ceil(v * s + o - 1e-4) - o) / s; };
  return {low(b.left, sx, ox), low(b.top, sy, oy), high(b.right, sx, ox), high(b.bottom, sy, oy)};
}

void Importer::FilterReader::setDistances(GpgpFilterStep& step, size_t first) const {
  const double lengths[2] = {std::copysign(std::hypot(space.a, space.b), space.a),
                             std::copysign(std::hypot(space.c, space.d), space.d)};
  for (size_t k = 0; k < 2; ++k) {
    const double distance = std::clamp(1 / (lengths[k] * importer.detail_.scale), -1e6, 1e6);
    if (std::abs(distance - 1) > 1e-6) step.values[first + k] = static_cast<float>(distance);
  }
}

Box Importer::FilterReader::regionOf(const Box& place) const { return cuts_ ? cut(place, region_) : place; }

bool Importer::FilterReader::readElement(pugi::xml_node filter) {
  const GradientChain& chain = importer.chainOf(filter);
  filter_ = filter;
  const std::optional<Box> region = importer.effectRegion(chain, "filterUnits", state, box);
  if (!region) return false;
  const bool isFirst = layer.steps.empty();
  const pugi::xml_attribute units = importer.gradientAttribute(chain, "primitiveUnits");
  const std::string_view unit = trim(units.value());
  byBox_ = unit == "objectBoundingBox";
  if (units && !byBox_ && unit != "userSpaceOnUse") importer.ignored(filter, units);
  if (byBox_) {
    unit_ = box();
    if (!(unit_.right >= unit_.left && unit_.bottom >= unit_.top)) unit_ = {0, 0, 0, 0};
  }
  region_ = onPixels(*region);
  if (isFirst) {
    store(region_, layer.layer.filterRegion);
  } else {
    add(GPGP_FILTER_OFFSET, region_, GPGP_IMAGE_SRGB, {0, 0}, source_);
    source_ = last();
    hasAlpha_ = false;
  }
  if (importer.gradientAttribute(chain, "filterRes")) unsupported(filter, "filterRes");
  previous_ = source_;
  results_.clear();
  pugi::xml_node content = filter; // whose primitives they are
  for (const pugi::xml_node f : chain.gradients) {
    const auto children = f.children();
    if (std::none_of(children.begin(), children.end(),
                     [](const pugi::xml_node& child) { return child.type() == pugi::node_element; }))
      continue;
    content = f;
    break;
  }
  cuts_ = true;
  for (const pugi::xml_node child : content.children())
    if (importer.document_.name(child) == "feTile") cuts_ = false; // it repeats the whole of a region
  const size_t before = layer.steps.size();
  constexpr std::string_view silent[] = {"title",        "desc",          "metadata",         "animate", "set",
                                         "animateColor", "animateMotion", "animateTransform", "script"};
  bool any = false;
  for (const pugi::xml_node child : content.children()) {
    const std::string_view name = importer.document_.name(child);
    if (name.empty() || oneOf(name, silent)) continue;
    if (++importer.elements_ > importer.limits_.elements || tooMany) break;
    Primitive p;
    p.node = child;
    p.name = name;
    p.style = importer.styleOf(child, state.lengths);
    p.encoding = p.style.filtersLinear ? GPGP_IMAGE_LINEAR : GPGP_IMAGE_SRGB;
    const size_t own = layer.steps.size();
    readPrimitive(p);
    if (layer.steps.size() == own) continue; // it is no primitive
    any = true;
    previous_ = last();
    if (const std::string_view result = trim(child.attribute("result").value()); !result.empty())
      results_.insert_or_assign(std::string(result), previous_);
  }
  if (!any) return false;            // an empty filter shows nothing
  if (layer.steps.size() > before) { // nothing of it is outside of its region
    float(&shown)[4] = layer.steps.back().region;
    const Box both = cut(boxOf(shown), region_);
    store(isEmpty(both) ? Box{0, 0, 0, 0} : both, shown);
  }
  source_ = last();
  hasAlpha_ = false;
  return true;
}

void Importer::FilterReader::readFunction(const FilterFunction& f) {
  using Kind = FilterFunction::Kind;
  constexpr double kDeviations = 3.1; // what is further away than these does not show
  const auto matrix = [&](std::initializer_list<double> rows) {
    GpgpFilterStep& step = add(GPGP_FILTER_COLOR_MATRIX, region_, GPGP_IMAGE_SRGB, {}, source_);
    size_t i = 0;
    for (const double v : rows) step.values[i / 3 * 5 + i % 3] = static_cast<float>(v), ++i;
    step.values[18] = 1;
    return &step;
  };
  const auto linear = [&](double slope, double intercept) {
    GpgpFilterStep* step = matrix({slope, 0, 0, 0, slope, 0, 0, 0, slope});
    for (const size_t row : {0u, 1u, 2u}) step->values[5 * row + 4] = static_cast<float>(intercept);
  };
  const bool spreads = f.kind == Kind::Blur || f.kind == Kind::DropShadow;
  const double most = spreads ? kMaxDeviation : static_cast<double>(kReach); // no factor below is larger than v
  const double v = f.kind == Kind::HueRotate ? f.amount : std::min(f.amount, most), rest = 1 - v;
  switch (f.kind) {
  case Kind::Blur:
  case Kind::DropShadow: {
    const double reach = kDeviations * v;
    Box around{region_.left - reach, region_.top - reach, region_.right + reach, region_.bottom + reach};
    if (f.kind == Kind::Blur) {
      region_ = around;
      add(GPGP_FILTER_GAUSSIAN_BLUR, region_, GPGP_IMAGE_SRGB, {v, v}, source_);
      break;
    }
    around.left += f.x, around.right += f.x, around.top += f.y, around.bottom += f.y;
    unite(region_, around);
    const auto c = colorOf({f.color.value_or(state.style.color), false}, 1, state.style);
    add(GPGP_FILTER_DROP_SHADOW, region_, GPGP_IMAGE_SRGB, {v, v, f.x, f.y, c[0], c[1], c[2], c[3]}, source_);
    break;
  }
  case Kind::Brightness: linear(v, 0); break;
  case Kind::Contrast: linear(v, 0.5 - 0.5 * v); break;
  case Kind::Invert: linear(1 - 2 * v, v); break;
  case Kind::Opacity: matrix({1, 0, 0, 0, 1, 0, 0, 0, 1})->values[18] = static_cast<float>(v); break;
  case Kind::Grayscale:
    matrix({0.2126 + 0.7874 * rest, 0.7152 - 0.7152 * rest, 0.0722 - 0.0722 * rest, 0.2126 - 0.2126 * rest,
            0.7152 + 0.2848 * rest, 0.0722 - 0.0722 * rest, 0.2126 - 0.2126 * rest, 0.7152 - 0.7152 * rest,
            0.0722 + 0.9278 * rest});
    break;
  case Kind::Sepia:
    matrix({0.393 + 0.607 * rest, 0.769 - 0.769 * rest, 0.189 - 0.189 * rest, 0.349 - 0.349 * rest,
            0.686 + 0.314 * rest, 0.168 - 0.168 * rest, 0.272 - 0.272 * rest, 0.534 - 0.534 * rest,
            0.131 + 0.869 * rest});
    break;
  case Kind::Saturate:
  case Kind::HueRotate: {
    const auto m = f.kind == Kind::Saturate ? saturation(v) : hueRotation(v);
    matrix({m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]});
    break;
  }
  default: break;
  }
  source_ = last();
  hasAlpha_ = false;
}

bool Importer::FilterReader::read(const std::vector<FilterFunction>& functions) {
  region_ = drawn;
  const double to[6] = {space.a, space.b, space.c, space.d, space.e, space.f};
  for (size_t i = 0; i < 6; ++i) layer.layer.filterTransform[i] = static_cast<float>(to[i]);
  const bool byReference = functions[0].kind == FilterFunction::Kind::Reference;
  if (!byReference) {
    if (!(drawn.right >= drawn.left && drawn.bottom >= drawn.top)) return false; // there is nothing to work on
    store(drawn, layer.layer.filterRegion);
  }
  for (const FilterFunction& f : functions) {
    if (f.kind != FilterFunction::Kind::Reference)
      readFunction(f);
    else if (!readElement(importer.document_.find(f.reference)))
      return false;
    if (tooMany) break;
  }
  return true;
}

std::vector<FilterFunction> Importer::filtersOf(pugi::xml_node node, const State& state) {
  std::vector<FilterFunction> filters;
  for (const FilterFunction& f : state.style.filter) {
    if (f.kind != FilterFunction::Kind::Reference) {
      filters.push_back(f);
      continue;
    }
    const std::string shown = "filter '" + f.reference.substr(0, 60) + "' ";
    const std::string rest = ": " + element(node) + " is drawn without it";
    const pugi::xml_node target = document_.find(f.reference);
    if (!f.reference.starts_with('#'))
      reporter_.warn(document_.place(node), shown + "of another file is not supported" + rest);
    else if (!target || document_.name(target) != "filter")
      reporter_.ignored(document_.place(node), shown + (target ? "is not a filter" : "does not exist") + rest);
    else if (std::find(used_.begin(), used_.end(), target) != used_.end())
      reporter_.ignored(document_.place(node), shown + "contains itself" + rest);
    else
      filters.push_back(f);
  }
  return filters;
}

} // namespace gpgp::vector::svg
