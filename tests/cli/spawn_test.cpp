// `gpgp spawn` on grammars whose terminals can be counted by hand.
#include "files.h"
#include "glb.h"
#include "host/files.h"
#include "host/picture.h"
#include "run.h"
#include "spawn/shared/layout.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

namespace gpgp::test {
namespace {

constexpr const char* kTower = R"(axiom Box Tower;
terminal Floor (1, 0);
Tower = Repeat(Y, 1, ADJUST_TO_FILL) Floor;
)";

TEST(CliSpawn, CountsTerminals) {
  const TemporaryFile grammar("tower.pga", kTower), picture("tower.png");
  const json tower = gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "4,10,4", "--repeat", "2",
                               "--image", picture.path(), "--image-size", "96x64", "--validate"});
  EXPECT_EQ(keys(tower), (std::set<std::string>{"command",
                                                "ok",
                                                "grammar",
                                                "device",
                                                "status",
                                                "output",
                                                "schedule",
                                                "schedule_file",
                                                "execution_groups",
                                                "axioms",
                                                "recordings",
                                                "seed",
                                                "terminals",
                                                "instances",
                                                "vertices",
                                                "triangles",
                                                "buckets",
                                                "rules",
                                                "rounds",
                                                "peak_shapes",
                                                "max_shapes",
                                                "measures",
                                                "detail",
                                                "max_rounds",
                                                "dropped_shapes",
                                                "unfinished_shapes",
                                                "colliders",
                                                "budget_exceeded",
                                                "key_hash",
                                                "bytes_written",
                                                "gpu_ms_median",
                                                "passes",
                                                "cpu_reference_terminals",
                                                "cpu_reference_ms",
                                                "changed",
                                                "image",
                                                "out"}));
  EXPECT_EQ(tower["status"], "GPGP_SUCCESS");
  EXPECT_EQ(tower["terminals"], 30);
  EXPECT_EQ(tower["instances"], 30);
  EXPECT_EQ(tower["triangles"], 30 * 12);
  EXPECT_EQ(tower["bytes_written"], 30 * 96);
  EXPECT_EQ(tower["budget_exceeded"], false);
  EXPECT_EQ(tower["cpu_reference_terminals"], 30);
  EXPECT_GT(tower["cpu_reference_ms"].get<double>(), 0);
  ASSERT_EQ(tower["buckets"].size(), 1u);
  EXPECT_EQ(tower["buckets"][0]["name"], "Floor");
  EXPECT_EQ(tower["buckets"][0]["instances"], 30);
  EXPECT_EQ(tower["rules"], json::array({{{"rule", "Tower"}, {"instances", 30}}}));
  EXPECT_EQ(tower["key_hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(host::readPng(picture.path()).width, 96u);
  const json again = gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "4,10,4"});
  EXPECT_EQ(again["key_hash"], tower["key_hash"]);
  const json otherSeed = gpgpJson({"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "4,10,4", "--seed", "9"});
  EXPECT_NE(otherSeed["key_hash"], tower["key_hash"]);
}

/// Corners of a binary glTF file's triangles, in an order of their own.
std::vector<std::array<Vector, 3>> trianglesOf(const std::string& file) {
  std::vector<std::array<Vector, 3>> triangles;
  for (const GlbTriangle& t : readGlb(file).triangles) triangles.push_back(t.corners);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(CliSpawn, InstancesWithCornersOfTheirOwnAreDrawnWithThem) {
  const TemporaryFile grammar("corners.pga",
                              "axiom Box S;\nterminal T (0, 0);\n"
                              "S = Repeat(X, 2, ADJUST_TO_FILL) SetAsDynamicConcaveRightPrism((-0.5,-0.5),(0.5,-0.5),"
                              "(0.5,0),(0,0),(0,0.5),(-0.5,0.5)) T;\n"),
      instances("corners_instances.glb"), vertices("corners_vertices.glb");
  const auto spawn = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {"spawn", grammar.path(), "--axioms", "3", "--axiom-size", "8,2,2", "--slice", "2", "--validate"});
    return gpgpJson(more);
  };
  const json one = spawn({"--out", instances.path()}), two = spawn({"--out", vertices.path(), "--output", "vertices"});
  EXPECT_EQ(one["instances"], 12);
  EXPECT_EQ(one["triangles"], 12 * (2 * 4 + 6 * 2)); // an L's two ends and six sides
  EXPECT_EQ(one["triangles"], two["triangles"]);
  EXPECT_EQ(one["bytes_written"], 12 * 96); // of the instances alone
  const auto triangles = trianglesOf(instances.path());
  EXPECT_EQ(triangles.size(), one["triangles"]);
  EXPECT_EQ(triangles, trianglesOf(vertices.path()));
}

constexpr const char* kStreet = R"(axiom Box Street;
terminal Wall Roof (1, 0);
terminal Window (1, 1);
Street = SubDiv(X) { -1: House | -1: Tall | -1: House };
House = IfSizeLess(Y, 5) { Wall | Floors };
Tall = Scale(-1, -0.5, -1) Translate(0, 1, 0) Floors;
Floors = Repeat(Y, 2, ADJUST_TO_FILL) Front;
Front = CompSplit() { Roof | Discard() | Wide };
Wide = Extrude(0.1) Window;
)";

