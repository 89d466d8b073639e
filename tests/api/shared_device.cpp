#include "scenarios.h"

#include <gtest/gtest.h>

namespace gpgp::test {
namespace {
#ifdef __SANITIZE_THREAD__
constexpr bool kValidation = false; // the layer orders its threads' memory by what ThreadSanitizer does not see
#else
constexpr bool kValidation = true;
#endif
class SharedDevice final : public testing::Environment {
public:
  void TearDown() override { device.reset(); }
  std::unique_ptr<host::HeadlessDevice> device;
};
SharedDevice* const environment =
    static_cast<SharedDevice*>(testing::AddGlobalTestEnvironment(new SharedDevice)); // owned by GoogleTest
} // namespace

host::HeadlessDevice& sharedDevice() {
  if (!environment->device)
    environment->device = std::make_unique<host::HeadlessDevice>(host::DeviceOptions{.validation = kValidation});
  return *environment->device;
}

} // namespace gpgp::test
