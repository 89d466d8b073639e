// One round of derivation. A workgroup takes shapes from the round's queue and derives all that comes of them by
// itself, depth first by batches, with a stack of its own: most derivations end in the round in which they began.
//
// A batch is one shape for each invocation, waiting for an operator that multiplies. Step by step its children are
// made, one an invocation whoever the parent, and each goes through its chain of operators until it is a terminal, or
// waits in its turn: on the stack, or, in the batch's last step, where it is, as a part of the next batch. Terminals
// leave at once, a workgroup's together. A batch ends with a full step: parents whose children are too many for that go
// back to the stack, one perhaps with a part of them made.
// Work goes over to the next round, through the other queue, where a round began with too few shapes to keep the device
// busy and a workgroup has enough to give (`spread`), where most workgroups have finished, where the stack is full, and
// after `steps`, so that no workgroup runs for ever. Round 0 reads axioms. What does not fit the queue is counted and
// dropped.
//
// Kernels of grammars with Collider or IfCollides (GPGP_COLLIDERS) derive in phases, each with rounds of its own. A
// shape that comes to an IfCollides of a later phase goes to a third queue, where the first round of each phase finds
// it.
layout(constant_id = 0) const uint groupSize = 64;
layout(constant_id = 1) const uint stackShapes = 1024;
layout(local_size_x_id = 0) in;
#ifdef GPGP_COLLIDERS
layout(push_constant) uniform Push {
  uint round;
  uint phase;
  uint firstRound; // of the phase
};
#else
layout(push_constant) uniform Push { uint round; };
#endif

shared uvec2 fans[groupSize];         // of the parents: successors, length
shared uint childrenUpTo[groupSize];  // of the parents: inclusive sums
shared uint stackSize;
shared uint taken;
shared uint terminalBase;
shared uint queueBase;
shared uint hashX;
shared uint hashY;
shared uint deepest;

#include "spawn/lanes.glsl"

/// A barrier for the workgroup's stack as well. It stands before the stack is read, when what was written has long
/// arrived, not after it is written, where everybody would wait.
void stackBarrier() {
  controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsBuffer | gl_StorageSemanticsShared,
                 gl_SemanticsAcquireRelease);
}

Shape axiomAt(uint index) {
  const uvec4 a = axioms[index * 6 + 3];
  const uvec4 b = axioms[index * 6 + 4];
  if (!hasRule(b.y)) atomicAdd(state.droppedShapes, 1);
  return axiomShape(unpackVector(a), a.w, b.x, b.y, uintBitsToFloat(b.z), index);
}
Shape queuedAt(uint index) {
#ifdef GPGP_COLLIDERS
  const uint queue = round == firstRound ? 2 : round & 1;
#else
  const uint queue = round & 1;
#endif
  const uint start = queue * kShapePlanes * record.maxShapes + index;
  return unpackShape(queues[start], queues[start + record.maxShapes], queues[start + 2 * record.maxShapes],
                     queues[start + 3 * record.maxShapes], queues[start + 4 * record.maxShapes],
                     queues[start + 5 * record.maxShapes]);
}
/// The batch's parents lie behind the stack: in shared memory they would take most of it, and fewer workgroups would be
/// resident.
const uint stackRoom = stackShapes - groupSize;
uint stackPlane(uint plane) { return (gl_WorkGroupID.x * kShapePlanes + plane) * stackShapes; }
Shape stackedAt(uint index) {
  return unpackShape(stacks[stackPlane(0) + index], stacks[stackPlane(1) + index], stacks[stackPlane(2) + index],
                     stacks[stackPlane(3) + index], stacks[stackPlane(4) + index], stacks[stackPlane(5) + index]);
}
Shape parentAt(uint index) { return stackedAt(stackRoom + index); }

/// Moves the stack to the next round's queue.
void giveAway() {
  const uint lane = laneIndex();
  const uint count = stackSize;
  if (lane == 0) {
    queueBase = atomicAdd(rounds[round + 1].shapes, count); // stays far below 2^32: steps and groups are bounded
    const uint held = min(queueBase + count, record.maxShapes);
    atomicMax(rounds[round + 1].groupsX, min(held, record.maxGroups));
    rounds[round + 1].groupsY = 1;
    rounds[round + 1].groupsZ = 1;
  }
  stackBarrier();
  const uint target = ((round + 1) & 1) * kShapePlanes * record.maxShapes + queueBase;
  const uint fitting = queueBase < record.maxShapes ? min(count, record.maxShapes - queueBase) : 0;
  for (uint plane = 0; plane < kShapePlanes; ++plane)
    for (uint i = lane; i < fitting; i += groupSize)
      queues[target + plane * record.maxShapes + i] = stacks[stackPlane(plane) + i];
  if (lane == 0) stackSize = 0;
  barrier();
}

