// Contexts: side by side on several devices, the engine's callbacks, the pipeline cache, and our own block allocator.
#include "api/check.h"
#include "core/gpu_memory.h"
#include "host/device.h"
#include "host/files.h"
#include "host/memory.h"
#include "toy_recorder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <deque>
#include <map>
#include <new>
#include <random>
#include <thread>

namespace {
using namespace gpgp;
using namespace gpgp::test;

core::Context& of(GpgpContext handle) { return *reinterpret_cast<core::Context*>(handle); }

void runToy(host::HeadlessDevice& device, GpgpContext handle, uint32_t factor) {
  const std::vector<uint32_t> data(100, 3);
  const auto asset = ToyAsset::create(of(handle), data);
  auto recorder = ToyRecorder::create(of(handle), {"toy", device.graphics().family, 0, VK_FALSE});
  ASSERT_TRUE(recorder) << recorder.error().text;
  ASSERT_TRUE((*recorder)->prewarm(nullptr));
  host::Buffer output(device, 400, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const GpgpBuffer range = output.range();
  const GpgpFrame frame{1, 0};
  ASSERT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS);
  const GpgpRecordingInfo base{};
  device.submitAndWait([&](VkCommandBuffer cmd) {
    ASSERT_EQ(gpgpRecordUpload(handle, cmd, &frame, 0, nullptr), GPGP_SUCCESS);
    ASSERT_TRUE((*recorder)->run(cmd, base, *asset, range, 100, factor));
  });
  for (const uint32_t word : host::download<uint32_t>(device, output, 100)) EXPECT_EQ(word, 3 * factor);
}

TEST(Context, SeveralDevicesAndContextsSideBySideOnThreads) {
  std::vector<std::unique_ptr<host::HeadlessDevice>> devices;
  for (int i = 0; i < 2; ++i)
    devices.push_back(std::make_unique<host::HeadlessDevice>(host::DeviceOptions{.validation = true}));
  std::vector<std::thread> threads;
  for (auto& device : devices)
    threads.emplace_back([&device] {
      const GpgpContextCreateInfo info = device->contextCreateInfo();
      GpgpContext contexts[2] = {};
      for (GpgpContext& context : contexts) ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
      for (uint32_t i = 0; i < 2; ++i) runToy(*device, contexts[i], i + 5);
      for (GpgpContext context : contexts) gpgpDestroyContext(context);
    });
  for (std::thread& thread : threads) thread.join();
  for (auto& device : devices)
    for (const std::string& message : device->validationMessages()) ADD_FAILURE() << message;
}

PFN_vkGetInstanceProcAddr loader = nullptr;
/// The loader's, but for vkGetPhysicalDeviceFeatures2, which offers nothing.
PFN_vkVoidFunction VKAPI_CALL withoutFeatures(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetPhysicalDeviceFeatures2") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(
        +[](VkPhysicalDevice, VkPhysicalDeviceFeatures2* features) { features->features = {}; });
  return loader(instance, name);
}

TEST(Context, DeclaredFeaturesAreCheckedAgainstTheDevice) {
  host::HeadlessDevice device;
  loader = device.getInstanceProcAddr();
  for (const auto& [feature, name] :
       {std::pair(GPGP_FEATURE_DYNAMIC_RENDERING, "GPGP_FEATURE_DYNAMIC_RENDERING"),
        std::pair(GPGP_FEATURE_MULTIVIEW, "GPGP_FEATURE_MULTIVIEW"),
        std::pair(GPGP_FEATURE_BUFFER_INT64_ATOMICS, "GPGP_FEATURE_BUFFER_INT64_ATOMICS")}) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.getInstanceProcAddr = withoutFeatures;
    std::string text;
    info.features = feature;
    info.messageUserData = &text;
    info.messageFn = [](void* data, const GpgpMessage* message) { *static_cast<std::string*>(data) = message->text; };
    GpgpContext context = nullptr;
    EXPECT_EQ(gpgpCreateContext(&info, &context), GPGP_ERROR_MISSING_FEATURE);
    EXPECT_NE(text.find(name), std::string::npos) << text;
    info.features = 0;
    EXPECT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
    gpgpDestroyContext(context);
  }
}

TEST(Context, PipelineCacheTravels) {
  host::HeadlessDevice device;
  std::vector<char> bytes;
  for (int round = 0; round < 2; ++round) {
    GpgpContextCreateInfo info = device.contextCreateInfo();
    info.pipelineCacheData = bytes.data();
    info.pipelineCacheSize = bytes.size();
    GpgpContext context = nullptr;
    ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
    runToy(device, context, 2);
    size_t size = 0;
    ASSERT_EQ(gpgpGetPipelineCacheData(context, &size, nullptr), GPGP_SUCCESS);
    ASSERT_GT(size, 0u);
    bytes.resize(size);
    ASSERT_EQ(gpgpGetPipelineCacheData(context, &size, bytes.data()), GPGP_SUCCESS);
    size = 1;
    char one;
    EXPECT_EQ(gpgpGetPipelineCacheData(context, &size, &one), GPGP_INCOMPLETE);
    gpgpDestroyContext(context);
  }
}