TEST(CliSpawn, EveryScheduleDerivesTheSame) {
  const TemporaryFile grammar("street.pga", kStreet), groups("street_groups.txt"), baked("street.gpgp");
  ASSERT_EQ(gpgp({"graph", grammar.path(), "--schedule", "heuristic", "-o", groups.path()}).exitCode, 0);
  ASSERT_EQ(gpgp({"bake", grammar.path(), "-o", baked.path()}).exitCode, 0);
  const auto derive = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"spawn", grammar.path(), "--axioms", "2", "--axiom-size", "9,8,4"});
    return gpgpJson(more);
  };
  const json wanted = derive({"--schedule", "interpreter"});
  EXPECT_EQ(wanted["terminals"], 2 * (4 + 2 + 4) * 5);
  EXPECT_EQ(wanted["schedule"], "interpreter");
  std::map<std::string, json> all;
  for (const std::string& schedule : {std::string("default"), std::string("sgl"), std::string("rw"), groups.path()}) {
    const json one = all[schedule] = derive({"--schedule", schedule, "--matching", schedule == "rw" ? "on" : "off"});
    EXPECT_EQ(one["terminals"], wanted["terminals"]) << schedule;
    EXPECT_EQ(one["key_hash"], wanted["key_hash"]) << schedule;
    EXPECT_EQ(one["budget_exceeded"], false) << schedule;
  }
  const TemporaryFile queues("schedules_queues.gpgp", "");
  gpgpJson({"bake", grammar.path(), "--queues", "group", "-o", queues.path()});
  for (const json& one : {derive({"--schedule", "rw", "--queues", "group"}), derive({"--schedule", queues.path()})}) {
    EXPECT_EQ(one["schedule"], one["schedule_file"].is_null() ? "rw, queues" : "default, queues");
    EXPECT_EQ(one["terminals"], wanted["terminals"]);
    EXPECT_EQ(one["key_hash"], wanted["key_hash"]);
  }
  for (const char* schedule : {"sgl", "rw"}) {
    const json graph = gpgpJson({"graph", grammar.path(), "--schedule", schedule});
    EXPECT_EQ(all[schedule]["execution_groups"], graph["execution_groups"]) << schedule;
    EXPECT_EQ(all[schedule]["schedule"], schedule);
  }
  EXPECT_LT(all["sgl"]["execution_groups"], all["rw"]["execution_groups"]);
  const json fromFile = derive({"--schedule", baked.path()});
  EXPECT_EQ(fromFile["schedule"], "default"); // the kernel that it was baked with
  EXPECT_EQ(fromFile["schedule_file"], baked.path());
  EXPECT_EQ(fromFile["execution_groups"], all["default"]["execution_groups"]);
  EXPECT_EQ(fromFile["key_hash"], wanted["key_hash"]);
}

TEST(CliSpawn, TheHeuristicsGroupSizeIsSet) {
  const std::string house = GPGP_SAMPLE_GRAMMARS "/simple_house.pga";
  std::vector<json> groups;
  for (const char* size : {"0", "5"}) {
    const json spawned = gpgpJson({"spawn", house, "--schedule", "heuristic", "--group-size", size});
    groups.push_back(spawned["execution_groups"]);
    EXPECT_EQ(groups.back(),
              gpgpJson({"graph", house, "--schedule", "heuristic", "--group-size", size})["execution_groups"]);
  }
  EXPECT_GT(groups[0], groups[1]);
  EXPECT_EQ(gpgpJson({"spawn", house, "--schedule", "heuristic"})["execution_groups"], groups[1]); // the thesis's 5
}

TEST(CliSpawn, WritesVertices) {
  const TemporaryFile grammar("vertices.pga", kStreet), picture("vertices.png"), out("vertices.glb");
  const std::vector<std::string> common = {"spawn",        grammar.path(), "--axioms",   "2",
                                           "--axiom-size", "9,8,4",        "--schedule", "interpreter"};
  const auto derive = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    return gpgpJson(more);
  };
  const json instances = derive({});
  const json vertices = derive(
      {"--output", "vertices", "--validate", "--image", picture.path(), "--image-size", "96x64", "--out", out.path()});
  EXPECT_EQ(vertices["terminals"], instances["terminals"]);
  EXPECT_EQ(vertices["key_hash"], instances["key_hash"]);
  EXPECT_EQ(vertices["instances"], 0);
  // Of five terminals of a floor one is a quad and four are boxes.
  EXPECT_EQ(vertices["triangles"], 2 * 10 * (2 + 4 * 12));
  EXPECT_EQ(vertices["triangles"], instances["triangles"]);
  EXPECT_EQ(vertices["vertices"], 2 * 10 * (4 + 4 * 24));
  EXPECT_EQ(vertices["bytes_written"], 2 * 10 * ((4 + 4 * 24) * 32 + (2 + 4 * 12) * 3 * 4));
  EXPECT_EQ(vertices["buckets"][0]["triangles"], 2 * 10 * 2);
  EXPECT_EQ(host::readPng(picture.path()).width, 96u);
  EXPECT_EQ(host::readText(out.path()).substr(0, 4), "glTF");
  auto less = common;
  less.insert(less.end(), {"--output", "vertices", "--max-instances", "100"});
  const json few = gpgpExceeded(less);
  EXPECT_EQ(few["budget_exceeded"], true);
  EXPECT_LE(few["vertices"], 100);
  EXPECT_EQ(few["terminals"], instances["terminals"]);
  const json sorted = derive({"--sorted"});
  EXPECT_EQ(sorted["buckets"], instances["buckets"]);
}

TEST(CliSpawn, BudgetsThatAreSetAreKept) { // and what is lost is told; others grow until all fits
  const TemporaryFile grammar("wide.pga", "axiom Box A;\nterminal T (1, 0);\nA = IfSizeLess(X, 0.03) { T | B };\n"
                                          "B = SubDiv(X) { -1: C | -1: C };\nC = SubDiv(Y) { -1: A | -1: A };\n");
  const std::vector<std::string> common = {"spawn", grammar.path(), "--axioms", "40", "--schedule", "interpreter"};
  const json whole = gpgpJson(common);
  EXPECT_EQ(whole["terminals"], 40 << 12);
  EXPECT_EQ(whole["dropped_shapes"], 0);
  EXPECT_EQ(whole["budget_exceeded"], false);
  auto small = common;
  small.insert(small.end(), {"--max-shapes", "2"});
  small.push_back("--json");
  const ProcessResult result = gpgp(small);
  const json told = json::parse(result.out);
  EXPECT_EQ(result.exitCode, told["budget_exceeded"] ? 1 : 0);
  EXPECT_EQ(told["max_shapes"], 2);
  EXPECT_EQ(told["budget_exceeded"], told["dropped_shapes"].get<uint32_t>() > 0);
  EXPECT_EQ(told["terminals"] == whole["terminals"], told["dropped_shapes"] == 0);
}

