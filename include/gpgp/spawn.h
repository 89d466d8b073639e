/* gpgp spawn: derives grammars on the GPU and writes the results into the engine's buffers.
 *
 *   grammar (asset)      an operator graph with its parameters, made from a baked grammar
 *   spawner (recorder)   derives axioms by any grammar; its budgets are fixed when it is created
 *
 * Steps:
 *   gpgpCompileGrammar (libgpgp_compiler)   grammar text to a baked grammar, at build time or at run time
 *   gpgpCreateGrammar, gpgpRecordUpload     the baked grammar to an asset on the device
 *   gpgpCreateSpawner, gpgpPrewarm          the recorder
 *   gpgpRecordPrepareSpawn                  derives and writes, as often as wanted
 *
 * Words: an axiom is a start shape in the world. A derivation applies the rules of the grammar to it until only
 * terminal shapes are left. Each terminal line of a grammar is a bucket, which the engine draws with one indirect
 * command.
 */
#ifndef GPGP_SPAWN_H
#define GPGP_SPAWN_H
#include <gpgp/core.h>
#ifdef __cplusplus
extern "C" {
#endif

/** A start shape in the world. 96 bytes, with the same layout in C and in GPU buffers (std430). */
typedef struct GpgpAxiom {
  float transform[12]; /**< Rows of a 3x4 matrix from object to world space. Derivation itself runs in object space. */
  float size[3];       /**< Extents of the start shape in metres. Its centre is the origin of object space. */
  uint32_t seed;       /**< Seeds all random values of this axiom's derivation. */
  uint32_t id;         /**< The engine's own number. Every instance of the axiom returns it. */
  /** The rule or axiom line to start at, as an index into gpgpGetGrammarStarts. It decides the type of the start shape.
   *  GPGP_AXIOM_DEFAULT_START: the first axiom line of the grammar. */
  uint32_t start;
  float attribute; /**< Custom attribute, which shapes inherit. NaN: a value in [0, 1) that the seed determines. */
  /** Not 0: OutOfView() of its shapes is 2^100, also without a camera. An engine sets it where the visibility service
   *  saw nothing of the axiom, so that rules leave out what is there but hidden. */
  uint32_t hidden;
  uint32_t reserved[4]; /**< 0. */
} GpgpAxiom;
#define GPGP_AXIOM_DEFAULT_START 0xffffffffu

/** A terminal shape. 96 bytes (std430). The transform maps the unit shape, which spans [-0.5, 0.5] on each axis, to the
 *  world, and includes the size of the shape. Polygons face +Z and have size[2] 0. Their transform scales Z by 1, not
 *  by size[2], so that it stays invertible.
 *
 *  An instance does not hold corners. For shapes of the GPGP_SHAPE_DYNAMIC_... types, the engine chooses the mesh by
 *  terminal, or uses a spawner that writes vertices (GpgpSpawnerCreateInfo::vertices). The compiler sends a note for
 *  every terminal of kind 1 (GpgpGrammarTerminal) that such shapes can reach.
 *
 *  bucket is the terminal line, terminal the name that a rule uses, and rule the rule whose body contains the terminal.
 *  Ancestor rules are recorded only in key. */
typedef struct GpgpInstance {
  float transform[12]; /**< Rows of a 3x4 matrix from the unit shape to world space. */
  uint32_t bucket;     /**< GpgpGrammarTerminal::bucket of the terminal. It selects the draw. */
  uint32_t shape;      /**< A GpgpShape; for GPGP_SHAPE_ROOF and GPGP_SHAPE_TRAPEZOID also its form, in bits 8 to 30. */
  uint32_t axiomId;    /**< GpgpAxiom::id. */
  uint32_t terminal;   /**< Index into gpgpGetGrammarTerminals. Several terminals may share a bucket. */
  uint32_t seed;       /**< Seed of the shape. */
  float attribute;     /**< Custom attribute of the shape. */
  uint32_t key[2];     /**< Path key: a hash of the way from the axiom to this shape. Equal on all devices. */
  float size[3];       /**< Extents of the shape in metres. */
  /** The rule whose body contains the terminal, as an index into gpgpGetGrammarStarts. GPGP_NO_RULE: an axiom line
   *  names the terminal directly. */
  uint32_t rule;
} GpgpInstance;
#define GPGP_NO_RULE 0xffffffffu

/** A terminal shape in 32 bytes, which spawners with GPGP_SPAWNER_COMPACT write. gpgp/shaders/compact_instance.h reads
 *  it in GLSL and HLSL. The point p of the unit shape lies at position + rotate(rotation, scale * p).
 *
 *  The error, compared with GpgpInstance::transform, is at most 6e-4 times the largest of the three extents in the
 *  world, plus the rounding of position. Extents are 6.2e-5 to 65504 metres; smaller ones become 0, larger ones 65504.
 *  Shear cannot be represented: the axiom's transform may only rotate, mirror, translate and scale uniformly. */
typedef struct GpgpCompactInstance {
  float position[3]; /**< World space. */
  uint32_t seed;     /**< GpgpInstance::seed. */
  /** Extents in the world as half floats. For polygons the third is the axiom's scale, as in GpgpInstance::transform.
   *  If the axiom's transform mirrors, the first is negative. */
  uint16_t scale[3];
  uint16_t terminal; /**< GpgpInstance::terminal, from which the mesh and the material follow. */
  /** A unit quaternion (x, y, z, w) whose largest component is positive and left out. The other three follow in order,
   *  15 bits each: 0 to 32767 stand for -sqrt(1/2) to sqrt(1/2). The highest bits of the first two numbers are the
   *  index of the missing component: bit 0 in the first, bit 1 in the second. */
  uint16_t rotation[3];
  uint16_t shape; /**< A GpgpShape, without the form of roofs and trapezoids. */
} GpgpCompactInstance;

/** Types of shapes. PRISM3 to PRISM8 and BOX are right prisms on regular polygons and on a square.
 *
 *  A ROOF stands on the whole lower face of its unit box and ends in a ridge at y = 0.5. A TRAPEZOID lies in z = 0 on
 *  the whole lower edge of its unit square and ends in a part of the upper one. GpgpInstance::shape holds their form as
 *  well. Bits 0 to 7 are the GpgpShape. Bits 8 to 27 are half the length of the ridge or upper edge, in units of 2^-20
 *  of the extent along it. Bits 28 and 29 are its position: 0 in the middle, 1 at -0.5, 2 at 0.5. A ridge is moved at
 *  right angles to itself, an edge along itself. Bit 30 is set if the ridge is parallel to z, and not set if it is
 *  parallel to x. */
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
  GPGP_SHAPE_SPHERE = 16,
  GPGP_SHAPE_ROOF = 17,
  GPGP_SHAPE_TRAPEZOID = 18
};

