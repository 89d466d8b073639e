// Derivation of many axioms on the CPU, in ranges that the engine's jobs run: the inside of libgpgp_evaluator.
//
// A range is a run of axioms with a walker of its own, so that no two jobs share anything that is written. All ranges
// end a phase before the next begins. The result is by axiom and the same for every number of ranges.
#pragma once
#include "core/host_memory.h"
#include "spawn/evaluator/walker.h"
#include "spawn/graph/blob.h"

#include <gpgp/evaluator.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace gpgp::spawn {

/// Memory in pieces: what belongs together stays together, and nothing else moves. T is trivially copyable.
template <class T> class Pieces {
public:
  explicit Pieces(std::pmr::memory_resource* memory) : pieces_(memory) {}
  Pieces(const Pieces&) = delete;
  ~Pieces() {
    for (const Piece& piece : pieces_) free(piece);
  }

  /// Everything may be overwritten from now on; the memory stays.
  void clear() {
    current_ = 0;
    next = end = start_ = nullptr;
    if (pieces_.empty()) return;
    next = start_ = pieces_[0].data;
    end = next + pieces_[0].size;
  }
  /// What comes from now on belongs together.
  void begin() { start_ = next; }
  T* start() const { return start_; }
  /// [next, end) gets room for `count` more.
  void makeRoom(size_t count = 1) {
    const size_t kept = static_cast<size_t>(next - start_), wanted = kept + count;
    const bool alone = start_ && start_ == pieces_[current_].data; // nothing else lies in that piece
    size_t at = start_ ? current_ + 1 : 0;
    while (at < pieces_.size() && pieces_[at].size < wanted) free(take(at)); // from an earlier use
    if (at == pieces_.size()) add(kept ? 2 * wanted : wanted);
    const Piece piece = pieces_[at];
    if (kept) std::memcpy(static_cast<void*>(piece.data), start_, kept * sizeof(T));
    if (alone) free(take(current_));
    current_ = alone ? at - 1 : at;
    start_ = piece.data;
    next = start_ + kept;
    end = start_ + piece.size;
  }

  T *next = nullptr, *end = nullptr;

private:
  static constexpr size_t kFirst = 8192, kMost = size_t(2) << 20; // bytes
  struct Piece {
    T* data;
    size_t size;
  };
  std::pmr::memory_resource* memory() const { return pieces_.get_allocator().resource(); }
  void add(size_t wanted) {
    const size_t least = std::min(kMost, kFirst << std::min<size_t>(pieces_.size(), 16)) / sizeof(T);
    const size_t size = std::max(least, wanted);
    pieces_.reserve(pieces_.size() + 1); // so that nothing fails once the memory is there
    pieces_.push_back({static_cast<T*>(memory()->allocate(size * sizeof(T), alignof(T))), size});
  }
  void free(const Piece& piece) { memory()->deallocate(piece.data, piece.size * sizeof(T), alignof(T)); }
  Piece take(size_t at) {
    const Piece piece = pieces_[at];
    pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(at));
    return piece;
  }

  std::pmr::vector<Piece> pieces_;
  size_t current_ = 0;
  T* start_ = nullptr;
};

/// A grammar that can be derived: everything is read only.
struct EvaluatorGrammar {
  EvaluatorGrammar(Graph&& checked, std::pmr::vector<uint32_t>&& baked)
      : graph(std::move(checked)), words(std::move(baked)),
        program(decode(words.data(), words.get_allocator().resource())) {}
  const Graph graph;
  const std::pmr::vector<uint32_t> words;
  const Program program;
};

/// The box of an instance in the world.
GpgpSpawnBounds boundsOf(const GpgpInstance& instance);

class AxiomRange; ///< a run of axioms, and their results

/// Derives, and holds what came of it.
class Evaluation {
public:
  Evaluation(const EvaluatorGrammar& grammar, const GpgpJobSystem& jobs, core::HostMemory& memory);
  ~Evaluation();

  /// Throws std::bad_alloc. Both an error and that leave the evaluation empty. info is checked.
  core::Result<void> derive(const GpgpEvaluationInfo& info, const VertexLayout* layout);
  const GpgpEvaluationResult& result() const { return result_; }

private:
  void clear();
  core::Result<void> run(const GpgpEvaluationInfo& info, const VertexLayout* layout);
  void merge();

  const EvaluatorGrammar& grammar_;
  const GpgpJobSystem jobs_;
  core::HostMemory& memory_;
  std::pmr::vector<core::Unique<AxiomRange>> ranges_; // more than are used, where an earlier derivation used more
  std::pmr::vector<GpgpEvaluatedAxiom> axioms_;
  std::pmr::vector<GpgpAxiomMeasures> measures_;
  std::pmr::vector<uint32_t> indices_;
  GpgpEvaluationResult result_ = GPGP_EVALUATION_RESULT_INIT;
};

} // namespace gpgp::spawn
