// Live editing of .cga files in the mini-engine, by a script: what each state shows, against the library's derivation
// of the same text and values; attributes by their annotations; imports; the old town under the message of a broken
// file.
#include "live_run.h"
#include "mini_engine/level.h"
#include "mini_engine/live_cga.h"

#include <gpgp/cga.hpp>

#include <cstring>
#include <fstream>

namespace {
namespace fs = std::filesystem;
using namespace gpgp::test;

const char* const kTown = R"(version "2023.0"
import roof: "roof.cga"
@Group("Size", 1) @Range(min=1, max=6, stepsize=1) @Description("Storeys of a house")
attr floors = 25%: 1 50%: 2 else: 3
@Group("Look", 2) @Color
attr wall = "#d9b38c"
@Group("Look", 2) @Enum("flat", "steep")
attr shape = "flat"
@Group("Size", 1)
attr garden = true
@Hidden
attr secret = 1
Lot --> case garden: Grass split(x) { 3: NIL | ~1: split(z) { 3: NIL | ~1: House } | 3: NIL } else: House
Grass --> color("#7fa35b") Grass.
House --> extrude(floors * 3 * secret) comp(f) { top: Top | side: color(wall) Wall. }
Top --> case shape == "steep": roof.Steep else: color("#4d4a4c") Flat.
)";
const char* const kRoof = "version \"2023.0\"\nSteep --> roofGable(40) color(\"#8c3b2a\") Roof.\n";

struct LiveCgaEditing : testing::Test {
  const fs::path folder = GPGP_GOLDEN_OUT "-live-cga";
  std::string output;

  void SetUp() override {
    if (std::string(GPGP_LIVE) != "1") GTEST_SKIP() << "built without gpgp::imgui";
    fs::remove_all(folder);
    fs::create_directories(folder);
    write("town.cga", kTown);
    write("roof.cga", kRoof);
  }
  void write(const char* name, const std::string& contents) const {
    std::ofstream(folder / name, std::ios::binary) << contents;
  }
  static std::string replaced(std::string from, const std::string& what, const std::string& by) {
    const size_t at = from.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? from : from.replace(at, what.size(), by);
  }
  /// The library's own derivation, with the texts that lie in the folder.
  void expectDerived(const State& state, const std::string& text, const std::vector<GpgpCgaValue>& values) const {
    auto info = gpgp::init<GpgpCgaProgramCreateInfo>();
    const std::string name = (folder / "town.cga").string();
    info.name = name.c_str();
    info.text = text.data();
    info.size = text.size();
    const gpgp::Result<gpgp::CgaProgram> program = gpgp::CgaProgram::create(info);
    ASSERT_TRUE(program) << program.name();
    gpgp::Result<gpgp::CgaDerivation> derivation = program->derivation();
    ASSERT_TRUE(derivation);
    std::vector<GpgpCgaLot> lots;
    for (GpgpAxiom axiom : mini::levelAxioms()) {
      axiom.size[0] = axiom.size[2] = 20;
      axiom.size[1] = axiom.transform[7] = 0;
      lots.push_back({});
      lots.back().axiom = axiom;
    }
    auto derive = gpgp::init<GpgpCgaDerivationInfo>();
    derive.lots = lots.data();
    derive.lotCount = static_cast<uint32_t>(lots.size());
    derive.values = values.data();
    derive.valueCount = static_cast<uint32_t>(values.size());
    ASSERT_EQ(derivation->derive(derive), GPGP_SUCCESS);
    const GpgpCgaDerivationResult result = *derivation->result();
    uint64_t hash = 14695981039346656037u; // FNV-1a, a word at a time
    const auto add = [&](const void* word) {
      uint32_t bits = 0;
      std::memcpy(&bits, word, 4);
      hash = (hash ^ bits) * 1099511628211u;
    };
    for (uint32_t v = 0; v < result.vertexCount; ++v)
      for (const float& x : result.vertices[v].position) add(&x);
    for (uint32_t i = 0; i < result.indexCount; ++i) add(&result.indices[i]);
    char shown[17];
    std::snprintf(shown, sizeof shown, "%016llx", static_cast<unsigned long long>(hash));
    EXPECT_EQ(state.count, result.triangles) << state.file;
    EXPECT_EQ(state.keyHash, shown) << state.file;
  }
};