/* ---------------------------------------------------------------- compiler (libgpgp_compiler) */

/** A message of the compiler. */
typedef struct GpgpCompileMessage {
  const char* file; /**< GpgpGrammarSource::name. */
  /** Line and column, counted from 1. Both are 0 if the message concerns no place in a text. A message about a builder
   *  begins with the name of the place instead. */
  uint32_t line, column;
  GpgpSeverity severity;
  const char* text;
  uint32_t omitted; /**< 0, except in the last message of a severity: how many more there were. text says so too. */
} GpgpCompileMessage;

/** Receives the messages of a compilation. @lifetime call */
typedef void(GPGP_CALL* GpgpCompileMessageFn)(void* userData, const GpgpCompileMessage* message);

/** A new value for a `var` of a grammar. */
typedef struct GpgpVariable {
  const char* name;
  float value;
} GpgpVariable;

typedef uint64_t GpgpCompileFlags;
/** Generates a kernel for the grammar, in the default schedule. The kernel gives the same result as the interpreter in
 *  less time. gpgpPrewarmGrammar compiles it for the device. */
#define GPGP_COMPILE_KERNEL ((GpgpCompileFlags)1)
/** GpgpGrammarSource::text is a program in the stack language (.gml) instead of PGA-shape. */
#define GPGP_COMPILE_STACK_LANGUAGE ((GpgpCompileFlags)2)

typedef struct GpgpGrammarBuilder_T* GpgpGrammarBuilder; /**< A grammar made in code, see spawn_builder.h. */

/** The source of a grammar: exactly one of text, builder and baked. */
typedef struct GpgpGrammarSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name;  /**< File name for messages. gpgpLinkGrammars derives the name of the grammar from it. */
  const char* alias; /**< Optional. The name of the grammar for gpgpLinkGrammars: letters, digits and _. */
  const char* text;  /**< UTF-8, at most 256 MiB. It need not end in 0. */
  size_t size;       /**< Bytes of text or of baked. 0 with builder. */
  const GpgpVariable* variables; /**< New values for variables of text or builder. Unknown names are errors. */
  uint32_t variableCount;
  /** Receives all errors, warnings and notes, sorted by place: at most 1000 of each, and then how many were omitted. */
  GpgpCompileMessageFn messageFn;
  void* messageUserData;
  GpgpCompileFlags flags;
  GpgpGrammarBuilder builder; /**< Read during the call. */
  /** A baked grammar, as in a file. All of it is checked. Its variables are fixed, and kernels in it are dropped.
   *  @lifetime call */
  const void* baked;
} GpgpGrammarSource;
#define GPGP_GRAMMAR_SOURCE_INIT GPGP_INIT(GpgpGrammarSource, GPGP_STRUCTURE_GRAMMAR_SOURCE)

