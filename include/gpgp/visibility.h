/* gpgp visibility: which triangles can be seen, for object-space shading.
 *
 *   geometry set (asset)  meshes as the engine's own buffers describe them: no vertex data is copied
 *   recorder (recorder)      samples triangle ids and gathers the visible set; sized by budgets
 *   camera history           remembers what one camera saw, to tell what has changed
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
 *  Errors: INVALID_ARGUMENT (mesh index in the message), UNSUPPORTED (16 bytes a mesh are more than the device binds),
 *  INVALID_STRUCT, OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGeometrySet(GpgpContext context, const GpgpGeometrySetCreateInfo* info,
                                                    GpgpAsset* geometrySet);

/** An order of a mesh's triangles in which those that follow one another face one way and lie near each other, so that
 *  clusters of them (GpgpVisibilityInfo::clusters) are left out where they face away: of closed meshes nearly half.
 *  order[i], of indexCount / 3: the number of the triangle that is to be the i-th. For when meshes are built; an engine
 *  that keeps data by triangle number moves it likewise. positions: three floats each, positionStride bytes apart.
 *  Errors: INVALID_ARGUMENT (an index out of range is in the message). @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpOrderTriangles(const float* positions, uint32_t positionStride, uint32_t vertexCount,
                                                 const uint32_t* indices, uint32_t indexCount, uint32_t* order);

typedef struct GpgpVisibilityRecorderCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  uint32_t maxWidth, maxHeight; /**< viewport, at most 8192 each; 0: 2048. Scratch: 8 bytes a pixel and camera
                                     (conservative: 52; exact: 16 and a fifth) */
  uint32_t maxCameras;          /**< of one record, at most 128; 0: 1 */
  uint32_t maxDraws;            /**< of all cameras together; 0: 65536. Scratch: 56 bytes each */
  uint32_t maxTriangles;        /**< of one record, all draws and cameras together, at most 2^30; 0: 4194304. What is
                                     beyond is not sampled and the report says BUDGET_EXCEEDED. Scratch: 4 bytes a
                                     triangle (exact: 8, or 4 a pair if that is more), and 8 for each 64 */
  uint32_t methods;             /**< GPGP_SAMPLING_..._BIT of the methods it will be asked for; 0: standard */
  uint32_t maxSamples;    /**< per pixel in each direction, a power of two up to 64; 0: 1. Scratch: the 8 bytes a pixel
                               for each of its samples */
  uint32_t maxCandidates; /**< exact: triangles that may be seen, and those that may hide them; 0: a quarter
                               of maxTriangles, at least 65536. Scratch: 64 bytes each */
  uint32_t maxPairs;      /**< exact: of a candidate and a pixel; 0: 4 each and 4 a pixel, as far as the device
                               binds them; and half as many of a candidate and 8 x 8 pixels. Scratch: 8 bytes
                               each, and see maxTriangles */
} GpgpVisibilityRecorderCreateInfo;
#define GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT                                                                      \
  GPGP_INIT(GpgpVisibilityRecorderCreateInfo, GPGP_STRUCTURE_VISIBILITY_RECORDER_CREATE_INFO)

/** Makes a recorder that samples any geometry set, with scratch for the budgets. Prewarm it before the first record.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets beyond the device), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateVisibilityRecorder(GpgpContext context,
                                                           const GpgpVisibilityRecorderCreateInfo* info,
                                                           GpgpRecorder* recorder);

typedef struct GpgpCameraHistoryCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  uint32_t maxTriangles; /**< at most 2^31; one bit each is allocated; 0: 4194304 */
} GpgpCameraHistoryCreateInfo;
#define GPGP_CAMERA_HISTORY_CREATE_INFO_INIT                                                                           \
  GPGP_INIT(GpgpCameraHistoryCreateInfo, GPGP_STRUCTURE_CAMERA_HISTORY_CREATE_INFO)

/** Makes the history of one camera: all triangles unseen until its first record. It is ready once a gpgpRecordUpload
 *  has cleared it.
 *  Errors: INVALID_ARGUMENT, UNSUPPORTED (its bits are more than the device binds), INVALID_STRUCT, OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCameraHistory(GpgpContext context, const GpgpCameraHistoryCreateInfo* info,
                                                      GpgpHistory* history);

/** One draw of one mesh. 64 bytes, std430, in a buffer of the engine's. Draws may share triangle numbers: the bit is
 *  then set if any of them is visible. A transform that mirrors, by a determinant of at most -2^-126, does not turn
 *  front faces into back faces. */
