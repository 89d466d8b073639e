// What lies in the atlas's buffers: structs and numbers that the CPU writes, the passes share and reports hold.
//
// Guarantees: one layout in std430 and C++ (only 4-byte members).
#ifndef GPGP_SHADERS_VISIBILITY_ATLAS_LAYOUT_H
#define GPGP_SHADERS_VISIBILITY_ATLAS_LAYOUT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kMinClass = 4u;                ///< a block of class c has 2^c texels
GPGP_CONST uint kMaxClass = 14u;               ///< a whole superblock
GPGP_CONST uint kClasses = 11u;                ///< from kMinClass to kMaxClass
GPGP_CONST uint kSuperSide = 128u;             ///< texels of a superblock, which holds blocks of one class
GPGP_CONST uint kSuperWords = 34u;             ///< of each: blocks that stay in it, their class, a bit for each place
GPGP_CONST uint kMaxSupers = 4096u;            ///< of an atlas of 8192 x 8192 texels
GPGP_CONST uint kAtlasGroup = 1024u;           ///< triangles that a workgroup takes, in four rounds
GPGP_CONST uint kMaxAtlasTriangles = 1u << 25; ///< groups of them stay below 65535
GPGP_CONST uint kMaxBuckets = 32u;
GPGP_CONST uint kMaxAtlasDraws = 65535u;

/// The history: a head, a word of state for each triangle, then four bits for each two of them (pairCode).
GPGP_CONST uint kHeadPressure = 0u;
GPGP_CONST uint kHeadVacated = 1u; ///< of each class: a superblock whose blocks move out, plus one; 0: none
GPGP_CONST uint kHeadWords = 16u;

/// Pressure, which lowers blocks: keys are half octaves of area, each in 16 parts by a hash of the triangle's number.
GPGP_CONST uint kKeys = 1024u;
GPGP_CONST uint kKeyParts = 16u;
GPGP_CONST uint kVariants = 3u; ///< class that hysteresis keeps: one below, at and above the one for the size
GPGP_CONST uint kDropPressure = kKeys * (kMaxClass - kMinClass); ///< from here on blocks are dropped
GPGP_CONST uint kMostPressure = kDropPressure + kKeys;           ///< none is left

/// Rows of counts, one count for each workgroup's triangles, and their number.
GPGP_CONST uint kRowAll = 0u;       ///< blocks, by class
GPGP_CONST uint kRowRequests = 11u; ///< of these, those that need a new place, by class
GPGP_CONST uint kRowNew = 22u;
GPGP_CONST uint kRowChanged = 23u; ///< have a block and request another one
GPGP_CONST uint kRowKept = 24u;
GPGP_CONST uint kRowGone = 25u;
GPGP_CONST uint kRowTiles = 26u; ///< blocks to shade, by bucket and in these by class
GPGP_CONST uint kMaxRows = kRowTiles + kMaxBuckets * kClasses;
/// Before the rows lie each row's sum, then where each row's tiles begin.
GPGP_CONST uint kRowBases = kMaxRows;
GPGP_CONST uint kRowCounts = kMaxRows * 2u;

/// Bits of a triangle's plan, made in this recording.
GPGP_CONST uint kPlanDesired = 15u;   ///< class, before it is lowered; 0: the triangle has no block of its own
GPGP_CONST uint kPlanClassShift = 4u; ///< 4 bits: class of its block; 0: none
GPGP_CONST uint kPlanKeyShift = 8u;   ///< 10 bits
GPGP_CONST uint kPlanVisible = 1u << 18;
GPGP_CONST uint kPlanPaired = 1u << 19;
GPGP_CONST uint kPlanHad = 1u << 20;   ///< had a block before
GPGP_CONST uint kPlanKeeps = 1u << 21; ///< keeps its place
GPGP_CONST uint kPlanShade = 1u << 22; ///< its tiles are listed
GPGP_CONST uint kPlanBoth = 1u << 23;  ///< both triangles of the pair are visible

GPGP_CONST int kAtlasParams = 0;
GPGP_CONST int kAtlasHistory = 1;
GPGP_CONST int kAtlasBits = 2;
GPGP_CONST int kAtlasSizes = 3;
GPGP_CONST int kAtlasDraws = 4;
GPGP_CONST int kAtlasMeshes = 5;
GPGP_CONST int kAtlasIndices = 6;
GPGP_CONST int kAtlasBuckets = 7;
GPGP_CONST int kAtlasShade = 8;
GPGP_CONST int kAtlasCounters = 9;
GPGP_CONST int kAtlasCodes = 10;
GPGP_CONST int kAtlasPlans = 11;
GPGP_CONST int kAtlasRows = 12;
GPGP_CONST int kAtlasSupers = 13;
GPGP_CONST int kAtlasLists = 14; ///< of each class and of none: superblocks and the free places before them
GPGP_CONST int kAtlasHistogram = 15;
GPGP_CONST int kAtlasBlocks = 16;
GPGP_CONST int kAtlasTiles = 17;
GPGP_CONST int kAtlasArguments = 18;
GPGP_CONST int kAtlasNew = 19;
GPGP_CONST int kAtlasChanged = 20;
GPGP_CONST int kAtlasGone = 21;
GPGP_CONST int kAtlasCounts = 22;
GPGP_CONST int kAtlasBindings = 23;
GPGP_CONST uint kArgumentWords = 5u; ///< of a bucket: VkDispatchIndirectCommand, first tile, tiles
GPGP_CONST uint kTilesPerGroup = 4u;

struct AtlasParams {
  uint triangleCount;
  uint maxTriangles; ///< of the history
  uint groupCount;   ///< of kAtlasGroup triangles
  uint superColumns;
  uint superCount;
  float scale; ///< texels for each pixel of a triangle's area
  uint drawCount;
  uint meshCount;
  uint indexCount;
  uint shortIndices;
  uint findsPairs; ///< 1: draws are there
  uint bucketCount;
  uint hasBuckets;
  uint hasShade;
  uint tileCapacity;
  uint newCapacity; ///< 0: there is no such list; so of the others
  uint changedCapacity;
  uint goneCapacity;
  uint hasCounts;
  uint hasArguments;
};

/// GPU counters; the first kAtlasReportWords are the report.
struct AtlasCounters {
  uint visible; ///< triangles
  uint blocks;
  uint added;
  uint changed;
  uint kept;
  uint gone;
  uint lowered;
  uint dropped;          ///< blocks
  uint droppedTriangles; ///< visible ones
  uint byClass[11];
  uint supers; ///< in use
  uint leastSupers;
  uint texels; ///< of all blocks
  uint pressure;
  uint repacked; ///< 1: all blocks moved
  uint tiles;
  uint vacated; ///< blocks that moved out of a nearly empty superblock
  uint maxSupers;
  uint listsExceeded;   ///< 1: a list of the engine's was too small
  uint classSupers[12]; ///< 0: unused, then of each class: what has blocks that stay
  uint classFree[12];   ///< free places in them
  uint emptiest[12];    ///< blocks that stay and 4095 - superblock, of each class
  uint firstNew[11];    ///< of each class: its first one in the list of unused superblocks; when repacked, superblock
};
GPGP_CONST uint kAtlasReportWords = 29u;
GPGP_CONST uint kAtlasCounterWords = 76u;

#ifdef __cplusplus
static_assert(sizeof(AtlasParams) == 80 && sizeof(AtlasCounters) == 4 * kAtlasCounterWords);
static_assert(kMaxClass - kMinClass + 1 == kClasses && kSuperSide * kSuperSide == 1u << kMaxClass);
#endif

GPGP_SHADER_END
#endif
