// Fewer faces and corners for the same geometry, and outlines made simpler or straighter.
#include "spawn/geometry/waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace gpgp::spawn {

using namespace shader;

namespace {

/// A face as lists of corners of the old mesh.
struct Outlines {
  std::vector<std::vector<uint32_t>> loops;
  uint32_t tags;
};
std::vector<Outlines> outlinesOf(MeshPool& pool, uint32_t mesh) {
  std::vector<Outlines> faces;
  for (uint f = 0; f < meshFaces(pool, mesh); ++f) {
    const Face face = faceOf(pool, mesh, f);
    Outlines o{{}, face.tags};
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, mesh, face.firstLoop + l);
      std::vector<uint32_t> corners(loop.corners);
      std::iota(corners.begin(), corners.end(), loop.firstCorner);
      o.loops.push_back(std::move(corners));
    }
    faces.push_back(std::move(o));
  }
  return faces;
}
/// The form with these faces; vertices are places of `positions`.
Status rebuild(MeshPool& pool, Form& form, const std::vector<Outlines>& faces, const std::vector<uint32_t>& welded,
               const std::vector<vec3>& positions) {
  uint loops = 0;
  for (const Outlines& face : faces) {
    loops += uint(face.loops.size());
  }
  Builder b = newBuilder(pool, meshVertices(pool, form.mesh), meshCorners(pool, form.mesh), loops, uint(faces.size()),
                         meshUvSets(pool, form.mesh));
  std::vector<uint32_t> number(positions.size(), kNone);
  for (const Outlines& face : faces) {
    if (face.loops.empty() || face.loops[0].size() < 3) continue;
    beginFace(pool, b, face.tags);
    for (const auto& loop : face.loops) {
      if (loop.size() < 3) continue;
      beginLoop(pool, b);
      for (const uint32_t c : loop) {
        uint32_t& v = number[welded[cornerVertex(pool, form.mesh, c)]];
        if (v == kNone) v = addVertex(pool, b, positions[welded[cornerVertex(pool, form.mesh, c)]]);
        const uint made = addCorner(pool, b, v, cornerTags(pool, form.mesh, c));
        copyCornerUv(pool, b, made, form.mesh, c, c, 0.0f);
      }
    }
  }
  return finishForm(pool, b, form, true);
}
std::vector<vec3> positionsOf(MeshPool& pool, const Form& form) {
  std::vector<vec3> positions(meshVertices(pool, form.mesh));
  for (uint v = 0; v < positions.size(); ++v) {
    positions[v] = scaled3(vertexPosition(pool, form.mesh, v), form.scale);
  }
  return positions;
}

/// Loops from directed edges (corner to end place) that are left of faces of one plane.
struct DirectedEdge {
  uint32_t corner, from, to;
  bool used = false;
};
void chain(MeshPool& pool, std::vector<DirectedEdge>& edges, const std::vector<vec3>& positions,
           const PlaneBasis& basis, uint32_t tags, std::vector<Outlines>& faces) {
  std::vector<std::vector<uint32_t>> loops;
  std::vector<std::vector<vec2>> points;
  for (DirectedEdge& start : edges) {
    if (start.used) continue;
    std::vector<uint32_t> loop;
    std::vector<vec2> at;
    DirectedEdge* e = &start;
    while (e) {
      e->used = true;
      loop.push_back(e->corner);
      at.push_back(inPlane(basis, positions[e->from]));
      if (e->to == start.from) break;
      const glm::dvec2 along(inPlane(basis, positions[e->to]) - at.back());
      DirectedEdge* next = nullptr;
      if (!countSteps(pool, edges.size())) return;
      double best = -10;
      for (DirectedEdge& other : edges) {
        if (other.used || other.from != e->to) continue;
        const glm::dvec2 d(inPlane(basis, positions[other.to]) - inPlane(basis, positions[other.from]));
        const double turn = std::atan2(along.x * d.y - along.y * d.x, along.x * d.x + along.y * d.y);
        if (turn > best) {
          best = turn;
          next = &other;
        }
      }
      e = next;
    }
    if (!e || loop.size() < 3) continue;
    loops.push_back(std::move(loop));
    points.push_back(std::move(at));
  }
  const auto areaOf = [](const std::vector<vec2>& loop) {
    double sum = 0;
    for (size_t i = 0; i < loop.size(); ++i) {
      const glm::dvec2 a(loop[i] - loop[0]), b(loop[(i + 1) % loop.size()] - loop[0]);
      sum += a.x * b.y - a.y * b.x;
    }
    return sum;
  };
  const auto contains = [](const std::vector<vec2>& loop, vec2 p) {
    bool isInside = false;
    for (size_t i = 0; i < loop.size(); ++i) {
      const vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      const float side = sideOf(a, b, p);
      if (b.y > a.y ? side > 0 : side < 0) isInside = !isInside;
    }
    return isInside;
  };
  std::vector<size_t> faceOfLoop(loops.size(), faces.size());
  for (size_t i = 0; i < loops.size(); ++i) {
    if (!(areaOf(points[i]) > 0)) continue;
    faceOfLoop[i] = faces.size();
    faces.push_back({{loops[i]}, tags});
  }
  // A hole belongs to the smallest outline around it.
  for (size_t j = 0; j < loops.size(); ++j) {
    if (areaOf(points[j]) >= 0) continue;
    for (const auto& loop : points) countSteps(pool, loop.size());
    const vec2 middle = (points[j][0] + points[j][1]) * 0.5f;
    size_t chosen = loops.size();
    for (size_t i = 0; i < loops.size(); ++i) {
      if (!(areaOf(points[i]) > 0) || !contains(points[i], middle)) continue;
      if (chosen == loops.size() || areaOf(points[i]) < areaOf(points[chosen])) chosen = i;
    }
    if (chosen != loops.size()) faces[faceOfLoop[chosen]].loops.push_back(loops[j]);
  }
}

