/* gpgp lsystem.hpp: C++17 wrapper of lsystem.h. The rules of the wrapper are in core.hpp.
 *
 *   auto blob = gpgp::compileLsystem(source);
 *   auto lsystem = gpgp::Lsystem::create(context, info);
 *   auto recorder = gpgp::LsystemRecorder::create(context, gpgp::init<GpgpLsystemRecorderCreateInfo>());
 *   recorder->recordPrepare(commandBuffer, frame, lsystemInfo);
 */
#ifndef GPGP_LSYSTEM_HPP
#define GPGP_LSYSTEM_HPP

#include <gpgp/core.hpp>
#include <gpgp/lsystem.h>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpLsystemSource, GPGP_STRUCTURE_LSYSTEM_SOURCE);
GPGP_STRUCTURE_OF(GpgpLsystemCreateInfo, GPGP_STRUCTURE_LSYSTEM_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpLsystemRecorderCreateInfo, GPGP_STRUCTURE_LSYSTEM_RECORDER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpLsystemInfo, GPGP_STRUCTURE_LSYSTEM_INFO);
GPGP_STRUCTURE_OF(GpgpLsystemReport, GPGP_STRUCTURE_LSYSTEM_REPORT);

/// A compiled L-system on the device (gpgpCreateLsystem).
class Lsystem : public Asset {
public:
  using Asset::Asset;
  static Result<Lsystem> create(GpgpContext context, const GpgpLsystemCreateInfo& info) noexcept {
    return detail::create<Lsystem>(gpgpCreateLsystem, context, info);
  }
  /// gpgpGetLsystemTerminals. count: in, the capacity of terminals; out, the number of all terminals. terminals nullptr
  /// asks for the count.
  [[nodiscard]] GpgpResult terminals(uint32_t& count, GpgpGrammarTerminal* terminals) const noexcept {
    return gpgpGetLsystemTerminals(get(), &count, terminals);
  }
  /// gpgpGetLsystemSymbols, with count as for terminals(). GpgpLsystemModule::symbol is an index into this list.
  [[nodiscard]] GpgpResult symbols(uint32_t& count, GpgpLsystemSymbol* symbols) const noexcept {
    return gpgpGetLsystemSymbols(get(), &count, symbols);
  }
};

/// Derives L-systems on the GPU (gpgpCreateLsystemRecorder).
class LsystemRecorder : public Recorder {
public:
  using Recorder::Recorder;
  static Result<LsystemRecorder> create(GpgpContext context, const GpgpLsystemRecorderCreateInfo& info) noexcept {
    return detail::create<LsystemRecorder>(gpgpCreateLsystemRecorder, context, info);
  }
  /// gpgpRecordPrepareLsystem: records a derivation, outside render passes.
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpLsystemInfo& info) noexcept {
    return gpgpRecordPrepareLsystem(get(), commandBuffer, &frame, &info);
  }
  /// gpgpGetLsystemReport: the oldest report that was not taken yet, or GPGP_NOT_READY.
  Result<GpgpLsystemReport> report() noexcept { return detail::report(gpgpGetLsystemReport, get()); }
};

// ---------------------------------------------------------------- compiler (libgpgp_compiler)

/// gpgpCompileLsystem: the L-system as bytes for GpgpLsystemCreateInfo::data.
inline Result<Blob> compileLsystem(const GpgpLsystemSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileLsystem(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

} // namespace gpgp
#endif
