/* gpgp core: what the three services spawn, vector and visibility share.
 *
 * An engine gives gpgp its device once (gpgpCreateContext). In each frame it gives gpgp a command buffer in the
 * recording state. gpgp records work into that command buffer and returns. It never submits, waits or presents. It
 * owns no queue and creates no thread.
 *
 * Objects (the end of this header explains more words):
 *   asset      input that recorders share: a grammar, drawing, glyph set or geometry set. Only glyph sets change later
 *   recorder   pipelines, scratch memory and fixed budgets for one kind of work: a spawner, canvas, visibility recorder
 *   list       shapes, images, text and drawings that the engine fills in every frame or keeps, in host memory (ui.h)
 *   history    what one camera or canvas keeps from one recording to the next
 *
 * A recording is one gpgpRecord... call and the commands that it recorded. A report holds what the GPU counted while
 * a recording executed. The report can be read once the frame of the recording is safe (GpgpFrame).
 *
 * A frame:
 *   gpgpAdvance(context, &frame)                        once: frees and reuses memory, collects reports
 *   gpgpRecordUpload(context, cmd, &frame, bytes, ...)  copies pending asset data to the device
 *   gpgpRecordPrepare...(recorder, cmd, &frame, &info)  outside render passes: the compute work
 *   gpgpRecordDraw...(recorder, cmd, &frame, &info)     inside the engine's render pass, for recorders that draw
 *
 * Conventions of all services:
 *   object and world space   right-handed, +Y up, 1 unit = 1 metre; counter-clockwise triangles face the viewer
 *   drawing space            +X right, +Y down, 1 unit = 1 CSS pixel, as in SVG
 *   pixel space              +X right, +Y down; pixel (x, y) covers [x, x+1) x [y, y+1)
 *   clip space               Vulkan's: +Y down, depth 0 (near) to 1 (far) unless a struct says that it is reversed
 *   matrices                 column-major, for column vectors: clip = viewProjection * world * position
 *   colour                   linear, premultiplied alpha, unless a field names another encoding
 *
 * Documentation tags of functions:
 *   @threads any      May be called from any thread at any time.
 *   @threads context  One thread at a time per context. Other threads may record with recorders of the context
 *                     meanwhile, but not use an object that is being destroyed. gpgpAdvance excludes recordings and
 *                     report queries as well.
 *   @threads handle   One thread at a time per handle, the one that the function names first. Calls for different
 *                     handles may run at the same time.
 *   @lifetime call    Pointers are read during the call only.
 *   @lifetime frame   The named objects must exist until the frame of the call is safe.
 *   @lifetime handle  The named objects must exist until the handle is destroyed.
 *   @pass             Where the command buffer must be: outside a render pass, inside one, or any (either).
 *   @state            The command-buffer state that differs after the call.
 *
 * Errors are negative values of GpgpResult. A function that returns an error has changed nothing and recorded nothing.
 * It has sent one message to the callback of its create info or of its first handle's context, if there is a callback.
 *
 * This header includes vulkan_core.h for the handle types. No other Vulkan header has to come first.
 */
#ifndef GPGP_CORE_H
#define GPGP_CORE_H

#include <gpgp/structure_types.h>
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

/** Returns the version of the loaded library, encoded by GPGP_MAKE_VERSION. The library is compatible with this header
 *  if the major versions are equal. While the major version is 0, the minor versions must be equal as well.
 *  @threads any */
GPGP_API uint32_t GPGP_CALL gpgpGetVersion(void);

/* ---------------------------------------------------------------- results and messages */

typedef int32_t GpgpResult; /**< One of the values below. */
enum {
  GPGP_SUCCESS = 0,

  /* Statuses are positive. Nothing is wrong, and no message is sent. */

  /** An asset or history is not resident, a pipeline has not been prewarmed, or no report is ready. */
  GPGP_NOT_READY = 1,
  /** In reports: a budget was too small. The report says how much was needed. What was written is valid. */
  GPGP_BUDGET_EXCEEDED = 2,
  /** In reports: the GPU never executed the command buffer. */
  GPGP_NOT_EXECUTED = 3,
  /** An array or byte range was too small. What fits was written, and the returned count or size is what is needed. */
  GPGP_INCOMPLETE = 4,
  /** The engine ended the call early. */
  GPGP_CANCELLED = 5,

