// Fields of the world that rules read: against closed forms, on the device and on the CPU, and what is refused.
#include "grammars.h"
#include "host/memory.h"
#include "random_grammar.h"
#include "rebuild.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/language/print.h"
#include "spawn/schedule/fields.h"
#include "spawner_test.h"

#include <gpgp/evaluator.hpp>
#include <gpgp/scatter.hpp>
#include <gpgp/tiles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

/// Fields and their values, one after the other, as a recording has them.
struct Fields {
  std::vector<GpgpSpawnField> list;
  std::vector<std::vector<float>> owned;
  std::vector<float> values;

  void add(const char* name, uint32_t width, uint32_t height, float minX, float minZ, float maxX, float maxZ,
           const std::function<float(uint32_t, uint32_t)>& value) {
    std::vector<float>& own = owned.emplace_back();
    for (uint32_t z = 0; z < height; ++z)
      for (uint32_t x = 0; x < width; ++x) own.push_back(value(x, z));
    GpgpSpawnField& field = list.emplace_back();
    field.name = name;
    field.grid = {own.data(), width, height, {minX, minZ}, {maxX, maxZ}};
    values.push_back(kNan); // nobody may read what lies between
    field.offset = values.size() * sizeof(float);
    values.insert(values.end(), own.begin(), own.end());
  }
  uint32_t count() const { return static_cast<uint32_t>(list.size()); }
};

spawn::Graph graphOf(const std::vector<uint32_t>& words) {
  auto graph = spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
  if (!graph) throw std::runtime_error(graph.error().text);
  return std::move(*graph);
}

spawn::Derivation derived(const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms,
                          const Fields& fields) {
  const auto bound = spawn::bindFields(graphOf(words), {fields.list.data(), fields.count()});
  EXPECT_TRUE(bound) << bound.error().text;
  spawn::DeriveOptions options;
  if (bound) options.fields = &*bound;
  return spawn::derive(words, axioms, options);
}

/// The values of an expression for axioms.
std::vector<float> valuesOf(const std::string& expression, const std::vector<GpgpAxiom>& axioms, const Fields& fields) {
  const auto words = bake("axiom Box A;\nterminal T (1, 0);\nA = SetAttribute(" + expression + ") T;\n");
  std::vector<float> values;
  for (const GpgpInstance& i : derived(words, axioms, fields).instances) values.push_back(i.attribute);
  return values;
}

/// Somewhere in the world, turned and scaled.
GpgpAxiom somewhere(std::mt19937& random, uint32_t id, float reach, float scale = 1) {
  std::uniform_real_distribution<float> place(-reach, reach), angle(0, 6.28f), size(1, 12);
  GpgpAxiom axiom = spawn::makeAxiom(size(random), size(random), size(random), 1 + uint32_t(random() % 100000), id);
  const float a = angle(random), c = std::cos(a) * scale, s = std::sin(a) * scale;
  const float rows[12] = {c, 0, s, place(random), 0, scale, 0, place(random) / 8, -s, 0, c, place(random)};
  std::copy_n(rows, 12, axiom.transform);
  return axiom;
}
GpgpAxiom at(float x, float z) {
  GpgpAxiom axiom = spawn::makeAxiom(2, 2, 2, 7);
  axiom.transform[3] = x;
  axiom.transform[11] = z;
  return axiom;
}

// ---------------------------------------------------------------- values

