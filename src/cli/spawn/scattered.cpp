#include "cli/spawn/scattered.h"

#include "cli/shared/common.h"
#include "host/picture.h"

#include <gpgp/scatter.h>

#include <algorithm>

namespace gpgp::cli {
namespace {

/// A picture's red channel over the area, from 0 to `white`; nothing without a file.
struct Field {
  std::vector<float> values;
  GpgpGroundField field{};

  Field(const std::string& file, const std::array<float, 2>& area, float white) {
    if (file.empty()) return;
    const host::Picture picture = host::readPng(file);
    for (size_t i = 0; i < picture.rgba.size(); i += 4) values.push_back(white * float(picture.rgba[i]) / 255.0f);
    field = {values.data(), picture.width, picture.height, {}, {}};
    for (int axis = 0; axis < 2; ++axis) {
      field.max[axis] = area[axis] / 2;
      field.min[axis] = -field.max[axis];
    }
  }
  Field(const Field&) = delete;
  const GpgpGroundField* get() const { return values.empty() ? nullptr : &field; }
};

} // namespace

std::vector<GpgpAxiom> scatterAxioms(const ScatterOptions& options, const AxiomDefaults& defaults) {
  const Field density(options.density, options.area, 1), terrain(options.terrain, options.area, options.terrainHeight);
  GpgpScatterInfo info = GPGP_SCATTER_INFO_INIT;
  info.base = axiomAt({0, 0, 0}, 0, defaults.size, defaults.seed, 0);
  info.base.transform[7] = 0; // it stands on its place, which the library sees to
  info.distance = options.distance;
  info.seed = defaults.seed;
  for (int axis = 0; axis < 2; ++axis) {
    info.max[axis] = options.area[axis] / 2;
    info.min[axis] = -info.max[axis];
  }
  info.density = density.get();
  info.heights = terrain.get();
  uint32_t count = 0;
  if (gpgpScatterAxioms(&info, &count, nullptr) != GPGP_SUCCESS)
    throw Usage("--scatter: an area is at most 2048 distances wide and deep, and a distance at least 1 mm");
  if (!count) throw Usage("--scatter: no point was left; the area is smaller than the distance, or the density 0");
  std::vector<GpgpAxiom> axioms(count);
  gpgpScatterAxioms(&info, &count, axioms.data());
  for (uint32_t i = 0; i < count; ++i) {
    axioms[i].id = i;
    axioms[i].start = defaults.starts[i % defaults.starts.size()];
  }
  return axioms;
}

} // namespace gpgp::cli
