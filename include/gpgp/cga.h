/* gpgp cga: files of the CGA-like language (.cga) in the engine: their attributes for an editor, their meshes from the
 * CPU, and the operator graph that derives them on the GPU. All of it is in libgpgp_evaluator, which needs neither a
 * device nor a context.
 *
 *   program      A .cga file with what it imports. Read only: any number of threads may use it.
 *   derivation   The meshes of a list of lots. The next one replaces them.
 *   lot          A start shape: a polygon with holes, a rectangle or a box.
 *
 *   gpgpCreateCgaProgram -> gpgpGetCgaAttributes                           names, ranges and groups for sliders
 *                        -> gpgpCreateCgaDerivation -> gpgpDeriveCga -> gpgpGetCgaDerivationResult
 *                        -> gpgpGetCgaGraph -> gpgpCompileGrammar -> gpgpCreateGrammar
 *
 * A derivation on the CPU takes every file. One on the GPU takes files whose operations have operators there, and
 * derives the same shapes with the same random numbers.
 *
 * Files are found in the folder of GpgpCgaProgramCreateInfo::name. Functions such as fileSearch and readTextFile read
 * them from the disk, so an engine that takes .cga files from strangers must know what lies in that folder.
 *
 * Destroyed handles are not recognised, since there is no context: using one is undefined behaviour.
 */
#ifndef GPGP_CGA_H
#define GPGP_CGA_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct GpgpCgaProgram_T* GpgpCgaProgram;
typedef struct GpgpCgaDerivation_T* GpgpCgaDerivation;

/** The value of an attribute as text: a number, true, false, or else a string. */
typedef struct GpgpCgaValue {
  const char* name; /**< With the prefixes of imports, as in "Roof.angle". */
  const char* text;
} GpgpCgaValue;

/** The triangles of an asset that i() and its like insert. */
typedef struct GpgpCgaAsset {
  const float (*positions)[3]; /**< Object space of the asset, metres, y up. */
  uint32_t positionCount;
  const uint32_t* indices;   /**< Three a triangle, each less than positionCount. */
  uint32_t indexCount;       /**< 0: there is no such asset. A box then stands for it, and a message names it. */
  const char* const* groups; /**< Optional: the names of its groups, which assetNamingInfo(path, g) lists. */
  uint32_t groupCount;
  const char* const* materials; /**< Optional: the names of its materials, for assetNamingInfo(path, m). */
  uint32_t materialCount;
} GpgpCgaAsset;

/** Loads the asset of a file. path: of a file that is there, else the folder of the program and the name in the file.
 *  The arrays are copied before the callback is called again on the same thread. Threads of the job system may call it
 *  at the same time, each of them once for a path in a derivation. A negative result is as an indexCount of 0. */
typedef GpgpResult(GPGP_CALL* GpgpLoadCgaAssetFn)(void* userData, const char* path, GpgpCgaAsset* asset);

/* ---------------------------------------------------------------- program */

typedef struct GpgpCgaProgramCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* name;  /**< Path of the file, for messages, and for what the program reads beside it. */
  const char* text;  /**< UTF-8. It need not end in 0. NULL: the file is read. */
  size_t size;       /**< Bytes of text. */
  const char* start; /**< A rule without parameters. NULL: the one behind `@StartRule`, or else the first one. */
  const char* style; /**< A style of the file, or NULL. */
  const GpgpFileSystem* fileSystem; /**< Reads the file and what it imports. NULL: the C library. @lifetime handle */
  const GpgpJobSystem* jobSystem;   /**< NULL: a derivation runs on the calling thread. The struct is copied. */
  GpgpCompileMessageFn messageFn;   /**< Receives errors and warnings of the compilation. NULL: they are dropped. */
  void* messageUserData;
} GpgpCgaProgramCreateInfo;
#define GPGP_CGA_PROGRAM_CREATE_INFO_INIT GPGP_INIT(GpgpCgaProgramCreateInfo, GPGP_STRUCTURE_CGA_PROGRAM_CREATE_INFO)

