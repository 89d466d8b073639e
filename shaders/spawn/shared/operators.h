// The operators as functions of a shape, which they change in place, and the values of their parameters.
//
// One definition for all that derives: the interpreter (interpret.h), generated code, and the CPU evaluator. Everything
// that decides a count, a size or a position is settled arithmetic, so that all of them agree to the last bit.
#ifndef GPGP_SHADERS_SPAWN_OPERATORS_H
#define GPGP_SHADERS_SPAWN_OPERATORS_H
#include "spawn/shared/expression.h"
#include "spawn/shared/roofs.h"

// Which operators that multiply there are: bits by kOp values, and kHas bits, below. Generated kernels say what their
// graph has; what it has not is left out.
#ifndef GPGP_OPERATORS
#define GPGP_OPERATORS 0xffffffffu
#endif

GPGP_SHADER_BEGIN

// ---------------------------------------------------------------- one shape to one shape

/// Absolute, or a factor where negative.
GPGP_FN float scaled(float size, float v) { return v < 0.0f ? multiply(size, -v) : v; }

GPGP_FN void translate(GPGP_INOUT(Shape) s, vec3 v) { s.position = framePoint(s, v); }

/// The columns of Rz * Ry * Rx.
struct Rotation {
  vec3 c0, c1, c2;
};
/// Of (sine, cosine) of the three angles.
GPGP_FN Rotation rotationOfAngles(vec2 x, vec2 y, vec2 z) {
  const float sxsy = multiply(x.x, y.x);
  const float cxsy = multiply(x.y, y.x);
  Rotation r;
  r.c0 = vec3(multiply(z.y, y.y), multiply(z.x, y.y), -y.x);
  r.c1 = vec3(subtract(multiply(z.y, sxsy), multiply(z.x, x.y)), add(multiply(z.x, sxsy), multiply(z.y, x.y)),
              multiply(y.y, x.x));
  r.c2 = vec3(add(multiply(z.y, cxsy), multiply(z.x, x.x)), subtract(multiply(z.x, cxsy), multiply(z.y, x.x)),
              multiply(y.y, x.y));
  return r;
}
GPGP_FN Rotation rotationOf(vec3 degrees) {
  // Most angles are zero, and a loop is one copy of the polynomials.
  vec3 sines = vec3(0.0f);
  vec3 cosines = vec3(1.0f);
  for (uint i = 0u; i < 3u; ++i) {
    const float angle = component(degrees, i);
    if (angle == 0.0f) continue;
    const vec2 both = sineCosineDegrees(angle);
    sines = withComponent(sines, i, both.x);
    cosines = withComponent(cosines, i, both.y);
  }
  return rotationOfAngles(vec2(sines.x, cosines.x), vec2(sines.y, cosines.y), vec2(sines.z, cosines.z));
}
/// From the right.
GPGP_FN void rotate(GPGP_INOUT(Shape) s, Rotation rotation) {
  const vec3 axisX = frameDirection(s, rotation.c0);
  const vec3 axisY = frameDirection(s, rotation.c1);
  s.axisZ = frameDirection(s, rotation.c2);
  s.axisX = axisX;
  s.axisY = axisY;
}

GPGP_FN void resize(GPGP_INOUT(Shape) s, vec3 v) {
  s.size = vec3(scaled(s.size.x, v.x), scaled(s.size.y, v.y), scaled(s.size.z, v.z));
}

/// A polygon becomes a prism, Y along its normal; solids stay as they are.
GPGP_FN void extrude(GPGP_INOUT(Shape) s, float height) {
  if (!isPolygon(shapeType(s))) return;
  const vec3 axisZ = opposite(s.axisY);
  s.axisY = s.axisZ;
  s.axisZ = axisZ;
  s.size = vec3(s.size.x, scaled(s.size.z, height), s.size.y);
  s.geometry = prismOf(shapeType(s)) | (s.geometry & 0xffffff00u);
  s.seed = childSeed(s.seed, 0u);
}

GPGP_FN void swapSizes(GPGP_INOUT(Shape) s, uint axes) {
  s.size = vec3(component(s.size, axes & 3u), component(s.size, (axes >> 2) & 3u), component(s.size, axes >> 4));
}

// What CGA's operations do, whose scopes have their origin in a corner, the one of least coordinates.

