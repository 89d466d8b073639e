#include "spawn/cga/split_layout.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn::cga {

namespace {

constexpr float kSmallest = 1e-5f; // metres; what is thinner is no part

/// Lengths of a list, each repeated group once.
struct Sum {
  double fixed = 0, floating = 0;
  double repeatedFixed = 0, repeatedFloating = 0;
  bool repeats = false;

  void add(const std::vector<SplitPart>& parts) {
    for (const SplitPart& part : parts) {
      const double size = part.size > 0 ? static_cast<double>(part.size) : 0.0;
      if (part.kind == SplitPart::Kind::absolute) fixed += size;
      if (part.kind == SplitPart::Kind::floating) floating += size;
      if (part.kind == SplitPart::Kind::group) add(part.parts);
      if (part.kind == SplitPart::Kind::repeated) {
        repeats = true;
        Sum inner;
        inner.add(part.parts);
        repeatedFixed += inner.fixed + inner.repeatedFixed;
        repeatedFloating += inner.floating + inner.repeatedFloating;
      }
    }
  }
};

class Layout {
public:
  Layout(float length, size_t most, std::vector<Piece>& pieces) : length_(length), most_(most), pieces_(pieces) {}

  bool list(const std::vector<SplitPart>& parts, double length) {
    Sum sum;
    sum.add(parts);
    const double left = length - sum.fixed;
    const double count = sum.repeats ? repetitions(sum, left) : 0;
    if (count > static_cast<double>(most_)) return false;
    const double floating = sum.floating + count * sum.repeatedFloating;
    const double stretch = floating > 0 ? std::max(0.0, (left - count * sum.repeatedFixed) / floating) : 0.0;
    return write(parts, static_cast<size_t>(count), stretch);
  }

private:
  /// How often repeated groups are there.
  static double repetitions(const Sum& sum, double left) {
    const double once = sum.repeatedFixed + sum.repeatedFloating;
    if (!(once > 1e-6) || !(left > 0)) return 0;
    if (sum.floating + sum.repeatedFloating <= 0) return std::max(1.0, std::floor(left / once + 1e-4));
    double best = 0, least = 1e300;
    const double about = std::floor(std::max(0.0, left - sum.floating) / once);
    for (double n = std::max(0.0, about - 1); n <= about + 2; ++n) {
      const double floating = sum.floating + n * sum.repeatedFloating;
      const double rest = left - n * sum.repeatedFixed;
      if (!(floating > 0)) continue; // of none, nothing stretches
      if (rest < -1e-6 || (rest <= 0 && n > 0 && sum.repeatedFloating > 0)) continue;
      const double stretch = std::max(rest, 1e-9) / floating;
      const double cost = std::max(stretch, 1 / stretch);
      if (cost < least * (1 - 1e-6)) {
        least = cost;
        best = n;
      }
    }
    if (least == 1e300) return std::max(1.0, std::floor(left / once + 1e-4));
    // Where all that floats is repeated, once at least.
    return sum.floating > 0 || sum.fixed > 0 ? best : std::max(1.0, best);
  }

  bool write(const std::vector<SplitPart>& parts, size_t count, double stretch) {
    for (const SplitPart& part : parts) {
      switch (part.kind) {
      case SplitPart::Kind::absolute: piece(static_cast<double>(part.size), part.body); break;
      case SplitPart::Kind::floating: piece(static_cast<double>(part.size) * stretch, part.body); break;
      case SplitPart::Kind::group:
        if (!write(part.parts, count, stretch)) return false;
        break;
      case SplitPart::Kind::repeated: {
        Sum inner;
        inner.add(part.parts);
        const double each = inner.fixed + inner.repeatedFixed + stretch * (inner.floating + inner.repeatedFloating);
        for (size_t i = 0; i < count && at_ < static_cast<double>(length_) - static_cast<double>(kSmallest); ++i) {
          if (inner.repeats ? !list(part.parts, each) : !write(part.parts, 0, stretch)) return false;
        }
        break;
      }
      }
      if (pieces_.size() > most_) return false;
    }
    return true;
  }

