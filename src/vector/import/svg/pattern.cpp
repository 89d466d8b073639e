// Patterns (SVG 2, 14.3) as copies: what one tile shows is made once, repeated over the box of what is painted, and
// clipped by it. So they are as sharp as all else; a limit on the tiles bounds them.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::svg {
namespace {

constexpr double kMaxTiles = 65536;       ///< whose paths are one path each
constexpr double kMaxGroupedTiles = 4096; ///< that have groups of their own

void append(ImportedPath& to, const ImportedPath& path, double dx, double dy) {
  to.verbs.insert(to.verbs.end(), path.verbs.begin(), path.verbs.end());
  for (size_t i = 0; i < path.points.size(); ++i)
    to.points.push_back(static_cast<float>(static_cast<double>(path.points[i]) + (i % 2 ? dy : dx)));
}

template <class T> void shift(T& paint, double dx, double dy) {
  paint.transform[4] = static_cast<float>(static_cast<double>(paint.transform[4]) + dx);
  paint.transform[5] = static_cast<float>(static_cast<double>(paint.transform[5]) + dy);
}

/// The same elsewhere.
ImportedPath moved(const ImportedPath& path, double dx, double dy) {
  ImportedPath copy = path;
  copy.verbs.clear(), copy.points.clear();
  append(copy, path, dx, dy);
  if (path.gradient) {
    auto gradient = std::make_shared<Gradient>(*path.gradient);
    gradient->gradient.stops = gradient->stops.data();
    shift(gradient->gradient, dx, dy);
    copy.gradient = std::move(gradient);
  }
  if (path.image) {
    auto image = std::make_shared<GpgpImagePaint>(*path.image);
    shift(*image, dx, dy);
    copy.image = std::move(image);
  }
  return copy;
}

/// The same elsewhere, where groups have other names.
template <class Rename>
std::shared_ptr<const ImportedLayer> moved(const ImportedLayer& layer, double dx, double dy, const Rename& renamed) {
  auto copy = std::make_shared<ImportedLayer>(layer);
  GpgpLayer& l = copy->layer;
  l.mask = renamed(l.mask);
  const auto shift = [](float& value, double by) { value = static_cast<float>(static_cast<double>(value) + by); };
  for (float* t : {l.maskTransform, l.filterTransform}) shift(t[4], dx), shift(t[5], dy);
  for (GpgpFilterStep& step : copy->steps) {
    if (!step.group) continue;
    step.group = renamed(step.group);
    float* back = step.values; // from the drawing, where the group has moved
    const auto at = [back](size_t i) { return static_cast<double>(back[i]); };
    shift(back[4], -(at(0) * dx + at(2) * dy)), shift(back[5], -(at(1) * dx + at(3) * dy));
  }
  return copy;
}

} // namespace

pugi::xml_node Importer::contentOf(const GradientChain& chain) {
  for (const pugi::xml_node pattern : chain.gradients)
    for (const pugi::xml_node child : pattern.children())
      if (child.type() == pugi::node_element) return pattern;
  return {};
}

