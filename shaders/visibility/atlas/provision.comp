// One invocation: gives each class the superblocks that its requests need beyond its free places, the largest class
// first. If too few are left, all blocks get new places: resolve has seen to it that they then fit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 1) in;

void main() {
  uint needed = 0u;
  uint least = 0u;
  uint used = 0u;
  for (uint i = kClasses; i-- > 0u;) {
    uint class_ = kMinClass + i;
    uint requests = rows[kRowRequests + i];
    uint free = counters.classFree[i + 1u];
    counters.firstNew[i] = needed;
    if (requests > free) needed += supersFor(requests - free, class_);
    least += supersFor(rows[kRowAll + i], class_);
    used += counters.classSupers[i + 1u];
    counters.byClass[i] = rows[kRowAll + i];
    counters.blocks += rows[kRowAll + i];
    counters.texels += rows[kRowAll + i] << class_;
  }
  bool repacked = needed > counters.classSupers[0];
  uint place = 0u;
  for (uint i = kClasses; i-- > 0u;) {
    uint class_ = kMinClass + i;
    uint vacated = 0u;
    if (repacked) {
      counters.firstNew[i] = place;
      place += supersFor(rows[kRowAll + i], class_);
    } else {
      uint emptiest = counters.emptiest[i + 1u];
      uint kept = emptiest == 0xffffffffu ? 0u : emptiest >> 12u;
      if (isVacated(class_, kept, counters.classFree[i + 1u], rows[kRowRequests + i]))
        vacated = 4096u - (emptiest & 4095u);
    }
    history[kHeadVacated + i] = vacated;
  }
  counters.repacked = repacked ? 1u : 0u;
  counters.supers = repacked ? least : used + needed;
  counters.leastSupers = least;
  counters.added = rows[kRowNew];
  counters.gone = rows[kRowGone];
  counters.kept = repacked ? 0u : rows[kRowKept];
  counters.changed = rows[kRowChanged] + (repacked ? rows[kRowKept] : 0u);
}
