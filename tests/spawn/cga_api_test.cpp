// cga.h as an engine calls it: attributes for sliders, meshes of lots, operator graphs, files and jobs of its own.
#include <gpgp/gpgp.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace {

struct Said {
  std::vector<std::string> lines;
  static void take(void* user, const GpgpCompileMessage* m) {
    static_cast<Said*>(user)->lines.push_back(std::string(m->file) + ":" + std::to_string(m->line) + ":" +
                                              std::to_string(m->column) + ": " + m->text);
  }
  bool has(const std::string& part) const {
    for (const std::string& line : lines)
      if (line.find(part) != std::string::npos) return true;
    return false;
  }
};

gpgp::CgaProgram programOf(const std::string& text, Said& said, const GpgpJobSystem* jobs = nullptr,
                           const GpgpFileSystem* files = nullptr) {
  auto info = gpgp::init<GpgpCgaProgramCreateInfo>();
  info.name = "lot.cga";
  info.text = text.data();
  info.size = text.size();
  info.jobSystem = jobs;
  info.fileSystem = files;
  info.messageFn = Said::take;
  info.messageUserData = &said;
  auto made = gpgp::CgaProgram::create(info);
  return made ? *std::move(made) : gpgp::CgaProgram();
}

GpgpCgaLot lotOf(float x, float z, float sizeX, float sizeZ, uint32_t seed) {
  GpgpCgaLot lot{};
  const float transform[12] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, z};
  std::memcpy(lot.axiom.transform, transform, sizeof transform);
  lot.axiom.size[0] = sizeX;
  lot.axiom.size[2] = sizeZ;
  lot.axiom.seed = seed;
  lot.axiom.start = GPGP_AXIOM_DEFAULT_START;
  return lot;
}

struct Derived {
  GpgpResult code = GPGP_SUCCESS;
  GpgpCgaDerivationResult result = GPGP_CGA_DERIVATION_RESULT_INIT;
  Said said;
};
/// The result's pointers are the derivation's.
Derived derive(gpgp::CgaDerivation& derivation, const std::vector<GpgpCgaLot>& lots,
               GpgpCgaDerivationInfo info = GPGP_CGA_DERIVATION_INFO_INIT) {
  Derived derived;
  info.lots = lots.data();
  info.lotCount = static_cast<uint32_t>(lots.size());
  info.messageFn = Said::take;
  info.messageUserData = &derived.said;
  derived.code = derivation.derive(info);
  derived.result = *derivation.result();
  return derived;
}

/// Signed volume of a leaf's triangles, and their area.
std::pair<double, double> measure(const GpgpCgaDerivationResult& r, const GpgpCgaLeaf& leaf) {
  double volume = 0, area = 0;
  for (uint32_t i = leaf.firstIndex; i < leaf.firstIndex + leaf.indexCount; i += 3) {
    const float* p[3];
    for (int k = 0; k < 3; ++k) p[k] = r.vertices[r.indices[i + static_cast<uint32_t>(k)]].position;
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) u[k] = double(p[1][k]) - double(p[0][k]), v[k] = double(p[2][k]) - double(p[0][k]);
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    area += std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    volume += (double(p[0][0]) * n[0] + double(p[0][1]) * n[1] + double(p[0][2]) * n[2]) / 6;
  }
  return {volume, area};
}

const char* const kHouse = R"(
@Group("Building", 1) @Range(min=3, max=60, stepsize=0.5, restricted=false) @Order(2)
@Description("Height of the walls")
attr height = 9
@Range(0, 1) @Percent @Order(1)
attr share = 0.25
@Enum("brick", "wood") @Group("Look", "Walls", 3)
attr wall = "wood"
@Hidden attr isTall = height > 20
@Color attr colour = "#ff8000"
attr names = ["a", "b"]
const twice = 2 * height
@StartRule
Lot --> report("twice", twice) color(colour) extrude(height) split(x) { 'share: Left(wall) | ~1: Right }
Left(w) --> print(w) LeftPart.
Right --> RightPart.
)";

