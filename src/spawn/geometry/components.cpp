// Faces, edges, vertices, groups and holes of forms: which directions they face, and each as a form of its own.
#include "spawn/geometry/internal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// An edge of a face: its ends in the scope's metres.
struct FaceEdge {
  uint32_t face;
  Loop loop;
  uint32_t corner;
  vec3 from, to;
};
FaceEdge faceEdge(MeshPool& pool, const Form& form, uint32_t face, uint32_t corner) {
  const Face found = faceOf(pool, form.mesh, face);
  FaceEdge e{face, {}, corner, {}, {}};
  for (uint l = 0; l < found.loops; ++l) {
    e.loop = loopOf(pool, form.mesh, found.firstLoop + l);
    if (corner < e.loop.firstCorner + e.loop.corners) break;
  }
  e.from = localPosition(pool, form, corner);
  e.to = localPosition(pool, form, nextCorner(e.loop, corner));
  return e;
}
/// Out of the face, in its plane.
vec3 outOf(MeshPool& pool, const Form& form, const FaceEdge& e) {
  return unit3(outer3(minus3(e.to, e.from), localNormal(pool, form, e.face)));
}

/// The face's loops of holes, one behind the other.
std::vector<std::pair<uint32_t, uint32_t>> holesOf(MeshPool& pool, const Form& form) {
  std::vector<std::pair<uint32_t, uint32_t>> holes;
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    for (uint l = 1; l < face.loops; ++l) {
      holes.emplace_back(f, face.firstLoop + l);
    }
  }
  return holes;
}

/// For each group, its faces.
std::vector<std::vector<uint32_t>> groupsOf(MeshPool& pool, const Form& form) {
  std::vector<uint32_t> lead(meshFaces(pool, form.mesh));
  std::iota(lead.begin(), lead.end(), 0u);
  const auto find = [&](uint32_t f) {
    while (lead[f] != f) {
      f = lead[f] = lead[lead[f]];
    }
    return f;
  };
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  // Faces that share an edge; which face had an edge first.
  std::vector<std::vector<std::pair<uint32_t, uint32_t>>> edges(welded.size());
  for (uint f = 0; f < lead.size(); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        const uint a = welded[cornerVertex(pool, form.mesh, c)];
        const uint b = welded[cornerVertex(pool, form.mesh, nextCorner(loop, c))];
        auto& known = edges[std::min(a, b)];
        const auto at =
            std::find_if(known.begin(), known.end(), [&](const auto& e) { return e.first == std::max(a, b); });
        if (at == known.end()) {
          known.emplace_back(std::max(a, b), f);
        } else {
          const uint x = find(f), y = find(at->second);
          lead[std::max(x, y)] = std::min(x, y);
        }
      }
    }
  }
  std::vector<std::vector<uint32_t>> groups;
  std::vector<uint32_t> number(lead.size(), kNone);
  for (uint f = 0; f < lead.size(); ++f) {
    const uint first = find(f);
    if (number[first] == kNone) {
      number[first] = uint32_t(groups.size());
      groups.emplace_back();
    }
    groups[number[first]].push_back(f);
  }
  return groups;
}

/// The places of vertices: for each, one vertex.
std::vector<uint32_t> placesOf(const std::vector<uint32_t>& welded) {
  std::vector<uint32_t> places;
  for (uint32_t v = 0; v < welded.size(); ++v) {
    if (welded[v] == v) places.push_back(v);
  }
  return places;
}

