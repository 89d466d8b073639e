// Terminal shapes as triangles: what each GpgpShape looks like, and what a vertex of it holds.
//
// Every shape is made of quads, four vertices and the two triangles 0 1 2 and 0 2 3, each flat and with vertices of its
// own. So one number says how much room a shape takes among vertices and among indices, and indices are the same
// pattern whatever the shape. A convex polygon is a fan of (corners - 1) / 2 quads, the last triangle of an odd one
// without area, a concave one the quads that its grammar was compiled with; prisms have two such ends and a quad a
// side, roofs a quad a side and one below; a sphere is rings of quads. Triangles are counter-clockwise from outside.
#ifndef GPGP_SHADERS_SPAWN_MESH_H
#define GPGP_SHADERS_SPAWN_MESH_H
#include "core/math.h"
#include "spawn/shared/roof_shapes.h"

#ifdef __cplusplus
#include <glm/exponential.hpp>
#include <glm/packing.hpp>
namespace gpgp::shader {
using glm::inversesqrt;
using glm::packHalf2x16;
using glm::packSnorm4x8;
using glm::packUnorm4x8;
} // namespace gpgp::shader
#endif

GPGP_SHADER_BEGIN

GPGP_CONST uint kSphereRings = 8u;
GPGP_CONST uint kSphereSegments = 12u;

GPGP_FN uint polygonAt(GPGP_GRAPH uint geometry) {
  return graphWords[kHeaderSections + 2u * kSectionPolygons + 1u] + (geometry >> 8) * kPolygonSize;
}

GPGP_FN uint polygonQuads(GPGP_GRAPH uint polygon) {
  const uint quads = graphWords[polygon + 3u];
  return quads > 0u ? quads : (graphWords[polygon + 1u] - 1u) / 2u;
}

/// Quads of a shape. geometry: as Shape's.
GPGP_FN uint meshQuads(GPGP_GRAPH uint geometry) {
  const uint shape = geometry & 0xffu;
  if (shape == kShapeBox) return 6u;
  if (shape == kShapeQuad || shape == kShapeTrapezoid) return 1u;
  if (shape == kShapeRoof) return 5u;
  if (shape == kShapeSphere) return kSphereRings * kSphereSegments;
  const uint polygon = polygonAt(GPGP_G geometry);
  const uint quads = polygonQuads(GPGP_G polygon);
  return isPolygon(shape) ? quads : 2u * quads + graphWords[polygon + 1u];
}

/// A vertex of the unit shape; the cross product of along and up is the normal, of any length.
struct MeshVertex {
  vec3 position;
  vec3 along;
  vec3 up;
  vec2 uv; // of its face, right and up
};

/// A face of the unit box, in CompSplit's order: top, bottom, back, front, left, right; or the unit quad.
GPGP_FN MeshVertex rectangleVertex(bool box, uint face, uint corner) {
  const float a = corner == 1u || corner == 2u ? 0.5f : -0.5f;
  const float b = corner >= 2u ? 0.5f : -0.5f;
  const float side = (face & 1u) == 0u ? 1.0f : -1.0f; // of top, back, left
  MeshVertex v;
  v.uv = vec2(a + 0.5f, b + 0.5f);
  v.up = vec3(0.0f, 1.0f, 0.0f);
  if (!box) {
    v.position = vec3(a, b, 0.0f);
    v.along = vec3(1.0f, 0.0f, 0.0f);
  } else if (face < 2u) {
    v.position = vec3(a, 0.5f * side, -side * b);
    v.along = vec3(1.0f, 0.0f, 0.0f);
    v.up = vec3(0.0f, 0.0f, -side);
  } else if (face < 4u) {
    v.position = vec3(-side * a, b, -0.5f * side);
    v.along = vec3(-side, 0.0f, 0.0f);
  } else {
    v.position = vec3(-0.5f * side, b, side * a);
    v.along = vec3(0.0f, 0.0f, side);
  }
  return v;
}

GPGP_FN vec2 polygonCorner(GPGP_GRAPH uint polygon, uint corner) {
  const uint at = graphWords[polygon] + 2u * corner;
  return vec2(uintBitsToFloat(graphWords[at]), uintBitsToFloat(graphWords[at + 1u]));
}
/// Which of a polygon's corners a quad's is.
GPGP_FN uint quadCorner(GPGP_GRAPH uint polygon, uint quad, uint corner) {
  if (graphWords[polygon + 3u] > 0u)
    return (graphWords[graphWords[polygon + 2u] + kQuadSize * quad + (corner >> 1)] >> (16u * (corner & 1u))) & 0xffffu;
  return corner == 0u ? 0u : min(2u * quad + corner, graphWords[polygon + 1u] - 1u);
}
/// A quad's corners the other way round.
GPGP_FN uint mirroredCorner(uint corner) { return (4u - corner) & 3u; }

