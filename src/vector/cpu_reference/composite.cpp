// The CPU reference of raster: every pixel front to back, sample by sample, with groups, clips and exact areas.
//
// How far the GPU may be off follows the light: what a path's colour is in doubt, times its weight; where its alpha is,
// all that lies behind, which is no brighter than the brightest colour of the recording; and rounding of weights.
#include "vector/raster/composite.h"

#include "vector/cpu_reference/cpu_reference.h"
#include "vector/shared/color.h"

#include <algorithm>

namespace gpgp::vector {
using shader::ItemRecord;
using shader::kItemGrouped;
using shader::kShapeSlot;
using shader::PlacedPath;
using shader::vec3;
using shader::vec4;

namespace {

constexpr float kRounding = 1e-5f; // of weights and sums of some dozens of paths
constexpr float kPower = 2e-5f;    // as in paint.cpp

/// A group less than opaque that is open: of the recording's, or of one drawing that is shown.
struct Group {
  uint32_t slot, layer, item; ///< item: UINT32_MAX of the recording's
  float opacity;
  bool operator==(const Group& other) const { return slot == other.slot && layer == other.layer && item == other.item; }
};

/// Light of a pixel, or of a group in it.
struct Light {
  uint32_t alive = 0;
  float scale = 1, gap = 0;
  float through[16] = {};
};

struct Compositor {
  const CpuInput& input;
  const CpuPlaces& places;
  uint32_t every; ///< samples
  float share, brightest = 1;
  std::vector<std::vector<Group>> groups; ///< of each path, the outermost first

