// Each triangle is met with the rays of its box on the screen, in homogeneous coordinates; two passes: what hides, then
// who is seen.
#include "exact_oracle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace gpgp::test {
namespace {
using Vec = std::array<double, 4>;
constexpr uint32_t kExactSamples = 64; // a pixel has this many by this many
constexpr double kInside = 1.0 / 128;  // pixels: half of what snapping moves a corner by, and the margin

struct Placed {
  std::array<Vec, 3> clip;
  std::array<std::array<double, 2>, 3> coordinates;
  uint32_t id = 0, flags = 0;
};

struct Hit {
  bool hit = false;
  double depth = 0, u = 0, v = 0;
};

/// moved: of the ray, in pixels.
Hit meet(const Placed& t, double x, double y, const shader::Params& params) {
  const double nx = x / params.width * 2 - 1, ny = y / params.height * 2 - 1;
  double a[3], b[3], l[3], sum = 0;
  for (size_t i = 0; i < 3; ++i) a[i] = t.clip[i][0] - nx * t.clip[i][3], b[i] = t.clip[i][1] - ny * t.clip[i][3];
  for (size_t i = 0; i < 3; ++i) {
    l[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    sum += l[i];
  }
  Hit hit;
  if (sum == 0) return hit;
  double z = 0, w = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double part = l[i] / sum;
    if (part < 0) return {};
    z += part * t.clip[i][2], w += part * t.clip[i][3];
    hit.u += part * t.coordinates[i][0], hit.v += part * t.coordinates[i][1];
  }
  if (!(w > 0) || z < 0 || z > w) return {};
  hit.hit = true;
  hit.depth = params.reversedDepth ? 1 - z / w : z / w;
  return hit;
}

/// Alpha as a sampler that repeats reads it.
double alphaAt(const AlphaTexture& texture, double u, double v) {
  const auto wrapped = [](double at, uint32_t size) {
    const double n = static_cast<double>(size);
    return static_cast<size_t>(std::fmod(std::fmod(at, n) + n, n));
  };
  const auto texel = [&](double x, double y) {
    return texture
               .alpha[wrapped(std::floor(y), texture.height) * texture.width + wrapped(std::floor(x), texture.width)] /
           255.0;
  };
  const double x = u * texture.width, y = v * texture.height;
  if (!texture.linear) return texel(x, y);
  const double cx = x - 0.5, cy = y - 0.5, fx = cx - std::floor(cx), fy = cy - std::floor(cy);
  const double top = texel(cx, cy) * (1 - fx) + texel(cx + 1, cy) * fx;
  const double bottom = texel(cx, cy + 1) * (1 - fx) + texel(cx + 1, cy + 1) * fx;
  return top * (1 - fy) + bottom * fy;
}

std::vector<Placed> place(Scene& scene, uint32_t camera) {
  const visibility::CpuInput in = scene.input();
  const float* matrix = in.params.viewProjection + camera * 16;
  std::vector<Placed> all;
  for (const shader::Draw& draw : in.draws) {
    const uint32_t layers = in.params.cameraLayers[camera], own = draw.flags >> 16;
    if ((draw.flags & 8) || (own && layers && !(own & layers))) continue;
    const float* m = draw.transform;
    for (uint32_t local = 0; local < in.meshes[draw.mesh].indexCount / 3; ++local) {
      Placed t;
      t.id = draw.firstTriangle + local, t.flags = draw.flags;
      for (size_t i = 0; i < 3; ++i) {
        const size_t vertex =
            in.indices[in.meshes[draw.mesh].firstIndex + local * 3 + i] + in.meshes[draw.mesh].vertexOffset;
        double p[3], world[3];
        for (size_t k = 0; k < 3; ++k)
          p[k] = std::bit_cast<float>(
              in.positions[vertex * (in.params.positionStride / 4) + in.params.positionOffset / 4 + k]);
        for (size_t k = 0; k < 3; ++k)
          world[k] = m[k * 4] * p[0] + m[k * 4 + 1] * p[1] + m[k * 4 + 2] * p[2] + m[k * 4 + 3];
        for (size_t k = 0; k < 4; ++k)
          t.clip[i][k] = matrix[k] * world[0] + matrix[4 + k] * world[1] + matrix[8 + k] * world[2] + matrix[12 + k];
        if (vertex * 2 + 1 < scene.coordinates.size())
          t.coordinates[i] = {scene.coordinates[vertex * 2], scene.coordinates[vertex * 2 + 1]};
      }
      const auto& c = t.clip;
      const double turn = c[0][0] * (c[1][1] * c[2][3] - c[2][1] * c[1][3]) -
                          c[1][0] * (c[0][1] * c[2][3] - c[2][1] * c[0][3]) +
                          c[2][0] * (c[0][1] * c[1][3] - c[1][1] * c[0][3]);
      const double determinant = double(m[0]) * (double(m[5]) * m[10] - double(m[6]) * m[9]) -
                                 double(m[1]) * (double(m[4]) * m[10] - double(m[6]) * m[8]) +
                                 double(m[2]) * (double(m[4]) * m[9] - double(m[5]) * m[8]);
      const bool front = (turn < 0) != ((determinant < 0) != ((draw.flags & 2) != 0));
      if (turn == 0 || (!(draw.flags & 1) && !front)) continue;
      all.push_back(t);
    }
  }
  return all;
}
/// The rays, from low to below high, that can meet a triangle.
struct Window {
  double low[2], high[2];
};

Window windowOf(const Placed& t, uint32_t width, uint32_t height) {
  if (!std::all_of(t.clip.begin(), t.clip.end(), [](const Vec& v) { return v[3] > 1e-3; }))
    return {{0, 0}, {double(width), double(height)}};
  Window window{{1e9, 1e9}, {-1e9, -1e9}};
  for (size_t k = 0; k < 2; ++k)
    for (const Vec& v : t.clip) {
      const double p = (v[k] / v[3] + 1) / 2 * (k ? height : width);
      window.low[k] = std::min(window.low[k], p - 2), window.high[k] = std::max(window.high[k], p + 2);
    }
  return window;
}
} // namespace

