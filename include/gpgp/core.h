/* gpgp core: what all three services share.
 *
 * An engine hands gpgp its device once (gpgpCreateContext), then, each frame, a command buffer in recording state.
 * gpgp records work into it and returns. It never submits, waits, presents, owns a queue or creates a thread.
 *
 *   asset    immutable input, shareable between recorders: a grammar, a drawing, a geometry set
 *   recorder   pipelines and scratch for one kind of work, sized by budgets: a spawner, a canvas, a recorder
 *   view     the history of one camera, canvas or tile
 *   report   what a record did, as counted by the GPU; ready when its frame is safe
 *
 * A frame:
 *   gpgpAdvance(context, &frame)                      once: frees, harvests reports, recycles rings
 *   gpgpRecordUpload(context, cmd, &frame, bytes)     copies pending asset data
 *   gpgpRecordPrepare...(recorder, cmd, &frame, info)   outside render passes: the compute work
 *   gpgpRecordDraw...(recorder, cmd, &frame, info)      inside the engine's pass, where something is drawn
 *
 * Conventions, stated once for all services:
 *   object and world space   right-handed, +Y up, 1 unit = 1 metre; counter-clockwise triangles face the viewer
 *   drawing space            +X right, +Y down, 1 unit = 1 CSS pixel, as SVG
 *   pixel space              +X right, +Y down, pixel (x, y) covers [x, x+1) x [y, y+1)
 *   clip space               Vulkan's: +Y down, depth 0 (near) to 1 (far) unless a struct says reversed
 *   matrices                 column-major, column vectors: clip = viewProjection * world * position
 *   colour                   linear, premultiplied alpha, unless a field names another encoding
 *
 * Documentation tags:
 *   @threads any      safe from any thread at any time
 *   @threads context  one thread at a time per context; beside records of its recorders, too, but for gpgpAdvance,
 * which changes what records and reports read, and for destroying what a record uses
 *   @threads handle   one thread at a time per handle named first; different handles run side by side
 *   @lifetime call    pointers are read during the call only; frame: until the frame is safe; handle: until destroyed
 *   @pass outside     command buffer must be outside a render pass; inside: inside; any: either
 *   @state            command-buffer state that differs after the call
 *
 * Errors: negative GpgpResult. A function that returns an error has changed nothing, recorded nothing and sent one
 * message to the callback. The header needs no Vulkan header before it; it includes vulkan_core.h for handle types.
 */
#ifndef GPGP_CORE_H
#define GPGP_CORE_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan_core.h>

#if defined(_WIN32)
#define GPGP_CALL __stdcall
#if defined(GPGP_SHARED_BUILD)
#define GPGP_API __declspec(dllexport)
#elif defined(GPGP_SHARED)
#define GPGP_API __declspec(dllimport)
#else
#define GPGP_API
#endif
#else
#define GPGP_CALL
#define GPGP_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- version */

#define GPGP_VERSION_MAJOR 0
#define GPGP_VERSION_MINOR 1
#define GPGP_VERSION_PATCH 0
#define GPGP_MAKE_VERSION(major, minor, patch)                                                                         \
  (((uint32_t)(major) << 22) | ((uint32_t)(minor) << 12) | (uint32_t)(patch))
/** The version of this header. */
#define GPGP_VERSION GPGP_MAKE_VERSION(GPGP_VERSION_MAJOR, GPGP_VERSION_MINOR, GPGP_VERSION_PATCH)

/** The version of the library that is loaded, as GPGP_MAKE_VERSION makes it. Compatible: the same major version, and
 *  while that is 0 the same minor version too.
 *  @threads any */
GPGP_API uint32_t GPGP_CALL gpgpGetVersion(void);

/* ---------------------------------------------------------------- results and messages */

