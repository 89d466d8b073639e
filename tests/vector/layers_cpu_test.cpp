// Operations on pictures beside their CPU reference: random filters of all kinds, masks and blend modes, every pixel of
// every picture that a recording leaves.
#include "api/items.h"
#include "layers_fixture.h"
#include "vector/cpu_reference/layers.h"
#include "vector/raster/canvas.h"

#include <glm/packing.hpp>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using shader::uvec2;
using shader::vec4;

constexpr uint32_t kSize = 80;

struct LayersCpuTest : LayersTest {
  vector::Canvas& ownCanvas() const {
    const core::Context* owner = nullptr;
    return static_cast<vector::Canvas&>(*api::objectOf(canvas, &owner));
  }
  /// What lies in the buffer of pictures behind a pass.
  std::vector<uvec2> pictures(const std::vector<GpgpCanvasItem>& items, uint32_t pass) {
    vector::Canvas& own = ownCanvas();
    const host::Buffer copy(device, own.scratchBytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, host::Memory::host);
    own.inspect({pass, copy.handle()});
    raster(items, kSize, kSize, 4);
    own.inspect({});
    std::vector<uvec2> pixels(layerPixels);
    std::memcpy(pixels.data(),
                static_cast<const char*>(copy.mapped()) + own.passes().scratchOffsets[shader::kBindPictures],
                pixels.size() * sizeof(uvec2));
    return pixels;
  }
};

/// A filter of a few random steps.
GpgpLayer randomFilter(Scene& scene, std::mt19937& random, std::vector<std::vector<float>>& tables) {
  const auto at = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<uint32_t>(n)); };
  std::vector<GpgpFilterStep> steps;
  const int count = 1 + upTo(4);
  for (int i = 0; i < count; ++i) {
    const auto input = [&] { return static_cast<uint32_t>(upTo(4) == 0 || i == 0 ? upTo(2) : 3 + upTo(i)); };
    const int kind = upTo(GPGP_FILTER_GROUP);
    GpgpFilterStep s = step(kind, {}, 0, input(), input());
    float* v = s.values;
    switch (kind) {
    case GPGP_FILTER_FLOOD:
      for (int k = 0; k < 4; ++k) v[k] = at(0, 1);
      break;
    case GPGP_FILTER_DROP_SHADOW:
      for (int k = 2; k < 8; ++k) v[k] = k < 4 ? at(-6, 6) : at(0, 1);
      [[fallthrough]];
    case GPGP_FILTER_GAUSSIAN_BLUR: v[0] = at(0, 14), v[1] = at(0, 4); break;
    case GPGP_FILTER_OFFSET: v[0] = at(-9, 9), v[1] = at(-9, 9); break;
    case GPGP_FILTER_COLOR_MATRIX:
      for (int k = 0; k < 20; ++k) v[k] = at(-0.5f, 1);
      break;
    case GPGP_FILTER_COMPONENT_TRANSFER: {
      std::vector<float>& table = tables.emplace_back();
      for (int k = 0; k < 1024; ++k) table.push_back(0.5f + 0.4f * std::sin(static_cast<float>(k) * 0.05f));
      s.table = table.data(), s.tableCount = 1024;
      break;
    }
    case GPGP_FILTER_BLEND: s.mode = upTo(17); break;
    case GPGP_FILTER_COMPOSITE:
      s.mode = upTo(7);
      for (int k = 0; k < 4; ++k) v[k] = at(-0.2f, 1);
      break;
    case GPGP_FILTER_MORPHOLOGY: v[0] = at(0, 5), v[1] = at(0, 5), s.mode = upTo(2); break;
    case GPGP_FILTER_CONVOLVE_MATRIX: {
      v[0] = static_cast<float>(1 + upTo(4)), v[1] = static_cast<float>(1 + upTo(4));
      v[2] = static_cast<float>(upTo(static_cast<int>(v[0]))), v[3] = static_cast<float>(upTo(static_cast<int>(v[1])));
      v[4] = at(1, 4), v[5] = at(0, 0.2f), v[6] = static_cast<float>(upTo(2)), s.mode = upTo(3);
      std::vector<float>& table = tables.emplace_back();
      for (float k = 0; k < v[0] * v[1]; ++k) table.push_back(at(-1, 2));
      s.table = table.data(), s.tableCount = static_cast<uint32_t>(table.size());
      break;
    }
    case GPGP_FILTER_DISPLACEMENT_MAP: v[0] = at(-20, 20), s.mode = upTo(16); break;
    case GPGP_FILTER_TURBULENCE:
      v[0] = at(0.01f, 0.2f), v[1] = at(0.01f, 0.2f), v[2] = static_cast<float>(upTo(5)), v[3] = at(-9, 9);
      s.mode = upTo(2);
      break;
    case GPGP_FILTER_SPECULAR_LIGHTING:
    case GPGP_FILTER_DIFFUSE_LIGHTING: {
      v[0] = at(-3, 3), v[1] = at(0.5f, 2), v[2] = at(0, 1), v[3] = at(0, 1), v[4] = at(0, 1), v[5] = at(1, 5);
      float* light = v + (kind == GPGP_FILTER_SPECULAR_LIGHTING ? 6 : 5);
      s.mode = upTo(3);
      for (int k = 0; k < 6; ++k) light[k] = s.mode == 0 ? at(0, 1.5f) : at(0, 60);
      light[6] = at(1, 3), light[7] = -1;
      break;
    }
    default: break;
    }
    s.encoding = upTo(2);
    const float region[4] = {at(-20, 20), at(-20, 20), at(50, 90), at(50, 90)};
    std::copy_n(region, 4, s.region);
    steps.push_back(s);
  }
  GpgpLayer layer = scene.filter(std::move(steps));
  const float angle = upTo(2) ? at(0, 3) : 0, size = at(0.7f, 1.5f);
  const float transform[6] = {size * std::cos(angle), size * std::sin(angle), -size * std::sin(angle),
                              size * std::cos(angle), angle == 0 ? 0.f : 40,  0};
  std::copy_n(transform, 6, layer.filterTransform);
  const float region[4] = {-30, -30, 100, 100};
  std::copy_n(region, 4, layer.filterRegion);
  return layer;
}

