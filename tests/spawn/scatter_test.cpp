// Scattered points: how near they come, how little room they leave, and that rectangles of one pattern fit together.
#include <gpgp/scatter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace {

GpgpScatterInfo infoOf(float distance, float minX, float minZ, float maxX, float maxZ, uint32_t seed = 1) {
  GpgpScatterInfo info = GPGP_SCATTER_INFO_INIT;
  for (const int i : {0, 5, 10}) info.base.transform[i] = 1;
  for (float& extent : info.base.size) extent = 2;
  info.distance = distance;
  info.seed = seed;
  info.min[0] = minX;
  info.min[1] = minZ;
  info.max[0] = maxX;
  info.max[1] = maxZ;
  return info;
}

std::vector<GpgpAxiom> scattered(const GpgpScatterInfo& info) {
  uint32_t count = 0;
  EXPECT_EQ(gpgpScatterAxioms(&info, &count, nullptr), GPGP_SUCCESS);
  std::vector<GpgpAxiom> axioms(count);
  EXPECT_EQ(gpgpScatterAxioms(&info, &count, axioms.data()), GPGP_SUCCESS);
  EXPECT_EQ(count, axioms.size());
  return axioms;
}

/// Bytes of all, in an order of their own.
std::vector<std::string> sorted(const std::vector<GpgpAxiom>& axioms) {
  std::vector<std::string> all;
  for (const GpgpAxiom& a : axioms) all.emplace_back(reinterpret_cast<const char*>(&a), sizeof a);
  std::sort(all.begin(), all.end());
  return all;
}

double nearestTo(const std::vector<GpgpAxiom>& axioms, double x, double z, const GpgpAxiom* but = nullptr) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const GpgpAxiom& a : axioms)
    if (&a != but) nearest = std::min(nearest, std::hypot(a.transform[3] - x, a.transform[11] - z));
  return nearest;
}

TEST(ScatterTest, PointsKeepTheirDistanceAndLeaveLittleRoom) {
  for (const float distance : {0.5f, 3.0f, 40.0f}) {
    const float side = 50 * distance;
    const auto axioms = scattered(infoOf(distance, -side / 2, -side, side / 2, 0, 7));
    double nearest = std::numeric_limits<double>::infinity();
    for (const GpgpAxiom& a : axioms)
      nearest = std::min(nearest, nearestTo(axioms, a.transform[3], a.transform[11], &a));
    EXPECT_GE(nearest, distance);
    EXPECT_LT(nearest, 1.02 * distance);
    const double density = double(axioms.size()) / 2500; // points on the square of the distance
    EXPECT_GT(density, 0.57);
    EXPECT_LT(density, 0.9069 * 4 / 3.14159265); // the densest packing of disks
    std::mt19937 random(3);                      // places, away from the edges, where one more point would fit
    std::uniform_real_distribution<double> place(0.1, 0.9);
    uint32_t room = 0;
    for (int i = 0; i < 4000; ++i)
      room += nearestTo(axioms, (place(random) - 0.5) * side, (place(random) - 1) * side) > distance;
    EXPECT_LT(room, 4000 * 0.12);
  }
}

TEST(ScatterTest, RectanglesInAnyOrderAreTheWhole) {
  const auto whole = sorted(scattered(infoOf(1.7f, -64, 31, 64, 95, 3)));
  std::mt19937 random(9);
  for (int run = 0; run < 3; ++run) {
    // Edges anywhere, also on those of cells and where no float is exact.
    std::vector<float> x{-64, 64}, z{31, 95};
    std::uniform_real_distribution<float> inX(-64, 64), inZ(31, 95);
    for (int i = 0; i < 4; ++i) x.push_back(inX(random));
    for (int i = 0; i < 3; ++i) z.push_back(inZ(random));
    x.push_back(float(std::floor(inX(random) / 1.7) * 1.7 * 0.70710678118654752));
    std::sort(x.begin(), x.end());
    std::sort(z.begin(), z.end());
    std::vector<std::pair<size_t, size_t>> tiles;
    for (size_t i = 0; i + 1 < x.size(); ++i)
      for (size_t j = 0; j + 1 < z.size(); ++j) tiles.emplace_back(i, j);
    std::shuffle(tiles.begin(), tiles.end(), random);
    std::vector<GpgpAxiom> parts;
    for (const auto& tile : tiles)
      for (const GpgpAxiom& a :
           scattered(infoOf(1.7f, x[tile.first], z[tile.second], x[tile.first + 1], z[tile.second + 1], 3)))
        parts.push_back(a);
    EXPECT_EQ(sorted(parts), whole);
  }
  EXPECT_GT(whole.size(), 1500u);
  EXPECT_NE(sorted(scattered(infoOf(1.7f, -64, 31, 64, 95, 4))), whole);
}

TEST(ScatterTest, IdsAndSeedsDiffer) {
  const auto axioms = scattered(infoOf(1, 0, 0, 60, 60));
  std::vector<uint32_t> ids, seeds;
  for (const GpgpAxiom& a : axioms) {
    ids.push_back(a.id);
    seeds.push_back(a.seed);
  }
  for (std::vector<uint32_t>* all : {&ids, &seeds}) {
    std::sort(all->begin(), all->end());
    EXPECT_EQ(std::unique(all->begin(), all->end()), all->end());
  }
}