/// Where a component is and which way it faces, in the frame, with the tags that it has.
struct Direction {
  bool found = false;
  vec3 normal{0.0f};
  uint32_t tags = 0;
  bool border = false;
};
Direction directionOf(MeshPool& pool, const Form& form, Component kind, uint32_t index, bool wantBorder) {
  Direction d;
  vec3 local(0.0f);
  const uint faces = meshFaces(pool, form.mesh);
  const auto bordersOf = [&](const auto& isPart) {
    if (!wantBorder) return false;
    const std::vector<MeshEdge> edges = meshEdges(pool, form);
    return std::any_of(edges.begin(), edges.end(), [&](const MeshEdge& e) { return e.faces == 1 && isPart(e); });
  };
  switch (kind) {
  case Component::Faces:
    if (index >= faces) return d;
    local = localNormal(pool, form, index);
    d.tags = faceOf(pool, form.mesh, index).tags;
    d.border = bordersOf([&](const MeshEdge& e) { return e.face == index; });
    break;
  case Component::Edges: {
    const std::vector<MeshEdge> edges = meshEdges(pool, form);
    if (index >= edges.size()) return d;
    const MeshEdge& e = edges[index];
    d.tags = cornerTags(pool, form.mesh, e.corner) | cornerTags(pool, form.mesh, e.otherCorner);
    d.border = e.faces == 1;
    local = e.faces == 1 ? outOf(pool, form, faceEdge(pool, form, e.face, e.corner))
                         : plus3(localNormal(pool, form, e.face), localNormal(pool, form, e.otherFace));
    break;
  }
  case Component::FaceEdges: {
    if (index >= meshCorners(pool, form.mesh)) return d;
    const uint face = cornerFaces(pool, form.mesh)[index];
    local = outOf(pool, form, faceEdge(pool, form, face, index));
    d.tags = cornerTags(pool, form.mesh, index);
    if (wantBorder) {
      for (const MeshEdge& e : meshEdges(pool, form)) {
        d.border = d.border || (e.corner == index && e.faces == 1);
      }
    }
    break;
  }
  case Component::Vertices: {
    const std::vector<uint32_t> welded = weldVertices(pool, form);
    const std::vector<uint32_t> places = placesOf(welded);
    if (index >= places.size()) return d;
    const std::vector<uint32_t> faceAt = cornerFaces(pool, form.mesh);
    for (uint c = 0; c < faceAt.size(); ++c) {
      if (welded[cornerVertex(pool, form.mesh, c)] == places[index])
        local = plus3(local, localNormal(pool, form, faceAt[c]));
    }
    d.border = bordersOf([&](const MeshEdge& e) { return e.from == places[index] || e.to == places[index]; });
    break;
  }
  case Component::Groups: {
    const auto groups = groupsOf(pool, form);
    if (index >= groups.size()) return d;
    for (const uint32_t f : groups[index]) {
      local = plus3(local, faceAreaVector(pool, form, f));
      d.tags |= faceOf(pool, form.mesh, f).tags;
    }
    d.border = bordersOf([&](const MeshEdge& e) {
      return std::find(groups[index].begin(), groups[index].end(), e.face) != groups[index].end();
    });
    break;
  }
  case Component::Holes: {
    const auto holes = holesOf(pool, form);
    if (index >= holes.size()) return d;
    local = localNormal(pool, form, holes[index].first);
    d.tags = faceOf(pool, form.mesh, holes[index].first).tags;
    break;
  }
  }
  d.found = true;
  d.normal = unit3(scopeDirection(form.scope, local));
  return d;
}

/// A scope with z along a normal of the frame and x along a direction.
Scope scopeAlong(vec3 origin, vec3 normal, vec3 along) {
  const PlaneBasis basis = planeBasis(origin, normal, along);
  return {origin, basis.right, basis.up, normal, vec3(0.0f)};
}

/// The face's axes: of its edges the first whose y is as much up as that of any.
Scope faceScope(MeshPool& pool, const Form& form, uint32_t f) {
  const vec3 normal = faceNormal(pool, form, f);
  const Loop loop = loopOf(pool, form.mesh, faceOf(pool, form.mesh, f).firstLoop);
  vec3 best(0.0f);
  float bestUp = 0.0f;
  for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
    const vec3 along = unit3(minus3(framePosition(pool, form, nextCorner(loop, c)), framePosition(pool, form, c)));
    const float up = outer3(normal, along).y;
    if (along == vec3(0.0f) || (best != vec3(0.0f) && up <= bestUp + 1e-4f)) continue;
    best = along;
    bestUp = up;
  }
  return scopeAlong(framePosition(pool, form, loop.firstCorner), normal, best);
}

/// Faces of a form as one of other axes, tight. flat: z of all positions is 0.
Status takeFaces(MeshPool& pool, const Form& form, std::span<const uint32_t> faces, const Scope& scope, bool flat,
                 Form& taken) {
  Form made{scope, vec3(1.0f), 0};
  std::vector<uint32_t> number(meshVertices(pool, form.mesh), kNone);
  Builder b = builderFor(pool, form.mesh, 1);
  const bool sameAxes = !flat && scope.axisX == form.scope.axisX && scope.axisY == form.scope.axisY;
  for (const uint32_t f : faces) {
    const Face face = faceOf(pool, form.mesh, f);
    beginFace(pool, b, face.tags);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      beginLoop(pool, b);
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        uint32_t& v = number[cornerVertex(pool, form.mesh, c)];
        if (v == kNone) {
          vec3 p = localPosition(pool, form, c);
          if (!sameAxes) p = inScope(scope, minus3(scopePoint(form.scope, p), scope.origin));
          if (flat) p.z = 0;
          v = addVertex(pool, b, p);
        }
        const uint made2 = addCorner(pool, b, v, cornerTags(pool, form.mesh, c));
        copyCornerUv(pool, b, made2, form.mesh, c, c, 0.0f);
      }
    }
  }
  if (sameAxes) made.scope.origin = form.scope.origin;
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) taken = made;
  return status;
}

} // namespace

