#include "random_grammar.h"

#include <array>
#include <cstdint>
#include <iterator>
#include <random>
#include <vector>

namespace gpgp::test {
namespace {
class Generator {
public:
  /// Every third one has Collider and IfCollides.
  explicit Generator(uint32_t seed) : random_(seed), context_(seed % 3 == 0) {}

  std::string run() {
    static const char* kShapes[] = {
        "Box",     "Box",    "Box",
        "Quad",    "Prism3", "Prism6",
        "Octagon", "Sphere", "DynamicRightPrism { (-0.5,-0.5), (0.5,-0.5), (0,0), (0,0.5) }"};
    rules_ = 3 + below(8);
    std::string text = std::string("var v = ") + number(0.2, 3) + ";\naxiom " + kShapes[below(std::size(kShapes))] +
                       " R0;\nterminal T0 T1 (1, 0);\nterminal T2 (0, 1);\nterminal T3 (1, 2);\n";
    if (context_) {
      phaseAt_[1] = 1 + below(rules_);
      phaseAt_[2] = phaseAt_[1] + below(rules_);
    }
    for (uint32_t r = 0; r < rules_; ++r) {
      rule_ = r;
      text += std::string("R") + std::to_string(r) + " = " + (r == 0 ? call(3) : successor(3)) + ";\n";
    }
    return text;
  }

private:
  uint32_t below(size_t n) { return static_cast<uint32_t>(random_() % n); }
  std::string number(double low, double high) {
    const double value = low + (high - low) * double(random_() % 1000) / 1000;
    std::string text = std::to_string(value);
    return text.substr(0, text.find('.') + 4);
  }
  static std::string notZero(const std::string& number) { return std::stod(number) == 0 ? "0.5" : number; }
  const char* axis() { return below(3) == 0 ? "X" : below(2) == 0 ? "Y" : "Z"; }

  std::string value(double low, double high) {
    switch (below(10)) {
    case 0: return std::string("Rand(") + number(low, high) + "," + number(low, high) + ")";
    case 1: return std::string("Exp(ShapeSize(") + axis() + ") * " + number(0.1, 0.9) + ")";
    case 2: return std::string("Exp(v + ShapeSeed() * ") + number(low, high) + ")";
    case 3: return std::string("Exp(ShapePos(") + axis() + ") / " + notZero(number(-4, 4)) + ")";
    case 4:
      return std::string("Exp(ShapeNormal(Y) * ") + number(low, high) + " - ShapeRotation(" + axis() + "," + axis() +
             "))";
    case 5: return "ShapeCustomAttribute()";
    default: return number(low, high);
    }
  }
  std::string condition() {
    static const char* kOperators[] = {"<", ">", "<=", ">=", "==", "!="};
    const std::string simple = value(-2, 4) + " " + kOperators[below(6)] + " " + value(-2, 4);
    return below(3) ? std::string("Exp(") + simple + ")"
                    : std::string("Exp(") + simple + (below(2) ? " && " : " || ") + "ShapeSeed() < 0.5)";
  }

  std::string leaf() {
    if (below(5) == 0) return "Discard()";
    return std::string("T") + std::to_string(below(4));
  }
  std::string successor(int depth) {
    if (depth == 0 || below(4) == 0) {
      if (rule_ + 1 < rules_ && below(3))
        return std::string("R") + std::to_string(rule_ + 1 + below(rules_ - rule_ - 1));
      return leaf();
    }
    return call(depth);
  }
  std::string list(size_t count, int depth, double low, double high, bool labels) {
    std::string text = " { ";
    for (size_t i = 0; i < count; ++i)
      text += std::string(i ? " | " : "") + (labels ? value(low, high) + ": " : std::string()) + successor(depth - 1);
    return text + " }";
  }
  /// By constants, which cut polygons.
  std::string weights(size_t count, int depth) {
    std::string text = " { ";
    for (size_t i = 0; i < count; ++i) text += (i ? " | -" : "-") + number(0.2, 2) + ": " + successor(depth - 1);
    return text + " }";
  }

  /// Rules are in up to three parts; none leads back to a part before its own. Of a tag, Colliders are in parts before
  /// those with its IfCollides.
  uint32_t part() const { return rule_ >= phaseAt_[2] ? 2 : rule_ >= phaseAt_[1] ? 1 : 0; }
  std::string context(int depth) {
    static const char* kTags[] = {"7", "wall", "v - v"};
    const uint32_t own = part();
    if (own == 0 || (own == 1 && below(2)))
      return std::string("Collider(") + kTags[own == 0 ? below(2) : 1] + ") " + successor(depth - 1);
    return std::string("IfCollides(") + kTags[own == 1 ? 0 : below(3)] + ")" + list(2, depth, 0, 0, false);
  }

