// What `gpgp visibility` reads of glTF and OBJ files, by what is seen of it, and what it refuses.
#include "cli/model/ear_clipping.h"
#include "files.h"
#include "run.h"

#include <glm/glm.hpp>

#include <cmath>
#include <functional>
#include <random>

namespace gpgp::test {
namespace {

using Args = std::vector<std::string>;

// Looks along -z at -1 to 1, in 64 x 64 pixels: a square of side 1 has 1024.
constexpr const char* kCamera = "1 0 0 0  0 -1 0 0  0 0 -0.1 0  0 0 0.5 1";

Args from(const TemporaryFile& model, const TemporaryFile& camera) {
  return {"visibility", model.path(), "--size", "64x64", "--camera", camera.path()};
}

/// A glTF of a triangle, half of the unit square.
class Gltf {
public:
  /// The file is the triangle's, changed.
  explicit Gltf(const std::function<void(json&)>& change = [](json&) {})
      : bytes_("shape.bin", bytes()), file_("shape.gltf", text(change)), camera_("shape.txt", kCamera) {}
  json seen(const Args& more = {}) const {
    Args args = from(file_, camera_);
    args.insert(args.end(), more.begin(), more.end());
    return gpgpJson(args);
  }
  json seenFromBehind() const {
    return gpgpJson({"visibility", file_.path(), "--size", "64x64", "--yaw", "180", "--pitch", "0"});
  }
  std::string failure() const { return gpgpFailure(from(file_, camera_)); }

private:
  static std::string bytes() {
    constexpr float kPositions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, kReplaced[] = {1, 0, 0, 0, 0.5f, 0};
    constexpr uint16_t kIndices[] = {0, 1, 2, 3}, kPlaces[] = {1, 2};
    constexpr uint8_t kQuantized[] = {0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0};
    std::string bytes;
    const auto add = [&bytes](const auto& values) {
      bytes.append(reinterpret_cast<const char*>(values), sizeof values);
    };
    add(kPositions);
    add(kIndices);
    add(kPlaces);
    add(kReplaced);
    add(kQuantized);
    return bytes;
  }
  std::string text(const std::function<void(json&)>& change) const {
    json gltf = json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 8},
                      {"buffer": 0, "byteOffset": 56, "byteLength": 4}, {"buffer": 0, "byteOffset": 60, "byteLength": 24},
                      {"buffer": 0, "byteOffset": 84, "byteLength": 12, "byteStride": 4}],
      "buffers": [{"byteLength": 96}]})");
    gltf["buffers"][0]["uri"] = std::filesystem::path(bytes_.path()).filename().string();
    change(gltf);
    return gltf.dump();
  }
  TemporaryFile bytes_, file_, camera_;
};

constexpr double kEdge = 24; // pixels whose centres lie on an edge

json& primitive(json& gltf) { return gltf["meshes"][0]["primitives"][0]; }

TEST(CliVisibilityModels, SparseAccessorsReplace) {
  EXPECT_NEAR(Gltf().seen()["coveredPixels"], 512, kEdge);
  const auto sparse = [](json& gltf) {
    gltf["accessors"][0]["sparse"] = {
        {"count", 2}, {"indices", {{"bufferView", 2}, {"componentType", 5123}}}, {"values", {{"bufferView", 3}}}};
  };
  EXPECT_NEAR(Gltf(sparse).seen()["coveredPixels"], 256, kEdge) << "the third corner is half as high";
  const Gltf alone([&](json& gltf) {
    sparse(gltf);
    gltf["accessors"][0].erase("bufferView");
  });
  EXPECT_NEAR(alone.seen()["coveredPixels"], 256, kEdge) << "all others are zeros";
  const auto failure = [&](const std::function<void(json&)>& change) {
    return Gltf([&](json& gltf) {
             sparse(gltf);
             change(gltf["accessors"][0]);
           })
        .failure();
  };
  EXPECT_NE(failure([](json& a) { a["sparse"]["count"] = 3; }).find("beyond buffer view 2"), std::string::npos);
  EXPECT_NE(failure([](json& a) { a["count"] = 2; }).find("index is out of range"), std::string::npos);
  EXPECT_NE(failure([](json& a) { a["sparse"]["values"]["bufferView"] = 9; }).find("no buffer view 9"),
            std::string::npos);
}

