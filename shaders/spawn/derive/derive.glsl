// One round of derivation. A workgroup takes shapes from the round's queue and derives all that comes of them by
// itself, depth first by batches, with a stack of its own: most derivations end in the round in which they began.
// How it does so is in derive_steps.glsl, and for software devices (GPGP_SOFTWARE) in derive_batches.glsl.
//
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
#ifdef GPGP_SOFTWARE
const bool oneSubgroup = true;
#elif defined(GPGP_SUBGROUPS) // the workgroup is one subgroup, and knows of it (2 is tableStart of table.glsl)
layout(constant_id = 3) const bool oneSubgroup = false;
#else
const bool oneSubgroup = false;
#endif
#include "spawn/derive/turns_count.glsl"
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

#include "core/turns.h"

#include "spawn/shared/lanes.glsl"

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
  Shape s = axiomShape(unpackVector(a), a.w, b.y, uintBitsToFloat(b.z), index);
  // Never so many: it is 0, but the answer goes where all answers go that way (isLast).
  if (startWords(b.y) == 0) s.depth |= atomicAdd(state.droppedShapes, 1) >> 31;
  return s;
}
Shape queuedAt(uint index) {
#ifdef GPGP_COLLIDERS
  const uint queue = round == firstRound ? 2 : round & 1;
#else
  const uint queue = round & 1;
#endif
  const uint start = queue * kShapePlanes * record.maxShapes + index;
  Shape s = unpackShape(queues[start], queues[start + record.maxShapes], queues[start + 2 * record.maxShapes],
                        queues[start + 3 * record.maxShapes], queues[start + 4 * record.maxShapes],
                        queues[start + 5 * record.maxShapes]);
#ifdef GPGP_COLLIDERS
  // Of another phase: has made its child there, or will, as it stays in the queue.
  if (queue == 2 && graphWords[s.node + kNodeArgument2] != phase) s.made = 1;
#endif
  return s;
}
/// Behind it is room for the batch's parents.
const uint stackRoom = stackShapes - groupSize;
uint stackPlane(uint plane) { return (gl_WorkGroupID.x * kShapePlanes + plane) * stackShapes; }
#ifdef GPGP_QUEUES
#include "spawn/derive/queues.glsl"
#else
uint placeOf(uint index) { return index; }
void enterQueue(uint index, uint node) {}
void emptyQueues() {}
#endif
Shape stackedAt(uint index) {
  return unpackShape(stacks[stackPlane(0) + index], stacks[stackPlane(1) + index], stacks[stackPlane(2) + index],
                     stacks[stackPlane(3) + index], stacks[stackPlane(4) + index], stacks[stackPlane(5) + index]);
}

#include "spawn/derive/parents.glsl"

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

/// Turns of loops after which a workgroup leaves its work to the next round. What is kept for leaving shapes of this
/// round, of which there are so many, is there for work where they are fewer than the most.
uint mostTurnsOf(uint shapes) {
  if (!turnsCount) return record.steps;
  return record.steps + (record.mostLeft - min(shapes, record.mostLeft)) / groupSize * record.leftTurns;
}

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
    }
  }
  if (turnsCount) { // in a loop for each plane there would be six times as many
    for (uint i = lane; i < fitting; i += groupSize) {
      const uint at = placeOf(i);
      queues[target + i] = stacks[stackPlane(0) + at];
      queues[target + record.maxShapes + i] = stacks[stackPlane(1) + at];
      queues[target + 2 * record.maxShapes + i] = stacks[stackPlane(2) + at];
      queues[target + 3 * record.maxShapes + i] = stacks[stackPlane(3) + at];
      queues[target + 4 * record.maxShapes + i] = stacks[stackPlane(4) + at];
      queues[target + 5 * record.maxShapes + i] = stacks[stackPlane(5) + at];
    }
  } else {
    for (uint plane = 0; plane < kShapePlanes; ++plane)
      for (uint i = lane; i < fitting; i += groupSize)
        queues[target + plane * record.maxShapes + i] = stacks[stackPlane(plane) + placeOf(i)];
  }
  if (keeps) {
    keptAt = base;
    keptCount = count;
    keptShapes += count;
  }
  stackSize = 0;
#ifdef GPGP_QUEUES
  groupBarrier();
#endif
  emptyQueues();
  groupBarrier();
}

