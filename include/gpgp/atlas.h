/* gpgp atlas: a shading atlas for what a visibility recorder found (visibility.h), for shading in object space.
 *
 *   atlas (history)              Which triangles have blocks of the atlas, and where. Blocks stay where they are while
 *                                their triangles are visible and keep their size class. It holds no texels: the images
 *                                are the engine's, as many and in such formats as it likes.
 *   atlas recorder (recorder)    Allocates blocks and lists what is to be shaded. Its budgets set its size. It serves
 *                                any number of atlases.
 *
 *   gpgpCreateAtlas, gpgpCreateAtlasRecorder -> gpgpPrewarm
 *   -> each frame: gpgpRecordPrepareVisibility with visibleBits and triangleSizes -> gpgpRecordPrepareAtlas
 *   -> the engine shades the listed tiles by indirect dispatches, one for each material bucket
 *   -> the engine displays, at its own rate: the fragment's triangle and barycentrics give a point in the atlas
 *   -> frames later: gpgpGetAtlasReport
 *
 * gpgp/shaders/atlas.h has the functions for both of the engine's shaders, in GLSL and HLSL.
 *
 * Blocks are rectangles of 2^c texels, class c = 4 to 14: 4 x 4, 8 x 4, 8 x 8, up to 128 x 128. A block of a class is
 * chosen by the projected area, and holds two triangles or one:
 *   - triangles 2n and 2n + 1 share a block, the pair's, if one draw has both and they share two vertices by index,
 *     in opposite order as triangles of one surface do;
 *   - every other triangle has a block of its own, and half of it stays empty.
 * "The block's triangle" is triangle 2n of a pair. An even firstTriangle and quads of two consecutive triangles give
 * the most pairs. Superblocks of 128 x 128 texels hold blocks of one class. Those without blocks are free for any
 * class. The same input gives the same blocks, lists and report on every device.
 */
#ifndef GPGP_ATLAS_H
#define GPGP_ATLAS_H
#include <gpgp/visibility.h>
#ifdef __cplusplus
extern "C" {
#endif

#define GPGP_ATLAS_CLASSES 11u /**< of blocks: class i has 2^(i + 4) texels */

/* ---------------------------------------------------------------- atlas */

typedef struct GpgpAtlasCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;      /**< for messages and debug names; copied */
  uint32_t width, height; /**< texels, multiples of 128, at most 8192 each; 0: 4096 */
  /** Largest triangleCount of its recordings, at most 2^25; 0: 4194304. Memory: 4.25 bytes each. Each recording
   *  iterates over all of them, so choose no more than the scene has. */
  uint32_t maxTriangles;
} GpgpAtlasCreateInfo;
#define GPGP_ATLAS_CREATE_INFO_INIT GPGP_INIT(GpgpAtlasCreateInfo, GPGP_STRUCTURE_ATLAS_CREATE_INFO)

/** Makes an atlas without blocks. It is ready once gpgpRecordUpload has cleared it. Its recordings must be submitted in
 *  the order in which they are recorded.
 *  Errors: INVALID_ARGUMENT (a size, or maxTriangles), UNSUPPORTED (maxTriangles exceeds maxStorageBufferRange),
 *  INVALID_STRUCT, OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateAtlas(GpgpContext context, const GpgpAtlasCreateInfo* info, GpgpHistory* atlas);

/* ---------------------------------------------------------------- atlas recorder */

/** Budgets of an atlas recorder. Scratch: 960 KiB, 4.4 bytes for each of maxTriangles, and 44 bytes for each bucket and
 *  each 1024 of maxTriangles. */
typedef struct GpgpAtlasRecorderCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  uint32_t maxTriangles; /**< the largest maxTriangles of its atlases, at most 2^25; 0: 4194304 */
  uint32_t maxBuckets;   /**< material buckets, at most 32; 0: 1 */
} GpgpAtlasRecorderCreateInfo;
#define GPGP_ATLAS_RECORDER_CREATE_INFO_INIT                                                                           \
  GPGP_INIT(GpgpAtlasRecorderCreateInfo, GPGP_STRUCTURE_ATLAS_RECORDER_CREATE_INFO)

/** Makes an atlas recorder and allocates scratch for its budgets. Prewarm it before its first recording.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets that the device cannot bind), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateAtlasRecorder(GpgpContext context, const GpgpAtlasRecorderCreateInfo* info,
                                                      GpgpRecorder* recorder);

/* ---------------------------------------------------------------- recording */

/** One recording. Buffers marked "out" are written, all others are only read. All have STORAGE usage. An optional
 *  buffer is left out by leaving it zero. Lists are in ascending order of triangles. What exceeds a list's size is not
 *  written; the report and `counts` hold how many there are. */
