/* gpgp spawn: grammars derived on the GPU, straight into the engine's buffers.
 *
 *   grammar (asset)   an operator graph with its parameter table; from a baked blob or compiled from text
 *   spawner (recorder)  derives axioms with any grammar; sized by budgets
 *
 *   gpgpCompileGrammar (libgpgp_compiler) -> blob -> gpgpCreateGrammar -> gpgpRecordUpload -> gpgpRecordPrepareSpawn
 */
#ifndef GPGP_SPAWN_H
#define GPGP_SPAWN_H
#include <gpgp/core.h>
#ifdef __cplusplus
extern "C" {
#endif

/** Where a derivation starts. 96 bytes, the same in C and in GPU buffers (std430). */
typedef struct GpgpAxiom {
  float transform[12];  /**< rows of a 3x4 matrix, object to world. The derivation itself runs in object space */
  float size[3];        /**< extents of the start shape, metres, its centre at the object's origin */
  uint32_t seed;        /**< of all random values below this axiom */
  uint32_t id;          /**< the engine's own number, found again in each instance */
  uint32_t start;       /**< its start, which says its shape, by its place in gpgpGetGrammarStarts;
                             GPGP_AXIOM_DEFAULT_START: the grammar's first axiom line */
  float attribute;      /**< custom attribute, inherited; NaN: taken from the seed as in [0, 1) */
  uint32_t reserved[5]; /**< 0 */
} GpgpAxiom;
#define GPGP_AXIOM_DEFAULT_START 0xffffffffu

/** What a terminal becomes. 96 bytes, std430. The mesh's unit shape spans [-0.5, 0.5] on each axis; the transform
 *  includes the shape's size. Polygons face +Z and have size[2] 0; their transform keeps 1 metre for that axis.
 *  An instance has no corners: what mesh stands for a dynamic shape follows from its terminal, or it is written as
 *  vertices (GpgpSpawnerCreateInfo::vertices), which have them; compiling tells of such terminals.
 *  What made it: bucket says the terminal line, terminal the name that a rule uses, rule the rule that uses it: whose
 *  body ends in that terminal. Rules that the derivation passed before leave no trace but in key. */
typedef struct GpgpInstance {
  float transform[12]; /**< rows of a 3x4 matrix, unit shape to world */
  uint32_t bucket;     /**< GpgpGrammarTerminal::bucket of its terminal: which draw */
  uint32_t shape;      /**< GpgpShape */
  uint32_t axiomId;    /**< GpgpAxiom::id */
  uint32_t terminal;   /**< index as in gpgpGetGrammarTerminals; several terminals may share a bucket */
  uint32_t seed;       /**< of the shape */
  float attribute;     /**< custom attribute of the shape */
  uint32_t key[2];     /**< path key: the same on every device and schedule */
  float size[3];       /**< of the shape, metres */
  uint32_t rule;       /**< in whose body the terminal stands, by its place in gpgpGetGrammarStarts, which has its name;
                            GPGP_NO_RULE: in none, as an axiom line names it */
} GpgpInstance;
#define GPGP_NO_RULE 0xffffffffu

typedef uint32_t GpgpShape;
enum {
  GPGP_SHAPE_TRIANGLE = 0,
  GPGP_SHAPE_QUAD = 1,
  GPGP_SHAPE_PENTAGON = 2,
  GPGP_SHAPE_HEXAGON = 3,
  GPGP_SHAPE_HEPTAGON = 4,
  GPGP_SHAPE_OCTAGON = 5,
  GPGP_SHAPE_PRISM3 = 6,
  GPGP_SHAPE_BOX = 7,
  GPGP_SHAPE_PRISM5 = 8,
  GPGP_SHAPE_PRISM6 = 9,
  GPGP_SHAPE_PRISM7 = 10,
  GPGP_SHAPE_PRISM8 = 11,
  GPGP_SHAPE_DYNAMIC_CONVEX_POLYGON = 12,
  GPGP_SHAPE_DYNAMIC_POLYGON = 13,
  GPGP_SHAPE_DYNAMIC_CONVEX_RIGHT_PRISM = 14,
  GPGP_SHAPE_DYNAMIC_RIGHT_PRISM = 15,
  GPGP_SHAPE_SPHERE = 16
};

/* ---------------------------------------------------------------- compiler (libgpgp_compiler) */

typedef struct GpgpCompileMessage {
  const char* file;
  uint32_t line, column; /**< from 1; 0 where text is not about a place in the source, and for a builder: its text
                            begins with the place, by name */
  GpgpSeverity severity;
  const char* text;
  uint32_t omitted; /**< 0; in a last message: how many more of this severity there were, as text says */
} GpgpCompileMessage;
typedef void(GPGP_CALL* GpgpCompileMessageFn)(void* userData, const GpgpCompileMessage* message);

/** Overrides one `var` of a grammar. */
typedef struct GpgpVariable {
  const char* name;
  float value;
} GpgpVariable;

typedef uint64_t GpgpCompileFlags;
/** Generate a kernel for the grammar, in the default schedule. It derives what the interpreter does, many times faster.
 */
#define GPGP_COMPILE_KERNEL ((GpgpCompileFlags)1)

typedef struct GpgpGrammarBuilder_T* GpgpGrammarBuilder; /**< a grammar made in code, see spawn_builder.h */

typedef struct GpgpGrammarSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name;  /**< file name for messages */
  const char* alias; /**< optional: what gpgpLinkGrammars calls it, instead of by its file; letters, digits and _ */
  const char* text;  /**< UTF-8, need not end in 0 */
  size_t size;       /**< bytes of text or baked */
  const GpgpVariable* variables;
  uint32_t variableCount;
  GpgpCompileMessageFn messageFn; /**< every error, warning and note of the file, in order of their places; of each at
                                       most 1000, and then how many were left out */
  void* messageUserData;
  GpgpCompileFlags flags;
  GpgpGrammarBuilder builder; /**< instead of text, which then is NULL; read during the call */
  const void* baked; /**< instead of text: a baked grammar, as it stands in a file; all of it is checked. It has no
                          variables any more, and kernels in it are left out. @lifetime call */
} GpgpGrammarSource;
#define GPGP_GRAMMAR_SOURCE_INIT GPGP_INIT(GpgpGrammarSource, GPGP_STRUCTURE_GRAMMAR_SOURCE)