typedef int32_t GpgpResult; /* one of the values below; 32 bits in every compiler */
enum {
  GPGP_SUCCESS = 0,
  /* statuses: nothing is wrong */
  GPGP_NOT_READY = 1,       /**< an asset is not resident, a pipeline not prewarmed, or a report not yet safe */
  GPGP_BUDGET_EXCEEDED = 2, /**< in reports: something did not fit; the report names the size that would have */
  GPGP_NOT_EXECUTED = 3,    /**< in reports: the command buffer was dropped, the GPU never ran it */
  GPGP_INCOMPLETE = 4,      /**< an array or byte range was too small; what fits was written, the count says all */
  /* errors: nothing was changed */
  GPGP_ERROR_INVALID_ARGUMENT = -1,
  GPGP_ERROR_INVALID_STRUCT = -2,  /**< sType is unknown, or a pNext chain holds a struct that does not belong */
  GPGP_ERROR_INVALID_HANDLE = -3,  /**< destroyed, of another kind, or of another context */
  GPGP_ERROR_MISSING_FEATURE = -4, /**< the device or the declared features lack something; the message names it */
  GPGP_ERROR_OUT_OF_HOST_MEMORY = -5,
  GPGP_ERROR_OUT_OF_DEVICE_MEMORY = -6,
  GPGP_ERROR_DEVICE_LOST = -7,
  GPGP_ERROR_TOO_MANY_RECORDINGS = -8, /**< maxRecordingsPerFrame or maxFramesInFlight is used up */
  GPGP_ERROR_INVALID_DATA = -9,        /**< bytes that are not what they claim: magic, version, checksum or content */
  GPGP_ERROR_UNSUPPORTED = -10,        /**< valid input that this build or device cannot handle */
  GPGP_ERROR_IO = -11,
  GPGP_ERROR_VULKAN = -12 /**< Vulkan failed otherwise; the message holds its code */
};

/** The name of a result as spelled in this header, "GPGP_UNKNOWN" otherwise. Static string. @threads any */
GPGP_API const char* GPGP_CALL gpgpResultString(GpgpResult result);

typedef int32_t GpgpSeverity;
enum { GPGP_SEVERITY_INFO = 0, GPGP_SEVERITY_WARNING = 1, GPGP_SEVERITY_ERROR = 2 };

typedef struct GpgpMessage {
  GpgpSeverity severity;
  GpgpResult code;
  const char* function; /**< the API function, e.g. "gpgpCreateSpawner" */
  const char* label;    /**< of the object concerned, "" where there is none */
  const char* text;     /**< one sentence, names the argument and what was expected */
} GpgpMessage;
/** Called on the thread that called gpgp. Must not call gpgp. @lifetime call */
typedef void(GPGP_CALL* GpgpMessageFn)(void* userData, const GpgpMessage* message);

/* ---------------------------------------------------------------- structs with a type */

