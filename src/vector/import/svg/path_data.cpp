// Path data and point lists (SVG 2, chapter 9.3): all commands, absolute and relative, repeats implied.
#include "vector/import/svg/scanner.h"

namespace gpgp::vector::svg {
namespace {

class PathReader {
public:
  PathReader(std::string_view text, Shape& shape, double tolerance, std::vector<size_t>* silent)
      : scan_(text), shape_(shape), tolerance_(tolerance), silent_(silent) {}

  size_t read() {
    scan_.skipSpace();
    if (scan_.take("none")) return std::string_view::npos;
    if (!scan_.done() && scan_.peek() != 'M' && scan_.peek() != 'm') return scan_.offset();
    while (!scan_.done()) {
      const size_t at = scan_.offset();
      const char command = scan_.peek();
      const char upper = static_cast<char>(command & ~0x20);
      constexpr std::string_view known = "MLHVCSQTAZ";
      if (command < 'A' || known.find(upper) == known.npos) return at;
      scan_.advance();
      relative_ = command != upper;
      scan_.skipSpace();
      if (upper == 'Z') {
        close();
      } else if (const size_t bad = repeat(upper); bad != std::string_view::npos) {
        return bad;
      }
      if (upper != 'M') previous_ = upper;
      scan_.skipSpace();
    }
    return std::string_view::npos;
  }

private:
  /// One command's arguments, as often as they follow.
  size_t repeat(char command) {
    while (true) {
      if (!segment(command)) return scan_.offset();
      previous_ = command;
      if (command == 'M') command = 'L';
      const size_t before = scan_.offset();
      scan_.skipSpace();
      const bool comma = scan_.peek() == ',';
      if (comma) scan_.skipCommaSpace();
      const char c = scan_.peek();
      const bool more = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
      const bool isLast = comma && (scan_.done() || c == ','); // before a command it counts as space, as in browsers
      if (!more) return isLast ? before : std::string_view::npos;
    }
  }

  bool segment(char command) {
    Point a, b, p;
    switch (command) {
    case 'M':
      if (!point(p)) return false;
      shape_.move(p);
      start_ = at_ = p;
      open_ = true;
      return true;
    case 'L': return point(p) && line(p);
    case 'H': return scan_.number(p.x) && line({relative_ ? at_.x + p.x : p.x, at_.y});
    case 'V': return scan_.number(p.y) && line({at_.x, relative_ ? at_.y + p.y : p.y});
    case 'C': return point(a) && nextPoint(b) && nextPoint(p) && cubic(a, b, p);
    case 'S': {
      const bool smooth = previous_ == 'C' || previous_ == 'S';
      return point(b) && nextPoint(p) && cubic(smooth ? 2.0 * at_ - control_ : at_, b, p);
    }
    case 'Q': return point(a) && nextPoint(p) && quad(a, p);
    case 'T': {
      const bool smooth = previous_ == 'Q' || previous_ == 'T';
      return point(p) && quad(smooth ? 2.0 * at_ - control_ : at_, p);
    }
    default: return arc();
    }
  }

  bool arc() {
    double values[3] = {}; // radii, rotation
    bool large = false, positive = false;
    Point p;
    for (double& v : values) {
      if (!scan_.number(v)) return false;
      scan_.skipCommaSpace();
    }
    if (!scan_.flag(large)) return false;
    scan_.skipCommaSpace();
    if (!scan_.flag(positive) || !nextPoint(p)) return false;
    begin();
    const size_t first = shape_.verbs.size();
    appendSvgArc(shape_, at_, values[0], values[1], values[2], large, positive, p, tolerance_);
    if (shape_.verbs.size() == first) shape_.line(p); // to where it begins: its caps show
    if (silent_)
      for (size_t i = first; i + 1 < shape_.verbs.size(); ++i) silent_->push_back(i);
    at_ = p;
    return true;
  }

  bool point(Point& p) {
    Point read;
    if (!scan_.number(read.x)) return false;
    scan_.skipCommaSpace();
    if (!scan_.number(read.y)) return false;
    p = relative_ ? at_ + read : read;
    return true;
  }
  bool nextPoint(Point& p) { return scan_.skipCommaSpace(), point(p); }

  /// After Z a segment begins a new contour where the last one began.
  void begin() {
    if (!open_ && silent_) silent_->push_back(shape_.verbs.size());
    if (!open_) shape_.move(start_);
    open_ = true;
  }
  bool line(Point p) {
    begin();
    shape_.line(p);
    at_ = p;
    return true;
  }
  bool quad(Point c, Point p) {
    begin();
    shape_.quad(c, p);
    control_ = c;
    at_ = p;
    return true;
  }
  bool cubic(Point c1, Point c2, Point p) {
    begin();
    shape_.cubic(c1, c2, p);
    control_ = c2;
    at_ = p;
    return true;
  }
  void close() {
    if (open_) shape_.close();
    at_ = start_;
    open_ = false;
  }

  Scanner scan_;
  Shape& shape_;
  double tolerance_;
  std::vector<size_t>* silent_;
  Point start_, at_, control_;
  char previous_ = 'M';
  bool relative_ = false, open_ = false;
};

} // namespace

size_t parsePathData(std::string_view text, Shape& shape, double tolerance, std::vector<size_t>* silent) {
  return PathReader(text, shape, tolerance, silent).read();
}

bool parsePoints(std::string_view text, bool close, Shape& shape) {
  Scanner s(text);
  s.skipSpace();
  bool good = true;
  while (good && !s.done()) {
    Point p;
    good = s.number(p.x);
    s.skipCommaSpace();
    good = good && s.number(p.y);
    if (!good) break;
    s.skipCommaSpace();
    if (shape.empty())
      shape.move(p);
    else
      shape.line(p);
  }
  if (close && !shape.empty()) shape.close();
  return good;
}

} // namespace gpgp::vector::svg
