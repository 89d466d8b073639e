// Alpha-tested and see-through draws: against the CPU reference bit for bit, against rays in double precision that
// sample the textures by themselves, and in scenes whose answer is plain.
#include "exact_oracle.h"
#include "gpu.h"

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;

bool isVisible(const std::vector<uint32_t>& bits, uint32_t id) { return (bits[id / 32] >> (id % 32) & 1) != 0; }

AlphaTexture noise(uint32_t seed, uint32_t size, float cutoff) {
  AlphaTexture texture{size, size, {}, cutoff, false};
  std::mt19937 random(seed);
  for (uint32_t i = 0; i < size * size; ++i) texture.alpha.push_back(static_cast<uint8_t>(random() >> 24));
  return texture;
}
/// Opaque within a circle.
AlphaTexture disc(uint32_t size, double radius) {
  AlphaTexture texture{size, size, {}, 0.5f, false};
  for (uint32_t y = 0; y < size; ++y)
    for (uint32_t x = 0; x < size; ++x) {
      const double from = std::hypot((x + 0.5) / size - 0.5, (y + 0.5) / size - 0.5);
      texture.alpha.push_back(static_cast<uint8_t>(std::clamp((radius - from) * size * 128 + 128, 0.0, 255.0)));
    }
  return texture;
}
AlphaTexture constant(uint8_t alpha) { return {1, 1, {alpha}, 0.5f, false}; }