typedef int32_t GpgpStructureType;
enum {
  GPGP_STRUCTURE_CONTEXT_CREATE_INFO = 1,
  GPGP_STRUCTURE_REQUIREMENTS_INFO = 2,
  GPGP_STRUCTURE_REQUIREMENTS = 3,
  GPGP_STRUCTURE_PREWARM_INFO = 4,
  GPGP_STRUCTURE_TARGET_INFO = 5,
  GPGP_STRUCTURE_MEMORY_REPORT = 6,
  /* spawn */
  GPGP_STRUCTURE_GRAMMAR_SOURCE = 100,
  GPGP_STRUCTURE_GRAMMAR_CREATE_INFO = 101,
  GPGP_STRUCTURE_SPAWNER_CREATE_INFO = 102,
  GPGP_STRUCTURE_SPAWN_INFO = 103,
  GPGP_STRUCTURE_SPAWN_REPORT = 104,
  /* vector */
  GPGP_STRUCTURE_SVG_SOURCE = 200,
  GPGP_STRUCTURE_DRAWING_CREATE_INFO = 201,
  GPGP_STRUCTURE_DRAWING_INFO = 202,
  GPGP_STRUCTURE_CANVAS_CREATE_INFO = 203,
  GPGP_STRUCTURE_CANVAS_INFO = 204,
  GPGP_STRUCTURE_CANVAS_DRAW_INFO = 205,
  GPGP_STRUCTURE_CANVAS_REPORT = 206,
  GPGP_STRUCTURE_CANVAS_HISTORY_CREATE_INFO = 207,
  GPGP_STRUCTURE_GLYPH_SOURCE = 208,
  GPGP_STRUCTURE_GLYPH_SET_CREATE_INFO = 209,
  GPGP_STRUCTURE_GLYPH_SET_INFO = 210,
  GPGP_STRUCTURE_LIST_CREATE_INFO = 211,
  GPGP_STRUCTURE_HIT_TEST_INFO = 212,
  /* visibility */
  GPGP_STRUCTURE_GEOMETRY_SET_CREATE_INFO = 300,
  GPGP_STRUCTURE_VISIBILITY_RECORDER_CREATE_INFO = 301,
  GPGP_STRUCTURE_VISIBILITY_INFO = 302,
  GPGP_STRUCTURE_VISIBILITY_REPORT = 303,
  GPGP_STRUCTURE_CAMERA_HISTORY_CREATE_INFO = 304,
  GPGP_STRUCTURE_VISIBILITY_METRICS_INFO = 305,
  GPGP_STRUCTURE_VIEW_CELL_INFO = 306,
  /* text */
  GPGP_STRUCTURE_FONT_CREATE_INFO = 400,
  GPGP_STRUCTURE_FONT_INFO = 401,
  GPGP_STRUCTURE_GLYPH_OUTLINE_INFO = 402,
  GPGP_STRUCTURE_SHAPER_CREATE_INFO = 403,
  GPGP_STRUCTURE_SHAPER_REPORT = 404,
  GPGP_STRUCTURE_TEXT_INFO = 405,
  GPGP_STRUCTURE_LAYOUT_INFO = 406
};