/// Rounds of the phase behind this one. What goes over from the last is dropped, so that nothing is given away there by
/// choice.
uint roundsLeft() {
#ifdef GPGP_COLLIDERS
  const uint number = round - firstRound;
#else
  const uint number = round;
#endif
  return record.phaseRounds - 1 - number;
}

/// Whether a workgroup should give away its shapes, as most others have nothing left to do. That takes another round,
/// so another one must be left for what may have to go over there; and never more than half of the room of a queue.
bool othersIdle(uint shapes) {
  if (record.balances == 0 || shapes <= groupSize || roundsLeft() < 2) return false;
  if (laneIndex() == 0) {
    taken = 0;
    if (3 * atomicAdd(rounds[round].finished, 0) >= 2 * gl_NumWorkGroups.x)
      taken = atomicAdd(rounds[round].given, shapes) + shapes <= record.maxShapes / 2 ? 1 : 0;
  }
  barrier();
  const bool idle = taken != 0;
  barrier();
  return idle;
}

/// Shapes onto the stack, or by it to the next round. place: among count of them.
void push(bool own, uint place, uint count, Shape s) {
  if (count == 0) return;
  if (stackSize + count > stackRoom) giveAway();
  const uint base = stackSize;
  if (own)
    for (uint plane = 0; plane < kShapePlanes; ++plane) stacks[stackPlane(plane) + base + place] = packShape(s, plane);
  barrier();
  if (laneIndex() == 0) stackSize = base + count;
  barrier();
}

#include "spawn/mesh.h"

#include "spawn/regions.glsl"

#ifdef GPGP_COLLIDERS
#include "spawn/context.glsl"
#endif

// Families are in a generated kernel's table, everything else that multiplies in the graph's words.
Fan fanFor(Shape s) {
#ifdef GPGP_TABLE
  const uint family = familyOf(s.node);
  if (family != 0) {
    const uint count = tableAt(family).x;
    return Fan(count, count, 0.0f);
  }
#endif
  return fanOf(s);
}
/// Returns a kEnd value.
uint toChildOf(inout Shape s, Fan fan, uint index) {
#ifdef GPGP_TABLE
  const uint family = familyOf(s.node);
  if (family != 0) return toDescendant(s, family, index, record.maxDepth);
#endif
  toChild(s, fan, index);
  return kEndGoesOn;
}

/// Terminals to records, or counted. first: the room that was made for all.
void keep(bool own, uint place, uint first, Shape s) {
  const uint bucket = own ? graphWords[s.node + kNodeArgument2] : 0;
  const bool quads = record.quads != 0; // vertices make themselves room when records become them
  if (record.terminalsTo == kToCounts) {
    if (own) atomicAdd(bucketCounts[bucket], quads ? meshQuads(s.geometry) : 1);
    return;
  }
  if (laneIndex() == 0) terminalBase = first;
  barrier();
  if (!own) return;
  const uint target = terminalBase + place;
  const bool keyed = record.terminalsTo == kToKeyedRecords;
  if (target < record.maxTerminals) {
    for (uint plane = 0; plane < (keyed ? kShapePlanes : kShapePlanes - 1); ++plane) // the last one has the key
      records[plane * record.maxTerminals + target] = packShape(s, plane);
    if (keyed) atomicAdd(bucketCounts[bucket], 1);
  } else if (quads) {
    atomicAdd(bucketCounts[kBucketLost + (record.regions != 0 ? bucket : 0)], meshQuads(s.geometry));
  }
}