/** Compiles a file and what it imports. What is not supported is a warning that names it and its place, once for each
 *  kind; the rest derives. Errors: INVALID_DATA (messages say where), INVALID_ARGUMENT (messageFn gets one without a
 *  place), INVALID_STRUCT, IO, OUT_OF_HOST_MEMORY. @threads any @lifetime call; what callbacks use: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCgaProgram(const GpgpCgaProgramCreateInfo* info, GpgpCgaProgram* program);

/** Destroys a program. Its derivations must have been destroyed before. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyCgaProgram(GpgpCgaProgram program);

typedef uint32_t GpgpCgaType;
enum {
  GPGP_CGA_NUMBER = 0,
  GPGP_CGA_BOOLEAN = 1,
  GPGP_CGA_STRING = 2,
  GPGP_CGA_ARRAY = 3 /**< Of any of these. GpgpCgaValue cannot set it. */
};

typedef uint64_t GpgpCgaAttributeFlags;
/** `@Hidden`: not to be shown. */
#define GPGP_CGA_ATTRIBUTE_HIDDEN ((GpgpCgaAttributeFlags)1)
/** `@Range` or `@Enum` with restricted=false: values outside of the range or the choices are as good. */
#define GPGP_CGA_ATTRIBUTE_UNRESTRICTED ((GpgpCgaAttributeFlags)2)
/** `@Color`, `@File`, `@Directory`, `@Percent`, `@Angle`, `@Distance`: how to show and to edit the value. */
#define GPGP_CGA_ATTRIBUTE_COLOR ((GpgpCgaAttributeFlags)4)
#define GPGP_CGA_ATTRIBUTE_FILE ((GpgpCgaAttributeFlags)8)
#define GPGP_CGA_ATTRIBUTE_DIRECTORY ((GpgpCgaAttributeFlags)16)
#define GPGP_CGA_ATTRIBUTE_PERCENT ((GpgpCgaAttributeFlags)32)
#define GPGP_CGA_ATTRIBUTE_ANGLE ((GpgpCgaAttributeFlags)64)
#define GPGP_CGA_ATTRIBUTE_DISTANCE ((GpgpCgaAttributeFlags)128)
/** `@MaterialFile` */
#define GPGP_CGA_ATTRIBUTE_MATERIAL_FILE ((GpgpCgaAttributeFlags)256)

/** An `attr` of a program, with what its annotations say. Strings are UTF-8. @lifetime handle */
typedef struct GpgpCgaAttribute {
  const char* name; /**< With the prefixes of imports, as in "Roof.angle". */
  GpgpCgaType type;
  GpgpCgaAttributeFlags flags;
  const char* text; /**< The value that a lot of 1 x 1 metres with seed 1 has by itself. Other lots may have others. */
  double number;    /**< The same as a number; 0 or 1 of booleans, 0 of strings and arrays. */
  /** `@Range`, else NaN. step is the unit of a slider, NaN for any value. `@Angle` has a range from 0 to 360 and
   *  `@Percent` one from 0 to 1 by itself, both unrestricted. Of an array, these and the choices are those of its
   *  elements. */
  double min, max, step;
  const char* const* choices; /**< `@Enum`: the values to choose from, as texts. */
  uint32_t choiceCount;
  const char* const* groups; /**< `@Group`, which holds until the next one: from the outermost one inwards. */
  uint32_t groupCount;
  double groupOrder;       /**< Groups and attributes are shown in rising order; INFINITY: behind all others. */
  double order;            /**< `@Order` */
  const char* description; /**< `@Description`, or "". */
  const char* file;        /**< Where it is defined. */
  uint32_t line, column;
  const char* displayName;       /**< `@DisplayName`, or "": the name is shown. */
  const char* const* extensions; /**< `@File("obj", "glb")`: of the files to choose from. */
  uint32_t extensionCount;
} GpgpCgaAttribute;

/** Lists the attributes of a program, file by file, in the order of their definitions. count is the capacity of
 *  attributes on input and the number of all attributes on output. If attributes is NULL, only the count is returned.
 *  If it is too small, the function fills it and returns GPGP_INCOMPLETE. Errors: INVALID_HANDLE, INVALID_ARGUMENT.
 *  @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetCgaAttributes(GpgpCgaProgram program, uint32_t* count,
                                                   GpgpCgaAttribute* attributes);

/* ---------------------------------------------------------------- on the GPU */

