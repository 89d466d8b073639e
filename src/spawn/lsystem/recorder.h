// An L-system as an asset, and the recorder that derives any of them.
#pragma once
#include "core/recorder.h"
#include "core/resident.h"
#include "spawn/lsystem/passes.h"
#include "spawn/lsystem/table.h"

#include <gpgp/lsystem.h>

namespace gpgp::spawn::lsystem {

class Lsystem final : public core::Resident {
public:
  /// Checks a compiled L-system and queues it for upload.
  static core::Result<core::Unique<Lsystem>> create(core::Context& context, const char* label,
                                                    std::span<const std::byte> bytes);
  Lsystem(core::Context& owner, const char* name, Table&& checked)
      : Resident(owner, core::Kind::lsystem, name), table(std::move(checked)) {}
  const Table table;
};

class LsystemRecorder final : public core::Recorder {
public:
  static core::Result<core::Unique<LsystemRecorder>> create(core::Context& context,
                                                            const GpgpLsystemRecorderCreateInfo& info);
  LsystemRecorder(core::Context& owner, const GpgpRecorderCreateInfo& base)
      : Recorder(owner, core::Kind::lsystemRecorder, base, GPGP_SERVICE_SPAWN) {}

  /// Sizes of buffers are the caller's to check; the rest is checked here.
  core::Result<void> prepare(VkCommandBuffer commandBuffer, const GpgpLsystemInfo& info, const Lsystem& lsystem);
  bool takeReport(GpgpLsystemReport& report);

private:
  Sizes sizes_;
};

} // namespace gpgp::spawn::lsystem
