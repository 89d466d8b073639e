// Level of detail within a budget: the search against costs of known forms, against the real wood and town, and on the
// device, whose reports come frames later.
#include "grammars.h"
#include "host/memory.h"
#include "spawn/detail/detail.h"
#include "spawner_test.h"
#include "walk_scene.h"

#include <gpgp/gpgp.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Cost = std::function<double(double detail)>;

GpgpDetailBudget timeBudget() {
  GpgpDetailBudget budget = GPGP_DETAIL_BUDGET_INIT;
  budget.milliseconds = 1;
  return budget;
}
GpgpDetailBudget instanceBudget(uint32_t instances) {
  GpgpDetailBudget budget = GPGP_DETAIL_BUDGET_INIT;
  budget.instances = instances;
  return budget;
}

/// Frames of a camera that stands still: details, and costs in parts of the budget.
struct Stay {
  std::vector<float> details;
  std::vector<double> costs;

  /// From then on nothing changes.
  size_t settled() const {
    size_t frame = details.size();
    while (frame && details[frame - 1] == details.back()) --frame;
    return frame;
  }
  size_t mostExceededInARow() const {
    size_t most = 0, row = 0;
    for (const double cost : costs) most = std::max(most, row = cost > 1 ? row + 1 : 0);
    return most;
  }
};

Stay stay(const GpgpDetailBudget& budget, const Cost& cost, GpgpDetail& state, int frames) {
  Stay stay;
  for (int i = 0; i < frames; ++i) {
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    report.detail = state.detail;
    stay.details.push_back(state.detail);
    stay.costs.push_back(cost(state.detail));
    EXPECT_GE(gpgpAdaptDetail(&budget, &report, stay.costs.back(), &state), GPGP_SUCCESS);
  }
  return stay;
}
GpgpDetail begun(const GpgpDetailBudget& budget) {
  GpgpDetail state{};
  EXPECT_EQ(gpgpAdaptDetail(&budget, nullptr, 0, &state), GPGP_SUCCESS);
  return state;
}

/// What the header promises of where it ends.
void expectEnd(const Cost& cost, float detail, float most = 1) {
  EXPECT_LE(cost(detail), 1);
  EXPECT_TRUE(cost(detail) >= 0.9 || detail == most || cost(detail * 1.0405) > 1)
      << detail << " costs " << cost(detail);
}

TEST(DetailTest, PowersAreThoseOfTheMathLibrary) {
  for (double x = 1e-6; x < 1e6; x *= 1.0137) ASSERT_NEAR(spawn::logarithm(x), std::log2(x), 1e-7) << x;
  for (double x = -100; x < 100; x += 0.0137) ASSERT_NEAR(spawn::power(x) / std::exp2(x), 1, 1e-6) << x;
}

/// Costs with an elasticity of at least 1/2 between any detail that exceeds the budget and what is within it: a cut is
/// followed by one frame at most that exceeds it, and a few frames later nothing changes any more.
TEST(DetailTest, SmoothCostsSettleInAFewFramesAndNeverExceedTwice) {
  std::mt19937 random(7);
  const auto from = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto power = [&]() -> Cost {
    const double p = from(0.6, 4), k = std::exp(from(-6, 6));
    return [=](double d) { return k * std::pow(d, p); };
  };
  const auto square = [&]() -> Cost {
    const double base = from(0, 0.8), k = std::exp(from(-6, 6));
    return [=](double d) { return base + k * d * d; };
  };
  for (const auto& make : {std::function<Cost()>(power), std::function<Cost()>(square)}) {
    double frames = 0;
    int cuts = 0;
    for (int i = 0; i < 3000; ++i) {
      const Cost before = make(), after = make();
      const GpgpDetailBudget budget = timeBudget();
      if (before(1.0 / 64) > 1 || after(1.0 / 64) > 1) continue;
      GpgpDetail state = begun(budget);
      const Stay first = stay(budget, before, state, 40);
      EXPECT_LE(first.mostExceededInARow(), 1u);
      if (first.settled() >= 38) continue; // few; they are counted below
      const Stay second = stay(budget, after, state, 40);
      EXPECT_LE(second.mostExceededInARow(), 1u);
      if (second.settled() >= 38) continue;
      expectEnd(before, first.details.back());
      // Another view of nearly the same cost is not told from this one.
      if (std::abs(after(first.details.back()) / before(first.details.back()) - 1) > 0.06)
        expectEnd(after, second.details.back());
      frames += static_cast<double>(second.settled());
      ++cuts;
    }
    EXPECT_GT(cuts, 1900);
    EXPECT_LT(frames / cuts, 5);
  }
}

