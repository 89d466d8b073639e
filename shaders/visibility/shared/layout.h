// What lies in buffers: structs and numbers that the CPU writes, the passes share and reports hold.
//
// Guarantees: one layout in std430 and C++ (only 4-byte members).
#ifndef GPGP_SHADERS_VISIBILITY_LAYOUT_H
#define GPGP_SHADERS_VISIBILITY_LAYOUT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kNoTriangle = 0xffffffffu; ///< in a sample: nothing
GPGP_CONST uint kFarthest = 0xffffffffu;   ///< in a sample: nothing
GPGP_CONST uint kTwoSided = 1u;            ///< GPGP_DRAW_TWO_SIDED
GPGP_CONST uint kClockwise = 2u;           ///< GPGP_DRAW_CLOCKWISE
GPGP_CONST uint kSeeThrough = 4u;          ///< GPGP_DRAW_SEE_THROUGH
GPGP_CONST uint kDisabled = 8u;            ///< GPGP_DRAW_DISABLED
GPGP_CONST uint kAlphaTestBits = 0x1f00u;  ///< GPGP_DRAW_ALPHA_TEST: 1 and the index of its test, from bit 8 on
GPGP_CONST uint kMaxAlphaTests = 16u;      ///< of one recording
GPGP_CONST uint kMaxCameras = 128u;        ///< of one recording
GPGP_CONST uint kMaxOrigins = 32u;         ///< that draws' transforms are relative to
GPGP_CONST uint kMaxViewport = 8192u;      ///< pixels; edge functions stay below 2^48 up to here
GPGP_CONST uint kMaxGroups = 65535u;       ///< workgroups per dimension that every device offers
GPGP_CONST uint kListGroup = 64u;          ///< listed triangles per workgroup of the engine's indirect dispatch
GPGP_CONST uint kListBlocks = 512u;        ///< parts of the visible bits that are counted before they are listed
GPGP_CONST uint kChangedHeader = 4u;       ///< words of the list of changes before its triangles
GPGP_CONST uint kLargeSplit = 32u;         ///< workgroups that share one large triangle that has no record
GPGP_CONST uint kMaxSlices = 256u;         ///< records, a workgroup each, that share one large triangle at most
GPGP_CONST uint kSliceBlocks = 64u;        ///< blocks of 8 x 8 pixels that one workgroup is given at least
GPGP_CONST uint kSliceTiles = 64u;         ///< the same of exact sampling's tiles: one an invocation
GPGP_CONST uint kChunk = 64u;              ///< triangles of one draw that a workgroup takes at a time
GPGP_CONST uint kExact = 1u;               ///< GPGP_SAMPLING_EXACT
GPGP_CONST uint kReference = 2u;           ///< GPGP_SAMPLING_REFERENCE
GPGP_CONST uint kConservative = 3u;        ///< GPGP_SAMPLING_CONSERVATIVE
GPGP_CONST uint kNearby = 4u;              ///< GPGP_SAMPLING_NEARBY
GPGP_CONST uint kBatch = 32u;              ///< entries of a pixel's list that a workgroup looks at together
GPGP_CONST uint kListRun = 8u;             ///< lists of at most so many that a workgroup is given
GPGP_CONST uint kNonOpaqueSplit = 8u;      ///< workgroups that share one triangle that is not opaque
GPGP_CONST uint kNoRecord = 0x80000000u;   ///< flag of a queued item whose triangles found no record

/// Formats of positions.
GPGP_CONST uint kFloats = 0u;
GPGP_CONST uint kHalves = 1u;
GPGP_CONST uint kSnorms = 2u;
GPGP_CONST uint kUnorms = 3u; ///< of texture coordinates only

