#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#endif
// Terminal records to vertices and indices, as many records at a time as a workgroup has invocations.
//
// A prefix sum places the records' quads, one atomic addition takes room for all of them among vertices and indices
// alike; where records are in order, order.comp has placed them instead. Then vertex after vertex is made, one an
// invocation whoever's record it is of. Where the room ends within a record, none of it is written; what it leaves free
// is noted, so that what is written has no holes.
//
// How a vertex looks is in specialization constants: its words are known when the pipeline is made, and lie in
// registers. Vertices of whole 16 bytes are stored by who made them; others are staged, and copied out word after word.
#include "spawn/shared/bindings.glsl"
// the same as vertices
layout(set = 0, binding = kBindVertices, std430) writeonly buffer VertexWords { uint vertexWords[]; };

#include "core/turns.h"
#include "spawn/outputs/mesh.h"
#include "spawn/shared/shape.h"

#include "spawn/outputs/regions.glsl"
const uint groupSize = 64; // kSpawnGroupSize
const bool oneSubgroup = false;
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint stride = 4; // words of a vertex
// vertexAttribute(), or kNoAttribute.
layout(constant_id = 1) const uint attribute0 = 0;
layout(constant_id = 2) const uint attribute1 = kNoAttribute;
layout(constant_id = 3) const uint attribute2 = kNoAttribute;
layout(constant_id = 4) const uint attribute3 = kNoAttribute;
layout(constant_id = 5) const uint attribute4 = kNoAttribute;
layout(constant_id = 6) const uint attribute5 = kNoAttribute;
layout(constant_id = 7) const uint attribute6 = kNoAttribute;
layout(constant_id = 8) const uint attribute7 = kNoAttribute;
layout(constant_id = 9) const bool turnsCount = false; // the device counts turns of loops (core/turns.h)

#include "spawn/shared/lanes.glsl"

// Rules of terminals take room only where a vertex has them. Sums, as the compiler takes no || of such constants.
#define GPGP_IS_RULE(described) ((((described) >> 8) & 0xffu) == kVertexRule ? 1u : 0u)
const bool kRules = GPGP_IS_RULE(attribute0) + GPGP_IS_RULE(attribute1) + GPGP_IS_RULE(attribute2) +
                        GPGP_IS_RULE(attribute3) + GPGP_IS_RULE(attribute4) + GPGP_IS_RULE(attribute5) +
                        GPGP_IS_RULE(attribute6) + GPGP_IS_RULE(attribute7) > 0u;
shared uint rules[kRules ? groupSize : 1];

const uint kNoPlace = 0xffffffffu;
const uint kMirrored = 1u << 31;
// Records: rows of unit shape to world; numbers of attributes; geometry, and whether the axiom mirrors.
shared vec4 rows[3 * groupSize];
shared uvec4 numbers[groupSize];
shared uint geometries[groupSize];
shared uint quadsUpTo[groupSize];     // inclusive sums over the records
shared uvec2 recordPlaces[groupSize]; // of the record's first quad: in the buffers, or kNoPlace; in its region
shared uint quadBase;
shared uint fittingQuads;
// Vertices that are staged, with an odd number of words from one to the next, and the first word of each in the buffer.
const bool kStaged = stride % 4 != 0;
const uint kStagedStride = stride | 1u;
shared uint staged[kStaged ? groupSize * kStagedStride : 1];
shared uint stagedPlaces[kStaged ? groupSize : 1];

/// One word of a quad's indices; words: of a quad.
uint indexWord(uint words, uint quad, uint word) {
  const uint vertex = 4 * quad;
  if (words == 6) return vertex + quadIndex(word);
  return (vertex + quadIndex(2 * word)) | ((vertex + quadIndex(2 * word + 1)) << 16);
}

/// Places the records' quads, and stages the records. at: the place of the invocation's own. Returns how many quads all
/// have, those without room included.
uint stageRecords(uint at, bool own, uint lane) {
  const bool regions = record.regions != 0;
  const bool ordered = record.terminalsTo == kToKeyedRecords;
  Shape s;
  uint quads = 0;
  if (own) {
    const uint i = ordered ? order[orderedAt(at)] : at;
    s = unpackShape(records[i], records[i + record.maxTerminals], records[i + 2 * record.maxTerminals],
                    records[i + 3 * record.maxTerminals], records[i + 4 * record.maxTerminals], uvec4(0));
    quads = meshQuads(s.geometry);
  }
  uint total;
  const uint before = sumBefore(quads, total);
  if (lane == 0 && !regions) {
    quadBase = ordered ? order[quadsBefore(at)] : atomicAdd(bucketCounts[0], total);
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
      first = ordered ? order[quadsBefore(at)] - order[quadsBefore(bucketCounts[kBucketPlaces + bucket])]
                      : atomicAdd(bucketCounts[bucket], quads);
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
    if (kRules) rules[lane] = graphWords[s.node + kNodeRule];
    geometries[lane] = s.geometry | (isMirrored(row0, row1, row2) ? kMirrored : 0);
  }
  barrier();
  return regions ? total : fittingQuads;
}

