// The implicit forms of curves: lines, conics (quadratic Béziers and arcs) and cubics by type.
//
// A cubic's form is k^3 - l m, where along the curve k, l and m are products of linear factors of its parameter that
// vanish at its inflections (serpentine, cusp) or where it meets itself (loop); Loop and Blinn 2005. Each of them is
// linear in x and y. It is kept as a polynomial around the curve's start: G(x, y) + Q(x, y) + K(x, y)^3, where G and K
// are linear and Q is quadratic, for k^3 and l m are almost equal where the curve is almost a parabola. The form is
// zero on the whole continuation of the curve, so what is made here is checked: at
// points beside the curve and in the triangle between it and its tangents, in the shader's own arithmetic.
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace gpgp::vector {
namespace {
using shader::PatchReader;

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double exact(float v) { return static_cast<double>(v); }
float rounded(double v) {
  const volatile float f = static_cast<float>(v); // g++ 12 may drop the rounding of a pair that becomes double again
  return f;
}

/// A piece of a curve whose ends are floats; controls from the start.
struct Piece {
  float x0, y0, x1, y1;
  Point c1, c2, end; // from the start
};

Piece pieceOf(float x0, float y0, float x1, float y1, Point c1, Point c2) {
  return {x0, y0, x1, y1, c1, c2, {exact(x1) - exact(x0), exact(y1) - exact(y0)}};
}

FormCurve curveOf(const Piece& p, uint32_t kind) {
  FormCurve c;
  c.kind = kind;
  c.x0 = p.x0, c.y0 = p.y0, c.x1 = p.x1, c.y1 = p.y1;
  return c;
}

/// Into the box of the ends, where rounding has left it.
Point intoBox(Point p, Point end) {
  return {std::clamp(p.x, std::min(0.0, end.x), std::max(0.0, end.x)), std::clamp(p.y, 0.0, end.y)};
}

FormCurve conicOf(const Piece& p, Point control, double weight) {
  FormCurve c = curveOf(p, PatchReader::kPatchConic);
  control = intoBox(control, p.end);
  c.control[0] = rounded(control.x), c.control[1] = rounded(control.y);
  c.weight = rounded(weight);
  return c;
}

struct Polynomial { // in t
  double c[4] = {};
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial product;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; i + k < 4; ++k) product.c[i + k] += a.c[i] * b.c[k];
    return product;
  }
};

/// The two roots of a t^2 + b t + c as linear factors, each of length 1; real ones.
std::array<Polynomial, 2> factors(double a, double b, double c) {
  const double root = std::sqrt(std::max(b * b - 4 * a * c, 0.0)), q = -0.5 * (b + std::copysign(root, b));
  const auto factor = [](double t, double s) { // s t - t0
    const double length = std::hypot(t, s);
    return length > 0 ? Polynomial{{-t / length, s / length}} : Polynomial{{1}};
  };
  return {factor(q, a), factor(c, q)};
}

struct CubicForm {
  FormCurve curve;
  CubicType type;
};