TEST(ScatterTest, DensityIsTheShareThatIsKept) {
  const float ramp[4] = {0, 1, 0, 1}; // along x
  const GpgpGroundField field{ramp, 2, 2, {0, 0}, {100, 100}};
  GpgpScatterInfo info = infoOf(0.5f, -20, 0, 120, 100, 5);
  const auto all = scattered(info);
  info.density = &field;
  const auto kept = scattered(info);
  const auto in = [](const std::vector<GpgpAxiom>& axioms, float low, float high) {
    return double(std::count_if(axioms.begin(), axioms.end(),
                                [&](const GpgpAxiom& a) { return a.transform[3] >= low && a.transform[3] < high; }));
  };
  EXPECT_EQ(in(kept, -20, 0), 0);
  EXPECT_EQ(in(kept, 100, 120), in(all, 100, 120));
  for (float x = 0; x < 100; x += 10) {
    const double p = (x + 5) / 100, count = in(all, x, x + 10);
    EXPECT_NEAR(in(kept, x, x + 10), count * p, 5 * std::sqrt(count * p * (1 - p))) << x;
  }
  const auto whole = sorted(all);
  for (const std::string& one : sorted(kept)) // density moves nothing
    EXPECT_TRUE(std::binary_search(whole.begin(), whole.end(), one));
}

TEST(ScatterTest, AxiomsStandOnTheTerrain) {
  std::vector<float> heights; // a plane, which bilinear sampling keeps, and constant beyond
  for (int z = 0; z < 5; ++z)
    for (int x = 0; x < 9; ++x) heights.push_back(float(x) * 2 - float(z) * 3);
  const GpgpGroundField field{heights.data(), 9, 5, {10, 20}, {26, 28}}; // 2 m apart
  GpgpScatterInfo info = infoOf(0.4f, 0, 10, 40, 40);
  info.heights = &field;
  info.base.transform[7] = 100;
  const auto axioms = scattered(info);
  for (const GpgpAxiom& a : axioms) {
    const double x = std::clamp(double(a.transform[3]), 10.0, 26.0),
                 z = std::clamp(double(a.transform[11]), 20.0, 28.0);
    ASSERT_NEAR(a.transform[7], 100 + 1 + (x - 10) - (z - 20) * 1.5, 1e-4);
  }
  info.minHeight = -2;
  info.maxHeight = 3;
  const auto banded = scattered(info);
  const auto within = std::count_if(axioms.begin(), axioms.end(),
                                    [](const GpgpAxiom& a) { return a.transform[7] >= 99 && a.transform[7] <= 104; });
  EXPECT_EQ(int64_t(banded.size()), within);
  EXPECT_GT(within, 100);
  const float flat = 4; // a field of one value
  const GpgpGroundField one{&flat, 1, 1, {0, 0}, {0, 0}};
  info.heights = &one;
  info.minHeight = info.maxHeight = 0;
  EXPECT_EQ(scattered(info).front().transform[7], 105);
}

TEST(ScatterTest, WhatIsWrongIsRefusedAndShortListsAreSaid) {
  GpgpScatterInfo info = infoOf(1, 0, 0, 10, 10);
  uint32_t count = 5;
  std::vector<GpgpAxiom> few(5), all = scattered(info);
  EXPECT_EQ(gpgpScatterAxioms(&info, &count, few.data()), GPGP_INCOMPLETE);
  EXPECT_EQ(count, all.size());
  EXPECT_EQ(std::memcmp(few.data(), all.data(), 5 * sizeof few[0]), 0);
  info.max[0] = 0; // empty
  EXPECT_TRUE(scattered(info).empty());
  const float value = 1, nan = std::numeric_limits<float>::quiet_NaN();
  const GpgpGroundField bad[] = {{nullptr, 1, 1, {0, 0}, {1, 1}},
                                 {&value, 0, 1, {0, 0}, {1, 1}},
                                 {&value, 2, 1, {1, 0}, {1, 1}},
                                 {&value, 1, 1, {nan, 0}, {1, 1}},
                                 {&nan, 1, 1, {0, 0}, {1, 1}}};
  const auto refused = [&](const GpgpScatterInfo& what) {
    return gpgpScatterAxioms(&what, &count, nullptr) == GPGP_ERROR_INVALID_ARGUMENT;
  };
  for (const GpgpGroundField& field : bad) {
    info = infoOf(1, 0, 0, 10, 10);
    info.density = &field;
    EXPECT_TRUE(refused(info));
    info.density = nullptr;
    info.heights = &field;
    EXPECT_TRUE(refused(info));
  }
  for (const GpgpScatterInfo& wrong :
       {infoOf(0, 0, 0, 1, 1), infoOf(nan, 0, 0, 1, 1), infoOf(1, 1, 0, 0, 1), infoOf(1, 0, nan, 1, 1),
        infoOf(1, 0, 0, 2049, 1), infoOf(1, 65537, 0, 65538, 1)})
    EXPECT_TRUE(refused(wrong));
  EXPECT_EQ(gpgpScatterAxioms(nullptr, &count, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info = infoOf(1, 0, 0, 10, 10);
  EXPECT_EQ(gpgpScatterAxioms(&info, nullptr, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  info.pNext = &count;
  EXPECT_EQ(gpgpScatterAxioms(&info, &count, nullptr), GPGP_ERROR_INVALID_STRUCT);
}

} // namespace