/// Two triangles, corners counter-clockwise; texture coordinates 0 to `repeat`.
uint32_t addCard(Scene& scene, const std::array<glm::vec3, 4>& corners, float repeat = 1) {
  const auto first = static_cast<uint32_t>(scene.indices.size());
  uint32_t v[4];
  constexpr float kAt[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  for (size_t i = 0; i < 4; ++i) {
    scene.coordinates.resize(scene.positions.size() / 3 * 2);
    v[i] = scene.addVertex(corners[i].x, corners[i].y, corners[i].z);
    scene.coordinates.insert(scene.coordinates.end(), {kAt[i][0] * repeat, kAt[i][1] * repeat});
  }
  scene.indices.insert(scene.indices.end(), {v[0], v[1], v[2], v[0], v[2], v[3]});
  return scene.addMesh(first);
}
/// Facing +Z.
std::array<glm::vec3, 4> square(glm::vec3 centre, float half) {
  return {centre + glm::vec3(-half, -half, 0), centre + glm::vec3(half, -half, 0), centre + glm::vec3(half, half, 0),
          centre + glm::vec3(-half, half, 0)};
}

/// Cards in front of a sheet: alpha-tested, see-through, both, neither.
Scene foliage(uint32_t seed, uint32_t cards, uint32_t width, uint32_t height, bool reversed, bool ortho = false) {
  Scene scene = sheet(seed, 10, 0.3f);
  scene.coordinates.resize(scene.positions.size() / 3 * 2);
  scene.addDraw(0, glm::scale(glm::mat4(1), glm::vec3(2)));
  scene.textures = {noise(seed, 8, 0.5f), disc(32, 0.4), constant(0), constant(255)};
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (uint32_t i = 0; i < cards; ++i) {
    const glm::vec3 centre(unit(random) * 1.5f, unit(random) * 1.2f, 0.5f + 0.5f * unit(random));
    const glm::vec3 right = 0.3f * glm::normalize(glm::vec3(unit(random), unit(random), unit(random)));
    const glm::vec3 up = 0.3f * glm::normalize(glm::cross(right, glm::vec3(unit(random), unit(random), unit(random))));
    const uint32_t mesh =
        addCard(scene, {centre - right - up, centre + right - up, centre + right + up, centre - right + up},
                1 + static_cast<float>(i % 3));
    const uint32_t kinds[] = {GPGP_DRAW_ALPHA_TEST(0),
                              GPGP_DRAW_ALPHA_TEST(1),
                              GPGP_DRAW_ALPHA_TEST(2),
                              GPGP_DRAW_ALPHA_TEST(3),
                              GPGP_DRAW_SEE_THROUGH,
                              GPGP_DRAW_SEE_THROUGH | GPGP_DRAW_ALPHA_TEST(0),
                              0};
    glm::mat4 transform(1);
    if (i % 5 == 4) transform[0][0] = -1; // mirrored
    scene.addDraw(mesh, transform, kinds[i % std::size(kinds)] | GPGP_DRAW_TWO_SIDED);
  }
  // One that goes through the near plane.
  scene.addDraw(
      addCard(scene, {glm::vec3(-0.4f, -0.9f, -1), {0.4f, -0.9f, -1}, {0.4f, -0.6f, 4}, {-0.4f, -0.6f, 4}}, 6),
      glm::mat4(1), GPGP_DRAW_ALPHA_TEST(0) | GPGP_DRAW_TWO_SIDED);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  glm::mat4 view = lookAt({0.2f, 0.1f, 3}, {0, 0, 0});
  if (ortho) {
    glm::mat4 m(1.0f); // parallel and off-centre: -1.6 to 1.2 across, -0.9 to 1.3 up, 0.5 to 10 deep
    m[0][0] = 2 / 2.8f, m[3][0] = 0.4f / 2.8f;
    m[1][1] = -2 / 2.2f, m[3][1] = 0.4f / 2.2f;
    m[2][2] = reversed ? 1 / 9.5f : -1 / 9.5f;
    m[3][2] = reversed ? 10 / 9.5f : -0.5f / 9.5f;
    view = m * view;
  } else {
    glm::mat4 m = perspective(0.9f, aspect, 0.2f, 20, reversed);
    m[2][0] = 0.15f, m[2][1] = -0.1f; // off-centre
    view = m * view;
  }
  scene.setCamera(view, width, height, reversed);
  scene.params.maxNonOpaque = 4096;
  return scene;
}

struct NonOpaqueTest : VisibilityGpuTest {};

CpuResult onCpu(Scene& scene, GpgpSamplingMethod method) {
  CpuInput input = scene.input();
  input.params.method = static_cast<uint32_t>(method);
  if (method == GPGP_SAMPLING_EXACT) return sampleExactOnCpu(input);
  if (method == GPGP_SAMPLING_CONSERVATIVE) return sampleConservativelyOnCpu(input);
  return sampleOnCpu(input);
}

TEST_F(NonOpaqueTest, EqualsTheCpuReference) {
  for (const bool ortho : {false, true})
    for (const bool reversed : {false, true}) {
      Scene scene = foliage(7, 70, 96, 64, reversed, ortho);
      scene.params.heuristics = GPGP_HEURISTICS_DEFAULT;
      scene.params.epsilonStatic = 0.05f;
      for (const GpgpSamplingMethod method :
           {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT, GPGP_SAMPLING_CONSERVATIVE}) {
        GpuOptions options;
        options.method = method;
        const std::string what =
            "method " + std::to_string(method) + (ortho ? ", parallel" : "") + (reversed ? ", reversed" : "");
        expectEqual(sample(scene, options), onCpu(scene, method), what);
      }
    }
}

TEST_F(NonOpaqueTest, ReferenceSlicesEqualTheCpuReference) {
  Scene scene = foliage(8, 40, 64, 48, false);
  for (const uint32_t slice : {0u, 7u}) {
    GpuOptions options;
    options.method = GPGP_SAMPLING_REFERENCE, options.samples = 16, options.slice = slice;
    CpuInput input = scene.input();
    input.params.method = shader::kReference;
    input.params.gridShift = 6;
    input.params.gridX = slice % 4 * 16 + 8;
    input.params.gridY = slice / 4 * 16 + 8;
    expectEqual(sample(scene, options), sampleOnCpu(input), "slice " + std::to_string(slice));
  }
}

TEST_F(NonOpaqueTest, ManyCardsInAPixelEqualTheCpuReference) {
  Scene scene = foliage(9, 300, 12, 8, false); // lists of more than 32, which are decided in batches
  GpuOptions options;
  options.method = GPGP_SAMPLING_EXACT;
  const CpuResult cpu = onCpu(scene, GPGP_SAMPLING_EXACT);
  EXPECT_GT(cpu.counters.pairs, 12u * 8 * 32);
  expectEqual(sample(scene, options), cpu, "many");
}

// Textures by a linear filter, which the CPU reference has not.
TEST_F(NonOpaqueTest, FindsWhatRaysSee) {
  for (const bool ortho : {false, true}) {
    Scene scene = foliage(10, 60, 40, 30, ortho, ortho);
    for (AlphaTexture& texture : scene.textures) texture.linear = true;
    GpuOptions options;
    options.method = GPGP_SAMPLING_EXACT;
    const GpuResult exact = sample(scene, options);
    EXPECT_EQ(exact.report.unresolved, 0u);
    // A ray in 8 x 8 a pixel stands for 64 of the samples.
    EXPECT_EQ(compareWithRays(scene, exact.bits, 8, 1), "");
    options.method = GPGP_SAMPLING_STANDARD;
    const SeenByRays centres = seenByRays(scene, 1);
    const GpuResult standard = sample(scene, options);
    for (uint32_t id = 0; id < scene.params.triangleCount; ++id) {
      EXPECT_TRUE(isVisible(standard.bits, id) || centres.sure[id] == 0) << id;
      EXPECT_TRUE(!isVisible(standard.bits, id) || centres.possible[id] != 0) << id;
    }
    // The grid of the reference, in one slice; and what shows from nearby is a superset.
    options.method = GPGP_SAMPLING_REFERENCE, options.samples = 4;
    const SeenByRays grid = seenByRays(scene, 4);
    const GpuResult reference = sample(scene, options);
    options.samples = 0;
    for (uint32_t id = 0; id < scene.params.triangleCount; ++id) {
      EXPECT_TRUE(isVisible(reference.bits, id) || grid.sure[id] == 0) << id;
      EXPECT_TRUE(!isVisible(reference.bits, id) || grid.possible[id] != 0) << id;
    }
    if (!ortho) {
      options.method = GPGP_SAMPLING_NEARBY;
      const GpuResult nearby = sample(scene, options);
      for (uint32_t id = 0; id < scene.params.triangleCount; ++id)
        EXPECT_TRUE(isVisible(nearby.bits, id) || !isVisible(standard.bits, id)) << id;
    }
    // The comparison can fail: with whole quads much of the sheet is hidden.
    Scene whole = scene;
    for (shader::Draw& draw : whole.draws) draw.flags &= ~shader::kAlphaTestBits;
    options.method = GPGP_SAMPLING_EXACT;
    EXPECT_NE(compareWithRays(scene, sample(whole, options).bits, 8, 1), "");
  }
}

/// A wall, and a card before it that hides all of it unless something lets it show.
struct Wall {
  Scene scene;
  explicit Wall(uint32_t flags) {
    scene.addDraw(addCard(scene, square({0, 0, 0}, 0.5f))); // triangles 0 and 1
    scene.addDraw(addCard(scene, square({0, 0, 1}, 1)), glm::mat4(1), flags);
    scene.textures = {constant(255), constant(0), disc(16, 0.1)};
    scene.setCamera(perspective(1, 1, 0.1f, 10) * lookAt({0, 0, 3}, {0, 0, 0}), 64, 64);
    scene.params.maxNonOpaque = 4096;
  }
};

TEST_F(NonOpaqueTest, WhatIsCutAwayIsNeitherSeenNorHides) {
  constexpr uint32_t kWall = 3, kCard = 12;
  const std::pair<uint32_t, uint32_t> cases[] = {{0, kCard},
                                                 {GPGP_DRAW_ALPHA_TEST(0), kCard},
                                                 {GPGP_DRAW_ALPHA_TEST(1), kWall},
                                                 {GPGP_DRAW_ALPHA_TEST(2), kWall | kCard},
                                                 {GPGP_DRAW_SEE_THROUGH, kWall | kCard},
                                                 {GPGP_DRAW_SEE_THROUGH | GPGP_DRAW_ALPHA_TEST(1), kWall},
                                                 {GPGP_DRAW_DISABLED, kWall}};
  for (const auto& [flags, expected] : cases)
    for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT, GPGP_SAMPLING_REFERENCE}) {
      Wall wall(flags);
      GpuOptions options;
      options.method = method;
      options.samples = method == GPGP_SAMPLING_REFERENCE ? 4 : 0;
      EXPECT_EQ(sample(wall.scene, options).bits[0], expected) << "flags " << flags << ", method " << method;
    }
}