typedef struct GpgpVisibilityDraw {
  float transform[12];    /**< rows of a 3x4 matrix, object to world */
  uint32_t mesh;          /**< index in the geometry set */
  uint32_t firstTriangle; /**< where this draw's triangles start in the visible bits and lists; a multiple of 32 lets
                               draws be cleared apart */
  uint32_t flags;         /**< GPGP_DRAW_... */
  uint32_t origin; /**< with GpgpVisibilityInfo::origins: index of the one that transform is relative to. Triangles
                        of a draw whose index is out of range are skipped and counted; without origins it is
                        not read */
} GpgpVisibilityDraw;
#define GPGP_DRAW_TWO_SIDED 1u /**< back faces count as visible */
#define GPGP_DRAW_CLOCKWISE                                                                                            \
  2u /**< the front is where the corners are clockwise as seen; so only back faces are seen of                         \
          a mesh whose front is not. Engines whose mirrored draws turn their faces set it                              \
          for those */

typedef int32_t GpgpSamplingMethod;
enum {
  GPGP_SAMPLING_STANDARD = 0,     /**< a grid of `samples` x `samples` a pixel; 1: its centre */
  GPGP_SAMPLING_EXACT = 1,        /**< standard, and then, among those that it did not find, the triangles with one of
                                       64 x 64 samples a pixel that nothing in front of them covers */
  GPGP_SAMPLING_REFERENCE = 2,    /**< a grid of `samples` x `samples` and the centre, in slices: for metrics */
  GPGP_SAMPLING_CONSERVATIVE = 3, /**< the thesis's (6.1.3): a pixel's centre, and then the triangles that touch a pixel
                                      and come near what was found there, by `heuristics` */
  GPGP_SAMPLING_NEARBY = 4 /**< a pixel's centre, and then what may be seen from up to `reach` away: several times as
                                many triangles as can be seen, for further records of a view cell, which find those.
                                Perspective cameras */
};
#define GPGP_SAMPLING_STANDARD_BIT 1u
#define GPGP_SAMPLING_EXACT_BIT 2u
#define GPGP_SAMPLING_REFERENCE_BIT 4u
#define GPGP_SAMPLING_CONSERVATIVE_BIT 8u
#define GPGP_SAMPLING_NEARBY_BIT 16u

/** What the conservative method asks of a triangle that touches a pixel; with none of these every one is visible.
 *  IN_CIRCLE: its in-circle's radius is at most a pixel (6.1).
 *  DEPTH: its depths in the pixel are less than epsilon from those of the triangle found at the pixel's centre; where
 *  none was found it is not visible (6.2 to 6.4).
 *  KEEP_FRONT, with DEPTH: what lies in front, or before the background, is kept. Not in the thesis; finds wires and
 *  leaves. */
#define GPGP_HEURISTIC_IN_CIRCLE 1u
#define GPGP_HEURISTIC_DEPTH 2u
#define GPGP_HEURISTIC_KEEP_FRONT 4u
#define GPGP_HEURISTICS_DEFAULT (GPGP_HEURISTIC_IN_CIRCLE | GPGP_HEURISTIC_DEPTH)

/** Near and far planes are the projection's; the far one may be infinitely far. Clip space is Vulkan's, y down: an
 *  engine whose viewports have a negative height negates the matrix' second row.
 *  Floats are 8 mm apart 10^5 m from the world's origin. A large world gives each camera an origin near it, usually its
 *  place, and each draw one near it (GpgpVisibilityInfo::origins): then floats hold only what is relative to them. */
typedef struct GpgpCamera {
  float viewProjection[16]; /**< world, less origin, to clip; column-major */
  VkBool32 reversedDepth;   /**< near is 1 */
  double origin[3];         /**< a place in the world, less than 1e30 in magnitude; 0, 0, 0: the world's */
} GpgpCamera;

/** A region that a viewer may be in until the next record: a camera in its middle and those around it. What the union
 * of their records shows is what may be seen from there (6.3.5). */
