// L-systems on the device against the CPU reference: strings, counts and keys bit for bit, transforms by tolerance.
#include "host/device.h"
#include "host/memory.h"
#include "lsystem_random.h"
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"

#include <gpgp/lsystem.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gpgp {
namespace {

using namespace spawn::lsystem;
constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

struct Words {
  std::vector<uint32_t> words;
  Table table;
};
Words wordsOf(const std::string& text) {
  spawn::Diagnostics diagnostics;
  auto words = compile(text, {}, diagnostics);
  if (!words) throw std::runtime_error(format(diagnostics.sorted().at(0), "test") + "\n" + text);
  auto table = Table::load(std::as_bytes(std::span(*words)), std::pmr::new_delete_resource());
  if (!table) throw std::runtime_error(table.error().text);
  return {std::move(*words), std::move(*table)};
}

std::vector<GpgpAxiom> axiomsOf(uint32_t count) {
  std::vector<GpgpAxiom> axioms(count);
  for (uint32_t i = 0; i < count; ++i) {
    axioms[i].transform[0] = axioms[i].transform[10] = 2;
    axioms[i].transform[5] = 1;
    axioms[i].transform[3] = static_cast<float>(i);
    axioms[i].seed = 1 + i;
    axioms[i].id = 100 + i;
  }
  return axioms;
}

class LsystemGpu : public testing::Test {
protected:
  struct Result {
    GpgpLsystemReport report;
    std::vector<GpgpInstance> instances;
    std::vector<GpgpLsystemCorner> corners;
    std::vector<GpgpLsystemModule> modules;
    std::vector<float> parameters;
    std::vector<VkDrawIndexedIndirectCommand> draws;
  };

  static void SetUpTestSuite() {
    device_ = std::make_unique<host::HeadlessDevice>(host::DeviceOptions{.validation = true});
    GpgpContextCreateInfo info = device_->contextCreateInfo();
    info.messageFn = [](void*, const GpgpMessage* m) { ADD_FAILURE() << m->function << ": " << m->text; };
    ASSERT_EQ(gpgpCreateContext(&info, &context_), GPGP_SUCCESS);
    recorder_ = make(1u << 15);
  }
  static void TearDownTestSuite() {
    device_->waitIdle();
    gpgpDestroyContext(context_);
    for (const std::string& message : device_->validationMessages()) ADD_FAILURE() << message;
    device_.reset();
  }
  static GpgpRecorder make(uint32_t modules, uint32_t rounds = 64) {
    GpgpLsystemRecorderCreateInfo info = GPGP_LSYSTEM_RECORDER_CREATE_INFO_INIT;
    info.base.queueFamily = device_->graphics().family;
    info.flags = GPGP_LSYSTEM_RECORDER_CONTEXTS;
    info.maxModules = modules;
    info.maxParameters = 2 * modules;
    info.maxSteps = 32;
    info.maxRounds = rounds;
    GpgpRecorder recorder = nullptr;
    EXPECT_EQ(gpgpCreateLsystemRecorder(context_, &info, &recorder), GPGP_SUCCESS);
    EXPECT_EQ(gpgpPrewarm(recorder, nullptr), GPGP_SUCCESS);
    return recorder;
  }
  static GpgpFrame advance() {
    ++frame_;
    const GpgpFrame frame{frame_, frame_ - 1};
    EXPECT_EQ(gpgpAdvance(context_, &frame), GPGP_SUCCESS);
    return frame;
  }

