// A chunk of one camera's draws, and which of its triangles belong in the lists by draw: those that are visible and
// whose indices and vertices lie inside their ranges, so that the engine can draw what is listed.
#include "visibility/shared/fetch.glsl"
#include "visibility/shared/chunks.glsl"
layout(local_size_x = 64) in; // kChunk

layout(std430, set = 0, binding = kBindBits) readonly buffer BitBuffer { uint bits[]; };

struct Listed {
  uint entry;
  uint id;
  uint index; // of its first corner in the engine's indices
  bool listed;
};

Listed listedOf(uint chunk) {
  Listed l;
  l.entry = 0u; // this list has no budget of items, so the chunk may not be in the table
  uint high = params.entryCount - 1u;
  while (l.entry < high) {
    uint middle = l.entry + (high - l.entry + 1u) / 2u;
    if (chunkStart(middle) <= chunk) l.entry = middle;
    else high = middle - 1u;
  }
  l.id = 0u;
  l.index = 0u;
  l.listed = false;
  DrawEntry e = entryOf(l.entry);
  if (!isSampledBy(draws[e.draw].flags, params.allLayers)) return l;
  uint local = (chunk - chunkStart(l.entry)) * kChunk + gl_LocalInvocationIndex;
  if (local >= e.indexCount / 3u) return l;
  l.index = e.firstIndex + local * 3u;
  if (!fetchId(e, draws[e.draw].firstTriangle, local, l.id)) return l;
  if ((bits[l.id >> 5u] & (1u << (l.id & 31u))) == 0u) return l;
  uint vertex;
  l.listed = l.index >= e.firstIndex && l.index <= 0xfffffffdu && fetchPlace(e, l.index, vertex) &&
             fetchPlace(e, l.index + 1u, vertex) && fetchPlace(e, l.index + 2u, vertex);
  return l;
}