std::vector<Outlines> mergeFaces(MeshPool& pool, const Form& form, const std::vector<uint32_t>& welded,
                                 const std::vector<vec3>& positions, float degrees) {
  const std::vector<Outlines> old = outlinesOf(pool, form.mesh);
  std::vector<uint32_t> lead(old.size());
  std::iota(lead.begin(), lead.end(), 0u);
  const auto find = [&](uint32_t f) {
    while (lead[f] != f) {
      f = lead[f];
    }
    return f;
  };
  const float cosine = std::cos(degrees / 57.29577951f);
  std::vector<vec3> normals;
  for (uint f = 0; f < old.size(); ++f) {
    normals.push_back(localNormal(pool, form, f));
  }
  for (const MeshEdge& e : meshEdges(pool, form)) {
    if (e.faces != 2 || !e.opposed || e.face == e.otherFace) continue;
    if (normals[e.face] == vec3(0.0f) || normals[e.otherFace] == vec3(0.0f)) continue;
    const uint32_t a = find(e.face), b = find(e.otherFace);
    // The leading face's plane decides, so that a bent strip does not become one face bit by bit.
    if (a == b || inner3(normals[a], normals[b]) < cosine || old[a].tags != old[b].tags) continue;
    lead[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<DirectedEdge>> edges(old.size());
  std::vector<uint32_t> sizes(old.size());
  for (uint f = 0; f < old.size(); ++f) {
    sizes[find(f)] += 1;
    for (const auto& loop : old[f].loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const uint from = welded[cornerVertex(pool, form.mesh, loop[i])];
        const uint to = welded[cornerVertex(pool, form.mesh, loop[(i + 1) % loop.size()])];
        edges[find(f)].push_back({loop[i], from, to});
      }
    }
  }
  std::vector<Outlines> faces;
  for (uint f = 0; f < old.size(); ++f) {
    if (find(f) != f) continue;
    if (sizes[f] == 1) {
      faces.push_back(old[f]);
      continue;
    }
    for (DirectedEdge& e : edges[f]) {
      if (!countSteps(pool, edges[f].size())) break;
      for (DirectedEdge& o : edges[f]) {
        if (e.used || o.used || &e == &o || e.from != o.to || e.to != o.from) continue;
        e.used = o.used = true;
      }
    }
    const PlaneBasis basis =
        planeBasis(positions[edges[f][0].from], normals[f], positions[edges[f][0].to] - positions[edges[f][0].from]);
    chain(pool, edges[f], positions, basis, old[f].tags, faces);
  }
  return faces;
}

/// For each place its neighbours along edges, kNone twice where there are more than two.
std::vector<std::pair<uint32_t, uint32_t>> outlineNeighbours(MeshPool& pool, const Form& form,
                                                             const std::vector<Outlines>& faces,
                                                             const std::vector<uint32_t>& welded) {
  std::vector<std::vector<uint32_t>> found(welded.size());
  for (const Outlines& face : faces) {
    for (const auto& loop : face.loops) {
      for (size_t i = 0; i < loop.size(); ++i) {
        const uint a = welded[cornerVertex(pool, form.mesh, loop[i])];
        const uint b = welded[cornerVertex(pool, form.mesh, loop[(i + 1) % loop.size()])];
        found[a].push_back(b);
        found[b].push_back(a);
      }
    }
  }
  std::vector<std::pair<uint32_t, uint32_t>> pairs(welded.size(), {kNone, kNone});
  for (size_t v = 0; v < found.size(); ++v) {
    std::sort(found[v].begin(), found[v].end());
    found[v].erase(std::unique(found[v].begin(), found[v].end()), found[v].end());
    if (found[v].size() == 2) pairs[v] = {found[v][0], found[v][1]};
  }
  return pairs;
}
void dropPlace(MeshPool& pool, const Form& form, std::vector<Outlines>& faces, const std::vector<uint32_t>& welded,
               uint32_t place) {
  for (Outlines& face : faces) {
    for (auto& loop : face.loops) {
      std::erase_if(loop, [&](uint32_t c) { return welded[cornerVertex(pool, form.mesh, c)] == place; });
    }
  }
}
/// The same, of an outline with so few corners that none can go.
bool canDrop(MeshPool& pool, const Form& form, const std::vector<Outlines>& faces, const std::vector<uint32_t>& welded,
             uint32_t place) {
  for (const Outlines& face : faces) {
    for (const auto& loop : face.loops) {
      if (loop.size() > 3) continue;
      for (const uint32_t c : loop) {
        if (welded[cornerVertex(pool, form.mesh, c)] == place) return false;
      }
    }
  }
  return true;
}

} // namespace

