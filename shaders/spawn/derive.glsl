// One round of derivation. A workgroup takes shapes from the round's queue and derives all that comes of them by
// itself, depth first by batches, with a stack of its own: most derivations end in the round in which they began.
//
// A batch is one shape for each invocation, waiting for an operator that multiplies. Step by step its children are
// made, one an invocation whoever the parent, and each goes through its chain of operators until it is a terminal, or
// waits in its turn: on the stack, or, in the batch's last step, where it is, as a part of the next batch. Terminals
// leave at once, a workgroup's together. Where more shapes wait on the stack, a batch ends with a full step: parents
// whose children are too many for that go back to the stack, one perhaps with a part of them made.
// Work goes over to the next round, through the other queue, where a round began with too few shapes to keep the device
// busy and a workgroup has enough to give (`spread`), where most workgroups have finished, where the stack is full, and
// after `steps`, so that no workgroup runs for ever. Round 0 reads axioms. What does not fit the queue is counted and
// dropped. In the last round, which no other one follows, the next queue's memory is more room for full stacks: their
// workgroups take back what they put there.
//
// Kernels of grammars with Collider or IfCollides (GPGP_COLLIDERS) derive in phases, each with rounds of its own. A
// shape that comes to an IfCollides of a later phase goes to a third queue, where the first round of each phase finds
// it.
layout(constant_id = 0) const uint groupSize = 64;
layout(constant_id = 1) const uint stackShapes = 1024;
#ifdef GPGP_SUBGROUPS // the workgroup is one subgroup, and knows of it (2 is tableStart of table.glsl)
layout(constant_id = 3) const bool oneSubgroup = false;
#else
const bool oneSubgroup = false;
#endif
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

shared uint childrenUpTo[groupSize]; // of the batch's parents: inclusive sums
shared uint hashX;
shared uint hashY;
shared uint deepest;

#include "spawn/lanes.glsl"

uint stackSize; // of the workgroup; each of its invocations counts along

/// A barrier for the workgroup's stack as well. It stands before the stack is read, when what was written has long
/// arrived, not after it is written, where everybody would wait.
void stackBarrier() {
#ifdef GPGP_SUBGROUPS
  if (oneSubgroup) {
    subgroupBarrier();
    return;
  }
#endif
  controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsBuffer | gl_StorageSemanticsShared,
                 gl_SemanticsAcquireRelease);
}