typedef struct GpgpViewCellInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpCamera camera;      /**< of the middle; perspective or parallel */
  uint32_t columns, rows; /**< a grid of so many pixels, 1 to 64 each, with the middle in its centre (figure 6.13); 0:
                             no grid */
  uint32_t skip;          /**< every so many pixels' view point is taken; 0: 1 */
  uint32_t height;        /**< of the viewport, in pixels */
  float distance;      /**< of the grid: along the view, in clip space's w: by one of its pixels what lies there moves
                            by one pixel */
  const float* points; /**< more view points: 3 floats each, in world units along the camera's right, its up and
                            back towards the viewer, from the middle. Finite */
  uint32_t pointCount;
  uint32_t walkCount; /**< view points in a square across the view, denser towards its border, from where most is seen;
                           at most 1024; 0: none */
  float walkDistance; /**< of the square's sides from its middle, in world units; above 0 where there are such points */
} GpgpViewCellInfo;
#define GPGP_VIEW_CELL_INFO_INIT GPGP_INIT(GpgpViewCellInfo, GPGP_STRUCTURE_VIEW_CELL_INFO)

/** Makes the cameras of a view cell: the middle, the grid row by row, the square's, the points. For a record with
 *  several cameras, or several records that accumulate. cameras may be NULL; *count is what it has room for, and then
 *  how many there are (INCOMPLETE: more than the room; the first ones are written).
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetViewCellCameras(const GpgpViewCellInfo* info, uint32_t* count,
                                                     GpgpCamera* cameras);

/** Projected size of a triangle, of what lies between near and far plane and within three viewports to each side. */
typedef struct GpgpTriangleSize {
  float area;          /**< pixels */
  float width, height; /**< of its box, pixels */
} GpgpTriangleSize;

