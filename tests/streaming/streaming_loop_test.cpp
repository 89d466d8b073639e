// The streaming sample without its network: what the server shaded is what the client has, and what it displays at the
// server's pose is what local rendering gives there.
#include "assembly.h"
#include "frame_source.h"
#include "quality.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace streaming {
namespace {

constexpr uint32_t kWidth = 192, kHeight = 108;
constexpr float kFieldOfView = 1.05f;

struct Loop {
  World world = makeVillage(1);
  Stage stage{"", true};
  FrameSource source;
  StreamState state;
  DisplayRenderer display;
  FrameAssembly assembly;

  Loop(GpgpSamplingMethod method, Codec codec, uint32_t reshade, uint32_t gutter, uint32_t side = 1024)
      : source(stage, world, shading(method, reshade, gutter, side), {codec, 0, 30}), state(source.welcome()),
        display(stage, world, *parseWelcome(write(source.welcome())), kWidth, kHeight, kFieldOfView) {}
  ~Loop() { EXPECT_NO_THROW(stage.checkMessages()); }

  static ShadingOptions shading(GpgpSamplingMethod method, uint32_t reshade, uint32_t gutter, uint32_t side) {
    ShadingOptions options;
    options.method = method;
    options.width = kWidth;
    options.height = kHeight;
    options.fieldOfView = kFieldOfView;
    options.atlasWidth = options.atlasHeight = side;
    options.gutter = gutter;
    options.reshade = reshade;
    return options;
  }
  PoseMessage poseAt(double seconds) const {
    PoseMessage pose;
    pose.number = 1 + static_cast<uint32_t>(seconds * 1000);
    pose.seconds = seconds;
    pose.view = walkAt(seconds, world);
    pose.earliest = 0;
    pose.latest = 0.12f;
    return pose;
  }
  /// One frame through messages, as over a network.
  void send(const PoseMessage& pose) {
    const Bytes frame = source.next(*parsePose(write(pose)), 0);
    for (uint32_t i = 0; i < partCount(frame.size()); ++i)
      ASSERT_TRUE(assembly.add(*parsePart(write(partOf(frame, source.header().number, i))), 0));
    const auto taken = assembly.take();
    ASSERT_TRUE(taken);
    const auto parsed = parseFrame(*taken, world.model.triangleCount);
    ASSERT_TRUE(parsed);
    ASSERT_TRUE(state.apply(*parsed));
    display.upload(state);
  }
  /// All pixels of geometry are accounted for; the quality against local rendering.
  Quality show(double seconds, PixelCounts& counts) {
    counts = display.render(walkAt(seconds, world), seconds, DisplayRenderer::compare);
    EXPECT_EQ(counts.holes, 0u);
    EXPECT_EQ(counts.geometry, counts.atlas + counts.last + counts.mean);
    EXPECT_GT(counts.geometry, kWidth * kHeight / 4);
    if (const char* folder = std::getenv("GPGP_TEST_PICTURES")) {
      writePicture(folder + std::string("/display.png"), display.picture());
      writePicture(folder + std::string("/local.png"), display.local());
    }
    return compare(display.picture(), display.local());
  }
};

/// Lossless: every texel, word and bit is the server's; at its own pose the display shows what local rendering shows.
TEST(StreamingLoop, ClientHasWhatTheServerShaded) {
  Loop loop(GPGP_SAMPLING_EXACT, Codec::zstd, 3, 0);
  for (int n = 0; n < 5; ++n) {
    const double seconds = 0.4 * n;
    if (n == 3) loop.source.restart(); // a key frame on the way
    loop.send(loop.poseAt(seconds));
    EXPECT_EQ(loop.state.atlas().texels, loop.source.renderer().atlas().texels) << n;
    EXPECT_EQ(loop.state.blocks(), loop.source.renderer().blocks()) << n;
    EXPECT_EQ(loop.state.visibleBits(), loop.source.renderer().visibleBits()) << n;
    EXPECT_EQ(loop.source.header().dropped, 0u);
    PixelCounts counts;
    const Quality quality = loop.show(seconds, counts);
    std::printf("frame %d: PSNR %.2f dB, SSIM %.4f, %u of %u pixels with fallback, %u tiles changed of %u shaded\n", n,
                quality.psnr, quality.ssim, counts.fallback(), counts.geometry,
                static_cast<uint32_t>(loop.source.shaded().changedTiles.size()), loop.source.shaded().tiles);
    EXPECT_GT(quality.psnr, n ? 30 : 32);
    EXPECT_LE(counts.fallback(), counts.geometry / 5000);
  }
}

/// Denser texels come nearer to local rendering: what differs is filtering, not the place of what is shown.
TEST(StreamingLoop, DifferenceIsThatOfFiltering) {
  double last = 0;
  for (const float texels : {1.0f, 4.0f, 16.0f}) {
    const World world = makeVillage(1);
    Stage stage("", false);
    ShadingOptions options = Loop::shading(GPGP_SAMPLING_STANDARD, 1, 1, 2048);
    options.texelsPerPixel = texels;
    FrameSource source(stage, world, options, {Codec::zstd, 0, 30});
    StreamState state(source.welcome());
    DisplayRenderer display(stage, world, source.welcome(), kWidth, kHeight, kFieldOfView);
    PoseMessage pose;
    pose.view = walkAt(0.5, world);
    pose.view.velocity = {};
    pose.latest = 0;
    pose.seconds = 0.5;
    ASSERT_TRUE(state.apply(*parseFrame(source.next(pose, 0), world.model.triangleCount)));
    display.upload(state);
    const PixelCounts counts = display.render(walkAt(0.5, world), 0.5, DisplayRenderer::compare);
    const Quality quality = compare(display.picture(), display.local());
    std::printf("%g texels a pixel: PSNR %.2f dB, SSIM %.4f, %u fallback\n", static_cast<double>(texels), quality.psnr,
                quality.ssim, counts.fallback());
    EXPECT_GT(quality.psnr, last + 0.5);
    last = quality.psnr;
  }
}

/// A display elsewhere than the server thinks, and an atlas that is too small: fallback shades, counted, no hole.
TEST(StreamingLoop, ShowsNoHoleWhereTheAtlasHasNothing) {
  Loop loop(GPGP_SAMPLING_STANDARD, Codec::x264, 1, 1, 128);
  PixelCounts counts;
  loop.show(0, counts); // nothing has come yet
  EXPECT_EQ(counts.mean, counts.geometry);
  EXPECT_EQ(counts.unseen, counts.geometry);
  loop.send(loop.poseAt(0));
  EXPECT_GT(loop.source.header().lowered, 0u);
  const Quality here = loop.show(0, counts);
  EXPECT_GT(counts.atlas, counts.geometry / 2);
  const Quality elsewhere = loop.show(6, counts);
  EXPECT_GT(counts.fallback(), counts.geometry / 100);
  EXPECT_GT(here.psnr, elsewhere.psnr);
  for (int n = 1; n <= 4; ++n) loop.send(loop.poseAt(1.5 * n)); // blocks go, and leave their colours
  loop.show(0, counts);
  EXPECT_GT(counts.last, 0u);
}

/// What exact sampling is for: from elsewhere within the cell it leaves fewer pixels without shading than standard.
TEST(StreamingLoop, ExactSamplingLeavesFewerPixelsUnshaded) {
  uint32_t fallback[2] = {};
  for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
    Loop loop(method, Codec::zstd, 1, 0);
    for (int n = 0; n < 2; ++n) {
      loop.send(loop.poseAt(1.2 * n));
      for (const double later : {0.04, 0.08, 0.12}) {
        PixelCounts counts;
        loop.show(1.2 * n + later, counts);
        fallback[method == GPGP_SAMPLING_EXACT] += counts.fallback();
      }
    }
  }
  std::printf("pixels with fallback: %u standard, %u exact\n", fallback[0], fallback[1]);
  EXPECT_LT(fallback[1] * 3, fallback[0]);
}

} // namespace
} // namespace streaming
