// What bounds a derivation of a .cga file: faces, vertices, meshes and work, for programs that grow without end and for
// ten thousand random ones.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict" // gcc 12 sees overlaps in sums of strings where there are none
#endif
#include "cga_run.h"

#include <random>

namespace gpgp::spawn::cga {
namespace {

void says(const Derived& d, const std::string& what) {
  EXPECT_NE(d.messages.find(what), std::string::npos) << d.messages;
}

TEST(CgaLimits, FacesOfAShapeAreNamedWithRuleOperationAndPlace) {
  DeriveOptions options;
  options.maxFaces = 1000;
  // Each turn makes of every face a solid of six.
  const Derived d = run("Lot -->\n  extrude(1) A\nA -->\n  t(0, 1, 0)\n  extrude(0.5) A", {lot(10, 10)}, options);
  says(d, "main.cga:5:3: error: rule 'A', 'extrude': a shape has ");
  says(d, " faces, more than 1000; maxFaces (--max-faces) allows more");
  EXPECT_LT(d.all.work, 1'000'000u);
  options = {};
  options.maxVertices = 500;
  says(run("Lot --> primitiveSphere(64, 64)", {lot(1, 1)}, options),
       "main.cga:1:9: error: rule 'Lot', 'primitiveSphere': a shape has 4034 vertices, more than 500; maxVertices "
       "(--max-vertices)");
}

TEST(CgaLimits, WorkAndMeshesOfAnAxiomAreBounded) {
  DeriveOptions options;
  options.maxWork = 3'000'000;
  const Derived d = run("Lot --> offset(-0.01) offset(0.01) Lot", {lot(10, 10)}, options);
  says(d, "main.cga:1:");
  says(
      d,
      ": error: rule 'Lot', 'offset': the geometry of one axiom takes more than 3 million steps; maxWork (--max-work)");
  EXPECT_LT(d.all.work, 2 * options.maxWork);
  const Derived kept = run("Lot --> B. offset(-0.01) offset(0.01) Lot", {lot(10, 10)}, options); // what came before
  says(kept, "--max-work");
  EXPECT_GE(kept.rules.at("B"), 2u);
  EXPECT_GT(kept.all.triangles, 2u);
  options = {};
  options.maxGeometryMiB = 4;
  const Derived e = run("Lot --> primitiveSphere(64, 64) s('1.01, '1, '1) tileUV(0, 1, 1) Lot", {lot(1, 1)}, options);
  says(e, "main.cga:1:");
  says(e, ": error: rule 'Lot', '");
  says(e, "': the meshes of one axiom need more than 4 MiB; maxGeometryMiB (--max-geometry) allows more");
  // Drawing shares meshes, but not triangles.
  const Derived f = run("Lot --> primitiveSphere(64, 64) split(x) { ~1: A | ~1: A } A --> B B B B B B B B "
                        "B --> C. C. C. C. C. C. C. C.",
                        {lot(1, 1)}, options);
  says(f, "error: the triangles of one axiom need more than 4 MiB; maxGeometryMiB (--max-geometry) allows more");
  EXPECT_TRUE(run("Lot --> primitiveSphere(64, 64) A. A. A.").messages.empty());
}

/// A façade that is cut, offset and cut again in itself: bridges of one line double the outline's corners.
TEST(CgaLimits, ARecursingFacadeEndsSoon) {
  const char* text = R"(Lot --> extrude(9) comp(f) { side: Facade | top: Facade }
Facade -->
  split(x) { ~1: Wall | ~1: offset(-0.2) Facade | ~1: Wall }
Wall --> offset(-0.1, border) split(y) { ~1: Facade | { ~0.7: extrude(0.1) comp(f) { all = Facade } }* })";
  DeriveOptions options;
  options.maxWork = 20'000'000;
  const Derived d = run(text, {lot(12, 9)}, options);
  says(d, "error: ");
  EXPECT_LT(d.all.work, 2 * options.maxWork);
}

TEST(CgaLimits, ComponentsOfLargeShapesTakeWorkInProportion) {
  uint64_t last = 0;
  for (const int n : {16, 32, 64, 128}) {
    const std::string sides = std::to_string(n);
    const Derived d = run("Lot --> primitiveSphere(" + sides + ", " + sides +
                          ") comp(e) { border: B. | ridge: B. | top: A. } comp(v) { border: B. | top: A. } "
                          "comp(fe) { border: B. | top: A. } comp(f) { border: B. | aslant: A. }");
    if (last) {
      EXPECT_LT(d.all.work, 6 * last) << n;
    }
    last = d.all.work;
    EXPECT_EQ(d.rules.count("B"), 0u);
  }
}

/// Programs of a grammar of their own: all operations with values that mean something, rules that call each other in
/// any way.
class Writer {
public:
  explicit Writer(uint32_t seed) : random_(seed) {}
  std::string program() {
    rules_ = 1 + below(4);
    std::string text = "attr a = " + plain() + "\nf(x) = case x > 8: x - 3 else: x + 1\n";
    for (uint32_t r = 0; r < rules_; ++r) {
      text += (r ? "R" + std::to_string(r) : std::string("Lot")) + " -->\n ";
      text += r ? body(3) : (below(2) ? " extrude(" + number() + ")" : std::string()) + body(3);
      text += "\n";
    }
    return text;
  }

private:
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  const char* one(std::initializer_list<const char*> list) { return list.begin()[below(uint32_t(list.size()))]; }
  std::string number() {
    switch (below(9)) {
    case 0: return "rand(" + std::to_string(below(5)) + ", 9)";
    case 1: return "'" + std::string(one({"0.5", "1.1", "0.25"}));
    case 2: return "scope.s" + std::string(one({"x", "y", "z"}));
    case 3: return one({"-1", "0", "-0.2", "90"});
    case 4: return "f(" + std::to_string(below(9)) + ")";
    case 5: return one({"geometry.area", "geometry.nFaces", "a", "split.index", "comp.total"});
    default: return std::to_string(below(8)) + one({"", ".5", ".25"});
    }
  }
  std::string plain() { return std::to_string(below(6)) + one({"", ".5", ".3"}); }
  std::string rule() {
    const uint32_t r = below(rules_ + 1);
    return r == rules_ ? one({"X.", "NIL", "Y."}) : r ? "R" + std::to_string(r) : std::string("Lot");
  }
  std::string selector() {
    return one({"front", "side", "top", "bottom", "all", "0", "-1", "world.south", "border", "inside", "aslant",
                "vertical", "ridge", "eave", "object.left", "street.front", "isTagged(\"t\")", "isTagged(\"roof\")"});
  }
  std::string parts(int depth, bool isSplit) {
    std::string text = "{ ";
    for (uint32_t i = 0, n = 1 + below(3); i < n; ++i) {
      if (i) text += " | ";
      if (isSplit && depth > 1 && below(4) == 0)
        text += parts(depth - 1, true) + one({"", "*"});
      else if (isSplit)
        text += one({"~1", "~2.1", "'0.3", "1", "0.7", "~0.4"}) + std::string(":") + body(depth - 1);
      else
        text += selector() + one({":", ":", "="}) + body(depth - 1);
    }
    return text + " }";
  }
  std::string body(int depth) {
    std::string text;
    for (uint32_t n = below(4); n--;) text += " " + operation(depth);
    if (depth == 0 || inCase_ || below(6)) return text + " " + rule();
    inCase_ = true; // a second one would be the first one's next condition
    text += " case " + (below(2) ? number() + " > 3" : "inside(\"l\") || touches(\"l\")") + ":" + body(depth - 1);
    text += " else:" + body(depth - 1);
    inCase_ = false;
    return text;
  }
  std::string operation(int depth) {
    if (depth > 0 && below(3) == 0) {
      switch (below(12)) {
      case 0: return "comp(" + std::string(one({"f", "e", "fe", "v", "g", "h", "m"})) + ") " + parts(depth, false);
      case 1: return "comp(f) " + parts(depth, false);
      case 2: return "setback(" + plain() + ") " + parts(depth, false);
      case 3: return "setbackPerEdge(comp.index + " + plain() + ") " + parts(depth, false);
      case 4:
        return "shapeL(" + plain() + ", " + plain() + ") { shape:" + body(depth - 1) +
               " | remainder:" + body(depth - 1) + " }";
      case 5: return "innerRectangle(edge) { shape:" + body(depth - 1) + " | remainder:" + body(depth - 1) + " }";
      case 6: return "scatter(surface, " + std::to_string(below(6)) + ", uniform) {" + body(depth - 1) + " }";
      case 7: return "splitArea(" + std::string(one({"x", "y", "z"})) + ") " + parts(depth, true);
      case 8: return "inline(" + std::string(one({"append", "unify", "recompose"})) + ") {" + body(depth - 1) + " }";
      case 9:
        return std::string(one({"union", "subtract", "intersect"})) + " {" + body(depth - 1) + " |" + body(depth - 1) +
               " }";
      case 10: return "setbackToArea(" + number() + ") " + parts(depth, false);
      default: return "split(" + std::string(one({"x", "y", "z", "x", "y", "u", "v"})) + ") " + parts(depth, true);
      }
    }
    switch (below(24)) {
    case 0: return "extrude(" + number() + ")";
    case 1:
      return "extrude(" + std::string(one({"world.y", "vertex.normal", "face.normal", "scope.x"})) + ", " + plain() +
             ")";
    case 2: return "offset(" + std::string(one({"-", ""})) + plain() + one({"", ", inside", ", border"}) + ")";
    case 3: return "roofGable(" + number() + ", " + plain() + ", " + plain() + ")";
    case 4: return "roofHip(" + number() + ", " + plain() + ")";
    case 5: return std::string(one({"roofPyramid(", "roofShed(", "taper("})) + number() + ")";
    case 6: return "t(" + number() + ", " + number() + ", " + number() + ")";
    case 7: return "s(" + number() + ", " + number() + ", " + number() + ")";
    case 8: return "r(" + plain() + ", " + plain() + ", 30)";
    case 9: return "center(" + std::string(one({"x", "xz", "xyz"})) + ")";
    case 10:
      return std::string(
          one({"alignScopeToAxes(y)", "alignScopeToGeometry(yUp, any, longest)", "alignScopeToGeometryBBox(y)"}));
    case 11: return "setupProjection(0, scope.xy, " + plain() + ", " + plain() + ") projectUV(0)";
    case 12:
      return std::string(
          one({"normalizeUV(0, uv, separatePerFace)", "rotateUV(0, 30)", "tileUV(0, 1, 2)", "deleteUV(0)"}));
    case 13:
      return std::string(
          one({"cleanupGeometry(all, 1)", "convexify()", "deleteHoles()", "rectify(10)", "reverseNormals()"}));
    case 14: return "reduceGeometry(" + std::string(one({"0.5", "1", "0.1"})) + ")";
    case 15: return "tag(\"" + std::string(one({"t", "u.v", "w"})) + "\"" + one({"", ", edges", ", faces"}) + ")";
    case 16: return "deleteTags(\"" + std::string(one({"t", "u", "?"})) + "\")";
    case 17:
      return std::string(one(
          {"primitiveCube()", "primitiveCylinder(8)", "primitiveSphere(6, 4)", "primitiveDisk(5)", "primitiveQuad()"}));
    case 18: return "envelope(normal, " + plain() + ", 1, 45, 1, 60, 1, 80, 1, 30)";
    case 19: return "mirror(true, false, " + std::string(one({"true", "false"})) + ")";
    case 20: return "label(\"l\") report(\"r\", geometry.volume)";
    case 21:
      return "setupProjection(0, scope.xz, 1, 1) projectUV(0) insertAlongUV(0, \"builtin:cube\", " + plain() + ")";
    case 22: return "color(rand, 1, 0)";
    default: return std::string(one({"[ t(1, 0, 0) Z. ]", "set(a, a + 1)", "color(\"#ff0000\")", "resetGeometry()"}));
    }
  }
  std::mt19937 random_;
  uint32_t rules_ = 1;
  bool inCase_ = false;
};

/// The work of an operation that is under way when there is none left, of shapes as small as here.
constexpr uint64_t kRest = 2'000'000;

TEST(CgaLimits, TenThousandRandomProgramsEndWithinTheirWork) {
  DeriveOptions options;
  options.threads = 1;
  options.maxDepth = 40;
  options.maxShapes = 1500;
  options.maxFaces = 2000;
  options.maxVertices = 8000;
  options.maxGeometryMiB = 16;
  options.maxInstructions = 50'000;
  options.maxWork = 400'000;
  uint64_t most = 0, over = 0, whole = 0;
  for (uint32_t seed = 0; seed < 10'000; ++seed) {
    const std::string text = Writer(seed).program();
    Messages messages;
    const auto program = compiled(text, messages);
    ASSERT_TRUE(program) << text << allOf(messages);
    const Derivation all = derive(*program, {lot(6, 5, seed)}, options, messages);
    most = std::max(most, all.work);
    ASSERT_LE(all.work, options.maxWork + kRest) << text;
    over += messages.hasErrors();
    whole += !messages.hasErrors();
    for (const Vertex& v : all.vertices)
      ASSERT_TRUE(std::isfinite(v.position.x + v.position.y + v.position.z + v.normal.x)) << text;
    for (const uint32_t i : all.indices) ASSERT_LT(i, all.vertices.size()) << text;
  }
  EXPECT_GT(over, 500u);
  EXPECT_GT(whole, 2000u);
  std::printf("%llu ended by a limit, %llu whole, at most %llu steps\n", static_cast<unsigned long long>(over),
              static_cast<unsigned long long>(whole), static_cast<unsigned long long>(most));
}

} // namespace
} // namespace gpgp::spawn::cga