/// Binding numbers of set 0, which are resource numbers of the pass list. Not more than the storage buffers that every
/// device offers a shader: what is not needed at the same time shares a number.
GPGP_CONST int kBindParams = 0;
GPGP_CONST int kBindPositions = 1;
GPGP_CONST int kBindIndices = 2;
GPGP_CONST int kBindDraws = 3;
GPGP_CONST int kBindMeshes = 4;
GPGP_CONST int kBindTable = 5;
GPGP_CONST int kBindQueue = 6;
GPGP_CONST int kBindSamples = 7;
GPGP_CONST int kBindCounters = 8;
GPGP_CONST int kBindBits = 9;
GPGP_CONST int kBindList = 10;
GPGP_CONST int kBindCount = 11;
GPGP_CONST int kBindView = 12;
GPGP_CONST int kBindRecords = 13;
GPGP_CONST int kBindSizes = 14;
GPGP_CONST int kBindSlots =
    15; // words per pixel: limits (then where its list ends), list lengths; tiles; large candidates
GPGP_CONST int kBindCommands = 16;
GPGP_CONST int kBindCommandCount = 17;
GPGP_CONST int kBindDrawCommands = 18;
GPGP_CONST int kBindDrawIndices = 19;
GPGP_CONST int kBindDrawTriangles = 20;
GPGP_CONST int kBindExtents = 21;
GPGP_CONST int kBindPairs = 22; // a tile and a candidate each, then which of its pixels; by tile: candidates
GPGP_CONST int kBindTextureCoordinates = 23;
GPGP_CONST int kBindChanged = 24;
GPGP_CONST int kBindTextures = 25;              // kMaxAlphaTests in a row
GPGP_CONST int kBindOpen = kBindSamples;        // exact, once ids are gathered: pixels with lists
GPGP_CONST int kBindCandidates = kBindRecords;  // exact, once ids are drawn
GPGP_CONST int kBindEntries = kBindQueue;       // exact, once all pairs are there: candidates in lists
GPGP_CONST int kBindKeys = kBindPairs;          // exact, once lists have their places: depths of long ones' entries
GPGP_CONST int kBindSurfaces = kBindRecords;    // conservative, once ids are drawn
GPGP_CONST int kBindGaps = kBindPairs;          // conservative: words per pixel
GPGP_CONST int kBindTiles = kBindRecords;       // nearby, once ids are drawn
GPGP_CONST int kBindNumbers = kBindMeshes;      // with commands, which need no meshes: triangles' numbers
GPGP_CONST int kBindClusters = kBindCommands;   // without commands
GPGP_CONST int kBindReference = kBindPositions; // of recordings that measure, which have no geometry
GPGP_CONST int kBindReferenceCounts = kBindIndices;
GPGP_CONST int kBindRecheck = kBindDraws;
GPGP_CONST int kBindFalsePositives = kBindList;
GPGP_CONST int kBindFalseNegatives = kBindCount;

/// Words of a sample: which triangle it shows and the key of its depth, together a number of 64 bits whose least value
/// is the nearest one, and of those the lowest number.
GPGP_CONST uint kSampleWords = 2u;
GPGP_FN uint idAt(uint sample_) { return sample_ * kSampleWords; }
GPGP_FN uint depthAt(uint sample_) { return sample_ * kSampleWords + 1u; }

/// GpgpMesh
struct Mesh {
  uint firstIndex;
  uint indexCount;
  uint vertexOffset;
};

/// GpgpVisibilityDraw
struct Draw {
  float transform[12]; // rows of a 3x4 matrix
  uint mesh;
  uint firstTriangle;
  uint flags;
  uint origin; ///< in the recording's origins
};

/// One draw of a camera. Lies in the draw table, whose regions hold, for each of `maxEntries`: first item and first
/// chunk; this; of an indirect command the first entry, item and chunk; the visible triangles and their place. Behind
/// them the entry of each chunk, and with clusters the chunks that are kept.
struct DrawEntry {
  uint draw; // in GpgpVisibilityDraw[]
  uint camera;
  uint firstIndex;
  uint indexCount;
  uint vertexOffset;
};
GPGP_CONST uint kEntryWords = 5u;
GPGP_CONST uint kTableWords = 12u;  ///< of each entry, all regions together
GPGP_CONST uint kTableEntries = 2u; ///< where each region begins, times maxEntries
GPGP_CONST uint kTableCommands = 7u;
GPGP_CONST uint kTableCounts = 10u;
GPGP_CONST uint kTablePlaces = 11u;