#ifdef __cplusplus
} /* extern "C": a template needs C++ linkage */
template <class T> inline T gpgpInitStruct(GpgpStructureType type) {
  T value = T();
  value.sType = type;
  return value;
}
extern "C" {
#define GPGP_INIT(Type, type) gpgpInitStruct<Type>(type)
#else
#define GPGP_INIT(Type, type)                                                                                          \
  { .sType = (type) }
#endif

/* Every descriptor struct begins with sType and pNext. pNext is NULL or points to a struct that the base struct's
 * comment names; anything else is GPGP_ERROR_INVALID_STRUCT. Zero all other fields (the _INIT macros do): zero is
 * always "none" or "default". */

/* ---------------------------------------------------------------- handles */

typedef struct GpgpContext_T* GpgpContext;
typedef struct GpgpAsset_T* GpgpAsset;       /**< grammar, drawing, glyph set or geometry set */
typedef struct GpgpRecorder_T* GpgpRecorder; /**< spawner, canvas or recorder */
typedef struct GpgpHistory_T* GpgpHistory;   /**< history of one camera, canvas or tile */

typedef int32_t GpgpService;
enum { GPGP_SERVICE_CORE = 0, GPGP_SERVICE_SPAWN = 1, GPGP_SERVICE_VECTOR = 2, GPGP_SERVICE_VISIBILITY = 3 };
#define GPGP_SERVICE_COUNT 4

/* ---------------------------------------------------------------- device requirements and features */

typedef uint64_t GpgpFeatures;
/* What the engine enabled on its device. Vulkan cannot tell afterwards, so the engine declares it. */
#define GPGP_FEATURE_DYNAMIC_RENDERING ((GpgpFeatures)1 << 0)
#define GPGP_FEATURE_BUFFER_INT64_ATOMICS ((GpgpFeatures)1 << 1) /**< shaderBufferInt64Atomics and shaderInt64 */
#define GPGP_FEATURE_MULTIVIEW ((GpgpFeatures)1 << 2)
#define GPGP_FEATURE_DEBUG_UTILS ((GpgpFeatures)1 << 3) /**< VK_EXT_debug_utils on the instance: names and labels */
#define GPGP_FEATURE_ALL (((GpgpFeatures)1 << 4) - 1)

typedef struct GpgpRequirementsInfo {
  GpgpStructureType sType;
  const void* pNext;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
} GpgpRequirementsInfo;
#define GPGP_REQUIREMENTS_INFO_INIT GPGP_INIT(GpgpRequirementsInfo, GPGP_STRUCTURE_REQUIREMENTS_INFO)

typedef struct GpgpRequirements {
  GpgpStructureType sType;
  void* pNext;
  uint32_t apiVersion;           /**< at least this Vulkan version, for instance and device */
  GpgpFeatures requiredFeatures; /**< always 0: the baseline is plain Vulkan 1.2 */
  GpgpFeatures optionalFeatures; /**< those that the device offers and gpgp would use */
  VkQueueFlags queueFlags;       /**< a family for recorders needs these; drawing needs GRAPHICS as well */
  const char* const* extensions; /**< device extensions behind optionalFeatures; static strings */
  uint32_t extensionCount;
  VkPhysicalDeviceFeatures2 features; /**< chain to VkDeviceCreateInfo::pNext, or merge: enables optionalFeatures;
                                           its chain points into this struct, so do not copy the struct */
  VkPhysicalDeviceVulkan11Features features11;
  VkPhysicalDeviceVulkan12Features features12;
  VkPhysicalDeviceDynamicRenderingFeatures dynamicRendering;
  uint32_t missingCount;   /**< 0: the device can run gpgp */
  const char* missing[16]; /**< each missing item by name and needed value; static strings */
} GpgpRequirements;
#define GPGP_REQUIREMENTS_INIT GPGP_INIT(GpgpRequirements, GPGP_STRUCTURE_REQUIREMENTS)

/** What gpgp needs of a device and what it could use, before the device is made.
 *  Works before any context exists. Returns GPGP_ERROR_MISSING_FEATURE when missingCount > 0 (the struct is filled all
 *  the same). @threads any @lifetime call (returned strings: forever) */
GPGP_API GpgpResult GPGP_CALL gpgpGetRequirements(const GpgpRequirementsInfo* info, GpgpRequirements* requirements);

/* ---------------------------------------------------------------- callbacks of the engine */

/** Host memory. allocate returns NULL on failure; alignment is a power of two. All of gpgp's own host memory comes
 *  from here; blobs of libgpgp_compiler do not. May be called from any thread that calls gpgp. */
typedef struct GpgpHostAllocator {
  void* userData;
  void*(GPGP_CALL* allocate)(void* userData, size_t size, size_t alignment);
  void(GPGP_CALL* free)(void* userData, void* memory, size_t size, size_t alignment);
} GpgpHostAllocator;

/** One piece of device memory. */
typedef struct GpgpGpuAllocation {
  VkDeviceMemory memory;
  VkDeviceSize offset;
  void* mapped;   /**< at offset; required for host-visible requests, ignored otherwise; stays mapped */
  void* userData; /**< the engine's own handle, given back to free */
} GpgpGpuAllocation;

typedef struct GpgpGpuAllocationRequest {
  VkMemoryRequirements requirements;
  VkMemoryPropertyFlags required;
  VkMemoryPropertyFlags preferred;
  GpgpService service;
  const char* label;
} GpgpGpuAllocationRequest;

/** Device memory. allocate returns VK_SUCCESS or an error; gpgp never calls it while recording. Without these
 *  callbacks gpgp sub-allocates blocks of its own. */
typedef struct GpgpGpuAllocator {
  void* userData;
  VkResult(GPGP_CALL* allocate)(void* userData, const GpgpGpuAllocationRequest* request, GpgpGpuAllocation* allocation);
  void(GPGP_CALL* free)(void* userData, const GpgpGpuAllocation* allocation);
} GpgpGpuAllocator;

/** The engine's job system, used by gpgpPrewarm; without it work runs on the calling thread. */
typedef void(GPGP_CALL* GpgpJobFn)(void* argument, uint32_t index);
typedef struct GpgpJobSystem {
  void* userData;
  /** Runs job(argument, i) for i in [0, count) and returns when all are done. */
  void(GPGP_CALL* parallelFor)(void* userData, uint32_t count, GpgpJobFn job, void* argument);
} GpgpJobSystem;

/** The engine's files. read returns GPGP_SUCCESS and sets size; it copies at most capacity bytes when data is not NULL.
 */
typedef struct GpgpFileSystem {
  void* userData;
  GpgpResult(GPGP_CALL* read)(void* userData, const char* path, void* data, size_t capacity, size_t* size);
} GpgpFileSystem;

/* ---------------------------------------------------------------- context */

typedef struct GpgpContextCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label; /**< for messages and debug names; copied */
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  uint32_t apiVersion;            /**< the version that instance and device were created with; 0: 1.2 */
  GpgpFeatures features;          /**< what was enabled on the device */
  uint32_t maxFramesInFlight;     /**< 1 to 8; 0: 3 */
  uint32_t maxRecordingsPerFrame; /**< gpgpRecord... calls per frame and recorder; 0: 16 */
  VkDeviceSize uploadRingBytes;   /**< staging memory for gpgpRecordUpload, all frames together; 0: 8 MiB */
  VkPipelineCache pipelineCache;  /**< the engine's, used for all pipelines; or VK_NULL_HANDLE: gpgp's own */
  const void* pipelineCacheData;  /**< initial bytes for gpgp's own cache, from gpgpGetPipelineCacheData */
  size_t pipelineCacheSize;
  const GpgpHostAllocator* hostAllocator; /**< NULL: malloc. The struct is copied */
  const GpgpGpuAllocator* gpuAllocator;   /**< NULL: own blocks. The struct is copied */
  const GpgpJobSystem* jobSystem;         /**< NULL: none */
  const GpgpFileSystem* fileSystem;       /**< NULL: baked files are read through the C library */
  GpgpMessageFn messageFn;
  void* messageUserData;
} GpgpContextCreateInfo;
#define GPGP_CONTEXT_CREATE_INFO_INIT GPGP_INIT(GpgpContextCreateInfo, GPGP_STRUCTURE_CONTEXT_CREATE_INFO)