TEST(CliSpawn, SchedulesFromFilesAreChecked) {
  const TemporaryFile grammar("checked.pga", kStreet), other("other.pga", kTower), baked("other.gpgp"),
      groups("wrong_groups.txt", "group { 0 1\n");
  ASSERT_EQ(gpgp({"bake", other.path(), "--no-kernel", "-o", baked.path()}).exitCode, 0);
  EXPECT_NE(gpgpFailure({"spawn", grammar.path(), "--schedule", baked.path()}).find("is not a baking of this grammar"),
            std::string::npos);
  EXPECT_NE(gpgpFailure({"spawn", other.path(), "--schedule", baked.path()}).find("holds no kernel"),
            std::string::npos);
  EXPECT_NE(gpgpFailure({"spawn", grammar.path(), "--schedule", groups.path()}).find("wrong_groups.txt:"),
            std::string::npos);
  const TemporaryFile more("more_groups.txt", "group { 0 1000 }\ngroup { 2000 }\n");
  const std::string graph = gpgp({"graph", grammar.path(), "--schedule", more.path()}).err;
  const std::string spawn = gpgp({"spawn", grammar.path(), "--schedule", more.path()}).err;
  EXPECT_EQ(graph.substr(0, graph.rfind("gpgp graph")), spawn.substr(0, spawn.rfind("gpgp spawn"))); // all of them
  expectWrongUsage({{"spawn", grammar.path(), "--schedule", "fastest"},
                    {"spawn", grammar.path(), "--matching", "yes"},
                    {"spawn", grammar.path(), "--output", "triangles"},
                    {"spawn", grammar.path(), "--output", "vertices", "--sorted"}});
}

TEST(CliSpawn, WhatHasNoEffectIsWrong) {
  const TemporaryFile grammar("effect.pga", kTower), axioms("effect.csv", "x,z\n0,0\n"),
      dynamic("effect_dynamic.pga",
              "axiom Box S;\nterminal T (0, 0);\n"
              "S = Replicate() { P | P };\nP = SetAsDynamicConvexPolygon((0,0.5),(-0.5,-0.5),(0.5,-0.5)) T;\n");
  expectWrongUsage({{"spawn", grammar.path(), "--queues", "group", "--schedule", "interpreter"},
                    {"spawn", grammar.path(), "--queues", "group", "--schedule", "tuned"},
                    {"spawn", grammar.path(), "--queues", "both"},
                    {"spawn", grammar.path(), "--matching", "on"},
                    {"spawn", grammar.path(), "--matching", "on", "--schedule", "interpreter"},
                    {"spawn", grammar.path(), "--axiom-file", axioms.path(), "--spacing", "3"},
                    {"spawn", grammar.path(), "--yaw", "3"},
                    {"spawn", grammar.path(), "--image-size", "32x32"},
                    {"spawn", dynamic.path(), "--schedule", "interpreter", "--max-instances", "1"}});
  const json both = gpgpJson({"spawn", dynamic.path(), "--schedule", "interpreter", "--max-instances", "2"});
  EXPECT_EQ(both["triangles"], 2);
}

TEST(CliSpawn, BudgetsAreReported) {
  const TemporaryFile grammar("budget.pga", kTower);
  const json tower = gpgpExceeded({"spawn", grammar.path(), "--axiom-size", "4,10,4", "--max-instances", "4"});
  EXPECT_EQ(tower["status"], "GPGP_BUDGET_EXCEEDED");
  EXPECT_EQ(tower["terminals"], 10);
  EXPECT_EQ(tower["instances"], 4);
  EXPECT_EQ(tower["budget_exceeded"], true);
}

TEST(CliSpawn, WhatWasExceededIsNamed) {
  const TemporaryFile grammar("named.pga", kTower), deep("named_deep.pga", "axiom Box S;\nterminal T (0, 0);\n"
                                                                           "S = Replicate() { T | S };\n");
  const auto said = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "spawn");
    arguments.insert(arguments.end(), {"--schedule", "interpreter"});
    const ProcessResult result = gpgp(arguments);
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_NE(result.out.find("terminals"), std::string::npos); // what there is is told all the same
    const size_t at = result.err.find("budget exceeded: ");
    return at == std::string::npos ? result.err : result.err.substr(at + 17);
  };
  EXPECT_EQ(said({grammar.path(), "--axiom-size", "4,10,4", "--max-instances", "9"}),
            "1 instance did not fit; --max-instances 10 would have held all\n");
  EXPECT_EQ(said({grammar.path(), "--axiom-size", "4,10,4", "--max-instances", "100", "--output", "vertices"}),
            "144 vertices did not fit; --max-instances 240 would have held all\n");
  EXPECT_EQ(said({deep.path(), "--max-depth", "7"}), "1 shape was not finished; the rules nest in themselves without "
                                                     "end, or too deep for any --max-depth\n");
  const TemporaryFile ends("named_ends.pga", "axiom Box S;\nterminal T (0, 0);\n"
                                             "S = If(ShapePos(X) < 20) { Translate(1,0,0) S | T };\n");
  EXPECT_EQ(said({ends.path(), "--max-depth", "7"}),
            "1 shape was not finished; --max-depth 20 would have been enough\n");
  gpgpJson({"spawn", ends.path(), "--max-depth", "20", "--schedule", "interpreter"});
  const TemporaryFile thin("thin.pga", "axiom Box S;\nterminal T (1, 0);\nS = Repeat(X, 1e-9, ADJUST_TO_FILL) T;\n");
  EXPECT_EQ(said({thin.path()}), "1 shape was dropped, as a Repeat makes at most 1048576 copies of one\n");
  EXPECT_EQ(said({thin.path(), "--axioms", "4", "--slice", "2"}),
            "2 shapes were dropped, as a Repeat makes at most 1048576 copies of one\n");
  const TemporaryFile uncut("uncut.pga", "axiom Prism6 S;\nterminal T (1, 0);\nS = SubDiv(X) { 1: T | -1: T };\n");
  EXPECT_EQ(said({uncut.path()}), "1 shape was dropped, as SubDiv cuts polygons and prisms by constant weights alone, "
                                  "and each part into one piece\n");
  const TemporaryFile both("both.pga", "axiom Prism6 S;\nterminal T (1, 0);\nS = Replicate() { SubDiv(X) { 1: T } |"
                                       " Repeat(X, 1e-9, ADJUST_TO_FILL) T };\n");
  EXPECT_EQ(said({both.path()}), "1 shape was dropped, as a Repeat makes at most 1048576 copies of one\n"
                                 "budget exceeded: 1 shape was dropped, as SubDiv cuts polygons and prisms by constant "
                                 "weights alone, and each part into one piece\n");
}

