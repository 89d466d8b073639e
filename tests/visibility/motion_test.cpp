// The cameras of a viewer in motion: every view of the moving viewer lies in their frustum, every eye in their box.
#include <gpgp/visibility.h>
#include <gtest/gtest.h>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/glm.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <random>
#include <vector>

namespace {

struct Cameras {
  GpgpViewMotionCoverage coverage{};
  std::vector<glm::dmat4> matrices;
};

GpgpViewMotionInfo infoOf(const glm::mat4& projection, const glm::mat4& view) {
  GpgpViewMotionInfo info = GPGP_VIEW_MOTION_INFO_INIT;
  const glm::mat4 camera = projection * view;
  std::copy_n(glm::value_ptr(camera), 16, info.camera.viewProjection);
  info.width = 1920;
  info.height = 1080;
  return info;
}

Cameras camerasOf(const GpgpViewMotionInfo& info) {
  Cameras result;
  uint32_t count = 3;
  std::vector<GpgpCamera> cameras(count);
  EXPECT_EQ(gpgpGetViewMotionCameras(&info, &count, cameras.data(), &result.coverage), GPGP_SUCCESS);
  EXPECT_EQ(count, result.coverage.cameraCount);
  for (uint32_t i = 0; i < count; ++i) result.matrices.emplace_back(glm::make_mat4(cameras[i].viewProjection));
  return result;
}

/// Off-centre, y down, and not at the origin.
const glm::mat4 kProjection = [] {
  glm::mat4 m = glm::frustumRH_ZO(-0.09f, 0.13f, -0.05f, 0.07f, 0.1f, 500.0f);
  m[1] *= -1.0f;
  return m;
}();
const glm::vec3 kEye(3, -2, 5);
const glm::mat4 kView = glm::lookAtRH(kEye, glm::vec3(-4, 1, -9), glm::vec3(0.1f, 1, 0));

/// Rows of the view: right, up, back in world space.
glm::dvec3 axisOf(int row) { return {kView[0][row], kView[1][row], kView[2][row]}; }

glm::dvec3 eyeOf(const glm::dmat4& camera) {
  const glm::dmat4 inverse = glm::inverse(camera);
  // Lines through the eye meet there: of two pixels, from near to far.
  const auto line = [&](double x, double y, glm::dvec3& at, glm::dvec3& along) {
    const glm::dvec4 a = inverse * glm::dvec4(x, y, 0, 1), b = inverse * glm::dvec4(x, y, 0.9, 1);
    at = glm::dvec3(a) / a.w;
    along = glm::normalize(glm::dvec3(b) / b.w - at);
  };
  glm::dvec3 p, d, q, e;
  line(-1, -1, p, d);
  line(1, 1, q, e);
  const glm::dvec3 n = glm::cross(d, e);
  return p + d * (glm::dot(glm::cross(q - p, e), n) / glm::dot(n, n));
}

TEST(ViewMotion, WhoStandsStillHasTheOneCamera) {
  GpgpViewMotionInfo info = infoOf(kProjection, kView);
  info.latest = 0.3f;
  const Cameras made = camerasOf(info);
  ASSERT_EQ(made.matrices.size(), 1u);
  for (int i = 0; i < 16; ++i)
    EXPECT_NEAR(glm::value_ptr(made.matrices[0])[i], info.camera.viewProjection[i], 1e-4) << i;
  EXPECT_EQ(made.coverage.width, 1920u);
  EXPECT_EQ(made.coverage.height, 1080u);
  EXPECT_EQ(made.coverage.reach, 0.0f);
}

TEST(ViewMotion, TheFrustumHoldsEveryTurnAndNoMore) {
  GpgpViewMotionInfo info = infoOf(kProjection, kView);
  info.latest = 0.2f;
  info.turnRate = 0.5f;
  info.tiltRate = 0.2f;
  const Cameras made = camerasOf(info);
  ASSERT_EQ(made.matrices.size(), 1u);
  EXPECT_NEAR(made.coverage.turn, 0.1f, 1e-6f);
  EXPECT_NEAR(made.coverage.tilt, 0.04f, 1e-6f);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> either(-1, 1);
  glm::dvec2 low(1), high(-1);
  for (int i = 0; i < 200000; ++i) {
    const bool extreme = i % 2 != 0;
    const auto of = [&](double most) { return most * (extreme ? (either(random) < 0 ? -1 : 1) : either(random)); };
    // A viewer's pixel, through the head's turn and tilt, to a point of the world.
    const glm::dmat4 head = glm::rotate(glm::dmat4(1), of(0.1), glm::dvec3(0, 1, 0)) *
                            glm::rotate(glm::dmat4(1), of(0.04), glm::dvec3(1, 0, 0));
    const glm::dvec4 pixel = glm::inverse(glm::dmat4(kProjection)) * glm::dvec4(of(1), of(1), 0.5, 1);
    const glm::dvec4 world = glm::inverse(glm::dmat4(kView)) * (head * (pixel / pixel.w));
    const glm::dvec4 seen = made.matrices[0] * world;
    ASSERT_GT(seen.w, 0);
    const glm::dvec2 at = glm::dvec2(seen) / seen.w;
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_GE(low[axis], -1.0001);
    EXPECT_LE(high[axis], 1.0001);
    EXPECT_LE(low[axis], -0.999);
    EXPECT_GE(high[axis], 0.999);
  }
  // A small step across the view moves as many pixels as it does for the viewer.
  const auto pixels = [](const glm::dmat4& camera, int axis, double size) {
    const glm::dvec3 at = kEye - glm::vec3(axisOf(2)) * 10.0f;
    const auto place = [&](const glm::dvec3& p) {
      const glm::dvec4 clip = camera * glm::dvec4(p, 1);
      return clip[axis] / clip.w * 0.5 * size;
    };
    return std::abs(place(at + axisOf(axis) * 0.01) - place(at));
  };
  const glm::dmat4 own(kProjection * kView);
  EXPECT_NEAR(pixels(made.matrices[0], 0, made.coverage.width) / pixels(own, 0, 1920), 1, 1e-3);
  EXPECT_NEAR(pixels(made.matrices[0], 1, made.coverage.height) / pixels(own, 1, 1080), 1, 1e-3);
}

TEST(ViewMotion, EveryEyeStaysInTheBoxWhoseCornersHaveCameras) {
  GpgpViewMotionInfo info = infoOf(kProjection, kView);
  const glm::dvec3 velocity(1.1, -0.3, -2.0);
  for (int i = 0; i < 3; ++i) info.velocity[i] = static_cast<float>(velocity[i]);
  info.acceleration = 3;
  info.turnRate = 2;
  info.earliest = 0.05f;
  info.latest = 0.25f;
  info.eyeDistance = 0.064f;
  const Cameras made = camerasOf(info);
  ASSERT_EQ(made.matrices.size(), 3u);
  const auto place = [&](const glm::dvec3& world) { // right, up, back of the pose
    const glm::dvec3 offset = world - glm::dvec3(kEye);
    return glm::dvec3(glm::dot(offset, axisOf(0)), glm::dot(offset, axisOf(1)), glm::dot(offset, axisOf(2)));
  };
  const glm::dvec3 middle(glm::make_vec3(made.coverage.middle)), extent(glm::make_vec3(made.coverage.extent));
  const glm::dvec3 expected[3] = {middle, middle - extent, middle + extent};
  for (size_t i = 0; i < 3; ++i) EXPECT_LT(glm::length(place(eyeOf(made.matrices[i])) - expected[i]), 2e-3) << i;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(0, 1);
  glm::dvec3 most(0);
  for (int i = 0; i < 50000; ++i) {
    const double time = 0.05 + 0.2 * (i % 3 == 0 ? 1.0 : share(random));
    glm::dvec3 drift(share(random) * 2 - 1, share(random) * 2 - 1, share(random) * 2 - 1);
    drift *= 0.5 * 3 * time * time / glm::length(drift);
    const double angle = 2 * time * (share(random) * 2 - 1), side = share(random) < 0.5 ? -0.032 : 0.032;
    const glm::dvec3 eyes = (axisOf(0) * std::cos(angle) + axisOf(2) * std::sin(angle)) * side;
    const glm::dvec3 at = glm::abs(place(glm::dvec3(kEye) + velocity * time + drift + eyes) - middle);
    most = glm::max(most, at / extent);
    for (int axis = 0; axis < 3; ++axis) ASSERT_LE(at[axis], extent[axis] + 1e-6) << axis;
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(most[axis], 0.8) << "the box is not much larger than it must be";
}

TEST(ViewMotion, NoPlaceIsFartherFromACameraThanReach) {
  for (const glm::vec3 velocity : {glm::vec3(0, 0, -5), glm::vec3(4, 0, -5), glm::vec3(1, 2, -9)}) {
    GpgpViewMotionInfo info = infoOf(kProjection, glm::mat4(1));
    std::copy_n(glm::value_ptr(velocity), 3, info.velocity);
    info.latest = 0.3f;
    const Cameras made = camerasOf(info);
    EXPECT_EQ(made.matrices.size(), 3u);
    std::vector<glm::dvec3> eyes;
    for (const glm::dmat4& matrix : made.matrices) eyes.push_back(eyeOf(matrix));
    const glm::dvec3 middle(glm::make_vec3(made.coverage.middle)), extent(glm::make_vec3(made.coverage.extent));
    std::mt19937 random(9);
    std::uniform_real_distribution<double> either(-1, 1);
    double most = 0;
    for (int i = 0; i < 100000; ++i) {
      const glm::dvec3 at = middle + extent * glm::dvec3(either(random), either(random), either(random));
      double nearest = 1e9;
      for (const glm::dvec3& eye : eyes) nearest = std::min(nearest, glm::length(eye - at));
      most = std::max(most, nearest);
    }
    EXPECT_LE(most, static_cast<double>(made.coverage.reach) + 1e-3);
    EXPECT_GE(most, 0.25 * static_cast<double>(made.coverage.reach));
  }
}

TEST(ViewMotion, TurnsBeyondWhatOneFrustumHoldsAreCutAndSaidSo) {
  GpgpViewMotionInfo info = infoOf(kProjection, kView);
  info.latest = 0.5f;
  info.turnRate = 3;
  const Cameras made = camerasOf(info);
  EXPECT_LT(made.coverage.turn, 1.2f);
  EXPECT_GT(made.coverage.turn, 0.2f);
  // What is wide has at most twice the viewer's pixels.
  const double pixels = static_cast<double>(made.coverage.width) * made.coverage.height;
  EXPECT_LE(pixels, 2.01 * 1920 * 1080);
  EXPECT_GE(pixels, 1.99 * 1920 * 1080);
  EXPECT_EQ(made.coverage.cornerWidth, (made.coverage.width + 3) / 4);
}

TEST(ViewMotion, ArgumentsAreChecked) {
  uint32_t count = 0;
  const auto with = [&](auto change) {
    GpgpViewMotionInfo info = infoOf(kProjection, kView);
    info.latest = 0.1f;
    change(info);
    return gpgpGetViewMotionCameras(&info, &count, nullptr, nullptr);
  };
  EXPECT_EQ(with([](GpgpViewMotionInfo&) {}), GPGP_SUCCESS);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.width = 0; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.velocity[1] = NAN; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.acceleration = -1; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.earliest = 0.2f; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.latest = INFINITY; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.turnRate = 20; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.eyeDistance = -0.1f; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.camera.viewProjection[3] = NAN; }), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) { i.sType = 0; }), GPGP_ERROR_INVALID_STRUCT);
  EXPECT_EQ(with([](GpgpViewMotionInfo& i) {
              const glm::mat4 flat = glm::orthoRH_ZO(-1.0f, 1.0f, -1.0f, 1.0f, 0.0f, 10.0f);
              std::copy_n(glm::value_ptr(flat), 16, i.camera.viewProjection);
            }),
            GPGP_ERROR_INVALID_ARGUMENT);
  GpgpViewMotionInfo info = infoOf(kProjection, kView);
  EXPECT_EQ(gpgpGetViewMotionCameras(&info, nullptr, nullptr, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.velocity[0] = 1;
  info.latest = 0.1f;
  GpgpCamera one;
  count = 1;
  EXPECT_EQ(gpgpGetViewMotionCameras(&info, &count, &one, nullptr), GPGP_INCOMPLETE);
  EXPECT_GT(count, 1u);
}

} // namespace