  /* Errors are negative. Nothing was changed, and a message says why. */

  GPGP_ERROR_INVALID_ARGUMENT = -1,
  GPGP_ERROR_INVALID_STRUCT = -2,  /**< sType is not the expected one, or pNext holds an unexpected struct. */
  GPGP_ERROR_INVALID_HANDLE = -3,  /**< NULL, destroyed, of another kind, or of another context. */
  GPGP_ERROR_MISSING_FEATURE = -4, /**< The device lacks something, or it was not declared. The message names it. */
  GPGP_ERROR_OUT_OF_HOST_MEMORY = -5,
  GPGP_ERROR_OUT_OF_DEVICE_MEMORY = -6,
  GPGP_ERROR_DEVICE_LOST = -7,
  GPGP_ERROR_TOO_MANY_RECORDINGS = -8, /**< maxRecordingsPerFrame or maxFramesInFlight is used up. */
  GPGP_ERROR_INVALID_DATA = -9,        /**< Bytes or text with a wrong magic, version, checksum or content. */
  GPGP_ERROR_UNSUPPORTED = -10,        /**< The input is valid, but this build or device cannot handle it. */
  GPGP_ERROR_IO = -11,                 /**< A file could not be read. */
  GPGP_ERROR_VULKAN = -12              /**< Vulkan returned another error. The message holds its code. */
};

/** Returns the name of a result as it is spelled in this header, or "GPGP_UNKNOWN". The string is static.
 *  @threads any */
GPGP_API const char* GPGP_CALL gpgpResultString(GpgpResult result);

typedef int32_t GpgpSeverity;
enum { GPGP_SEVERITY_INFO = 0, GPGP_SEVERITY_WARNING = 1, GPGP_SEVERITY_ERROR = 2 };

typedef struct GpgpMessage {
  GpgpSeverity severity;
  GpgpResult code;
  const char* function; /**< The API function, for example "gpgpCreateSpawner". */
  const char* label;    /**< The label of the object concerned, or "". */
  const char* text;     /**< One sentence that names the argument and what was expected. */
} GpgpMessage;

/** Receives messages on the thread that called gpgp, so several threads may call it at the same time. The callback must
 *  not call gpgp. @lifetime call */
typedef void(GPGP_CALL* GpgpMessageFn)(void* userData, const GpgpMessage* message);

/* ---------------------------------------------------------------- handles */

typedef struct GpgpContext_T* GpgpContext;
typedef struct GpgpAsset_T* GpgpAsset;       /**< A grammar, drawing, glyph set or geometry set. */
typedef struct GpgpRecorder_T* GpgpRecorder; /**< A spawner, canvas or visibility recorder. */
typedef struct GpgpHistory_T* GpgpHistory;   /**< The history of one camera or canvas, or a tile set. */

typedef int32_t GpgpService;
enum { GPGP_SERVICE_CORE = 0, GPGP_SERVICE_SPAWN = 1, GPGP_SERVICE_VECTOR = 2, GPGP_SERVICE_VISIBILITY = 3 };
#define GPGP_SERVICE_COUNT 4

/* ---------------------------------------------------------------- device requirements and features */

typedef uint64_t GpgpFeatures;
/* The features that the engine enabled on its device. Vulkan has no query for them, so the engine declares them in
 * GpgpContextCreateInfo::features. */
#define GPGP_FEATURE_DYNAMIC_RENDERING ((GpgpFeatures)1 << 0)
#define GPGP_FEATURE_BUFFER_INT64_ATOMICS ((GpgpFeatures)1 << 1) /**< shaderBufferInt64Atomics, shaderInt64 */
#define GPGP_FEATURE_MULTIVIEW ((GpgpFeatures)1 << 2)
#define GPGP_FEATURE_DEBUG_UTILS ((GpgpFeatures)1 << 3) /**< VK_EXT_debug_utils on the instance: names, labels */
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
  uint32_t apiVersion;           /**< The lowest Vulkan version, of the instance and of the device: 1.2. */
  GpgpFeatures requiredFeatures; /**< Always 0, since the baseline is Vulkan 1.2 without optional features. */
  GpgpFeatures optionalFeatures; /**< Features that the device offers and gpgp would use. */
  VkQueueFlags queueFlags;       /**< Every recorder's queue family needs these. Drawing needs GRAPHICS as well. */
  const char* const* extensions; /**< Device extensions that optionalFeatures need. The strings are static. */
  uint32_t extensionCount;
  /** Enables optionalFeatures. Chain it to VkDeviceCreateInfo::pNext, or merge it into the engine's own structs. Its
   *  pNext chain points into this GpgpRequirements, so do not copy the struct. */
  VkPhysicalDeviceFeatures2 features;
  VkPhysicalDeviceVulkan11Features features11;
  VkPhysicalDeviceVulkan12Features features12;
  VkPhysicalDeviceDynamicRenderingFeatures dynamicRendering;
  uint32_t missingCount;   /**< 0 if the device can run gpgp. */
  const char* missing[16]; /**< Each missing item by name and needed value. The strings are static. */
} GpgpRequirements;
#define GPGP_REQUIREMENTS_INIT GPGP_INIT(GpgpRequirements, GPGP_STRUCTURE_REQUIREMENTS)