typedef struct GpgpVisibilityInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  GpgpAsset geometrySet;
  GpgpHistory history; /**< optional: history of this camera; its previous record is what `appeared` compares with */
  GpgpSamplingMethod method;
  GpgpCamera camera;
  const GpgpCamera* moreCameras; /**< of the same viewport size and reversedDepth: a stereo pair's other eye, views of a
                                      cell. A triangle that any of them sees is visible */
  uint32_t moreCameraCount;
  uint32_t width, height; /**< viewport of each camera, pixels */
  uint32_t
      samples; /**< standard, reference: per pixel in each direction, a power of two up to 256; 0: 1 (reference: 64) */
  uint32_t slice;      /**< reference: 0 to n * n, where n = max(samples / maxSamples, 1); the last one is the centre */
  VkBool32 accumulate; /**< bits, pixel counts and sizes are added to, not overwritten: unites slices, views, a view
                            cell */
  float resolution;    /**< conservative: factor of width and height, 0.25 to 1, rounded to whole pixels; 0: 1 */
  uint32_t heuristics; /**< conservative: GPGP_HEURISTIC_... */
  float epsilonStatic; /**< conservative: equation 6.2's, in units of clip space's w: for perspective projections
                            distance along the view; for parallel ones, whose w is 1, of its z */
  float epsilonDynamic;    /**< conservative: times 1 - |cosine| of the two triangles' normals */
  uint32_t refinements;    /**< conservative: at most 4 further passes, each of which shows, in every pixel that visible
                                triangles do not cover at 8 x 8 samples, the nearest one in each quarter that covers such
                                a sample */
  float reach;             /**< nearby: how far from a camera, in units of clip space's w; 0 or more. exact: also shows
                                what a move that far would uncover within a pixel, for views of a cell whose view points
                                lie twice as far apart; 0: nothing more. Above 0: perspective cameras */
  GpgpBuffer positions;    /**< vertex positions; STORAGE usage; size a multiple of 4 for 16-bit formats */
  VkFormat positionFormat; /**< R32G32B32_SFLOAT, R16G16B16_SFLOAT or R16G16B16_SNORM, or the same with A; UNDEFINED:
                                R32G32B32_SFLOAT. Only the first three numbers are read */
  uint32_t positionOffset; /**< bytes from a vertex' begin to its position; a multiple of a number's size */
  uint32_t positionStride; /**< bytes, a multiple of a number's size; 0: three numbers */
  GpgpBuffer indices;      /**< STORAGE usage; size a multiple of 4 for UINT16 too */
  VkIndexType indexType;   /**< UINT16 or UINT32 */
  GpgpBuffer clusters;     /**< optional, not with commands: 48 bytes for each 64 triangles that follow one another in a
                                mesh, the last ones of a mesh too; STORAGE usage. The record writes into it where they
                                are and how they face (with draws; without any it has no positions), and reads none of
                                those that are out of sight or face away. What is found is the same. Worth it where
                                meshes are of more than a few such clusters: see gpgpOrderTriangles */
  VkBool32 keepClusters;   /**< clusters hold what an earlier record wrote there, of this geometry set, these positions
                                and indices. FALSE where any of them may have changed */
  GpgpBuffer draws;        /**< GpgpVisibilityDraw[drawCount]; STORAGE usage */
  uint32_t drawCount;
  const double* origins;  /**< optional: three numbers each, less than 1e30 in magnitude: places in the world, such as
                               the middles of its sectors, that draws' transforms are relative to
                               (GpgpVisibilityDraw::origin). Differences to cameras' are exact to 2^-46 of an origin's
                               magnitude, and to 2^-24 of the difference */
  uint32_t originCount;   /**< at most 32; 0: draws' transforms are relative to the world's */
  GpgpBuffer commands;    /**< optional: the engine's VkDrawIndexedIndirectCommand[commandCount]; STORAGE usage. Then
                               what is drawn are the commands' instances: instance i of a command is of its indices,
                               and has the transform, flags and triangle numbers of draws[firstInstance + i], whose
                               `mesh` is not read. Instances beyond `draws` are skipped and counted */
  uint32_t commandCount;  /**< at most */
  uint32_t commandStride; /**< bytes, a multiple of 4; 0: 20 */
  GpgpBuffer triangleNumbers; /**< optional, with commands: uint32_t: the number of a command's primitive i is
                                   [firstIndex / 3 + i]; `draws` give none. So a record can sample what another one
                                   listed: its drawCommands, drawIndices and drawTriangles as commands, indices and
                                   these. STORAGE usage */
  GpgpBuffer drawCountBuffer; /**< optional: uint32_t: how many of the commands, or without them of the draws, there
                                   are; STORAGE usage */
  uint32_t triangleCount;     /**< of all draws: one past the last triangle number; at most 2^31 */
  GpgpBuffer visibleBits;     /**< out: one bit per triangle, ceil(triangleCount / 32) words, overwritten */
  GpgpBuffer pixelCounts;     /**< out, optional: uint32_t per triangle: samples that show it (exact: centres);
                                   reference: at most 2^32 - 1; with a resolution below 1, of that smaller picture */
  GpgpBuffer visibleList;   /**< out, optional: uint32_t triangle numbers, compact, in no stated order; its size is the
                                 budget */
  GpgpBuffer visibleCount;  /**< out, optional: uint32_t[4]: needed, then a VkDispatchIndirectCommand with one workgroup
                                 of 64 per 64 listed triangles, in rows of 65535 (workgroup y * 65535 + x; the last row
                                 may run past the list); with drawCommands a fifth: their number; STORAGE usage */
  GpgpBuffer drawCommands;  /**< out, optional: VkDrawIndexedIndirectCommand per draw, over drawIndices: no or one
                                 instance of its visible triangles, firstInstance its number in `draws`. Of commands:
                                 per instance, in their order. STORAGE usage */
  GpgpBuffer drawIndices;   /**< out, optional: uint32_t[3] per visible triangle of each draw, as the engine's indices
                                 have them; a draw's lie together, in no stated order; its size is the budget */
  GpgpBuffer drawTriangles; /**< out, optional: uint32_t triangle number per triangle in drawIndices: of a command's
                                 primitive i [firstIndex / 3 + i]; its size is the budget */
  GpgpBuffer triangleSizes; /**< out, optional: GpgpTriangleSize per triangle: of visible ones, the largest of all
                                 cameras and draws, in pixels of width and height times resolution; 0 for others */
} GpgpVisibilityInfo;
#define GPGP_VISIBILITY_INFO_INIT GPGP_INIT(GpgpVisibilityInfo, GPGP_STRUCTURE_VISIBILITY_INFO)