/// The last stack that was kept is the stack again.
void takeBack() {
  stackBarrier();
  const uint source = nextQueue() + keptAt;
  if (turnsCount) {
    for (uint i = laneIndex(); i < keptCount; i += groupSize) {
      const uint at = placeOf(i);
      stacks[stackPlane(0) + at] = queues[source + 1 + i];
      stacks[stackPlane(1) + at] = queues[source + 1 + record.maxShapes + i];
      stacks[stackPlane(2) + at] = queues[source + 1 + 2 * record.maxShapes + i];
      stacks[stackPlane(3) + at] = queues[source + 1 + 3 * record.maxShapes + i];
      stacks[stackPlane(4) + at] = queues[source + 1 + 4 * record.maxShapes + i];
      stacks[stackPlane(5) + at] = queues[source + 1 + 5 * record.maxShapes + i];
    }
  } else {
    for (uint plane = 0; plane < kShapePlanes; ++plane)
      for (uint i = laneIndex(); i < keptCount; i += groupSize)
        stacks[stackPlane(plane) + placeOf(i)] = queues[source + 1 + plane * record.maxShapes + i];
  }
#ifdef GPGP_QUEUES
  for (uint i = laneIndex(); i < keptCount; i += groupSize)
    enterQueue(i, queues[source + 1 + 4 * record.maxShapes + i].w);
#endif
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
  if (own) {
    const uint at = placeOf(stackSize + place);
    for (uint plane = 0; plane < kShapePlanes; ++plane) stacks[stackPlane(plane) + at] = packShape(s, plane);
    enterQueue(stackSize + place, s.node);
  }
  stackSize += count;
}

#include "spawn/outputs/mesh.h"

#include "spawn/outputs/regions.glsl"

#ifdef GPGP_COLLIDERS
#include "spawn/colliders/context.glsl"
#endif

/// What the recording's camera sees of a shape. Kernels' own code calls it where a value is wanted; look() is for what
/// runs by the graph's words.
Seen seenOf(Shape s) {
#ifdef GPGP_COLLIDERS
  const uint axiom = axiomNumber(s.axiom) * 6;
#else
  const uint axiom = s.axiom * 6;
#endif
  return hiddenFrom(seenBy(record.view, s, uintBitsToFloat(axioms[axiom]), uintBitsToFloat(axioms[axiom + 1]),
                           uintBitsToFloat(axioms[axiom + 2])),
                    axioms[axiom + 4].w);
}

void look(Shape s) {
  const uint asks = graphWords[s.node + kNodeOperator] & kNodeSees;
  for (uint i = 0; i < asks; i += kNodeSees) { // a loop: software devices skip nothing else
    seen = seenOf(s);
  }
}

#ifdef GPGP_FIELDS
float readField(Shape s, uint field, float x, float z) {
#ifdef GPGP_COLLIDERS
  const uint axiom = axiomNumber(s.axiom) * 6;
#else
  const uint axiom = s.axiom * 6;
#endif
  const vec3 point = framePoint(s, vec3(x, 0.0, z));
  const FieldPlace at = placeInField(record.fields[field], worldCoordinate(point, uintBitsToFloat(axioms[axiom])),
                                     worldCoordinate(point, uintBitsToFloat(axioms[axiom + 2])));
  return fieldBetween(at, uintBitsToFloat(fieldWords[at.near]), uintBitsToFloat(fieldWords[at.near + at.right]),
                      uintBitsToFloat(fieldWords[at.near + at.far]),
                      uintBitsToFloat(fieldWords[at.near + at.far + at.right]));
}
#endif