/// Of one recording.
struct Params {
#ifdef __cplusplus
  float viewProjection[kMaxCameras * 16]; // of each camera, column-major
  float depthScales[kMaxCameras * 4];
  float cameraOrigins[kMaxCameras * 8]; // of each, what floats hold of it, then the rest; four numbers each
  float origins[kMaxOrigins * 8];
#else
  vec4 viewProjection[kMaxCameras * 4u]; // the columns
  vec4 depthScales[kMaxCameras];         // nearby: of each camera, see nearby.h
  vec4 cameraOrigins[kMaxCameras * 2u];
  vec4 origins[kMaxOrigins * 2u];
#endif
#ifdef __cplusplus
  uint cameraLayers[kMaxCameras];       // 0: all
  float alphaTests[kMaxAlphaTests * 2]; // of each, the cutoff and the texture's level
#else
  uvec4 cameraLayers[kMaxCameras / 4u];
  vec4 alphaTests[kMaxAlphaTests / 2u];
#endif
  uint cameraCount;
  uint width;
  uint height; // of each camera; they lie one below the other in the buffer of samples
  uint reversedDepth;
  uint drawCount;
  uint hasDrawCount; // 1: the buffer of the command count holds the number of draws, or of commands
  uint hasCommands;  // 1: draws come from the engine's indirect commands
  uint commandCount; // at most
  uint commandWords; // stride
  uint entryCount;   // draws of all cameras, at most
  uint maxEntries;   // capacity of the draw table
  uint meshCount;
  uint triangleCount;
  uint maxItems;       // triangles of all draws together: the recorder's budget
  uint indexCount;     // that the index range holds
  uint shortIndices;   // 1: 16 bits each
  uint vertexCount;    // that the position range holds
  uint positionFormat; // kFloats, kHalves, kSnorms
  uint positionOffset; // bytes
  uint positionStride;
  uint listCapacity;        // in triangles
  uint hasList;             // 1: visibleList is there; 2: changedList; 3: both
  uint writeCount;          // 1: visibleCount is there; 2: with the number of draws
  uint viewWords;           // 0: no view
  uint drawCommandCapacity; // in draws
  uint drawListCapacity;    // in triangles; kNoTriangle: there is no such list
  uint hasDrawIndices;
  uint hasDrawTriangles;
  uint mediumRecords; // capacities of the record buffer: its front
  uint largeRecords;  // and what follows
  uint gridShift;     // Grid::shift, and offset
  uint gridX;
  uint gridY;
  uint accumulate;    // 1: bits, pixel counts and sizes are added to
  uint hasSizes;      // 1: pixelCounts is there
  uint hasExtents;    // 1: triangleSizes is there
  uint method;        // GpgpSamplingMethod
  uint slotCapacity;  // pixels of the largest viewport, in whole tiles
  uint maxCandidates; // capacities of exact sampling
  uint maxLargeCandidates;
  uint maxPairs;
  uint pixelCapacity; // of the largest viewport of all cameras
  uint heuristics;    // GPGP_HEURISTIC_...
  float epsilonStatic;
  float epsilonDynamic;
  uint metricBuffers; // kHas... of a recording that measures
  uint numberCount;   // triangles' numbers that are there; with hasNumbers
  uint hasNumbers;    // 1: triangles have the numbers of their place among the indices
  uint clusterCount;  // of all meshes; 0: chunks are not tested
  uint originCount;   // of draws; 0: none has one
  uint hasOrigins;    // 1: draws or cameras have some
  uint allLayers;     // of all cameras together; 0: all
  uint alphaTestCount;
  uint textureFormat; // of texture coordinates: kFloats, kHalves, kUnorms
  uint textureOffset; // bytes
  uint textureStride;
  uint textureCount;    // that the range holds
  uint maxNonOpaque;    // room for triangles that are not opaque
  uint nonOpaqueAt;     // where that begins in the queue
  uint changedCapacity; // triangles that the list of changes has room for
  uint keepsDecisions;  // 1: the history has more than what was visible (reuse.h)
  uint reuse;           // 1: this recording takes decisions over
  uint reuseKey;        // of what a recording must have in common with the previous one for that
  float maxLate;        // GpgpCameraHistoryCreateInfo; a uniform block is a multiple of 16 bytes
};
GPGP_CONST uint kHasReferenceCounts = 1u;
GPGP_CONST uint kHasRecheck = 2u;
GPGP_CONST uint kHasFalsePositives = 4u;
GPGP_CONST uint kHasFalseNegatives = 8u;

