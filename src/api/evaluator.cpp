// The C functions of evaluator.h, in libgpgp_evaluator, which has no context: messages go to those who made the object.
#include "api/check_struct.h"
#include "api/standalone.h"
#include "spawn/evaluator/evaluation.h"
#include "spawn/language/compile_grammar.h"

#include <cmath>
#include <string>

using namespace gpgp;
using namespace gpgp::api::standalone;
using api::checkStruct;
using core::makeError;
using core::Result;

namespace {

struct EvaluatorObject {
  static constexpr uint32_t kMagic = 0x6576616c; // "eval"
  explicit EvaluatorObject(const GpgpEvaluatorCreateInfo& info)
      : memory(info.hostAllocator), jobs(info.jobSystem ? *info.jobSystem : GpgpJobSystem{}),
        label(info.label ? info.label : "", &memory), messageFn(info.messageFn), messageUserData(info.messageUserData) {
  }

  uint32_t magic = kMagic;
  core::HostMemory memory;
  GpgpJobSystem jobs;
  std::pmr::string label;
  GpgpMessageFn messageFn;
  void* messageUserData;
  std::optional<spawn::EvaluatorGrammar> grammar;
};

struct EvaluationObject {
  static constexpr uint32_t kMagic = 0x6576616e;
  explicit EvaluationObject(EvaluatorObject& owner)
      : evaluator(owner), evaluation(*owner.grammar, owner.jobs, owner.memory) {}

  uint32_t magic = kMagic;
  EvaluatorObject& evaluator;
  spawn::Evaluation evaluation;
};

Receiver receiverOf(const EvaluatorObject* evaluator) {
  if (!evaluator) return {};
  return {evaluator->messageFn, evaluator->messageUserData, evaluator->label.c_str()};
}

void destroyEvaluator(EvaluatorObject* object) {
  core::HostMemory memory(&object->memory.callbacks()); // which it contains
  destroy(memory, object);
}

Result<void> compile(const GpgpEvaluatorCreateInfo& info, EvaluatorObject& object) {
  spawn::Graph made(std::pmr::new_delete_resource());
  const GpgpResult result = spawn::graphOf({info.sources, info.sourceCount}, info.sourceCount > 1, nullptr, made);
  if (result == GPGP_ERROR_INVALID_STRUCT) return makeError(result, "a source is not a GpgpGrammarSource");
  if (result != GPGP_SUCCESS)
    return makeError(result, "%s", "the grammar has errors; the messages of its source say where");
  auto words = spawn::serialize(made, &object.memory);
  auto graph = spawn::load(std::as_bytes(std::span(words)), &object.memory);
  if (!graph) return graph.error();
  object.grammar.emplace(std::move(*graph), std::move(words));
  return {};
}

Result<void> check(const GpgpEvaluationInfo& info) {
  if (info.axiomCount && !info.axioms) return invalid("axioms is NULL, axiomCount is not 0");
  if (info.contextCount > info.axiomCount) return invalid("contextCount is more than axiomCount");
  if (info.keyCount && !info.keys) return invalid("keys is NULL, keyCount is not 0");
  if (info.flags & ~(GPGP_EVALUATION_COUNT_ONLY | GPGP_EVALUATION_BOUNDS)) return invalid("flags has unknown bits");
  if (info.measures && (info.flags & GPGP_EVALUATION_COUNT_ONLY))
    return invalid("measures is set, but flags has GPGP_EVALUATION_COUNT_ONLY");
  if (info.maxDepth > 65535) return invalid("maxDepth is at most 65535");
  if (info.maxShapesPerAxiom > 1u << 31) return invalid("maxShapesPerAxiom is at most 2147483648");
  for (int axis = 0; info.region && axis < 3; ++axis)
    if (!(info.region->min[axis] <= info.region->max[axis])) // nor are numbers that are none
      return invalid("region has a min that is not at most its max");
  return {};
}

} // namespace

GpgpResult GPGP_CALL gpgpCreateEvaluator(const GpgpEvaluatorCreateInfo* info, GpgpEvaluator* evaluator) {
  const bool typed = info && info->sType == GPGP_STRUCTURE_EVALUATOR_CREATE_INFO;
  const Receiver to =
      typed ? Receiver{info->messageFn, info->messageUserData, info->label ? info->label : ""} : Receiver{};
  return guarded("gpgpCreateEvaluator", to, [&]() -> Result<void> {
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_EVALUATOR_CREATE_INFO, "info"); !ok) return ok;
    if (!evaluator) return invalid("evaluator is NULL");
    if (!info->sources || !info->sourceCount) return invalid("there are no sources");
    for (uint32_t i = 0; i < info->sourceCount; ++i)
      if (info->sources[i].builder)
        return invalid("a source is a builder, which libgpgp_evaluator does not read; bake it with gpgpCompileGrammar");
    if (info->hostAllocator && (!info->hostAllocator->allocate || !info->hostAllocator->free))
      return invalid("hostAllocator needs both allocate and free");
    core::HostMemory bootstrap(info->hostAllocator);
    auto* object = make<EvaluatorObject>(bootstrap, *info);
    try {
      if (auto ok = compile(*info, *object); !ok) {
        destroyEvaluator(object);
        return ok;
      }
    } catch (...) {
      destroyEvaluator(object);
      throw;
    }
    *evaluator = reinterpret_cast<GpgpEvaluator>(object);
    return {};
  });
}

