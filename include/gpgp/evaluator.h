/* gpgp evaluator: derives grammars on the CPU, with the same result as the spawn service on the GPU. Uses are
 * collision, navigation, saved games and servers. It has a library of its own, libgpgp_evaluator. The library needs
 * neither a device nor a context: use it with libgpgp, or alone. Nothing in it calls Vulkan.
 *
 *   evaluator    A grammar, ready to be derived. Read only: any number of threads may use it.
 *   evaluation   The result for a list of axioms. The next derivation reuses its memory.
 *
 *   gpgpCreateEvaluator -> gpgpCreateEvaluation -> gpgpEvaluate -> gpgpGetEvaluationResult, again for other axioms
 *
 * Counts, path keys, seeds, sizes, attributes and hashes are those of the GPU, bit for bit. Transforms, positions and
 * normals agree to 1e-4 of their size.
 *
 * Destroyed handles are not recognised, since there is no context: using one is undefined behaviour.
 */
#ifndef GPGP_EVALUATOR_H
#define GPGP_EVALUATOR_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct GpgpEvaluator_T* GpgpEvaluator;
typedef struct GpgpEvaluation_T* GpgpEvaluation;

typedef struct GpgpEvaluatorCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label; /**< For messages. The string is copied. */
  /** The grammar: a text (.pga, or .gml with GPGP_COMPILE_STACK_LANGUAGE) or a baked grammar, whose kernels are
   *  ignored. Several sources are linked, as by gpgpLinkGrammars. Builders are not allowed, since they belong to
   *  libgpgp_compiler: bake them. */
  const GpgpGrammarSource* sources;
  uint32_t sourceCount;                   /**< At least 1. */
  const GpgpHostAllocator* hostAllocator; /**< NULL: the C++ heap, which the compilation of texts always uses. */
  const GpgpJobSystem* jobSystem;         /**< NULL: all work runs on the calling thread. The struct is copied. */
  GpgpMessageFn messageFn;                /**< NULL: messages are dropped. Those of texts go to their sources. */
  void* messageUserData;
} GpgpEvaluatorCreateInfo;
#define GPGP_EVALUATOR_CREATE_INFO_INIT GPGP_INIT(GpgpEvaluatorCreateInfo, GPGP_STRUCTURE_EVALUATOR_CREATE_INFO)

/** Compiles or checks a grammar for the CPU.
 *  Errors: INVALID_DATA (the messages of the sources say where), INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED,
 *  OUT_OF_HOST_MEMORY. @threads any @lifetime call; what callbacks use: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateEvaluator(const GpgpEvaluatorCreateInfo* info, GpgpEvaluator* evaluator);

/** Destroys an evaluator. Its evaluations must have been destroyed before. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyEvaluator(GpgpEvaluator evaluator);

/** Lists the terminals of the grammar, as gpgpGetGrammarTerminals does. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetEvaluatorTerminals(GpgpEvaluator evaluator, uint32_t* count,
                                                        GpgpGrammarTerminal* terminals);

/** Lists the starts of the grammar, as gpgpGetGrammarStarts does. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetEvaluatorStarts(GpgpEvaluator evaluator, uint32_t* count,
                                                     GpgpGrammarStart* starts);

/** Lists the names of the fields that the grammar reads, as gpgpGetGrammarFields does.
 *  @threads any @lifetime handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetEvaluatorFields(GpgpEvaluator evaluator, uint32_t* count, const char** names);

/** Returns the index of the first start with a name, as gpgpFindGrammarStart does.
 *  Errors: INVALID_ARGUMENT (there is none), INVALID_HANDLE. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpFindEvaluatorStart(GpgpEvaluator evaluator, const char* name, uint32_t* start);

/** Creates an empty evaluation. Errors: INVALID_HANDLE, INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpCreateEvaluation(GpgpEvaluator evaluator, GpgpEvaluation* evaluation);

/** Destroys an evaluation and everything that gpgpGetEvaluationResult returned. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyEvaluation(GpgpEvaluation evaluation);

/** Returns a number other than 0 to cancel a derivation. Threads of the job system call it, possibly at the same time,
 *  at least once every 65536 shapes. */
typedef uint32_t(GPGP_CALL* GpgpIsCancelledFn)(void* userData);

typedef uint64_t GpgpEvaluationFlags;
/** Only the report: no instances and no vertices. */
#define GPGP_EVALUATION_COUNT_ONLY ((GpgpEvaluationFlags)1)
/** GpgpEvaluatedAxiom::bounds is filled. */
#define GPGP_EVALUATION_BOUNDS ((GpgpEvaluationFlags)2)

/** The axioms to derive, and which of their terminals to keep. Colliders of all axioms of a call collide with each
 *  other. keys and region choose what is kept, never what is derived. If both are given, a terminal must satisfy both.
 */