TEST(CgaApi, AttributesHaveTheirRangesGroupsAndValues) {
  Said said;
  const gpgp::CgaProgram program = programOf(kHouse, said);
  ASSERT_TRUE(program);
  EXPECT_TRUE(said.lines.empty()) << said.lines[0];
  uint32_t count = 0;
  ASSERT_EQ(program.attributes(count, nullptr), GPGP_SUCCESS);
  ASSERT_EQ(count, 6u);
  std::vector<GpgpCgaAttribute> all(count);
  ASSERT_EQ(program.attributes(count, all.data()), GPGP_SUCCESS);

  EXPECT_STREQ(all[0].name, "height");
  EXPECT_EQ(all[0].type, GPGP_CGA_NUMBER);
  EXPECT_EQ(all[0].number, 9);
  EXPECT_STREQ(all[0].text, "9");
  EXPECT_EQ(all[0].min, 3);
  EXPECT_EQ(all[0].max, 60);
  EXPECT_EQ(all[0].step, 0.5);
  EXPECT_EQ(all[0].flags, GPGP_CGA_ATTRIBUTE_UNRESTRICTED);
  ASSERT_EQ(all[0].groupCount, 1u);
  EXPECT_STREQ(all[0].groups[0], "Building");
  EXPECT_EQ(all[0].groupOrder, 1);
  EXPECT_EQ(all[0].order, 2);
  EXPECT_STREQ(all[0].description, "Height of the walls");
  EXPECT_STREQ(all[0].file, "lot.cga");
  EXPECT_EQ(all[0].line, 4u);

  EXPECT_EQ(all[1].flags, GPGP_CGA_ATTRIBUTE_PERCENT);
  EXPECT_EQ(all[1].max, 1);
  EXPECT_TRUE(std::isnan(all[1].step));
  ASSERT_EQ(all[1].groupCount, 1u); // a group holds until the next one
  EXPECT_STREQ(all[1].groups[0], "Building");
  EXPECT_EQ(all[1].groupOrder, 1);

  EXPECT_EQ(all[2].type, GPGP_CGA_STRING);
  EXPECT_STREQ(all[2].text, "wood");
  ASSERT_EQ(all[2].choiceCount, 2u);
  EXPECT_STREQ(all[2].choices[1], "wood");
  ASSERT_EQ(all[2].groupCount, 2u);
  EXPECT_STREQ(all[2].groups[1], "Walls");
  EXPECT_TRUE(std::isnan(all[2].min));

  EXPECT_EQ(all[3].type, GPGP_CGA_BOOLEAN); // of the value, which no literal says
  EXPECT_STREQ(all[3].text, "false");
  EXPECT_EQ(all[3].flags, GPGP_CGA_ATTRIBUTE_HIDDEN);
  EXPECT_EQ(all[4].flags, GPGP_CGA_ATTRIBUTE_COLOR);
  EXPECT_EQ(all[5].type, GPGP_CGA_ARRAY);

  count = 2;
  std::vector<GpgpCgaAttribute> few(2);
  EXPECT_EQ(program.attributes(count, few.data()), GPGP_INCOMPLETE);
  EXPECT_EQ(count, 6u);
}

