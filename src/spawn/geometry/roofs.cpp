// Roofs of faces: on the straight skeleton, or planes and pyramids.
//
// The plane of a roof's face rises from its edge with the slope of the roof; where a front of the skeleton is at time t
// the roof is t * slope high. A gable is an edge that stays where it is. Overhangs move the outline's points, and
// gables' tips, along their faces' planes.
#include "spawn/geometry/waves.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpgp::spawn {

using namespace shader;

namespace {

double radians(double degrees) { return degrees * (3.14159265358979323846 / 180.0); }
float slopeOf(float degrees) {
  const vec2 sc = sineCosineDegrees(degrees);
  return divide(sc.x, sc.y);
}

struct Edges {
  std::vector<uint32_t> next, previous;
};
/// Neighbours of each of the outline's edges.
Edges neighbours(const Waves& w) {
  Edges e;
  e.next.resize(w.edges.size());
  e.previous.resize(w.edges.size());
  size_t first = 0;
  for (size_t i = 0; i < w.edges.size(); ++i) {
    const bool last = i + 1 == w.edges.size() || w.edges[i + 1].first != w.edges[i].second;
    const size_t to = last ? first : i + 1;
    e.next[i] = uint32_t(to);
    e.previous[to] = uint32_t(i);
    if (last) first = i + 1;
  }
  return e;
}

double edgeLength(const Waves& w, uint32_t e) {
  const glm::dvec2 d(w.edges[e].second - w.edges[e].first);
  return std::hypot(d.x, d.y);
}
/// Unit length, inwards.
glm::dvec2 inwards(const Waves& w, uint32_t e) {
  const glm::dvec2 d(w.edges[e].second - w.edges[e].first);
  const double l = std::hypot(d.x, d.y);
  return {-d.y / l, d.x / l};
}
bool isConvexCorner(const Waves& w, uint32_t before, uint32_t behind) {
  const glm::dvec2 a = inwards(w, before), b = inwards(w, behind);
  return a.x * b.y - a.y * b.x > 1e-6;
}

/// Edges that get a gable: where the skeleton of the whole has a triangle; short ones first, no two neighbours.
std::vector<bool> chooseGables(const Waves& w, const Edges& around, int32_t index) {
  std::vector<bool> gables(w.edges.size());
  std::vector<uint32_t> candidates;
  if (index >= 0) {
    // Ridges along the edge: gables where edges are nearest to a right angle to it, one at each end.
    const glm::dvec2 along = inwards(w, uint32_t(index) % uint32_t(w.edges.size()));
    const glm::dvec2 direction(along.y, -along.x);
    for (const double sign : {1.0, -1.0}) {
      double best = 0.3;
      uint32_t chosen = kNone;
      for (uint32_t e = 0; e < w.edges.size(); ++e) {
        const double facing = sign * glm::dot(inwards(w, e), direction);
        if (facing > best + 1e-6 && isConvexCorner(w, around.previous[e], e) && isConvexCorner(w, e, around.next[e])) {
          best = facing;
          chosen = e;
        }
      }
      if (chosen != kNone) candidates.push_back(chosen);
    }
  } else {
    for (const WaveFace& f : w.faces) {
      const bool convex =
          isConvexCorner(w, around.previous[f.edge], f.edge) && isConvexCorner(w, f.edge, around.next[f.edge]);
      if (f.nodes.size() == 3 && convex) candidates.push_back(f.edge);
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](uint32_t a, uint32_t b) { return edgeLength(w, a) < edgeLength(w, b) * (1 - 1e-5); });
  }
  for (const uint32_t e : candidates) {
    if (!gables[around.previous[e]] && !gables[around.next[e]]) gables[e] = true;
  }
  return gables;
}

/// A roof face's polygon in the outline's plane, with heights.
struct RoofFace {
  uint32_t edge;
  std::vector<glm::dvec3> points;
  std::vector<uint32_t> beside;
  uint32_t tags;
};

class RoofBuilder {
public:
  RoofBuilder(MeshPool& pool, const Form& form, uint32_t face, const RoofOptions& options, Builder& b)
      : pool_(pool), form_(form), face_(face), options_(options), b_(b) {}