/** Compiles a text, a builder or a baked grammar to a baked grammar. The text is PGA-shape (.pga), or an operator graph
 *  as `gpgp graph` prints it, which has no variables, or with GPGP_COMPILE_STACK_LANGUAGE a stack program (.gml). The
 *  result depends on the input only. In libgpgp_compiler. Errors: INVALID_DATA (messages say where), INVALID_ARGUMENT,
 *  INVALID_STRUCT, UNSUPPORTED (a limit of graphs is exceeded), OUT_OF_HOST_MEMORY. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileGrammar(const GpgpGrammarSource* source, GpgpBlob* blob);

/** Compiles several grammars to one, so that one recording derives axioms of all of them. The rules, terminals, buckets
 *  and axiom lines follow in the order of the sources. The first axiom line of the first source is the default start.
 *
 *  Each source has a name: its alias, or else GpgpGrammarSource::name without folders and without everything from the
 *  first dot on. Characters other than letters, digits and _ become _. A name that consists of digits only is prefixed
 *  with _. The names of rules and terminals are prefixed with the name of their source, as in house.Wall. The first
 *  axiom line of the source becomes the start named house (gpgpGetGrammarStarts). Sources share nothing but the tags of
 *  Collider and IfCollides.
 *
 *  Each source has variables and messages of its own. A kernel is generated if any source asks for one. The result
 *  depends on the input only. In libgpgp_compiler.
 *  Errors: INVALID_DATA (messages say where; also if two sources have the same name, or one has none), INVALID_ARGUMENT
 *  (also if there are no sources), INVALID_STRUCT, UNSUPPORTED, OUT_OF_HOST_MEMORY. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpLinkGrammars(const GpgpGrammarSource* sources, uint32_t sourceCount, GpgpBlob* blob);

/* ---------------------------------------------------------------- grammar */

/** Exactly one of data and filePath is set. */
typedef struct GpgpGrammarCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;    /**< For messages and debug names. The string is copied. */
  const void* data;     /**< A baked grammar. It is copied. */
  size_t size;          /**< Bytes of data. */
  const char* filePath; /**< A file with a baked grammar, read through GpgpFileSystem or the C library. */
} GpgpGrammarCreateInfo;
#define GPGP_GRAMMAR_CREATE_INFO_INIT GPGP_INIT(GpgpGrammarCreateInfo, GPGP_STRUCTURE_GRAMMAR_CREATE_INFO)

/** Checks a baked grammar and queues it for upload. It checks the magic number, the version, the checksums, every index
 *  and the kernels, and that no data follows.
 *  Errors: INVALID_DATA, INVALID_ARGUMENT, INVALID_STRUCT, INVALID_HANDLE, IO, OUT_OF_..._MEMORY, DEVICE_LOST.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGrammar(GpgpContext context, const GpgpGrammarCreateInfo* info,
                                                GpgpAsset* grammar);

typedef struct GpgpGrammarTerminal {
  const char* name; /**< @lifetime handle */
  uint32_t kind;    /**< 0: generated triangles. 1: an instanced mesh of the engine. */
  uint32_t index;   /**< Number of the mesh or material, as the grammar says. */
  uint32_t bucket;  /**< The number of its terminal line in the grammar: GpgpInstance::bucket of its instances. */
} GpgpGrammarTerminal;

/** Lists the terminals of a grammar. count is the capacity of terminals on input and the number of all terminals on
 *  output. If terminals is NULL, only the count is returned. If it is too small, the function fills it and returns
 *  GPGP_INCOMPLETE. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetGrammarTerminals(GpgpAsset grammar, uint32_t* count,
                                                      GpgpGrammarTerminal* terminals);

/** A rule or an axiom line, at which a derivation can start. GpgpAxiom::start is an index into the list of these. */
typedef struct GpgpGrammarStart {
  /** The name of the rule. An axiom line has the name of the rule or terminal that it starts. The first axiom line of a
   *  linked grammar has the name of that grammar instead. @lifetime handle */
  const char* name;
  /** The type of shapes that start here. A rule has the shape of the first axiom line of its grammar that names it. If
   *  none does, it has the shape of the first axiom line of its grammar. */
  GpgpShape shape;
  uint32_t axiomLine; /**< 1: an axiom line, 0: a rule. */
} GpgpGrammarStart;