/** Creates a context on the engine's device. Several contexts, on one or more devices, run side by side.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, MISSING_FEATURE, OUT_OF_..._MEMORY. @threads any @lifetime call;
 *  instance, device, pipelineCache and callbacks: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateContext(const GpgpContextCreateInfo* info, GpgpContext* context);

/** Destroys the context and everything made from it, at once: the device must be idle as far as gpgp's records are
 *  concerned, or lost. NULL is ignored. @threads context */
GPGP_API void GPGP_CALL gpgpDestroyContext(GpgpContext context);

/** Where the engine is. Frame numbers only grow. Everything recorded with a number <= safe has finished on all queues
 *  (or was dropped and never will be submitted). current - safe <= maxFramesInFlight. */
typedef struct GpgpFrame {
  uint64_t current; /**< > safe */
  uint64_t safe;
} GpgpFrame;

/** Once a frame, before the frame's records: frees what was destroyed, harvests reports, recycles rings. The only
 *  function that does. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAdvance(GpgpContext context, const GpgpFrame* frame);

/** Tells gpgp that the device is lost: what creates, records or advances then returns
 *  GPGP_ERROR_DEVICE_LOST, no report comes any more, destroying stays legal and frees at
 *  once. @threads context */
GPGP_API void GPGP_CALL gpgpNotifyDeviceLost(GpgpContext context);

/** Copies up to byteBudget bytes of pending asset data into device memory, oldest asset first (at least 16 are taken;
 * 0: all that the ring holds). pendingBytes, if not NULL, receives what is left. Records transfer commands and one
 * barrier that makes the data visible to all later gpgp records on the same queue; between queues the engine
 * synchronises.
 *  @threads context @lifetime call @pass outside @state none */
GPGP_API GpgpResult GPGP_CALL gpgpRecordUpload(GpgpContext context, VkCommandBuffer commandBuffer,
                                               const GpgpFrame* frame, VkDeviceSize byteBudget,
                                               VkDeviceSize* pendingBytes);

/** The pipeline cache in use (gpgp's own or the engine's) as bytes, for the next start. size in: capacity, out: needed.
 * data NULL asks for the size.
 *  @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetPipelineCacheData(GpgpContext context, size_t* size, void* data);

/* ---------------------------------------------------------------- resources of the engine */

