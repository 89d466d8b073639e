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

bool layOut(const std::vector<SplitPart>& parts, float length, size_t most, std::vector<Piece>& pieces) {
  pieces.clear();
  return !(length > 0) || Layout(length, most, pieces).list(parts, static_cast<double>(length));
}

} // namespace gpgp::spawn::cga