/// A corner of a quad, of shapes other than boxes and quads, with its uv.
struct MeshPoint {
  vec3 position;
  vec2 uv;
};
GPGP_FN MeshPoint meshPoint(GPGP_GRAPH uint geometry, uint quad, uint corner) {
  const uint shape = geometry & 0xffu;
  MeshPoint p;
  if (shape == kShapeSphere) {
    const uint ring = quad / kSphereSegments + (corner < 2u ? 1u : 0u);
    const uint segment = quad % kSphereSegments + (corner == 1u || corner == 2u ? 1u : 0u);
    const vec2 polar = sineCosineDegrees(float(ring) * (180.0f / float(kSphereRings)));
    const vec2 around = sineCosineDegrees(float(segment) * (360.0f / float(kSphereSegments)));
    p.position = vec3(0.5f * polar.x * around.y, 0.5f * polar.y, -0.5f * polar.x * around.x);
    p.uv = vec2(float(segment) / float(kSphereSegments), 1.0f - float(ring) / float(kSphereRings));
    return p;
  }
  if (shape == kShapeTrapezoid || shape == kShapeRoof) {
    const Ridge ridge = ridgeOf(geometry);
    const bool isPlane = shape == kShapeTrapezoid;
    const vec3 edge = isPlane ? vec3(ridge.place, ridge.halfLength, 0.0f) : roofEdge(ridge, quad);
    const vec3 c = trapezoidCorner(edge, corner);
    p.position = isPlane ? vec3(c.x, c.y, 0.0f) : roofPoint(quad, c.x, c.y, c.z);
    p.uv = vec2(c.x + 0.5f, c.y + 0.5f);
    if (!isPlane && quad == 4u) {
      const MeshVertex v = rectangleVertex(true, 1u, corner);
      p.position = v.position;
      p.uv = v.uv;
    }
    return p;
  }
  const uint polygon = polygonAt(GPGP_G geometry);
  const uint corners = graphWords[polygon + 1u];
  const uint quads = polygonQuads(GPGP_G polygon);
  if (isPolygon(shape)) {
    const vec2 c = polygonCorner(GPGP_G polygon, quadCorner(GPGP_G polygon, quad, corner));
    p.position = vec3(c.x, c.y, 0.0f);
    p.uv = vec2(c.x + 0.5f, c.y + 0.5f);
    return p;
  }
  // A prism: its polygon's (x, y) is (x, -z), Y runs from the lower end to the upper one.
  if (quad < quads) {
    const vec2 c = polygonCorner(GPGP_G polygon, quadCorner(GPGP_G polygon, quad, corner));
    p.position = vec3(c.x, 0.5f, -c.y);
    p.uv = vec2(c.x + 0.5f, c.y + 0.5f);
  } else if (quad < 2u * quads) { // from below: the other way round
    const vec2 c = polygonCorner(GPGP_G polygon, quadCorner(GPGP_G polygon, quad - quads, mirroredCorner(corner)));
    p.position = vec3(c.x, -0.5f, -c.y);
    p.uv = vec2(c.x + 0.5f, 0.5f - c.y);
  } else {
    const uint from = quad - 2u * quads;
    const bool second = corner == 1u || corner == 2u;
    const vec2 c = polygonCorner(GPGP_G polygon, second ? (from + 1u == corners ? 0u : from + 1u) : from);
    p.position = vec3(c.x, corner >= 2u ? 0.5f : -0.5f, -c.y);
    p.uv = vec2(second ? 1.0f : 0.0f, corner >= 2u ? 1.0f : 0.0f);
  }
  return p;
}

/// A vertex of the unit shape: quad below meshQuads, corner below 4.
GPGP_FN MeshVertex meshVertex(GPGP_GRAPH uint geometry, uint quad, uint corner) {
  const uint shape = geometry & 0xffu;
  if (shape == kShapeBox || shape == kShapeQuad) return rectangleVertex(shape == kShapeBox, quad, corner);
  const MeshPoint p = meshPoint(GPGP_G geometry, quad, corner);
  MeshVertex v;
  v.position = p.position;
  v.uv = p.uv;
  v.along = meshPoint(GPGP_G geometry, quad, 2u).position - meshPoint(GPGP_G geometry, quad, 0u).position;
  v.up = meshPoint(GPGP_G geometry, quad, 3u).position - meshPoint(GPGP_G geometry, quad, 1u).position;
  return v;
}

// ---------------------------------------------------------------- in the world

// Where an axiom mirrors, mirroredCorner takes a quad's corners, so that triangles still face outwards.