TEST(CgaApi, FieldsPlacesAndEdgesOfTheWorld) {
  Said said;
  const gpgp::CgaProgram program = programOf(R"(attr height = 1
Lot --> report("field", Field("slope")) report("h", height) report("lat", getGeoCoord(lat)) report("lon", getGeoCoord(lon))
  comp(fe) { all: report(edgeAttr.getString("use"), edgeAttr.getFloat("width")) NIL })",
                                             said);
  ASSERT_TRUE(program) << said.lines[0];
  auto derivation = program.derivation();
  ASSERT_TRUE(derivation);
  const float slope[] = {0, 100, 0, 100}, tall[] = {30}; // along x from 0 to 100
  GpgpSpawnField fields[2]{};
  fields[0].name = "slope";
  fields[0].grid = {slope, 2, 2, {0, 0}, {100, 100}};
  fields[1].name = "height";
  fields[1].grid = {tall, 1, 1, {0, 0}, {0, 0}};
  const float square[][3] = {{40, 0, 30}, {60, 0, 30}, {60, 0, 10}, {40, 0, 10}};
  const uint32_t loop[] = {4};
  GpgpCgaLot lot = lotOf(0, 0, 1, 1, 4);
  lot.points = square;
  lot.loopSizes = loop;
  lot.loopCount = 1;
  const GpgpCgaValue edges[] = {{"/edgeattr/use", "street;yard;yard;wall;"}, {"/edgeattr/width", "8;1;2;0.5"}};
  lot.values = edges;
  lot.valueCount = 2;
  GpgpCgaDerivationInfo info = GPGP_CGA_DERIVATION_INFO_INIT;
  info.fields = fields;
  info.fieldCount = 2;
  info.flags = GPGP_CGA_DERIVATION_GEOGRAPHIC;
  info.longitude = 8.5;
  info.latitude = 47.25;
  const Derived d = derive(*derivation, {lot}, info);
  ASSERT_EQ(d.code, GPGP_SUCCESS) << (d.said.lines.empty() ? "" : d.said.lines[0]);
  std::map<std::string, double> sums;
  for (uint32_t i = 0; i < d.result.reportCount; ++i) sums[d.result.reports[i].name] = d.result.reports[i].sum;
  EXPECT_NEAR(sums["field"], 50, 1e-4);
  EXPECT_NEAR(sums["h"], 30, 1e-4);
  EXPECT_NEAR(sums["street"], 8, 1e-4);
  EXPECT_NEAR(sums["yard"], 3, 1e-4);
  EXPECT_NEAR(sums["wall"], 0.5, 1e-4);
  EXPECT_NEAR(sums["lat"], 47.25 - 10 / 111319.490793, 2e-5); // of the scope's origin, which is at (40, 10)
  EXPECT_NEAR(sums["lon"], 8.5 + 40 / (111319.490793 * std::cos(47.25 * 3.14159265358979 / 180)), 2e-5);

  // What is set goes before a field.
  const GpgpCgaValue set[] = {{"height", "7"}};
  info.values = set;
  info.valueCount = 1;
  const Derived own = derive(*derivation, {lot}, info);
  for (uint32_t i = 0; i < own.result.reportCount; ++i) {
    if (std::string(own.result.reports[i].name) == "h") {
      EXPECT_EQ(own.result.reports[i].sum, 7);
    }
  }

  const auto refused = [&](const GpgpCgaDerivationInfo& wrong, const std::string& what) {
    const Derived r = derive(*derivation, {lot}, wrong);
    EXPECT_EQ(r.code, GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_TRUE(r.said.has(what)) << what << ": " << (r.said.lines.empty() ? "" : r.said.lines[0]);
  };
  GpgpCgaDerivationInfo wrong = info;
  wrong.fields = fields + 1;
  wrong.fieldCount = 1;
  refused(wrong, "lot.cga:2:25: field \"slope\" is read, and is not among the fields");
  wrong = info;
  wrong.fields = nullptr;
  refused(wrong, "fields is NULL");
  wrong = info;
  wrong.latitude = 91;
  refused(wrong, "latitude not within 90");
  GpgpSpawnField empty = fields[0];
  empty.grid.values = nullptr;
  wrong = info;
  wrong.fields = &empty;
  wrong.fieldCount = 1;
  refused(wrong, "field \"slope\": values is NULL");
}

TEST(CgaApi, AttributesHaveTheNamesAndFilesToShow) {
  Said said;
  const gpgp::CgaProgram program =
      programOf("@DisplayName(\"Roof tiles\") @File(\"obj\", \"glb\") attr tile = \"a.obj\"\n"
                "@MaterialFile attr wall = \"b.cgamat\"\n@Angle attr turn = 20\n"
                "@Enum(valuesAttr=kinds) attr kind = \"b\"\nattr kinds = [\"a\", \"b\"]\nLot --> A.",
                said);
  ASSERT_TRUE(program) << said.lines[0];
  uint32_t count = 5;
  std::vector<GpgpCgaAttribute> all(count);
  ASSERT_EQ(program.attributes(count, all.data()), GPGP_SUCCESS);
  EXPECT_STREQ(all[0].displayName, "Roof tiles");
  ASSERT_EQ(all[0].extensionCount, 2u);
  EXPECT_STREQ(all[0].extensions[1], "glb");
  EXPECT_STREQ(all[1].displayName, "");
  EXPECT_EQ(all[1].flags, GPGP_CGA_ATTRIBUTE_MATERIAL_FILE);
  EXPECT_EQ(all[2].max, 360);
  EXPECT_EQ(all[2].flags, GPGP_CGA_ATTRIBUTE_ANGLE | GPGP_CGA_ATTRIBUTE_UNRESTRICTED);
  ASSERT_EQ(all[3].choiceCount, 2u);
  EXPECT_STREQ(all[3].choices[0], "a");
}

