// --dump-pass: the scratch buffers that a pass uses, as they are behind it.
#pragma once
#include "core/recorder.h"
#include "host/memory.h"

#include <filesystem>
#include <string>

namespace gpgp::cli {

class PassDump {
public:
  /// The recorder's recordings are looked at until the dump's end. name: of a pass, with "#2" the second of that name.
  /// Throws Failure where there is none.
  PassDump(host::HeadlessDevice& device, core::Recorder& recorder, const std::string& name);
  ~PassDump() { recorder_.inspect({}); }
  PassDump(const PassDump&) = delete;
  PassDump& operator=(const PassDump&) = delete;

  /// A file for each scratch buffer, of the last recording; returns their names and sizes, a line each. Throws Failure
  /// where it has not run the pass.
  std::string write(const std::filesystem::path& folder) const;

  static core::Recorder& recorderOf(GpgpRecorder handle);

private:
  host::HeadlessDevice& device_;
  core::Recorder& recorder_;
  std::string name_;
  uint32_t pass_ = 0;
  host::Buffer scratch_;
};

} // namespace gpgp::cli