/// A plane is what a bilinear grid reproduces everywhere.
TEST(FieldValues, APlaneIsThatPlane) {
  Fields fields;
  const auto plane = [](double x, double z) { return 3 + 0.25 * x - 0.5 * z; };
  fields.add("ground", 41, 21, -100, -80, 100, 120,
             [&](uint32_t x, uint32_t z) { return static_cast<float>(plane(-100 + 5.0 * x, -80 + 10.0 * z)); });
  std::mt19937 random(2);
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 2000; ++i) axioms.push_back(somewhere(random, i, 150, i % 3 ? 1.0f : 2.0f));
  const auto centre = valuesOf("Field(ground)", axioms, fields);
  const auto corner = valuesOf("Field(ground, ShapeSize(X) / 2, 3 - ShapeSize(Z))", axioms, fields);
  uint32_t outside = 0;
  for (uint32_t i = 0; i < axioms.size(); ++i) {
    const float* t = axioms[i].transform;
    const auto expected = [&](double x, double z) {
      const double worldX = t[0] * x + t[2] * z + t[3], worldZ = t[8] * x + t[10] * z + t[11];
      const double insideX = std::clamp(worldX, -100.0, 100.0), insideZ = std::clamp(worldZ, -80.0, 120.0);
      outside += insideX != worldX || insideZ != worldZ;
      return plane(insideX, insideZ);
    };
    EXPECT_NEAR(centre[i], expected(0, 0), 1e-4);
    EXPECT_NEAR(corner[i], expected(axioms[i].size[0] / 2, 3 - axioms[i].size[2]), 1e-4);
  }
  EXPECT_GT(outside, 500u);
  EXPECT_LT(outside, 3500u);
}

/// Points lie on a terrain that the scattering of axioms reads in its own arithmetic.
TEST(FieldValues, AreWhatScatteredAxiomsStandOn) {
  Fields fields;
  std::mt19937 random(9);
  std::uniform_real_distribution<float> height(0, 60);
  fields.add("ground", 37, 53, -50, -70, 70, 60, [&](uint32_t, uint32_t) { return height(random); });
  auto info = init<GpgpScatterInfo>();
  info.base = spawn::makeAxiom(1, 0, 1);
  info.distance = 1.5f;
  info.min[0] = info.min[1] = -90;
  info.max[0] = info.max[1] = 90;
  info.heights = &fields.list[0].grid;
  uint32_t count = 0;
  ASSERT_EQ(gpgpScatterAxioms(&info, &count, nullptr), GPGP_SUCCESS);
  std::vector<GpgpAxiom> axioms(count);
  ASSERT_EQ(gpgpScatterAxioms(&info, &count, axioms.data()), GPGP_SUCCESS);
  ASSERT_GT(count, 5000u);
  const auto values = valuesOf("Field(ground)", axioms, fields);
  float worst = 0;
  for (uint32_t i = 0; i < count; ++i) worst = std::max(worst, std::abs(values[i] - axioms[i].transform[7]));
  EXPECT_LT(worst, 1e-3f); // of 60 m, and slopes of up to 25 m a metre
}

/// The point is where Translate would move the shape to, whatever its frame.
TEST(FieldValues, PointsLieAlongTheShapesAxes) {
  Fields fields;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> height(-5, 5);
  fields.add("ground", 64, 64, -60, -60, 60, 60, [&](uint32_t, uint32_t) { return height(random); });
  const std::string begin = "axiom Box A;\nterminal T (1, 0);\nA = Translate(3, 1, -2) Rotate(20, 70, -35) ";
  const auto from = bake(begin + "SetAttribute(Field(ground, 4, -3)) T;\n");
  const auto to = bake(begin + "Translate(4, 0, -3) SetAttribute(Field(ground)) T;\n");
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 200; ++i) axioms.push_back(somewhere(random, i, 50));
  const auto a = derived(from, axioms, fields).instances, b = derived(to, axioms, fields).instances;
  for (uint32_t i = 0; i < axioms.size(); ++i) EXPECT_EQ(a[i].attribute, b[i].attribute);
}

TEST(FieldValues, GridsAsSmallAsCanBeAndValuesThatAreNone) {
  Fields fields;
  fields.add("one", 1, 1, 5, 5, 5, 5, [](uint32_t, uint32_t) { return 4.5f; });
  fields.add("row", 2, 1, 0, 9, 10, -9, [](uint32_t x, uint32_t) { return x ? 20.0f : 10.0f; });
  fields.add("holes", 3, 2, 0, 0, 20, 10, [](uint32_t x, uint32_t z) {
    return x == 1 ? (z ? kInfinity : kNan) : x ? 1e-40f : -kInfinity;
  });
  const std::vector<GpgpAxiom> axioms{at(-1e30f, 1e30f), at(0, 0),  at(5, 5),    at(10, -3),
                                      at(7.5f, 1e9f),    at(20, 0), at(1e30f, 0)};
  EXPECT_EQ(valuesOf("Field(one)", axioms, fields), std::vector<float>(7, 4.5f));
  EXPECT_EQ(valuesOf("Field(row)", axioms, fields), (std::vector<float>{10, 10, 15, 20, 17.5f, 20, 20}));
  const auto holes = valuesOf("Field(holes)", axioms, fields);
  EXPECT_EQ(holes[1], -shader::kLargest);
  EXPECT_EQ(holes[3], 0.0f); // NaN
  EXPECT_EQ(holes[5], 0.0f); // less than 2^-100
  for (const float value : holes) EXPECT_LE(std::abs(value), shader::kLargest);
  EXPECT_EQ(valuesOf("Field(holes)", {at(10, 10)}, fields)[0], shader::kLargest);
}

