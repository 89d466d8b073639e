// A shape on its way through the operator graph, and how it lies in a queue.
//
// Frames are relative to the axiom: a derivation does not depend on where in the world it happens, and keeps its
// precision far from the origin. The axiom's transform is applied when an instance is written.
#ifndef GPGP_SHADERS_SPAWN_SHAPE_H
#define GPGP_SHADERS_SPAWN_SHAPE_H
#include "core/math.h"
#include "core/random.h"
#include "spawn/shared/graph_format.h"

#ifdef GPGP_SOFTWARE
uint operatorsPassed; // by the invocation, where the device counts turns of loops (src/spawn/schedule/turns.h)
#endif

GPGP_SHADER_BEGIN

struct Shape {
  vec3 axisX; // of the local frame, unit length
  vec3 axisY;
  vec3 axisZ;
  vec3 position; // of the centre
  vec3 size;     // extents; 0 where a polygon has none
  float custom;  // attribute; GLSL reserves that word
  uint geometry; // GpgpShape, and its polygon << 8
  uint seed;
  uvec2 key;  // of the path, where numbers were drawn on it included; instances have instanceKey() of it
  uint axiom; // index
  uint node;  // the operator it waits for, a word offset; 0: discarded
  uint depth; // recursive edges on its path
  uint made;  // where it waits for an operator that multiplies: children that exist already
};

GPGP_CONST uint kShapePlanes = 6u; // uvec4 each

GPGP_FN uvec4 packPlane(vec3 v, uint last) {
  return uvec4(floatBitsToUint(v.x), floatBitsToUint(v.y), floatBitsToUint(v.z), last);
}
GPGP_FN vec3 unpackVector(uvec4 p) { return vec3(uintBitsToFloat(p.x), uintBitsToFloat(p.y), uintBitsToFloat(p.z)); }
/// One sixth of a shape.
GPGP_FN uvec4 packShape(Shape s, uint plane) {
  if (plane == 0u) return packPlane(s.axisX, s.geometry);
  if (plane == 1u) return packPlane(s.axisY, s.seed);
  if (plane == 2u) return packPlane(s.axisZ, floatBitsToUint(s.custom));
  if (plane == 3u) return packPlane(s.position, s.axiom);
  if (plane == 4u) return packPlane(s.size, s.node);
  return uvec4(s.key.x, s.key.y, s.depth, s.made);
}
GPGP_FN Shape unpackShape(uvec4 p0, uvec4 p1, uvec4 p2, uvec4 p3, uvec4 p4, uvec4 p5) {
  Shape s;
  s.axisX = unpackVector(p0);
  s.axisY = unpackVector(p1);
  s.axisZ = unpackVector(p2);
  s.position = unpackVector(p3);
  s.size = unpackVector(p4);
  s.custom = uintBitsToFloat(p2.w);
  s.geometry = p0.w;
  s.seed = p1.w;
  s.key = uvec2(p5.x, p5.y);
  s.axiom = p3.w;
  s.node = p4.w;
  s.depth = p5.z;
  s.made = p5.w;
  return s;
}

GPGP_FN uint shapeType(Shape s) { return s.geometry & 0xffu; }
GPGP_FN uint shapePolygon(Shape s) { return s.geometry >> 8; }

/// The words of a start, which is a rule or an axiom; 0 where there is none. Of both the second word is the node.
GPGP_FN uint startWords(GPGP_GRAPH uint start) {
  const uint rules = graphWords[kHeaderSections + 2u * kSectionRules];
  const uint axioms = graphWords[kHeaderSections + 2u * kSectionAxioms + 1u];
  if (start == kDefaultRule) return axioms;
  if (start < rules) return graphWords[kHeaderSections + 2u * kSectionRules + 1u] + start * kRuleSize;
  return start - rules < graphWords[kHeaderSections + 2u * kSectionAxioms] ? axioms + (start - rules) * kAxiomSize : 0u;
}
/// The shape that it starts with, and its polygon << 8.
GPGP_FN uint startGeometry(GPGP_GRAPH uint start, uint words) {
  const bool isRule = start < graphWords[kHeaderSections + 2u * kSectionRules];
  return graphWords[(isRule ? graphWords[words + 2u] : words) + 2u];
}