/** What the terminals of a program's graph are, by GpgpGrammarTerminal::index. */
typedef struct GpgpCgaTerminal {
  const char* rule; /**< The rule that shapes end in, or the name of a report. */
  float color[4];   /**< sRGB, and opacity. */
  const char* texture;
  const char* asset; /**< What i() named, or "" for the shape itself. */
  uint32_t isReport; /**< 1: not a shape. GpgpInstance::attribute is a value that the file reports. */
} GpgpCgaTerminal;

/** The operator graph of a program. Everything in it is valid until the next call with this program, or until the
 *  program is destroyed. */
typedef struct GpgpCgaGraph {
  GpgpStructureType sType;
  void* pNext;
  const char* text; /**< PGA-shape for GpgpGrammarSource::text. It ends in 0. */
  size_t size;      /**< Bytes of text, without the 0. */
  const GpgpCgaTerminal* terminals;
  uint32_t terminalCount;
  /** 1: the graph is right for axioms only whose y axis is the world's, since the file asks for directions. */
  uint32_t needsUpright;
} GpgpCgaGraph;
#define GPGP_CGA_GRAPH_INIT GPGP_INIT(GpgpCgaGraph, GPGP_STRUCTURE_CGA_GRAPH)

/** Makes the operator graph that derives what the program derives, with these values of attributes. Its axioms are
 *  rectangles in the ground plane: GpgpAxiom::size has y 0, GpgpAxiom::attribute is NaN.
 *  Errors: UNSUPPORTED (the program's messageFn gets the first thing that has no operator, with its place),
 *  INVALID_ARGUMENT (a value names no attribute), INVALID_HANDLE, INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetCgaGraph(GpgpCgaProgram program, const GpgpCgaValue* values, uint32_t valueCount,
                                              GpgpCgaGraph* graph);

/* ---------------------------------------------------------------- on the CPU */

/** Creates an empty derivation. Errors: INVALID_HANDLE, INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCgaDerivation(GpgpCgaProgram program, GpgpCgaDerivation* derivation);

/** Destroys a derivation and all that gpgpGetCgaDerivationResult returned. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyCgaDerivation(GpgpCgaDerivation derivation);

/** A start shape. */
typedef struct GpgpCgaLot {
  /** Without points, this is the lot: a rectangle where size[1] is 0, or a box. transform must not mirror, shear or
   *  scale. Of a polygon only the seed is used. start must be GPGP_AXIOM_DEFAULT_START. */
  GpgpAxiom axiom;
  const float (*points)[3];  /**< World space, metres: the outline counter-clockwise seen from above, then the holes. */
  const uint32_t* loopSizes; /**< Points of the outline, then of each hole. */
  uint32_t loopCount;        /**< 0: there is no polygon. */
  const float* streetWidths; /**< Optional. Of the street beside each edge of the outline and the holes; 0: none. */
  /** Of this lot's attributes. GpgpCgaDerivationInfo::values go before them. The name "/edgeattr/NAME" is a value for
   *  each edge of the polygon, which edgeAttr.getFloat("NAME") and its like read: the text has them with a semicolon
   *  behind each, in the order of the points. */
  const GpgpCgaValue* values;
  uint32_t valueCount;
} GpgpCgaLot;

typedef uint64_t GpgpCgaDerivationFlags;
/** Counts and reports only: no vertices. */
#define GPGP_CGA_DERIVATION_COUNT_ONLY ((GpgpCgaDerivationFlags)1)
/** longitude and latitude are given. Without, getGeoCoord(lon) and getGeoCoord(lat) are 0, with a warning. */
#define GPGP_CGA_DERIVATION_GEOGRAPHIC ((GpgpCgaDerivationFlags)2)

