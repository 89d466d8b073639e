// Code of plant modellers: blocks in cpfg's files, and L+C, the language of lpfg. Strings in closed form.
#include "spawn/lsystem/compile.h"
#include "spawn/lsystem/reference.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

namespace gpgp {
namespace {

using namespace spawn::lsystem;
using spawn::Diagnostics;

using Files = std::map<std::string, std::string>;

std::string messagesOf(Diagnostics& diagnostics) {
  std::string all;
  for (const auto& d : diagnostics.sorted()) all += format(d, "x") + "\n";
  return all;
}

Table tableOf(const std::string& text, const Files& files = {}, std::string* messages = nullptr) {
  Diagnostics diagnostics;
  const auto words = compile(text, {}, diagnostics, [&](const std::string& path, std::string& into) {
    const auto found = files.find(path);
    if (found != files.end()) into = found->second;
    return found != files.end();
  });
  const std::string all = messagesOf(diagnostics);
  if (messages)
    *messages = all;
  else
    EXPECT_EQ(all, "") << text;
  if (!words) throw std::runtime_error("no L-system: " + all);
  auto table = Table::load(std::as_bytes(std::span(words.value())), std::pmr::new_delete_resource());
  if (!table) throw std::runtime_error(table.error().text);
  return *table;
}
GpgpAxiom axiomOf(uint32_t seed) {
  GpgpAxiom axiom{};
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.seed = seed;
  return axiom;
}
std::string stringOf(const Table& table, uint32_t iterations, uint32_t seed = 1) {
  const GpgpAxiom axiom = axiomOf(seed);
  return print(table, derive(table, {&axiom, 1}, iterations).string);
}
std::string after(const std::string& text, uint32_t iterations, const Files& files = {}) {
  return stringOf(tableOf(text, files), iterations);
}

TEST(LsystemCode, LoopsAreUnrolledAndArraysHoldNumbers) {
  EXPECT_EQ(after(R"(lsystem: 1
derivation length: 1
Define: { array length[3] = {1, 2, 4}; array square[4]; array grid[2][3] = {{1, 2, 3}, {4, 5, 6}}; }
Start: { i = 0; while (i < 4) { square[i] = i * i; i = i + 1; } }
axiom: A(2) C(1)
A(k) : * { s = 0; for (j = 0; j < 3; j++) { if (j == 1) continue; s += length[j]; } do s += 100; while (s < 200); }
  --> B(s, length[k], square[k + 1], square[9])
C(k) --> D(grid[k][2], grid[0][k])
endlsystem
)",
                  1),
            "B(205,4,9,9)D(6,2)");
}

TEST(LsystemCode, ValuesChangeFromStepToStep) {
  // The code before a step counts it; what stands behind it is seen by the step after it, and by homomorphism.
  const std::string text = R"(lsystem: 1
derivation length: 3
Start: { n = 10; m = 0; }
StartEach: { n = n + 1; }
EndEach: { m = n * n; }
axiom: A
A --> B(n, m) A
homomorphism
A --> C(n, m)
endlsystem
)";
  EXPECT_EQ(after(text, 3), "B(11,0)B(12,121)B(13,144)C(13,169)");
}

TEST(LsystemCode, FilesAreIncluded) {
  const std::string text = "#include \"numbers.h\"\n#include <math.h>\nlsystem: 1\nderivation length: 1\naxiom: A(N)\n"
                           "A(n) --> B(n + TWO)\nendlsystem\n";
  EXPECT_EQ(after(text, 1, {{"numbers.h", "#define N 3\n#include \"two.h\"\n"}, {"two.h", "#define TWO (1+1)\n"}}),
            "B(5)");
  std::string messages;
  tableOf("#include \"none.h\"\nlsystem: 1\nderivation length: 0\naxiom: F\nendlsystem\n", {}, &messages);
  EXPECT_EQ(messages, "x:1:1: warning: 'none.h' of an #include cannot be read; what it defines is missing\n");
}

TEST(LsystemCode, SubSystemsByNumber) {
  EXPECT_EQ(after(R"(lsystem: 1
derivation length: 2
axiom: A
A --> B ?(2, 1) A $ A
endlsystem
lsystem: 2
axiom: A
A --> C A C
endlsystem
)",
                  2),
            "BClsystem2.ACBlsystem2.AA");
}

TEST(LsystemCode, SeveralModulesAreRewrittenTogether) {
  EXPECT_EQ(
      after("lsystem: 1\nderivation length: 1\naxiom: A(1)B(2)C A(3)C\nA(x)B(y) > C --> D(x + y)\nendlsystem\n", 1),
      "D(3)CA(3)C");
}

const char* const kTree = R"(#include <lpfgall.h>
#define N 3 // steps
const float ratio = 0.5f;
const int fan[] = {10, 20};
module A(int, float);
module B(float), Done();
float half(float x) { if (x > 1) return x / 2; return x; }
int whole(int a, int b) { return a / b; }
derivation length: N;
axiom: A(0, 4);
production:
A(n, x) : {
  if (n >= 2) produce Done();
  nproduce F(half(x));
  for (int i = 0; i < 2; i++) {
    if (i == n) continue;
    nproduce SB() Left(fan[i]) B(x + i) EB();
  }
  produce A(n + 1.9, x * ratio);
}
B(x) < Done() : { produce F(1); }
F(d) < A(n, x) > B(y) : { produce ; }
B(x) : { int k = whole(7, 2); float y = 7 / 2; if (x > 4.5) produce B(k) ; else produce B(y + 1.0 / 4); }
)";

