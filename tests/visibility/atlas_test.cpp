// The atlas: the GPU against the CPU reference over walks with overflow, what must hold of every frame, blocks that
// stay in a steady walk, and the engine's shader functions as a round trip and as a picture.
#include "atlas_world.h"
#include "host/kernel.h"
#include "shaders/atlas_material.spv.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::test {
namespace {
using namespace shader;
using visibility::CpuAtlas;
using visibility::CpuAtlasResult;

struct AtlasTest : DeviceTest {
  GpgpRecorder atlasRecorder() {
    GpgpAtlasRecorderCreateInfo info = GPGP_ATLAS_RECORDER_CREATE_INFO_INIT;
    info.base.label = "atlas recorder";
    info.base.queueFamily = device.graphics().family;
    info.maxTriangles = 1 << 14;
    info.maxBuckets = 5;
    return recorder(gpgpCreateAtlasRecorder, info);
  }
};

void expectSame(const AtlasWorld& world, const CpuAtlasResult& gpu, const CpuAtlasResult& cpu, uint32_t frame) {
  SCOPED_TRACE(testing::Message() << "frame " << frame);
  const auto head = [](auto list, uint32_t most) {
    list.resize(std::min<size_t>(list.size(), most));
    return list;
  };
  EXPECT_TRUE(gpu.blocks == cpu.blocks);
  EXPECT_TRUE(gpu.tiles == head(cpu.tiles, world.allTiles()));
  EXPECT_EQ(gpu.dispatches, cpu.dispatches);
  EXPECT_EQ(gpu.added, head(cpu.added, world.allListed()));
  EXPECT_EQ(gpu.changed, head(cpu.changed, world.allListed()));
  EXPECT_EQ(gpu.gone, head(cpu.gone, world.allListed()));
  const AtlasCounters &a = gpu.counters, &b = cpu.counters;
  EXPECT_TRUE(std::equal(a.byClass, a.byClass + kClasses, b.byClass));
  for (const uint32_t AtlasCounters::*field :
       {&AtlasCounters::visible, &AtlasCounters::blocks, &AtlasCounters::added, &AtlasCounters::changed,
        &AtlasCounters::kept, &AtlasCounters::gone, &AtlasCounters::lowered, &AtlasCounters::dropped,
        &AtlasCounters::droppedTriangles, &AtlasCounters::supers, &AtlasCounters::pressure, &AtlasCounters::repacked,
        &AtlasCounters::tiles, &AtlasCounters::vacated})
    EXPECT_EQ(a.*field, b.*field);
}

float logUniform(std::mt19937& random, float low, float high) {
  const float t = static_cast<float>(random() % 65536) / 65536;
  return low * std::pow(high / low, t);
}

/// One frame further: some triangles appear or disappear, sizes drift.
void walk(AtlasWorld& world, std::mt19937& random, uint32_t changes, float growth) {
  for (uint32_t i = 0; i < changes; ++i) {
    const uint32_t t = static_cast<uint32_t>(random()) % world.triangles;
    world.setVisible(t, !world.isVisible(t));
  }
  for (uint32_t t = 0; t < world.triangles; ++t) {
    const float area = uintBitsToFloat(world.sizes[t * 3]) * growth * logUniform(random, 0.97f, 1.03f);
    world.setSize(t, area, std::sqrt(area) * 2);
  }
}

TEST(AtlasFunctions, PairsShareAnEdgeInOppositeOrder) {
  uint32_t pairs = 0;
  for (uint32_t i = 0; i < 4 * 4 * 4 * 4 * 4 * 4; ++i) {
    const uvec3 a(i & 3, i >> 2 & 3, i >> 4 & 3), b(i >> 6 & 3, i >> 8 & 3, i >> 10 & 3);
    const uint32_t code = pairCode(a, b);
    if (!code) continue;
    ++pairs;
    const uint32_t first = firstCorner(code), second = secondCorner(code);
    const auto at = [](const uvec3& v, uint32_t k) { return k % 3 == 0 ? v.x : k % 3 == 1 ? v.y : v.z; };
    EXPECT_EQ(at(a, first + 1), at(b, second + 2));
    EXPECT_EQ(at(a, first + 2), at(b, second + 1));
    EXPECT_NE(at(a, first + 1), at(a, first + 2));
  }
  // Of each of 24 triangles: for each edge one with the fourth corner, and itself turned over; three ways to begin.
  EXPECT_EQ(pairs, 24u * (3 + 1) * 3);
  EXPECT_EQ(codeIn(0xfu, 0), 0u); // what no pair has
}

TEST(AtlasFunctions, ClassesHaveRoomAndHysteresis) {
  for (float texels = 0.01f; texels < 1e6f; texels *= 1.01f) {
    const uint32_t c = classFor(texels), key = keyFor(texels, 7);
    EXPECT_TRUE(texels < powerOfTwo(int(c)) || c == kMaxClass) << texels;
    EXPECT_TRUE(c == kMinClass || texels >= powerOfTwo(int(c) - 1)) << texels;
    EXPECT_LT(key, kKeys);
    EXPECT_EQ(classOfKey(key), c) << texels;
    EXPECT_LE(key / kKeyParts, keyFor(texels * 1.01f, 7) / kKeyParts);
    for (uint32_t before = 0; before <= kMaxClass; before = before ? before + 1 : kMinClass) {
      const uint32_t now = classWithHysteresis(before, texels);
      EXPECT_LT(variantOf(now, key), kVariants);
      EXPECT_EQ(classWithHysteresis(now, texels), now);
      if (now != before && before) {
        // A block that has just changed stays until its size changes by a quarter.
        EXPECT_EQ(classWithHysteresis(now, texels * 1.2f), now) << texels;
        EXPECT_EQ(classWithHysteresis(now, texels / 1.2f), now) << texels;
      }
    }
    for (uint32_t pressure = 0; pressure < kMostPressure; pressure += 97)
      EXPECT_GE(classUnder(c, key, pressure), classUnder(c, key, pressure + 97));
    EXPECT_EQ(classUnder(c, key, 0), c);
    EXPECT_EQ(classUnder(c, key, kDropPressure), kMinClass);
    EXPECT_EQ(classUnder(c, key, kMostPressure), 0u);
  }
  for (const uint32_t bits : {0x7f800000u, 0x7fc00000u, 0xff800000u, 0xffffffffu, 0x80000001u, 1u})
    EXPECT_LE(classFor(texelsFor(bits, bits, bits, 64)), kMaxClass);
}

/// Over every class, place, corner and gutter: texel, barycentrics, and back to the texel's centre.
TEST(AtlasFunctions, TexelsComeBackFromBarycentrics) {
  float worst = 0;
  for (uint32_t c = kMinClass; c <= kMaxClass; ++c)
    for (uint32_t code = 0; code <= 9; ++code)
      for (uint32_t gutter = 0; gutter < 2; ++gutter) {
        const uint32_t place = (placesIn(c) - 1) * 5 / 7, state = makeState(37, place, c, c);
        const uint32_t first = blockWord(state, 8, firstCorner(code), 0);
        const uint32_t second = code ? blockWord(state, 8, secondCorner(code), 1) : 0;
        const GpgpAtlasBlock b = gpgpAtlasBlock(first);
        EXPECT_EQ(b.width * b.height, 1u << c);
        EXPECT_TRUE(b.width == b.height || b.width == b.height * 2);
        EXPECT_EQ(b.x / kSuperSide, 37u % 8);
        EXPECT_EQ(b.y / kSuperSide, 37u / 8);
        uint32_t shown = 0;
        const uint32_t step = c > 10 ? 3 : 1;
        for (uint32_t tile = 0; tile < b.width * b.height / 16; tile += step)
          for (uint32_t local = 0; local < 16; ++local) {
            const GpgpAtlasTexel t = gpgpAtlasTexel(first, second, tile, local, gutter);
            EXPECT_TRUE(t.place.x - b.x < b.width && t.place.y - b.y < b.height);
            if (!t.shown) continue;
            ++shown;
            EXPECT_NEAR(t.weights.x + t.weights.y + t.weights.z, 1, 1e-5f);
            const vec2 at = gpgpAtlasPoint(t.second ? second : first, t.weights, gutter);
            worst =
                std::max({worst, std::abs(at.x - float(t.place.x) - 0.5f), std::abs(at.y - float(t.place.y) - 0.5f)});
            const vec3 next = t.weights + t.right;
            const vec2 beside = gpgpAtlasPoint(t.second ? second : first, next, gutter);
            EXPECT_NEAR(beside.x, at.x + 1, 2e-3f);
            const vec2 below = gpgpAtlasPoint(t.second ? second : first, t.weights + t.down, gutter);
            EXPECT_NEAR(below.y, at.y + 1, 2e-3f);
            if (!code || gutter) continue;
            EXPECT_GE(std::min({t.weights.x, t.weights.y, t.weights.z}), -1e-5f); // a pair has no texel outside
          }
        EXPECT_TRUE(!code || step > 1 || shown == b.width * b.height);
        // A bilinear filter inside either triangle reads shown texels of this block alone.
        for (int i = 0; i <= 8; ++i)
          for (int j = 0; i + j <= 8; ++j) {
            const vec3 w(float(i) / 8, float(j) / 8, float(8 - i - j) / 8);
            for (const uint32_t word : {first, second}) {
              if (!word) continue;
              const vec2 at = gpgpAtlasPoint(word, w, gutter);
              for (const float dx : {-0.499f, 0.499f})
                for (const float dy : {-0.499f, 0.499f}) {
                  const auto x = static_cast<uint32_t>(at.x + dx), y = static_cast<uint32_t>(at.y + dy);
                  ASSERT_TRUE(x >= b.x && x < b.x + b.width && y >= b.y && y < b.y + b.height);
                  const uint32_t tile = (y - b.y) / 4 * (b.width / 4) + (x - b.x) / 4;
                  EXPECT_TRUE(gpgpAtlasTexel(first, second, tile, y % 4 * 4 + x % 4, gutter).shown);
                }
            }
          }
      }
  EXPECT_LT(worst, 2e-3f);
}

TEST_F(AtlasTest, EqualsTheCpuReferenceOverAWalkWithOverflow) {
  std::mt19937 random(11);
  AtlasWorld world(14000, 384, 256, random); // room for 6144 blocks of 4 x 4
  world.bucketCount = 3;
  for (uint32_t t = 0; t < world.triangles; ++t) {
    world.setVisible(t, random() % 10 == 0);
    world.setSize(t, logUniform(random, 0.5f, 200), 10);
  }
  AtlasGpu gpu(*this, atlasRecorder(), world);
  CpuAtlas atlas;
  std::vector<uint32_t> before;
  uint32_t lowered = 0, dropped = 0, repacked = 0, relieved = 0, last = 0;
  for (uint32_t frame = 0; frame < 48; ++frame) {
    // Grows until blocks are lowered, gets crowded until they are dropped, and empties again.
    const float growth = frame < 12 ? 1.25f : frame < 30 ? 1.0f : 0.8f;
    walk(world, random, frame >= 30 ? 10 : frame % 7 == 3 ? 400 : 60, growth);
    if (frame == 20)
      for (uint32_t t = 0; t < world.triangles; ++t) world.setVisible(t, true);
    if (frame == 30)
      for (uint32_t t = 0; t < world.triangles; ++t) world.setVisible(t, random() % 20 == 0);
    world.hasShade = frame % 3 == 1;
    world.findsPairs = frame == 0 || frame == 35;
    if (frame == 35) std::rotate(world.indices.begin(), world.indices.begin() + 3, world.indices.end()); // other pairs
    world.tileCapacity = frame == 9 ? 100 : 0;
    world.listCapacity = frame == 10 ? 20 : 0;
    for (uint32_t& word : world.shadeBits) word = static_cast<uint32_t>(random() & random() & random());
    GpgpAtlasReport report;
    const CpuAtlasResult found = gpu.step(world, report);
    const CpuAtlasResult expected = allocate(world.input(), atlas);
    expectSame(world, found, expected, frame);
    EXPECT_EQ(report.base.status == GPGP_BUDGET_EXCEEDED,
              report.loweredBlocks || report.droppedBlocks || expected.counters.listsExceeded)
        << frame;
    EXPECT_EQ(expected.counters.listsExceeded != 0, frame == 9 || frame == 10) << frame;
    expectSound(world, expected, frame == 35 ? std::vector<uint32_t>() : before);
    if (HasFailure()) FAIL() << "frame " << frame;
    lowered += expected.counters.lowered;
    dropped += expected.counters.dropped;
    repacked += expected.counters.repacked;
    relieved += expected.counters.pressure < last;
    last = expected.counters.pressure;
    before = expected.blocks;
  }
  // The walk has been through all of it.
  EXPECT_GT(lowered, 0u);
  EXPECT_GT(dropped, 0u);
  EXPECT_GT(repacked, 0u);
  EXPECT_GT(relieved, 0u);
  EXPECT_EQ(last, 0u);
}

/// Most triangles go: those left move together, a superblock a frame, and the others become free.
TEST_F(AtlasTest, GivesSuperblocksBack) {
  std::mt19937 random(23);
  AtlasWorld world(14000, 1024, 512, random);
  for (uint32_t t = 0; t < world.triangles; ++t) {
    world.setVisible(t, true);
    world.setSize(t, 3, 3);
  }
  AtlasGpu gpu(*this, atlasRecorder(), world);
  CpuAtlas atlas;
  std::vector<uint32_t> before;
  uint32_t most = 0, spare = 0, vacated = 0;
  for (uint32_t frame = 0; frame < 12; ++frame) {
    GpgpAtlasReport report;
    const CpuAtlasResult found = gpu.step(world, report), expected = allocate(world.input(), atlas);
    expectSame(world, found, expected, frame);
    expectSound(world, expected, before);
    EXPECT_EQ(expected.counters.changed, expected.counters.vacated);
    most = std::max(most, expected.counters.supers);
    spare = expected.counters.supers - expected.counters.leastSupers;
    vacated += expected.counters.vacated;
    before = expected.blocks;
    for (uint32_t t = 0; frame == 0 && t < world.triangles; ++t) world.setVisible(t, random() % 10 == 0);
  }
  EXPECT_GE(most, 8u);
  EXPECT_LE(spare, 1u);
  EXPECT_GT(vacated, 500u);
}

/// The most tiles that one workgroup can have: its loops are as long as they get.
TEST_F(AtlasTest, ListsTheLargestBlocks) {
  std::mt19937 random(1);
  AtlasWorld world(1024, 4096, 4096, random);
  world.findsPairs = false;
  for (uint32_t t = 0; t < world.triangles; ++t) {
    world.setVisible(t, true);
    world.setSize(t, 1e5f, 500);
  }
  AtlasGpu gpu(*this, atlasRecorder(), world);
  CpuAtlas atlas;
  GpgpAtlasReport report;
  const CpuAtlasResult found = gpu.step(world, report), expected = allocate(world.input(), atlas);
  expectSame(world, found, expected, 0);
  expectSound(world, expected, {});
  EXPECT_EQ(report.tiles, 1u << 20);
  EXPECT_EQ(report.fill, 1);
}

TEST(AtlasReference, BlocksStayInASteadyWalk) {
  std::mt19937 random(5);
  AtlasWorld world(40000, 2048, 2048, random);
  for (uint32_t t = 0; t < world.triangles; ++t) {
    world.setVisible(t, random() % 4 == 0);
    world.setSize(t, logUniform(random, 0.5f, 300), 10);
  }
  CpuAtlas atlas;
  std::vector<uint32_t> before;
  for (uint32_t frame = 0; frame < 40; ++frame) {
    const CpuAtlasResult result = allocate(world.input(), atlas);
    expectSound(world, result, before);
    const AtlasCounters& counters = result.counters;
    EXPECT_EQ(counters.pressure, 0u);
    EXPECT_EQ(counters.repacked, 0u);
    if (frame) {
      EXPECT_LT(counters.changed * 100, counters.blocks * 4) << frame; // most of these drift to another class
    }
    EXPECT_LE(counters.supers, counters.leastSupers + 2 * kClasses) << frame; // what is left over is given back
    before = result.blocks;
    world.findsPairs = false;
    walk(world, random, 400, frame < 20 ? 1.01f : 0.99f);
  }
}

/// All triangles have one size and too many are visible: some are dropped, not all, and the rest stays where it is.
TEST(AtlasReference, DropsNoMoreThanItMust) {
  std::mt19937 random(2);
  AtlasWorld world(6000, 256, 128, random); // room for 2048 blocks of 4 x 4
  world.findsPairs = false;
  for (uint32_t t = 0; t < world.triangles; ++t) {
    world.setVisible(t, true);
    world.setSize(t, 20, 5);
  }
  CpuAtlas atlas;
  const CpuAtlasResult first = allocate(world.input(), atlas), second = allocate(world.input(), atlas);
  expectSound(world, first, {});
  EXPECT_EQ(first.counters.blocks + first.counters.dropped, world.triangles);
  EXPECT_GT(first.counters.blocks, 1700u); // a sixteenth of them is the step
  EXPECT_EQ(second.counters.kept, first.counters.blocks);
  EXPECT_TRUE(first.blocks == second.blocks);
}

/// An engine's material shades the listed tiles through gpgp/shaders/atlas.h on the GPU.
TEST_F(AtlasTest, AMaterialShadesTheListedTiles) {
  std::mt19937 random(3);
  AtlasWorld world(900, 512, 256, random);
  for (uint32_t t = 0; t < world.triangles; ++t) {
    world.setVisible(t, random() % 3 == 0);
    world.setSize(t, logUniform(random, 0.5f, 3000), 10);
  }
  AtlasGpu gpu(*this, atlasRecorder(), world);
  GpgpAtlasReport report;
  const CpuAtlasResult result = gpu.step(world, report);
  const size_t texels = size_t(world.width) * world.height;
  const host::Buffer image(device, texels * 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  host::fill(device, image, 0);
  host::ComputeKernel kernel(device, atlas_material, 3, 20);
  const std::array<uint32_t, 5> push{world.width, world.triangles, result.dispatches[3], result.dispatches[4], 1};
  kernel.run({&gpu.blocks, &gpu.tiles, &image}, push.data(), result.dispatches[0], result.dispatches[1]);
  const auto shaded = host::download<std::array<float, 4>>(device, image, texels);
  size_t shown = 0, painted = 0;
  float worst = 0;
  for (const auto& texel : shaded) painted += texel[3] != 0;
  for (const auto& [triangle, tile] : result.tiles)
    for (uint32_t local = 0; local < 16; ++local) {
      const uint32_t second = triangle + 1 < world.triangles ? result.blocks[triangle + 1] : 0;
      const GpgpAtlasTexel t = gpgpAtlasTexel(result.blocks[triangle], second, tile, local, 1);
      if (!t.shown) continue;
      ++shown;
      const auto& found = shaded[size_t(t.place.y) * world.width + t.place.x];
      for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(found[size_t(k)] - t.weights[k]));
      EXPECT_EQ(found[3], static_cast<float>(triangle + t.second + 1));
    }
  EXPECT_EQ(shown, painted);
  EXPECT_LT(worst, 1e-4f);
}

TEST_F(AtlasTest, SaysWhatIsWrong) {
  GpgpHistory atlas = nullptr;
  GpgpAtlasCreateInfo create = GPGP_ATLAS_CREATE_INFO_INIT;
  create.width = 100;
  EXPECT_EQ(gpgpCreateAtlas(context, &create, &atlas), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("width x height is 100 x 0; expected multiples of 128 up to 8192"), std::string::npos)
      << lastMessage();
  create.width = create.height = 256;
  create.maxTriangles = (1u << 25) + 1;
  EXPECT_EQ(gpgpCreateAtlas(context, &create, &atlas), GPGP_ERROR_INVALID_ARGUMENT);
  create.maxTriangles = 64;
  ASSERT_EQ(gpgpCreateAtlas(context, &create, &atlas), GPGP_SUCCESS);
  const GpgpFrame frame = advance();
  host::Buffer buffer(device, 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  GpgpAtlasInfo info = GPGP_ATLAS_INFO_INIT;
  info.indexType = VK_INDEX_TYPE_UINT32;
  const auto expect = [&](GpgpResult code, const char* text) {
    device.submitAndWait(device.graphics(), [&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareAtlas(atlasRecorder(), cmd, &frame, &info), code) << text;
    });
    EXPECT_NE(lastMessage().find(text), std::string::npos) << lastMessage();
  };
  expect(GPGP_ERROR_INVALID_HANDLE, "atlas is NULL; expected a shading atlas");
  info.atlas = atlas;
  expect(GPGP_NOT_READY, "atlas is not resident");
  VkDeviceSize pending = 0;
  device.submitAndWait(device.graphics(), [&](VkCommandBuffer cmd) {
    ASSERT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, &pending), GPGP_SUCCESS);
  });
  info.triangleCount = 65;
  expect(GPGP_ERROR_INVALID_ARGUMENT, "triangleCount is 65; the atlas was made for 64");
  info.triangleCount = 64;
  expect(GPGP_ERROR_INVALID_ARGUMENT, "visibleBits.buffer is NULL");
  info.visibleBits = buffer.range({}, {}, 0, 4);
  expect(GPGP_ERROR_INVALID_ARGUMENT, "visibleBits.size is 4; triangleCount needs 8");
  info.visibleBits = info.triangleSizes = info.blocks = buffer.range();
  info.bucketCount = 6;
  expect(GPGP_ERROR_INVALID_ARGUMENT, "bucketCount is 6; the recorder was made for 5");
  info.bucketCount = 1;
  info.texelsPerPixel = -1;
  expect(GPGP_ERROR_INVALID_ARGUMENT, "texelsPerPixel is -1; expected 0.0009765625 to 64");
  info.texelsPerPixel = 0;
  info.drawCount = 1;
  expect(GPGP_ERROR_INVALID_HANDLE, "geometrySet is NULL; expected a geometry set");
  gpgpDestroyHistory(atlas);
}

} // namespace
} // namespace gpgp::test
