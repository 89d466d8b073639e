// The spawner's one descriptor set (layout.h has the bindings).
#include "spawn/shared/layout.h"
layout(set = 0, binding = kBindGraph, std430) readonly buffer Graph { uint graphWords[]; };
layout(set = 0, binding = kBindGraph, std430) readonly buffer GraphRows { uvec4 graphRows[]; }; // the same
layout(set = 0, binding = kBindAxioms, std430) readonly buffer Axioms { uvec4 axioms[]; };        // GpgpAxiom: six each
// GpgpInstance: six each
layout(set = 0, binding = kBindInstances, std430) writeonly buffer Instances { uvec4 instances[]; };
layout(set = 0, binding = kBindDraws, std430) buffer Draws { uint draws[]; };
layout(set = 0, binding = kBindCount, std430) writeonly buffer Count { uint instanceCount; };
// two queues of maxShapes, plane after plane
layout(set = 0, binding = kBindQueues, std430) buffer Queues { uvec4 queues[]; };
// one of stackShapes for each workgroup
layout(set = 0, binding = kBindStacks, std430) buffer Stacks { uvec4 stacks[]; };
layout(set = 0, binding = kBindRecords, std430) buffer Records { uvec4 records[]; }; // terminals, plane after plane
// Two rounds more than can be recorded: what the last one left, and emission.
layout(set = 0, binding = kBindCounters, std430) buffer Counters {
  SpawnState state;
  SpawnRound rounds[];
};
layout(set = 0, binding = kBindBuckets, std430) buffer Buckets { uint bucketCounts[]; }; // kBucketWords
layout(set = 0, binding = kBindConstants, std140) uniform Constants { SpawnConstants record; };
// a quad: as many as its words
layout(set = 0, binding = kBindVertices, std430) writeonly buffer Vertices { uvec4 vertices[]; };
layout(set = 0, binding = kBindIndices, std430) writeonly buffer Indices { uint indices[]; };
layout(set = 0, binding = kBindNeeded, std430) writeonly buffer Needed { uint neededCounts[]; };
layout(set = 0, binding = kBindOrder, std430) buffer Order { uint order[]; }; // see order.comp
layout(set = 0, binding = kBindAxiomCounter, std430) readonly buffer AxiomCounter { uint axiomCounter; };
// where the host reads it
layout(set = 0, binding = kBindReport, std430) writeonly buffer Report { SpawnState report; };
layout(set = 0, binding = kBindRanges, std430) buffer Ranges { uint axiomRanges[]; }; // kRangeWords each
// of the world: those of all fields (field.h)
layout(set = 0, binding = kBindFields, std430) readonly buffer Fields { uint fieldWords[]; };
/// Where in order[] the record is that comes at a place.
uint orderedAt(uint place) { return 3 * record.maxTerminals + place; }
/// Where in order[] it says how many quads come before a place, up to that behind the last record.
uint quadsBefore(uint place) { return record.maxTerminals + place; }
/// Workgroups of the passes that take a record an invocation.
void dispatchRecords(uint kept) {
  const uint last = rounds.length() - 1;
  rounds[last].groupsX = min((kept + kSpawnGroupSize - 1) / kSpawnGroupSize, record.maxGroups * 16);
  rounds[last].groupsY = 1;
  rounds[last].groupsZ = 1;
}
