// How a workgroup derives.
//
// A batch is one shape for each invocation, waiting for an operator that multiplies. Step by step its children are
// made, one an invocation whoever the parent, and each goes through its chain of operators until it is a terminal, or
// waits in its turn: on the stack, or, in the batch's last step, where it is, as a part of the next batch. Terminals
// leave at once, a workgroup's together. Where more shapes wait on the stack, a batch ends with a full step: parents
// whose children are too many for that go back to the stack, one perhaps with a part of them made.
const uint kPlenty = 16; // shapes of a round for each workgroup: then some may idle so that batches of others are full
shared uint childrenUpTo[groupSize]; // of the batch's parents: inclusive sums
shared uint hashX;
shared uint hashY;
shared uint deepest;
shared uint unfinishedShapes;

/// The last workgroup of a round leaves the shapes to the next one that nobody took, as all have run out of steps; and
/// if nothing is left, the derivation is over. answers: see isLast.
void leaveRest(uint count, uint answers) {
  const uint lane = laneIndex();
  if (stackSize > 0) giveAway();
  uint last = 0;
  if (lane == 0 && isLast(answers)) last = 1;
  if (fromFirst(last) == 0) return;
  for (uint left = 0;; left += groupSize) {
    uint first = 0;
    if (lane == 0) first = atomicAdd(rounds[round].taken, groupSize);
    first = fromFirst(first);
    if (first >= count) break;
    if (turnsCount && left >= record.mostLeft) {
      if (lane == 0) atomicAdd(state.droppedShapes, count - first);
      break;
    }
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
  if (lane == 0) sayIfEnded();
  if (lane == 0 && record.reports != 0 &&
      (round + 1 == record.rounds || atomicAdd(rounds[round + 1].shapes, 0) == 0))
    reportAll();
}

/// What the workgroup's invocations have counted to the recording's counters. Returns their answers, to the first one.
uint addCounts(uvec2 hash, uint depth, uint unfinished) {
#ifdef GPGP_SUBGROUPS
  hash = uvec2(subgroupAdd(hash.x), subgroupAdd(hash.y));
  depth = subgroupMax(depth);
  unfinished = subgroupAdd(unfinished);
  const bool adds = subgroupElect();
#else
  const bool adds = true;
#endif
  if (adds) {
    atomicAdd(hashX, hash.x);
    atomicAdd(hashY, hash.y);
    atomicMax(deepest, depth);
    atomicAdd(unfinishedShapes, unfinished);
  }
  barrier();
  uint answers = 0;
  if (laneIndex() == 0) {
    answers = atomicMax(state.depth, deepest);
    if ((hashX | hashY) != 0) answers |= atomicAdd(state.keyHashX, hashX) | atomicAdd(state.keyHashY, hashY);
    if (unfinishedShapes > 0) answers |= atomicAdd(state.unfinishedShapes, unfinishedShapes);
  }
  return answers;
}

void main() {
  const uint lane = laneIndex();
  const uint axiomsThere = record.readsAxiomCounter != 0 ? axiomCounter : record.axiomCount;
  const uint needed = round == 0 ? axiomsThere : rounds[round].shapes;
  const uint count = min(needed, round == 0 ? record.axiomCount : record.maxShapes);
  startRound(needed, count);
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
  const uint full = kGrowing * groupSize;
  const uint grown = growth <= full ? growth : roundsLeft() == 1 ? full : kGrowth;
  const uint enough = spreads ? max(grown, kGrowth) : 0xffffffffu;
  stackSize = 0;
  keepsRest = roundsLeft() == 0;
  keptAt = 0;
  keptCount = 0;
  keptShapes = 0;
  if (lane == 0) {
    hashX = 0;
    hashY = 0;
    deepest = 0;
    unfinishedShapes = 0;
#ifdef GPGP_COLLIDERS
    spentInStep = 0;
#endif
  }
#ifdef GPGP_QUEUES
  startQueues();
#endif
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
#ifdef GPGP_QUEUES
  bool drained = false; // nothing is left to fetch
  const uint fair = count / gl_NumWorkGroups.x;
  uint fetchedShapes = 0;
#endif
  const uint mostTurns = mostTurnsOf(count);
#ifdef GPGP_QUEUES
  uint batchTurns = 0; // none of a batch that is chosen again
  for (uint turns = 0; turns < mostTurns || made < total; turns += batchTurns) {
    batchTurns = record.batchTurns;
#else
  for (uint turns = 0; turns < mostTurns || made < total; turns += record.batchTurns) {
#endif
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
#ifdef GPGP_QUEUES
      // Its shapes are of one queue. While none fills a batch, more come into the workgroup: at most its share, unless
      // there are plenty, and never so many that they would leave again.
      uint more = 0;
      if (waiting + stackSize > 0) {
        if (turnsCount) turns += gatherTurns(stackShapes, groupSize);
        if (waiting + stackSize > stackRoom) giveAway();
        const uint queue = fullestQueue(waits, s.node);
        const bool mayFetch = !drained && (fair >= kPlenty || fetchedShapes + share <= fair);
        const bool fetches = mayFetch && queued[queue] < groupSize &&
                             waiting + stackSize + share < min(enough, stackRoom / 2);
        more = gather(queue, fetches, waits, waiting, s);
      }
#else
      const uint space = groupSize - waiting;
      const uint more = min(stackSize, min(space, max((stackRoom - stackSize) / 8, 1)));
#endif
      if (more > 0) {
        uint idle;
        const uint place = ranksOf(!waits, false, idle);
        stackBarrier();
        if (!waits && place < more) {
          s = stackedAt(placeOf(stackSize - 1 - place));
          waits = true;
        }
        stackSize -= more;
        waiting += more;
      }
      if (waiting == 0) {
        if (lane == 0) first = atomicAdd(rounds[round].taken, share);
        first = fromFirst(first);
#ifdef GPGP_QUEUES
        if (first >= count && stackSize > 0) {
          drained = true;
          batchTurns = 0;
          continue;
        }
#endif
        if (first >= count) break;
        waiting = min(share, count - first);
        fetched = round == 0;
        if (fetched) {
          total = waiting;
        } else if (lane < waiting) {
          s = queuedAt(first + lane);
          waits = true;
        }
#ifdef GPGP_QUEUES
        fetchedShapes += waiting;
        if (!fetched) {
          batchTurns = 0;
          continue;
        }
#endif
      }
      if (!fetched) {
#ifdef GPGP_BATCH // tests count batches
        GPGP_BATCH(waits, s.node)
#endif
        Fan fan;
        fan.count = 0;
        if (waits) {
          fan = fanFor(s);
          if (fan.extent < 0.0f) atomicAdd(state.droppedShapes, 1);
          fan.count = min(fan.count - s.made, 0xffffffffu / groupSize); // more come later
          keepParent(s, fan);
        }
        const uint before = sumBefore(fan.count, total);
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
          const bool late = waits && fan.count > 0 && before + fan.count > total; // what makes none is done
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
      if (end == kEndTerminal) { // also of a family's, which goes through no chain
        s.axiom = axiomNumber(s.axiom);
        if (s.axiom >= record.contextFrom) end = kEndDiscarded;
      }
#else
      if (end == kEndGoesOn) end = runChain(s, arrives, record.maxDepth);
#endif
      depth = max(depth, s.depth);
      if (end == kEndUnfinished) unfinished += 1;
    }
    made += batch;
#ifdef GPGP_COLLIDERS
    turns += queriedTurns();
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
    if (end == kEndTerminal) hash += hashOfTerminal(s);
    emit(end == kEndTerminal, places & 0xffffu, terminals, firstTerminal, s);
  }

  keepsRest = false;
  if (lane == 0 && keptShapes > 0) atomicAdd(rounds[round + 1].shapes, keptShapes);
  uint rest; // what there were no steps left for goes over
  const uint place = ranksOf(waits, false, rest);
  push(waits, place, rest, s);

  uint answers = 0;
  answers |= sayIfEnded();
  if (oneSubgroup) answers |= addCounts(hash, depth, unfinished);
  leaveRest(count, answers);
  if (!oneSubgroup) addCounts(hash, depth, unfinished);
}
