#include "atlas_world.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

namespace gpgp::test {
using namespace shader;
using visibility::CpuAtlasResult;

AtlasWorld::AtlasWorld(uint32_t triangleCount, uint32_t atlasWidth, uint32_t atlasHeight, std::mt19937& random)
    : triangles(triangleCount), width(atlasWidth), height(atlasHeight), bits((triangleCount + 31) / 32),
      sizes(size_t(triangleCount) * 3), buckets((triangleCount + 3) / 4), shadeBits((triangleCount + 31) / 32) {
  uint32_t vertex = 0;
  while (indices.size() < size_t(triangles) * 3) {
    const auto turn = static_cast<uint32_t>(random() % 3), turn2 = static_cast<uint32_t>(random() % 3);
    const auto add = [&](std::array<uint32_t, 3> corners, uint32_t t) {
      for (uint32_t i = 0; i < 3; ++i) indices.push_back(vertex + corners[(i + t) % 3]);
    };
    add({0, 1, 2}, turn);
    if (random() % 8) add({3, 2, 1}, turn2); // otherwise the next pair is off by one
    vertex += 4;
  }
  indices.resize(size_t(triangles) * 3);
  const uint32_t half = triangles / 2 | 1; // the second mesh begins at an odd triangle
  meshes = {{0, half * 3, 0}, {half * 3, (triangles - half) * 3, 0}};
  draws.resize(2);
  draws[1].mesh = 1;
  draws[1].firstTriangle = half;
  for (uint32_t& word : buckets) word = static_cast<uint32_t>(random());
}

void AtlasWorld::setVisible(uint32_t t, bool visible) {
  bits[t / 32] = (bits[t / 32] & ~(1u << t % 32)) | (visible ? 1u << t % 32 : 0);
}
void AtlasWorld::setSize(uint32_t t, float area, float side) {
  sizes[t * 3] = floatBitsToUint(area);
  sizes[t * 3 + 1] = sizes[t * 3 + 2] = floatBitsToUint(side);
}

visibility::CpuAtlasInput AtlasWorld::input() const {
  visibility::CpuAtlasInput input;
  AtlasParams& params = input.params;
  params.triangleCount = params.maxTriangles = triangles;
  params.superColumns = width / kSuperSide;
  params.superCount = params.superColumns * (height / kSuperSide);
  params.scale = 1;
  params.findsPairs = findsPairs;
  params.indexCount = static_cast<uint32_t>(indices.size());
  params.bucketCount = bucketCount;
  params.hasBuckets = bucketCount > 1;
  params.hasShade = hasShade;
  params.tileCapacity = allTiles();
  params.newCapacity = params.changedCapacity = params.goneCapacity = allListed();
  input.bits = bits;
  input.sizes = sizes;
  input.draws = draws;
  input.meshes = meshes;
  input.indices = indices;
  input.buckets = buckets;
  input.shadeBits = shadeBits;
  return input;
}

void expectSound(const AtlasWorld& world, const CpuAtlasResult& result, const std::vector<uint32_t>& before) {
  std::vector<uint32_t> painted(size_t(world.width) * world.height / 16); // 4 x 4 texels: the triangle, plus one
  std::array<uint32_t, kClasses> byClass{};
  uint32_t overlaps = 0, outside = 0, withoutBlock = 0, blocks = 0, texels = 0, wrongTiles = 0, moved = 0;
  const std::set<uint32_t> added(result.added.begin(), result.added.end()),
      changed(result.changed.begin(), result.changed.end()), gone(result.gone.begin(), result.gone.end());
  std::vector<uint32_t> owned(world.triangles); // tiles
  for (uint32_t t = 0; t < world.triangles; ++t) {
    const uint32_t word = result.blocks[t];
    withoutBlock += world.isVisible(t) && !gpgpAtlasHasBlock(word);
    const GpgpAtlasBlock b = gpgpAtlasBlock(word);
    const bool own = b.width && !b.second;
    if (!before.empty()) {
      const bool had = gpgpAtlasHasBlock(before[t]) && !gpgpAtlasBlock(before[t]).second;
      if (own && had && !changed.contains(t)) moved += word != before[t]; // what is not listed stays
      EXPECT_EQ(own && !had, added.contains(t)) << t;
      EXPECT_EQ(had && !own, gone.contains(t)) << t;
    }
    if (!own) continue;
    ++blocks;
    texels += b.width * b.height;
    for (uint32_t c = kMinClass; c <= kMaxClass; ++c) byClass[c - kMinClass] += b.width * b.height == 1u << c;
    owned[t] = b.width * b.height / 16;
    for (uint32_t y = b.y / 4; y < (b.y + b.height) / 4; ++y)
      for (uint32_t x = b.x / 4; x < (b.x + b.width) / 4; ++x) {
        if (x >= world.width / 4 || y >= world.height / 4) {
          ++outside;
          continue;
        }
        uint32_t& place = painted[size_t(y) * world.width / 4 + x];
        overlaps += place != 0;
        place = t + 1;
      }
  }
  for (const auto& [t, tile] : result.tiles) wrongTiles += tile >= owned[t];
  const AtlasCounters& counters = result.counters;
  EXPECT_EQ(overlaps, 0u);
  EXPECT_EQ(outside, 0u);
  EXPECT_EQ(moved, 0u);
  EXPECT_EQ(wrongTiles, 0u);
  EXPECT_EQ(withoutBlock, counters.droppedTriangles);
  EXPECT_EQ(blocks, counters.blocks);
  EXPECT_EQ(texels, counters.texels);
  EXPECT_TRUE(std::equal(byClass.begin(), byClass.end(), counters.byClass));
  EXPECT_EQ(counters.added + counters.changed + counters.kept, counters.blocks);
  EXPECT_EQ(counters.dropped == 0 && counters.lowered == 0, counters.pressure == 0);
  EXPECT_LE(counters.supers, world.width * world.height / kSuperSide / kSuperSide);
  EXPECT_LE(counters.leastSupers, counters.supers);
}

AtlasGpu::AtlasGpu(DeviceTest& fixture, GpgpRecorder recorder, const AtlasWorld& world)
    : fixture_(fixture), recorder_(recorder) {
  GpgpAtlasCreateInfo info = GPGP_ATLAS_CREATE_INFO_INIT;
  info.label = "atlas";
  info.width = world.width;
  info.height = world.height;
  info.maxTriangles = world.triangles;
  EXPECT_EQ(gpgpCreateAtlas(fixture.context, &info, &atlas_), GPGP_SUCCESS);
  GpgpGeometrySetCreateInfo set = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  set.meshes = reinterpret_cast<const GpgpMesh*>(world.meshes.data());
  set.meshCount = static_cast<uint32_t>(world.meshes.size());
  EXPECT_EQ(gpgpCreateGeometrySet(fixture.context, &set, &geometry_), GPGP_SUCCESS);
  for (VkDeviceSize pending = 1; pending;) {
    const GpgpFrame frame = fixture.advance();
    fixture.device.submitAndWait(fixture.device.graphics(), [&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordUpload(fixture.context, cmd, &frame, 0, &pending), GPGP_SUCCESS);
    });
  }
}

