// The C function of scatter.h: a pure function on the host.
#include "spawn/scatter/scatter.h"
#include "api/check_struct.h"

#include <algorithm>
#include <new>

using namespace gpgp;

GpgpResult GPGP_CALL gpgpScatterAxioms(const GpgpScatterInfo* info, uint32_t* count, GpgpAxiom* axioms) {
  if (const auto ok = api::checkStruct(info, GPGP_STRUCTURE_SCATTER_INFO, "info"); !ok) return ok.error().code;
  if (!count || !spawn::isValid(*info)) return GPGP_ERROR_INVALID_ARGUMENT;
  try {
    const auto all = spawn::scatter(*info);
    const size_t written = axioms ? std::min<size_t>(*count, all.size()) : 0;
    std::copy_n(all.begin(), written, axioms);
    *count = static_cast<uint32_t>(all.size());
    return axioms && written < all.size() ? GPGP_INCOMPLETE : GPGP_SUCCESS;
  } catch (const std::bad_alloc&) {
    return GPGP_ERROR_OUT_OF_HOST_MEMORY;
  }
}