/** Tells what gpgp needs from a physical device and which optional features it would use. Call it before creating the
 *  device; no context is needed. If the device lacks something, the function returns GPGP_ERROR_MISSING_FEATURE and
 *  fills the struct all the same. Returned strings are static. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetRequirements(const GpgpRequirementsInfo* info, GpgpRequirements* requirements);

/* ---------------------------------------------------------------- callbacks of the engine */

/** Allocates host memory. allocate returns NULL on failure. The alignment is a power of two. All host memory of libgpgp
 *  comes from these callbacks; blobs of libgpgp_compiler do not. Threads that call gpgp and threads of the job system
 *  call them, possibly at the same time. */
typedef struct GpgpHostAllocator {
  void* userData;
  void*(GPGP_CALL* allocate)(void* userData, size_t size, size_t alignment);
  void(GPGP_CALL* free)(void* userData, void* memory, size_t size, size_t alignment);
} GpgpHostAllocator;

/** A range of device memory. */
typedef struct GpgpGpuAllocation {
  VkDeviceMemory memory;
  VkDeviceSize offset; /**< In bytes, aligned as the request says. */
  /** Host address of the byte at offset. A request that requires HOST_VISIBLE memory needs it, and the memory must stay
   *  mapped until it is freed. Other requests ignore it. */
  void* mapped;
  void* userData; /**< The engine's own value, passed back to free. */
} GpgpGpuAllocation;

typedef struct GpgpGpuAllocationRequest {
  VkMemoryRequirements requirements;
  VkMemoryPropertyFlags required;  /**< Properties that the memory type must have. */
  VkMemoryPropertyFlags preferred; /**< Properties that it should have as well. */
  GpgpService service;             /**< The service that the memory is for. */
  const char* label;               /**< What the memory is for. */
} GpgpGpuAllocationRequest;

/** Allocates device memory. allocate returns VK_SUCCESS or an error. gpgp never calls it while recording. Calls for one
 *  context never overlap, but any thread that creates objects may make them. Without these callbacks gpgp sub-allocates
 *  from its own blocks: 4 MiB for the first of a memory type, then 32 MiB, or as much as a larger request needs. */
typedef struct GpgpGpuAllocator {
  void* userData;
  VkResult(GPGP_CALL* allocate)(void* userData, const GpgpGpuAllocationRequest* request, GpgpGpuAllocation* allocation);
  void(GPGP_CALL* free)(void* userData, const GpgpGpuAllocation* allocation);
} GpgpGpuAllocator;

/** One of the jobs that GpgpJobSystem::parallelFor runs. */
typedef void(GPGP_CALL* GpgpJobFn)(void* argument, uint32_t index);

/** The engine's job system. gpgpPrewarm and the conversion of paths and glyphs call it, on the thread that called them.
 *  Without it they do all work on that thread. */
typedef struct GpgpJobSystem {
  void* userData;
  /** Runs job(argument, i) for every i in [0, count), on any threads, and returns when all jobs have ended. */
  void(GPGP_CALL* parallelFor)(void* userData, uint32_t count, GpgpJobFn job, void* argument);
} GpgpJobSystem;

/** Reads the engine's files. Several threads that create assets may call it at the same time. read sets size to the
 *  size of the file and returns GPGP_SUCCESS. If data is not NULL, it copies at most capacity bytes of the file there.
 *  gpgp calls it twice for a file: for the size, then for the data. */