TEST(LsystemCode, LpfgProductionsHaveBodies) {
  const Table t = tableOf(kTree);
  EXPECT_EQ(stringOf(t, 1), "F(2)[+(20)B(5)]A(1,2)");
  EXPECT_EQ(stringOf(t, 2), "F(2)[+(20)B(3)]F(1)[+(10)B(2)]A(2,1)");
  EXPECT_EQ(stringOf(t, 3), "F(2)[+(20)B(3.25)]F(1)[+(10)B(3.25)]Done");
}

TEST(LsystemCode, LpfgDrawsOnceForAllWays) {
  // Both branches of a condition see the same random number: exactly one of them holds, for every seed.
  const Table t = tableOf(R"(#include <lpfgall.h>
module A();
module B(float);
module C(float);
derivation length: 1;
axiom: A();
A() : { float r = ran(1); if (r < 0.5) produce B(r); else produce C(r); }
)");
  uint32_t below = 0;
  for (uint32_t seed = 0; seed < 400; ++seed) {
    const std::string s = stringOf(t, 1, seed);
    float value = -1;
    char name = 0;
    ASSERT_EQ(std::sscanf(s.c_str(), "%c(%f)", &name, &value), 2) << s;
    EXPECT_EQ(name, value < 0.5f ? 'B' : 'C') << s;
    below += name == 'B' ? 1 : 0;
  }
  EXPECT_NEAR(below, 200, 60);
}

TEST(LsystemCode, LpfgLoopsThatParametersEnd) {
  std::string messages;
  const Table t = tableOf(R"(#include <lpfgall.h>
module A(int);
derivation length: 1;
axiom: A(3) A(0);
A(n) : { for (int i = 0; i < n; i++) nproduce F(i); produce Right(90); }
)",
                          {}, &messages);
  EXPECT_NE(messages.find("it turns at most 64 times"), std::string::npos) << messages;
  EXPECT_EQ(stringOf(t, 1), "F(0)F(1)F(2)-(90)-(90)");
}

TEST(LsystemCode, LpfgStepsAndInterpretation) {
  EXPECT_EQ(after(R"(#include <lpfgall.h>
#include <math.h>
int t;
module A();
derivation length: 4;
Start: { t = 0; }
StartEach: { t++; }
axiom: A();
A() : { produce F(t) A(); }
interpretation:
A() : { produce Sphere(sin(M_PI / 2) * t); }
)",
                  4),
            "F(1)F(2)F(3)F(4)@O(4)");
}

TEST(LsystemCode, WhatLpfgHasBesidesIsNamed) {
  std::string messages;
  const Table t = tableOf(R"(#include <lpfgall.h>
struct Leaf { int age; };
module A(int);
int count;
derivation length: 1;
axiom: A(1) MoveTo(0, 0, 0) SetHead(0, 1, 0, 0, 0, 1) SetHead(0, 1, 0, 0, 0, 1);
A(n) : { count++; Printf("%d\n", count); produce F(n); }
)",
                          {}, &messages);
  EXPECT_EQ(stringOf(t, 1), "F(1)");
  EXPECT_EQ(messages, "x:2:1: warning: this C++ is not supported, and is passed over: 'struct Leaf { int age; };'\n"
                      "x:6:13: warning: the command 'MoveTo' is not supported, and has no effect\n"
                      "x:6:29: warning: the command 'SetHead' is not supported, and has no effect\n"
                      "x:7:10: warning: 'count' is a value of all modules; what one of them sets, no other sees\n");
}

TEST(LsystemCode, ErrorsSayWhereAndWhat) {
  for (const auto& [text, expected] : {
           std::pair{"lsystem: 1\nderivation length: 1\naxiom: A(1)\nA(n) : * { while (n > 1) n = n - 1; } --> A(n)\n",
                     "4:12: error: the number of turns of a loop has to be known"},
           {"lsystem: 1\nderivation length: 1\nstart: { i = 0; while (1) i = i + 1; }\naxiom: A\nA --> B\n",
            "3:17: error: the loops of this code turn more than 100000 times"},
           {"lsystem: 1\nderivation length: 1\ndefine: { array a[n]; }\naxiom: A\nA --> B\n",
            "3:19: error: an array has a known number of elements"},
           {"#include <lpfgall.h>\nderivation length: 1;\nmodule A();\nA() : { produce A(; }\n",
            "4:19: error: expected a number"},
           {"#include <lpfgall.h>\nderivation length: 1;\nmodule A();\n", "there is no axiom"},
       }) {
    Diagnostics diagnostics;
    EXPECT_FALSE(compile(text, {}, diagnostics)) << text;
    const std::string all = messagesOf(diagnostics);
    EXPECT_NE(all.find(expected), std::string::npos) << expected << "\n" << all;
  }
}

} // namespace
} // namespace gpgp
