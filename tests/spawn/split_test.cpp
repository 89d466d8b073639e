// SubDiv and Repeat: nothing of them reaches out of the shape that they split, and they share it without gaps.
#include "divisions.h"
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using spawn::makeAxiom;

struct Piece {
  uint32_t terminal;
  float from, to; // along X
};
std::vector<Piece> piecesOf(const std::string& rules, float size) {
  const GpgpAxiom axiom = makeAxiom(size, 1, 1);
  std::vector<Piece> pieces;
  const auto words =
      bake("axiom Box A; terminal P (1,0); terminal Q (1,1); terminal W (1,2); terminal F (1,3);" + rules);
  for (const GpgpInstance& i : spawn::derive(words, std::span(&axiom, 1)).instances)
    pieces.push_back({i.terminal, i.transform[3] - i.size[0] / 2, i.transform[3] + i.size[0] / 2});
  return pieces;
}

TEST(Splits, FixedLengthsEndWhereTheShapeEnds) {
  for (const char* first : {"3", "Exp(ShapeSize(Y)*3)"}) { // a constant, and what is not
    const auto pieces = piecesOf("A = SubDiv(X) { " + std::string(first) + ": P | -1: W | 3: Q };", 5);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_FLOAT_EQ(pieces[0].from, -2.5f);
    EXPECT_FLOAT_EQ(pieces[0].to, 0.5f);
    EXPECT_EQ(pieces[1].terminal, 1u);
    EXPECT_FLOAT_EQ(pieces[1].from, 0.5f);
    EXPECT_FLOAT_EQ(pieces[1].to, 2.5f);
  }
  EXPECT_EQ(piecesOf("A = SubDiv(X) { 5: P | 3: Q | -1: W };", 5).size(), 1u);
  EXPECT_EQ(piecesOf("A = SubDiv(X) { 2: Discard() | 4: Q | 1: Discard() };", 5).at(0).to, 2.5f); // passes on one
  EXPECT_EQ(piecesOf("A = SubDiv(X) { 6: Discard() | 4: Q };", 5).size(), 0u);
  const auto narrow = piecesOf("A = SubDiv(X) { 1: P | -1: Repeat(X,1.2,ADJUST_TO_FILL) F | 1: Q };", 1.5f);
  ASSERT_EQ(narrow.size(), 2u);
  EXPECT_FLOAT_EQ(narrow[1].from, 0.25f);
  EXPECT_FLOAT_EQ(narrow[1].to, 0.75f);
}

TEST(Splits, RoundingLeavesNoSlivers) {
  std::string parts;
  for (int i = 0; i < 11; ++i) parts += std::string(i ? " | " : "") + "0.1: P";
  for (const float size : {0.9f, 1.0f, 0.7f, 0.3f}) {
    const auto pieces = piecesOf("A = SubDiv(X) { " + parts + " };", size);
    EXPECT_EQ(pieces.size(), std::lround(size * 10)) << size;
    for (const Piece& p : pieces) EXPECT_NEAR(p.to - p.from, 0.1f, 1e-5f);
  }
}

TEST(Splits, PiecesStayWithinAndLeaveNoGaps) {
  std::mt19937 random(5);
  const auto number = [&](double low, double high) { return low + (high - low) * double(random() % 10000) / 10000; };
  for (int turn = 0; turn < 300; ++turn) {
    std::string rules = "A = SubDiv(X) { ";
    const int parts = 1 + int(random() % 6);
    bool weights = false;
    double fixedLengths = 0;
    for (int p = 0; p < parts; ++p) {
      const double value = random() % 3 ? number(0.1, 3) : -number(0.1, 3);
      weights = weights || value < 0;
      fixedLengths += std::max(value, 0.0);
      const std::string text = std::to_string(value);
      rules += (p ? " | " : "") + (random() % 2 ? text : "Exp(ShapeSize(Y) * " + text + ")") + ": P";
    }
    const float size = float(number(0.2, 8));
    const auto pieces = piecesOf(rules + " };", size);
    float at = -size / 2;
    for (const Piece& p : pieces) {
      EXPECT_NEAR(p.from, at, 1e-4f * size) << rules << size;
      EXPECT_GT(p.to, p.from);
      at = p.to;
    }
    EXPECT_LE(at, size / 2 * 1.000001f) << rules << size;
    const float end = weights || fixedLengths > size ? size / 2 : at;
    EXPECT_NEAR(at, end, 3e-4f * size) << rules << size;
  }
}

