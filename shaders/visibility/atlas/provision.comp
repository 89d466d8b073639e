// One workgroup: gives each class the superblocks that its requests need beyond its free places, the largest class
// first. If too few are left, all blocks get new places: resolve has seen to it that they then fit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 16) in;

// By class; the invocations read together what one of them adds up.
shared uint all_[kClasses];
shared uint requests[kClasses];
shared uint free[kClasses];
shared uint used[kClasses];
shared uint firstNew[kClasses];
shared bool repacked;

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane < kClasses) {
    all_[lane] = rows[kRowAll + lane];
    requests[lane] = rows[kRowRequests + lane];
    free[lane] = counters.classFree[lane + 1u];
    used[lane] = counters.classSupers[lane + 1u];
    counters.byClass[lane] = all_[lane];
  }
  barrier();
  if (lane == 0u) {
    uint unused = counters.classSupers[0];
    uint needed = 0u;
    uint least = 0u;
    uint inUse = 0u;
    uint blocks = 0u;
    uint texels = 0u;
    for (uint i = kClasses; i-- > 0u;) {
      firstNew[i] = needed;
      if (requests[i] > free[i]) needed += supersFor(requests[i] - free[i], kMinClass + i);
      least += supersFor(all_[i], kMinClass + i);
      inUse += used[i];
      blocks += all_[i];
      texels += all_[i] << (kMinClass + i);
    }
    repacked = needed > unused;
    uint place = 0u;
    for (uint i = kClasses; repacked && i-- > 0u;) {
      firstNew[i] = place;
      place += supersFor(all_[i], kMinClass + i);
    }
    uint kept = rows[kRowKept];
    counters.repacked = repacked ? 1u : 0u;
    counters.supers = repacked ? least : inUse + needed;
    counters.leastSupers = least;
    counters.blocks = blocks;
    counters.texels = texels;
    counters.added = rows[kRowNew];
    counters.gone = rows[kRowGone];
    counters.kept = repacked ? 0u : kept;
    counters.changed = rows[kRowChanged] + (repacked ? kept : 0u);
  }
  barrier();
  if (lane >= kClasses) return;
  counters.firstNew[lane] = firstNew[lane];
  uint emptiest = counters.emptiest[lane + 1u];
  uint kept = emptiest == 0xffffffffu ? 0u : emptiest >> 12u;
  bool vacated = !repacked && isVacated(kMinClass + lane, kept, free[lane], requests[lane]);
  history[kHeadVacated + lane] = vacated ? 4096u - (emptiest & 4095u) : 0u;
}
