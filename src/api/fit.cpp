// The C functions of fit.h: pure functions on the host.
#include "spawn/fit/fit.h"
#include "api/check_struct.h"

#include <gpgp/fit.h>

using namespace gpgp;

namespace {
/// There is no context that could get a message. A struct of the wrong kind is said before what is wrong with it.
template <class T> GpgpResult codeOf(const T* info, GpgpStructureType type, bool isComplete) {
  if (const auto ok = api::checkStruct(info, type, "info"); !ok) return ok.error().code;
  return isComplete && spawn::isValid(*info) ? GPGP_SUCCESS : GPGP_ERROR_INVALID_ARGUMENT;
}
} // namespace

GpgpResult GPGP_CALL gpgpProposeAxioms(const GpgpFit* fit, uint32_t round, const GpgpFitCandidate* current,
                                       GpgpAxiom* proposed) {
  const GpgpResult result = codeOf(fit, GPGP_STRUCTURE_FIT, proposed && (current || round == 0));
  if (result != GPGP_SUCCESS) return result;
  if (round >= fit->rounds) return GPGP_ERROR_INVALID_ARGUMENT;
  for (uint32_t i = 0; i < fit->candidates; ++i)
    proposed[i] = spawn::propose(*fit, round, i, round ? &current[i].axiom : nullptr);
  return GPGP_SUCCESS;
}

GpgpResult GPGP_CALL gpgpAcceptAxioms(const GpgpFit* fit, uint32_t round, const GpgpAxiom* proposed,
                                      const double* scores, GpgpFitCandidate* current, GpgpFitCandidate* best) {
  const GpgpResult result = codeOf(fit, GPGP_STRUCTURE_FIT, proposed && scores && current);
  if (result != GPGP_SUCCESS) return result;
  if (round >= fit->rounds) return GPGP_ERROR_INVALID_ARGUMENT;
  spawn::accept(*fit, round, proposed, scores, current, best);
  return GPGP_SUCCESS;
}

GpgpResult GPGP_CALL gpgpScoreMeasures(const GpgpFitTarget* target, const GpgpAxiomMeasures* measures, uint32_t count,
                                       double* scores) {
  if (const auto ok = api::checkStruct(target, GPGP_STRUCTURE_FIT_TARGET, "target"); !ok) return ok.error().code;
  if (count && !(measures && scores)) return GPGP_ERROR_INVALID_ARGUMENT;
  for (uint32_t i = 0; i < count; ++i) scores[i] = spawn::scoreOf(*target, measures[i]);
  return GPGP_SUCCESS;
}
