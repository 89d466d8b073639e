// A small software rasteriser: edge functions over each triangle's box, a depth buffer of two or three points a pixel
// each way.
#include "cli/shared/painter.h"

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
  const glm::vec3 half = glm::max((bounds.high - bounds.low) * 0.5f, glm::vec3(bounds.radius() * 1e-6f));
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
  projection[3][2] = near * (far / (near - far));
  return projection * view;
}

glm::mat4 viewFrom(const glm::vec3& eye, const glm::vec3& target, float fov, uint32_t width, uint32_t height) {
  const glm::vec3 back = glm::normalize(eye - target);
  const glm::vec3 above = std::abs(back.y) > 0.9999f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(above, back)), up = glm::cross(back, right);
  const float scale = 1.0f / std::tan(glm::radians(fov) * 0.5f);
  const float near = std::min(glm::length(eye - target) * 1e-3f, 0.1f), far = near * 1e5f;
  const glm::mat4 view(glm::vec4(right.x, up.x, back.x, 0), glm::vec4(right.y, up.y, back.y, 0),
                       glm::vec4(right.z, up.z, back.z, 0),
                       glm::vec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1));
  glm::mat4 projection(0.0f);
  projection[0][0] = scale * static_cast<float>(height) / static_cast<float>(width);
  projection[1][1] = -scale;
  projection[2][2] = far / (near - far);
  projection[2][3] = -1.0f;
  projection[3][2] = near * (far / (near - far));
  return projection * view;
}

Painter::Painter(uint32_t width, uint32_t height, bool reversed, Style style)
    : reversed_(reversed), style_(style), width_(width * (style == Style::smooth ? 2 : 3)),
      height_(height * (style == Style::smooth ? 2 : 3)), depth_(size_t{width_} * height_, reversed ? 0.0f : 1.0f),
      colour_(size_t{width_} * height_, glm::u8vec4(247, 247, 247, 0)),
      number_(style == Style::smooth ? 0 : size_t{width_} * height_, UINT32_MAX) {}

/// A part of a triangle on the points; z grows with the distance.
struct Painter::Piece {
  std::array<glm::vec3, 3> p, world;
  glm::vec3 inverseW;
  float area;
  glm::vec3 normal; ///< of the side that is seen
};

namespace {

constexpr uint32_t kSunPixels = 4096; // a side of the shadow map
const glm::vec3 kToSun = glm::normalize(glm::vec3(0.45f, 0.8f, 0.4f));

float edge(const glm::vec3& a, const glm::vec3& b, float x, float y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// Calls visit(x, y) for the pixels in the box of three positions.
template <class Visit>
void forBox(const std::array<glm::vec3, 3>& p, uint32_t width, uint32_t height, const Visit& visit) {
  const auto range = [](float a, float b, float c, float limit) {
    const float low = std::clamp(std::floor(std::min({a, b, c})), 0.0f, limit);
    const float high = std::clamp(std::ceil(std::max({a, b, c})), 0.0f, limit);
    return std::pair(static_cast<uint32_t>(low), static_cast<uint32_t>(high));
  };
  const auto [left, right] = range(p[0].x, p[1].x, p[2].x, static_cast<float>(width));
  const auto [top, bottom] = range(p[0].y, p[1].y, p[2].y, static_cast<float>(height));
  for (uint32_t y = top; y < bottom; ++y)
    for (uint32_t x = left; x < right; ++x) visit(x, y);
}

/// Calls paint(x, y, weights) for each pixel centre in a triangle of pixel positions.
template <class Paint>
void fill(const std::array<glm::vec3, 3>& p, float area, uint32_t width, uint32_t height, const Paint& paint) {
  if (!(std::abs(area) > 1e-9f)) return;
  forBox(p, width, height, [&](uint32_t x, uint32_t y) {
    const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
    const float a = edge(p[1], p[2], px, py) / area, b = edge(p[2], p[0], px, py) / area, c = 1.0f - a - b;
    if (a >= 0 && b >= 0 && c >= 0) paint(x, y, glm::vec3(a, b, c));
  });
}

/// The weights of the point of a triangle that is nearest to q.
glm::vec3 nearestPoint(const std::array<glm::vec3, 3>& p, float area, const glm::vec2& q) {
  const glm::vec3 inside =
      glm::vec3(edge(p[1], p[2], q.x, q.y), edge(p[2], p[0], q.x, q.y), edge(p[0], p[1], q.x, q.y)) / area;
  if (inside.x >= 0 && inside.y >= 0 && inside.z >= 0) return inside;
  glm::vec3 best(0);
  float least = 1e30f;
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const glm::vec2 from(p[static_cast<size_t>(i)]), way = glm::vec2(p[static_cast<size_t>(next)]) - from;
    const float t = glm::clamp(glm::dot(q - from, way) / std::max(glm::dot(way, way), 1e-30f), 0.0f, 1.0f);
    const glm::vec2 rest = from + way * t - q;
    if (glm::dot(rest, rest) >= least) continue;
    least = glm::dot(rest, rest);
    best = glm::vec3(0);
    best[i] = 1.0f - t;
    best[next] = t;
  }
  return best;
}

/// Calls visit(x, y, weights) for pixels that a triangle of pixel positions touches, one or more of any triangle in the
/// picture: those that hold its point nearest to their centre, which weights are.
template <class Visit>
void touched(const std::array<glm::vec3, 3>& p, float area, uint32_t width, uint32_t height, const Visit& visit) {
  forBox(p, width, height, [&](uint32_t x, uint32_t y) {
    const glm::vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const glm::vec3 w = nearestPoint(p, area, centre);
    const glm::vec2 rest = glm::abs(glm::vec2(p[0]) * w.x + glm::vec2(p[1]) * w.y + glm::vec2(p[2]) * w.z - centre);
    if (std::max(rest.x, rest.y) <= 0.501f) visit(x, y, w);
  });
}

float skyLight(const glm::vec3& normal) { return 0.5f + 0.12f * normal.y + 0.05f * normal.x; }

} // namespace