TEST(CliVisibilityModels, AccessorsWithoutBufferViewAreZeros) {
  const json seen = Gltf([](json& gltf) {
                      gltf["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
                      gltf["meshes"][0]["primitives"].push_back(primitive(gltf));
                      gltf["meshes"][0]["primitives"][1]["attributes"]["POSITION"] = 2;
                    }).seen();
  EXPECT_EQ(seen["triangles"], 2);
  EXPECT_EQ(seen["visible"], 1) << "the other is a point";
  EXPECT_NE(Gltf([](json& gltf) {
              gltf["accessors"][0].erase("bufferView");
              gltf["accessors"][0]["count"] = 4000000000u;
            })
                .failure()
                .find("more elements than a buffer holds"),
            std::string::npos);
}

TEST(CliVisibilityModels, ImagesAreNotLookedAt) {
  for (const json& image :
       {json{{"uri", "data:image/webp;base64,UklGRgAAAABXRUJQ"}}, json{{"uri", "missing.png"}},
        json{{"uri", "data:image/ktx2;base64,q0tUWCAyMLsNChoK"}}, json{{"uri", "data:image/png;base64,iVBORw0KGgo="}},
        json{{"bufferView", 1}, {"mimeType", "image/ktx2"}}}) {
    const Gltf model([&image](json& gltf) {
      gltf["images"] = {image};
      gltf["textures"] = json::parse(R"([{"source": 0}])");
      gltf["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
      primitive(gltf)["material"] = 0;
    });
    EXPECT_EQ(model.seen()["visible"], 1) << image;
  }
}

TEST(CliVisibilityModels, StripsAndFans) {
  const auto mode = [](int number) {
    return Gltf([number](json& gltf) {
      primitive(gltf)["mode"] = number;
      gltf["accessors"][1]["count"] = 4;
    });
  };
  const json strip = mode(5).seen();
  EXPECT_EQ(strip["visible"], 2) << "both face the camera";
  EXPECT_NEAR(strip["coveredPixels"], 1024, kEdge) << "the square";
  EXPECT_EQ(strip["omitted"], 0);
  const json fan = mode(6).seen({"--two-sided"});
  EXPECT_EQ(fan["triangles"], 2);
  EXPECT_NEAR(fan["coveredPixels"], 768, kEdge) << "two halves that overlap";
  EXPECT_EQ(mode(6).seen()["visible"], 1) << "the second turns the other way";
}

TEST(CliVisibilityModels, DoubleSidedMaterialsShowTheirBack) {
  const Gltf both([](json& gltf) {
    gltf["materials"] = json::parse(R"([{"doubleSided": true}, {}])");
    gltf["meshes"][0]["primitives"].push_back(primitive(gltf));
    gltf["meshes"][0]["primitives"].push_back(primitive(gltf));
    primitive(gltf)["material"] = 1;
    gltf["meshes"][0]["primitives"][1]["material"] = 0;
  });
  const json behind = both.seenFromBehind();
  EXPECT_EQ(behind["triangles"], 3);
  EXPECT_EQ(behind["facing"], 1) << "only the primitive of that material";
  EXPECT_EQ(behind["visible"], 1);
}

TEST(CliVisibilityModels, ExtensionsThatChangeShapesAreRefused) {
  const auto requiring = [](const std::string& name) {
    return Gltf([&name](json& gltf) { gltf["extensionsRequired"] = {name}; });
  };
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "X_new"})
    EXPECT_NE(requiring(name).failure().find(name), std::string::npos);
  const Gltf without([](json& gltf) { // an error of its own, which does not say why
    gltf["extensionsRequired"] = {"EXT_meshopt_compression"};
    gltf["buffers"].push_back({{"byteLength", 96}});
  });
  EXPECT_NE(without.failure().find("EXT_meshopt_compression"), std::string::npos);
  for (const char* name : {"KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual"})
    EXPECT_EQ(requiring(name).seen()["visible"], 1) << name;
  const auto quantized = [](json& gltf) {
    json& positions = gltf["accessors"][0];
    positions["bufferView"] = 4;
    positions["componentType"] = 5121;
    positions["normalized"] = true;
    positions["count"] = 3;
  };
  EXPECT_NE(Gltf(quantized).failure().find("not three floats"), std::string::npos);
  const Gltf allowed([&](json& gltf) {
    quantized(gltf);
    gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
  });
  EXPECT_NEAR(allowed.seen()["coveredPixels"], 512, kEdge);
}

TEST(CliVisibilityModels, BrokenGltfIsNamed) {
  const std::vector<std::pair<std::function<void(json&)>, const char*>> broken = {
      {[](json& gltf) { gltf["asset"]["version"] = "1.0"; }, "version '1.0'"},
      {[](json& gltf) { gltf["asset"]["version"] = "3.0"; }, "version '3.0'"},
      {[](json& gltf) { gltf["nodes"][0]["mesh"] = 3; }, "node 0 names mesh 3"},
      {[](json& gltf) {
         gltf["nodes"][0]["matrix"] = {1, 0, 0, 0};
       },
       "4 numbers, not 16"},
      {[](json& gltf) {
         gltf["nodes"][0]["scale"] = {1, 1};
       },
       "too many or too few numbers"},
      {[](json& gltf) { primitive(gltf)["material"] = 0; }, "no material"},
      {[](json& gltf) { primitive(gltf).erase("indices"); }, "4 corners, which is not a multiple of 3"},
      {[](json& gltf) { gltf["bufferViews"][0]["byteLength"] = 47; }, "beyond buffer view 0"},
      {[](json& gltf) { gltf["accessors"][1]["count"] = 5; }, "beyond buffer view 1"},
      {[](json& gltf) { gltf["accessors"][1]["count"] = 4000000000u; }, "beyond buffer view 1"},
      {[](json& gltf) { gltf["accessors"][0]["byteOffset"] = 18446744073709551600u; }, "beyond buffer view 0"},
      {[](json& gltf) { gltf["bufferViews"][1]["byteLength"] = 49; }, "buffer view 1 reaches beyond its buffer"}};
  for (const auto& [change, text] : broken) {
    const std::string failure = Gltf(change).failure();
    EXPECT_NE(failure.find(text), std::string::npos) << failure;
  }
}

