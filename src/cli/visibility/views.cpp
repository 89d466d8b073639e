#include "cli/visibility/views.h"

#include "host/files.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace gpgp::cli {

View orbitView(const Bounds& bounds, uint32_t k, uint32_t n, float distance, Size size) {
  const float turn = glm::radians(360.0f) * static_cast<float>(k) / static_cast<float>(n), rise = glm::radians(20.0f);
  const float radius = bounds.radius();
  const glm::vec3 back(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  const glm::mat4 view = glm::lookAtRH(bounds.centre() + back * (distance * radius), bounds.centre(), {0, 1, 0});
  glm::mat4 projection =
      glm::perspectiveRH_ZO(glm::radians(60.0f), static_cast<float>(size.width) / static_cast<float>(size.height),
                            std::max(distance - 1.2f, 0.01f) * radius, (distance + 1.2f) * radius);
  projection[1][1] *= -1;
  return {projection * view, false};
}

View readView(const std::string& file, const glm::dvec3& origin) {
  std::istringstream text(host::readText(file));
  std::vector<double> numbers;
  for (std::string word; text >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end || !std::isfinite(static_cast<float>(numbers.back())))
      throw Failure(file + ": word " + std::to_string(numbers.size()) + ", '" + word + "', is not a finite number");
  }
  if (numbers.size() < 16 || numbers.size() > 17)
    throw Failure(file + ": holds " + std::to_string(numbers.size()) + " numbers; a camera is 16, or 17");
  const glm::dmat4 camera = glm::translate(glm::make_mat4(numbers.data()), origin);
  const View view{glm::mat4(camera), numbers.size() == 17 && numbers[16] != 0};
  if (glm::determinant(glm::dmat4(view.camera)) == 0) throw Failure(file + ": the matrix has no inverse");
  return view;
}

std::optional<glm::dvec3> eyeOf(const View& view) {
  const glm::dmat4 rows = glm::transpose(glm::dmat4(view.camera));
  const glm::dmat3 normals = glm::transpose(glm::dmat3(rows[0], rows[1], rows[3]));
  if (glm::length(glm::dvec3(rows[3])) == 0 || glm::determinant(normals) == 0) return std::nullopt;
  return glm::inverse(normals) * -glm::dvec3(rows[0].w, rows[1].w, rows[3].w);
}

Cell::Cell(const std::string& spec) {
  uint32_t columns = 0, rows = 0, skip = 1, count = 0;
  float radius = 0;
  char rest = 0;
  // Few digits, so that nothing overflows; what is negative is read as a large number.
  if (std::sscanf(spec.c_str(), "%4ux%4u/%5u%c", &columns, &rows, &skip, &rest) == 3 ||
      (skip = 1, std::sscanf(spec.c_str(), "%4ux%4u%c", &columns, &rows, &rest) == 2)) {
    if (columns < 1 || rows < 1 || columns > 64 || rows > 64 || skip < 1 || skip > 16384)
      throw Usage("--cell: 1x1 to 64x64, and a skip of 1 to 16384");
    info.columns = columns;
    info.rows = rows;
    info.skip = skip;
  } else if (std::sscanf(spec.c_str(), "%f:%4u%c", &radius, &count, &rest) == 2) {
    const auto side = static_cast<uint32_t>(std::lround(std::sqrt(static_cast<float>(count))));
    if (!(radius > 0 && radius <= kMostReach) || count < 1 || count > 4096 || side * side != count)
      throw Usage(
          "--cell: the radius is above 0 and at most 1e18, and there are 1, 4, 9, 16 or another square number of "
          "points up to 4096");
    // A square grid, from corner to corner; the middle is always there.
    for (uint32_t i = 0; i < count && side > 1; ++i) {
      const float x = static_cast<float>(i % side) / static_cast<float>(side - 1) * 2 - 1;
      const float y = static_cast<float>(i / side) / static_cast<float>(side - 1) * 2 - 1;
      if (x != 0 || y != 0) points.insert(points.end(), {x * radius, y * radius, 0});
    }
  } else if (!spec.empty()) {
    throw Usage("--cell: '" + spec + "' is neither COLUMNSxROWS[/SKIP] in pixels nor RADIUS:POINTS in world units");
  }
}

std::vector<View> viewsOf(const Cell& cell, const View& view, const glm::vec3& centre, uint32_t height) {
  GpgpViewCellInfo info = cell.info;
  std::copy_n(glm::value_ptr(view.camera), 16, info.camera.viewProjection);
  info.camera.reversedDepth = view.reversed;
  info.height = height;
  const glm::mat4& m = view.camera;
  info.distance = m[0][3] * centre.x + m[1][3] * centre.y + m[2][3] * centre.z + m[3][3];
  if (info.columns && !(info.distance > 0 && std::isfinite(info.distance)))
    throw Failure("--cell: the middle of the scene does not lie before the camera, and so the pixels of a grid have no "
                  "size there; give RADIUS:POINTS");
  info.points = cell.points.data();
  info.pointCount = static_cast<uint32_t>(cell.points.size() / 3);
  uint32_t count = 0;
  GpgpResult result = gpgpGetViewCellCameras(&info, &count, nullptr);
  std::vector<GpgpCamera> cameras(count);
  if (result == GPGP_SUCCESS) result = gpgpGetViewCellCameras(&info, &count, cameras.data());
  if (result != GPGP_SUCCESS) throw Failure("the camera has no direction across or along its view");
  std::vector<View> views;
  for (const GpgpCamera& camera : cameras) views.push_back({glm::make_mat4(camera.viewProjection), view.reversed});
  return views;
}

} // namespace gpgp::cli
