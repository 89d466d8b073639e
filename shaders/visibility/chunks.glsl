// Which draw a chunk of 64 triangles belongs to. Needs `params` and table.glsl.
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

uint findChunk(uint chunk) {
  uint low = 0u;
  uint high = params.entryCount - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (chunkStart(middle) <= chunk) low = middle;
    else high = middle - 1u;
  }
  return low;
}