AtlasGpu::~AtlasGpu() {
  gpgpDestroyHistory(atlas_);
  gpgpDestroyAsset(geometry_);
}

CpuAtlasResult AtlasGpu::step(const AtlasWorld& world, GpgpAtlasReport& report) {
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  host::HeadlessDevice& device = fixture_.device;
  const auto copy = [&](const auto& data) { return host::makeBuffer(device, data, kStorage); };
  const auto make = [&](VkDeviceSize words) {
    host::Buffer buffer(device, words * 4, kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    host::fill(device, buffer, 0xdeadbeef);
    return buffer;
  };
  const auto toHost = [](const host::Buffer& buffer) {
    return buffer.range({}, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}});
  };
  const host::Buffer bits = copy(world.bits), sizes = copy(world.sizes), buckets = copy(world.buckets),
                     shade = copy(world.shadeBits), draws = copy(world.draws), indices = copy(world.indices);
  blocks = make(world.triangles);
  tiles = make(world.allTiles() * 2);
  const host::Buffer dispatches = make(world.bucketCount * kArgumentWords), added = make(world.allListed()),
                     changed = make(world.allListed()), gone = make(world.allListed()), counts = make(4);
  GpgpAtlasInfo info = GPGP_ATLAS_INFO_INIT;
  info.atlas = atlas_;
  info.triangleCount = world.triangles;
  info.visibleBits = bits.range();
  info.triangleSizes = sizes.range();
  if (world.findsPairs) {
    info.geometrySet = geometry_;
    info.draws = draws.range();
    info.drawCount = static_cast<uint32_t>(world.draws.size());
    info.indices = indices.range();
  }
  info.indexType = VK_INDEX_TYPE_UINT32;
  if (world.bucketCount > 1) info.buckets = buckets.range();
  info.bucketCount = world.bucketCount;
  if (world.hasShade) info.shadeBits = shade.range();
  info.blocks = toHost(blocks);
  info.tiles = toHost(tiles);
  info.dispatches = toHost(dispatches);
  info.newBlocks = toHost(added);
  info.changedBlocks = toHost(changed);
  info.goneBlocks = toHost(gone);
  info.counts = toHost(counts);
  const GpgpFrame frame = fixture_.advance();
  device.submitAndWait(device.graphics(), [&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordPrepareAtlas(recorder_, cmd, &frame, &info), GPGP_SUCCESS) << fixture_.lastMessage();
  });
  fixture_.advance();
  report = GPGP_ATLAS_REPORT_INIT;
  EXPECT_EQ(gpgpGetAtlasReport(recorder_, &report), GPGP_SUCCESS);

  CpuAtlasResult result;
  const auto listOf = [&](const host::Buffer& buffer, uint32_t count) {
    return host::download<uint32_t>(device, buffer, std::min(count, world.allListed()));
  };
  result.blocks = host::download<uint32_t>(device, blocks, world.triangles);
  result.dispatches = host::download<uint32_t>(device, dispatches, world.bucketCount * kArgumentWords);
  result.tiles = host::download<std::array<uint32_t, 2>>(device, tiles, std::min(report.tiles, world.allTiles()));
  result.added = listOf(added, report.newBlocks);
  result.changed = listOf(changed, report.changedBlocks);
  result.gone = listOf(gone, report.goneBlocks);
  EXPECT_EQ(host::download<uint32_t>(device, counts, 4),
            (std::vector<uint32_t>{report.newBlocks, report.changedBlocks, report.goneBlocks, report.tiles}));
  AtlasCounters& counters = result.counters;
  counters.visible = report.visibleTriangles;
  counters.blocks = report.blocks;
  std::copy_n(report.blocksByClass, kClasses, counters.byClass);
  counters.added = report.newBlocks;
  counters.changed = report.changedBlocks;
  counters.kept = report.keptBlocks;
  counters.gone = report.goneBlocks;
  counters.vacated = report.vacatedBlocks;
  counters.lowered = report.loweredBlocks;
  counters.dropped = report.droppedBlocks;
  counters.droppedTriangles = report.droppedTriangles;
  counters.tiles = report.tiles;
  counters.supers = report.superblocks;
  counters.pressure = report.pressure;
  counters.repacked = report.repacked;
  return result;
}

} // namespace gpgp::test
