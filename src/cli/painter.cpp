// A small software rasteriser: edge functions over each triangle's box, a depth buffer at twice the resolution.
#include "cli/painter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::cli {

glm::mat4 viewAll(const Bounds& bounds, float yaw, float pitch, uint32_t width, uint32_t height) {
  const float yawRadians = glm::radians(yaw), pitchRadians = glm::radians(pitch);
  const glm::vec3 back(std::sin(yawRadians) * std::cos(pitchRadians), std::sin(pitchRadians),
                       std::cos(yawRadians) * std::cos(pitchRadians)); // from the middle to the eye
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  const glm::vec3 up = glm::cross(back, right);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const float scale = 1.0f / std::tan(0.35f); // half the field of view of the smaller side, radians
  const glm::vec2 zoom = aspect >= 1.0f ? glm::vec2(scale / aspect, scale) : glm::vec2(scale, scale * aspect);
  // Back until the last corner of the box is in the picture, with a twentieth to spare.
  const glm::vec3 half = glm::max((bounds.high - bounds.low) * 0.5f, glm::vec3(1e-6f));
  float distance = 0.0f, depth = 0.0f;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
    const float side = std::max(std::abs(glm::dot(corner, right)) * zoom.x, std::abs(glm::dot(corner, up)) * zoom.y);
    distance = std::max(distance, glm::dot(corner, back) + side * 1.05f);
    depth = std::max(depth, std::abs(glm::dot(corner, back)));
  }
  distance = std::max(distance, depth * 1.1f);
  const glm::vec3 eye = bounds.centre() + back * distance;
  const float near = (distance - depth) * 0.9f, far = distance + depth * 1.1f;
  const glm::mat4 view(glm::vec4(right.x, up.x, back.x, 0), glm::vec4(right.y, up.y, back.y, 0),
                       glm::vec4(right.z, up.z, back.z, 0),
                       glm::vec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1));
  glm::mat4 projection(0.0f);
  projection[0][0] = zoom.x;
  projection[1][1] = -zoom.y;
  projection[2][2] = far / (near - far);
  projection[2][3] = -1.0f;
  projection[3][2] = near * far / (near - far);
  return projection * view;
}

Painter::Painter(uint32_t width, uint32_t height, bool reversed)
    : reversed_(reversed), width_(width), height_(height), depth_(size_t{width} * height * 4, reversed ? 0.0f : 1.0f),
      colour_(size_t{width} * height * 4, glm::vec3(0.97f)) {}

namespace {

constexpr uint32_t kSunPixels = 4096; // a side of the shadow map
const glm::vec3 kToSun = glm::normalize(glm::vec3(0.45f, 0.8f, 0.4f));

float edge(const glm::vec3& a, const glm::vec3& b, float x, float y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// Calls paint(x, y, weights) for each pixel centre in a triangle of pixel positions.
template <class Paint>
void fill(const std::array<glm::vec3, 3>& p, float area, uint32_t width, uint32_t height, const Paint& paint) {
  const auto range = [](float a, float b, float c, float limit) {
    const float low = std::clamp(std::floor(std::min({a, b, c})), 0.0f, limit);
    const float high = std::clamp(std::ceil(std::max({a, b, c})), 0.0f, limit);
    return std::pair(static_cast<uint32_t>(low), static_cast<uint32_t>(high));
  };
  const auto [left, right] = range(p[0].x, p[1].x, p[2].x, static_cast<float>(width));
  const auto [top, bottom] = range(p[0].y, p[1].y, p[2].y, static_cast<float>(height));
  for (uint32_t y = top; y < bottom; ++y)
    for (uint32_t x = left; x < right; ++x) {
      const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
      const float a = edge(p[1], p[2], px, py) / area, b = edge(p[2], p[0], px, py) / area, c = 1.0f - a - b;
      if (a >= 0 && b >= 0 && c >= 0) paint(x, y, glm::vec3(a, b, c));
    }
}

} // namespace

void Painter::sun(const Bounds& bounds) {
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), kToSun)), up = glm::cross(kToSun, right);
  const float radius = std::max(glm::length(bounds.high - bounds.low) * 0.5f, 1e-6f);
  const float scale = kSunPixels * 0.5f / radius;
  const glm::vec3 centre = bounds.centre();
  toSun_ = glm::transpose(glm::mat4(glm::vec4(right * scale, kSunPixels * 0.5f - glm::dot(right, centre) * scale),
                                    glm::vec4(up * scale, kSunPixels * 0.5f - glm::dot(up, centre) * scale),
                                    glm::vec4(-kToSun, glm::dot(kToSun, centre)), glm::vec4(0, 0, 0, 1)));
  sunPixel_ = 1.0f / scale;
  sunDepth_.assign(size_t{kSunPixels} * kSunPixels, 1e30f);
}

void Painter::shadow(std::span<const glm::vec3, 3> corners) {
  std::array<glm::vec3, 3> p;
  for (size_t i = 0; i < 3; ++i) p[i] = glm::vec3(toSun_ * glm::vec4(corners[i], 1.0f));
  const float area = edge(p[0], p[1], p[2].x, p[2].y);
  if (!(std::abs(area) > 1e-9f)) return;
  fill(p, area, kSunPixels, kSunPixels, [&](uint32_t x, uint32_t y, const glm::vec3& weights) {
    float& depth = sunDepth_[size_t{y} * kSunPixels + x];
    depth = std::min(depth, glm::dot(weights, glm::vec3(p[0].z, p[1].z, p[2].z)));
  });
}