TEST(CliSpawn, SlicesSumUp) {
  const TemporaryFile grammar("slices.pga", kStreet),
      colliders("slices_colliders.pga", "axiom Box S;\nterminal W (1, 0);\n"
                                        "S = Collider(w) W;\n");
  const std::vector<std::string> common = {"spawn", grammar.path(), "--axioms",    "10",       "--axiom-size",
                                           "9,8,4", "--schedule",   "interpreter", "--repeat", "2"};
  const auto spawn = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    return gpgpJson(more);
  };
  for (const char* output : {"instances", "vertices"}) {
    const json one = spawn({"--output", output}), several = spawn({"--output", output, "--slice", "4"});
    EXPECT_EQ(one["recordings"], 1);
    EXPECT_EQ(several["recordings"], 3);
    for (const char* same :
         {"axioms", "terminals", "instances", "vertices", "triangles", "buckets", "rules", "key_hash", "bytes_written"})
      EXPECT_EQ(one[same], several[same]) << same;
  }
  auto less = common;
  less.insert(less.end(), {"--slice", "4", "--max-instances", "60"}); // of each record
  const json few = gpgpExceeded(less);
  EXPECT_EQ(few["instances"], 3 * 60);
  EXPECT_EQ(few["budget_exceeded"], true);
  expectWrongUsage({{"spawn", colliders.path(), "--axioms", "10", "--slice", "4"}});
}

TEST(CliSpawn, MoreAxiomsThanADeviceBinds) { // software devices bind 128 MiB
  const TemporaryFile grammar("bound.pga", "axiom Box S;\nterminal T (1, 0);\nS = T;\n");
  const json all = gpgpJson({"spawn", grammar.path(), "--axioms", "1500000", "--schedule", "interpreter"});
  EXPECT_EQ(all["terminals"], 1500000);
  EXPECT_EQ(all["budget_exceeded"], false);
}

TEST(CliSpawn, DerivationsWithoutEndAreToldAtOnce) {
  const TemporaryFile out("endless.gpgp"),
      grammar("endless.pga", "axiom Box S;\nterminal T (1, 0);\nS = Replicate() { S | S | S | S };\n");
  for (const auto& command : {std::vector<std::string>{"spawn", grammar.path()},
                              std::vector<std::string>{"tune", grammar.path(), "--axioms", "1", "-o", out.path()}})
    EXPECT_NE(gpgpFailure(command).find("one axiom alone becomes more than 100 million shapes"), std::string::npos);
  EXPECT_EQ(gpgpExceeded({"spawn", grammar.path(), "--schedule", "interpreter", "--max-depth", "5"})["terminals"], 0);
  // Whichever axiom it is.
  const TemporaryFile large("large.pga", "axiom Box S;\nterminal T (1, 0);\n"
                                         "S = Repeat(X, 1, ADJUST_TO_FILL) Repeat(Y, 1, ADJUST_TO_FILL) T;\n"),
      second("second.csv", "x,z,size_x,size_y\n0,0,1,1\n5,0,1000000,1000000\n0,0,1,1\n");
  const auto refused = [&](const std::string& axioms) {
    const std::string error = gpgpFailure({"spawn", large.path(), "--axiom-file", axioms});
    EXPECT_EQ(error, gpgpFailure({"tune", large.path(), "--axiom-file", axioms, "-o", out.path()}));
    return error;
  };
  EXPECT_NE(refused(second.path()).find(": axiom 2 of 3 alone becomes more than 100 million shapes"),
            std::string::npos);
}

TEST(CliSpawn, CollidersThatDoNotFitAreReported) { // by themselves, what differs from the evaluator is no mistake
  const TemporaryFile grammar("colliders.pga",
                              "axiom Box S;\nterminal W F (1, 0);\n"
                              "S = Replicate() { Collider(w) W | Scale(-0.5, -3, -0.5) IfCollides(w) { F | W } };\n");
  const std::vector<std::string> common = {"spawn", grammar.path(), "--schedule", "interpreter", "--axioms",
                                           "9",     "--spacing",    "0.5"};
  EXPECT_EQ(gpgpJson(common)["budget_exceeded"], false);
  auto few = common;
  few.insert(few.end(), {"--max-colliders", "4"});
  const json told = gpgpExceeded(few);
  EXPECT_EQ(told["budget_exceeded"], true);
  EXPECT_EQ(told["colliders"], 9);
  EXPECT_EQ(told["terminals"], 18);
  const ProcessResult text = gpgp(few);
  EXPECT_NE(text.err.find("budget exceeded: 5 colliders did not fit; --max-colliders 9 would have held all"),
            std::string::npos)
      << text.err;
}

TEST(CliSpawn, AxiomFiles) {
  const TemporaryFile grammar("rules.pga", "axiom Box One;\nterminal T (1, 0);\nOne = Replicate() { T | Two };\n"
                                           "Two = Replicate() { T | T };\n");
  const TemporaryFile csv("lots.csv", "# lots\nx, z, rotation, size_x, size_y, size_z, seed, rule\n"
                                      "10, 20, 90, 2, 4, 6, 5, Two\n\n-1, 0.5, 0, 1, 1, 1, 6,\n");
  const TemporaryFile listed("lots.json", "[{\"position\": [10, 0, 20], \"rotation\": 90, \"size\": [2, 4, 6], "
                                          "\"seed\": 5, \"rule\": \"Two\"},\n"
                                          " {\"position\": [-1, 0, 0.5], \"seed\": 6}]");
  const json a = gpgpJson({"spawn", grammar.path(), "--axiom-file", csv.path()});
  const json b = gpgpJson({"spawn", grammar.path(), "--axiom-file", listed.path()});
  EXPECT_EQ(a["axioms"], 2);
  EXPECT_EQ(a["terminals"], 2 + 3);
  EXPECT_EQ(a["key_hash"], b["key_hash"]);
}

TEST(CliSpawn, AxiomFilesChooseShapes) {
  const TemporaryFile grammar("shapes.pga", "axiom Box All;\naxiom Hexagon All;\nterminal Face (1, 0);\n"
                                            "All = CompSplit() Face;\n");
  const TemporaryFile lots("shapes.csv", "x,z,rule,shape\n0,0,All,\n2,0,All,Hexagon\n4,0,All,Box\n6,0,,\n");
  EXPECT_EQ(gpgpJson({"spawn", grammar.path(), "--axiom-file", lots.path()})["terminals"], 6 + 1 + 6 + 6);
}