Status cleanup(MeshPool& pool, Form& form, const Cleanup& what) {
  if (!(what.degrees >= 0) || what.degrees > 90) return kGeometryBadArgument;
  if (form.mesh == 0) return kGeometryOk;
  Attempt attempt(pool);
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  const std::vector<vec3> positions = positionsOf(pool, form);
  std::vector<Outlines> faces = outlinesOf(pool, form.mesh);
  if (what.faces) {
    faces = mergeFaces(pool, form, welded, positions, what.degrees);
  }
  for (Outlines& face : faces) {
    for (auto& loop : face.loops) {
      for (size_t i = loop.size(); i-- > 0 && loop.size() > 1;) {
        const uint a = welded[cornerVertex(pool, form.mesh, loop[i])];
        if (a == welded[cornerVertex(pool, form.mesh, loop[(i + 1) % loop.size()])])
          loop.erase(loop.begin() + ptrdiff_t(i));
      }
    }
  }
  if (what.vertices) {
    const float cosine = std::cos(std::max(what.degrees, 0.01f) / 57.29577951f);
    const auto neighbours = outlineNeighbours(pool, form, faces, welded);
    for (uint32_t v = 0; v < welded.size(); ++v) {
      const auto [a, b] = neighbours[v];
      if (a == kNone) continue;
      if (!countSteps(pool, meshCorners(pool, form.mesh))) return attempt.end(kGeometryTooLarge);
      if (!canDrop(pool, form, faces, welded, v)) continue;
      const vec3 in = unit3(positions[v] - positions[a]), out = unit3(positions[b] - positions[v]);
      if (inner3(in, out) >= cosine) dropPlace(pool, form, faces, welded, v);
    }
  }
  return attempt.end(rebuild(pool, form, faces, welded, positions));
}

Status reduce(MeshPool& pool, Form& form, float part) {
  if (!(part >= 0) || part > 1) return kGeometryBadArgument;
  if (form.mesh == 0) return kGeometryOk;
  Attempt attempt(pool);
  const std::vector<uint32_t> welded = weldVertices(pool, form);
  const std::vector<vec3> positions = positionsOf(pool, form);
  std::vector<Outlines> faces = outlinesOf(pool, form.mesh);
  const auto first = outlineNeighbours(pool, form, faces, welded);
  const size_t candidates =
      size_t(std::count_if(first.begin(), first.end(), [](const auto& p) { return p.first != kNone; }));
  const size_t goes = size_t(part * float(candidates));
  for (size_t i = 0; i < goes; ++i) {
    if (!countSteps(pool, 4ull * meshCorners(pool, form.mesh))) return attempt.end(kGeometryTooLarge);
    const auto neighbours = outlineNeighbours(pool, form, faces, welded);
    float best = 0;
    uint32_t chosen = kNone;
    for (uint32_t v = 0; v < welded.size(); ++v) {
      const auto [a, b] = neighbours[v];
      if (a == kNone) continue;
      if (!countSteps(pool, meshCorners(pool, form.mesh))) return attempt.end(kGeometryTooLarge);
      if (!canDrop(pool, form, faces, welded, v)) continue;
      const float moved = length3(outer3(positions[a] - positions[v], positions[b] - positions[v]));
      if (chosen != kNone && moved >= best) continue;
      best = moved;
      chosen = v;
    }
    if (chosen == kNone) break;
    dropPlace(pool, form, faces, welded, chosen);
  }
  return attempt.end(rebuild(pool, form, faces, welded, positions));
}