/** Compiles text, what a builder holds, or a baked grammar, to a baked grammar. Text is PGA-shape (.pga), or an
 * operator graph as gpgp graph prints it, which has no variables any more. In libgpgp_compiler. A pure function of its
 * input. Errors: INVALID_DATA (messages say where), INVALID_ARGUMENT, OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileGrammar(const GpgpGrammarSource* source, GpgpBlob* blob);

/** Compiles several grammars to one, so that one record derives axioms of all of them. It has their rules, terminals,
 *  buckets and axiom lines in the order of the sources; the first axiom line of the first source is the default start.
 *  Each source is called by its alias, or else by its file: GpgpGrammarSource::name without folders and without what
 *  follows the first point, characters other than letters, digits and _ made _. Its rules and terminals have that name
 *  before theirs, as in house.Wall, and its first axiom line is the start house; see gpgpGetGrammarStarts. Tags of
 *  Collider and IfCollides are common. Each source has its own variables and gets its own messages; a kernel is
 *  generated where any asks for one. In libgpgp_compiler. A pure function of its input. Errors: INVALID_DATA (messages
 *  say where; also where two sources have the same name, or one has none), INVALID_ARGUMENT (no sources),
 *  INVALID_STRUCT, UNSUPPORTED, OUT_OF_HOST_MEMORY. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpLinkGrammars(const GpgpGrammarSource* sources, uint32_t sourceCount, GpgpBlob* blob);

/* ---------------------------------------------------------------- grammar */

typedef struct GpgpGrammarCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  const void* data; /**< a baked grammar; or NULL: read from filePath through the file callbacks */
  size_t size;
  const char* filePath;
} GpgpGrammarCreateInfo;
#define GPGP_GRAMMAR_CREATE_INFO_INIT GPGP_INIT(GpgpGrammarCreateInfo, GPGP_STRUCTURE_GRAMMAR_CREATE_INFO)