typedef struct GpgpEvaluationInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpAxiom* axioms;
  uint32_t axiomCount;
  GpgpEvaluationFlags flags;
  const uint32_t (*keys)[2]; /**< NULL: all. Only terminals with one of these path keys (GpgpInstance::key) are kept. */
  uint32_t keyCount;         /**< 0 with keys: none is kept. */
  const GpgpSpawnBounds* region; /**< Optional. Only terminals whose world-space box touches this one are kept. */
  /** Optional. Also returns the vertices of the kept terminals in this layout, as a spawner would write them. */
  const GpgpVertexLayout* vertices;
  uint32_t maxDepth; /**< As GpgpSpawnerCreateInfo::maxDepth. 0: 64. */
  /** Maximum number of shapes of an axiom, terminals included; at most 2^31. 0: 2^27. The derivation of an axiom stops
   *  there, always at the same shape. */
  uint32_t maxShapesPerAxiom;
  /** Number of ranges that the axioms are divided into. Each range is one job of GpgpJobSystem. The result does not
   *  depend on this number. 0: 64 with a job system, 1 without. */
  uint32_t rangeCount;
  GpgpIsCancelledFn isCancelled; /**< Optional. */
  void* cancelUserData;
  const GpgpSpawnCamera* camera; /**< As GpgpSpawnInfo::camera. */
  /** Optional. Fills GpgpEvaluationResult::measures, of the kept terminals. Not with GPGP_EVALUATION_COUNT_ONLY. */
  const GpgpMeasureInfo* measures;
  uint32_t contextCount; /**< As GpgpSpawnInfo::contextCount. Such axioms have results without terminals. */
  uint32_t fieldCount;
  /** As GpgpSpawnInfo::fields, with the values in host memory (GpgpGroundField::values). */
  const GpgpSpawnField* fields;
} GpgpEvaluationInfo;
#define GPGP_EVALUATION_INFO_INIT GPGP_INIT(GpgpEvaluationInfo, GPGP_STRUCTURE_EVALUATION_INFO)

/** Derives the axioms, and replaces what the evaluation held. It returns when everything is derived. An error about
 *  the arguments changes nothing; after GPGP_CANCELLED or OUT_OF_HOST_MEMORY the evaluation is empty.
 *  Errors: INVALID_HANDLE, INVALID_STRUCT, INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpEvaluate(GpgpEvaluation evaluation, const GpgpEvaluationInfo* info);

/** The result of one axiom. Its terminals are in depth-first order, one phase after the other. */
typedef struct GpgpEvaluatedAxiom {
  GpgpResult status; /**< SUCCESS, or BUDGET_EXCEEDED: the axiom was not derived to its end, or shapes were dropped. */
  uint32_t instanceCount;        /**< Terminals that were kept. */
  const GpgpInstance* instances; /**< [instanceCount] */
  const void* vertices;          /**< 4 for every quad. NULL without GpgpEvaluationInfo::vertices. */
  uint32_t vertexCount;
  uint32_t indexCount;    /**< vertexCount / 4 * 6: the axiom uses the first ones of GpgpEvaluationResult::indices. */
  GpgpSpawnBounds bounds; /**< Around the kept terminals. Only with GPGP_EVALUATION_BOUNDS. */
  uint32_t terminals;     /**< All terminals, kept or not. */
  uint32_t shapes;        /**< Shapes that were processed, terminals included. */
  uint32_t droppedShapes, unfinishedShapes, depth; /**< As in GpgpSpawnReport. */
  /** As in GpgpSpawnReport, for this axiom. The sum over all axioms, modulo 2^32, is that of the result. */
  uint32_t keyHash[2];
} GpgpEvaluatedAxiom;

/** All pointers stay valid until the next gpgpEvaluate of the evaluation, or until it is destroyed. */
typedef struct GpgpEvaluationResult {
  GpgpStructureType sType;
  void* pNext;
  GpgpResult status; /**< SUCCESS, or BUDGET_EXCEEDED where any axiom says so. */
  uint32_t axiomCount;
  const GpgpEvaluatedAxiom* axioms; /**< [axiomCount], in the order of GpgpEvaluationInfo::axioms. */
  const uint32_t* indices;          /**< One pattern for all axioms: 0 1 2 0 2 3, 4 5 6 4 6 7 and so on. */
  uint32_t indexCount;              /**< Enough for the axiom with the most vertices. */
  uint64_t instances;               /**< Terminals that were kept. */
  uint64_t terminals;               /**< All terminals, kept or not. */
  uint64_t shapes;                  /**< Shapes that were processed, terminals included. */
  uint64_t colliders;               /**< Shapes that Collider registered. */
  uint32_t droppedShapes, unfinishedShapes, depth; /**< As in GpgpSpawnReport. */
  uint32_t keyHash[2];                             /**< As in GpgpSpawnReport: equal to that of the GPU. */
  uint32_t rangeCount;                             /**< Number of ranges that were used. */
  /** [axiomCount], as a spawner measures. NULL without GpgpEvaluationInfo::measures. */
  const GpgpAxiomMeasures* measures;
} GpgpEvaluationResult;
#define GPGP_EVALUATION_RESULT_INIT GPGP_INIT(GpgpEvaluationResult, GPGP_STRUCTURE_EVALUATION_RESULT)

/** Returns what the evaluation holds. Errors: INVALID_HANDLE, INVALID_STRUCT. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetEvaluationResult(GpgpEvaluation evaluation, GpgpEvaluationResult* result);

#ifdef __cplusplus
}
#endif
#endif
