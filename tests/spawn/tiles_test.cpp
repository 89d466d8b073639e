// Tiles through the C functions: whatever order they come, go and move in, each holds what its axioms become, and
// nothing of another is touched.
#include "grammars.h"
#include "host/files.h"
#include "host/memory.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/tiles/tile_set.h"
#include "spawner_test.h"

#include <gpgp/tiles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
using Command = VkDrawIndexedIndirectCommand;

// ---------------------------------------------------------------- free ranges

TEST(FreeRangesTest, TakesTheLowestAndJoinsNeighbours) { // against a bit for each place
  std::mt19937 random(5);
  constexpr uint32_t kSize = 97;
  spawn::FreeRanges free(kSize, kSize, std::pmr::new_delete_resource());
  std::array<bool, kSize> used{};
  std::vector<spawn::FreeRanges::Range> taken;
  uint32_t refused = 0;
  for (int step = 0; step < 20000; ++step) {
    if (taken.empty() || random() % 2) {
      const uint32_t size = 1 + uint32_t(random() % 12);
      uint32_t expected = UINT32_MAX;
      for (uint32_t at = 0; at + size <= kSize && expected == UINT32_MAX; ++at)
        if (std::none_of(used.begin() + at, used.begin() + at + size, [](bool u) { return u; })) expected = at;
      const uint32_t first = free.take(size);
      ASSERT_EQ(first, expected) << step;
      if (first == UINT32_MAX) {
        ++refused;
        continue;
      }
      std::fill_n(used.begin() + first, size, true);
      taken.push_back({first, size});
    } else {
      const size_t which = random() % taken.size();
      const spawn::FreeRanges::Range range = taken[which];
      taken[which] = taken.back();
      taken.pop_back();
      free.give(range);
      if (random() % 4 == 0) { // and at once the same again
        free.takeAt(range);
        taken.push_back(range);
      } else {
        std::fill_n(used.begin() + range.first, range.size, false);
      }
    }
    uint32_t largest = 0, run = 0, runs = 0;
    for (uint32_t at = 0; at < kSize; ++at) {
      run = used[at] ? 0 : run + 1;
      runs += run == 1;
      largest = std::max(largest, run);
    }
    ASSERT_EQ(free.largest(), largest) << step;
    ASSERT_EQ(free.ranges().size(), runs) << step;
  }
  EXPECT_GT(refused, 100u);
}

// ---------------------------------------------------------------- tiles on the device

const char* const kOneBucket = "axiom Box A;\nterminal T (1, 0);\nA = Repeat(X, Rand(0.4, 2), ADJUST_TO_FILL) T;\n";

std::vector<GpgpAxiom> lotsOf(uint32_t tile, uint32_t count, uint32_t version = 0) {
  std::vector<GpgpAxiom> lots;
  for (uint32_t i = 0; i < count; ++i) {
    GpgpAxiom lot =
        spawn::makeAxiom(4, float(3 + (tile + i + version) % 5), 3, 1 + tile * 64 + i + 7919 * version, tile * 64 + i);
    lot.transform[3] = 100.0f * float(tile % 8) + 6.0f * float(i);
    lot.transform[11] = 100.0f * float(tile / 8);
    lots.push_back(lot);
  }
  return lots;
}

struct World {
  host::HeadlessDevice& device;
  GpgpContext context;
  GpgpRecorder spawner = nullptr;
  GpgpAsset grammar = nullptr;
  uint32_t buckets = 0, maxTiles = 0;
  host::Buffer things, indices, draws;
  VkDeviceSize stride = 0;
  gpgp::TileSet set;
};

struct TilesTest : SpawnerTest {
  static constexpr uint32_t kPoison = 0xbaadf00d;