TEST(Context, PrewarmGoesThroughTheJobSystem) {
  host::HeadlessDevice device;
  std::atomic<uint32_t> jobs{0};
  const GpgpJobSystem system{&jobs, [](void* user, uint32_t count, GpgpJobFn job, void* argument) {
                               std::vector<std::thread> threads;
                               for (uint32_t i = 0; i < count; ++i) threads.emplace_back([=] { job(argument, i); });
                               for (std::thread& thread : threads) thread.join();
                               *static_cast<std::atomic<uint32_t>*>(user) += count;
                             }};
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.jobSystem = &system;
  GpgpContext context = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  runToy(device, context, 4);
  EXPECT_EQ(jobs, 1u); // the toy has one shader
  gpgpDestroyContext(context);
}

TEST(Context, FilesComeFromTheEngineOrTheDisk) {
  host::HeadlessDevice device;
  const GpgpFileSystem files{nullptr, [](void*, const char* path, void* data, size_t capacity, size_t* size) {
                               if (std::string_view(path) != "pak:answer") return GpgpResult(GPGP_ERROR_IO);
                               *size = 2;
                               if (data && capacity >= 2) std::memcpy(data, "42", 2);
                               return GpgpResult(GPGP_SUCCESS);
                             }};
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.fileSystem = &files;
  GpgpContext context = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  { // what was read lies in the context's memory
    const auto answer = of(context).readFile("pak:answer");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->size(), 2u);
    const auto missing = of(context).readFile("pak:question");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, GPGP_ERROR_IO);
    EXPECT_NE(std::string(missing.error().text).find("pak:question"), std::string::npos);
  }
  gpgpDestroyContext(context);

  info.fileSystem = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  {
    const auto self = of(context).readFile(GPGP_TEST_DATA "/README.md");
    ASSERT_TRUE(self) << self.error().text;
    EXPECT_GT(self->size(), 1000u);
  }
  EXPECT_FALSE(of(context).readFile("no/such/file"));
  gpgpDestroyContext(context);
}

TEST(GpuMemory, RandomSubAllocationsNeverOverlapAndAllComeBack) {
  host::HeadlessDevice device;
  const GpgpContextCreateInfo info = device.contextCreateInfo();
  GpgpContext handle = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
  core::GpuMemory& memory = of(handle).gpu();
  const auto blockBytes = [&memory] {
    GpgpMemoryReport report = GPGP_MEMORY_REPORT_INIT;
    memory.report(report);
    return report.blockBytes;
  };
  const VkDeviceSize before = blockBytes();
  std::mt19937 random(7);
  struct Live {
    GpgpGpuAllocation allocation;
    VkDeviceSize size;
  };
  std::vector<Live> live;
  for (int step = 0; step < 4000; ++step) {
    if (live.size() < 40 || (random() % 2 && live.size() < 120)) {
      GpgpGpuAllocationRequest request{};
      request.requirements.size = 1 + random() % (random() % 10 ? 50000 : 5000000);
      request.requirements.alignment = VkDeviceSize(1) << (random() % 12);
      request.requirements.memoryTypeBits = ~0u;
      request.label = "random";
      const auto made = memory.allocate(request);
      ASSERT_TRUE(made) << made.error().text;
      EXPECT_EQ(made->offset % request.requirements.alignment, 0u);
      for (const Live& other : live) {
        const bool apart = other.allocation.memory != made->memory ||
                           made->offset + request.requirements.size <= other.allocation.offset ||
                           other.allocation.offset + other.size <= made->offset;
        ASSERT_TRUE(apart);
      }
      live.push_back({*made, request.requirements.size});
    } else {
      const size_t at = random() % live.size();
      memory.free(live[at].allocation);
      live[at] = live.back();
      live.pop_back();
    }
  }
  for (const Live& one : live) memory.free(one.allocation);
  EXPECT_EQ(blockBytes(), before);
  gpgpDestroyContext(handle);
}

TEST(Slots, AHandleIsNotMistakenForItsSuccessor) {
  host::HeadlessDevice device;
  const GpgpContextCreateInfo info = device.contextCreateInfo();
  GpgpContext handle = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
  const std::vector<uint32_t> data(4, 1);
  const auto make = [&] { return api::adopt<GpgpAsset>(of(handle), ToyAsset::create(of(handle), data)); };
  const GpgpAsset first = make();
  gpgpDestroyAsset(first);
  VkBool32 resident = VK_FALSE;
  for (int i = 0; i < 300; ++i) { // slots are reused, handles never
    const GpgpAsset next = make();
    EXPECT_NE(next, first);
    EXPECT_EQ(gpgpGetResidency(first, &resident), GPGP_ERROR_INVALID_HANDLE);
    gpgpDestroyAsset(next);
  }
  gpgpDestroyContext(handle);
}