void GPGP_CALL gpgpDestroyEvaluator(GpgpEvaluator handle) {
  if (auto* object = objectOf<EvaluatorObject>(handle)) destroyEvaluator(object);
}

GpgpResult GPGP_CALL gpgpGetEvaluatorTerminals(GpgpEvaluator handle, uint32_t* count, GpgpGrammarTerminal* terminals) {
  const auto* object = objectOf<EvaluatorObject>(handle);
  return guarded("gpgpGetEvaluatorTerminals", receiverOf(object), [&]() -> Result<void> {
    if (!object) return notA("evaluator", "an evaluator");
    const spawn::Graph& graph = object->grammar->graph;
    return deliver(static_cast<uint32_t>(graph.terminals.size()), count, terminals, "terminals", [&](uint32_t i) {
      const spawn::Terminal& t = graph.terminals[i];
      return GpgpGrammarTerminal{graph.nameAt(t.name), t.kind, t.index, t.bucket};
    });
  });
}

GpgpResult GPGP_CALL gpgpGetEvaluatorStarts(GpgpEvaluator handle, uint32_t* count, GpgpGrammarStart* starts) {
  const auto* object = objectOf<EvaluatorObject>(handle);
  return guarded("gpgpGetEvaluatorStarts", receiverOf(object), [&]() -> Result<void> {
    if (!object) return notA("evaluator", "an evaluator");
    const spawn::Graph& graph = object->grammar->graph;
    return deliver(spawn::startCount(graph), count, starts, "starts", [&](uint32_t i) {
      const spawn::Start start = spawn::startAt(graph, i);
      return GpgpGrammarStart{start.name, start.axiom->shape, i >= graph.rules.size()};
    });
  });
}

GpgpResult GPGP_CALL gpgpGetEvaluatorFields(GpgpEvaluator handle, uint32_t* count, const char** names) {
  const auto* object = objectOf<EvaluatorObject>(handle);
  return guarded("gpgpGetEvaluatorFields", receiverOf(object), [&]() -> Result<void> {
    if (!object) return notA("evaluator", "an evaluator");
    const spawn::Graph& graph = object->grammar->graph;
    return deliver(static_cast<uint32_t>(graph.fields.size()), count, names, "names",
                   [&](uint32_t i) { return graph.nameAt(graph.fields[i]); });
  });
}

GpgpResult GPGP_CALL gpgpFindEvaluatorStart(GpgpEvaluator handle, const char* name, uint32_t* start) {
  const auto* object = objectOf<EvaluatorObject>(handle);
  return guarded("gpgpFindEvaluatorStart", receiverOf(object), [&]() -> Result<void> {
    if (!object) return notA("evaluator", "an evaluator");
    if (!name || !start) return invalid(name ? "start is NULL" : "name is NULL");
    const spawn::Graph& graph = object->grammar->graph;
    for (uint32_t i = 0; i < spawn::startCount(graph); ++i) {
      if (std::strcmp(spawn::startAt(graph, i).name, name) != 0) continue;
      *start = i;
      return {};
    }
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the grammar has no start \"%s\"", name);
  });
}

GpgpResult GPGP_CALL gpgpCreateEvaluation(GpgpEvaluator handle, GpgpEvaluation* evaluation) {
  auto* object = objectOf<EvaluatorObject>(handle);
  return guarded("gpgpCreateEvaluation", receiverOf(object), [&]() -> Result<void> {
    if (!object) return notA("evaluator", "an evaluator");
    if (!evaluation) return invalid("evaluation is NULL");
    *evaluation = reinterpret_cast<GpgpEvaluation>(make<EvaluationObject>(object->memory, *object));
    return {};
  });
}

void GPGP_CALL gpgpDestroyEvaluation(GpgpEvaluation handle) {
  if (auto* object = objectOf<EvaluationObject>(handle)) destroy(object->evaluator.memory, object);
}

GpgpResult GPGP_CALL gpgpEvaluate(GpgpEvaluation handle, const GpgpEvaluationInfo* info) {
  auto* object = objectOf<EvaluationObject>(handle);
  return guarded("gpgpEvaluate", receiverOf(object ? &object->evaluator : nullptr), [&]() -> Result<void> {
    if (!object) return notA("evaluation", "an evaluation");
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_EVALUATION_INFO, "info"); !ok) return ok;
    if (auto ok = check(*info); !ok) return ok;
    if (!info->vertices) return object->evaluation.derive(*info, nullptr);
    const auto layout = spawn::layoutOf(*info->vertices);
    if (!layout) return layout.error();
    return object->evaluation.derive(*info, &*layout);
  });
}

GpgpResult GPGP_CALL gpgpGetEvaluationResult(GpgpEvaluation handle, GpgpEvaluationResult* result) {
  auto* object = objectOf<EvaluationObject>(handle);
  return guarded("gpgpGetEvaluationResult", receiverOf(object ? &object->evaluator : nullptr), [&]() -> Result<void> {
    if (!object) return notA("evaluation", "an evaluation");
    if (auto ok = checkStruct(result, GPGP_STRUCTURE_EVALUATION_RESULT, "result"); !ok) return ok;
    *result = object->evaluation.result();
    return {};
  });
}
