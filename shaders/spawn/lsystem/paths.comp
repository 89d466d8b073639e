#version 460
#extension GL_GOOGLE_include_directive : require
// Which corner of all each module is: of polygons in the order of the string, of cylinders in that by depth. The
// module that begins a polygon or cylinder learns where it ends.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
layout(push_constant) uniform Push { uint stage, kind; };
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/frames.glsl"

void main() {
  sourceHalf = state.last;
  const bool cylinders = kind == kLsysSumCylinders;
  const uint place = gl_GlobalInvocationID.x;
  const bool isThere = place < state.modules;
  uint module = place;
  if (isThere && cylinders) module = order[orderAt(place)];
  const uint turtle = isThere ? lsysTurtleOf(lsysModule(module).x) : kTurtleNone;
  const bool begins = turtle == (cylinders ? kTurtleCylinder : kTurtlePolygon);
  const bool corner = isThere && (cylinders ? lsysIsSection(turtle)
                                            : lsysIsCorner(turtle) && (marks[module].x & 0x10000u) != 0u);
  const uvec4 own = uvec4(corner ? 1u : 0u, begins ? place + 1u : 0u, 0u, 0u);
  uvec4 upTo = sumUpTo(own, true);
  if (stage == 0u) {
    if (gl_LocalInvocationIndex == 0u) tiles[gl_WorkGroupID.x] = scanned[kLsysTile - 1u];
    return;
  }
  upTo = joined(tiles[gl_WorkGroupID.x], upTo, true);
  if (!corner && !begins) return;
  const uint index = upTo.x - own.x;
  marks[module].w = index;
  if (begins) atomicMax(chosen[module], index);
  if (!corner || upTo.y == 0u) return;
  const uint beginning = cylinders ? order[orderAt(upTo.y - 1u)] : upTo.y - 1u;
  const bool same = cylinders ? headOf(beginning) == headOf(module) : marks[beginning].z == marks[module].z;
  if (same) atomicMax(chosen[beginning], index + 1u);
}
