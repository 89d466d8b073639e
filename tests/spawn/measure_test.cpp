// What is measured of axioms: on the CPU against closed forms, and read back from the GPU against the CPU.
#include "grammars.h"
#include "host/memory.h"
#include "random_grammar.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/schedule/measuring.h"
#include "spawner_test.h"

#include <gpgp/evaluator.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

// Rows of windows on a wall, and a value that every wall says.
const char* const kWall = R"(axiom Box A;
terminal Window (1, 0); terminal Wall (1, 1);
A = SubDiv(Y) { -1: Repeat(X, 2, ADJUST_TO_FILL) Window | -2: SetAttribute(-0.75) Wall };
)";

Evaluator evaluatorOf(const std::string& text) {
  auto source = init<GpgpGrammarSource>();
  source.name = "grammar.pga";
  source.text = text.data();
  source.size = text.size();
  auto info = init<GpgpEvaluatorCreateInfo>();
  info.sources = &source;
  info.sourceCount = 1;
  auto evaluator = Evaluator::create(info);
  EXPECT_TRUE(evaluator);
  return std::move(*evaluator);
}

std::vector<GpgpAxiomMeasures> onCpu(const std::string& text, const std::vector<GpgpAxiom>& axioms,
                                     const GpgpMeasureInfo& measures, uint32_t ranges = 3) {
  const Evaluator evaluator = evaluatorOf(text);
  auto evaluation = evaluator.evaluation();
  auto info = init<GpgpEvaluationInfo>();
  info.axioms = axioms.data();
  info.axiomCount = static_cast<uint32_t>(axioms.size());
  info.measures = &measures;
  info.rangeCount = ranges;
  EXPECT_EQ(evaluation->derive(info), GPGP_SUCCESS);
  const auto result = evaluation->result();
  EXPECT_NE(result->measures, nullptr);
  return {result->measures, result->measures + result->axiomCount};
}

// ---------------------------------------------------------------- numbers

int64_t wide(shader::uvec2 words) { return static_cast<int64_t>(uint64_t(words.y) << 32 | words.x); }

TEST(MeasureTest, FixedPointIsTheValueCutOff) {
  std::mt19937 random(1);
  std::vector<float> values{0,       -0.0f,    1,     -1, 0.5f, 1.0f / 65536, 0.99f / 65536, -0.99f / 65536,
                            8388608, -8388608, 1e-40f};
  for (int i = 0; i < 100000; ++i)
    values.push_back(std::ldexp(float(int32_t(random())), int(random() % 60) - 52)); // up to 2^38
  for (const float value : values) {
    const double most = 8388608.0;
    const double clamped = std::clamp(double(value), -most, most);
    ASSERT_EQ(wide(shader::fixedOf(value)), int64_t(clamped * 65536)) << value;
    ASSERT_EQ(shader::measuresTooMuch(value), std::abs(double(value)) > most) << value;
  }
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(wide(shader::fixedOf(nan)), 0);
  EXPECT_TRUE(shader::measuresTooMuch(nan));
  EXPECT_EQ(wide(shader::fixedOf(-infinity)), -(int64_t(1) << 39));
  EXPECT_TRUE(shader::measuresTooMuch(infinity));
}

TEST(MeasureTest, CellsAreThoseWhoseCentresLieBetween) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-3, 13);
  for (int i = 0; i < 20000; ++i) {
    const uint32_t cells = 2 + uint32_t(random() % 70);
    float low = place(random), high = place(random);
    if (low > high) std::swap(low, high);
    const float perMetre = float(cells) / 10.0f;
    const shader::uvec2 range = shader::cellsBetween(low, high, 0, perMetre, cells);
    std::vector<uint32_t> words((cells + 31) / 32);
    if (range.x <= range.y)
      for (uint32_t word = range.x / 32; word <= range.y / 32; ++word)
        words[word] |= shader::cellBits(word, range.x, range.y);
    for (uint32_t c = 0; c < cells; ++c) {
      const double centre = (c + 0.5) / cells * 10;
      if (std::min(std::abs(centre - low), std::abs(centre - high)) < 1e-5) continue;
      ASSERT_EQ(words[c / 32] >> c % 32 & 1, centre > low && centre < high) << low << ' ' << high << ' ' << c;
    }
  }
  EXPECT_EQ(shader::cellsBetween(11, 12, 0, 0.1f, 1).x, 1u); // beyond a single cell
  EXPECT_EQ(shader::cellsBetween(2, 2.1f, 0, 0.1f, 1).x, 0u);
}