  Result derive(const Words& system, uint32_t iterations, const std::vector<GpgpAxiom>& axioms, GpgpRecorder recorder,
                uint32_t capacity = 1u << 15) {
    GpgpLsystemCreateInfo create = GPGP_LSYSTEM_CREATE_INFO_INIT;
    create.data = system.words.data();
    create.size = system.words.size() * 4;
    GpgpAsset lsystem = nullptr;
    EXPECT_EQ(gpgpCreateLsystem(context_, &create, &lsystem), GPGP_SUCCESS);
    const uint32_t terminals = system.table.count(shader::kLsysSectionTerminals);
    const auto start = host::makeBuffer(*device_, axioms, kStorage);
    const host::Buffer instances(*device_, VkDeviceSize(capacity) * sizeof(GpgpInstance), kStorage);
    const host::Buffer corners(*device_, VkDeviceSize(capacity) * sizeof(GpgpLsystemCorner), kStorage);
    const host::Buffer modules(*device_, VkDeviceSize(capacity) * sizeof(GpgpLsystemModule), kStorage);
    const host::Buffer parameters(*device_, VkDeviceSize(2) * capacity * 4, kStorage);
    const host::Buffer draws(*device_, std::max(terminals, 1u) * sizeof(VkDrawIndexedIndirectCommand), kStorage);
    const host::Buffer count(*device_, 4, kStorage);
    GpgpLsystemInfo info = GPGP_LSYSTEM_INFO_INIT;
    info.lsystem = lsystem;
    info.axioms = start.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.iterations = iterations ? iterations : GPGP_LSYSTEM_NO_ITERATIONS;
    info.instances = instances.range();
    info.corners = corners.range();
    info.modules = modules.range();
    info.parameters = parameters.range();
    info.draws = draws.range();
    info.count = count.range();
    const GpgpFrame frame = advance();
    device_->submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context_, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(gpgpRecordPrepareLsystem(recorder, commands, &frame, &info), GPGP_SUCCESS);
    });
    advance();
    Result r;
    r.report = GPGP_LSYSTEM_REPORT_INIT;
    EXPECT_EQ(gpgpGetLsystemReport(recorder, &r.report), GPGP_SUCCESS);
    r.instances = host::download<GpgpInstance>(*device_, instances, r.report.instancesWritten);
    r.corners = host::download<GpgpLsystemCorner>(*device_, corners, r.report.cornersWritten);
    r.modules = host::download<GpgpLsystemModule>(*device_, modules, std::min(r.report.modules, capacity));
    r.parameters = host::download<float>(*device_, parameters, std::min(r.report.parameters, 2 * capacity));
    r.draws = host::download<VkDrawIndexedIndirectCommand>(*device_, draws, terminals);
    EXPECT_EQ(host::download<uint32_t>(*device_, count, 1)[0], r.report.instancesWritten);
    gpgpDestroyAsset(lsystem);
    return r;
  }

  /// Where both derive the same; false otherwise, with a failure.
  bool agrees(const Words& system, uint32_t iterations, const std::vector<GpgpAxiom>& axioms, GpgpRecorder recorder,
              const Limits& limits, float tolerance = 1e-4f) {
    const Derived derived = spawn::lsystem::derive(system.table, axioms, iterations, limits);
    const Drawn drawn = draw(system.table, derived.string, axioms);
    const Result r = derive(system, iterations, axioms, recorder);
    EXPECT_EQ(r.report.steps, derived.steps);
    EXPECT_EQ(r.report.modules, derived.string.modules.size());
    EXPECT_EQ(r.report.parameters, derived.string.parameters.size());
    EXPECT_EQ(r.report.modulesNeeded, derived.modulesNeeded);
    EXPECT_EQ(r.report.parametersNeeded, derived.parametersNeeded);
    const auto hash = hashOf(system.table, derived.string);
    EXPECT_EQ(r.report.stringHash[0], hash[0]);
    EXPECT_EQ(r.report.stringHash[1], hash[1]);
    EXPECT_EQ(r.report.instances, drawn.instances.size());
    EXPECT_EQ(r.report.corners, drawn.corners.size());
    EXPECT_EQ(r.report.depth, drawn.depth);
    EXPECT_EQ(r.report.unfinishedBranches, 0u);
    EXPECT_EQ(r.report.base.status, derived.complete ? GPGP_SUCCESS : GPGP_BUDGET_EXCEEDED);
    if (testing::Test::HasFailure()) return false;
    EXPECT_EQ(std::memcmp(r.modules.data(), derived.string.modules.data(), r.modules.size() * 16), 0);
    if (!r.parameters.empty()) {
      EXPECT_EQ(std::memcmp(r.parameters.data(), derived.string.parameters.data(), r.parameters.size() * 4), 0);
    }
    float extent = 1, worst = 0;
    uint32_t at = 0;
    for (size_t t = 0; t < r.draws.size(); ++t) {
      EXPECT_EQ(r.draws[t].firstInstance, at);
      for (uint32_t i = 0; i < r.draws[t].instanceCount; ++i) EXPECT_EQ(drawn.instances.at(at + i).terminal, t);
      at += r.draws[t].instanceCount;
    }
    EXPECT_EQ(at, r.instances.size());
    for (size_t i = 0; i < r.instances.size(); ++i) {
      const GpgpInstance &a = drawn.instances[i], &b = r.instances[i];
      EXPECT_TRUE(a.key[0] == b.key[0] && a.key[1] == b.key[1] && a.terminal == b.terminal && a.bucket == b.bucket &&
                  a.shape == b.shape && a.axiomId == b.axiomId && a.seed == b.seed && a.rule == b.rule)
          << i;
      for (int c = 0; c < 12; ++c) {
        extent = std::max(extent, std::abs(a.transform[c]));
        worst = std::max(worst, std::abs(a.transform[c] - b.transform[c]));
      }
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.size[c] - b.size[c]));
      worst = std::max(worst, std::abs(a.attribute - b.attribute));
    }
    for (size_t i = 0; i < r.corners.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(drawn.corners[i][c] - r.corners[i].position[c]));
      worst = std::max(worst, std::abs(drawn.corners[i][3] - r.corners[i].width));
    }
    EXPECT_LE(worst, tolerance * extent);
    return !testing::Test::HasFailure();
  }

  static inline std::unique_ptr<host::HeadlessDevice> device_; // its pipelines are compiled once
  static inline GpgpContext context_ = nullptr;
  static inline GpgpRecorder recorder_ = nullptr;
  static inline uint64_t frame_ = 0;
  static constexpr Limits kLimits{1u << 15, 1u << 16};
};