/// k^3 - l m, in the double precision of the making; nothing where the curve is no proper cubic.
std::optional<CubicForm> cubicForm(const Piece& p) {
  const double size = std::max(std::abs(p.end.x), p.end.y);
  if (!(size > 0)) return std::nullopt;
  const Point c1 = (1 / size) * p.c1, c2 = (1 / size) * p.c2, e = (1 / size) * p.end;
  const Point a[3] = {3 * c1, 3 * (c2 - 2 * c1), e - 3 * c2 + 3 * c1}; // of t, t^2, t^3
  const double c12 = cross(a[0], a[1]), c13 = cross(a[0], a[2]), c23 = cross(a[1], a[2]);
  const double discriminant = 9 * c13 * c13 - 12 * c12 * c23;
  const double scale = 9 * c13 * c13 + 12 * std::abs(c12 * c23);
  if (!(scale > 0)) return std::nullopt;
  CubicForm made{curveOf(p, PatchReader::kPatchCubic), CubicType::cusp};
  Polynomial forms[3];
  if (discriminant >= 0) { // also a cusp, whose inflections are one
    made.type = discriminant > 1e-12 * scale ? CubicType::serpentine : CubicType::cusp;
    const auto [l, m] = factors(3 * c23, 3 * c13, c12);
    forms[0] = l * m, forms[1] = l * l * l, forms[2] = m * m * m;
  } else {
    made.type = CubicType::loop; // c23 is not 0
    const auto [l, m] = factors(c23 * c23, c13 * c23, c13 * c13 - c12 * c23);
    forms[0] = l * m, forms[1] = l * l * m, forms[2] = l * m * m;
  }
  // The linear function of the plane that the polynomial is along the curve, from the two rows that are most apart.
  const int rows[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  const double apart[3] = {std::abs(c12), std::abs(c13), std::abs(c23)};
  const int* row = rows[std::max_element(apart, apart + 3) - apart];
  double linear[3][3];
  for (int f = 0; f < 3; ++f) {
    const Point u = a[row[0]], v = a[row[1]];
    const double p1 = forms[f].c[1 + row[0]], p2 = forms[f].c[1 + row[1]], d = cross(u, v);
    linear[f][0] = (p1 * v.y - p2 * u.y) / d;
    linear[f][1] = (u.x * p2 - v.x * p1) / d;
    linear[f][2] = forms[f].c[0];
  }
  // Around the start, where k^3 is l m, in powers of x and y: what cancels has gone before it is rounded to floats.
  const auto &k = linear[0], &l = linear[1], &m = linear[2];
  double form[7] = {3 * k[2] * k[2] * k[0] - l[2] * m[0] - m[2] * l[0],
                    3 * k[2] * k[2] * k[1] - l[2] * m[1] - m[2] * l[1],
                    3 * k[2] * k[0] * k[0] - l[0] * m[0],
                    6 * k[2] * k[0] * k[1] - l[0] * m[1] - l[1] * m[0],
                    3 * k[2] * k[1] * k[1] - l[1] * m[1],
                    k[0],
                    k[1]};
  const auto value = [&](Point q) {
    const double cube = form[5] * q.x + form[6] * q.y;
    return form[0] * q.x + form[1] * q.y + (form[2] * q.x + form[3] * q.y) * q.x + form[4] * q.y * q.y +
           cube * cube * cube;
  };
  // Negative between the curve and its chord, and neither huge nor tiny.
  const Point middle = 0.375 * (c1 + c2) + 0.125 * e;
  double factor = value(0.5 * (middle + 0.5 * e)) > 0 ? -1 : 1;
  factor /= std::max(std::hypot(form[0], form[1]), 1e-3 * std::hypot(form[2], form[3], form[4]));
  if (!std::isfinite(factor)) return std::nullopt;
  for (int i = 0; i < 7; ++i)
    made.curve.form[i] = rounded(form[i] * (i < 2   ? factor / size
                                            : i < 5 ? factor / (size * size)
                                                    : std::cbrt(factor) / size));
  made.curve.control[0] = rounded(p.c1.x), made.curve.control[1] = rounded(p.c1.y);
  made.curve.control2[0] = rounded(p.c2.x), made.curve.control2[1] = rounded(p.c2.y);
  return made;
}

/// Whether the form says, beside the curve and in the triangle around it, on which side points lie.
bool tellsSides(const Piece& p, const FormCurve& curve) {
  const float* f = curve.form;
  const shader::uvec4 words[4] = {{},
                                  {},
                                  std::bit_cast<shader::uvec4>(shader::vec4(f[0], f[1], f[2], f[3])),
                                  std::bit_cast<shader::uvec4>(shader::vec4(f[4], f[5], f[6], 0))};
  PatchReader reader(words);
  PatchReader::GpgpPatchCurve c{};
  c.end = {curve.x1 - curve.x0, curve.y1 - curve.y0};
  c.control = {curve.control[0], curve.control[1]};
  c.control2 = {curve.control2[0], curve.control2[1]};
  const double size = std::max(std::abs(p.end.x), p.end.y), slack = 2e-6 * size;
  const auto right = [&](Point q) {
    return reader.gpgpRightOf(0, 0, PatchReader::kPatchCubic << PatchReader::kPatchCurveKind, c,
                              {rounded(q.x), rounded(q.y)});
  };
  const auto at = [&](double t) {
    const double u = 1 - t;
    return 3 * u * u * t * p.c1 + 3 * u * t * t * p.c2 + t * t * t * p.end;
  };
  constexpr int kBeside = 24, kRows = 16, kInRow = 8;
  for (int i = 1; i < kBeside; ++i) {
    const double t = double(i) / kBeside, u = 1 - t;
    const Point q = at(t);
    Point n = u * u * p.c1 + 2 * u * t * (p.c2 - p.c1) + t * t * (p.end - p.c2); // along it
    const double length = std::hypot(n.x, n.y);
    if (!(length > 0)) return false;
    n = Point{n.y / length, -n.x / length}; // to the right
    for (const double away : {slack, 16 * slack}) {
      const Point a = q + away * n, b = q - away * n;
      if (a.y >= 0 && a.y <= p.end.y && !right(a)) return false;
      if (b.y >= 0 && b.y <= p.end.y && right(b)) return false;
    }
  }
  // Rows of points from the chord to the tangents' side of the box.
  double t = 0;
  for (int i = 1; i < kRows; ++i) {
    const double y = p.end.y * i / kRows;
    double low = t, high = 1;
    for (int k = 0; k < 40; ++k) (at(t = 0.5 * (low + high)).y < y ? low : high) = t;
    const double x = at(t).x;
    for (int k = 0; k <= kInRow; ++k) {
      const double q = p.end.x * k / kInRow;
      if (std::abs(q - x) > 16 * slack && right({q, y}) != (q > x)) return false;
    }
  }
  return true;
}

void appendCubic(const Piece& source, int depth, std::pmr::vector<FormCurve>& forms,
                 std::pmr::vector<CubicType>* types) {
  Piece p = source;
  const double size = std::max(std::abs(p.end.x), p.end.y);
  // A control on its end gives no tangent, whatever rounding has left of it.
  if (std::hypot(p.c1.x, p.c1.y) <= 1e-6 * size) p.c1 = {};
  if (std::hypot(p.end.x - p.c2.x, p.end.y - p.c2.y) <= 1e-6 * size) p.c2 = p.end;
  const auto offChord = [&](Point q) { return std::abs(cross(q, p.end)) / std::hypot(p.end.x, p.end.y); };
  if (p.end.x == 0 || std::max(offChord(p.c1), offChord(p.c2)) <= 1e-7 * size) {
    forms.push_back(curveOf(p, PatchReader::kPatchLine));
    return;
  }
  const auto split = [&](double t) {
    const Cubic whole{{{}, p.c1, p.c2, p.end}}, upper = whole.part(0, t), lower = whole.part(t, 1);
    const float x = rounded(exact(p.x0) + upper.p[3].x), y = rounded(exact(p.y0) + upper.p[3].y);
    const bool within = x >= std::min(p.x0, p.x1) && x <= std::max(p.x0, p.x1);
    if (!(y > p.y0 && y < p.y1 && within)) return false;
    const Piece first = pieceOf(p.x0, p.y0, x, y, upper.p[1], upper.p[2]);
    const Piece second = pieceOf(x, y, p.x1, p.y1, lower.p[1] - lower.p[0], lower.p[2] - lower.p[0]);
    appendCubic(first, depth + 1, forms, types);
    appendCubic(second, depth + 1, forms, types);
    return true;
  };
  // Where it changes from bending left to bending right it is cut.
  constexpr int kDeepest = 8;
  const Point a1 = 3 * p.c1, a2 = 3 * (p.c2 - 2 * p.c1), a3 = p.end - 3 * p.c2 + 3 * p.c1;
  double roots[2];
  const int inflections = rootsInside(3 * cross(a2, a3), 3 * cross(a1, a3), cross(a1, a2), roots);
  for (int i = 0; i < inflections; ++i)
    if (roots[i] > 1e-3 && roots[i] < 1 - 1e-3 && depth < kDeepest && split(roots[i])) return;
  const Point parabola = 0.75 * (p.c1 + p.c2) - 0.25 * p.end;
  const Point third = p.end - 3 * p.c2 + 3 * p.c1;
  if (std::hypot(third.x, third.y) * 0.0481125224 <= 1e-7 * size) {
    forms.push_back(conicOf(p, parabola, 1));
    return;
  }
  if (const auto made = cubicForm(p); made && tellsSides(p, made->curve)) {
    forms.push_back(made->curve);
    if (types) types->push_back(made->type);
    return;
  }
  if (depth < kDeepest && split(0.5)) return;
  forms.push_back(conicOf(p, parabola, 1)); // so short that no float tells it from the parabola
}

} // namespace

