// The operators, and the interpreter's two halves: runChain takes a shape through operators with one successor until
// it ends, becomes a terminal or multiplies; childOf makes any one of the shapes into which it multiplies.
//
// Both are pure functions of the shape and the graph. That a child can be made alone, by its number, lets a workgroup
// spread the children of its shapes evenly over its invocations.
#ifndef GPGP_SHADERS_SPAWN_OPERATORS_H
#define GPGP_SHADERS_SPAWN_OPERATORS_H
#include "spawn/expression.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kEndDiscarded = 0u;
GPGP_CONST uint kEndTerminal = 1u; // shape.node is the terminal's node
GPGP_CONST uint kEndFan = 2u;      // shape.node multiplies the shape

/// How a chain ended.
struct ChainEnd {
  uint kind;
  uint count; // kEndFan: children
  uint
      successors; // kEndFan: bit i set: successor i takes part; 0: the chain only paused, the child is the shape itself
};

GPGP_FN float parameter(GPGP_GRAPH Shape s, uint index) {
  return evaluate(GPGP_G s, graphWords[s.node + kNodeParameters] + index * kParameterSize);
}
GPGP_FN uint edgeTarget(GPGP_GRAPH uint node, uint index) {
  return graphWords[graphWords[node + kNodeEdges] + index * kEdgeSize + kEdgeTarget];
}
/// The place of the n-th set bit.
GPGP_FN uint selectBit(uint bits, uint n) {
  for (uint i = 0u; i < n; ++i) bits &= bits - 1u;
  return uint(findLSB(bits));
}

/// What SubDiv makes of its parameters: the length that weights share, and the sum of weights.
struct Division {
  float remainder;
  float weights;
  uint live; // bit i: part i has an extent and a successor
};
GPGP_FN Division divisionOf(GPGP_GRAPH Shape s) {
  Division d;
  float fixedLength = 0.0f;
  d.weights = 0.0f;
  uint fixedParts = 0u;
  uint weightedParts = 0u;
  const uint count = graphWords[s.node + kNodeEdgeCount];
  for (uint i = 0u; i < count; ++i) {
    const float v = parameter(GPGP_G s, i);
    const uint bit = edgeTarget(GPGP_G s.node, i) != 0u ? 1u << i : 0u;
    if (v > 0.0f) {
      fixedLength = add(fixedLength, v);
      fixedParts |= bit;
    } else if (v < 0.0f) {
      d.weights = subtract(d.weights, v);
      weightedParts |= bit;
    }
  }
  d.remainder = max(0.0f, subtract(component(s.size, graphWords[s.node + kNodeArgument]), fixedLength));
  d.live = fixedParts | (d.remainder > 0.0f ? weightedParts : 0u);
  return d;
}

/// The length of v where v weights share a remainder.
GPGP_FN float shareOf(Division d, float weight) { return divide(multiply(d.remainder, weight), d.weights); }

/// How many times Repeat's extent fits. A part in ten thousand of a copy is taken for rounding.
struct Repetition {
  uint count;
  float extent;
};
GPGP_FN Repetition repetitionOf(GPGP_GRAPH Shape s) {
  const float size = component(s.size, graphWords[s.node + kNodeArgument]);
  const uint mode = graphWords[s.node + kNodeArgument2];
  const float wanted = parameter(GPGP_G s, 0u);
  Repetition r;
  r.extent = wanted < 0.0f ? multiply(size, -wanted) : wanted;
  r.count = 0u;
  if (!(r.extent > 0.0f) || !(size > 0.0f)) return r;
  const float fits = min(divide(size, r.extent), float(kMaxRepeat));
  if (mode == kRepeatAdjustToFill) {
    r.count = uint(floor(add(fits, 1.0e-4f)));
    if (r.count > 0u) r.extent = divide(size, float(r.count));
  } else {
    r.count = uint(max(1.0f, -floor(subtract(1.0e-4f, fits))));
  }
  return r;
}

GPGP_FN uint sideCount(GPGP_GRAPH uint geometry) {
  const uint shape = geometry & 0xffu;
  if (!isPrism(shape)) return 0u;
  if (shape == kShapeBox) return 4u;
  return graphWords[graphWords[kHeaderSections + 2u * kSectionPolygons + 1u] + (geometry >> 8) * kPolygonSize + 1u];
}

