// Finds the fastest schedule of a grammar on a device by measuring.
//
// First schedules (which edges are static), each with the device's usual numbers; the best few of them with a queue for
// each execution group; and those near the best, until none of these is better. Then, for the best two, the size and
// count of workgroups; then, for the best, when work is spread, and whether idle workgroups get some; then the best few
// by turns, as they would be kept. Every candidate must derive what the interpreter derives, within the budgets that
// the interpreter needs.
//
// Nearly all of the time goes into the driver's compiler. Kernels are compiled on all processors, as many at a time as
// there are, and no more of them than the time allows: the best is chosen from what was measured by then.
#pragma once
#include "cli/tune/deriver.h"

#include <limits>

namespace gpgp::cli {

struct TuneSettings {
  /// Nothing: every partition where there are no more than samples; else half of the samples as the heuristics and
  /// coins say, and what is near the best of them.
  std::optional<spawn::Search> search;
  bool mixed = true, grouped = true; ///< kinds of queues that are tried: one or both
  bool matching = false;             ///< chains of groups that differ in parameters only share code
  spawn::Heuristics heuristics;
  bool schedulesOnly = false; ///< leave the numbers as the device suggests
  uint32_t samples = 32;      ///< schedules at most, the named ones included; the best few once more with queues
  uint32_t repeat = 15, seed = 1;
  DeriverOptions derive; ///< its depth, camera and fields
  double seconds = 50;   ///< nothing is begun that would probably take longer; 0: no limit. The interpreter and one
                         ///< schedule are always measured
};

/// A schedule with numbers, and what it took.
struct Candidate {
  size_t schedule = 0; ///< in Tuned::schedules
  spawn::Fit fit;
  /// Infinite where it would drop shapes in a spawner that has room for what the interpreter needs.
  double milliseconds = std::numeric_limits<double>::infinity();
  uint32_t rounds = 0; ///< that are recorded; 0: as many as the library takes
};

struct Tuned {
  std::vector<spawn::Schedule> schedules;
  std::vector<Candidate> measured; ///< of schedules alone, the fastest first
  Candidate best;
  KernelCode code;        ///< of the best
  spawn::KernelInfo info; ///< of the best, as it is kept: for this device and number of axioms
  GpgpSpawnReport report{};
  double interpreter = 0; ///< milliseconds
  bool complete = false;  ///< all partitions were tried
  size_t candidates = 0;  ///< measured
  size_t omitted = 0;     ///< for lack of time
  double seconds = 0;

  const spawn::Schedule& schedule() const { return schedules[best.schedule]; }
};

/// Throws Failure where nothing comes of the axioms, or where a candidate derives something else.
Tuned tuneGrammar(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
                  const TuneSettings& settings);

} // namespace gpgp::cli
