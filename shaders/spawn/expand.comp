#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#endif
// Terminal records to vertices and indices, as many records at a time as a workgroup has invocations.
//
// A prefix sum places the records' quads, one atomic addition takes room for all of them among vertices and indices
// alike. Then each invocation makes the four vertices of a quad, whoever's record it is of, in shared memory, and the
// workgroup copies them out, 16 bytes an invocation side by side. Where the room ends within a record, none of it is
// written; what it leaves free is noted, so that what is written has no holes.
#include "spawn/bindings.glsl"

#include "spawn/mesh.h"
#include "spawn/shape.h"

#include "spawn/regions.glsl"
layout(constant_id = 0) const uint groupSize = 64;
layout(constant_id = 1) const uint stageWords = 2048; // for vertices: kExpandWordsEach an invocation
layout(local_size_x_id = 0) in;

#include "spawn/lanes.glsl"

const uint kNoPlace = 0xffffffffu;
// Records: rows of unit shape to world; numbers of attributes; geometry, and whether the axiom mirrors.
shared vec4 rows[3 * groupSize];
shared uvec4 numbers[groupSize];
shared uint geometries[groupSize];
shared uint quadsUpTo[groupSize]; // inclusive sums over the records
shared uvec2 recordPlaces[groupSize]; // regions: of the record's first quad in the buffers, and in its region
shared uvec2 quadPlaces[groupSize];   // the same of the quads in stage
shared uint quadBase;
shared uint fittingQuads;
// Vertices word by word: that of corner c of quad q lies at word * wordStride + c * cornerStride + q, so that neither
// those who make vertices nor those who copy them out meet in a bank.
shared uint stage[stageWords];

const uint kMirrored = 1u << 31;

/// One word of a quad's indices; words: of a quad.
uint indexWord(uint words, uint quad, uint word) {
  const uint vertex = 4 * quad;
  if (words == 6) return vertex + quadIndex(word);
  return (vertex + quadIndex(2 * word)) | ((vertex + quadIndex(2 * word + 1)) << 16);
}

void stageValue(uint described, vec4 value, uint number, uint at, uint wordStride) {
  const uint format = attributeFormat(described);
  if (format == kVertexUnorm4 && attributeSemantic(described) == kVertexNormal) value = withoutSign(value);
  const uvec4 words = attributeValue(format, value, number);
  const uint count = attributeWords(format);
  at += attributeOffset(described) * wordStride;
  stage[at] = words.x;
  if (count > 1) stage[at + wordStride] = words.y;
  if (count > 2) stage[at + 2 * wordStride] = words.z;
}

/// The four vertices of a record's quad.
void stageQuad(uint owner, uint quad, uint place, uint cornerStride) {
  const uint geometry = geometries[owner] & ~kMirrored;
  const bool mirrored = (geometries[owner] & kMirrored) != 0;
  const vec4 row0 = rows[3 * owner];
  const vec4 row1 = rows[3 * owner + 1];
  const vec4 row2 = rows[3 * owner + 2];
  vec3 normal = vec3(0.0f);
  const uint wordStride = 4 * cornerStride + 1;
  for (uint corner = 0; corner < 4; ++corner) {
    const MeshVertex v = meshVertex(geometry, quad, mirrored ? mirroredCorner(corner) : corner);
    if (corner == 0) normal = meshNormal(row0, row1, row2, v, mirrored); // of the whole quad
    const vec3 position = meshPosition(row0, row1, row2, v.position);
    const uint at = place + corner * cornerStride;
    for (uint i = 0; i < record.attributeCount; ++i) {
      const uint described = record.attributes[i];
      const uint semantic = attributeSemantic(described);
      vec4 value = vec4(v.uv, 0.0f, 0.0f);
      uint number = 0;
      if (semantic == kVertexPosition) value = vec4(position, 1.0f);
      if (semantic == kVertexNormal) value = vec4(normal, 0.0f);
      if (semantic >= kVertexBucket) number = numbers[owner][(semantic - kVertexBucket) & 3];
      stageValue(described, value, number, at, wordStride);
    }
  }
}