typedef struct GpgpCgaDerivationInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpCgaLot* lots;
  uint32_t lotCount;
  GpgpCgaDerivationFlags flags;
  const GpgpCgaValue* values; /**< Of the attributes of all lots. */
  uint32_t valueCount;
  uint32_t maxDepth;            /**< Rules that follow one another. 0: 2000. */
  uint32_t maxShapes;           /**< Of one lot. 0: 4 million. */
  uint32_t maxFaces;            /**< Of one shape. 0: 250 000. */
  uint32_t maxVertices;         /**< Of one shape. 0: 1 million. */
  uint32_t maxGeometryMiB;      /**< Of the meshes of one lot, and of the triangles that are kept. 0: 2048. */
  uint32_t maxWork;             /**< Million steps of one lot's geometry. 0: 1000. */
  GpgpLoadCgaAssetFn loadAsset; /**< NULL: a box stands for every asset. */
  void* loadAssetUserData;
  GpgpCompileMessageFn messageFn; /**< Receives warnings, and as errors limits that were exceeded, with their places. */
  void* messageUserData;
  /** Fields of the world, with their values in host memory (GpgpSpawnField::grid). Field("NAME") reads them. An attr of
   *  a field's name has the field's value at the middle of the lot, unless `values` set it. Each field that the program
   *  names must be there; others are ignored. */
  const GpgpSpawnField* fields;
  uint32_t fieldCount;
  double longitude, latitude; /**< Of the origin of world space, degrees. x is east and z is south. */
} GpgpCgaDerivationInfo;
#define GPGP_CGA_DERIVATION_INFO_INIT GPGP_INIT(GpgpCgaDerivationInfo, GPGP_STRUCTURE_CGA_DERIVATION_INFO)

/** Derives lots, and replaces what the derivation held. The result does not depend on the number of threads. An error
 *  about the arguments changes nothing; after OUT_OF_HOST_MEMORY the derivation is empty.
 *  Errors: INVALID_HANDLE, INVALID_STRUCT, INVALID_ARGUMENT (messageFn says which), OUT_OF_HOST_MEMORY.
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpDeriveCga(GpgpCgaDerivation derivation, const GpgpCgaDerivationInfo* info);

/** A shape in which the derivation ended. */
typedef struct GpgpCgaLeaf {
  const char* rule;                /**< The name that it ended in. */
  const char* texture;             /**< What texture() named, or "". */
  float color[4];                  /**< sRGB, and opacity. */
  uint32_t lot;                    /**< Index into GpgpCgaDerivationInfo::lots. */
  uint32_t firstIndex, indexCount; /**< Of GpgpCgaDerivationResult::indices. */
} GpgpCgaLeaf;

typedef struct GpgpCgaVertex {
  float position[3]; /**< World space, metres. */
  float normal[3];   /**< World space, of length 1. */
  float uv[2];       /**< UV set 0. v points up. */
} GpgpCgaVertex;

/** The sum of a report() over all lots. */
typedef struct GpgpCgaReport {
  const char* name;
  uint64_t count;
  double sum, min, max;
} GpgpCgaReport;

/** All pointers stay valid until the next gpgpDeriveCga of the derivation, or until it is destroyed. */
typedef struct GpgpCgaDerivationResult {
  GpgpStructureType sType;
  void* pNext;
  GpgpResult status;         /**< SUCCESS, or BUDGET_EXCEEDED: a limit stopped a lot. The messages name it. */
  const GpgpCgaLeaf* leaves; /**< In the order of the lots. */
  uint32_t leafCount;
  const GpgpCgaVertex* vertices;
  uint32_t vertexCount;
  const uint32_t* indices; /**< Three a triangle, counter-clockwise seen from outside. */
  uint32_t indexCount;
  const GpgpCgaReport* reports; /**< In the order of their names. */
  uint32_t reportCount;
  const char* const* prints; /**< What print() said, in order: the first 1000. */
  uint32_t printCount;
  uint64_t printed;   /**< How often print() was called. */
  uint64_t shapes;    /**< Shapes that rules ran on. */
  uint64_t triangles; /**< Of all leaves, also with GPGP_CGA_DERIVATION_COUNT_ONLY. */
  uint32_t depth;     /**< Rules that led to the deepest shape. */
} GpgpCgaDerivationResult;
#define GPGP_CGA_DERIVATION_RESULT_INIT GPGP_INIT(GpgpCgaDerivationResult, GPGP_STRUCTURE_CGA_DERIVATION_RESULT)

/** Returns what the derivation holds. Errors: INVALID_HANDLE, INVALID_STRUCT. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetCgaDerivationResult(GpgpCgaDerivation derivation, GpgpCgaDerivationResult* result);

#ifdef __cplusplus
}
#endif
#endif