/** Checks a baked grammar (magic, version, checksums, every index, the kernels behind it, nothing else there) and
 * queues it for upload. Errors: INVALID_DATA, IO, OUT_OF_..._MEMORY. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGrammar(GpgpContext context, const GpgpGrammarCreateInfo* info,
                                                GpgpAsset* grammar);

typedef struct GpgpGrammarTerminal {
  const char* name; /**< @lifetime handle */
  uint32_t kind;    /**< 0: triangles are generated, 1: an instanced mesh of the engine's */
  uint32_t index;   /**< mesh or material, as the grammar says */
  uint32_t bucket;  /**< GpgpInstance::bucket of its instances: the number of its line among terminal lines */
} GpgpGrammarTerminal;

/** The grammar's terminals. count in: capacity, out: all. terminals NULL asks for the count. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetGrammarTerminals(GpgpAsset grammar, uint32_t* count,
                                                      GpgpGrammarTerminal* terminals);

/** Where a derivation can start: a rule or an axiom line. Its place in the list is what GpgpAxiom::start takes. */
typedef struct GpgpGrammarStart {
  const char* name;   /**< of the rule; of an axiom line, the name of what it starts, but of the first one of a linked
                           grammar that grammar's name alone. @lifetime handle */
  GpgpShape shape;    /**< of axioms that start here: an axiom line's; a rule's is that of the first axiom line of its
                           grammar that names it, else of the first one of all */
  uint32_t axiomLine; /**< 1: an axiom line, 0: a rule */
} GpgpGrammarStart;

/** The grammar's starts: its rules, in order, then its axiom lines. count in: capacity, out: all. starts NULL asks for
 *  the count. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetGrammarStarts(GpgpAsset grammar, uint32_t* count, GpgpGrammarStart* starts);

/** The place of the first start by that name, for GpgpAxiom::start: a rule, or a linked grammar as a whole.
 *  Errors: INVALID_ARGUMENT (there is none), INVALID_HANDLE. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpFindGrammarStart(GpgpAsset grammar, const char* name, uint32_t* start);

/* ---------------------------------------------------------------- spawner */

typedef uint32_t GpgpVertexSemantic;
enum {
  GPGP_VERTEX_POSITION = 0, /**< world space; w is 1 where the format has it */
  GPGP_VERTEX_NORMAL = 1,   /**< of the face, unit length, world space; UNORM holds n / 2 + 1 / 2 */
  GPGP_VERTEX_UV = 2,       /**< on the face, [0, 1] to the right and upwards */
  GPGP_VERTEX_BUCKET = 3,   /**< GpgpGrammarTerminal::bucket of the terminal */
  GPGP_VERTEX_AXIOM_ID = 4, /**< GpgpAxiom::id */
  GPGP_VERTEX_TERMINAL = 5, /**< index as in gpgpGetGrammarTerminals */
  GPGP_VERTEX_SEED = 6,     /**< of the shape */
  GPGP_VERTEX_RULE = 7      /**< GpgpInstance::rule */
};

typedef struct GpgpVertexAttribute {
  GpgpVertexSemantic semantic;
  VkFormat format; /**< R32G32B32_SFLOAT, R32G32_SFLOAT, R16G16B16A16_SFLOAT, R8G8B8A8_SNORM or R8G8B8A8_UNORM for
                        positions, normals and uvs; R32_UINT for the others */
  uint32_t offset; /**< bytes in the vertex, a multiple of 4 */
} GpgpVertexAttribute;

#define GPGP_MAX_VERTEX_ATTRIBUTES 8

/** How terminals look as triangles. Every one becomes quads of four vertices and the six indices v + {0, 1, 2, 0, 2,
 *  3}, flat-shaded, counter-clockwise from outside also where an axiom mirrors: a box is six quads, a convex polygon of
 *  n corners (n - 1) / 2, a concave one at most n - 2, a prism two polygons and n quads, a sphere 96. */
typedef struct GpgpVertexLayout {
  uint32_t stride;         /**< bytes of a vertex, a multiple of 4, at most 64; multiples of 16 are written fastest */
  uint32_t attributeCount; /**< bytes that no attribute covers become 0 */
  GpgpVertexAttribute attributes[GPGP_MAX_VERTEX_ATTRIBUTES];
} GpgpVertexLayout;

typedef uint64_t GpgpSpawnerFlags;
/** Instances, or terminals as vertices and indices, lie in order of their bucket, then of their path key, and those
 * that do not fit a buffer or region are its last ones, from the first on that has no room: which survive, and where
 * each lies, does not depend on execution, as long as maxTerminals holds all and no shape is dropped. Axioms should
 * differ in seed or id: equal keys come in the order of the axioms, thousands of them in no stated order. */
