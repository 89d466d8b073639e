// Triangles are sorted by the way they face, 54 ways, and then along a Z-order curve. So nearly all clusters face one
// way, and half of those of a closed mesh face away from any viewer.
#include "visibility/triangle_order.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numeric>
#include <vector>

namespace gpgp::visibility {
namespace {
/// Of a cube's sides, each cut into 3 x 3 parts, so that what is parallel to an axis is in the middle of a part.
uint32_t wayOf(glm::vec3 normal) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto third = [&](int other) {
    const float share = 3 * normal[other];
    return share > size[axis] ? 2u : share < -size[axis] ? 0u : 1u;
  };
  const uint32_t side = static_cast<uint32_t>(axis) * 2 + (normal[axis] < 0 ? 1 : 0);
  return side * 9 + third((axis + 1) % 3) * 3 + third((axis + 2) % 3);
}

/// Ten bits of each coordinate, from 0 to 1.
uint32_t curveOf(glm::vec3 place) {
  uint32_t key = 0;
  for (int bit = 9; bit >= 0; --bit)
    for (int k = 0; k < 3; ++k)
      key = key * 2 + (static_cast<uint32_t>(place[k] * 1023.0f) >> static_cast<uint32_t>(bit) & 1u);
  return key;
}
} // namespace

core::Result<void> orderTriangles(const float* positions, uint32_t stride, uint32_t vertexCount,
                                  std::span<const uint32_t> indices, uint32_t* orders) {
  if (indices.size() % 3)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "indexCount is %zu; expected a multiple of 3", indices.size());
  if (stride < 12)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "positionStride is %u; expected 12 or more", stride);
  for (size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= vertexCount)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "indices[%zu] is %u; there are %u vertices", i, indices[i],
                             vertexCount);
  const std::span order(orders, indices.size() / 3);
  const auto corner = [&](size_t i) {
    float p[3];
    std::memcpy(p, reinterpret_cast<const char*>(positions) + size_t(indices[i]) * stride, sizeof p);
    for (float& v : p) v = std::isfinite(v) ? std::clamp(v, -1e15f, 1e15f) : 0; // what is skipped may lie anywhere
    return glm::vec3(p[0], p[1], p[2]);
  };
  glm::vec3 low(1e30f), high(-1e30f);
  for (size_t i = 0; i < indices.size(); ++i) {
    low = glm::min(low, corner(i));
    high = glm::max(high, corner(i));
  }
  const glm::vec3 size = high - low;
  const float widest = std::max({size.x, size.y, size.z, 1e-30f});
  std::vector<uint64_t> keys(order.size());
  for (size_t i = 0; i < keys.size(); ++i) {
    const glm::vec3 a = corner(i * 3), b = corner(i * 3 + 1), c = corner(i * 3 + 2);
    const glm::vec3 place = glm::clamp(((a - low) + (b - low) + (c - low)) / (3 * widest), 0.0f, 1.0f);
    keys[i] = uint64_t(wayOf(glm::cross(b - a, c - a))) << 32 | curveOf(place);
  }
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  return {};
}

} // namespace gpgp::visibility