/** Samples triangle ids and gathers the visible set. Where two triangles have the same depth the lower number wins
 *  (conservative: the earlier draw). Exact: but for pixels in which more than 28 triangles reach through one
 *  another in depth, or with more than about 1 500 candidates: what is in doubt there counts as visible, which
 *  `unresolved` says.
 *  Draws, meshes and indices that name what is not there, and coordinates that are not finite or reach 2^100, are
 *  skipped and counted. Without draws the geometry buffers may be left out; without triangles the bits too.
 *  NOT_READY: geometry set or view not resident, or recorder not prewarmed. INVALID_ARGUMENT, with the field's name and
 *  what is allowed: a size, camera, method or epsilon out of range or not of the recorder's; a buffer that is missing,
 *  too small, misaligned or larger than the device binds; fields that exclude each other; triangleCount beyond the
 *  view's maxTriangles.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareVisibility(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                          const GpgpFrame* frame, const GpgpVisibilityInfo* info);

typedef struct GpgpVisibilityMetricsInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  uint32_t triangleCount;     /**< of all buffers; at most 2^31 */
  GpgpBuffer visibleBits;     /**< what is measured: a record's, or several records' united; STORAGE usage, as all */
  GpgpBuffer referenceBits;   /**< of records of method reference: all slices, of all cameras that visibleBits unites */
  GpgpBuffer referenceCounts; /**< optional: their pixelCounts; without it shares by area are 0 */
  GpgpBuffer recheckBits;     /**< optional: bits of a finer reference (256 samples): a triangle that is visible and in
                                   these is part of the reference, but one that is in these only is not */
  GpgpBuffer falsePositives;  /**< out, optional: bits, like all in words of 32: visible, not in the reference */
  GpgpBuffer falseNegatives;  /**< out, optional: bits: in the reference, not visible */
} GpgpVisibilityMetricsInfo;
#define GPGP_VISIBILITY_METRICS_INFO_INIT GPGP_INIT(GpgpVisibilityMetricsInfo, GPGP_STRUCTURE_VISIBILITY_METRICS_INFO)

/** Compares visible bits with a reference, triangle by triangle: coverage and overestimation (6.3). Their numbers are
 * in this record's report. Bits and masks: a bit a triangle, in words of 32. NOT_READY: recorder not prewarmed.
 * INVALID_ARGUMENT: a buffer that is missing or too small, with its name and the bytes that it needs.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareVisibilityMetrics(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                                 const GpgpFrame* frame,
                                                                 const GpgpVisibilityMetricsInfo* info);

typedef struct GpgpVisibilityReport {
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
  uint32_t skippedDraws;     /**< of a mesh that is not in the geometry set; instances beyond `draws` */
  uint32_t neededCandidates; /**< exact: at least, where there is too little room */
  uint32_t neededPairs;
  uint32_t maxTriangles; /**< what the recorder has room for, as all three: as it was made with, or its defaults */
  uint32_t maxCandidates;
  uint32_t maxPairs;
  uint32_t unresolved;  /**< exact: triangles and pairs that were not decided; the triangles are reported visible, and
                             what they hide may be, too. For want of room: neededCandidates or neededPairs then exceed
                             the budgets. Or whatever the budgets: what is in doubt in a pixel of too many
                             triangles (see gpgpRecordPrepareVisibility); and what more than 2^20 parts of candidates
                             of over 8 x 8 pixels leave no place for */
  uint32_t neededDraws; /**< of one camera */
  uint32_t draws;       /**< of them sampled, and with drawCommands written */
  uint32_t neededDrawTriangles; /**< with lists by draw: visible ones of all draws */
  uint32_t drawTriangles;       /**< of them written */
  uint32_t reference;           /**< of metrics, as all that follows: triangles in the reference */
  uint32_t falsePositives;      /**< visible, not in the reference */
  uint32_t falseNegatives;      /**< in the reference, not visible */
  float coverage;               /**< found ones, of the reference: 0 to 1; 0 without reference */
  float overestimation;         /**< false positives, of the reference; may exceed 1 */
  float coverageArea;           /**< the reference's samples that show found ones, of all that show a triangle */
  float overestimationArea;     /**< false positives, which no sample shows, as one sample each, of the same */
} GpgpVisibilityReport;
#define GPGP_VISIBILITY_REPORT_INIT GPGP_INIT(GpgpVisibilityReport, GPGP_STRUCTURE_VISIBILITY_REPORT)

/** The oldest report not yet taken. NOT_READY: none. BUDGET_EXCEEDED in base.status: maxTriangles (neededTriangles says
 *  how many there are), maxDraws or drawCommands (neededDraws), the list (visible says how many), the lists by draw
 *  (neededDrawTriangles), or anything `unresolved`, which larger budgets do not always help. What is written is valid,
 *  and whole triangles. Of several cameras all but visible, listed, appeared, disappeared and draws are sums.
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetVisibilityReport(GpgpRecorder recorder, GpgpVisibilityReport* report);

#ifdef __cplusplus
}
#endif
#endif