TEST_F(LiveCgaEditing, AttributesFilesAndImportsAreSeenAndBrokenOnesLeaveTheTown) {
  const std::string tall = replaced(kTown, "floors * 3 *", "floors * 4 *");
  write("tall.cga", tall);
  write("broken.cga", replaced(tall, "House --> extrude", "House --> extrude extrude"));
  write("script", "picture first.png\n"
                  "set floors 4.4\n" // a step of its range: 4
                  "picture floors.png\n"
                  "set wall #ff0000\n"
                  "picture wall.png\n"
                  "set shape steep\n"
                  "picture steep.png\n"
                  "set garden false\n"
                  "picture bare.png\n"
                  "write tall.cga\n"
                  "picture tall.png\n"
                  "write broken.cga\n"
                  "picture broken.png\n"
                  "write tall.cga\n"
                  "set floors 1\n"
                  "picture again.png\n");
  const std::vector<State> states = runLive(folder, "town.cga", output);
  ASSERT_EQ(states.size(), 8u) << output;
  const std::vector<GpgpCgaValue> values{{"floors", "4"}, {"wall", "#ff0000"}, {"shape", "steep"}, {"garden", "false"}};
  const auto first = [&](size_t count) { return std::vector<GpgpCgaValue>(values.begin(), values.begin() + count); };
  for (size_t i = 0; i < 5; ++i) expectDerived(states[i], kTown, first(i));
  expectDerived(states[5], tall, values); // what was set stays
  expectDerived(states[6], tall, values); // the old town
  expectDerived(states[7], tall, {{"floors", "1"}, values[1], values[2], values[3]});

  const auto picture = [&](size_t i) { return gpgp::host::readPng(states[i].file); };
  const int panel[4] = {480 - 192 - 12, 0, 480, 260};
  for (size_t i = 0; i < 5; ++i) EXPECT_GT(different(picture(i), picture(i + 1), panel), 500u) << i;
  for (size_t i = 0; i < states.size(); ++i) {
    if (i == 6) continue;
    EXPECT_TRUE(states[i].errors.empty()) << states[i].errors[0];
    EXPECT_EQ(states[i].errorBox[2], 0);
  }
  ASSERT_FALSE(states[6].errors.empty()) << output;
  EXPECT_EQ(states[6].errors[0].rfind((folder / "town.cga").string() + ":15:", 0), 0u) << states[6].errors[0];
  EXPECT_EQ(different(picture(5), picture(6), states[6].errorBox), 0u);
  EXPECT_GT(different(picture(5), picture(6), kNowhere), 1500u);
}

TEST(LiveCga, ShowsAttributesAsTheirAnnotationsSay) {
  const fs::path folder = GPGP_GOLDEN_OUT "-live-cga-attributes";
  fs::create_directories(folder);
  std::ofstream(folder / "town.cga", std::ios::binary) << kTown;
  std::ofstream(folder / "roof.cga", std::ios::binary) << kRoof;
  GpgpCgaLot lot{};
  lot.axiom = mini::levelAxioms()[0];
  lot.axiom.size[1] = lot.axiom.transform[7] = 0;
  mini::LiveCga live((folder / "town.cga").string(), {lot});
  const auto mesh = live.update();
  ASSERT_TRUE(mesh) << (live.errors().empty() ? "" : live.errors()[0].text);
  EXPECT_GT(mesh->triangles(), 10u);
  for (const mini::TownMesh::Vertex& vertex : mesh->vertices) EXPECT_GT(vertex.colour[1], 0);
  const std::vector<mini::LiveAttribute>& all = live.attributes();
  ASSERT_EQ(all.size(), 4u); // without the hidden one
  const char* const names[] = {"floors", "garden", "wall", "shape"};
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(all[i].name, names[i]);
  EXPECT_EQ(all[0].kind, mini::LiveAttribute::number);
  EXPECT_EQ(all[0].min, 1);
  EXPECT_EQ(all[0].max, 6);
  EXPECT_EQ(all[0].step, 1);
  EXPECT_EQ(all[0].group, "Size");
  EXPECT_EQ(all[0].description, "Storeys of a house");
  EXPECT_EQ(all[1].kind, mini::LiveAttribute::boolean);
  EXPECT_EQ(all[2].kind, mini::LiveAttribute::colour);
  EXPECT_EQ(all[2].text(), "#d9b38c");
  EXPECT_EQ(all[3].kind, mini::LiveAttribute::choice);
  EXPECT_EQ(all[3].choices, (std::vector<std::string>{"flat", "steep"}));
  EXPECT_FALSE(live.set("shape", "round"));
  EXPECT_FALSE(live.set("floors", "many"));
  EXPECT_FALSE(live.set("secret", "2"));
  EXPECT_FALSE(live.update()); // nothing has changed

  // An import is followed; one that is broken is named, with its place, at the second look.
  std::ofstream(folder / "roof.cga", std::ios::binary) << "version \"2023.0\"\nSteep --> roofGable(\n";
  EXPECT_FALSE(live.update());
  EXPECT_FALSE(live.update());
  ASSERT_FALSE(live.errors().empty());
  EXPECT_NE(live.errors()[0].place().find("roof.cga:"), std::string::npos) << live.errors()[0].place();
  std::ofstream(folder / "roof.cga", std::ios::binary) << kRoof << "\n";
  EXPECT_TRUE(live.update());
  EXPECT_TRUE(live.errors().empty());
}

} // namespace