  GpgpRecorder makeSpawner(GpgpSpawnerFlags flags = 0, const GpgpVertexLayout* layout = nullptr) {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.queueFamily = device.graphics().family;
    info.maxShapes = info.maxTerminals = 16384;
    info.maxHostAxioms = 64;
    info.flags = flags;
    info.vertices = layout;
    return spawnerOf(info);
  }
  World makeWorld(const char* text, uint32_t bytes, uint32_t maxTiles, GpgpRecorder spawner, bool vertices = false,
                  VkIndexType indexType = VK_INDEX_TYPE_UINT32) {
    World world{device, context};
    const auto words = bake(text);
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = words.data();
    info.size = words.size() * 4;
    EXPECT_EQ(gpgpCreateGrammar(context, &info, &world.grammar), GPGP_SUCCESS);
    const GpgpFrame f = advance();
    device.submitAndWait(
        [&](VkCommandBuffer cmd) { EXPECT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS); });
    world.spawner = spawner;
    world.buckets = vertices ? 1 : words[shader::kHeaderBuckets];
    world.maxTiles = maxTiles;
    world.stride = *tileStride(spawner, world.grammar);
    world.things = host::Buffer(device, bytes, kStorage);
    host::fill(device, world.things, kPoison);
    if (vertices) world.indices = host::Buffer(device, bytes, kStorage);
    std::vector<uint32_t> commands(world.stride * maxTiles / 4, kPoison);
    for (uint32_t t = 0; t < maxTiles; ++t)
      for (uint32_t b = 0; b < world.buckets; ++b) {
        const Command command = vertices ? Command{0, 1, kPoison, 5, 0} : Command{36 + b, 0, 7 * b, 4, kPoison};
        std::memcpy(&commands[(world.stride * t + sizeof command * b) / 4], &command, sizeof command);
      }
    world.draws = host::makeBuffer(device, commands, kStorage);
    auto create = init<GpgpTileSetCreateInfo>();
    create.label = "world";
    create.spawner = spawner;
    create.grammar = world.grammar;
    create.maxTiles = maxTiles;
    (vertices ? create.vertices : create.instances) = world.things.range();
    if (vertices) create.indices = world.indices.range();
    create.indexType = indexType;
    create.draws = world.draws.range();
    auto set = gpgp::TileSet::create(context, create);
    EXPECT_TRUE(set) << lastMessage();
    world.set = std::move(*set);
    return world;
  }
  void destroy(World& world) {
    world.set.reset();
    gpgpDestroyAsset(world.grammar);
  }

  /// What a buffer holds.
  std::vector<uint32_t> read(const host::Buffer& buffer) {
    return host::download<uint32_t>(device, buffer, buffer.size() / 4);
  }
};

struct Read {
  std::vector<uint32_t> things, draws;
};

