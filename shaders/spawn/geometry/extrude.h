// Faces become solids.
#ifndef GPGP_SHADERS_SPAWN_GEOMETRY_EXTRUDE_H
#define GPGP_SHADERS_SPAWN_GEOMETRY_EXTRUDE_H
#include "spawn/geometry/build.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kExtrudeFaceNormal = 0u;
GPGP_CONST uint kExtrudeDirection = 2u;
GPGP_CONST uint kExtrudeFlatTop = 3u;

/// Sides between the corners of a face and vertices that lie above them: `upper` for the face's first corner, and so
/// on. Holes have sides too. The sides of a reversed solid face inwards of the face, that is outwards of the solid.
GPGP_FN void addSides(GPGP_POOL GPGP_INOUT(Builder) b, uint mesh, uint face, uint lowerVertex, uint upperVertex,
                      bool reversed) {
  const Face found = faceOf(GPGP_P mesh, face);
  uint above = upperVertex;
  for (uint l = 0u; l < found.loops; ++l) {
    const Loop loop = loopOf(GPGP_P mesh, found.firstLoop + l);
    for (uint i = 0u; i < loop.corners; ++i) {
      const uint corner = loop.firstCorner + i;
      const uint next = nextCorner(loop, corner);
      const uint nextAbove = above + next - loop.firstCorner;
      const uint v0 = lowerVertex + cornerVertex(GPGP_P mesh, corner);
      const uint v1 = lowerVertex + cornerVertex(GPGP_P mesh, next);
      const uint tags = cornerTags(GPGP_P mesh, corner);
      beginFace(GPGP_P b, kTagExtrudeSide | (tags & ~(kTagUser - 1u)));
      beginLoop(GPGP_P b);
      // The lower edge comes first, so that it is the side's x axis.
      const uint c0 = addCorner(GPGP_P b, reversed ? v1 : v0, tags);
      const uint c1 = addCorner(GPGP_P b, reversed ? v0 : v1, 0u);
      const uint c2 = addCorner(GPGP_P b, reversed ? above + i : nextAbove, tags);
      const uint c3 = addCorner(GPGP_P b, reversed ? nextAbove : above + i, 0u);
      copyCornerUv(GPGP_P b, c0, mesh, reversed ? next : corner, corner, 0.0f);
      copyCornerUv(GPGP_P b, c1, mesh, reversed ? corner : next, corner, 0.0f);
      copyCornerUv(GPGP_P b, c2, mesh, reversed ? corner : next, corner, 0.0f);
      copyCornerUv(GPGP_P b, c3, mesh, reversed ? next : corner, corner, 0.0f);
    }
    above += loop.corners;
  }
}

/// direction: in the scope's axes, for all but kExtrudeFaceNormal. Negative distances go the other way.
GPGP_FN uint extrudeFaces(GPGP_POOL GPGP_INOUT(Form) form, uint kind, float distance, vec3 direction) {
  const uint faces = meshFaces(GPGP_P form.mesh);
  const uint corners = meshCorners(GPGP_P form.mesh);
  const uint loops = meshLoops(GPGP_P form.mesh);
  const uint vertices = meshVertices(GPGP_P form.mesh);
  if (faces == 0u) return kGeometryEmpty;
  if (distance == 0.0f) return kGeometryOk;
  Builder b = newBuilder(GPGP_P vertices + corners, 6u * corners, 2u * loops + corners, 2u * faces + corners,
                         meshUvSets(GPGP_P form.mesh));
  copyVertices(GPGP_P b, form);
  for (uint f = 0u; f < faces; ++f) {
    const Loop all = faceCorners(GPGP_P form.mesh, f);
    const vec3 normal = localNormal(GPGP_P form, f);
    const vec3 along = kind == kExtrudeFaceNormal ? normal : direction;
    // Below the face where the direction points away from its front.
    const bool reversed = (inner3(along, normal) < 0.0f) != (distance < 0.0f);
    float top = 0.0f;
    for (uint c = 0u; c < all.corners && kind == kExtrudeFlatTop; ++c) {
      const float height = inner3(localPosition(GPGP_P form, all.firstCorner + c), along);
      if (c == 0u || (distance > 0.0f ? height > top : height < top)) top = height;
    }
    const uint upper = b.vertices;
    for (uint c = 0u; c < all.corners; ++c) {
      const vec3 p = localPosition(GPGP_P form, all.firstCorner + c);
      const float by = kind == kExtrudeFlatTop ? add(subtract(top, inner3(p, along)), distance) : distance;
      addVertex(GPGP_P b, along3(p, along, by));
    }
    copyFace(GPGP_P b, form.mesh, f, 0u, !reversed, kTagExtrudeBottom);
    addSides(GPGP_P b, form.mesh, f, 0u, upper, reversed);
    // The upper face: as the old one, with its own vertices.
    const Face found = faceOf(GPGP_P form.mesh, f);
    beginFace(GPGP_P b, found.tags | kTagExtrudeTop);
    uint first = upper;
    for (uint l = 0u; l < found.loops; ++l) {
      const Loop loop = loopOf(GPGP_P form.mesh, found.firstLoop + l);
      beginLoop(GPGP_P b);
      for (uint i = 0u; i < loop.corners; ++i) {
        const uint j = reversed ? loop.corners - 1u - i : i;
        const uint corner = loop.firstCorner + j;
        const uint ofEdge = reversed ? previousCorner(loop, corner) : corner;
        const uint made = addCorner(GPGP_P b, first + j, cornerTags(GPGP_P form.mesh, ofEdge));
        copyCornerUv(GPGP_P b, made, form.mesh, corner, corner, 0.0f);
      }
      first += loop.corners;
    }
  }
  return finishForm(GPGP_P b, form, true);
}

GPGP_SHADER_END
#endif