typedef struct GpgpFileSystem {
  void* userData;
  GpgpResult(GPGP_CALL* read)(void* userData, const char* path, void* data, size_t capacity, size_t* size);
} GpgpFileSystem;

/* ---------------------------------------------------------------- context */

typedef struct GpgpContextCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label; /**< For messages and debug names. The string is copied. */
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  uint32_t apiVersion;            /**< The version that instance and device were created with. 0: Vulkan 1.2. */
  GpgpFeatures features;          /**< The features that the engine enabled on the device. */
  uint32_t maxFramesInFlight;     /**< 1 to 8. 0: 3. */
  uint32_t maxRecordingsPerFrame; /**< Recordings per frame, for each recorder. At most 4096. 0: 16. */
  VkDeviceSize uploadRingBytes;   /**< Staging memory for gpgpRecordUpload, for all frames together. 0: 8 MiB. */
  VkPipelineCache pipelineCache;  /**< The engine's cache for all pipelines, or VK_NULL_HANDLE for one of gpgp's own. */
  /** Optional. Initial data of gpgp's own cache, from gpgpGetPipelineCacheData. Data of another device or driver is
   *  ignored, with an INFO message. */
  const void* pipelineCacheData;
  size_t pipelineCacheSize;               /**< Bytes of pipelineCacheData. */
  const GpgpHostAllocator* hostAllocator; /**< NULL: the C++ heap. The struct is copied. */
  const GpgpGpuAllocator* gpuAllocator;   /**< NULL: blocks of gpgp's own. The struct is copied. */
  const GpgpJobSystem* jobSystem;         /**< NULL: all work runs on the calling thread. The struct is copied. */
  const GpgpFileSystem* fileSystem;       /**< NULL: the C library reads files. The struct is copied. */
  GpgpMessageFn messageFn;                /**< NULL: messages are dropped. */
  void* messageUserData;
} GpgpContextCreateInfo;
#define GPGP_CONTEXT_CREATE_INFO_INIT GPGP_INIT(GpgpContextCreateInfo, GPGP_STRUCTURE_CONTEXT_CREATE_INFO)

/** Creates a context on the engine's device. Several contexts may exist at the same time, on one or more devices.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, MISSING_FEATURE, OUT_OF_..._MEMORY, VULKAN.
 *  @threads any @lifetime call; instance, device, pipelineCache and what callbacks use: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateContext(const GpgpContextCreateInfo* info, GpgpContext* context);

/** Destroys the context and everything that was created from it, at once. No recording of gpgp may be pending or
 *  executing on the device, unless the device is lost. NULL is ignored. @threads context */
GPGP_API void GPGP_CALL gpgpDestroyContext(GpgpContext context);

/** The engine's place in time. Frame numbers never decrease. A frame is safe when everything recorded in it has
 *  finished on all queues, or was dropped and will never be submitted. current - safe is at most maxFramesInFlight. */
typedef struct GpgpFrame {
  uint64_t current; /**< The frame that is being recorded. Greater than safe. */
  uint64_t safe;    /**< The newest safe frame. All older frames are safe too. */
} GpgpFrame;

/** Begins a frame. For all frames that are now safe, it frees destroyed objects, collects reports, and makes staging
 *  memory and descriptor sets ready for reuse. Apart from destroying the context and the loss of the device, nothing
 *  else does this. Call it once a frame, before the recordings of the frame. All recordings of the frame are given this
 *  same GpgpFrame.
 *  Errors: INVALID_HANDLE, INVALID_ARGUMENT, DEVICE_LOST.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAdvance(GpgpContext context, const GpgpFrame* frame);

/** Tells gpgp that the device is lost. From then on, functions that create, record or advance return
 *  GPGP_ERROR_DEVICE_LOST. No further report becomes ready. Destroying objects stays legal and frees them at once.
 *  @threads context */
GPGP_API void GPGP_CALL gpgpNotifyDeviceLost(GpgpContext context);

/** Records copies of pending asset data into device memory, oldest asset first, and clears of new histories. It records
 *  transfer commands and one barrier, or nothing if nothing is pending. The barrier makes the data visible to all later
 *  recordings on the same queue. The engine synchronises recordings on other queues.
 *    byteBudget     copies at most this many bytes, but at least 16; 0: as many as staging memory has room for.
 *                   Clears do not count
 *    pendingBytes   receives the number of bytes that are still pending; may be NULL
 *  Errors: INVALID_HANDLE, INVALID_ARGUMENT, TOO_MANY_RECORDINGS, DEVICE_LOST.
 *  @threads context @lifetime call @pass outside @state none */
