/* gpgp evaluator.hpp: C++17 wrapper of evaluator.h. The rules of the wrapper are in core.hpp.
 * The functions are in libgpgp_evaluator; only programs that call them link that library.
 *
 *   auto evaluator = gpgp::Evaluator::create(info);
 *   auto evaluation = evaluator->evaluation();
 *   evaluation->derive(axioms);
 *   auto result = evaluation->result();
 */
#ifndef GPGP_EVALUATOR_HPP
#define GPGP_EVALUATOR_HPP

#include <gpgp/evaluator.h>
#include <gpgp/spawn.hpp>

#include <cstdint>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpEvaluatorCreateInfo, GPGP_STRUCTURE_EVALUATOR_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpEvaluationInfo, GPGP_STRUCTURE_EVALUATION_INFO);
GPGP_STRUCTURE_OF(GpgpEvaluationResult, GPGP_STRUCTURE_EVALUATION_RESULT);

namespace detail {
template <> struct Destroy<GpgpEvaluator> {
  void operator()(GpgpEvaluator handle) const noexcept { gpgpDestroyEvaluator(handle); }
};
template <> struct Destroy<GpgpEvaluation> {
  void operator()(GpgpEvaluation handle) const noexcept { gpgpDestroyEvaluation(handle); }
};
} // namespace detail

/// What was derived from a list of axioms (gpgpCreateEvaluation).
class Evaluation : public Handle<GpgpEvaluation> {
public:
  using Handle::Handle;
  /// gpgpEvaluate
  [[nodiscard]] GpgpResult derive(const GpgpEvaluationInfo& info) noexcept { return gpgpEvaluate(get(), &info); }
  /// gpgpGetEvaluationResult
  Result<GpgpEvaluationResult> result() const noexcept {
    GpgpEvaluationResult value = init<GpgpEvaluationResult>();
    const GpgpResult code = gpgpGetEvaluationResult(get(), &value);
    return Result<GpgpEvaluationResult>(code, value);
  }
};

/// A grammar for the CPU (gpgpCreateEvaluator). It must outlive its evaluations.
class Evaluator : public Handle<GpgpEvaluator> {
public:
  using Handle::Handle;
  static Result<Evaluator> create(const GpgpEvaluatorCreateInfo& info) noexcept {
    GpgpEvaluator raw = nullptr;
    const GpgpResult code = gpgpCreateEvaluator(&info, &raw);
    return Result<Evaluator>(code, Evaluator(raw));
  }
  /// gpgpCreateEvaluation
  Result<Evaluation> evaluation() const noexcept {
    GpgpEvaluation raw = nullptr;
    const GpgpResult code = gpgpCreateEvaluation(get(), &raw);
    return Result<Evaluation>(code, Evaluation(raw));
  }
  /// gpgpGetEvaluatorTerminals. count: in, the capacity of terminals; out, the number of all terminals.
  [[nodiscard]] GpgpResult terminals(uint32_t& count, GpgpGrammarTerminal* terminals) const noexcept {
    return gpgpGetEvaluatorTerminals(get(), &count, terminals);
  }
  /// gpgpGetEvaluatorStarts, with count as for terminals().
  [[nodiscard]] GpgpResult starts(uint32_t& count, GpgpGrammarStart* starts) const noexcept {
    return gpgpGetEvaluatorStarts(get(), &count, starts);
  }
  /// gpgpGetEvaluatorFields, with count as for terminals().
  [[nodiscard]] GpgpResult fields(uint32_t& count, const char** names) const noexcept {
    return gpgpGetEvaluatorFields(get(), &count, names);
  }
  /// gpgpFindEvaluatorStart
  Result<uint32_t> start(const char* name) const noexcept {
    uint32_t value = 0;
    const GpgpResult code = gpgpFindEvaluatorStart(get(), name, &value);
    return Result<uint32_t>(code, value);
  }
};

} // namespace gpgp

#endif