TEST(CliSpawn, SeveralGrammarsAreLinked) {
  const TemporaryFile house("house.pga", "var n = 2;\naxiom Box House;\nterminal Wall (1, 0);\n"
                                         "House = Repeat(X, n, ADJUST_TO_FILL) Wall;\n"),
      tree("tree.pga", "axiom Box Trunk;\naxiom Quad Leaf;\nterminal Wood (1, 1);\nterminal Green (1, 2);\n"
                       "Trunk = CompSplit() { Leaf | Wood | Leaf };\nLeaf = Green;\n");
  const std::string name = "gpgp_cli_test_"; // of files, and so of grammars
  const TemporaryFile lots("street.csv", "x,z,size_x,rule\n0,0,6," + name + "house\n10,0,1," + name + "tree\n20,0,1," +
                                             name + "tree.Leaf\n30,0,8,\n");
  const std::vector<std::string> both = {house.path(), tree.path()};
  const auto spawn = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"spawn", house.path(), tree.path()});
    return gpgpJson(more);
  };
  for (const char* schedule : {"interpreter", "default", "rw"}) {
    const json all = spawn({"--axiom-file", lots.path(), "--schedule", schedule, "--validate"});
    EXPECT_EQ(all["grammar"], json(both));
    EXPECT_EQ(all["terminals"], 3 + 6 + 1 + 4);
    EXPECT_EQ(all["buckets"][0]["name"], name + "house.Wall");
    EXPECT_EQ(all["buckets"][0]["instances"], 3 + 4);
    EXPECT_EQ(all["buckets"][1]["instances"], 1);
    EXPECT_EQ(all["buckets"][2]["instances"], 5 + 1);
  }
  const json turns = spawn({"--axioms", "5", "--axiom-size", "8,1,1", "--set", name + "house.n=4"});
  EXPECT_EQ(turns["terminals"], 3 * 2 + 2 * 6);                 // a house first
  EXPECT_EQ(spawn({"--schedule", "interpreter"})["axioms"], 2); // one of each
  const TemporaryFile baked("street.gpgp");
  const json bake = gpgpJson({"bake", house.path(), tree.path(), "--link", "-o", baked.path()});
  EXPECT_EQ(bake["baked"][0]["in"], json(both));
  EXPECT_EQ(bake["baked"][0]["bytes"], std::filesystem::file_size(baked.path()));
  EXPECT_EQ(spawn({"--axiom-file", lots.path(), "--schedule", baked.path()})["terminals"], 14);
  const TemporaryFile tuned("tuned_street.gpgp");
  const json tune = gpgpJson({"tune", house.path(), tree.path(), "--axiom-file", lots.path(), "--samples", "5",
                              "--repeat", "3", "--schedules-only", "-o", tuned.path()});
  EXPECT_EQ(tune["axioms"], 4);
  EXPECT_EQ(tune["terminals"], 14);
  EXPECT_EQ(spawn({"--axiom-file", lots.path(), "--schedule", tuned.path()})["terminals"], 14);
  const TemporaryFile wrong("wrong_street.csv", "x,z,rule\n0,0,House\n"),
      broken("broken.pga", "axiom Box A;\nA = B;\n");
  EXPECT_NE(gpgpFailure({"spawn", house.path(), tree.path(), "--axiom-file", wrong.path()})
                .find("csv:2:5: error: the grammar has no rule \"House\"; expected a grammar, or its rule as in " +
                      name + "house.House"),
            std::string::npos);
  EXPECT_NE(gpgpFailure({"spawn", house.path(), broken.path()}).find("broken.pga:2:5: error: there is no rule or term"),
            std::string::npos);
  EXPECT_NE(gpgpFailure({"graph", house.path(), house.path()}).find("is also the name of"), std::string::npos);
  // What is baked can be linked again, or derived alone; a name before a file calls it so.
  const TemporaryFile bakedHouse("house.gpgp"), again("again.gpgp");
  gpgpJson({"bake", house.path(), "-o", bakedHouse.path()});
  gpgpJson({"bake", bakedHouse.path(), tree.path(), "--link", "-o", again.path()});
  EXPECT_EQ(host::readText(again.path()), host::readText(baked.path()));
  EXPECT_EQ(gpgpJson({"spawn", baked.path(), "--axioms", "5", "--axiom-size", "8,1,1"})["terminals"], 3 * 4 + 2 * 6);
  const json twice = gpgpJson({"spawn", house.path(), "other=" + house.path(), "--set", "other.n=1"});
  EXPECT_EQ(twice["buckets"][1]["name"], "other.Wall");
  EXPECT_EQ(twice["axioms"], 2);
  EXPECT_EQ(gpgpJson({"graph", "other=" + house.path()})["nodes"], gpgpJson({"graph", house.path()})["nodes"]);
  EXPECT_NE(gpgpFailure({"graph", bakedHouse.path(), tree.path(), "--set", name + "house.n=4"})
                .find("house.gpgp: error: a baked grammar has no var 'n' that could be set; they were set when it was "
                      "baked (--set " +
                      name + "house.n=4)"),
            std::string::npos);
  expectWrongUsage({{"spawn", house.path(), tree.path(), "--set", "n=4"},
                    {"spawn", house.path(), tree.path(), "--set", "other.n=4"},
                    {"spawn", house.path(), tree.path(), "--set", name + "house.n=nan"},
                    {"bake", house.path(), "-", "--link", "-o", "x.gpgp"},
                    {"bake", "other=" + house.path(), "-o", "x.gpgp"},
                    {"spawn", house.path(), "two words=" + house.path()},
                    {"graph", "7=" + house.path()},
                    {"tune", "other=no_such_file.pga"},
                    {"bake", house.path(), lots.path(), "--link", "-o", "x.gpgp"},
                    {"bake", house.path(), tree.path(), "--link", "-o", testing::TempDir()},
                    {"tune", house.path(), "--axioms", "3", "--axiom-file", lots.path()}});
}

TEST(CliSpawn, TheSampleStreet) {
  const std::string folder = GPGP_SAMPLE_GRAMMARS "/";
  const json street = gpgpJson({"spawn", folder + "simple_house.pga", folder + "suburban_house.pga",
                                folder + "tree_4_3.pga", "--axiom-file", folder + "street.csv"});
  EXPECT_EQ(street["axioms"], 38);
  EXPECT_EQ(street["terminals"], 5 * 361 + 5 * 374 + 28 * 94); // trees have lost a whorl to their thin trunks
}