GPGP_API GpgpResult GPGP_CALL gpgpRecordUpload(GpgpContext context, VkCommandBuffer commandBuffer,
                                               const GpgpFrame* frame, VkDeviceSize byteBudget,
                                               VkDeviceSize* pendingBytes);

/** Returns the contents of the pipeline cache in use, gpgp's own or the engine's, for the next start of the program.
 *  size is the capacity of data on input and the size of the contents on output. If data is NULL, only the size is
 *  returned. If data is too small, the function returns GPGP_INCOMPLETE and the needed size. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetPipelineCacheData(GpgpContext context, size_t* size, void* data);

/* ---------------------------------------------------------------- resources of the engine */

/** How the engine uses a resource before or after a recording, in the 64-bit flags of synchronization2. Barriers take
 *  32-bit flags, so a flag without a 32-bit equivalent becomes the smallest 32-bit flag that includes it. */
typedef struct GpgpAccess {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout; /**< For images only. */
} GpgpAccess;

typedef uint64_t GpgpAccessMode;
/** The engine places the barriers before and after the recording itself, as a render graph does. `before` and `after`
 *  of all resources are ignored. The resources must be in the state that gpgpGetRecordingAccess returns, and they stay
 *  in it. gpgp still places the barriers between its own passes. */
#define GPGP_ACCESS_EXTERNAL_BARRIERS ((GpgpAccessMode)1 << 0)

typedef struct GpgpBuffer {
  VkBuffer buffer;
  VkDeviceSize offset; /**< In bytes, a multiple of the device's minStorageBufferOffsetAlignment. */
  VkDeviceSize size;   /**< Bytes from offset on that gpgp may use, at most maxStorageBufferRange. */
  GpgpAccess before;   /**< The engine's last use. stages 0: there is nothing to wait for. */
  GpgpAccess after;    /**< The engine's next use. stages 0: the engine places that barrier. */
} GpgpBuffer;

typedef struct GpgpImage {
  VkImage image;
  VkImageView view; /**< A 2D view of one mip level and one array layer. */
  VkFormat format;
  uint32_t mipLevel, arrayLayer; /**< The level and layer of the view. Barriers cover no other part of the image. */
  uint32_t width, height;        /**< The size of that level in pixels. */
  GpgpAccess before;             /**< The engine's last use. Layout UNDEFINED: the contents may be discarded. */
  GpgpAccess after;              /**< The engine's next use. stages 0: the engine places that barrier. */
} GpgpImage;

/* ---------------------------------------------------------------- recorders */

/** The part that the create infos of all recorders have in common, embedded as `base`. */
typedef struct GpgpRecorderCreateInfo {
  const char* label;       /**< For messages and debug names. The string is copied. */
  uint32_t queueFamily;    /**< The family of the queues that all recordings of this recorder are submitted to. */
  VkQueueFlags queueFlags; /**< The flags of that family. 0: gpgp queries the physical device. */
  /** VK_TRUE: gpgp allocates no scratch memory, and each recording supplies it in GpgpRecordingInfo::scratch. */
  VkBool32 engineScratch;
} GpgpRecorderCreateInfo;

/** Something that a recorder draws into. */
typedef struct GpgpTargetInfo {
  GpgpStructureType sType;
  const void* pNext;
  VkRenderPass renderPass;       /**< VK_NULL_HANDLE: dynamic rendering, which needs GPGP_FEATURE_DYNAMIC_RENDERING. */
  uint32_t subpass;              /**< Of renderPass. */
  uint32_t viewMask;             /**< 0, or views 0 and 1 at most, which need GPGP_FEATURE_MULTIVIEW. */
  VkFormat colorFormat;          /**< Dynamic rendering: the format of colour attachment 0. */
  VkFormat depthFormat;          /**< Dynamic rendering: the format of the depth attachment, or VK_FORMAT_UNDEFINED. */
  VkSampleCountFlagBits samples; /**< 0: 1 sample. */
  VkBool32 depthTest;            /**< VK_TRUE: tests the bound depth attachment. gpgp never writes depth. */
  VkCompareOp depthCompare;      /**< Used with depthTest. */
} GpgpTargetInfo;
#define GPGP_TARGET_INFO_INIT GPGP_INIT(GpgpTargetInfo, GPGP_STRUCTURE_TARGET_INFO)

