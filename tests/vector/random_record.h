// Records of random things of all kinds that a canvas draws, with what the CPU reference needs of them.
#pragma once
#include "ui_fixture.h"
#include "vector/raster/drawing_asset.h"

#include <deque>
#include <map>

namespace gpgp::test {

struct Dice {
  std::mt19937 random;
  explicit Dice(uint32_t seed) : random(seed) {}
  uint32_t upTo(uint32_t n) { return static_cast<uint32_t>(random() % n); }
  bool oneIn(uint32_t n) { return upTo(n) == 0; }
  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(upTo(1u << 20)) / static_cast<float>(1u << 20);
  }
  std::array<float, 4> color() {
    const float most = oneIn(8) ? 4.0f : 1.0f; // brighter than white
    return {between(0, most), between(0, most), between(0, most), oneIn(3) ? between(0, 1) : 1.0f};
  }
};

/// What a record may have: each takes other shaders.
struct Kinds {
  bool gradients, images, groups, projective, lists, texts, severalDrawings;
};

/// Paths with gradients, strokes, images and groups; everything that is pointed at lives as long as it does.
struct RandomPaths {
  std::deque<TestPath> shapes;
  std::deque<std::vector<GpgpGradientStop>> stops;
  std::deque<GpgpGradient> gradients;
  std::deque<GpgpStroke> strokes;
  std::deque<GpgpImagePaint> imagePaints;
  std::deque<std::vector<GpgpPath>> clips;
  std::vector<GpgpPath> paths;
  std::vector<GpgpPathGroup> groups;

  const TestPath& shape(Dice& dice, float size) {
    TestPath& path = shapes.emplace_back();
    const auto at = [&] { return dice.between(-0.2f * size, 1.2f * size); };
    path.rule = dice.oneIn(2) ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
    path.color = dice.color();
    if (dice.oneIn(4)) { // covers tiles whole
      const float x = at(), y = at();
      path.move(x, y).line(x + size, y).line(x + size, y + size).line(x, y + size).close();
      return path;
    }
    path.move(at(), at());
    for (uint32_t i = 2 + dice.upTo(6); i > 0; --i) {
      const float a = at(), b = at(), c = at(), d = at(), e = at(), f = at();
      switch (dice.upTo(4)) {
      case 0: path.quad(a, b, c, d); break;
      case 1: path.cubic(a, b, c, d, e, f); break;
      case 2: path.line(a, path.points.back()); break; // level
      default: path.line(a, b); break;
      }
    }
    path.close();
    return path;
  }
  const GpgpGradient* gradient(Dice& dice, float size) {
    std::vector<GpgpGradientStop>& ramp = stops.emplace_back();
    float offset = dice.oneIn(2) ? 0.0f : dice.between(0, 0.3f);
    for (uint32_t i = 1 + dice.upTo(4); i > 0; --i) {
      const auto c = dice.color();
      ramp.push_back({std::min(offset, 1.0f), {c[0], c[1], c[2], c[3]}});
      if (!dice.oneIn(4)) offset += dice.between(0, 0.6f); // else two at one place
    }
    const auto at = [&] { return dice.between(0, size); };
    GpgpGradient& g = gradients.emplace_back();
    g.kind = dice.oneIn(2) ? GPGP_GRADIENT_RADIAL : GPGP_GRADIENT_LINEAR;
    g.spread = static_cast<GpgpSpread>(dice.upTo(3));
    const auto map = turned(dice.between(0, 360), dice.between(0.5f, 2), dice.between(0, 9), dice.between(0, 9));
    std::copy_n(map.data(), 6, g.transform);
    g.start[0] = at(), g.start[1] = at(), g.end[0] = at(), g.end[1] = at();
    g.startRadius = dice.oneIn(2) ? 0.0f : dice.between(0, 0.3f * size);
    g.endRadius = dice.oneIn(5) ? g.startRadius : dice.between(0.2f * size, size);
    g.stops = ramp.data();
    g.stopCount = static_cast<uint32_t>(ramp.size());
    g.interpolateSrgb = dice.oneIn(2);
    return &g;
  }
  void path(Dice& dice, const Kinds& kinds, float size, uint32_t imageCount, uint32_t group) {
    GpgpPath path = shape(dice, size).view();
    path.group = group;
    if (kinds.gradients && dice.oneIn(3)) {
      path.gradient = gradient(dice, size);
    } else if (kinds.images && imageCount && dice.oneIn(3)) {
      GpgpImagePaint& image = imagePaints.emplace_back();
      image.image = dice.upTo(imageCount);
      const auto map =
          turned(dice.between(0, 360), dice.between(0.3f, 1) * size, dice.between(0, size), dice.between(0, size));
      std::copy_n(map.data(), 6, image.transform);
      path.image = &image;
    }
    if (dice.oneIn(8)) {
      GpgpStroke& stroke = strokes.emplace_back();
      stroke.width = dice.between(0.02f, 0.1f) * size;
      stroke.join = static_cast<GpgpJoin>(dice.upTo(3));
      stroke.cap = static_cast<GpgpCap>(dice.upTo(3));
      path.stroke = &stroke;
    }
    paths.push_back(path);
  }
  /// Some paths, of which some are in groups in each other, of which `fading` may be less than opaque.
  void add(Dice& dice, const Kinds& kinds, float size, uint32_t imageCount, uint32_t parent, uint32_t fading,
           uint32_t depth) {
    for (uint32_t i = 1 + dice.upTo(4); i > 0; --i) {
      if (!kinds.groups || depth == 4 || !dice.oneIn(3)) {
        path(dice, kinds, size, imageCount, parent);
        continue;
      }
      GpgpPathGroup group{parent, 1, nullptr, 0};
      const bool fades = fading > 0 && dice.oneIn(2);
      if (fades) group.opacity = dice.between(0.1f, 0.9f);
      if (!fades || dice.oneIn(2)) {
        std::vector<GpgpPath>& clip = clips.emplace_back();
        for (uint32_t k = 1 + dice.upTo(2); k > 0; --k) clip.push_back(shape(dice, size).view());
        group.clip = clip.data();
        group.clipCount = static_cast<uint32_t>(clip.size());
      }
      groups.push_back(group);
      add(dice, kinds, size, imageCount, static_cast<uint32_t>(groups.size()), fading - fades, depth + 1);
    }
  }
};

/// Items, and what they show.
struct RandomRecord {
  uint32_t width = 0, height = 0, samples = 16;
  bool exactArea = false, blendSrgb = false, encodeSrgb = false, wide = false;
  std::array<float, 4> background{};
  std::vector<GpgpCanvasItem> items;
  std::deque<TestList> lists;
  std::deque<std::vector<GpgpGlyphInstance>> texts;
  std::deque<RandomPaths> listPaints;
  std::vector<GpgpAsset> drawings; ///< to be destroyed
  std::string what;
};

} // namespace gpgp::test