// ---------------------------------------------------------------- the language

constexpr const char* kHills = R"(axiom Box Lot;
terminal House Tree (1, 0);
terminal Base (1, 1);
Lot = If(Field(water) > 0.5) { Discard() | Dry };
Dry = Translate(0, Field(ground), 0) RandomRule(Field(woods)) { 1: House | Exp(Field(woods, 1, ShapeSize(Z)) * 2): Trees };
Trees = Repeat(X, 1 + Field(woods), ADJUST_TO_FILL)
        SubDiv(Z) { -1: Tree | 1 + Field(woods): Base | Field(woods, Field(water), Rand(0, 2)): Tree };
)";

TEST(FieldLanguage, PrintedAndBuiltGrammarsAreTheSame) {
  const auto words = bake(kHills);
  const spawn::Graph graph = graphOf(words);
  ASSERT_EQ(graph.fields.size(), 3u);
  EXPECT_STREQ(graph.nameAt(graph.fields[0]), "water");
  EXPECT_STREQ(graph.nameAt(graph.fields[1]), "ground");
  const std::string text = spawn::printGraph(graph);
  EXPECT_NE(text.find("field water\nfield ground\nfield woods\n"), std::string::npos) << text;
  spawn::Diagnostics diagnostics;
  const auto printed = spawn::parseGraph(text, diagnostics, std::pmr::new_delete_resource());
  ASSERT_TRUE(printed) << format(diagnostics.sorted().at(0), "text");
  EXPECT_EQ(spawn::printGraph(printed->graph), text);
  EXPECT_EQ(printed->graph.code, graph.code);

  GpgpGrammarBuilder builder = nullptr;
  ASSERT_EQ(gpgpCreateGrammarBuilder(&builder), GPGP_SUCCESS);
  const spawn::SyntaxTree tree = spawn::parse(kHills, diagnostics);
  const Rebuild rebuild(tree, builder);
  auto source = init<GpgpGrammarSource>();
  source.builder = builder;
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
  ASSERT_EQ(blob.size, words.size() * 4);
  EXPECT_EQ(std::memcmp(blob.data, words.data(), blob.size), 0);
  gpgpFreeBlob(&blob);
  gpgpDestroyGrammarBuilder(builder);
}

TEST(FieldLanguage, LinkedGrammarsShareFieldsByName) {
  const std::string other = "axiom Box A;\nterminal T (1, 0);\nA = Translate(Field(snow), Field(water), 0) T;\n";
  const auto words = linked({{"hills.pga", kHills}, {"other.pga", other}});
  const spawn::Graph graph = graphOf(words);
  ASSERT_EQ(graph.fields.size(), 4u);
  EXPECT_STREQ(graph.nameAt(graph.fields[3]), "snow");
  EXPECT_EQ(linked({bakedFile({"hills.pga", kHills}), bakedFile({"other.pga", other})}), words);
  std::string many = "axiom Box A;\nterminal T (1, 0);\nA = ";
  for (int i = 0; i < 8; ++i) many += "Translate(0, Field(f" + std::to_string(i) + "), 0) ";
  EXPECT_EQ(graphOf(bake(many + "T;\n")).fields.size(), 8u);
  const std::string message = std::string("error: ") + spawn::kTooManyFields;
  const size_t column = many.size() - many.rfind('\n') + std::string("Translate(0, ").size();
  EXPECT_EQ(messagesOf(many + "Translate(0, Field(more), 0) T;\n").at(0),
            "3:" + std::to_string(column) + ": " + message);
  const auto messages = linkMessages({{"hills.pga", kHills}, bakedFile({"many.pga", many + "T;\n"})});
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages[0].find(message), std::string::npos) << messages[0];
}