/// Whatever rises: steps and cliffs settle as well, and what exceeds the budget twice goes to the least detail.
TEST(DetailTest, AnyCostThatRisesSettles) {
  std::mt19937 random(9);
  const auto from = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::pair<double, double>> steps;
    for (int s = 0; s < 8; ++s) steps.emplace_back(std::exp(from(-4, 0.1)), std::exp(from(-4, 0.7)));
    const Cost cost = [=](double d) {
      double sum = 0.2 * std::sqrt(d);
      for (const auto& [at, more] : steps) sum += d >= at ? more : 0;
      return sum;
    };
    const GpgpDetailBudget budget = timeBudget();
    GpgpDetail state{};
    state.detail = static_cast<float>(from(1.0 / 64, 1));
    const Stay all = stay(budget, cost, state, 50);
    EXPECT_LE(all.mostExceededInARow(), cost(1.0 / 64) > 1 ? 50u : 2u);
    EXPECT_LT(all.settled(), 40u);
    if (cost(1.0 / 64) > 1) continue;
    expectEnd(cost, all.details.back());
    // Once it has settled, what exceeded it is never tried again.
    EXPECT_LE(*std::max_element(all.costs.begin() + 40, all.costs.end()), 1);
  }
}

TEST(DetailTest, TheEndDoesNotDependOnTheBeginning) {
  const Cost cost = [](double d) { return 0.3 + 2 * d * d; };
  const GpgpDetailBudget budget = timeBudget();
  for (float begin = 1.0f / 64; begin <= 1; begin *= 1.1f) {
    GpgpDetail state{};
    state.detail = begin;
    const Stay all = stay(budget, cost, state, 20);
    EXPECT_LE(all.settled(), 10u);
    EXPECT_GE(all.costs.back(), 0.9);
    EXPECT_LE(all.costs.back(), 1);
  }
}

/// Reports come two frames later, and those of before a change are not mistaken for those behind it.
TEST(DetailTest, LateReportsChangeNothingTwice) {
  const GpgpDetailBudget budget = timeBudget();
  const Cost near = [](double d) { return 8 * d * d; }, far = [](double d) { return 0.5 * d; };
  for (const size_t late : {1u, 2u, 3u}) {
    GpgpDetail state = begun(budget);
    std::vector<std::pair<float, double>> sent; // details and costs
    size_t changes = 0;
    float last = state.detail;
    for (int frame = 0; frame < 160; ++frame) {
      const Cost& cost = frame < 80 ? near : far;
      sent.emplace_back(state.detail, cost(state.detail));
      if (sent.size() <= late) continue;
      GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
      report.detail = sent[sent.size() - 1 - late].first;
      ASSERT_EQ(gpgpAdaptDetail(&budget, &report, sent[sent.size() - 1 - late].second, &state), GPGP_SUCCESS);
      changes += state.detail != last;
      last = state.detail;
      if (frame == 79) {
        EXPECT_NEAR(std::sqrt(0.95 / 8), state.detail, 0.02);
      }
    }
    EXPECT_EQ(state.detail, 1); // all of it is within the budget
    EXPECT_LE(changes, 12u);
  }
}

TEST(DetailTest, TimesMayVaryByAFewPercent) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(1, 0.01);
  const GpgpDetailBudget budget = timeBudget();
  GpgpDetail state = begun(budget);
  stay(
      budget, [&](double d) { return 3 * d * d * noise(random); }, state, 20);
  const Stay all = stay(
      budget, [&](double d) { return 3 * d * d * noise(random); }, state, 400);
  const auto [least, most] = std::minmax_element(all.details.begin(), all.details.end());
  EXPECT_LT(*most / *least, 1.1f);
  EXPECT_LE(all.mostExceededInARow(), 1u);
}

TEST(DetailTest, EveryBudgetCounts) {
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  report.terminals = 50;
  report.vertices = 600;
  report.peakShapes = 7000;
  GpgpDetailBudget budget = GPGP_DETAIL_BUDGET_INIT;
  budget.instances = 100;
  EXPECT_EQ(spawn::costOf(budget, report, 3), 0.5);
  budget.vertices = 1000;
  EXPECT_EQ(spawn::costOf(budget, report, 3), 0.6);
  budget.shapes = 10000;
  EXPECT_EQ(spawn::costOf(budget, report, 3), 0.7);
  budget.milliseconds = 4;
  EXPECT_EQ(spawn::costOf(budget, report, 3), 0.75);
  report.base.status = GPGP_BUDGET_EXCEEDED; // of something else
  EXPECT_EQ(spawn::costOf(budget, report, 3), 2);
  budget.instances = 10;
  EXPECT_EQ(spawn::costOf(budget, report, 3), 5);
}

