// How a workgroup of a software device derives. It is one subgroup, and takes shapes from its stack by batches, one for
// each invocation: they go through their chains, and then their children are made, the first ones of all beside each
// other, the second ones, and so on. Where there are fewer shapes, several invocations share the children of each, and
// what they have not made in this round is as many shapes, which go to as many workgroups. Children go back to the
// stack, which has two ends: at its lower end are shapes that wait, at its upper end terminals, which are written when
// there are enough of them for all invocations.
//
// Compilers of such devices turn branches into masks: whatever a loop holds is run at each of its turns, wanted or not.
// So the loop over children only makes them, and everything else is done for as many shapes at once as there are
// invocations, in loops of its own. Invocations go step by step together, and never wait for each other.

const uint kMostWaiting = stackShapes / 2; // more of them go elsewhere
const uint kMostTerminals = stackShapes < 512 ? stackShapes / 8 : 64; // before they are written
uint terminalCount; // on the stack

// Shape::made of what waits here: the number of its next child, and above it how far those behind are apart, as a power
// of two. Of at most kMaxRepeat copies of a family no child is beyond the mask.
const uint kMadeBits = 27;
const uint kMadeMask = (1u << kMadeBits) - 1u;

/// Shapes onto the stack, at one of its ends; there is room.
void stackUp(bool waits, bool ends, Shape s) {
  uint both;
  const uint places = ranksOf(waits, ends, both);
  const uint at = ends ? stackShapes - 1 - terminalCount - (places >> 16) : stackSize + (places & 0xffffu);
  if (waits || ends) {
    stacks[stackPlane(0) + at] = packShape(s, 0);
    stacks[stackPlane(1) + at] = packShape(s, 1);
    stacks[stackPlane(2) + at] = packShape(s, 2);
    stacks[stackPlane(3) + at] = packShape(s, 3);
    stacks[stackPlane(4) + at] = packShape(s, 4);
    stacks[stackPlane(5) + at] = packShape(s, 5);
  }
  stackSize += both & 0xffffu;
  terminalCount += both >> 16;
}

/// Of moving so many shapes of the stack.
uint turnsOfRows(uint shapes) { return kRowTurns * (shapes / groupSize + 2); }

/// Writes terminals while there are at least so many. Adds them to the hash.
void writeTerminals(uint least, inout uvec2 hash) {
  const uint lane = laneIndex();
  while (terminalCount >= least) {
    const uint count = min(terminalCount, groupSize);
    terminalCount -= count;
    Shape s;
    if (lane < count) {
      s = stackedAt(stackShapes - 1 - terminalCount - lane);
      hash += hashOfTerminal(s);
    }
    uint first = 0;
    if (lane == 0) first = atomicAdd(state.terminals, count);
    emit(lane < count, lane, count, first, s);
  }
}

/// Shapes from the queue, or axioms that no round before has taken. Returns false where there are none.
bool takeMore(uint share, uint queued, uint axiomsThere) {
  const uint lane = laneIndex();
  uint first = 0;
  if (lane == 0 && queued > 0) first = atomicAdd(rounds[round].taken, share);
  first = fromFirst(first);
  const uint fromQueue = first < queued ? min(share, queued - first) : 0;
  uint firstAxiom = 0;
  if (lane == 0 && fromQueue == 0) firstAxiom = atomicAdd(rounds[0].given, share);
  firstAxiom = fromFirst(firstAxiom);
  const uint fromAxioms = fromQueue == 0 && firstAxiom < axiomsThere ? min(share, axiomsThere - firstAxiom) : 0;
  Shape s;
  if (lane < fromQueue) s = queuedAt(first + lane);
  if (lane < fromAxioms) s = axiomAt(firstAxiom + lane);
  stackUp(lane < fromQueue + fromAxioms, false, s);
  return fromQueue + fromAxioms > 0;
}

/// The stack to elsewhere, but for the batch on top, which the workgroup goes on with.
void giveMost() {
  const uint lane = laneIndex();
  stackSize -= groupSize;
  const Shape s = stackedAt(stackSize + lane);
  giveAway();
  stackUp(true, false, s);
}

bool isTerminal(Shape s) {
  return (graphWords[s.node + kNodeOperator] & kOperatorMask) == kOpTerminal && s.depth <= record.maxDepth;
}

/// How many axioms rounds have taken.
uint axiomsTaken() {
  uint taken = 0;
  if (laneIndex() == 0) taken = atomicAdd(rounds[0].given, 0);
  return fromFirst(taken);
}

/// The last workgroup of a round leaves to the next one what nobody took, as all have made their turns; axioms stay
/// where they are. If nothing is left, the derivation is over. answers: see isLast.
void leaveRest(uint queued, uint axiomsThere, uint answers) {
  const uint lane = laneIndex();
  if (stackSize > 0) giveAway();
  uint last = 0;
  if (lane == 0 && isLast(answers)) last = 1;
  if (fromFirst(last) == 0) return;
  uint first = 0;
  if (lane == 0) first = min(atomicAdd(rounds[round].taken, 0), queued);
  first = fromFirst(first);
  const uint until = min(queued, first + record.mostLeft);
  for (; first < until; first += groupSize) {
    const bool own = first + lane < until;
    Shape s;
    if (own) s = queuedAt(first + lane);
    stackUp(own, false, s);
    if (stackSize >= kMostWaiting) giveAway();
  }
  if (stackSize > 0) giveAway();
  const uint axiomsLeft = axiomsThere - min(axiomsTaken(), axiomsThere);
  if (lane != 0) return;
  if (until < queued) atomicAdd(state.droppedShapes, queued - until);
  if (axiomsLeft > 0 && roundsLeft() == 0) atomicAdd(rounds[round + 1].shapes, axiomsLeft); // dropped
  if (axiomsLeft > 0 && roundsLeft() > 0) atomicMax(rounds[round + 1].groupsX, record.maxGroups);
  sayIfEnded();
  if (record.reports != 0 && (round + 1 == record.rounds ||
                              (axiomsLeft == 0 && atomicAdd(rounds[round + 1].shapes, 0) == 0)))
    reportAll();
}

