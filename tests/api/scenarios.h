// One small real job for each service, through the C API alone, so that every promise all services make is tested on
// all of them with one piece of code.
//
// A scenario owns the engine's buffers for the job and can be asked for the bytes of its results.
#pragma once
#include "host/device.h"
#include "host/memory.h"

#include <gpgp/ui.h>

#include <memory>
#include <string>
#include <vector>

namespace gpgp::test {

class Scenario {
public:
  explicit Scenario(host::HeadlessDevice& d) : device(d) {}
  virtual ~Scenario() = default;
  virtual const char* name() const = 0;

  /// The service's asset, recorder (with its pipelines) and view where it has one. Each returns the API's result.
  virtual GpgpResult createAsset(GpgpContext context) = 0;
  virtual GpgpResult createRecorder(GpgpContext context, const GpgpRecorderCreateInfo& base) = 0;
  virtual GpgpResult createView(GpgpContext) { return GPGP_SUCCESS; }
  virtual GpgpResult prewarm() { return gpgpPrewarm(recorder, nullptr); }
  /// Destroys the handles that exist.
  void destroy();

  virtual GpgpResult record(VkCommandBuffer commandBuffer, const GpgpFrame& frame, const GpgpRecordingInfo& base) = 0;
  /// What was written, in an order that does not depend on scheduling. Waits for the device.
  virtual std::vector<uint32_t> results() = 0;
  /// Overwrites the outputs, so that old results cannot pass for new ones.
  virtual void clearOutputs() = 0;
  /// The oldest report's header; `meaningful` is set when its counts are those of the whole job.
  virtual GpgpResult takeReport(GpgpReportHeader& header, bool& meaningful) = 0;
  /// Edge states that record() gave to its outputs.
  static constexpr GpgpAccess kBefore{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT, {}};
  static constexpr GpgpAccess kAfter{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, {}};

  host::HeadlessDevice& device;
  GpgpAsset asset = nullptr, secondAsset = nullptr; ///< the second: where the job needs two
  GpgpRecorder recorder = nullptr;
  GpgpHistory view = nullptr;
  GpgpList shownList = nullptr;
};

/// One device with validation for all tests of a process: drivers allow only so many instances, and they take time.
/// Destroyed after the last test.
host::HeadlessDevice& sharedDevice();

/// All services that this build has.
std::vector<std::string> scenarioNames();
std::unique_ptr<Scenario> makeScenario(const std::string& name, host::HeadlessDevice& device);

/// A context on the device with three frames in flight; messages are appended to *messages.
GpgpContextCreateInfo scenarioContextInfo(host::HeadlessDevice& device, std::vector<std::string>* messages);

} // namespace gpgp::test
