// Scenes of paths in layers, and a canvas that draws them.
#pragma once
#include "canvas_fixture.h"

namespace gpgp::test {

inline constexpr float kAll[4] = {-1e5f, -1e5f, 1e5f, 1e5f};

inline TestPath solid(float left, float top, float right, float bottom, std::array<float, 4> color = {1, 1, 1, 1}) {
  TestPath path;
  path.move(left, top).line(right, top).line(right, bottom).line(left, bottom).close();
  path.color = color;
  return path;
}

/// A layer that does nothing, to be changed.
inline GpgpLayer plainLayer() {
  GpgpLayer layer{};
  for (float* transform : {layer.maskTransform, layer.filterTransform}) transform[0] = transform[3] = 1;
  for (float* region : {layer.maskRegion, layer.filterRegion}) std::copy_n(kAll, 4, region);
  layer.maskEncoding = GPGP_IMAGE_LINEAR;
  return layer;
}
inline GpgpFilterStep step(GpgpFilterKind kind, std::vector<float> values = {}, int32_t mode = 0,
                           uint32_t input = GPGP_FILTER_SOURCE, uint32_t input2 = GPGP_FILTER_SOURCE) {
  GpgpFilterStep s{};
  s.kind = kind;
  s.mode = mode;
  s.input = input;
  s.input2 = input2;
  std::copy_n(kAll, 4, s.region);
  std::copy(values.begin(), values.end(), s.values);
  return s;
}

/// Paths and groups that live as long as the test.
struct Scene {
  std::vector<TestPath> shapes;
  std::vector<uint32_t> groupOf;
  std::vector<GpgpPathGroup> groups;
  std::vector<std::unique_ptr<GpgpLayer>> layers;
  std::vector<std::unique_ptr<std::vector<GpgpFilterStep>>> filters;
  std::vector<std::unique_ptr<TestPath>> clips;
  std::vector<std::unique_ptr<GpgpPath>> clipViews;

  /// Returns 1 + its index.
  uint32_t group(uint32_t parent = 0, float opacity = 1, const GpgpLayer* layer = nullptr) {
    groups.push_back({parent, opacity});
    if (layer) {
      layers.push_back(std::make_unique<GpgpLayer>(*layer));
      groups.back().layer = layers.back().get();
    }
    return static_cast<uint32_t>(groups.size());
  }
  GpgpLayer filter(std::vector<GpgpFilterStep> steps) {
    filters.push_back(std::make_unique<std::vector<GpgpFilterStep>>(std::move(steps)));
    GpgpLayer layer = plainLayer();
    layer.filter = filters.back()->data();
    layer.filterCount = static_cast<uint32_t>(filters.back()->size());
    return layer;
  }
  void clip(uint32_t group, const TestPath& path) {
    clips.push_back(std::make_unique<TestPath>(path));
    clipViews.push_back(std::make_unique<GpgpPath>(clips.back()->view()));
    groups[group - 1].clip = clipViews.back().get();
    groups[group - 1].clipCount = 1;
  }
  void add(const TestPath& path, uint32_t group = 0) {
    shapes.push_back(path);
    groupOf.push_back(group);
  }
  std::vector<GpgpPath> paths() const {
    std::vector<GpgpPath> views;
    for (size_t i = 0; i < shapes.size(); ++i) {
      views.push_back(shapes[i].view());
      views.back().group = groupOf[i];
    }
    return views;
  }
};

struct LayersTest : CanvasTest {
  uint32_t layerPixels = 1 << 22, operations = 0, drawings = 0;
  void makeLayerCanvas(uint32_t size = 256) {
    GpgpCanvasCreateInfo info = GPGP_CANVAS_CREATE_INFO_INIT;
    info.base = {"canvas with layers", device.graphics().family, 0, VK_FALSE};
    info.maxWidth = info.maxHeight = size;
    info.maxPaths = 4096;
    info.maxDrawings = drawings;
    info.targets = canvasTargets;
    info.maxLayerPixels = layerPixels;
    info.maxLayerOperations = operations;
    canvas = recorder(gpgpCreateCanvas, info, nullptr);
  }
  std::vector<Rgba> draw(const Scene& scene, uint32_t size, GpgpCanvasReport* report = nullptr) {
    const GpgpAsset drawing = makeDrawing(scene.paths(), scene.groups);
    auto pixels = raster({place(drawing)}, size, size, 16, report);
    gpgpDestroyAsset(drawing);
    return pixels;
  }
};

inline void expectNear(const Rgba& p, const std::array<double, 4>& want, double within, const std::string& what) {
  const float got[4] = {p.r, p.g, p.b, p.a};
  for (size_t k = 0; k < 4; ++k) ASSERT_NEAR(got[k], want[k], within) << what << ", channel " << k;
}

inline double cumulative(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

} // namespace gpgp::test