TEST_F(NonOpaqueTest, NearbyKeepsWhatShowsThroughACutCard) {
  Wall wall(GPGP_DRAW_ALPHA_TEST(2));
  GpuOptions options;
  options.method = GPGP_SAMPLING_NEARBY;
  EXPECT_EQ(sample(wall.scene, options).bits[0] & 3, 3u);
}

TEST_F(NonOpaqueTest, ASolidWallHidesWhatIsSeeThrough) {
  for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
    Scene scene;
    scene.addDraw(addCard(scene, square({0, 0, 0}, 0.4f)), glm::mat4(1), GPGP_DRAW_SEE_THROUGH);
    scene.addDraw(addCard(scene, square({0, 0, 1}, 1)));
    scene.setCamera(perspective(1, 1, 0.1f, 10) * lookAt({0, 0, 3}, {0, 0, 0}), 64, 64);
    scene.params.maxNonOpaque = 4096;
    GpuOptions options;
    options.method = method;
    EXPECT_EQ(sample(scene, options).bits[0], 12u) << method;
  }
}

// Two levels of detail of one thing, while one fades into the other.
TEST_F(NonOpaqueTest, ACrossFadeShowsBothLevelsOfDetail) {
  Scene fine = sheet(3, 8, 0), coarse = sheet(3, 2, 0);
  const auto offset = static_cast<uint32_t>(fine.positions.size() / 3);
  const auto first = static_cast<uint32_t>(fine.indices.size());
  fine.positions.insert(fine.positions.end(), coarse.positions.begin(), coarse.positions.end());
  fine.indices.insert(fine.indices.end(), coarse.indices.begin(), coarse.indices.end());
  const uint32_t mesh = fine.addMesh(first, offset);
  for (const bool fades : {true, false}) {
    Scene scene = fine;
    const uint32_t flags = fades ? GPGP_DRAW_SEE_THROUGH : 0;
    scene.addDraw(0, glm::mat4(1), flags);
    scene.addDraw(mesh, glm::mat4(1), flags); // in the same plane
    scene.setCamera(perspective(1, 1, 0.1f, 10) * lookAt({0, 0, 3}, {0, 0, 0}), 128, 128);
    scene.params.maxNonOpaque = 4096;
    for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
      GpuOptions options;
      options.method = method;
      const GpuResult result = sample(scene, options);
      EXPECT_EQ(result.report.visible == scene.params.triangleCount, fades) << method;
    }
  }
}