/// Sets sizes, and the corner stays. Negative sizes reach to the other side of it.
GPGP_FN void resizeAtCorner(GPGP_INOUT(Shape) s, vec3 v) {
  const vec3 move = vec3(multiply(subtract(v.x, s.size.x), 0.5f), multiply(subtract(v.y, s.size.y), 0.5f),
                         multiply(subtract(v.z, s.size.z), 0.5f));
  s.position = framePoint(s, move);
  s.size = abs(v);
}
/// Sets one size, and the corner stays; the shape is a box then.
GPGP_FN void grow(GPGP_INOUT(Shape) s, uint axis, float v) {
  s.position = axisPoint(s, axis, multiply(subtract(v, component(s.size, axis)), 0.5f));
  s.size = withComponent(s.size, axis, v);
  s.geometry = kShapeBox | (kQuadPolygon << 8);
}
/// About the corner, by Rx Ry Rz: first about z.
GPGP_FN void turnAtCorner(GPGP_INOUT(Shape) s, vec3 degrees) {
  const vec3 middle = vec3(multiply(s.size.x, 0.5f), multiply(s.size.y, 0.5f), multiply(s.size.z, 0.5f));
  s.position = framePoint(s, vec3(-middle.x, -middle.y, -middle.z));
  // The inverse of Rz Ry Rx by the opposite angles, whose rows are the columns.
  const Rotation r = rotationOf(vec3(-degrees.x, -degrees.y, -degrees.z));
  Rotation inverse;
  inverse.c0 = vec3(r.c0.x, r.c1.x, r.c2.x);
  inverse.c1 = vec3(r.c0.y, r.c1.y, r.c2.y);
  inverse.c2 = vec3(r.c0.z, r.c1.z, r.c2.z);
  rotate(s, inverse);
  s.position = framePoint(s, middle);
}
GPGP_FN void setCustom(GPGP_INOUT(Shape) s, float v) { s.custom = v; }

GPGP_FN void setGeometry(GPGP_INOUT(Shape) s, uint shape, uint polygon) { s.geometry = shape | (polygon << 8); }

/// Takes an edge: target is its word in the graph.
GPGP_FN void follow(GPGP_INOUT(Shape) s, uint target) {
  s.node = target & ~kEdgeRecursive;
  s.depth += target >> 31;
}

// ---------------------------------------------------------------- one shape to many: to one of them

/// A piece along an axis, from start on; number is its place in the path.
GPGP_FN void toPiece(GPGP_INOUT(Shape) s, uint axis, float start, float extent, uint number) {
  const float centre = subtract(add(start, multiply(extent, 0.5f)), multiply(component(s.size, axis), 0.5f));
  s.position = axisPoint(s, axis, centre);
  s.size = withComponent(s.size, axis, extent);
  s.seed = childSeed(s.seed, number);
  s.key = childKey(s.key, number);
}

/// What weights share in SubDiv. A millionth of the whole is taken for rounding.
GPGP_FN float remainderOf(float size, float fixedLength) {
  const float rest = subtract(size, fixedLength);
  return rest > multiply(size, 1.0e-6f) ? rest : 0.0f;
}
/// A part of SubDiv: one of fixed and share is zero. What comes before it, likewise.
struct Part {
  float fixedLength;
  float share;
  float fixedBefore;
  float shareBefore;
};
/// False where nothing of the part is within the shape: fixed lengths are cut off where the shape ends. A part in ten
/// thousand of a length is taken for rounding.
GPGP_FN bool toPart(GPGP_INOUT(Shape) s, uint axis, float remainder, Part part, uint number) {
  const float start = add(part.fixedBefore, multiply(remainder, part.shareBefore));
  const float extent = add(part.fixedLength, multiply(remainder, part.share));
  const float room = subtract(component(s.size, axis), start);
  const bool allFit = remainder > 0.0f;
  // Without a return before its end: compilers take long for chains of those.
  toPiece(s, axis, start, allFit ? extent : min(extent, room), number);
  return allFit || room > multiply(extent, 1.0e-4f);
}

/// What a shape multiplies into.
struct Fan {
  uint count;      // children
  uint successors; // bit i: successor i takes part; 0: the operator passes on one shape, and the only child is the
                   // shape itself, which has not passed it yet. Repeat: the children
  float extent; // SubDiv: what weights share; Repeat: the length of a copy; negative: the shape is dropped and counted
};

