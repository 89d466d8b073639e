// What every recording function promises the engine, on every service: what it calls, what state it leaves, which
// barriers it places, and that scratch, drops, frames in flight and kinds of command buffers do not matter.
#include "aligned.h"
#include "counting_new.h"
#include "host/frames.h"
#include "scenarios.h"
#include "vulkan_proxy.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <thread>

namespace {
using namespace gpgp;
using namespace gpgp::test;

struct ContractTest : testing::TestWithParam<std::string> {
  host::HeadlessDevice& device = sharedDevice();
  VulkanProxy proxy{device};
  std::vector<std::string> messages;
  GpgpContext context = nullptr;
  std::unique_ptr<Scenario> scenario;
  uint64_t hostAllocations = 0;
  GpgpHostAllocator allocator{&hostAllocations,
                              [](void* user, size_t size, size_t alignment) {
                                ++*static_cast<uint64_t*>(user);
                                return allocateAligned(size, alignment);
                              },
                              [](void* user, void* memory, size_t, size_t) {
                                ++*static_cast<uint64_t*>(user);
                                freeAligned(memory);
                              }};

  void SetUp() override {
    GpgpContextCreateInfo info = scenarioContextInfo(device, &messages);
    info.getInstanceProcAddr = VulkanProxy::getInstanceProcAddr();
    info.hostAllocator = &allocator;
    ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
    scenario = makeScenario(GetParam(), device);
  }
  void TearDown() override {
    device.waitIdle();
    gpgpDestroyContext(context);
    scenario.reset();
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }

  /// Asset, recorder and view made, prewarmed and uploaded, in frame 1.
  void prepare(const host::Queue& queue, bool engineScratch = false) {
    ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS) << lastMessage();
    ASSERT_EQ(scenario->createRecorder(context, {"recorder", queue.family, 0, engineScratch}), GPGP_SUCCESS)
        << lastMessage();
    ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS) << lastMessage();
    ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS) << lastMessage();
    const GpgpFrame frame = advance();
    device.submitAndWait(queue, [&](VkCommandBuffer cmd) {
      ASSERT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
    });
  }
  void prepare(bool engineScratch = false) { prepare(device.graphics(), engineScratch); }
  GpgpFrame advance() {
    ++number;
    const GpgpFrame frame{number, number - 1};
    EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS) << lastMessage();
    return frame;
  }
  std::string lastMessage() const { return messages.empty() ? "no message" : messages.back(); }
  /// Runs one recording on a queue, and returns its results.
  std::vector<uint32_t> run(const host::Queue& queue, const GpgpRecordingInfo& base = {}) {
    scenario->clearOutputs();
    const GpgpFrame frame = advance();
    device.submitAndWait(queue, [&](VkCommandBuffer cmd) {
      ASSERT_EQ(scenario->record(cmd, frame, base), GPGP_SUCCESS) << lastMessage();
    });
    return scenario->results();
  }
  void expectReport(GpgpResult status) {
    GpgpReportHeader header{};
    bool meaningful = false;
    ASSERT_EQ(scenario->takeReport(header, meaningful), GPGP_SUCCESS) << lastMessage();
    EXPECT_EQ(header.status, status);
    EXPECT_EQ(meaningful, status == GPGP_SUCCESS);
  }
  uint64_t number = 0;
};

TEST_P(ContractTest, RecordingOnlyRecords) {
  prepare();
  const GpgpFrame frame = advance();
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  proxy.clear();
  const uint64_t allocationsBefore = hostAllocations, newBefore = countingNewCalls();
  const GpgpResult result = scenario->record(cmd, frame, {});
  const uint64_t newCalls = countingNewCalls() - newBefore;
  ASSERT_EQ(result, GPGP_SUCCESS) << lastMessage();
  EXPECT_EQ(hostAllocations, allocationsBefore) << "recording allocated from the engine's callbacks";
  EXPECT_EQ(newCalls, 0u) << "recording allocated behind the callbacks";
  ASSERT_FALSE(proxy.calls.empty());
  std::set<std::string_view> strange;
  for (const LoggedCall& call : proxy.calls)
    if (call.name.rfind("vkCmd", 0) != 0 && call.name != "vkUpdateDescriptorSets") strange.insert(call.name);
  EXPECT_TRUE(strange.empty()) << "recording called " << *strange.begin();
  ring.drop();
}

