// A queue for each execution group in a workgroup (thesis 3.1.1, after Whippletree): a batch is of one group, so that
// all of its shapes run the same code.
//
// The workgroup's memory is that of its stack. A list in shared memory says in which order its places are used: those
// of the stack first, with the queue that each shape is in, the free ones behind them. So a queue is a part of the
// stack in the stack's order, takes no room of its own, and no queue is full as long as the stack is not. A batch takes
// the last shapes of the queue that fills most of the workgroup's invocations.
#ifndef GPGP_TABLE
layout(constant_id = 2) const uint tableStart = 0; // in graphRows
#endif
shared uint places[stackShapes]; // in the stack's order: a place, and its queue << 16
shared uint queued[GPGP_QUEUES]; // shapes of each queue
shared uint taken[groupSize];    // places of a batch
shared uint fullest;             // 0 but while a queue is chosen

/// A node's queue. Any node has one; the result does not depend on which.
uint queueOf(uint node) {
  return graphWords[4u * tableStart + GPGP_QUEUE_TABLE + (node - kHeaderSize) / kNodeSize];
}
/// Where the stack's shape lies.
uint placeOf(uint index) { return places[index] & 0xffffu; }
/// The stack's shape waits for this node.
void enterQueue(uint index, uint node) {
  const uint queue = queueOf(node);
  places[index] = placeOf(index) | queue << 16;
  atomicAdd(queued[queue], 1);
}
/// The stack has become empty. A barrier must follow.
void emptyQueues() {
  for (uint i = laneIndex(); i < GPGP_QUEUES; i += groupSize) queued[i] = 0;
}
/// Before anything else. A barrier must follow.
void startQueues() {
  for (uint i = laneIndex(); i < stackShapes; i += groupSize) places[i] = i;
  emptyQueues();
  if (laneIndex() == 0) fullest = 0;
}

/// The largest of all invocations' values.
uint largestOf(uint value) {
#ifdef GPGP_SUBGROUPS
  if (oneSubgroup) return subgroupMax(value);
#endif
  if (value > 0) atomicMax(fullest, value);
  barrier();
  value = fullest;
  barrier();
  if (laneIndex() == 0) fullest = 0; // there are barriers before the next one is asked for
  return value;
}

/// Counts the shapes that invocations hold, which is undone by whoever does not put them onto the stack. Returns the
/// queue whose shapes fill most invocations: of several full ones the last one in the graph's order, so that shapes
/// leave before others come.
uint fullestQueue(bool holds, uint node) {
  if (holds) atomicAdd(queued[queueOf(node)], 1);
  groupBarrier();
  uint own = 0;
  for (uint i = laneIndex(); i < GPGP_QUEUES; i += groupSize) own = max(own, min(queued[i], groupSize) << 16 | i);
  return largestOf(own) & 0xffffu;
}

/// Counted shapes onto the stack, where there is room. place: among count of them.
void holdBack(bool own, uint place, uint count, Shape s) {
  if (own) {
    const uint at = placeOf(stackSize + place);
    places[stackSize + place] = at | queueOf(s.node) << 16;
    for (uint plane = 0; plane < kShapePlanes; ++plane) stacks[stackPlane(plane) + at] = packShape(s, plane);
  }
  stackSize += count;
  groupBarrier();
}

/// Brings the last `wanted` of a queue's `there` shapes to the top of the stack. All others keep their order.
void bringUp(uint queue, uint there, uint wanted) {
  if (there == stackSize || wanted == 0) return;
  const uint lane = laneIndex();
  const uint skipped = there - wanted;
  uint met = 0; // of the queue
  for (uint first = 0; first < stackSize; first += groupSize) {
    // Places move down only, to where they have been read.
    const uint index = first + lane;
    const uint place = index < stackSize ? places[index] : 0xffffffffu;
    const bool isOfQueue = place >> 16 == queue;
    uint more;
    const uint before = met + ranksOf(isOfQueue, false, more);
    const uint down = max(before, skipped) - skipped; // taken ones below
    if (isOfQueue && before >= skipped)
      taken[down] = place;
    else if (index < stackSize)
      places[index - down] = place;
    met += more;
  }
  groupBarrier();
  if (lane < wanted) places[stackSize - wanted + lane] = taken[lane];
  groupBarrier();
}

/// The next batch is of this queue. Held shapes of others, which are counted, go onto the stack, or where none is to be
/// kept all of them; waits, waiting: those that stay, and how many. Returns how many more to take from the top of the
/// stack, where they are.
uint gather(uint queue, bool none, inout bool waits, inout uint waiting, Shape s) {
  const bool other = waits && (none || queueOf(s.node) != queue);
  waits = waits && !other;
  uint both;
  const uint ranks = ranksOf(other, waits, both);
  holdBack(other, ranks & 0xffffu, both & 0xffffu, s);
  waiting = both >> 16;
  if (none) return 0;
  const uint there = queued[queue] - waiting;
  const uint more = min(there, min(groupSize - waiting, max((stackRoom - stackSize) / 8, 1)));
  bringUp(queue, there, more);
  groupBarrier();
  if (laneIndex() == 0) queued[queue] = there - more;
  return more;
}