/// The edge that a conditional or random operator takes.
GPGP_FN uint chooseEdge(GPGP_GRAPH Shape s, uint op) {
  const float first = parameter(GPGP_G s, 0u);
  if (op == kOpIf) return first != 0.0f ? 0u : 1u;
  if (op == kOpIfSizeLess) return component(s.size, graphWords[s.node + kNodeArgument]) < first ? 0u : 1u;
  const uint count = graphWords[s.node + kNodeEdgeCount];
  float total = 0.0f;
  for (uint i = 0u; i < count; ++i) total = add(total, max(0.0f, parameter(GPGP_G s, i + 1u)));
  const float x = multiply(subtract(first, floor(first)), total);
  float sum = 0.0f;
  uint chosen = 0u;
  for (uint i = 0u; i < count; ++i) {
    const float p = max(0.0f, parameter(GPGP_G s, i + 1u));
    if (p > 0.0f && (sum <= x)) chosen = i;
    sum = add(sum, p);
  }
  return chosen;
}

GPGP_FN float scaled(float size, float v) { return v < 0.0f ? multiply(size, -v) : v; }

/// The shape after one of the operators that pass on exactly one shape; its node stays.
GPGP_FN Shape transformed(GPGP_GRAPH Shape s, uint op) {
  // Values are worked out at one place: a GPU has all of evaluate() again wherever it is called.
  vec3 value = vec3(0.0f);
  const uint count = min(graphWords[s.node + kNodeParameterCount], 3u);
  for (uint i = 0u; i < count; ++i) value = withComponent(value, i, parameter(GPGP_G s, i));
  Shape r = s;
  if (op == kOpTranslate) {
    r.position = framePoint(s, value);
  } else if (op == kOpRotate) {
    const vec2 x = sineCosineDegrees(value.x);
    const vec2 y = sineCosineDegrees(value.y);
    const vec2 z = sineCosineDegrees(value.z);
    // columns of Rz * Ry * Rx
    const float sxsy = multiply(x.x, y.x);
    const float cxsy = multiply(x.y, y.x);
    const vec3 c0 = vec3(multiply(z.y, y.y), multiply(z.x, y.y), -y.x);
    const vec3 c1 = vec3(subtract(multiply(z.y, sxsy), multiply(z.x, x.y)),
                         add(multiply(z.x, sxsy), multiply(z.y, x.y)), multiply(y.y, x.x));
    const vec3 c2 = vec3(add(multiply(z.y, cxsy), multiply(z.x, x.x)),
                         subtract(multiply(z.x, cxsy), multiply(z.y, x.x)), multiply(y.y, x.y));
    r.axisX = frameDirection(s, c0);
    r.axisY = frameDirection(s, c1);
    r.axisZ = frameDirection(s, c2);
  } else if (op == kOpScale) {
    r.size = vec3(scaled(s.size.x, value.x), scaled(s.size.y, value.y), scaled(s.size.z, value.z));
  } else if (op == kOpExtrude) {
    if (isPolygon(shapeType(s))) { // solids stay as they are
      r.axisY = s.axisZ;
      r.axisZ = vec3(settle(-s.axisY.x), settle(-s.axisY.y), settle(-s.axisY.z));
      r.size = vec3(s.size.x, scaled(s.size.z, value.x), s.size.y);
      r.geometry = prismOf(shapeType(s)) | (s.geometry & 0xffffff00u);
      r.seed = childSeed(s.seed, 0u);
    }
  } else if (op == kOpSwapSize) {
    const uint axes = graphWords[s.node + kNodeArgument];
    r.size = vec3(component(s.size, axes & 3u), component(s.size, (axes >> 2) & 3u), component(s.size, axes >> 4));
  } else { // kOpSetGeometry
    r.geometry = graphWords[s.node + kNodeArgument] | (graphWords[s.node + kNodeArgument2] << 8);
  }
  return r;
}

/// A face of a box: 0 top, 1 bottom, then back, front, left, right. X runs to the right and Z out of the face.
GPGP_FN Shape boxFace(Shape s, uint face) {
  Shape r = s;
  const vec3 zero = vec3(0.0f);
  const vec3 notX = settle3(zero - s.axisX);
  const vec3 notY = settle3(zero - s.axisY);
  const vec3 notZ = settle3(zero - s.axisZ);
  const vec3 halfSize = vec3(multiply(s.size.x, 0.5f), multiply(s.size.y, 0.5f), multiply(s.size.z, 0.5f));
  if (face == 0u) {
    r.axisY = notZ;
    r.axisZ = s.axisY;
    r.position = framePoint(s, vec3(0.0f, halfSize.y, 0.0f));
    r.size = vec3(s.size.x, s.size.z, 0.0f);
  } else if (face == 1u) {
    r.axisY = s.axisZ;
    r.axisZ = notY;
    r.position = framePoint(s, vec3(0.0f, -halfSize.y, 0.0f));
    r.size = vec3(s.size.x, s.size.z, 0.0f);
  } else if (face == 2u) {
    r.axisX = notX;
    r.axisZ = notZ;
    r.position = framePoint(s, vec3(0.0f, 0.0f, -halfSize.z));
    r.size = vec3(s.size.x, s.size.y, 0.0f);
  } else if (face == 3u) {
    r.position = framePoint(s, vec3(0.0f, 0.0f, halfSize.z));
    r.size = vec3(s.size.x, s.size.y, 0.0f);
  } else if (face == 4u) {
    r.axisX = s.axisZ;
    r.axisZ = notX;
    r.position = framePoint(s, vec3(-halfSize.x, 0.0f, 0.0f));
    r.size = vec3(s.size.z, s.size.y, 0.0f);
  } else {
    r.axisX = notZ;
    r.axisZ = s.axisX;
    r.position = framePoint(s, vec3(halfSize.x, 0.0f, 0.0f));
    r.size = vec3(s.size.z, s.size.y, 0.0f);
  }
  r.geometry = kShapeQuad | (kQuadPolygon << 8);
  return r;
}

