/* gpgp tiles: parts of a world that are spawned, spawned anew and freed one by one, in buffers that they share.
 *
 * A tile set is a history (gpgpDestroyHistory). It shares out ranges of the engine's instance or vertex buffers, one
 * for each tile, and ranges of a buffer of indirect draws. It holds no memory of the device itself. A tile is a list of
 * axioms, which one recording derives (gpgpRecordPrepareSpawn). Nothing that a tile does touches another tile.
 *
 *   gpgpCreateSpawner, gpgpCreateTileSet   once
 *   gpgpRecordTile                         spawns a tile, or spawns one anew: other axioms, a changed grammar
 *   gpgpGetSpawnReport                     how much it needed; gpgpTrimTile gives back the rest of its range
 *   gpgpRecordFreeTile                     frees it
 *
 * All recordings of a tile set, and the engine's draws, are submitted to one queue in the order of recording, or the
 * engine synchronises them: a range that was freed is used again at once. They must be submitted. Where a command
 * buffer is dropped instead, the set counts its tiles as recorded: record those that it spawned or moved again, and
 * fill the counts of those that it freed with 0 (GpgpTileRange::slot before it was freed), or their draws stay what
 * they were.
 */
#ifndef GPGP_TILES_H
#define GPGP_TILES_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** A tile of a tile set. 0 is none. A freed tile's handle is recognised, and so is that of another set. */
typedef uint64_t GpgpTile;

typedef struct GpgpTileSetCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;    /**< For messages. The string is copied. */
  GpgpRecorder spawner; /**< Derives all tiles. It says whether they are instances, compact instances or vertices. */
  GpgpAsset grammar;    /**< Of all tiles; linked grammars count as one. */
  uint32_t maxTiles;    /**< Tiles that exist at the same time. At least 1, at most 2^20. */
  /** What tiles share: instances of a spawner for instances, else vertices, and indices if they are wanted. `before`
   * and `after` are the engine's use in every recording. */
  GpgpBuffer instances, vertices, indices;
  VkIndexType indexType; /**< UINT16 or UINT32. 16 bits reach 65532 vertices of a tile. */
  /** VkDrawIndexedIndirectCommand: for each tile one for each bucket, or one in all for vertices. STORAGE and
   *  TRANSFER_DST usage. Its size is at least maxTiles * GpgpTileSetReport::tileStride; gpgpGetTileStride tells that
   *  beforehand. Before the first recording, the engine fills in all commands, with counts of 0.
   *
   *  Instances: instanceCount and firstInstance are written, all others keep the engine's values. Vertices: indexCount,
   *  firstIndex and vertexOffset are written. firstInstance, firstIndex and vertexOffset count from the beginning of
   * the buffers' ranges given here. */
  GpgpBuffer draws;
} GpgpTileSetCreateInfo;
#define GPGP_TILE_SET_CREATE_INFO_INIT GPGP_INIT(GpgpTileSetCreateInfo, GPGP_STRUCTURE_TILE_SET_CREATE_INFO)

/** Returns the bytes from a tile's draw commands to the next tile's. A vkCmdDrawIndexedIndirect with this stride and
 *  maxTiles commands draws a bucket of all tiles: it begins at draws.offset + bucket * 20. A device without
 *  multiDrawIndirect draws tile by tile. Errors: INVALID_HANDLE, INVALID_ARGUMENT. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetTileStride(GpgpRecorder spawner, GpgpAsset grammar, VkDeviceSize* stride);

/** Creates a tile set without tiles.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, INVALID_HANDLE, OUT_OF_HOST_MEMORY, DEVICE_LOST.
 *  @threads context @lifetime call; spawner, grammar and buffers: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateTileSet(GpgpContext context, const GpgpTileSetCreateInfo* info,
                                                GpgpHistory* tileSet);

typedef uint64_t GpgpTileFlags;
/** A tile that exists is spawned anew in the lowest free range, its own included, instead of where it is. This is how
 *  an engine defragments, when it wants to and as much as it wants to: GpgpTileSetReport::highest names the tile. */
#define GPGP_TILE_MOVE ((GpgpTileFlags)1)

/** What becomes a tile. */
typedef struct GpgpTileInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;      /**< base.tag is in the report of the spawner. */
  GpgpBuffer axioms;           /**< As GpgpSpawnInfo::axioms. */
  const GpgpAxiom* hostAxioms; /**< As GpgpSpawnInfo::hostAxioms. @lifetime call */
  uint32_t axiomCount;         /**< At least 1. */
  /** Terminals that the tile has room for: instances, or quads of vertices. gpgpEvaluate (evaluator.h) counts them
   *  exactly; a report of the same axioms does so, too. What does not fit is missing from this tile, and its report
   *  says BUDGET_EXCEEDED. At least 1. */
  uint32_t capacity;
  GpgpTileFlags flags;
  const GpgpSpawnCamera* camera; /**< As GpgpSpawnInfo::camera. @lifetime call */
} GpgpTileInfo;
#define GPGP_TILE_INFO_INIT GPGP_INIT(GpgpTileInfo, GPGP_STRUCTURE_TILE_INFO)

/** Records the derivation of a tile. *tile is 0 for a new one, which it becomes; else that tile is spawned anew, where
 *  it is if capacity is not more than it has room for. Returns BUDGET_EXCEEDED, and changes and records nothing, if no
 *  range is large enough or there are maxTiles tiles; an existing tile then stays as it is. Returns NOT_READY as
 *  gpgpRecordPrepareSpawn does. Errors: INVALID_HANDLE (also of a freed tile), INVALID_STRUCT, INVALID_ARGUMENT,
 *  TOO_MANY_RECORDINGS, UNSUPPORTED, DEVICE_LOST.
 *  @threads handle, and the spawner @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordTile(GpgpHistory tileSet, VkCommandBuffer commandBuffer, const GpgpFrame* frame,
                                             const GpgpTileInfo* info, GpgpTile* tile);

/** Frees a tile: records fills that set the counts of its draws to 0, and gives back its ranges.
 *  Errors: INVALID_HANDLE (also of a freed tile), INVALID_ARGUMENT, DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside @state none */
GPGP_API GpgpResult GPGP_CALL gpgpRecordFreeTile(GpgpHistory tileSet, VkCommandBuffer commandBuffer,
                                                 const GpgpFrame* frame, GpgpTile tile, GpgpAccessMode accessMode);

/** Gives back the end of a tile's range. `used` is what the report of its recording says: instancesWritten, or
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

/** How full a tile set is. Instances, or quads. */
typedef struct GpgpTileSetReport {
  GpgpStructureType sType;
  void* pNext;
  uint32_t tiles;
  uint32_t capacity; /**< All of the shared buffers. */
  uint32_t used;     /**< Ranges of tiles. */
  uint32_t largest;  /**< The largest free range: the most that gpgpRecordTile takes. */
  uint32_t holes;    /**< Free ranges below the highest tile. */
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