/// A triangle, or a piece of a clipped one, in a pixel's list. Behind one that is not opaque lies what tells where it
/// is, in the room of another candidate.
struct Candidate {
  ivec2 p0; // ScreenTriangle, but corners in parts of kFine to a unit
  ivec2 p1;
  ivec2 p2;
  float z0;
  float dz1;
  float dz2;
  float zMin;
  float zMax;
  float inverseArea; // in such parts as well
  float slope0;      // x per y along the edges p1 p2, p2 p0, p0 p1; 0 for horizontal ones
  float slope1;
  float slope2;
  uint id;
};

/// What conservative sampling found at a pixel's centre.
struct Surface {
  float nearest; // depths within the pixel
  float farthest;
  float normalX; // of length 1, or 0
  float normalY;
  float normalZ;
};
GPGP_CONST uint kIsNonOpaque = 0x80000000u; ///< beside a candidate's triangle number
GPGP_CONST uint kPairBytes = 8u;
GPGP_CONST uint kTileWords = 3u;
GPGP_CONST uint kTilePairWords = 3u;   ///< tile, candidate, index within the list of its tile and kind, seen or not
GPGP_CONST uint kNoTile = 0xffffffffu; ///< of a pair that found no room
GPGP_CONST uint kIsSeen = 0x80000000u; ///< beside a candidate's number in its pairs: at some pixel's centre
GPGP_CONST uint kQuarters = 4u;        ///< of a pixel, each of 4 x 4 samples
GPGP_CONST uint kGapWords = 2u + kQuarters; ///< of a pixel: its covered samples; behind all, quarters' depths

