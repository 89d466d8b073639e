// The spawner's one descriptor set: binding = resource number in src/spawn/schedule/spawner.cpp.
layout(set = 0, binding = 0, std430) readonly buffer Graph { uint graphWords[]; };
layout(set = 0, binding = 0, std430) readonly buffer GraphRows { uvec4 graphRows[]; }; // the same
#include "spawn/shared/layout.h"
layout(set = 0, binding = 1, std430) readonly buffer Axioms { uvec4 axioms[]; };        // GpgpAxiom: six each
layout(set = 0, binding = 2, std430) writeonly buffer Instances { uvec4 instances[]; }; // GpgpInstance: six each
layout(set = 0, binding = 3, std430) buffer Draws { uint draws[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Count { uint instanceCount; };
layout(set = 0, binding = 5, std430) buffer Queues { uvec4 queues[]; };   // two queues of maxShapes, plane after plane
layout(set = 0, binding = 6, std430) buffer Stacks { uvec4 stacks[]; };   // one of stackShapes for each workgroup
layout(set = 0, binding = 7, std430) buffer Records { uvec4 records[]; }; // terminals, plane after plane
// Two rounds more than can be recorded: what the last one left, and emission.
layout(set = 0, binding = 8, std430) buffer Counters {
  SpawnState state;
  SpawnRound rounds[];
};
layout(set = 0, binding = 9, std430) buffer Buckets { uint bucketCounts[]; }; // kBucketWords
layout(set = 0, binding = 10, std140) uniform Constants { SpawnConstants record; };
layout(set = 0, binding = 11, std430) writeonly buffer Vertices { uvec4 vertices[]; }; // a quad: as many as its words
layout(set = 0, binding = 12, std430) writeonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 13, std430) writeonly buffer Needed { uint neededCounts[]; };
layout(set = 0, binding = 16, std430) buffer Order { uint order[]; }; // see order.comp
layout(set = 0, binding = 17, std430) readonly buffer AxiomCounter { uint axiomCounter; };
layout(set = 0, binding = 20, std430) writeonly buffer Report { SpawnState report; }; // where the host reads it
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