TEST(Splits, AtLeastOneCopyFills) {
  for (const float size : {0.01f, 1.0f, 2.9f, 3.0f, 5.9f, 6.0f}) {
    const auto copies = piecesOf("A = Repeat(X,3,ADJUST_TO_FILL) P;", size);
    EXPECT_EQ(copies.size(), size < 6 ? 1u : 2u) << size;
    ASSERT_FALSE(copies.empty());
    EXPECT_FLOAT_EQ(copies.front().from, -size / 2);
    EXPECT_FLOAT_EQ(copies.back().to, size / 2);
  }
  EXPECT_EQ(piecesOf("A = Scale(0,-1,-1) Repeat(X,3,ADJUST_TO_FILL) P;", 1).size(), 0u);
}

TEST(Splits, PolygonAxiomsAreFlat) { // whatever their third extent says
  for (const char* shape : {"Triangle", "Quad", "Octagon", "DynamicPolygon { (-0.5,-0.5), (0.5,-0.5), (0,0.5) }"}) {
    const GpgpAxiom axiom = makeAxiom(2, 3, 5);
    const auto of = [&](const std::string& rules) {
      return spawn::derive(bake("axiom " + std::string(shape) + " A; terminal P (1,0); terminal N (1,1);" + rules),
                           std::span(&axiom, 1))
          .instances.at(0);
    };
    EXPECT_EQ(of("A = If(ShapeSize(Z) > 0) { P | N };").bucket, 1u) << shape;
    EXPECT_EQ(of("A = P;").size[2], 0) << shape;
    EXPECT_EQ(of("A = Extrude(-1) P;").size[1], 0) << shape; // its height is a factor of nothing
    EXPECT_EQ(of("A = Extrude(2) P;").size[1], 2) << shape;
    EXPECT_EQ(of("A = P;").transform[10], 1) << shape; // the instance keeps its metre
  }
  const GpgpAxiom box = makeAxiom(2, 3, 5);
  EXPECT_EQ(spawn::derive(bake("axiom Box A; terminal P (1,0); A = P;"), std::span(&box, 1)).instances.at(0).size[2],
            5);
}

// ---------------------------------------------------------------- polygons and prisms

/// What a derivation makes, by terminal: the volume of its solids, and all of their corners.
struct Solids {
  std::map<uint32_t, double> volumes;
  std::map<uint32_t, double> areas; // of the triangles
  std::map<uint32_t, std::vector<std::array<double, 3>>> corners;
  uint32_t dropped = 0;
};
Solids solidsOf(const std::vector<uint32_t>& words, const GpgpAxiom& axiom) {
  GpgpVertexLayout described{};
  described.stride = 12;
  described.attributeCount = 1;
  described.attributes[0] = {GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0};
  const auto layout = spawn::layoutOf(described);
  spawn::DeriveOptions options;
  options.vertices = &*layout;
  const auto d = spawn::derive(words, std::span(&axiom, 1), options);
  Solids solids;
  solids.dropped = d.droppedShapes;
  EXPECT_EQ(d.uncutShapes, d.droppedShapes); // no Repeat here makes too many copies
  size_t at = 0;
  for (size_t i = 0; i < d.instances.size(); ++i)
    for (uint32_t quad = 0; quad < d.quads[i]; ++quad, at += 12) {
      std::array<std::array<double, 3>, 4> p;
      for (size_t c = 0; c < 4; ++c)
        for (size_t k = 0; k < 3; ++k) {
          float value;
          std::memcpy(&value, &d.vertexWords[at + 3 * c + k], 4);
          p[c][k] = value;
        }
      const uint32_t terminal = d.instances[i].terminal;
      for (const auto& corner : p) solids.corners[terminal].push_back(corner);
      const auto add = [&](const auto& a, const auto& b, const auto& c) {
        std::array<double, 3> u, v;
        for (size_t k = 0; k < 3; ++k) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
        solids.areas[terminal] +=
            std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
        solids.volumes[terminal] += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                                     a[2] * (b[0] * c[1] - b[1] * c[0])) /
                                    6;
      };
      add(p[0], p[1], p[2]);
      add(p[0], p[2], p[3]);
    }
  return solids;
}
Solids solidsOf(const std::string& text, const GpgpAxiom& axiom) { return solidsOf(bake(text), axiom); }