void Painter::sun(const Bounds& bounds) {
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), kToSun)), up = glm::cross(kToSun, right);
  const float scale = kSunPixels * 0.5f / bounds.radius();
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
  fill(p, edge(p[0], p[1], p[2].x, p[2].y), kSunPixels, kSunPixels,
       [&](uint32_t x, uint32_t y, const glm::vec3& weights) {
         float& depth = sunDepth_[size_t{y} * kSunPixels + x];
         depth = std::min(depth, glm::dot(weights, glm::vec3(p[0].z, p[1].z, p[2].z)));
       });
}

bool Painter::lit(const glm::vec3& point, float tolerance) const {
  const glm::vec3 p(toSun_ * glm::vec4(point, 1.0f));
  if (!(p.x >= 0 && p.y >= 0 && p.x < kSunPixels && p.y < kSunPixels)) return true;
  return p.z <= sunDepth_[static_cast<size_t>(p.y) * kSunPixels + static_cast<size_t>(p.x)] + tolerance;
}

std::vector<Painter::Piece> Painter::pieces(const glm::mat4& viewProjection, const Triangle& triangle) const {
  struct Corner {
    glm::vec4 clip;
    glm::vec3 world;
  };
  const std::array<glm::vec3, 3>& corners = triangle.corners;
  // In double: the squares of small ones vanish.
  const glm::dvec3 cross = glm::cross(glm::dvec3(corners[1] - corners[0]), glm::dvec3(corners[2] - corners[0]));
  const double length = glm::length(cross);
  if (!(length > 0)) return {};
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
  std::vector<Piece> pieces;
  for (size_t last = 2; last < count; ++last) {
    const std::array<Corner, 3> three{cut[0], cut[last - 1], cut[last]};
    Piece piece;
    bool isBehind = false;
    for (int i = 0; i < 3; ++i) {
      const auto& [clip, world] = three[static_cast<size_t>(i)];
      isBehind = isBehind || !(clip.w > 0);
      piece.inverseW[i] = 1.0f / clip.w;
      piece.world[static_cast<size_t>(i)] = world;
      piece.p[static_cast<size_t>(i)] = glm::vec3((clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(width_),
                                                  (clip.y / clip.w * 0.5f + 0.5f) * static_cast<float>(height_),
                                                  (reversed_ ? -clip.z : clip.z) / clip.w);
    }
    piece.area = edge(piece.p[0], piece.p[1], piece.p[2].x, piece.p[2].y);
    piece.normal = glm::vec3((piece.area < 0 ? cross : -cross) / length);
    if (!isBehind && std::abs(piece.area) > 0) pieces.push_back(piece);
  }
  return pieces;
}

void Painter::put(size_t point, const Triangle& triangle, float light) {
  colour_[point] = glm::u8vec4(glm::round(glm::clamp(triangle.colour * light, 0.0f, 1.0f) * 255.0f), triangle.rank + 1);
}

void Painter::triangle(const glm::mat4& viewProjection, const Triangle& triangle) {
  for (const Piece& piece : pieces(viewProjection, triangle)) {
    const float toSun = std::max(glm::dot(piece.normal, kToSun), 0.0f);
    const float sky = skyLight(piece.normal), sun = 0.5f * toSun;
    const float tolerance = sunPixel_ * (1.5f + 1.5f * std::sqrt(1.0f - toSun * toSun) / std::max(toSun, 0.1f));
    fill(piece.p, piece.area, width_, height_, [&](uint32_t x, uint32_t y, const glm::vec3& weights) {
      const float z = glm::dot(weights, glm::vec3(piece.p[0].z, piece.p[1].z, piece.p[2].z));
      const size_t point = size_t{y} * width_ + x;
      if (z >= depth_[point]) return;
      depth_[point] = z;
      bool sunny = toSun > 0;
      if (sunny && !sunDepth_.empty()) {
        glm::vec3 w = weights * piece.inverseW;
        w /= w.x + w.y + w.z;
        sunny = lit(piece.world[0] * w.x + piece.world[1] * w.y + piece.world[2] * w.z, tolerance);
      }
      put(point, triangle, sunny ? sky + sun : sky);
      if (!number_.empty()) number_[point] = triangle.number;
    });
  }
}

void Painter::mark(const glm::mat4& viewProjection, const Triangle& triangle, bool isInSight) {
  const std::vector<Piece> all = pieces(viewProjection, triangle);
  bool isShown = false;
  for (const Piece& piece : all)
    forBox(piece.p, width_, height_,
           [&](uint32_t x, uint32_t y) { isShown = isShown || number_[size_t{y} * width_ + x] == triangle.number; });
  if (isShown) return;
  const auto paint = [&](size_t point, const glm::vec3& normal) {
    if (colour_[point].a <= triangle.rank)
      put(point, triangle, skyLight(normal) + 0.5f * std::max(glm::dot(normal, kToSun), 0.0f));
  };
  float least = 1e30f; // how far behind what is shown
  size_t best = 0;
  const Piece* bestPiece = nullptr;
  for (const Piece& piece : all)
    touched(piece.p, piece.area, width_, height_, [&](uint32_t x, uint32_t y, const glm::vec3& weights) {
      const float behind =
          glm::dot(weights, glm::vec3(piece.p[0].z, piece.p[1].z, piece.p[2].z)) - depth_[size_t{y} * width_ + x];
      if (x % 3 == 1 && y % 3 == 1) // on the side where it lies
        x = glm::dot(weights, glm::vec3(piece.p[0].x, piece.p[1].x, piece.p[2].x)) < static_cast<float>(x) + 0.5f
                ? x - 1
                : x + 1;
      const size_t point = size_t{y} * width_ + x;
      if (behind < 0) paint(point, piece.normal);
      if (behind < least) {
        least = behind;
        best = point;
        bestPiece = &piece;
      }
    });
  if (bestPiece && isInSight) paint(best, bestPiece->normal);
}

host::Picture Painter::picture() const {
  const uint32_t side = style_ == Style::smooth ? 2 : 1; // points of a pixel of the picture
  host::Picture picture{width_ / side, height_ / side, {}};
  picture.rgba.reserve(size_t{picture.width} * picture.height * 4);
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) {
      glm::uvec3 sum(0);
      for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) sum += glm::uvec3(colour_[(size_t{y} * side + j) * width_ + x * side + i]);
      const glm::uvec3 mean = (sum + side * side / 2) / (side * side);
      for (int c = 0; c < 3; ++c) picture.rgba.push_back(static_cast<uint8_t>(mean[c]));
      picture.rgba.push_back(255);
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