std::shared_ptr<const Importer::Tiling> Importer::tilingOf(const GradientChain& chain, const Surface& surface) {
  const pugi::xml_node node = chain.gradients[0];
  const State& state = surface.state;
  auto tiling = std::make_shared<Tiling>(Tiling{node, contentOf(chain), state});
  const auto isUnit = [&](const char* name, std::string_view word, std::string_view other) {
    const pugi::xml_attribute a = gradientAttribute(chain, name);
    const std::string_view text = trim(a.value());
    if (a && text != word && text != other) ignored(node, a);
    return text == word;
  };
  const bool userSpace = isUnit("patternUnits", "userSpaceOnUse", "objectBoundingBox");
  const bool byBox = isUnit("patternContentUnits", "objectBoundingBox", "userSpaceOnUse");
  LengthContext lengths = state.lengths;
  lengths.fontSize = state.style.fontSize;
  if (!userSpace) lengths.width = lengths.height = 1;
  const auto number = [&](const char* name, LengthAxis axis, bool isSize) {
    const pugi::xml_attribute a = gradientAttribute(chain, name);
    double value = 0;
    if (a && !parseLength(trim(a.value()), lengths, axis, value))
      noLength(node, document_.place(a, 0), name, a.value());
    if (value < 0 && isSize)
      reporter_.error(document_.place(a, 0), element(node) + " has a negative " + name + "; ignored");
    return value < 0 && isSize ? 0 : value;
  };
  double x = number("x", LengthAxis::X, false), y = number("y", LengthAxis::Y, false);
  double w = number("width", LengthAxis::X, true), h = number("height", LengthAxis::Y, true);
  const pugi::xml_attribute boxText = gradientAttribute(chain, "viewBox");
  const std::optional<ViewBox> viewBox = parseViewBox(boxText.value());
  if (boxText && !viewBox) ignored(node, boxText);
  Box box;
  if (!userSpace || (byBox && !viewBox)) {
    box = surface.box();
    if (!(box.right > box.left && box.bottom > box.top)) return nullptr; // nothing to measure by
  }
  const double bw = box.right - box.left, bh = box.bottom - box.top;
  if (!userSpace) x = box.left + x * bw, y = box.top + y * bh, w *= bw, h *= bh;
  if (!(w > 0 && h > 0) || (viewBox && !(viewBox->width > 0 && viewBox->height > 0))) return nullptr;
  tiling->width = w, tiling->height = h;
  Affine map = surface.space;
  for (const pugi::xml_node pattern : chain.gradients) { // the property, whose attribute patternTransform is
    const Style style = styleOf(pattern, state.lengths);
    if (!style.isMoved()) continue;
    map = map * transformOf(pattern, style, lengths);
    break;
  }
  map = map * Affine{1, 0, 0, 1, x, y};
  if (map.a * map.d == map.b * map.c || !map.finite()) return nullptr;
  tiling->space = map;
  State& inner = tiling->state;
  inner.style = styleOf(tiling->content, state.lengths);
  if (inner.style.overflowVisible)
    reporter_.warn(document_.place(node),
                   "overflow 'visible' is not supported: " + element(node) + " is clipped to its tiles");
  inner.opacity = 1;
  inner.context = nullptr;
  inner.transform = map;
  ++inner.depth;
  if (viewBox) {
    AspectRatio ratio;
    if (const pugi::xml_attribute a = gradientAttribute(chain, "preserveAspectRatio")) {
      const auto parsed = parseAspectRatio(a.value());
      parsed ? void(ratio = *parsed) : ignored(node, a);
    }
    inner.transform = map * fitViewBox(*viewBox, w, h, ratio);
    inner.lengths.width = viewBox->width, inner.lengths.height = viewBox->height;
  } else if (byBox) {
    inner.transform = map * Affine{bw, 0, 0, bh, 0, 0};
  }
  return tiling;
}