TEST(MeasureTest, SumsBoxesAndCellsOfAWall) {
  // 6 wide, 3 high, 2 deep: 3 windows of 2 x 1 x 2 below, a wall of 6 x 2 x 2 above.
  std::vector<GpgpAxiom> axioms{spawn::makeAxiom(6, 3, 2, 1, 5), spawn::makeAxiom(6, 3, 2, 2, 6)};
  axioms[1].transform[3] = 100;
  const GpgpMeasure measures[4] = {{0, 0},
                                   {GPGP_ALL_TERMINALS, GPGP_MEASURE_X | GPGP_MEASURE_Y},
                                   {1, GPGP_MEASURE_ATTRIBUTE},
                                   {0, GPGP_MEASURE_X | GPGP_MEASURE_Y | GPGP_MEASURE_Z}};
  // Cells of 1 m, seen along z; the target is the lower half of the left 5 columns.
  std::array<uint32_t, 4> target{0x1f, 0x1f, 0, 0};
  const GpgpOccupancy occupancy{{{-4, -2, -50}, {4, 2, 50}}, {8, 4, 1}, target.data()};
  const GpgpMeasureInfo info{measures, 4, &occupancy};
  const auto found = onCpu(kWall, axioms, info);
  ASSERT_EQ(found.size(), 2u);
  for (uint32_t a = 0; a < 2; ++a) {
    EXPECT_EQ(found[a].terminals, 4u);
    EXPECT_EQ(found[a].clamped, 0u);
    EXPECT_EQ(found[a].sums[0], 3 * 65536);
    EXPECT_EQ(found[a].sums[1], 18 * 65536);
    EXPECT_EQ(found[a].sums[2], -3 * 65536 / 4);
    EXPECT_EQ(found[a].sums[3], 12 * 65536);
    EXPECT_EQ(found[a].bounds.min[0], (a ? 100 : 0) - 3);
    EXPECT_EQ(found[a].bounds.max[1], 1.5f);
    EXPECT_EQ(found[a].bounds.max[2], 1);
  }
  // Centres at -3.5 .. 3.5 and -1.5 .. 1.5: 6 x 4 are within, of the target columns 1 to 4 in two rows.
  EXPECT_EQ(found[0].occupiedCells, 24u);
  EXPECT_EQ(found[0].matchingCells, 8u);
  EXPECT_EQ(found[1].occupiedCells, 0u);
}

