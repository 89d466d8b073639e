// What `gpgp spawn --out` writes: triangles that face outwards with normals and uv, in nodes named as their terminals.
#include "files.h"
#include "glb.h"
#include "run.h"

#include <gpgp/evaluator.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
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

/// Positions, turns and scales of unit shapes as matrices, by terminal, shape and place.
using Placed = std::map<std::string, std::vector<std::array<double, 12>>>;
Placed placedBy(const Glb& glb) {
  Placed all;
  for (const auto& node : glb.placed) {
    const auto t = node["translation"].get<Vector>(), s = node["scale"].get<Vector>();
    const auto q = node["rotation"].get<std::array<double, 4>>();
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    std::array<double, 12> matrix{};
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) matrix[4 * r + c] = rows[r][c] * s[c];
      matrix[4 * r + 3] = t[r];
    }
    all[node["name"]].push_back(matrix);
  }
  return all;
}

TEST(CliSpawnGltf, InstancesAreTheDerivation) {
  const TemporaryFile places("places.csv", "x,y,z,rotation,seed,size_x,size_y,size_z\n0,0,0,0,5,24,8,20\n"
                                           "40,1,-7,0,6,24,8,20\n0,2,50,0,77,24,8,20\n"),
      out("instanced.glb"), merged("merged.glb");
  const std::string file = GPGP_SAMPLE_GRAMMARS "/suburban_house.pga";
  const std::vector<std::string> common = {"spawn",      file,          "--axiom-file", places.path(),
                                           "--schedule", "interpreter", "--out"};
  auto one = common, other = common;
  one.push_back(merged.path());
  other.insert(other.end(), {out.path(), "--instanced"});
  EXPECT_EQ(gpgpJson(one)["triangles"], gpgpJson(other)["triangles"]);
  const Glb a = readGlb(merged.path()), b = readGlb(out.path());
  expectLit(b);
  EXPECT_EQ(a.triangles.size(), b.triangles.size());
  EXPECT_NEAR(volumeOf(a.triangles), volumeOf(b.triangles), 1e-2);
  EXPECT_EQ(b.model["extensionsUsed"], json::array({"EXT_mesh_gpu_instancing"}));
  EXPECT_LT(b.model["nodes"].size(), 40u);
  EXPECT_LT(b.model["meshes"].size(), 30u);
  for (const auto& mesh : b.model["meshes"]) {
    const auto& primitive = mesh["primitives"][0];
    for (const char* attribute : {"POSITION", "NORMAL", "TEXCOORD_0"})
      EXPECT_TRUE(primitive["attributes"].contains(attribute)) << attribute;
    EXPECT_TRUE(primitive.contains("material"));
  }
  // The same axioms on the CPU.
  const std::string text = host::readText(file);
  auto source = init<GpgpGrammarSource>();
  source.text = text.data();
  source.size = text.size();
  auto create = init<GpgpEvaluatorCreateInfo>();
  create.sources = &source;
  create.sourceCount = 1;
  const auto evaluator = gpgp::Evaluator::create(create);
  ASSERT_TRUE(evaluator);
  auto evaluation = std::move(*evaluator->evaluation());
  std::vector<GpgpAxiom> axioms;
  for (const auto& [x, y, z, seed] : {std::array<float, 4>{0, 0, 0, 5}, {40, 1, -7, 6}, {0, 2, 50, 77}}) {
    GpgpAxiom axiom{};
    axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
    axiom.transform[3] = x;
    axiom.transform[7] = y + 4;
    axiom.transform[11] = z;
    axiom.size[0] = 24;
    axiom.size[1] = 8;
    axiom.size[2] = 20;
    axiom.seed = static_cast<uint32_t>(seed);
    axiom.start = GPGP_AXIOM_DEFAULT_START;
    axiom.attribute = std::nanf("");
    axioms.push_back(axiom);
  }
  auto info = init<GpgpEvaluationInfo>();
  info.axioms = axioms.data();
  info.axiomCount = 3;
  ASSERT_EQ(evaluation.derive(info), GPGP_SUCCESS);
  const auto result = *evaluation.result();
  uint32_t count = 0;
  ASSERT_EQ(evaluator->terminals(count, nullptr), GPGP_SUCCESS);
  std::vector<GpgpGrammarTerminal> terminals(count);
  ASSERT_EQ(evaluator->terminals(count, terminals.data()), GPGP_SUCCESS);
  std::map<std::string, std::vector<std::array<double, 12>>> expected, found;
  for (uint32_t i = 0; i < result.axiomCount; ++i)
    for (uint32_t k = 0; k < result.axioms[i].instanceCount; ++k) {
      const GpgpInstance& instance = result.axioms[i].instances[k];
      std::array<double, 12> matrix{};
      std::copy_n(instance.transform, 12, matrix.begin());
      expected[terminals[instance.terminal].name].push_back(matrix);
    }
  for (const auto& [name, matrices] : placedBy(b)) { // "Roof box" and "Roof prism3" are of one terminal
    auto& all = found[name.substr(0, name.find(' '))];
    all.insert(all.end(), matrices.begin(), matrices.end());
  }
  ASSERT_EQ(found.size(), expected.size());
  size_t compared = 0;
  double worst = 0;
  for (auto& [name, all] : expected) {
    ASSERT_EQ(all.size(), found[name].size()) << name;
    for (const auto& matrix : all) { // each has one of its own
      auto& rest = found[name];
      size_t nearest = 0;
      double least = 1e9;
      for (size_t i = 0; i < rest.size(); ++i) {
        double far = 0;
        for (size_t e = 0; e < 12; ++e) far = std::max(far, std::abs(rest[i][e] - matrix[e]));
        if (far < least) nearest = i;
        least = std::min(least, far);
      }
      worst = std::max(worst, least);
      rest.erase(rest.begin() + long(nearest));
      ++compared;
    }
  }
  EXPECT_EQ(compared, result.instances);
  EXPECT_GT(compared, 1000u);
  EXPECT_LT(worst, 1e-4);
}

TEST(CliSpawnGltf, TheValidatorFindsNothing) {
  const std::string validator = GPGP_TEST_DATA "/fetched/gltf-validator";
  if (runProcess({"/usr/bin/env", "node", "--version"}).exitCode != 0 ||
      !std::filesystem::exists(validator + "/index.js"))
    GTEST_SKIP() << "node is not there, or tests/data/fetch.sh --only gltf-validator was not run";
  const TemporaryFile out("validated.glb");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--output", "vertices"}, {"--out-nodes"}, {"--instanced"}}) {
    std::vector<std::string> arguments = {"spawn",        GPGP_SAMPLE_GRAMMARS "/suburban_house.pga",
                                          "--axioms",     "3",
                                          "--axiom-size", "24,8,20",
                                          "--schedule",   "interpreter",
                                          "--out",        out.path()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    gpgpJson(arguments);
    const std::string script = "const v = require(process.argv[1]), fs = require('fs');"
                               "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])))"
                               ".then(r => console.log(JSON.stringify(r.issues)));";
    const ProcessResult result = runProcess({"/usr/bin/env", "node", "-e", script, validator, out.path()});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json issues = json::parse(result.out);
    EXPECT_EQ(issues["numErrors"], 0) << result.out;
    EXPECT_EQ(issues["numWarnings"], 0) << result.out;
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
