// Writes entries of the draw table. Needs table.glsl.
void writeEntry(uint entry, uint item, uint chunk, DrawEntry e) {
  table[entry * 2u] = item;
  table[entry * 2u + 1u] = chunk;
  uint at = params.maxEntries * kTableEntries + entry * kEntryWords;
  table[at] = e.draw;
  table[at + 1u] = e.camera;
  table[at + 2u] = e.firstIndex;
  table[at + 3u] = e.indexCount;
  table[at + 4u] = e.vertexOffset;
  table[params.maxEntries * kTableCounts + entry] = 0u;
}

/// An entry that no item and no chunk belongs to.
void writeNone(uint entry) {
  DrawEntry none;
  none.draw = 0u;
  none.camera = 0u;
  none.firstIndex = 0u;
  none.indexCount = 0u;
  none.vertexOffset = 0u;
  writeEntry(entry, 0xffffffffu, 0xffffffffu, none);
}

/// Sums and products stay at 2^32 - 1: more is beyond every budget.
uint saturatedSum(uint a, uint b) { return a + b < a ? 0xffffffffu : a + b; }
uint saturatedProduct(uint a, uint b) {
  uint high;
  uint low;
  umulExtended(a, b, high, low);
  return high != 0u ? 0xffffffffu : low;
}
uint chunksOf(uint triangles) { return triangles / kChunk + (triangles % kChunk != 0u ? 1u : 0u); }
