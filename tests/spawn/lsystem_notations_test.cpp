// L-systems in the notations of other programs: lengths and places that are known, and interpreters of those programs'
// rules that share nothing with the readers.
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace gpgp {
namespace {

using namespace spawn::lsystem;
using spawn::Diagnostics;

struct Compiled {
  std::optional<Table> table;
  std::string messages;
};
Compiled compiled(const std::string& text, std::string_view start = {}) {
  Compiled result;
  Diagnostics diagnostics;
  const auto words = compile(text, {}, diagnostics, {}, start);
  for (const auto& d : diagnostics.sorted()) result.messages += format(d, "test") + "\n";
  if (!words) return result;
  auto table = Table::load(std::as_bytes(std::span(*words)), std::pmr::new_delete_resource());
  if (!table) throw std::runtime_error(table.error().text);
  result.table = *table;
  return result;
}

std::vector<GpgpAxiom> oneAxiom() {
  std::vector<GpgpAxiom> axioms(1);
  axioms[0].transform[0] = axioms[0].transform[5] = axioms[0].transform[10] = 1;
  axioms[0].seed = 1;
  return axioms;
}

struct Segment {
  std::array<double, 2> from, to;
};
/// In the order in which the turtle draws them, of systems that draw one kind of segment.
std::vector<Segment> segmentsOf(const std::string& text, uint32_t iterations, std::string_view start = {}) {
  const Compiled c = compiled(text, start);
  EXPECT_TRUE(c.table) << c.messages << text;
  std::vector<Segment> segments;
  if (!c.table) return segments;
  const auto axioms = oneAxiom();
  for (const GpgpInstance& i : draw(*c.table, derive(*c.table, axioms, iterations).string, axioms).instances) {
    const float* m = i.transform;
    const double x = 0.5 * m[1], y = 0.5 * m[5];
    segments.push_back({{m[3] - x, m[7] - y}, {m[3] + x, m[7] + y}});
    EXPECT_NEAR(m[11], 0, 1e-4);
  }
  return segments;
}
double lengthOf(const std::vector<Segment>& segments) {
  double sum = 0;
  for (const Segment& s : segments) sum += std::hypot(s.to[0] - s.from[0], s.to[1] - s.from[1]);
  return sum;
}

// ------------------------------------------------------------ Fractint

TEST(LsystemOfFractint, CurvesOfTheBooksHaveTheirLengthsAndEnds) {
  // The Fractal Geometry of Nature: three sides, of which each becomes four; closed.
  const std::string koch = "Koch1 { ; a snowflake\n  Angle 6\n  Axiom F--F--F\n  F=F+F--F+F\n}\n";
  for (uint32_t n = 0; n <= 5; ++n) {
    const auto segments = segmentsOf(koch, n);
    ASSERT_EQ(segments.size(), 3 * std::pow(4, n));
    EXPECT_NEAR(segments.back().to[0], 0, 1e-2);
    EXPECT_NEAR(segments.back().to[1], 0, 1e-2);
  }
  EXPECT_NEAR(segmentsOf(koch, 0)[0].to[0], 1, 1e-6); // it begins to the right, and turns to the left
  EXPECT_NEAR(segmentsOf(koch, 0)[1].to[1], -std::sqrt(3) / 2, 1e-6);
  // The dragon: 2^n segments, whose ends are sqrt(2)^n apart.
  const std::string dragon = "Dragon (old) { Angle 4\n Axiom FX\n X=X+YF+\n Y=-FX-Y }";
  for (uint32_t n = 1; n <= 12; ++n) {
    const auto segments = segmentsOf(dragon, n);
    ASSERT_EQ(segments.size(), std::pow(2, n));
    EXPECT_NEAR(std::hypot(segments.back().to[0], segments.back().to[1]), std::pow(2, n / 2.0), 1e-3) << n;
  }
  // Branches, each half as long: in all as many as those of the first.
  const std::string tree = "Tree {\n angle 8\n axiom FX\n x=@.5[+fx][-fx]\n}\n";
  for (uint32_t n = 0; n <= 8; ++n) EXPECT_NEAR(lengthOf(segmentsOf(tree, n)), 1.0 + n, 1e-4) << n;
}

/// What Fractint draws, in double precision: strings first, then one turtle.
struct Plain {
  int angle = 4;
  std::map<char, std::string> rules;
  std::string axiom;

  std::string after(uint32_t iterations) const {
    std::string text = axiom;
    for (uint32_t i = 0; i < iterations; ++i) {
      std::string next;
      for (size_t k = 0; k < text.size(); ++k) {
        const auto rule = rules.find(text[k]);
        next += rule != rules.end() ? rule->second : std::string(1, text[k]);
      }
      text = next;
    }
    return text;
  }
  std::vector<Segment> draw(uint32_t iterations) const {
    const std::string text = after(iterations);
    struct Turtle {
      double x = 0, y = 0, size = 1, degrees = 0;
      int steps = 0;
      bool isReversed = false;
    };
    std::vector<Turtle> stack(1);
    std::vector<Segment> segments;
    for (size_t i = 0; i < text.size(); ++i) {
      Turtle& t = stack.back();
      const auto number = [&] {
        bool isRoot = false, isInverse = false;
        for (; text[i + 1] == 'Q' || text[i + 1] == 'I'; ++i) (text[i + 1] == 'Q' ? isRoot : isInverse) = true;
        size_t length = 0;
        double value = std::stod(text.substr(i + 1), &length);
        i += length;
        if (isRoot) value = std::sqrt(value);
        return isInverse ? 1 / value : value;
      };
      const double radians = 3.14159265358979323846 / 180;
      switch (text[i]) {
      case '+': t.steps += t.isReversed ? -1 : 1; break;
      case '-': t.steps -= t.isReversed ? -1 : 1; break;
      case '|': t.steps -= angle / 2; break;
      case '\\': t.degrees += (t.isReversed ? -1 : 1) * number(); break;
      case '/': t.degrees -= (t.isReversed ? -1 : 1) * number(); break;
      case '!': t.isReversed = !t.isReversed; break;
      case '@': t.size *= number(); break;
      case '[': stack.push_back(Turtle(t)); break;
      case ']': stack.pop_back(); break;
      case 'F':
      case 'G':
      case 'D':
      case 'M': {
        const bool isByDegrees = text[i] == 'D' || text[i] == 'M';
        const double a = radians * (isByDegrees ? t.degrees : t.steps * 360.0 / angle);
        const Segment s{{t.x, t.y}, {t.x + t.size * std::cos(a), t.y + t.size * std::sin(a)}};
        if (text[i] == 'F' || text[i] == 'D') segments.push_back(s);
        t.x = s.to[0];
        t.y = s.to[1];
      }
      }
    }
    return segments;
  }
};

TEST(LsystemOfFractint, RandomSystemsAreDrawnAsItsTurtleDoes) {
  std::mt19937 random(11);
  const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  double worst = 0;
  size_t drawn = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool byDegrees = i % 3 == 0;
    Plain plain;
    plain.angle = byDegrees ? 7 : i % 2 ? 4 + 2 * static_cast<int>(below(6)) : 3 + 2 * static_cast<int>(below(4));
    const bool reverses = byDegrees || plain.angle % 2 == 0;
    const std::string turns = byDegrees ? "\\/" : reverses ? "+-|!" : "+-|";
    const auto string = [&](auto&& self, uint32_t depth) -> std::string {
      std::string text;
      for (uint32_t n = 2 + below(4); n > 0; --n) {
        const char turn = turns[below(static_cast<uint32_t>(turns.size()))];
        switch (below(depth < 2 ? 6 : 4)) {
        case 0: text += byDegrees ? below(4) ? 'D' : 'M' : below(4) ? 'F' : 'G'; break;
        case 1: text += below(2) ? 'X' : 'Y'; break;
        case 2:
          text += turn;
          if (byDegrees) text += std::to_string(5 + below(80)) + (below(2) ? ".5" : "");
          break;
        case 3: text += byDegrees ? (below(2) ? "!" : "") : reverses && below(4) == 0 ? "!" : "+"; break;
        case 4: text += "[" + self(self, depth + 1) + "]"; break;
        default: text += (below(2) ? "[@.5" : "[@IQ2") + self(self, depth + 1) + "]"; break;
        }
      }
      return text;
    };
    plain.axiom = string(string, 0);
    plain.rules['X'] = string(string, 0);
    plain.rules['Y'] = string(string, 0);
    plain.rules[byDegrees ? 'D' : 'F'] = i % 2 ? (byDegrees ? "D" : "F") : (byDegrees ? "DD" : "FF");
    std::string text =
        "system" + std::to_string(i) + " {\n angle " + std::to_string(plain.angle) + "\n AXIOM " + plain.axiom + "\n";
    for (const auto& [symbol, rule] : plain.rules) { // in two parts, of which the second goes on
      text += std::string(" ") + symbol + "=" + (i % 5 ? rule : std::string()) + " ; a rule\n";
      if (i % 5 == 0) text += std::string(" ") + static_cast<char>(symbol + 32) + " = " + rule + "\n";
    }
    text += "}\n";
    const std::vector<Segment> expected = plain.draw(3), found = segmentsOf(text, 3);
    ASSERT_EQ(found.size(), expected.size()) << text;
    double extent = 1;
    for (size_t k = 0; k < found.size(); ++k)
      for (int c = 0; c < 2; ++c) {
        extent = std::max(extent, std::fabs(expected[k].to[c]));
        worst = std::max(worst, std::fabs(found[k].to[c] - expected[k].to[c]) / extent);
        worst = std::max(worst, std::fabs(found[k].from[c] - expected[k].from[c]) / extent);
      }
    drawn += found.size();
  }
  EXPECT_GT(drawn, 20000u);
  EXPECT_LT(worst, 1e-4);
}

TEST(LsystemOfFractint, OneOfSeveralSystemsIsRead) {
  const std::string text = "comment { no system }\nA { Angle 4\n Axiom F }\nB{Angle 3\nAxiom FF}\n";
  EXPECT_EQ(segmentsOf(text, 1).size(), 1u);
  EXPECT_EQ(segmentsOf(text, 1, "B").size(), 2u);
  EXPECT_NE(compiled(text).messages.find("this file has 2 systems; 'A', the first, is read"), std::string::npos);
  EXPECT_NE(compiled(text, "C").messages.find("there is no system 'C' in the file"), std::string::npos);
  EXPECT_EQ(compiled("axiom: F\niterations: 1\nF --> FF\n", "C")
                .messages.find("test: error: this file has one system, which has no name; 'C' is none of it"),
            0u);
}

TEST(LsystemOfFractint, ErrorsSayWhereAndWhat) {
  const std::pair<const char*, const char*> cases[] = {
      {"A { Angle 2\n Axiom F }", "test:1:5: error: 'Angle' is a whole number from 3 to 50"},
      {"A { Axiom F }", "test:1:1: error: 'A' has no angle"},
      {"A { Angle 4\n Axiom F\n", "test:1:1: error: 'A' has no '}'"},
      {"A { Angle 4\n Axiom F\n Anlge 6 }", "test:3:2: error: expected 'Axiom', 'Angle' or a rule such as "},
      {"A { Angle 4\n Axiom F\n +=F }", "test:3:2: error: '+' is a command; a rule is for another symbol"},
      {"A { Angle 4\n Axiom F\n F=F F }", "test:3:6: error: a string has no blanks; found more behind it"},
      {"A { Angle 4\n Axiom F@0F }", "test:2:9: error: '@' is followed by a factor above 0"},
      {"A { Angle 4\n Axiom FD }", "test:2:9: error: D and M, which turn by \\ and / alone, and F and G"},
      {"A { Angle 5\n Axiom F!|F }", "test:2:10: error: '|' of an odd angle in a system that has '!' is not supported"},
      {"A { Angle 4\n Axiom XF\n X=@.5F }",
       "test:2:9: error: the scale here depends on the rule of a symbol before it"},
      {"A { Angle 4\n Axiom [F }", "test:2:9: error: a '[' of this string has no ']'"},
      {"A { Angle 4\n Axiom F>1F\n F=FF }",
       "test:2:9: warning: '>', which changes the colour by steps, has no effect"}};
  for (const auto& [text, message] : cases)
    EXPECT_NE(compiled(text).messages.find(message), std::string::npos) << text << "\n" << compiled(text).messages;
  // What a scale that leaves its rule does not reach is drawn.
  EXPECT_EQ(compiled("A { Angle 4\n Axiom F[+X][-X]\n X=F@.5X }").messages, "");
}

// ------------------------------------------------------------ L-Py

std::string stringOf(const std::string& text, uint32_t iterations) {
  const Compiled c = compiled(text);
  EXPECT_TRUE(c.table) << c.messages << text;
  return c.table ? print(*c.table, derive(*c.table, oneAxiom(), iterations).string) : std::string();
}

TEST(LsystemOfLpy, TheSameAsOurNotation) {
  // ABOP figure 1.9: branches, each shorter than the one before by a factor.
  const std::string theirs = R"(
R = 1.456 # of lengths
a = 85
Axiom: _(0.01) A(1)
derivation length: 6
production:
A(s) --> F(s)[+(a)A(s/R)][-(a)A(s/R)]
interpretation:
endlsystem
def __initialiseContext__(context):
    import openalea.plantgl.all as pgl
)";
  const std::string ours = "define: R 1.456\ndefine: a 85\naxiom: !(0.01) A(1)\niterations: 6\n"
                           "A(s) --> F(s)[+(a)A(s/R)][-(a)A(s/R)]\n";
  EXPECT_EQ(compiled(theirs).messages, "");
  for (uint32_t n = 0; n <= 6; ++n) EXPECT_EQ(stringOf(theirs, n), stringOf(ours, n)) << n;
  // A turn without a value is one of 60 degrees, or what the file says.
  EXPECT_EQ(segmentsOf("Axiom: F--F--F\nproduction:\nF --> F+F--F+F\n", 3).size(), 192u);
  EXPECT_NEAR(segmentsOf("Axiom: F--F--F\nproduction:\nF --> F+F--F+F\n", 3).back().to[1], 0, 1e-3);
  const auto square = segmentsOf("context().turtle.setAngleIncrement(90)\nAxiom: F-F-F-F\nproduction:\nF --> F\n", 1);
  EXPECT_NEAR(square[1].to[0], 1, 1e-6);
}

