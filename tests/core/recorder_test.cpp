// Frames, uploads, records, reports and deferred destruction, on a real device with validation.
#include "api/check.h"
#include "host/device.h"
#include "host/frames.h"
#include "host/memory.h"
#include "toy_recorder.h"

#include <gtest/gtest.h>

#include <numeric>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct RecorderTest : testing::Test {
  host::HeadlessDevice device{host::DeviceOptions{.validation = true}};
  GpgpContext handle = nullptr;
  core::Context* context = nullptr;
  std::vector<std::string> messages;
  uint64_t frame = 0;

  void SetUp() override {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.label = "test";
    info.maxFramesInFlight = 3;
    info.maxRecordingsPerFrame = 2;
    info.uploadRingBytes = 4096;
    info.messageUserData = &messages;
    info.messageFn = [](void* user, const GpgpMessage* m) {
      static_cast<std::vector<std::string>*>(user)->push_back(std::string(m->function) + ": " + m->text);
    };
    ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
    context = reinterpret_cast<core::Context*>(handle);
  }
  void TearDown() override {
    device.waitIdle();
    gpgpDestroyContext(handle);
    for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
  }
  GpgpFrame advance(uint64_t inFlight = 1) {
    ++frame;
    const GpgpFrame f{frame, frame > inFlight ? frame - inFlight : 0};
    EXPECT_EQ(gpgpAdvance(handle, &f), GPGP_SUCCESS);
    return f;
  }
};

TEST_F(RecorderTest, UploadsInPiecesWithinTheBudgetAndTheRing) {
  std::vector<uint32_t> data(5000); // 20000 bytes through a ring of 4096
  std::iota(data.begin(), data.end(), 1u);
  const auto asset = ToyAsset::create(*context, data);
  ASSERT_TRUE(asset);
  int uploads = 0;
  VkDeviceSize pending = 1, last = 20000;
  while (pending) {
    const GpgpFrame f = advance();
    device.submitAndWait(
        [&](VkCommandBuffer cmd) { ASSERT_EQ(gpgpRecordUpload(handle, cmd, &f, 3000, &pending), GPGP_SUCCESS); });
    EXPECT_LE(last - pending, 3000u);
    last = pending;
    ASSERT_LT(++uploads, 100);
  }
  EXPECT_TRUE(asset->resident());
  EXPECT_GE(uploads, 20000 / 3000);
}

TEST_F(RecorderTest, DerivesReportsInOrder) {
  std::vector<uint32_t> data(1000);
  std::iota(data.begin(), data.end(), 1u);
  const auto asset = ToyAsset::create(*context, data);
  auto made = ToyRecorder::create(*context, {"toy", device.graphics().family, 0, VK_FALSE});
  ASSERT_TRUE(made) << made.error().text;
  auto& recorder = *made;
  ASSERT_TRUE(recorder->prewarm(nullptr));
  host::Buffer output(device, 4000, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, host::Memory::readback);
  GpgpBuffer range = output.range({}, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, {}});
  for (uint32_t factor = 1; factor <= 6; ++factor) {
    const GpgpFrame f = advance();
    GpgpRecordingInfo base{};
    base.tag = factor;
    const bool dropped = factor == 4;
    const auto record = [&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordUpload(handle, cmd, &f, 0, nullptr), GPGP_SUCCESS);
      const auto ok = recorder->run(cmd, base, *asset, range, 1000, factor);
      ASSERT_TRUE(ok) << ok.error().text;
    };
    if (dropped) {
      host::FrameRing ring(device, 1);
      record(ring.begin());
      ring.drop();
    } else {
      device.submitAndWait(record);
      for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(output.as<uint32_t>()[i], (i + 1) * factor);
    }
  }
  advance();
  for (uint32_t factor = 1; factor <= 6; ++factor) {
    core::RawReport report;
    ASSERT_TRUE(recorder->takeReport(report)) << factor;
    EXPECT_EQ(report.header.tag, factor);
    EXPECT_EQ(report.header.frame, factor);
    EXPECT_EQ(report.header.status, factor == 4 ? GPGP_NOT_EXECUTED : GPGP_SUCCESS);
    EXPECT_EQ(report.words[0], factor == 4 ? 0 : 500500u * factor);
    EXPECT_EQ(report.words[1], factor == 4 ? 0 : 2u);
  }
  core::RawReport none;
  EXPECT_FALSE(recorder->takeReport(none));
}

