// A point x, y of a panel has clip coordinates that are linear in (x, y, 1), so pixels are a projective map of it, and
// depth, divided by w, is linear in the pixel: its row times the inverse of that map.
#include "vector/ui/panel.h"

#include "vector/raster/place.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector {

bool placePanel(const GpgpPanel& panel, const float* viewProjection, const uint32_t* viewport, GpgpCanvasItem& result,
                float* resultClip) {
  GpgpCanvasItem item = result;
  float clip[16] = {};
  const auto number = [](auto v) { return static_cast<double>(v); };
  const auto narrow = [](double v) { return static_cast<float>(v); };
  double rows[4][3]; // clip coordinates of across, down, corner
  for (int row = 0; row < 4; ++row) {
    const float* vectors[3] = {panel.across, panel.down, panel.corner};
    for (int k = 0; k < 3; ++k) {
      rows[row][k] = k == 2 ? number(viewProjection[12 + row]) : 0;
      for (int axis = 0; axis < 3; ++axis)
        rows[row][k] += number(viewProjection[4 * axis + row]) * number(vectors[k][axis]);
    }
  }
  const double left = number(viewport[0]), top = number(viewport[1]), width = number(viewport[2]),
               height = number(viewport[3]);
  double pixel[3][3]; // rows of the map to pixels
  for (int k = 0; k < 3; ++k) {
    pixel[0][k] = 0.5 * width * (rows[0][k] + rows[3][k]) + left * rows[3][k];
    pixel[1][k] = 0.5 * height * (rows[1][k] + rows[3][k]) + top * rows[3][k];
    pixel[2][k] = rows[3][k];
    item.transform[2 * k] = narrow(pixel[0][k]);
    item.transform[2 * k + 1] = narrow(pixel[1][k]);
    item.perspective[k] = narrow(pixel[2][k]);
  }
  // Without perspective an item would be affine; a panel in the plane of the eye is not seen.
  if (std::none_of(item.perspective, item.perspective + 3, [](float v) { return v != 0; })) item.perspective[2] = -1;
  item.scissor[0] = narrow(left);
  item.scissor[1] = narrow(top);
  item.scissor[2] = narrow(left + width);
  item.scissor[3] = narrow(top + height);
  const auto cross = [](const double* a, const double* b, int k) {
    return a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
  };
  double determinant = 0, depth[3] = {}; // depth: of a pixel's x, y and 1
  for (int k = 0; k < 3; ++k) determinant += pixel[0][k] * cross(pixel[1], pixel[2], k);
  for (int column = 0; column < 3 && determinant != 0; ++column)
    for (int k = 0; k < 3; ++k)
      depth[column] += rows[2][k] * cross(pixel[(column + 1) % 3], pixel[(column + 2) % 3], k) / determinant;
  clip[0] = narrow(2 / width);
  clip[5] = narrow(2 / height);
  clip[12] = clip[13] = -1;
  clip[15] = 1;
  clip[2] = narrow(depth[0]);
  clip[6] = narrow(depth[1]);
  clip[14] = narrow(depth[2] + depth[0] * left + depth[1] * top);

  const auto finite = [](float v) { return std::isfinite(v); };
  if (!std::all_of(item.transform, item.transform + 6, finite) ||
      !std::all_of(item.perspective, item.perspective + 3, finite) ||
      (resultClip && !std::all_of(clip, clip + 16, finite)))
    return false;
  result = item;
  if (resultClip) std::copy_n(clip, 16, resultClip);
  return true;
}

} // namespace gpgp::vector