TEST(FieldLanguage, BakedFieldsAreChecked) {
  const auto words = bake(kHills);
  const uint32_t at = words[shader::kHeaderSections + 2 * shader::kSectionFields + 1];
  const auto message = [&](uint32_t field, uint32_t name) {
    auto changed = words;
    changed[at + field] = name;
    changed[shader::kHeaderChecksum] = spawn::checksum(std::span(changed).subspan(shader::kHeaderChecked));
    const auto graph = spawn::load(std::as_bytes(std::span(changed)), std::pmr::new_delete_resource());
    return graph ? std::string() : std::string(graph.error().text);
  };
  EXPECT_EQ(message(1, words[at]), "fields 0 and 1 have the same name");
  EXPECT_EQ(message(2, 1u << 20), "field 2 has a bad name");
}

// ---------------------------------------------------------------- what is refused

TEST(FieldErrors, NameTheFieldAndTheRuleThatReadsIt) {
  const auto words = bake(kHills);
  const spawn::Graph graph = graphOf(words);
  Fields fields;
  for (const char* name : {"water", "other", "woods", "ground"})
    fields.add(name, 2, 2, 0, 0, 1, 1, [](uint32_t, uint32_t) { return 0.0f; });
  const auto message = [&](auto change) {
    Fields changed = fields;
    change(changed.list);
    const auto bound = spawn::bindFields(graph, {changed.list.data(), changed.count()});
    return bound ? std::string() : std::string(bound.error().text);
  };
  using List = std::vector<GpgpSpawnField>;
  EXPECT_EQ(message([](List&) {}), "");
  EXPECT_EQ(message([](List& f) { f.pop_back(); }), "rule Dry reads field \"ground\", which is not among fields");
  EXPECT_EQ(message([](List& f) { f[0].name = nullptr; }), "rule Lot reads field \"water\", which is not among fields");
  EXPECT_EQ(message([](List& f) { f[1].grid.width = 0; }), ""); // nobody reads it
  EXPECT_EQ(message([](List& f) { f[0].grid.width = 0; }), "field \"water\": width and height are from 1 to 16384");
  EXPECT_EQ(message([](List& f) { f[2].grid.height = 16385; }),
            "field \"woods\": width and height are from 1 to 16384");
  EXPECT_EQ(message([](List& f) { f[2].grid.min[0] = kNan; }), "field \"woods\": min or max is not finite");
  EXPECT_EQ(message([](List& f) { f[2].grid.max[1] = 0; }), "field \"woods\": min is not less than max");
  EXPECT_EQ(message([](List& f) { f[2].grid.values = nullptr; }), "field \"woods\": values is NULL");
}

// ---------------------------------------------------------------- on the device

/// All of an instance that is equal bit for bit on every device.
std::vector<std::vector<uint32_t>> bitsOf(const std::vector<GpgpInstance>& all) {
  std::vector<std::vector<uint32_t>> bits;
  for (const GpgpInstance& i : all) {
    std::vector<uint32_t>& words = bits.emplace_back(12);
    std::memcpy(words.data(), reinterpret_cast<const char*>(&i) + 48, 48);
  }
  std::sort(bits.begin(), bits.end());
  return bits;
}

struct FieldsOnDevice : SpawnerTest {
  GpgpRecorder makeSpawner(uint32_t colliders = 0) {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.queueFamily = device.graphics().family;
    info.maxShapes = info.maxTerminals = 16384;
    info.maxColliders = colliders;
    return spawnerOf(info);
  }
  GpgpResult record(GpgpRecorder spawner, const GpgpSpawnInfo& info) {
    const GpgpFrame f = advance();
    GpgpResult result = GPGP_SUCCESS;
    device.submitAndWait([&](VkCommandBuffer cmd) { result = gpgpRecordPrepareSpawn(spawner, cmd, &f, &info); });
    advance();
    return result;
  }
  std::vector<GpgpInstance> onDevice(GpgpRecorder spawner, GpgpAsset grammar, const std::vector<GpgpAxiom>& axioms,
                                     uint64_t capacity, const Fields& fields) {
    const auto from = host::makeBuffer(device, axioms, kStorage),
               values = host::makeBuffer(device, fields.values, kStorage);
    const host::Buffer instances(device, VkDeviceSize(96) * std::max<uint64_t>(capacity, 1), kStorage);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.axioms = from.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    info.instances = instances.range();
    info.fields = fields.list.data();
    info.fieldCount = fields.count();
    info.fieldValues = values.range();
    EXPECT_EQ(record(spawner, info), GPGP_SUCCESS) << lastMessage();
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
    EXPECT_EQ(report.base.status, GPGP_SUCCESS);
    return host::download<GpgpInstance>(device, instances, report.instancesWritten);
  }
};

