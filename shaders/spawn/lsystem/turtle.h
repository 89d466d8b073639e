// The turtle: what a command does to a frame, and what a frame draws.
//
// The turtle's axes are heading H, left L and up U, with U = H x L. It begins at the origin with H = +Y, L = -X and
// U = +Z. A move is a frame relative to the one before; moves are joined by a product, so that a string of them can be
// scanned. Width and colour are joined as x -> scale * x + offset. A frame from the root has scale 0.
#ifndef GPGP_SHADERS_SPAWN_LSYSTEM_TURTLE_H
#define GPGP_SHADERS_SPAWN_LSYSTEM_TURTLE_H
#include "spawn/lsystem/functions.h"
#include "spawn/lsystem/string.h"

GPGP_SHADER_BEGIN

struct LsysFrame {
  vec4 h, l, u; // axes, and in w: scale of width, offset of width, scale of colour
  vec4 p;       // place, and offset of colour
};

GPGP_FN LsysFrame lsysIdentity() {
  LsysFrame f;
  f.h = vec4(1.0f, 0.0f, 0.0f, 1.0f);
  f.l = vec4(0.0f, 1.0f, 0.0f, 0.0f);
  f.u = vec4(0.0f, 0.0f, 1.0f, 1.0f);
  f.p = vec4(0.0f);
  return f;
}

/// The turtle before the first command. In moves, components are along H, L and U.
GPGP_FN LsysFrame lsysStart(LSYS_STRING_ONLY) {
  LsysFrame f;
  f.h = vec4(0.0f, 1.0f, 0.0f, 0.0f);
  f.l = vec4(-1.0f, 0.0f, 0.0f, uintBitsToFloat(lsysWord(LSYS_S kLsysHeadWidth)));
  f.u = vec4(0.0f, 0.0f, 1.0f, 0.0f);
  f.p = vec4(0.0f);
  return f;
}

/// b seen from the frame a.
GPGP_FN vec4 lsysTurned(LsysFrame a, vec4 b, float w) {
  GPGP_PRECISE float x = a.h.x * b.x + a.l.x * b.y + a.u.x * b.z;
  GPGP_PRECISE float y = a.h.y * b.x + a.l.y * b.y + a.u.y * b.z;
  GPGP_PRECISE float z = a.h.z * b.x + a.l.z * b.y + a.u.z * b.z;
  return vec4(x, y, z, w);
}

/// First a, then b.
GPGP_FN LsysFrame lsysCompose(LsysFrame a, LsysFrame b) {
  LsysFrame f;
  f.h = lsysTurned(a, b.h, a.h.w * b.h.w);
  f.l = lsysTurned(a, b.l, b.h.w * a.l.w + b.l.w);
  f.u = lsysTurned(a, b.u, a.u.w * b.u.w);
  f.p = lsysTurned(a, b.p, b.u.w * a.p.w + b.p.w) + vec4(a.p.x, a.p.y, a.p.z, 0.0f);
  return f;
}

/// The first parameter of a module, or a default.
GPGP_FN float lsysArgument(LSYS_STRING uvec4 module, uint fallback) {
  const uint arity = lsysWord(LSYS_S lsysSymbolAt(LSYS_S module.x) + kSymbolArity);
  return arity != 0u ? lsysParameter(LSYS_S module.y) : uintBitsToFloat(lsysWord(LSYS_S fallback));
}