TEST(LsystemOfLpy, BodiesOfProductionsAreRead) {
  // Counts down, then becomes what the body says; a module that nothing is produced for stays.
  const std::string countdown = R"(Axiom: G(4,0) B
production:
G(x, t):
    if t == 0: produce G(x/2, 2) F(x)
    elif t > 5:
        pass
    else: produce G(x, t-1)
B :
    produce C(1 if 2 < 3 else 7)
C(i) :
    n = i * 2
    for k in range(2):
        nproduce F(n + k)
)";
  EXPECT_EQ(compiled(countdown).messages, "");
  EXPECT_EQ(stringOf(countdown, 1), "G_(2,2)F(4)C(1)");
  EXPECT_EQ(stringOf(countdown, 2), "G_(2,1)F(4)F(2)F(3)");
  EXPECT_EQ(stringOf(countdown, 4), "G_(1,2)F(2)F(4)F(2)F(3)");
  // Precedence, powers, division, and functions of numbers.
  EXPECT_EQ(stringOf(R"(from math import *
x = 2
y = -x ** 2 + 7 // 2 + 1 / 4
def f(a, b):
    if a > b: return a
    return b ** 0.5
Axiom: A(y, f(1, 16), f(3, 2), not x == 2 or y < 0)
production:
A(a,b,c,d) --> B(round(1.2345, 2), a if d else b)
)",
                     0),
            "A(-0.75,4,3,1)");
  EXPECT_EQ(stringOf("Axiom: Bud(1)Leaf\nmodule Bud, Leaf\nproduction:\nBud(x) --> Leaf Bud(x+1)\n", 2),
            "LeafLeafBud(3)Leaf");
  EXPECT_EQ(stringOf("Axiom: AB\nproduction:\nA < B --> C\nA > C --> D\n", 2), "DC");
  EXPECT_EQ(stringOf("Axiom: A\nproduction:\nA --> BB\ninterpretation:\nB --> F\n", 1), "FF");
}