/// Noise with values that no other field has: none, too large, too small.
Fields noise(std::mt19937& random, std::initializer_list<const char*> names) {
  Fields fields;
  std::uniform_real_distribution<float> value(0, 3);
  for (const char* name : names) {
    const uint32_t width = 1 + uint32_t(random() % 40), height = 1 + uint32_t(random() % 40);
    fields.add(name, width, height, -50 - value(random), -40, 45, 50 + value(random), [&](uint32_t, uint32_t) {
      const uint32_t kind = uint32_t(random() % 40);
      return kind == 0 ? kNan : kind == 1 ? 1e35f : kind == 2 ? -1e-40f : value(random);
    });
  }
  return fields;
}

const char* const kColliding = R"(axiom Box A;
terminal T (1, 0); terminal Small (1, 1);
A = SubDiv(Y) { -1: Collider(1) If(Field(a) < 1.5) { Small | Repeat(X, 1.5, ADJUST_TO_FILL) T } |
                -1: IfCollides(1) { SetAttribute(Field(b, 1, 2)) Small |
                                    Repeat(Z, 0.5 + Field(a, ShapeSize(X), 0), ADJUST_TO_FILL) T } };
)";

TEST_F(FieldsOnDevice, DeviceAndCpuReadTheSame) {
  std::mt19937 random(17);
  struct Case {
    const char* name;
    std::string text;
    bool kernel, colliders;
  };
  const Case cases[] = {{"hills interpreted", kHills, false, false},
                        {"hills by their kernel", kHills, true, false},
                        {"colliders interpreted", kColliding, false, true},
                        {"colliders by their kernel", kColliding, true, true}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const auto words = bake(c.text);
    const GpgpRecorder spawner = makeSpawner(c.colliders ? 4096 : 0);
    const std::string baked = c.kernel ? bakedFile({"grammar.pga", c.text}, GPGP_COMPILE_KERNEL).text : std::string();
    const GpgpAsset grammar =
        c.kernel ? load(spawner, baked.data(), baked.size()) : load(spawner, words.data(), words.size() * 4);
    uint64_t fewest = UINT64_MAX, most = 0;
    for (int k = 0; k < 4; ++k) {
      const Fields fields = noise(random, {"a", "b", "woods", "ground", "water"});
      std::vector<GpgpAxiom> axioms;
      for (uint32_t i = 0; i < 40; ++i) axioms.push_back(somewhere(random, i, c.colliders ? 20.0f : 60.0f));
      const auto cpu = derived(words, axioms, fields);
      ASSERT_TRUE(cpu.complete);
      const auto gpu = onDevice(spawner, grammar, axioms, cpu.terminals, fields);
      EXPECT_EQ(bitsOf(gpu), bitsOf(cpu.instances));
      fewest = std::min(fewest, cpu.terminals);
      most = std::max(most, cpu.terminals);
    }
    EXPECT_LT(fewest, most);
    gpgpDestroyAsset(grammar);
  }
}