TEST_P(ContractTest, UploadingOnlyRecordsTransfersAndOneBarrier) {
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
  const GpgpFrame frame = advance();
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  proxy.clear();
  const uint64_t allocationsBefore = hostAllocations, newBefore = countingNewCalls();
  const GpgpResult result = gpgpRecordUpload(context, cmd, &frame, 0, nullptr);
  const uint64_t newCalls = countingNewCalls() - newBefore;
  ASSERT_EQ(result, GPGP_SUCCESS) << lastMessage();
  EXPECT_EQ(hostAllocations, allocationsBefore);
  EXPECT_EQ(newCalls, 0u);
  ASSERT_GE(proxy.calls.size(), 2u);
  for (size_t i = 0; i < proxy.calls.size(); ++i) {
    const std::string_view name = proxy.calls[i].name;
    if (i + 1 < proxy.calls.size())
      EXPECT_TRUE(name == "vkCmdCopyBuffer" || name == "vkCmdFillBuffer") << name;
    else
      EXPECT_EQ(name, "vkCmdPipelineBarrier");
  }
  const LoggedCall& barrier = proxy.calls.back();
  EXPECT_EQ(barrier.sourceStages, VkPipelineStageFlags(VK_PIPELINE_STAGE_TRANSFER_BIT));
  EXPECT_TRUE(barrier.targetStages & VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  EXPECT_TRUE(barrier.targetAccess & VK_ACCESS_MEMORY_READ_BIT);

  proxy.clear(); // nothing is pending any more: nothing is recorded
  EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
  EXPECT_TRUE(proxy.calls.empty());
  ring.drop();
}

TEST_P(ContractTest, DrawingOnlyRecordsADraw) {
  if (GetParam() != "vector") GTEST_SKIP() << GetParam() << " records nothing inside a render pass";
#if defined(GPGP_WITH_VECTOR)
  if (!(device.features() & GPGP_FEATURE_DYNAMIC_RENDERING)) GTEST_SKIP() << device.name() << " renders in passes only";
  prepare();
  GpgpTargetInfo target = GPGP_TARGET_INFO_INIT;
  target.colorFormat = VK_FORMAT_R8G8B8A8_UNORM;
  GpgpPrewarmInfo prewarm = GPGP_PREWARM_INFO_INIT;
  prewarm.targets = &target;
  prewarm.targetCount = 1;
  ASSERT_EQ(gpgpPrewarm(scenario->recorder, &prewarm), GPGP_SUCCESS) << lastMessage();
  const host::Image image(device, {target.colorFormat, 64, 64, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
  const GpgpFrame frame = advance();
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  GpgpCanvasDrawInfo info = GPGP_CANVAS_DRAW_INFO_INIT;
  info.history = scenario->view;
  info.target = &target;
  info.width = info.height = 64;
  for (int i = 0; i < 4; ++i) info.clip[i * 5] = 1;
  EXPECT_EQ(gpgpRecordDrawCanvas(scenario->recorder, cmd, &frame, &info), GPGP_NOT_READY) << "nothing was prepared";
  ASSERT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS) << lastMessage();

  host::imageBarrier(device, cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  attachment.imageView = image.view();
  attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = {64, 64};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &attachment;
  const VolkDeviceTable& vk = device.vk();
  vk.vkCmdBeginRenderingKHR(cmd, &rendering);
  const VkViewport viewport{0, 0, 64, 64, 0, 1};
  const VkRect2D scissor{{0, 0}, {64, 64}};
  vk.vkCmdSetViewport(cmd, 0, 1, &viewport);
  vk.vkCmdSetScissor(cmd, 0, 1, &scissor);
  proxy.clear();
  const uint64_t allocationsBefore = hostAllocations, newBefore = countingNewCalls();
  const GpgpResult result = gpgpRecordDrawCanvas(scenario->recorder, cmd, &frame, &info);
  const uint64_t newCalls = countingNewCalls() - newBefore;
  ASSERT_EQ(result, GPGP_SUCCESS) << lastMessage();
  EXPECT_EQ(hostAllocations, allocationsBefore);
  EXPECT_EQ(newCalls, 0u);
  int draws = 0;
  for (const LoggedCall& call : proxy.calls) {
    draws += call.name == "vkCmdDraw";
    if (call.name == "vkCmdBindPipeline" || call.name == "vkCmdBindDescriptorSets") {
      EXPECT_EQ(call.bindPoint, VK_PIPELINE_BIND_POINT_GRAPHICS);
      continue;
    }
    EXPECT_TRUE(call.name == "vkCmdDraw" || call.name == "vkCmdPushConstants" ||
                call.name == "vkUpdateDescriptorSets" || call.name.find("Label") != std::string_view::npos)
        << call.name;
  }
  EXPECT_EQ(draws, 1);
  vk.vkCmdEndRenderingKHR(cmd);
  ring.submit(); // validation sees the whole
  ring.waitAll();
#endif
}

TEST_P(ContractTest, LeavesExactlyTheDocumentedState) {
  prepare();
  const GpgpFrame frame = advance();
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  proxy.clear();
  ASSERT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS);
  static const std::set<std::string_view> kStateless = {"vkCmdDispatch",
                                                        "vkCmdDispatchIndirect",
                                                        "vkCmdFillBuffer",
                                                        "vkCmdCopyBuffer",
                                                        "vkCmdPipelineBarrier",
                                                        "vkUpdateDescriptorSets",
                                                        "vkCmdBeginDebugUtilsLabelEXT",
                                                        "vkCmdEndDebugUtilsLabelEXT"};
  bool pipeline = false, set = false;
  int labels = 0;
  for (const LoggedCall& call : proxy.calls) {
    if (call.name == "vkCmdBeginDebugUtilsLabelEXT") ++labels;
    if (call.name == "vkCmdEndDebugUtilsLabelEXT") --labels;
    if (call.name == "vkCmdBindPipeline") {
      EXPECT_EQ(call.bindPoint, VK_PIPELINE_BIND_POINT_COMPUTE);
      pipeline = true;
    } else if (call.name == "vkCmdBindDescriptorSets") {
      EXPECT_EQ(call.bindPoint, VK_PIPELINE_BIND_POINT_COMPUTE);
      EXPECT_EQ(call.firstSet, 0u);
      EXPECT_EQ(call.setCount, 1u);
      set = true;
    } else if (call.name != "vkCmdPushConstants") {
      EXPECT_TRUE(kStateless.count(call.name)) << call.name << " changes state that the header does not name";
    }
  }
  EXPECT_TRUE(pipeline && set);
  EXPECT_EQ(labels, 0) << "debug labels are not balanced";
  ring.drop();
}

TEST_P(ContractTest, PlacesTheDocumentedBarriersAtTheEdges) {
  prepare();
  for (const bool synchronised : {false, true}) {
    const GpgpFrame frame = advance();
    host::FrameRing ring(device, 1);
    const VkCommandBuffer cmd = ring.begin();
    GpgpRecordingInfo base{};
    base.accessMode = synchronised ? GPGP_ACCESS_EXTERNAL_BARRIERS : 0;
    proxy.clear();
    ASSERT_EQ(scenario->record(cmd, frame, base), GPGP_SUCCESS) << lastMessage();
    std::vector<const LoggedCall*> work;
    for (const LoggedCall& call : proxy.calls)
      if (call.name != "vkUpdateDescriptorSets" && call.name.find("Label") == std::string_view::npos)
        work.push_back(&call);
    ASSERT_GE(work.size(), 3u);
    EXPECT_EQ(work.front()->name, "vkCmdPipelineBarrier");
    EXPECT_EQ(work.back()->name, "vkCmdPipelineBarrier");
    const bool images = GetParam() == "vector";
    const VkPipelineStageFlags before = images ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_HOST_BIT;
    const VkPipelineStageFlags after = VK_PIPELINE_STAGE_TRANSFER_BIT;
    if (synchronised) {
      EXPECT_TRUE(work.front()->imageCount == 0);
      EXPECT_TRUE(work.back()->imageCount == 0);
      EXPECT_FALSE(work.front()->sourceStages & VK_PIPELINE_STAGE_HOST_BIT);
      EXPECT_FALSE(work.back()->targetStages & VK_PIPELINE_STAGE_TRANSFER_BIT);
    } else {
      EXPECT_EQ(work.front()->sourceStages & before, before);
      EXPECT_EQ(work.back()->targetStages & after, after);
      EXPECT_EQ(work.front()->imageCount, images ? 1u : 0u);
      EXPECT_EQ(work.back()->imageCount, images ? 1u : 0u);
    }
    EXPECT_TRUE(work.back()->targetStages & VK_PIPELINE_STAGE_HOST_BIT) << "reports are read by the host";
    ring.drop();
  }
}

TEST_P(ContractTest, ScratchContentsDoNotMatter) {
  prepare(true);
  VkDeviceSize size = 0, alignment = 0;
  VkBufferUsageFlags usage = 0;
  ASSERT_EQ(gpgpGetScratchSize(scenario->recorder, &size, &alignment, &usage), GPGP_SUCCESS);
  ASSERT_GT(size, 0u);
  host::Buffer scratch(device, size + alignment, usage);
  GpgpRecordingInfo base{};
  base.scratch = scratch.range({}, {}, alignment, size);
  std::vector<std::vector<uint32_t>> results;
  for (const uint32_t poison : {0u, 0xffffffffu, 0x7fc00000u, 0xdeadbeefu}) {
    host::fill(device, scratch, poison);
    results.push_back(run(device.graphics(), base));
    EXPECT_EQ(results.back(), results.front()) << "with scratch poisoned by " << std::hex << poison;
  }
  advance();
  for (int i = 0; i < 4; ++i) expectReport(GPGP_SUCCESS);
}

TEST_P(ContractTest, ADroppedCommandBufferIsReportedAndForgotten) {
  prepare();
  const auto expected = run(device.graphics());
  const GpgpFrame frame = advance();
  expectReport(GPGP_SUCCESS);
  host::FrameRing ring(device, 1);
  ASSERT_EQ(scenario->record(ring.begin(), frame, {}), GPGP_SUCCESS);
  ring.drop();
  EXPECT_EQ(run(device.graphics()), expected);
  advance();
  expectReport(GPGP_NOT_EXECUTED);
  expectReport(GPGP_SUCCESS);
}

TEST_P(ContractTest, ThreeFramesInFlight) {
  prepare();
  const auto expected = run(device.graphics());
  advance();
  expectReport(GPGP_SUCCESS);
  scenario->clearOutputs();
  host::FrameRing ring(device, 3);
  const uint64_t offset = number;
  int reports = 0;
  const auto take = [&] {
    GpgpReportHeader header{};
    bool meaningful = false;
    while (scenario->takeReport(header, meaningful) == GPGP_SUCCESS) {
      EXPECT_EQ(header.status, GPGP_SUCCESS);
      EXPECT_TRUE(meaningful);
      EXPECT_EQ(header.tag, static_cast<uint64_t>(reports++));
    }
  };
  for (uint64_t i = 0; i < 9; ++i) {
    const VkCommandBuffer cmd = ring.begin();
    const GpgpFrame frame{ring.frame().current + offset, ring.frame().safe + offset};
    ASSERT_EQ(gpgpAdvance(context, &frame), GPGP_SUCCESS) << lastMessage();
    take();
    GpgpRecordingInfo base{};
    base.tag = i;
    ASSERT_EQ(scenario->record(cmd, frame, base), GPGP_SUCCESS) << lastMessage();
    ring.submit();
    number = frame.current;
  }
  ring.waitAll();
  EXPECT_EQ(scenario->results(), expected);
  advance();
  take();
  EXPECT_EQ(reports, 9);
}

TEST_P(ContractTest, SecondaryCommandBuffersAndTimestamps) {
  prepare();
  const auto expected = run(device.graphics());
  scenario->clearOutputs();
  uint32_t passes = 0;
  ASSERT_EQ(gpgpGetPasses(scenario->recorder, &passes, nullptr), GPGP_SUCCESS);
  ASSERT_GT(passes, 0u);
  std::vector<const char*> names(passes);
  ASSERT_EQ(gpgpGetPasses(scenario->recorder, &passes, names.data()), GPGP_SUCCESS);
  for (const char* name : names) EXPECT_STRNE(name, "");

  const VolkDeviceTable& vk = device.vk();
  const VkQueryPoolCreateInfo queryInfo{
      VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, passes + 1, 0};
  VkQueryPool queries = VK_NULL_HANDLE;
  ASSERT_EQ(vk.vkCreateQueryPool(device.device(), &queryInfo, nullptr, &queries), VK_SUCCESS);
  const VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0,
                                         device.graphics().family};
  VkCommandPool pool = VK_NULL_HANDLE;
  ASSERT_EQ(vk.vkCreateCommandPool(device.device(), &poolInfo, nullptr, &pool), VK_SUCCESS);
  const VkCommandBufferAllocateInfo allocateInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                                 VK_COMMAND_BUFFER_LEVEL_SECONDARY, 1};
  VkCommandBuffer secondary = VK_NULL_HANDLE;
  ASSERT_EQ(vk.vkAllocateCommandBuffers(device.device(), &allocateInfo, &secondary), VK_SUCCESS);
  const VkCommandBufferInheritanceInfo inheritance{VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO};
  const VkCommandBufferBeginInfo beginInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, &inheritance};
  ASSERT_EQ(vk.vkBeginCommandBuffer(secondary, &beginInfo), VK_SUCCESS);
  GpgpRecordingInfo base{};
  base.timestamps = {queries, 0, passes + 1};
  const GpgpFrame frame = advance();
  ASSERT_EQ(scenario->record(secondary, frame, base), GPGP_SUCCESS) << lastMessage();
  ASSERT_EQ(vk.vkEndCommandBuffer(secondary), VK_SUCCESS);
  device.submitAndWait([&](VkCommandBuffer cmd) {
    vk.vkCmdResetQueryPool(cmd, queries, 0, passes + 1);
    vk.vkCmdExecuteCommands(cmd, 1, &secondary);
  });
  EXPECT_EQ(scenario->results(), expected);
  std::vector<uint64_t> times(passes + 1);
  ASSERT_EQ(vk.vkGetQueryPoolResults(device.device(), queries, 0, passes + 1, times.size() * 8, times.data(), 8,
                                     VK_QUERY_RESULT_64_BIT),
            VK_SUCCESS);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_GT(times.back(), times.front());
  vk.vkDestroyCommandPool(device.device(), pool, nullptr);
  vk.vkDestroyQueryPool(device.device(), queries, nullptr);
}