TEST_F(LsystemGpu, SamplesEqualTheReference) {
  for (const auto& file : std::filesystem::directory_iterator(GPGP_SAMPLE_LSYSTEMS)) {
    std::stringstream text;
    text << std::ifstream(file.path()).rdbuf();
    const Words system = wordsOf(text.str());
    for (uint32_t iterations = 0; iterations <= std::min(system.table.head(shader::kLsysHeadIterations), 5u);
         ++iterations)
      ASSERT_TRUE(agrees(system, iterations, axiomsOf(1), recorder_, kLimits)) << file.path() << ' ' << iterations;
    ASSERT_TRUE(agrees(system, 2, axiomsOf(5), recorder_, kLimits)) << file.path();
  }
}

TEST_F(LsystemGpu, RandomSystemsEqualTheReference) {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    const test::PlainSystem plain = test::randomSystem(random);
    const Words system = wordsOf(
        plain.text() +
        (i % 2 ? "homomorphism:\nA(x) --> {F.f}~l(x)\nB --> @Gs F @Gc [ ! @Gs @Ge ] @Ge\nC(x,y) --> ' F(x) +(y) \n"
               : ""));
    ASSERT_TRUE(agrees(system, static_cast<uint32_t>(plain.iterations), axiomsOf(1 + i % 4), recorder_, kLimits, 2e-3f))
        << plain.text();
  }
}