std::optional<FormCurve> joinArcs(const FormCurve& first, const FormCurve& second) {
  for (const FormCurve* arc : {&first, &second})
    if (arc->kind != PatchReader::kPatchConic || !(arc->weight < 1)) return std::nullopt;
  if (first.x1 != second.x0 || first.y1 != second.y0) return std::nullopt;
  const auto from = [&](float x, float y) { return Point{exact(x) - exact(first.x0), exact(y) - exact(first.y0)}; };
  const Point c1{exact(first.control[0]), exact(first.control[1])}, met = from(first.x1, first.y1);
  const Point c2 = met + Point{exact(second.control[0]), exact(second.control[1])}, end = from(second.x1, second.y1);
  const Point tangent = end - c2;
  const double turn = cross(c1, tangent);
  if (!(std::abs(turn) > 1e-3 * std::hypot(c1.x, c1.y) * std::hypot(tangent.x, tangent.y))) return std::nullopt;
  const Point control = (cross(end, tangent) / turn) * c1;
  const double size = std::max(std::abs(end.x), end.y);
  const double slack = 3e-7 * std::max({std::abs(exact(first.x0)), std::abs(exact(first.y0)), size});
  const Point within = intoBox(control, end);
  const double whole = cross(control, end);
  if (!(std::hypot(within.x - control.x, within.y - control.y) <= slack) || whole == 0) return std::nullopt;
  // The parts of start, control and end in a point; the weight is that of the conic through the point where they meet.
  const auto parts = [&](Point q) {
    const double b = cross(q, end) / whole, c = cross(control, q) / whole;
    return std::array{1 - b - c, b, c};
  };
  const auto [a, b, c] = parts(met);
  if (!(a > 0 && b > 0 && c > 0)) return std::nullopt;
  const double weight = b / (2 * std::sqrt(a * c));
  if (!(weight > 0.1 && weight < 1)) return std::nullopt;
  const auto off = [&](Point q) { // how far a point is from that conic
    const auto [u, v, w] = parts(q);
    const double f = v * v - 4 * weight * weight * u * w, outer = 4 * weight * weight;
    const Point dv{end.y / whole, -end.x / whole}, dw{-control.y / whole, control.x / whole}, du = -1.0 * (dv + dw);
    const Point slope = 2 * v * dv - outer * (w * du + u * dw);
    return std::abs(f) / std::hypot(slope.x, slope.y);
  };
  const auto middle = [](Point start, Point control_, Point end_, double w) {
    return (1 / (2 + 2 * w)) * (start + 2 * w * control_ + end_);
  };
  if (!(off(middle({}, c1, met, exact(first.weight))) <= slack) ||
      !(off(middle(met, c2, end, exact(second.weight))) <= slack))
    return std::nullopt;
  return conicOf(pieceOf(first.x0, first.y0, second.x1, second.y1, {}, {}), control, weight);
}