TEST(CgaApi, LotsBecomeMeshesOfKnownVolumes) {
  Said said;
  const gpgp::CgaProgram program = programOf(kHouse, said);
  auto derivation = program.derivation();
  ASSERT_TRUE(derivation);
  const GpgpCgaValue tall[] = {{"height", "24"}}, half[] = {{"share", "0.5"}};
  std::vector<GpgpCgaLot> lots{lotOf(0, 0, 10, 8, 1), lotOf(100, -20, 4, 4, 2), lotOf(0, 50, 2, 2, 3)};
  lots[1].values = tall;
  lots[1].valueCount = 1;
  lots[2].axiom.size[1] = 3; // a box: it is extruded from its own height on
  const float square[][3] = {{0, 0, 0}, {0, 0, 10}, {10, 0, 10}, {10, 0, 0},
                             {4, 0, 4}, {6, 0, 4},  {6, 0, 6},   {4, 0, 6}};
  const uint32_t loops[] = {4, 4};
  GpgpCgaLot yard = lotOf(0, 0, 1, 1, 4);
  yard.points = square;
  yard.loopSizes = loops;
  yard.loopCount = 2;
  lots.push_back(yard);
  const Derived d = derive(*derivation, lots);
  ASSERT_EQ(d.code, GPGP_SUCCESS);
  EXPECT_EQ(d.result.status, GPGP_SUCCESS);
  ASSERT_EQ(d.result.leafCount, 8u);
  const auto volume = [&](uint32_t leaf) { return measure(d.result, d.result.leaves[leaf]).first; };
  EXPECT_STREQ(d.result.leaves[0].rule, "LeftPart");
  EXPECT_STREQ(d.result.leaves[1].rule, "RightPart");
  EXPECT_NEAR(volume(0), 0.25 * 10 * 8 * 9, 1e-2);
  EXPECT_NEAR(volume(1), 0.75 * 10 * 8 * 9, 1e-2);
  EXPECT_EQ(d.result.leaves[2].lot, 1u);
  EXPECT_NEAR(volume(2) + volume(3), 4 * 4 * 24, 1e-2);
  EXPECT_NEAR(volume(6) + volume(7), (100 - 4) * 9, 1e-1); // the hole is none of it
  EXPECT_NEAR(d.result.leaves[0].color[1], 128 / 255.0, 1e-5);
  ASSERT_EQ(d.result.reportCount, 1u);
  EXPECT_EQ(d.result.reports[0].count, 4u);
  EXPECT_EQ(d.result.reports[0].sum, 3 * 18 + 48);
  EXPECT_EQ(d.result.reports[0].max, 48);
  ASSERT_EQ(d.result.printCount, 4u);
  EXPECT_STREQ(d.result.prints[0], "wood");
  for (uint32_t i = 0; i < d.result.indexCount; ++i) ASSERT_LT(d.result.indices[i], d.result.vertexCount);

  // Values of the call go before those of lots. Without vertices, all counts stay.
  auto info = gpgp::init<GpgpCgaDerivationInfo>();
  info.values = half;
  info.valueCount = 1;
  const Derived halves = derive(*derivation, lots, info);
  EXPECT_NEAR(measure(halves.result, halves.result.leaves[0]).first, 360, 1e-2);
  const uint64_t triangles = halves.result.triangles;
  EXPECT_EQ(triangles * 3, halves.result.indexCount);
  info.flags = GPGP_CGA_DERIVATION_COUNT_ONLY;
  const Derived counted = derive(*derivation, lots, info);
  EXPECT_EQ(counted.result.triangles, triangles);
  EXPECT_EQ(counted.result.vertexCount, 0u);
  EXPECT_EQ(counted.result.leafCount, 8u);
}

TEST(CgaApi, TransformsMoveAndTurnLots) {
  Said said;
  const gpgp::CgaProgram program = programOf("Lot --> split(x) { 1: A. | ~1: NIL }", said);
  auto derivation = program.derivation();
  GpgpCgaLot lot = lotOf(5, 7, 4, 2, 1);
  const float turned[12] = {0, 0, 1, 5, 0, 1, 0, 3, -1, 0, 0, 7}; // x to -z
  std::memcpy(lot.axiom.transform, turned, sizeof turned);
  const Derived d = derive(*derivation, {lot});
  ASSERT_EQ(d.result.leafCount, 1u);
  float least[3] = {1e9f, 1e9f, 1e9f}, most[3] = {-1e9f, -1e9f, -1e9f};
  for (uint32_t i = 0; i < d.result.vertexCount; ++i)
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], d.result.vertices[i].position[k]);
      most[k] = std::max(most[k], d.result.vertices[i].position[k]);
    }
  // Object space: x -2 to -1, z -1 to 1; so the world's z is 7 - x, its x 5 + z.
  const float expected[6] = {4, 3, 8, 6, 3, 9};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(least[k], expected[k], 1e-5);
    EXPECT_NEAR(most[k], expected[3 + k], 1e-5);
  }
}

