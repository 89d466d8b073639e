// Double precision throughout; every triangle is tried in every pixel near it.
#include "oracle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace gpgp::test {
namespace {
using Vec = std::array<double, 4>;
constexpr double kJitter = 1.0 / 64, kDepthTolerance = 4e-6;

struct Hit {
  bool hit = false;
  double depth = 0; // 0 near, 1 far, whatever the convention
};

/// Where the line of sight through a point of the screen (pixels) meets the triangle inside the view volume.
Hit meet(const std::array<Vec, 3>& t, double px, double py, const shader::Params& params) {
  const double nx = px / params.width * 2 - 1, ny = py / params.height * 2 - 1;
  std::array<double, 3> u, v, l;
  for (size_t i = 0; i < 3; ++i) u[i] = t[i][0] - nx * t[i][3], v[i] = t[i][1] - ny * t[i][3];
  for (size_t i = 0; i < 3; ++i) l[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
  const double sum = l[0] + l[1] + l[2];
  if (sum == 0) return {};
  double z = 0, w = 0;
  for (size_t i = 0; i < 3; ++i) {
    l[i] /= sum;
    if (l[i] < 0) return {};
    z += l[i] * t[i][2], w += l[i] * t[i][3];
  }
  if (!(w > 0) || z < 0 || z > w) return {};
  return {true, params.reversedDepth ? 1 - z / w : z / w};
}

/// The same for a triangle so thin on the screen that the nine points of a pixel fall beside it: 65 x 65 points, and
/// where all of it is before the camera the distance from the centre.
Hit meetThin(const std::array<Vec, 3>& t, double px, double py, const shader::Params& params) {
  Hit found{false, 2};
  for (int j = -32; j <= 32; ++j)
    for (int i = -32; i <= 32; ++i) {
      const Hit hit = meet(t, px + i * kJitter / 32, py + j * kJitter / 32, params);
      if (hit.hit) found = {true, std::min(found.depth, hit.depth)};
    }
  if (found.hit || std::any_of(t.begin(), t.end(), [](const Vec& v) { return v[3] < 1e-3; })) return found;
  for (size_t i = 0; i < 3; ++i) {
    const auto onScreen = [&](const Vec& v) {
      return std::array{(v[0] / v[3] + 1) / 2 * params.width - px, (v[1] / v[3] + 1) / 2 * params.height - py};
    };
    const auto a = onScreen(t[i]), b = onScreen(t[(i + 1) % 3]);
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
    const double s = length > 0 ? std::clamp(-(a[0] * dx + a[1] * dy) / length, 0.0, 1.0) : 0;
    if (std::hypot(a[0] + s * dx, a[1] + s * dy) > kJitter) continue;
    const double z = t[i][2] / t[i][3], z2 = t[(i + 1) % 3][2] / t[(i + 1) % 3][3], depth = z + s * (z2 - z);
    found = {true, std::min(found.depth, params.reversedDepth ? 1 - depth : depth)};
  }
  return found;
}

struct Pixel {
  double sureDepth = 2; // of the nearest triangle that surely covers the centre
  uint32_t sureId = shader::kNoTriangle;
  bool sampledMayCover = false;
  double sampledDepth = 2; // nearest possible of the sampled triangle
};
} // namespace

Verdict judge(const visibility::CpuInput& in, const std::vector<uint32_t>& ids) {
  const shader::Params& params = in.params;
  std::vector<Pixel> pixels(ids.size());
  for (const shader::Draw& draw : in.draws) {
    const shader::Mesh& mesh = in.meshes[draw.mesh];
    const float* m = draw.transform;
    const double determinant = double(m[0]) * (double(m[5]) * m[10] - double(m[6]) * m[9]) -
                               double(m[1]) * (double(m[4]) * m[10] - double(m[6]) * m[8]) +
                               double(m[2]) * (double(m[4]) * m[9] - double(m[5]) * m[8]);
    for (uint32_t local = 0; local < mesh.indexCount / 3; ++local) {
      const uint32_t id = draw.firstTriangle + local;
      std::array<Vec, 3> t;
      for (uint32_t i = 0; i < 3; ++i) {
        const size_t at =
            size_t(in.indices[mesh.firstIndex + local * 3 + i] + mesh.vertexOffset) * (params.positionStride / 4);
        double p[3], world[3];
        for (size_t k = 0; k < 3; ++k) p[k] = std::bit_cast<float>(in.positions[at + k]);
        for (size_t k = 0; k < 3; ++k)
          world[k] = m[k * 4] * p[0] + m[k * 4 + 1] * p[1] + m[k * 4 + 2] * p[2] + m[k * 4 + 3];
        for (size_t k = 0; k < 4; ++k)
          t[i][k] = params.viewProjection[k] * world[0] + params.viewProjection[4 + k] * world[1] +
                    params.viewProjection[8 + k] * world[2] + params.viewProjection[12 + k];
      }
      // Orientation of (x, y, w): negative is counter-clockwise as seen with y down.
      const double turn = t[0][0] * (t[1][1] * t[2][3] - t[2][1] * t[1][3]) -
                          t[1][0] * (t[0][1] * t[2][3] - t[2][1] * t[0][3]) +
                          t[2][0] * (t[0][1] * t[1][3] - t[1][1] * t[0][3]);
      if (!(draw.flags & shader::kTwoSided) && (determinant < 0 ? turn <= 0 : turn >= 0)) continue;
      double left = 0, top = 0, right = params.width, bottom = params.height;
      if (std::all_of(t.begin(), t.end(), [](const Vec& v) { return v[3] > 1e-3; })) {
        left = top = 1e9, right = bottom = -1e9;
        for (const Vec& v : t) {
          const double x = (v[0] / v[3] + 1) / 2 * params.width, y = (v[1] / v[3] + 1) / 2 * params.height;
          left = std::min(left, x - 1), right = std::max(right, x + 1);
          top = std::min(top, y - 1), bottom = std::max(bottom, y + 1);
        }
      }
      const auto x0 = static_cast<long>(std::clamp<double>(left, 0, params.width));
      const auto x1 = static_cast<long>(std::clamp<double>(std::ceil(right), 0, params.width));
      const auto y0 = static_cast<long>(std::clamp<double>(top, 0, params.height));
      const auto y1 = static_cast<long>(std::clamp<double>(std::ceil(bottom), 0, params.height));
      for (long y = y0; y < y1; ++y)
        for (long x = x0; x < x1; ++x) {
          const size_t at = size_t(y) * params.width + static_cast<size_t>(x);
          bool sure = true, may = false;
          double nearest = 2, farthest = -1;
          for (int j = 0; j < 9; ++j) {
            const Hit hit =
                meet(t, double(x) + 0.5 + (j % 3 - 1) * kJitter, double(y) + 0.5 + (j / 3 - 1) * kJitter, params);
            sure &= hit.hit, may |= hit.hit;
            if (hit.hit) nearest = std::min(nearest, hit.depth), farthest = std::max(farthest, hit.depth);
          }
          Pixel& pixel = pixels[at];
          if (sure && farthest < pixel.sureDepth) pixel.sureDepth = farthest, pixel.sureId = id;
          if (!may && ids[at] == id) {
            const Hit thin = meetThin(t, double(x) + 0.5, double(y) + 0.5, params);
            may = thin.hit, nearest = thin.depth;
          }
          if (may && ids[at] == id) {
            pixel.sampledMayCover = true;
            pixel.sampledDepth = std::min(pixel.sampledDepth, nearest);
          }
        }
    }
  }
  Verdict verdict;
  for (size_t i = 0; i < ids.size(); ++i) {
    const Pixel& pixel = pixels[i];
    const char* reason = nullptr;
    if (ids[i] == shader::kNoTriangle) {
      if (pixel.sureId != shader::kNoTriangle) reason = "a triangle that covers it was missed";
    } else {
      ++verdict.covered;
      if (!pixel.sampledMayCover)
        reason = "its triangle does not cover it";
      else if (pixel.sampledDepth > pixel.sureDepth + kDepthTolerance)
        reason = "a nearer triangle covers it";
    }
    ++verdict.pixels;
    if (!reason) continue;
    if (verdict.wrong++ == 0)
      verdict.firstWrong = "pixel (" + std::to_string(i % params.width) + ", " + std::to_string(i / params.width) +
                           "), sampled " + std::to_string(ids[i]) + ", certain " + std::to_string(pixel.sureId) + ": " +
                           reason;
  }
  return verdict;
}

} // namespace gpgp::test