/// The instances that a tile's commands draw; they must lie in its range, one bucket after the other.
std::vector<GpgpInstance> drawn(const World& world, const Read& read, GpgpTile tile) {
  std::vector<GpgpInstance> found;
  const GpgpTileRange range = *world.set.range(tile);
  for (uint32_t b = 0; b < world.buckets; ++b) {
    Command command;
    std::memcpy(&command, &read.draws[(world.stride * range.slot + sizeof command * b) / 4], sizeof command);
    EXPECT_EQ(command.indexCount, 36 + b); // the engine's
    EXPECT_EQ(command.firstIndex, 7 * b);
    EXPECT_EQ(command.vertexOffset, 4);
    if (!command.instanceCount) continue;
    EXPECT_GE(command.firstInstance, range.first);
    EXPECT_LE(command.firstInstance + command.instanceCount, range.first + range.capacity);
    for (uint32_t i = 0; i < command.instanceCount; ++i) {
      GpgpInstance instance;
      std::memcpy(&instance, &read.things[size_t(command.firstInstance + i) * 24], sizeof instance);
      EXPECT_EQ(instance.bucket, b);
      found.push_back(instance);
    }
  }
  return found;
}
void sort(std::vector<GpgpInstance>& all) {
  std::sort(all.begin(), all.end(),
            [](const GpgpInstance& a, const GpgpInstance& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
}
bool same(std::vector<GpgpInstance> a, std::vector<GpgpInstance> b) {
  sort(a);
  sort(b);
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

// Houses register, trees ask: of the neighbours' houses, too, which stand as far as beyond the border.
const char* const kYards = R"(axiom Box Lot;
terminal House (1, 0);
terminal Tree (1, 1);
Lot = Replicate() {
  Translate(Rand(-8, 8), 0, Rand(-8, 8)) Scale(Rand(4, 12), -1, Rand(4, 12)) Collider(1) House |
  Repeat(X, 3, ADJUST_TO_FILL) Repeat(Z, 3, ADJUST_TO_FILL) Scale(1.5, -1, 1.5) IfCollides(1) { Discard() | Tree }
};
)";

TEST_F(TilesTest, WithTheirNeighboursAsContextTheyAreTheWorldDerivedWhole) {
  constexpr int kSide = 6;
  constexpr uint32_t kTiles = kSide * kSide;
  const auto lot = [](int x, int z) {
    GpgpAxiom axiom = spawn::makeAxiom(16, 6, 16, uint32_t(1000 + 37 * x + 411 * z), uint32_t(z * kSide + x));
    axiom.transform[3] = 16.0f * float(x);
    axiom.transform[11] = 16.0f * float(z);
    return axiom;
  };
  GpgpSpawnerCreateInfo create = GPGP_SPAWNER_CREATE_INFO_INIT;
  create.base.queueFamily = device.graphics().family;
  create.maxShapes = create.maxTerminals = 16384;
  create.maxHostAxioms = 16;
  create.maxColliders = 64;
  const GpgpRecorder spawner = recorder(gpgpCreateSpawner, create);
  advance();
  for (GpgpSpawnReport old = GPGP_SPAWN_REPORT_INIT; gpgpGetSpawnReport(spawner, &old) == GPGP_SUCCESS;) {
  } // of other tests
  const auto words = bake(kYards);
  std::vector<GpgpAxiom> all;
  for (int z = 0; z < kSide; ++z)
    for (int x = 0; x < kSide; ++x) all.push_back(lot(x, z));
  const std::vector<GpgpInstance> whole = spawn::derive(words, all).instances;
  size_t apart = 0;
  for (const GpgpAxiom& axiom : all) apart += spawn::derive(words, std::span(&axiom, 1)).instances.size();
  EXPECT_GT(apart, whole.size() + 50); // without their neighbours there are more trees

  World world = makeWorld(kYards, 96 * 8000, kTiles, spawner);
  std::vector<uint32_t> order(kTiles);
  for (uint32_t t = 0; t < kTiles; ++t) order[t] = t;
  std::mt19937 random(5);
  std::shuffle(order.begin(), order.end(), random);
  std::map<uint32_t, GpgpTile> tiles;
  uint64_t terminals = 0;
  uint32_t hash[2] = {};
  for (const uint32_t t : order) {
    const int x = int(t % kSide), z = int(t / kSide);
    std::vector<GpgpAxiom> axioms{lot(x, z)};
    for (int dz = -1; dz <= 1; ++dz)
      for (int dx = -1; dx <= 1; ++dx)
        if ((dx || dz) && x + dx >= 0 && x + dx < kSide && z + dz >= 0 && z + dz < kSide)
          axioms.push_back(lot(x + dx, z + dz));
    auto tile = init<GpgpTileInfo>();
    tile.hostAxioms = axioms.data();
    tile.axiomCount = uint32_t(axioms.size());
    tile.contextCount = tile.axiomCount - 1;
    tile.capacity = 200;
    const GpgpFrame frame = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      ASSERT_EQ(world.set.record(cmd, frame, tile, tiles[t]), GPGP_SUCCESS) << lastMessage();
    });
    advance();
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    ASSERT_EQ(report.base.status, GPGP_SUCCESS);
    EXPECT_EQ(report.colliders, axioms.size());
    terminals += report.terminals;
    for (int k = 0; k < 2; ++k) hash[k] += report.keyHash[k];
  }
  Read read{this->read(world.things), this->read(world.draws)};
  std::vector<GpgpInstance> found;
  for (const auto& [t, tile] : tiles) {
    const auto part = drawn(world, read, tile);
    for (const GpgpInstance& instance : part) EXPECT_EQ(instance.axiomId, t);
    found.insert(found.end(), part.begin(), part.end());
  }
  const auto keys = [](const std::vector<GpgpInstance>& instances) {
    std::multiset<std::array<uint32_t, 4>> set;
    for (const GpgpInstance& i : instances) set.insert({i.axiomId, i.key[0], i.key[1], i.terminal});
    return set;
  };
  EXPECT_EQ(terminals, whole.size());
  EXPECT_EQ(found.size(), whole.size());
  EXPECT_EQ(keys(found), keys(whole));

  // A tile of neighbours alone is none; a grammar without colliders derives no context at all.
  auto tile = init<GpgpTileInfo>();
  tile.hostAxioms = all.data();
  tile.axiomCount = tile.contextCount = 2;
  tile.capacity = 10;
  GpgpTile made = 0;
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer cmd) {
    EXPECT_EQ(world.set.record(cmd, frame, tile, made), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(lastMessage().find("contextCount is 2"), std::string::npos) << lastMessage();
  });
  destroy(world);
}

