// `gpgp spawn` on .cga files: budgets, and what GeoJSON says of plots.
#include "files.h"
#include "run.h"

namespace gpgp::test {
namespace {

TEST(CliCga, BudgetsNameTheRuleTheOperationAndThePlace) {
  const TemporaryFile file("grow.cga", "Lot --> extrude(2) A\nA -->\n  extrude(0.5) A\n");
  const std::string faces = gpgpFailure({"spawn", file.path(), "--max-faces", "100"});
  EXPECT_NE(
      faces.find(":3:3: error: rule 'A', 'extrude': a shape has 216 faces, more than 100; maxFaces (--max-faces)"),
      std::string::npos)
      << faces;
  const std::string vertices = gpgpFailure({"spawn", file.path(), "--max-vertices", "100"});
  EXPECT_NE(vertices.find("vertices, more than 100; maxVertices (--max-vertices) allows more"), std::string::npos)
      << vertices;
  const std::string work = gpgpFailure({"spawn", file.path(), "--max-work", "1"});
  EXPECT_NE(work.find("takes more than 1 million steps; maxWork (--max-work) allows more"), std::string::npos) << work;
  const std::string meshes = gpgpFailure({"spawn", file.path(), "--max-geometry", "2"});
  EXPECT_NE(meshes.find("need more than 2 MiB; maxGeometryMiB (--max-geometry) allows more"), std::string::npos)
      << meshes;
  const TemporaryFile other("box.pga", "axiom Box A;\nterminal B;\nA --> B;\n");
  EXPECT_EQ(gpgp({"spawn", other.path(), "--max-work", "3"}).exitCode, 2);
}

TEST(CliCga, StreetsComeFromGeoJson) {
  const TemporaryFile file("plot.cga", "Lot --> comp(fe) { street.front: report(\"front\", scope.sx) A. | "
                                       "street.back: report(\"back\", scope.sx) B. | street.side: C. }\n");
  const auto plot = [](const std::string& ring, const std::string& widths) {
    return "{\"type\": \"Feature\", \"properties\": {\"streetWidth\": " + widths +
           "}, \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [" + ring + "]}}";
  };
  // Both ways round: the edge from (0, 0) to (10, 0) is at the street.
  const TemporaryFile left("left.json", plot("[[0,0],[10,0],[8,20],[0,20],[0,0]]", "[6, 0, 0, 0]"));
  const TemporaryFile right("right.json", plot("[[10,0],[0,0],[0,20],[8,20],[10,0]]", "[6, 0, 0, 0]"));
  for (const TemporaryFile* lots : {&left, &right}) {
    const json result = gpgpJson({"spawn", file.path(), "--axiom-file", lots->path()});
    EXPECT_EQ(result["terminals"], 4);
    EXPECT_NEAR(result["reports"]["front"].get<double>(), 10, 1e-4);
    EXPECT_NEAR(result["reports"]["back"].get<double>(), 8, 1e-4);
  }
  const TemporaryFile wrong("wrong.json", plot("[[0,0],[10,0],[8,20],[0,20],[0,0]]", "[6, 0]"));
  const std::string error = gpgpFailure({"spawn", file.path(), "--axiom-file", wrong.path()});
  EXPECT_NE(error.find("\"streetWidth\" has 2 numbers; the outline has 4 edges"), std::string::npos) << error;
}

TEST(CliCga, DerivesOnTheGpuOrSaysWhatKeepsItOnTheCpu) {
  const TemporaryFile box("box.cga",
                          "attr h = rand(3, 9)\nLot --> report(\"h\", h) extrude(h) comp(f) { side: Wall. | top: "
                          "30%: color(\"#ff0000\") A. else: split(x) { ~2: B. }* }\n");
  const json gpu = gpgpJson({"spawn", box.path(), "--axioms", "20"});
  const json cpu = gpgpJson({"spawn", box.path(), "--axioms", "20", "--device", "cpu"});
  EXPECT_TRUE(gpu["device"].is_string()) << gpu;
  EXPECT_TRUE(gpu["on_cpu_because"].is_null());
  EXPECT_TRUE(cpu["device"].is_null());
  EXPECT_EQ(cpu["on_cpu_because"], "--device cpu");
  for (const char* same : {"terminals", "rules", "triangles", "start", "axioms"})
    EXPECT_EQ(gpu[same], cpu[same]) << same;
  EXPECT_NEAR(gpu["reports"]["h"].get<double>(), cpu["reports"]["h"].get<double>(), 1e-4);
  EXPECT_EQ(gpgpJson({"spawn", box.path(), "--axioms", "20", "--device", "gpu"})["terminals"], cpu["terminals"]);

  const TemporaryFile roof("roof.cga", "Lot --> extrude(3)\n  roofHip(30)\n");
  const json other = gpgpJson({"spawn", roof.path()});
  EXPECT_TRUE(other["device"].is_null());
  const std::string because = ":2:3: 'roofHip' of anything but a rectangle has no operator on the GPU";
  EXPECT_EQ(other["on_cpu_because"], roof.path() + because);
  const std::string error = gpgpFailure({"spawn", roof.path(), "--device", "gpu"});
  EXPECT_NE(error.find(because), std::string::npos) << error;

  // Rectangles of GeoJSON, but not other polygons.
  const auto lots = [](const std::string& ring) {
    return "{\"type\": \"Polygon\", \"coordinates\": [[" + ring + "]]}";
  };
  const TemporaryFile rectangle("r.json", lots("[3,0],[13,5],[8,15],[-2,10],[3,0]"));
  const TemporaryFile triangle("t.json", lots("[0,0],[10,0],[8,20],[0,0]"));
  EXPECT_TRUE(gpgpJson({"spawn", box.path(), "--axiom-file", rectangle.path()})["device"].is_string());
  EXPECT_TRUE(gpgpJson({"spawn", box.path(), "--axiom-file", triangle.path()})["device"].is_null());
}

TEST(CliCga, FieldsAreReadOnBothSidesAndGiveAttributes) {
  // 8-bit greys over 3 by 3 metres are too few; the sample's hills do.
  const std::string hills = std::string("ground=") + GPGP_SAMPLE_GRAMMARS + "/../world/hills.png,-160,-160,160,160,60";
  const TemporaryFile file("field.cga", "attr least = 20\nLot --> case Field(\"ground\") > least: extrude(max(1, "
                                        "Field(\"ground\") / 10)) High. else: Low.\n");
  const std::vector<std::string> spawn{"spawn",   file.path(), "--axioms", "60",      "--axiom-size",
                                       "10,1,10", "--spacing", "30",       "--field", hills};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = spawn;
    all.insert(all.end(), more.begin(), more.end());
    return gpgpJson(all);
  };
  const json gpu = with({}), cpu = with({"--device", "cpu"});
  EXPECT_TRUE(gpu["device"].is_string()) << gpu;
  for (const char* same : {"terminals", "rules", "triangles"}) EXPECT_EQ(gpu[same], cpu[same]) << same;
  EXPECT_EQ(gpu["rules"].size(), 2u);
  // The same field as the value of an attr: nothing is higher than the field itself.
  std::string other = hills;
  const json own = with({"--field", other.replace(0, 6, "least")});
  EXPECT_TRUE(own["device"].is_null());
  EXPECT_EQ(own["on_cpu_because"], "'least', an attr that has its value from a field, derives on the CPU");
  ASSERT_EQ(own["rules"].size(), 1u);
  EXPECT_EQ(own["rules"][0]["rule"], "Low");
  EXPECT_EQ(with({"--field", other, "--attr", "least=-1"})["rules"][0]["rule"], "High");