  void piece(double size, uint32_t body) {
    if (!(size > 0)) return;
    const double end = std::min(at_ + size, static_cast<double>(length_));
    if (end - at_ >= static_cast<double>(kSmallest))
      pieces_.push_back({static_cast<float>(at_), static_cast<float>(end), body});
    at_ += size;
  }

  float length_;
  size_t most_;
  std::vector<Piece>& pieces_;
  double at_ = 0;
};

} // namespace

std::vector<SplitPart> readParts(const uint32_t* words, uint32_t table, const shader::CgaValue* values, float whole) {
  using namespace shader;
  std::vector<SplitPart> parts;
  for (uint32_t i = 0; i < words[table]; ++i) {
    const uint32_t record = words[table + 1 + i], kind = words[record + kCgaPartKind];
    SplitPart part;
    if (kind == kCgaPartGroup || kind == kCgaPartRepeated) {
      part.kind = kind == kCgaPartGroup ? SplitPart::Kind::group : SplitPart::Kind::repeated;
      part.parts = readParts(words, words[record + kCgaPartBody], values, whole);
      parts.push_back(std::move(part));
      continue;
    }
    if (words[record + kCgaPartSelector] == kCgaNoSelector) continue;
    const CgaValue v = values[words[record + kCgaPartSelector]];
    const bool isNumber = v.type == kCgaFloat || v.type == kCgaRelative || v.type == kCgaFloating;
    const float size = isNumber ? uintBitsToFloat(v.bits) : 0.0f;
    part.kind = v.type == kCgaFloating ? SplitPart::Kind::floating : SplitPart::Kind::absolute;
    part.size = v.type == kCgaRelative ? multiply(size, whole) : size;
    part.body = words[record + kCgaPartBody];
    parts.push_back(std::move(part));
  }
  return parts;
}

bool layOut(const std::vector<SplitPart>& parts, float length, size_t most, std::vector<Piece>& pieces) {
  pieces.clear();
  return !(length > 0) || Layout(length, most, pieces).list(parts, static_cast<double>(length));
}

// ---------------------------------------------------------------- by the operators of graphs

namespace {
using namespace shader;

bool isPlainPart(const SplitPart& part) {
  return part.kind == SplitPart::Kind::absolute || part.kind == SplitPart::Kind::floating;
}
bool arePlain(const std::vector<SplitPart>& parts) {
  return !parts.empty() && parts.size() <= kMaxSuccessors && std::all_of(parts.begin(), parts.end(), isPlainPart);
}

class PlainLayout {
public:
  PlainLayout(size_t most, std::vector<Piece>& pieces) : most_(most), pieces_(pieces) {}

