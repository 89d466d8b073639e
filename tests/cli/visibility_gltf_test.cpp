// glTF files that gpgp showed wrongly, or in silence, in `gpgp visibility`; and of each the whole kind.
#include "files.h"
#include "run.h"

#include <cstring>

namespace gpgp::test {
namespace {

using Args = std::vector<std::string>;

constexpr const char* kCases = GPGP_TEST_DATA "/cases/visibility/";
// Looks along -z at -1 to 1, in 64 x 64 pixels, with depths for z of -5 to 5: a square of side 1 has 1024.
constexpr const char* kCamera = "1 0 0 0  0 -1 0 0  0 0 -0.1 0  0 0 0.5 1";
constexpr double kEdge = 70; // pixels whose centres lie on the outline of a square of side 1, or a little more

json seen(const std::string& file, const Args& more = {}) {
  const TemporaryFile camera("gltf_case.txt", kCamera);
  Args args{"visibility", file, "--size", "64x64", "--camera", camera.path()};
  args.insert(args.end(), more.begin(), more.end());
  return gpgpJson(args);
}

bool notes(const json& object, const std::string& part) {
  for (const json& note : object["notes"])
    if (note.get<std::string>().find(part) != std::string::npos) return true;
  return false;
}

/// A glTF that is made up of accessors, each with bytes of its own.
struct Maker {
  json gltf = json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"byteLength": 0}],
    "accessors": [], "bufferViews": []})");
  std::string bytes;

  /// A square of side 1 round the origin, in the plane z = 0.
  Maker() {
    add<float>("VEC3", 5126, {-.5f, -.5f, 0, .5f, -.5f, 0, .5f, .5f, 0, -.5f, -.5f, 0, .5f, .5f, 0, -.5f, .5f, 0});
  }
  template <class Number> void add(const char* type, int component, const std::vector<Number>& numbers) {
    const size_t size = numbers.size() * sizeof(Number);
    const size_t each = std::strcmp(type, "VEC4") == 0   ? 4
                        : std::strcmp(type, "MAT4") == 0 ? 16
                        : std::strcmp(type, "VEC2") == 0 ? 2
                                                         : 3;
    gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", numbers.size() / each},
                                 {"type", type}});
    bytes.append(reinterpret_cast<const char*>(numbers.data()), size);
    bytes.resize((bytes.size() + 3) / 4 * 4);
    gltf["buffers"][0]["byteLength"] = bytes.size();
  }
  json& node() { return gltf["nodes"][0]; }
  json& primitive() { return gltf["meshes"][0]["primitives"][0]; }
  std::string text() const {
    json whole = gltf;
    if (!whole["buffers"][0].contains("uri"))
      whole["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
    return whole.dump();
  }
  json seen(const Args& more = {}) const {
    const TemporaryFile file("made.gltf", text());
    return test::seen(file.path(), more);
  }
  std::string failure() const {
    const TemporaryFile file("made.gltf", text());
    return gpgpFailure({"visibility", file.path()});
  }
};

/// A little-endian word.
std::string word(uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i));
  return bytes;
}

TEST(CliVisibilityGltf, FarFromTheOriginNodesKeepTheirForm) {
  // A square of 2 cm, where floats are 8 mm apart: placed by its node, by an instance, and by the joint of a skin.
  Maker made;
  made.node()["scale"] = {0.02, 0.02, 0.02};
  const auto look = [](const Maker& model) {
    const TemporaryFile file("far.gltf", model.text());
    return gpgpJson({"visibility", file.path(), "--method", "exact", "--size", "64x48"});
  };
  const json near = look(made);
  EXPECT_EQ(near["visible"], 2);
  const auto expectTheSame = [&](const Maker& far) {
    const json found = look(far);
    EXPECT_EQ(found["visible"], near["visible"]) << far.gltf;
    EXPECT_EQ(found["coveredPixels"], near["coveredPixels"]) << far.gltf;
  };
  Maker placed = made;
  placed.node()["translation"] = {1e5 + 0.003, 0.7e5, -1.3e5};
  expectTheSame(placed);
  Maker instanced = placed;
  instanced.node()["scale"] = {1, 1, 1};
  instanced.add<float>("VEC3", 5126, {0, 0, 0});
  instanced.add<float>("VEC3", 5126, {0.02f, 0.02f, 0.02f});
  instanced.gltf["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  instanced.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", 1}, {"SCALE", 2}};
  expectTheSame(instanced);
  Maker skinned = made;
  skinned.node()["skin"] = 0;
  skinned.gltf["nodes"].push_back({{"translation", {1e5 + 0.003, 0.7e5, -1.3e5}}, {"scale", {0.02, 0.02, 0.02}}});
  skinned.gltf["scenes"][0]["nodes"] = {0, 1};
  skinned.gltf["skins"] = {{{"joints", {1}}}};
  skinned.add<uint8_t>("VEC4", 5121, std::vector<uint8_t>(24, 0));
  skinned.add<float>("VEC4", 5126, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  skinned.primitive()["attributes"]["JOINTS_0"] = 1;
  skinned.primitive()["attributes"]["WEIGHTS_0"] = 2;
  expectTheSame(skinned);
}