/// A side of a prism whose polygon (x, y) lies at local (x, ., -y), counter-clockwise seen from above.
GPGP_FN Shape prismSide(GPGP_GRAPH Shape s, uint side) {
  const uint polygon = graphWords[kHeaderSections + 2u * kSectionPolygons + 1u] + shapePolygon(s) * kPolygonSize;
  const uint count = graphWords[polygon + 1u];
  const uint from = graphWords[polygon] + 2u * side;
  const uint to = graphWords[polygon] + 2u * (side + 1u == count ? 0u : side + 1u);
  const float ax = multiply(uintBitsToFloat(graphWords[from]), s.size.x);
  const float ay = multiply(uintBitsToFloat(graphWords[from + 1u]), s.size.z);
  const float bx = multiply(uintBitsToFloat(graphWords[to]), s.size.x);
  const float by = multiply(uintBitsToFloat(graphWords[to + 1u]), s.size.z);
  const float dx = subtract(bx, ax);
  const float dy = subtract(by, ay);
  const float length = squareRoot(add(multiply(dx, dx), multiply(dy, dy)));
  const float ux = length > 0.0f ? divide(dx, length) : 1.0f;
  const float uy = length > 0.0f ? divide(dy, length) : 0.0f;
  Shape r = s;
  r.axisX = frameDirection(s, vec3(ux, 0.0f, -uy));
  r.axisZ = frameDirection(s, vec3(uy, 0.0f, ux));
  r.position = framePoint(s, vec3(multiply(add(ax, bx), 0.5f), 0.0f, multiply(add(ay, by), -0.5f)));
  r.size = vec3(length, s.size.y, 0.0f);
  r.geometry = kShapeQuad | (kQuadPolygon << 8);
  return r;
}

/// Child number index of a shape that multiplies, index below ChainEnd::count.
GPGP_FN Shape childOf(GPGP_GRAPH Shape s, uint successors, uint index) {
  if (successors == 0u) return s;
  const uint op = graphWords[s.node + kNodeOperator];
  Shape r = s;
  uint successor = 0u;
  uint number = index; // in the path
  if (op == kOpSubDiv) {
    successor = selectBit(successors, index);
    number = successor;
    const uint axis = graphWords[s.node + kNodeArgument];
    const Division d = divisionOf(GPGP_G s);
    float fixedBefore = 0.0f;
    float weightBefore = 0.0f;
    float own = 0.0f;
    for (uint i = 0u; i <= successor; ++i) {
      if (own > 0.0f)
        fixedBefore = add(fixedBefore, own);
      else
        weightBefore = subtract(weightBefore, own);
      own = parameter(GPGP_G s, i);
    }
    const float extent = own > 0.0f ? own : shareOf(d, -own);
    const float start = weightBefore > 0.0f ? add(fixedBefore, shareOf(d, weightBefore)) : fixedBefore;
    const float centre = subtract(add(start, multiply(extent, 0.5f)), multiply(component(s.size, axis), 0.5f));
    r.position = framePoint(s, withComponent(vec3(0.0f), axis, centre));
    r.size = withComponent(s.size, axis, extent);
    r.seed = childSeed(s.seed, number);
  } else if (op == kOpRepeat) {
    const uint axis = graphWords[s.node + kNodeArgument];
    const uint mode = graphWords[s.node + kNodeArgument2];
    const float size = component(s.size, axis);
    const Repetition repetition = repetitionOf(GPGP_G s);
    const float last = subtract(size, multiply(float(repetition.count - 1u), repetition.extent));
    float extent = repetition.extent;
    float start = multiply(float(index), extent);
    if (mode == kRepeatAnchorToStart && index + 1u == repetition.count) extent = last;
    if (mode == kRepeatAnchorToEnd) {
      extent = index == 0u ? last : repetition.extent;
      start = index == 0u ? 0.0f : add(last, multiply(float(index - 1u), repetition.extent));
    }
    const float centre = subtract(add(start, multiply(extent, 0.5f)), multiply(size, 0.5f));
    r.position = framePoint(s, withComponent(vec3(0.0f), axis, centre));
    r.size = withComponent(s.size, axis, extent);
    r.seed = childSeed(s.seed, number);
  } else if (op == kOpCompSplit) {
    const uint ends = successors & 3u;
    const uint endCount = (ends & 1u) + (ends >> 1);
    number = index < endCount ? (ends == 2u ? 1u : index) : 2u + index - endCount; // top 0, bottom 1, sides from 2
    successor = min(number, 2u);
    if (isPrism(shapeType(s))) { // a polygon's only face is itself
      if (number < 2u || shapeType(s) == kShapeBox) {
        r = boxFace(s, number);
        // seen from below, the polygon is its mirror image, which is the other one of its pair
        if (number < 2u) r.geometry = polygonOf(shapeType(s)) | ((shapePolygon(s) ^ number) << 8);
      } else {
        r = prismSide(GPGP_G s, number - 2u);
      }
    }
    r.seed = childSeed(s.seed, number);
  } else { // kOpReplicate: copies with the seed unchanged
    successor = selectBit(successors, index);
    number = successor;
  }
  r.key = childKey(s.key, number);
  r.node = edgeTarget(GPGP_G s.node, successor);
  return r;
}