typedef struct GpgpAtlasInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  GpgpHistory atlas;
  /** As in the visibility recording: one more than the largest triangle number. Triangles up to the atlas's
   *  maxTriangles that lie beyond it count as invisible. */
  uint32_t triangleCount;
  GpgpBuffer visibleBits;   /**< of GpgpVisibilityInfo, of one recording or of several that accumulated */
  GpgpBuffer triangleSizes; /**< likewise: GpgpTriangleSize[triangleCount] */
  /** Texels for each pixel of a triangle's projected area, 2^-10 to 64; 0: 1. Sizes are rounded up to a class, so a
   *  triangle gets 1 to 2 times as many texels. Hysteresis widens this range to 0.8 to 2.7. */
  float texelsPerPixel;
  /** Optional: geometry set, draws and indices of the visibility recording. They tell which triangles are pairs. Needed
   *  in an atlas's first recording, and again after meshes, draws or triangle numbers have changed: triangles whose
   *  partner has changed then lose their blocks and get new ones. In other recordings the atlas keeps the pairs that it
   *  knows. If no recording gives them, all triangles are single. Draws that share triangle numbers must have the same
   *  indices. */
  GpgpAsset geometrySet;
  GpgpBuffer draws;      /**< GpgpVisibilityDraw[drawCount] */
  uint32_t drawCount;    /**< at most 65535; 0: pairs stay as they are */
  GpgpBuffer indices;    /**< the size is a multiple of 4, for UINT16 too */
  VkIndexType indexType; /**< UINT16 or UINT32 */
  /** Optional: the material bucket that shades each triangle, one byte a triangle; ceil(triangleCount / 4) words.
   *  Numbers from bucketCount on count as the last bucket. The block's triangle decides for its pair. */
  GpgpBuffer buckets;
  uint32_t bucketCount; /**< at most the recorder's maxBuckets; 0: 1 */
  /** Optional: a bit for each triangle, as in visibleBits. New and changed blocks are always listed for shading. Others
   *  are listed only if the bit of one of their triangles is set. Left out: all blocks are listed. */
  GpgpBuffer shadeBits;
  /** Out: uint32_t[triangleCount], each triangle's block for gpgp/shaders/atlas.h; 0: it has none. Rewritten as a whole
   *  by each recording. */
  GpgpBuffer blocks;
  /** Out, optional: uint32_t[2] for each tile of 4 x 4 texels to shade: the block's triangle, and the tile's number in
   *  the block. Grouped by bucket, in a bucket by class, then by triangle. An atlas has at most width * height / 16. */
  GpgpBuffer tiles;
  /** Out, optional: uint32_t[5] for each bucket. [0] to [2] are a VkDispatchIndirectCommand with a workgroup for each 4
   *  tiles, in rows of 65535: workgroup y * 65535 + x. The last row may extend beyond the list. [3] is the bucket's
   *  first tile in `tiles`, [4] is how many it has. */
  GpgpBuffer dispatches;
  GpgpBuffer newBlocks;     /**< out, optional: uint32_t triangles whose blocks were made by this recording */
  GpgpBuffer changedBlocks; /**< out, optional: likewise for blocks whose size or place has changed */
  GpgpBuffer goneBlocks;    /**< out, optional: likewise for blocks that were freed */
  GpgpBuffer counts; /**< out, optional: uint32_t[4]: numbers of new, changed and freed blocks, and of tiles to shade */
} GpgpAtlasInfo;
#define GPGP_ATLAS_INFO_INIT GPGP_INIT(GpgpAtlasInfo, GPGP_STRUCTURE_ATLAS_INFO)

/** Gives each visible triangle a block, keeps the blocks that exist already, and lists the tiles to shade and the
 *  changes.
 *
 *  If not all blocks fit, blocks are made one class smaller, beginning with those of the smallest visible area, until
 *  all fit. Where one such round does not suffice, another one follows. Only once all have 4 x 4 texels are blocks left
 *  out, again beginning with the smallest area. The report counts both. The steps are half octaves of area, divided
 *  into 16 parts each. Blocks grow again once an eighth of the atlas would remain free.
 *
 *  A block moves in three cases:
 *  - its class changes;
 *  - the other superblocks of its class have room for all blocks of its superblock, which then becomes free;
 *  - too few superblocks are free although enough texels are. All blocks then move at once (`repacked`).
 *
 *  NOT_READY: the atlas or geometry set is not resident, or the recorder is not prewarmed. Nothing is recorded.
 *  Errors: INVALID_ARGUMENT (the message names the field and what is allowed: a buffer that is missing, too small or
 *  larger than the device binds; a count beyond its budget), INVALID_STRUCT, INVALID_HANDLE, TOO_MANY_RECORDINGS,
 *  DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareAtlas(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                     const GpgpFrame* frame, const GpgpAtlasInfo* info);

/* ---------------------------------------------------------------- report */

/** What one recording did, as the GPU counted it. */
typedef struct GpgpAtlasReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t visibleTriangles;
  uint32_t blocks;                            /**< after the recording; newBlocks + changedBlocks + keptBlocks */
  uint32_t blocksByClass[GPGP_ATLAS_CLASSES]; /**< their sum is `blocks` */
  uint32_t newBlocks;
  uint32_t changedBlocks; /**< whose size or place has changed; includes vacatedBlocks and repacked blocks */
  uint32_t keptBlocks;
  uint32_t goneBlocks;
  uint32_t vacatedBlocks;    /**< moved so that a nearly empty superblock becomes free */
  uint32_t loweredBlocks;    /**< with fewer texels than their triangles ask for, for lack of room */
  uint32_t droppedBlocks;    /**< of visible triangles, left out for lack of room */
  uint32_t droppedTriangles; /**< visible ones without a block */
  uint32_t tiles;            /**< to shade; tiles.size of 8 bytes each is needed */
  uint32_t superblocks;      /**< in use */
  uint32_t maxSuperblocks;   /**< of the atlas */
  /** 0: all blocks have the size that they ask for. Each 1024 lower all blocks by one class. */
  uint32_t pressure;
  VkBool32 repacked; /**< all blocks moved */
  float fill;        /**< texels of blocks / texels of the atlas */
  /** Share of superblocks in use that would be free if each class had no more than it needs. */
  float fragmentation;
} GpgpAtlasReport;
#define GPGP_ATLAS_REPORT_INIT GPGP_INIT(GpgpAtlasReport, GPGP_STRUCTURE_ATLAS_REPORT)

/** Takes the oldest report that was not taken yet. NOT_READY: there is none.
 *  base.status is BUDGET_EXCEEDED if blocks were lowered or dropped, or if a list was too small. What is written is
 *  valid.
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetAtlasReport(GpgpRecorder recorder, GpgpAtlasReport* report);

#ifdef __cplusplus
}
#endif
#endif
