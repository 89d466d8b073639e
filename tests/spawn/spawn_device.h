// A headless device with a spawner on it, for tests that compare reports. Validation messages fail the test.
#pragma once
#include "host/device.h"
#include "host/memory.h"

#include <gpgp/gpgp.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace gpgp::test {

class SpawnDevice {
public:
  explicit SpawnDevice(const GpgpSpawnerCreateInfo& budgets = {}) {
    GpgpContextCreateInfo info = device_.contextCreateInfo();
    info.messageUserData = this;
    info.messageFn = [](void*, const GpgpMessage* m) { ADD_FAILURE() << m->function << ": " << m->text; };
    EXPECT_EQ(gpgpCreateContext(&info, &context_), GPGP_SUCCESS);
    GpgpSpawnerCreateInfo spawner = GPGP_SPAWNER_CREATE_INFO_INIT;
    spawner.base.queueFamily = device_.graphics().family;
    spawner.maxShapes = budgets.maxShapes;
    spawner.maxColliders = budgets.maxColliders;
    spawner.maxRounds = budgets.maxRounds;
    EXPECT_EQ(gpgpCreateSpawner(context_, &spawner, &spawner_), GPGP_SUCCESS);
    EXPECT_EQ(gpgpPrewarm(spawner_, nullptr), GPGP_SUCCESS);
  }
  ~SpawnDevice() {
    device_.waitIdle();
    gpgpDestroyContext(context_);
    for (const std::string& message : device_.validationMessages()) ADD_FAILURE() << message;
  }
  SpawnDevice(const SpawnDevice&) = delete;
  SpawnDevice& operator=(const SpawnDevice&) = delete;

  /// Uploads the grammar and derives once. written: gets the instances.
  GpgpSpawnReport derive(const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms, uint32_t capacity,
                         std::vector<GpgpInstance>* written = nullptr) {
    GpgpGrammarCreateInfo grammarInfo = GPGP_GRAMMAR_CREATE_INFO_INIT;
    grammarInfo.data = words.data();
    grammarInfo.size = words.size() * sizeof(uint32_t);
    GpgpAsset grammar = nullptr;
    EXPECT_EQ(gpgpCreateGrammar(context_, &grammarInfo, &grammar), GPGP_SUCCESS);
    EXPECT_EQ(gpgpPrewarmGrammar(spawner_, grammar), GPGP_SUCCESS);
    const auto start = host::makeBuffer(device_, axioms, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const host::Buffer instances(device_, VkDeviceSize(capacity) * sizeof(GpgpInstance),
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.axioms = start.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.instances = instances.range();
    const GpgpFrame frame = advance();
    device_.submitAndWait([&](VkCommandBuffer commands) {
      EXPECT_EQ(gpgpRecordUpload(context_, commands, &frame, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner_, commands, &frame, &info), GPGP_SUCCESS);
    });
    advance();
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    EXPECT_EQ(gpgpGetSpawnReport(spawner_, &report), GPGP_SUCCESS);
    if (written) *written = host::download<GpgpInstance>(device_, instances, report.instancesWritten);
    gpgpDestroyAsset(grammar);
    return report;
  }

private:
  GpgpFrame advance() {
    ++frame_;
    const GpgpFrame frame{frame_, frame_ - 1};
    EXPECT_EQ(gpgpAdvance(context_, &frame), GPGP_SUCCESS);
    return frame;
  }
  host::HeadlessDevice device_{host::DeviceOptions{.validation = true}};
  GpgpContext context_ = nullptr;
  GpgpRecorder spawner_ = nullptr;
  uint64_t frame_ = 0;
};

} // namespace gpgp::test