GPGP_FN float rowDot(vec4 row, vec3 v) {
  GPGP_PRECISE float sum = row.x * v.x + row.y * v.y + row.z * v.z;
  return sum;
}
GPGP_FN vec3 crossOf(vec3 a, vec3 b) {
  GPGP_PRECISE vec3 c = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return c;
}
/// Whether unit shape to world turns right into left.
GPGP_FN bool isMirrored(vec4 row0, vec4 row1, vec4 row2) {
  const vec3 c = crossOf(vec3(row0.x, row0.y, row0.z), vec3(row1.x, row1.y, row1.z));
  return rowDot(row2, c) < 0.0f;
}
GPGP_FN vec3 meshPosition(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
  GPGP_PRECISE vec3 world = vec3(rowDot(row0, p) + row0.w, rowDot(row1, p) + row1.w, rowDot(row2, p) + row2.w);
  return world;
}
/// Unit length; zero where the face has no area.
GPGP_FN vec3 meshNormal(vec4 row0, vec4 row1, vec4 row2, MeshVertex v, bool mirrored) {
  const vec3 along = vec3(rowDot(row0, v.along), rowDot(row1, v.along), rowDot(row2, v.along));
  const vec3 up = vec3(rowDot(row0, v.up), rowDot(row1, v.up), rowDot(row2, v.up));
  const vec3 n = crossOf(along, up);
  const float squared = rowDot(vec4(n.x, n.y, n.z, 0.0f), n);
  if (!(squared > 0.0f)) return vec3(0.0f);
  const float scale = mirrored ? -inversesqrt(squared) : inversesqrt(squared);
  return vec3(n.x * scale, n.y * scale, n.z * scale);
}

// ---------------------------------------------------------------- as the engine wants it

// Semantics, as GpgpVertexSemantic.
GPGP_CONST uint kVertexPosition = 0u;
GPGP_CONST uint kVertexNormal = 1u;
GPGP_CONST uint kVertexUv = 2u;
GPGP_CONST uint kVertexBucket = 3u; // from here on numbers
GPGP_CONST uint kVertexRule = 7u;
GPGP_CONST uint kVertexSemantics = 8u;
// Formats.
GPGP_CONST uint kVertexFloat3 = 0u;
GPGP_CONST uint kVertexFloat2 = 1u;
GPGP_CONST uint kVertexHalf4 = 2u;
GPGP_CONST uint kVertexSnorm4 = 3u;
GPGP_CONST uint kVertexUnorm4 = 4u;
GPGP_CONST uint kVertexUint = 5u;

GPGP_CONST uint kMaxVertexAttributes = 8u;
GPGP_CONST uint kMaxVertexWords = 16u; // of a vertex

// An attribute in one word: where it lies in the vertex, what it is, how it is written.
GPGP_FN uint vertexAttribute(uint wordOffset, uint semantic, uint format) {
  return wordOffset | (semantic << 8) | (format << 16);
}
GPGP_CONST uint kNoAttribute = 0xffffffffu;
GPGP_FN uint attributeOffset(uint word) { return word & 0xffu; }
GPGP_FN uint attributeSemantic(uint word) { return (word >> 8) & 0xffu; }
GPGP_FN uint attributeFormat(uint word) { return word >> 16; }
GPGP_FN uint attributeWords(uint format) {
  return format == kVertexFloat3 ? 3u : (format == kVertexFloat2 || format == kVertexHalf4 ? 2u : 1u);
}

/// Normals where the format has no sign.
GPGP_FN vec4 withoutSign(vec4 v) {
  GPGP_PRECISE vec4 r = v * 0.5f + vec4(0.5f);
  return r;
}

/// An attribute's words. value: of what is not a number of its own (with w 1 for positions); number: of what is.
GPGP_FN uvec4 attributeValue(uint format, vec4 value, uint number) {
  uvec4 words = uvec4(floatBitsToUint(value.x), floatBitsToUint(value.y), floatBitsToUint(value.z), 0u);
  if (format == kVertexHalf4) {
    words.x = packHalf2x16(vec2(value.x, value.y));
    words.y = packHalf2x16(vec2(value.z, value.w));
  } else if (format == kVertexSnorm4) {
    words.x = packSnorm4x8(value);
  } else if (format == kVertexUnorm4) {
    words.x = packUnorm4x8(value);
  } else if (format == kVertexUint) {
    words.x = number;
  }
  return words;
}

/// Index number i of a quad, below 6: 0 1 2 0 2 3.
GPGP_FN uint quadIndex(uint i) { return (0x320210u >> (4u * i)) & 3u; }

GPGP_SHADER_END
#endif
