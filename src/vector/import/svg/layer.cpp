// Elements that are shown as one: opacity, masks (CSS Masking 1, chapters 6 and 7), filters and modes of mixing
// (Compositing and Blending 1) as groups. What masks and filters show besides goes to groups without parents.
#include "vector/import/svg/filter_reader.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {
namespace {
constexpr double kMaxNumber = 3e7; ///< of what a layer holds

/// Whether it is a number or a percentage, as parts of a box are.
bool isFraction(std::string_view text) { return text.find_first_not_of("+-.0123456789eE%") == text.npos; }
void store(const Affine& m, float (&transform)[6]) {
  const double to[6] = {m.a, m.b, m.c, m.d, m.e, m.f};
  for (size_t i = 0; i < 6; ++i) transform[i] = static_cast<float>(to[i]);
}
void addMapped(Box& box, const Affine& map, const float (&region)[4]) {
  const auto at = [&region](size_t i) { return static_cast<double>(region[i]); };
  for (const Point corner : {Point{at(0), at(1)}, Point{at(2), at(1)}, Point{at(0), at(3)}, Point{at(2), at(3)}})
    box.add(map(corner));
}
Affine affineOf(const float (&t)[6]) {
  const auto at = [&t](size_t i) { return static_cast<double>(t[i]); };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}
/// Whether a map, as a layer holds it, has an inverse, and neither is beyond what a layer holds.
bool isUsable(const Affine& exact) {
  float stored[6];
  store(exact, stored);
  const Affine m = affineOf(stored);
  const double determinant = m.a * m.d - m.b * m.c;
  if (!(std::fabs(determinant) > 1e-20)) return false;
  const Affine back = inverseOf(m);
  for (const Affine& map : {m, back})
    for (const double v : {map.a, map.b, map.c, map.d, map.e, map.f})
      if (!(std::fabs(v) <= kMaxNumber)) return false;
  return true;
}
} // namespace

std::optional<Box> Importer::effectRegion(const GradientChain& chain, const char* unitsName, const State& state,
                                          const std::function<Box()>& box) {
  const pugi::xml_node node = chain.gradients[0];
  const pugi::xml_attribute units = gradientAttribute(chain, unitsName);
  const std::string_view unit = trim(units.value());
  const bool userSpace = unit == "userSpaceOnUse";
  if (units && !userSpace && unit != "objectBoundingBox") ignored(node, units);
  LengthContext lengths = state.lengths;
  lengths.fontSize = styleOf(node, state.lengths).fontSize; // where the attributes are
  if (!userSpace) lengths.width = lengths.height = 1;
  const auto along = [&](const char* name, LengthAxis axis, double part) {
    const pugi::xml_attribute a = gradientAttribute(chain, name);
    const double otherwise = part * (axis == LengthAxis::X ? lengths.width : lengths.height);
    double value = otherwise;
    const std::string_view text = trim(a.value());
    if (a && ((!userSpace && !isFraction(text)) || !parseLength(text, lengths, axis, value))) {
      noLength(node, document_.place(a, 0), name, a.value());
      value = otherwise;
    }
    return value;
  };
  double x = along("x", LengthAxis::X, -0.1), y = along("y", LengthAxis::Y, -0.1);
  double w = along("width", LengthAxis::X, 1.2), h = along("height", LengthAxis::Y, 1.2);
  if (!userSpace) {
    const Box b = box();
    const double bw = b.right - b.left, bh = b.bottom - b.top;
    if (!(bw > 0 && bh > 0)) return std::nullopt;
    x = b.left + x * bw, y = b.top + y * bh, w *= bw, h *= bh;
  }
  if (!(w > 0 && h > 0) || !std::isfinite(x + y + w + h)) return std::nullopt;
  return Box{x, y, x + w, y + h};
}

