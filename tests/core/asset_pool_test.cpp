// Assets in shared buffers: random allocations never overlap, lie in few buffers, and leave nothing behind.
#include "api/check.h"
#include "core/context.h"
#include "host/device.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace {
using namespace gpgp;

TEST(AssetPool, PartsDoNotOverlapAndBuffersAreFew) {
  host::HeadlessDevice device(host::DeviceOptions{.validation = true});
  const GpgpContextCreateInfo info = device.contextCreateInfo();
  GpgpContext handle = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
  core::Context& context = *reinterpret_cast<core::Context*>(handle);
  const auto bytes = [&] {
    GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
    EXPECT_EQ(gpgpGetMemoryReport(handle, &report), GPGP_SUCCESS);
    return report.services[GPGP_SERVICE_VECTOR].deviceBytes;
  };
  const VkDeviceSize before = bytes();
  std::mt19937 random(1);
  std::multimap<VkBuffer, core::AssetPool::Place> places;
  VkDeviceSize living = 0, most = 0;
  for (int step = 0; step < 4000; ++step) {
    if (!places.empty() && random() % 5 < 2) {
      auto at = places.begin();
      std::advance(at, static_cast<long>(random() % places.size()));
      living -= at->second.size;
      context.assetPool().free(at->second);
      places.erase(at);
      continue;
    }
    const VkDeviceSize size = 16 + random() % (random() % 50 ? 8192 : 400000);
    const auto place = context.assetPool().allocate(GPGP_SERVICE_VECTOR, size);
    ASSERT_TRUE(place) << place.error().text;
    EXPECT_EQ(place->offset % 256, 0u);
    EXPECT_GE(place->size, size);
    ASSERT_LE(place->offset + place->size, place->bufferSize);
    const auto [first, last] = places.equal_range(place->buffer);
    for (auto other = first; other != last; ++other)
      ASSERT_TRUE(other->second.offset + other->second.size <= place->offset ||
                  place->offset + place->size <= other->second.offset);
    places.emplace(place->buffer, *place);
    living += place->size;
    most = std::max(most, living);
    std::set<VkBuffer> buffers;
    for (const auto& [buffer, ignored] : places) buffers.insert(buffer);
    ASSERT_LE(buffers.size(), 8u) << living;
  }
  EXPECT_GT(most, VkDeviceSize(4) << 20); // more than the first blocks hold
  EXPECT_LE(bytes() - before, 3 * most + (VkDeviceSize(1) << 20));
  for (const auto& [buffer, place] : places) context.assetPool().free(place);
  EXPECT_EQ(bytes(), before);
  // Small ones lie together, whatever large ones come and go beside them.
  std::set<VkBuffer> smalls;
  std::vector<core::AssetPool::Place> few, many;
  for (int i = 0; i < 64; ++i) {
    const auto small = context.assetPool().allocate(GPGP_SERVICE_VECTOR, 512);
    const auto large = context.assetPool().allocate(GPGP_SERVICE_VECTOR, VkDeviceSize(1) << 20);
    ASSERT_TRUE(small && large);
    smalls.insert(small->buffer);
    few.push_back(*small);
    many.push_back(*large);
  }
  EXPECT_EQ(smalls.size(), 1u);
  for (const auto& place : many) context.assetPool().free(place);
  EXPECT_EQ(bytes() - before, VkDeviceSize(1) << 20);
  for (const auto& place : few) context.assetPool().free(place);
  // What no block of theirs holds.
  const VkDeviceSize huge = VkDeviceSize(3) << 20;
  const auto large = context.assetPool().allocate(GPGP_SERVICE_VECTOR, huge);
  ASSERT_TRUE(large);
  EXPECT_EQ(large->offset, 0u);
  EXPECT_EQ(bytes() - before, huge);
  context.assetPool().free(*large);
  gpgpDestroyContext(handle);
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
}

} // namespace
