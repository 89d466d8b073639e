// Which draw a chunk of 64 triangles belongs to. Needs `params` and `starts`.
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };

uint findChunk(uint chunk) {
  uint low = 0u;
  uint high = params.drawCount - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (starts[middle].y <= chunk) low = middle;
    else high = middle - 1u;
  }
  return low;
}
