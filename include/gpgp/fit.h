/* gpgp fit: inverse modelling. Finds the axiom whose derivation comes nearest to what is wanted: a silhouette, a
 * volume, a sum, or a score of the engine's own.
 *
 * A round is a list of candidates, axioms that differ in some of their fields. One recording derives them all and
 * measures each (GpgpSpawnInfo::measures); no instances are written. What the GPU found becomes scores, and scores
 * decide which candidates go on:
 *
 *   gpgpProposeAxioms          the axioms of a round
 *   gpgpRecordPrepareSpawn     derives and measures them; gpgpGetSpawnReport brings the measures, frames later
 *   gpgpScoreMeasures          measures to scores, or a score of the engine's own; lower is better
 *   gpgpAcceptAxioms           which candidates go on; the best one of all
 *
 * The functions keep nothing between calls, allocate nothing and use arithmetic that is the same everywhere: the same
 * GpgpFit and scores give the same axioms on every machine.
 */
#ifndef GPGP_FIT_H
#define GPGP_FIT_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** A field of GpgpAxiom. */
typedef uint32_t GpgpFitField;
enum {
  GPGP_FIT_SIZE_X = 0,
  GPGP_FIT_SIZE_Y = 1, /**< The middle of the lower face stays where it is in GpgpFit::base. */
  GPGP_FIT_SIZE_Z = 2,
  GPGP_FIT_ATTRIBUTE = 3,
  GPGP_FIT_SEED = 4 /**< Whole numbers below 2^24. A step to another seed is a jump to any. */
};

/** What may vary, and how far. */
typedef struct GpgpFitParameter {
  GpgpFitField field;
  float min, max; /**< min is at most max. Sizes are more than 0. */
  float step;     /**< 0: any number. Else: min + n * step. Of seeds: at least 1. */
} GpgpFitParameter;

typedef uint32_t GpgpFitMethod;
enum {
  /** Every round draws all parameters anew. A candidate that is better than the one before takes its place. */
  GPGP_FIT_MONTE_CARLO = 0,
  /** The first round draws all parameters. Later ones change one of them, sometimes more, by steps that become
   *  shorter. A candidate that is worse by d is accepted with probability exp(-d / temperature) (Metropolis). Each
   *  place in the list of candidates is a chain of its own. */
  GPGP_FIT_ANNEALING = 1
};

/** A search. */
typedef struct GpgpFit {
  GpgpStructureType sType;
  const void* pNext;
  GpgpAxiom base;                     /**< All that no parameter varies. Candidates have ids 0, 1, 2 and so on. */
  const GpgpFitParameter* parameters; /**< Each field at most once. */
  uint32_t parameterCount;            /**< 1 to 5. */
  uint32_t candidates;                /**< Axioms of a round, at least 1. */
  uint32_t rounds;                    /**< At least 1. An engine may end earlier. */
  GpgpFitMethod method;
  uint32_t seed;
  /** Of annealing, in units of the score: from the first round to the last. At least 0. */
  float startTemperature, endTemperature;
} GpgpFit;
#define GPGP_FIT_INIT GPGP_INIT(GpgpFit, GPGP_STRUCTURE_FIT)

/** A candidate and its score. */
typedef struct GpgpFitCandidate {
  GpgpAxiom axiom;
  double score; /**< Lower is better. */
} GpgpFitCandidate;

/** Makes the axioms of a round. current: GpgpFitCandidate[candidates], as gpgpAcceptAxioms left them; not read in round
 *  0. Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpProposeAxioms(const GpgpFit* fit, uint32_t round, const GpgpFitCandidate* current,
                                                GpgpAxiom* proposed);

/** Decides which axioms of a round go on. scores: of each of the proposed axioms; one that is no number is worse than
 *  all. current: written in round 0, later read and changed where a candidate is accepted. best: optional, the best of
 *  all rounds; written in round 0, later changed where one is better.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAcceptAxioms(const GpgpFit* fit, uint32_t round, const GpgpAxiom* proposed,
                                               const double* scores, GpgpFitCandidate* current, GpgpFitCandidate* best);

/** What is wanted of measures. A score is the sum of its parts:
 *  sumWeights[m] * |sums[m] / 65536 - sums wanted|, and
 *  occupancyWeight * (cells that are wrongly occupied or wrongly empty) / (cells of the target, at least 1). */
typedef struct GpgpFitTarget {
  GpgpStructureType sType;
  const void* pNext;
  double sums[GPGP_MAX_MEASURES];
  double sumWeights[GPGP_MAX_MEASURES]; /**< 0: does not matter. */
  double occupancyWeight;
  uint32_t targetCells; /**< The bits of GpgpOccupancy::target that are set. */
} GpgpFitTarget;
#define GPGP_FIT_TARGET_INIT GPGP_INIT(GpgpFitTarget, GPGP_STRUCTURE_FIT_TARGET)

/** Turns measures into scores. Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpScoreMeasures(const GpgpFitTarget* target, const GpgpAxiomMeasures* measures,
                                                uint32_t count, double* scores);

#ifdef __cplusplus
}
#endif
#endif