typedef struct GpgpPrewarmInfo {
  GpgpStructureType sType;
  const void* pNext;
  const GpgpTargetInfo* targets; /**< For recorders that draw: every target that they will draw into. */
  uint32_t targetCount;          /**< At most 16 different targets for a recorder, counted over all calls. */
} GpgpPrewarmInfo;
#define GPGP_PREWARM_INFO_INIT GPGP_INIT(GpgpPrewarmInfo, GPGP_STRUCTURE_PREWARM_INFO)

/** Compiles the recorder's pipelines, on the calling thread or through the job system. Until it has returned, recording
 *  returns GPGP_NOT_READY and records nothing. info may be NULL for recorders that do not draw. Other recorders may
 *  record at the same time.
 *  Errors: INVALID_HANDLE, INVALID_ARGUMENT, INVALID_STRUCT, MISSING_FEATURE, UNSUPPORTED, OUT_OF_..._MEMORY,
 *  DEVICE_LOST, VULKAN.
 *  @threads handle @lifetime call; render passes: handle */
GPGP_API GpgpResult GPGP_CALL gpgpPrewarm(GpgpRecorder recorder, const GpgpPrewarmInfo* info);

/** Returns how much scratch memory one recording of this recorder needs, in bytes, the alignment of its offset, and the
 *  usage flags that the engine's buffer must have. alignment and usage may be NULL. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetScratchSize(GpgpRecorder recorder, VkDeviceSize* size, VkDeviceSize* alignment,
                                                 VkBufferUsageFlags* usage);

/** Lists the passes of this recorder's recordings in order, including those that a recording may omit. count is the
 *  capacity of names on input and the number of passes on output. If names is NULL, only the count is returned. If
 *  names is too small, the function fills it and returns GPGP_INCOMPLETE. @threads any @lifetime call; names: handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetPasses(GpgpRecorder recorder, uint32_t* count, const char** names);

/** A pipeline of a recorder. */
typedef struct GpgpPipelineInfo {
  const char* name;   /**< Of the compute shader, or "draw". */
  uint32_t codeBytes; /**< SPIR-V of its shaders, in bytes. */
  float milliseconds; /**< How long Vulkan took to make it, on one thread; 0 before gpgpPrewarm. */
} GpgpPipelineInfo;

/** Lists the recorder's pipelines and what they cost: one for each compute shader, then those of each target that was
 *  prewarmed. count and pipelines are used as in gpgpGetPasses. A pipeline that the driver found in a cache costs
 * little.
 *  @threads handle @lifetime call; names: handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetPipelines(GpgpRecorder recorder, uint32_t* count, GpgpPipelineInfo* pipelines);

/** GPU timestamps of a recording. gpgp writes query firstQuery at the start and one query after each pass, omitted
 *  passes included: one more than gpgpGetPasses counts. The engine resets the queries before and reads them after. */
typedef struct GpgpTimestamps {
  VkQueryPool queryPool; /**< VK_NULL_HANDLE: no timestamps. */
  uint32_t firstQuery;
  uint32_t queryCount; /**< At least the number of passes + 1. */
} GpgpTimestamps;

/** Returns the access that buffers and images must have before a recording with GPGP_ACCESS_EXTERNAL_BARRIERS, and that
 *  they have after it. Either pointer may be NULL. @threads any */
GPGP_API void GPGP_CALL gpgpGetRecordingAccess(GpgpAccess* buffer, GpgpAccess* image);

/** The part that the infos of all recordings have in common, embedded as `base`. */
typedef struct GpgpRecordingInfo {
  uint64_t tag;       /**< The engine's own number. The report returns it. */
  GpgpBuffer scratch; /**< For recorders with engineScratch. Its contents are undefined before and after. */
  GpgpTimestamps timestamps;
  GpgpAccessMode accessMode;
} GpgpRecordingInfo;

/* ---------------------------------------------------------------- reports */

/** The part that all reports have in common, embedded as `base`. A recorder keeps the newest maxFramesInFlight x
 *  maxRecordingsPerFrame reports. When there are more, the oldest are dropped with a warning. */
