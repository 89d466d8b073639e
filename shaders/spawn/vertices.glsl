// Terminals to vertices and indices, a workgroup's together.
//
// Each invocation gives the quads of its terminal; a prefix sum places them, one atomic addition takes room for all of
// them among vertices and indices alike. Then the workgroup makes vertex after vertex, one an invocation whoever's
// terminal, in shared memory, and copies them out, 16 bytes an invocation side by side. Where the room ends within a
// terminal, none of it is written; what it leaves free is noted, so that what is written has no holes.

shared uvec4 vertexWords[vertexStage * groupSize + 1]; // one more, as none is not allowed
shared uvec4 staged[vertexStage > 0 ? 6 * groupSize : 1]; // terminals
shared uvec2 quadPlaces[groupSize / 4]; // regions: of the quads in vertexWords, in the buffers and in their region
shared uint fittingQuads;
const uint kNoPlace = 0xffffffffu;

/// Words that no attribute covers stay zero.
void clearVertexWords() {
  for (uint i = laneIndex(); i < vertexStage * groupSize; i += groupSize) vertexWords[i] = uvec4(0);
}

/// One word of a quad's indices; words: of a quad.
uint indexWord(uint words, uint quad, uint word) {
  const uint vertex = 4 * quad;
  if (words == 6) return vertex + quadIndex(word);
  return (vertex + quadIndex(2 * word)) | ((vertex + quadIndex(2 * word + 1)) << 16);
}

/// Vertex of the terminal that invocation `owner` staged, to its place in shared memory.
void makeVertex(uint owner, uint quad, uint corner, uint place) {
  const vec4 row0 = uintBitsToFloat(staged[owner * 6]);
  const vec4 row1 = uintBitsToFloat(staged[owner * 6 + 1]);
  const vec4 row2 = uintBitsToFloat(staged[owner * 6 + 2]);
  const uvec4 numbers = staged[owner * 6 + 3];
  const uint geometry = staged[owner * 6 + 5].x;
  const bool mirrored = staged[owner * 6 + 5].y != 0;
  const MeshVertex v = meshVertex(geometry, quad, mirrored ? mirroredCorner(corner) : corner);
  const vec3 position = meshPosition(row0, row1, row2, v.position);
  const vec3 normal = meshNormal(row0, row1, row2, v, mirrored);
  for (uint i = 0; i < record.attributeCount; ++i) {
    const uint described = record.attributes[i];
    const uint semantic = attributeSemantic(described);
    const uint format = attributeFormat(described);
    vec4 value = vec4(v.uv, 0.0f, 0.0f);
    if (semantic == kVertexPosition) value = vec4(position, 1.0f);
    if (semantic == kVertexNormal) value = vec4(normal, 0.0f);
    if (semantic == kVertexNormal && format == kVertexUnorm4) value = withoutSign(value);
    const uvec4 words = attributeValue(format, value, numbers[(semantic - kVertexBucket) & 3]);
    const uint count = attributeWords(format);
    const uint at = place + attributeOffset(described);
    vertexWords[at >> 2][at & 3] = words.x;
    if (count > 1) vertexWords[(at + 1) >> 2][(at + 1) & 3] = words.y;
    if (count > 2) vertexWords[(at + 2) >> 2][(at + 2) & 3] = words.z;
  }
}