TEST(MeasureTest, WhatNeverComesIsAnEmptyBox) {
  const GpgpMeasureInfo info{};
  const auto found = onCpu("axiom Box A;\nterminal T (1, 0);\nA = Discard();\n", {spawn::makeAxiom(1, 1, 1)}, info);
  EXPECT_EQ(found[0].terminals, 0u);
  EXPECT_EQ(found[0].bounds.min[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(found[0].bounds.max[2], -std::numeric_limits<float>::infinity());
}

TEST(MeasureTest, WhatIsWrongIsSaid) {
  GpgpMeasure measure{7, 0};
  uint32_t target = 0;
  GpgpOccupancy grid{{{0, 0, 0}, {1, 1, 1}}, {8, 1, 1}, &target};
  const auto codeOf = [](const GpgpMeasureInfo& info) {
    const auto made = spawn::measuringOf(info, 2);
    return made ? std::string() : std::string(made.error().text);
  };
  EXPECT_NE(codeOf({&measure, 1, nullptr}).find("terminal is 7"), std::string::npos);
  measure = {1, 16};
  EXPECT_NE(codeOf({&measure, 1, nullptr}).find("unknown bits"), std::string::npos);
  EXPECT_NE(codeOf({&measure, 5, nullptr}).find("at most 4"), std::string::npos);
  EXPECT_NE(codeOf({nullptr, 1, nullptr}).find("NULL"), std::string::npos);
  EXPECT_EQ(codeOf({nullptr, 0, &grid}), "");
  grid.cells[0] = 0;
  EXPECT_NE(codeOf({nullptr, 0, &grid}).find("0 x 1 x 1"), std::string::npos);
  const uint32_t tooMany[3] = {0xffffffffu, 0xffffffffu, 0xffffffffu};
  std::copy_n(tooMany, 3, grid.cells);
  EXPECT_NE(codeOf({nullptr, 0, &grid}).find("1024 words"), std::string::npos);
  const uint32_t large[3] = {33, 513, 1};
  std::copy_n(large, 3, grid.cells);
  EXPECT_NE(codeOf({nullptr, 0, &grid}).find("1024 words"), std::string::npos);
  grid.cells[1] = 512;
  EXPECT_EQ(codeOf({nullptr, 0, &grid}), "");
  grid.box.max[1] = 0;
  EXPECT_NE(codeOf({nullptr, 0, &grid}).find("axis 1"), std::string::npos);
  grid.target = nullptr;
  EXPECT_NE(codeOf({nullptr, 0, &grid}).find("target is NULL"), std::string::npos);
}

// ---------------------------------------------------------------- on the device

struct MeasuresTest : SpawnerTest {
  GpgpSpawnerCreateInfo budgets() {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.queueFamily = device.graphics().family;
    info.maxShapes = info.maxTerminals = 16384;
    info.maxMeasuredAxioms = 64;
    info.maxOccupancyWords = 256;
    info.maxHostAxioms = 64;
    return info;
  }
  GpgpAsset load(GpgpRecorder spawner, const std::string& text, bool kernel = false) {
    const std::string baked = bakedFile({"grammar.pga", text}, kernel ? GPGP_COMPILE_KERNEL : 0).text;
    return SpawnerTest::load(spawner, baked.data(), baked.size());
  }
  GpgpSpawnReport derive(GpgpRecorder spawner, const GpgpSpawnInfo& info) {
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS) << lastMessage();
    });
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_NOT_READY); // the frame is not safe yet: nothing waits
    advance();
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    return report;
  }
  static GpgpSpawnInfo infoOf(GpgpAsset grammar, const std::vector<GpgpAxiom>& axioms,
                              const GpgpMeasureInfo& measures) {
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.hostAxioms = axioms.data();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.measures = &measures;
    return info;
  }
};

/// exactBoxes: of software devices, whose transforms are the CPU's; else boxes and cells agree to rounding.
void expectEqual(const GpgpSpawnReport& report, const std::vector<GpgpAxiomMeasures>& expected, bool exactBoxes) {
  ASSERT_EQ(report.axiomCount, expected.size());
  for (uint32_t a = 0; a < report.axiomCount; ++a) {
    const GpgpAxiomMeasures &g = report.axioms[a], &c = expected[a];
    ASSERT_EQ(g.terminals, c.terminals) << "axiom " << a;
    ASSERT_EQ(g.clamped, c.clamped) << "axiom " << a;
    for (int m = 0; m < GPGP_MAX_MEASURES; ++m) ASSERT_EQ(g.sums[m], c.sums[m]) << "axiom " << a << ", measure " << m;
    if (exactBoxes) {
      ASSERT_EQ(std::memcmp(&g.bounds, &c.bounds, sizeof g.bounds), 0) << "axiom " << a;
      ASSERT_EQ(g.occupiedCells, c.occupiedCells) << "axiom " << a;
      ASSERT_EQ(g.matchingCells, c.matchingCells) << "axiom " << a;
    } else if (c.terminals) {
      for (int axis = 0; axis < 3; ++axis) {
        const float near = 1e-4f * (1 + std::max(std::abs(c.bounds.min[axis]), std::abs(c.bounds.max[axis])));
        ASSERT_NEAR(g.bounds.min[axis], c.bounds.min[axis], near);
        ASSERT_NEAR(g.bounds.max[axis], c.bounds.max[axis], near);
      }
      ASSERT_NEAR(double(g.occupiedCells), double(c.occupiedCells), 2 + 0.01 * c.occupiedCells);
    }
  }
}