TEST(Cuts, HalvesOfATriangleAreATriangleAndAQuadrilateral) {
  const auto solids = solidsOf("axiom Box B; terminal L (1,0); terminal R (1,1); B = SetAsDynamicConvexRightPrism("
                               "(-0.5,-0.5),(0.5,-0.5),(-0.5,0.5)) SubDiv(X) { -1: L | -1: R };",
                               makeAxiom(2, 2, 2));
  EXPECT_NEAR(solids.volumes.at(0), 3, 1e-5); // of 4
  EXPECT_NEAR(solids.volumes.at(1), 1, 1e-5);
  for (const auto& c : solids.corners.at(0)) EXPECT_LE(c[0], 1e-6);
  for (const auto& c : solids.corners.at(1)) EXPECT_GE(c[0], -1e-6);
}

TEST(Cuts, PiecesAreThePartsOfTheWhole) { // each within its part, and together as much as the whole
  std::mt19937 random(3);
  const auto number = [&](double low, double high) { return low + (high - low) * double(random() % 1000) / 1000; };
  for (int turn = 0; turn < 120; ++turn) {
    std::string shape = "Prism" + std::to_string(std::array{3, 5, 6, 7, 8}[random() % 5]);
    if (turn % 3 == 0) { // corners on an ellipse
      shape = "DynamicConvexRightPrism { ";
      const int corners = 3 + int(random() % 6);
      for (int i = 0; i < corners; ++i) {
        const double angle = (i + number(0.1, 0.9)) * 2 * M_PI / corners;
        shape += (i ? ", (" : "(") + std::to_string(0.5 * std::cos(angle)) + "," +
                 std::to_string(0.4 * std::sin(angle)) + ")";
      }
      shape += " }";
    }
    const GpgpAxiom axiom = makeAxiom(float(number(1, 4)), float(number(1, 4)), float(number(1, 4)));
    const double whole = solidsOf("axiom " + shape + " A; terminal T (1,0); A = T;", axiom).volumes.at(0);
    // Parts along X, one of which is cut along Z and Y again, and turned before that.
    const double w[4] = {number(0.2, 2), number(0.2, 2), number(0.2, 2), number(0.2, 2)};
    const auto weight = [&](int i) { return "-" + std::to_string(w[i]) + ": "; };
    const std::string text = "axiom " + shape +
                             " A; terminal P (1,0); terminal Q (1,1); terminal U (1,2); terminal V (1,3);"
                             "A = SubDiv(X) { " +
                             weight(0) + "P | " + weight(1) + "Rotate(0,40,0) SubDiv(Z) { " + weight(2) +
                             "SubDiv(Y) { " + weight(3) + "Q | -1: U } | -1: V } };";
    const auto solids = solidsOf(text, axiom);
    double sum = 0;
    for (const auto& [terminal, volume] : solids.volumes) {
      EXPECT_GT(volume, 0) << text;
      sum += volume;
    }
    EXPECT_NEAR(sum, whole, 1e-4 * whole) << text;
    EXPECT_EQ(solids.dropped, 0u);
    const double border = axiom.size[0] * (w[0] / (w[0] + w[1]) - 0.5);
    for (const auto& c : solids.corners.at(0)) {
      EXPECT_LE(c[0], border + 1e-4);
      EXPECT_GE(c[0], -axiom.size[0] / 2 - 1e-4);
      EXPECT_LE(std::abs(c[2]), axiom.size[2] / 2 + 1e-4);
    }
  }
}

TEST(Cuts, FacesOfPiecesAreTheirs) { // ends and sides are where the piece has them
  const auto of = [](const char* successor) {
    return solidsOf("axiom Hexagon A; terminal T (0,0); terminal N (0,1); A = Extrude(2) SubDiv(Z) { -1: " +
                        std::string(successor) + " | -2: Discard() };",
                    makeAxiom(3, 4, 1));
  };
  const auto solid = of("T").volumes.at(0);
  EXPECT_GT(solid, 0);
  // Extruded a little outwards, all faces lie around the solid.
  const auto faces = of("CompSplit() { T | T | T }");
  EXPECT_NEAR(faces.volumes.at(0), solid, 1e-4); // they are the surface of the same volume
}

