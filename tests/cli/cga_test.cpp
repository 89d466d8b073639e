// `gpgp spawn` on .cga files: budgets, and what GeoJSON says of plots.
#include "files.h"
#include "run.h"

namespace gpgp::test {
namespace {

TEST(CliCga, BudgetsNameTheRuleTheOperationAndThePlace) {
  const TemporaryFile file("grow.cga", "Lot --> extrude(2) A\nA -->\n  extrude(0.5) A\n");
  const std::string faces = gpgpFailure({"spawn", file.path(), "--max-faces", "100"});
  EXPECT_NE(faces.find(":3:3: error: rule 'A', 'extrude': a shape has 216 faces, more than 100; --max-faces"),
            std::string::npos)
      << faces;
  const std::string vertices = gpgpFailure({"spawn", file.path(), "--max-vertices", "100"});
  EXPECT_NE(vertices.find("vertices, more than 100; --max-vertices allows more"), std::string::npos) << vertices;
  const std::string work = gpgpFailure({"spawn", file.path(), "--max-work", "1"});
  EXPECT_NE(work.find("takes more than 1 million steps; --max-work allows more"), std::string::npos) << work;
  const std::string meshes = gpgpFailure({"spawn", file.path(), "--max-geometry", "2"});
  EXPECT_NE(meshes.find("need more than 2 MiB; --max-geometry allows more"), std::string::npos) << meshes;
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