  Status build() {
    switch (options_.kind) {
    case Roof::Pyramid: return pyramid();
    case Roof::Shed: return shed();
    default: return sloped();
    }
  }

private:
  MeshPool& pool_;
  const Form& form_;
  uint32_t face_;
  const RoofOptions& options_;
  Builder& b_;
  Waves w_;

  vec3 lifted(glm::dvec3 p) const { return fromPlane(w_.outline.basis, vec2(float(p.x), float(p.y)), float(p.z)); }
  void addBottom() {
    const Face face = faceOf(pool_, form_.mesh, face_);
    beginFace(pool_, b_, face.tags | kTagRoofBottom);
    for (uint l = 0; l < face.loops; ++l) {
      const Loop loop = loopOf(pool_, form_.mesh, face.firstLoop + l);
      beginLoop(pool_, b_);
      for (uint i = loop.corners; i-- > 0;) {
        const uint corner = loop.firstCorner + i;
        addCorner(pool_, b_, addVertex(pool_, b_, localPosition(pool_, form_, corner)),
                  cornerTags(pool_, form_.mesh, previousCorner(loop, corner)));
      }
    }
  }
  void addPolygon(const std::vector<glm::dvec3>& points, uint32_t tags, const std::vector<uint32_t>& edgeTags = {}) {
    beginFace(pool_, b_, tags);
    beginLoop(pool_, b_);
    for (size_t i = 0; i < points.size(); ++i) {
      addCorner(pool_, b_, addVertex(pool_, b_, lifted(points[i])), edgeTags.empty() ? 0u : edgeTags[i]);
    }
  }

  // ------------------------------------------------------------ hips, gables, mansards

  float slope_ = 0, upperSlope_ = 0, break_ = 0;
  double overhangInPlan_ = 0;
  double heightAt(double t) const {
    return break_ > 0 && t > break_ ? double(break_) * slope_ + (t - break_) * upperSlope_ : t * slope_;
  }

  /// Where an outline's corner or a gable's tip is with overhangs. `before` and `behind` are the edges at the corner.
  glm::dvec2 overhung(glm::dvec2 p, uint32_t before, uint32_t behind, const std::vector<bool>& gables) const {
    const glm::dvec2 a = inwards(w_, before), b = inwards(w_, behind);
    const double da = gables[before] ? options_.overhangY : overhangInPlan_;
    const double db = gables[behind] ? options_.overhangY : overhangInPlan_;
    const double det = a.x * b.y - a.y * b.x;
    if (std::fabs(det) < 1e-6) return p - a * std::max(da, db);
    // a . move = -da, b . move = -db
    return p + glm::dvec2((-da * b.y + db * a.y) / det, (-a.x * db + b.x * da) / det);
  }

  uint32_t tagOf(const RoofFace& f, size_t side, const std::vector<bool>& gables) const {
    const glm::dvec3 p = f.points[side], q = f.points[(side + 1) % f.points.size()];
    const uint32_t beside = f.beside[side];
    if (side == 0 && beside == kNone) return gables[f.edge] ? 0u : kTagEave;
    if (beside == kNone || gables[beside] || gables[f.edge]) return 0;
    // Convex where the other plane is above this one's face.
    const glm::dvec2 d(q.x - p.x, q.y - p.y), left(-d.y, d.x);
    const bool convex = glm::dot(inwards(w_, f.edge), left) < glm::dot(inwards(w_, beside), left);
    const double rise = std::fabs(q.z - p.z), run = std::hypot(d.x, d.y);
    if (!convex) return kTagValley;
    return rise <= 1e-4 * run ? kTagRidge : kTagHip;
  }