TEST(CliSpawn, LinesOfGeoJsonBecomeAxiomsAtIntervals) {
  // Each terminal says by its attribute where its axiom is; along the second segment X runs to the north.
  const TemporaryFile grammar("along.pga", "axiom Box One;\nterminal T (1, 0);\nOne = T;\n");
  const TemporaryFile file("streets.geojson", R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"name": "a", "seed": 7},
   "geometry": {"type": "LineString", "coordinates": [[0, 0], [10, 0], [10, 7, 2]]}},
  {"type": "Feature", "properties": {"size": [1, 2, 3]}, "geometry": {"type": "Point", "coordinates": [-5, 20]}},
  {"type": "Feature", "geometry": null}
]})");
  const json result =
      gpgpJson({"spawn", grammar.path(), "--axiom-file", file.path(), "--interval", "4", "--schedule", "interpreter"});
  EXPECT_EQ(result["axioms"], 5); // 17.28 m: four of 4.32 m, and the point
  EXPECT_EQ(result["terminals"], 5);
  const auto error = [&](const std::string& text) {
    const TemporaryFile wrong("wrong.geojson", text);
    const std::string all =
        gpgpFailure({"spawn", grammar.path(), "--axiom-file", wrong.path(), "--schedule", "interpreter"});
    const size_t name = all.find("wrong.geojson:");
    return name == std::string::npos ? all : all.substr(name + 14);
  };
  EXPECT_EQ(error("{\"type\": \"Polygon\"}").find("1:1: error: \"Polygon\" is not a geometry for a"), 0u);
  EXPECT_EQ(error("{\"type\": \"LineString\", \"coordinates\": [[1, 2]]}"),
            "1:1: error: a line needs at least two places");
  EXPECT_EQ(error("{\"type\": \"LineString\", \"coordinates\": [[1, 2], [1, 2]]}"),
            "1:1: error: this line has no length");
  EXPECT_EQ(error("{\"type\": \"FeatureCollection\", \"features\": [\n {\"type\": \"Feature\", \"geometry\": null},\n"
                  "  {\"type\": \"Feature\", \"properties\": {\"rule\": \"Two\"},\n"
                  "   \"geometry\": {\"type\": \"Point\", \"coordinates\": [1, 2]}}]}"),
            "3:3: error: the grammar has no rule \"Two\"");
}

TEST(CliSpawn, ACameraAndAChange) {
  const std::string wood = GPGP_SAMPLE_GRAMMARS "/../world/wood.pga";
  const std::vector<std::string> all{"spawn",  wood,        "--axioms", "64",         "--axiom-size",
                                     "7,10,7", "--spacing", "9",        "--schedule", "interpreter"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), all.begin(), all.end());
    return more;
  };
  const uint64_t finest = gpgpJson(with({}))["terminals"];
  EXPECT_EQ(finest, 64u * 283);
  EXPECT_EQ(gpgpJson(with({"--camera", "0,4,60,0,3,0"}))["terminals"], finest); // all of it is large there
  const uint64_t near = gpgpJson(with({"--camera", "0,4,250,0,3,0"}))["terminals"];
  const uint64_t far = gpgpJson(with({"--camera", "0,4,900,0,3,0"}))["terminals"];
  EXPECT_LT(near, finest);
  EXPECT_LT(far, near);
  EXPECT_EQ(gpgpJson(with({"--camera", "0,4,60,0,3,0", "--set", "pixels=0"}))["terminals"].get<uint64_t>() % 283, 0u);
  const json changed = gpgpJson(with({"--changed", "5"}))["changed"];
  EXPECT_EQ(changed["instances"], 3 * 283);
  EXPECT_EQ(changed["of"], finest);
  const auto wrong = [&](const std::vector<std::string>& more, const char* option) {
    const ProcessResult result = gpgp(with(more));
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.err.find(option), std::string::npos) << result.err;
  };
  wrong({"--camera", "1,2,3,1,2,3"}, "--camera");
  wrong({"--changed", "5", "--sorted"}, "--changed");
  wrong({"--image-size", "64x64"}, "--image-size requires --image or --camera");
}

TEST(CliSpawn, AxiomFilesSayWhatIsWrongAndWhere) {
  const TemporaryFile grammar("rules2.pga", "axiom Box One;\nterminal T (1, 0);\nOne = T;\n");
  const auto error = [&](const std::string& text) {
    const TemporaryFile file("wrong_axioms", text);
    const std::string all =
        gpgpFailure({"spawn", grammar.path(), "--axiom-file", file.path(), "--schedule", "interpreter"});
    const size_t name = all.find("wrong_axioms:");
    return name == std::string::npos ? all : all.substr(name + 13);
  };
  EXPECT_EQ(error("x,z\n1,2\n\n3,  four\n"), "4:5: error: z takes a number; \"four\" is none");
  EXPECT_EQ(error("x,z\n1\n"), "2:1: error: 1 values for 2 columns");
  EXPECT_EQ(error("x,z,seed\n1,2,-1\n"), "2:5: error: seed takes a whole number from 0 to 4294967295; \"-1\" is none");
  EXPECT_EQ(error("x,y\n1,2\n"), "2:1: error: an axiom needs a value for z");
  EXPECT_EQ(error("x,z,size_y\n1,2,0\n"), "2:5: error: sizes are above 0");
  EXPECT_EQ(error("x,z,rule\n1,2,Other\n"), "2:5: error: the grammar has no rule \"Other\"");
  EXPECT_EQ(error("x,z,rule,shape\n1,2,One,Quad\n"),
            "2:9: error: the grammar does not start \"One\" with shape \"Quad\", only with: Box");
  EXPECT_EQ(error("x,z,shape\n1,2,Box\n"), "2:5: error: a shape needs the rule that starts with it");
  EXPECT_EQ(error("x,x\n"), "1:3: error: two columns are named \"x\"");
  EXPECT_EQ(error("x,w\n").substr(0, 32), "1:3: error: \"w\" is not a column;");
  EXPECT_EQ(error("[{\"position\": [1, 2, 3]},\n\n {\"rotation\": 3}]").substr(0, 36),
            "3:2: error: an axiom needs a value f");
  EXPECT_EQ(error("[\n{\"position\": [1, 2]}]"), "2:1: error: position takes three numbers, [x, y, z]");
  EXPECT_EQ(error("[{\"position\": [1, 2, 3]},\n5]"),
            "2:1: error: expected an object with position, rotation, size, seed, rule");
  EXPECT_EQ(error("[\n{]").substr(0, 11), "2:2: error:");
  EXPECT_NE(error("x,z\n").find("no axioms"), std::string::npos);
  EXPECT_EQ(error("{\"position\": [1, 2, 3]}"), "1:1: error: expected an array of axioms, [{...}, {...}], or GeoJSON");
  EXPECT_NE(error("[{\"position\": [1, 2, 1e999]}]").find(" error: "), std::string::npos);
  EXPECT_EQ(error("\xef\xbb\xbfx,z\n1,two\n"), "2:3: error: z takes a number; \"two\" is none");
  EXPECT_EQ(error("x,qx,z\n1,0,1\n"), "2:1: error: an axiom with some of qx to qw needs all 4");
  EXPECT_EQ(error("x,z,qx,qy,qz,qw\n1,0,0,0,0,0\n"), "2:5: error: a quaternion of length 0 turns nowhere");
  EXPECT_EQ(error("x,z,rotation,qx,qy,qz,qw\n1,0,5,0,0,0,1\n"), "2:5: error: rotation or a quaternion, not both");
  EXPECT_EQ(error("[{\"transform\": [1]}]"), "1:2: error: transform takes twelve numbers, the rows of a 3x4 matrix");
  EXPECT_EQ(error("[{\"rotation\": 3, \"transform\": [1,0,0,0, 0,1,0,0, 0,0,1,0]}]"),
            "1:2: error: rotation stands beside a whole transform");
  EXPECT_EQ(error("x,z\n1,\x01\xff\n"), "2:3: error: z takes a number; \"\\x01\\xff\" is none");
}