TEST(CgaApi, JobsAndOneThreadDeriveTheSameBytes) {
  const std::string text = R"(Lot --> extrude(rand(3, 30)) split(y) { ~3: Floor }*
      Floor --> 30%: A. else: split(x) { ~rand(1, 4): B. }*)";
  std::atomic<uint32_t> jobs{0};
  GpgpJobSystem system{&jobs, [](void* user, uint32_t count, GpgpJobFn job, void* argument) {
                         std::vector<std::thread> threads;
                         for (uint32_t i = 0; i < count; ++i) threads.emplace_back(job, argument, i);
                         for (std::thread& thread : threads) thread.join();
                         *static_cast<std::atomic<uint32_t>*>(user) += count;
                       }};
  Said said;
  const gpgp::CgaProgram alone = programOf(text, said), shared = programOf(text, said, &system);
  std::vector<GpgpCgaLot> lots;
  for (uint32_t i = 0; i < 200; ++i) lots.push_back(lotOf(float(i) * 20, 0, 10, 12, i));
  auto one = alone.derivation(), many = shared.derivation();
  const Derived a = derive(*one, lots), b = derive(*many, lots);
  EXPECT_EQ(jobs.load(), 7u); // blocks of 32 lots
  ASSERT_GT(a.result.leafCount, 2000u);
  ASSERT_EQ(a.result.leafCount, b.result.leafCount);
  ASSERT_EQ(a.result.vertexCount, b.result.vertexCount);
  EXPECT_EQ(std::memcmp(a.result.vertices, b.result.vertices, sizeof(GpgpCgaVertex) * a.result.vertexCount), 0);
  EXPECT_EQ(std::memcmp(a.result.indices, b.result.indices, sizeof(uint32_t) * a.result.indexCount), 0);
  for (uint32_t i = 0; i < a.result.leafCount; ++i) ASSERT_STREQ(a.result.leaves[i].rule, b.result.leaves[i].rule);
}

TEST(CgaApi, TheGraphDerivesWhatTheProgramDerives) {
  Said said;
  std::string text = kHouse;
  text.replace(text.find("print(w) "), 9, ""); // has no operator
  gpgp::CgaProgram program = programOf(text, said);
  const GpgpCgaValue values[] = {{"height", "12"}};
  const auto graph = program.graph(values, 1);
  ASSERT_TRUE(graph) << (said.lines.empty() ? "" : said.lines[0]);
  EXPECT_EQ(std::strlen(graph->text), graph->size);
  auto source = gpgp::init<GpgpGrammarSource>();
  source.name = "lot";
  source.text = graph->text;
  source.size = graph->size;
  auto info = gpgp::init<GpgpEvaluatorCreateInfo>();
  info.sources = &source;
  info.sourceCount = 1;
  auto evaluator = gpgp::Evaluator::create(info);
  ASSERT_TRUE(evaluator);
  uint32_t count = 0;
  ASSERT_EQ(evaluator->terminals(count, nullptr), GPGP_SUCCESS);
  ASSERT_EQ(count, graph->terminalCount);
  std::vector<GpgpGrammarTerminal> terminals(count);
  ASSERT_EQ(evaluator->terminals(count, terminals.data()), GPGP_SUCCESS);
  auto evaluation = evaluator->evaluation();
  GpgpCgaLot lot = lotOf(0, 0, 10, 8, 5);
  lot.axiom.attribute = std::nanf("");
  auto what = gpgp::init<GpgpEvaluationInfo>();
  what.axioms = &lot.axiom;
  what.axiomCount = 1;
  ASSERT_EQ(evaluation->derive(what), GPGP_SUCCESS);
  const auto instances = evaluation->result();
  std::map<std::string, double> volumes;
  double reported = 0;
  for (uint32_t i = 0; i < instances->axioms[0].instanceCount; ++i) {
    const GpgpInstance& instance = instances->axioms[0].instances[i];
    ASSERT_LT(terminals.at(instance.terminal).index, graph->terminalCount);
    const GpgpCgaTerminal& terminal = graph->terminals[terminals[instance.terminal].index];
    if (terminal.isReport)
      reported += double(instance.attribute);
    else
      volumes[terminal.rule] += double(instance.size[0]) * double(instance.size[1]) * double(instance.size[2]);
  }
  EXPECT_NEAR(volumes["LeftPart"], 0.25 * 10 * 8 * 12, 1e-2);
  EXPECT_NEAR(volumes["RightPart"], 0.75 * 10 * 8 * 12, 1e-2);
  EXPECT_EQ(reported, 24);
}