/// The move of a command; those that depend on the heading move nothing here.
GPGP_FN LsysFrame lsysMove(LSYS_STRING uvec4 module, uint turtle) {
  LsysFrame f = lsysIdentity();
  if (turtle >= kTurtleDraw && turtle <= kTurtleMoveOnly) {
    f.p.x = lsysArgument(LSYS_S module, kLsysHeadStep);
  } else if (turtle >= kTurtleLeft && turtle <= kTurtleAround) {
    const vec2 sc = sineCosineDegrees(turtle == kTurtleAround ? 180.0f : lsysArgument(LSYS_S module, kLsysHeadAngle));
    const float c = sc.y;
    const bool opposite = turtle == kTurtleRight || turtle == kTurtleUp || turtle == kTurtleRollRight;
    const float s = opposite ? -sc.x : sc.x;
    if (turtle == kTurtleDown || turtle == kTurtleUp) {
      f.h = vec4(c, 0.0f, -s, 1.0f);
      f.u = vec4(s, 0.0f, c, 1.0f);
    } else if (turtle == kTurtleRollLeft || turtle == kTurtleRollRight) {
      f.l = vec4(0.0f, c, -s, 0.0f);
      f.u = vec4(0.0f, s, c, 1.0f);
    } else {
      f.h = vec4(c, s, 0.0f, 1.0f);
      f.l = vec4(-s, c, 0.0f, 0.0f);
    }
  } else if (turtle == kTurtleWidth) {
    const uint arity = lsysWord(LSYS_S lsysSymbolAt(LSYS_S module.x) + kSymbolArity);
    f.h.w = arity != 0u ? 0.0f : uintBitsToFloat(lsysWord(LSYS_S kLsysHeadTaper));
    f.l.w = arity != 0u ? max(lsysParameter(LSYS_S module.y), 0.0f) : 0.0f;
  } else if (turtle == kTurtleColour) {
    const uint arity = lsysWord(LSYS_S lsysSymbolAt(LSYS_S module.x) + kSymbolArity);
    f.u.w = arity != 0u ? 0.0f : 1.0f;
    f.p.w = arity != 0u ? lsysParameter(LSYS_S module.y) : 1.0f;
  }
  return f;
}