TEST_F(TilesTest, InAnyOrderTheyAreTheWorldDerivedWhole) {
  constexpr uint32_t kTiles = 48, kLots = 5;
  for (const char* text : {kTown, kOneBucket}) {
    const GpgpRecorder spawner = makeSpawner();
    const auto words = bake(text);
    std::vector<GpgpAxiom> all;
    std::vector<uint32_t> needs;
    for (uint32_t t = 0; t < kTiles; ++t) {
      const auto lots = lotsOf(t, kLots);
      all.insert(all.end(), lots.begin(), lots.end());
      needs.push_back(static_cast<uint32_t>(spawn::derive(words, lots).terminals));
    }
    // All at once, in a recording of the spawner.
    World world = makeWorld(text, 96 * 24000, kTiles, spawner);
    const auto axioms = host::makeBuffer(device, all, kStorage);
    const host::Buffer instances(device, 96 * 20000, kStorage);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = world.grammar;
    info.axioms = axioms.range();
    info.axiomCount = static_cast<uint32_t>(all.size());
    info.instances = instances.range();
    const GpgpFrame f = advance();
    device.submitAndWait(
        [&](VkCommandBuffer cmd) { ASSERT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS); });
    advance();
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    ASSERT_EQ(report.base.status, GPGP_SUCCESS);
    const auto whole = host::download<GpgpInstance>(device, instances, report.terminals);
    ASSERT_GT(whole.size(), 500u);
    // Tile by tile, several in a frame, in random order; some come, go and come again.
    std::mt19937 random(11);
    for (int round = 0; round < 3; ++round) {
      std::vector<uint32_t> order(kTiles);
      for (uint32_t t = 0; t < kTiles; ++t) order[t] = t;
      std::shuffle(order.begin(), order.end(), random);
      std::map<uint32_t, GpgpTile> tiles;
      for (uint32_t next = 0; next < kTiles;) {
        const GpgpFrame frame = advance();
        device.submitAndWait([&](VkCommandBuffer cmd) {
          for (uint32_t i = 0; i < 6 && next < kTiles; ++i, ++next) {
            const auto lots = lotsOf(order[next], kLots);
            auto tile = init<GpgpTileInfo>();
            tile.hostAxioms = lots.data();
            tile.axiomCount = kLots;
            tile.capacity = needs[order[next]];
            ASSERT_EQ(world.set.record(cmd, frame, tile, tiles[order[next]]), GPGP_SUCCESS) << lastMessage();
            if (next % 5 == 4) { // an earlier one goes, to come again at the end
              const uint32_t gone = order[next - 3];
              if (!tiles[gone]) continue;
              ASSERT_EQ(world.set.recordFree(cmd, frame, tiles[gone]), GPGP_SUCCESS);
              tiles.erase(gone);
              if (next < kTiles - 8) order.push_back(gone);
            }
          }
        });
      }
      for (uint32_t t = 0; t < kTiles; t += 6) {
        const GpgpFrame frame = advance();
        device.submitAndWait([&](VkCommandBuffer cmd) {
          for (uint32_t i = t; i < t + 6; ++i) {
            if (tiles.count(i)) continue;
            const auto lots = lotsOf(i, kLots);
            auto tile = init<GpgpTileInfo>();
            tile.hostAxioms = lots.data();
            tile.axiomCount = kLots;
            tile.capacity = needs[i];
            ASSERT_EQ(world.set.record(cmd, frame, tile, tiles[i]), GPGP_SUCCESS);
          }
        });
      }
      const Read found{read(world.things), read(world.draws)};
      std::vector<GpgpInstance> together;
      for (const auto& [number, tile] : tiles) {
        const auto own = drawn(world, found, tile);
        EXPECT_EQ(own.size(), needs[number]);
        together.insert(together.end(), own.begin(), own.end());
      }
      EXPECT_TRUE(same(together, whole)) << "round " << round;
      const GpgpFrame frame = advance();
      device.submitAndWait([&](VkCommandBuffer cmd) {
        for (const auto& entry : tiles) ASSERT_EQ(world.set.recordFree(cmd, frame, entry.second), GPGP_SUCCESS);
      });
      const auto empty = *world.set.report();
      EXPECT_EQ(empty.tiles, 0u);
      EXPECT_EQ(empty.used, 0u);
      EXPECT_EQ(empty.largest, empty.capacity); // no leak, no fragments
      const auto draws = read(world.draws);
      for (uint32_t t = 0; t < kTiles; ++t)
        for (uint32_t b = 0; b < world.buckets; ++b) ASSERT_EQ(draws[(world.stride * t + 20 * b) / 4 + 1], 0u);
    }
    destroy(world);
  }
}

