// The parents of a batch, one for each invocation. Where the workgroup is one subgroup, each stays in registers and is
// handed on; elsewhere they lie behind the workgroup's stack. Shared memory would hold them as well, but then fewer
// workgroups would be resident.
#ifdef GPGP_SUBGROUPS
Shape ownParent;
Fan ownFan;
#endif
shared uvec2 fans[oneSubgroup ? 1 : groupSize]; // successors, length

/// The invocation's parent.
void keepParent(Shape s, Fan fan) {
#ifdef GPGP_SUBGROUPS
  if (oneSubgroup) {
    ownParent = s;
    ownFan = fan;
    return;
  }
#endif
  const uint lane = laneIndex();
  for (uint plane = 0; plane < kShapePlanes; ++plane)
    stacks[stackPlane(plane) + stackRoom + lane] = packShape(s, plane);
  fans[lane] = uvec2(fan.successors, floatBitsToUint(fan.extent));
}

/// The parent of an invocation, and its fan without the count. Everybody asks together.
Shape parentAt(uint lane, out Fan fan) {
  fan.count = 0;
#ifdef GPGP_SUBGROUPS
  if (oneSubgroup) {
    fan.successors = subgroupShuffle(ownFan.successors, lane);
    fan.extent = subgroupShuffle(ownFan.extent, lane);
    return unpackShape(subgroupShuffle(packShape(ownParent, 0), lane), subgroupShuffle(packShape(ownParent, 1), lane),
                       subgroupShuffle(packShape(ownParent, 2), lane), subgroupShuffle(packShape(ownParent, 3), lane),
                       subgroupShuffle(packShape(ownParent, 4), lane), subgroupShuffle(packShape(ownParent, 5), lane));
  }
#endif
  fan.successors = fans[lane].x;
  fan.extent = uintBitsToFloat(fans[lane].y);
  return stackedAt(stackRoom + lane);
}
