/* gpgp visibility: which triangles can be seen, for object-space shading.
 *
 *   geometry set (asset)  meshes as the engine's own buffers describe them: no vertex data is copied
 *   sampler (worker)      samples triangle ids and gathers the visible set; sized by budgets
 *   camera view           remembers what one camera saw, to tell what has changed
 */
#ifndef GPGP_VISIBILITY_H
#define GPGP_VISIBILITY_H
#include <gpgp/core.h>
#ifdef __cplusplus
extern "C" {
#endif

/** One indexed triangle mesh in the engine's vertex and index buffers. */
typedef struct GpgpMesh {
  uint32_t firstIndex;   /**< in indices, from the start of the index buffer range */
  uint32_t indexCount;   /**< a multiple of 3 */
  uint32_t vertexOffset; /**< added to each index */
} GpgpMesh;

typedef struct GpgpGeometrySetCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  const GpgpMesh* meshes;
  uint32_t meshCount;
} GpgpGeometrySetCreateInfo;
#define GPGP_GEOMETRY_SET_CREATE_INFO_INIT GPGP_INIT(GpgpGeometrySetCreateInfo, GPGP_STRUCTURE_GEOMETRY_SET_CREATE_INFO)

/** Checks the mesh table and queues it for upload.
 *  Errors: INVALID_ARGUMENT (mesh index in the message), INVALID_STRUCT, OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGeometrySet(GpgpContext context, const GpgpGeometrySetCreateInfo* info,
                                                    GpgpAsset* geometrySet);

typedef struct GpgpSamplerCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpWorkerCreateInfo base;
  uint32_t maxWidth, maxHeight; /**< viewport, at most 8192 each; 0: 2048. Scratch: 8 bytes a pixel */
  uint32_t maxDraws;            /**< 0: 65536 */
  uint32_t maxTriangles;        /**< of one record, all draws together; 0: 4194304. What is beyond is not sampled and
                                     the report says BUDGET_EXCEEDED. Scratch: 4 bytes a triangle */
  uint32_t methods;             /**< GPGP_SAMPLING_..._BIT of the methods it will be asked for; 0: standard */
  uint32_t maxSamples;    /**< per pixel in each direction, a power of two up to 64; 0: 1. Scratch: 8 bytes each */
  uint32_t maxCandidates; /**< exact: triangles that may be seen, and those that may hide them; 0: a quarter
                               of maxTriangles, at least 65536. Scratch: 64 bytes each */
  uint32_t maxPairs;      /**< exact: of a candidate and a pixel; 0: 4 each and 4 a pixel, as far as the device
                               binds them. Scratch: 24 bytes each */
} GpgpSamplerCreateInfo;
#define GPGP_SAMPLER_CREATE_INFO_INIT GPGP_INIT(GpgpSamplerCreateInfo, GPGP_STRUCTURE_SAMPLER_CREATE_INFO)

/** Makes a worker that samples any geometry set, with scratch for the budgets. Prewarm it before the first record.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets beyond the device), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateSampler(GpgpContext context, const GpgpSamplerCreateInfo* info,
                                                GpgpWorker* sampler);

typedef struct GpgpCameraViewCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  uint32_t maxTriangles; /**< one bit each is allocated; 0: 4194304 */
} GpgpCameraViewCreateInfo;
#define GPGP_CAMERA_VIEW_CREATE_INFO_INIT GPGP_INIT(GpgpCameraViewCreateInfo, GPGP_STRUCTURE_CAMERA_VIEW_CREATE_INFO)

/** Makes the history of one camera: all triangles unseen until its first record. It is ready once a gpgpRecordUpload
 *  has cleared it.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, OUT_OF_..._MEMORY. @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCameraView(GpgpContext context, const GpgpCameraViewCreateInfo* info,
                                                   GpgpView* view);

/** One draw of one mesh. 64 bytes, std430, in a buffer of the engine's. Draws may share triangle numbers: the bit is
 *  then set if any of them is visible. A transform that mirrors does not turn front faces into back faces. */
typedef struct GpgpVisibilityDraw {
  float transform[12];    /**< rows of a 3x4 matrix, object to world */
  uint32_t mesh;          /**< index in the geometry set */
  uint32_t firstTriangle; /**< where this draw's triangles start in the visible bits and lists; a multiple of 32 lets
                               draws be cleared apart */
  uint32_t flags;         /**< GPGP_DRAW_... */
  uint32_t reserved;
} GpgpVisibilityDraw;
#define GPGP_DRAW_TWO_SIDED 1u /**< back faces count as visible */