TEST_F(NonOpaqueTest, WithoutRoomTrianglesCountAsVisibleAndHideNothing) {
  for (const uint32_t room : {0u, 10u})
    for (const GpgpSamplingMethod method : {GPGP_SAMPLING_STANDARD, GPGP_SAMPLING_EXACT}) {
      Scene scene = foliage(11, 60, 64, 48, false);
      for (shader::Draw& draw : scene.draws) // textures need room
        if (draw.flags & shader::kAlphaTestBits)
          draw.flags = (draw.flags & ~shader::kAlphaTestBits) | shader::kSeeThrough;
      scene.textures.clear();
      const GpuResult whole = sample(scene, {.method = method});
      ASSERT_EQ(whole.report.base.status, GPGP_SUCCESS);
      ASSERT_GT(whole.report.neededNonOpaque, 60u);
      scene.params.maxNonOpaque = room;
      const GpuResult result = sample(scene, {.method = method});
      EXPECT_EQ(result.report.base.status, GPGP_BUDGET_EXCEEDED);
      EXPECT_EQ(result.report.neededNonOpaque, whole.report.neededNonOpaque);
      for (size_t i = 0; i < whole.bits.size(); ++i) EXPECT_EQ(whole.bits[i] & ~result.bits[i], 0u) << i;
      if (room == 0) expectEqual(result, onCpu(scene, method), "no room");
    }
}

TEST_F(NonOpaqueTest, AnAlphaTestThatIsNotThereIsSkippedAndCounted) {
  Wall wall(GPGP_DRAW_ALPHA_TEST(3));
  const GpuResult result = sample(wall.scene);
  EXPECT_EQ(result.bits[0], 3u);
  EXPECT_EQ(result.report.skippedTriangles, 2u);
}