#define GPGP_SPAWNER_ORDERED ((GpgpSpawnerFlags)1)

typedef struct GpgpSpawnerCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  GpgpSpawnerFlags flags;
  const GpgpVertexLayout* vertices; /**< optional: terminals become vertices and indices, not instances; records give
                                         GpgpSpawnInfo::vertices. @lifetime call */
  uint32_t maxShapes;     /**< shapes that wait for a round of derivation; 0: 131072. What does not fit is counted */
  uint32_t maxTerminals;  /**< terminal shapes of one record, where they become vertices, or instances that are sorted
                               or ordered; 96 bytes each; 0: 524288. What does not fit is counted */
  uint32_t maxDepth;      /**< how deep rules may nest in themselves; 0: 64. Deeper shapes are counted, not derived */
  uint32_t maxRounds;     /**< rounds of derivation that are recorded, a pass each. Few are needed: workgroups derive by
                             themselves, and rounds only share work out again. 0: at most 4, or 32 on software devices,
                             and fewer where the number of axioms, or a tuned kernel, says that fewer are enough. What
                             is left is counted */
  uint32_t maxColliders;  /**< shapes that Collider registers in one record; what does not fit is counted. 0: none, and
                               grammars with Collider or IfCollides are refused. At most 2^24, 8192 on software
                               devices */
  uint32_t maxHostAxioms; /**< axioms of one record that GpgpSpawnInfo::hostAxioms gives; 0: none. 96 bytes each, for
                               every record that can be in flight, of memory that the host writes; at most 2^24 */
} GpgpSpawnerCreateInfo;
#define GPGP_SPAWNER_CREATE_INFO_INIT GPGP_INIT(GpgpSpawnerCreateInfo, GPGP_STRUCTURE_SPAWNER_CREATE_INFO)

/** Makes a recorder that derives any grammar, with scratch for the budgets. Prewarm it before the first record.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets beyond the device), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateSpawner(GpgpContext context, const GpgpSpawnerCreateInfo* info,
                                                GpgpRecorder* spawner);

/** Compiles the kernels that a grammar was baked with and that are for this device, on the calling thread. Until it has
 *  returned, and for grammars without such kernels, records run the interpreter, which derives the same. The pipelines
 *  belong to the grammar and serve all spawners of the context. May run beside records and gpgpAdvance, so that
 *  frames go on; only the two handles must live until it returns.
 *  Errors: INVALID_HANDLE, UNSUPPORTED, OUT_OF_..._MEMORY. @threads handle: one call for a grammar at a time */
GPGP_API GpgpResult GPGP_CALL gpgpPrewarmGrammar(GpgpRecorder spawner, GpgpAsset grammar);

/** Where terminals go as triangles. A terminal that fits only in part is left out whole. */
typedef struct GpgpVertexOutput {
  GpgpBuffer vertices;   /**< out; its size is the budget; STORAGE usage. NULL: the record only counts, see
                              GpgpSpawnInfo::draws */
  GpgpBuffer indices;    /**< out; its size is the budget; STORAGE usage. NULL: none are written; they are the same
                              pattern in every record */
  VkIndexType indexType; /**< UINT16 or UINT32. 16 bits reach 65532 vertices of a draw */
} GpgpVertexOutput;

/** A box in the world. 24 bytes. */
typedef struct GpgpSpawnBounds {
  float min[3], max[3]; /**< metres; infinite and turned over, min > max, where there is nothing */
} GpgpSpawnBounds;

typedef uint64_t GpgpSpawnFlags;
/** Buckets have regions of the engine's: draws say where each begins, and it reaches to where the next one begins, or
 *  to the buffer's end. Regions lie in the order of the buckets. */
#define GPGP_SPAWN_REGIONS ((GpgpSpawnFlags)1)

