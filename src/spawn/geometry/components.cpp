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

/// Faces of a form as one of other axes, tight. flat: z of all positions is 0. number: kNone for each vertex of the
/// form, and so again afterwards.
Status takeFaces(MeshPool& pool, const Form& form, std::span<const uint32_t> faces, const Scope& scope, bool flat,
                 std::vector<uint32_t>& number, Form& taken) {
  Form made{scope, vec3(1.0f), 0};
  uint corners = 0, loops = 0;
  for (const uint32_t f : faces) {
    corners += faceCorners(pool, form.mesh, f).corners;
    loops += faceOf(pool, form.mesh, f).loops;
  }
  Builder b = newBuilder(pool, corners, corners, loops, uint(faces.size()), meshUvSets(pool, form.mesh));
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
  for (const uint32_t f : faces) {
    const Loop all = faceCorners(pool, form.mesh, f);
    for (uint c = 0; c < all.corners; ++c) {
      number[cornerVertex(pool, form.mesh, all.firstCorner + c)] = kNone;
    }
  }
  if (sameAxes) made.scope.origin = form.scope.origin;
  const Status status = finishForm(pool, b, made, true);
  if (status <= kGeometryEmpty) taken = made;
  return status;
}

} // namespace

Axes axesOf(const Scope& scope) { return {scope.axisX, scope.axisY, scope.axisZ}; }

Components::Components(MeshPool& pool, const Form& form, Component kind) : pool_(pool), form_(form), kind_(kind) {
  countSteps(pool, meshCorners(pool, form.mesh));
  switch (kind) {
  case Component::Faces: count_ = meshFaces(pool, form.mesh); break;
  case Component::Edges: count_ = uint32_t(edges().size()); break;
  case Component::FaceEdges:
    faceAt_ = cornerFaces(pool, form.mesh);
    count_ = uint32_t(faceAt_.size());
    break;
  case Component::Vertices: {
    const std::vector<uint32_t> welded = weldVertices(pool, form);
    places_ = placesOf(welded);
    faceAt_ = cornerFaces(pool, form.mesh);
    sums_.assign(welded.size(), vec3(0.0f));
    for (uint c = 0; c < faceAt_.size(); ++c) {
      vec3& sum = sums_[welded[cornerVertex(pool, form.mesh, c)]];
      sum = plus3(sum, localNormal(pool, form, faceAt_[c]));
    }
    count_ = uint32_t(places_.size());
    break;
  }
  case Component::Groups:
    groups_ = groupsOf(pool, form);
    count_ = uint32_t(groups_.size());
    break;
  case Component::Holes:
    holes_ = holesOf(pool, form);
    count_ = uint32_t(holes_.size());
    break;
  }
}

const std::vector<MeshEdge>& Components::edges() const {
  if (!hasEdges_) edges_ = meshEdges(pool_, form_);
  hasEdges_ = true;
  return edges_;
}

bool Components::isBorder(uint32_t index) const {
  if (kind_ == Component::Edges) return edges()[index].faces == 1;
  if (kind_ == Component::Holes) return false;
  if (!hasBorder_) {
    hasBorder_ = true;
    border_.assign(kind_ == Component::Vertices ? meshVertices(pool_, form_.mesh) : count_, false);
    std::vector<uint32_t> groupAt(kind_ == Component::Groups ? meshFaces(pool_, form_.mesh) : 0);
    for (uint32_t g = 0; g < groups_.size(); ++g) {
      for (const uint32_t f : groups_[g]) {
        groupAt[f] = g;
      }
    }
    for (const MeshEdge& e : edges()) {
      if (e.faces != 1) continue;
      if (kind_ == Component::Faces) border_[e.face] = true;
      if (kind_ == Component::FaceEdges) border_[e.corner] = true;
      if (kind_ == Component::Groups) border_[groupAt[e.face]] = true;
      if (kind_ == Component::Vertices) border_[e.from] = border_[e.to] = true;
    }
  }
  return border_[kind_ == Component::Vertices ? places_[index] : index];
}