TEST(CliSpawn, AxiomFilesSayAllThatIsWrong) {
  const TemporaryFile grammar("rules3.pga", "axiom Box One;\nterminal T (1, 0);\nOne = T;\n"),
      lots("all_wrong.csv", "x,z,rotation,seed\n1,2,bad,5\n3,4,0,-7\nfoo,1,2,3\n1,2\n");
  const ProcessResult result = gpgp({"spawn", grammar.path(), "--axiom-file", lots.path()});
  EXPECT_EQ(result.exitCode, 1);
  for (const char* wrong : {"csv:2:5: error: ", "csv:3:7: error: ", "csv:4:1: error: ", "csv:5:1: error: "})
    EXPECT_NE(result.err.find(wrong), std::string::npos) << wrong << result.err;
  EXPECT_NE(result.err.find("\"bad\" is none\n"), std::string::npos) << result.err;
  EXPECT_TRUE(result.err.ends_with("gpgp spawn: 4 errors\n")) << result.err;
  std::istringstream lines(result.err);
  std::set<std::string> said;
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(said.insert(line).second) << "twice: " << line;
  EXPECT_EQ(said.size(), 5u) << result.err;
  const TemporaryFile members("all_wrong.json",
                              "[{\"position\": [1, 2], \"quaternion\": [0, 0, 0, \"w\"], \"seed\": 1.5,"
                              "\"rule\": \"Other\"},\n {\"position\": 5, \"rule\": 5, \"shape\": 5},\n5]");
  const std::string errors = gpgp({"spawn", grammar.path(), "--axiom-file", members.path()}).err;
  for (const char* wrong : {":1:2: error: position takes three numbers", ":1:2: error: quaternion takes numbers",
                            ":1:2: error: seed takes a whole number", ":1:2: error: the grammar has no rule \"Other\"",
                            ":2:2: error: position takes", ":2:2: error: rule takes", ":2:2: error: shape takes",
                            ":3:1: error: expected an object", "gpgp spawn: 8 errors\n"})
    EXPECT_NE(errors.find(wrong), std::string::npos) << wrong << '\n' << errors;
}

/// The same places by angle, by quaternion and by matrix.
TEST(CliSpawn, AxiomFilesHoldTransforms) {
  const TemporaryFile grammar("placed.pga", "axiom Box One;\nterminal T (1, 0);\nOne = T;\n");
  const auto bounds = [&](const std::string& file, const std::string& text) {
    const TemporaryFile axioms(file, text), out("placed.glb");
    gpgpJson({"spawn", grammar.path(), "--schedule", "interpreter", "--axiom-size", "2,4,6", "--axiom-file",
              axioms.path(), "--out", out.path()});
    const json accessor = readGlb(out.path()).model["accessors"][0];
    std::vector<double> all = accessor["min"];
    for (const double high : accessor["max"]) all.push_back(high);
    return all;
  };
  const auto expectNear = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5) << i;
  };
  const std::vector<double> turned = {7, 1, 19, 13, 5, 21}; // 2 x 4 x 6 by 90 degrees about Y at 10, 1, 20
  expectNear(bounds("angle.csv", "x,y,z,rotation\n10,1,20,90\n"), turned);
  expectNear(bounds("quaternion.csv", "x,y,z,qx,qy,qz,qw\n10,1,20,0,3,0,3\n"), turned);
  expectNear(bounds("matrix.csv", "m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n0,0,1,10,0,1,0,3,-1,0,0,20\n"),
             turned);
  expectNear(bounds("quaternion.json", "[{\"position\": [10, 1, 20], \"quaternion\": [0, 1, 0, 1]}]"), turned);
  expectNear(bounds("matrix.json", "[{\"transform\": [0,0,1,10, 0,1,0,3, -1,0,0,20]}]"), turned);
  // About Z it lies on its side: its own Y points to -X, and it stands along that.
  expectNear(bounds("lying.json", "[{\"position\": [0, 0, 0], \"quaternion\": [0, 0, 1, 1]}]"), {-4, -1, -3, 0, 1, 3});
}

TEST(CliSpawn, WritesTriangles) {
  const TemporaryFile grammar("glb.pga", kTower), out("tower.glb");
  gpgpJson({"spawn", grammar.path(), "--axiom-size", "4,10,4", "--out", out.path()});
  const json model = readGlb(out.path()).model;
  ASSERT_EQ(model["meshes"].size(), 1u);
  EXPECT_EQ(model["accessors"][0]["count"], 10 * 24);
  EXPECT_EQ(model["accessors"][3]["count"], 10 * 12 * 3);
  EXPECT_EQ(model["accessors"][0]["min"], (json{-2.0, 0.0, -2.0}));
  EXPECT_EQ(model["accessors"][0]["max"], (json{2.0, 10.0, 2.0}));
  EXPECT_EQ(model["materials"][0]["name"], "Floor");
  EXPECT_EQ(model["nodes"][0]["name"], "Floor");
}