/// How many shapes an operator makes of one, and by which successors.
GPGP_FN ChainEnd fanOf(GPGP_GRAPH Shape s, uint op) {
  ChainEnd end;
  end.kind = kEndFan;
  if (op == kOpSubDiv) {
    end.successors = divisionOf(GPGP_G s).live;
    end.count = uint(bitCount(end.successors));
  } else if (op == kOpRepeat) {
    end.successors = edgeTarget(GPGP_G s.node, 0u) != 0u ? 1u : 0u;
    end.count = end.successors != 0u ? repetitionOf(GPGP_G s).count : 0u;
  } else if (op == kOpCompSplit) {
    const bool prism = isPrism(shapeType(s));
    const uint sides = edgeTarget(GPGP_G s.node, 2u) != 0u ? sideCount(GPGP_G s.geometry) : 0u;
    const uint top = edgeTarget(GPGP_G s.node, 0u) != 0u && shapeType(s) != kShapeSphere ? 1u : 0u;
    const uint bottom = edgeTarget(GPGP_G s.node, 1u) != 0u && prism ? 1u : 0u;
    end.successors = top | (bottom << 1) | (sides > 0u ? 4u : 0u);
    end.count = top + bottom + sides;
  } else {
    end.successors = 0u;
    const uint count = graphWords[s.node + kNodeEdgeCount];
    for (uint i = 0u; i < count; ++i)
      if (edgeTarget(GPGP_G s.node, i) != 0u) end.successors |= 1u << i;
    end.count = uint(bitCount(end.successors));
  }
  return end;
}

/// Takes a shape from operator to operator while each passes on one shape.
GPGP_FN ChainEnd runChain(GPGP_GRAPH GPGP_INOUT(Shape) s) {
  ChainEnd end;
  end.count = 0u;
  end.successors = 0u;
  for (uint step = 0u; step < kMaxChain; ++step) {
    if (s.node == 0u) {
      end.kind = kEndDiscarded;
      return end;
    }
    const uint op = graphWords[s.node + kNodeOperator];
    if (op == kOpTerminal) {
      end.kind = kEndTerminal;
      return end;
    }
    if (op <= kOpSetGeometry) {
      const Shape next = transformed(GPGP_G s, op);
      const uint node = edgeTarget(GPGP_G s.node, 0u);
      s = next;
      s.node = node;
    } else if (op <= kOpRandomRule) {
      s.node = edgeTarget(GPGP_G s.node, chooseEdge(GPGP_G s, op));
    } else {
      end = fanOf(GPGP_G s, op);
      if (end.count == 0u) {
        end.kind = kEndDiscarded;
        return end;
      }
      if (end.count > 1u) return end;
      const Shape child = childOf(GPGP_G s, end.successors, 0u); // a single child stays with this invocation
      s = child;
    }
  }
  end.kind = kEndFan;
  end.count = 1u;
  end.successors = 0u;
  return end;
}

GPGP_SHADER_END
#endif