TEST_P(ContractTest, ComputeOnlyQueueFamily) {
  if (!device.computeOnly()) GTEST_SKIP() << device.name() << " has no queue family with compute and without graphics";
  prepare(*device.computeOnly());
  const auto compute = run(*device.computeOnly());
  scenario->destroy();
  scenario = makeScenario(GetParam(), device);
  prepare();
  EXPECT_EQ(run(device.graphics()), compute);
}

TEST_P(ContractTest, NotReadyRecordsNothing) {
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
  GpgpFrame frame = advance();
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  proxy.clear();
  const auto expectSaidOnce = [&](const char* why) {
    for (int i = 0; i < 2; ++i) EXPECT_EQ(scenario->record(cmd, frame, {}), GPGP_NOT_READY) << why;
    EXPECT_EQ(messages.size(), 1u);
    EXPECT_NE(lastMessage().find(why), std::string::npos) << lastMessage();
    messages.clear();
  };
  expectSaidOnce("gpgpPrewarm");
  const auto pipelines = [&] {
    uint32_t count = 0;
    EXPECT_EQ(gpgpGetPipelines(scenario->recorder, &count, nullptr), GPGP_SUCCESS);
    std::vector<GpgpPipelineInfo> list(count);
    EXPECT_EQ(gpgpGetPipelines(scenario->recorder, &count, list.data()), GPGP_SUCCESS);
    return list;
  };
  for (const GpgpPipelineInfo& pipeline : pipelines()) EXPECT_EQ(pipeline.milliseconds, 0) << pipeline.name;
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  EXPECT_FALSE(pipelines().empty());
  for (const GpgpPipelineInfo& pipeline : pipelines()) {
    EXPECT_STRNE(pipeline.name, "");
    EXPECT_GT(pipeline.codeBytes, 100u) << pipeline.name;
    EXPECT_GT(pipeline.milliseconds, 0) << pipeline.name;
  }
  uint32_t none = 0;
  GpgpPipelineInfo first{};
  EXPECT_EQ(gpgpGetPipelines(scenario->recorder, &none, &first), GPGP_INCOMPLETE);
  EXPECT_EQ(none, pipelines().size());
  EXPECT_EQ(first.name, nullptr);
  messages.clear();
  proxy.clear();
  expectSaidOnce("not resident");
  EXPECT_TRUE(proxy.calls.empty()) << proxy.calls.front().name;
  ring.drop();
}