/** How the engine uses a resource around a record: stages and accesses in 64-bit (synchronization2) flags. Flags of
 *  stages that the device cannot name in 32 bits are mapped to the nearest wider one. */
typedef struct GpgpAccess {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout; /**< images only */
} GpgpAccess;

typedef uint64_t GpgpAccessMode;
/** The engine's render graph places the barriers at the edges itself; before and after are ignored, the resources are
 * in the state that gpgpGetRecordingAccess tells, and stay in it. gpgp still places those between its own passes. */
#define GPGP_ACCESS_EXTERNAL_BARRIERS ((GpgpAccessMode)1 << 0)

typedef struct GpgpBuffer {
  VkBuffer buffer;
  VkDeviceSize offset; /**< a multiple of the device's minStorageBufferOffsetAlignment */
  VkDeviceSize size;   /**< bytes that gpgp may use from offset; at most maxStorageBufferRange */
  GpgpAccess before;   /**< the engine's last use; stages 0: nothing to wait for */
  GpgpAccess after;    /**< the engine's next use; stages 0: the engine places that barrier */
} GpgpBuffer;

typedef struct GpgpImage {
  VkImage image;
  VkImageView view; /**< 2D, one mip level, one layer */
  VkFormat format;
  uint32_t mipLevel, arrayLayer; /**< that the view shows: barriers touch no other part of the image */
  uint32_t width, height;        /**< of that level */
  GpgpAccess before;             /**< layout UNDEFINED: contents may be lost */
  GpgpAccess after;
} GpgpImage;

/* ---------------------------------------------------------------- recorders */

/** Common part of every recorder's create info; each service's struct embeds it as `base`. */
typedef struct GpgpRecorderCreateInfo {
  const char* label;       /**< copied */
  uint32_t queueFamily;    /**< all records of this recorder go to queues of this family */
  VkQueueFlags queueFlags; /**< of that family; 0: gpgp asks the physical device */
  VkBool32 engineScratch;  /**< VK_TRUE: no scratch is allocated, each record brings its own */
} GpgpRecorderCreateInfo;

typedef struct GpgpTargetInfo {
  GpgpStructureType sType;
  const void* pNext;
  VkRenderPass renderPass; /**< VK_NULL_HANDLE: dynamic rendering (needs GPGP_FEATURE_DYNAMIC_RENDERING) */
  uint32_t subpass;
  uint32_t viewMask;
  VkFormat colorFormat;          /**< dynamic rendering: attachment 0 */
  VkFormat depthFormat;          /**< dynamic rendering: VK_FORMAT_UNDEFINED for none */
  VkSampleCountFlagBits samples; /**< 0: 1 */
  VkBool32 depthTest;            /**< tests against the bound depth attachment, never writes it */
  VkCompareOp depthCompare;
} GpgpTargetInfo;
#define GPGP_TARGET_INFO_INIT GPGP_INIT(GpgpTargetInfo, GPGP_STRUCTURE_TARGET_INFO)

typedef struct GpgpPrewarmInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpTargetInfo* targets; /**< for recorders that draw: each combination they will draw into */
  uint32_t targetCount;
} GpgpPrewarmInfo;
#define GPGP_PREWARM_INFO_INIT GPGP_INIT(GpgpPrewarmInfo, GPGP_STRUCTURE_PREWARM_INFO)

/** Compiles the recorder's pipelines on the calling thread (through the job system where one was given). Until it has
 *  returned, records return GPGP_NOT_READY and record nothing. info may be NULL for recorders that do not draw.
 *  May run beside records of other recorders. @threads handle @lifetime call; render passes: handle */
GPGP_API GpgpResult GPGP_CALL gpgpPrewarm(GpgpRecorder recorder, const GpgpPrewarmInfo* info);

/** Bytes of scratch that one record of this recorder needs, and the usage flags an engine's buffer for it must have.
 *  @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetScratchSize(GpgpRecorder recorder, VkDeviceSize* size, VkDeviceSize* alignment,
                                                 VkBufferUsageFlags* usage);

/** The passes that one record of this recorder runs, in order. count in: capacity of names, out: passes. names NULL
 *  asks for the count. @threads any @lifetime call; names: handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetPasses(GpgpRecorder recorder, uint32_t* count, const char** names);

/** GPU timestamps of a record: query firstQuery at its start and one more after each pass, passes + 1 in all. The
 *  engine has reset the queries. */
