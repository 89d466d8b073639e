// Spot checks by Embree: rays through single samples of a picture, against the sampled ids and the exact method's
// bits. An independent library with another way to intersect; what lies within 1/64 pixel of an edge is left out, as
// gpgp snaps vertices to 1/256 pixel.
#include "gpu.h"
#include "measured_scenes.h"

#include <bit>
#include <embree3/rtcore.h>
#include <glm/matrix.hpp>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

/// A scene's triangles in world space, in their numbers' order, each front face or two-sided.
class Rays {
public:
  explicit Rays(Scene& scene) : device_(rtcNewDevice("threads=1")), world_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const size_t count = scene.params.triangleCount;
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, count * 3));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
    twoSided_.resize(count);
    for (uint32_t i = 0; i < count * 3; ++i) indices[i] = i;
    for (const shader::Draw& draw : scene.draws) {
      const shader::Mesh& mesh = scene.meshes[draw.mesh];
      const glm::mat3 m(draw.transform[0], draw.transform[4], draw.transform[8], draw.transform[1], draw.transform[5],
                        draw.transform[9], draw.transform[2], draw.transform[6], draw.transform[10]);
      const bool turned = glm::determinant(m) < 0;
      for (uint32_t i = 0; i < mesh.indexCount; ++i) {
        const float* p = &scene.positions[size_t(mesh.vertexOffset + scene.indices[mesh.firstIndex + i]) * 3];
        const uint32_t triangle = draw.firstTriangle + i / 3, corner = turned ? 2 - i % 3 : i % 3;
        for (int axis = 0; axis < 3; ++axis) {
          const float* row = draw.transform + axis * 4;
          vertices[(size_t(triangle) * 3 + corner) * 3 + static_cast<size_t>(axis)] =
              row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
        }
        twoSided_[triangle] = draw.flags & shader::kTwoSided;
      }
    }
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryIntersectFilterFunction(geometry, rejectBackFaces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(world_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(world_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(world_);
  }
  ~Rays() {
    rtcReleaseScene(world_);
    rtcReleaseDevice(device_);
  }
  Rays(const Rays&) = delete;
  Rays& operator=(const Rays&) = delete;

  struct Hit {
    uint32_t triangle = shader::kNoTriangle;
    float distance = 0;
  };
  /// What is nearest from one point towards another; distance: a share of the way.
  Hit shoot(const glm::vec3& from, const glm::vec3& to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    const glm::vec3 along = to - from;
    ray.ray.org_x = from.x;
    ray.ray.org_y = from.y;
    ray.ray.org_z = from.z;
    ray.ray.dir_x = along.x;
    ray.ray.dir_y = along.y;
    ray.ray.dir_z = along.z;
    ray.ray.tfar = 1.0f;
    ray.ray.mask = ~0u;
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(world_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {ray.hit.primID, ray.ray.tfar};
  }

private:
  static void rejectBackFaces(const RTCFilterFunctionNArguments* args) {
    const Rays& self = *static_cast<const Rays*>(args->geometryUserPtr);
    const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, 0);
    const RTCRay ray = rtcGetRayFromRayN(args->ray, args->N, 0);
    // Embree's normal of a counter-clockwise triangle points towards the viewer of its front.
    const float cosine = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z;
    if (!self.twoSided_[hit.primID] && cosine > 0) args->valid[0] = 0;
  }
  RTCDevice device_;
  RTCScene world_;
  std::vector<uint32_t> twoSided_;
};

/// World-space points of a place in the picture (pixels) on the near and far plane.
struct Ray {
  glm::vec3 from, to;
  Ray(const shader::Params& params, double x, double y) {
    glm::dmat4 m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = params.viewProjection[i];
    const glm::dmat4 back = glm::inverse(m);
    const double nx = x / params.width * 2 - 1, ny = y / params.height * 2 - 1;
    const glm::dvec4 a = back * glm::dvec4(nx, ny, params.reversedDepth ? 1 : 0, 1);
    const glm::dvec4 b = back * glm::dvec4(nx, ny, params.reversedDepth ? 0.001 : 0.999, 1);
    from = glm::vec3(glm::dvec3(a) / a.w);
    to = glm::vec3(glm::dvec3(b) / b.w);
  }
};

std::vector<std::pair<std::string, Scene>> checkedScenes() {
  std::vector<std::pair<std::string, Scene>> scenes;
  Scene bunnies = bunnyGrid(3, 3);
  setOrbitCamera(bunnies, 1, 8, 2.5f, 160, 90);
  scenes.emplace_back("bunnies", std::move(bunnies));
  Scene columns = colonnadeWithWires(0.6f);
  setWalkingCamera(columns, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, 160, 90, true);
  scenes.emplace_back("colonnade", std::move(columns));
  Scene hedge = foliage(6000);
  setWalkingCamera(hedge, {1, 1.7f, 7}, {0, 1.5f, 0}, 160, 90, true);
  scenes.emplace_back("foliage", std::move(hedge));
  Scene houses = city(6);
  setOrbitCamera(houses, 1, 8, 1.2f, 160, 90);
  scenes.emplace_back("city", std::move(houses));
  return scenes;
}

/// The one triangle that rays through a place and its surroundings of 1/64 pixel hit; kNoTriangle: they disagree, or
/// nothing is there. depthGap: another surface is nearly as near.
uint32_t certainHit(const Rays& rays, const shader::Params& params, double x, double y) {
  uint32_t triangle = shader::kNoTriangle;
  for (const auto& [dx, dy] : {std::pair(0, 0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
    const Ray ray(params, x + dx / 64.0, y + dy / 64.0);
    const Rays::Hit hit = rays.shoot(ray.from, ray.to);
    if (hit.triangle == shader::kNoTriangle || (triangle != shader::kNoTriangle && hit.triangle != triangle))
      return shader::kNoTriangle;
    triangle = hit.triangle;
  }
  return triangle;
}

TEST_F(VisibilityGpuTest, IdsAtPixelCentresAreWhatEmbreesRaysHit) {
  for (auto& [name, scene] : checkedScenes()) {
    const GpuResult gpu = sample(scene);
    const Rays rays(scene);
    uint32_t checked = 0, different = 0;
    for (uint32_t y = 0; y < scene.params.height; ++y)
      for (uint32_t x = 0; x < scene.params.width; ++x) {
        const uint32_t expected = certainHit(rays, scene.params, x + 0.5, y + 0.5);
        if (expected == shader::kNoTriangle) continue;
        ++checked;
        const uint32_t got = gpu.ids[size_t(y) * scene.params.width + x];
        if (got != expected && ++different < 5)
          ADD_FAILURE() << name << ": pixel " << x << ", " << y << " shows " << got << ", Embree hits " << expected;
      }
    EXPECT_GT(checked, name == "bunnies" ? 150u : 3000u) << name; // few of theirs are larger than a pixel
    EXPECT_EQ(different, 0u) << name << " of " << checked;
  }
}

// What a ray anywhere in a pixel surely hits can be seen: the exact method must have it.
TEST_F(VisibilityGpuTest, WhatEmbreesRaysHitAnywhereIsFoundExactly) {
  std::mt19937 random(6);
  for (auto& [name, scene] : checkedScenes()) {
    const GpuResult exact = sample(scene, {.method = GPGP_SAMPLING_EXACT});
    const Rays rays(scene);
    std::vector<uint32_t> seen((scene.params.triangleCount + 31) / 32);
    uint32_t hits = 0;
    for (int i = 0; i < 40000; ++i) {
      const double x = static_cast<double>(random()) * 0x1p-32 * scene.params.width;
      const double y = static_cast<double>(random()) * 0x1p-32 * scene.params.height;
      const uint32_t triangle = certainHit(rays, scene.params, x, y);
      if (triangle == shader::kNoTriangle) continue;
      ++hits;
      seen[triangle / 32] |= 1u << triangle % 32;
    }
    uint32_t all = 0, found = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
      all += static_cast<uint32_t>(std::popcount(seen[i]));
      found += static_cast<uint32_t>(std::popcount(seen[i] & exact.bits[i]));
    }
    EXPECT_GT(hits, name == "bunnies" ? 400u : 4000u) << name;
    EXPECT_GE(found, all * 0.99) << name << ": " << found << " of " << all;
    std::printf("%s: %u rays hit %u triangles for certain, exact sampling has %u of them\n", name.c_str(), hits, all,
                found);
  }
}

} // namespace
} // namespace gpgp::test