typedef int32_t GpgpSamplingMethod;
enum {
  GPGP_SAMPLING_STANDARD = 0, /**< a grid of `samples` x `samples` a pixel; 1: its centre */
  GPGP_SAMPLING_EXACT = 1,    /**< standard, and then, among those that it did not find, the triangles with one of
                                   64 x 64 samples a pixel that nothing in front of them covers */
  GPGP_SAMPLING_TRUTH = 2     /**< a grid of `samples` x `samples` and the centre, in slices: for metrics */
};
#define GPGP_SAMPLING_STANDARD_BIT 1u
#define GPGP_SAMPLING_EXACT_BIT 2u
#define GPGP_SAMPLING_TRUTH_BIT 4u

typedef struct GpgpCamera {
  float viewProjection[16]; /**< world to clip, column-major */
  VkBool32 reversedDepth;   /**< near is 1 */
} GpgpCamera;

typedef struct GpgpSampleInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordInfo base;
  GpgpAsset geometrySet;
  GpgpView view; /**< optional: history of this camera; its previous record is what `appeared` compares with */
  GpgpSamplingMethod method;
  GpgpCamera camera;
  uint32_t width, height; /**< viewport, pixels */
  uint32_t samples;     /**< standard, truth: per pixel in each direction, a power of two up to 256; 0: 1 (truth: 64) */
  uint32_t slice;       /**< truth: 0 to n * n, where n = max(samples / maxSamples, 1); the last one is the centre */
  VkBool32 accumulate;  /**< bits and pixel counts are added to, not overwritten: unites slices, views, a view cell */
  GpgpBuffer positions; /**< vertex positions, 3 floats each at positionStride; STORAGE usage */
  uint32_t positionStride; /**< bytes, a multiple of 4; 0: 12 */
  GpgpBuffer indices;      /**< STORAGE usage; size a multiple of 4 for UINT16 too */
  VkIndexType indexType;   /**< UINT16 or UINT32 */
  GpgpBuffer draws;        /**< GpgpVisibilityDraw[drawCount]; STORAGE usage */
  uint32_t drawCount;
  uint32_t triangleCount;  /**< of all draws: one past the last triangle number; at most 2^31 */
  GpgpBuffer visibleBits;  /**< out: one bit per triangle, ceil(triangleCount / 32) words, overwritten */
  GpgpBuffer pixelCounts;  /**< out, optional: uint32_t per triangle: samples that show it (exact: centres) */
  GpgpBuffer visibleList;  /**< out, optional: uint32_t triangle numbers, compact, in no stated order; its size is the
                                budget */
  GpgpBuffer visibleCount; /**< out, optional: uint32_t[4]: needed, then a VkDispatchIndirectCommand with one workgroup
                                of 64 per 64 listed triangles, in rows of 65535 (workgroup y * 65535 + x; the last row
                                may run past the list); STORAGE usage */
} GpgpSampleInfo;
#define GPGP_SAMPLE_INFO_INIT GPGP_INIT(GpgpSampleInfo, GPGP_STRUCTURE_SAMPLE_INFO)

/** Samples triangle ids and gathers the visible set. Where two triangles have the same depth the lower number wins.
 *  Draws, meshes and indices that name what is not there, and coordinates that are not finite or reach 2^100, are
 *  skipped and counted. Without draws the geometry buffers may be left out; without triangles the bits too.
 *  NOT_READY: geometry set or view not resident, or sampler not prewarmed.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareVisibility(GpgpWorker sampler, VkCommandBuffer commandBuffer,
                                                          const GpgpFrame* frame, const GpgpSampleInfo* info);

typedef struct GpgpSampleReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t triangles;        /**< in front of the near plane, in the viewport, facing the camera */
  uint32_t visible;          /**< in the bits */
  uint32_t listed;           /**< written to the list */
  uint32_t coveredPixels;    /**< samples that show a triangle (exact: centres) */
  uint32_t appeared;         /**< with a view: visible now, not in its previous record */
  uint32_t disappeared;      /**< with a view: the reverse */
  uint32_t neededTriangles;  /**< of all draws, whatever the budget */
  uint32_t skippedTriangles; /**< index or triangle number out of range, coordinate not finite or too large */
  uint32_t skippedDraws;     /**< of a mesh that is not in the geometry set */
  uint32_t neededCandidates; /**< exact: at least, where there is too little room */
  uint32_t neededPairs;
  uint32_t unresolved; /**< exact: triangles and pairs without room; the triangles are reported visible */
} GpgpSampleReport;
#define GPGP_SAMPLE_REPORT_INIT GPGP_INIT(GpgpSampleReport, GPGP_STRUCTURE_SAMPLE_REPORT)

/** The oldest report not yet taken. NOT_READY: none. BUDGET_EXCEEDED in base.status: maxTriangles (neededTriangles says
 *  how many there are) or the list (visible says how many). @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetSampleReport(GpgpWorker sampler, GpgpSampleReport* report);

#ifdef __cplusplus
}
#endif
#endif