/** Lists the names of the fields that a grammar reads, at most GPGP_MAX_FIELDS: see GpgpSpawnField. count is the
 *  capacity of names on input and the number of all fields on output. If names is NULL, only the count is returned. If
 *  it is too small, the function fills it and returns GPGP_INCOMPLETE. @threads any @lifetime handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetGrammarFields(GpgpAsset grammar, uint32_t* count, const char** names);
#define GPGP_MAX_FIELDS 8

/** Lists the starts of a grammar: its rules in order, then its axiom lines in order. count is the capacity of starts on
 *  input and the number of all starts on output. If starts is NULL, only the count is returned. If it is too small, the
 *  function fills it and returns GPGP_INCOMPLETE. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetGrammarStarts(GpgpAsset grammar, uint32_t* count, GpgpGrammarStart* starts);

/** Returns the index of the first start with a name, for GpgpAxiom::start. The name is that of a rule or of a linked
 *  grammar. Errors: INVALID_ARGUMENT (there is none), INVALID_HANDLE. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpFindGrammarStart(GpgpAsset grammar, const char* name, uint32_t* start);

/* ---------------------------------------------------------------- spawner */

/** What a vertex attribute holds. */
typedef uint32_t GpgpVertexSemantic;
enum {
  GPGP_VERTEX_POSITION = 0, /**< World space. A fourth component is 1. */
  GPGP_VERTEX_NORMAL = 1,   /**< Normal of the face, unit length, in world space. UNORM formats hold n / 2 + 1 / 2. */
  GPGP_VERTEX_UV = 2,       /**< Position on the face, 0 to 1 from left to right and from bottom to top. */
  GPGP_VERTEX_BUCKET = 3,   /**< GpgpGrammarTerminal::bucket. */
  GPGP_VERTEX_AXIOM_ID = 4, /**< GpgpAxiom::id. */
  GPGP_VERTEX_TERMINAL = 5, /**< Index into gpgpGetGrammarTerminals. */
  GPGP_VERTEX_SEED = 6,     /**< Seed of the shape. */
  GPGP_VERTEX_RULE = 7      /**< GpgpInstance::rule. */
};

typedef struct GpgpVertexAttribute {
  GpgpVertexSemantic semantic;
  /** POSITION, NORMAL and UV: R32G32B32_SFLOAT, R32G32_SFLOAT, R16G16B16A16_SFLOAT, R8G8B8A8_SNORM or R8G8B8A8_UNORM.
   *  All others: R32_UINT. */
  VkFormat format;
  uint32_t offset; /**< Bytes from the start of the vertex, a multiple of 4. */
} GpgpVertexAttribute;

#define GPGP_MAX_VERTEX_ATTRIBUTES 8

/** The layout of vertices. Every terminal becomes a number of quads, each with four vertices of its own and the indices
 *  v + {0, 1, 2, 0, 2, 3}. Faces are flat-shaded, and counter-clockwise seen from outside even if the axiom's transform
 *  mirrors. A box has 6 quads. A convex polygon with n corners has (n - 1) / 2, rounded down. A concave one has n - 2
 *  at most. A prism has those of two polygons and n more. A sphere has 96. */
typedef struct GpgpVertexLayout {
  uint32_t stride;         /**< Bytes of a vertex: a multiple of 4, at most 64. Multiples of 16 are written fastest. */
  uint32_t attributeCount; /**< 1 to GPGP_MAX_VERTEX_ATTRIBUTES. Bytes without an attribute become 0. */
  GpgpVertexAttribute attributes[GPGP_MAX_VERTEX_ATTRIBUTES];
} GpgpVertexLayout;

typedef uint64_t GpgpSpawnerFlags;
/** Orders the output by bucket, then by path key. If a buffer or region is too small, its output is cut off at the
 *  first terminal that does not fit. Place and survival of a terminal then do not depend on the order of execution, as
 *  long as maxTerminals holds all terminals and no shape is dropped. Axioms should differ in seed or id. Terminals with
 *  equal keys follow in the order of their axioms, but the order of thousands of equal keys is unspecified. */
#define GPGP_SPAWNER_ORDERED ((GpgpSpawnerFlags)1)
/** The spawner writes GpgpCompactInstance instead of GpgpInstance. Its output is always sorted by bucket, so
 *  maxTerminals limits it. GPGP_SPAWN_REGIONS also needs GPGP_SPAWNER_ORDERED then. Not allowed with vertices. */
#define GPGP_SPAWNER_COMPACT ((GpgpSpawnerFlags)2)
/** The spawner has no interpreter, which most of the time of gpgpPrewarm goes into. It derives grammars by the kernels
 *  that they were baked with: until gpgpPrewarmGrammar has returned, recording returns NOT_READY. A grammar without a
 *  kernel that fits the device and the spawner is refused (UNSUPPORTED), by gpgpPrewarmGrammar and by recordings. */
#define GPGP_SPAWNER_KERNELS_ONLY ((GpgpSpawnerFlags)4)

