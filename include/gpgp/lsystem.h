/* gpgp lsystem: derives L-systems on the GPU and writes what their turtle draws into the engine's buffers.
 *
 *   L-system (asset)              a compiled .lsys file
 *   L-system recorder (recorder)  derives axioms of any L-system; its budgets are fixed when it is created
 *
 * Steps:
 *   gpgpCompileLsystem (libgpgp_compiler)    text to a compiled L-system, at build time or at run time
 *   gpgpCreateLsystem, gpgpRecordUpload      the compiled L-system to an asset on the device
 *   gpgpCreateLsystemRecorder, gpgpPrewarm   the recorder
 *   gpgpRecordPrepareLsystem                 derives and draws, as often as wanted
 *
 * Words: a string is a list of modules. A module is a symbol with parameters. A step rewrites all modules of a string
 * at once. The turtle reads the last string, and each module that draws becomes an instance of a terminal. The language
 * is described in docs/guide/lsystems.md.
 */
#ifndef GPGP_LSYSTEM_H
#define GPGP_LSYSTEM_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- compiler (libgpgp_compiler) */

/** The source of an L-system. */
typedef struct GpgpLsystemSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< File name for messages. */
  const char* text; /**< UTF-8, at most 16 MiB. It need not end in 0. */
  size_t size;      /**< Bytes of text. */
  /** New values for constants of the text, or for iterations, angle, step, width and seed. Unknown names are errors. */
  const GpgpVariable* variables;
  uint32_t variableCount;
  /** Receives all errors, warnings and notes, sorted by place: at most 1000 of each, and then how many were omitted. */
  GpgpCompileMessageFn messageFn;
  void* messageUserData;
  /** Of a text that has several systems with names, as files of Fractint do, the one to compile. NULL: the first. */
  const char* start;
} GpgpLsystemSource;
#define GPGP_LSYSTEM_SOURCE_INIT GPGP_INIT(GpgpLsystemSource, GPGP_STRUCTURE_LSYSTEM_SOURCE)

/** Compiles the text of an L-system. The result depends on the input only. In libgpgp_compiler.
 *  Errors: INVALID_DATA (messages say where), INVALID_ARGUMENT, INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileLsystem(const GpgpLsystemSource* source, GpgpBlob* blob);

/* ---------------------------------------------------------------- L-system */

/** Exactly one of data and filePath is set. */
typedef struct GpgpLsystemCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;    /**< For messages and debug names. The string is copied. */
  const void* data;     /**< A compiled L-system. It is copied. */
  size_t size;          /**< Bytes of data. */
  const char* filePath; /**< A file with a compiled L-system, read through GpgpFileSystem or the C library. */
} GpgpLsystemCreateInfo;
#define GPGP_LSYSTEM_CREATE_INFO_INIT GPGP_INIT(GpgpLsystemCreateInfo, GPGP_STRUCTURE_LSYSTEM_CREATE_INFO)

/** Checks a compiled L-system and queues it for upload. Checked are magic, version, checksum, every index and every
 *  expression.
 *  Errors: INVALID_DATA, INVALID_ARGUMENT, INVALID_STRUCT, INVALID_HANDLE, IO, OUT_OF_..._MEMORY, DEVICE_LOST.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateLsystem(GpgpContext context, const GpgpLsystemCreateInfo* info,
                                                GpgpAsset* lsystem);

/** Lists what an L-system can draw. kind 0: a segment, polygon or cylinder. kind 1: an asset of the engine. index and
 *  bucket are the number of the terminal. count is the capacity of terminals on input and the number of all on output.
 *  If terminals is NULL, only the count is returned. If it is too small, the function fills it and returns
 *  GPGP_INCOMPLETE. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetLsystemTerminals(GpgpAsset lsystem, uint32_t* count,
                                                      GpgpGrammarTerminal* terminals);

/** A symbol of an L-system. A name with another number of parameters is another symbol. */
typedef struct GpgpLsystemSymbol {
  const char* name; /**< @lifetime handle */
  uint32_t parameterCount;
} GpgpLsystemSymbol;

