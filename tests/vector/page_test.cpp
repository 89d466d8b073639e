// Pages beside cairo's, tile by tile: thin frames along their edges, at sizes that are multiples of what a word of
// tiles, a tile and a workgroup hold, and others.
#include "cairo_fixture.h"
#include "fetched_svg.h"

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct PageTest : CairoTest {
  PageTest() { exactArea = true; }
  /// Both pictures, compared where they differ most.
  void expectAlike(std::span<const GpgpPath> paths, std::span<const GpgpPathGroup> groups, const float (&scale)[2],
                   uint32_t width, uint32_t height, const std::string& what) {
    makeCanvas(2048);
    const GpgpAsset drawing = makeDrawing({paths.begin(), paths.end()}, {groups.begin(), groups.end()});
    GpgpCanvasItem item = place(drawing);
    item.transform[0] = scale[0], item.transform[3] = scale[1];
    const auto ours = raster({item}, width, height, 16);
    gpgpDestroyAsset(drawing);
    const auto theirs =
        cairoPicture(paths, groups, static_cast<double>(scale[0]), static_cast<double>(scale[1]), width, height);
    const TileDifference worst = compare(ours, theirs, width).worst;
    worst_ = std::max(worst_, worst.mean);
    // Where both edges of a line lie in one pixel, the second counts by its samples: a sixteenth for two of eight rows.
    EXPECT_LE(worst.mean, 4.0 / 255) << what << ", " << width << " x " << height << ": " << worst.where();
  }
  double worst_ = 0;
};

constexpr uint32_t kSizes[][2] = {{256, 256}, {512, 512}, {512, 467}, {768, 64}, {1024, 96}, {1280, 40}, {2048, 64},
                                  {320, 200}, {500, 300}, {264, 264}, {511, 64}, {513, 64},  {96, 2048}, {8, 8}};

TEST_F(PageTest, ThinFramesAlongThePage) {
  for (const auto& [width, height] : kSizes)
    for (const float stroke : {0.036f, 0.1f, 0.25f, 0.5f, 1.0f})
      for (const float inset : {0.0f, 0.018f, 0.25f, 0.5f}) {
        const auto w = static_cast<float>(width), h = static_cast<float>(height);
        TestPath frame;
        frame.rule = GPGP_FILL_EVEN_ODD;
        frame.color = {1, 0, 0, 1};
        for (const float d : {inset - stroke / 2, inset + stroke / 2})
          frame.move(d, d).line(w - d, d).line(w - d, h - d).line(d, h - d).close();
        const GpgpPath path = frame.view();
        expectAlike({&path, 1}, {}, {1, 1}, width, height,
                    "stroke " + std::to_string(stroke) + " at " + std::to_string(inset));
      }
  std::printf("%.2f / 255 in the worst tile\n", worst_ * 255);
}

struct PageOfFile : PageTest, testing::WithParamInterface<const char*> {};

TEST_P(PageOfFile, AtAnySize) {
  const auto svg = fetchedSvg(GetParam());
  ASSERT_TRUE(svg);
  const vector::svg::ImportedViews views(*svg);
  for (const auto& [width, height] : kSizes)
    expectAlike(views.paths, views.groups, {float(width) / float(svg->width), float(height) / float(svg->height)},
                width, height, GetParam());
  std::printf("%.2f / 255 in the worst tile\n", worst_ * 255);
}
INSTANTIATE_TEST_SUITE_P(Cases, PageOfFile,
                         testing::Values("cases/vector/01_thin_frame_leak.svg",
                                         "cases/vector/02_page_outline_tile.svg"));

} // namespace