  Status sloped() {
    const bool mansard = options_.kind == Roof::Mansard;
    Status status = makeWaves(pool_, form_, face_, {}, -1.0f, false, w_);
    if (status) return status;
    const Edges around = neighbours(w_);
    std::vector<bool> gables(w_.edges.size());
    if (options_.kind == Roof::Gable) {
      gables = chooseGables(w_, around, options_.index);
      if (std::find(gables.begin(), gables.end(), true) != gables.end()) {
        std::vector<float> speeds(faceCorners(pool_, form_.mesh, face_).corners, 1.0f);
        const uint first = faceCorners(pool_, form_.mesh, face_).firstCorner;
        for (size_t e = 0; e < gables.size(); ++e) {
          if (gables[e]) speeds[w_.cornerOf[e] - first] = 0.0f;
        }
        status = makeWaves(pool_, form_, face_, speeds, -1.0f, false, w_);
        if (status) return status;
      }
    }
    float latest = 0;
    for (const vec3& n : w_.nodes) {
      latest = std::max(latest, n.z);
    }
    if (mansard) {
      break_ = options_.breakDistance > 0 ? std::min(options_.breakDistance, latest) : 0.3f * latest;
      const float upper = options_.upperAngle > 0 ? options_.upperAngle : options_.value / 3.0f;
      slope_ = options_.byHeight ? 1.0f : slopeOf(options_.value);
      upperSlope_ = options_.byHeight && !(options_.upperAngle > 0) ? 0.35f : slopeOf(upper);
      if (options_.byHeight) {
        const float factor = options_.value / float(heightAt(latest));
        slope_ *= factor;
        upperSlope_ *= factor;
      }
      status = makeWaves(pool_, form_, face_, {}, break_, false, w_);
      if (status) return status;
    } else {
      slope_ = options_.byHeight ? divide(options_.value, latest) : slopeOf(options_.value);
    }
    overhangInPlan_ = options_.overhangX * std::cos(std::atan(double(slope_)));
    addBottom();

    // Positions of nodes: on the solid, and with overhangs.
    std::vector<glm::dvec3> solid, sheet;
    for (const vec3& n : w_.nodes) {
      solid.emplace_back(n.x, n.y, heightAt(n.z));
    }
    if (options_.even && options_.kind == Roof::Gable)
      for (const WaveFace& f : w_.faces) {
        for (const uint32_t n : f.nodes) {
          if (gables[f.edge] && w_.nodes[n].z > 0) solid[n].z = heightAt(latest);
        }
      }
    sheet = solid;
    const bool overhangs = options_.overhangX > 0 || options_.overhangY > 0;
    for (uint32_t e = 0; overhangs && e < w_.edges.size(); ++e) {
      const glm::dvec2 p(w_.edges[e].first);
      const uint32_t before = around.previous[e];
      const glm::dvec2 q = overhung(p, before, e, gables);
      const uint32_t eave = gables[e] ? before : e;
      const double down = gables[e] && gables[before] ? 0.0 : -glm::dot(inwards(w_, eave), q - p);
      sheet[e] = glm::dvec3(q.x, q.y, -down * slope_);
    }
    // A gable's tip moves along the line in which the planes beside it meet.
    for (const WaveFace& f : w_.faces) {
      if (!overhangs || !gables[f.edge]) continue;
      const glm::dvec2 out = -inwards(w_, f.edge);
      for (size_t i = 2; i < f.nodes.size(); ++i) {
        const uint32_t before = f.beside[i - 1], behind = f.beside[i];
        if (f.nodes[i] < w_.edges.size() || before == kNone || behind == kNone) continue;
        const glm::dvec2 a = inwards(w_, before), b = inwards(w_, behind), along(a - b);
        // In plan the line is at right angles to the difference of the normals.
        glm::dvec2 ridge(-along.y, along.x);
        const double rate = glm::dot(ridge, out);
        if (std::fabs(rate) < 1e-9) continue;
        const glm::dvec2 move = ridge * (double(options_.overhangY) / rate);
        const double rise = before == behind ? 0.0 : glm::dot(a, move) * slope_;
        sheet[f.nodes[i]] += glm::dvec3(move.x, move.y, rise);
      }
    }
    for (const WaveFace& f : w_.faces) {
      addRoofFace({f.edge, {}, f.beside, gables[f.edge] ? kTagRoofSide : kTagRoofTop}, f,
                  gables[f.edge] ? solid : sheet, gables);
    }
    return mansard ? addUpper() : b_.status;
  }

  void addRoofFace(RoofFace face, const WaveFace& f, const std::vector<glm::dvec3>& nodes,
                   const std::vector<bool>& gables) {
    for (const uint32_t n : f.nodes) {
      face.points.push_back(nodes[n]);
    }
    std::vector<uint32_t> tags;
    for (size_t i = 0; i < face.points.size(); ++i) {
      tags.push_back(tagOf(face, i, gables));
    }
    addPolygon(face.points, face.tags, tags);
  }