GPGP_FN vec3 lsysCross(vec3 a, vec3 b) {
  return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/// $: rolls the frame so that L is level, that is, at right angles to +Y.
GPGP_FN LsysFrame lsysUpright(LsysFrame f) {
  const float length = squareRoot(add(multiply(f.h.x, f.h.x), multiply(f.h.z, f.h.z)));
  if (length < 1.0e-4f) return f; // H is upright itself
  const vec3 h = vec3(f.h.x, f.h.y, f.h.z);
  const vec3 l = vec3(divide(h.z, length), 0.0f, divide(-h.x, length)); // Y x H
  const vec3 u = lsysCross(h, l);
  f.l = vec4(l.x, l.y, l.z, f.l.w);
  f.u = vec4(u.x, u.y, u.z, f.u.w);
  return f;
}

/// Turns the frame towards a direction of unit length by elasticity * |H x direction| radians.
GPGP_FN LsysFrame lsysBend(LsysFrame f, vec3 direction, float elasticity) {
  const vec3 axis = lsysCross(vec3(f.h.x, f.h.y, f.h.z), direction);
  const float sine = squareRoot(dot3(axis, axis));
  if (sine < 1.0e-6f || elasticity == 0.0f) return f;
  const vec2 sc = sineCosine(multiply(elasticity, sine));
  const vec3 k = vec3(divide(axis.x, sine), divide(axis.y, sine), divide(axis.z, sine));
  for (uint i = 0u; i < 3u; ++i) { // Rodrigues
    const vec4 v = i == 0u ? f.h : (i == 1u ? f.l : f.u);
    const vec3 a = vec3(v.x, v.y, v.z);
    const vec3 turned = a * sc.y + lsysCross(k, a) * sc.x + k * (dot3(k, a) * (1.0f - sc.y));
    const vec4 w = vec4(turned.x, turned.y, turned.z, v.w);
    if (i == 0u) f.h = w;
    if (i == 1u) f.l = w;
    if (i == 2u) f.u = w;
  }
  return f;
}

/// A frame from the root behind one more command. elasticity is that of tropism.
GPGP_FN LsysFrame lsysWalk(LSYS_STRING LsysFrame f, uvec4 module, uint turtle, GPGP_INOUT(float) elasticity) {
  if (turtle == kTurtleUpright) return lsysUpright(f);
  if (turtle == kTurtleTropism) {
    elasticity = lsysArgument(LSYS_S module, kLsysHeadTropism + 3u);
    return f;
  }
  f = lsysCompose(f, lsysMove(LSYS_S module, turtle));
  if (turtle >= kTurtleDraw && turtle <= kTurtleMoveOnly && elasticity != 0.0f) {
    const vec3 direction = vec3(uintBitsToFloat(lsysWord(LSYS_S kLsysHeadTropism)),
                                uintBitsToFloat(lsysWord(LSYS_S kLsysHeadTropism + 1u)),
                                uintBitsToFloat(lsysWord(LSYS_S kLsysHeadTropism + 2u)));
    f = lsysBend(f, direction, elasticity);
  }
  return f;
}

/// Extents across and along H of what a module draws, and whether it stands on the turtle's place (1) or its middle is
/// there (0).
GPGP_FN vec3 lsysExtents(LSYS_STRING LsysFrame f, uvec4 module, uint turtle) {
  if (turtle == kTurtlePolygon || turtle == kTurtleCylinder) return vec3(1.0f, 1.0f, 0.0f);
  const float length = lsysArgument(LSYS_S module, kLsysHeadStep);
  return vec3(turtle == kTurtleAsset ? length : f.l.w, length, 1.0f);
}

/// Row 0 to 2 of the transform from the unit shape of a module that draws. Its y axis is along H, its z axis along U.
GPGP_FN vec4 lsysUnitRow(LsysFrame f, uint row, vec3 extents) {
  const float h = row == 0u ? f.h.x : (row == 1u ? f.h.y : f.h.z);
  const float l = row == 0u ? f.l.x : (row == 1u ? f.l.y : f.l.z);
  const float u = row == 0u ? f.u.x : (row == 1u ? f.u.y : f.u.z);
  const float p = row == 0u ? f.p.x : (row == 1u ? f.p.y : f.p.z);
  return vec4(-l * extents.x, h * extents.y, u * extents.x, p + h * extents.y * extents.z * 0.5f);
}

/// A row of an axiom's transform applied to rows of another.
GPGP_FN vec4 lsysWorldRow(vec4 world, vec4 row0, vec4 row1, vec4 row2) {
  return row0 * world.x + row1 * world.y + row2 * world.z + vec4(0.0f, 0.0f, 0.0f, world.w);
}

/// Whether a module with this command draws an instance. In a polygon, F is an edge of it.
GPGP_FN bool lsysDraws(uint turtle, bool inPolygon) {
  return turtle == kTurtleDrawOnly || turtle == kTurtleAsset || turtle == kTurtlePolygon || turtle == kTurtleCylinder ||
         (turtle == kTurtleDraw && !inPolygon);
}
/// Whether it is a corner of the polygon around it.
GPGP_FN bool lsysIsCorner(uint turtle) {
  return turtle == kTurtleCorner || turtle == kTurtleDraw || turtle == kTurtleMove;
}
/// Whether it is a section of the cylinder of its branch: where that begins and ends, and in between.
GPGP_FN bool lsysIsSection(uint turtle) { return turtle >= kTurtleCylinder && turtle <= kTurtleCylinderEnd; }

/// The turtle's place behind a command that moves, as a corner is: of a frame before it.
GPGP_FN vec3 lsysCornerOf(LSYS_STRING LsysFrame f, uvec4 module, uint turtle) {
  const bool moves = turtle == kTurtleDraw || turtle == kTurtleMove;
  const float length = moves ? lsysArgument(LSYS_S module, kLsysHeadStep) : 0.0f;
  return vec3(f.p.x + f.h.x * length, f.p.y + f.h.y * length, f.p.z + f.h.z * length);
}

/// Seed of what a module draws.
GPGP_FN uint lsysSeed(uvec4 module) { return childSeed(module.z, module.w); }

GPGP_SHADER_END
#endif