/** Lists the symbols of an L-system, for GpgpLsystemModule::symbol. count and symbols are used as in
 *  gpgpGetLsystemTerminals. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetLsystemSymbols(GpgpAsset lsystem, uint32_t* count, GpgpLsystemSymbol* symbols);

/* ---------------------------------------------------------------- recorder */

typedef uint64_t GpgpLsystemRecorderFlags;
/** The recorder takes L-systems with contexts and with the cut command. 32 bytes more for each of maxModules, rounded
 *  up to a power of two. */
#define GPGP_LSYSTEM_RECORDER_CONTEXTS ((GpgpLsystemRecorderFlags)1)

/** Budgets of an L-system recorder. */
typedef struct GpgpLsystemRecorderCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  GpgpLsystemRecorderFlags flags;
  /** Modules of a string, of all axioms of a recording together. At most 8388480, and less where a storage buffer of 64
   *  bytes for each does not fit the device. 0: 262144. About 220 bytes each. */
  uint32_t maxModules;
  uint32_t maxParameters; /**< Parameters of all modules of a string. At most 2^26. 0: as maxModules. 8 bytes each. */
  /** Steps of a recording: iterations, and the steps of decomposition and homomorphism. At most 1024. 0: 64. */
  uint32_t maxSteps;
  /** Rounds for turtles whose commands depend on the heading ($, T and tropism). A round processes 256 modules of a
   *  branch and starts the branches that begin there. At most 1024. 0: 64. */
  uint32_t maxRounds;
  /** Axioms of one recording that come from GpgpLsystemInfo::hostAxioms. 0: none. At most 2^20. */
  uint32_t maxHostAxioms;
} GpgpLsystemRecorderCreateInfo;
#define GPGP_LSYSTEM_RECORDER_CREATE_INFO_INIT                                                                         \
  GPGP_INIT(GpgpLsystemRecorderCreateInfo, GPGP_STRUCTURE_LSYSTEM_RECORDER_CREATE_INFO)

/** Creates a recorder, with scratch memory for its budgets. It derives any L-system. Prewarm it before the first
 *  recording.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, INVALID_HANDLE, UNSUPPORTED (budgets beyond the device),
 *  OUT_OF_..._MEMORY, DEVICE_LOST. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateLsystemRecorder(GpgpContext context, const GpgpLsystemRecorderCreateInfo* info,
                                                        GpgpRecorder* recorder);

/** A module of a string. 16 bytes (std430). Brackets are modules too. The string of each axiom lies in brackets, and
 *  begins with a module @axiom whose parameter is the axiom's number, as the bits of a uint32_t. */
typedef struct GpgpLsystemModule {
  uint32_t symbol;    /**< Index into gpgpGetLsystemSymbols. */
  uint32_t parameter; /**< Index of its first parameter. */
  uint32_t key[2];    /**< Path key: a hash of the way from the axiom to this module. Equal on all devices. */
} GpgpLsystemModule;

/** A corner of a polygon, or a section of a generalised cylinder. 16 bytes (std430). */
typedef struct GpgpLsystemCorner {
  float position[3]; /**< In world space. */
  float width;       /**< The turtle's width, in units of object space. */
} GpgpLsystemCorner;

#define GPGP_LSYSTEM_NO_ITERATIONS 0xffffffffu

