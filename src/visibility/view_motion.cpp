// Where the eyes may be is a box along the camera's axes; where they may look is a wider frustum.
#include "visibility/view_motion.h"

#include "visibility/camera_axes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::visibility {
namespace {
using core::makeError;
constexpr float kMostTangent = 5.67f; // of 80 degrees to each side
constexpr float kMostPixels = 2;      // for one of the viewer's
constexpr uint32_t kCoarser = 4;      // how many times smaller corners are sampled

/// What a camera shows, on the plane one unit before it: x and y of the picture's sides, in the order of clip space.
struct Window {
  float low[2], high[2];
};

/// The window that shows what `window` shows after any turn and tilt up to these angles; false where that reaches
/// further than kMostTangent.
bool turned(const Window& window, float turn, float tilt, Window& all) {
  all = window;
  for (int corner = 0; corner < 4; ++corner) {
    const float x = corner & 1 ? window.high[0] : window.low[0], y = corner & 2 ? window.high[1] : window.low[1];
    for (int way = 0; way < 9; ++way) {
      const float a = turn * static_cast<float>(way % 3 - 1), b = tilt * static_cast<float>(way / 3 - 1);
      // Tilted about its own x axis, then turned about the middle camera's y axis.
      const float ty = y * std::cos(b) + std::sin(b), tz = std::cos(b) - y * std::sin(b);
      const float rx = x * std::cos(a) + tz * std::sin(a), rz = tz * std::cos(a) - x * std::sin(a);
      const float at[2] = {rx / rz, ty / rz};
      for (int axis = 0; axis < 2; ++axis) {
        if (!(rz > 0) || !(std::abs(at[axis]) <= kMostTangent)) return false;
        all.low[axis] = std::min(all.low[axis], at[axis]);
        all.high[axis] = std::max(all.high[axis], at[axis]);
      }
    }
  }
  return true;
}

bool within(float value, float most) { return value >= 0 && value <= most; }

core::Result<void> check(const GpgpViewMotionInfo& info) {
  const glm::vec3 velocity(info.velocity[0], info.velocity[1], info.velocity[2]);
  if (!info.width || !info.height || info.width > 16384 || info.height > 16384)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "width x height is %u x %u; expected 1 to 16384 each", info.width,
                     info.height);
  if (!within(glm::length(velocity), 1e6f) || !within(info.acceleration, 1e6f) || !within(info.eyeDistance, 1e6f))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "velocity, acceleration or eyeDistance is negative, above 1e6 or not finite");
  if (!within(info.earliest, info.latest) || !within(info.latest, 10))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "earliest, latest are %g, %g s; expected 0 <= earliest <= latest <= 10",
                     static_cast<double>(info.earliest), static_cast<double>(info.latest));
  constexpr float kQuarter = 1.57079632f;
  if (!within(info.turnRate * info.latest, kQuarter) || !within(info.tiltRate * info.latest, kQuarter))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "turnRate, tiltRate are %g, %g rad/s; expected 0 to a quarter of a turn until `latest`",
                     static_cast<double>(info.turnRate), static_cast<double>(info.tiltRate));
  return {};
}

} // namespace