/// Returns how many steps of a workgroup's work it was.
uint emitVertices(bool own, uint count, Shape s) {
  if (count == 0) return 0;
  const uint lane = laneIndex();
  uint quads = 0;
  uint bucket = 0;
  if (own) {
    quads = meshQuads(s.geometry);
    bucket = graphWords[s.node + kNodeArgument2];
  }
  uint total;
  const uint before = sumBefore(quads, total);
  if (lane == 0) atomicAdd(state.terminals, count);
  if (record.terminalsTo == kToCounts) {
    if (quads > 0) atomicAdd(bucketCounts[bucket], quads);
    return 0;
  }
  if (total == 0) return 0;

  const bool regions = record.regions != 0;
  if (lane == 0 && !regions) {
    terminalBase = atomicAdd(bucketCounts[0], total);
    fittingQuads = min(total, record.quadCapacity - min(terminalBase, record.quadCapacity));
  }
  barrier();
  uint first = terminalBase + before; // in the region
  uint start = 0;                     // of the region
  uint capacity = record.quadCapacity;
  uint gap = kBucketGaps;
  if (regions && quads > 0) {
    first = atomicAdd(bucketCounts[bucket], quads);
    start = regionStart(bucket, true);
    capacity = regionCapacity(bucket, true);
    gap = kBucketGaps + bucket;
  }
  const bool fits = first < capacity && quads <= capacity - first;
  if (quads > 0) {
    if (!fits && first < capacity) { // the only one that does so
      bucketCounts[gap] = capacity - first;
      if (!regions) fittingQuads = before;
    }
    const uint axiom = s.axiom * 6;
    const vec4 row0 = instanceRow(s, uintBitsToFloat(axioms[axiom]));
    const vec4 row1 = instanceRow(s, uintBitsToFloat(axioms[axiom + 1]));
    const vec4 row2 = instanceRow(s, uintBitsToFloat(axioms[axiom + 2]));
    staged[lane * 6] = floatBitsToUint(row0);
    staged[lane * 6 + 1] = floatBitsToUint(row1);
    staged[lane * 6 + 2] = floatBitsToUint(row2);
    staged[lane * 6 + 3] = uvec4(bucket, axioms[axiom + 4].x, graphWords[s.node + kNodeArgument], s.seed);
    staged[lane * 6 + 5] = uvec4(s.geometry, isMirrored(row0, row1, row2) ? 1 : 0, 0, 0);
  }
  staged[lane * 6 + 4] = uvec4(before + quads, before, fits ? start + first : kNoPlace, first);
  barrier();

  const uint stride = record.strideWords;
  const uint together = min(groupSize / 4, vertexStage * groupSize / stride); // quads
  const uint all = regions ? total : fittingQuads;
  for (uint block = 0; block < all; block += together) {
    const uint count = min(together, all - block);
    if (lane < 4 * count) {
      const uint quad = block + lane / 4;
      uint owner = 0; // the first whose sum lies above quad
      for (uint step = groupSize / 2; step > 0; step /= 2)
        if (staged[(owner + step - 1) * 6 + 4].x <= quad) owner += step;
      const uvec4 place = staged[owner * 6 + 4];
      makeVertex(owner, quad - place.y, lane & 3, lane * stride);
      if (regions && (lane & 3) == 0) {
        const uint offset = quad - place.y;
        quadPlaces[lane / 4] = uvec2(place.z == kNoPlace ? kNoPlace : place.z + offset, place.w + offset);
      }
    }
    barrier();
    if (!regions) {
      const uint target = (terminalBase + block) * stride;
      for (uint i = lane; i < count * stride; i += groupSize) vertices[target + i] = vertexWords[i];
    } else {
      for (uint i = lane; i < count * stride; i += groupSize) {
        const uint quad = i / stride;
        const uint target = quadPlaces[quad].x;
        if (target != kNoPlace) vertices[target * stride + i - quad * stride] = vertexWords[i];
      }
      for (uint i = lane; i < count * record.indexWords; i += groupSize) {
        const uint quad = record.indexWords == 6 ? i / 6 : i / 3;
        const uint word = i - quad * record.indexWords;
        const uvec2 place = quadPlaces[quad];
        if (place.x != kNoPlace)
          indices[place.x * record.indexWords + word] = indexWord(record.indexWords, place.y, word);
      }
    }
    barrier();
  }
  if (!regions && record.indexWords > 0)
    for (uint i = lane; i < all * record.indexWords; i += groupSize) {
      const uint quad = record.indexWords == 6 ? i / 6 : i / 3;
      indices[terminalBase * record.indexWords + i] =
          indexWord(record.indexWords, terminalBase + quad, i - quad * record.indexWords);
    }
  barrier();
  return all / groupSize;
}