TEST_F(LsystemGpu, FunctionsAndDrawsEqualTheReference) {
  const Words system =
      wordsOf("axiom: A(1.5, 0.3) B(2) C(0)\niterations: 6\n"
              "A(x,y) --> A(sin(x*50)+tan(y), atan2(y,x)/9) F(exp(y)+log(1+x^2)) [ +(rand(-9,9)) B(sqrt(x*x+y*y)) ]\n"
              "B(x) : rand() < 0.5 --> B(nran(x,0.1)) C(floor(x*3)%4) : x\n"
              "B(x) --> C(ceil(x)^1.5) B(min(x,max(0.1,asin(x/9)))) : 0.5\n"
              "C(x) : x > 1 && !(x == 3) || x < 0 --> C(x > 2 ? x-1 : acos(x/8)/30) F(abs(x)+round(x)*sign(x))\n");
  for (uint32_t iterations = 1; iterations <= 6; ++iterations)
    ASSERT_TRUE(agrees(system, iterations, axiomsOf(7), recorder_, kLimits)) << iterations;
}

TEST_F(LsystemGpu, DeepBracketsTakeTwoDigits) {
  // 300 brackets within each other, and back out again
  std::string axiom = "axiom: ";
  for (int i = 0; i < 300; ++i) axiom += i % 3 ? "[F" : "[+";
  for (int i = 0; i < 300; ++i) axiom += "]";
  ASSERT_TRUE(agrees(wordsOf(axiom + "\nangle: 3\niterations: 1\nF --> FF\n"), 1, axiomsOf(2), recorder_, kLimits));
}

TEST_F(LsystemGpu, WalkingAndScanningDrawTheSame) {
  const std::string text = "axiom: A\nangle: 25\niterations: 5\nA --> F[+A'][&A!]/F{f.f}A\n";
  const auto axioms = axiomsOf(2);
  const Result scanned = derive(wordsOf(text), 5, axioms, recorder_);
  const Result walked = derive(wordsOf(text + "B --> T\n"), 5, axioms, recorder_);
  ASSERT_EQ(scanned.instances.size(), walked.instances.size());
  ASSERT_EQ(scanned.corners.size(), walked.corners.size());
  for (size_t i = 0; i < scanned.instances.size(); ++i)
    for (int c = 0; c < 12; ++c)
      ASSERT_NEAR(scanned.instances[i].transform[c], walked.instances[i].transform[c], 1e-3) << i;
}

TEST_F(LsystemGpu, WhatDoesNotFitIsCounted) {
  const Words system = wordsOf("axiom: F\niterations: 12\nF --> F[+F]F\n");
  const GpgpRecorder small = make(1000, 2);
  ASSERT_TRUE(agrees(system, 12, axiomsOf(1), small, {1000, 2000}));
  // Instances that do not fit: the first ones are written.
  const Result cut = derive(system, 4, axiomsOf(1), recorder_, 50);
  EXPECT_EQ(cut.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(cut.report.instances, 81u);
  EXPECT_EQ(cut.report.instancesWritten, 50u);
  EXPECT_EQ(cut.draws[0].instanceCount, 50u);
  // Axioms that do not fit
  const Result none = derive(system, 1, axiomsOf(400), small);
  EXPECT_EQ(none.report.modules, 0u);
  EXPECT_EQ(none.report.modulesNeeded, 1600u);
  EXPECT_EQ(none.report.base.status, GPGP_BUDGET_EXCEEDED);
  // Walkers that end too early
  const Result walked =
      derive(wordsOf("axiom: F[+F[+F[+F]]]\ntropism: 0 -1 0 0.1\niterations: 0\n"), 0, axiomsOf(1), small);
  EXPECT_EQ(walked.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_GT(walked.report.unfinishedBranches, 0u);
}

TEST_F(LsystemGpu, NothingIsDrawnOfNothing) {
  const Words system = wordsOf("axiom:\niterations: 3\nF --> FF\n");
  ASSERT_TRUE(agrees(system, 3, axiomsOf(3), recorder_, kLimits));
  EXPECT_EQ(derive(system, 3, axiomsOf(3), recorder_).report.modules, 9u);
}

} // namespace
} // namespace gpgp
