// A device test with spawners and grammars on it.
#pragma once
#include "../device_test.h"

#include <gpgp/spawn.h>

namespace gpgp::test {

struct SpawnerTest : DeviceTest {
  /// The suite's spawner of that info, without reports of other tests.
  GpgpRecorder spawnerOf(const GpgpSpawnerCreateInfo& info) {
    const GpgpRecorder spawner = recorder(gpgpCreateSpawner, info);
    advance();
    for (GpgpSpawnReport old = GPGP_SPAWN_REPORT_INIT; gpgpGetSpawnReport(spawner, &old) == GPGP_SUCCESS;) {
    }
    return spawner;
  }
  /// Of baked data; uploaded, with its kernels made.
  GpgpAsset load(GpgpRecorder spawner, const void* data, size_t size) {
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = data;
    info.size = size;
    GpgpAsset grammar = nullptr;
    EXPECT_EQ(gpgpCreateGrammar(context, &info, &grammar), GPGP_SUCCESS) << lastMessage();
    EXPECT_EQ(gpgpPrewarmGrammar(spawner, grammar), GPGP_SUCCESS) << lastMessage();
    const GpgpFrame f = advance();
    device.submitAndWait(
        [&](VkCommandBuffer cmd) { EXPECT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS); });
    return grammar;
  }
};

} // namespace gpgp::test