void main() {
  const uint lane = laneIndex();
  const uint axioms0 = record.readsAxiomCounter != 0 ? axiomCounter : record.axiomCount;
  const uint axiomsThere = min(axioms0, record.axiomCount);
  const uint queued = round == 0 ? 0 : min(rounds[round].shapes, record.maxShapes);
  const uint count = queued + axiomsThere - min(round == 0 ? 0 : axiomsTaken(), axiomsThere);
  startRound(round == 0 ? axioms0 : rounds[round].shapes, round == 0 ? axiomsThere : queued);
  // What waits is known before the round; that others have taken all of it meanwhile is not: all must have finished for
  // one to be the last.
  if (round == 0 ? count == 0 : rounds[round].groupsX == 0) return;
  if (gl_GlobalInvocationID.x == 0) atomicMax(state.rounds, round + 1);
  const uint share = clamp(count / (4 * gl_NumWorkGroups.x), 1, groupSize);
  const bool spreads = count < record.spread && roundsLeft() > 0;
  const uint enough = spreads ? min(kGrowth * groupSize, kMostWaiting) : kMostWaiting;
  const uint maxDepth = record.maxDepth;
  const uint mostTurns = mostTurnsOf(queued);
  stackSize = 0;
  terminalCount = 0;
  keepsRest = roundsLeft() == 0;
  keptAt = 0;
  keptCount = 0;
  keptShapes = 0;
  uvec2 hash = uvec2(0);
  uint depth = 0;
  uint unfinished = 0;
  for (uint made = 0; made < mostTurns;) { // turns of loops, as the device counts them (core/turns.h) or more
    if (stackSize >= enough) {
      made += turnsOfRows(stackSize);
      giveMost();
    }
    if (stackSize == 0 && keptCount > 0) {
      made += turnsOfRows(keptCount);
      takeBack();
    }
    if (stackSize == 0 && !takeMore(share, queued, axiomsThere)) break;
    do {
      operatorsPassed = 0;
      const uint batch = min(stackSize, groupSize);
      stackSize -= batch;
      // Where shapes are few, each is the parent of several invocations, which take its children by turns.
      const uint shares = 1u << findMSB(groupSize / batch);
      const uint share = lane / batch;
      Shape parent;
      uint end = kEndDiscarded;
      if (share < shares) {
        parent = stackedAt(stackSize + lane - share * batch);
        end = runChain(parent, false, maxDepth);
        depth = max(depth, parent.depth);
        if (share > 0 && end != kEndWaits) end = kEndDiscarded; // the first one's
      }
      if (end == kEndUnfinished) unfinished += 1;
      Fan fan;
      uint first = 0, stride = 1, left = 0; // children
      if (end == kEndWaits) {
        fan = fanFor(parent);
        if (fan.extent < 0.0f && share == 0) atomicAdd(state.droppedShapes, 1);
        first = (parent.made & kMadeMask) + (share << (parent.made >> kMadeBits));
        stride = shares << (parent.made >> kMadeBits);
        left = first < fan.count ? (fan.count - first - 1) / stride + 1 : 0;
      }
      const uint turns = min(subgroupMax(left), record.childrenAtOnce);
      parent.made = (first + turns * stride) | (uint(findMSB(stride)) << kMadeBits);
      stackUp(left > turns, end == kEndTerminal, parent); // the children behind these turns come later
      parent.made = 0;
      for (uint turn = 0; turn < turns; ++turn) {
        Shape s = parent;
        end = kEndDiscarded;
        if (turn < left) {
          end = toChildOf(s, fan, first + turn * stride);
          if (end == kEndGoesOn) end = isTerminal(s) ? kEndTerminal : kEndWaits;
          depth = max(depth, s.depth);
          if (end == kEndUnfinished) unfinished += 1;
        }
        stackUp(end == kEndWaits, end == kEndTerminal, s);
      }
      made += subgroupMax(operatorsPassed) * record.operatorTurns + turns * record.childTurns + record.batchTurns;
    } while (stackSize > 0 && stackSize < enough && terminalCount < kMostTerminals && made < mostTurns);
    made += kWriteTurns * (terminalCount / groupSize + 1);
    writeTerminals(groupSize, hash);
  }
  writeTerminals(1, hash);

  keepsRest = false;
  if (lane == 0 && keptShapes > 0) atomicAdd(rounds[round + 1].shapes, keptShapes);
  hash = uvec2(subgroupAdd(hash.x), subgroupAdd(hash.y));
  depth = subgroupMax(depth);
  unfinished = subgroupAdd(unfinished);
  uint answers = 0;
  if (lane == 0) {
    answers = atomicMax(state.depth, depth);
    if ((hash.x | hash.y) != 0) answers |= atomicAdd(state.keyHashX, hash.x) | atomicAdd(state.keyHashY, hash.y);
    if (unfinished > 0) answers |= atomicAdd(state.unfinishedShapes, unfinished);
  }
  answers |= sayIfEnded();
  leaveRest(queued, axiomsThere, answers);
}
