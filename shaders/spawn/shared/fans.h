// Operators that multiply shapes, by the graph's words: fanOf says into how many shapes one multiplies a shape, toChild
// makes it any one of them. The interpreter and generated kernels share them; what they need is parameter().
//
// Operators of a kind run the same instructions with other words, whichever node it is: that shapes of many nodes are
// in a workgroup at once costs little.
#ifndef GPGP_SHADERS_SPAWN_FANS_H
#define GPGP_SHADERS_SPAWN_FANS_H
#include "spawn/shared/operators.h"

GPGP_SHADER_BEGIN

GPGP_FN uint edgeTarget(GPGP_GRAPH uint node, uint index) {
  return graphWords[graphWords[node + kNodeEdges] + index * kEdgeSize + kEdgeTarget];
}

/// SubDiv whose parts are not constant: the fan, and the part `wanted`.
struct Division {
  Fan fan;
  Part part;
};
GPGP_FN Division divisionOf(GPGP_GRAPH Shape s, uint wanted) {
  Division d;
  const uint count = graphWords[s.node + kNodeEdgeCount];
  float fixedLength = 0.0f;
  float weights = 0.0f;
  float own = 0.0f;
  float weightBefore = 0.0f;
  uint fixedParts = 0u;
  uint weightedParts = 0u;
  d.part.fixedBefore = 0.0f;
  for (uint i = 0u; i < count; ++i) {
    const float v = parameter(GPGP_G s, i);
    const uint bit = edgeTarget(GPGP_G s.node, i) != 0u ? 1u << i : 0u;
    if (i == wanted) {
      own = v;
      d.part.fixedBefore = fixedLength;
      weightBefore = weights;
    }
    if (v > 0.0f) {
      fixedLength = add(fixedLength, v);
      fixedParts |= bit;
    } else if (v < 0.0f) {
      weights = subtract(weights, v);
      weightedParts |= bit;
    }
  }
  d.fan.extent = remainderOf(component(s.size, graphWords[s.node + kNodeArgument]), fixedLength);
  d.fan.successors = fixedParts | (d.fan.extent > 0.0f ? weightedParts : 0u);
  d.fan.count = uint(bitCount(d.fan.successors));
  d.part.fixedLength = max(0.0f, own);
  d.part.share = own < 0.0f ? divide(-own, weights) : 0.0f;
  d.part.shareBefore = weightBefore > 0.0f ? divide(weightBefore, weights) : 0.0f;
  return d;
}

GPGP_FN bool isOperator(uint op, uint which) { return (GPGP_OPERATORS & (1u << which)) != 0u && op == which; }
GPGP_FN float graphFloat(GPGP_GRAPH uint at) { return uintBitsToFloat(graphWords[at]); }
GPGP_FN Part partAt(GPGP_GRAPH uint at) {
  Part part;
  part.fixedLength = graphFloat(GPGP_G at + kPartFixed);
  part.share = graphFloat(GPGP_G at + kPartShare);
  part.fixedBefore = graphFloat(GPGP_G at + kPartFixedBefore);
  part.shareBefore = graphFloat(GPGP_G at + kPartShareBefore);
  return part;
}

/// Where a SubDiv has the pieces of a polygon, by its parts; 0: nowhere.
GPGP_FN uint cutsAt(GPGP_GRAPH uint node, uint polygon) {
  const uint division = graphWords[node + kNodeArgument2];
  if (division == 0u || graphWords[division + kDivisionCuts] == 0u) return 0u;
  const uint first = division + graphWords[division + kDivisionCuts];
  const uint size = graphWords[node + kNodeEdgeCount] + 1u;
  for (uint i = 0u; i < graphWords[first]; ++i) {
    if (graphWords[first + 1u + i * size] == polygon) return first + 2u + i * size;
  }
  return 0u;
}
/// A shape that a SubDiv can not cut is dropped, which whoever asks counts.
GPGP_FN bool isUncut(GPGP_GRAPH Shape s, uint node, uint axis) {
  return isCut(shapeType(s), axis) && (shapeType(s) > kShapeSphere || cutsAt(GPGP_G node, shapePolygon(s)) == 0u);
}
/// The polygon of a SubDiv's part. False where there is nothing of it.
GPGP_FN bool cutTo(GPGP_GRAPH GPGP_INOUT(Shape) s, uint node, uint axis, uint part) {
  if (!isCut(shapeType(s), axis)) return true;
  const uint piece = graphWords[cutsAt(GPGP_G node, shapePolygon(s)) + part];
  if (piece == kNoPiece) return false;
  setGeometry(s, pieceShape(shapeType(s)), piece);
  return true;
}