Status rectify(MeshPool& pool, Form& form, float degrees) {
  if (!(degrees >= 0) || degrees > 45) return kGeometryBadArgument;
  if (form.mesh == 0) return kGeometryOk;
  Attempt attempt(pool);
  // Each face's outline in its plane: edges near the longest one's direction, or near a right angle to it, take that
  // direction through their middles; corners are where neighbouring edges meet.
  const uint corners = meshCorners(pool, form.mesh);
  Builder b = newBuilder(pool, corners, corners, meshLoops(pool, form.mesh), meshFaces(pool, form.mesh),
                         meshUvSets(pool, form.mesh));
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const Face face = faceOf(pool, form.mesh, f);
    const Loop outer = loopOf(pool, form.mesh, face.firstLoop);
    const vec3 origin = localPosition(pool, form, outer.firstCorner);
    const PlaneBasis basis =
        planeBasis(origin, localNormal(pool, form, f), localPosition(pool, form, outer.firstCorner + 1) - origin);
    glm::dvec2 main(1, 0);
    double longest = -1;
    for (uint c = outer.firstCorner; c < outer.firstCorner + outer.corners; ++c) {
      const glm::dvec2 d(inPlane(basis, localPosition(pool, form, nextCorner(outer, c))) -
                         inPlane(basis, localPosition(pool, form, c)));
      const double length = std::hypot(d.x, d.y);
      if (length <= longest) continue;
      longest = length;
      main = d / length;
    }
    beginFace(pool, b, face.tags);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool, form.mesh, face.firstLoop + l);
      std::vector<glm::dvec2> points, directions;
      for (uint c = loop.firstCorner; c < loop.firstCorner + loop.corners; ++c) {
        points.emplace_back(inPlane(basis, localPosition(pool, form, c)));
      }
      const size_t n = points.size();
      for (size_t i = 0; i < n; ++i) {
        const glm::dvec2 d = points[(i + 1) % n] - points[i];
        const double angle = std::atan2(main.x * d.y - main.y * d.x, main.x * d.x + main.y * d.y);
        const double quarters = std::round(angle / (std::numbers::pi / 2));
        const bool near = std::fabs(angle - quarters * std::numbers::pi / 2) <= degrees / 57.29577951;
        const int turns = int(quarters) & 3;
        const glm::dvec2 side(-main.y, main.x);
        const glm::dvec2 exact = turns == 0 ? main : turns == 1 ? side : turns == 2 ? -main : -side;
        const double length = std::hypot(d.x, d.y);
        directions.push_back(near || !(length > 0) ? exact : d / length);
      }
      beginLoop(pool, b);
      for (size_t i = 0; i < n; ++i) {
        const size_t before = (i + n - 1) % n;
        const glm::dvec2 m0 = (points[before] + points[i]) * 0.5, m1 = (points[i] + points[(i + 1) % n]) * 0.5;
        const glm::dvec2 d0 = directions[before], d1 = directions[i];
        const double sine = d0.x * d1.y - d0.y * d1.x;
        glm::dvec2 p = points[i];
        if (std::fabs(sine) > 0.05) {
          const glm::dvec2 between = m1 - m0;
          p = m0 + d0 * ((between.x * d1.y - between.y * d1.x) / sine);
        } else { // nearly straight: between both lines
          const glm::dvec2 q0 = m0 + d0 * glm::dot(d0, p - m0), q1 = m1 + d1 * glm::dot(d1, p - m1);
          p = (q0 + q1) * 0.5;
        }
        const uint corner = loop.firstCorner + uint(i);
        const vec3 place = fromPlane(basis, vec2(float(p.x), float(p.y)), 0.0f);
        const uint made = addCorner(pool, b, addVertex(pool, b, place), cornerTags(pool, form.mesh, corner));
        copyCornerUv(pool, b, made, form.mesh, corner, corner, 0.0f);
      }
    }
  }
  return attempt.end(finishForm(pool, b, form, true));
}

