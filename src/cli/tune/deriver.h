// Derives axioms of one grammar over and over: buffers and budgets as large as it takes, times of a warm device.
#pragma once
#include "cli/shared/session.h"
#include "cli/tune/kernels.h"

#include <map>
#include <optional>

namespace gpgp::cli {

struct DeriverOptions {
  bool vertices = false;                 ///< vertices and indices, not instances
  bool sorted = false;                   ///< instances by bucket, with draws
  bool bounds = false;                   ///< and a box around each bucket
  uint32_t maxShapes = 0;                ///< 0: the library's default, and more where that is too little
  uint32_t maxDepth = 0;                 ///< 0: the library's default
  uint32_t maxColliders = 0;             ///< 0: as many as there are
  uint64_t expected = 0;                 ///< instances or vertices, where that is known: spares a second try
  std::optional<GpgpSpawnCamera> camera; ///< of all recordings
  std::vector<GpgpSpawnField> fields;    ///< as well; their names must outlive the deriver
  std::vector<float> fieldValues;
  uint32_t maxInstances = 0; ///< 0: as many as there are, as far as the device binds them
  bool kernelsOnly = false;  ///< grammars have kernels; the interpreter is made only where none of them fits the device
};

/// A vertex of `--output vertices`: position R32G32B32_SFLOAT, normal R8G8B8A8_SNORM, uv R32G32_SFLOAT, terminal and
/// axiom id R32_UINT.
struct SpawnedVertex {
  float position[3];
  int8_t normal[4];
  float uv[2];
  uint32_t terminal, axiom;
};
static_assert(sizeof(SpawnedVertex) == 32);

/// What deriving some axioms anew costs beside deriving all.
struct Changes {
  GpuTimes whole, part;
  uint64_t instances = 0, changed = 0; ///< of all ranges, and of those that were derived anew
  uint64_t moved = 0;                  ///< instances of other ranges that are not what they were
  uint64_t foreign = 0;                ///< instances of the ranges derived anew that are not of their axiom
};

class Deriver {
public:
  /// How SpawnedVertex is told to the library.
  static GpgpVertexLayout layout();
  Deriver(Session& session, const BakedGraph& grammar, const std::vector<GpgpAxiom>& axioms,
          const DeriverOptions& options);
  /// Axioms that this device binds at once.
  static uint64_t mostAxioms(Session& session);
  void setAxioms(const std::vector<GpgpAxiom>& axioms);

  /// For each of the kernels, as words: the grammar on the device with its pipeline, made on all processors. No words:
  /// the interpreter.
  std::vector<Grammar> prepare(std::span<const std::pmr::vector<uint32_t>> kernels);
  Grammar prepare(const std::pmr::vector<uint32_t>& kernel);
  /// prepare in parts: the grammar, by the context's thread; its pipelines, by any thread; then Session::upload.
  Grammar load(const std::pmr::vector<uint32_t>& kernel);
  GpgpResult prewarm(const Grammar& grammar) { return spawner_->prewarm(grammar); }
  /// Derives once. Where the report says that shapes were dropped, or that buffers are too small, again with more of
  /// what was short, as far as the device and the options allow.
  GpgpSpawnReport fit(const Grammar& grammar);
  /// Back to the budgets of the start: with higher ones all that is measured later would take longer.
  void resetBudgets();
  /// rounds: what is recorded at most; 0: what the budgets say.
  Measured<GpgpSpawnReport> measure(const Grammar& grammar, uint32_t repeat, uint32_t rounds = 0);

  /// Derives the axioms into ranges of their own, then others in the place of some of them, by number, and nothing
  /// else. Both are measured.
  Changes change(const Grammar& grammar, const std::vector<GpgpAxiom>& axioms,
                 const std::map<uint32_t, GpgpAxiom>& changed, uint32_t repeat);

  /// Instances or vertices that this device binds at once.
  uint64_t mostElements() const;
  uint32_t mostColliders() const;
  uint32_t mostShapes() const;
  uint32_t maxShapes() const { return maxShapes_; }
  uint32_t maxRounds() const { return maxRounds_; }
  bool interprets() const { return interprets_; }
  /// What the last derivation took and wrote, read back.
  std::vector<GpgpInstance> instances();
  std::vector<SpawnedVertex> vertices();
  std::vector<uint32_t> indices();
  /// Instances or indices written, as the GPU counted them.
  uint32_t count();
  uint64_t bytesWritten();

private:
  /// Camera and fields.
  void setWorld(GpgpSpawnInfo& info) const;
  Measured<GpgpSpawnReport> measureRanges(const Grammar& grammar, const std::vector<GpgpAxiom>& axioms,
                                          std::vector<GpgpAxiomRange>& ranges, uint32_t repeat);
  Spawner newSpawner(uint32_t rounds);
  void makeSpawner();
  void makeOutput(uint64_t elements);

  Session& session_;
  const BakedGraph& grammar_;
  DeriverOptions options_;
  uint32_t axiomCount_ = 0, maxShapes_ = 0, maxRounds_ = 0, maxTerminals_ = 0, maxColliders_ = 0;
  uint32_t firstShapes_ = 0, firstRounds_ = 0; // budgets of the start
  std::optional<Spawner> spawner_;
  bool interprets_ = true;
  std::map<uint32_t, Spawner> limited_; // with fewer rounds
  host::Buffer axioms_, instances_, vertices_, indices_, draws_, count_, bounds_, fieldValues_;
  uint64_t elements_ = 0; // instances or vertices that the buffers hold
};

} // namespace gpgp::cli
