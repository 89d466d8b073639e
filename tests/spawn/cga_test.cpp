// .cga files: language, split layouts, and derivations of boxes and polygons in closed form.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "cga_run.h"
#include "spawn/cga/parser.h"
#include "spawn/cga/split_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>

namespace gpgp::spawn::cga {
namespace {

// ---------------------------------------------------------------- expressions

TEST(CgaLanguage, ValuesOfExpressions) {
  EXPECT_EQ(printed(R"(Lot --> print(1 + 2 * 3 - 4 / 2) print(7 % 3) print(-7 % 3) print(2 < 3 && !(3 < 2))
      print("a" + 1.5 + true) print(rint(2.5)) print(sqrt(16)) print(pow(2, 10)) print(sin(30)) print(atan2(1, 1))
      print(substring("hello", 1, 3)) print(find("abcabc", "c", 1)) print(replace("a-b-c", "-", "+"))
      print(listItem("a;b;c", 1)) print(count("banana", "an")) print(getPrefix("ab.cd", ".")) print(len("four"))
      print(float("2.5") * 2) print(isinf(1 / 0)) print(min(2, 3)) print(str(2) + "m") NIL)"),
            (std::vector<std::string>{"5", "1",     "-1", "true", "a1.5true", "3", "4", "1024", "0.5", "45", "el",
                                      "5", "a+b+c", "b",  "2",    "ab",       "4", "5", "true", "2",   "2m"}));
}

TEST(CgaLanguage, ArraysAreIndexedBySingleValuesRangesAndConditions) {
  EXPECT_EQ(printed(R"(const k = [1, 2, 3, 4.5]
      table = [1, 2; 3, 4]
      Lot --> print(k[1]) print(k[1:2]) print(k[-1]) print(k[:1]) print(size(k)) print(k[k .> 2]) print(table[1, 0])
              print(nRows(table)) print(["a"] + ["b"]) print(k[2:]) NIL)"),
            (std::vector<std::string>{"2", "[2,3]", "0", "[1,2]", "4", "[3,4.5]", "3", "2", "[a,b]", "[3,4.5]"}));
}

// The examples of the reference.
TEST(CgaLanguage, ArraysHaveRowsAndAreJoinedSideBySideAndBelowEachOther) {
  EXPECT_EQ(printed(R"(const a = [-1 ; -2]
      const b = [0:2 ; 3, 3, 3]
      const c = [a, b ; b, a]
      const m = [1, 2, 3; 4, 5, 6; 7, 8, 9]
      const v = [1, 2, 3, 4]
      fibonacci(n) = case n <= 2: [0:n-1] else: fibonacci([0, 1], n)
      fibonacci(f, n) = case size(f) == n: f else: fibonacci([f, f[size(f)-2] + f[size(f)-1]], n)
      Lot --> print(a) print(b) print(c) print(nRows(v)) print(nColumns(v)) print(fibonacci(10)) print([1:2:5])
              print(v[3:-1:1]) print(v[[0, 1; 2, 3]]) print(m[1, [0, 2]]) print(m[[0, 0, 1], 2]) print(m[0:2, [0, 2]])
              print(v[v .> 1 .&& v .<= 3]) print(m[[false, true, true], 0]) print(m[[2, 3], -1:1]) print(m[3])
              print(v[[false, false, true, true, true]]) NIL)"),
            (std::vector<std::string>{"[-1;-2]", "[0,1,2;3,3,3]", "[-1,0,1,2;-2,3,3,3;0,1,2,-1;3,3,3,-2]", "1", "4",
                                      "[0,1,1,2,3,5,8,13,21,34]", "[1,3,5]", "[4,3,2]", "[1,2;3,4]", "[4,6]", "[3;3;6]",
                                      "[1,3;4,6;7,9]", "[2,3]", "[4;7]", "[0,7,8;0,0,0]", "4", "[3,4,0]"}));
}

TEST(CgaLanguage, ArraysAreComparedSortedAndSetElementByElement) {
  EXPECT_EQ(printed(R"(const s = [1:7]
      const z = [0, 0, 0, 0, 0, 0]
      const t = [4, 0, 1; 2, 1, 9; 1, 3, 0; 2, 1, 0]
      Lot --> print([1, 2] == [1, 2]) print([1, 2] == [1; 2]) print(.![true, false]) print([1, 2] .+ [3, 4])
              print([1, 2] .* 3) print(.-[1, 2]) print(["a", "b"] .+ 1) print(setElems(z, 2, 1))
              print(setElems(z, [1:4], 1)) print(setElems(z, [5, 1, 3], [1:3])) print(setElems(s, s .> 4, [3, 2, 1]))
              print(setElems([0, 0; 0, 0], [1, 0], [1, 0], [1, 2; 3, 4])) print(setElems([1], 3, 9))
              print(sortIndices([2, 1, 3, 3, 1])) print(sortIndices(["e", "c", "d"; "b", "a", "c"]))
              print(sortRowIndices(t)) print(t[sortRowIndices(t), 0:nColumns(t)-1]) print(transpose([1, 2; 3, 4]))
              print(findFirst(["x", "y"], "y")) print(sum([1:4])) NIL)"),
            (std::vector<std::string>{"true",
                                      "false",
                                      "[false,true]",
                                      "[4,6]",
                                      "[3,6]",
                                      "[-1,-2]",
                                      "[a1,b1]",
                                      "[0,0,1,0,0,0]",
                                      "[0,1,1,1,1,0]",
                                      "[0,2,0,3,0,1]",
                                      "[1,2,3,4,3,2,1]",
                                      "[4,3;2,1]",
                                      "[1,0,0,9]",
                                      "[1,4,0,2,3]",
                                      "[1,2,0;4,3,5]",
                                      "[2,3,1,0]",
                                      "[1,3,0;2,1,0;2,1,9;4,0,1]",
                                      "[1,3;2,4]",
                                      "1",
                                      "10"}));
}

TEST(CgaLanguage, ComponentsHaveValues) {
  EXPECT_EQ(printed(R"(length = scope.sx
      largest(areas) = areas[sortIndices(areas)[size(areas) - 1]]
      attr perimeter = sum(comp(fe) { all: scope.sx })
      twice(n) = [n, n]
      Lot --> print(comp(v) { all: comp.index }) print(comp(fe) { front: length | back: 2 * length })
              print(perimeter) extrude(3) print(comp(f) { side: "s" | top: "t" }) print(comp(f) { side = geometry.area })
              print(largest(comp(f) { all: geometry.area })) print(twice(sum(comp(f) { side: geometry.area }))[1]) NIL)"),
            (std::vector<std::string>{"[0,1,2,3]", "[10,0,20,0]", "60", "[,s,s,s,s,t]", "[0,180,180,180,180,0]", "200",
                                      "180"}));
}

TEST(CgaLanguage, NoNumberIsToldFromNumbers) {
  EXPECT_EQ(printed(R"(const NaN = ln(-1)
      attr height = NaN
      const NULL = "\ue000"
      Lot --> print(isnan(height)) print(isNull(height)) print(isnan(ln(1))) print(isNull(NULL)) print(isNull("x")) NIL)"),
            (std::vector<std::string>{"true", "true", "false", "true", "false"}));
}

TEST(CgaLanguage, StringsMayGoOnInTheNextLineAndLeavesMayHaveCommentsBehindThem) {
  EXPECT_EQ(printed("@Description(\"two\nlines\")\nattr x = 1\nLot --> print(x) A.//done\n"),
            (std::vector<std::string>{"1"}));
}

TEST(CgaFiles, AreFoundAnywhereBelowAndWhateverTheirCapitals) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("gpgp_cga_files_" + std::to_string(std::random_device()()));
  fs::create_directories(folder / "assets" / "Deep" / "textures");
  const unsigned char png[24] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13,
                                 'I',  'H', 'D', 'R', 0,  0,  1,  2,  0, 0, 0, 7};
  for (const char* name : {"assets/Deep/textures/a.png", "assets/Deep/textures/b.png", "assets/Deep/c.png"})
    std::ofstream(folder / name, std::ios::binary).write(reinterpret_cast<const char*>(png), sizeof png);
  Messages messages;
  CompileOptions options;
  options.path = (folder / "main.cga").string();
  options.read = filesOnDisk();
  const auto program = compile(R"(Lot --> print(fileSearch("*textures/*.png")) print(size(filesSearch("*.png")))
      print(fileExists("ASSETS/deep/Textures/A.png")) print(fileExists("assets/Deep/d.png"))
      print(imageInfo("assets/Deep/c.png", sx)) print(imageInfo("assets/Deep/c.png", sy)) NIL)",
                               options, messages);
  ASSERT_TRUE(program) << allOf(messages);
  const std::vector<Axiom> axioms{lot(1, 1)};
  const Derivation d = derive(*program, axioms, {}, messages);
  fs::remove_all(folder);
  EXPECT_EQ(allOf(messages), "");
  EXPECT_EQ(d.prints, (std::vector<std::string>{"assets/Deep/textures/a.png;assets/Deep/textures/b.png;", "3", "true",
                                                "false", "258", "7"}));
}

TEST(CgaModules, StylesExtendTheDefaultAndPathsHaveAnySlash) {
  const std::map<std::string, std::string> files = {
      {"lib/a.cga", "attr x = 1\nattr y = 2\nShow --> print(x + y) NIL\nstyle Alt extends Default\nattr x = 10\n"}};
  const Derived d = run("import a(Alt) : \"lib\\a.cga\"\nLot --> a.Show", {lot(1, 1)}, {}, files);
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.all.prints, (std::vector<std::string>{"12"}));
}

TEST(CgaModules, AttributesOfTheImporterAreThoseOfTheImport) {
  const std::map<std::string, std::string> files = {{"st.cga", "attr height = 3\nattr width = 4\n"
                                                               "Show --> print(height + \" \" + width) NIL"}};
  const auto shows = [&](const std::string& import) {
    return run("attr height = 7\n" + import + "\nLot --> st.Show", {lot(10, 10)}, {}, files).all.prints;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(shows("import st : \"st.cga\""), Texts{"7 4"});
  EXPECT_EQ(shows("import st : \"st.cga\" (height)"), Texts{"3 4"});
  EXPECT_EQ(shows("import st : \"st.cga\" ()"), Texts{"3 4"});
  EXPECT_EQ(shows("import st : \"st.cga\" (height = 5, width = height * 2)"), Texts{"5 14"});
  EXPECT_EQ(shows("import st : \"st.cga\" (width)"), Texts{"7 4"});
  const Derived set =
      run("attr height = 7\nimport st : \"st.cga\"\nLot --> set(height, 9) st.Show", {lot(1, 1)}, {}, files);
  EXPECT_EQ(set.all.prints, Texts{"9 4"});
}

TEST(CgaLanguage, FunctionsLocalsAndRecursion) {
  EXPECT_EQ(printed(R"(fib(n) = case n < 2: n else: fib(n - 1) + fib(n - 2)
      dist(x, y) with (a := x * x  b := y * y) = sqrt(a + b)
      area = scope.sx * scope.sz
      area(k) = area * k
      Lot with (w := area) --> print(fib(15)) print(dist(3, 4)) s('2, '1, '1) print(w) print(area) print(area(2)) NIL)"),
            (std::vector<std::string>{"610", "5", "200", "400", "800"}));
}

/// An evaluator of its own beside the program: random expressions of numbers, and both trees' values.
struct Random {
  std::mt19937 random;
  std::string text;
  double value = 0;
  explicit Random(uint32_t seed) : random(seed) {}
  void make(int depth) {
    const auto draw = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
    if (depth == 0 || draw(6) == 0) {
      const uint32_t n = draw(40);
      text = std::to_string(n) + (draw(2) ? ".5" : "");
      value = n + (text.ends_with(".5") ? 0.5 : 0.0);
      return;
    }
    const uint32_t kind = draw(8);
    make(depth - 1);
    const std::string a = text;
    const double x = value;
    make(depth - 1);
    const std::string b = text;
    const double y = value;
    switch (kind) {
    case 0:
      text = "(" + a + " + " + b + ")";
      value = x + y;
      break;
    case 1:
      text = a + " - (" + b + ")";
      value = x - y;
      text = "(" + text + ")";
      break;
    case 2:
      text = "(" + a + ") * (" + b + ")";
      value = x * y;
      text = "(" + text + ")";
      break;
    case 3:
      text = "(case " + a + " < " + b + ": " + a + " else: " + b + ")";
      value = std::min(x, y);
      break;
    case 4:
      text = "max(" + a + ", " + b + ")";
      value = std::max(x, y);
      break;
    case 5:
      text = "abs(-" + a + ")";
      value = std::fabs(x);
      break;
    case 6:
      text = "floor(" + a + ")";
      value = std::floor(x);
      break;
    default:
      text = "(case !(" + a + " >= " + b + ") || " + a + " == " + b + ": 1 else: 0)";
      value = x < y || x == y ? 1 : 0;
    }
  }
};

TEST(CgaLanguage, RandomExpressionsAreWorthWhatAnotherEvaluatorSays) {
  std::string program = "Lot -->\n";
  std::vector<double> values;
  for (uint32_t i = 0; i < 400; ++i) {
    Random random(i);
    random.make(4);
    if (std::fabs(random.value) > 1e5) continue; // floats then round what doubles do not
    program += "  report(\"" + std::to_string(values.size()) + "\", " + random.text + ")\n";
    values.push_back(random.value);
  }
  ASSERT_GT(values.size(), 250u);
  const Derived derived = run(program + "  NIL\n");
  for (size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(derived.sum(std::to_string(i)), values[i], 1e-5 * (1 + std::fabs(values[i]))) << i;
}

TEST(CgaLanguage, MathIsRightToSixDigits) {
  std::string program = "Lot -->\n";
  std::vector<double> values;
  const auto add = [&](const std::string& text, double value) {
    program += "  report(\"" + std::to_string(values.size()) + "\", " + text + ")\n";
    values.push_back(value);
  };
  for (int i = -40; i <= 40; ++i) {
    const double x = i * 0.37, degree = 57.29577951308232;
    const std::string t = "(" + std::to_string(x) + ")";
    add("exp(" + t + ")", std::exp(x));
    add("atan(" + t + ")", std::atan(x) * degree);
    add("sin(10 * " + t + ")", std::sin(10 * x / degree));
    add("atan2(" + t + ", 3)", std::atan2(x, 3) * degree);
    if (x > 0) add("ln(" + t + ")", std::log(x));
    if (x > 0) add("pow(" + t + ", 1.7)", std::pow(x, 1.7));
    if (std::fabs(x) <= 1) add("acos(" + t + ")", std::acos(x) * degree);
  }
  const Derived derived = run(program + "  NIL\n");
  for (size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(derived.sum(std::to_string(i)), values[i], 3e-6 * (1 + std::fabs(values[i]))) << i << program;
}

// ---------------------------------------------------------------- splits

using Kind = SplitPart::Kind;
SplitPart absolute(float size) { return {Kind::absolute, size, 0, {}}; }
SplitPart floating(float size) { return {Kind::floating, size, 0, {}}; }
SplitPart repeated(std::vector<SplitPart> parts) { return {Kind::repeated, 0, 0, std::move(parts)}; }
std::vector<float> sizes(const std::vector<SplitPart>& parts, float length) {
  std::vector<Piece> pieces;
  EXPECT_TRUE(layOut(parts, length, 100000, pieces));
  std::vector<float> result;
  for (const Piece& p : pieces) result.push_back(p.to - p.from);
  return result;
}
void expectSizes(const std::vector<float>& got, const std::vector<float>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], 1e-4f) << i;
}

TEST(CgaSplit, SizesInClosedForm) {
  expectSizes(sizes({absolute(3), absolute(1)}, 5), {3, 1});
  expectSizes(sizes({absolute(3), absolute(4)}, 5), {3, 2});                  // cut off
  expectSizes(sizes({absolute(0), absolute(-1), absolute(2)}, 5), {2});       // no part
  expectSizes(sizes({floating(1), absolute(2), floating(3)}, 10), {2, 2, 6}); // in proportion
  expectSizes(sizes({floating(1), absolute(12)}, 10), {10});                  // nothing left
  expectSizes(sizes({repeated({floating(2.1f)})}, 10), {2, 2, 2, 2, 2});      // stretches least
  expectSizes(sizes({repeated({absolute(3)})}, 10), {3, 3, 3});               // as fits whole
  expectSizes(sizes({absolute(1), repeated({floating(2)}), absolute(1)}, 10), {1, 2, 2, 2, 2, 1});
  expectSizes(sizes({floating(1), repeated({absolute(2), floating(1)}), floating(1)}, 11), {1, 2, 1, 2, 1, 2, 1, 1});
  std::vector<Piece> pieces;
  EXPECT_FALSE(layOut({repeated({floating(1e-4f)})}, 1e6f, 100000, pieces));
}

TEST(CgaSplit, RandomLayoutsFillAndNeverOverlap) {
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    const auto draw = [&] { return static_cast<float>(random() % 1000) / 100.0f - 0.5f; };
    std::function<std::vector<SplitPart>(int)> parts = [&](int depth) {
      std::vector<SplitPart> list(1 + random() % 3);
      for (SplitPart& part : list) {
        const uint32_t kind = static_cast<uint32_t>(random() % (depth ? 4 : 2));
        part.kind = static_cast<Kind>(kind);
        part.size = draw();
        if (kind >= 2) part.parts = parts(depth - 1);
      }
      return list;
    };
    const float length = 1 + static_cast<float>(random() % 500) / 10.0f;
    std::vector<Piece> pieces;
    if (!layOut(parts(2), length, 20000, pieces)) continue;
    float at = 0;
    for (const Piece& p : pieces) {
      EXPECT_GE(p.from, at - 1e-3f);
      EXPECT_GT(p.to, p.from);
      EXPECT_LE(p.to, length * (1 + 1e-5f));
      at = p.to;
    }
  }
}

// ---------------------------------------------------------------- shapes

TEST(CgaShapes, ExtrusionAndItsFaces) {
  const Derived d = run(R"(Lot --> extrude(6) report("volume", geometry.volume) report("area", geometry.area) Mass
      Mass --> comp(f) { top: Top | bottom: Bottom | front: Front | side: Side }
      Top --> report("top", geometry.area) Top.
      Bottom --> report("bottom", geometry.area) Bottom.
      Front --> report("front", scope.sx * scope.sy) Front.
      Side --> report("side", geometry.area) Side.)");
  EXPECT_EQ(d.messages, "");
  EXPECT_FLOAT_EQ(static_cast<float>(d.sum("volume")), 1200);
  EXPECT_FLOAT_EQ(static_cast<float>(d.sum("area")), 2 * (200 + 60 + 120));
  EXPECT_FLOAT_EQ(static_cast<float>(d.sum("top")), 200);
  EXPECT_FLOAT_EQ(static_cast<float>(d.sum("bottom")), 200);
  EXPECT_FLOAT_EQ(static_cast<float>(d.sum("front")), 60);
  EXPECT_FLOAT_EQ(static_cast<float>(d.sum("side")), 60 + 120 + 120);
  EXPECT_EQ(d.rules.at("Side"), 3u);
  EXPECT_EQ(d.all.triangles, 12u);
}

TEST(CgaShapes, SplitsKeepVolumesAndCountParts) {
  const Derived d = run(R"(Lot --> extrude(9) split(y) { { ~3: Floor }* }
      Floor --> split(x) { 1: A(split.index, split.total) | { ~2: split(z) { '0.5: B | ~1: C } }* | 1: A(0, 0) }
      A(i, n) --> report("volume", geometry.volume) report("total", n)
      B --> report("volume", geometry.volume)
      C --> report("volume", geometry.volume))");
  EXPECT_EQ(d.messages, "");
  EXPECT_NEAR(d.sum("volume"), 1800, 1e-3);
  EXPECT_EQ(d.rules.at("A"), 6u);
  EXPECT_EQ(d.rules.at("B"), 12u);
  EXPECT_EQ(d.rules.at("C"), 12u);
  EXPECT_EQ(d.sum("total"), 3 * 6); // parts of each floor, of the first A of each
}

TEST(CgaShapes, AttributesGoToChildrenAndComeBackBehindBrackets) {
  EXPECT_EQ(printed(R"(attr a = 1
      Lot --> [ set(a, 2) Child ] print(a) set(a, a + 2) Child print(scope.tx) t(3, 0, 0) print(scope.tx) NIL
      Child --> print(a) NIL)"),
            (std::vector<std::string>{"1", "0", "3", "2", "3"}));
}

TEST(CgaShapes, ImportsHaveValuesOfTheirOwn) {
  const Derived d =
      run(R"(import w : "wall.cga" (height = 5, Paint --> color("#ff0000") Painted)
      import v : "wall.cga"
      Lot --> print(w.height) print(v.height) set(v.height, 7) [ w.Wall ] v.Wall
      Painted --> Painted.)",
          {lot(10, 20)}, {},
          {{"wall.cga", "attr height = 3\nWall --> extrude(height) report(\"h\", height) Paint\nPaint --> Plain."}});
  EXPECT_EQ(d.messages, "");
  EXPECT_EQ(d.all.prints, (std::vector<std::string>{"5", "3"}));
  EXPECT_EQ(d.sum("h"), 12);
  EXPECT_EQ(d.rules.at("Painted"), 1u);
  EXPECT_EQ(d.rules.at("Plain"), 1u);
}

TEST(CgaShapes, StochasticRulesFollowTheirPercentages) {
  std::vector<Axiom> axioms;
  for (uint32_t i = 0; i < 20000; ++i) axioms.push_back(lot(1, 1, i));
  const Derived d = run("Lot --> 30%: A. 20%: case scope.sx > 5: B. else: 50%: C. else: D. else: E.", axioms);
  EXPECT_EQ(d.all.leaves.size(), 20000u);
  EXPECT_NEAR(static_cast<double>(d.rules.at("A")), 6000, 300);
  EXPECT_NEAR(static_cast<double>(d.rules.at("C")), 2000, 200);
  EXPECT_NEAR(static_cast<double>(d.rules.at("D")), 2000, 200);
  EXPECT_NEAR(static_cast<double>(d.rules.at("E")), 10000, 400);
}

TEST(CgaShapes, ThreadsChangeNothing) {
  std::vector<Axiom> axioms;
  for (uint32_t i = 0; i < 200; ++i) axioms.push_back(lot(10, 10 + static_cast<float>(i % 7), i));
  const char* text = R"(attr h = rand(3, 30)
      Lot --> extrude(h) comp(f) { side: split(y) { ~3: Floor }* | top: 50%: Flat. else: Green. }
      Floor --> split(x) { ~rand(1, 3): Tile }*
      Tile --> color(rand, rand, rand) report("r", rand) Tile.)";
  DeriveOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const Derived a = run(text, axioms, one), b = run(text, axioms, three);
  ASSERT_GT(a.all.leaves.size(), 10000u);
  ASSERT_EQ(a.all.leaves.size(), b.all.leaves.size());
  EXPECT_EQ(a.sum("r"), b.sum("r"));
  for (size_t i = 0; i < a.all.leaves.size(); ++i) ASSERT_EQ(a.all.leaves[i].color, b.all.leaves[i].color);
}

TEST(CgaShapes, PolygonsWithHoles) {
  Axiom axiom;
  axiom.points = {{0, 0, 10}, {10, 0, 10}, {10, 0, 0}, {0, 0, 0}, {3, 0, 3}, {7, 0, 3}, {7, 0, 7}, {3, 0, 7}};
  axiom.loopSizes = {4, 4};
  const Derived d = run(R"(Lot --> report("area", geometry.area) report("holes", geometry.nHoles)
      extrude(2) report("volume", geometry.volume) split(x) { 5: Half | ~1: Half }
      Half --> report("half", geometry.volume) Half.)",
                        {axiom});
  EXPECT_EQ(d.messages, "");
  EXPECT_NEAR(d.sum("area"), 84, 1e-3);
  EXPECT_EQ(d.sum("holes"), 1);
  EXPECT_NEAR(d.sum("volume"), 168, 1e-3);
  EXPECT_NEAR(d.sum("half"), 168, 1e-3);
  EXPECT_EQ(d.rules.at("Half"), 2u);
}

// ---------------------------------------------------------------- messages and limits

TEST(CgaMessages, ErrorsHavePlacesAndSuggestions) {
  Messages messages;
  EXPECT_FALSE(compiled(
      "attr height = 3\nLot --> extrude(heigth)\n  t(1, 2)\nA --> comp(f) { top Roof }\nB --> \"x\"\n", messages));
  const std::string all = allOf(messages);
  EXPECT_NE(
      all.find("main.cga:2:17: error: there is no attribute, constant or function 'heigth'; did you mean 'height'?"),
      std::string::npos)
      << all;
  EXPECT_NE(all.find("main.cga:3:3: error: 't' takes 3 values, not 2"), std::string::npos) << all;
  EXPECT_NE(all.find("main.cga:4:21: error: expected ':' behind a size or a selector"), std::string::npos) << all;
  EXPECT_NE(all.find("main.cga:5:7"), std::string::npos) << all;
}

TEST(CgaMessages, WhatIsNotSupportedIsNamedOnceAndTheRestDerives) {
  const Derived d = run("Lot --> pointCloud('0.5) { all : A | 2 : B C } splitPerimeter(1) { ~2 : A } newFunction(3) "
                        "insert(3) insert(4) extrude(2 + rando(7)) Unknown\n");
  EXPECT_EQ(d.all.leaves.size(), 2u);
  EXPECT_NE(d.messages.find("main.cga:1:92: warning: the operation 'insert' is not supported, and does nothing (and "
                            "1 more of these)"),
            std::string::npos)
      << d.messages;
  EXPECT_NE(d.messages.find("'pointCloud' is not supported"), std::string::npos) << d.messages;
  EXPECT_NE(d.messages.find("main.cga:1:48: warning: there is no operation 'splitPerimeter'; it and its block do "
                            "nothing"),
            std::string::npos)
      << d.messages;
  EXPECT_NE(d.messages.find("warning: there is no function 'rando', and it is 0; did you mean 'rand'?"),
            std::string::npos)
      << d.messages;
}

TEST(CgaMessages, LimitsEndInErrorsThatNameThem) {
  DeriveOptions options;
  options.maxShapes = 10000;
  const auto says = [&](const std::string& text, const std::string& what) {
    const Derived d = run(text, {lot(10, 10)}, options);
    EXPECT_NE(d.messages.find(what), std::string::npos) << d.messages;
  };
  says("Lot --> Lot", "2000 rules behind the axiom; maxDepth (--max-depth) allows more");
  says("Lot --> split(x) { ~0.0005: A. }*", "more than 10000 shapes");
  says("f(x) = f(x + 1)\nLot --> t(f(1), 0, 0)", "functions call each other deeper than 512");
  says("Lot --> split(x) { ~0.000005: A. }*", "a split has more than 1000000 parts");
}

TEST(CgaMessages, AttributesThatNeedThemselves) {
  Messages messages;
  EXPECT_FALSE(compiled("attr a = b\nattr b = a\nLot --> extrude(a)", messages));
  EXPECT_NE(allOf(messages).find("needs itself"), std::string::npos) << allOf(messages);
}

TEST(CgaMessages, AnnotationsAreReadable) {
  Messages messages;
  const auto program =
      compiled("@Group(\"Size\", 1) @Range(min=2, max=9.5) @Hidden\nattr h = 3\nLot --> extrude(h)", messages);
  ASSERT_TRUE(program) << allOf(messages);
  ASSERT_EQ(program->attributes.size(), 1u);
  const AttributeInfo& h = program->attributes[0];
  ASSERT_EQ(h.annotations.size(), 3u);
  EXPECT_EQ(h.annotations[0].values[0].text, "Size");
  EXPECT_EQ(h.annotations[1].values[1].name, "max");
  EXPECT_EQ(h.annotations[1].values[1].number, 9.5);
}

/// Pieces of programs in any order: errors or derivations, but no crash.
TEST(CgaMessages, RandomProgramsNeverCrash) {
  const char* kPieces[] = {"Lot",      "A",       "-->",  "=",       "(",    ")",      "{",      "}",     "[",
                           "]",        "|",       ":",    "*",       "~",    "'",      "1",      "2.5",   "x",
                           "f",        "split",   "comp", "extrude", "case", "else",   "30",     "%",     "\"s\"",
                           "attr",     "const",   "+",    "-",       ",",    "t",      "s",      "set",   "rand",
                           "scope.sx", "top",     "side", "all",     "NIL",  "A.",     "\n",     "color", "offset",
                           "roofHip",  "setback", "&&",   "==",      "<",    "@Range", "import", "with",  ":="};
  std::mt19937 random(11);
  size_t derived = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = i % 2 ? "Lot --> " : "attr x = 1\nf(a) = a\nLot --> extrude(3) A\nA --> ";
    for (uint32_t n = static_cast<uint32_t>(random() % 14); n--;)
      text += std::string(kPieces[random() % std::size(kPieces)]) + " ";
    Messages messages;
    const auto program = compiled(text, messages);
    EXPECT_EQ(!program, messages.hasErrors());
    if (!program || ++derived > 60) continue;
    DeriveOptions options;
    options.threads = 1;
    options.maxDepth = 50;
    options.maxShapes = 2000;
    derive(*program, {lot(3, 4)}, options, messages);
  }
  EXPECT_GT(derived, 60u);
}

TEST(CgaSamples, Derive) {
  for (const char* name : {"house", "tower", "facade", "parking"}) {
    std::ifstream file(std::string(GPGP_CGA_SAMPLES) + "/" + name + ".cga");
    std::ostringstream text;
    text << file.rdbuf();
    std::vector<Axiom> axioms;
    for (uint32_t seed = 0; seed < 8; ++seed) axioms.push_back(lot(30, 36, seed));
    const Derived d = run(text.str(), axioms);
    EXPECT_EQ(d.messages, "") << name;
    EXPECT_GT(d.all.triangles, 3000u) << name;
    for (const Vertex& v : d.all.vertices) ASSERT_TRUE(std::isfinite(v.position.x + v.normal.y + v.uv.x)) << name;
  }
}

} // namespace
} // namespace gpgp::spawn::cga