  const ProcessResult missing = gpgp({"spawn", file.path()});
  EXPECT_EQ(missing.exitCode, 2);
  EXPECT_NE(missing.err.find(":2:14: field \"ground\" is read, and is not among the fields"), std::string::npos)
      << missing.err;
  EXPECT_NE(gpgp({"spawn", file.path(), "--field", hills, "--field", "x" + hills}).err.find("nothing reads this field"),
            std::string::npos);
  const TemporaryFile lsystem("f.lsys", "axiom: F\n");
  EXPECT_EQ(gpgp({"spawn", lsystem.path(), "--field", hills}).exitCode, 2);
}

TEST(CliCga, EdgeAttributesAndPlacesComeFromGeoJson) {
  const TemporaryFile file("edges.cga", "Lot --> comp(fe) { all: report(edgeAttr.getString(\"use\"), scope.sx) "
                                        "report(\"w\", edgeAttr.getFloat(\"w\") * scope.sx) NIL }\n");
  const auto plot = [](const std::string& ring, const std::string& uses) {
    return "{\"type\": \"Feature\", \"properties\": {\"/edgeattr/use\": " + uses +
           ", \"/edgeattr/w\": [1, 2, 3, 4]}, \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [" + ring + "]}}";
  };
  const std::string uses = "[\"road\", \"wall\", \"park\", \"wall\"]";
  // Both ways round: the edge from (0, 0) to (10, 0) is the road's.
  const TemporaryFile left("left.json", plot("[[0,0],[10,0],[10,20],[0,20],[0,0]]", uses));
  const TemporaryFile right("right.json", plot("[[10,0],[0,0],[0,20],[10,20],[10,0]]", uses));
  for (const TemporaryFile* lots : {&left, &right}) {
    const json result = gpgpJson({"spawn", file.path(), "--axiom-file", lots->path()});
    EXPECT_NEAR(result["reports"]["road"].get<double>(), 10, 1e-4);
    EXPECT_NEAR(result["reports"]["park"].get<double>(), 10, 1e-4);
    EXPECT_NEAR(result["reports"]["wall"].get<double>(), 40, 1e-4);
    EXPECT_NEAR(result["reports"]["w"].get<double>(), 10 * (1 + 3) + 20 * (2 + 4), 1e-3);
  }
  const TemporaryFile few("few.json", plot("[[0,0],[10,0],[10,20],[0,20],[0,0]]", "[\"road\"]"));
  const std::string error = gpgpFailure({"spawn", file.path(), "--axiom-file", few.path()});
  EXPECT_NE(error.find("\"/edgeattr/use\" is an array of a value for each of the 4 edges"), std::string::npos) << error;

  const TemporaryFile where("where.cga",
                            "Lot --> report(\"lon\", getGeoCoord(lon)) report(\"lat\", getGeoCoord(lat)) A.\n");
  const TemporaryFile town("town.json", "{\"type\": \"Polygon\", \"coordinates\": "
                                        "[[[8.5,47.25],[8.501,47.25],[8.501,47.251],[8.5,47.251],[8.5,47.25]]]}");
  const json place = gpgpJson({"spawn", where.path(), "--axiom-file", town.path(), "--geographic"});
  EXPECT_NEAR(place["reports"]["lon"].get<double>(), 8.5, 2e-6);
  EXPECT_NEAR(place["reports"]["lat"].get<double>(), 47.25, 0.00101); // a corner of it
}

TEST(CliCga, AttributesAreListedWithRangesAndGroups) {
  const TemporaryFile file("list.cga", "@Group(\"Building\", 1) @Range(min=3, max=60, stepsize=0.5) @Order(2)\n"
                                       "@Description(\"Of the walls\") @Distance attr height = 9\n"
                                       "@Enum(valuesAttr=kinds) attr roof = \"gable\"\n"
                                       "@Hidden attr kinds = [\"gable\", \"hip\"]\n"
                                       "@Group @Color attr wall = \"#ff8000\"\nLot --> extrude(height) A.\n");
  const json all = gpgpJson({"spawn", file.path(), "--attributes"});
  ASSERT_EQ(all["attributes"].size(), 4u);
  const json& height = all["attributes"][0];
  EXPECT_EQ(height["name"], "height");
  EXPECT_EQ(height["type"], "number");
  EXPECT_EQ(height["value"], 9);
  EXPECT_EQ(height["min"], 3);
  EXPECT_EQ(height["max"], 60);
  EXPECT_EQ(height["step"], 0.5);
  EXPECT_EQ(height["restricted"], true);
  EXPECT_EQ(height["groups"], json({"Building"}));
  EXPECT_EQ(height["group_order"], 1);
  EXPECT_EQ(height["order"], 2);
  EXPECT_EQ(height["kind"], "distance");
  EXPECT_EQ(height["description"], "Of the walls");
  EXPECT_EQ(all["attributes"][1]["choices"], json({"gable", "hip"}));
  EXPECT_EQ(all["attributes"][1]["groups"], json({"Building"}));
  EXPECT_TRUE(all["attributes"][2]["hidden"].get<bool>());
  EXPECT_TRUE(all["attributes"][3]["groups"].empty());
  EXPECT_TRUE(all["attributes"][3]["min"].is_null());
  EXPECT_EQ(all["attributes"], gpgpJson({"spawn", file.path(), "--device", "cpu"})["attributes"]);
  EXPECT_EQ(gpgp({"spawn", file.path(), "--attributes"}).out,
            "Building\n  height = 9  [3 .. 60 by 0.5]  distance  Of the walls\n"
            "  roof = \"gable\"  {gable, hip}\nwithout a group\n  wall = \"#ff8000\"  color\n");
  const TemporaryFile box("box.pga", "axiom Box A;\nterminal B;\nA --> B;\n");
  EXPECT_EQ(gpgp({"spawn", box.path(), "--attributes"}).exitCode, 2);
}

TEST(CliCga, AssetsHaveTheNamesOfTheirFiles) {
  const TemporaryFile tree("tree.obj",
                           "o Crown\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl leaf\nf 1 2 3\ng Trunk\nusemtl bark\nf 1 3 2\n");
  const std::string name = tree.path().substr(tree.path().rfind('/') + 1);
  const TemporaryFile file("names.cga", "Lot --> print(assetNamingInfo(\"" + name + "\", g)) print(assetNamingInfo(\"" +
                                            name + "\", m)) NIL\n");
  EXPECT_EQ(gpgpJson({"spawn", file.path()})["prints"], json({"Crown;Trunk;", "leaf;bark;"}));
}

TEST(CliCga, WhatNeedsAGraphSaysWhoHasNone) {
  const TemporaryFile cga("a.cga", "attr h = 2\nattr s = \"x\"\nLot --> extrude(h)\n"), lsystem("a.lsys", "axiom: F\n"),
      out("a.bin");
  const TemporaryFile roof("hip.cga", "Lot --> extrude(2) roofHip(30)\n");
  const TemporaryFile stack("a.gml", "[ /A /B ] 0 0 terminal\n/Box axiom\nX [ 0.5 { A } -1 { B } ] subdiv\n");
  for (const char* command : {"graph", "tune", "bake"})
    for (const TemporaryFile* file : {&roof, &lsystem}) {
      std::vector<std::string> arguments{command, file->path()};
      if (std::string(command) == "bake") arguments.insert(arguments.end(), {"--out", out.path()});
      const ProcessResult result = gpgp(arguments);
      EXPECT_EQ(result.exitCode, file == &roof ? 1 : 2) << result.err;
      EXPECT_NE(result.err.find("has no operator graph"), std::string::npos) << result.err;
    }
  for (const char* wrong : {"h=abc", "h=1e39", "h=nan", "h="}) {
    const ProcessResult result = gpgp({"spawn", cga.path(), "--attr", wrong});
    EXPECT_EQ(result.exitCode, 2) << wrong;
    EXPECT_NE(result.err.find("--attr h: it is a number in the file"), std::string::npos) << result.err;
  }
  EXPECT_EQ(gpgp({"spawn", cga.path(), "--attr", "s=7", "--attr", "h=3", "--device", "cpu"}).exitCode, 0);
  EXPECT_EQ(gpgp({"graph", stack.path()}).exitCode, 0);
  EXPECT_NE(gpgp({"graph", cga.path(), "--set", "h=7.5"}).out.find("GrowAlong(Y,7.5)"), std::string::npos);
  EXPECT_EQ(gpgp({"bake", cga.path(), "--no-kernel", "--out", out.path()}).exitCode, 0);
  const json baked = gpgpJson({"spawn", out.path(), "--axiom-size", "4,1,5"});
  EXPECT_EQ(baked["terminals"], 1);
  EXPECT_EQ(gpgp({"bake", stack.path(), "--no-kernel", "--out", out.path()}).exitCode, 0);
}

} // namespace
} // namespace gpgp::test