TEST(CliVisibilityModels, ObjFilesMayBeginWithAMark) {
  const TemporaryFile marked("marked.obj", "\xef\xbb\xbfv -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1/ 2//3 3/-1/2#all\n"),
      camera("marked.txt", kCamera);
  EXPECT_NEAR(gpgpJson(from(marked, camera))["coveredPixels"], 2048, 2 * kEdge);
}

TEST(CliVisibilityModels, ObjNumbersAreWholeWords) {
  for (const char* line : {"v 0 0 0junk", "v 0 0x 0", "v 0 0 0,5"}) {
    const TemporaryFile model("junk.obj", std::string(line) + '\n');
    EXPECT_NE(gpgpFailure({"visibility", model.path()}).find("junk.obj:1: a vertex"), std::string::npos) << line;
  }
  for (const char* face : {"1.9 2 3", "1 2 3abc", "1/x 2 3", "1 2 3/1/2/3", "1/1x 2 3", "1 2 - 3"}) {
    const TemporaryFile model("junk.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + std::string(face) + '\n');
    EXPECT_NE(gpgpFailure({"visibility", model.path()}).find("junk.obj:4: a face"), std::string::npos) << face;
  }
}

TEST(CliVisibilityModels, ConcavePolygonsKeepTheirOutline) {
  const TemporaryFile camera("concave.txt", kCamera);
  const auto covered = [&](const std::string& obj) {
    const TemporaryFile model("concave.obj", obj);
    Args args = from(model, camera);
    args.push_back("--two-sided"); // what lies outside would be seen
    return gpgpJson(args)["coveredPixels"].get<double>();
  };
  const std::string notch = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 0.25 0\nv 0 1 0\n";
  EXPECT_NEAR(covered(notch + "f 1 2 3 4 5\n"), 0.625 * 1024, kEdge);
  EXPECT_NEAR(covered(notch + "f 5 4 3 2 1\n"), 0.625 * 1024, kEdge) << "whichever way round";
  EXPECT_NEAR(covered("v 0 0 0\nv 1 -0.75 0\nv 0.25 0 0\nv 1 0.75 0\nf 2 3 4 1\n"), 0.1875 * 1024, kEdge);
}

/// Twice a triangle's area, seen from a direction.
double areaFrom(const glm::dvec3& normal, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return glm::dot(glm::cross(b - a, c - a), normal);
}

// Triangles that all turn as the outline does and have its area together are the polygon, each point of it once.
TEST(EarClipping, TrianglesAreThePolygon) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 300; ++round) {
    // A star round its middle, or a spiral, in a plane that lies anyhow.
    const glm::dvec3 normal = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)) - 0.5);
    const glm::dvec3 right = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, -0.7)));
    const glm::dvec3 up = glm::cross(normal, right);
    std::vector<glm::dvec3> outline;
    const auto add = [&](double turn, double radius) {
      outline.push_back((right * std::cos(turn) + up * std::sin(turn)) * radius);
    };
    const int corners = 3 + round % 40;
    if (round % 2)
      for (int i = 0; i < corners; ++i) add(6.2831853 * i / corners, 0.1 + unit(random));
    else {
      for (int i = 0; i <= corners; ++i) add(0.5 * i, 1 + 0.1 * i);
      for (int i = corners; i >= 0; --i) add(0.5 * i, 0.5 + 0.1 * i);
    }
    double whole = 0, parts = 0;
    for (size_t i = 0; i < outline.size(); ++i)
      whole += areaFrom(normal, glm::dvec3(0), outline[i], outline[(i + 1) % outline.size()]);
    const double sign = whole < 0 ? -1 : 1;
    const std::vector<size_t> triangles = cli::clipEars(outline);
    ASSERT_EQ(triangles.size(), (outline.size() - 2) * 3);
    for (size_t i = 0; i < triangles.size(); i += 3) {
      const double area =
          areaFrom(normal, outline[triangles[i]], outline[triangles[i + 1]], outline[triangles[i + 2]]) * sign;
      EXPECT_GE(area, -1e-12) << "round " << round;
      parts += area;
    }
    EXPECT_NEAR(parts, whole * sign, 1e-9) << "round " << round;
  }
}

TEST(EarClipping, ConvexPolygonsAreFans) {
  const std::vector<glm::dvec3> square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(cli::clipEars(square), (std::vector<size_t>{0, 1, 2, 0, 2, 3, 0, 3, 4})) << "with a corner on an edge";
  const std::vector<glm::dvec3> point(4, glm::dvec3(1));
  EXPECT_EQ(cli::clipEars(point).size(), 6u);
}

} // namespace
} // namespace gpgp::test