TEST_F(TilesTest, WhatHappensToOneLeavesTheOthersAlone) {
  const GpgpRecorder spawner = makeSpawner();
  const auto words = bake(kTown);
  World world = makeWorld(kTown, 96 * 1500, 12, spawner);
  struct Known {
    std::vector<GpgpInstance> instances; // as the CPU derives them
    GpgpTileRange range;
  };
  std::map<GpgpTile, Known> tiles;
  std::mt19937 random(3);
  Read before{read(world.things), read(world.draws)};
  uint32_t full = 0, moved = 0, trimmed = 0, freed = 0;
  for (uint32_t step = 0; step < 150; ++step) {
    const uint32_t what = random() % 8;
    GpgpTile tile = 0;
    if (!tiles.empty() && what >= 3) tile = std::next(tiles.begin(), long(random() % tiles.size()))->first;
    const GpgpTile touched = tile;
    GpgpTile after = tile;
    if (what == 7 && tile) { // go
      const GpgpFrame frame = advance();
      device.submitAndWait(
          [&](VkCommandBuffer cmd) { ASSERT_EQ(world.set.recordFree(cmd, frame, tile), GPGP_SUCCESS); });
      tiles.erase(tile);
      after = 0;
      ++freed;
    } else if (what == 6 && tile) { // give back
      const auto used = static_cast<uint32_t>(tiles[tile].instances.size());
      const uint32_t was = tiles[tile].range.capacity;
      ASSERT_EQ(world.set.trim(tile, used), GPGP_SUCCESS);
      tiles[tile].range = *world.set.range(tile);
      ASSERT_GE(tiles[tile].range.capacity, used);
      trimmed += tiles[tile].range.capacity < was;
    } else { // come, or anew
      const auto lots = lotsOf(uint32_t(random() % 30), 1 + uint32_t(random() % 7), step);
      const auto known = spawn::derive(words, lots);
      auto info = init<GpgpTileInfo>();
      info.hostAxioms = lots.data();
      info.axiomCount = static_cast<uint32_t>(lots.size());
      info.capacity = static_cast<uint32_t>(known.terminals + random() % 60);
      info.flags = what == 5 ? GPGP_TILE_MOVE : 0;
      const GpgpFrame frame = advance();
      GpgpResult result = GPGP_SUCCESS;
      device.submitAndWait([&](VkCommandBuffer cmd) { result = world.set.record(cmd, frame, info, after); });
      if (result == GPGP_BUDGET_EXCEEDED) {
        ++full;
        ASSERT_EQ(after, touched);
        const auto report = *world.set.report();
        ASSERT_TRUE(report.largest < info.capacity || (!touched && report.tiles == 12)) << report.largest;
        if (touched) { // as it was
          const GpgpTileRange still = *world.set.range(touched);
          ASSERT_EQ(std::memcmp(&tiles[touched].range, &still, sizeof still), 0);
        }
      } else {
        ASSERT_EQ(result, GPGP_SUCCESS) << lastMessage();
        const GpgpTileRange range = *world.set.range(after);
        moved += touched && range.first != tiles[touched].range.first;
        tiles[after] = {known.instances, range};
      }
    }
    // Ranges do not overlap; what others draw has not changed by a bit; the tile draws what the CPU derives.
    Read now{read(world.things), read(world.draws)};
    uint32_t used = 0;
    for (const auto& [other, known] : tiles) {
      used += known.range.capacity;
      for (const auto& [second, overlapped] : tiles)
        ASSERT_TRUE(other == second || known.range.first >= overlapped.range.first + overlapped.range.capacity ||
                    overlapped.range.first >= known.range.first + known.range.capacity);
      const auto found = drawn(world, now, other);
      ASSERT_EQ(found.size(), known.instances.size()) << "step " << step;
      if (other != after) {
        ASSERT_TRUE(same(found, drawn(world, before, other))) << "step " << step;
        continue;
      }
      std::vector<std::array<uint32_t, 2>> keys, expected;
      for (const GpgpInstance& i : found) keys.push_back({{i.key[0], i.key[1]}});
      for (const GpgpInstance& i : known.instances) expected.push_back({{i.key[0], i.key[1]}});
      std::sort(keys.begin(), keys.end());
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(keys, expected) << "step " << step;
    }
    ASSERT_EQ(world.set.report()->used, used);
    ASSERT_EQ(world.set.report()->tiles, tiles.size());
    before = std::move(now);
  }
  EXPECT_GT(full, 5u);
  EXPECT_GT(moved, 5u);
  EXPECT_GT(trimmed, 2u);
  EXPECT_GT(freed, 5u);
  // Defragmented until there is no hole, and no further: all tiles still draw what they drew.
  const auto packed = [&] { return world.set.report()->holes == 0; };
  for (int turn = 0; turn < 100 && !packed(); ++turn) {
    // The highest that a hole takes; the rest of a set can be spawned anew in its order.
    bool any = false;
    std::vector<std::pair<uint32_t, GpgpTile>> order;
    for (const auto& [tile, known] : tiles) order.push_back({known.range.first, tile});
    std::sort(order.begin(), order.end());
    EXPECT_EQ(world.set.report()->highest, order.back().second);
    for (const auto& entry : order) {
      const GpgpTile tile = entry.second;
      std::vector<GpgpAxiom> lots{lotsOf(1, 1)};
      auto info = init<GpgpTileInfo>();
      info.hostAxioms = lots.data();
      info.axiomCount = 1;
      info.capacity = tiles[tile].range.capacity;
      info.flags = GPGP_TILE_MOVE;
      GpgpTile same = tile;
      const GpgpFrame frame = advance();
      device.submitAndWait(
          [&](VkCommandBuffer cmd) { ASSERT_EQ(world.set.record(cmd, frame, info, same), GPGP_SUCCESS); });
      ASSERT_EQ(same, tile);
      const GpgpTileRange range = *world.set.range(tile);
      ASSERT_LE(range.first, tiles[tile].range.first);
      any = any || range.first < tiles[tile].range.first;
      tiles[tile].range = range;
    }
    ASSERT_TRUE(any);
  }
  EXPECT_TRUE(packed());
  destroy(world);
}

