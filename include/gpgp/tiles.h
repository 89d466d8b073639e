/* gpgp tiles: parts of a world that are spawned, respawned and freed one by one in shared buffers.
 *
 * A tile set is a history (gpgpDestroyHistory). It allocates a range of the engine's instance or vertex buffers to each
 * tile, and a range of a buffer of indirect draws. It has no device memory of its own. A tile is a list of axioms,
 * which one recording derives (gpgpRecordPrepareSpawn). Recording one tile does not change another one.
 *
 *   gpgpCreateSpawner, gpgpCreateTileSet   once
 *   gpgpRecordTile                         spawns a new tile, or respawns one: other axioms, a changed grammar
 *   gpgpGetSpawnReport                     tells how much it needed; gpgpTrimTile frees the rest of its range
 *   gpgpRecordFreeTile                     frees it
 *
 * A freed range is reused at once. So all recordings of a tile set, and the engine's draws, must be submitted to one
 * queue in the order of recording, or the engine synchronises them. Every recording must be submitted. A tile set does
 * not notice that a command buffer was dropped. In that case, record the tiles that it spawned or moved once more. Fill
 * the draw counts of the tiles that it freed with 0 (GpgpTileRange::slot before they were freed). Otherwise their draws
 * stay as they were.
 */
#ifndef GPGP_TILES_H
#define GPGP_TILES_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** The handle of a tile in a tile set. 0: no tile. Handles of freed tiles and of other sets are recognised as invalid.
 */
typedef uint64_t GpgpTile;

typedef struct GpgpTileSetCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;    /**< For messages. The string is copied. */
  GpgpRecorder spawner; /**< Derives all tiles, as instances, compact instances or vertices. */
  GpgpAsset grammar;    /**< The grammar of all tiles. It may be linked from several ones. */
  uint32_t maxTiles;    /**< Tiles that exist at the same time. At least 1, at most 2^20. */
  /** The shared buffers: instances, or for a spawner that writes vertices, vertices and optionally indices. `before`
   *  and `after` apply to every recording. */
  GpgpBuffer instances, vertices, indices;
  VkIndexType indexType; /**< UINT16 or UINT32. UINT16 allows up to 65532 vertices in a tile. */
  /** VkDrawIndexedIndirectCommand[]: one for each bucket of each tile, or for vertices one for each tile. STORAGE and
   *  TRANSFER_DST usage. Its size is at least maxTiles * GpgpTileSetReport::tileStride. gpgpGetTileStride returns the
   *  stride beforehand. Before the first recording, the engine fills in all commands, with counts of 0.
   *
   *  Instances: instanceCount and firstInstance are written, all others keep the engine's values. Vertices: indexCount,
   *  firstIndex and vertexOffset are written. firstInstance, firstIndex and vertexOffset count from the beginning of
   *  the buffers' ranges given here. */
  GpgpBuffer draws;
} GpgpTileSetCreateInfo;
#define GPGP_TILE_SET_CREATE_INFO_INIT GPGP_INIT(GpgpTileSetCreateInfo, GPGP_STRUCTURE_TILE_SET_CREATE_INFO)

/** Returns the distance in bytes from one tile's draw commands to the next tile's. A vkCmdDrawIndexedIndirect with this
 *  stride and maxTiles commands draws a bucket of all tiles: it begins at draws.offset + bucket * 20. A device without
 *  multiDrawIndirect draws tile by tile. Errors: INVALID_HANDLE, INVALID_ARGUMENT. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetTileStride(GpgpRecorder spawner, GpgpAsset grammar, VkDeviceSize* stride);

/** Creates a tile set without tiles.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, INVALID_HANDLE, OUT_OF_HOST_MEMORY, DEVICE_LOST.
 *  @threads context @lifetime call; spawner, grammar and buffers: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateTileSet(GpgpContext context, const GpgpTileSetCreateInfo* info,
                                                GpgpHistory* tileSet);

typedef uint64_t GpgpTileFlags;
/** Respawns an existing tile in the lowest range that is free or its own, instead of in place. Engines use it to
 *  defragment, as much and whenever they like: GpgpTileSetReport::highest is the tile to move. */
#define GPGP_TILE_MOVE ((GpgpTileFlags)1)