// Families are in a generated kernel's table, everything else that multiplies in the graph's words.
Fan fanFor(Shape s) {
#ifdef GPGP_TABLE
  const uint family = familyOf(s.node);
  if (family != 0) return familyFan(s, family);
#endif
  look(s);
  return fanOf(s);
}
/// Returns a kEnd value.
uint toChildOf(inout Shape s, Fan fan, uint index) {
#ifdef GPGP_TABLE
  const uint family = familyOf(s.node);
  if (family != 0) return toDescendant(s, family, fan, index, record.maxDepth);
#endif
  look(s);
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

/// Its path key becomes the instance's.
uvec2 hashOfTerminal(inout Shape s) {
  s.key = instanceKey(s.key, axioms[s.axiom * 6 + 4].x);
  const uvec4 terminal = graphRows[s.node / 4];
  return terminalHash(s.key, terminal[kNodeArgument], terminal[kNodeRule], shapeType(s));
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

/// The next place of an axiom's range, or nowhere.
uint rangePlace(uint axiom) {
  const uint range = axiom * kRangeWords;
  const uint first = axiomRanges[range + kRangeFirst];
  const uint most = record.instanceCapacity - min(record.instanceCapacity, first);
  const uint nth = atomicAdd(axiomRanges[range + kRangeCount], 1);
  return nth < min(most, axiomRanges[range + kRangeCapacity]) ? first + nth : kNowhere;
}

/// Terminals to what the recording wants of them. place: among count of them. first: the room that was made for all, as
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
    const uvec4 terminal = graphRows[s.node / 4];
    words[3] = uvec4(terminal[kNodeArgument2], instanceShape(s), axioms[axiom + 4].x, terminal[kNodeArgument]);
    words[4] = uvec4(s.seed, floatBitsToUint(s.custom), s.key);
    words[5] = packPlane(s.size, terminal[kNodeRule]);
  }
  uint target = fromFirst(first) + place;
  if (record.byAxiom != 0 && own) {
    target = rangePlace(s.axiom);
    if (target == kNowhere) atomicAdd(state.instancesWritten, 1);
  } else if (record.regions != 0 && own) {
    const uint bucket = words[3].x;
    target = atomicAdd(bucketCounts[bucket], 1);
    target = target < regionCapacity(bucket, false) ? target + regionStart(bucket, false) : kNowhere;
  } else if (!own || target >= record.instanceCapacity) {
    target = kNowhere;
  }
  writeInstance(target, words);
}

/// One more workgroup has finished. answers: of the device, to all that it has counted, which must be there before: it
/// waits for them, as what it adds depends on them for all that a compiler knows, and that is microseconds less than a
/// fence for all of its memory. Returns whether it is the round's last one.
bool isLast(uint answers) {
  const uint one = 1 + (answers & (record.reports >> 1));
  return atomicAdd(rounds[round].finished, one) + 1 == gl_NumWorkGroups.x;
}

/// Behind the last loop: where the device has ended loops, what was derived is wrong. Returns the
/// device's answer, for isLast.
uint sayIfEnded() {
  if (!turnsCount || !loopsWereEnded(record.one)) return 0;
  return atomicOr(state.ended, 1);
}

/// All has been derived, or nothing more can be: says how many instances there are. What workgroups have counted was
/// answered before they said that they have finished. Those of one subgroup write the report as well; where they are
/// larger, it is copied when they are through, which is no slower there.
void reportAll() {
  if (round + 1 == record.rounds) {
    const uint left = atomicAdd(rounds[round + 1].shapes, 0);
    atomicMax(state.peakShapes, left);
    atomicAdd(state.droppedShapes, left);
  }
  const uint terminals = atomicAdd(state.terminals, 0);
  const uint written = min(terminals, record.instanceCapacity);
  const uint exceeded = written < terminals ? 1 : 0;
  state.instancesWritten = written;
  state.exceeded = exceeded;
  if (record.writeCount != 0) instanceCount = written;
  if (record.drawCapacity > 0 && graphWords[kHeaderBuckets] > 0) {
    draws[1] = written;
    draws[4] = 0;
  }
  if (oneSubgroup)
    report = SpawnState(terminals, written, atomicAdd(state.peakShapes, 0), atomicAdd(state.droppedShapes, 0),
                        atomicAdd(state.unfinishedShapes, 0), atomicAdd(state.rounds, 0), atomicAdd(state.keyHashX, 0),
                        atomicAdd(state.keyHashY, 0), atomicAdd(state.depth, 0), 0, 0, exceeded,
                        atomicAdd(state.colliders, 0), 0, 0, turnsCount ? atomicAdd(state.ended, 0) : 0);
}

/// The first thing that a round does. needed: shapes that wait for it; count: that are there.
void startRound(uint needed, uint count) {
  if (gl_GlobalInvocationID.x == 0) {
    rounds[round + 1].groupsY = 1; // of its dispatch; groupsX stays 0 where nothing goes over
    rounds[round + 1].groupsZ = 1;
#ifdef GPGP_COLLIDERS
    if (count > 0) atomicAdd(state.rounds, 1); // rounds follow each other
#else
    if (count > 0) atomicMax(state.rounds, round + 1);
#endif
    if (round > 0) atomicMax(state.peakShapes, needed);
    if (needed > count) atomicAdd(state.droppedShapes, needed - count);
    if (round == 0 && count == 0 && record.reports != 0) reportAll();
  }
}

#if defined(GPGP_SOFTWARE) && !defined(GPGP_COLLIDERS)
#include "spawn/derive/derive_batches.glsl"
#else
#include "spawn/derive/derive_steps.glsl"
#endif
