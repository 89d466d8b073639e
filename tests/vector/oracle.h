// Point-in-path by winding number: the tests' reference, written apart from the library's conversion.
//
// A path's curves are cut where they turn in y only; a ray to the left counts them by bisection in double precision.
#pragma once
#include <gpgp/vector.h>

#include <array>
#include <string>
#include <vector>

namespace gpgp::test {

struct TestPath {
  std::vector<GpgpPathVerb> verbs;
  std::vector<float> points;
  GpgpFillRule rule = GPGP_FILL_NON_ZERO;
  std::array<float, 4> color{0, 0, 0, 1};

  TestPath& move(float x, float y) { return add(GPGP_PATH_MOVE, {x, y}); }
  TestPath& line(float x, float y) { return add(GPGP_PATH_LINE, {x, y}); }
  TestPath& quad(float a, float b, float x, float y) { return add(GPGP_PATH_QUAD, {a, b, x, y}); }
  TestPath& cubic(float a, float b, float c, float d, float x, float y) {
    return add(GPGP_PATH_CUBIC, {a, b, c, d, x, y});
  }
  TestPath& close() { return add(GPGP_PATH_CLOSE, {}); }
  TestPath& add(GpgpPathVerb verb, std::initializer_list<float> values) {
    verbs.push_back(verb);
    points.insert(points.end(), values);
    return *this;
  }
  GpgpPath view() const {
    return {verbs.data(),  static_cast<uint32_t>(verbs.size()),
            points.data(), static_cast<uint32_t>(points.size() / 2),
            rule,          {color[0], color[1], color[2], color[3]}};
  }
};

class PathOracle {
public:
  explicit PathOracle(const GpgpPath& path);
  int winding(double x, double y) const;
  bool inside(double x, double y) const {
    const int w = winding(x, y);
    return evenOdd_ ? (w & 1) != 0 : w != 0;
  }
  /// Whether the answer is the same everywhere within `distance`, as far as four neighbours tell.
  bool certain(double x, double y, double distance) const {
    const bool in = inside(x, y);
    return inside(x - distance, y) == in && inside(x + distance, y) == in && inside(x, y - distance) == in &&
           inside(x, y + distance) == in;
  }
  /// To the nearest point of the outline, found by a thousand flattened segments a piece. Where `certain` is asked in a
  /// sliver thinner than its distance, the neighbours can all lie beyond the other edge.
  double distance(double x, double y) const;
  struct Crossing {
    double x;
    int direction;
  };
  /// All crossings of a row, from left to right.
  std::vector<Crossing> crossings(double y) const;
  double left = 1e30, top = 1e30, right = -1e30, bottom = -1e30;
  /// The largest coordinate, in magnitude.
  double magnitude() const;

private:
  struct Piece { // grows in y from t0 to t1, or shrinks
    std::array<double, 8> c;
    double t0, t1, y0, y1, xMin, xMax;
  };
  void addCurve(const std::array<double, 8>& c);
  bool evenOdd_;
  std::vector<Piece> pieces_;
};

} // namespace gpgp::test
