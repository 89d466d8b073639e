// Measures lists of axioms on the device, in as many recordings as its buffers take.
#pragma once
#include "cli/shared/session.h"
#include "cli/spawn/axioms.h"
#include "cli/tune/deriver.h"

#include <gpgp/gpgp.hpp>

#include <vector>

namespace gpgp::cli {

class FitScorer {
public:
  /// Of `how`, the depth, the camera and the fields. measures must outlive it.
  FitScorer(Session& session, const BakedGraph& grammar, const GpgpMeasureInfo& measures, const DeriverOptions& how);

  /// Of each axiom. Budgets grow until all fit, or a recording takes fewer axioms. Throws Failure where not even one
  /// axiom fits.
  std::vector<GpgpAxiomMeasures> measure(const std::vector<GpgpAxiom>& axioms);
  uint32_t startNamed(const std::string& name);

  uint64_t terminals() const { return terminals_; }
  uint32_t recordings() const { return recordings_; }
  double gpuMilliseconds() const { return milliseconds_; }

private:
  void makeSpawner();

  Session& session_;
  const GpgpMeasureInfo measures_;
  const DeriverOptions how_;
  const uint32_t occupancyWords_;
  uint32_t maxTerminals_, maxShapes_ = 131072, mostAxioms_ = 4096;
  uint32_t mostTerminals_; ///< that this device binds
  Grammar grammar_;
  std::optional<Spawner> spawner_;
  host::Buffer fieldValues_;
  uint64_t terminals_ = 0;
  uint32_t recordings_ = 0;
  double milliseconds_ = 0;
};

} // namespace gpgp::cli
