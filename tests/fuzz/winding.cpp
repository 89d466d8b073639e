// Bytes as the verbs and coordinates of a path, on a grid or off it: its patches are disjoint, and together what
// winding numbers say, at points that are not within float distance of an edge.
#include "vector/oracle.h"
#include "vector/patch/drawing.h"
#include "vector/shared/curve.h"

#include <cstdlib>
#include <random>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp;
  constexpr float kScales[] = {1, 0.37f, 1000, 7e4f}, kOffsets[] = {0, 0.1f, 1e5f, -3};
  constexpr size_t kMaxVerbs = 100;
  if (size < 8) return 0;
  const uint8_t how = data[0];
  const float scale = kScales[how & 3], offset = kOffsets[how >> 2 & 3];
  const bool fine = how & 16;
  size_t at = 1;
  uint32_t seed = how;
  const auto byte = [&] {
    seed = seed * 31 + data[at % size];
    return data[at++ % size];
  };
  const auto number = [&] {
    float v = static_cast<float>(static_cast<int8_t>(byte()));
    if (fine) v += static_cast<float>(byte()) / 256;
    return scale * v + offset;
  };
  test::TestPath path;
  path.rule = how & 32 ? GPGP_FILL_EVEN_ODD : GPGP_FILL_NON_ZERO;
  float n[6] = {};
  const auto take = [&](int count) {
    for (int i = 0; i < count; ++i) n[i] = number();
  };
  take(2);
  path.move(n[0], n[1]);
  while (at < size && path.verbs.size() < kMaxVerbs) {
    switch (byte() % 8) {
    case 0: path.close(); [[fallthrough]];
    case 1: take(2), path.move(n[0], n[1]); break;
    case 2:
    case 3: take(2), path.line(n[0], n[1]); break;
    case 4: take(4), path.quad(n[0], n[1], n[2], n[3]); break;
    default: take(6), path.cubic(n[0], n[1], n[2], n[3], n[4], n[5]); break;
    }
  }
  const GpgpPath view = path.view();
  const auto drawing = vector::makeDrawing(std::span(&view, 1), std::pmr::get_default_resource());
  if (!drawing) std::abort();
  const test::PathOracle oracle(view);
  const double slack = oracle.magnitude() * 1.5e-6;
  if (!(oracle.right - oracle.left > 8 * slack && oracle.bottom - oracle.top > 8 * slack)) return 0;
  std::mt19937 random(seed);
  const auto between = [&random](double low, double high) {
    return static_cast<float>(low + (high - low) * (static_cast<double>(random()) / 4294967296.0));
  };
  for (int i = 0; i < 200; ++i) {
    const float x = between(oracle.left, oracle.right), y = between(oracle.top, oracle.bottom);
    int count = 0;
    for (const vector::PatchRecord& p : drawing->patches)
      count += y >= p.top && y < p.bottom && shader::rightOfCurve(drawing->curves[p.left], x, y, 0) &&
               !shader::rightOfCurve(drawing->curves[p.right], x, y, 0);
    if (count == static_cast<int>(oracle.inside(x, y))) continue;
    if (oracle.distance(x, y) > slack) std::abort();
  }
  return 0;
}
