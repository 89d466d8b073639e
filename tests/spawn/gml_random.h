// Random programs in the stack language, of boxes. Tokens are separated by white space, as gml_plain.h reads them.
#pragma once
#include <cstdint>
#include <random>
#include <string>

namespace gpgp::test {

class RandomProgram {
public:
  explicit RandomProgram(uint32_t seed) : random_(seed) {}

  std::string text() {
    std::string program = "/T0 1 0 terminal /T1 1 1 terminal /T2 1 2 terminal ";
    for (uint32_t i = below(3); i > 0; --i, ++procedures_) // shape to shape
      program += "/p" + std::to_string(procedures_) + " { " + changes(1) + "} def ";
    const uint32_t rules = below(3);
    for (uint32_t i = 0; i < rules; ++i) { // a shape and a number that counts down
      const std::string name = "r" + std::to_string(i);
      program += "/" + name + " 1 { !n " + change(1) + ":n 1 lt { " + end(1) + "} { " +
                 (below(2) ? "dup " + terminal() : "") + splitTo("{ :n 1 sub " + name + " }") + "} ifelse } rule ";
    }
    if (below(4) == 0) { // ends by its size
      program += "/halves 0 { X size " + number(0.4, 0.9) + "lt { " + end(0) + "} { " + number(0, 0.05) +
                 "0 0 translate " + "X [ -1 { halves } " + number(-1.3, -0.7) + "{ halves } ] subdiv } ifelse } rule ";
      hasHalves_ = true;
    }
    rules_ = rules;
    return program + "/Box axiom " + end(3);
  }

private:
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  std::string number(double from, double to) {
    const double x = from + (to - from) * below(100003) / 100003.0;
    std::string text = std::to_string(x);
    return text + " ";
  }
  std::string axis() { return std::string(1, static_cast<char>('X' + below(3))) + " "; }
  std::string terminal() { return "T" + std::to_string(below(3)) + " "; }
  /// A known number, by ways that use the stack.
  std::string known(double from, double to) {
    const double half = (from + to) / 2;
    switch (below(8)) {
    case 0: return number(from, half) + number(0, to - half) + "add ";
    case 1: return number(from, to) + number(1, 2) + "exch pop " + "dup pop " + number(0, 0.1) + "pop 1 mul ";
    case 2: return number(0, 0.1) + number(from, to) + "2 1 roll pop ";
    case 3: return number(from, to) + number(5, 9) + "1 index exch pop exch pop ";
    case 4: return number(from, to) + "1 2 lt { } { pop 5 } ifelse ";
    case 5: return "[ " + number(from, to) + "] { 1 mul } map aload ";
    default: return number(from, to);
    }
  }

  std::string change(int depth) {
    switch (below(12)) {
    case 0: return known(-2, 2) + known(-2, 2) + known(-2, 2) + "translate ";
    case 1: return known(-40, 40) + known(-180, 180) + known(-40, 40) + "rotate ";
    case 2: return known(-1.2, -0.5) + known(-1.2, -0.5) + known(0.5, 2) + "scale ";
    case 3: return axis() + "size " + number(0.1, 0.6) + "mul !r 0 :r " + number(-1, 1) + "translate ";
    case 4:
      return axis() + "size !a " + axis() + "size !b :a :b add 3 0 " + number(0.2, 0.4) +
             "3 -1 roll exch pop exch pop mul " + "!c :c 1 :c translate ";
    case 5: return axis() + number(0.6, 2.5) + "tile ";
    case 6:
      if (depth <= 0) return "";
      return axis() + "size " + number(0.5, 3) + (below(2) ? "lt { " : "gt { ") + changes(depth - 1) + "} { " +
             changes(depth - 1) + "} ifelse ";
    case 7:
      if (depth <= 0) return "";
      return axis() + "size " + number(0.5, 3) + "lt { " + changes(depth - 1) + "} if ";
    case 8: return "2 { " + known(-1, 1) + "0 0 translate } repeat ";
    case 9: return "0 1 2 { 0.3 mul 0 exch 0 translate } for ";
    case 10: return procedures_ && depth > 0 ? "p" + std::to_string(below(procedures_)) + " " : std::string();
    default:
      if (depth <= 0) return "";
      return axis() + "size " + number(0.5, 3) + "lt { pop nothing } { } ifelse ";
    }
  }
  std::string changes(int depth) {
    std::string text;
    for (uint32_t i = below(3); i > 0; --i) text += change(depth);
    return text;
  }
  std::string parts(const std::string& what) {
    std::string text = axis() + "[ ";
    const uint32_t count = 1 + below(3);
    for (uint32_t i = 0; i < count; ++i) text += (below(3) ? number(-2, -0.5) : number(0.2, 1.5)) + what + " ";
    return text + "] subdiv ";
  }
  std::string splitTo(const std::string& procedure) { return parts(procedure); }

  /// Takes the shape at the top to its end.
  std::string end(int depth) {
    const std::string before = changes(depth);
    if (depth <= 0) return before + terminal();
    switch (below(11)) {
    case 0: return before + "dup " + change(depth) + end(depth - 1) + end(depth - 1);
    case 1: return before + "dup exch " + end(depth - 1) + end(depth - 2);
    case 2: return before + parts("{ " + end(depth - 1) + "}");
    case 3: return before + parts("") + "{ " + end(depth - 1) + "} forall ";
    case 4: return before + parts("") + "{ " + changes(depth - 1) + "} map { " + end(depth - 1) + "} forall ";
    case 5:
      return before + axis() + "size " + number(0.5, 4) + "gt { " + end(depth - 1) + "} { " + end(depth - 1) +
             "} ifelse ";
    case 6: return before + "3 { dup " + change(depth) + terminal() + "} repeat " + end(depth - 1);
    case 7: return before + "!s 0 1 2 { !i :s 0 :i " + number(0.5, 2) + "mul 0 translate " + terminal() + "} for ";
    case 8:
      return rules_ ? before + std::to_string(below(3)) + " r" + std::to_string(below(rules_)) + " "
                    : before + terminal();
    case 9: return hasHalves_ ? before + "halves " : before + "dup " + terminal() + terminal();
    default: return before + "dup dup " + terminal() + "2 1 roll " + end(depth - 1) + end(depth - 2);
    }
  }

  std::mt19937 random_;
  uint32_t procedures_ = 0, rules_ = 0;
  bool hasHalves_ = false;
};

} // namespace gpgp::test
