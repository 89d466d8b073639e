/* gpgp cga.hpp: C++17 wrapper of cga.h. The rules of the wrapper are in core.hpp.
 * The functions are in libgpgp_evaluator; only programs that call them link that library.
 *
 *   auto program = gpgp::CgaProgram::create(info);
 *   auto derivation = program->derivation();
 *   derivation->derive(lots);
 *   auto result = derivation->result();
 */
#ifndef GPGP_CGA_HPP
#define GPGP_CGA_HPP

#include <gpgp/cga.h>
#include <gpgp/spawn.hpp>

#include <cstdint>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpCgaProgramCreateInfo, GPGP_STRUCTURE_CGA_PROGRAM_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpCgaGraph, GPGP_STRUCTURE_CGA_GRAPH);
GPGP_STRUCTURE_OF(GpgpCgaDerivationInfo, GPGP_STRUCTURE_CGA_DERIVATION_INFO);
GPGP_STRUCTURE_OF(GpgpCgaDerivationResult, GPGP_STRUCTURE_CGA_DERIVATION_RESULT);

namespace detail {
template <> struct Destroy<GpgpCgaProgram> {
  void operator()(GpgpCgaProgram handle) const noexcept { gpgpDestroyCgaProgram(handle); }
};
template <> struct Destroy<GpgpCgaDerivation> {
  void operator()(GpgpCgaDerivation handle) const noexcept { gpgpDestroyCgaDerivation(handle); }
};
} // namespace detail

/// The meshes of a list of lots (gpgpCreateCgaDerivation).
class CgaDerivation : public Handle<GpgpCgaDerivation> {
public:
  using Handle::Handle;
  /// gpgpDeriveCga
  [[nodiscard]] GpgpResult derive(const GpgpCgaDerivationInfo& info) noexcept { return gpgpDeriveCga(get(), &info); }
  /// gpgpGetCgaDerivationResult
  Result<GpgpCgaDerivationResult> result() const noexcept {
    GpgpCgaDerivationResult value = init<GpgpCgaDerivationResult>();
    const GpgpResult code = gpgpGetCgaDerivationResult(get(), &value);
    return Result<GpgpCgaDerivationResult>(code, value);
  }
};

/// A .cga file with what it imports (gpgpCreateCgaProgram). It must outlive its derivations.
class CgaProgram : public Handle<GpgpCgaProgram> {
public:
  using Handle::Handle;
  static Result<CgaProgram> create(const GpgpCgaProgramCreateInfo& info) noexcept {
    GpgpCgaProgram raw = nullptr;
    const GpgpResult code = gpgpCreateCgaProgram(&info, &raw);
    return Result<CgaProgram>(code, CgaProgram(raw));
  }
  /// gpgpGetCgaAttributes. count: in, the capacity of attributes; out, the number of all attributes. attributes nullptr
  /// asks for the count.
  [[nodiscard]] GpgpResult attributes(uint32_t& count, GpgpCgaAttribute* attributes) const noexcept {
    return gpgpGetCgaAttributes(get(), &count, attributes);
  }
  /// gpgpGetCgaGraph
  Result<GpgpCgaGraph> graph(const GpgpCgaValue* values, uint32_t valueCount) noexcept {
    GpgpCgaGraph value = init<GpgpCgaGraph>();
    const GpgpResult code = gpgpGetCgaGraph(get(), values, valueCount, &value);
    return Result<GpgpCgaGraph>(code, value);
  }
  /// gpgpCreateCgaDerivation
  Result<CgaDerivation> derivation() const noexcept {
    GpgpCgaDerivation raw = nullptr;
    const GpgpResult code = gpgpCreateCgaDerivation(get(), &raw);
    return Result<CgaDerivation>(code, CgaDerivation(raw));
  }
};

} // namespace gpgp

#endif