double FormCurve::xAt(double y) const {
  const double v = y - exact(y0), height = exact(y1) - exact(y0), width = exact(x1) - exact(x0);
  if (v <= 0) return exact(x0);
  if (v >= height) return exact(x1);
  if (kind == PatchReader::kPatchLine) return exact(x0) + width * (v / height);
  double low = 0, high = 1;
  for (int i = 0; i < 52; ++i) {
    const double t = 0.5 * (low + high), u = 1 - t, w = exact(weight);
    const double at = kind == PatchReader::kPatchConic
                          ? (2 * w * u * t * exact(control[1]) + t * t * height) / (u * u + 2 * w * u * t + t * t)
                          : 3 * u * u * t * exact(control[1]) + 3 * u * t * t * exact(control2[1]) + t * t * t * height;
    (at < v ? low : high) = t;
  }
  const double t = 0.5 * (low + high), u = 1 - t, w = exact(weight);
  const double x = kind == PatchReader::kPatchConic
                       ? (2 * w * u * t * exact(control[0]) + t * t * width) / (u * u + 2 * w * u * t + t * t)
                       : 3 * u * u * t * exact(control[0]) + 3 * u * t * t * exact(control2[0]) + t * t * t * width;
  return exact(x0) + x;
}

void appendForms(const CurveRecord& curve, std::pmr::vector<FormCurve>& forms, std::pmr::vector<CubicType>* types) {
  const Point c1{exact(curve.controls.x), exact(curve.controls.y)},
      c2{exact(curve.controls.z), exact(curve.controls.w)};
  const Piece whole = pieceOf(curve.ends.x, curve.ends.y, curve.endX, curve.endY, c1, c2);
  if (curve.bend < 0) {
    forms.push_back(curveOf(whole, PatchReader::kPatchLine));
  } else if (curve.weight > 0) {
    // The controls of an arc's cubic lie at this part of the way to where its tangents meet.
    const double w = exact(curve.weight), part = 4 * w / (3 * (1 + w));
    forms.push_back(conicOf(whole, 0.5 * ((1 / part) * c1 + whole.end + (1 / part) * (c2 - whole.end)), w));
  } else {
    appendCubic(whole, 0, forms, types);
  }
}

} // namespace gpgp::vector