/// How many times Repeat's extent fits. A part in ten thousand of a copy is taken for rounding. Where it fits more than
/// kMaxRepeat times there is no copy: the shape is dropped, which whoever asks counts.
GPGP_FN Fan repetitionOf(float size, uint mode, float wanted) {
  Fan r;
  r.extent = wanted < 0.0f ? multiply(size, -wanted) : wanted;
  r.count = 0u;
  if (r.extent > 0.0f && size > 0.0f) {
    const float fits = divide(size, r.extent);
    if (fits > float(kMaxRepeat)) {
      r.extent = -1.0f;
    } else if (mode == kRepeatAdjustToFill) {
      r.count = uint(max(1.0f, floor(add(fits, 1.0e-4f))));
      r.extent = divide(size, float(r.count));
    } else {
      r.count = uint(max(1.0f, -floor(subtract(1.0e-4f, fits))));
    }
  }
  r.successors = r.count;
  return r;
}
GPGP_FN void toRepeat(GPGP_INOUT(Shape) s, uint axis, uint mode, uint count, float copyExtent, uint index) {
  const float last = subtract(component(s.size, axis), multiply(float(count - 1u), copyExtent));
  float extent = copyExtent;
  float start = multiply(float(index), extent);
  if (mode == kRepeatAnchorToStart && index + 1u == count) extent = last;
  if (mode == kRepeatAnchorToEnd) {
    extent = index == 0u ? last : copyExtent;
    start = index == 0u ? 0.0f : add(last, multiply(float(index - 1u), copyExtent));
  }
  toPiece(s, axis, start, extent, index);
}

/// Replicate: a copy with the seed unchanged.
GPGP_FN void toCopy(GPGP_INOUT(Shape) s, uint number) { s.key = childKey(s.key, number); }

GPGP_FN uint sideCount(GPGP_GRAPH uint geometry) {
  const uint shape = geometry & 0xffu;
  if (!isPrism(shape)) return 0u;
  if (shape == kShapeBox) return 4u;
  return graphWords[graphWords[kHeaderSections + 2u * kSectionPolygons + 1u] + (geometry >> 8) * kPolygonSize + 1u];
}

/// A face of a box: 0 top, 1 bottom, then back, front, left, right. X runs to the right and Z out of the face.
GPGP_FN void toBoxSide(GPGP_INOUT(Shape) s, uint face) {
  vec3 axisX = s.axisX;
  vec3 axisY = s.axisY;
  vec3 axisZ = s.axisZ;
  vec3 size = vec3(s.size.x, s.size.y, 0.0f);
  uint axis = 2u; // of the face's normal
  float side = face == 0u || face == 3u || face == 5u ? 0.5f : -0.5f;
  if (face < 2u) {
    axis = 1u;
    axisY = face == 0u ? opposite(s.axisZ) : s.axisZ;
    axisZ = face == 0u ? s.axisY : opposite(s.axisY);
    size.y = s.size.z;
  } else if (face == 2u) {
    axisX = opposite(s.axisX);
    axisZ = opposite(s.axisZ);
  } else if (face > 3u) {
    axis = 0u;
    axisX = face == 4u ? s.axisZ : opposite(s.axisZ);
    axisZ = face == 4u ? opposite(s.axisX) : s.axisX;
    size.x = s.size.z;
  }
  s.position = axisPoint(s, axis, multiply(component(s.size, axis), side));
  s.axisX = axisX;
  s.axisY = axisY;
  s.axisZ = axisZ;
  s.size = size;
  s.geometry = kShapeQuad | (kQuadPolygon << 8);
}

GPGP_FN void toSideOf(GPGP_INOUT(Shape) s, float face) { toBoxSide(s, uint(clamp(floor(face), 0.0f, 5.0f))); }

/// A side of a prism whose polygon (x, y) lies at local (x, ., -y), counter-clockwise seen from above.
GPGP_FN void toPrismSide(GPGP_GRAPH GPGP_INOUT(Shape) s, uint side) {
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
  s.position = framePoint(s, vec3(multiply(add(ax, bx), 0.5f), 0.0f, multiply(add(ay, by), -0.5f)));
  const vec3 axisX = frameDirection(s, vec3(ux, 0.0f, -uy));
  s.axisZ = frameDirection(s, vec3(uy, 0.0f, ux));
  s.axisX = axisX;
  s.size = vec3(length, s.size.y, 0.0f);
  s.geometry = kShapeQuad | (kQuadPolygon << 8);
}