  /// SubDiv. A repeated group among parts of fixed length takes what they leave.
  void list(const shader::Shape& s, const std::vector<SplitPart>& parts) {
    float fixedLength = 0, weights = 0;
    for (const SplitPart& part : parts) count(part, fixedLength, weights);
    const float remainder = remainderOf(s.size.x, fixedLength);
    shader::Part place{0, 0, 0, 0};
    float before = 0, weightBefore = 0;
    for (uint32_t i = 0; i < parts.size(); ++i) {
      const float own = parts[i].kind == SplitPart::Kind::repeated ? 1.0f : max(0.0f, parts[i].size);
      const bool isFixed = parts[i].kind == SplitPart::Kind::absolute;
      place.fixedLength = isFixed ? own : 0;
      place.share = !isFixed && own > 0 ? shader::divide(own, weights) : 0;
      place.fixedBefore = before;
      place.shareBefore = weightBefore > 0 ? shader::divide(weightBefore, weights) : 0;
      count(parts[i], before, weightBefore);
      if (!(own > 0) || (!isFixed && !(remainder > 0))) continue;
      shader::Shape child = s;
      if (!toPart(child, 0, remainder, place, i)) continue;
      if (parts[i].kind == SplitPart::Kind::repeated)
        group(child, parts[i].parts);
      else
        piece(child, parts[i].body);
    }
  }
  /// Repeat, and SubDiv within its copies.
  void group(const shader::Shape& s, const std::vector<SplitPart>& parts) {
    float fixedLength = 0, weights = 0;
    for (const SplitPart& part : parts) count(part, fixedLength, weights);
    shader::Shape whole = s;
    float extent = fixedLength;
    if (weights > 0) {
      extent = shader::divide(s.size.x, repetitions(s.size.x, fixedLength, weights));
    } else {
      // Those that fit whole, at least one.
      const float fits =
          max(1.0f, settle(floor(shader::divide(add(s.size.x, multiply(fixedLength, 1e-4f)), fixedLength))));
      const float length = multiply(fits, fixedLength);
      const float left = remainderOf(s.size.x, length);
      if (!(fixedLength > 0) || !toPart(whole, 0, left, {length, 0, 0, 0}, 0)) return;
    }
    const Fan fan = repetitionOf(whole.size.x, kRepeatAdjustToFill, extent);
    if (fan.extent < 0 || fan.count > most_) overflows = true;
    for (uint32_t i = 0; i < fan.count && !overflows; ++i) {
      shader::Shape copy = whole;
      toRepeat(copy, 0, kRepeatAdjustToFill, fan.count, fan.extent, i);
      if (parts.size() == 1)
        piece(copy, parts[0].body);
      else
        list(copy, parts);
    }
  }
  bool overflows = false;

private:
  static void count(const SplitPart& part, float& fixedLength, float& weights) {
    const float own = part.kind == SplitPart::Kind::repeated ? 1.0f : max(0.0f, part.size);
    float& sum = part.kind == SplitPart::Kind::absolute ? fixedLength : weights;
    sum = add(sum, own);
  }
  void piece(const shader::Shape& s, uint32_t body) {
    if (pieces_.size() >= most_) overflows = true;
    if (overflows) return;
    Piece piece;
    piece.from = s.position.x - s.size.x * 0.5f;
    piece.to = piece.from + s.size.x;
    piece.body = body;
    piece.extent = s.size.x;
    piece.key = s.key;
    pieces_.push_back(piece);
  }
  size_t most_;
  std::vector<Piece>& pieces_;
};
} // namespace

float repetitions(float length, float fixed, float floating) {
  const float fits = settle(floor(shader::divide(length, add(fixed, floating))));
  const float more = subtract(shader::divide(length, fits), fixed);
  const float less = subtract(shader::divide(length, add(fits, 1.0f)), fixed);
  return max(1.0f, add(fits, multiply(more, less) > multiply(floating, floating) ? 1.0f : 0.0f));
}

bool layOutPlain(const std::vector<SplitPart>& parts, float length, shader::uvec2 key, size_t most,
                 std::vector<Piece>& pieces) {
  pieces.clear();
  const auto isGroup = [](const SplitPart& part) { return part.kind == SplitPart::Kind::repeated; };
  const auto groups = std::count_if(parts.begin(), parts.end(), isGroup);
  for (const SplitPart& part : parts)
    if (isGroup(part) ? !arePlain(part.parts)
                      : !isPlainPart(part) || (groups && part.kind == SplitPart::Kind::floating))
      return false;
  if (groups > 1 || parts.empty() || parts.size() > kMaxSuccessors) return false;
  shader::Shape s{};
  s.axisX = vec3(1, 0, 0);
  s.axisY = vec3(0, 1, 0);
  s.axisZ = vec3(0, 0, 1);
  s.position = vec3(length * 0.5f, 0, 0);
  s.size = vec3(length, 1, 1);
  s.key = key;
  PlainLayout layout(most, pieces);
  if (groups && parts.size() == 1)
    layout.group(s, parts[0].parts);
  else
    layout.list(s, parts);
  return !layout.overflows;
}

} // namespace gpgp::spawn::cga