  Compositor(const CpuInput& from, const CpuPlaces& placed)
      : input(from), places(placed), every((1u << from.header.samples) - 1),
        share(1.0f / static_cast<float>(from.header.samples)) {
    const auto see = [&](const vec4& c) {
      brightest = std::max({brightest, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    };
    see(input.header.background);
    for (const PlacedPath& path : places.paths) {
      groups.push_back(groupsOf(path));
      see(path.color);
      if (path.paint == 0 || path.paint & shader::kPaintsTriangle) continue;
      const uint32_t slot = places.items[path.item].slot;
      const uint32_t first = input.word(slot, path.paint - 1 + 3, 0), count = input.word(slot, path.paint - 1 + 3, 1);
      if (input.word(slot, path.paint - 1 + 2, 1) >= shader::kPaintImage) continue;
      for (uint32_t k = 0; k < count; ++k) {
        const vec4 stop = input.fetch(slot, input.slots(slot).stops + (first + k) * 2);
        see(stop);
        see(vec4(shader::decodeSrgb(vec3(stop)), 1));
      }
    }
  }

  std::vector<Group> groupsOf(const PlacedPath& path) const {
    std::vector<Group> found;
    const auto add = [&](uint32_t slot, uint32_t layer, uint32_t item) { // the innermost first
      while (layer) {
        const size_t at = input.slots(slot).layers + layer - 1;
        found.push_back({slot, layer, item, input.fetch(slot, at).x});
        layer = input.word(slot, at, 1);
      }
    };
    const ItemRecord& item = places.items[path.item];
    if (const uint32_t own = path.group & ~kItemGrouped) add(item.slot, input.word(item.slot, own - 1, 2), path.item);
    if (path.group & kItemGrouped) add(kShapeSlot, item.layer, UINT32_MAX);
    std::reverse(found.begin(), found.end());
    return found;
  }

  /// What a path's clips leave of what it covers.
  void clip(const PlacedPath& path, uint32_t x, uint32_t y, bool area, CpuCoverage& coverage) const {
    const auto coverageOf = [&](uint32_t which) {
      CpuCoverage c = places.at(input.header, which, x, y);
      if (!area) c.difference = 0;
      return c;
    };
    const auto join = [&](CpuCoverage& to, const CpuCoverage& other, bool both) {
      shader::combine(to.mask, to.difference, other.mask, other.difference, both, every);
    };
    const ItemRecord& item = places.items[path.item];
    CpuCoverage shown{every, 0};
    const uint32_t own = path.group & ~kItemGrouped;
    for (uint32_t clip = own ? input.word(item.slot, own - 1, 1) : 0; clip;) {
      const size_t at = input.slots(item.slot).clips + clip - 1;
      const uint32_t first = input.word(item.slot, at, 0), count = input.word(item.slot, at, 1);
      CpuCoverage all;
      for (uint32_t k = 0; k < count; ++k) join(all, coverageOf(item.firstPath + first + k), true);
      join(shown, all, false);
      clip = input.word(item.slot, at, 2);
    }
    for (uint32_t clip = path.group & kItemGrouped ? item.clip : 0; clip;) {
      const size_t at = input.slots(kShapeSlot).clips + clip - 1;
      join(shown, coverageOf(input.word(kShapeSlot, at, 0)), false);
      clip = input.word(kShapeSlot, at, 1);
    }
    join(coverage, shown, false);
  }

  struct Pixel {
    bool first;
    Light light;
    std::vector<std::pair<Group, Light>> outer; ///< open groups, and what is around each
    vec4 sum{}, doubt{};
    bool open() const { return light.alive || light.gap > 0; }
  };

  void leave(Pixel& pixel) const {
    const auto [group, outer] = pixel.outer.back();
    pixel.outer.pop_back();
    const float past = 1 - group.opacity;
    float sumPast = 0, sumLight = 0;
    Light& light = pixel.light;
    for (uint32_t k = 0; k < input.header.samples; ++k) {
      const float passed = outer.alive >> k & 1 ? outer.through[k] * past : 0;
      const float inside = light.alive >> k & 1 ? light.through[k] : 0;
      light.through[k] = passed + inside;
      sumPast += passed;
      sumLight += inside;
    }
    light.alive = outer.alive;
    if (input.header.flags & shader::kExactArea)
      shader::joinLight(sumPast, outer.scale, outer.gap, past, sumLight, share, light.scale, light.gap);
  }
  void enter(Pixel& pixel, const Group& group) const {
    pixel.outer.emplace_back(group, pixel.light);
    pixel.light.gap *= group.opacity;
    for (float& through : pixel.light.through) through *= group.opacity;
  }
  void toGroups(Pixel& pixel, const std::vector<Group>& wanted) const {
    size_t common = 0;
    while (common < std::min(pixel.outer.size(), wanted.size()) && pixel.outer[common].first == wanted[common])
      ++common;
    while (pixel.outer.size() > common) leave(pixel);
    for (size_t k = common; k < wanted.size(); ++k) enter(pixel, wanted[k]);
  }

  void paint(Pixel& pixel, size_t index, uint32_t x, uint32_t y) const {
    const PlacedPath& path = places.paths[index];
    CpuCoverage coverage = places.at(input.header, index, x, y);
    if (path.paint & shader::kPaintsTriangle) coverage.difference = 0;
    const uint32_t own = coverage.mask;
    if (!coverage.mask && !coverage.difference) return;
    toGroups(pixel, groups[index]);
    Light& light = pixel.light;
    const bool area = pixel.first || light.gap > 0;
    if (!area) coverage.difference = 0;
    if (!pixel.open()) return; // the group is hidden
    if (path.group) clip(path, x, y, area, coverage);
    const auto [mask, difference] = coverage;
    if (mask == 0 && (pixel.first ? difference == 0 : light.gap * static_cast<float>(difference) <= 0)) return;
    const CpuColor source = paintAt(input, places, path, x, y, own);
    const float alpha = source.color.w;
    float weight = 0, doubtful = 0; // light that an alpha in doubt may let through or not
    if (pixel.first && (mask != every || difference != 0)) {
      pixel.first = false;
      const float covered = static_cast<float>(shader::bitCount(mask)) * share, through = light.through[0];
      weight = shader::firstEdge(covered, difference, share, through, alpha, light.scale, light.gap);
      // Whether what the area leaves is a gap, or shows through what all samples leave, is as light as the alpha tells.
      if (source.doubt.w > 0 && alpha + source.doubt.w >= 1) doubtful = std::abs(through - weight);
    } else {
      for (uint32_t k = 0; k < input.header.samples; ++k)
        weight += (mask & light.alive) >> k & 1 ? light.through[k] : 0;
      weight = weight * share * light.scale + light.gap;
      light.gap *= 1 - alpha;
    }
    pixel.sum += source.color * weight;
    pixel.doubt += source.doubt * weight + source.color * (kRounding * weight) +
                   vec4(vec3(brightest), 1) * (source.doubt.w * weight + doubtful);
    if (alpha >= 1)
      light.alive &= ~mask;
    else
      for (uint32_t k = 0; k < input.header.samples; ++k)
        if (mask >> k & 1) light.through[k] *= 1 - alpha;
  }

  CpuColor at(uint32_t x, uint32_t y) const {
    Pixel pixel{(input.header.flags & shader::kExactArea) != 0, {every, 1, 0, {}}, {}, {}, {}};
    std::fill_n(pixel.light.through, 16, 1.0f);
    for (size_t i = places.paths.size(); i > 0 && (!pixel.outer.empty() || pixel.open()); --i)
      if (places.paths[i - 1].color.w > 0) paint(pixel, i - 1, x, y);
    while (!pixel.outer.empty()) leave(pixel);
    float light = 0;
    for (uint32_t k = 0; k < input.header.samples; ++k)
      light += pixel.light.alive >> k & 1 ? pixel.light.through[k] : 0;
    const vec4 behind = input.header.background * (light * share * pixel.light.scale + pixel.light.gap);
    return {pixel.sum + behind, pixel.doubt + glm::abs(behind) * kRounding};
  }
};

/// What the target receives of a mixed colour.
CpuColor converted(const CpuColor& mixed, uint32_t flags) {
  const bool encoded = flags & shader::kBlendSrgb, wanted = flags & shader::kEncodeSrgb;
  if (encoded == wanted) return mixed;
  const vec4 color = shader::targetColor(mixed.color, flags);
  vec4 doubt(0);
  for (const float rgb : {-1.0f, 1.0f})
    for (const float alpha : {-1.0f, 1.0f}) {
      const vec4 other = shader::targetColor(mixed.color + mixed.doubt * vec4(rgb, rgb, rgb, alpha), flags);
      doubt = glm::max(doubt, glm::abs(other - color));
    }
  return {color, doubt + vec4(vec3(glm::abs(color)) * kPower, 0)};
}

} // namespace

std::vector<CpuColor> paintOnCpu(const CpuInput& input, const CpuPlaces& places) {
  const Compositor compositor(input, places);
  std::vector<CpuColor> picture;
  picture.reserve(size_t(input.header.width) * input.header.height);
  for (uint32_t y = 0; y < input.header.height; ++y)
    for (uint32_t x = 0; x < input.header.width; ++x)
      picture.push_back(converted(compositor.at(x, y), input.header.flags));
  return picture;
}

} // namespace gpgp::vector
