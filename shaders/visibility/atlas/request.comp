// One invocation a triangle: whether its block keeps its place or asks for another one, and of which class. Counts both
// for each workgroup, and marks places that stay.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

shared uint counts[kRowTiles];
shared uint lowered;
shared uint dropped;
shared uint droppedTriangles;
shared uint visibleTriangles;
shared uint vacated;

void main() {
  uint lane = gl_LocalInvocationIndex;
  if (lane < kRowTiles) counts[lane] = 0u;
  if (lane == 0u) {
    lowered = 0u;
    dropped = 0u;
    droppedTriangles = 0u;
    visibleTriangles = 0u;
    vacated = 0u;
  }
  barrier();
  uint pressure = history[kHeadPressure];
  for (uint round = 0u; round < 4u; ++round) {
    uint triangle = gl_WorkGroupID.x * kAtlasGroup + round * 256u + lane;
    if (triangle >= params.maxTriangles) break;
    uint state = history[stateAt(triangle)];
    uint plan = plans[triangle];
    if (state == 0u && (plan & kPlanVisible) == 0u) continue;
    plan = planUnder(plan, state, pressure);
    uint class_ = planClass(plan);
    if (class_ != 0u) {
      uint leaves = history[kHeadVacated + class_ - kMinClass];
      if (keepsPlace(plan, state, leaves)) {
        plan |= kPlanKeeps;
        uint at = superAt(superOf(state));
        atomicAdd(supers[at], 1u);
        atomicMax(supers[at + 1u], class_);
        atomicOr(supers[at + 2u + placeOf(state) / 32u], 1u << (placeOf(state) % 32u));
      } else {
        atomicAdd(counts[kRowRequests + class_ - kMinClass], 1u);
        if (class_ == classOf(state)) atomicAdd(vacated, 1u);
      }
      atomicAdd(counts[kRowAll + class_ - kMinClass], 1u);
      if (class_ < (plan & kPlanDesired)) atomicAdd(lowered, 1u);
    } else if ((plan & kPlanVisible) != 0u) {
      atomicAdd(dropped, 1u);
      atomicAdd(droppedTriangles, (plan & kPlanBoth) != 0u ? 2u : 1u);
    }
    if ((plan & kPlanVisible) != 0u) atomicAdd(visibleTriangles, (plan & kPlanBoth) != 0u ? 2u : 1u);
    uint list = listOf(plan);
    if (list != kMaxRows) atomicAdd(counts[list], 1u);
    plans[triangle] = plan;
  }
  barrier();
  if (lane < kRowTiles) rows[rowAt(lane, gl_WorkGroupID.x)] = counts[lane];
  if (lane == 0u && visibleTriangles != 0u) {
    atomicAdd(counters.visible, visibleTriangles);
    atomicAdd(counters.lowered, lowered);
    atomicAdd(counters.dropped, dropped);
    atomicAdd(counters.droppedTriangles, droppedTriangles);
    atomicAdd(counters.vacated, vacated);
  }
}