TEST(Cuts, EveryShapeIsSharedOrDropped) { // by its area or volume, whatever it is and however it is divided
  const Divisions divisions = makeDivisions();
  double whole = 0, first = 0; // of what arrives; of the first third of it
  for (size_t i = 0; i < divisions.all.size(); ++i) {
    const Division& d = divisions.all[i];
    const Solids solids = solidsOf(divisions.words, divisions.axioms[i]);
    double sum = 0, ofFirst = 0;
    for (const auto& [terminal, size] : d.polygon ? solids.areas : solids.volumes) {
      sum += size;
      if (terminal == 0) ofFirst = size;
    }
    const auto what = [&] {
      return d.shape + (d.polygon ? ", a polygon along " : " along ") + d.axis + ", kind " +
             std::to_string(static_cast<int>(d.how));
    };
    if (d.how == Divide::nothing) {
      whole = sum;
      EXPECT_GT(whole, 0.5) << what();
      continue;
    }
    const bool cut = !d.keeps && d.axis != (d.polygon ? 'Z' : 'Y');
    const bool dropped = cut && (d.how == Divide::byLengths || d.how == Divide::byExpressions);
    const bool flat = d.polygon && d.axis == 'Z'; // nothing to share
    EXPECT_EQ(solids.dropped, dropped ? 1u : 0u) << what();
    if (d.how == Divide::byWeights) first = ofFirst;
    const double expected = dropped || flat ? 0 : d.how == Divide::keepFirst ? first : whole;
    EXPECT_NEAR(sum, expected, 1e-4 * whole) << what();
    if (flat) continue;
    EXPECT_GT(first, 0.02 * whole) << what();
    EXPECT_TRUE(!d.keeps || std::abs(first - whole / 3) < 1e-4 * whole) << what();
  }
}

TEST(Cuts, OthersKeepTheirShapeOrAreDropped) {
  const auto types = [](const std::string& text) {
    const GpgpAxiom axiom = makeAxiom(2, 2, 2);
    std::vector<uint32_t> result;
    for (const auto& i : spawn::derive(bake(text), std::span(&axiom, 1)).instances) result.push_back(i.shape);
    return result;
  };
  using Types = std::vector<uint32_t>;
  const std::string terminals = "terminal T (0,0); terminal U (0,1); ";
  EXPECT_EQ(types("axiom Box A; " + terminals + "A = SubDiv(X) { 1: T | -1: U };"),
            (Types{GPGP_SHAPE_BOX, GPGP_SHAPE_BOX}));
  EXPECT_EQ(types("axiom Prism6 A; " + terminals + "A = SubDiv(Y) { 1: T | -1: U };"),
            (Types{GPGP_SHAPE_PRISM6, GPGP_SHAPE_PRISM6}));
  EXPECT_EQ(types("axiom Sphere A; " + terminals + "A = SubDiv(Y) { 1: T | -1: U };"),
            (Types{GPGP_SHAPE_SPHERE, GPGP_SHAPE_SPHERE}));
  EXPECT_EQ(types("axiom Hexagon A; " + terminals + "A = SubDiv(Y) { -1: T | -1: U };"),
            (Types{GPGP_SHAPE_DYNAMIC_CONVEX_POLYGON, GPGP_SHAPE_DYNAMIC_CONVEX_POLYGON}));
  const std::string lengths = "axiom Prism6 A; " + terminals + "A = SubDiv(X) { 1: T | -1: U };";
  EXPECT_EQ(types(lengths), Types{});
  EXPECT_EQ(solidsOf(lengths, makeAxiom(2, 2, 2)).dropped, 1u);
  EXPECT_EQ(messagesOf(lengths),
            std::vector<std::string>{"1:57: warning: SubDiv cuts nothing of Prism6, which can arrive: by lengths, its "
                                     "pieces would have other corners for each size. Such shapes are dropped and "
                                     "counted; expected constant weights alone"});
  // A U falls into two pieces above its bottom.
  const std::string u =
      "axiom DynamicRightPrism { (-0.5,-0.5), (0.5,-0.5), (0.5,0.5), (0.25,0.5), (0.25,0), (-0.25,0), "
      "(-0.25,0.5), (-0.5,0.5) } A; " +
      terminals;
  EXPECT_EQ(solidsOf(u + "A = SubDiv(Z) { -1: T | -3: U };", makeAxiom(1, 1, 1)).dropped, 1u);
  EXPECT_NEAR(solidsOf(u + "A = SubDiv(X) { -1: T | -1: U };", makeAxiom(1, 1, 1)).volumes.at(1), 0.375, 1e-6);
  // A rule that cuts its own pieces ends as well.
  const std::string endless = "axiom Prism5 A; " + terminals +
                              "A = SubDiv(X) { -1: Rotate(0,90,0) B | -1: T }; B = SubDiv(Z) { -1: A | -2: U };";
  EXPECT_GT(solidsOf(endless, makeAxiom(2, 2, 2)).volumes.size(), 1u);
}

} // namespace