TEST(CgaApi, WhatHasNoOperatorIsSaidWithItsPlace) {
  Said said;
  gpgp::CgaProgram program = programOf("Lot --> extrude(3)\n  scatter(surface, 5, uniform) { A. }\n", said);
  ASSERT_TRUE(program);
  EXPECT_EQ(program.graph(nullptr, 0).code(), GPGP_ERROR_UNSUPPORTED);
  ASSERT_EQ(said.lines.size(), 1u);
  EXPECT_TRUE(said.has("lot.cga:2:3: ")) << said.lines[0];
  EXPECT_TRUE(said.has("has no operator on the GPU"));
}

TEST(CgaApi, FilesAndAssetsAreTheEngines) {
  struct Engine {
    std::map<std::string, std::string> files{{"parts/roof.cga", "attr angle = 30\nRoof --> i(\"tile.obj\")\n"}};
    std::vector<std::string> assets;
    float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    uint32_t indices[3] = {0, 1, 2};
    uint32_t last = 2;
  } engine;
  const GpgpFileSystem files{&engine, [](void* user, const char* path, void* data, size_t capacity, size_t* size) {
                               const auto& all = static_cast<Engine*>(user)->files;
                               const auto found = all.find(path);
                               if (found == all.end()) return GpgpResult(GPGP_ERROR_IO);
                               *size = found->second.size();
                               if (data) std::memcpy(data, found->second.data(), std::min(capacity, *size));
                               return GpgpResult(GPGP_SUCCESS);
                             }};
  Said said;
  const std::string text = "import R : \"parts/roof.cga\"\nLot --> s('1, 5, '1) R.Roof";
  const gpgp::CgaProgram program = programOf(text, said, nullptr, &files);
  ASSERT_TRUE(program) << (said.lines.empty() ? "" : said.lines[0]);
  uint32_t count = 1;
  GpgpCgaAttribute attribute{};
  ASSERT_EQ(program.attributes(count, &attribute), GPGP_SUCCESS);
  EXPECT_STREQ(attribute.name, "R.angle");
  EXPECT_STREQ(attribute.file, "parts/roof.cga");
  auto derivation = program.derivation();
  auto info = gpgp::init<GpgpCgaDerivationInfo>();
  info.loadAssetUserData = &engine;
  info.loadAsset = [](void* user, const char* path, GpgpCgaAsset* asset) {
    auto& self = *static_cast<Engine*>(user);
    self.assets.push_back(path);
    self.indices[2] = self.last;
    *asset = {self.positions, 3, self.indices, 3};
    return GpgpResult(GPGP_SUCCESS);
  };
  const Derived d = derive(*derivation, {lotOf(0, 0, 4, 3, 1)}, info);
  EXPECT_EQ(engine.assets.size(), 1u);
  EXPECT_EQ(engine.assets.at(0), "tile.obj");
  ASSERT_EQ(d.result.leafCount, 1u);
  EXPECT_EQ(d.result.indexCount, 3u);
  EXPECT_NEAR(measure(d.result, d.result.leaves[0]).second, 4 * 5 / 2.0, 1e-4); // fitted to the scope

  engine.last = 3; // no such position
  const Derived bad = derive(*derivation, {lotOf(0, 0, 4, 3, 1)}, info);
  EXPECT_TRUE(bad.said.has("its indices are no triangles of its positions"));
  EXPECT_EQ(bad.result.triangles, 12u) << "a box stands for it";

  // An import that is not there is named, and the rest derives. Of the main file it is an error.
  EXPECT_FALSE(said.has("none.cga"));
  EXPECT_TRUE(programOf("import R : \"none.cga\"\nLot --> A.", said, nullptr, &files));
  EXPECT_TRUE(said.has("none.cga"));
  auto missing = gpgp::init<GpgpCgaProgramCreateInfo>();
  missing.name = "none.cga";
  missing.fileSystem = &files;
  EXPECT_EQ(gpgp::CgaProgram::create(missing).code(), GPGP_ERROR_IO);
  engine.files["main.cga"] = "Lot --> A.";
  missing.name = "main.cga";
  EXPECT_TRUE(gpgp::CgaProgram::create(missing));
}