/** Budgets of a spawner. What does not fit a budget is counted in the report. */
typedef struct GpgpSpawnerCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  GpgpSpawnerFlags flags;
  /** Optional. The spawner writes vertices and indices in this layout instead of instances, and its recordings give
   *  GpgpSpawnInfo::vertices. @lifetime call */
  const GpgpVertexLayout* vertices;
  uint32_t maxShapes; /**< Shapes that wait for a round of derivation. At most 2^24. 0: 131072. 576 bytes each. */
  /** Terminal shapes of one recording that are written as vertices, sorted by bucket or ordered. A spawner whose
   *  recordings only count, or write unsorted instances, needs 1. At most 2^24. 0: 524288. 96 bytes each, ordered 112.
   */
  uint32_t maxTerminals;
  /** Maximum recursion depth of rules. Deeper shapes are counted and not derived. At most 65535. 0: 64. */
  uint32_t maxDepth;
  /** Rounds of derivation that are recorded, one pass each. Within a round each workgroup derives on its own; a new
   *  round only redistributes the work, so few are needed. Shapes that remain after the last round are counted as
   *  dropped. At most 256. 0: at most 4, or 32 on software devices, and fewer if the number of axioms or a tuned kernel
   *  shows that fewer suffice. */
  uint32_t maxRounds;
  /** Shapes that Collider registers in one recording. 0: none, and grammars with Collider or IfCollides are refused. At
   *  most 2^24, on software devices 8192. 76 to 84 bytes each. If not 0, each of maxShapes takes 96 bytes more. */
  uint32_t maxColliders;
  /** Axioms of one recording that come from GpgpSpawnInfo::hostAxioms. 0: none. At most 2^24. 96 bytes of host-visible
   *  memory each, for every recording that can be in flight. */
  uint32_t maxHostAxioms;
  /** Axioms of one recording that GpgpSpawnInfo::measures is asked of. 0: none. At most 2^20. 72 bytes of host memory
   *  each, and as much of host-visible memory, for every recording that can be in flight. */
  uint32_t maxMeasuredAxioms;
  /** Words of 32 cells of GpgpOccupancy that each of these axioms has. At most 1024. 4 bytes each, for every axiom. */
  uint32_t maxOccupancyWords;
} GpgpSpawnerCreateInfo;
#define GPGP_SPAWNER_CREATE_INFO_INIT GPGP_INIT(GpgpSpawnerCreateInfo, GPGP_STRUCTURE_SPAWNER_CREATE_INFO)

/** Creates a spawner, with scratch memory for its budgets. It derives any grammar. Prewarm it before the first
 *  recording.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, INVALID_HANDLE, UNSUPPORTED (budgets beyond the device),
 *  OUT_OF_..._MEMORY, DEVICE_LOST. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateSpawner(GpgpContext context, const GpgpSpawnerCreateInfo* info,
                                                GpgpRecorder* spawner);

/** Compiles those kernels of a baked grammar that are for this device, on the calling thread. The pipelines belong to
 *  the grammar and serve all spawners of the context. Until the function has returned, recordings run the interpreter,
 *  which derives the same. Grammars without such kernels always run it, or are refused (UNSUPPORTED) by spawners with
 *  GPGP_SPAWNER_KERNELS_ONLY. Recordings and gpgpAdvance may run at the same
 *  time. Both handles must live until the function returns.
 *  Errors: INVALID_HANDLE, UNSUPPORTED, OUT_OF_..._MEMORY, DEVICE_LOST. @threads handle, and one call at a time for a
 *  grammar */
GPGP_API GpgpResult GPGP_CALL gpgpPrewarmGrammar(GpgpRecorder spawner, GpgpAsset grammar);

/** Where a spawner writes vertices. Output (of a region) stops at the first terminal that does not fit whole. */
typedef struct GpgpVertexOutput {
  /** Output. Its size is the budget. STORAGE usage. NULL: the recording only counts (GpgpSpawnInfo::draws), and indices
   *  must be NULL too. */
  GpgpBuffer vertices;
  /** Output. Its size is the budget. STORAGE usage. NULL: no indices are written. They are the same pattern in every
   *  recording. */
  GpgpBuffer indices;
  VkIndexType indexType; /**< UINT16 or UINT32. UINT16 allows up to 65532 vertices in a draw. */
} GpgpVertexOutput;

/** An axis-aligned box in world space. 24 bytes. */
typedef struct GpgpSpawnBounds {
  float min[3], max[3]; /**< In metres. An empty box has min +infinity and max -infinity. */
} GpgpSpawnBounds;