uint32_t Components::tags(uint32_t index) const {
  if (index >= count_) return 0;
  switch (kind_) {
  case Component::Faces: return faceOf(pool_, form_.mesh, index).tags;
  case Component::Edges:
    return cornerTags(pool_, form_.mesh, edges()[index].corner) |
           cornerTags(pool_, form_.mesh, edges()[index].otherCorner);
  case Component::FaceEdges: return cornerTags(pool_, form_.mesh, index);
  case Component::Vertices: return 0;
  case Component::Groups: {
    uint32_t tags = 0;
    for (const uint32_t f : groups_[index]) {
      tags |= faceOf(pool_, form_.mesh, f).tags;
    }
    return tags;
  }
  case Component::Holes: return faceOf(pool_, form_.mesh, holes_[index].first).tags;
  }
  return 0;
}

uint32_t Components::tagsOfEdges(uint32_t index) const {
  if (kind_ != Component::Faces || index >= count_) return tags(index);
  const Loop all = faceCorners(pool_, form_.mesh, index);
  uint32_t found = 0;
  for (uint c = 0; c < all.corners; ++c) {
    found |= cornerTags(pool_, form_.mesh, all.firstCorner + c);
  }
  return found;
}

vec3 Components::normal(uint32_t index) const {
  vec3 local(0.0f);
  switch (kind_) {
  case Component::Faces: local = localNormal(pool_, form_, index); break;
  case Component::Edges: {
    const MeshEdge& e = edges()[index];
    local = e.faces == 1 ? outOf(pool_, form_, faceEdge(pool_, form_, e.face, e.corner))
                         : plus3(localNormal(pool_, form_, e.face), localNormal(pool_, form_, e.otherFace));
    break;
  }
  case Component::FaceEdges: local = outOf(pool_, form_, faceEdge(pool_, form_, faceAt_[index], index)); break;
  case Component::Vertices: local = sums_[places_[index]]; break;
  case Component::Groups:
    for (const uint32_t f : groups_[index]) {
      local = plus3(local, faceAreaVector(pool_, form_, f));
    }
    break;
  case Component::Holes: local = localNormal(pool_, form_, holes_[index].first); break;
  }
  return unit3(scopeDirection(form_.scope, local));
}

bool Components::matches(uint32_t index, Selector selector, const Axes& axes) const {
  if (index >= count_) return false;
  switch (selector) {
  case Selector::All: return true;
  case Selector::Border: return isBorder(index);
  case Selector::Inside: return !isBorder(index);
  case Selector::Eave: return (tags(index) & kTagEave) != 0;
  case Selector::Hip: return (tags(index) & kTagHip) != 0;
  case Selector::Valley: return (tags(index) & kTagValley) != 0;
  case Selector::Ridge: return (tags(index) & kTagRidge) != 0;
  case Selector::StreetFront: return (tags(index) & kTagStreetFront) != 0;
  case Selector::StreetBack: return (tags(index) & kTagStreetBack) != 0;
  case Selector::StreetLeft: return (tags(index) & kTagStreetLeft) != 0;
  case Selector::StreetRight: return (tags(index) & kTagStreetRight) != 0;
  case Selector::StreetSide: return (tags(index) & (kTagStreetLeft | kTagStreetRight)) != 0;
  default: break;
  }
  const vec3 direction = normal(index);
  const vec3 n(inner3(axes.x, direction), inner3(axes.y, direction), inner3(axes.z, direction));
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
  default: return false;
  }
  return false;
}