/** The contents of a tile. */
typedef struct GpgpTileInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;      /**< base.tag is in the report of the spawner. */
  GpgpBuffer axioms;           /**< As GpgpSpawnInfo::axioms. */
  const GpgpAxiom* hostAxioms; /**< As GpgpSpawnInfo::hostAxioms. @lifetime call */
  uint32_t axiomCount;         /**< At least 1. */
  /** Terminals that the tile has room for: instances, or quads of vertices. gpgpEvaluate (evaluator.h) counts them
   *  exactly, and so does a report for the same axioms. What does not fit is missing from this tile, and its report
   *  says BUDGET_EXCEEDED. At least 1. */
  uint32_t capacity;
  GpgpTileFlags flags;
  const GpgpSpawnCamera* camera; /**< As GpgpSpawnInfo::camera. @lifetime call */
  uint32_t contextCount;         /**< As GpgpSpawnInfo::contextCount: the last ones are of neighbours. */
  uint32_t fieldCount;
  const GpgpSpawnField* fields; /**< As GpgpSpawnInfo::fields. @lifetime call */
  GpgpBuffer fieldValues;       /**< As GpgpSpawnInfo::fieldValues. */
} GpgpTileInfo;
#define GPGP_TILE_INFO_INIT GPGP_INIT(GpgpTileInfo, GPGP_STRUCTURE_TILE_INFO)

/** Records the derivation of a tile. If *tile is 0, it creates a tile and writes its handle there. Otherwise it
 *  respawns that tile, in place if its range has room for `capacity`. Returns BUDGET_EXCEEDED if no free range is large
 *  enough or maxTiles tiles exist. It then changes and records nothing, and an existing tile stays as it is. Returns
 *  NOT_READY as gpgpRecordPrepareSpawn does. Errors: INVALID_HANDLE (also of a freed tile), INVALID_STRUCT,
 *  INVALID_ARGUMENT, TOO_MANY_RECORDINGS, UNSUPPORTED, DEVICE_LOST.
 *  @threads handle, and the spawner @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordTile(GpgpHistory tileSet, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                             const GpgpTileInfo* info, GpgpTile* tile);

/** Frees a tile: records fills that set the counts of its draws to 0, and frees its ranges.
 *  Errors: INVALID_HANDLE (also of a freed tile), INVALID_ARGUMENT, DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside @state none */
GPGP_API GpgpResult GPGP_CALL gpgpRecordFreeTile(GpgpHistory tileSet, VkCommandBuffer commandBuffer,
                                                 const GpgpFrame* frame, GpgpTile tile, GpgpAccessMode accessMode);

/** Frees the unused end of a tile's range. `used` is what the report of its recording says: instancesWritten, or
 *  verticesWritten / 4. Errors: INVALID_HANDLE, INVALID_ARGUMENT (used is more than the range holds).
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpTrimTile(GpgpHistory tileSet, GpgpTile tile, uint32_t used);

/** Where a tile lies. */
typedef struct GpgpTileRange {
  uint32_t first;    /**< Instance, or quad of 4 vertices and 6 indices, from the beginning of the shared buffers. */
  uint32_t capacity; /**< Instances or quads. At least what was asked for, as ranges are rounded up. */
  uint32_t slot;     /**< Its draws begin at draws.offset + slot * tileStride. Less than maxTiles. */
} GpgpTileRange;

/** Returns where a tile lies. Errors: INVALID_HANDLE, INVALID_ARGUMENT. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetTileRange(GpgpHistory tileSet, GpgpTile tile, GpgpTileRange* range);

/** How full a tile set is. capacity, used and largest count instances or quads. */
typedef struct GpgpTileSetReport {
  GpgpStructureType sType;
  void* pNext;
  uint32_t tiles;
  uint32_t capacity; /**< Of the shared buffers. */
  uint32_t used;     /**< In ranges of tiles. */
  uint32_t largest;  /**< The largest free range, which is the largest `capacity` that a new tile can have. */
  uint32_t holes;    /**< Number of free ranges below the highest tile. */
  GpgpTile highest;  /**< The tile that lies highest, 0 without tiles. */
  VkDeviceSize tileStride;
} GpgpTileSetReport;
#define GPGP_TILE_SET_REPORT_INIT GPGP_INIT(GpgpTileSetReport, GPGP_STRUCTURE_TILE_SET_REPORT)

/** Returns how full a tile set is. Errors: INVALID_HANDLE, INVALID_STRUCT. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetTileSetReport(GpgpHistory tileSet, GpgpTileSetReport* report);

#ifdef __cplusplus
}
#endif
#endif