/// Terminals to what the record wants of them. place: among count of them.
void emit(bool own, uint place, uint count, Shape s) {
  if (count == 0) return;
  const uint lane = laneIndex();
  uint first = 0;
  if (lane == 0) first = atomicAdd(state.terminals, count);
  if (record.terminalsTo != kToInstances) {
    keep(own, place, first, s);
    return;
  }
  // An instance is made while the device answers where it goes. Each by itself: staging them for whole lines costs more
  // than it saves.
  uvec4 row0, row1, row2, words;
  if (own) {
    const uint axiom = s.axiom * 6;
    row0 = floatBitsToUint(instanceRow(s, uintBitsToFloat(axioms[axiom])));
    row1 = floatBitsToUint(instanceRow(s, uintBitsToFloat(axioms[axiom + 1])));
    row2 = floatBitsToUint(instanceRow(s, uintBitsToFloat(axioms[axiom + 2])));
    words = uvec4(graphWords[s.node + kNodeArgument2], shapeType(s), axioms[axiom + 4].x,
                  graphWords[s.node + kNodeArgument]);
  }
  if (lane == 0) terminalBase = first;
  barrier();
  if (!own) return;
  uint target = terminalBase + place;
  if (record.regions != 0) {
    const uint bucket = words.x;
    target = atomicAdd(bucketCounts[bucket], 1);
    if (target >= regionCapacity(bucket, false)) return;
    target += regionStart(bucket, false);
  } else if (target >= record.instanceCapacity) {
    return;
  }
  target *= kInstanceWords4;
  instances[target] = row0;
  instances[target + 1] = row1;
  instances[target + 2] = row2;
  instances[target + 3] = words;
  instances[target + 4] = uvec4(s.seed, floatBitsToUint(s.custom), s.key);
  instances[target + 5] = packPlane(s.size, 0);
}

/// The shapes of a round that nobody took, once all workgroups have run out of steps: the last one leaves them to the
/// next round.
void leaveRest(uint count) {
  const uint lane = laneIndex();
  if (stackSize > 0) giveAway();
  if (lane == 0) taken = atomicAdd(rounds[round].finished, 1) + 1 == gl_NumWorkGroups.x ? 1 : 0;
  barrier();
  if (taken == 0) return;
  for (;;) {
    barrier();
    if (lane == 0) taken = atomicAdd(rounds[round].taken, groupSize);
    barrier();
    const uint first = taken;
    if (first >= count) break;
    const uint rest = min(count - first, groupSize);
    Shape s;
    if (lane < rest) {
      if (round == 0)
        s = axiomAt(first + lane);
      else
        s = queuedAt(first + lane);
    }
    push(lane < rest, lane, rest, s);
  }
  if (stackSize > 0) giveAway();
}

