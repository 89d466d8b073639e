// Inverse modelling on the host: candidates of a round, and which of them go on (gpgp/fit.h).
//
// Every number that is drawn depends on the search's seed, the round, the candidate and what it is drawn for, never on
// an earlier one, so that nothing is kept between rounds but the candidates themselves.
#pragma once
#include <gpgp/fit.h>

namespace gpgp::spawn {

bool isValid(const GpgpFit& fit);
/// current: of the same candidate; null in round 0.
GpgpAxiom propose(const GpgpFit& fit, uint32_t round, uint32_t candidate, const GpgpAxiom* current);
void accept(const GpgpFit& fit, uint32_t round, const GpgpAxiom* proposed, const double* scores,
            GpgpFitCandidate* current, GpgpFitCandidate* best);
double scoreOf(const GpgpFitTarget& target, const GpgpAxiomMeasures& measures);

/// exp(-x) for x >= 0, to 1e-5 of its value up to x = 20, by products alone: the same bits everywhere.
double decay(double x);

} // namespace gpgp::spawn
