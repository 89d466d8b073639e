#include "cli/shared/pass_dump.h"

#include "api/check.h"
#include "cli/shared/common.h"
#include "host/files.h"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace gpgp::cli {

core::Recorder& PassDump::recorderOf(GpgpRecorder handle) {
  const core::Context* context = nullptr;
  return *static_cast<core::Recorder*>(api::objectOf(handle, &context));
}

PassDump::PassDump(host::HeadlessDevice& device, core::Recorder& recorder, const std::string& name)
    : device_(device), recorder_(recorder), name_(name) {
  const auto& passes = recorder.passes().passes;
  const size_t mark = name.rfind('#');
  const std::string wanted = name.substr(0, mark);
  size_t number = mark == std::string::npos ? 1 : std::strtoul(name.c_str() + mark + 1, nullptr, 10);
  for (; pass_ < passes.size(); ++pass_)
    if (passes[pass_].name == wanted && --number == 0) break;
  if (pass_ == passes.size()) {
    std::string all;
    std::set<std::string> seen;
    for (const core::Pass& pass : passes)
      if (seen.insert(pass.name).second) all += (all.empty() ? "" : "; ") + std::string(pass.name);
    throw Failure("there is no pass \"" + name + "\"; there are " + all);
  }
  scratch_ = host::Buffer(device, recorder.scratchBytes(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  recorder.inspect({pass_, scratch_.handle()});
}

std::string PassDump::write(const std::filesystem::path& folder) const {
  if (!recorder_.ran(pass_)) throw Failure("this recording does not run the pass \"" + name_ + "\"");
  const core::PassList& list = recorder_.passes();
  const core::Pass& pass = list.passes[pass_];
  std::set<core::ResourceIndex> used;
  for (uint32_t u = 0; u < pass.useCount; ++u) used.insert(pass.uses[u].resource);
  if (pass.kind != core::PassKind::dispatch) used.insert(pass.target);
  const auto bytes = host::download<char>(device_, scratch_, recorder_.scratchBytes());
  std::string written;
  for (const core::ResourceIndex resource : used) {
    if (list.resources[resource].kind != core::ResourceKind::scratch) continue;
    std::string file = name_ + "." + list.resources[resource].name + ".bin";
    std::replace(file.begin(), file.end(), ' ', '_');
    const std::string_view part(bytes.data() + list.scratchOffsets[resource], list.resources[resource].bytes);
    host::writeFile(folder / file, part);
    written += (folder / file).string() + ": " + std::to_string(part.size()) + " bytes\n";
  }
  return written;
}

} // namespace gpgp::cli