Affine Importer::spaceOf(pugi::xml_node node, std::string_view name, const State& state) {
  if (node == document_.root()) // a box of CSS, in pixels of the page
    return !state.style.isMoved() ? Affine{} : state.transform * inverseOf(toPage_);
  if (name != "use") return state.transform;
  LengthContext lengths = state.lengths; // its x and y move its own coordinates
  lengths.fontSize = state.style.fontSize;
  return state.transform * Affine{1,
                                  0,
                                  0,
                                  1,
                                  length(node, state.style, "x", lengths, LengthAxis::X, 0),
                                  length(node, state.style, "y", lengths, LengthAxis::Y, 0)};
}

Box Importer::boxOfElement(pugi::xml_node node, std::string_view name, const State& state, const Affine& space) {
  if (node == document_.root() && result_.width > 0 && result_.height > 0) return {0, 0, result_.width, result_.height};
  return boxAround(node, name, state, space);
}

uint32_t Importer::aside(State inner, const std::function<void(State&)>& show) {
  if (stopped_) return 0;
  const size_t groupsBefore = result_.groups.size(), asideBefore = aside_.size();
  result_.groups.push_back({});
  inner.group = static_cast<uint32_t>(result_.groups.size());
  inner.opacity = 1;
  inner.clips = inner.fading = 0;
  ++inner.layers;
  ++inner.depth;
  const uint32_t own = inner.group, outer = group_;
  std::vector<ImportedPath> paths;
  std::swap(paths, result_.paths);
  show(inner);
  std::swap(paths, result_.paths);
  group_ = outer;
  if (paths.empty()) {
    madeClips_.clear();
    result_.groups.resize(groupsBefore);
    aside_.resize(asideBefore);
    return 0;
  }
  aside_.insert(aside_.end(), std::make_move_iterator(paths.begin()), std::make_move_iterator(paths.end()));
  return own;
}

pugi::xml_node Importer::maskOf(pugi::xml_node from, const State& state) {
  const std::string& value = state.style.mask;
  if (value.empty()) return {};
  const std::string reference = referenceOf(value);
  const pugi::xml_node target = reference.empty() ? pugi::xml_node() : document_.find(reference);
  const auto without = [&](const std::string& why) {
    reporter_.ignored(document_.place(from),
                      "mask '" + value.substr(0, 60) + "' " + why + ": " + element(from) + " is drawn without it");
    return pugi::xml_node();
  };
  if (reference.empty()) {
    reporter_.warn(document_.place(from),
                   "mask '" + value.substr(0, 60) + "' is not supported: " + element(from) + " is drawn without it");
    return {};
  }
  if (!target) return without("does not exist");
  if (document_.name(target) != "mask") return without("is not a mask");
  const bool isInside =
      std::any_of(used_.begin(), used_.end(), [&](pugi::xml_node used) { return document_.name(used) == "mask"; });
  if (std::find(used_.begin(), used_.end(), target) != used_.end() ||
      (isInside && refersBack(target, &Style::mask, state.lengths)))
    return without("contains itself");
  return target;
}

bool Importer::mask(pugi::xml_node target, pugi::xml_node node, const State& state, const Affine& space,
                    const std::function<Box()>& box, ImportedLayer& layer) {
  if (stopped(target)) return false;
  GradientChain alone;
  alone.gradients.push_back(target);
  const std::optional<Box> region = effectRegion(alone, "maskUnits", state, box);
  if (!region) return false;
  const pugi::xml_attribute units = target.attribute("maskContentUnits");
  const std::string_view unit = trim(units.value());
  const bool byBox = unit == "objectBoundingBox";
  if (units && !byBox && unit != "userSpaceOnUse") ignored(target, units);
  State inner = state;
  inner.style = styleOf(target, state.lengths);
  inner.transform = space;
  inner.context = nullptr;
  if (byBox) {
    const Box b = box();
    const double bw = b.right - b.left, bh = b.bottom - b.top;
    if (!(bw > 0 && bh > 0)) {
      reporter_.ignored(document_.place(node),
                        "mask is in units of a box without extent: " + element(node) + " is drawn without it");
      return true;
    }
    inner.transform = space * Affine{bw, 0, 0, bh, b.left, b.top};
  }
  const Style style = inner.style;
  GpgpLayer& l = layer.layer;
  l.maskKind = style.masksByAlpha ? GPGP_MASK_ALPHA : GPGP_MASK_LUMINANCE;
  l.maskEncoding = style.mixesLinear ? GPGP_IMAGE_LINEAR : GPGP_IMAGE_SRGB;
  const double sides[4] = {region->left, region->top, region->right, region->bottom};
  for (size_t i = 0; i < 4; ++i) l.maskRegion[i] = static_cast<float>(std::clamp(sides[i], -kMaxNumber, kMaxNumber));
  store(space, l.maskTransform);
  // What is around a mask's content: of its own properties a mask.
  inner.style.filter.clear();
  inner.style.clipPath.clear();
  inner.style.opacity = 1;
  inner.style.blend = GPGP_BLEND_NORMAL;
  used_.push_back(target);
  const Frame frame{space, box};
  l.mask = aside(std::move(inner), [&](State& own) {
    grouped(
        target, "mask", own,
        [&](State& content) {
          content.style = style.inherited();
          visitChildren(target, content);
        },
        &frame);
  });
  used_.pop_back();
  return l.mask != 0;
}

