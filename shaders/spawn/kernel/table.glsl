// What a generated kernel does by its table (table_format.h). Results equal those of operators.h: settled values do not
// change by adding zero or by a factor of one.
layout(constant_id = 2) const uint tableStart = 0; // in graphRows

/// 0: none.
uint familyOf(uint node) { return graphWords[4u * tableStart + (node - kHeaderSize) / kNodeSize]; }
uvec4 tableAt(uint offset) { return graphRows[tableStart + offset]; }

// What no frame has costs nothing.
bool hasFrame(uint flags, uint flag) { return (GPGP_FRAMES & flag) != 0u && (flags & flag) != 0u; }
float frameFactor(vec3 size, uint factor) {
  return factor == kFrameNoFactor ? 1.0f : component(size, factor);
}
/// v + d * numbers that are drawn; first: the flag of the first component.
vec3 frameDrawn(vec3 v, vec3 d, uvec2 key, uint flags, uint first) {
  if (hasFrame(flags, first)) v.x = add(v.x, multiply(d.x, drawnNumber(key, 0u)));
  if (hasFrame(flags, first << 1)) v.y = add(v.y, multiply(d.y, drawnNumber(key, 1u << kDrawsOfParameter)));
  if (hasFrame(flags, first << 2)) v.z = add(v.z, multiply(d.z, drawnNumber(key, 2u << kDrawsOfParameter)));
  return v;
}
vec3 frameVector(uint row, vec3 v, vec3 size, uvec2 key, uint flags, uint first, uint factors) {
  if (hasFrame(flags, 7u * first)) v = frameDrawn(v, unpackVector(tableAt(row + 1u)), key, flags, first);
  if (factors != 0x3fu)
    v = vec3(multiply(frameFactor(size, factors & 3u), v.x), multiply(frameFactor(size, (factors >> 2) & 3u), v.y),
             multiply(frameFactor(size, factors >> 4), v.z));
  if (hasFrame(flags, kFrameAdded)) {
    const vec3 c = unpackVector(tableAt(row + 2u));
    v = vec3(add(v.x, c.x), add(v.y, c.y), add(v.z, c.z));
  }
  return v;
}
void transformBy(inout Shape s, uint frame, uint flags) {
  const uvec4 translation = tableAt(frame);
  if (hasFrame(flags, kFrameTranslates)) {
    s.position = framePoint(s, frameVector(frame, unpackVector(translation), s.size, s.key, flags,
                                           kFrameTranslationDraws, flags & 0x3fu));
    if (hasFrame(flags, 7u * kFrameTranslationDraws)) s.key = drawnKey(s.key);
  }
  if (hasFrame(flags, kFrameRotates)) {
    const uint rotation = frame + kFrameRotation / 4u;
    Rotation r;
    r.c0 = unpackVector(tableAt(rotation));
    r.c1 = unpackVector(tableAt(rotation + 1u));
    if (hasFrame(flags, 7u * kFrameRotationDraws)) {
      const vec3 angles = frameDrawn(r.c0, r.c1, s.key, flags, kFrameRotationDraws);
#ifdef GPGP_SOFTWARE // which counts turns of loops
      r = rotationOfAngles(sineCosineDegrees(angles.x), sineCosineDegrees(angles.y), sineCosineDegrees(angles.z));
#else
      r = rotationOf(angles);
#endif
      s.key = drawnKey(s.key);
    } else {
      r.c2 = unpackVector(tableAt(rotation + 2u));
    }
    rotate(s, r);
  }
  if (hasFrame(flags, kFrameScales)) {
    const uint scale = frame + kFrameScale / 4u;
    resize(s, frameVector(scale, unpackVector(tableAt(scale)), s.size, s.key, flags, kFrameScaleDraws,
                          (flags >> 6) & 0x3fu));
    if (hasFrame(flags, 7u * kFrameScaleDraws)) s.key = drawnKey(s.key);
  }
}
/// toPart where it is known whether some parts have a fixed length.
bool toPartBy(inout Shape s, uint axis, float remainder, bool fixedLengths, uvec4 row, vec4 part) {
  if (fixedLengths) return toPart(s, axis, remainder, Part(part.x, part.y, part.z, part.w), row.y);
  toPiece(s, axis, multiply(remainder, part.w), multiply(remainder, part.y), row.y);
  return true;
}
/// The fan of a shape that waits for a family's operator.
Fan familyFan(Shape s, uint family) {
  const uvec4 row = tableAt(family);
#ifdef GPGP_REPEATS
  if (row.y != 0) {
    Fan fan = repetitionOf(component(s.size, graphWords[s.node + kNodeArgument]), graphWords[s.node + kNodeArgument2],
                           parameter(s, 0u));
    fan.count *= row.x;
    return fan;
  }
#endif
  return Fan(row.x, row.x, 0.0f);
}
/// The shape becomes a child of its family. Returns a kEnd value.
uint toDescendant(inout Shape s, uint family, Fan fan, uint index, uint maxDepth) {
#ifdef GPGP_REPEATS
  const uvec4 row = tableAt(family);
  if (row.y != 0) {
    const uint copy = index / row.x;
    index -= copy * row.x;
    toRepeat(s, graphWords[s.node + kNodeArgument], graphWords[s.node + kNodeArgument2], fan.successors, fan.extent,
             copy);
  }
#endif
  uvec4 child = tableAt(family + 1u + index);
#if defined(GPGP_PROGRAMS) && !defined(GPGP_SOFTWARE) // there all programs would run
  for (;;) {
    const uint next = runProgram(s, child); // generated
    if (next == 0u) break;
    if (next == 0xffffffffu) return kEndDiscarded;
    child = tableAt(next);
  }
#else
  for (uint i = 0; i < (child.y & kEntrySteps); ++i) {
    const uvec4 row = tableAt(child.x + kStepSize * i);
    const uint op = row.x & kStepOperator;
    if (isStep(op, kOpSubDiv)) {
      const uint axis = (row.x >> kStepAxis) & 0xffu;
      const float remainder = remainderOf(component(s.size, axis), uintBitsToFloat(row.z));
      if ((row.x & kStepWeighted) != 0u && !(remainder > 0.0f)) return kEndDiscarded;
      const vec4 part = uintBitsToFloat(tableAt(child.x + kStepSize * i + 1u));
      if (!toPart(s, axis, remainder, Part(part.x, part.y, part.z, part.w), row.y)) return kEndDiscarded;
    } else if (isStep(op, kOpCompSplit)) {
      toBoxFace(s, row.y);
    } else if (isStep(op, kOpReplicate)) {
      toCopy(s, row.y);
    } else if (isStep(op, kOpIf)) {
      child = tableAt(row.y + chosenEdge(s, row.z)); // which draws
      i = 0xffffffffu;
      continue;
    }
    if (GPGP_FRAMES != 0u && row.w != 0u) transformBy(s, row.w, tableAt(row.w).w);
  }
#endif
  s.node = child.z & ~kEdgeRecursive;
  s.depth += child.z >> 31;
  return s.depth > maxDepth ? kEndUnfinished : child.w;
}
