// Collider and IfCollides in a kernel: what ends a chain of operators with kEndContext is done here, and the chain goes
// on.
#include "spawn/colliders/colliders.glsl"
uint linkedColliders() { return rounds[firstRound].linked; }

uint spentOnQueries, chainsMade; // by the invocation in this step
shared uint spentInStep;           // turns of an invocation's or a subgroup's loops in this step

/// To the queue for later phases.
void waitForPhase(Shape s) {
  const uint place = atomicAdd(state.waiting, 1);
  if (place >= record.maxShapes) {
    atomicAdd(state.droppedShapes, 1);
    return;
  }
  const uint start = 2 * kShapePlanes * record.maxShapes + place;
  s.made = 0;
  for (uint plane = 0; plane < kShapePlanes; ++plane) queues[start + plane * record.maxShapes] = packShape(s, plane);
}

/// The shape's box becomes a collider; one that does not fit is only counted.
void registerCollider(inout Shape s) {
  const uint i = atomicAdd(state.colliders, 1);
  if (i >= record.maxColliders) return;
  const ColliderBox box = boxOfShape(s);
  colliders[4 * i] = packPlane(box.offset, axiomNumber(s.axiom));
  colliders[4 * i + 1] = packPlane(box.halfX, graphWords[s.node + kNodeArgument]);
  colliders[4 * i + 2] = packPlane(box.halfY, s.axiom);
  colliders[4 * i + 3] = packPlane(box.halfZ, 0);
  s.axiom = kColliderLink | i;
}

/// runChain and what it leaves to its caller. A query looks at all that it has to.
uint runContext(inout Shape s, bool arrives) {
  uint spent = 0;
  uint end = kEndWaits;
  for (uint chains = 0; chains < kMaxChain && spent < record.mostQueried; ++chains) {
    end = runChain(s, arrives && chains == 0, record.maxDepth);
    chainsMade = chains + 1;
    if (end != kEndContext) break;
    end = kEndWaits;
    if (graphWords[s.node + kNodeArgument2] > phase) {
      waitForPhase(s);
      end = kEndLater;
      break;
    }
    uint edge = 0;
    if ((graphWords[s.node + kNodeOperator] & kOperatorMask) == kOpCollider) {
      registerCollider(s);
    } else {
      const uint tag = graphWords[s.node + kNodeArgument];
      if (!collidesWithAny(boxOfShape(s), tag, s.axiom, spent)) edge = 1;
    }
    follow(s, edgeTarget(s.node, edge));
  }
  if (end == kEndWaits && s.node == 0) end = kEndDiscarded;
  spentOnQueries = spent;
  return end;
}

/// How many turns of loops the chains and queries of this step were. Colliders of this step can be read after it.
uint queriedTurns() {
  uint spent = spentOnQueries;
  if (turnsCount) { // as the device counts them: invocations look at other colliders, each at its own turns
#ifdef GPGP_SUBGROUPS
    spent = 2 * subgroupAdd(spent) + subgroupMax(chainsMade) * record.childTurns;
#else
    atomicAdd(spentInStep, 2 * spent + chainsMade * record.childTurns);
    spent = 0;
#endif
  }
  if (spent > 0) atomicMax(spentInStep, spent);
  spentOnQueries = 0;
  chainsMade = 0;
  stackBarrier();
  const uint turns = spentInStep;
  barrier();
  if (laneIndex() == 0) spentInStep = 0;
  return turns;
}