/// The start of a derivation, from a GpgpAxiom's fields. node 0 where its rule does not exist.
GPGP_FN Shape axiomShape(GPGP_GRAPH vec3 size, uint seed, uint rule, float custom, uint index) {
  Shape s;
  s.axisX = vec3(1.0f, 0.0f, 0.0f);
  s.axisY = vec3(0.0f, 1.0f, 0.0f);
  s.axisZ = vec3(0.0f, 0.0f, 1.0f);
  s.position = vec3(0.0f);
  s.size = settle3(size);
  s.seed = childSeed(seed, 0u); // engines may count seeds up: 1, 2, 3 must not look alike
  s.custom = isNan(custom) ? unitFloat(s.seed) : settle(custom);
  const uint words = startWords(GPGP_G rule);
  s.geometry = words != 0u ? startGeometry(GPGP_G rule, words) : 0u;
  if (isFlat(shapeType(s))) s.size.z = 0.0f;
  s.key = childKey(uvec2(seed, 0u), 0u); // without the id: axioms that share a seed draw the same numbers
  s.axiom = index;
  s.depth = 0u;
  s.made = 0u;
  s.node = words != 0u ? graphWords[words + 1u] : 0u;
  return s;
}

// Axes have unit length but for rounding, so nothing below overflows to infinity. Terms that are zero may be left out
// and factors of one as well: the settled result is the same.

/// A point of the local frame.
GPGP_FN vec3 framePoint(Shape s, vec3 local) {
  GPGP_PRECISE lanes3 p =
      lanes3(s.position) + lanes3(s.axisX) * local.x + lanes3(s.axisY) * local.y + lanes3(s.axisZ) * local.z;
  return settleFinite3(p);
}
/// A point on one of the local axes.
GPGP_FN vec3 axisPoint(Shape s, uint axis, float distance) {
  const vec3 x = s.axisX, y = s.axisY, z = s.axisZ, other = axis == 1u ? y : z, direction = axis == 0u ? x : other;
  GPGP_PRECISE lanes3 p = lanes3(s.position) + lanes3(direction) * distance;
  return settleFinite3(p);
}
/// A direction of the local frame.
GPGP_FN vec3 frameDirection(Shape s, vec3 local) {
  GPGP_PRECISE lanes3 d = lanes3(s.axisX) * local.x + lanes3(s.axisY) * local.y + lanes3(s.axisZ) * local.z;
  return settleFinite3(d);
}
GPGP_FN vec3 opposite(vec3 v) { return settleFinite3(vec3(0.0f) - v); }

/// One of the three rows of unit shape to world, for row vectors of the axiom's transform.
GPGP_FN vec4 instanceRow(Shape s, vec4 axiomRow) {
  // A polygon without thickness keeps a unit normal, so that the matrix stays invertible.
  const float thickness = isFlat(shapeType(s)) && s.size.z == 0.0f ? 1.0f : s.size.z;
  GPGP_PRECISE lanes4 row = lanes4(s.axisX.x, s.axisY.x, s.axisZ.x, s.position.x) * axiomRow.x +
                            lanes4(s.axisX.y, s.axisY.y, s.axisZ.y, s.position.y) * axiomRow.y +
                            lanes4(s.axisX.z, s.axisY.z, s.axisZ.z, s.position.z) * axiomRow.z;
  row = row * lanes4(s.size.x, s.size.y, thickness, 1.0f) + lanes4(-0.0f, -0.0f, -0.0f, axiomRow.w);
  return row;
}

/// The path key that an instance has: of two axioms with the same seed, but not the same id, no two are equal.
GPGP_FN uvec2 instanceKey(uvec2 key, uint id) { return uvec2(key.x ^ mixBits(key.y + id * 0x9e3779b1u), key.y); }

/// A terminal shape's contribution to the order-free hash of a derivation. key: its instance's; terminal: its number,
/// as rules name it; rule: whose body it ended. Up to 8192 terminals, no two pairs of them are one number.
GPGP_FN uvec2 terminalHash(uvec2 key, uint terminal, uint rule, uint shape) {
  return childKey(key, (rule * 8192u + terminal) * 32u + shape);
}

GPGP_SHADER_END
#endif