Status convexify(MeshPool& pool, Form& form) {
  if (form.mesh == 0) return kGeometryOk;
  Attempt attempt(pool);
  // Triangles, joined over their common edges where the corners at both ends stay convex (Hertel, Mehlhorn 1983).
  std::vector<Outlines> faces;
  const std::vector<vec3> positions = positionsOf(pool, form);
  std::vector<uint32_t> itself(positions.size());
  std::iota(itself.begin(), itself.end(), 0u);
  const auto place = [&](uint32_t c) { return positions[cornerVertex(pool, form.mesh, c)]; };
  for (uint f = 0; f < meshFaces(pool, form.mesh); ++f) {
    const vec3 normal = localNormal(pool, form, f);
    std::vector<uint32_t> triangles;
    if (const Status status = triangulateFace(pool, form, f, triangles)) return attempt.end(status);
    std::vector<std::vector<uint32_t>> pieces;
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      pieces.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
    }
    const auto convex = [&](const std::vector<uint32_t>& p) {
      for (size_t i = 0; i < p.size(); ++i) {
        const vec3 a = place(p[i]), q = place(p[(i + 1) % p.size()]), c = place(p[(i + 2) % p.size()]);
        if (inner3(outer3(unit3(q - a), unit3(c - q)), normal) < -1e-5f) return false;
      }
      return true;
    };
    bool joined = true;
    while (joined) {
      joined = false;
      if (!countSteps(pool, pieces.size())) return attempt.end(kGeometryTooLarge);
      for (size_t i = 0; i < pieces.size() && !joined; ++i) {
        for (size_t j = i + 1; j < pieces.size() && !joined; ++j) {
          countSteps(pool, pieces[i].size());
          for (size_t k = 0; k < pieces[i].size() && !joined; ++k) {
            const uint32_t a = pieces[i][k], c = pieces[i][(k + 1) % pieces[i].size()];
            const auto at = std::find(pieces[j].begin(), pieces[j].end(), c);
            if (at == pieces[j].end()) continue;
            const size_t m = size_t(at - pieces[j].begin());
            if (pieces[j][(m + 1) % pieces[j].size()] != a) continue;
            std::vector<uint32_t> both;
            for (size_t s = 1; s <= pieces[i].size(); ++s) {
              both.push_back(pieces[i][(k + s) % pieces[i].size()]);
            }
            for (size_t s = 2; s < pieces[j].size(); ++s) {
              both.push_back(pieces[j][(m + s) % pieces[j].size()]);
            }
            if (!convex(both)) continue;
            pieces[i] = both;
            pieces.erase(pieces.begin() + ptrdiff_t(j));
            joined = true;
          }
        }
      }
    }
    for (auto& p : pieces) {
      faces.push_back({{std::move(p)}, faceOf(pool, form.mesh, f).tags});
    }
  }
  const uint corners = meshCorners(pool, form.mesh);
  Builder b = newBuilder(pool, uint(positions.size()), 3 * corners + 6 * meshLoops(pool, form.mesh), 3 * corners,
                         3 * corners, meshUvSets(pool, form.mesh));
  copyVertices(pool, b, form);
  for (const Outlines& face : faces) {
    beginFace(pool, b, face.tags);
    beginLoop(pool, b);
    for (const uint32_t c : face.loops[0]) {
      const uint made = addCorner(pool, b, cornerVertex(pool, form.mesh, c), 0);
      copyCornerUv(pool, b, made, form.mesh, c, c, 0.0f);
    }
  }
  return attempt.end(finishForm(pool, b, form, false));
}

Status deleteHoles(MeshPool& pool, Form& form) {
  if (form.mesh == 0) return kGeometryOk;
  Attempt attempt(pool);
  std::vector<Outlines> faces = outlinesOf(pool, form.mesh);
  for (Outlines& face : faces) {
    face.loops.resize(1);
  }
  std::vector<uint32_t> itself(meshVertices(pool, form.mesh));
  std::iota(itself.begin(), itself.end(), 0u);
  return attempt.end(rebuild(pool, form, faces, itself, positionsOf(pool, form)));
}

} // namespace gpgp::spawn