TEST_F(RecorderTest, RefusesMoreRecordsThanPromised) {
  const std::vector<uint32_t> data(16, 1);
  const auto asset = ToyAsset::create(*context, data);
  auto made = ToyRecorder::create(*context, {"toy", device.graphics().family, 0, VK_FALSE});
  ASSERT_TRUE(made);
  ASSERT_TRUE((*made)->prewarm(nullptr));
  host::Buffer output(device, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const GpgpBuffer range = output.range();
  advance();
  const GpgpRecordingInfo base{};
  device.submitAndWait([&](VkCommandBuffer cmd) {
    EXPECT_TRUE((*made)->run(cmd, base, *asset, range, 16, 1));
    EXPECT_TRUE((*made)->run(cmd, base, *asset, range, 16, 1));
    const auto third = (*made)->run(cmd, base, *asset, range, 16, 1);
    ASSERT_FALSE(third);
    EXPECT_EQ(third.error().code, GPGP_ERROR_TOO_MANY_RECORDINGS);
  });
  advance();
  device.submitAndWait([&](VkCommandBuffer cmd) { EXPECT_TRUE((*made)->run(cmd, base, *asset, range, 16, 1)); });
}

TEST_F(RecorderTest, AnUploadThatNeverRanIsPendingAgain) {
  const std::vector<uint32_t> data(16, 1);
  const auto asset = ToyAsset::create(*context, data);
  GpgpFrame f = advance();
  {
    host::FrameRing ring(device, 1);
    ASSERT_EQ(gpgpRecordUpload(handle, ring.begin(), &f, 0, nullptr), GPGP_SUCCESS);
    EXPECT_TRUE(asset->resident());
    ring.drop();
  }
  f = advance();
  EXPECT_FALSE(asset->resident());
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("never executed"), std::string::npos);
  device.submitAndWait(
      [&](VkCommandBuffer cmd) { ASSERT_EQ(gpgpRecordUpload(handle, cmd, &f, 0, nullptr), GPGP_SUCCESS); });
  advance();
  EXPECT_TRUE(asset->resident());
}

TEST_F(RecorderTest, DestroyedHandlesAreRecognisedAndMemoryWaitsForSafeFrames) {
  advance();
  GpgpMemoryReport before = GPGP_MEMORY_REPORT_INIT;
  ASSERT_EQ(gpgpGetMemoryReport(handle, &before), GPGP_SUCCESS);
  const std::vector<uint32_t> data(1024, 1);
  const auto asset = api::adopt<GpgpAsset>(*context, ToyAsset::create(*context, data));
  VkBool32 resident = VK_TRUE;
  EXPECT_EQ(gpgpGetResidency(asset, &resident), GPGP_SUCCESS);
  EXPECT_EQ(resident, VK_FALSE);
  gpgpDestroyAsset(asset);
  EXPECT_EQ(gpgpGetResidency(asset, &resident), GPGP_ERROR_INVALID_HANDLE);
  GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
  ASSERT_EQ(gpgpGetMemoryReport(handle, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.services[GPGP_SERVICE_CORE].pendingBytes, 4096u);
  for (int i = 0; i < 3; ++i) advance(2);
  ASSERT_EQ(gpgpGetMemoryReport(handle, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.services[GPGP_SERVICE_CORE].pendingBytes, 0u);
  EXPECT_EQ(report.services[GPGP_SERVICE_CORE].deviceBytes, before.services[GPGP_SERVICE_CORE].deviceBytes);
}

TEST(PassList, PlacesBarriersOnlyWhereDataFlows) {
  core::PassList list(std::pmr::get_default_resource());
  const auto a = list.add({"a", core::ResourceKind::scratch, 100});
  const auto b = list.add({"b", core::ResourceKind::scratch, 300});
  using enum core::UseKind;
  list.dispatch("write a", 0, {{a, write}}, 0);
  list.dispatch("write b", 0, {{b, write}}, 0);             // independent
  list.dispatch("read both", 0, {{a, read}, {b, read}}, 0); // after writes
  list.dispatch("read again", 0, {{a, read}}, 0);           // reads beside reads
  list.dispatch("overwrite", 0, {{a, write}}, 0);           // after a read
  list.fill("clear", b, 0);                                 // b was read before that barrier
  list.dispatchIndirect("indirect", 0, {{b, read}}, a, 0);
  list.finish(256);
  std::vector<bool> barriers;
  for (const core::Pass& pass : list.passes) barriers.push_back(pass.barrierBefore);
  EXPECT_EQ(barriers, (std::vector<bool>{false, false, true, false, true, false, true}));
  const uint32_t direct = 1u << uint32_t(core::PassKind::dispatch), fill = 1u << uint32_t(core::PassKind::fill);
  const uint32_t counted = 1u << uint32_t(core::PassKind::dispatchIndirect);
  std::vector<uint32_t> kinds;
  for (const core::Pass& pass : list.passes) kinds.push_back(pass.kindsAhead);
  EXPECT_EQ(kinds, (std::vector<uint32_t>{direct, direct, direct, direct, direct | fill, fill, counted}));
  EXPECT_EQ(list.scratchOffsets[a], 0u);
  EXPECT_EQ(list.scratchOffsets[b], 256u);
  EXPECT_EQ(list.scratchBytes, 768u);
}

} // namespace
