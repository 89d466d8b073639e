// The draw table: words in regions of params.maxEntries each (layout.h). Needs `params`, and TABLE_ACCESS.
layout(std430, set = 0, binding = kBindTable) TABLE_ACCESS buffer TableBuffer { uint table[]; };

/// First item and first chunk of an entry.
uvec2 startOf(uint entry) { return uvec2(table[entry * 2u], table[entry * 2u + 1u]); }
uint chunkStart(uint entry) { return table[entry * 2u + 1u]; }

/// Where a chunk's entry is, and for how many there is room: more are beyond the budget of items.
uint chunkAt(uint chunk) { return params.maxEntries * kTableWords + chunk; }
uint chunkCapacity() { return params.maxItems / kChunk + params.maxEntries + 1u; }

/// Where the number of a chunk that may be in sight is.
uint keptAt(uint i) { return chunkAt(chunkCapacity()) + i; }

DrawEntry entryOf(uint entry) {
  uint at = params.maxEntries * kTableEntries + entry * kEntryWords;
  DrawEntry e;
  e.draw = table[at];
  e.camera = table[at + 1u];
  e.firstIndex = table[at + 2u];
  e.indexCount = table[at + 3u];
  e.vertexOffset = table[at + 4u];
  return e;
}