/// What of the pictures' memory an operation reads and writes: whole boxes, row by row.
struct Touched {
  std::vector<std::pair<size_t, size_t>> read, written;
  explicit Touched(const shader::OperationRecord& o) {
    const auto add = [](const shader::PictureRecord& p, std::vector<std::pair<size_t, size_t>>& to) {
      for (int y = p.top; y < p.bottom && p.left < p.right; ++y) {
        const size_t row = p.first + size_t(y - p.top) * p.stride;
        to.push_back({row, row + size_t(p.right - p.left)});
      }
    };
    add(o.a, read), add(o.b, read), add(o.c, read);
    if (o.kind == shader::kOperationComposite) add(o.result, read);
    add(o.result, written);
  }
  static bool meet(const std::vector<std::pair<size_t, size_t>>& a, const std::vector<std::pair<size_t, size_t>>& b) {
    for (const auto& [first, last] : a)
      for (const auto& [begin, end] : b)
        if (first < end && begin < last) return true;
    return false;
  }
  bool conflicts(const Touched& other) const {
    return meet(written, other.written) || meet(written, other.read) || meet(read, other.written);
  }
};

/// Of two operations that touch the same memory, the one that is listed first comes first, with a barrier between them;
/// with room for all pictures, most operations share a barrier; without, each has its own. Pictures are the same.
TEST_F(LayersCpuTest, OperationsSideBySideTouchNothingOfEachOther) {
  constexpr uint32_t kSide = 256;
  for (uint32_t seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<float>> tables;
    tables.reserve(256);
    Scene scene;
    for (int i = 0; i < 16; ++i) { // on a grid, some of them across their neighbours
      GpgpLayer layer = i % 3 == 2 ? randomFilter(scene, random, tables)
                                   : scene.filter({step(GPGP_FILTER_DROP_SHADOW, {2, 2, 3, 3, 0, 0, 0, 0.5f}),
                                                   step(GPGP_FILTER_GAUSSIAN_BLUR, {1, 1}, 0, GPGP_FILTER_FIRST_STEP)});
      if (i % 4 == 1) layer.blend = GPGP_BLEND_MULTIPLY;
      const uint32_t group = scene.group(0, 0.8f, &layer);
      const float x = static_cast<float>(i % 4) * 64 + 8, y = static_cast<float>(i / 4) * 64 + 8;
      const float side = seed % 2 && i % 5 == 0 ? 90.f : 40.f;
      scene.add(solid(x, y, x + side, y + side, {0.2f, 0.5f, 0.1f * static_cast<float>(i % 10), 1}), group);
    }
    const std::vector<GpgpPath> paths = scene.paths();
    const GpgpAsset drawing = makeDrawing(paths, scene.groups);
    std::vector<Rgba> pictures[2];
    uint32_t needed = 0;
    for (const bool tight : {false, true}) {
      layerPixels = tight ? needed : 1 << 21;
      makeLayerCanvas(kSide);
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      pictures[tight] = raster({place(drawing)}, kSide, kSide, 4, &report);
      ASSERT_EQ(report.base.status, GPGP_SUCCESS) << seed;
      needed = report.layerPixels;
      const vector::Canvas& own = ownCanvas();
      const auto steps = own.steps();
      std::vector<Touched> touched;
      for (const shader::OperationRecord& o : own.operations()) touched.emplace_back(o);
      ASSERT_EQ(steps.size() + 1, touched.size());
      std::vector<uint32_t> place(touched.size(), 0), behind(touched.size(), 0); // in order; barriers up to it
      uint32_t barriers = 0;
      for (uint32_t k = 0; k < steps.size(); ++k) {
        barriers += !steps[k].alongside;
        EXPECT_EQ(place[steps[k].constant], 0u) << "twice";
        place[steps[k].constant] = k + 1;
        behind[steps[k].constant] = barriers;
      }
      EXPECT_FALSE(steps[0].alongside);
      size_t conflicts = 0;
      for (size_t i = 1; i < touched.size(); ++i)
        for (size_t j = i + 1; j < touched.size(); ++j) {
          if (!touched[i].conflicts(touched[j])) continue;
          ++conflicts;
          const auto inRaster = [&](size_t k) { return own.operations()[k].kind == shader::kOperationComposite; };
          EXPECT_TRUE(tight || (inRaster(i) && inRaster(j)) || !Touched::meet(touched[i].written, touched[j].written))
              << seed << ": operations " << i << " and " << j << " write the same memory";
          EXPECT_LT(behind[i], behind[j]) << seed << ": operations " << i << " and " << j;
        }
      EXPECT_GT(conflicts, steps.size() / 2);
      EXPECT_TRUE(tight ? barriers == steps.size() : barriers < steps.size() / 2)
          << seed << ": " << barriers << " of " << steps.size();
    }
    ASSERT_EQ(pictures[0].size(), pictures[1].size());
    EXPECT_EQ(std::memcmp(pictures[0].data(), pictures[1].data(), pictures[0].size() * sizeof(Rgba)), 0) << seed;
    gpgpDestroyAsset(drawing);
  }
}

