// The spawner's one descriptor set: binding = resource number in src/spawn/schedule/spawner.cpp.
layout(local_size_x = 64) in; // kSpawnGroupSize
layout(constant_id = 0) const uint maxShapes = 1;
layout(constant_id = 1) const uint maxTerminals = 1;
layout(set = 0, binding = 0, std430) readonly buffer Graph { uint graphWords[]; };
#include "spawn/layout.h"
layout(set = 0, binding = 1, std430) readonly buffer Axioms { uvec4 axioms[]; }; // GpgpAxiom: six each
layout(set = 0, binding = 2, std430) writeonly buffer Instances { uvec4 instances[]; }; // GpgpInstance: six each
layout(set = 0, binding = 3, std430) buffer Draws { uint draws[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Count { uint instanceCount; };
layout(set = 0, binding = 5, std430) buffer Queues { uvec4 queues[]; };   // two queues of maxShapes, plane after plane
layout(set = 0, binding = 6, std430) buffer Records { uvec4 records[]; }; // terminals, plane after plane
layout(set = 0, binding = 7, std430) buffer State { SpawnState state; };
layout(set = 0, binding = 8, std430) buffer Buckets { uint bucketCounts[]; }; // counts, then places, kMaxBuckets each
// One round more than can be recorded: the last is emission's.
layout(set = 0, binding = 9, std430) buffer Rounds { SpawnRound rounds[]; };
layout(set = 0, binding = 10, std430) readonly buffer Constants { SpawnConstants record; };