/// CompSplit's successors that take part for a shape, of those in wanted (bits: top, bottom, sides), and its children.
struct Faces {
  uint successors;
  uint count;
};
GPGP_FN Faces facesOf(GPGP_GRAPH uint geometry, uint wanted) {
  const uint shape = geometry & 0xffu;
  const uint sides = (wanted & 4u) != 0u ? sideCount(GPGP_G geometry) : 0u;
  const uint top = wanted & (kFacedShapes >> shape) & 1u;
  const uint bottom = isPrism(shape) ? wanted & 2u : 0u;
  Faces f;
  f.successors = top | bottom | (sides > 0u ? 4u : 0u);
  f.count = top + (bottom >> 1) + sides;
  return f;
}
/// The number of a face from its place among the children: top 0, bottom 1, sides from 2.
GPGP_FN uint faceNumber(uint successors, uint index) {
  const uint ends = successors & 3u;
  const uint endCount = (ends & 1u) + (ends >> 1);
  return index < endCount ? (ends == 2u ? 1u : index) : 2u + index - endCount;
}
/// Any face of a box, the ends of any prism.
GPGP_FN void toBoxFace(GPGP_INOUT(Shape) s, uint number) {
  // seen from below, the polygon is its mirror image, which is the other one of its pair
  const uint end = polygonOf(shapeType(s)) | ((shapePolygon(s) ^ number) << 8);
  toBoxSide(s, number);
  if (number < 2u) s.geometry = end;
  s.seed = childSeed(s.seed, number);
  s.key = childKey(s.key, number);
}
GPGP_FN void toFace(GPGP_GRAPH GPGP_INOUT(Shape) s, uint number) {
  const bool prism = isPrism(shapeType(s));
  if (prism && (number < 2u || shapeType(s) == kShapeBox)) {
    toBoxFace(s, number);
    return;
  }
  if (prism) toPrismSide(GPGP_G s, number - 2u); // a polygon's only face is itself
  s.seed = childSeed(s.seed, number);
  s.key = childKey(s.key, number);
}

/// The place of the n-th set bit.
GPGP_FN uint selectBit(uint bits, uint n) {
  for (uint i = 0u; i < n; ++i) {
    bits &= bits - 1u;
  }
  return uint(findLSB(bits));
}

// Bits of GPGP_OPERATORS beside those of kOp values: cases of operators that cost much code.
GPGP_CONST uint kHasRoofs = 1u << 28;     // RaiseRoof, ToRoofFace
GPGP_CONST uint kHasCuts = 1u << 29;      // SubDiv of others than boxes, quads and spheres
GPGP_CONST uint kHasDivisions = 1u << 30; // SubDiv whose parts are not constant
GPGP_CONST uint kHasSides = 1u << 31;     // CompSplit of others than boxes

GPGP_FN void raiseRoof(GPGP_INOUT(Shape) s, vec3 v) {
  if ((GPGP_OPERATORS & kHasRoofs) != 0u) makeRoof(s, v);
}
GPGP_FN void toRoofFace(GPGP_INOUT(Shape) s, vec3 v) {
  if ((GPGP_OPERATORS & kHasRoofs) != 0u) makeRoofFace(s, v);
}
/// As GpgpInstance::shape: roofs and trapezoids with the bits that say their form.
GPGP_FN uint instanceShape(Shape s) {
  return (GPGP_OPERATORS & kHasRoofs) != 0u && shapeType(s) > kShapeSphere ? s.geometry : shapeType(s);
}

/// How a chain of operators that pass on one shape ended.
GPGP_CONST uint kEndDiscarded = 0u;
GPGP_CONST uint kEndTerminal = 1u;   // shape.node is the terminal's node
GPGP_CONST uint kEndWaits = 2u;      // the shape waits for shape.node
GPGP_CONST uint kEndUnfinished = 3u; // deeper than allowed
GPGP_CONST uint kEndContext = 4u;    // at a Collider or IfCollides, which needs more than the shape and the graph
GPGP_CONST uint kEndLater = 5u;      // at a Collider or IfCollides of a later phase
GPGP_CONST uint kEndGoesOn = 6u;     // it has not: another operator of the chain follows

GPGP_SHADER_END
#endif