TEST_F(FieldsOnDevice, RandomGrammarsThatReadFields) {
  std::mt19937 random(41);
  const GpgpRecorder spawner = makeSpawner(4096);
  uint32_t asked = 0, differ = 0, compared = 0;
  for (uint32_t seed = 0; seed < 60; ++seed) {
    std::string text = randomGrammar(seed);
    const auto replaceAll = [&](const std::string& from, const std::string& to) {
      for (size_t place = text.find(from); place != std::string::npos; place = text.find(from, place + to.size())) {
        text.replace(place, from.size(), to);
        ++asked;
      }
    };
    replaceAll("ShapeSeed()", seed % 2 ? "Field(a)" : "Exp(Field(b, ShapeSize(X), 0 - 1) / 3)");
    replaceAll("ShapeCustomAttribute()", seed % 3 ? "Exp(Field(c) / 4)" : "Field(a, Field(c), Rand(-4, 4))");
    SCOPED_TRACE(text);
    const auto words = bake(text);
    const Fields fields = noise(random, {"c", "b", "a"}), others = noise(random, {"a", "b", "c"});
    std::vector<GpgpAxiom> axioms;
    for (uint32_t i = 0; i < 6; ++i) axioms.push_back(somewhere(random, i, 60));
    const auto cpu = derived(words, axioms, fields), other = derived(words, axioms, others);
    if (!cpu.complete || cpu.terminals > 8000 || cpu.droppedShapes || cpu.unfinishedShapes) continue;
    ++compared;
    differ += std::memcmp(cpu.keyHash, other.keyHash, 8) != 0;
    const GpgpAsset grammar = load(spawner, words.data(), words.size() * 4);
    EXPECT_EQ(bitsOf(onDevice(spawner, grammar, axioms, cpu.terminals, fields)), bitsOf(cpu.instances));
    gpgpDestroyAsset(grammar);
  }
  EXPECT_GT(asked, 100u);
  EXPECT_GT(differ, 5u); // so that fields decide something
  EXPECT_GT(compared, 30u);
}

TEST_F(FieldsOnDevice, EvaluatorAndTilesTakeFields) {
  const auto words = bake(kHills);
  std::mt19937 random(23);
  const Fields fields = noise(random, {"woods", "ground", "water"});
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 20; ++i) axioms.push_back(somewhere(random, i, 60));
  const auto expected = derived(words, axioms, fields);
  auto source = init<GpgpGrammarSource>();
  source.name = "hills.pga";
  source.text = kHills;
  source.size = std::strlen(kHills);
  std::vector<std::string> said;
  auto info = init<GpgpEvaluatorCreateInfo>();
  info.sources = &source;
  info.sourceCount = 1;
  info.messageUserData = &said;
  info.messageFn = [](void* user, const GpgpMessage* m) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(m->text);
  };
  auto evaluator = Evaluator::create(info);
  ASSERT_TRUE(evaluator);
  const char* names[8] = {};
  uint32_t count = 8;
  ASSERT_EQ(evaluator->fields(count, names), GPGP_SUCCESS);
  ASSERT_EQ(count, 3u);
  EXPECT_STREQ(names[2], "woods");
  count = 1;
  EXPECT_EQ(evaluator->fields(count, names), GPGP_INCOMPLETE);
  EXPECT_EQ(count, 3u);
  auto evaluation = evaluator->evaluation();
  ASSERT_TRUE(evaluation);
  auto what = init<GpgpEvaluationInfo>();
  what.axioms = axioms.data();
  what.axiomCount = 20;
  what.rangeCount = 4;
  EXPECT_EQ(evaluation->derive(what), GPGP_ERROR_INVALID_ARGUMENT);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back(), "rule Lot reads field \"water\", which is not among fields");
  what.fieldCount = fields.count();
  EXPECT_EQ(evaluation->derive(what), GPGP_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(said.back(), "fields is NULL, fieldCount is 3");
  what.fields = fields.list.data();
  ASSERT_EQ(evaluation->derive(what), GPGP_SUCCESS);
  EXPECT_EQ(evaluation->result()->terminals, expected.terminals);
  EXPECT_EQ(std::memcmp(evaluation->result()->keyHash, expected.keyHash, 8), 0);

  const GpgpRecorder spawner = makeSpawner();
  const GpgpAsset grammar = load(spawner, words.data(), words.size() * 4);
  count = 8;
  ASSERT_EQ(gpgpGetGrammarFields(grammar, &count, names), GPGP_SUCCESS);
  ASSERT_EQ(count, 3u);
  EXPECT_STREQ(names[0], "water");
  const host::Buffer instances(device, 96 * 8192, kStorage), draws(device, 4096, kStorage);
  host::fill(device, draws, 0);
  auto create = init<GpgpTileSetCreateInfo>();
  create.spawner = spawner;
  create.grammar = grammar;
  create.maxTiles = 1;
  create.instances = instances.range();
  create.draws = draws.range();
  auto set = TileSet::create(context, create);
  ASSERT_TRUE(set) << lastMessage();
  const auto from = host::makeBuffer(device, axioms, kStorage),
             values = host::makeBuffer(device, fields.values, kStorage);
  auto tileInfo = init<GpgpTileInfo>();
  tileInfo.axioms = from.range();
  tileInfo.axiomCount = 20;
  tileInfo.capacity = 4096;
  tileInfo.fields = fields.list.data();
  tileInfo.fieldCount = fields.count();
  tileInfo.fieldValues = values.range();
  GpgpTile tile = 0;
  const GpgpFrame f = advance();
  device.submitAndWait(
      [&](VkCommandBuffer cmd) { EXPECT_EQ(set->record(cmd, f, tileInfo, tile), GPGP_SUCCESS) << lastMessage(); });
  advance();
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  ASSERT_EQ(gpgpGetSpawnReport(spawner, &report), GPGP_SUCCESS);
  EXPECT_EQ(report.terminals, expected.terminals);
  EXPECT_EQ(std::memcmp(report.keyHash, expected.keyHash, 8), 0);
  set->reset();
  gpgpDestroyAsset(grammar);
}

