// Finds the fastest schedule of a grammar on a device by measuring.
//
// First schedules (which edges are static), each with the device's usual numbers; then, for the best two, the numbers
// (size and count of workgroups, when work is spread). Every candidate must derive what the interpreter derives.
#pragma once
#include "cli/deriver.h"

#include <limits>

namespace gpgp::cli {

struct TuneSettings {
  spawn::Search search = spawn::Search::heuristic;
  bool matching = false;      ///< chains of groups that differ in parameters only share code
  bool schedulesOnly = false; ///< leave the numbers as the device suggests
  uint32_t samples = 12;      ///< schedules at most, the named ones included
  uint32_t repeat = 15, seed = 1;
};

/// A schedule with numbers, and what it took.
struct Candidate {
  size_t schedule = 0; ///< in Tuned::schedules
  spawn::Fit fit;
  double milliseconds = std::numeric_limits<double>::infinity(); ///< it exceeds the device's budgets
  uint32_t rounds = 0;
  bool larger = false; ///< it needs more rounds or shapes than the interpreter does: measured, but never the best
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
  size_t candidates = 0;
  double seconds = 0;

  const spawn::Schedule& schedule() const { return schedules[best.schedule]; }
};

/// Throws Failure where nothing comes of the axioms, or where a candidate derives something else.
Tuned tuneGrammar(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
                  const TuneSettings& settings);

} // namespace gpgp::cli