Axes axesOf(const Scope& scope) { return {scope.axisX, scope.axisY, scope.axisZ}; }

uint32_t componentCount(MeshPool& pool, const Form& form, Component kind) {
  switch (kind) {
  case Component::Faces: return meshFaces(pool, form.mesh);
  case Component::Edges: return edgeCount(pool, form);
  case Component::FaceEdges: return meshCorners(pool, form.mesh);
  case Component::Vertices: return vertexCount(pool, form);
  case Component::Groups: return uint32_t(groupsOf(pool, form).size());
  case Component::Holes: return uint32_t(holesOf(pool, form).size());
  }
  return 0;
}

bool matches(MeshPool& pool, const Form& form, Component kind, uint32_t index, Selector selector, const Axes& axes) {
  const bool wantBorder = selector == Selector::Border || selector == Selector::Inside;
  const Direction d = directionOf(pool, form, kind, index, wantBorder);
  if (!d.found) return false;
  const vec3 n(inner3(axes.x, d.normal), inner3(axes.y, d.normal), inner3(axes.z, d.normal));
  constexpr float kSine45 = 0.70710678f, kSine11 = 0.19509032f, kSine78 = 0.98078528f, kSlack = 1e-5f;
  const bool top = n.y > kSine45 + kSlack, bottom = n.y < -kSine45 - kSlack;
  const bool level = !top && !bottom; // 45 degrees is a side's
  const bool alongZ = std::fabs(n.z) >= std::fabs(n.x) - kSlack;
  switch (selector) {
  case Selector::Front: return level && alongZ && n.z > 0;
  case Selector::Back: return level && alongZ && n.z < 0;
  case Selector::Left: return level && !alongZ && n.x < 0;
  case Selector::Right: return level && !alongZ && n.x > 0;
  case Selector::Top: return top;
  case Selector::Bottom: return bottom;
  case Selector::Side: return std::fabs(n.y) <= kSine78;
  case Selector::Vertical: return std::fabs(n.y) <= kSine11 + kSlack;
  case Selector::Horizontal: return std::fabs(n.y) > kSine78;
  case Selector::Aslant: return n.y > kSine11 + kSlack && n.y <= kSine78;
  case Selector::Nutant: return n.y < -kSine11 - kSlack && n.y >= -kSine78;
  case Selector::Border: return d.border;
  case Selector::Inside: return !d.border;
  case Selector::Eave: return (d.tags & kTagEave) != 0;
  case Selector::Hip: return (d.tags & kTagHip) != 0;
  case Selector::Valley: return (d.tags & kTagValley) != 0;
  case Selector::Ridge: return (d.tags & kTagRidge) != 0;
  case Selector::All: return true;
  }
  return false;
}

uint32_t componentTags(MeshPool& pool, const Form& form, Component kind, uint32_t index) {
  return directionOf(pool, form, kind, index, false).tags;
}