TEST_F(FieldsOnDevice, RecordingsNameWhatIsWrong) {
  const auto words = bake(kHills);
  std::mt19937 random(3);
  const Fields good = noise(random, {"woods", "ground", "water"});
  const GpgpRecorder spawner = makeSpawner();
  const GpgpAsset grammar = load(spawner, words.data(), words.size() * 4);
  const auto from = host::makeBuffer(device, std::vector<GpgpAxiom>{at(0, 0)}, kStorage),
             values = host::makeBuffer(device, good.values, kStorage);
  const host::Buffer instances(device, 96 * 1024, kStorage);
  const auto message = [&](auto change) {
    Fields fields = good;
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.axioms = from.range();
    info.axiomCount = 1;
    info.instances = instances.range();
    info.fieldValues = values.range();
    info.fields = fields.list.data();
    info.fieldCount = fields.count();
    change(info, fields.list);
    messages.clear();
    const GpgpResult result = record(spawner, info);
    GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
    while (gpgpGetSpawnReport(spawner, &report) == GPGP_SUCCESS) {
    }
    EXPECT_EQ(result, messages.empty() ? GPGP_SUCCESS : GPGP_ERROR_INVALID_ARGUMENT);
    const std::string all = lastMessage();
    return all.substr(std::min(all.find(": ") + 2, all.size()));
  };
  using List = std::vector<GpgpSpawnField>;
  EXPECT_EQ(message([](GpgpSpawnInfo&, List&) {}), "");
  EXPECT_EQ(message([](GpgpSpawnInfo&, List& f) {
              for (GpgpSpawnField& field : f) field.grid.values = nullptr; // which the CPU alone reads
            }),
            "");
  EXPECT_EQ(message([](GpgpSpawnInfo& i, List&) { i.fieldCount = 0; }),
            "rule Lot reads field \"water\", which is not among fields");
  EXPECT_EQ(message([](GpgpSpawnInfo& i, List&) { i.fields = nullptr; }), "fields is NULL, fieldCount is 3");
  EXPECT_EQ(message([](GpgpSpawnInfo& i, List&) { i.fieldValues = {}; }),
            "field \"water\": it is read from fieldValues, whose buffer is NULL");
  EXPECT_EQ(message([](GpgpSpawnInfo&, List& f) { f[1].offset += 2; }),
            "field \"ground\": offset is not a multiple of 4");
  EXPECT_EQ(message([](GpgpSpawnInfo&, List& f) { f[2].offset += 4; }),
            "field \"water\": it does not lie within fieldValues");
  EXPECT_EQ(message([](GpgpSpawnInfo&, List& f) { f[2].offset = ~VkDeviceSize(3); }),
            "field \"water\": it does not lie within fieldValues");
  gpgpDestroyAsset(grammar);
}

} // namespace