TEST(Slots, ObjectsThatComeAndGoForEverTakeNoMoreMemory) {
  struct Heap {
    int64_t bytes = 0;
  } heap;
  const GpgpHostAllocator allocator{&heap,
                                    [](void* user, size_t size, size_t alignment) -> void* {
                                      static_cast<Heap*>(user)->bytes += static_cast<int64_t>(size);
                                      return ::operator new(size, std::align_val_t(alignment));
                                    },
                                    [](void* user, void* memory, size_t size, size_t alignment) {
                                      static_cast<Heap*>(user)->bytes -= static_cast<int64_t>(size);
                                      ::operator delete(memory, std::align_val_t(alignment));
                                    }};
  host::HeadlessDevice device;
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.hostAllocator = &allocator;
  GpgpContext handle = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
  const std::vector<uint32_t> data(4, 1);
  VkBool32 resident = VK_FALSE;
  std::deque<GpgpAsset> destroyed;
  int64_t most[3] = {}; // of thirds: the first fills the queue of worn slots
  for (uint64_t i = 0; i < 210'000; ++i) {
    const GpgpAsset next = api::adopt<GpgpAsset>(of(handle), ToyAsset::create(of(handle), data));
    gpgpDestroyAsset(next);
    if (i % 50 == 0) {
      const GpgpFrame frame{i / 50 + 2, i / 50 + 1};
      ASSERT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS);
      most[i / 70'000] = std::max(most[i / 70'000], heap.bytes);
      destroyed.push_back(next);
      if (destroyed.size() > 20) destroyed.pop_front(); // 1 000 objects ago
      for (const GpgpAsset old : destroyed) ASSERT_EQ(gpgpGetResidency(old, &resident), GPGP_ERROR_INVALID_HANDLE);
    }
  }
  EXPECT_EQ(most[1], most[2]);
  gpgpDestroyContext(handle);
  EXPECT_EQ(heap.bytes, 0);
}

TEST(Residency, WhatIsDestroyedBeforeItsUploadIsForgotten) {
  host::HeadlessDevice device{host::DeviceOptions{.validation = true}};
  const GpgpContextCreateInfo info = device.contextCreateInfo();
  GpgpContext handle = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
  const std::vector<uint32_t> data(1 << 16, 1);
  GpgpFrame frame{1, 0};
  ASSERT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS);
  gpgpDestroyAsset(api::adopt<GpgpAsset>(of(handle), ToyAsset::create(of(handle), data)));
  frame.current = 2;
  ASSERT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS);
  VkDeviceSize pending = 1;
  device.submitAndWait([&](VkCommandBuffer cmd) {
    EXPECT_EQ(gpgpRecordUpload(handle, cmd, &frame, 0, &pending), GPGP_SUCCESS);
    frame = {3, 1};
    EXPECT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS); // frees it, before the GPU runs the frame
  });
  EXPECT_EQ(pending, 0u);
  gpgpDestroyContext(handle);
  for (const std::string& message : device.validationMessages()) ADD_FAILURE() << message;
}

TEST(Residency, ThousandsOfAssetsAreCheapOnceTheyAreThere) {
  host::HeadlessDevice device;
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.uploadRingBytes = 1 << 20;
  GpgpContext handle = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &handle), GPGP_SUCCESS);
  const std::vector<uint32_t> data(4, 1);
  std::vector<GpgpAsset> assets;
  for (int i = 0; i < 4000; ++i)
    assets.push_back(api::adopt<GpgpAsset>(of(handle), ToyAsset::create(of(handle), data)));
  GpgpFrame frame{1, 0};
  for (VkDeviceSize pending = 1; pending; ++frame.current, ++frame.safe) {
    ASSERT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS);
    device.submitAndWait(
        [&](VkCommandBuffer cmd) { ASSERT_EQ(gpgpRecordUpload(handle, cmd, &frame, 0, &pending), GPGP_SUCCESS); });
  }
  ASSERT_EQ(gpgpAdvance(handle, &frame), GPGP_SUCCESS);
  EXPECT_EQ(of(handle).residents, nullptr) << "finished uploads must not be visited every frame";
  for (const GpgpAsset asset : assets) {
    VkBool32 resident = VK_FALSE;
    ASSERT_EQ(gpgpGetResidency(asset, &resident), GPGP_SUCCESS);
    EXPECT_TRUE(resident);
    gpgpDestroyAsset(asset);
  }
  gpgpDestroyContext(handle);
}

} // namespace