TEST_F(NonOpaqueTest, FormatsOfTextureCoordinates) {
  Scene scene = foliage(12, 60, 64, 48, false);
  for (float& at : scene.coordinates) at /= 4; // below 1: what unorm16 holds
  const std::vector<uint32_t> expected = sample(scene, {.method = GPGP_SAMPLING_EXACT}).bits;
  const SceneBuffers buffers(device, scene);
  const GpgpAsset set = createGeometrySet(scene);
  upload();
  const GpgpRecorder recorder = createRecorder(256, 256, 0, false, GPGP_SAMPLING_EXACT_BIT, 0, 0, 0, 1, 0, 4096);
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  for (const VkFormat format : {VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16_UNORM}) {
    std::vector<uint32_t> words; // vertices of four words, coordinates from the second or the half of it on
    for (size_t i = 0; i < scene.coordinates.size(); i += 2) {
      const float u = scene.coordinates[i], v = scene.coordinates[i + 1];
      if (format == VK_FORMAT_R32G32_SFLOAT) {
        words.insert(words.end(), {7, std::bit_cast<uint32_t>(u), std::bit_cast<uint32_t>(v), 7});
        continue;
      }
      const auto half = [&](float x) { // exact for multiples of 1/4
        if (format == VK_FORMAT_R16G16_UNORM) return static_cast<uint32_t>(std::lround(x * 65535));
        return x == 0 ? 0u
                      : (std::bit_cast<uint32_t>(x) >> 13 & 0x3ffu) | ((std::bit_cast<uint32_t>(x) >> 23) - 112) << 10;
      };
      words.insert(words.end(), {half(u) << 16, half(v), 7, 7});
    }
    const host::Buffer coordinates = host::makeBuffer(device, words, kStorage);
    const host::Buffer bits(device, expected.size() * 4, kStorage);
    GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
    info.method = GPGP_SAMPLING_EXACT;
    info.textureCoordinates = coordinates.range();
    info.textureCoordinateFormat = format;
    info.textureCoordinateOffset = format == VK_FORMAT_R32G32_SFLOAT ? 4 : 2;
    info.textureCoordinateStride = 16;
    info.visibleBits = bits.range({}, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}});
    const GpgpFrame frame = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    const auto found = host::download<uint32_t>(device, bits, expected.size());
    uint32_t different = 0;
    for (size_t i = 0; i < found.size(); ++i) different += static_cast<uint32_t>(std::popcount(found[i] ^ expected[i]));
    // 1/65535 is not a power of two: places move by less than a texel's hundredth.
    EXPECT_LE(different, format == VK_FORMAT_R16G16_UNORM ? 2u : 0u) << format;
  }
  gpgpDestroyAsset(set);
}

TEST_F(NonOpaqueTest, RefusesWhatCannotBe) {
  Scene scene = foliage(13, 4, 32, 32, false);
  const SceneBuffers buffers(device, scene);
  const GpgpAsset set = createGeometrySet(scene);
  upload();
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const host::Buffer bits(device, 4096, kStorage);
  const GpgpRecorder with = createRecorder(256, 256, 0, false, 0, 0, 0, 0, 1, 0, 4096),
                     without = createRecorder(256, 256);
  const auto refuses = [&](GpgpRecorder recorder, const std::string& message, const auto& change) {
    GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
    std::vector<GpgpAlphaTest> tests = buffers.alphaTests;
    info.alphaTests = tests.data();
    info.visibleBits = bits.range();
    change(info, tests);
    const GpgpFrame frame = advance();
    device.submitAndWait(queue(), [&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, commands, &frame, &info), GPGP_ERROR_INVALID_ARGUMENT);
    });
    EXPECT_NE(lastMessage().find(message), std::string::npos) << lastMessage() << " for " << message;
  };
  using Tests = std::vector<GpgpAlphaTest>;
  refuses(without, "maxNonOpaque 0", [](GpgpVisibilityInfo&, Tests&) {});
  refuses(with, "alphaTestCount is 17", [](GpgpVisibilityInfo& info, Tests&) { info.alphaTestCount = 17; });
  refuses(with, "alphaTests is NULL", [](GpgpVisibilityInfo& info, Tests&) { info.alphaTests = nullptr; });
  refuses(with, "alphaTests[1].view", [](GpgpVisibilityInfo&, Tests& tests) { tests[1].view = VK_NULL_HANDLE; });
  refuses(with, "alphaTests[0].sampler", [](GpgpVisibilityInfo&, Tests& tests) { tests[0].sampler = VK_NULL_HANDLE; });
  refuses(with, "alphaTests[2].layout",
          [](GpgpVisibilityInfo&, Tests& tests) { tests[2].layout = VK_IMAGE_LAYOUT_UNDEFINED; });
  refuses(with, "alphaTests[0].cutoff", [](GpgpVisibilityInfo&, Tests& tests) { tests[0].cutoff = NAN; });
  refuses(with, "textureCoordinateFormat",
          [](GpgpVisibilityInfo& info, Tests&) { info.textureCoordinateFormat = VK_FORMAT_R8_UNORM; });
  refuses(with, "textureCoordinateStride", [](GpgpVisibilityInfo& info, Tests&) { info.textureCoordinateStride = 6; });
  refuses(with, "textureCoordinateOffset", [](GpgpVisibilityInfo& info, Tests&) { info.textureCoordinateOffset = 2; });
  refuses(with, "textureCoordinates.buffer", [](GpgpVisibilityInfo& info, Tests&) { info.textureCoordinates = {}; });
  gpgpDestroyAsset(set);
}

} // namespace
} // namespace gpgp::test