Status Components::take(uint32_t index, Form& component) const {
  if (index >= count_) return kGeometryBadArgument;
  MeshPool& pool = pool_;
  const Form& form = form_;
  if (number_.empty()) number_.assign(meshVertices(pool, form.mesh), kNone);
  Attempt attempt(pool);
  switch (kind_) {
  case Component::Faces:
    return attempt.end(takeFaces(pool, form, {{index}}, faceScope(pool, form, index), true, number_, component));
  case Component::Edges:
  case Component::FaceEdges: {
    const bool shared = kind_ == Component::Edges;
    const uint corner = shared ? edges()[index].corner : index;
    const FaceEdge e = faceEdge(pool, form, shared ? edges()[index].face : faceAt_[corner], corner);
    vec3 normal = localNormal(pool, form, e.face);
    if (shared) normal = plus3(normal, localNormal(pool, form, edges()[index].otherFace));
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
    vec3 direction = normal(index);
    if (direction == vec3(0.0f)) direction = form.scope.axisY;
    const vec3 p = scaled3(vertexPosition(pool, form.mesh, places_[index]), form.scale);
    component = {scopeAlong(scopePoint(form.scope, p), direction, form.scope.axisX), vec3(1.0f), 0};
    return attempt.end(kGeometryOk);
  }
  case Component::Groups:
    return attempt.end(takeFaces(pool, form, groups_[index], form.scope, false, number_, component));
  case Component::Holes: {
    const auto [f, l] = holes_[index];
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

uint32_t componentCount(MeshPool& pool, const Form& form, Component kind) {
  switch (kind) {
  case Component::Faces: return meshFaces(pool, form.mesh);
  case Component::FaceEdges: return meshCorners(pool, form.mesh);
  default: return Components(pool, form, kind).count();
  }
}
bool matches(MeshPool& pool, const Form& form, Component kind, uint32_t index, Selector selector, const Axes& axes) {
  return Components(pool, form, kind).matches(index, selector, axes);
}
uint32_t componentTags(MeshPool& pool, const Form& form, Component kind, uint32_t index) {
  return Components(pool, form, kind).tags(index);
}
Status toComponent(MeshPool& pool, const Form& form, Component kind, uint32_t index, Form& component) {
  return Components(pool, form, kind).take(index, component);
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
    const Components holes(pool, form, kind);
    std::vector<Form> parts(indices.size());
    for (size_t i = 0; i < indices.size(); ++i) {
      if (const Status status = holes.take(indices[i], parts[i])) return attempt.end(status);
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
  std::vector<uint32_t> number(meshVertices(pool, form.mesh), kNone);
  return attempt.end(takeFaces(pool, form, faces, form.scope, false, number, combined));
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

Status tagAll(MeshPool& pool, Form& form, bool faces, bool edges, uint32_t set, uint32_t clear) {
  const uint faceWords = kFaceWords * meshFaces(pool, form.mesh);
  const uint cornerWords = kCornerWords * meshCorners(pool, form.mesh);
  if (form.mesh == 0) return kGeometryOk;
  const uint to = takePool(pool, kMeshHeader + faceWords + cornerWords);
  if (to == 0) return kGeometryNoRoom;
  for (uint i = 0; i < kMeshHeader; ++i) {
    setPoolWord(pool, to + i, poolWord(pool, form.mesh + i));
  }
  const auto copy = [&](uint range, uint at, uint words, uint stride, uint tag, bool changes) {
    const uint from = poolWord(pool, form.mesh + range);
    setPoolWord(pool, to + range, at);
    for (uint i = 0; i < words; ++i) {
      const uint w = poolWord(pool, from + i);
      setPoolWord(pool, at + i, changes && i % stride == tag ? (w & ~clear) | set : w);
    }
  };
  copy(kMeshFaceRange, to + kMeshHeader, faceWords, kFaceWords, 2, faces);
  copy(kMeshCornerRange, to + kMeshHeader + faceWords, cornerWords, kCornerWords, 1, edges);
  form.mesh = to;
  return kGeometryOk;
}

uint32_t tagsOf(MeshPool& pool, const Form& form, bool faces, bool edges) {
  uint32_t tags = 0;
  for (uint f = 0; faces && f < meshFaces(pool, form.mesh); ++f) {
    tags |= faceOf(pool, form.mesh, f).tags;
  }
  for (uint c = 0; edges && c < meshCorners(pool, form.mesh); ++c) {
    tags |= cornerTags(pool, form.mesh, c);
  }
  return tags;
}

} // namespace gpgp::spawn
