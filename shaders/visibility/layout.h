// What lies in buffers: structs and numbers that the CPU writes, the passes share and reports hold.
//
// Guarantees: one layout in std430 and C++ (only 4-byte members).
#ifndef GPGP_SHADERS_VISIBILITY_LAYOUT_H
#define GPGP_SHADERS_VISIBILITY_LAYOUT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kNoTriangle = 0xffffffffu; ///< in the id buffer: nothing
GPGP_CONST uint kFarthest = 0xffffffffu;   ///< in the depth buffer: nothing
GPGP_CONST uint kTwoSided = 1u;            ///< GPGP_DRAW_TWO_SIDED
GPGP_CONST uint kMaxViewport = 8192u;      ///< pixels; edge functions stay below 2^48 up to here
GPGP_CONST uint kMaxGroups = 65535u;       ///< workgroups per dimension that every device offers
GPGP_CONST uint kListGroup = 64u;          ///< listed triangles per workgroup of the engine's indirect dispatch
GPGP_CONST uint kLargeSplit = 32u;         ///< workgroups that share one large triangle at most
GPGP_CONST uint kSliceBlocks = 256u;       ///< blocks of 8 x 8 pixels that one workgroup is given at least
GPGP_CONST uint kChunk = 64u;              ///< triangles of one draw that a workgroup takes at a time
GPGP_CONST uint kNoRecord = 0x80000000u;   ///< flag of a queued item whose triangles found no record

/// Binding numbers of set 0, which are resource numbers of the pass list.
GPGP_CONST int kBindParams = 0;
GPGP_CONST int kBindPositions = 1;
GPGP_CONST int kBindIndices = 2;
GPGP_CONST int kBindDraws = 3;
GPGP_CONST int kBindMeshes = 4;
GPGP_CONST int kBindStarts = 5;
GPGP_CONST int kBindQueue = 6;
GPGP_CONST int kBindDepth = 7;
GPGP_CONST int kBindIds = 8;
GPGP_CONST int kBindCounters = 9;
GPGP_CONST int kBindBits = 10;
GPGP_CONST int kBindList = 11;
GPGP_CONST int kBindCount = 12;
GPGP_CONST int kBindView = 13;
GPGP_CONST int kBindRecords = 14;

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
  uint reserved;
};

/// Of one record.
struct Params {
  float viewProjection[16]; // column-major
  uint width;
  uint height;
  uint reversedDepth;
  uint drawCount;
  uint meshCount;
  uint triangleCount;
  uint maxItems;     // triangles of all draws together: the sampler's budget
  uint indexCount;   // that the index range holds
  uint shortIndices; // 1: 16 bits each
  uint vertexCount;  // that the position range holds
  uint strideWords;
  uint listCapacity;  // in triangles
  uint hasList;       // 1: visibleList is there
  uint writeCount;    // 1: visibleCount is there
  uint viewWords;     // 0: no view
  uint mediumRecords; // capacities of the record buffer: its front
  uint largeRecords;  // and what follows
};

/// GPU counters; the words up to `hasList` inclusive are the report.
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
  uint hasList;     // 1: the record has a list
  uint chunks;      // of all draws
  uint queueCount;  // triangles that one invocation should not draw alone
  uint mediumCount; // records asked for
  uint largeCount;
  uint smallArgs[3]; // indirect dispatches
  uint unfoldArgs[3];
  uint mediumArgs[3];
  uint largeArgs[3];
  uint leftArgs[3];
};
GPGP_CONST uint kCounterWords = 29u;
GPGP_CONST uint kReportWords = 10u;

/// The engine's indirect dispatch over a list: a workgroup per kListGroup triangles, in rows of at most kMaxGroups.
GPGP_FN uvec3 listGroups(uint listed) {
  uint groups = (listed >> 6u) + ((listed & 63u) != 0u ? 1u : 0u);
  return uvec3(min(groups, kMaxGroups), max(groups / kMaxGroups + (groups % kMaxGroups != 0u ? 1u : 0u), 1u), 1u);
}

#ifdef __cplusplus
static_assert(kListGroup == 64);
static_assert(sizeof(Mesh) == 12 && sizeof(Draw) == 64 && sizeof(Params) == 132 &&
              sizeof(Counters) == 4 * kCounterWords);
#endif

GPGP_SHADER_END
#endif