Status toComponent(MeshPool& pool, const Form& form, Component kind, uint32_t index, Form& component) {
  Attempt attempt(pool);
  switch (kind) {
  case Component::Faces:
    if (index >= meshFaces(pool, form.mesh)) return kGeometryBadArgument;
    return attempt.end(takeFaces(pool, form, {{index}}, faceScope(pool, form, index), true, component));
  case Component::Edges:
  case Component::FaceEdges: {
    const std::vector<MeshEdge> edges = kind == Component::Edges ? meshEdges(pool, form) : std::vector<MeshEdge>{};
    if (index >= (kind == Component::Edges ? edges.size() : meshCorners(pool, form.mesh))) return kGeometryBadArgument;
    const uint corner = kind == Component::Edges ? edges[index].corner : index;
    const FaceEdge e = faceEdge(pool, form, cornerFaces(pool, form.mesh)[corner], corner);
    vec3 normal = localNormal(pool, form, e.face);
    if (kind == Component::Edges) normal = plus3(normal, localNormal(pool, form, edges[index].otherFace));
    const vec3 along = minus3(e.to, e.from);
    const vec3 x = unit3(scopeDirection(form.scope, along));
    vec3 z = unit3(scopeDirection(form.scope, normal));
    if (z == vec3(0.0f)) z = faceNormal(pool, form, e.face);
    Form made{scopeAlong(scopePoint(form.scope, e.from), unit3(along3(z, x, -inner3(z, x))), x), vec3(1.0f), 0};
    made.scope.size = vec3(length3(along), 0.0f, 0.0f);
    component = made;
    return attempt.end(kGeometryOk);
  }
  case Component::Vertices: {
    const std::vector<uint32_t> places = placesOf(weldVertices(pool, form));
    if (index >= places.size()) return kGeometryBadArgument;
    vec3 normal = directionOf(pool, form, kind, index, false).normal;
    if (normal == vec3(0.0f)) normal = form.scope.axisY;
    const vec3 p = scaled3(vertexPosition(pool, form.mesh, places[index]), form.scale);
    component = {scopeAlong(scopePoint(form.scope, p), normal, form.scope.axisX), vec3(1.0f), 0};
    return attempt.end(kGeometryOk);
  }
  case Component::Groups: {
    const auto groups = groupsOf(pool, form);
    if (index >= groups.size()) return kGeometryBadArgument;
    return attempt.end(takeFaces(pool, form, groups[index], form.scope, false, component));
  }
  case Component::Holes: {
    const auto holes = holesOf(pool, form);
    if (index >= holes.size()) return kGeometryBadArgument;
    const auto [f, l] = holes[index];
    const Loop loop = loopOf(pool, form.mesh, l);
    Form made{faceScope(pool, form, f), vec3(1.0f), 0};
    Builder b = newBuilder(pool, loop.corners, loop.corners, 1, 1, meshUvSets(pool, form.mesh));
    beginFace(pool, b, 0);
    beginLoop(pool, b);
    for (uint i = loop.corners; i-- > 0;) {
      const uint corner = loop.firstCorner + i;
      vec3 p = inScope(made.scope, minus3(framePosition(pool, form, corner), made.scope.origin));
      p.z = 0;
      const uint c =
          addCorner(pool, b, addVertex(pool, b, p), cornerTags(pool, form.mesh, previousCorner(loop, corner)));
      copyCornerUv(pool, b, c, form.mesh, corner, corner, 0.0f);
    }
    const Status status = finishForm(pool, b, made, true);
    if (status <= kGeometryEmpty) component = made;
    return attempt.end(status);
  }
  }
  return kGeometryBadArgument;
}

Status toComponents(MeshPool& pool, const Form& form, Component kind, std::span<const uint32_t> indices,
                    Form& combined) {
  Attempt attempt(pool);
  std::vector<uint32_t> faces;
  switch (kind) {
  case Component::Faces: faces.assign(indices.begin(), indices.end()); break;
  case Component::Groups: {
    const auto groups = groupsOf(pool, form);
    for (const uint32_t g : indices) {
      if (g >= groups.size()) return kGeometryBadArgument;
      faces.insert(faces.end(), groups[g].begin(), groups[g].end());
    }
    break;
  }
  case Component::Holes: {
    std::vector<Form> parts(indices.size());
    for (size_t i = 0; i < indices.size(); ++i) {
      if (const Status status = toComponent(pool, form, kind, indices[i], parts[i])) return attempt.end(status);
    }
    if (parts.empty()) return attempt.end(kGeometryEmpty);
    Form made{};
    if (const Status status = combine(pool, parts, made)) return attempt.end(status);
    const Status status = alignScope(pool, made, axesOf(form.scope));
    if (status <= kGeometryEmpty) combined = made;
    return attempt.end(status);
  }
  default: return kGeometryBadArgument; // edges and vertices have no geometry to join
  }
  for (const uint32_t f : faces) {
    if (f >= meshFaces(pool, form.mesh)) return kGeometryBadArgument;
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return attempt.end(takeFaces(pool, form, faces, form.scope, false, combined));
}

Status tagComponent(MeshPool& pool, Form& form, Component kind, uint32_t index, uint32_t tags) {
  if (index >= componentCount(pool, form, kind)) return kGeometryBadArgument;
  Attempt attempt(pool);
  std::vector<uint32_t> faces, corners;
  if (kind == Component::Faces) faces = {index};
  if (kind == Component::Groups) faces = groupsOf(pool, form)[index];
  if (kind == Component::FaceEdges) corners = {index};
  if (kind == Component::Edges) {
    const MeshEdge e = meshEdges(pool, form)[index];
    corners = {e.corner, e.otherCorner};
  }
  if (faces.empty() && corners.empty()) return kGeometryBadArgument;
  Builder b = builderFor(pool, form.mesh, 1);
  copyVertices(pool, b, form);
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const bool tagged = std::find(faces.begin(), faces.end(), f) != faces.end();
    copyFace(pool, b, form.mesh, f, 0, false, tagged ? tags : 0);
  }
  if (b.status == kGeometryOk) {
    for (const uint32_t c : corners) {
      const uint at = b.cornerAt + kCornerWords * c + 1;
      setWorkWord(pool, at, workWord(pool, at) | tags);
    }
  }
  return attempt.end(finishForm(pool, b, form, false));
}

} // namespace gpgp::spawn
