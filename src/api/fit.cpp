// The C functions of fit.h: pure functions on the host.
#include "spawn/fit/fit.h"
#include "core/result.h"

#include <gpgp/fit.h>

using namespace gpgp;

namespace {
/// There is no context that could get a message.
GpgpResult codeOf(bool valid) { return valid ? GPGP_SUCCESS : GPGP_ERROR_INVALID_ARGUMENT; }
} // namespace

GpgpResult GPGP_CALL gpgpProposeAxioms(const GpgpFit* fit, uint32_t round, const GpgpFitCandidate* current,
                                       GpgpAxiom* proposed) {
  const bool valid = fit && spawn::isValid(*fit) && proposed && round < fit->rounds && (current || round == 0);
  if (valid)
    for (uint32_t i = 0; i < fit->candidates; ++i)
      proposed[i] = spawn::propose(*fit, round, i, round ? &current[i].axiom : nullptr);
  return codeOf(valid);
}

GpgpResult GPGP_CALL gpgpAcceptAxioms(const GpgpFit* fit, uint32_t round, const GpgpAxiom* proposed,
                                      const double* scores, GpgpFitCandidate* current, GpgpFitCandidate* best) {
  const bool valid = fit && spawn::isValid(*fit) && proposed && scores && current && round < fit->rounds;
  if (valid) spawn::accept(*fit, round, proposed, scores, current, best);
  return codeOf(valid);
}

GpgpResult GPGP_CALL gpgpScoreMeasures(const GpgpFitTarget* target, const GpgpAxiomMeasures* measures, uint32_t count,
                                       double* scores) {
  const bool valid = target && (count == 0 || (measures && scores));
  if (valid)
    for (uint32_t i = 0; i < count; ++i) scores[i] = spawn::scoreOf(*target, measures[i]);
  return codeOf(valid);
}
