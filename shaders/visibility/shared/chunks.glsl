// Which draw a chunk of 64 triangles belongs to. Needs `params` and table.glsl.
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

uint chunkCount() { return min(counters.chunks, chunkCapacity()); }
uint findChunk(uint chunk) { return table[chunkAt(chunk)]; }

/// Those that may be in sight, in any order: where there are no clusters, all.
uint keptCount() { return params.clusterCount != 0u ? counters.keptCount : chunkCount(); }
uint keptChunk(uint i) { return params.clusterCount != 0u ? table[keptAt(i)] : i; }