bool Painter::lit(const glm::vec3& point, float tolerance) const {
  const glm::vec3 p(toSun_ * glm::vec4(point, 1.0f));
  if (!(p.x >= 0 && p.y >= 0 && p.x < kSunPixels && p.y < kSunPixels)) return true;
  return p.z <= sunDepth_[static_cast<size_t>(p.y) * kSunPixels + static_cast<size_t>(p.x)] + tolerance;
}

void Painter::triangle(const glm::mat4& viewProjection, std::span<const glm::vec3, 3> corners,
                       const glm::vec3& colour) {
  const glm::vec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const float length = glm::length(cross);
  if (!(length > 0)) return;
  std::array<Corner, 3> whole;
  std::array<float, 3> inside; // how far behind the near plane
  for (size_t i = 0; i < 3; ++i) {
    const glm::vec4 clip = viewProjection * glm::vec4(corners[i], 1.0f);
    whole[i] = {clip, corners[i]};
    inside[i] = reversed_ ? clip.w - clip.z : clip.z;
  }
  std::array<Corner, 4> cut; // as Sutherland and Hodgman do
  size_t count = 0;
  for (size_t i = 0; i < 3; ++i) {
    const size_t next = (i + 1) % 3;
    if (inside[i] >= 0) cut[count++] = whole[i];
    if ((inside[i] >= 0) == (inside[next] >= 0)) continue;
    // From the inner to the outer corner, so that neighbours cut their edge at the same point.
    const size_t from = inside[i] >= 0 ? i : next, to = inside[i] >= 0 ? next : i;
    const float t = inside[from] / (inside[from] - inside[to]);
    cut[count++] = {glm::mix(whole[from].clip, whole[to].clip, t), glm::mix(whole[from].world, whole[to].world, t)};
  }
  for (size_t i = 2; i < count; ++i) piece({cut[0], cut[i - 1], cut[i]}, cross / length, colour);
}

void Painter::piece(const std::array<Corner, 3>& corners, const glm::vec3& front, const glm::vec3& colour) {
  const uint32_t width = width_ * 2, height = height_ * 2;
  std::array<glm::vec3, 3> p;
  glm::vec3 inverseW;
  for (int i = 0; i < 3; ++i) {
    const glm::vec4& clip = corners[static_cast<size_t>(i)].clip;
    if (!(clip.w > 0)) return;
    inverseW[i] = 1.0f / clip.w;
    p[static_cast<size_t>(i)] = glm::vec3((clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(width),
                                          (clip.y / clip.w * 0.5f + 0.5f) * static_cast<float>(height),
                                          (reversed_ ? -clip.z : clip.z) / clip.w); // nearer ones are smaller
  }
  const float area = edge(p[0], p[1], p[2].x, p[2].y);
  if (!(std::abs(area) > 1e-9f)) return;
  const glm::vec3 normal = area < 0 ? front : -front; // of the side that is seen
  const float toSun = std::max(glm::dot(normal, kToSun), 0.0f);
  const float sky = 0.5f + 0.12f * normal.y + 0.05f * normal.x, sun = 0.5f * toSun;
  const float tolerance = sunPixel_ * (1.5f + 1.5f * std::sqrt(1.0f - toSun * toSun) / std::max(toSun, 0.1f));
  fill(p, area, width, height, [&](uint32_t x, uint32_t y, const glm::vec3& weights) {
    const float z = glm::dot(weights, glm::vec3(p[0].z, p[1].z, p[2].z));
    const size_t index = size_t{y} * width + x;
    if (z >= depth_[index]) return;
    depth_[index] = z;
    bool sunny = toSun > 0;
    if (sunny && !sunDepth_.empty()) {
      glm::vec3 w = weights * inverseW;
      w /= w.x + w.y + w.z;
      sunny = lit(corners[0].world * w.x + corners[1].world * w.y + corners[2].world * w.z, tolerance);
    }
    colour_[index] = colour * (sunny ? sky + sun : sky);
  });
}

host::Picture Painter::picture() const {
  host::Picture picture{width_, height_, std::vector<uint8_t>(size_t{width_} * height_ * 4)};
  for (uint32_t y = 0; y < height_; ++y)
    for (uint32_t x = 0; x < width_; ++x) {
      const size_t first = size_t{y} * 2 * width_ * 2 + size_t{x} * 2;
      const glm::vec3 sum =
          colour_[first] + colour_[first + 1] + colour_[first + width_ * 2] + colour_[first + width_ * 2 + 1];
      uint8_t* pixel = &picture.rgba[(size_t{y} * width_ + x) * 4];
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<uint8_t>(std::lround(std::clamp(sum[c] * 0.25f, 0.0f, 1.0f) * 255.0f));
      pixel[3] = 255;
    }
  return picture;
}

glm::vec3 paletteColour(uint32_t n) {
  constexpr std::array<uint32_t, 16> kColours = {0xb9c4cc, 0x6c9bd2, 0xe0a458, 0x7fb069, 0xd36c6c, 0x9b86c2,
                                                 0xa98467, 0xe3a3c6, 0x8f8f8f, 0x58a4a4, 0xf2efe6, 0x3f4b57,
                                                 0xb5523b, 0xe8d8b0, 0x4a6fa5, 0x5d7f45};
  const uint32_t rgb = kColours[n % kColours.size()];
  return glm::vec3(static_cast<float>(rgb >> 16 & 255u), static_cast<float>(rgb >> 8 & 255u),
                   static_cast<float>(rgb & 255u)) /
         255.0f;
}

} // namespace gpgp::cli