/** A camera, for grammars that derive distant or hidden parts in less detail: the values CameraDistance(), ScreenSize()
 *  and OutOfView() refer to it. Other grammars ignore it. Without a camera everything counts as near and in view, so
 *  all levels of detail are the finest ones.
 *
 *  A shape's sphere is centred on the shape. Its diameter is the diagonal of the shape's extents, times the largest
 *  scale of its axiom's transform. The same camera gives the same terminals on every device and on the CPU. */
typedef struct GpgpSpawnCamera {
  /** World space to Vulkan's clip space, column-major; perspective or parallel. Its six planes are the frustum of
   *  OutOfView(); a far plane at infinity is ignored. Reversed depth does not matter. */
  float viewProjection[16];
  float position[3]; /**< World space, metres. Distances are measured from here, with parallel projections too. */
  uint32_t height;   /**< Height of the picture in pixels, for ScreenSize(). Not 0. */
  /** Times ScreenSize(): less than 1 is coarser, more is finer. 0: 1. gpgpAdaptDetail chooses it by a budget. Distances
   *  are not changed by it. */
  float detail;
} GpgpSpawnCamera;

/** Numbers on a grid over the ground plane, bilinear in between, constant beyond. */
typedef struct GpgpGroundField {
  const float* values;    /**< [height][width], rows along x, first row at the least z. @lifetime call */
  uint32_t width, height; /**< At least 1, at most 16384. */
  float min[2], max[2];   /**< x and z of the first and of the last value, metres. min is less than max, but for a
                           *   width or height of 1. */
} GpgpGroundField;

/** A field of the world, such as the heights of a terrain or a mask, which the rules of a grammar read: Field(name) is
 *  its value at a shape's centre, Field(name, x, z) x and z metres from there along the shape's axes, both seen from
 *  above. In units of the field; positions are those of the world. Values that are NaN count as 0.
 *
 *  Fields lie in a buffer of floats. The same values give the same terminals on every device and on the CPU, which
 *  images with a sampler do not. An engine with an image copies it once (vkCmdCopyImageToBuffer), or writes the buffer
 *  in a shader. */
typedef struct GpgpSpawnField {
  const char* name; /**< As the grammar writes it. @lifetime call */
  /** Its grid. gpgpEvaluate reads grid.values. Recordings ignore them, and read GpgpSpawnInfo::fieldValues. */
  GpgpGroundField grid;
  /** Recordings: bytes from the beginning of fieldValues to float[height][width]. A multiple of 4. */
  VkDeviceSize offset;
} GpgpSpawnField;

/** The range of an axiom in GpgpSpawnInfo::instances. 16 bytes (std430). */
typedef struct GpgpAxiomRange {
  uint32_t first;    /**< Instance, from the beginning of the buffer's range. */
  uint32_t capacity; /**< Instances. 0: the axiom's terminals are only counted. */
  /** 0 before the recording; afterwards the axiom's terminals, those that did not fit included. The first min(count,
   *  capacity) instances of the range are written, in no particular order. The others keep their contents. */
  uint32_t count;
  uint32_t reserved; /**< 0. */
} GpgpAxiomRange;

/** What a measure multiplies for each terminal: bits. 0: the number 1, so that terminals are counted. */
typedef uint32_t GpgpMeasureFactors;
enum {
  GPGP_MEASURE_X = 1, /**< GpgpInstance::size[0], in metres. X and Y: the area of a facade. X, Y and Z: a volume. */
  GPGP_MEASURE_Y = 2,
  GPGP_MEASURE_Z = 4,
  GPGP_MEASURE_ATTRIBUTE = 8 /**< GpgpInstance::attribute, which is the value of a `report` of .cga files. */
};

/** A number that is summed up over the terminals of each axiom. */
typedef struct GpgpMeasure {
  uint32_t terminal; /**< Index into gpgpGetGrammarTerminals, or GPGP_ALL_TERMINALS. */
  GpgpMeasureFactors factors;
} GpgpMeasure;
#define GPGP_ALL_TERMINALS 0xffffffffu
#define GPGP_MAX_MEASURES 4

/** A grid of cells in the world, of which each axiom's terminals occupy some. An axis of one cell makes it a silhouette
 *  seen along that axis. A terminal occupies the cells whose centres lie in its axis-aligned box; along an axis of one
 *  cell, the cell that its box touches. */
typedef struct GpgpOccupancy {
  GpgpSpawnBounds box; /**< World space. min is less than max on each axis. */
  uint32_t cells[3];   /**< Along x, y and z, at least 1. Of a row along x, each started word of 32 cells counts; at
                        *   most 1024 words, as 128 x 256 cells have. */
  /** What should be occupied: uint32_t[cells[2]][cells[1]][(cells[0] + 31) / 32], cell x in bit x % 32 of word x / 32.
   *  @lifetime call */
  const uint32_t* target;
} GpgpOccupancy;

