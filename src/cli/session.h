// A headless device with a gpgp context on it, and the frame that each subcommand runs: upload, record, submit, wait.
#pragma once
#include "cli/command.h"
#include "host/frames.h"
#include "host/memory.h"

#include <map>

namespace gpgp::cli {

/// Destroys a gpgp handle. The context must still live.
template <class Handle, void(GPGP_CALL* destroy)(Handle)> struct Owned {
  Handle handle = nullptr;
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { destroy(handle); }
  operator Handle() const { return handle; }
  Handle* out() { return &handle; }
};
using Context = Owned<GpgpContext, gpgpDestroyContext>;
using Asset = Owned<GpgpAsset, gpgpDestroyAsset>;
using Worker = Owned<GpgpWorker, gpgpDestroyWorker>;
using View = Owned<GpgpView, gpgpDestroyView>;

/// GPU times of a repeated record, milliseconds.
struct GpuTimes {
  std::vector<double> totals;                         ///< one per repeat
  std::vector<std::pair<std::string, double>> passes; ///< median of each pass, in order
  double median() const;
  double least() const;
  Json json() const;
};

class Session {
public:
  explicit Session(const CommonOptions& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  host::HeadlessDevice& device() { return device_; }
  GpgpContext context() const { return context_; }

  /// Throws Failure with gpgp's own message where result is an error; returns it otherwise.
  GpgpResult check(GpgpResult result, const char* what);
  GpgpWorkerCreateInfo workerInfo(const char* label) const;
  /// Uploads all pending assets.
  void upload();
  /// Runs record `repeat` times, a frame each, and waits for it; measures every one. record is given the info's common
  /// part with timestamps set, and returns what the record function returned.
  using Record = std::function<GpgpResult(VkCommandBuffer, const GpgpFrame&, const GpgpRecordInfo&)>;
  GpuTimes run(GpgpWorker worker, const char* label, uint32_t repeat, const Record& record);
  /// After the last run: makes reports ready.
  void harvest();
  /// Throws Failure where the validation layer had anything to say.
  void checkValidation();

private:
  static void GPGP_CALL onMessage(void* userData, const GpgpMessage* message);
  host::HeadlessDevice device_;
  std::string lastError_;
  Context context_;
  host::FrameRing frames_;
  bool validate_;
};

/// Milliseconds with three digits, for people.
std::string milliseconds(double value);
/// A GpgpResult as text with stable spelling, e.g. "GPGP_SUCCESS".
std::string statusName(GpgpResult status);

} // namespace gpgp::cli
