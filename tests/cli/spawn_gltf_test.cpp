// What `gpgp spawn --out` writes: triangles that face outwards with normals and uv, in nodes named as their terminals.
#include "files.h"
#include "glb.h"
#include "run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr const char* kCases = GPGP_TEST_DATA "/cases/spawn/";

/// Each triangle's normals are those of its corners.
void expectLit(const Glb& glb) {
  for (const GlbTriangle& t : glb.triangles) {
    const Vector area = cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
    const double length = std::sqrt(dot(area, area));
    ASSERT_GT(length, 0);
    for (const Vector& n : t.normals) ASSERT_GT(dot(n, area) / length, 0.99) << t.node; // 8 bits each, of vertices
    for (const auto& uv : t.uv)
      for (const double v : uv) {
        ASSERT_GE(v, 0);
        ASSERT_LE(v, 1);
      }
  }
}
/// Corners of all triangles, in an order of their own.
std::vector<std::array<Vector, 3>> cornersOf(const Glb& glb) {
  std::vector<std::array<Vector, 3>> result;
  for (const GlbTriangle& t : glb.triangles) {
    auto corners = t.corners;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(CliSpawnGltf, MirroredAndShearedAxiomsFaceOutwards) {
  const TemporaryFile out("mirrored.glb");
  const std::vector<std::string> common = {"spawn",        kCases + std::string("c10_shear.pga"),
                                           "--axiom-file", kCases + std::string("c10.csv"),
                                           "--schedule",   "interpreter",
                                           "--out",        out.path()};
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--output", "vertices"}, {"--out-nodes"}}) {
    auto arguments = common;
    arguments.insert(arguments.end(), more.begin(), more.end());
    gpgpJson(arguments);
    const Glb glb = readGlb(out.path());
    expectLit(glb);
    std::map<std::string, std::vector<GlbTriangle>> byNode;
    for (const GlbTriangle& t : glb.triangles) byNode[t.node].push_back(t);
    ASSERT_EQ(byNode.size(), 2u); // the box, and its sides
    EXPECT_EQ(byNode["P"].size(), 12u);
    EXPECT_NEAR(volumeOf(byNode["P"]), 71.64, 0.01); // 2 * 3 * 4 times the determinant, -2.985, without its sign
  }
}

TEST(CliSpawnGltf, NodesAndTrianglesAreTheSame) {
  const TemporaryFile grammar(
      "nodes.pga", "axiom Box S; terminal Wall Roof (1,3); terminal Pole (1,5); terminal Ball (0,1);\n"
                   "S = SubDiv(X) { -1: Repeat(Y,1,ADJUST_TO_FILL) Wall | -1: Rotate(10,20,30) Scale(1,2,3) Roof |"
                   " -1: CompSplit() { Extrude(1) Pole | Discard() | Wall } | -1: B | -1: C };\n"
                   "B = SetAsDynamicConvexRightPrism((-0.5,-0.5),(0.5,-0.5),(0,0.5)) Discard();\n"
                   "C = Scale(-0.5,-0.5,-0.5) Ball;\n"),
      round("round.pga", "axiom Sphere S; terminal Ball (0,1); S = Ball;\n"), merged("merged.glb"), nodes("nodes.glb");
  for (const auto& [file, instances] :
       {std::pair(grammar.path(), size_t(3 + 1 + 5 + 1)), std::pair(round.path(), size_t(1))}) {
    const std::vector<std::string> common = {"spawn", file,         "--axiom-size", "10,3,4", "--axioms",
                                             "2",     "--schedule", "interpreter",  "--out"};
    auto one = common, other = common;
    one.push_back(merged.path());
    other.insert(other.end(), {nodes.path(), "--out-nodes"});
    EXPECT_EQ(gpgpJson(one)["triangles"], gpgpJson(other)["triangles"]);
    const Glb a = readGlb(merged.path()), b = readGlb(nodes.path());
    expectLit(a);
    expectLit(b);
    const auto first = cornersOf(a), second = cornersOf(b);
    ASSERT_EQ(first.size(), second.size());
    EXPECT_NEAR(volumeOf(a.triangles), volumeOf(b.triangles), 1e-3);
    // A node each, without meshes of their own; meshes are as many as terminals have shapes.
    std::map<std::string, size_t> children;
    for (const auto& node : b.model["nodes"])
      if (node.contains("children")) children[node["name"]] = node["children"].size();
    size_t sum = 0;
    for (const auto& [name, count] : children) sum += count;
    EXPECT_EQ(sum, 2 * instances);
    EXPECT_LE(b.model["meshes"].size(), 5u);
    std::vector<std::string> names, materials;
    for (const auto& node : a.model["nodes"]) names.push_back(node["name"]);
    for (const auto& material : a.model["materials"]) materials.push_back(material["name"]);
    EXPECT_EQ(names, materials);
    EXPECT_EQ(a.model["meshes"].size(), names.size());
  }
}

TEST(CliSpawnGltf, ColoursAreThePalettes) { // in linear light: encoded as sRGB they are the palette's bytes
  const TemporaryFile grammar("colours.pga", "axiom Box S; terminal Slate (1,11); terminal Brick (1,12);\n"
                                             "S = SubDiv(X) { -1: Slate | -1: Brick };\n"),
      out("colours.glb");
  gpgpJson({"spawn", grammar.path(), "--schedule", "interpreter", "--out", out.path()});
  const Glb glb = readGlb(out.path());
  const std::map<std::string, std::array<int, 3>> expected = {{"Slate", {0x3f, 0x4b, 0x57}},
                                                              {"Brick", {0xb5, 0x52, 0x3b}}};
  for (const auto& material : glb.model["materials"])
    for (size_t c = 0; c < 3; ++c) {
      const double linear = material["pbrMetallicRoughness"]["baseColorFactor"][c];
      const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
      EXPECT_NEAR(255 * encoded, expected.at(material["name"])[c], 0.01) << material["name"];
    }
}

TEST(CliSpawnGltf, NothingIsAFileAsWell) {
  const TemporaryFile grammar("none.pga",
                              "axiom Box S; terminal T (1,0); S = If(ShapeSize(X) > 5) { T | Discard() };\n"),
      out("none.glb");
  gpgpJson({"spawn", grammar.path(), "--schedule", "interpreter", "--out", out.path()});
  EXPECT_TRUE(readGlb(out.path()).triangles.empty());
}

} // namespace
