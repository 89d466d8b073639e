// What the spawner's passes share with each other and with the CPU: counters, constants of a recording, bindings.
#ifndef GPGP_SHADERS_SPAWN_LAYOUT_H
#define GPGP_SHADERS_SPAWN_LAYOUT_H
#include "spawn/shared/graph_format.h"

GPGP_SHADER_BEGIN

// Bindings of descriptor set 0, which are the numbers of the spawner's resources.
GPGP_CONST int kBindGraph = 0;
GPGP_CONST int kBindAxioms = 1;
GPGP_CONST int kBindInstances = 2;
GPGP_CONST int kBindDraws = 3;
GPGP_CONST int kBindCount = 4;
GPGP_CONST int kBindQueues = 5;
GPGP_CONST int kBindStacks = 6;
GPGP_CONST int kBindRecords = 7;
GPGP_CONST int kBindCounters = 8;
GPGP_CONST int kBindBuckets = 9;
GPGP_CONST int kBindConstants = 10;
GPGP_CONST int kBindVertices = 11;
GPGP_CONST int kBindIndices = 12;
GPGP_CONST int kBindNeeded = 13;
GPGP_CONST int kBindColliders = 14;
GPGP_CONST int kBindColliderCells = 15;
GPGP_CONST int kBindOrder = 16;
GPGP_CONST int kBindAxiomCounter = 17;
GPGP_CONST int kBindBounds = 18;
GPGP_CONST int kBindBoundKeys = 19;
GPGP_CONST int kBindReport = 20;
GPGP_CONST int kBindRanges = 21;
GPGP_CONST int kBindFields = 22;

/// Counters of one recording, cleared at its start, and its report.
struct SpawnState {
  uint terminals;        // derived, those that did not fit included
  uint instancesWritten; // while deriving by axiom: those that their range had no room for
  uint peakShapes;       // that waited for a round, those that did not fit included
  uint droppedShapes;
  uint unfinishedShapes;
  uint rounds;
  uint keyHashX;
  uint keyHashY;
  uint depth;
  uint quads; // of terminals as vertices, those that did not fit included
  uint quadsWritten;
  uint exceeded;  // 1: something did not fit the engine's buffers, or what goes before them
  uint colliders; // those that did not fit included
  uint waiting;   // shapes for later phases, those that did not fit included; they stay where they are
  uint levels;    // bit set of those that colliders are linked in
  uint ended;     // 1: the device has ended loops before their time (core/turns.h), and what was derived is wrong
};
GPGP_CONST uint kRowTurns = 2u;    // of moving a shape for each invocation of a batch
GPGP_CONST uint kWriteTurns = 24u; // of writing a terminal for each

// What a workgroup's shapes should grow to in a round that spreads work.
GPGP_CONST uint kGrowing = 2u; // batches at most,
GPGP_CONST uint kGrowth = 16u; // or else, and at least, so many times

GPGP_CONST uint kMostQueues = 128u; // of a kernel; further execution groups share them
/// Turns of a workgroup's loops for choosing a batch from its queues (shaders/spawn/derive/queues.glsl): one over the
/// places of the stack with ranks in it, and three over the queues.
GPGP_FN uint gatherTurns(uint stackShapes, uint groupSize) {
  const uint ranks = (groupSize > 40u ? groupSize / 4u : 10u) + 2u;
  return (stackShapes / groupSize + 2u) * ranks + 3u * (kMostQueues / groupSize + 2u);
}

/// One round of derivation: the arguments of its dispatch, and what its queue holds.
struct SpawnRound {
  uint groupsX, groupsY, groupsZ; // VkDispatchIndirectCommand
  uint shapes;                    // that the round before left, those that did not fit included
  uint taken;                     // by workgroups of this round; behind the last one: room that it kept full stacks in
  uint finished;                  // workgroups
  uint linked;                    // the first round of a phase: colliders that its queries can find
  uint given; // shapes that its workgroups were willing to leave to idle ones; by batches: axioms that all rounds took
};

/// A recording's camera. Planes are seen from its position: a point p is inside where dot(plane.xyz, p) + plane.w >= 0.
struct View {
  // Position in the world; pixels that a metre covers at a distance of one metre. 0: there is no camera. Negative:
  // pixels that a metre covers anywhere, of a parallel projection
  vec4 camera;
  vec4 left, right, bottom, top, front, back; // normals of unit length, or 0 and a w that nothing is outside of
};

/// A field of the world (field.h). Its rows along x lie one after the other.
struct FieldGrid {
  float minX, minZ;           // of the first value, in the world
  float perMetreX, perMetreZ; // steps of the grid; 0 along an axis with one value
  uint width, height;         // at least 1
  uint first;                 // its first value among those of all fields
  uint unused;
};