TEST(CliVisibilityGltf, AlphaIsNamed) {
  const json masked = seen(std::string(kCases) + "alpha_MASK.gltf");
  EXPECT_FALSE(notes(masked, "alpha-tested")) << masked;
  Maker made;
  made.gltf["materials"] = json::parse(R"([{"alphaMode": "BLEND"}, {"alphaMode": "MASK", "alphaCutoff": 0.5,
    "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.4]}}])");
  made.primitive()["material"] = 0;
  made.gltf["meshes"][0]["primitives"].push_back(made.primitive());
  made.gltf["meshes"][0]["primitives"][1]["material"] = 1;
  const json object = made.seen();
  EXPECT_EQ(object["triangles"], 2) << "the other's alpha is below its cutoff everywhere";
  EXPECT_FALSE(notes(object, "BLEND")) << object;
  EXPECT_TRUE(notes(object, "were left out")) << object;
}

/// A PNG of two texels, the left one transparent.
constexpr const char* kHalf = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAADElEQVR4nGNg"
                              "gID/AAEIAQBNGY85AAAAAElFTkSuQmCC";

// Two squares, one in front of the other, which has a texture whose left half is transparent.
TEST(CliVisibilityGltf, AlphaIsSampled) {
  Maker made;
  made.add<float>("VEC2", 5126, {0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0});
  made.gltf["images"] = {{{"uri", kHalf}}};
  made.gltf["samplers"] = json::parse(R"([{"magFilter": 9728, "wrapS": 33071, "wrapT": 33071}])");
  made.gltf["textures"] = json::parse(R"([{"source": 0, "sampler": 0}])");
  made.gltf["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
  made.gltf["meshes"].push_back(made.gltf["meshes"][0]);
  made.gltf["nodes"] = json::parse(R"([{"mesh": 0}, {"mesh": 1, "translation": [0, 0, 1], "scale": [1.5, 1, 1]}])");
  made.gltf["scenes"][0]["nodes"] = {0, 1};
  json& front = made.gltf["meshes"][1]["primitives"][0];
  front["material"] = 0;
  front["attributes"]["TEXCOORD_0"] = 1;
  struct Case {
    const char* mode;
    int visible, covered; // triangles, pixels of what hides
  };
  for (const Case& c : {Case{"OPAQUE", 2, 1536}, Case{"MASK", 4, 1280}, Case{"BLEND", 4, 1024}})
    for (const char* method : {"standard", "exact"}) {
      made.gltf["materials"][0]["alphaMode"] = c.mode;
      for (const char* device : {"gpu", "cpu"}) {
        const json object = made.seen({"--method", method, "--reference", "4", "--reference-device", device});
        EXPECT_EQ(object["visible"], c.visible) << object;
        EXPECT_EQ(object["reference"], c.visible) << object;
        EXPECT_NEAR(object["coveredPixels"], c.covered, kEdge) << object;
        EXPECT_TRUE(object["notes"].empty()) << object;
      }
    }
  made.gltf["materials"][0]["alphaMode"] = "MASK";
  made.gltf["images"][0]["uri"] = "data:image/png;base64,AAAA";
  EXPECT_TRUE(notes(made.seen(), "not readable as PNG, JPEG or WebP"));
  made.gltf["textures"][0]["source"] = 7;
  EXPECT_NE(made.failure().find("names no image"), std::string::npos);
  made.gltf["textures"] = json::array();
  EXPECT_NE(made.failure().find("names no texture"), std::string::npos);
}

TEST(CliVisibilityGltf, InstancesAreDrawn) {
  const json three = seen(std::string(kCases) + "instancing_used.gltf");
  EXPECT_EQ(three["triangles"], 36);
  EXPECT_EQ(three["draws"], 3);
  EXPECT_TRUE(three["notes"].empty()) << three;
  Maker made; // a square of a half, turned by 90 degrees so that it is seen from behind, and one as it is
  made.add<float>("VEC3", 5126, {0, 0, 0, 0.25f, 0.25f, 0});
  made.add<int16_t>("VEC4", 5122, {0, 0, 0, 32767, 0, 32767, 0, 0});
  made.gltf["accessors"][2]["normalized"] = true;
  made.add<float>("VEC3", 5126, {0.5f, 0.5f, 1, 1, 1, 1});
  made.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", 1}, {"ROTATION", 2}, {"SCALE", 3}};
  made.gltf["extensionsUsed"] = made.gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const json object = made.seen();
  EXPECT_EQ(object["triangles"], 4);
  EXPECT_EQ(object["facing"], 2);
  EXPECT_NEAR(object["coveredPixels"], 256, kEdge);
  EXPECT_NEAR(made.seen({"--two-sided"})["coveredPixels"], 1024, kEdge);
  made.gltf["accessors"][3]["count"] = 1;
  EXPECT_NE(made.failure().find("different numbers"), std::string::npos);
  made.node()["extensions"]["EXT_mesh_gpu_instancing"] = json::object();
  EXPECT_NE(made.failure().find("EXT_mesh_gpu_instancing"), std::string::npos);
}

TEST(CliVisibilityGltf, MorphTargetsAreAtTheirDefaultWeights) {
  EXPECT_NEAR(seen(std::string(kCases) + "morph.gltf")["coveredPixels"], 4096, kEdge) << "twice as large";
  Maker made;
  made.add<float>("VEC3", 5126, {-.5f, -.5f, 0, .5f, -.5f, 0, .5f, .5f, 0, -.5f, -.5f, 0, .5f, .5f, 0, -.5f, .5f, 0});
  made.primitive()["targets"] = json::parse(R"([{"POSITION": 1}, {"NORMAL": 1}])");
  EXPECT_NEAR(made.seen()["coveredPixels"], 1024, kEdge) << "weights are 0 where none are given";
  made.gltf["meshes"][0]["weights"] = {-0.5, 0};
  EXPECT_NEAR(made.seen()["coveredPixels"], 256, kEdge);
  made.node()["weights"] = {0.5, 1};
  EXPECT_NEAR(made.seen()["coveredPixels"], 2304, kEdge) << "a node's come first";
  made.gltf["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, -1}}});
  made.gltf["scenes"][0]["nodes"] = {1, 0};
  EXPECT_EQ(made.seen()["triangles"], 4) << "each node with its own";
  made.gltf["accessors"][1]["count"] = 3;
  EXPECT_NE(made.failure().find("a morph target has 3 vertices, its primitive 6"), std::string::npos);
}

TEST(CliVisibilityGltf, SkinsAreAtRest) {
  const json unbound = seen(std::string(kCases) + "skin_transform.gltf");
  EXPECT_NEAR(unbound["coveredPixels"], 1024, kEdge) << "the node's transform moves no skinned mesh";
  EXPECT_TRUE(notes(unbound, "name no joints")) << unbound;
  Maker made; // the lower corners by one joint, the upper ones half by each: the second is 1 to the right, bound at 0.5
  made.add<uint8_t>("VEC4", 5121, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  made.add<float>("VEC4", 5126, {1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, .5f, .5f, 0, 0});
  made.add<float>("MAT4", 5126,
                  {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -.5f, 0, 0, 1});
  made.primitive()["attributes"] = {{"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}};
  made.node()["skin"] = 0;
  made.node()["translation"] = {50, 0, 0};
  made.gltf["nodes"].push_back({{"name", "first"}});
  made.gltf["nodes"].push_back({{"name", "second"}, {"translation", {1, 0, 0}}});
  made.gltf["nodes"].push_back({{"children", {1, 2}}, {"translation", {0, 0, 1}}});
  made.gltf["scenes"][0]["nodes"] = {0, 3};
  made.gltf["skins"] = json::parse(R"([{"joints": [1, 2], "inverseBindMatrices": 3}])");
  const TemporaryFile ids("skin.png");
  EXPECT_NEAR(made.seen()["coveredPixels"], 1024, kEdge) << "a parallelogram, a quarter to the right";
  EXPECT_TRUE(made.seen()["notes"].empty());
  made.gltf["skins"][0]["joints"] = {1};
  EXPECT_NE(made.failure().find("joint 1, which its skin has not"), std::string::npos);
  made.gltf["skins"][0]["joints"] = {1, 9};
  EXPECT_NE(made.failure().find("a skin names a node"), std::string::npos);
}

TEST(CliVisibilityGltf, CompressionWithoutItsFallbackIsRefusedByName) {
  const TemporaryFile camera("gltf_case.txt", kCamera);
  EXPECT_NE(gpgpFailure({"visibility", std::string(kCases) + "draco_used_nofallback.gltf"})
                .find("KHR_draco_mesh_compression"),
            std::string::npos);
  Maker draco;
  draco.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                   {"attributes", {{"POSITION", 0}}}};
  draco.gltf["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  const json fallback = draco.seen();
  EXPECT_EQ(fallback["visible"], 2) << "with a fallback";
  EXPECT_TRUE(fallback["notes"].empty()) << fallback;
  draco.gltf["accessors"].push_back({{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}});
  draco.primitive()["indices"] = 1;
  EXPECT_NE(draco.failure().find("KHR_draco_mesh_compression"), std::string::npos) << draco.failure();
  Maker meshopt;
  meshopt.gltf["buffers"].push_back(
      {{"byteLength", 72}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  meshopt.gltf["bufferViews"][0] = {{"buffer", 1},
                                    {"byteLength", 72},
                                    {"extensions", {{"EXT_meshopt_compression", {{"buffer", 0}, {"byteLength", 20}}}}}};
  meshopt.gltf["extensionsUsed"] = {"EXT_meshopt_compression"};
  EXPECT_NE(meshopt.failure().find("EXT_meshopt_compression"), std::string::npos) << meshopt.failure();
}

TEST(CliVisibilityGltf, ResourcesMayBeLongerThanTheirBuffers) {
  for (const char* name : {"datauri_longer.gltf", "file_longer.gltf"})
    EXPECT_NEAR(seen(std::string(kCases) + name)["coveredPixels"], 1024, kEdge) << name;
  Maker made;
  made.bytes.resize(60); // of 72
  made.bytes.append(100'000, 0);
  made.gltf["buffers"][0]["byteLength"] = 200'000;
  const std::string shorter = made.failure();
  EXPECT_NE(shorter.find("buffer 0 has 100060 bytes of 200000"), std::string::npos) << shorter;
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + std::string(99'999, '!'),
        "data:application/octet-stream," + std::string(99'999, 'A'), "https://example.org/" + std::string(99'999, 'a'),
        std::string(99'999, 'a'), std::string("missing.bin")}) {
    made.gltf["buffers"][0]["uri"] = uri;
    const std::string failure = made.failure();
    EXPECT_NE(failure.find("buffer 0"), std::string::npos) << failure;
    EXPECT_LT(failure.size(), 500u) << failure;
  }
  std::string broken = Maker().text();
  broken.insert(broken.find("base64,") + 7, std::string(100'000, 'A'));
  broken.resize(broken.size() / 2); // an unfinished string
  const TemporaryFile file("broken.gltf", broken);
  const std::string failure = gpgpFailure({"visibility", file.path()});
  EXPECT_LT(failure.size(), 500u) << failure;
}

TEST(CliVisibilityGltf, ContainersAreCheckedChunkByChunk) {
  EXPECT_NE(gpgpFailure({"visibility", std::string(kCases) + "v3.glb"}).find("container version 3"), std::string::npos);
  Maker made;
  const auto container = [&](uint32_t jsonSize, uint32_t binarySize, const std::string& kind, uint32_t length) {
    std::string text = made.gltf.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string chunks = word(static_cast<uint32_t>(text.size()) + jsonSize) + kind + text +
                               word(static_cast<uint32_t>(made.bytes.size()) + binarySize) + std::string("BIN\0", 4) +
                               made.bytes;
    return "glTF" + word(2) + word(static_cast<uint32_t>(chunks.size()) + 12 + length) + chunks;
  };
  const auto failure = [](const std::string& bytes) {
    const TemporaryFile file("made.glb", bytes);
    return gpgpFailure({"visibility", file.path()});
  };
  const TemporaryFile good("good.glb", container(0, 0, "JSON", 0)), named("good.gltf", container(0, 0, "JSON", 0)),
      more("more.glb", container(0, 0, "JSON", 0) + "and more behind its end");
  EXPECT_EQ(seen(good.path())["visible"], 2);
  EXPECT_EQ(seen(named.path())["visible"], 2) << "its bytes say what it is";
  EXPECT_EQ(seen(more.path())["visible"], 2);
  EXPECT_NE(failure(container(0, 0, "JSON", 4)).find("its header says"), std::string::npos);
  EXPECT_NE(failure(container(0, 4, "JSON", 0)).find("chunk 1 says that it has 76 bytes"), std::string::npos);
  EXPECT_NE(failure(container(0, 2, "JSON", 0)).find("chunk 1 has 74 bytes, which is not a multiple of 4"),
            std::string::npos);
  EXPECT_NE(failure(container(0xf0000000, 0, "JSON", 0)).find("chunk 0"), std::string::npos);
  EXPECT_NE(failure(container(0, 0, "NOSJ", 0)).find("first chunk"), std::string::npos);
  EXPECT_NE(failure(std::string("glTF") + word(2)).find("header"), std::string::npos);
  EXPECT_NE(failure("glTF" + word(2) + word(12)).find("no chunk of JSON"), std::string::npos);
  made.gltf["buffers"][0]["byteLength"] = 76;
  EXPECT_NE(failure(container(0, 0, "JSON", 0)).find("buffer 0 has 72 bytes of 76"), std::string::npos);
}

TEST(CliVisibilityGltf, WhatIsNotShownIsNamed) {
  Maker made;
  made.gltf["cameras"] = json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])");
  made.gltf["scenes"].push_back({{"nodes", {0}}});
  made.gltf["animations"] = json::parse(R"([{"channels": [], "recorders": []}])");
  made.gltf["extensionsUsed"] = {"KHR_node_visibility", "KHR_materials_unlit"};
  made.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = json::array();
  for (const int mode : {0, 1, 2, 3}) {
    made.gltf["meshes"][0]["primitives"].push_back(made.primitive());
    made.gltf["meshes"][0]["primitives"].back()["mode"] = mode;
  }
  made.gltf["meshes"][0]["primitives"].push_back({{"attributes", {{"NORMAL", 0}}}});
  const json object = made.seen();
  EXPECT_EQ(object["omitted"], 4);
  for (const char* part : {"1 cameras", "1 scenes", "1 animations are not played", "extension KHR_node_visibility",
                           "1 primitives have variants", "1 primitives have no positions"})
    EXPECT_TRUE(notes(object, part)) << part << object["notes"];
  EXPECT_EQ(object["notes"].size(), 6u) << object["notes"];
  made.gltf["asset"]["minVersion"] = "2.1";
  EXPECT_NE(made.failure().find("'2.1' at least"), std::string::npos);
}

TEST(CliVisibilityGltf, NodesOfNoSizeAreThereButNotSeen) {
  Maker made;
  made.node()["scale"] = {0, 0, 0};
  const json object = made.seen();
  EXPECT_EQ(object["triangles"], 2);
  EXPECT_EQ(object["visible"], 0);
}

// Depth first, in the order of the file.
TEST(CliVisibilityGltf, TrianglesAreNumberedAsTheNodesFollow) {
  Maker made;
  made.gltf["nodes"] = json::parse(R"([{"children": [1, 2]}, {"mesh": 0, "translation": [5, 0, 0]},
    {"mesh": 0, "translation": [0, 0, 0]}, {"mesh": 0, "translation": [9, 0, 0]}])");
  made.gltf["scenes"][0]["nodes"] = {0, 3};
  const TemporaryFile ids("order.ids");
  made.seen({"--export-ids", ids.path()});
  EXPECT_EQ(host::readText(ids.path()), word(2) + word(3));
}

TEST(CliVisibilityGltf, NestingHasAnEnd) {
  Maker made;
  std::string text = made.text();
  text.insert(1, "\"extras\": " + std::string(100'000, '[') + std::string(100'000, ']') + ", ");
  const TemporaryFile file("deep.gltf", text);
  EXPECT_NE(gpgpFailure({"visibility", file.path()}).find("nested deeper"), std::string::npos);
}

} // namespace
} // namespace gpgp::test
