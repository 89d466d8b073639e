#include "vector/import/lottie/path.h"

#include <algorithm>
#include <cmath>

namespace gpgp::vector::lottie {
namespace {
constexpr double kPi = 3.14159265358979323846;
constexpr double kQuarter = 0.5522847498307936; ///< of a quarter circle's radius: how long its tangents are

Point mix(Point a, Point b, double t) { return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; }
bool same(Point a, Point b) { return a.x == b.x && a.y == b.y; }
/// Left of (before) and right of (behind) the parameter.
std::array<std::array<Point, 4>, 2> split(const std::array<Point, 4>& c, double t) {
  const Point a = mix(c[0], c[1], t), b = mix(c[1], c[2], t), d = mix(c[2], c[3], t);
  const Point ab = mix(a, b, t), bd = mix(b, d, t), m = mix(ab, bd, t);
  return {{{c[0], a, ab, m}, {m, bd, d, c[3]}}};
}
void reverse(Contour& contour) {
  std::reverse(contour.vertices.begin(), contour.vertices.end());
  for (Contour::Vertex& v : contour.vertices) std::swap(v.in, v.out);
  if (contour.closed && !contour.vertices.empty()) // begins where it did
    std::rotate(contour.vertices.begin(), contour.vertices.end() - 1, contour.vertices.end());
}
void addPiece(const std::array<Point, 4>& c, Contour& to) {
  if (to.vertices.empty()) to.vertices.push_back({c[0], c[0], c[0]});
  to.vertices.back().out = c[1];
  to.vertices.push_back({c[3], c[2], c[3]});
}
} // namespace

double Contour::length() const {
  double sum = 0;
  for (size_t i = 0; i < segments(); ++i) sum += lengthOfCubic(segment(i));
  return sum;
}

Contour contourOf(const std::vector<double>& n, bool closed) {
  Contour contour;
  contour.closed = closed;
  for (size_t i = 0; i + 5 < n.size(); i += 6)
    contour.vertices.push_back(
        {{n[i], n[i + 1]}, {n[i] + n[i + 2], n[i + 1] + n[i + 3]}, {n[i] + n[i + 4], n[i + 1] + n[i + 5]}});
  return contour;
}

Contour rectangleOf(Point p, Point size, double radius, bool backwards) {
  const double w = size.x / 2, h = size.y / 2;
  const double r = std::clamp(radius, 0.0, std::min(std::fabs(w), std::fabs(h))), k = r * (1 - kQuarter);
  const double l = p.x - w, t = p.y - h, e = p.x + w, b = p.y + h;
  Contour c;
  c.closed = true;
  if (r == 0) {
    for (const Point q : {Point{e, t}, Point{e, b}, Point{l, b}, Point{l, t}}) c.vertices.push_back({q, q, q});
  } else {
    const auto add = [&](Point at, Point in, Point out) { c.vertices.push_back({at, in, out}); };
    add({e, t + r}, {e, t + k}, {e, t + r});
    add({e, b - r}, {e, b - r}, {e, b - k});
    add({e - r, b}, {e - k, b}, {e - r, b});
    add({l + r, b}, {l + r, b}, {l + k, b});
    add({l, b - r}, {l, b - k}, {l, b - r});
    add({l, t + r}, {l, t + r}, {l, t + k});
    add({l + r, t}, {l + k, t}, {l + r, t});
    add({e - r, t}, {e - r, t}, {e - k, t});
  }
  if (backwards) reverse(c);
  return c;
}

Contour ellipseOf(Point p, Point size, bool backwards) {
  const double a = size.x / 2, b = size.y / 2, ka = a * kQuarter, kb = b * kQuarter;
  Contour c;
  c.closed = true;
  c.vertices = {{{p.x, p.y - b}, {p.x - ka, p.y - b}, {p.x + ka, p.y - b}},
                {{p.x + a, p.y}, {p.x + a, p.y - kb}, {p.x + a, p.y + kb}},
                {{p.x, p.y + b}, {p.x + ka, p.y + b}, {p.x - ka, p.y + b}},
                {{p.x - a, p.y}, {p.x - a, p.y + kb}, {p.x - a, p.y - kb}}};
  if (backwards) reverse(c);
  return c;
}

Contour starOf(const Star& s) {
  Contour c;
  c.closed = true;
  const auto corners = static_cast<int>(std::clamp(std::floor(s.points), 0.0, 10000.0));
  const int count = s.polygon ? corners : 2 * corners;
  // Tangents are a quarter (of a polygon) or half (of a star) of the part of the perimeter that a corner has.
  for (int i = 0; i < count; ++i) {
    const bool inner = !s.polygon && i % 2;
    const double radius = inner ? s.innerRadius : s.outerRadius;
    const double round = (inner ? s.innerRoundness : s.outerRoundness) / 100;
    const double angle = -kPi / 2 + s.rotation * kPi / 180 + 2 * kPi * i / count;
    const double tangent = radius * round * 2 * kPi / (count * (s.polygon ? 4 : 2));
    const Point at{s.center.x + radius * std::cos(angle), s.center.y + radius * std::sin(angle)};
    const Point along{-std::sin(angle) * tangent, std::cos(angle) * tangent};
    c.vertices.push_back({at, {at.x - along.x, at.y - along.y}, {at.x + along.x, at.y + along.y}});
  }
  if (s.backwards) reverse(c);
  return c;
}

Contour trimmed(const Contour& contour, double start, double end) {
  if (start <= 0 && end >= 1) return contour;
  Contour result;
  const size_t count = contour.segments();
  std::vector<double> lengths(count);
  double whole = 0;
  for (size_t i = 0; i < count; ++i) whole += lengths[i] = lengthOfCubic(contour.segment(i));
  const double from = start * whole, to = end * whole;
  if (!(to > from)) return result;
  double before = 0;
  for (size_t i = 0; i < count; before += lengths[i], ++i) {
    const double low = from - before, high = to - before;
    if (high <= 0 || low >= lengths[i] || lengths[i] == 0) continue;
    std::array<Point, 4> c = contour.segment(i);
    const double t1 = high < lengths[i] ? parameterAt(c, high) : 1, t0 = low > 0 ? parameterAt(c, low) : 0;
    if (t1 < 1) c = split(c, t1)[0];
    if (t0 > 0 && t1 > 0) c = split(c, t0 / t1)[1];
    addPiece(c, result);
  }
  return result;
}

std::vector<Contour> trimmedAround(const Contour& contour, double start, double end) {
  if (end - start >= 1) return {contour};
  std::vector<Contour> pieces;
  const auto add = [&pieces](Contour c) {
    if (!c.vertices.empty()) pieces.push_back(std::move(c));
  };
  if (end <= 1) {
    add(trimmed(contour, start, end));
    return pieces;
  }
  add(trimmed(contour, start, 1));
  Contour rest = trimmed(contour, 0, end - 1);
  if (contour.closed && !pieces.empty() && !rest.vertices.empty()) {
    pieces[0].vertices.back().out = rest.vertices[0].out;
    pieces[0].vertices.insert(pieces[0].vertices.end(), rest.vertices.begin() + 1, rest.vertices.end());
  } else {
    add(std::move(rest));
  }
  return pieces;
}

Contour roundedCorners(const Contour& contour, double radius) {
  const size_t count = contour.vertices.size();
  if (!(radius > 0) || count < 3) return contour;
  Contour result;
  result.closed = contour.closed;
  for (size_t i = 0; i < count; ++i) {
    const Contour::Vertex& v = contour.vertices[i];
    const bool end = !contour.closed && (i == 0 || i + 1 == count);
    if (end || !same(v.at, v.in) || !same(v.at, v.out)) {
      result.vertices.push_back(v);
      continue;
    }
    const Point before = contour.vertices[(i + count - 1) % count].at, after = contour.vertices[(i + 1) % count].at;
    const auto towards = [&](Point q) { // no further than half of the way
      const double d = std::hypot(q.x - v.at.x, q.y - v.at.y);
      return d > 0 ? mix(v.at, q, std::min(d / 2, radius) / d) : v.at;
    };
    const Point a = towards(before), b = towards(after);
    result.vertices.push_back({a, a, mix(a, v.at, kQuarter)});
    result.vertices.push_back({b, mix(b, v.at, kQuarter), b});
  }
  return result;
}

Contour puckered(const Contour& contour, double amount) {
  Contour result = contour;
  Point mean{0, 0};
  for (const Contour::Vertex& v : contour.vertices) mean.x += v.at.x, mean.y += v.at.y;
  const auto count = static_cast<double>(std::max<size_t>(contour.vertices.size(), 1));
  mean = {mean.x / count, mean.y / count};
  const double part = amount / 100;
  for (Contour::Vertex& v : result.vertices) {
    v.at = mix(v.at, mean, part);
    v.in = mix(v.in, mean, -part);
    v.out = mix(v.out, mean, -part);
  }
  return result;
}

Contour twisted(const Contour& contour, double degrees, Point center) {
  Contour result = contour;
  double reach = 0;
  for (const Contour::Vertex& v : contour.vertices)
    reach = std::max(reach, std::hypot(v.at.x - center.x, v.at.y - center.y));
  if (!(reach > 0)) return result;
  const auto turn = [&](Point p) {
    const double x = p.x - center.x, y = p.y - center.y, d = std::hypot(x, y);
    const double angle = degrees * kPi / 180 * (1 - d / reach), c = std::cos(angle), s = std::sin(angle);
    return Point{center.x + c * x - s * y, center.y + s * x + c * y};
  };
  for (Contour::Vertex& v : result.vertices) v = {turn(v.at), turn(v.in), turn(v.out)};
  return result;
}

Contour zigzagged(const Contour& contour, double amplitude, double ridges, bool smooth) {
  Contour result;
  result.closed = contour.closed;
  const int steps = 1 + static_cast<int>(std::clamp(std::floor(ridges), 0.0, 1000.0));
  const size_t count = contour.segments();
  double side = 1;
  const auto wayAt = [](const std::array<Point, 4>& c, double t) { // of length 1, or 0 where there is none
    const Point a = pointOfCubic(c, std::max(t - 1e-4, 0.0)), b = pointOfCubic(c, std::min(t + 1e-4, 1.0));
    const double l = std::hypot(b.x - a.x, b.y - a.y);
    return l > 0 ? Point{(b.x - a.x) / l, (b.y - a.y) / l} : Point{0, 0};
  };
  const auto add = [&](Point p, Point way, double before, double behind) {
    const double l = std::hypot(way.x, way.y);
    const Point d = l > 1e-9 ? Point{way.x / l, way.y / l} : Point{1, 0};
    const Point at{p.x - d.y * amplitude * side, p.y + d.x * amplitude * side};
    const double in = smooth ? before / 2 : 0, out = smooth ? behind / 2 : 0;
    result.vertices.push_back({at, {at.x - d.x * in, at.y - d.y * in}, {at.x + d.x * out, at.y + d.y * out}});
    side = -side;
  };
  double before = count && contour.closed ? lengthOfCubic(contour.segment(count - 1)) / steps : 0;
  for (size_t i = 0; i < count; ++i) {
    const std::array<Point, 4> c = contour.segment(i);
    const double length = lengthOfCubic(c);
    for (int k = 0; k < steps; ++k) {
      const double t = parameterAt(c, length * k / steps), step = length / steps;
      Point way = wayAt(c, t);
      if (k == 0 && (i > 0 || contour.closed)) // halfway between both sides of a corner
        way = way + wayAt(contour.segment((i + count - 1) % count), 1);
      add(pointOfCubic(c, t), way, before, step);
      before = step;
    }
    if (i + 1 == count && !contour.closed) add(c[3], wayAt(c, 1), before, 0);
  }
  return result;
}

Contour mapped(const Contour& contour, const Affine& map) {
  Contour result = contour;
  for (Contour::Vertex& v : result.vertices) v = {map(v.at), map(v.in), map(v.out)};
  return result;
}

void append(const Contour& contour, const Affine& map, Shape& shape) {
  if (contour.vertices.empty()) return;
  shape.move(map(contour.vertices[0].at));
  for (size_t i = 0; i < contour.segments(); ++i) {
    const std::array<Point, 4> c = contour.segment(i);
    if (same(c[0], c[1]) && same(c[2], c[3])) {
      if (!contour.closed || i + 1 < contour.segments()) shape.line(map(c[3])); // closing does the last one
    } else {
      shape.cubic(map(c[1]), map(c[2]), map(c[3]));
    }
  }
  if (contour.closed) shape.close();
}

} // namespace gpgp::vector::lottie
