// What clip-path refers to (CSS Masking 1, chapter 5): the shapes of a clipPath as the clip of a group, or as its mask
// where they have clips themselves.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace gpgp::vector::svg {
std::string referenceOf(std::string_view text) {
  if (text.size() < 5 || !isWord(text.substr(0, 4), "url(")) return {};
  text.remove_prefix(4);
  if (text.back() == ')') text.remove_suffix(1); // the end of the value closes what is open (CSS Syntax 3, 5.3)
  text = trim(text);
  if (text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
    text = text.substr(1, text.size() - 2);
  return std::string(text.substr(0, 1) == "#" ? text : std::string_view());
}

Affine inverseOf(const Affine& m) {
  const double area = m.a * m.d - m.b * m.c;
  if (!(std::fabs(area) > 0)) return {0, 0, 0, 0, 0, 0};
  return {
      m.d / area, -m.b / area, -m.c / area, m.a / area, (m.c * m.f - m.d * m.e) / area, (m.b * m.e - m.a * m.f) / area};
}

void Importer::measure(const Shape& shape, const Affine& transform) {
  Shape moved = shape;
  for (Point& p : moved.points) p = transform(p);
  if (moved.points.empty()) return;
  const Box box = boxOf(moved);
  box_.add({box.left, box.top});
  box_.add({box.right, box.bottom});
}

Box Importer::boxAround(pugi::xml_node node, std::string_view name, State state, const Affine& space,
                        const double* useSize) {
  box_ = {};
  toBox_ = inverseOf(space);
  const Mode outer = mode_;
  mode_ = Mode::Measure;
  content(node, name, state, useSize);
  mode_ = outer;
  return box_;
}

Style Importer::styleOf(pugi::xml_node node, const LengthContext& lengths) {
  const auto [known, isNew] = styles_.try_emplace(node.hash_value());
  if (!isNew) return known->second;
  std::vector<pugi::xml_node> above; // the innermost first
  for (pugi::xml_node up = node; up.type() == pugi::node_element && above.size() < limits_.depth; up = up.parent())
    above.push_back(up);
  Style& style = known->second;
  for (size_t i = above.size(); i-- > 0;) {
    const Style parent = style;
    style = parent.inherited();
    cascade(above[i], parent, lengths, style);
  }
  return style;
}

const std::vector<pugi::xml_node>& Importer::referencesIn(pugi::xml_node from, std::string Style::*property,
                                                          const LengthContext& lengths) {
  const auto [known, isNew] = references_.try_emplace(std::pair(from.hash_value(), property == &Style::mask));
  std::vector<pugi::xml_node>& found = known->second;
  if (!isNew) return found;
  for (pugi::xml_node at = from; at && !stopped(at);) {
    const std::string value = document_.name(at).empty() ? std::string() : styleOf(at, lengths).*property;
    const pugi::xml_node target = value.empty() ? pugi::xml_node() : document_.find(referenceOf(value));
    if (target && std::find(found.begin(), found.end(), target) == found.end()) found.push_back(target);
    if (at.first_child()) {
      at = at.first_child();
      continue;
    }
    while (at && at != from && !at.next_sibling()) at = at.parent();
    at = at == from ? pugi::xml_node() : at.next_sibling();
  }
  return found;
}

bool Importer::refersBack(pugi::xml_node from, std::string Style::*property, const LengthContext& lengths) {
  std::vector<pugi::xml_node> open{from};
  std::unordered_set<size_t> seen{from.hash_value()};
  while (!open.empty() && !stopped_) {
    const pugi::xml_node at = open.back();
    open.pop_back();
    for (const pugi::xml_node next : referencesIn(at, property, lengths)) {
      if (std::find(used_.begin(), used_.end(), next) != used_.end()) return true;
      if (seen.insert(next.hash_value()).second) open.push_back(next);
    }
  }
  return false;
}

void Importer::clip(pugi::xml_node node, std::string_view name, State& state, const Frame* of) {
  const Affine space = of ? of->space : spaceOf(node, name, state);
  std::optional<Box> box; // of the element, when first asked for
  std::vector<pugi::xml_node> targets;
  pugi::xml_node from = node;
  std::string value = state.style.clipPath;
  const auto without = [&](const std::string& why) {
    reporter_.warn(document_.place(from),
                   std::string("clip-path ") + why + ": " + element(from) + " is drawn without it");
  };
  // What the clipPath is clipped by clips as well.
  for (; !value.empty(); from = targets.back()) {
    const std::string shown = std::string("'") + value.substr(0, 60) + "'";
    const std::string reference = referenceOf(value);
    const pugi::xml_node target = reference.empty() ? pugi::xml_node() : document_.find(reference);
    if (!target || document_.name(target) != "clipPath") return without(shown + " is not a clipPath of this file");
    if (std::find(targets.begin(), targets.end(), target) != targets.end() ||
        std::find(used_.begin(), used_.end(), target) != used_.end())
      return without(shown + " contains itself");
    const bool isInside = std::any_of(used_.begin(), used_.end(),
                                      [&](pugi::xml_node used) { return document_.name(used) == "clipPath"; });
    if (isInside && refersBack(target, &Style::clipPath, state.lengths))
      return without(shown + " contains what it clips");
    std::vector<pugi::xml_node> chain{target}; // of a ring of clipPaths only the first clips
    while (!targets.empty()) {
      const pugi::xml_node next = document_.find(referenceOf(styleOf(chain.back(), state.lengths).clipPath));
      if (!next || std::find(chain.begin(), chain.end(), next) != chain.end()) break;
      if (std::find(targets.begin(), targets.end(), next) != targets.end()) return without(shown + " contains itself");
      chain.push_back(next);
    }
    if (state.clips >= shader::kMaxClipDepth || state.clips + state.fading + state.layers >= GPGP_MAX_LAYER_DEPTH ||
        layerCount_ >= limits_.layers)
      return without("is inside too many others");
    targets.push_back(target);
    State inner;
    inner.style = styleOf(target, state.lengths);
    value = inner.style.clipPath;
    const bool isByBox = trim(target.attribute("clipPathUnits").value()) == "objectBoundingBox";
    LengthContext measures = state.lengths; // of its transform
    if (isByBox) measures.width = measures.height = 1;
    inner.transform = space * transformOf(target, inner.style, measures);
    inner.style = inner.style.inherited();
    inner.lengths = state.lengths;
    inner.depth = state.depth;
    if (isByBox) {
      if (!box) box = of ? of->box() : boxOfElement(node, name, state, space);
      if (box->left <= box->right)
        inner.transform =
            inner.transform * Affine{box->right - box->left, 0, 0, box->bottom - box->top, box->left, box->top};
    }
    if (!inner.transform.finite()) return without(shown + " has a transform beyond all numbers");
    const MadeClip made = madeClips_[target.hash_value()];
    MadeClip wanted{inner.transform, state.lengths.width, state.lengths.height, state.group, made.group};
    if (sharesClips_ && made.group && made == wanted) { // neighbours often share one
      ++state.clips;
      state.group = made.group;
      continue;
    }
    std::vector<ImportedPath> paths;
    std::swap(paths, result_.paths);
    const Mode outer = mode_;
    const bool inside = clipsInside_, apart = clipsApart_;
    mode_ = Mode::Clip;
    clipsInside_ = clipsApart_ = false;
    visitChildren(target, inner);
    const bool isMask = clipsInside_ && detail_.layers;
    if (clipsInside_ && !isMask)
      reporter_.warn(document_.place(target), "clip-path inside a clipPath is not drawn inside a render pass: " +
                                                  element(target) + " is drawn without it");
    std::swap(paths, result_.paths);
    if (isMask) { // shapes that have clips themselves: they cover what is shown
      const auto layer = std::make_shared<ImportedLayer>();
      layer->layer.maskKind = GPGP_MASK_ALPHA;
      layer->layer.maskEncoding = GPGP_IMAGE_SRGB;
      const float all[4] = {-1e7f, -1e7f, 1e7f, 1e7f}, same[6] = {1, 0, 0, 1, 0, 0};
      std::copy_n(all, 4, layer->layer.maskRegion);
      std::copy_n(same, 6, layer->layer.maskTransform);
      result_.groups.push_back({state.group, 1, false, {}});
      state.group = static_cast<uint32_t>(result_.groups.size());
      ++state.layers;
      ++layerCount_;
      clipsApart_ = true;
      used_.push_back(target);
      State apartFrom = inner;
      apartFrom.clips = state.clips, apartFrom.fading = state.fading, apartFrom.layers = state.layers;
      layer->layer.mask = aside(std::move(apartFrom), [&](State& own) { visitChildren(target, own); });
      used_.pop_back();
      if (layer->layer.mask)
        result_.groups[state.group - 1].layer = layer;
      else
        result_.groups[state.group - 1].clipped = true; // nothing is shown
    } else {
      ++state.clips;
      result_.groups.push_back({state.group, 1, true, std::move(paths)});
      state.group = static_cast<uint32_t>(result_.groups.size());
      wanted.group = state.group;
      madeClips_[target.hash_value()] = wanted;
    }
    mode_ = outer;
    clipsInside_ = inside, clipsApart_ = apart;
  }
}

} // namespace gpgp::vector::svg