/// Measures that every grammar has, and a grid around `reach` metres with a target of stripes.
struct Asked {
  std::array<GpgpMeasure, 4> measures{{{GPGP_ALL_TERMINALS, GPGP_MEASURE_X | GPGP_MEASURE_Y | GPGP_MEASURE_Z},
                                       {0, 0},
                                       {GPGP_ALL_TERMINALS, GPGP_MEASURE_ATTRIBUTE | GPGP_MEASURE_X},
                                       {0, GPGP_MEASURE_Y | GPGP_MEASURE_ATTRIBUTE}}};
  std::vector<uint32_t> target;
  GpgpOccupancy occupancy{};
  GpgpMeasureInfo info{};
  explicit Asked(float reach) {
    occupancy = {{{-reach, -reach, -reach}, {reach, reach, reach}}, {40, 12, 8}, nullptr};
    for (uint32_t word = 0; word < 2 * 12 * 8; ++word) target.push_back(word * 0x9e3779b9u);
    occupancy.target = target.data();
    info = {measures.data(), 4, &occupancy};
  }
  Asked(const Asked&) = delete;
};

std::vector<GpgpAxiom> someAxioms(uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> size(1, 12), place(-20, 20), angle(0, 6.28f);
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < count; ++i) {
    GpgpAxiom axiom = spawn::makeAxiom(size(random), size(random), size(random), uint32_t(random() % 1000), i);
    const float a = angle(random), c = std::cos(a), s = std::sin(a);
    const float rows[12] = {c, 0, s, place(random), 0, 1, 0, place(random), -s, 0, c, place(random)};
    std::copy_n(rows, 12, axiom.transform);
    if (i % 3) axiom.attribute = place(random);
    axioms.push_back(axiom);
  }
  return axioms;
}

TEST_F(MeasuresTest, ReadBackEqualsTheCpuInEveryKindOfRecording) {
  const Asked asked(24);
  const auto axioms = someAxioms(40, 3);
  const auto expected = onCpu(kTown, axioms, asked.info);
  EXPECT_GT(expected[0].terminals, 0u);
  GpgpVertexLayout layout{};
  layout.stride = 16;
  layout.attributeCount = 1;
  layout.attributes[0] = {GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0};
  const host::Buffer out(device, 8u << 20, kStorage), draws(device, 4096, kStorage);
  host::fill(device, draws, 0);
  const std::pair<const char*, GpgpSpawnerFlags> kinds[] = {
      {"plain", 0}, {"ordered", GPGP_SPAWNER_ORDERED}, {"compact", GPGP_SPAWNER_COMPACT}, {"vertices", 1u << 31}};
  for (const auto& [name, flags] : kinds)
    for (const bool writes : {true, false})
      for (const bool kernel : {false, true}) {
        const bool vertices = flags >> 31 & 1;
        if (vertices && !writes) continue;
        if (kernel && flags) continue; // kernels are the same for all
        SCOPED_TRACE(std::string(name) + (writes ? ", written" : ", only measured") + (kernel ? ", kernel" : ""));
        GpgpSpawnerCreateInfo create = budgets();
        create.maxColliders = flags ? 0 : 4096; // with the other tests' pipelines
        create.flags = flags & ~(GpgpSpawnerFlags(1) << 31);
        if (vertices) create.vertices = &layout;
        const GpgpRecorder spawner = spawnerOf(create);
        const GpgpAsset grammar = load(spawner, kTown, kernel);
        GpgpSpawnInfo info = infoOf(grammar, axioms, asked.info);
        GpgpVertexOutput output{};
        output.vertices = out.range();
        output.indexType = VK_INDEX_TYPE_UINT32;
        if (vertices) info.vertices = &output;
        if (!vertices && writes) {
          info.instances = out.range();
          info.draws = draws.range();
        }
        const GpgpSpawnReport report = derive(spawner, info);
        EXPECT_EQ(report.base.status, GPGP_SUCCESS);
        expectEqual(report, expected, device.isSoftware());
        uint64_t terminals = 0;
        for (const GpgpAxiomMeasures& axiom : expected) terminals += axiom.terminals;
        EXPECT_EQ(report.terminals, terminals);
        EXPECT_EQ(report.instancesWritten, vertices || !writes ? 0 : terminals);
        gpgpDestroyAsset(grammar);
      }
}