  std::string call(int depth) {
    if (context_ && below(4) == 0) return context(depth);
    switch (below(16)) {
    case 0:
      return std::string("Translate(") + value(-2, 2) + "," + value(-2, 2) + "," + value(-2, 2) + ") " +
             successor(depth - 1);
    case 1: return std::string("Rotate(") + value(-90, 90) + "," + value(-180, 180) + ",90) " + successor(depth - 1);
    case 2: return std::string("Scale(") + value(-1.2, 3) + ",-0.9," + value(-1.2, 3) + ") " + successor(depth - 1);
    case 3: return std::string("Extrude(") + value(0.1, 2) + ") " + successor(depth - 1);
    case 4: return std::string("CompSplit() ") + list(3, depth, 0, 0, false);
    case 5:
    case 6: {
      const std::string divides = std::string("SubDiv(") + axis() + ")";
      const size_t parts = 1 + below(5);
      return divides + (below(2) ? weights(parts, depth) : list(parts, depth, -2, 1.5, true));
    }
    case 7:
      return std::string("Repeat(") + axis() + "," + value(-0.6, 2) + "," +
             (below(3)   ? "ADJUST_TO_FILL"
              : below(2) ? "ANCHOR_TO_START"
                         : "ANCHOR_TO_END") +
             std::string(") ") + successor(depth - 1);
    case 8: return std::string("If(") + condition() + ")" + list(2, depth, 0, 0, false);
    case 9: return std::string("IfSizeLess(") + axis() + "," + value(0.5, 4) + ")" + list(2, depth, 0, 0, false);
    case 10: return std::string("RandomRule(") + value(-1, 3) + ")" + list(1 + below(4), depth, 0.01, 1, true);
    case 11: return std::string("Replicate()") + list(1 + below(3), depth, 0, 0, false);
    case 12: return std::string("SwapSize(") + axis() + "," + axis() + "," + axis() + ") " + successor(depth - 1);
    case 13:
      return std::string("SetAsDynamicConvex") + (below(2) ? "Polygon" : "RightPrism") +
             std::string("((-0.5,-0.5),(0.5,-0.5),(0.2,0.4),(-0.3,0.5)) ") + successor(depth - 1);
    case 14: return cornerOperator(depth);
    default: // a way back that ends: sizes shrink
      return std::string("If(Exp(ShapeSize(X) + ShapeSize(Y) + ShapeSize(Z) < ") + number(1, 4) + ")) { " + leaf() +
             std::string(" | Scale(-0.6,-0.6,-0.6) R") +
             std::to_string(phaseAt_[part()] + below(rule_ + 1 - phaseAt_[part()])) + " }";
    }
  }

  std::string cornerOperator(int depth) {
    switch (below(6)) {
    case 0:
      return std::string("ResizeCorner(") + value(0.5f, 3) + ",Max(" + value(0, 2) + ",ShapeSize(Y)),Min(" +
             value(1, 3) + ",2)) " + successor(depth - 1);
    case 1:
      return std::string("GrowAlong(") + axis() + ",Exp(1 + Floor(" + value(0, 4) + ",0.75))) " + successor(depth - 1);
    case 2:
      return std::string("TurnCorner(") + value(-90, 90) + "," + value(-180, 180) + ",90) " + successor(depth - 1);
    case 3:
      return std::string("SetAttribute(Noise(ShapeCustomAttribute(),") + value(0, 2) + ")) " + successor(depth - 1);
    case 4:
      return "RaiseRoof(" + std::to_string(below(8)) + "," + std::to_string(below(3)) + "," + value(0, 3) + ") " +
             (below(2)
                  ? successor(depth - 1)
                  : "Replicate() { ToRoofFace(" + std::to_string(below(5)) + ",0.2,0.1) " + successor(depth - 1) +
                        " | ToRoofFace(" + value(0, 3) + ",0," + number(0, 1) + ") " + successor(depth - 1) + " }");
    default: return std::string("ToFace(") + number(0, 6) + ") " + successor(depth - 1);
    }
  }

  std::mt19937 random_;
  bool context_;
  uint32_t rules_ = 1, rule_ = 0;
  std::array<uint32_t, 3> phaseAt_{0, UINT32_MAX, UINT32_MAX}; // the first rule of each part
};
} // namespace

std::string randomGrammar(uint32_t seed) { return Generator(seed).run(); }

} // namespace gpgp::test