typedef struct GpgpSpawnInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  GpgpAsset grammar;
  GpgpBuffer axioms; /**< GpgpAxiom[axiomCount]; STORAGE usage. Part of a longer list is its offset and count */
  const GpgpAxiom* hostAxioms; /**< instead of axioms: GpgpAxiom[axiomCount] of the CPU, copied while recording; at most
                                    GpgpSpawnerCreateInfo::maxHostAxioms. @lifetime call */
  GpgpBuffer axiomCounter;     /**< optional: uint32_t, how many axioms there are, for those that the GPU has written (4
                                  bytes); STORAGE usage. axiomCount is the most that are derived then */
  uint32_t axiomCount;
  GpgpSpawnFlags flags;
  GpgpBuffer instances; /**< out: GpgpInstance[]; its size is the budget; STORAGE usage. NULL with draws: the record
                           only counts */
  const GpgpVertexOutput* vertices; /**< for spawners made for vertices, instead of instances */
  /** Out, optional: VkDrawIndexedIndirectCommand[buckets], one per bucket; STORAGE usage. Fields that are not named
   * here are left as the engine set them. Instances: they are sorted by bucket; instanceCount and firstInstance are
   * written. Without draws they lie in no stated order, unless by GPGP_SPAWNER_ORDERED. Vertices: they lie in no stated
   * order, unless by GPGP_SPAWNER_ORDERED; indexCount of the first command is written, which draws all buckets.
   * GPGP_SPAWN_REGIONS: firstInstance is read and instanceCount written; or firstIndex is read, a multiple of 6, and
   * indexCount and vertexOffset (firstIndex / 6 * 4) are written. Only counting: instanceCount and firstInstance, or
   * indexCount, firstIndex and vertexOffset are written, regions that fit exactly for a later record with
   * GPGP_SPAWN_REGIONS. */
  GpgpBuffer draws;
  GpgpBuffer needed; /**< out, optional: uint32_t[buckets], instances or indices that each bucket needs; only with
                          GPGP_SPAWN_REGIONS or where the record only counts; STORAGE usage */
  GpgpBuffer count;  /**< out, optional: uint32_t, instances or indices written (4 bytes); STORAGE usage */
  GpgpBuffer bounds; /**< out, optional: GpgpSpawnBounds[buckets], around the terminals of each bucket that were
                        written, with BUDGET_EXCEEDED maybe around others, too; not where the record only counts;
                        STORAGE usage */
} GpgpSpawnInfo;
#define GPGP_SPAWN_INFO_INIT GPGP_INIT(GpgpSpawnInfo, GPGP_STRUCTURE_SPAWN_INFO)

/** Derives the axioms and writes one instance for each terminal shape, or its vertices and indices, or counts.
 *  NOT_READY: grammar not resident or spawner not prewarmed.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareSpawn(GpgpRecorder spawner, VkCommandBuffer commandBuffer,
                                                     const GpgpFrame* frame, const GpgpSpawnInfo* info);

typedef struct GpgpSpawnReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t terminals;        /**< terminal shapes derived */
  uint32_t instancesWritten; /**< <= terminals; less only with BUDGET_EXCEEDED, and where others are asked for */
  uint32_t peakShapes;       /**< the most shapes that waited for a round, those that did not fit included: a
                                  maxShapes that would have been enough for them */
  uint32_t droppedShapes;    /**< shapes that did not fit maxShapes or were left after maxRounds, and axioms whose
                                  rule does not exist or that axiomCounter counts beyond axiomCount, shapes of which
                                  a Repeat would make more than 2^20, and polygons that a SubDiv cannot cut; what lay
                                  below them is not known */
  uint32_t unfinishedShapes; /**< shapes deeper than maxDepth */
  uint32_t rounds;           /**< rounds that had work */
  uint32_t keyHash[2];       /**< order-free hash of (path key, terminal, rule, shape) over all terminals */
  uint32_t depth;            /**< how deep rules nested in themselves */
  uint32_t vertices;         /**< that the terminals have; 6 indices for each 4 of them */
  uint32_t verticesWritten;  /**< <= vertices; less only with BUDGET_EXCEEDED, and where the record only counts */
  uint32_t colliders;        /**< shapes that Collider had to register: a maxColliders that would have been enough */
  uint32_t collidersKept;    /**< <= colliders; less only with BUDGET_EXCEEDED: IfCollides did not see the others */
} GpgpSpawnReport;
#define GPGP_SPAWN_REPORT_INIT GPGP_INIT(GpgpSpawnReport, GPGP_STRUCTURE_SPAWN_REPORT)

/** The oldest report not yet taken. NOT_READY: none. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetSpawnReport(GpgpRecorder spawner, GpgpSpawnReport* report);

#ifdef __cplusplus
}
#endif
#endif