TEST_F(MeasuresTest, RandomGrammars) {
  GpgpSpawnerCreateInfo create = budgets();
  create.maxColliders = 4096;
  const GpgpRecorder spawner = spawnerOf(create);
  const Asked asked(20);
  uint32_t tried = 0, matching = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    const std::string text = randomGrammar(seed);
    SCOPED_TRACE(text);
    const auto axioms = someAxioms(12, seed);
    const auto whole = spawn::derive(bake(text), axioms);
    if (!whole.complete || whole.terminals > 12000 || whole.droppedShapes || whole.unfinishedShapes) continue;
    const auto expected = onCpu(text, axioms, asked.info);
    const GpgpAsset grammar = load(spawner, text);
    const GpgpSpawnReport report = derive(spawner, infoOf(grammar, axioms, asked.info));
    EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    expectEqual(report, expected, device.isSoftware());
    ++tried;
    for (const GpgpAxiomMeasures& axiom : expected) matching += axiom.matchingCells;
    gpgpDestroyAsset(grammar);
  }
  EXPECT_GT(tried, 40u);
  EXPECT_GT(matching, 1000u);
}

TEST_F(MeasuresTest, EachRecordingInFlightHasItsOwn) {
  GpgpSpawnerCreateInfo create = budgets();
  create.maxColliders = 4096;
  const GpgpRecorder spawner = spawnerOf(create);
  const GpgpAsset grammar = load(spawner, kTown);
  const Asked asked(24);
  std::vector<std::vector<GpgpAxiom>> lists;
  for (uint32_t i = 0; i < 6; ++i) lists.push_back(someAxioms(5 + 7 * i, 90 + i));
  uint32_t taken = 0;
  for (uint32_t frame = 0; frame < 8; ++frame) {
    const GpgpFrame f = advance(2); // two frames in flight
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    while (gpgpGetSpawnReport(spawner, &report) == GPGP_SUCCESS) {
      EXPECT_EQ(report.base.tag, taken);
      expectEqual(report, onCpu(kTown, lists[taken], asked.info), device.isSoftware());
      ++taken;
    }
    if (frame == 1) {
      EXPECT_EQ(taken, 0u); // the first frame may still run
    }
    if (frame >= 6) continue;
    device.submitAndWait([&](VkCommandBuffer cmd) {
      GpgpSpawnInfo info = infoOf(grammar, lists[frame], asked.info);
      info.base.tag = frame;
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS) << lastMessage();
    });
  }
  EXPECT_EQ(taken, 6u);

  // What was never submitted has none, and what measures nothing neither.
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  GpgpSpawnInfo info = infoOf(grammar, lists[0], asked.info);
  const GpgpFrame f = advance();
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.queueFamilyIndex = device.graphics().family;
  VkCommandPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(device.vk().vkCreateCommandPool(device.device(), &poolInfo, nullptr, &pool), VK_SUCCESS);
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool;
  allocate.commandBufferCount = 1;
  VkCommandBuffer dropped = VK_NULL_HANDLE;
  ASSERT_EQ(device.vk().vkAllocateCommandBuffers(device.device(), &allocate, &dropped), VK_SUCCESS);
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  ASSERT_EQ(device.vk().vkBeginCommandBuffer(dropped, &begin), VK_SUCCESS);
  EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, dropped, &f, &info), GPGP_SUCCESS);
  device.vk().vkDestroyCommandPool(device.device(), pool, nullptr);
  advance();
  ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.base.status, GPGP_NOT_EXECUTED);
  EXPECT_EQ(report.axioms, nullptr);
  EXPECT_EQ(report.axiomCount, 0u);
  const host::Buffer out(device, 96 * 16384, kStorage);
  info.measures = nullptr;
  info.instances = out.range();
  EXPECT_EQ(derive(spawner, info).axiomCount, 0u);
  gpgpDestroyAsset(grammar);
}