TEST_P(ContractTest, ASecondThreadOnARecorderGetsAnError) {
  prepare();
  const GpgpFrame frame = advance();
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  GpgpResult second = GPGP_SUCCESS;
  size_t before = 0, after = 1;
  proxy.inNextCall = [&] { // in the middle of the first thread's recording
    before = proxy.calls.size();
    std::thread([&] { second = scenario->record(cmd, frame, {}); }).join();
    after = proxy.calls.size();
  };
  ASSERT_EQ(scenario->record(cmd, frame, {}), GPGP_SUCCESS) << lastMessage();
  EXPECT_EQ(second, GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(after, before) << "the second thread called Vulkan";
  EXPECT_NE(lastMessage().find("two threads"), std::string::npos) << lastMessage();
  ring.drop();
}

TEST_P(ContractTest, LostReportsAreSaidOnceUntilOneIsTaken) {
  prepare();
  const auto loseSome = [&] {
    for (int i = 0; i < 3 * 4 + 2; ++i) run(device.graphics()); // a recorder keeps 3 * 4
    advance();
    return std::count_if(messages.begin(), messages.end(),
                         [](const std::string& m) { return m.find("not taken in time") != std::string::npos; });
  };
  EXPECT_EQ(loseSome(), 1);
  EXPECT_EQ(loseSome(), 1);
  expectReport(GPGP_SUCCESS);
  EXPECT_EQ(loseSome(), 2);
}

TEST_P(ContractTest, NothingIsRecordedBeforeTheFirstFrame) {
  ASSERT_EQ(scenario->createAsset(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createRecorder(context, {"recorder", device.graphics().family, 0, VK_FALSE}), GPGP_SUCCESS);
  ASSERT_EQ(scenario->createView(context), GPGP_SUCCESS);
  ASSERT_EQ(scenario->prewarm(), GPGP_SUCCESS);
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  proxy.clear();
  const GpgpFrame frame{1, 0};
  EXPECT_EQ(gpgpRecordUpload(context, cmd, &frame, 0, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("gpgpAdvance"), std::string::npos) << lastMessage();
  EXPECT_EQ(scenario->record(cmd, frame, {}), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(lastMessage().find("gpgpAdvance"), std::string::npos) << lastMessage();
  EXPECT_TRUE(proxy.calls.empty()) << proxy.calls.front().name;
  ring.drop();
}

TEST_P(ContractTest, DeviceLostMakesCallsFailAndDestroyingLegal) {
  prepare();
  run(device.graphics());
  gpgpNotifyDeviceLost(context);
  const GpgpFrame frame{number + 1, number};
  EXPECT_EQ(gpgpAdvance(context, &frame), GPGP_ERROR_DEVICE_LOST);
  host::FrameRing ring(device, 1);
  const VkCommandBuffer cmd = ring.begin();
  proxy.clear();
  const GpgpFrame last{number, number - 1};
  EXPECT_EQ(scenario->record(cmd, last, {}), GPGP_ERROR_DEVICE_LOST);
  EXPECT_EQ(gpgpRecordUpload(context, cmd, &last, 0, nullptr), GPGP_ERROR_DEVICE_LOST);
  EXPECT_TRUE(proxy.calls.empty());
  ring.drop();
  scenario->destroy();
  GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
  ASSERT_EQ(gpgpGetMemoryReport(context, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.services[GPGP_SERVICE_CORE].pendingBytes, 0u);
}

INSTANTIATE_TEST_SUITE_P(Services, ContractTest, testing::ValuesIn(scenarioNames()),
                         [](const auto& service) { return service.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ContractTest);

} // namespace