/// The record that a quad of the batch is of. own: the quad's number in it.
uint ownerOf(uint quad, out uint own) {
  uint owner = 0; // the first whose sum lies above quad
  for (uint step = groupSize / 2; step > 0; step /= 2)
    if (quadsUpTo[owner + step - 1] <= quad) owner += step;
  own = quad - (owner > 0 ? quadsUpTo[owner - 1] : 0);
  return owner;
}

uint words[kMaxVertexWords]; // of the invocation's vertex

void putAttribute(uint described, vec3 position, vec3 normal, vec2 uv, uvec4 ofRecord, uint rule) {
  if (described == kNoAttribute) return;
  const uint semantic = attributeSemantic(described);
  const uint format = attributeFormat(described);
  vec4 value = vec4(uv, 0.0f, 0.0f);
  uint number = 0;
  if (semantic == kVertexPosition) value = vec4(position, 1.0f);
  if (semantic == kVertexNormal) value = vec4(normal, 0.0f);
  if (semantic == kVertexNormal && format == kVertexUnorm4) value = withoutSign(value);
  if (semantic == kVertexBucket) number = ofRecord.x;
  if (semantic == kVertexBucket + 1) number = ofRecord.y;
  if (semantic == kVertexBucket + 2) number = ofRecord.z;
  if (semantic == kVertexBucket + 3) number = ofRecord.w;
  if (semantic == kVertexRule) number = rule;
  const uvec4 all = attributeValue(format, value, number);
  const uint at = attributeOffset(described);
  words[at] = all.x;
  if (attributeWords(format) > 1) words[at + 1] = all.y;
  if (attributeWords(format) > 2) words[at + 2] = all.z;
}

void makeVertex(uint owner, uint quad, uint corner) {
  const uint geometry = geometries[owner] & ~kMirrored;
  const bool mirrored = (geometries[owner] & kMirrored) != 0;
  const vec4 row0 = rows[3 * owner];
  const vec4 row1 = rows[3 * owner + 1];
  const vec4 row2 = rows[3 * owner + 2];
  const uvec4 ofRecord = numbers[owner];
  const uint rule = kRules ? rules[owner] : 0;
  const MeshVertex v = meshVertex(geometry, quad, mirrored ? mirroredCorner(corner) : corner);
  const vec3 position = meshPosition(row0, row1, row2, v.position);
  const vec3 normal = meshNormal(row0, row1, row2, v, mirrored);
  for (uint i = 0; i < kMaxVertexWords; ++i) words[i] = 0; // what no attribute covers
  putAttribute(attribute0, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute1, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute2, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute3, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute4, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute5, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute6, position, normal, v.uv, ofRecord, rule);
  putAttribute(attribute7, position, normal, v.uv, ofRecord, rule);
}

void main() {
  const uint lane = laneIndex();
  const uint kept = min(state.terminals, record.maxTerminals);
  const uint indexWords = record.indexWords;
  const uint each = turnsCount ? record.recordsAtOnce : groupSize;
  for (uint batch = gl_WorkGroupID.x * each; batch < kept; batch += gl_NumWorkGroups.x * each) {
    barrier(); // the last ones have been read
    const uint all = stageRecords(batch + lane, lane < each && batch + lane < kept, lane);
    for (uint block = 0; block < 4 * all; block += groupSize) {
      const uint vertex = block + lane;
      uint place = kNoPlace; // of the vertex, in the buffer
      if (vertex < 4 * all) {
        uint quad;
        const uint owner = ownerOf(vertex >> 2, quad);
        const uint first = recordPlaces[owner].x;
        makeVertex(owner, quad, vertex & 3);
        if (first != kNoPlace) place = 4 * (first + quad) + (vertex & 3);
      }
      if (!kStaged) {
        if (place != kNoPlace)
          for (uint i = 0; i < kMaxVertexWords / 4; ++i)
            if (4 * i < stride)
              vertices[place * (stride / 4) + i] =
                  uvec4(words[4 * i], words[4 * i + 1], words[4 * i + 2], words[4 * i + 3]);
      } else {
        barrier();
        for (uint i = 0; i < kMaxVertexWords; ++i)
          if (i < stride) staged[lane * kStagedStride + i] = words[i];
        stagedPlaces[lane] = place;
        barrier();
        for (uint i = lane; i < groupSize * stride; i += groupSize) {
          const uint from = i / stride;
          if (stagedPlaces[from] != kNoPlace)
            vertexWords[stagedPlaces[from] * stride + i - from * stride] =
                staged[from * kStagedStride + i - from * stride];
        }
      }
    }
    for (uint i = lane; i < all * indexWords; i += groupSize) {
      const uint quad = indexWords == 6 ? i / 6 : i / 3;
      uvec2 places = uvec2(quadBase + quad); // all lie side by side
      if (record.regions != 0) {
        uint own;
        places = recordPlaces[ownerOf(quad, own)];
        if (places.x == kNoPlace) continue;
        places += own;
      }
      indices[places.x * indexWords + i - quad * indexWords] =
          indexWord(indexWords, places.y, i - quad * indexWords);
    }
  }
  if (turnsCount && loopsWereEnded(record.one)) atomicOr(state.ended, 1);
}
