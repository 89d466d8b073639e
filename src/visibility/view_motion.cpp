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
constexpr float kSame = 1e-6f;        // of the largest extent: no extent

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

/// The largest distance of a place in a box to the nearest of its middle and its corners.
float farthest(const std::array<float, 3>& extent) {
  // In an eighth of the box it lies where the plane halfway between middle and corner meets an edge.
  float square = 0, most = 0;
  for (const float e : extent) square += e * e;
  for (size_t axis = 0; axis < 3; ++axis)
    for (int edge = 0; edge < 4; ++edge) {
      const size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
      const float pb = edge & 1 ? extent[b] : 0, pc = edge & 2 ? extent[c] : 0;
      if (extent[axis] <= 0) continue;
      const float along = (0.5f * square - pb * extent[b] - pc * extent[c]) / extent[axis];
      if (along >= 0 && along <= extent[axis]) most = std::max(most, along * along + pb * pb + pc * pc);
    }
  return std::sqrt(most);
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
  uint32_t* const sizes[2] = {&coverage.width, &coverage.height};
  for (int axis = 0; axis < 2; ++axis) {
    const float spread = (wider.high[axis] - wider.low[axis]) / (window.high[axis] - window.low[axis]);
    const float scale = 1 / spread, to = -(wider.high[axis] + wider.low[axis]) / (wider.high[axis] - wider.low[axis]);
    for (int column = 0; column < 4; ++column) {
      float* m = wide.viewProjection + column * 4;
      m[axis] = m[axis] * scale + m[3] * (to - middle[axis] * scale);
    }
    *sizes[axis] =
        static_cast<uint32_t>(std::ceil(spread * static_cast<float>(axis ? info.height : info.width) * (1 - kSame)));
  }

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
  const float largest = *std::max_element(extent.begin(), extent.end());
  coverage.reach = farthest(extent);
  // The middle and the corners; where the box has no extent, fewer.
  const auto add = [&](const glm::vec3& at) {
    if (cameras && coverage.cameraCount < room) cameras[coverage.cameraCount] = moved(wide, at);
    ++coverage.cameraCount;
  };
  add(centre);
  for (uint32_t corner = 0; corner < 8 && largest > 0; ++corner) {
    glm::vec3 at = centre;
    bool again = false; // another corner is the same place
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const bool has = extent[axis] > largest * kSame, high = (corner >> axis & 1) != 0;
      again = again || (!has && high);
      if (has) at += directions[axis] * (high ? extent[axis] : -extent[axis]);
    }
    if (!again) add(at);
  }
  return coverage;
}

} // namespace gpgp::visibility