/// Places the records' quads, and stages the records. Returns how many quads all have.
uint stageRecords(uint i, bool own, uint lane) {
  const bool regions = record.regions != 0;
  Shape s;
  uint quads = 0;
  if (own) {
    s = unpackShape(records[i], records[i + record.maxTerminals], records[i + 2 * record.maxTerminals],
                    records[i + 3 * record.maxTerminals], records[i + 4 * record.maxTerminals], uvec4(0));
    quads = meshQuads(s.geometry);
  }
  uint total;
  const uint before = sumBefore(quads, total);
  if (lane == 0 && !regions) {
    quadBase = atomicAdd(bucketCounts[0], total);
    fittingQuads = min(total, record.quadCapacity - min(quadBase, record.quadCapacity));
  }
  barrier();
  quadsUpTo[lane] = before + quads;
  if (quads > 0) {
    const uint bucket = graphWords[s.node + kNodeArgument2];
    uint first = quadBase + before; // in the region
    uint start = 0;                 // of the region
    uint capacity = record.quadCapacity;
    uint gap = kBucketGaps;
    if (regions) {
      first = atomicAdd(bucketCounts[bucket], quads);
      start = regionStart(bucket, true);
      capacity = regionCapacity(bucket, true);
      gap = kBucketGaps + bucket;
    }
    const bool fits = first < capacity && quads <= capacity - first;
    if (!fits && first < capacity) { // the only one that does so
      bucketCounts[gap] = capacity - first;
      if (!regions) fittingQuads = before;
    }
    recordPlaces[lane] = uvec2(fits ? start + first : kNoPlace, first);
    const uint axiom = s.axiom * 6;
    const vec4 row0 = instanceRow(s, uintBitsToFloat(axioms[axiom]));
    const vec4 row1 = instanceRow(s, uintBitsToFloat(axioms[axiom + 1]));
    const vec4 row2 = instanceRow(s, uintBitsToFloat(axioms[axiom + 2]));
    rows[3 * lane] = row0;
    rows[3 * lane + 1] = row1;
    rows[3 * lane + 2] = row2;
    numbers[lane] = uvec4(bucket, axioms[axiom + 4].x, graphWords[s.node + kNodeArgument], s.seed);
    geometries[lane] = s.geometry | (isMirrored(row0, row1, row2) ? kMirrored : 0);
  }
  barrier();
  return regions ? total : fittingQuads;
}

void main() {
  const uint lane = laneIndex();
  const bool regions = record.regions != 0;
  const uint kept = min(state.terminals, record.maxTerminals);
  const uint stride = record.strideWords;
  // Quads of a block: as many as there are invocations, or as find room in stage.
  const uint together = min(groupSize, ((stageWords / stride - 1) / 4) - 8);
  const uint cornerStride = together + 8;
  const uint wordStride = 4 * cornerStride + 1;
  for (uint i = lane; i < stride * wordStride; i += groupSize) stage[i] = 0; // what no attribute covers
  for (uint batch = gl_WorkGroupID.x * groupSize; batch < kept; batch += gl_NumWorkGroups.x * groupSize) {
    barrier();
    const uint all = stageRecords(batch + lane, batch + lane < kept, lane);
    for (uint block = 0; block < all; block += together) {
      const uint count = min(together, all - block);
      if (lane < count) {
        const uint quad = block + lane;
        uint owner = 0; // the first whose sum lies above quad
        for (uint step = groupSize / 2; step > 0; step /= 2)
          if (quadsUpTo[owner + step - 1] <= quad) owner += step;
        const uint own = quad - (owner > 0 ? quadsUpTo[owner - 1] : 0);
        stageQuad(owner, own, lane, cornerStride);
        if (regions) {
          const uvec2 place = recordPlaces[owner];
          quadPlaces[lane] = uvec2(place.x == kNoPlace ? kNoPlace : place.x + own, place.y + own);
        }
      }
      barrier();
      const uint target = (quadBase + block) * stride;
      // 16 bytes each: word and vertex of the first four, from one turn to the next without a division.
      uint vertex = 4 * lane / stride;
      uint word = 4 * lane - vertex * stride;
      const uint vertexStep = 4 * groupSize / stride;
      const uint wordStep = 4 * groupSize - vertexStep * stride;
      for (uint i = lane; i < count * stride; i += groupSize) {
        uvec4 words;
        uint w = word;
        uint v = vertex;
        for (uint c = 0; c < 4; ++c) {
          words[c] = stage[w * wordStride + (v & 3) * cornerStride + (v >> 2)];
          w += 1;
          if (w == stride) {
            w = 0;
            v += 1;
          }
        }
        if (!regions) {
          vertices[target + i] = words;
        } else {
          const uint quad = vertex >> 2;
          const uint place = quadPlaces[quad].x;
          if (place != kNoPlace) vertices[place * stride + i - quad * stride] = words;
        }
        word += wordStep;
        vertex += vertexStep;
        if (word >= stride) {
          word -= stride;
          vertex += 1;
        }
      }
      if (regions)
        for (uint i = lane; i < count * record.indexWords; i += groupSize) {
          const uint quad = record.indexWords == 6 ? i / 6 : i / 3;
          const uint word = i - quad * record.indexWords;
          const uvec2 place = quadPlaces[quad];
          if (place.x != kNoPlace)
            indices[place.x * record.indexWords + word] = indexWord(record.indexWords, place.y, word);
        }
      barrier();
    }
    if (!regions)
      for (uint i = lane; i < all * record.indexWords; i += groupSize) {
        const uint quad = record.indexWords == 6 ? i / 6 : i / 3;
        indices[quadBase * record.indexWords + i] =
            indexWord(record.indexWords, quadBase + quad, i - quad * record.indexWords);
      }
  }
}