TEST_F(TilesTest, ATileThatIsTooSmallLosesOnlyItsOwn) {
  const GpgpRecorder spawner = makeSpawner();
  const auto words = bake(kTown);
  World world = makeWorld(kTown, 96 * 2000, 3, spawner);
  std::array<GpgpTile, 3> tiles{};
  std::array<uint32_t, 3> needs{};
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer cmd) {
    for (uint32_t t = 0; t < 3; ++t) {
      const auto lots = lotsOf(t, 6);
      needs[t] = static_cast<uint32_t>(spawn::derive(words, lots).terminals);
      auto info = init<GpgpTileInfo>();
      info.base.tag = 70 + t;
      info.hostAxioms = lots.data();
      info.axiomCount = 6;
      info.capacity = t == 1 ? needs[t] / 3 : needs[t];
      ASSERT_EQ(world.set.record(cmd, frame, info, tiles[t]), GPGP_SUCCESS);
    }
  });
  advance();
  const Read found{read(world.things), read(world.draws)};
  for (uint32_t t = 0; t < 3; ++t) {
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    EXPECT_EQ(report.base.tag, 70 + t);
    EXPECT_EQ(report.terminals, needs[t]); // what would have fitted
    EXPECT_EQ(report.base.status, t == 1 ? GPGP_BUDGET_EXCEEDED : GPGP_SUCCESS);
    const uint32_t capacity = world.set.range(tiles[t])->capacity;
    EXPECT_EQ(drawn(world, found, tiles[t]).size(), std::min(needs[t], capacity));
    EXPECT_EQ(report.instancesWritten, std::min(needs[t], capacity));
  }
  // A fourth has no slot.
  const auto lots = lotsOf(5, 1);
  auto info = init<GpgpTileInfo>();
  info.hostAxioms = lots.data();
  info.axiomCount = 1;
  info.capacity = 10;
  GpgpTile fourth = 0;
  const GpgpFrame f = advance();
  device.submitAndWait(
      [&](VkCommandBuffer cmd) { EXPECT_EQ(world.set.record(cmd, f, info, fourth), GPGP_BUDGET_EXCEEDED); });
  EXPECT_EQ(fourth, 0u);
  EXPECT_TRUE(messages.empty());
  destroy(world);
}