TEST_F(MeasuresTest, BudgetsThatAreTooSmallAreSaid) {
  GpgpSpawnerCreateInfo create = budgets();
  create.maxTerminals = 50;
  create.maxMeasuredAxioms = 40;
  create.maxOccupancyWords = 2 * 12 * 8;
  const GpgpRecorder spawner = spawnerOf(create);
  const GpgpAsset grammar = load(spawner, kTown);
  const Asked asked(24);
  const auto axioms = someAxioms(40, 3);
  const GpgpSpawnReport report = derive(spawner, infoOf(grammar, axioms, asked.info));
  EXPECT_EQ(report.base.status, GPGP_BUDGET_EXCEEDED);
  uint64_t measured = 0;
  for (uint32_t a = 0; a < report.axiomCount; ++a) measured += report.axioms[a].terminals;
  EXPECT_EQ(measured, 50u);
  EXPECT_GT(report.terminals, 50u); // the size that would have fitted

  const auto refused = [&](const GpgpSpawnInfo& info, const char* what, GpgpRecorder by) {
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareSpawn(by, cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
    });
    EXPECT_NE(lastMessage().find(what), std::string::npos) << lastMessage();
  };
  const auto many = someAxioms(41, 4);
  GpgpSpawnInfo info = infoOf(grammar, many, asked.info);
  refused(info, "maxMeasuredAxioms 40", spawner);
  info.axiomCount = 40;
  Asked larger(24);
  larger.target.resize(193);
  larger.occupancy.target = larger.target.data();
  const uint32_t cells[3] = {32, 193, 1};
  std::copy_n(cells, 3, larger.occupancy.cells);
  info.measures = &larger.info;
  refused(info, "maxOccupancyWords 192", spawner);
  info.measures = &asked.info;
  const host::Buffer out(device, 96 * 64, kStorage);
  info.instances = info.ranges = out.range();
  refused(info, "ranges.buffer", spawner);
  info.ranges = {};
  info.draws = out.range();
  info.flags = GPGP_SPAWN_REGIONS;
  refused(info, "GPGP_SPAWN_REGIONS", spawner);
  create = budgets();
  create.maxOccupancyWords = 1025;
  GpgpRecorder none = nullptr;
  EXPECT_EQ(gpgpCreateSpawner(context, &create, &none), GPGP_ERROR_INVALID_ARGUMENT);
  create = budgets();
  create.maxMeasuredAxioms = (1u << 20) + 1;
  EXPECT_EQ(gpgpCreateSpawner(context, &create, &none), GPGP_ERROR_INVALID_ARGUMENT);
  gpgpDestroyAsset(grammar);
}
} // namespace