TEST(CgaApi, LimitsEndALotAndSayWhere) {
  Said said;
  const gpgp::CgaProgram program = programOf("Lot --> split(x) { ~1: Lot | ~1: Lot }", said);
  auto derivation = program.derivation();
  auto info = gpgp::init<GpgpCgaDerivationInfo>();
  info.maxDepth = 5;
  const Derived d = derive(*derivation, {lotOf(0, 0, 4, 3, 1)}, info);
  EXPECT_EQ(d.code, GPGP_SUCCESS);
  EXPECT_EQ(d.result.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_TRUE(d.said.has("maxDepth (--max-depth) allows more")) << (d.said.lines.empty() ? "" : d.said.lines[0]);
  EXPECT_TRUE(d.said.has("lot.cga:1:"));
}

TEST(CgaApi, WrongArgumentsAreErrorsThatChangeNothing) {
  Said said;
  EXPECT_FALSE(programOf("Lot --> extrude(\n", said));
  EXPECT_TRUE(said.has("lot.cga:"));
  said.lines.clear();
  gpgp::CgaProgram program = programOf(kHouse, said);
  auto derivation = program.derivation();
  const std::vector<GpgpCgaLot> good{lotOf(0, 0, 2, 2, 1)};
  ASSERT_EQ(derive(*derivation, good).result.leafCount, 2u);
  const auto refused = [&](const GpgpCgaLot& lot, const char* why) {
    const Derived d = derive(*derivation, {lot});
    EXPECT_EQ(d.code, GPGP_ERROR_INVALID_ARGUMENT) << why;
    EXPECT_TRUE(d.said.has(why)) << (d.said.lines.empty() ? why : d.said.lines[0]);
    EXPECT_EQ(d.result.leafCount, 2u) << "the derivation changed";
  };
  GpgpCgaLot lot = good[0];
  lot.axiom.start = 0;
  refused(lot, "axiom.start must be GPGP_AXIOM_DEFAULT_START");
  lot = good[0];
  lot.axiom.transform[0] = -1;
  refused(lot, "axiom.transform does more than move and turn");
  lot = good[0];
  lot.axiom.size[2] = 0;
  refused(lot, "axiom.size");
  lot = good[0];
  lot.loopCount = 1;
  refused(lot, "points or loopSizes is NULL");
  const float points[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, std::nanf("")}};
  const uint32_t three = 3, two = 2;
  lot.points = points;
  lot.loopSizes = &two;
  refused(lot, "a loop of 2 points");
  lot.loopSizes = &three;
  refused(lot, "points[2] is not finite");
  const GpgpCgaValue wrong[] = {{"heigth", "1"}}, text[] = {{"height", "tall"}}, constant[] = {{"twice", "1"}};
  lot = good[0];
  lot.valueCount = 1;
  lot.values = wrong;
  refused(lot, "lots[0].values[0] \"heigth\": there is no such attribute; did you mean 'height'?");
  lot.values = text;
  refused(lot, "it is a number in the file");
  lot.values = constant;
  refused(lot, "it is a const");
  EXPECT_EQ(program.graph(wrong, 1).code(), GPGP_ERROR_INVALID_ARGUMENT);
  auto info = gpgp::init<GpgpCgaDerivationInfo>();
  info.flags = 1u << 30;
  EXPECT_EQ(derive(*derivation, good, info).code, GPGP_ERROR_INVALID_ARGUMENT);
  info.sType = GPGP_STRUCTURE_CGA_GRAPH;
  EXPECT_EQ(derivation->derive(info), GPGP_ERROR_INVALID_STRUCT);
  uint32_t count = 0;
  EXPECT_EQ(gpgpGetCgaAttributes(nullptr, &count, nullptr), GPGP_ERROR_INVALID_HANDLE);
  gpgpDestroyCgaProgram(nullptr);
  gpgpDestroyCgaDerivation(nullptr);
}

} // namespace
