// Inverse modelling: the search against statistics and closed forms, and optima that are known.
#include "../device_test.h"
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/fit/fit.h"
#include "spawn/schedule/measuring.h"

#include <gpgp/fit.h>
#include <gpgp/gpgp.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;

GpgpFit searchOf(const std::vector<GpgpFitParameter>& parameters, uint32_t candidates, uint32_t rounds) {
  GpgpFit fit = GPGP_FIT_INIT;
  fit.base = spawn::makeAxiom(10, 20, 30, 77);
  fit.parameters = parameters.data();
  fit.parameterCount = static_cast<uint32_t>(parameters.size());
  fit.candidates = candidates;
  fit.rounds = rounds;
  fit.method = GPGP_FIT_ANNEALING;
  fit.seed = 5;
  return fit;
}

TEST(FitTest, DecayIsTheExponential) {
  EXPECT_EQ(spawn::decay(0), 1);
  for (double x = 0; x < 20; x += 0.01) ASSERT_NEAR(spawn::decay(x) / std::exp(-x), 1, 1e-5) << x;
  EXPECT_EQ(spawn::decay(1e9), 0);
  EXPECT_EQ(spawn::decay(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(FitTest, CandidatesStayWithinTheirRanges) {
  const std::vector<GpgpFitParameter> parameters{{GPGP_FIT_SIZE_Y, 5, 9, 0.5f},
                                                 {GPGP_FIT_ATTRIBUTE, -1, 1, 0},
                                                 {GPGP_FIT_SEED, 100, 107, 0},
                                                 {GPGP_FIT_SIZE_X, 2, 2, 1}};
  for (const GpgpFitMethod method : {GPGP_FIT_MONTE_CARLO, GPGP_FIT_ANNEALING}) {
    GpgpFit fit = searchOf(parameters, 300, 12);
    fit.method = method;
    // Standing at (4, 0, 0) and leaning: the foot stays.
    fit.base.transform[3] = 4;
    fit.base.transform[1] = 0.25f;
    fit.base.transform[7] = 10;
    std::vector<GpgpAxiom> axioms(300);
    std::vector<GpgpFitCandidate> current(300);
    const std::vector<double> scores(300, 1);
    std::set<float> heights;
    std::set<uint32_t> seeds;
    uint32_t changed = 0;
    for (uint32_t round = 0; round < 12; ++round) {
      ASSERT_EQ(gpgpProposeAxioms(&fit, round, current.data(), axioms.data()), GPGP_SUCCESS);
      for (uint32_t i = 0; i < 300; ++i) {
        const GpgpAxiom& a = axioms[i];
        ASSERT_EQ(a.id, i);
        ASSERT_EQ(a.size[0], 2);
        ASSERT_EQ(a.size[2], 30);
        ASSERT_GE(a.attribute, -1);
        ASSERT_LE(a.attribute, 1);
        ASSERT_EQ(a.size[1] * 2, std::floor(a.size[1] * 2));
        ASSERT_NEAR(a.transform[7] - a.size[1] / 2, 0, 1e-5);
        ASSERT_NEAR(a.transform[3] - 0.25f * a.size[1] / 2, 4 - 0.25f * 10, 1e-5);
        heights.insert(a.size[1]);
        seeds.insert(a.seed);
        if (round == 0 || method == GPGP_FIT_MONTE_CARLO) continue;
        const GpgpAxiom& before = current[i].axiom;
        changed += a.size[1] != before.size[1] || a.attribute != before.attribute || a.seed != before.seed;
      }
      ASSERT_EQ(gpgpAcceptAxioms(&fit, round, axioms.data(), scores.data(), current.data(), nullptr), GPGP_SUCCESS);
      ASSERT_EQ(std::memcmp(&current[7].axiom, &axioms[7], sizeof axioms[7]), 0); // equal scores are accepted
    }
    if (method == GPGP_FIT_ANNEALING) { // but for what cannot move, or ends where it began
      EXPECT_GT(changed, 11 * 300 * 6 / 10);
    }
    EXPECT_EQ(heights.size(), 9u);
    EXPECT_EQ(*heights.begin(), 5);
    EXPECT_EQ(*heights.rbegin(), 9);
    EXPECT_EQ(seeds.size(), 8u);
    EXPECT_EQ(*seeds.begin(), 100u);
  }
}

TEST(FitTest, WorseOnesAreAcceptedAsMetropolisSays) {
  const std::vector<GpgpFitParameter> parameters{{GPGP_FIT_ATTRIBUTE, 0, 1, 0}};
  constexpr uint32_t kChains = 20000;
  GpgpFit fit = searchOf(parameters, kChains, 2);
  fit.startTemperature = fit.endTemperature = 2;
  std::vector<GpgpAxiom> axioms(kChains);
  for (const double worse : {0.5, 2.0, 6.0}) {
    std::vector<GpgpFitCandidate> current(kChains);
    GpgpFitCandidate best{};
    ASSERT_EQ(gpgpProposeAxioms(&fit, 0, nullptr, axioms.data()), GPGP_SUCCESS);
    ASSERT_EQ(gpgpAcceptAxioms(&fit, 0, axioms.data(), std::vector<double>(kChains, 10).data(), current.data(), &best),
              GPGP_SUCCESS);
    ASSERT_EQ(gpgpProposeAxioms(&fit, 1, current.data(), axioms.data()), GPGP_SUCCESS);
    std::vector<double> scores(kChains, 10 + worse);
    scores[0] = std::numeric_limits<double>::quiet_NaN();
    ASSERT_EQ(gpgpAcceptAxioms(&fit, 1, axioms.data(), scores.data(), current.data(), &best), GPGP_SUCCESS);
    const auto accepted =
        std::count_if(current.begin(), current.end(), [](const GpgpFitCandidate& c) { return c.score > 10; });
    const double p = std::exp(-worse / 2), expected = kChains * p, deviation = std::sqrt(kChains * p * (1 - p));
    EXPECT_NEAR(double(accepted), expected, 4 * deviation);
    EXPECT_EQ(current[0].score, 10);
    EXPECT_EQ(best.score, 10);
  }
}

TEST(FitTest, ChainsComeToTheBoltzmannDistribution) {
  // 16 seeds with an energy each; jumps are symmetric, so a chain's state is as likely as exp(-energy / temperature).
  const std::vector<GpgpFitParameter> parameters{{GPGP_FIT_SEED, 0, 15, 1}};
  constexpr uint32_t kChains = 20000, kRounds = 60;
  GpgpFit fit = searchOf(parameters, kChains, kRounds);
  fit.startTemperature = fit.endTemperature = 1.5f;
  const auto energy = [](uint32_t state) { return double(state * 7 % 16) / 3; };
  std::vector<GpgpAxiom> axioms(kChains);
  std::vector<GpgpFitCandidate> current(kChains);
  std::vector<double> scores(kChains);
  for (uint32_t round = 0; round < kRounds; ++round) {
    ASSERT_EQ(gpgpProposeAxioms(&fit, round, current.data(), axioms.data()), GPGP_SUCCESS);
    for (uint32_t i = 0; i < kChains; ++i) scores[i] = energy(axioms[i].seed);
    ASSERT_EQ(gpgpAcceptAxioms(&fit, round, axioms.data(), scores.data(), current.data(), nullptr), GPGP_SUCCESS);
  }
  std::array<double, 16> found{};
  double sum = 0;
  for (uint32_t state = 0; state < 16; ++state) sum += std::exp(-energy(state) / 1.5);
  for (const GpgpFitCandidate& c : current) found.at(c.axiom.seed) += 1;
  for (uint32_t state = 0; state < 16; ++state) {
    const double p = std::exp(-energy(state) / 1.5) / sum;
    EXPECT_NEAR(found[state], kChains * p, 5 * std::sqrt(kChains * p * (1 - p))) << state;
  }
}

TEST(FitTest, ScoresAreTheSumOfTheirParts) {
  GpgpAxiomMeasures measures{};
  measures.sums[0] = 3 * 65536;
  measures.sums[2] = -65536 / 2;
  measures.occupiedCells = 30;
  measures.matchingCells = 20; // 10 too many, 5 missing
  GpgpFitTarget target{GPGP_STRUCTURE_FIT_TARGET, nullptr, {5, 99, 0.5, 0}, {2, 0, 4, 0}, 3, 25};
  double score = 0;
  ASSERT_EQ(gpgpScoreMeasures(&target, &measures, 1, &score), GPGP_SUCCESS);
  EXPECT_DOUBLE_EQ(score, 2 * 2 + 4 * 1 + 3 * 15 / 25.0);
}

TEST(FitTest, WhatIsNoSearchIsRefused) {
  const std::vector<GpgpFitParameter> good{{GPGP_FIT_SIZE_X, 1, 2, 0}};
  GpgpAxiom axiom{};
  GpgpFitCandidate current{};
  double score = 0;
  const auto codeOf = [&](const GpgpFit& fit, uint32_t round = 0) {
    return gpgpProposeAxioms(&fit, round, nullptr, &axiom);
  };
  const GpgpFit fit = searchOf(good, 1, 2);
  EXPECT_EQ(codeOf(fit), GPGP_SUCCESS);
  EXPECT_EQ(codeOf(fit, 1), GPGP_ERROR_INVALID_ARGUMENT); // no current candidates
  EXPECT_EQ(gpgpProposeAxioms(&fit, 2, &current, &axiom), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpProposeAxioms(nullptr, 0, nullptr, &axiom), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpAcceptAxioms(&fit, 0, &axiom, nullptr, &current, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(gpgpScoreMeasures(nullptr, nullptr, 0, &score), GPGP_ERROR_INVALID_ARGUMENT);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::vector<GpgpFitParameter>> all{{},
                                                       {{5, 0, 1, 0}},
                                                       {{GPGP_FIT_SIZE_X, 0, 1, 0}},
                                                       {{GPGP_FIT_SIZE_X, 2, 1, 0}},
                                                       {{GPGP_FIT_SIZE_X, nan, 1, 0}},
                                                       {{GPGP_FIT_SIZE_X, 1, 2, -1}},
                                                       {{GPGP_FIT_SEED, 0.5f, 3, 1}},
                                                       {{GPGP_FIT_SEED, 0, 16777216.0f, 1}},
                                                       {{GPGP_FIT_SEED, 0, 3, 1}, {GPGP_FIT_SEED, 0, 3, 1}}};
  for (const std::vector<GpgpFitParameter>& bad : all)
    EXPECT_EQ(codeOf(searchOf(bad, 1, 2)), GPGP_ERROR_INVALID_ARGUMENT);
  GpgpFit other = fit;
  other.candidates = 0;
  EXPECT_EQ(codeOf(other), GPGP_ERROR_INVALID_ARGUMENT);
  other = fit;
  other.endTemperature = -1;
  EXPECT_EQ(codeOf(other), GPGP_ERROR_INVALID_ARGUMENT);
  other = fit;
  other.method = 2;
  EXPECT_EQ(codeOf(other), GPGP_ERROR_INVALID_ARGUMENT);
  other = fit;
  other.sType = GPGP_STRUCTURE_FIT_TARGET;
  EXPECT_EQ(codeOf(other), GPGP_ERROR_INVALID_STRUCT);
}

// ---------------------------------------------------------------- known optima, on the device

// A tower whose tiers draw their widths.
const char* const kTower = R"(axiom Box Lot;
terminal Tier (1, 0); terminal Roof (1, 1);
Lot = SubDiv(Y) { -3: Band | -2: Band | -2: Band | ShapeCustomAttribute(): Roof };
Band = Scale(Rand(-0.2, -1), -1, -1) Repeat(Y, 3, ADJUST_TO_FILL) Tier;
)";

struct FitOnDevice : DeviceTest {};

TEST_F(FitOnDevice, TheHiddenBuildingIsFoundAndScoresAreTheCpus) {
  constexpr uint32_t kCandidates = 256, kRounds = 60;
  const auto words = bake(kTower);
  // The hidden one: its silhouette and its volume are all that the search knows.
  GpgpAxiom hidden = spawn::makeAxiom(24, 40, 12, 137);
  hidden.transform[7] = 20;
  hidden.attribute = 4;
  const GpgpMeasure volume{GPGP_ALL_TERMINALS, GPGP_MEASURE_X | GPGP_MEASURE_Y | GPGP_MEASURE_Z};
  std::vector<uint32_t> target(2 * 64), cells(2 * 64);
  const GpgpOccupancy occupancy{{{-16, 0, -100}, {16, 64, 100}}, {64, 64, 1}, target.data()};
  const GpgpMeasureInfo measures{&volume, 1, &occupancy};
  const auto onCpu = [&](const GpgpAxiom& axiom) {
    const auto measuring = spawn::measuringOf(measures, 2);
    std::array<uint32_t, shader::kMeasuredWords> sums{};
    std::fill(cells.begin(), cells.end(), 0u);
    for (const GpgpInstance& i : spawn::derive(words, {&axiom, 1}).instances)
      spawn::measure(*measuring, i, sums.data(), cells.data());
    return spawn::finishMeasures(*measuring, target.data(), sums.data(), cells.data());
  };
  const GpgpAxiomMeasures wanted = onCpu(hidden);
  target = cells;
  ASSERT_GT(wanted.occupiedCells, 500u);
  const GpgpFitTarget aim{GPGP_STRUCTURE_FIT_TARGET, nullptr, {double(wanted.sums[0]) / 65536}, {1.0 / 5000}, 1,
                          wanted.occupiedCells};

  const std::vector<GpgpFitParameter> parameters{{GPGP_FIT_SEED, 0, 255, 1},
                                                 {GPGP_FIT_SIZE_Y, 20, 60, 2},
                                                 {GPGP_FIT_SIZE_Z, 8, 16, 1},
                                                 {GPGP_FIT_ATTRIBUTE, 1, 8, 1}};
  GpgpFit fit = searchOf(parameters, kCandidates, kRounds);
  fit.base = hidden;
  fit.base.size[1] = 10;
  fit.base.transform[7] = 5;
  fit.startTemperature = 0.1f;
  fit.endTemperature = 0.001f;

  GpgpSpawnerCreateInfo create = GPGP_SPAWNER_CREATE_INFO_INIT;
  create.base.queueFamily = device.graphics().family;
  create.maxTerminals = create.maxShapes = 32768;
  create.maxHostAxioms = create.maxMeasuredAxioms = kCandidates;
  create.maxOccupancyWords = 128;
  const GpgpRecorder spawner = recorder(gpgpCreateSpawner, create);
  GpgpGrammarCreateInfo grammarInfo = GPGP_GRAMMAR_CREATE_INFO_INIT;
  grammarInfo.data = words.data();
  grammarInfo.size = words.size() * 4;
  GpgpAsset grammar = nullptr;
  ASSERT_EQ(gpgpCreateGrammar(context, &grammarInfo, &grammar), GPGP_SUCCESS);
  const GpgpFrame first = advance();
  device.submitAndWait(
      [&](VkCommandBuffer cmd) { EXPECT_EQ(gpgpRecordUpload(context, cmd, &first, 0, nullptr), GPGP_SUCCESS); });

  std::vector<GpgpAxiom> proposed(kCandidates);
  std::vector<GpgpFitCandidate> current(kCandidates);
  std::vector<double> scores(kCandidates), again(kCandidates);
  GpgpFitCandidate best{};
  uint32_t round = 0;
  for (; round < kRounds && (round == 0 || best.score > 0); ++round) {
    ASSERT_EQ(gpgpProposeAxioms(&fit, round, current.data(), proposed.data()), GPGP_SUCCESS);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.hostAxioms = proposed.data();
    info.axiomCount = kCandidates;
    info.measures = &measures;
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    ASSERT_EQ(report.base.status, GPGP_SUCCESS);
    ASSERT_EQ(report.axiomCount, kCandidates);
    ASSERT_EQ(gpgpScoreMeasures(&aim, report.axioms, kCandidates, scores.data()), GPGP_SUCCESS);
    if (round % 4 == 0 && device.isSoftware()) // the scores of the CPU, to the bit
      for (uint32_t i = 0; i < kCandidates; i += 5) {
        const GpgpAxiomMeasures own = onCpu(proposed[i]);
        ASSERT_EQ(gpgpScoreMeasures(&aim, &own, 1, &again[i]), GPGP_SUCCESS);
        ASSERT_EQ(scores[i], again[i]) << "round " << round << ", candidate " << i;
      }
    ASSERT_EQ(gpgpAcceptAxioms(&fit, round, proposed.data(), scores.data(), current.data(), &best), GPGP_SUCCESS);
  }
  EXPECT_EQ(best.score, 0) << "after " << round << " rounds";
  EXPECT_EQ(best.axiom.seed, hidden.seed);
  EXPECT_EQ(best.axiom.size[1], hidden.size[1]);
  EXPECT_EQ(best.axiom.size[2], hidden.size[2]);
  EXPECT_EQ(best.axiom.attribute, hidden.attribute);
  EXPECT_EQ(best.axiom.transform[7], hidden.transform[7]);
  gpgpDestroyAsset(grammar);
}
} // namespace