TEST_F(TilesTest, VerticesOfTilesAreDrawnFromTheSharedBuffers) {
  constexpr GpgpVertexLayout kLayout{
      16, 2, {{GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0}, {GPGP_VERTEX_AXIOM_ID, VK_FORMAT_R32_UINT, 12}}};
  for (const VkIndexType type : {VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32}) {
    const GpgpRecorder spawner = makeSpawner(0, &kLayout);
    const auto words = bake(kTown);
    const auto layout = spawn::layoutOf(kLayout);
    World world = makeWorld(kTown, 1 << 20, 8, spawner, true, type);
    std::map<GpgpTile, std::vector<GpgpAxiom>> tiles;
    GpgpTile second = 0;
    for (uint32_t t = 0; t < 7; ++t) {
      const GpgpFrame frame = advance();
      device.submitAndWait([&](VkCommandBuffer cmd) {
        const auto lots = lotsOf(t, 3 + t % 3);
        const auto known = spawn::derive(words, lots, {.vertices = &*layout});
        uint32_t quads = 0;
        for (const uint32_t q : known.quads) quads += q;
        auto info = init<GpgpTileInfo>();
        info.hostAxioms = lots.data();
        info.axiomCount = static_cast<uint32_t>(lots.size());
        info.capacity = quads;
        GpgpTile tile = 0;
        ASSERT_EQ(world.set.record(cmd, frame, info, tile), GPGP_SUCCESS) << lastMessage();
        tiles[tile] = lots;
        if (t == 1) second = tile;
        if (t == 4) {
          ASSERT_EQ(world.set.recordFree(cmd, frame, second), GPGP_SUCCESS);
          tiles.erase(second);
        }
      });
    }
    const auto vertices = read(world.things), indices = read(world.indices), draws = read(world.draws);
    for (const auto& [tile, lots] : tiles) {
      const auto known = spawn::derive(words, lots, {.vertices = &*layout});
      const GpgpTileRange range = *world.set.range(tile);
      Command command;
      std::memcpy(&command, &draws[world.stride * range.slot / 4], sizeof command);
      EXPECT_EQ(command.instanceCount, 1u);
      EXPECT_EQ(command.indexCount, known.vertexWords.size() / 16 * 6);
      EXPECT_EQ(command.firstIndex, range.first * 6);
      EXPECT_EQ(command.vertexOffset, int32_t(range.first * 4));
      // As a draw would read them: every corner of every triangle.
      std::vector<std::array<float, 4>> corners, expected;
      for (uint32_t i = 0; i < command.indexCount; ++i) {
        const uint32_t at = command.firstIndex + i;
        const uint32_t index = type == VK_INDEX_TYPE_UINT32 ? indices[at] : indices[at / 2] >> (16 * (at % 2)) & 0xffff;
        std::array<float, 4> corner;
        const uint32_t* from = &vertices[size_t(int32_t(index) + command.vertexOffset) * 4];
        std::memcpy(corner.data(), from, 12);
        corner[3] = float(from[3]);
        corners.push_back(corner);
      }
      for (size_t quad = 0; quad < known.vertexWords.size() / 16; ++quad)
        for (const uint32_t c : {0, 1, 2, 0, 2, 3}) {
          std::array<float, 4> corner;
          const uint32_t* from = &known.vertexWords[(quad * 4 + c) * 4];
          std::memcpy(corner.data(), from, 12);
          corner[3] = float(from[3]);
          expected.push_back(corner);
        }
      const auto rounded = [](std::vector<std::array<float, 4>>& all) {
        for (auto& corner : all)
          for (float& v : corner) v = std::round(v * 256) / 256; // halves of the sizes here have no digits there
        std::sort(all.begin(), all.end());
      };
      rounded(corners);
      rounded(expected);
      ASSERT_EQ(corners.size(), expected.size());
      size_t different = 0;
      for (size_t i = 0; i < corners.size(); ++i)
        for (int e = 0; e < 4; ++e) different += std::abs(corners[i][size_t(e)] - expected[i][size_t(e)]) > 0.01f;
      EXPECT_EQ(different, 0u);
    }
    destroy(world);
  }
}

