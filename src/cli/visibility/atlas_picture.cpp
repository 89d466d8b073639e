#include "core/shared.h"

#include "cli/visibility/atlas_picture.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <gpgp/shaders/atlas.h>

namespace gpgp::cli {
namespace {
using Texel = std::array<uint8_t, 4>;

/// What both ways of shading show: waves of a hundredth of the model's size, so that pixels resolve them.
class Pattern {
public:
  explicit Pattern(std::span<const glm::vec3> corners) : corners_(corners) {
    glm::vec3 low(3e38f), high(-3e38f);
    for (const glm::vec3& corner : corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    frequency_ = 2 * 3.14159265f * 12 / std::max(glm::length(high - low), 1e-20f);
  }

  glm::vec3 at(uint32_t triangle, const glm::vec3& weights) const {
    const glm::vec3 *c = &corners_[size_t{triangle} * 3], p = c[0] * weights.x + c[1] * weights.y + c[2] * weights.z;
    const glm::vec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
    const float length = glm::length(normal);
    const float light = length > 0 ? 0.7f + 0.3f * glm::dot(normal / length, glm::vec3(0.36f, 0.8f, 0.48f)) : 0.7f;
    return light * (glm::vec3(0.55f) + 0.4f * glm::vec3(std::sin(p.x * frequency_), std::sin(p.y * frequency_),
                                                        std::sin(p.z * frequency_)));
  }

private:
  std::span<const glm::vec3> corners_;
  float frequency_;
};

Texel quantised(const glm::vec3& color) {
  const auto byte = [](float v) { return static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
  return {byte(color.x), byte(color.y), byte(color.z), 255};
}

/// Bilinear, in texels.
glm::vec3 filtered(const host::Picture& picture, glm::vec2 at) {
  const glm::vec2 from = glm::floor(at - 0.5f), part = at - 0.5f - from;
  glm::vec3 sum(0.0f);
  for (int i = 0; i < 4; ++i) {
    const auto x = static_cast<uint32_t>(std::clamp(int(from.x) + i % 2, 0, int(picture.width) - 1));
    const auto y = static_cast<uint32_t>(std::clamp(int(from.y) + i / 2, 0, int(picture.height) - 1));
    const uint8_t* texel = &picture.rgba[(size_t{y} * picture.width + x) * 4];
    const float weight = (i % 2 ? part.x : 1 - part.x) * (i / 2 ? part.y : 1 - part.y);
    sum += weight / 255 * glm::vec3(texel[0], texel[1], texel[2]);
  }
  return sum;
}

struct Hit {
  uint32_t triangle = UINT32_MAX;
  glm::vec3 weights{};
  double depth = 0;
};

/// The nearest of the triangles at each pixel's centre, with barycentrics that are right in perspective: the solution
/// of corners * weights = w * (x, y, 1) needs no clipping.
std::vector<Hit> rasterise(Size size, const View& view, const std::vector<uint32_t>& bits,
                           std::span<const glm::vec3> corners) {
  std::vector<Hit> hits(size_t{size.width} * size.height);
  for (uint32_t t = 0; t < corners.size() / 3; ++t) {
    if (!(bits[t / 32] >> t % 32 & 1)) continue;
    glm::dvec4 clip[3];
    double left = size.width, top = size.height, right = 0, bottom = 0;
    bool behind = false;
    for (uint32_t k = 0; k < 3; ++k) {
      clip[k] = glm::dmat4(view.camera) * glm::dvec4(glm::dvec3(corners[t * 3 + k]), 1);
      if (clip[k].w <= 0) behind = true;
      const double x = (clip[k].x / clip[k].w * 0.5 + 0.5) * size.width,
                   y = (clip[k].y / clip[k].w * 0.5 + 0.5) * size.height;
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
    if (behind) left = top = 0, right = size.width, bottom = size.height;
    const glm::dmat3 matrix(glm::dvec3(clip[0].x, clip[0].y, clip[0].w), glm::dvec3(clip[1].x, clip[1].y, clip[1].w),
                            glm::dvec3(clip[2].x, clip[2].y, clip[2].w));
    if (glm::determinant(matrix) == 0) continue;
    const glm::dmat3 inverse = glm::inverse(matrix);
    const auto within = [](double value, uint32_t most) {
      return static_cast<uint32_t>(std::clamp(value, 0.0, double(most)));
    };
    for (uint32_t y = within(top, size.height); y < within(bottom + 1, size.height); ++y)
      for (uint32_t x = within(left, size.width); x < within(right + 1, size.width); ++x) {
        const glm::dvec3 n = inverse * glm::dvec3((x + 0.5) / size.width * 2 - 1, (y + 0.5) / size.height * 2 - 1, 1);
        const double sum = n.x + n.y + n.z; // 1 / w
        if (std::min({n.x, n.y, n.z}) < 0 || sum <= 0) continue;
        double depth = n.x * clip[0].z + n.y * clip[1].z + n.z * clip[2].z;
        if (depth < 0 || depth > 1) continue;
        if (view.reversed) depth = 1 - depth;
        Hit& hit = hits[size_t{y} * size.width + x];
        if (hit.triangle == UINT32_MAX || depth < hit.depth) hit = {t, glm::vec3(n / sum), depth};
      }
  }
  return hits;
}
} // namespace

host::Picture shadeAtlas(Size size, std::span<const uint32_t> blocks, std::span<const std::array<uint32_t, 2>> tiles,
                         std::span<const glm::vec3> corners) {
  const Pattern pattern(corners);
  host::Picture atlas{size.width, size.height, std::vector<uint8_t>(size_t{size.width} * size.height * 4)};
  for (size_t i = 3; i < atlas.rgba.size(); i += 4) atlas.rgba[i] = 255;
  for (const auto& [triangle, tile] : tiles) {
    const uint32_t second = triangle + 1 < blocks.size() ? blocks[triangle + 1] : 0;
    for (uint32_t local = 0; local < 16; ++local) {
      const shader::GpgpAtlasTexel texel = shader::gpgpAtlasTexel(blocks[triangle], second, tile, local, 0);
      if (!texel.shown) continue;
      const Texel color = quantised(pattern.at(triangle + texel.second, texel.weights));
      std::copy(color.begin(), color.end(), &atlas.rgba[(size_t{texel.place.y} * size.width + texel.place.x) * 4]);
    }
  }
  return atlas;
}

Display displayAtlas(Size size, const View& view, const std::vector<uint32_t>& bits, const host::Picture& atlas,
                     std::span<const uint32_t> blocks, std::span<const glm::vec3> corners) {
  const Pattern pattern(corners);
  Display display;
  display.picture = {size.width * 2, size.height, std::vector<uint8_t>(size_t{size.width} * size.height * 8, 255)};
  const std::vector<Hit> hits = rasterise(size, view, bits, corners);
  double error = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    if (hit.triangle == UINT32_MAX) continue;
    ++display.shown;
    const uint32_t block = blocks[hit.triangle];
    const glm::vec3 direct = pattern.at(hit.triangle, hit.weights);
    glm::vec3 fromAtlas(1, 0, 0);
    if (shader::gpgpAtlasHasBlock(block)) {
      fromAtlas = filtered(atlas, shader::gpgpAtlasPoint(block, hit.weights, 0));
      const glm::vec3 difference = fromAtlas - direct;
      error += static_cast<double>(glm::dot(difference, difference)) / 3;
    } else {
      ++display.holes;
    }
    const size_t row = i / size.width * size.width * 2, column = i % size.width;
    const Texel left = quantised(fromAtlas), right = quantised(direct);
    std::copy(left.begin(), left.end(), &display.picture.rgba[(row + column) * 4]);
    std::copy(right.begin(), right.end(), &display.picture.rgba[(row + size.width + column) * 4]);
  }
  const auto compared = static_cast<double>(display.shown - display.holes);
  display.psnr = error > 0 ? std::min(-10 * std::log10(error / compared), 100.0) : 100;
  return display;
}

} // namespace gpgp::cli
