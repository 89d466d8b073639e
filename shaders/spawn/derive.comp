#version 460
#extension GL_GOOGLE_include_directive : require
// One round of derivation: each invocation takes a shape through its chain of operators; terminals are appended as
// records, and the children of all shapes of a workgroup are made by all its invocations together, whoever the parent.
//
// Round 0 reads axioms, later ones the queue that the round before wrote, which also left the arguments of this
// dispatch. Workgroups stride over the shapes. Space in the queue and among the records is taken by one atomic a
// workgroup. What does not fit is counted and not written.
#include "spawn/bindings.glsl"
#include "spawn/operators.h"
layout(push_constant) uniform Push { uint round; };

shared uvec4 parents[kShapePlanes][kSpawnGroupSize];
shared uint successorsOf[kSpawnGroupSize];
shared uint childrenUpTo[kSpawnGroupSize]; // inclusive sums
shared uint groupTerminals;
shared uint groupBase;
shared uint terminalBase;
shared uint hashX;
shared uint hashY;

Shape loadShape(uint index) {
  if (round == 0) {
    const uvec4 a = axioms[index * 6 + 3];
    const uvec4 b = axioms[index * 6 + 4];
    if (!hasRule(b.y)) atomicAdd(state.droppedShapes, 1);
    return axiomShape(unpackVector(a), a.w, b.x, b.y, uintBitsToFloat(b.z), index);
  }
  const uint start = (round & 1) * kShapePlanes * maxShapes + index;
  return unpackShape(queues[start], queues[start + maxShapes], queues[start + 2 * maxShapes],
                     queues[start + 3 * maxShapes], queues[start + 4 * maxShapes], queues[start + 5 * maxShapes]);
}

/// Inclusive sums of value over the workgroup, in childrenUpTo.
void prefixSum(uint value) {
  const uint lane = gl_LocalInvocationIndex;
  childrenUpTo[lane] = value;
  barrier();
  for (uint step = 1; step < kSpawnGroupSize; step *= 2) {
    const uint before = lane >= step ? childrenUpTo[lane - step] : 0;
    barrier();
    childrenUpTo[lane] += before;
    barrier();
  }
}

/// Places in the next queue. The count stays exact up to 2^30 and never wraps: usual amounts are too small for all
/// workgroups together to get there from below the limit; large ones are added with care.
uint reserve(uint total) {
  const uint limit = 0x40000000u;
  uint before = atomicAdd(rounds[round + 1].shapes, 0);
  if (total <= 0x10000u) return before < limit ? atomicAdd(rounds[round + 1].shapes, total) : before;
  for (;;) {
    if (before >= limit) return before;
    const uint found = atomicCompSwap(rounds[round + 1].shapes, before, before + total);
    if (found == before) return before;
    before = found;
  }
}

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const uint needed = round == 0 ? record.axiomCount : rounds[round].shapes;
  const uint count = round == 0 ? needed : min(needed, maxShapes);
  if (gl_GlobalInvocationID.x == 0) {
    if (count > 0) state.rounds = round + 1;
    if (round > 0) {
      state.peakShapes = max(state.peakShapes, needed);
      if (needed > count) atomicAdd(state.droppedShapes, needed - count);
    }
  }
  if (lane == 0) {
    hashX = 0;
    hashY = 0;
  }

  for (uint base = gl_WorkGroupID.x * kSpawnGroupSize; base < count; base += gl_NumWorkGroups.x * kSpawnGroupSize) {
    if (lane == 0) groupTerminals = 0;
    barrier();

    Shape s;
    ChainEnd end;
    end.kind = kEndDiscarded;
    end.count = 0;
    end.successors = 0;
    if (base + lane < count) {
      s = loadShape(base + lane);
      end = runChain(s);
    }

    // terminals
    uint place = 0;
    if (end.kind == kEndTerminal) place = atomicAdd(groupTerminals, 1);
    barrier();
    if (lane == 0 && groupTerminals > 0) terminalBase = atomicAdd(state.terminals, groupTerminals);
    barrier();
    if (end.kind == kEndTerminal) {
      const uint bucket = graphWords[s.node + kNodeArgument2];
      const uvec2 hash = terminalHash(s.key, bucket, shapeType(s));
      atomicAdd(hashX, hash.x);
      atomicAdd(hashY, hash.y);
      place += terminalBase;
      if (place < maxTerminals) {
        for (uint plane = 0; plane < kShapePlanes; ++plane) records[plane * maxTerminals + place] = packShape(s, plane);
        if (record.drawCapacity > 0) atomicAdd(bucketCounts[bucket], 1);
      }
    }

    // children
    const bool fans = end.kind == kEndFan;
    if (fans) {
      for (uint plane = 0; plane < kShapePlanes; ++plane) parents[plane][lane] = packShape(s, plane);
      successorsOf[lane] = end.successors;
    }
    prefixSum(fans ? end.count : 0); // at most kSpawnGroupSize * kMaxRepeat
    const uint total = childrenUpTo[kSpawnGroupSize - 1];
    if (lane == 0 && total > 0) {
      groupBase = reserve(total);
      const uint made = min(groupBase + total, maxShapes);
      atomicMax(rounds[round + 1].groupsX, min((made + kSpawnGroupSize - 1) / kSpawnGroupSize, record.maxGroups));
      rounds[round + 1].groupsY = 1;
      rounds[round + 1].groupsZ = 1;
    }
    barrier();
    for (uint child = lane; child < total && groupBase + child < maxShapes; child += kSpawnGroupSize) {
      uint parent = 0; // the first whose sum lies above child
      for (uint step = kSpawnGroupSize / 2; step > 0; step /= 2)
        if (childrenUpTo[parent + step - 1] <= child) parent += step;
      const Shape p = unpackShape(parents[0][parent], parents[1][parent], parents[2][parent], parents[3][parent],
                                  parents[4][parent], parents[5][parent]);
      const uint first = parent > 0 ? childrenUpTo[parent - 1] : 0;
      const Shape made = childOf(p, successorsOf[parent], child - first);
      const uint at = ((round + 1) & 1) * kShapePlanes * maxShapes + groupBase + child;
      for (uint plane = 0; plane < kShapePlanes; ++plane) queues[at + plane * maxShapes] = packShape(made, plane);
    }
    barrier();
  }

  barrier();
  if (lane == 0 && (hashX | hashY) != 0) {
    atomicAdd(state.keyHashX, hashX);
    atomicAdd(state.keyHashY, hashY);
  }
}