SeenByRays seenByRays(Scene& scene, uint32_t samples, std::optional<uint32_t> only) {
  SeenByRays seen;
  seen.sure.resize(scene.params.triangleCount);
  seen.possible.resize(scene.params.triangleCount);
  const shader::Params& params = scene.params;
  const uint32_t width = params.width * samples, height = params.height * samples;
  for (uint32_t camera = 0; camera < std::max(params.cameraCount, 1u); ++camera) {
    const std::vector<Placed> triangles = place(scene, camera);
    Window window{{0, 0}, {double(width), double(height)}};
    if (only) {
      const auto of = std::find_if(triangles.begin(), triangles.end(), [&](const Placed& t) { return t.id == *only; });
      if (of == triangles.end()) continue;
      window = windowOf(*of, width, height);
    }
    const auto visit = [&](const Placed& t, const auto& at) {
      Window own = windowOf(t, width, height);
      for (size_t k = 0; k < 2; ++k)
        own.low[k] = std::max(own.low[k], window.low[k]), own.high[k] = std::min(own.high[k], window.high[k]);
      const auto clamped = [](double v, uint32_t most) {
        return static_cast<uint32_t>(std::clamp(v, 0.0, double(most)));
      };
      for (uint32_t y = clamped(own.low[1], height); y < clamped(std::ceil(own.high[1]), height); ++y)
        for (uint32_t x = clamped(own.low[0], width); x < clamped(std::ceil(own.high[0]), width); ++x)
          at(x, y, (x + 0.5) / samples, (y + 0.5) / samples);
    };
    const auto alphaOf = [&](const Placed& t, const Hit& hit) {
      const uint32_t test = (t.flags >> 8) & 31;
      return test ? alphaAt(scene.textures[test - 1], hit.u, hit.v) - double(scene.textures[test - 1].cutoff) : 1;
    };
    constexpr double kStep[5][2] = {
        {0, 0}, {-kInside, -kInside}, {kInside, -kInside}, {-kInside, kInside}, {kInside, kInside}};
    // Of each ray, how near that lies which may hide, and which surely does.
    std::vector<double> mayHide(size_t(width) * height, 2), hides(mayHide);
    for (const Placed& t : triangles) {
      if (t.flags & shader::kSeeThrough) continue;
      visit(t, [&](uint32_t x, uint32_t y, double px, double py) {
        bool sure = true;
        double nearest = 2, farthest = -1;
        for (const auto& step : kStep) {
          const Hit hit = meet(t, px + step[0], py + step[1], params);
          const double alpha = hit.hit ? alphaOf(t, hit) : -1;
          sure = sure && alpha >= 1e-4;
          if (alpha > -1e-4 && hit.hit)
            nearest = std::min(nearest, hit.depth), farthest = std::max(farthest, hit.depth);
        }
        const size_t at = size_t(y) * width + x;
        mayHide[at] = std::min(mayHide[at], nearest);
        if (sure) hides[at] = std::min(hides[at], farthest);
      });
    }
    for (const Placed& t : triangles) {
      if (only && t.id != *only) continue;
      visit(t, [&](uint32_t x, uint32_t y, double px, double py) {
        bool sure = true, may = false;
        double nearest = 2, farthest = -1;
        for (const auto& step : kStep) {
          const Hit hit = meet(t, px + step[0], py + step[1], params);
          const double alpha = hit.hit ? alphaOf(t, hit) : -1;
          sure = sure && alpha >= 1e-4;
          may = may || alpha > -1e-4;
          if (hit.hit) nearest = std::min(nearest, hit.depth), farthest = std::max(farthest, hit.depth);
        }
        const size_t at = size_t(y) * width + x;
        const double tolerance = 4e-6;
        // Its own depth is among those that may hide.
        const bool own = !(t.flags & shader::kSeeThrough);
        if (sure && (own ? nearest <= mayHide[at] : farthest + tolerance < mayHide[at])) ++seen.sure[t.id];
        if (may && nearest <= hides[at] + tolerance) ++seen.possible[t.id];
      });
    }
  }
  return seen;
}

std::string compareWithRays(Scene& scene, const std::vector<uint32_t>& bits, uint32_t samples, uint32_t least) {
  const SeenByRays seen = seenByRays(scene, samples);
  std::string wrong;
  for (uint32_t id = 0; id < scene.params.triangleCount && wrong.size() < 400; ++id) {
    const bool visible = (bits[id / 32] >> (id % 32) & 1) != 0;
    if (!visible && seen.sure[id] >= least)
      wrong += "triangle " + std::to_string(id) + " is missing, which " + std::to_string(seen.sure[id]) + " rays see; ";
    // What lies between these rays is looked for by all rays of the exact samples.
    if (visible && seen.possible[id] == 0 && seenByRays(scene, kExactSamples, id).possible[id] == 0)
      wrong += "triangle " + std::to_string(id) + " is there, which no ray sees; ";
  }
  return wrong;
}

} // namespace gpgp::test