void main() {
  const uint lane = laneIndex();
  const uint needed = round == 0 ? record.axiomCount : rounds[round].shapes;
  const uint count = round == 0 ? needed : min(needed, record.maxShapes);
  if (gl_GlobalInvocationID.x == 0) {
#ifdef GPGP_COLLIDERS
    if (count > 0) state.rounds += 1; // rounds follow each other
#else
    if (count > 0) state.rounds = round + 1;
#endif
    if (round > 0) {
      state.peakShapes = max(state.peakShapes, needed);
      if (needed > count) atomicAdd(state.droppedShapes, needed - count);
    }
  }
  // Few at a time, so that work comes out even. But not fewer than all could take at once: invocations that idle in
  // small batches cost more.
  const uint even = min((count + gl_NumWorkGroups.x - 1) / gl_NumWorkGroups.x, 4);
  const uint share = clamp(max(count / (2 * gl_NumWorkGroups.x), even), 1, groupSize);
  const bool spreads = count < record.spread && roundsLeft() > 0;
  const uint enough = spreads ? clamp(record.spread / max(count, 1), 16, 4 * groupSize) : 0xffffffffu;
  if (lane == 0) {
    stackSize = 0;
    hashX = 0;
    hashY = 0;
    deepest = 0;
#ifdef GPGP_COLLIDERS
    mostSpent = 0;
#endif
  }
  barrier();
  uvec2 hash = uvec2(0);
  uint depth = 0;
  uint unfinished = 0;

  Shape s;
  bool waits = false; // s is a part of the next batch
  uint waiting = 0;   // how many are
  uint total = 0;     // shapes that the batch makes
  uint made = 0;      // of them
  bool fetched = false; // axioms, which are made of nothing
  uint first = 0;
  uint batches = 0;
  for (uint step = 0; step < record.steps || made < total; ++step) {
    if (made >= total) { // the next batch: what waits in its place, more from the stack, or else from the queue
      total = 0;
      made = 0;
      fetched = false;
      if (waiting + stackSize >= enough || (++batches % 4 == 0 && othersIdle(waiting + stackSize))) {
        uint all;
        const uint place = ranksOf(waits, false, all);
        push(waits, place, all, s);
        giveAway();
        waits = false;
        waiting = 0;
      }
      const uint space = groupSize - waiting;
      const uint more = min(stackSize, min(space, max((stackRoom - stackSize) / 8, 1)));
      if (more > 0) {
        uint idle;
        const uint place = ranksOf(!waits, false, idle);
        stackBarrier();
        if (!waits && place < more) {
          s = stackedAt(stackSize - 1 - place);
          waits = true;
        }
        barrier();
        if (lane == 0) stackSize -= more;
        waiting += more;
      }
      if (waiting == 0) {
        if (lane == 0) taken = atomicAdd(rounds[round].taken, share);
        barrier();
        first = taken;
        if (first >= count) break;
        waiting = min(share, count - first);
        fetched = round == 0;
        if (fetched) {
          total = waiting;
        } else if (lane < waiting) {
          s = queuedAt(first + lane);
          waits = true;
        }
      }
      if (!fetched) {
        Fan fan;
        fan.count = 0;
        if (waits) {
          fan = fanFor(s);
          fan.count -= s.made;
          for (uint plane = 0; plane < kShapePlanes; ++plane)
            stacks[stackPlane(plane) + stackRoom + lane] = packShape(s, plane);
          fans[lane] = uvec2(fan.successors, floatBitsToUint(fan.extent));
        }
        const uint before = sumBefore(fan.count, total); // at most groupSize * kMaxRepeat
        childrenUpTo[lane] = before + fan.count;
        if (total > groupSize) { // whole steps, as many as there is room for: what more children there are comes later
#ifdef GPGP_COLLIDERS
          const uint steps = 1; // a batch is not left before its end, and queries are as much work as many steps
#else
          const uint steps = clamp((stackRoom - stackSize) / groupSize, 1, total / groupSize);
#endif
          total = steps * groupSize;
          const bool late = waits && before + fan.count > total;
          if (late) {
            const uint part = total - min(before, total);
            childrenUpTo[lane] = part > 0 ? total : 0xffffffffu;
            s.made += part;
          }
          uint back;
          const uint place = ranksOf(late, false, back);
          push(late, place, back, s);
        }
      }
      waits = false;
      waiting = 0;
      stackBarrier();
    }

    const uint batch = min(total - made, groupSize);
    uint end = kEndDiscarded;
    if (lane < batch) {
      bool arrives = false;
      end = kEndGoesOn;
      if (fetched) {
        s = axiomAt(first + lane);
      } else {
        const uint child = made + lane;
        uint parent = 0; // the first whose sum lies above child
        for (uint stride = groupSize / 2; stride > 0; stride /= 2)
          if (childrenUpTo[parent + stride - 1] <= child) parent += stride;
        s = parentAt(parent);
        Fan fan;
        fan.successors = fans[parent].x;
        fan.extent = uintBitsToFloat(fans[parent].y);
        const uint index = s.made + child - (parent > 0 ? childrenUpTo[parent - 1] : 0);
        s.made = 0;
        arrives = fan.successors != 0;
        end = toChildOf(s, fan, index);
      }
#ifdef GPGP_COLLIDERS
      if (end == kEndGoesOn) end = runContext(s, arrives);
#else
      if (end == kEndGoesOn) end = runChain(s, arrives, record.maxDepth);
#endif
      depth = max(depth, s.depth);
      if (end == kEndUnfinished) unfinished += 1;
      if (end == kEndTerminal) hash += terminalHash(s.key, graphWords[s.node + kNodeArgument2], shapeType(s));
    }
    made += batch;
#ifdef GPGP_COLLIDERS
    step += queriedSteps();
#endif
    uint leaving;
    const uint places = ranksOf(end == kEndTerminal, end == kEndWaits, leaving);
    emit(end == kEndTerminal, places & 0xffffu, leaving & 0xffffu, s);
    if (made < total) {
      push(end == kEndWaits, places >> 16, leaving >> 16, s);
    } else {
      waits = end == kEndWaits;
      waiting = leaving >> 16;
    }
  }

  uint rest; // what there were no steps left for goes over
  const uint place = ranksOf(waits, false, rest);
  push(waits, place, rest, s);
  leaveRest(count);

  if (hash != uvec2(0)) {
    atomicAdd(hashX, hash.x);
    atomicAdd(hashY, hash.y);
  }
  atomicMax(deepest, depth);
  if (unfinished > 0) atomicAdd(state.unfinishedShapes, unfinished);
  barrier();
  if (lane == 0) {
    if ((hashX | hashY) != 0) {
      atomicAdd(state.keyHashX, hashX);
      atomicAdd(state.keyHashY, hashY);
    }
    atomicMax(state.depth, deepest);
  }
}
