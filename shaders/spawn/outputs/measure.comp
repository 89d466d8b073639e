#version 460
#extension GL_GOOGLE_include_directive : require
// What is measured of each axiom (measure.h), from terminal records.
//
// Records that lie together mostly belong to one axiom: a workgroup adds up those of its first record's axiom in shared
// memory, and all others where they belong. Afterwards a workgroup takes an axiom: boxes from keys, cells from bits.
#include "spawn/shared/bindings.glsl"
#include "spawn/shared/shape.h"

#include "spawn/outputs/measure.h"

layout(set = 0, binding = kBindMeasured, std430) buffer Measured { uint measured[]; }; // axioms, then their grids
layout(set = 0, binding = kBindMeasuring, std430) readonly buffer Given {
  Measuring measuring;
  uint target[]; // bits, row after row along x, then y, then z
};
layout(local_size_x = 64) in;                        // kSpawnGroupSize
layout(constant_id = 0) const bool finishes = false; // what has been gathered

shared uint ofFirst[kMeasuredWords]; // of the first record's axiom

void raise(bool shares, uint axiom, uint word, uint key) {
  const uint at = axiom * kMeasuredWords + word;
  if (shares)
    atomicMax(ofFirst[word], key);
  else if (key > measured[at])
    atomicMax(measured[at], key);
}
void addWide(uint at, uvec2 value) {
  const uint before = atomicAdd(measured[at], value.x);
  const uint high = value.y + (before + value.x < before ? 1u : 0u);
  if (high != 0u) atomicAdd(measured[at + 1u], high);
}
void addWideShared(uint word, uvec2 value) {
  const uint before = atomicAdd(ofFirst[word], value.x);
  const uint high = value.y + (before + value.x < before ? 1u : 0u);
  if (high != 0u) atomicAdd(ofFirst[word + 1u], high);
}
void addOne(bool shares, uint axiom, uint word) {
  if (shares)
    atomicAdd(ofFirst[word], 1u);
  else
    atomicAdd(measured[axiom * kMeasuredWords + word], 1u);
}

void occupy(uint axiom, vec4 rows[3], bool withoutZ) {
  uvec2 cells[3];
  for (uint axis = 0; axis < 3; ++axis) {
    cells[axis] = cellsBetween(boxLow(rows[axis], withoutZ), boxHigh(rows[axis], withoutZ), measuring.origin[axis],
                               measuring.perMetre[axis], measuring.cells[axis]);
    if (cells[axis].x > cells[axis].y) return;
  }
  const uint rowWords = measuring.cells.w;
  for (uint z = cells[2].x; z <= cells[2].y; ++z)
    for (uint y = cells[1].x; y <= cells[1].y; ++y) {
      const uint row = measuring.firstGrid + axiom * measuring.gridWords + (z * measuring.cells.y + y) * rowWords;
      for (uint word = cells[0].x / 32; word <= cells[0].y / 32; ++word) {
        const uint bits = cellBits(word, cells[0].x, cells[0].y);
        if ((measured[row + word] & bits) != bits) atomicOr(measured[row + word], bits);
      }
    }
}

void measure(Shape s, bool shares) {
  vec4 rows[3];
  for (uint axis = 0; axis < 3; ++axis) rows[axis] = instanceRow(s, uintBitsToFloat(axioms[s.axiom * 6 + axis]));
  const bool withoutZ = s.size.z == 0;
  for (uint axis = 0; axis < 3; ++axis) {
    raise(shares, s.axiom, axis, ~boundKey(boxLow(rows[axis], withoutZ)));
    raise(shares, s.axiom, axis + 3, boundKey(boxHigh(rows[axis], withoutZ)));
  }
  addOne(shares, s.axiom, kMeasuredTerminals);
  const uint terminal = graphWords[s.node + kNodeArgument];
  for (uint m = 0; m < measuring.count; ++m) {
    const uvec4 pair = measuring.measures[m / 2];
    const uvec2 wanted = (m & 1) == 0 ? pair.xy : pair.zw;
    if (wanted.x != kAllTerminals && wanted.x != terminal) continue;
    const float value = measuredValue(wanted.y, s.size, s.custom);
    if (measuresTooMuch(value)) addOne(shares, s.axiom, kMeasuredClamped);
    const uint word = kMeasuredSums + 2 * m;
    if (shares)
      addWideShared(word, fixedOf(value));
    else
      addWide(s.axiom * kMeasuredWords + word, fixedOf(value));
  }
  if (measuring.gridWords != 0) occupy(s.axiom, rows, withoutZ);
}

void gather() {
  const uint count = min(state.terminals, record.maxTerminals), lane = gl_LocalInvocationIndex;
  for (uint first = gl_WorkGroupID.x * kSpawnGroupSize; first < count; first += gl_NumWorkGroups.x * kSpawnGroupSize) {
    const uint axiom = records[first + 3 * record.maxTerminals].w;
    if (lane < kMeasuredWords) ofFirst[lane] = 0;
    barrier();
    const uint i = first + lane;
    if (i < count) {
      const Shape s = unpackShape(records[i], records[i + record.maxTerminals], records[i + 2 * record.maxTerminals],
                                  records[i + 3 * record.maxTerminals], records[i + 4 * record.maxTerminals],
                                  uvec4(0));
      if (s.axiom < measuring.axioms) measure(s, s.axiom == axiom);
    }
    barrier();
    if (axiom < measuring.axioms && lane < kMeasuredWords) {
      const uint at = axiom * kMeasuredWords + lane;
      if (lane < kMeasuredTerminals)
        atomicMax(measured[at], ofFirst[lane]);
      else if (lane < kMeasuredSums)
        atomicAdd(measured[at], ofFirst[lane]);
      else if (lane < kMeasuredCells && lane % 2 == 0)
        addWide(at, uvec2(ofFirst[lane], ofFirst[lane + 1]));
    }
    barrier();
  }
}

void finish() {
  const uint lane = gl_LocalInvocationIndex;
  for (uint axiom = gl_WorkGroupID.x; axiom < measuring.axioms; axiom += gl_NumWorkGroups.x) {
    const uint at = axiom * kMeasuredWords, grid = measuring.firstGrid + axiom * measuring.gridWords;
    if (lane < 3) measured[at + lane] = floatBitsToUint(lowOf(measured[at + lane]));
    if (lane >= 3 && lane < 6) measured[at + lane] = floatBitsToUint(highOf(measured[at + lane]));
    uint cells = 0, matching = 0;
    for (uint word = lane; word < measuring.gridWords; word += kSpawnGroupSize) {
      const uint bits = measured[grid + word];
      cells += uint(bitCount(bits));
      matching += uint(bitCount(bits & target[word]));
    }
    if (cells != 0) atomicAdd(measured[at + kMeasuredCells], cells);
    if (matching != 0) atomicAdd(measured[at + kMeasuredMatching], matching);
  }
}

void main() {
  if (finishes)
    finish();
  else
    gather();
}