typedef struct GpgpLsystemInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  GpgpAsset lsystem;
  /** GpgpAxiom[axiomCount]. STORAGE usage. transform, seed and id are read. The turtle begins at the origin of object
   *  space and looks along +Y. */
  GpgpBuffer axioms;
  /** GpgpAxiom[axiomCount] in host memory instead of axioms. They are copied while recording. At most
   *  GpgpLsystemRecorderCreateInfo::maxHostAxioms. @lifetime call */
  const GpgpAxiom* hostAxioms;
  uint32_t axiomCount;
  /** At most 1000. 0: as many as the L-system says. GPGP_LSYSTEM_NO_ITERATIONS: the axiom is drawn. */
  uint32_t iterations;
  /** Output, optional. GpgpInstance[]. Its size is the budget. STORAGE usage. Instances are sorted by terminal, and
   *  within a terminal by their order in the string.
   *
   *  The unit shape stands on the turtle's position; its +Y is the heading, its +Z the turtle's up. size holds width,
   *  length and width, attribute the turtle's colour, key the key of the module. rule is GPGP_NO_RULE.
   *
   *  A polygon has the shape GPGP_SHAPE_DYNAMIC_POLYGON and a generalised cylinder GPGP_SHAPE_DYNAMIC_RIGHT_PRISM.
   *  Their rule is the index of their first corner and size[0] the number of corners. */
  GpgpBuffer instances;
  /** Output, optional. VkDrawIndexedIndirectCommand[terminals]. STORAGE usage. instanceCount and firstInstance are
   *  written. Other fields keep the engine's values. */
  GpgpBuffer draws;
  GpgpBuffer corners;    /**< Output, optional. GpgpLsystemCorner[]. Its size is the budget. STORAGE usage. */
  GpgpBuffer modules;    /**< Output, optional. GpgpLsystemModule[], the last string. STORAGE usage. */
  GpgpBuffer parameters; /**< Output, optional. float[], its parameters. STORAGE usage. */
  GpgpBuffer count;      /**< Output, optional. A uint32_t, the instances that were written. STORAGE usage. */
} GpgpLsystemInfo;
#define GPGP_LSYSTEM_INFO_INIT GPGP_INIT(GpgpLsystemInfo, GPGP_STRUCTURE_LSYSTEM_INFO)

/** Records a derivation of the axioms and the turtle's drawing. Returns NOT_READY if the L-system is not resident or
 *  the recorder is not prewarmed.
 *  Errors: INVALID_HANDLE, INVALID_STRUCT, INVALID_ARGUMENT, TOO_MANY_RECORDINGS, UNSUPPORTED, DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareLsystem(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                       const GpgpFrame* frame, const GpgpLsystemInfo* info);

typedef struct GpgpLsystemReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t modules;    /**< Of the last string, with the brackets and the @axiom of each axiom. */
  uint32_t parameters; /**< Of the last string. */
  /** Steps that were taken. If there are fewer than asked for, the status is BUDGET_EXCEEDED: the string of the next
   *  step did not fit, and the last string that did was drawn. */
  uint32_t steps;
  /** The largest number of modules of any step, including the one that did not fit. With this maxModules it would have
   *  fitted; later steps may need more. */
  uint32_t modulesNeeded;
  uint32_t parametersNeeded; /**< Likewise for maxParameters. */
  uint32_t instances;        /**< Instances that the last string draws. */
  uint32_t instancesWritten; /**< At most instances. Less only with BUDGET_EXCEEDED. */
  uint32_t corners;          /**< Of all polygons and cylinders. */
  uint32_t cornersWritten;   /**< At most corners. Less only with BUDGET_EXCEEDED. */
  uint32_t depth;            /**< Brackets around the deepest module. Only depths up to 65535 are drawn correctly. */
  /** Branches that were not drawn to their end within maxRounds, with BUDGET_EXCEEDED. */
  uint32_t unfinishedBranches;
  uint32_t stringHash[2]; /**< Hash of the last string. Equal on all devices. */
} GpgpLsystemReport;
#define GPGP_LSYSTEM_REPORT_INIT GPGP_INIT(GpgpLsystemReport, GPGP_STRUCTURE_LSYSTEM_REPORT)

/** Takes the oldest report that is ready. Returns NOT_READY if there is none. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetLsystemReport(GpgpRecorder recorder, GpgpLsystemReport* report);

#ifdef __cplusplus
}
#endif
#endif
