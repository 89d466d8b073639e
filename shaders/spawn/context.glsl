// Collider and IfCollides in a kernel: what ends a chain of operators with kEndContext is done here, and the chain goes
// on.
#include "spawn/colliders.glsl"
uint linkedColliders() { return rounds[firstRound].linked; }

/// What queries of one step may look at before the rest waits for another; a query looks at all that it has to.
const uint kMostSpent = 4096;
/// What is as much work as another step.
const uint kSpentStep = 32;
shared uint mostSpent; // by an invocation in this step

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

/// runChain and what it leaves to its caller.
uint runContext(inout Shape s, bool arrives) {
  uint spent = 0;
  uint end = kEndWaits;
  for (uint chains = 0; chains < kMaxChain && spent < kMostSpent; ++chains) {
    end = runChain(s, arrives && chains == 0, record.maxDepth);
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
  if (spent > 0) atomicMax(mostSpent, spent);
  return end;
}

/// How many steps of a workgroup's work the queries of this one were. Colliders of this step can be read after it.
uint queriedSteps() {
  stackBarrier();
  const uint steps = mostSpent / kSpentStep;
  barrier();
  if (laneIndex() == 0) mostSpent = 0;
  return steps;
}