/** What is measured of each axiom. */
typedef struct GpgpMeasureInfo {
  const GpgpMeasure* measures;    /**< @lifetime call */
  uint32_t measureCount;          /**< At most GPGP_MAX_MEASURES. */
  const GpgpOccupancy* occupancy; /**< Optional. @lifetime call */
} GpgpMeasureInfo;

/** What was measured of an axiom. 72 bytes. It does not depend on any order of execution. Numbers are equal on all
 *  devices and on the CPU; boxes, and cells at their very borders, as far as transforms are. */
typedef struct GpgpAxiomMeasures {
  GpgpSpawnBounds bounds; /**< Around the axiom's terminals. */
  uint32_t terminals;
  /** Values that were no number, and count as 0, or beyond 2^23 to either side, and count as that. */
  uint32_t clamped;
  /** By measure, in units of 1 / 65536; of each value, what lies beyond them is cut off. */
  int64_t sums[GPGP_MAX_MEASURES];
  uint32_t occupiedCells; /**< Cells of GpgpOccupancy that the axiom's terminals occupy. */
  uint32_t matchingCells; /**< Those of them that the target holds. */
} GpgpAxiomMeasures;

typedef uint64_t GpgpSpawnFlags;
/** Every bucket has a region of the output. GpgpSpawnInfo::draws says where each region begins. A region ends where
 *  that of the next bucket begins, the last one at the end of the buffer. Regions lie in the order of the buckets. */
#define GPGP_SPAWN_REGIONS ((GpgpSpawnFlags)1)

typedef struct GpgpSpawnInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  GpgpAsset grammar;
  GpgpBuffer axioms; /**< GpgpAxiom[axiomCount]. STORAGE usage. Offset and count can select a part of a longer list. */
  /** GpgpAxiom[axiomCount] in host memory instead of axioms. They are copied while recording. At most
   *  GpgpSpawnerCreateInfo::maxHostAxioms. @lifetime call */
  const GpgpAxiom* hostAxioms;
  /** Optional. A uint32_t with the number of axioms, for axioms that the GPU writes. STORAGE usage. axiomCount is then
   *  the largest number that is derived, and must not be 0. */
  GpgpBuffer axiomCounter;
  uint32_t axiomCount;
  GpgpSpawnFlags flags;
  /** Added to every firstInstance that the recording writes to draws: the number of instances that precede the range
   *  `instances` in what the engine binds. Without GPGP_SPAWN_REGIONS, and not for vertices. */
  uint32_t firstInstance;
  /** Output, GpgpInstance[], or GpgpCompactInstance[] with GPGP_SPAWNER_COMPACT. Its size is the budget. STORAGE usage.
   *  NULL: the recording only counts, and draws or measures must be given. */
  GpgpBuffer instances;
  const GpgpVertexOutput* vertices; /**< Output of spawners that were created for vertices, instead of instances. */
  /** Output, optional. VkDrawIndexedIndirectCommand[buckets], one for each bucket. STORAGE usage. Fields that are not
   *  named here keep the engine's values.
   *
   *  Instances: they are sorted by bucket, and instanceCount and firstInstance are written. Without draws, instances
   *  are in no particular order, unless the spawner has GPGP_SPAWNER_ORDERED.
   *
   *  Vertices: indexCount of the first command is written. It draws all buckets, so one command is enough. Vertices are
   *  in no particular order, unless the spawner has GPGP_SPAWNER_ORDERED.
   *
   *  Instances with GPGP_SPAWN_REGIONS: firstInstance is read and instanceCount is written.
   *
   *  Vertices with GPGP_SPAWN_REGIONS: firstIndex is read and must be a multiple of 6. indexCount and vertexOffset
   *  (firstIndex / 6 * 4) are written.
   *
   *  Only counting: instanceCount and firstInstance are written, or indexCount, firstIndex and vertexOffset. They
   *  describe regions of exactly the needed size, for a later recording with GPGP_SPAWN_REGIONS. */
  GpgpBuffer draws;
  /** Output, optional. uint32_t[buckets], the instances or indices that each bucket needs. STORAGE usage. Only with
   *  GPGP_SPAWN_REGIONS, or if the recording only counts. */
  GpgpBuffer needed;
  GpgpBuffer count; /**< Output, optional. A uint32_t, the instances or indices that were written. STORAGE usage. */
  /** Output, optional. GpgpSpawnBounds[buckets], the box around the terminals that were written for each bucket. With
   *  BUDGET_EXCEEDED it may also contain terminals that were omitted. STORAGE usage. Not if the recording only
   *  counts. */
  GpgpBuffer bounds;
  const GpgpSpawnCamera* camera; /**< Optional. The camera that the rules of the grammar refer to. @lifetime call */
  /** Input and output, optional. GpgpAxiomRange[axiomCount]: every axiom writes its own range of instances and nothing
   *  else. To derive some axioms anew, record only these, each with its range; all other instances keep their contents.
   *  Ranges must not overlap. Instances beyond the end of the buffer do not fit. STORAGE usage. Not allowed with draws,
   *  bounds or GPGP_SPAWN_REGIONS, nor in spawners that are ordered, compact or for vertices. */
  GpgpBuffer ranges;
  /** Optional. Measures each axiom. The results come with the report (GpgpSpawnReport::axioms), when the frame is safe:
   *  nothing waits. maxTerminals bounds the recording; where it is too small, the report says BUDGET_EXCEEDED, and some
   *  terminals were not measured. Vertices must be written. Not with ranges, nor, unless the spawner is ordered, with
   *  GPGP_SPAWN_REGIONS. @lifetime call */
  const GpgpMeasureInfo* measures;
  /** The last ones of the axioms are context: what they register with Collider exists for the other axioms, and their
   *  terminals are neither written nor counted. So parts of a world that are recorded one by one fit together: each
   *  has the neighbours that can reach into it as context. At most axiomCount; 0 with axiomCounter. */
  uint32_t contextCount;
  uint32_t fieldCount;
  /** The fields that the grammar reads, in any order. Others are ignored. One that is missing is INVALID_ARGUMENT; the
   *  message names it, and the first rule that reads it. @lifetime call */
  const GpgpSpawnField* fields;
  /** Input. The values of all fields, as floats. STORAGE usage. Not needed by grammars without fields. */
  GpgpBuffer fieldValues;
} GpgpSpawnInfo;
#define GPGP_SPAWN_INFO_INIT GPGP_INIT(GpgpSpawnInfo, GPGP_STRUCTURE_SPAWN_INFO)