/// What the operator that a shape waits for makes of it.
GPGP_FN Fan fanOf(GPGP_GRAPH Shape s) {
  const uint op = graphWords[s.node + kNodeOperator] & kOperatorMask;
  Fan fan;
  fan.successors = 0u;
  fan.count = 1u;
  fan.extent = 0.0f;
  if (op < kFirstMultiplying) return fan;
  if (isOperator(op, kOpSubDiv)) {
    if ((GPGP_OPERATORS & kHasCuts) != 0u && isUncut(GPGP_G s, s.node, graphWords[s.node + kNodeArgument])) {
      fan.count = 0u;
      fan.extent = -1.0f;
      return fan;
    }
    const uint division = graphWords[s.node + kNodeArgument2];
    if ((GPGP_OPERATORS & kHasDivisions) != 0u && division == 0u) return divisionOf(GPGP_G s, 0u).fan;
    fan.extent = remainderOf(component(s.size, graphWords[s.node + kNodeArgument]), graphFloat(GPGP_G division));
    fan.successors = graphWords[division + kDivisionFixedParts] |
                     (fan.extent > 0.0f ? graphWords[division + kDivisionWeightedParts] : 0u);
    fan.count = uint(bitCount(fan.successors));
    return fan;
  }
  if (isOperator(op, kOpRepeat)) {
    fan = repetitionOf(component(s.size, graphWords[s.node + kNodeArgument]), graphWords[s.node + kNodeArgument2],
                       parameter(GPGP_G s, 0u));
    if (edgeTarget(GPGP_G s.node, 0u) == 0u) {
      fan.count = 0u;
      fan.extent = 0.0f;
    }
    return fan;
  }
  const uint count = graphWords[s.node + kNodeEdgeCount];
  for (uint i = 0u; i < count; ++i) {
    if (edgeTarget(GPGP_G s.node, i) != 0u) fan.successors |= 1u << i;
  }
  fan.count = uint(bitCount(fan.successors));
  if (isOperator(op, kOpCompSplit)) {
    const Faces faces = facesOf(GPGP_G s.geometry, fan.successors);
    fan.successors = faces.successors;
    fan.count = faces.count;
  }
  return fan;
}

/// The shape becomes its child number index, below fan.count; its node is 0 where SubDiv has nothing for it. Of the fan
/// it needs successors and length.
GPGP_FN void toChild(GPGP_GRAPH GPGP_INOUT(Shape) s, Fan fan, uint index) {
  if (GPGP_OPERATORS == 0u || fan.successors == 0u) return;
  const uint op = graphWords[s.node + kNodeOperator] & kOperatorMask;
  const uint argument = graphWords[s.node + kNodeArgument];
  const uint argument2 = graphWords[s.node + kNodeArgument2];
  uint successor = 0u;
  if (isOperator(op, kOpSubDiv)) {
    successor = selectBit(fan.successors, index);
    Part part;
    if ((GPGP_OPERATORS & kHasDivisions) != 0u && argument2 == 0u)
      part = divisionOf(GPGP_G s, successor).part;
    else
      part = partAt(GPGP_G argument2 + kDivisionParts + successor * kPartSize);
    bool there = toPart(s, argument, fan.extent, part, successor);
    if ((GPGP_OPERATORS & kHasCuts) != 0u) there = there && cutTo(GPGP_G s, s.node, argument, successor);
    if (!there) {
      s.node = 0u;
      return;
    }
  } else if (isOperator(op, kOpRepeat)) {
    toRepeat(s, argument, argument2, fan.successors, fan.extent, index);
  } else if (isOperator(op, kOpCompSplit)) {
    const uint number = faceNumber(fan.successors, index);
    successor = min(number, 2u);
    if ((GPGP_OPERATORS & kHasSides) != 0u)
      toFace(GPGP_G s, number);
    else
      toBoxFace(s, number);
  } else {
    successor = selectBit(fan.successors, index);
    toCopy(s, successor);
  }
  follow(s, edgeTarget(GPGP_G s.node, successor));
}

GPGP_SHADER_END
#endif