TEST(LsystemOfLpy, WhatIsNotReadIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {"Axiom: A\nproduction:\nA :\n  x = [1, 2]\n  produce B\n",
       "test:4:7: error: Python's '[1, 2]' is not supported"},
      {"Axiom: A\nproduction:\nA :\n  for k in list:\n    produce B\n",
       "test:4:3: error: a loop over anything but range() is not supported"},
      {"Axiom: A\nproduction:\nA :\n  obj.grow()\n  produce B\n",
       "test:4:3: error: Python's 'obj.grow()' is not supported"},
      {"Axiom: A\nproduction:\nA(x+1) --> B\n", "test:3:4: error: a value that is not a name"},
      {"class A:\n  x = 1\nAxiom: A\nproduction:\nA --> B\n",
       "test:1:1: warning: Python's 'class' here is not supported"},
      {"Axiom: F@2DF\nproduction:\nF --> FF\n", "test:1:9: warning: the command '@2D' is not supported"},
      {"Axiom: F_F\nproduction:\nF --> FF\n", "test:1:9: warning: the command '_' without a value is not supported"},
      {"Axiom: A\ngroup 1:\nproduction:\nA --> B\n", "test:2:1: error: L-Py's 'group' is not supported"},
      {"Axiom: A(2\nproduction:\nA --> B\n", "test:2:1: error: 'production: ' in the values of 'A' is not supported"}};
  for (const auto& [text, message] : cases)
    EXPECT_NE(compiled(text).messages.find(message), std::string::npos) << text << "\n" << compiled(text).messages;
  for (const char* part : {"not ", "2**", "-", "(", "1+", "2*1 or "}) { // nothing goes on without end
    std::string text = "x = ";
    for (int i = 0; i < 100'000; ++i) text += part;
    EXPECT_NE(compiled(text + "1\nAxiom: A(x)\nproduction:\nA --> B\n").messages.find(" too "), std::string::npos)
        << part;
  }
}

} // namespace
} // namespace gpgp