typedef struct GpgpReportHeader {
  /** SUCCESS, BUDGET_EXCEEDED or NOT_EXECUTED. ERROR_UNSUPPORTED means that a software device ended loops of a shader
   *  early, so that the results are wrong. */
  GpgpResult status;
  uint64_t tag;   /**< GpgpRecordingInfo::tag. */
  uint64_t frame; /**< GpgpFrame::current of the recording. */
} GpgpReportHeader;

/* ---------------------------------------------------------------- objects */

/** Tells whether an asset is resident: whether gpgpRecordUpload has recorded the copies of all its data. Recordings
 *  that use the asset must be submitted after that command buffer. If that command buffer is never submitted, the asset
 *  is no longer resident once its frame is safe. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetResidency(GpgpAsset asset, VkBool32* resident);

/** Destroys an asset, a recorder or a history. This is legal at any time: memory that a frame in flight may use is
 *  freed by the gpgpAdvance that makes the frame safe. The handle is invalid when the function returns. NULL is
 *  ignored.
 *  @threads context */
GPGP_API void GPGP_CALL gpgpDestroyAsset(GpgpAsset asset);
GPGP_API void GPGP_CALL gpgpDestroyRecorder(GpgpRecorder recorder);
GPGP_API void GPGP_CALL gpgpDestroyHistory(GpgpHistory history);

typedef struct GpgpServiceMemory {
  VkDeviceSize deviceBytes;      /**< Device-local memory: assets, histories and scratch. */
  VkDeviceSize hostVisibleBytes; /**< Memory that the host maps: staging, constants and reports. */
  VkDeviceSize pendingBytes;     /**< Memory of destroyed objects that waits for frames to be safe. */
  uint64_t hostBytes;            /**< Host memory. All of it is counted under GPGP_SERVICE_CORE. */
} GpgpServiceMemory;

typedef struct GpgpMemoryReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpServiceMemory services[GPGP_SERVICE_COUNT]; /**< Indexed by GpgpService. */
  VkDeviceSize blockBytes; /**< Memory that gpgp's own allocator took from Vulkan. 0 with GpgpGpuAllocator. */
} GpgpMemoryReport;
#define GPGP_MEMORY_REPORT_INIT GPGP_INIT(GpgpMemoryReport, GPGP_STRUCTURE_MEMORY_REPORT)

/** Returns how much memory gpgp holds now. @threads context */
GPGP_API GpgpResult GPGP_CALL gpgpGetMemoryReport(GpgpContext context, GpgpMemoryReport* report);

/* ---------------------------------------------------------------- bytes from the compilers */

/** Bytes that a function of libgpgp_compiler returned. Free them with gpgpFreeBlob. */
typedef struct GpgpBlob {
  void* data;
  size_t size;
} GpgpBlob;

/** Frees the bytes and zeroes the struct. NULL is ignored. In libgpgp_compiler. @threads any */
GPGP_API void GPGP_CALL gpgpFreeBlob(GpgpBlob* blob);

#ifdef __cplusplus
}
#endif

/* ---------------------------------------------------------------- words
 *
 *   software device    A device of type VK_PHYSICAL_DEVICE_TYPE_CPU, such as lavapipe.
 *   pass               One dispatch or fill of a recording (gpgpGetPasses). The tag @pass is about render passes.
 *   in flight          Recorded, and the frame is not safe yet. A recorder can have maxFramesInFlight x
 *                      maxRecordingsPerFrame recordings in flight.
 *   target             Of gpgpRecordDraw...: a render pass and the formats of its attachments (GpgpTargetInfo). Of
 *                      gpgpRecordPrepareCanvas: the storage image that the canvas writes (GpgpCanvasInfo::target).
 *   canvas history     The prepared picture of a canvas, to be drawn in a render pass.
 *   camera history     The bits of the triangles that were visible in the camera's last recording. Neither kind of
 *                      history has anything to do with temporal anti-aliasing.
 *   samples            Of attachments and canvases: samples per pixel. Of visibility: samples per pixel and direction.
 *   clip               A region outside of which nothing shows (GpgpPathGroup::clip, gpgpPushClip). Clip space is
 *                      Vulkan's: homogeneous, before the division by w. GpgpCanvasDrawInfo::clip is a matrix to it.
 *   drawing            An asset made of paths.
 *   item               One thing that a canvas shows in a recording: a drawing, a text or a list (GpgpCanvasItem).
 */
#endif