Shape axiomAt(uint index) {
  const uvec4 a = axioms[index * 6 + 3];
  const uvec4 b = axioms[index * 6 + 4];
  if (startWords(b.y) == 0) atomicAdd(state.droppedShapes, 1);
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
/// Behind it is room for the batch's parents.
const uint stackRoom = stackShapes - groupSize;
uint stackPlane(uint plane) { return (gl_WorkGroupID.x * kShapePlanes + plane) * stackShapes; }
Shape stackedAt(uint index) {
  return unpackShape(stacks[stackPlane(0) + index], stacks[stackPlane(1) + index], stacks[stackPlane(2) + index],
                     stacks[stackPlane(3) + index], stacks[stackPlane(4) + index], stacks[stackPlane(5) + index]);
}

#include "spawn/parents.glsl"

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

// Stacks that the workgroup has put into the next queue's memory, each behind a place that says where the one put there
// before is.
bool keepsRest;  // it does so where its stack is full
uint keptAt;     // the last one
uint keptCount;  // its shapes; 0: there is none
uint keptShapes; // of all of them

uint nextQueue() { return ((round + 1) & 1) * kShapePlanes * record.maxShapes; }

/// Moves the stack to the next round's queue, or keeps it there.
void giveAway() {
  const uint lane = laneIndex();
  const uint count = stackSize;
  const uint wanted = keepsRest ? count + 1 : count;
  uint base = 0; // stays far below 2^32: steps and groups are bounded
  if (lane == 0) {
    if (keepsRest)
      base = atomicAdd(rounds[round + 1].taken, wanted);
    else
      base = atomicAdd(rounds[round + 1].shapes, count);
  }
  base = fromFirst(base);
  stackBarrier();
  const uint room = base < record.maxShapes ? record.maxShapes - base : 0;
  const bool keeps = keepsRest && wanted <= room;
  const uint target = nextQueue() + base + (keeps ? 1 : 0);
  const uint fitting = keeps ? count : roundsLeft() > 0 ? min(count, room) : 0;
  if (lane == 0) {
    if (keeps) {
      queues[target - 1] = uvec4(keptAt, keptCount, 0, 0);
    } else if (keepsRest) {
      atomicAdd(rounds[round + 1].shapes, count); // dropped
    } else {
      atomicMax(rounds[round + 1].groupsX, min(min(base + count, record.maxShapes), record.maxGroups));
      rounds[round + 1].groupsY = 1;
      rounds[round + 1].groupsZ = 1;
    }
  }
  for (uint plane = 0; plane < kShapePlanes; ++plane)
    for (uint i = lane; i < fitting; i += groupSize)
      queues[target + plane * record.maxShapes + i] = stacks[stackPlane(plane) + i];
  if (keeps) {
    keptAt = base;
    keptCount = count;
    keptShapes += count;
  }
  stackSize = 0;
  groupBarrier();
}

/// The last stack that was kept is the stack again.
void takeBack() {
  stackBarrier();
  const uint source = nextQueue() + keptAt;
  for (uint plane = 0; plane < kShapePlanes; ++plane)
    for (uint i = laneIndex(); i < keptCount; i += groupSize)
      stacks[stackPlane(plane) + i] = queues[source + 1 + plane * record.maxShapes + i];
  stackSize = keptCount;
  keptShapes -= keptCount;
  const uvec4 before = queues[source];
  keptAt = before.x;
  keptCount = before.y;
}

/// Whether a workgroup should give away its shapes, as most others have nothing left to do. That takes another round,
/// so another one must be left for what may have to go over there; and never more than half of the room of a queue.
bool othersIdle(uint shapes) {
  if (record.balances == 0 || shapes <= groupSize || roundsLeft() < 2) return false;
  uint idle = 0;
  if (laneIndex() == 0 && 3 * atomicAdd(rounds[round].finished, 0) >= 2 * gl_NumWorkGroups.x)
    idle = atomicAdd(rounds[round].given, shapes) + shapes <= record.maxShapes / 2 ? 1 : 0;
  return fromFirst(idle) != 0;
}

/// Shapes onto the stack, or by it to the next round. place: among count of them.
void push(bool own, uint place, uint count, Shape s) {
  if (count == 0) return;
  if (stackSize + count > stackRoom) giveAway();
  if (own)
    for (uint plane = 0; plane < kShapePlanes; ++plane)
      stacks[stackPlane(plane) + stackSize + place] = packShape(s, plane);
  stackSize += count;
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
  first = fromFirst(first);
  if (!own) return;
  const uint target = first + place;
  const bool keyed = record.terminalsTo == kToKeyedRecords;
  if (target < record.maxTerminals) {
    for (uint plane = 0; plane < (keyed ? kShapePlanes : kShapePlanes - 1); ++plane) // the last one has the key
      records[plane * record.maxTerminals + target] = packShape(s, plane);
    if (keyed) atomicAdd(bucketCounts[bucket], 1);
  } else if (quads) {
    atomicAdd(bucketCounts[kBucketLost + (record.regions != 0 ? bucket : 0)], meshQuads(s.geometry));
  }
}

const uint kNowhere = 0xffffffffu;
/// Everybody writes an instance, or nowhere. Neighbours write theirs together, one after the other, so that the halves
/// of each sector of 32 bytes, which is what memory takes at once, come together.
void writeInstance(uint target, uvec4 words[kInstanceWords4]) {
#ifdef GPGP_SUBGROUPS
  const bool odd = (gl_SubgroupInvocationID & 1) != 0;
  const uint other = subgroupShuffleXor(target, 1);
  const uint part = odd ? 1 : 0;
  for (uint i = 0; i < kInstanceWords4; i += 2) {
    const uvec4 own = odd ? words[i + 1] : words[i];
    const uvec4 others = subgroupShuffleXor(odd ? words[i] : words[i + 1], 1);
    const uint even = odd ? other : target;
    if (even != kNowhere) instances[even * kInstanceWords4 + i + part] = odd ? others : own;
    const uint second = odd ? target : other;
    if (second != kNowhere) instances[second * kInstanceWords4 + i + part] = odd ? own : others;
  }
#else
  if (target == kNowhere) return;
  for (uint i = 0; i < kInstanceWords4; ++i) instances[target * kInstanceWords4 + i] = words[i];
#endif
}

/// Terminals to what the record wants of them. place: among count of them. first: the room that was made for all, as
/// the first invocation knows.
void emit(bool own, uint place, uint count, uint first, Shape s) {
  if (count == 0) return;
  if (record.terminalsTo != kToInstances) {
    keep(own, place, first, s);
    return;
  }
  // An instance is made while the device answers where it goes.
  uvec4 words[kInstanceWords4];
  if (own) {
    const uint axiom = s.axiom * 6;
    for (uint row = 0; row < 3; ++row)
      words[row] = floatBitsToUint(instanceRow(s, uintBitsToFloat(axioms[axiom + row])));
    words[3] = uvec4(graphWords[s.node + kNodeArgument2], shapeType(s), axioms[axiom + 4].x,
                     graphWords[s.node + kNodeArgument]);
    words[4] = uvec4(s.seed, floatBitsToUint(s.custom), s.key);
    words[5] = packPlane(s.size, 0);
  }
  uint target = fromFirst(first) + place;
  if (record.regions != 0 && own) {
    const uint bucket = words[3].x;
    target = atomicAdd(bucketCounts[bucket], 1);
    target = target < regionCapacity(bucket, false) ? target + regionStart(bucket, false) : kNowhere;
  } else if (!own || target >= record.instanceCapacity) {
    target = kNowhere;
  }
  writeInstance(target, words);
}

/// All has been derived, or nothing more can be: says how many instances there are. What workgroups have counted was
/// answered before they said that they have finished.
void reportInstances() {
  if (round + 1 == record.rounds) {
    const uint left = atomicAdd(rounds[round + 1].shapes, 0);
    atomicMax(state.peakShapes, left);
    atomicAdd(state.droppedShapes, left);
  }
  const uint terminals = atomicAdd(state.terminals, 0);
  const uint written = min(terminals, record.instanceCapacity);
  state.instancesWritten = written;
  state.exceeded = written < terminals ? 1 : 0;
  if (record.writeCount != 0) instanceCount = written;
  if (record.drawCapacity > 0 && graphWords[kHeaderBuckets] > 0) {
    draws[1] = written;
    draws[4] = 0;
  }
}

/// The last workgroup of a round leaves the shapes to the next one that nobody took, as all have run out of steps; and
/// if nothing is left, the derivation is over.
void leaveRest(uint count) {
  const uint lane = laneIndex();
  if (stackSize > 0) giveAway();
  uint last = 0;
  if (lane == 0) last = atomicAdd(rounds[round].finished, 1) + 1 == gl_NumWorkGroups.x ? 1 : 0;
  if (fromFirst(last) == 0) return;
  for (;;) {
    uint first = 0;
    if (lane == 0) first = atomicAdd(rounds[round].taken, groupSize);
    first = fromFirst(first);
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
  if (lane == 0 && record.reports != 0 &&
      (round + 1 == record.rounds || atomicAdd(rounds[round + 1].shapes, 0) == 0))
    reportInstances();
}

void main() {
  const uint lane = laneIndex();
  const uint axiomsThere = record.readsAxiomCounter != 0 ? axiomCounter : record.axiomCount;
  const uint needed = round == 0 ? axiomsThere : rounds[round].shapes;
  const uint count = min(needed, round == 0 ? record.axiomCount : record.maxShapes);
  if (gl_GlobalInvocationID.x == 0) {
#ifdef GPGP_COLLIDERS
    if (count > 0) state.rounds += 1; // rounds follow each other
#else
    if (count > 0) state.rounds = round + 1;
#endif
    if (round > 0) state.peakShapes = max(state.peakShapes, needed);
    if (needed > count) atomicAdd(state.droppedShapes, needed - count);
    if (round == 0 && count == 0 && record.reports != 0) reportInstances();
  }
  if (count == 0) return; // the second round is recorded before anybody knows
  // Few at a time, so that work comes out even. But not fewer than all could take at once, and more of axioms, which
  // take a step of their own, and of what queries: invocations that idle in small batches cost more.
#ifdef GPGP_COLLIDERS
  const uint times = 2;
#else
  const uint times = round == 0 ? 2 : 8;
#endif
  const uint even = min((count + gl_NumWorkGroups.x - 1) / gl_NumWorkGroups.x, 8);
  const uint share = clamp(max(count / (times * gl_NumWorkGroups.x), even), 1, groupSize);
  // A workgroup by itself grows fast only until its invocations are busy: what takes much more than that grows further
  // in more rounds.
  const uint growth = record.spread / max(count, 1);
  const bool spreads = count < record.spread && roundsLeft() > 0;
  const uint enough = spreads ? (growth <= kGrowing * groupSize ? max(growth, kGrowth) : kGrowth) : 0xffffffffu;
  stackSize = 0;
  keepsRest = roundsLeft() == 0;
  keptAt = 0;
  keptCount = 0;
  keptShapes = 0;
  if (lane == 0) {
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
      if (waiting + stackSize == 0 && keptCount > 0) takeBack();
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
        stackSize -= more;
        waiting += more;
      }
      if (waiting == 0) {
        if (lane == 0) first = atomicAdd(rounds[round].taken, share);
        first = fromFirst(first);
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
          keepParent(s, fan);
        }
        const uint before = sumBefore(fan.count, total); // at most groupSize * kMaxRepeat
        childrenUpTo[lane] = before + fan.count;
#ifdef GPGP_COLLIDERS
        const uint most = groupSize; // a batch is not left before its end, and queries are as much work as many steps
#else
        // Whole steps where others wait to fill the next one, and no more than there is room for: what more children
        // there are comes later.
        const uint whole = stackSize < groupSize / 2 ? total : total / groupSize * groupSize;
        const uint most = max(min(whole, (stackRoom - stackSize) / groupSize * groupSize), groupSize);
#endif
        if (total > most) {
          total = most;
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
    const uint child = made + lane;
    uint parent = 0; // the first whose sum lies above child
    Fan fan;
    if (!fetched) {
      for (uint stride = groupSize / 2; stride > 0; stride /= 2)
        if (childrenUpTo[parent + stride - 1] <= child) parent += stride;
      s = parentAt(parent, fan);
    }
    uint end = kEndDiscarded;
    if (lane < batch) {
      bool arrives = false;
      end = kEndGoesOn;
      if (fetched) {
        s = axiomAt(first + lane);
      } else {
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
    }
    made += batch;
#ifdef GPGP_COLLIDERS
    step += queriedSteps();
#endif
    uint leaving;
    const uint places = ranksOf(end == kEndTerminal, end == kEndWaits, leaving);
    const uint terminals = leaving & 0xffffu;
    uint firstTerminal = 0; // known much later
    if (lane == 0 && terminals > 0) firstTerminal = atomicAdd(state.terminals, terminals);
    if (made < total) {
      push(end == kEndWaits, places >> 16, leaving >> 16, s);
    } else {
      waits = end == kEndWaits;
      waiting = leaving >> 16;
    }
    if (end == kEndTerminal) hash += terminalHash(s.key, graphWords[s.node + kNodeArgument2], shapeType(s));
    emit(end == kEndTerminal, places & 0xffffu, terminals, firstTerminal, s);
  }

  keepsRest = false;
  if (lane == 0 && keptShapes > 0) atomicAdd(rounds[round + 1].shapes, keptShapes);
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
