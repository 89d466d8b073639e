// A headless device with a gpgp context on it, and the frame that each subcommand runs: upload, record, submit, wait.
#pragma once
#include "cli/shared/common.h"
#include "cli/shared/pass_dump.h"
#include "host/busy_work.h"
#include "host/frames.h"
#include "host/memory.h"

#include <gpgp/gpgp.hpp>

#include <mutex>

namespace gpgp::cli {

/// GPU times of a repeated recording, milliseconds. Passes are timed in recordings of their own: a timestamp after each
/// of them takes time as well, and keeps them from running beside each other.
struct GpuTimes {
  std::vector<double> totals;                         ///< of whole recordings, one per repeat
  std::vector<std::pair<std::string, double>> passes; ///< median of each pass that ran, in order
  /// Of another recording that is run behind each of these.
  void add(const GpuTimes& other);
  double median() const;
  double least() const;
  Json json() const;
};

template <class Report> struct Measured {
  GpuTimes times;
  Report report{};
};

/// Throws Failure where the validation layer had anything to say, and prints that. Without the layer it has not.
void checkValidation(host::HeadlessDevice& device);

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
  /// Forgets an error that was expected.
  void dropError() { lastError_.clear(); }
  /// The same for what creates something.
  template <class T> T take(Result<T> result, const char* what) {
    check(result.code(), what);
    return std::move(*result);
  }
  GpgpRecorderCreateInfo recorderInfo(const char* label) const;
  /// Uploads all pending assets.
  void upload();
  /// Keeps a GPU's clocks up for some milliseconds, for who waits for what is measured next.
  void keepBusy() { busy_.pass(); }
  /// Runs record `repeat` times, a frame each, and waits for it; measures every one by two timestamps around all that
  /// it records, and before each of them, if there are several, another one by a timestamp after each pass. record is
  /// given the info's common part, and returns what the recording function returned. The report is the last run's. A
  /// GPU is kept busy for a while before, and between recordings: idle ones lower their clocks within milliseconds.
  using Record = std::function<GpgpResult(VkCommandBuffer, const GpgpFrame&, const GpgpRecordingInfo&)>;
  template <class RecorderType>
  auto measure(RecorderType& recorder, const char* label, uint32_t repeat, const Record& record) {
    Measured<std::decay_t<decltype(*recorder.report())>> result;
    bool found = false;
    result.times = run(recorder, label, repeat, record, [&] { // every frame: the recorder keeps only a few
      for (auto report = recorder.report(); report; report = recorder.report()) {
        result.report = *report;
        found = report->base.tag == repeat - 1;
      }
    });
    if (!found) throw Failure("the last recording gave no report");
    return result;
  }
  /// The same for a recorder that makes no reports.
  GpuTimes time(GpgpRecorder recorder, const char* label, uint32_t repeat, const Record& record) {
    return run(recorder, label, repeat, record, [] {});
  }
  void checkValidation() { cli::checkValidation(device_); }

private:
  GpuTimes run(GpgpRecorder recorder, const char* label, uint32_t repeat, const Record& record,
               const std::function<void()>& collectReports);
  static void GPGP_CALL onMessage(void* userData, const GpgpMessage* message);
  host::HeadlessDevice device_;
  std::mutex messages_; // pipelines are made on several threads
  std::string lastError_;
  Context context_;
  host::FrameRing frames_;
  host::BusyWork busy_;
  std::string dumpPass_, dumpFolder_;
  bool json_;
};

/// Milliseconds with three digits, for people.
std::string milliseconds(double value);
/// A GpgpResult as text with stable spelling, e.g. "GPGP_SUCCESS".
std::string statusName(GpgpResult status);

} // namespace gpgp::cli