typedef struct GpgpTimestamps {
  VkQueryPool queryPool; /**< VK_NULL_HANDLE: no timestamps */
  uint32_t firstQuery;
  uint32_t queryCount; /**< at least passes + 1 */
} GpgpTimestamps;

/** What gpgp does with buffers and images in a record: the state that GPGP_ACCESS_EXTERNAL_BARRIERS expects of the
 * engine's render graph before a record, and leaves behind. Either pointer may be NULL. @threads any */
GPGP_API void GPGP_CALL gpgpGetRecordingAccess(GpgpAccess* buffer, GpgpAccess* image);

/** Common part of every record info; each service's struct embeds it as `base`. */
typedef struct GpgpRecordingInfo {
  uint64_t tag;       /**< the engine's own number, found again in the report */
  GpgpBuffer scratch; /**< for recorders with engineScratch: contents undefined before and after */
  GpgpTimestamps timestamps;
  GpgpAccessMode accessMode;
} GpgpRecordingInfo;

/* ---------------------------------------------------------------- reports */

/** Common part of every report; each service's report struct embeds it as `base`. A recorder keeps the last
 *  maxFramesInFlight x maxRecordingsPerFrame reports; older ones that nobody took are dropped with a warning. */
typedef struct GpgpReportHeader {
  GpgpResult status; /**< SUCCESS, BUDGET_EXCEEDED, NOT_EXECUTED; ERROR_UNSUPPORTED: the device ended loops early */
  uint64_t tag;
  uint64_t frame;
} GpgpReportHeader;

/* ---------------------------------------------------------------- objects */

/** VK_TRUE in resident when all data of the asset has been recorded for upload. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetResidency(GpgpAsset asset, VkBool32* resident);

/** Destroying is always legal: memory that a frame in flight may read is freed by the gpgpAdvance that says it is
 *  safe. An asset, recorder or view handle is invalid from here on. NULL is ignored. @threads context */
GPGP_API void GPGP_CALL gpgpDestroyAsset(GpgpAsset asset);
GPGP_API void GPGP_CALL gpgpDestroyRecorder(GpgpRecorder recorder);
GPGP_API void GPGP_CALL gpgpDestroyHistory(GpgpHistory history);

typedef struct GpgpServiceMemory {
  VkDeviceSize deviceBytes;      /**< device-local: assets and scratch */
  VkDeviceSize hostVisibleBytes; /**< rings and report buffers */
  VkDeviceSize pendingBytes;     /**< destroyed, waiting for frames to be safe */
  uint64_t hostBytes;            /**< from the host allocator; all of it is counted under GPGP_SERVICE_CORE */
} GpgpServiceMemory;

typedef struct GpgpMemoryReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpServiceMemory services[GPGP_SERVICE_COUNT]; /**< indexed by GpgpService */
  VkDeviceSize blockBytes; /**< allocated from Vulkan by gpgp's own allocator; 0 with engine callbacks */
} GpgpMemoryReport;
#define GPGP_MEMORY_REPORT_INIT GPGP_INIT(GpgpMemoryReport, GPGP_STRUCTURE_MEMORY_REPORT)

/** What gpgp holds now. @threads context */
GPGP_API GpgpResult GPGP_CALL gpgpGetMemoryReport(GpgpContext context, GpgpMemoryReport* report);

/* ---------------------------------------------------------------- bytes from the compilers */

/** Bytes made by libgpgp_compiler. Free with gpgpFreeBlob. */
typedef struct GpgpBlob {
  void* data;
  size_t size;
} GpgpBlob;

/** Frees the bytes and zeroes the struct. In libgpgp_compiler. @threads any */
GPGP_API void GPGP_CALL gpgpFreeBlob(GpgpBlob* blob);

#ifdef __cplusplus
}
#endif
#endif