core::Result<GpgpViewMotionCoverage> viewMotionCameras(const GpgpViewMotionInfo& info, uint32_t room,
                                                       GpgpCamera* cameras) {
  if (auto ok = check(info); !ok) return ok.error();
  const CameraAxes axes(info.camera);
  if (!axes.perspective || !std::isfinite(glm::dot(axes.right, axes.up) + axes.back.x))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "camera.viewProjection is not that of a perspective camera");
  GpgpViewMotionCoverage coverage{};

  // A picture coordinate is slope * tangent + middle.
  const glm::vec3 w = rowOf(info.camera, 3);
  float slope[2], middle[2];
  Window window, wider;
  for (int axis = 0; axis < 2; ++axis) {
    slope[axis] = glm::length(axis ? axes.y : axes.x) / glm::length(w);
    middle[axis] = glm::dot(rowOf(info.camera, axis), w) / glm::dot(w, w);
    window.low[axis] = (-1 - middle[axis]) / slope[axis];
    window.high[axis] = (1 - middle[axis]) / slope[axis];
  }
  const float turn = info.turnRate * info.latest, tilt = info.tiltRate * info.latest;
  float share = 1;
  if (!turned(window, turn, tilt, wider)) {
    float low = 0;
    for (int step = 0; step < 24; ++step) {
      const float half = 0.5f * (low + share);
      (turned(window, turn * half, tilt * half, wider) ? low : share) = half;
    }
    share = low;
    if (!turned(window, turn * share, tilt * share, wider)) wider = window;
  }
  coverage.turn = turn * share;
  coverage.tilt = tilt * share;
  GpgpCamera wide = info.camera;
  float spreads[2];
  for (int axis = 0; axis < 2; ++axis) {
    const float spread = spreads[axis] = (wider.high[axis] - wider.low[axis]) / (window.high[axis] - window.low[axis]);
    const float scale = 1 / spread, to = -(wider.high[axis] + wider.low[axis]) / (wider.high[axis] - wider.low[axis]);
    for (int column = 0; column < 4; ++column) {
      float* m = wide.viewProjection + column * 4;
      m[axis] = m[axis] * scale + m[3] * (to - middle[axis] * scale);
    }
  }
  // Pixels near the sides of a wide picture are finer than they need be: twice the viewer's are enough.
  const float scale = std::min(1.0f, std::sqrt(kMostPixels / (spreads[0] * spreads[1])));
  const auto pixels = [](float exact) { return static_cast<uint32_t>(std::ceil(exact * (1 - 1e-6f))); };
  coverage.width = pixels(static_cast<float>(info.width) * spreads[0] * scale);
  coverage.height = pixels(static_cast<float>(info.height) * spreads[1] * scale);
  coverage.cornerWidth = (coverage.width + kCoarser - 1) / kCoarser;
  coverage.cornerHeight = (coverage.height + kCoarser - 1) / kCoarser;

  // The eyes at any time: a piece of the way, a ball around it, to each side half the distance of the eyes.
  const glm::vec3 velocity(info.velocity[0], info.velocity[1], info.velocity[2]);
  const glm::vec3 centre = velocity * (0.5f * (info.earliest + info.latest));
  const glm::vec3 way = velocity * (0.5f * (info.latest - info.earliest));
  const float ball = 0.5f * info.acceleration * info.latest * info.latest, eyes = 0.5f * info.eyeDistance;
  const std::array<glm::vec3, 3> directions = {axes.right, axes.up, axes.back};
  const std::array<float, 3> beside = {eyes, 0, eyes * std::sin(coverage.turn)}; // the eyes turn with the head
  std::array<float, 3> extent;
  for (size_t axis = 0; axis < 3; ++axis) {
    coverage.middle[axis] = glm::dot(centre, directions[axis]);
    coverage.extent[axis] = extent[axis] = std::abs(glm::dot(way, directions[axis])) + ball + beside[axis];
  }
  // The middle and two opposite corners: more of them find hardly more. Where the box is a line these are its ends.
  const glm::vec3 corner = axes.right * extent[0] + axes.up * extent[1] + axes.back * extent[2];
  const auto sides = std::count_if(extent.begin(), extent.end(), [](float e) { return e > 0; });
  coverage.reach = glm::length(corner) * (sides == 1 ? 0.5f : 1.0f);
  const auto add = [&](const glm::vec3& at) {
    if (cameras && coverage.cameraCount < room) cameras[coverage.cameraCount] = moved(wide, at);
    ++coverage.cameraCount;
  };
  add(centre);
  if (sides > 0) {
    add(centre - corner);
    add(centre + corner);
  }
  return coverage;
}

} // namespace gpgp::visibility