void Importer::grouped(pugi::xml_node node, std::string_view name, State& state,
                       const std::function<void(State&)>& inside, const Frame* of) {
  const double opacity = state.style.opacity;
  if (!(opacity > 0)) return;
  const size_t before = result_.paths.size(), groupsBefore = result_.groups.size(), asideBefore = aside_.size();
  const auto nothing = [&] {
    if (result_.groups.size() > groupsBefore) madeClips_.clear();
    result_.paths.resize(before);
    result_.groups.resize(groupsBefore);
    aside_.resize(asideBefore);
  };
  const Style& style = state.style;
  const bool clips = !style.clipPath.empty();
  if (clips && style.blend != GPGP_BLEND_NORMAL && detail_.layers && layerCount_ < limits_.layers &&
      state.clips + state.fading + state.layers + 1 < GPGP_MAX_LAYER_DEPTH) { // a clip isolates: blends are around it
    const auto layer = std::make_shared<ImportedLayer>();
    layer->layer.blend = style.blend;
    result_.groups.push_back({state.group, 1, false, {}});
    const auto group = static_cast<uint32_t>(result_.groups.size());
    state.group = group;
    ++state.layers, ++layerCount_;
    state.style.blend = GPGP_BLEND_NORMAL;
    grouped(node, name, state, inside, of);
    if (result_.paths.size() == before) return nothing();
    ++blendCount_;
    result_.groups[group - 1].layer = layer;
    return;
  }
  // Clips are outermost: they cut what comes of all the rest.
  if (clips) clip(node, name, state, of);
  const pugi::xml_node masked = maskOf(node, state);
  const std::vector<FilterFunction> functions = filtersOf(node, state);
  const bool filters = !functions.empty(), blends = style.blend != GPGP_BLEND_NORMAL;
  bool effects = masked || filters || blends;
  const Affine space = !effects ? Affine{} : of ? of->space : spaceOf(node, name, state);
  const auto without = [&](const std::string& why) {
    effects = false;
    reporter_.warn(document_.place(node),
                   "mask, filter or mix-blend-mode " + why + ": " + element(node) + " is drawn without it");
  };
  const uint32_t depth = state.clips + state.fading + state.layers;
  const bool fits = detail_.layers ? depth < GPGP_MAX_LAYER_DEPTH : state.fading < shader::kMaxLayerDepth;
  if (effects && !detail_.layers) without("is not drawn inside a render pass");
  if (effects && depth >= GPGP_MAX_LAYER_DEPTH) without("is inside too many others");
  if (effects && ++layerCount_ > limits_.layers)
    without("is one more than the " + std::to_string(limits_.layers) + " that a drawing can have");
  if (effects && (masked || filters) && !isUsable(space)) without("has coordinates that are too large or too small");
  const bool fades = opacity < 1 && fits;
  if (!fades) state.opacity *= opacity;
  // What isolates others without being drawn apart itself.
  const bool isolates =
      mayBlend_ && detail_.layers && !effects && !fades && (style.isolated || clips) && depth < GPGP_MAX_LAYER_DEPTH;
  const size_t blendsBefore = blendCount_;
  uint32_t group = 0; // 1 + index
  if (effects || fades || isolates) {
    result_.groups.push_back({state.group, fades ? static_cast<float>(opacity) : 1.0f, false, {}});
    state.group = group = static_cast<uint32_t>(result_.groups.size());
    ++(effects || isolates ? state.layers : state.fading);
  }
  const State own = state;
  inside(state);
  size_t drawn = result_.paths.size() - before;
  if (effects) {
    const auto layer = std::make_shared<ImportedLayer>();
    std::optional<Box> known;
    const auto box = [&] {
      if (of) return of->box();
      if (!known) known = boxOfElement(node, name, own, space);
      return *known;
    };
    if (filters) {
      const size_t groupsUntilHere = result_.groups.size(), asideUntilHere = aside_.size();
      FilterReader reader{*this, own, node, space, box, drawnBox(before, groupsBefore, inverseOf(space)), *layer};
      if (!reader.read(functions)) return nothing();
      if (reader.tooMany) {
        layer->steps.clear(); // and what they would have shown
        if (result_.groups.size() > groupsUntilHere) madeClips_.clear();
        result_.groups.resize(groupsUntilHere);
        aside_.resize(asideUntilHere);
        reporter_.warn(document_.place(node),
                       "filter has more steps than are supported: " + element(node) + " is drawn without it");
      } else if (drawn == 0) { // what a filter makes of nothing has a place in the order as well
        group_ = group;
        const float(&r)[4] = layer->steps.back().region;
        const auto at = [&r](size_t i) { return static_cast<double>(r[i]); };
        emit(rectangle(at(0), at(1), at(2) - at(0), at(3) - at(1), 0, 0, 1), space, GPGP_FILL_NON_ZERO, {}, 1, node);
        if (result_.paths.size() > before) result_.paths.back().color[3] = 0;
        drawn = result_.paths.size() - before;
      }
    }
    if (drawn == 0) return nothing();
    if (masked && !mask(masked, node, own, space, box, *layer)) return nothing();
    layer->layer.blend = style.blend;
    blendCount_ += blends;
    result_.groups[group - 1].layer = layer;
    return;
  }
  if (drawn == 0) return nothing();
  if (isolates && blendCount_ > blendsBefore) {
    const auto layer = std::make_shared<ImportedLayer>();
    layer->layer.isolated = 1;
    result_.groups[group - 1].layer = layer;
  } else if (fades && drawn == 1) { // one path needs no group to fade
    for (size_t g = group; g < result_.groups.size(); ++g)
      if (result_.groups[g].layer) return;
    ImportedPath& path = result_.paths.back();
    path.color[3] = static_cast<float>(static_cast<double>(path.color[3]) * opacity);
    result_.groups[group - 1].opacity = 1;
    if (path.group == group) {
      path.group = result_.groups[group - 1].parent;
      result_.groups.resize(group - 1);
    }
  } else if (opacity < 1 && !fades && drawn > 1) {
    reporter_.warn(document_.place(node),
                   "opacity of " + element(node) + ", inside too many that fade, is applied to each of its paths");
  }
}

Box Importer::drawnBox(size_t firstPath, size_t firstGroup, const Affine& back) const {
  Box box;
  for (size_t i = firstPath; i < result_.paths.size(); ++i)
    for (size_t k = 0; k + 1 < result_.paths[i].points.size(); k += 2)
      box.add(
          back({static_cast<double>(result_.paths[i].points[k]), static_cast<double>(result_.paths[i].points[k + 1])}));
  for (size_t g = firstGroup; g < result_.groups.size(); ++g)
    if (const auto& layer = result_.groups[g].layer; layer && !layer->steps.empty())
      addMapped(box, back * affineOf(layer->layer.filterTransform), layer->steps.back().region);
  return box;
}

} // namespace gpgp::vector::svg