  /// Above a mansard's break: a hip roof on each polygon of the wavefront there.
  Status addUpper() {
    const Waves lower = w_;
    const float base = multiply(break_, slope_);
    Form front{form_.scope, vec3(1.0f), 0};
    uint corners = 0;
    for (const auto& loop : lower.fronts) {
      corners += uint(loop.size());
    }
    Builder flat = newBuilder(pool_, corners, corners, uint(lower.fronts.size()), uint(lower.fronts.size()), 0);
    addLoops(pool_, flat, lower.outline.basis, lower.fronts, 0.0f, false, 0, 0);
    const uint32_t used = pool_.used;
    Status status = finishForm(pool_, flat, front, false);
    for (uint f = 0; f < meshFaces(pool_, front.mesh) && !status; ++f) {
      status = makeWaves(pool_, front, f, {}, -1.0f, false, w_);
      if (status) break;
      std::vector<glm::dvec3> nodes;
      for (const vec3& n : w_.nodes) {
        nodes.emplace_back(n.x, n.y, double(base) + double(n.z) * upperSlope_);
      }
      const std::vector<bool> none(w_.edges.size());
      for (const WaveFace& face : w_.faces) {
        addRoofFace({face.edge, {}, face.beside, kTagRoofTop}, face, nodes, none);
      }
    }
    pool_.used = used; // the front is not part of the roof
    return status == kGeometryEmpty ? kGeometryOk : status;
  }

  // ------------------------------------------------------------ pyramids and sheds

  /// The outline, without propagation.
  Status outline() { return makeWaves(pool_, form_, face_, {}, 0.0f, false, w_); }

  Status pyramid() {
    if (const Status status = outline()) return status;
    double area = 0;
    glm::dvec2 moment{};
    for (const auto& [first, second] : w_.edges) {
      const glm::dvec2 a(first), b(second);
      const double twice = a.x * b.y - a.y * b.x;
      area += twice;
      moment += twice * (a + b) / 3.0;
    }
    const glm::dvec2 apex = moment / area;
    double nearest = 1e300;
    for (uint32_t e = 0; e < w_.edges.size(); ++e) {
      nearest = std::min(nearest, std::fabs(glm::dot(inwards(w_, e), apex - glm::dvec2(w_.edges[e].first))));
    }
    const double height = options_.byHeight ? options_.value : std::tan(radians(options_.value)) * nearest;
    addBottom();
    const Edges around = neighbours(w_);
    const auto foot = [&](uint32_t e) {
      const glm::dvec2 p(w_.edges[e].first);
      if (!(options_.overhangX > 0)) return glm::dvec3(p.x, p.y, 0.0);
      // Down the line from the apex, by as much as the nearer of both faces asks for.
      double part = 0;
      for (const uint32_t side : {e, around.previous[e]}) {
        const double run = glm::dot(inwards(w_, side), apex - glm::dvec2(w_.edges[side].first));
        const double slant = std::hypot(run, height);
        if (slant > 0) part = std::max(part, options_.overhangX / slant);
      }
      return glm::dvec3(p.x + (p.x - apex.x) * part, p.y + (p.y - apex.y) * part, -height * part);
    };
    for (uint32_t e = 0; e < w_.edges.size(); ++e) {
      addPolygon({foot(e), foot(around.next[e]), glm::dvec3(apex.x, apex.y, height)}, kTagRoofTop,
                 {kTagEave, kTagHip, kTagHip});
    }
    return b_.status;
  }