TEST_F(TilesTest, HandlesAreChecked) {
  const GpgpRecorder spawner = makeSpawner();
  World world = makeWorld(kTown, 96 * 1000, 2, spawner), other = makeWorld(kOneBucket, 96 * 1000, 2, spawner),
        alike = makeWorld(kTown, 96 * 1000, 2, spawner);
  const auto lots = lotsOf(0, 2);
  auto info = init<GpgpTileInfo>();
  info.hostAxioms = lots.data();
  info.axiomCount = 2;
  info.capacity = 200;
  GpgpTile tile = 0, second = 0;
  const GpgpFrame frame = advance();
  device.submitAndWait([&](VkCommandBuffer cmd) {
    ASSERT_EQ(world.set.record(cmd, frame, info, tile), GPGP_SUCCESS);
    ASSERT_EQ(world.set.recordFree(cmd, frame, tile), GPGP_SUCCESS);
    EXPECT_EQ(world.set.recordFree(cmd, frame, tile), GPGP_ERROR_INVALID_HANDLE); // twice
    EXPECT_EQ(lastMessage(), "gpgpRecordFreeTile: tile was freed, or is none of this tile set");
    GpgpTile gone = tile;
    EXPECT_EQ(world.set.record(cmd, frame, info, gone), GPGP_ERROR_INVALID_HANDLE);
    EXPECT_EQ(world.set.trim(tile, 1), GPGP_ERROR_INVALID_HANDLE);
    EXPECT_EQ(world.set.range(tile).code(), GPGP_ERROR_INVALID_HANDLE);
    for (const GpgpTile wrong : {GpgpTile(1), GpgpTile(1) << 32 | 5, ~GpgpTile(0), GpgpTile(4) << 32})
      EXPECT_EQ(world.set.recordFree(cmd, frame, wrong), GPGP_ERROR_INVALID_HANDLE) << wrong;
    ASSERT_EQ(world.set.record(cmd, frame, info, second), GPGP_SUCCESS); // in the same slot
    EXPECT_NE(second, tile);
    EXPECT_EQ(world.set.range(second)->slot, 0u);
    EXPECT_EQ(world.set.recordFree(cmd, frame, tile), GPGP_ERROR_INVALID_HANDLE);
    EXPECT_EQ(other.set.recordFree(cmd, frame, second), GPGP_ERROR_INVALID_HANDLE); // of another set
    GpgpTile first = 0; // and of one whose tiles have the same slots
    ASSERT_EQ(alike.set.record(cmd, frame, info, first), GPGP_SUCCESS);
    EXPECT_EQ(world.set.recordFree(cmd, frame, first), GPGP_ERROR_INVALID_HANDLE);
    EXPECT_EQ(alike.set.recordFree(cmd, frame, second), GPGP_ERROR_INVALID_HANDLE);
    ASSERT_EQ(alike.set.recordFree(cmd, frame, first), GPGP_SUCCESS);
    EXPECT_EQ(world.set.trim(second, 100000), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(world.set.recordFree(cmd, frame, second, 8), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(world.set.recordFree(nullptr, frame, second), GPGP_ERROR_INVALID_ARGUMENT);
    auto wrong = info;
    GpgpTile none = 0;
    wrong.capacity = 0;
    EXPECT_EQ(world.set.record(cmd, frame, wrong, none), GPGP_ERROR_INVALID_ARGUMENT);
    wrong = info;
    wrong.axiomCount = 0;
    EXPECT_EQ(world.set.record(cmd, frame, wrong, none), GPGP_ERROR_INVALID_ARGUMENT);
    wrong = info;
    wrong.hostAxioms = nullptr;
    EXPECT_EQ(world.set.record(cmd, frame, wrong, none), GPGP_ERROR_INVALID_ARGUMENT);
    wrong = info;
    wrong.flags = 2;
    EXPECT_EQ(world.set.record(cmd, frame, wrong, none), GPGP_ERROR_INVALID_ARGUMENT);
    wrong = info;
    wrong.axiomCount = 65; // more than the spawner's maxHostAxioms: nothing is taken
    const uint32_t used = world.set.report()->used;
    EXPECT_EQ(world.set.record(cmd, frame, wrong, none), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(world.set.report()->used, used);
    EXPECT_EQ(none, 0u);
    EXPECT_EQ(gpgpRecordTile(reinterpret_cast<GpgpHistory>(spawner), cmd, &frame, &info, &none),
              GPGP_ERROR_INVALID_HANDLE);
    EXPECT_EQ(gpgpRecordTile(world.set, cmd, nullptr, &info, &none), GPGP_ERROR_INVALID_ARGUMENT);
  });
  auto create = init<GpgpTileSetCreateInfo>();
  create.spawner = spawner;
  create.grammar = world.grammar;
  create.maxTiles = 2;
  create.instances = world.things.range();
  create.draws = world.draws.range();
  const auto refuses = [&](auto change) {
    auto wrong = create;
    change(wrong);
    GpgpHistory made = nullptr;
    EXPECT_EQ(gpgpCreateTileSet(context, &wrong, &made), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(made, nullptr);
  };
  refuses([](GpgpTileSetCreateInfo& c) { c.maxTiles = 0; });
  refuses([](GpgpTileSetCreateInfo& c) { c.maxTiles = 1000; }); // draws are too few
  refuses([](GpgpTileSetCreateInfo& c) { c.instances.buffer = VK_NULL_HANDLE; });
  refuses([](GpgpTileSetCreateInfo& c) { c.draws.buffer = VK_NULL_HANDLE; });
  refuses([](GpgpTileSetCreateInfo& c) { c.instances.size = 10; });
  refuses([](GpgpTileSetCreateInfo& c) { c.instances.offset = 2; });
  refuses([](GpgpTileSetCreateInfo& c) { c.vertices = c.instances; });
  messages.clear();
  destroy(world);
  destroy(alike);
  destroy(other);
}

} // namespace