TEST(DetailTest, SaysWhatIsWrong) {
  GpgpDetailBudget budget = instanceBudget(100);
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  GpgpDetail state{};
  const auto adapted = [&](double milliseconds = 0) { return gpgpAdaptDetail(&budget, &report, milliseconds, &state); };
  EXPECT_EQ(gpgpAdaptDetail(nullptr, &report, 0, &state), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpAdaptDetail(&budget, &report, 0, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(adapted(), GPGP_SUCCESS);
  report.sType = GPGP_STRUCTURE_SPAWN_INFO;
  EXPECT_EQ(adapted(), GPGP_ERROR_INVALID_STRUCT);
  report = GPGP_SPAWN_REPORT_INIT;
  budget.sType = GPGP_STRUCTURE_SPAWN_INFO;
  EXPECT_EQ(adapted(), GPGP_ERROR_INVALID_STRUCT);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto wrong = [&](const std::function<void()>& spoil) {
    budget = instanceBudget(100);
    state = {};
    spoil();
    EXPECT_EQ(adapted(nan), GPGP_ERROR_INVALID_ARGUMENT);
  };
  wrong([&] { budget.instances = 0; });
  wrong([&] { budget.minDetail = -1; });
  wrong([&] { budget.maxDetail = nan; });
  wrong([&] { budget.minDetail = 2; });
  wrong([&] { budget.milliseconds = 1; }); // but none are given
  wrong([&] { budget.milliseconds = nan; });
  wrong([&] { state.detail = nan; });
  // The least detail exceeds the budget: it stays, and says so.
  budget = instanceBudget(100);
  state = begun(budget);
  report.detail = state.detail;
  report.terminals = 101;
  EXPECT_EQ(adapted(), GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(state.detail, 1.0f / 64);
  report.base.status = GPGP_NOT_EXECUTED;
  EXPECT_EQ(adapted(), GPGP_SUCCESS);
  report.base.status = GPGP_ERROR_UNSUPPORTED;
  EXPECT_EQ(adapted(), GPGP_SUCCESS);
  EXPECT_EQ(state.exceeded, 1u);
}

// ---------------------------------------------------------------- the wood and the town

std::vector<Place> places() { return walkPlaces(GPGP_WORLD); }

TEST(DetailOnEvaluator, DetailIsTheHeightOfThePicture) {
  for (const Place& place : places()) {
    WalkScene scene(place.file, {}, place.axioms);
    const Eye eye = place.walk(0.4f);
    uint64_t first = 0, before = 0;
    for (const float detail : {0.25f, 0.5f, 1.0f, 2.0f}) {
      const GpgpEvaluationResult all = scene.derive(eye, detail);
      const uint32_t hash[2] = {all.keyHash[0], all.keyHash[1]};
      const uint64_t terminals = all.terminals;
      EXPECT_GE(terminals, before) << place.name;
      before = terminals;
      if (!first) first = terminals;
      const GpgpEvaluationResult scaled = scene.derive(eye, 1, static_cast<uint32_t>(kHeight * detail));
      EXPECT_EQ(scaled.terminals, terminals);
      EXPECT_EQ(scaled.keyHash[0], hash[0]);
      EXPECT_EQ(scaled.keyHash[1], hash[1]);
    }
    EXPECT_GT(before, first) << place.name;
  }
}

TEST(DetailOnEvaluator, AWalkStaysWithinItsBudget) {
  for (const Place& place : places()) {
    SCOPED_TRACE(place.name);
    WalkScene scene(place.file, {}, place.axioms);
    const GpgpDetailBudget budget = instanceBudget(place.budget);
    GpgpDetail state = begun(budget);
    uint32_t exceeded = 0, row = 0, limited = 0, most = 0;
    double used = 0, step = 1;
    constexpr int kFrames = 600;
    for (int frame = 0; frame < kFrames; ++frame) {
      GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
      report.detail = state.detail;
      report.terminals =
          static_cast<uint32_t>(scene.derive(place.walk(float(frame) / kFrames), state.detail).terminals);
      row = report.terminals > place.budget ? row + 1 : 0;
      exceeded += row > 0;
      most = std::max(most, row);
      if (state.detail < 1) {
        ++limited;
        used += double(report.terminals) / place.budget;
      }
      ASSERT_EQ(gpgpAdaptDetail(&budget, &report, 0, &state), GPGP_SUCCESS);
      if (frame < 20 || row || report.detail == 1 || state.detail == 1) continue;
      step = std::max({step, double(state.detail / report.detail), double(report.detail / state.detail)});
    }
    EXPECT_LE(most, 1u);
    EXPECT_LE(exceeded, 2u); // of 600
    EXPECT_LE(step, 1.3);    // where nothing is exceeded
    EXPECT_GT(limited, 100u);
    EXPECT_GT(used / limited, 0.9);
    RecordProperty(std::string(place.name) + "_exceeded", static_cast<int>(exceeded));
    RecordProperty(std::string(place.name) + "_limited", static_cast<int>(limited));
  }
}

TEST(DetailOnEvaluator, CutsSettleInAFewFrames) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(0, 1);
  for (const Place& place : places()) {
    SCOPED_TRACE(place.name);
    WalkScene scene(place.file, {}, place.axioms);
    const GpgpDetailBudget budget = instanceBudget(place.budget);
    GpgpDetail state = begun(budget);
    size_t frames = 0, cuts = 0;
    for (int cut = 0; cut < 30; ++cut) {
      const Eye eye = place.walk(anywhere(random));
      const Cost cost = [&](double detail) {
        return double(scene.derive(eye, static_cast<float>(detail)).terminals) / place.budget;
      };
      Stay all;
      for (int i = 0; i < 24; ++i) {
        GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
        report.detail = state.detail;
        report.terminals = static_cast<uint32_t>(scene.derive(eye, state.detail).terminals);
        all.details.push_back(state.detail);
        all.costs.push_back(double(report.terminals) / place.budget);
        ASSERT_EQ(gpgpAdaptDetail(&budget, &report, 0, &state), GPGP_SUCCESS);
      }
      EXPECT_LE(all.mostExceededInARow(), 1u);
      EXPECT_LE(all.settled(), 16u); // where the first view hardly depends on the detail
      expectEnd(cost, state.detail);
      frames += all.settled();
      ++cuts;
    }
    EXPECT_LE(frames, 3 * cuts);
  }
}

// ---------------------------------------------------------------- on the device

struct DetailOnDevice : SpawnerTest {};

TEST_F(DetailOnDevice, ReportsSayWhichDetailTheyAreOf) {
  const Place place = places()[0];
  const std::string text = textOf(place.file);
  const auto words = bake(text);
  GpgpSpawnerCreateInfo create = GPGP_SPAWNER_CREATE_INFO_INIT;
  create.base.queueFamily = device.graphics().family;
  create.maxShapes = create.maxTerminals = 16384;
  create.maxHostAxioms = 64;
  const GpgpRecorder spawner = spawnerOf(create);
  const GpgpAsset grammar = load(spawner, words.data(), words.size() * 4);
  const host::Buffer instances(device, sizeof(GpgpInstance) * 16384, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  WalkScene scene(place.file, {}, place.axioms);
  const GpgpDetailBudget budget = instanceBudget(place.budget);
  GpgpDetail state = begun(budget);
  uint32_t reports = 0;
  float exceeding = 0; // the last detail, if it did
  const Eye eye = place.walk(0.9f);
  for (int frame = 0; frame < 40; ++frame) {
    GpgpSpawnCamera camera = scene.cameraOf(eye, state.detail);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.hostAxioms = place.axioms.data();
    info.axiomCount = static_cast<uint32_t>(place.axioms.size());
    info.instances = instances.range();
    info.camera = &camera;
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS) << lastMessage();
    });
    for (GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT; gpgpGetSpawnReport(spawner, &report) == GPGP_SUCCESS;) {
      EXPECT_EQ(report.terminals, scene.derive(eye, report.detail).terminals);
      const bool exceeds = report.terminals > place.budget;
      EXPECT_TRUE(!exceeds || exceeding == 0 || exceeding == report.detail) << "twice: " << report.detail;
      exceeding = exceeds ? report.detail : 0;
      ++reports;
      ASSERT_EQ(gpgpAdaptDetail(&budget, &report, 0, &state), GPGP_SUCCESS);
    }
  }
  EXPECT_GT(reports, 36u);
  EXPECT_EQ(exceeding, 0);
  expectEnd(
      [&](double detail) { return double(scene.derive(eye, static_cast<float>(detail)).terminals) / place.budget; },
      state.detail);
  // Without a camera, and with a detail that is none.
  const auto with = [&](const GpgpSpawnCamera* camera, GpgpResult expected) {
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.hostAxioms = place.axioms.data();
    info.axiomCount = 1;
    info.instances = instances.range();
    info.camera = camera;
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), expected) << lastMessage();
    });
  };
  with(nullptr, GPGP_SUCCESS);
  advance();
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  while (gpgpGetSpawnReport(spawner, &report) == GPGP_SUCCESS) {
  }
  EXPECT_EQ(report.detail, 1);
  GpgpSpawnCamera wrong = scene.cameraOf(eye, -1);
  with(&wrong, GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("detail is -1"), std::string::npos) << lastMessage();
  gpgpDestroyAsset(grammar);
}

} // namespace