/// What the CPU says with each recording.
struct SpawnConstants {
  uint axiomCount;        // at most
  uint instanceCapacity;  // GpgpInstance
  uint drawCapacity;      // VkDrawIndexedIndirectCommand; 0: instances are not sorted
  uint writeCount;        // 1: the count buffer is there
  uint rounds;            // the number of what the last round leaves
  uint maxGroups;         // workgroups of a round at most
  uint maxDepth;          // recursive edges that a shape may pass
  uint spread;            // shapes that a round should at least begin with: below, workgroups give work away
  uint steps;             // turns of loops after which a workgroup leaves its work to the next round
  uint maxShapes;         // that each queue holds
  uint maxTerminals;      // that the records hold
  uint terminalsTo;       // kTo..., below
  uint regions;           // 1: the engine's draws say where each bucket begins
  uint writeNeeded;       // 1: the buffer for needed counts is there
  uint quadCapacity;      // that vertices and indices hold
  uint regionQuads;       // that indices of one draw can reach
  uint indexWords;        // of a quad: 6, 3, or 0 without indices
  uint quads;             // 1: terminals become quads of vertices, not instances
  uint phaseRounds;       // rounds that were recorded of each phase
  uint maxColliders;      // that are held
  uint cellMask;          // cells that colliders are linked in, a power of two, less 1
  uint balances;          // 1: workgroups give work away as well where most have finished
  uint reports;           // 1: the last workgroup to derive says what was written, and place is left out
  uint readsAxiomCounter; // 1: the engine's buffer says how many axioms there are
  // What takes how many of `steps` at most (src/spawn/schedule/turns.h).
  uint chainLength;    // operators that one shape passes before others get their turn
  uint childrenAtOnce; // that a shape of a batch becomes before others get their turn
  uint operatorTurns;  // of an operator that is passed by the graph's words
  uint batchTurns;     // of a batch beside its operators and children, or of a step, queries aside
  uint childTurns;     // of one more child, or of a chain up to a Collider or IfCollides; 0: turns are not counted
  uint mostQueried;    // what queries of one step may look at before the rest waits for another
  uint mostLeft;       // shapes that the last workgroup of a round leaves to the next one
  uint leftTurns;      // of leaving one for each invocation
  uint recordsAtOnce;  // that a workgroup makes vertices of, at most kSpawnGroupSize
  uint one;            // 1, which no compiler knows
  uint firstInstance;  // added to what draws begin with
  uint byAxiom;        // 1: every axiom has a range of the instances
  uint contextFrom;    // axioms from this one on have colliders alone: their terminals are nothing
  uint unused0, unused1, unused2;
  View view;                    // of the camera
  FieldGrid fields[kMaxFields]; // by their numbers in the grammar
};

// What becomes of terminals.
GPGP_CONST uint kToInstances = 0u;    // at once, to instances
GPGP_CONST uint kToRecords = 1u;      // to records without keys, which expand makes vertices of as they come
GPGP_CONST uint kToCounts = 2u;       // they are counted by bucket
GPGP_CONST uint kToKeyedRecords = 3u; // to records with keys, counted by bucket and put in order before they are used

/// Words by bucket: what it got, in what is counted while deriving; quads of terminals without a record; what the
/// shape that fits only in part left free; where its records begin.
GPGP_CONST uint kBucketLost = kMaxBuckets;
GPGP_CONST uint kBucketGaps = 2u * kMaxBuckets;
GPGP_CONST uint kBucketPlaces = 3u * kMaxBuckets;
GPGP_CONST uint kBucketWords = 4u * kMaxBuckets;
GPGP_CONST uint kBoundWords = 6u; // of a bucket's box: lower and upper ends

GPGP_CONST uint kSpawnGroupSize = 64u; // of place, order and emit

// Stages of shaders/spawn/outputs/order.comp.
GPGP_CONST uint kOrderBuckets = 0u;    // where each bucket's records begin
GPGP_CONST uint kOrderCount = 1u;      // records of each bin
GPGP_CONST uint kOrderSum = 2u;        // of a part of the bins
GPGP_CONST uint kOrderStarts = 3u;     // of bins
GPGP_CONST uint kOrderFill = 4u;       // bins with records
GPGP_CONST uint kOrderRank = 5u;       // records within their bin
GPGP_CONST uint kOrderQuadSum = 6u;    // of a part of the records
GPGP_CONST uint kOrderQuadStarts = 7u; // of records among quads
GPGP_CONST uint kOrderParts = 256u;
GPGP_CONST uint kOrderWords = 4u;     // for each record, and kOrderParts
GPGP_CONST uint kInstanceWords4 = 6u; // GpgpInstance as uvec4
GPGP_CONST uint kDrawWords = 5u;      // VkDrawIndexedIndirectCommand

// GpgpAxiomRange
GPGP_CONST uint kRangeFirst = 0u;
GPGP_CONST uint kRangeCapacity = 1u;
GPGP_CONST uint kRangeCount = 2u;
GPGP_CONST uint kRangeWords = 4u;

GPGP_SHADER_END
#endif