/// GPU counters; the first kReportWords are the report.
struct Counters {
  uint triangles;
  uint visible;
  uint coveredPixels;
  uint appeared;
  uint disappeared;
  uint items;            // of all draws, whatever the budget; stays at 2^32 - 1
  uint skippedTriangles; // index out of range, coordinate not finite or too large, number not below triangleCount
  uint skippedDraws;     // mesh out of range
  uint listed;
  uint hasList;    // Params::hasList
  uint candidates; // exact sampling: asked for
  uint pairs;      // asked for
  uint unresolved; // triangles and pairs that found no room, whose triangles count as visible
  uint draws;      // of one camera, whatever the budget; stays at 2^32 - 1
  uint drawsGiven;
  uint drawTriangles; // visible ones of all draws: in the lists by draw, whatever their budget
  uint drawListed;
  uint reference; // triangles; this and what follows: of recordings that measure
  uint found;     // of the reference, visible
  uint falsePositives;
  uint referenceArea[2]; // samples: low word, high word
  uint foundArea[2];
  uint nonOpaque;     // triangles of alpha-tested and see-through draws, on the screen; whatever their budget
  uint changed;       // written to the list of changes
  uint decided;       // exact: triangles on the screen but at no pixel's centre that are decided
  uint reused;        // and those whose last decision is taken over
  uint decidedPixels; // that have lists
  uint ended;         // 1: the device has ended loops before their time (core/turns.h)
  uint drawChunks;    // of one camera's draws
  uint chunks;        // of all draws
  uint queueCount;    // triangles that one invocation should not draw alone
  uint mediumCount;   // records asked for
  uint largeCount;
  uint smallArgs[3]; // indirect dispatches
  uint unfoldArgs[3];
  uint mediumArgs[3];
  uint largeArgs[3];
  uint leftArgs[3];
  uint largeQueueCount; // triangles that reach over more than 8 x 8 pixels, or are clipped
  uint selectLargeArgs[3];
  uint largeCandidateCount;
  uint binLargeArgs[3];
  uint tilePairs; // of a candidate and a tile: asked for
  uint placeArgs[3];
  uint overlapCount; // conservative: triangles of more than 8 x 8 pixels
  uint overlapArgs[3];
  uint splitCount; // of more than 64 blocks of 8 x 8 pixels, or clipped
  uint splitArgs[3];
  uint placedCount; // pairs of tiles that have their place
  uint openCount;   // pixels with lists of at most kBatch
  uint openArgs[3];
  uint winnerCount; // small triangles that were nearest in a pixel when they were drawn
  uint winnerArgs[3];
  uint onScreenCount; // exact: triangles that face the viewer and reach over the viewport
  uint onScreenArgs[3];
  uint longCount; // pixels with lists of more than kBatch
  uint longArgs[3];
  uint keptCount; // chunks that may be in sight
  uint keptArgs[3];
  uint nonOpaqueArgs[3];
  uint checksum[2]; // with reuse: of all triangles on the screen
  uint reuseSeen;   // triangles at pixel centres
  uint reuseFresh;  // of these, not visible in the previous recording
  uint reuseFirst;  // of the circle of groups: where those begin that are decided
  uint reuseShare;  // and how much of it they take
  uint dueVisible;  // of these groups: triangles that are visible
  uint dueLate;     // that were on the screen and not visible before
  uint dueStale;    // that were visible and are still on the screen
};
GPGP_CONST uint kCounterWords = 103u;
GPGP_CONST uint kReportWords = 30u;

/// Whether a draw's triangles may leave open what lies behind them.
GPGP_FN bool isNonOpaque(uint flags) { return (flags & (kSeeThrough | kAlphaTestBits)) != 0u; }
GPGP_FN bool isSeeThrough(uint flags) { return (flags & kSeeThrough) != 0u; }
/// 1 and the index of a draw's alpha test; 0: none.
GPGP_FN uint alphaTestOf(uint flags) { return (flags & kAlphaTestBits) >> 8u; }
/// Whether a camera with these layers samples a draw.
GPGP_FN bool isSampledBy(uint flags, uint layers) {
  uint own = flags >> 16u;
  return (flags & kDisabled) == 0u && (own == 0u || layers == 0u || (own & layers) != 0u);
}

/// The engine's indirect dispatch over a list: a workgroup per kListGroup triangles, in rows of at most kMaxGroups.
GPGP_FN uvec3 listGroups(uint listed) {
  uint groups = (listed >> 6u) + ((listed & 63u) != 0u ? 1u : 0u);
  return uvec3(min(groups, kMaxGroups), max(groups / kMaxGroups + (groups % kMaxGroups != 0u ? 1u : 0u), 1u), 1u);
}

#ifdef __cplusplus
static_assert(kListGroup == 64);
static_assert(sizeof(Mesh) == 12 && sizeof(Draw) == 64 &&
              sizeof(Params) == kMaxCameras * 116 + kMaxOrigins * 32 + kMaxAlphaTests * 8 + 64 * 4 &&
              sizeof(DrawEntry) == 4 * kEntryWords && sizeof(Candidate) == 64 && sizeof(Surface) == 20 &&
              sizeof(Counters) == 4 * kCounterWords);
#endif

GPGP_SHADER_END
#endif