  Status shed() {
    if (const Status status = outline()) return status;
    const uint32_t count = uint32_t(w_.edges.size());
    const uint32_t eave = uint32_t(std::max(options_.index, 0)) % count;
    const glm::dvec2 n = inwards(w_, eave), origin(w_.edges[eave].first);
    double low = 1e300, high = -1e300;
    for (const auto& e : w_.edges) {
      const double d = glm::dot(n, glm::dvec2(e.first) - origin);
      low = std::min(low, d);
      high = std::max(high, d);
    }
    const double slope = options_.byHeight ? options_.value / (high - low) : std::tan(radians(options_.value));
    const double flat = 1e-5 * (high - low); // no wall lower than what counts as one place
    const auto at = [&](glm::dvec2 p) {
      const double d = glm::dot(n, p - origin) - low;
      return glm::dvec3(p.x, p.y, d <= flat ? 0.0 : d * slope);
    };
    addBottom();
    // The top: the outline's loops on the plane, the eave first.
    overhangInPlan_ = options_.overhangX * std::cos(std::atan(slope));
    const Edges around = neighbours(w_);
    std::vector<bool> sides(count, true);
    for (uint32_t e = 0; e < count; ++e) {
      // Overhangs along the slope where edges are level, else beside.
      sides[e] = std::fabs(glm::dot(inwards(w_, e), n)) < 0.5;
    }
    const bool overhangs = options_.overhangX > 0 || options_.overhangY > 0;
    const auto roofPoint = [&](uint32_t e) {
      const glm::dvec2 p(w_.edges[e].first);
      if (!overhangs) return at(p);
      const glm::dvec2 q = overhung(p, around.previous[e], e, sides);
      return glm::dvec3(q.x, q.y, (glm::dot(n, q - origin) - low) * slope);
    };
    beginFace(pool_, b_, kTagRoofTop);
    std::vector<bool> seen(count);
    for (uint32_t turn = 0; turn < count; ++turn) {
      uint32_t e = (eave + turn) % count;
      // The loop of the eave first: the outer one where it is of it, else the outer one follows its holes.
      if (seen[e]) continue;
      beginLoop(pool_, b_);
      while (!seen[e]) {
        seen[e] = true;
        addCorner(pool_, b_, addVertex(pool_, b_, lifted(roofPoint(e))), e == eave ? kTagEave : 0u);
        e = around.next[e];
      }
    }
    for (uint32_t e = 0; e < count; ++e) {
      const glm::dvec2 a(w_.edges[e].first), b(w_.edges[e].second);
      const glm::dvec3 ta = at(a), tb = at(b);
      std::vector<glm::dvec3> points{{a.x, a.y, 0}, {b.x, b.y, 0}};
      if (tb.z > 0) points.push_back(tb);
      if (ta.z > 0) points.push_back(ta);
      if (points.size() >= 3) addPolygon(points, kTagRoofSide);
    }
    return b_.status;
  }
};

} // namespace

Status roof(MeshPool& pool, Form& form, const RoofOptions& o) {
  if (!std::isfinite(o.value) || !(o.value > 0) || (!o.byHeight && o.value >= 90) || !(o.overhangX >= 0) ||
      !(o.overhangY >= 0) || !std::isfinite(o.overhangX) || !std::isfinite(o.overhangY) || !(o.upperAngle >= 0) ||
      o.upperAngle >= 90 || !(o.breakDistance >= 0))
    return kGeometryBadArgument;
  Attempt attempt(pool);
  const uint faces = meshFaces(pool, form.mesh), corners = meshCorners(pool, form.mesh);
  if (faces == 0) return attempt.end(kGeometryEmpty);
  Form made = form;
  Builder b = newBuilder(pool, 40 * corners + 64, 40 * corners + 64, 6 * corners + 16, 6 * corners + 16, 0);
  for (uint f = 0; f < faces; ++f) {
    RoofBuilder builder(pool, form, f, o, b);
    if (const Status status = builder.build()) return attempt.end(status);
  }
  Status status = finishForm(pool, b, made, true);
  if (status == kGeometryOk) {
    // y along the first face's normal, x as it was.
    const vec3 y = faceNormal(pool, form, 0);
    const vec3 x = along3(form.scope.axisX, y, -inner3(form.scope.axisX, y));
    const vec3 start = inner3(x, x) > 1e-6f ? x : form.scope.axisY;
    const vec3 xAxis = unit3(along3(start, y, -inner3(start, y)));
    if (inner3(y, made.scope.axisY) < 1.0f - 1e-6f) status = alignScope(pool, made, Axes{xAxis, y, outer3(xAxis, y)});
  }
  if (status <= kGeometryEmpty) form = made;
  return attempt.end(status);
}

} // namespace gpgp::spawn
