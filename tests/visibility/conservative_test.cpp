// Conservative sampling: its parts against double precision and closed forms, its properties, and the GPU against the
// CPU reference bit for bit.
#include "gpu.h"
#include "measured_scenes.h"
#include "visibility/conservative/conservative.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <random>

namespace gpgp::test {
namespace {
using namespace visibility;
using shader::ScreenTriangle;

constexpr uint32_t kThesis = GPGP_HEURISTICS_DEFAULT, kFront = kThesis | GPGP_HEURISTIC_KEEP_FRONT;

void setHeuristics(Scene& scene, uint32_t heuristics, float epsilonStatic, float epsilonDynamic) {
  scene.params.heuristics = heuristics;
  scene.params.epsilonStatic = epsilonStatic;
  scene.params.epsilonDynamic = epsilonDynamic;
}

uint32_t countOf(const std::vector<uint32_t>& bits) {
  uint32_t count = 0;
  for (const uint32_t word : bits) count += static_cast<uint32_t>(std::popcount(word));
  return count;
}
uint32_t missingOf(const std::vector<uint32_t>& wanted, const std::vector<uint32_t>& bits) {
  uint32_t count = 0;
  for (size_t i = 0; i < wanted.size(); ++i) count += static_cast<uint32_t>(std::popcount(wanted[i] & ~bits[i]));
  return count;
}

Scene columns(uint32_t width = 96, uint32_t height = 54) {
  Scene scene = colonnadeWithWires(0.3f);
  setWalkingCamera(scene, {0.3f, 1.7f, 3}, {0, 1.5f, -10}, width, height, true);
  return scene;
}
Scene leaves() {
  Scene scene = foliage(1500);
  setWalkingCamera(scene, {1, 1.7f, 7}, {0, 1.5f, 0}, 80, 45, true);
  return scene;
}
/// A parallel projection onto the scene from above.
Scene fromAbove(bool reversed) {
  Scene scene = city(3);
  glm::mat4 m(0.0f);
  m[0][0] = 0.02f;
  m[2][1] = 0.02f;
  m[1][2] = reversed ? 0.005f : -0.005f;
  m[3] = glm::vec4(-0.3f, -0.3f, reversed ? 0.1f : 0.9f, 1);
  scene.setCamera(m, 64, 64, reversed);
  return scene;
}

// Depths of a triangle's part in a pixel: against points all over the pixel, in double precision.
TEST(Conservative, DepthsInAPixelBoundThoseOfItsPoints) {
  std::mt19937 random(5);
  const shader::Grid grid = shader::middleGrid({64, 64}, 8);
  uint32_t compared = 0;
  for (int n = 0; n < 3000; ++n) {
    const int reach = n % 3 == 0 ? 200 : n % 3 == 1 ? 2000 : 300000;
    const auto number = [&] { return 8192 + static_cast<int>(random() % static_cast<uint32_t>(2 * reach)) - reach; };
    glm::ivec2 a(number(), number()), b(number(), number()), c(number(), number());
    const int turn = wideSign(shader::twiceArea(a, b, c));
    if (turn == 0) continue;
    if (turn < 0) std::swap(b, c);
    glm::vec3 w;
    for (int i = 0; i < 3; ++i) w[i] = 1 + float(random() % 1000) * 0.1f;
    const ScreenTriangle t = shader::makeTriangle(a, b, c, 0.1f, 0.2f, 0.3f, grid);
    const glm::ivec2 pixel(32, 32);
    float nearest = 0, farthest = 0;
    const bool found = depthsInPixel(t, inOrderOf(t, a, b, 1.0f / w), pixel, true, false, nearest, farthest);
    double low = 1e9, high = 0;
    const glm::dvec2 da(a), db(b), dc(c);
    const double area = (db.x - da.x) * (dc.y - da.y) - (db.y - da.y) * (dc.x - da.x);
    for (int y = 0; y <= 256; y += 2)
      for (int x = 0; x <= 256; x += 2) {
        const glm::dvec2 p(8192 + x, 8192 + y);
        const double u = ((p.x - da.x) * (dc.y - da.y) - (p.y - da.y) * (dc.x - da.x)) / area;
        const double v = ((db.x - da.x) * (p.y - da.y) - (db.y - da.y) * (p.x - da.x)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const double depth = 1 / ((1 - u - v) / double(w.x) + u / double(w.y) + v / double(w.z));
        low = std::min(low, depth), high = std::max(high, depth);
      }
    if (high == 0) continue;
    ++compared;
    ASSERT_TRUE(found) << n;
    EXPECT_LE(nearest, low * 1.0001) << n;
    EXPECT_GE(farthest, high * 0.9999) << n;
    // Nor much farther apart: of a triangle as large as the pixel what lies between the points is little.
    if (reach == 300000) {
      EXPECT_GE(nearest, low * 0.99) << n;
      EXPECT_LE(farthest, high * 1.01) << n;
    }
  }
  EXPECT_GT(compared, 300u);
}

TEST(Conservative, InCirclesAreMeasuredInPixels) {
  const shader::Grid grid = shader::middleGrid({64, 64}, 8);
  // Sides 3, 4 and 5 have an in-circle of radius 1.
  for (const auto& [scale, large] : {std::pair{255, false}, {256, false}, {257, true}})
    EXPECT_EQ(isLarge(shader::makeTriangle({0, 0}, {4 * scale, 0}, {0, 3 * scale}, 0, 0, 0, grid)), large) << scale;
  EXPECT_FALSE(isLarge(shader::makeTriangle({0, 0}, {60000, 0}, {0, 500}, 0, 0, 0, grid))) << "a sliver";
}

TEST(Conservative, NormalsHaveLengthOneOrNone) {
  const glm::vec3 n = shader::normalOf({1, 2, 3}, {4, 2, 3}, {1, 7, 3});
  EXPECT_EQ(n, glm::vec3(0, 0, 1));
  const glm::vec3 tiny = shader::normalOf({0, 0, 0}, {1e-12f, 0, 0}, {0, 0, 1e-9f});
  EXPECT_EQ(tiny, glm::vec3(0, -1, 0));
  EXPECT_EQ(shader::normalOf({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), glm::vec3(0));
  EXPECT_EQ(shader::normalOf({0, 0, 0}, {INFINITY, 1, 1}, {2, 0, 2}), glm::vec3(0));
  const glm::vec3 any = shader::normalOf({0.3f, 1, 9}, {-4, 2, 7}, {5, 5, 1});
  EXPECT_NEAR(glm::length(any), 1, 1e-6f);
  EXPECT_NEAR(std::abs(glm::dot(any, glm::normalize(glm::cross(glm::vec3(-4.3f, 1, -2), {4.7f, 4, -8})))), 1, 1e-6f);
}

// Equations 6.2 to 6.4 with numbers: a surface at depths 5 to 6.
TEST(Conservative, EpsilonSaysHowFarDepthsMayLieApart) {
  const shader::Surface s{5, 6, 0, 0, 1};
  const glm::vec3 same(0, 0, -1), across(1, 0, 0);
  EXPECT_TRUE(acceptsDepths(s, 5.5f, 7, same, kThesis, 0, 0)) << "overlap";
  EXPECT_TRUE(acceptsDepths(s, 6.4f, 7, same, kThesis, 0.5f, 0));
  EXPECT_FALSE(acceptsDepths(s, 6.6f, 7, same, kThesis, 0.5f, 9));
  EXPECT_TRUE(acceptsDepths(s, 6.6f, 7, across, kThesis, 0.5f, 0.2f));
  EXPECT_FALSE(acceptsDepths(s, 3, 4.4f, same, kThesis, 0.5f, 0)) << "too far in front, as the thesis has it";
  EXPECT_TRUE(acceptsDepths(s, 3, 4.4f, same, kFront, 0.5f, 0));
  EXPECT_FALSE(acceptsDepths(s, 6.6f, 7, same, kFront, 0.5f, 0));
}

TEST(Conservative, CoverageOfAPixelIsThatOfItsSamples) {
  std::mt19937 random(6);
  for (int n = 0; n < 2000; ++n) {
    const int reach = n % 2 ? 600 : 90000;
    const auto number = [&] { return 8192 + static_cast<int>(random() % static_cast<uint32_t>(2 * reach)) - reach; };
    const glm::ivec2 a(number(), number()), b(number(), number()), c(number(), number());
    if (wideSign(shader::twiceArea(a, b, c)) <= 0) continue;
    const ScreenTriangle t = shader::makeTriangle(a, b, c, 0, 0, 0, shader::middleGrid({64, 64}, 8));
    const glm::uvec2 mask = coverageOf(t, {32, 32});
    for (int i = 0; i < 64; ++i)
      ASSERT_EQ(((i < 32 ? mask.x >> i : mask.y >> (i - 32)) & 1) != 0,
                coversWide(t, 0, {8192 + i % 8 * 32 + 16, 8192 + i / 8 * 32 + 16}))
          << n;
  }
}

TEST(Conservative, FindsWhatTheThesisSaysItFinds) {
  Scene scene = columns();
  std::vector<uint32_t> sizes;
  const std::vector<uint32_t> reference = referenceOnCpu(scene.input(), 64, sizes).bits;
  const std::vector<uint32_t> standard = sampleOnCpu(scene.input()).bits;
  const double all = countOf(reference);
  const auto run = [&](uint32_t heuristics, float epsilon, uint32_t refinements = 0) {
    setHeuristics(scene, heuristics, epsilon, epsilon);
    const std::vector<uint32_t> bits = sampleConservativelyOnCpu(scene.input(), refinements).bits;
    EXPECT_EQ(missingOf(standard, bits), 0u) << "what is seen at a centre stays";
    return bits;
  };
  const auto found = [&](const std::vector<uint32_t>& bits) { return 1 - missingOf(reference, bits) / all; };
  const auto extra = [&](const std::vector<uint32_t>& bits) { return missingOf(bits, reference) / all; };
  const auto raw = run(0, 0), strict = run(kThesis, 0.05f), loose = run(kThesis, 2), front = run(kFront, 0.05f);
  EXPECT_EQ(found(raw), 1) << "every triangle that touches a pixel";
  EXPECT_GT(extra(raw), extra(loose));
  EXPECT_GT(found(strict), found(standard) + 0.1);
  EXPECT_GE(found(loose), found(strict)) << "more with a larger epsilon";
  EXPECT_GT(extra(loose), extra(strict));
  EXPECT_GT(found(front), found(strict)) << "wires in front";
  // The in-circle takes away only triangles; so does the depth.
  EXPECT_EQ(missingOf(strict, run(GPGP_HEURISTIC_DEPTH, 0.05f)), 0u);
  EXPECT_EQ(missingOf(strict, run(GPGP_HEURISTIC_IN_CIRCLE, 0.05f)), 0u);
  // Gaps: each pass adds triangles that are seen, and hardly any other.
  const auto one = run(kThesis, 0.05f, 1), four = run(kThesis, 0.05f, 4);
  EXPECT_EQ(missingOf(strict, one), 0u);
  EXPECT_EQ(missingOf(one, four), 0u);
  EXPECT_GT(found(one), found(strict));
  EXPECT_LT(extra(four), extra(strict) + 0.03);
}

// After refinement every sample that some triangle covers is covered by a visible one, once there are enough passes.
TEST(Conservative, RefinementClosesGaps) {
  Scene scene = leaves();
  setHeuristics(scene, kThesis, 0, 0);
  const CpuInput in = scene.input();
  const auto openSamples = [&](uint32_t refinements) {
    const std::vector<uint32_t> bits = sampleConservativelyOnCpu(in, refinements).bits;
    std::vector<glm::uvec2> covered(80 * 45), coverable(80 * 45);
    forEachTriangle(in, [&](const shader::DrawEntry& e, uint32_t local, uint32_t) {
      const uint32_t id = in.draws[e.draw].firstTriangle + local;
      for (const ScreenTriangle& t : placeTriangle(in, e, local).pieces) {
        const glm::ivec4 b = pixelBounds(t.p0, t.p1, t.p2, gridOf(in.params));
        for (int y = b.y; y < b.w; ++y)
          for (int x = b.x; x < b.z; ++x) {
            const glm::uvec2 own = coverageOf(t, {x, y});
            const size_t at = size_t(y) * 80 + size_t(x);
            coverable[at] |= own;
            if (bits[id / 32] >> (id % 32) & 1) covered[at] |= own;
          }
      }
    });
    uint32_t open = 0;
    for (size_t i = 0; i < covered.size(); ++i)
      open += static_cast<uint32_t>(std::popcount(coverable[i].x & ~covered[i].x) +
                                    std::popcount(coverable[i].y & ~covered[i].y));
    return open;
  };
  uint32_t before = openSamples(0);
  const uint32_t start = before;
  EXPECT_GT(before, 1000u);
  for (const uint32_t refinements : {1u, 2u, 4u, 8u, 32u}) {
    const uint32_t open = openSamples(refinements);
    EXPECT_LT(open, before) << refinements; // each shows a triangle in every quarter of a pixel with a gap
    if (refinements == 4) {                 // as many as a record offers
      EXPECT_LT(open * 20, start);
    }
    before = open;
  }
  EXPECT_EQ(before, 0u);
}

TEST_F(VisibilityGpuTest, ConservativeEqualsTheCpuReference) {
  const GpgpRecorder recorder =
      createRecorder(128, 96, 0, true, GPGP_SAMPLING_CONSERVATIVE_BIT, 0, 0, 0, 2); // one for all: 20 kernels
  struct Case {
    std::string name;
    Scene scene;
    uint32_t heuristics;
    float epsilon;
    uint32_t refinements;
  };
  std::vector<Case> cases;
  cases.push_back({"raw", columns(), 0, 0, 0});
  cases.push_back({"thesis", columns(), kThesis, 0.05f, 0});
  cases.push_back({"refined", columns(), kThesis, 0.05f, 2});
  cases.push_back({"front", leaves(), kFront, 0.05f, 4});
  cases.push_back({"parallel", fromAbove(false), kThesis, 0.001f, 1});
  cases.push_back({"parallel, reversed", fromAbove(true), kFront, 0.001f, 1});
  for (uint32_t seed = 0; seed < 4; ++seed)
    cases.push_back({"soup " + std::to_string(seed), randomSoup(seed, 40 + 80 * seed, 100, 90, seed % 2, seed % 3 == 0),
                     seed == 1 ? 0 : GPGP_HEURISTIC_DEPTH, 0.5f, seed});
  cases.push_back({"bad input", randomSoup(7, 200, 90, 90, true, false), GPGP_HEURISTIC_DEPTH, 0.5f, 2});
  Scene& bad = cases.back().scene;
  bad.positions[10] = NAN, bad.positions[100] = INFINITY, bad.positions[200] = 3e38f;
  bad.indices[50] = 0xffffffffu, bad.indices[61] = bad.indices[62] = bad.indices[60];
  cases.push_back({"one pixel", columns(1, 1), 0, 0, 2});
  cases.push_back({"stereo", columns(61, 45), kFront, 0.05f, 1});
  cases.back().scene.addCamera(perspective(1.0f, 61.0f / 45, 0.1f, 100.0f, true) *
                               lookAt({0.7f, 1.7f, 3}, {0.7f, 1.5f, -10}));
  for (Case& c : cases) {
    setHeuristics(c.scene, c.heuristics, c.epsilon, c.epsilon);
    const CpuResult cpu = sampleConservativelyOnCpu(c.scene.input(), c.refinements);
    const GpgpAsset set = createGeometrySet(c.scene);
    const GpuResult gpu =
        sample(c.scene, recorder, set, {.method = GPGP_SAMPLING_CONSERVATIVE, .refinements = c.refinements});
    expectEqual(gpu, cpu, c.name);
    EXPECT_GT(cpu.counters.visible, 5u) << c.name;
    gpgpDestroyAsset(set);
  }
  // Half the resolution is a smaller viewport.
  Scene scene = columns(48, 27);
  setHeuristics(scene, kThesis, 0.05f, 0.05f);
  const CpuResult cpu = sampleConservativelyOnCpu(scene.input());
  expectEqual(sample(scene, recorder, createGeometrySet(scene),
                     {.method = GPGP_SAMPLING_CONSERVATIVE, .width = 96, .height = 54, .resolution = 0.5f}),
              cpu, "half");
  // What the record says is checked.
  const GpgpAsset set = createGeometrySet(scene);
  const SceneBuffers buffers(device, scene);
  const host::Buffer bits(device, 65536, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  upload();
  const GpgpFrame f = advance();
  const auto refuse = [&](const char* text, auto change) {
    GpgpVisibilityInfo info = sampleInfo(scene, buffers, set);
    info.visibleBits = bits.range();
    info.method = GPGP_SAMPLING_CONSERVATIVE;
    change(info);
    messages.clear();
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT) << text;
    });
    ASSERT_EQ(messages.size(), 1u) << text;
    EXPECT_NE(messages[0].find(text), std::string::npos) << messages[0];
  };
  refuse("resolution is 0.2", [](auto& i) { i.resolution = 0.2f; });
  refuse("resolution is", [](auto& i) { i.resolution = NAN; });
  refuse("heuristics is 0x8", [](auto& i) { i.heuristics = 8; });
  refuse("epsilonStatic", [](auto& i) { i.epsilonDynamic = -1; });
  refuse("refinements is 5", [](auto& i) { i.refinements = 5; });
}

} // namespace
} // namespace gpgp::test
