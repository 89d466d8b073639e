// Any bytes as a baked drawing, the header's sizes and the checksum made right first, so that the checks behind them
// are reached; what loads must make closed outlines without harm and bake to bytes that load again.
#include "vector/patch/drawing.h"
#include "vector/raster/segments.h"

#include <cstdlib>
#include <cstring>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp::vector;
  const auto memory = std::pmr::get_default_resource();
  (void)loadBaked(std::as_bytes(std::span(data, size)), memory); // as it came
  // A good drawing, with gradients, images, clips, groups that fade in each other, and a layer with a filter and a
  // mask, with bytes of its tables exchanged, and the sum made right.
  const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_CUBIC, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  const float points[] = {0, 0, 5, 9, -3, 7, 8, 20, 12, 3};
  const GpgpGradientStop stops[] = {{0, {1, 0, 0, 1}}, {1, {0, 1, 0, 0.5f}}};
  GpgpGradient gradient{};
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.end[0] = 9;
  gradient.stops = stops;
  gradient.stopCount = 2;
  const GpgpImagePaint image{3, {20, 0, 0, 20, 0, 0}};
  const auto path = [&](uint32_t group) {
    return GpgpPath{verbs, 4, points, 5, GPGP_FILL_EVEN_ODD, {0, 0, 1, 1}, nullptr, nullptr, nullptr, 0, group};
  };
  GpgpPath paths[] = {path(0), path(1), path(2), path(3), path(0), path(4), path(5), path(6)};
  paths[2].gradient = &gradient;
  paths[4].image = &image;
  const GpgpPath clips[] = {path(0), path(0), path(0)};
  const float kernel[] = {1, 2, 1};
  const auto step = [](GpgpFilterKind kind, std::initializer_list<float> values, uint32_t input = GPGP_FILTER_SOURCE) {
    GpgpFilterStep s{};
    s.kind = kind;
    s.input = input;
    s.region[2] = s.region[3] = 50;
    std::copy(values.begin(), values.end(), s.values);
    return s;
  };
  GpgpFilterStep steps[] = {step(GPGP_FILTER_GAUSSIAN_BLUR, {2, 1}),
                            step(GPGP_FILTER_CONVOLVE_MATRIX, {3, 1, 1, 0, 4}, GPGP_FILTER_FIRST_STEP),
                            step(GPGP_FILTER_TURBULENCE, {0.1f, 0.1f, 2, 5}),
                            step(GPGP_FILTER_GROUP, {1, 0, 0, 1, 3, 3})};
  steps[1].table = kernel;
  steps[1].tableCount = 3;
  steps[3].group = 6;
  GpgpLayer layer{};
  layer.blend = GPGP_BLEND_SCREEN;
  layer.mask = 5;
  layer.maskRegion[2] = layer.maskRegion[3] = layer.filterRegion[2] = layer.filterRegion[3] = 50;
  for (const int k : {0, 3}) layer.maskTransform[k] = layer.filterTransform[k] = 1;
  layer.filter = steps;
  layer.filterCount = 4;
  const GpgpPathGroup groups[] = {{0, 0.5f, clips, 2, nullptr},    {1, 1, clips + 2, 1, nullptr},
                                  {2, 0.25f, nullptr, 0, nullptr}, {0, 0.5f, clips, 1, &layer},
                                  {0, 1, nullptr, 0, nullptr},     {0, 1, nullptr, 0, nullptr}};
  const auto good = makeDrawing(paths, groups, memory);
  if (!good) std::abort();
  std::pmr::vector<std::byte> bytes = bake(*good, memory);
  constexpr size_t kTables = 104, kSummedFrom = 16, kSum = 8; // where in a baked drawing
  for (size_t i = 0; i + 4 <= size; i += 4) {                 // place, place, how, value
    const size_t at = (data[i] | size_t(data[i + 1]) << 8) % (bytes.size() - kTables);
    std::byte& byte = bytes[kTables + at];
    byte = data[i + 2] % 2 ? static_cast<std::byte>(data[i + 3]) : byte ^ static_cast<std::byte>(1u << data[i + 3] % 8);
    if (i % 64 != 0) continue;
    const uint64_t sum = checksum(std::span(bytes).subspan(kSummedFrom));
    std::memcpy(bytes.data() + kSum, &sum, sizeof sum);
    const auto drawing = loadBaked(bytes, memory);
    if (!drawing) continue;
    const Outlines outlines = makeOutlines(*drawing, memory);
    if (outlines.ends.size() != drawing->paths.size()) std::abort();
    if (bake(*drawing, memory) != bytes) std::abort();
  }
  return 0;
}