TEST_F(LayersCpuTest, EveryPictureIsTheReferences) {
  layerPixels = 1 << 19;
  makeLayerCanvas();
  uint32_t kinds = 0;
  for (uint32_t seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<float>> tables;
    tables.reserve(64);
    Scene scene;
    blendSrgb = seed & 1;
    for (int i = 0; i < 3; ++i) {
      GpgpLayer layer = randomFilter(scene, random, tables);
      layer.blend = static_cast<int32_t>(random() % 17);
      if (random() % 2) {
        layer.mask = static_cast<uint32_t>(scene.groups.size() + 2);
        layer.maskKind = static_cast<int32_t>(random() % 2);
        layer.maskEncoding = static_cast<int32_t>(random() % 2);
      }
      const uint32_t group = scene.group(0, 0.7f, &layer);
      const auto shape = [&] {
        TestPath path = randomShape(static_cast<uint32_t>(random()), kSize);
        for (float& c : path.color) c = static_cast<float>(random() % 256) / 255;
        return path;
      };
      scene.add(shape());
      scene.add(shape(), group);
      scene.add(shape(), group);
      if (layer.mask) scene.add(shape(), scene.group());
    }
    const std::vector<GpgpPath> paths = scene.paths();
    const GpgpAsset drawing = makeDrawing(paths, scene.groups);
    const std::vector<GpgpCanvasItem> items = {place(drawing)};
    GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
    raster(items, kSize, kSize, 4, &report);
    ASSERT_EQ(report.base.status, GPGP_SUCCESS) << seed << ": " << report.layerPixels;
    vector::Canvas& own = ownCanvas();
    const auto& passes = own.passes().passes;
    uint32_t first = 0, rastered = 0, present = 0;
    while (!passes[first].stepped) ++first;
    for (uint32_t p = 0; p < passes.size(); ++p)
      if (own.ran(p)) (p < first ? rastered : present) = p;
    std::vector<uvec2> want = pictures(items, rastered);
    const std::vector<uvec2> got = pictures(items, present);
    const std::vector<shader::OperationRecord> listed(own.operations().begin(), own.operations().end());
    for (const auto& o : listed) kinds |= 1u << o.kind;

    const auto memory = std::pmr::get_default_resource();
    const auto converted = vector::makeDrawing(paths, scene.groups, memory);
    ASSERT_TRUE(converted);
    const auto packed = vector::packDrawing(*converted, vector::makeOutlines(*converted, memory), memory);
    std::vector<vec4> table(packed.bytes.size() / sizeof(vec4));
    std::memcpy(table.data(), packed.bytes.data(), packed.bytes.size());
    const core::Context* owner = nullptr;
    const auto& asset = static_cast<const vector::DrawingAsset&>(*api::objectOf(drawing, &owner));
    const vector::AssetTable assets[] = {{}, {asset.tables(), table, asset.offset() / sizeof(vec4)}};
    vector::operateOnCpu(listed, want, assets);

    // Half floats, powers and roots add up over the steps; noise and light that a step amplifies may differ more in
    // single pixels, where a table or a cell of the lattice changes.
    size_t apart = 0;
    for (size_t i = 0; i < report.layerPixels; ++i) {
      const auto color = [](const uvec2& p) {
        const auto a = glm::unpackHalf2x16(p.x), b = glm::unpackHalf2x16(p.y);
        return vec4(a.x, a.y, b.x, b.y);
      };
      const vec4 d = glm::abs(color(want[i]) - color(got[i]));
      apart += std::max({d.x, d.y, d.z, d.w}) > 0.01f;
    }
    EXPECT_LE(apart, report.layerPixels / 2000) << seed;
    gpgpDestroyAsset(drawing);
  }
  EXPECT_EQ(kinds, (1u << 18) - 1) << "a kind of operation was never asked for";
}

} // namespace