TEST(CliSpawn, TrianglesThatCannotBeWrittenAreAFailure) {
  const TemporaryFile grammar("glb.pga", kTower), folder("folder.glb"), under("under");
  std::filesystem::create_directory(folder.path());
  const auto spawn = [&](const std::string& out) {
    return std::vector<std::string>{"spawn", grammar.path(), "--schedule", "interpreter", "--out", out};
  };
  const std::vector<std::string> wrong = {folder.path(), grammar.path() + "/x.glb", "/proc/x.glb"};
  for (const std::string& out : wrong) EXPECT_EQ(gpgpFailure(spawn(out)).substr(0, out.size() + 2), out + ": ");
  std::filesystem::create_symlink("/dev/full", under.path() + ".glb");
  EXPECT_NE(gpgpFailure(spawn(under.path() + ".glb")).find("No space left"), std::string::npos);
  std::filesystem::remove(under.path() + ".glb");
  expectWrongUsage({spawn("x.obj"), spawn(".glb"), spawn("/dev/full")});
}

/// The service's own shapes: prisms stand along Y, triangles without area are left out.
TEST(CliSpawn, ShapesAreThoseOfTheService) {
  const auto triangles = [](const char* shape, const char* size) {
    const TemporaryFile grammar("shape.pga", std::string("axiom ") + shape + " T;\nterminal T (1, 0);\n"),
        out("shape.glb");
    gpgpJson({"spawn", grammar.path(), "--schedule", "interpreter", "--axiom-size", size, "--out", out.path()});
    return readGlb(out.path()).triangles;
  };
  const auto prism = triangles("Prism6", "2,6,3");
  EXPECT_EQ(prism.size(), 20u); // two hexagons of four triangles, six sides of two
  // A hexagon covers three quarters of its box; outwards is positive.
  EXPECT_NEAR(volumeOf(prism), 0.75 * 2 * 6 * 3, 1e-3);
  double low = 1e9, high = -1e9;
  for (const GlbTriangle& t : prism)
    for (const Vector& p : t.corners) low = std::min(low, p[1]), high = std::max(high, p[1]);
  EXPECT_DOUBLE_EQ(high - low, 6);
  for (const GlbTriangle& t : prism) // no corner between the ends
    for (const Vector& p : t.corners) EXPECT_TRUE(p[1] == low || p[1] == high);
  EXPECT_EQ(triangles("Box", "1,1,1").size(), 12u);
  EXPECT_EQ(triangles("Triangle", "1,1,1").size(), 1u);
  EXPECT_EQ(triangles("Pentagon", "1,1,1").size(), 3u);
  EXPECT_EQ(triangles("Sphere", "1,1,1").size(), 96u * 2u - 24u);
}

TEST(CliSpawn, ErrorsHaveAPlace) {
  const TemporaryFile grammar("wrong.pga", "axiom Box A;\nterminal T (1, 0);\nA = Nonsense(X) T;\n");
  EXPECT_NE(gpgpFailure({"spawn", grammar.path()}).find("wrong.pga:3:"), std::string::npos);
  // but not those that are not in the text
  const TemporaryFile tower("placeless.pga", kTower), without("without.pga", "terminal T (1, 0);\n");
  EXPECT_EQ(gpgpFailure({"spawn", tower.path(), "--set", "zz=1"}),
            tower.path() + ": error: there is no var 'zz' that could be set (--set zz=1)");
  EXPECT_EQ(gpgpFailure({"spawn", without.path()}),
            without.path() + ":1:1: error: there is no axiom; expected a line as: axiom Box Start;");
}

TEST(CliSpawn, WrongUsage) {
  const TemporaryFile grammar("usage.pga", kTower);
  expectWrongUsage({{"spawn"},
                    {"spawn", "no_such_file.pga"},
                    {"spawn", grammar.path(), "--axioms", "0"},
                    {"spawn", grammar.path(), "--axiom-size", "1,2"},
                    {"spawn", grammar.path(), "--axiom-size", "1,2,-3"},
                    {"spawn", grammar.path(), "--spacing", "nan"},
                    {"spawn", grammar.path(), "--spacing", "-1"},
                    {"spawn", grammar.path(), "--spacing", "inf"},
                    {"spawn", grammar.path(), "--axiom-file", "no_such_file.csv"},
                    {"spawn", grammar.path(), "--axioms", "3", "--axiom-file", grammar.path()},
                    {"spawn", grammar.path(), "--set", "floors"},
                    {"spawn", grammar.path(), "--set", "=3"},
                    {"spawn", grammar.path(), "--set", "floors=many"}});
  EXPECT_NE(gpgp({"spawn", grammar.path(), "--spacing", "0"}).err.find("0 is not within 1e-06 to 1e+09"),
            std::string::npos);
}

TEST(CliSpawn, DumpsWhatAPassHasLeftInScratch) {
  const TemporaryFile grammar("dump.pga", "axiom Box S;\nterminal A (1, 0);\nS = SubDiv(X) { -1: A | -1: A };\n");
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "gpgp_cli_dump";
  std::filesystem::remove_all(folder);
  const json spawned = gpgpJson({"spawn", grammar.path(), "--axioms", "10", "--schedule", "interpreter", "--dump-pass",
                                 "derive", "--dump-folder", folder.string(), "--validate"});
  const std::vector<uint8_t> counters = host::readFile(folder / "derive.counters.bin");
  shader::SpawnState state{};
  ASSERT_GE(counters.size(), sizeof state);
  std::memcpy(&state, counters.data(), sizeof state);
  EXPECT_EQ(state.terminals, 20u);
  EXPECT_EQ(spawned["terminals"], 20);
  std::filesystem::remove_all(folder);
  const ProcessResult none = gpgp({"spawn", grammar.path(), "--dump-pass", "raster"});
  EXPECT_EQ(none.exitCode, 1);
  EXPECT_NE(none.err.find("there is no pass \"raster\"; there are clear counters; "), std::string::npos) << none.err;
  const ProcessResult idle = gpgp({"spawn", grammar.path(), "--dump-pass", "emit"});
  EXPECT_NE(idle.err.find("does not run the pass \"emit\""), std::string::npos) << idle.err;
}

} // namespace
} // namespace gpgp::test