void Importer::emitTiles(const Shape& shape, const Affine& transform, GpgpFillRule rule, const Tiling& tiling,
                         double opacity, pugi::xml_node node) {
  const auto refused = [&](const std::string& why) {
    reporter_.warn(document_.place(node), element(node) + " is painted with a pattern " + why + "; it is not painted");
  };
  const double w = tiling.width, h = tiling.height;
  const Affine map = tiling.space, inverse = inverseOf(map) * transform;
  Shape inTiles = shape;
  for (Point& p : inTiles.points) p = inverse(p);
  const Box box = boxOf(inTiles);
  const double left = std::floor(box.left / w), right = std::ceil(box.right / w);
  const double top = std::floor(box.top / h), bottom = std::ceil(box.bottom / h);
  const double tiles = (right - left) * (bottom - top);
  if (!(tiles > 0)) return;
  if (!(tiles <= kMaxTiles)) return refused("of more than 65536 tiles, which is not supported");
  State inner = tiling.state;
  if (inner.clips + 1 >= shader::kMaxClipDepth) return refused("inside too many clips, which is not supported");
  const bool fades = opacity < 1;
  if (inner.clips + inner.fading + inner.layers + 1 >= GPGP_MAX_LAYER_DEPTH ||
      (fades && !detail_.layers && inner.fading >= shader::kMaxLayerDepth))
    return refused("inside too many that fade or are masked, which is not supported");
  if (inner.depth >= limits_.depth) return refused("nested too deeply, which is not supported");

  // What is painted clips the tiles.
  const uint32_t group = group_;
  std::vector<ImportedPath> kept;
  std::swap(kept, result_.paths);
  emit(shape, transform, rule, {}, 1, node);
  std::swap(kept, result_.paths);
  const size_t groupsBefore = result_.groups.size(), asideBefore = aside_.size(), blendsBefore = blendCount_;
  const size_t layersBefore = layerCount_, stepsBefore = filterSteps_;
  result_.groups.push_back({group, static_cast<float>(std::clamp(opacity, 0.0, 1.0)), true, std::move(kept)});
  inner.group = static_cast<uint32_t>(result_.groups.size());
  ++inner.clips;
  inner.fading += fades;

  // One tile, which is clipped to its own size where something reaches beyond it.
  std::vector<ImportedPath> tile;
  std::swap(tile, result_.paths);
  const uint32_t outer = inner.group;
  const size_t own = result_.groups.size();
  used_.push_back(tiling.node);
  clipped(tiling.content, map, w, h, inner, [&] { visitChildren(tiling.content, inner); });
  used_.pop_back();
  std::swap(tile, result_.paths);
  group_ = group;
  const std::vector<ImportedPath> tileAside(aside_.begin() + static_cast<ptrdiff_t>(asideBefore), aside_.end());
  aside_.resize(asideBefore);
  const auto takeBack = [&] {
    madeClips_.clear();
    result_.groups.resize(groupsBefore);
  };
  if (tile.empty()) return takeBack();
  if (blendCount_ > blendsBefore) { // a tile is a picture of its own
    const auto isolated = std::make_shared<ImportedLayer>();
    isolated->layer.isolated = 1;
    result_.groups[outer - 1].layer = isolated;
  }
  const auto manyLayers = tiles * static_cast<double>(layerCount_ - layersBefore),
             manySteps = tiles * static_cast<double>(filterSteps_ - stepsBefore);
  if (manyLayers > static_cast<double>(limits_.layers) || manySteps > static_cast<double>(limits_.filterSteps)) {
    takeBack();
    return refused("whose tiles have more masks, filters and blend modes than are supported");
  }
  layerCount_ += static_cast<size_t>(manyLayers), filterSteps_ += static_cast<size_t>(manySteps);
  const bool isPlain = result_.groups.size() > own && !result_.groups[own].clipped; // the one that clips the tile
  if (isPlain)
    for (ImportedPath& path : tile)
      if (path.group == own + 1) path.group = outer;
  const bool grouped = std::any_of(tile.begin(), tile.end(), [&](const ImportedPath& p) { return p.group != outer; });
  if (grouped && tiles > kMaxGroupedTiles) {
    takeBack();
    return refused("of more than 4096 tiles that reach beyond their edges or have groups, which is not supported");
  }
  size_t points = 0;
  for (const auto* paths : {&std::as_const(tile), &tileAside})
    for (const ImportedPath& path : *paths) points += path.points.size() / 2 + path.verbs.size();
  const bool copies =
      grouped || std::any_of(tile.begin(), tile.end(), [](const ImportedPath& p) { return p.gradient || p.image; });
  points_ += static_cast<size_t>(tiles) * points;
  if (points_ > limits_.points)
    return stop(node, std::string("more than ") + std::to_string(limits_.points) + " points");
  if (result_.paths.size() + aside_.size() +
          (tile.size() + tileAside.size()) * (copies ? static_cast<size_t>(tiles) : 1) >
      limits_.paths)
    return stop(node, std::string("more than ") + std::to_string(limits_.paths) + " paths");
  const auto eachTile = [&](const auto& place) {
    for (double row = top; row < bottom; ++row)
      for (double column = left; column < right; ++column) {
        const double x = column * w, y = row * h;
        place(map.a * x + map.c * y, map.b * x + map.d * y);
      }
  };
  if (!grouped) { // they do not overlap, so that each path's copies can follow one another
    for (const ImportedPath& path : tile) {
      if (path.gradient || path.image) {
        eachTile([&](double dx, double dy) { result_.paths.push_back(moved(path, dx, dy)); });
        continue;
      }
      ImportedPath all = path;
      all.verbs.clear(), all.points.clear();
      eachTile([&](double dx, double dy) { append(all, path, dx, dy); });
      result_.paths.push_back(std::move(all));
    }
    return;
  }
  const std::vector<ImportedGroup> groups(result_.groups.begin() + static_cast<ptrdiff_t>(own), result_.groups.end());
  madeClips_.clear(); // those of the first tile are no one else's
  result_.groups.resize(own);
  eachTile([&](double dx, double dy) {
    const auto offset = static_cast<uint32_t>(result_.groups.size() - own);
    const auto renamed = [&](uint32_t id) { return id > own ? id + offset : id; };
    for (const ImportedGroup& one : groups) {
      ImportedGroup copy{renamed(one.parent), one.opacity, one.clipped, {}};
      if (one.layer) copy.layer = moved(*one.layer, dx, dy, renamed);
      for (const ImportedPath& path : one.clip) copy.clip.push_back(moved(path, dx, dy));
      result_.groups.push_back(std::move(copy));
    }
    for (const ImportedPath& path : tile) {
      result_.paths.push_back(moved(path, dx, dy));
      result_.paths.back().group = renamed(path.group);
    }
    for (const ImportedPath& path : tileAside) {
      aside_.push_back(moved(path, dx, dy));
      aside_.back().group = renamed(path.group);
    }
  });
}

} // namespace gpgp::vector::svg