/** Records a derivation of the axioms. It writes an instance for each terminal shape, or its vertices and indices, or
 *  only counts. Returns NOT_READY if the grammar is not resident or the spawner is not prewarmed.
 *  Errors: INVALID_HANDLE, INVALID_STRUCT, INVALID_ARGUMENT, TOO_MANY_RECORDINGS, UNSUPPORTED, DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareSpawn(GpgpRecorder spawner, VkCommandBuffer commandBuffer,
                                                     const GpgpFrame* frame, const GpgpSpawnInfo* info);

typedef struct GpgpSpawnReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t terminals; /**< Terminal shapes that were derived. */
  /** At most terminals. Less only with BUDGET_EXCEEDED. 0 if the recording writes vertices or only counts. */
  uint32_t instancesWritten;
  /** The largest number of shapes that waited for a round, including those that did not fit. With this maxShapes they
   *  would have fitted. */
  uint32_t peakShapes;
  /** Shapes that were dropped: they did not fit maxShapes, or were left after maxRounds, or a Repeat would have made
   *  more than 2^20 copies of them, or they are polygons that a SubDiv cannot cut. Axioms are counted too if their
   *  start does not exist or if axiomCounter exceeds axiomCount. What would have been derived from them is not
   *  known. */
  uint32_t droppedShapes;
  uint32_t unfinishedShapes; /**< Shapes that nested deeper than maxDepth. */
  uint32_t rounds;           /**< Rounds that had work. */
  uint32_t keyHash[2];       /**< Hash of path key, terminal, rule and shape of all terminals, independent of order. */
  uint32_t depth;            /**< Deepest recursion of rules. */
  uint32_t vertices; /**< Vertices of all terminals, in a spawner for vertices. 6 indices belong to every 4 vertices. */
  uint32_t verticesWritten; /**< At most vertices. Less only with BUDGET_EXCEEDED or if the recording only counts. */
  uint32_t colliders;       /**< Shapes that Collider had to register. With this maxColliders all would have fitted. */
  /** At most colliders. Less only with BUDGET_EXCEEDED: IfCollides did not see the other colliders. */
  uint32_t collidersKept;
  /** What GpgpSpawnInfo::measures asked for, in the order of the axioms; NULL without measures, and of what was not
   *  executed. Valid until the next gpgpAdvance. */
  const GpgpAxiomMeasures* axioms;
  uint32_t axiomCount;
  float detail; /**< GpgpSpawnCamera::detail of the recording; 1 for 0, and without a camera. */
} GpgpSpawnReport;
#define GPGP_SPAWN_REPORT_INIT GPGP_INIT(GpgpSpawnReport, GPGP_STRUCTURE_SPAWN_REPORT)

/** Takes the oldest report that is ready. Returns NOT_READY if there is none. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetSpawnReport(GpgpRecorder spawner, GpgpSpawnReport* report);

#ifdef __cplusplus
}
#endif
#endif
