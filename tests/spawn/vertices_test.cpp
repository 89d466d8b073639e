// Terminals as vertices and indices, regions of buckets, and counting before writing: shapes against closed forms, the
// GPU against the CPU evaluator, budgets, through the C API with validation.
#include "../device_test.h"
#include "bounds.h"
#include "grammars.h"
#include "host/device.h"
#include "host/memory.h"
#include "spawn/evaluator/evaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <list>
#include <map>
#include <numeric>
#include <random>
#include <sstream>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using namespace gpgp::shader;
using spawn::makeAxiom;

// ---------------------------------------------------------------- shapes

struct Triangle {
  vec3 corners[3];
  vec3 normal; // of its vertices
};

std::vector<Triangle> trianglesOf(const std::vector<uint32_t>& words, uint32_t geometry) {
  std::vector<Triangle> triangles;
  for (uint32_t quad = 0; quad < meshQuads(words.data(), geometry); ++quad)
    for (uint32_t half = 0; half < 2; ++half) {
      Triangle t;
      for (uint32_t i = 0; i < 3; ++i) {
        const MeshVertex v = meshVertex(words.data(), geometry, quad, quadIndex(3 * half + i));
        t.corners[i] = v.position;
        t.normal = meshNormal(vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0), v, false);
        EXPECT_GE(std::min(v.uv.x, v.uv.y), 0.0f);
        EXPECT_LE(std::max(v.uv.x, v.uv.y), 1.0f);
      }
      triangles.push_back(t);
    }
  return triangles;
}

vec3 areaOf(const Triangle& t) { return 0.5f * cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]); }

double polygonArea(const std::vector<uint32_t>& words, uint32_t geometry) {
  const uint32_t polygon = polygonAt(words.data(), geometry), corners = words[polygon + 1];
  double area = 0;
  for (uint32_t i = 0; i < corners; ++i) {
    const vec2 a = polygonCorner(words.data(), polygon, i), b = polygonCorner(words.data(), polygon, (i + 1) % corners);
    area += 0.5 * (double(a.x) * b.y - double(b.x) * a.y);
  }
  return area;
}

/// Every edge is passed once in each direction, by triangles that have area or not.
void expectClosed(const std::vector<Triangle>& triangles) {
  std::map<std::array<int, 6>, int> edges;
  const auto grid = [](float v) { return static_cast<int>(std::lround(v * 100000)); };
  for (const Triangle& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const vec3 a = t.corners[i], b = t.corners[(i + 1) % 3];
      const std::array<int, 3> from{grid(a.x), grid(a.y), grid(a.z)}, to{grid(b.x), grid(b.y), grid(b.z)};
      if (from < to) ++edges[{from[0], from[1], from[2], to[0], to[1], to[2]}];
      if (to < from) --edges[{to[0], to[1], to[2], from[0], from[1], from[2]}];
    }
  EXPECT_GT(edges.size(), 5u);
  for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0);
}

/// A grammar with polygons of its own: a convex pentagon that is no regular one, and a concave one.
std::vector<uint32_t> shapesGrammar() {
  return bake("axiom Box A; terminal T (0,0); A = Replicate() { T | "
              "SetAsDynamicConvexRightPrism((-0.5,-0.5),(0.5,-0.4),(0.3,0.5),(-0.2,0.5),(-0.4,0.2)) T | "
              "SetAsDynamicConcaveRightPrism((-0.5,-0.5),(0.5,-0.5),(0.5,0.5),(0,0),(-0.5,0.5)) T };");
}

TEST(Mesh, SolidsAreClosedAndFaceOutwards) {
  const auto words = shapesGrammar();
  std::vector<uint32_t> geometries = {kShapeBox | (kQuadPolygon << 8),
                                      kShapeSphere,
                                      kShapeDynamicConvexRightPrism | (kRegularPolygons << 8),
                                      kShapeDynamicConvexRightPrism | ((kRegularPolygons + 1) << 8),
                                      kShapeDynamicRightPrism | ((kRegularPolygons + 2) << 8),
                                      kShapeDynamicRightPrism | ((kRegularPolygons + 3) << 8)};
  // Pyramids, hip roofs, gables, and shed roofs of all sides.
  for (const uint32_t place : {0u, kRidgeLow, kRidgeHigh})
    for (const uint32_t along : {0u, kRidgeAlongZ})
      for (const uint32_t length : {0u, kRidgeFull / 4, kRidgeFull / 2, kRidgeFull})
        if (place == 0 || length == kRidgeFull) geometries.push_back(kShapeRoof | ((place | along | length) << 8));
  for (uint32_t sides = 3; sides <= 8; ++sides)
    if (sides != 4) geometries.push_back((kShapePrism3 + sides - 3) | ((2 * (sides - 3)) << 8));
  for (const uint32_t geometry : geometries) {
    SCOPED_TRACE(geometry & 0xff);
    const auto triangles = trianglesOf(words, geometry);
    expectClosed(triangles);
    double volume = 0;
    vec3 low(9), high(-9);
    for (const Triangle& t : triangles) {
      volume += double(dot(t.corners[0], areaOf(t))) / 3;
      const float area = glm::length(areaOf(t));
      if (area > 1e-6f) {
        EXPECT_GT(dot(areaOf(t), t.normal), 0.999f * area);
      }
      for (const vec3& c : t.corners) {
        low = glm::min(low, c);
        high = glm::max(high, c);
      }
    }
    if (geometry == kShapeSphere) {
      EXPECT_GT(volume, 0.85 * 0.5235987756);
      EXPECT_LT(volume, 0.5235987756);
    } else if ((geometry & 0xff) == kShapeRoof) {
      // Under the ridge a prism, and both ends together a pyramid.
      const double ridge = 2 * double(ridgeOf(geometry).halfLength);
      EXPECT_NEAR(volume, ridge / 2 + (1 - ridge) / 3, 1e-6);
    } else {
      EXPECT_NEAR(volume, polygonArea(words, geometry), 1e-5);
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(low[axis], -0.5f, 0.02f);
      EXPECT_NEAR(high[axis], 0.5f, 0.02f);
    }
  }
}

TEST(Mesh, PolygonsCoverTheirAreaAndFaceUpZ) {
  const auto words = shapesGrammar();
  for (uint32_t polygon = 0; polygon < kRegularPolygons + 4; ++polygon) {
    const uint32_t shape = polygon < kRegularPolygons ? polygon / 2 : kShapeDynamicConvexPolygon;
    const uint32_t geometry = shape | (polygon << 8);
    SCOPED_TRACE(polygon);
    double area = 0;
    for (const Triangle& t : trianglesOf(words, geometry)) {
      EXPECT_GE(areaOf(t).z, 0.0f);
      EXPECT_NEAR(t.normal.z, 1.0f, 1e-5f);
      area += double(areaOf(t).z);
    }
    EXPECT_NEAR(area, polygonArea(words, geometry), 1e-5);
  }
}

/// Corners as a grammar writes them.
std::string cornersText(const std::vector<vec2>& corners) {
  std::ostringstream text;
  for (size_t i = 0; i < corners.size(); ++i) text << (i ? ",(" : "(") << corners[i].x << ',' << corners[i].y << ')';
  return text.str();
}

TEST(Mesh, ConcavePolygonsAreCoveredOnceByFewQuads) {
  std::vector<std::vector<vec2>> polygons;
  polygons.push_back({{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {0.3f, -0.3f}, {-0.3f, -0.3f}, {-0.5f, 0.5f}}); // U
  // A square ring as one outline: it runs along a bridge to the hole and back.
  polygons.push_back({{-0.5f, -0.5f},
                      {0.5f, -0.5f},
                      {0.5f, 0.5f},
                      {-0.5f, 0.5f},
                      {-0.5f, -0.5f},
                      {-0.25f, -0.25f},
                      {-0.25f, 0.25f},
                      {0.25f, 0.25f},
                      {0.25f, -0.25f},
                      {-0.25f, -0.25f}});
  // Corners on straight edges, and one corner twice.
  polygons.push_back({{-0.5f, -0.5f},
                      {0, -0.5f},
                      {0.5f, -0.5f},
                      {0.5f, 0},
                      {0.5f, 0.5f},
                      {0.5f, 0.5f},
                      {0, 0.25f},
                      {0, 0},
                      {-0.5f, 0}});
  std::vector<vec2> spiral; // a band that winds three times round the centre
  for (int i = 0; i <= 120; ++i) {
    const double angle = i * 6.283185307 * 3 / 120, radius = 0.1 + 0.35 * i / 120;
    spiral.push_back({static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))});
  }
  for (int i = 120; i >= 0; --i) {
    const double angle = i * 6.283185307 * 3 / 120, radius = 0.05 + 0.35 * i / 120;
    spiral.push_back({static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))});
  }
  polygons.push_back(spiral);
  std::mt19937 random(7);
  for (uint32_t count : {5u, 8u, 30u, 300u}) {
    std::vector<vec2> star;
    for (uint32_t i = 0; i < count; ++i) {
      const double radius = std::uniform_real_distribution<double>(0.02, 0.5)(random), angle = 6.283185307 * i / count;
      star.push_back({static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))});
    }
    polygons.push_back(star);
  }
  std::string text = "axiom Box A; terminal T (0,0); A = Replicate() { T";
  for (const auto& polygon : polygons)
    text += std::string(" | SetAsDynamicConcaveRightPrism(") + cornersText(polygon) + ") T";
  const auto words = bake(text + " };");
  for (uint32_t i = 0; i < 2 * polygons.size(); ++i) {
    SCOPED_TRACE(i);
    const uint32_t number = kRegularPolygons + i, corners = static_cast<uint32_t>(polygons[i / 2].size());
    const uint32_t flat = kShapeDynamicPolygon | (number << 8), prism = kShapeDynamicRightPrism | (number << 8);
    double area = 0, volume = 0;
    for (const Triangle& t : trianglesOf(words, flat)) {
      EXPECT_GE(areaOf(t).z, -1e-7f); // all positive: what sums up to the polygon's area covers it once
      area += double(areaOf(t).z);
    }
    EXPECT_NEAR(area, polygonArea(words, flat), 1e-5);
    EXPECT_LE(meshQuads(words.data(), flat), corners - 2);
    EXPECT_GE(meshQuads(words.data(), flat), (corners - 1) / 2);
    if (corners > 100) {
      EXPECT_LE(meshQuads(words.data(), flat), 3 * corners / 4);
    }
    const auto solid = trianglesOf(words, prism);
    expectClosed(solid);
    for (const Triangle& t : solid) volume += double(dot(t.corners[0], areaOf(t))) / 3;
    EXPECT_NEAR(volume, area, 1e-5);
  }
}

TEST(Mesh, BoxFacesAreThoseOfCompSplit) {
  // A box, and the six faces of one, have the same vertices in the same order.
  const auto solid = bake("axiom Box A; terminal T (0,0); A = T;");
  const auto split = bake("axiom Box A; terminal T (0,0); A = CompSplit() T;");
  GpgpAxiom axiom = makeAxiom(2, 3, 5, 1, 1);
  axiom.transform[0] = axiom.transform[10] = 0.6f;
  axiom.transform[2] = 0.8f;
  axiom.transform[8] = -0.8f;
  axiom.transform[7] = 9;
  spawn::VertexLayout layout{8, 3, {vertexAttribute(0, 0, 0), vertexAttribute(3, 1, 0), vertexAttribute(6, 2, 1)}};
  spawn::DeriveOptions options;
  options.vertices = &layout;
  const auto a = spawn::derive(solid, std::span(&axiom, 1), options);
  const auto b = spawn::derive(split, std::span(&axiom, 1), options);
  ASSERT_EQ(a.vertexWords.size(), 24u * 8u);
  ASSERT_EQ(b.vertexWords.size(), a.vertexWords.size());
  ASSERT_EQ(b.quads.size(), 6u);
  for (size_t i = 0; i < a.vertexWords.size(); ++i)
    EXPECT_NEAR(std::bit_cast<float>(a.vertexWords[i]), std::bit_cast<float>(b.vertexWords[i]), 1e-5f) << i;
}

// ---------------------------------------------------------------- the GPU

/// How vertices look, and the type of their indices.
struct VertexFormat : GpgpVertexLayout {
  VkIndexType indexType;
};
/// One that stays where it is: recorders are found again by their create info.
const GpgpVertexLayout* stable(const GpgpVertexLayout& layout) {
  static std::list<GpgpVertexLayout> all;
  for (const GpgpVertexLayout& known : all)
    if (std::memcmp(&known, &layout, sizeof layout) == 0) return &known;
  return &all.emplace_back(layout);
}
/// 48 bytes with all semantics but the rule, or parts of it in small formats.
VertexFormat wideVertex() {
  VertexFormat v{};
  v.indexType = VK_INDEX_TYPE_UINT32;
  v.stride = 48;
  v.attributeCount = 7;
  v.attributes[0] = {GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0};
  v.attributes[1] = {GPGP_VERTEX_NORMAL, VK_FORMAT_R32G32B32_SFLOAT, 12};
  v.attributes[2] = {GPGP_VERTEX_UV, VK_FORMAT_R32G32_SFLOAT, 24};
  v.attributes[3] = {GPGP_VERTEX_BUCKET, VK_FORMAT_R32_UINT, 32};
  v.attributes[4] = {GPGP_VERTEX_AXIOM_ID, VK_FORMAT_R32_UINT, 36};
  v.attributes[5] = {GPGP_VERTEX_TERMINAL, VK_FORMAT_R32_UINT, 40};
  v.attributes[6] = {GPGP_VERTEX_SEED, VK_FORMAT_R32_UINT, 44};
  return v;
}
/// 60 bytes, which are staged, with all semantics.
VertexFormat fullVertex() {
  VertexFormat v = wideVertex();
  v.stride = 60;
  v.attributes[v.attributeCount++] = {GPGP_VERTEX_RULE, VK_FORMAT_R32_UINT, 52};
  return v;
}
/// 28 bytes, four of which no attribute covers.
VertexFormat narrowVertex() {
  VertexFormat v{};
  v.indexType = VK_INDEX_TYPE_UINT16;
  v.stride = 28;
  v.attributeCount = 4;
  v.attributes[0] = {GPGP_VERTEX_SEED, VK_FORMAT_R32_UINT, 0};
  v.attributes[1] = {GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 8};
  v.attributes[2] = {GPGP_VERTEX_NORMAL, VK_FORMAT_R8G8B8A8_SNORM, 20};
  v.attributes[3] = {GPGP_VERTEX_UV, VK_FORMAT_R8G8B8A8_UNORM, 24};
  return v;
}
/// 16 bytes, for many.
VertexFormat smallVertex() {
  VertexFormat v{};
  v.indexType = VK_INDEX_TYPE_UINT32;
  v.stride = 16;
  v.attributeCount = 2;
  v.attributes[0] = {GPGP_VERTEX_POSITION, VK_FORMAT_R32G32B32_SFLOAT, 0};
  v.attributes[1] = {GPGP_VERTEX_SEED, VK_FORMAT_R32_UINT, 12};
  return v;
}
uint32_t offsetOf(const VertexFormat& v, GpgpVertexSemantic semantic) {
  for (uint32_t i = 0; i < v.attributeCount; ++i)
    if (v.attributes[i].semantic == semantic) return v.attributes[i].offset / 4;
  return UINT32_MAX;
}

constexpr uint32_t kPoison = 0xbaadf00d;

struct Output {
  GpgpSpawnReport report = GPGP_SPAWN_REPORT_INIT;
  std::vector<uint32_t> vertices, indices; // with those that were not written
  std::vector<GpgpInstance> instances;
  std::vector<VkDrawIndexedIndirectCommand> draws;
  std::vector<uint32_t> needed;
  uint32_t count = 0;
};

/// What to give a record.
struct Wanted {
  GpgpSpawnFlags flags = 0;
  const VertexFormat* vertices = nullptr;
  uint32_t instances = 0, quads = 0; // capacities
  uint32_t indexQuads = UINT32_MAX;  // of indices, where not quads
  bool withDraws = true, withNeeded = false;
  std::vector<VkDrawIndexedIndirectCommand> draws; // empty: poison
};

struct VerticesTest : DeviceTest {
  GpgpSpawnerFlags flags = 0;
  uint32_t maxColliders = 0, maxTerminals = 0;

  /// For vertices, or, without a layout, for instances.
  GpgpSpawnerCreateInfo spawnerInfo(const GpgpVertexLayout* layout) const {
    GpgpSpawnerCreateInfo info = GPGP_SPAWNER_CREATE_INFO_INIT;
    info.base.queueFamily = device.graphics().family;
    info.flags = flags;
    info.vertices = layout ? stable(*layout) : nullptr;
    info.maxTerminals = maxTerminals;
    info.maxColliders = maxColliders;
    return info;
  }
  GpgpRecorder spawnerFor(const GpgpVertexLayout* layout) { return recorder(gpgpCreateSpawner, spawnerInfo(layout)); }
  void TearDown() override {
    DeviceTest::TearDown();
    for (const std::string& message : messages) ADD_FAILURE() << message;
  }
  GpgpAsset makeGrammar(const std::vector<uint32_t>& words, GpgpRecorder spawner) {
    GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    info.data = words.data();
    info.size = words.size() * 4;
    GpgpAsset grammar = nullptr;
    EXPECT_EQ(gpgpCreateGrammar(context, &info, &grammar), GPGP_SUCCESS);
    EXPECT_EQ(gpgpPrewarmGrammar(spawner, grammar), GPGP_SUCCESS);
    return grammar;
  }

  Output run(const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& axioms, const Wanted& wanted) {
    Output out;
    constexpr auto kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const GpgpRecorder spawner = spawnerFor(wanted.vertices);
    const GpgpAsset grammar = makeGrammar(words, spawner);
    const uint32_t buckets = words[kHeaderBuckets];
    const auto axiomBuffer = host::makeBuffer(device, axioms, kUsage);
    const auto poisoned = [&](VkDeviceSize bytes) {
      host::Buffer buffer(device, std::max<VkDeviceSize>(bytes, 16), kUsage);
      host::fill(device, buffer, kPoison);
      return buffer;
    };
    const VertexFormat format = wanted.vertices ? *wanted.vertices : VertexFormat{};
    GpgpVertexOutput output{};
    output.indexType = format.indexType;
    const uint32_t indexBytes = output.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
    const uint32_t indexQuads = wanted.indexQuads == UINT32_MAX ? wanted.quads : wanted.indexQuads;
    const auto instances = poisoned(VkDeviceSize(wanted.instances) * sizeof(GpgpInstance));
    const auto vertices = poisoned(VkDeviceSize(wanted.quads) * 4 * format.stride);
    const auto indices = poisoned(VkDeviceSize(indexQuads) * 6 * indexBytes);
    auto given = wanted.draws;
    if (given.empty()) given.assign(buckets, {kPoison, kPoison, kPoison, 77, kPoison});
    const auto draws = host::makeBuffer(device, given, kUsage);
    const auto needed = poisoned(4 * buckets), count = poisoned(4);
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    info.flags = wanted.flags;
    info.axioms = axiomBuffer.range();
    info.axiomCount = static_cast<uint32_t>(axioms.size());
    if (wanted.instances) info.instances = instances.range();
    if (wanted.quads) output.vertices = vertices.range();
    if (wanted.quads && indexQuads) output.indices = indices.range();
    if (wanted.vertices) info.vertices = &output;
    if (wanted.withDraws) info.draws = draws.range();
    if (wanted.withNeeded) info.needed = needed.range();
    info.count = count.range();
    const auto bounds = poisoned(buckets * sizeof(GpgpSpawnBounds));
    if (wanted.instances || wanted.quads) info.bounds = bounds.range();
    const GpgpFrame f = advance();
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordUpload(context, cmd, &f, 0, nullptr), GPGP_SUCCESS);
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawner, cmd, &f, &info), GPGP_SUCCESS);
    });
    advance();
    EXPECT_EQ(gpgpGetSpawnReport(spawner, &out.report), GPGP_SUCCESS);
    out.count = host::download<uint32_t>(device, count, 1)[0];
    out.vertices = host::download<uint32_t>(device, vertices, size_t(wanted.quads) * format.stride);
    const auto raw = host::download<uint32_t>(device, indices, size_t(indexQuads) * 6 * indexBytes / 4);
    for (const uint32_t word : raw) {
      if (indexBytes == 4)
        out.indices.push_back(word);
      else
        out.indices.insert(out.indices.end(), {word & 0xffff, word >> 16});
    }
    out.instances = host::download<GpgpInstance>(device, instances, wanted.instances);
    out.draws = host::download<VkDrawIndexedIndirectCommand>(device, draws, given.size());
    out.needed = host::download<uint32_t>(device, needed, buckets);
    if (info.bounds.buffer) {
      const spawn::Derivation cpu = spawn::derive(words, axioms);
      if (out.report.terminals == cpu.terminals && out.report.base.status == GPGP_SUCCESS)
        expectBounds(host::download<GpgpSpawnBounds>(device, bounds, buckets), cpu.instances);
    }
    gpgpDestroyAsset(grammar);
    return out;
  }
};

using Quads = std::vector<std::vector<uint32_t>>;
/// Quads in an order of their own: by what must be equal to the last bit, without the sign of zeros.
Quads quadsOf(const std::vector<uint32_t>& words, size_t first, size_t count, uint32_t strideWords) {
  Quads quads;
  for (size_t q = first; q < first + count; ++q) {
    quads.emplace_back(words.begin() + std::ptrdiff_t(q * 4 * strideWords),
                       words.begin() + std::ptrdiff_t((q + 1) * 4 * strideWords));
    for (uint32_t& word : quads.back())
      if (word == 0x80000000u) word = 0;
  }
  return quads;
}
void sortQuads(Quads& quads, const VertexFormat& layout) {
  const uint32_t seed = offsetOf(layout, GPGP_VERTEX_SEED), position = offsetOf(layout, GPGP_VERTEX_POSITION);
  const uint32_t axiom = offsetOf(layout, GPGP_VERTEX_AXIOM_ID), stride = layout.stride / 4;
  std::sort(quads.begin(), quads.end(), [&](const auto& a, const auto& b) {
    if (axiom != UINT32_MAX && a[axiom] != b[axiom]) return a[axiom] < b[axiom];
    if (a[seed] != b[seed]) return a[seed] < b[seed];
    for (uint32_t corner = 0; corner < 4; ++corner)
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t at = corner * stride + position + i;
        if (a[at] != b[at]) return a[at] < b[at];
      }
    return false;
  });
}
/// The same vertices in the same places: floats within 1e-4 of the largest coordinate, small formats within one step,
/// the rest equal.
void expectInOrder(const Quads& expected, const Quads& found, const VertexFormat& layout, const std::string& what) {
  ASSERT_EQ(expected.size(), found.size()) << what;
  for (size_t q = 0; q < expected.size(); ++q)
    for (uint32_t corner = 0; corner < 4; ++corner) {
      std::vector<bool> covered(layout.stride / 4, false);
      for (uint32_t a = 0; a < layout.attributeCount; ++a) {
        const GpgpVertexAttribute& attribute = layout.attributes[a];
        const uint32_t offset = attribute.offset / 4;
        const uint32_t *e = &expected[q][corner * layout.stride / 4 + offset],
                       *f = &found[q][corner * layout.stride / 4 + offset];
        const uint32_t floats = attribute.format == VK_FORMAT_R32G32B32_SFLOAT ? 3
                                : attribute.format == VK_FORMAT_R32G32_SFLOAT  ? 2
                                                                               : 0;
        for (uint32_t i = 0; i < std::max(floats, 1u); ++i) covered[offset + i] = true;
        for (uint32_t i = 0; i < floats; ++i) {
          const float x = std::bit_cast<float>(e[i]), y = std::bit_cast<float>(f[i]);
          ASSERT_NEAR(x, y, 1e-4f * std::max(1.0f, std::fabs(x))) << what << " quad " << q << " attribute " << a;
        }
        if (attribute.format == VK_FORMAT_R32_UINT) {
          ASSERT_EQ(*e, *f) << what << " quad " << q << " attribute " << a;
        }
        if (attribute.format == VK_FORMAT_R8G8B8A8_SNORM || attribute.format == VK_FORMAT_R8G8B8A8_UNORM)
          for (uint32_t shift = 0; shift < 32; shift += 8) {
            const bool sign = attribute.format == VK_FORMAT_R8G8B8A8_SNORM;
            const int x = int(*e >> shift & 255), y = int(*f >> shift & 255);
            ASSERT_NEAR(sign ? int(int8_t(x)) : x, sign ? int(int8_t(y)) : y, 1) << what << " attribute " << a;
          }
      }
      for (size_t w = 0; w < covered.size(); ++w)
        if (!covered[w]) {
          ASSERT_EQ(found[q][corner * layout.stride / 4 + w], 0u) << what;
        }
    }
}
/// The same in any order.
void expectEqual(Quads expected, Quads found, const VertexFormat& layout, const std::string& what) {
  sortQuads(expected, layout);
  sortQuads(found, layout);
  expectInOrder(expected, found, layout, what);
}
/// The pattern in [first, first + count) quads; relative: to the first of them.
void expectIndices(const Output& out, size_t first, size_t count, bool relative) {
  for (size_t i = 6 * first; i < 6 * (first + count); ++i) {
    const uint32_t quad = uint32_t(i / 6 - (relative ? first : 0));
    static constexpr uint32_t kPattern[6] = {0, 1, 2, 0, 2, 3};
    ASSERT_EQ(out.indices[i], 4 * quad + kPattern[i % 6]) << i;
  }
}
/// Nothing from quad `first` on was touched, up to `end`.
void expectUntouched(const Output& out, size_t first, size_t end, const VertexFormat& layout) {
  for (size_t i = first * layout.stride; i < end * layout.stride; ++i) ASSERT_EQ(out.vertices[i], kPoison) << i;
  const uint32_t poison = layout.indexType == VK_INDEX_TYPE_UINT16 ? 0 : kPoison;
  for (size_t i = 6 * first; i < 6 * end; ++i)
    ASSERT_EQ(out.indices[i], poison ? poison : i % 2 ? kPoison >> 16 : kPoison & 0xffff) << i;
}

/// Axioms turned and moved; every third is mirrored.
std::vector<GpgpAxiom> axioms(uint32_t count, float x, float y, float z) {
  std::vector<GpgpAxiom> result;
  for (uint32_t i = 0; i < count; ++i) {
    GpgpAxiom axiom = makeAxiom(x, y, z, i * 2654435761u + 1, 100 + i);
    const float angle = float(i) * 0.7f, side = i % 3 == 2 ? -1.0f : 1.0f;
    axiom.transform[0] = std::cos(angle) * side;
    axiom.transform[2] = std::sin(angle);
    axiom.transform[8] = -std::sin(angle) * side;
    axiom.transform[10] = std::cos(angle);
    axiom.transform[3] = float(i % 16) * 50;
    result.push_back(axiom);
  }
  return result;
}

spawn::Derivation evaluate(const std::vector<uint32_t>& words, const std::vector<GpgpAxiom>& all,
                           const VertexFormat& output) {
  const auto layout = spawn::layoutOf(output);
  EXPECT_TRUE(layout);
  spawn::DeriveOptions options;
  options.vertices = &*layout;
  return spawn::derive(words, all, options);
}
uint32_t sum(const std::vector<uint32_t>& values) { return std::accumulate(values.begin(), values.end(), 0u); }

void checkAll(VerticesTest& test, const std::string& what, const std::vector<uint32_t>& words,
              const std::vector<GpgpAxiom>& all, const VertexFormat& layout) {
  const spawn::Derivation cpu = evaluate(words, all, layout);
  const uint32_t quads = sum(cpu.quads);
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = quads + 7;
  const Output out = test.run(words, all, wanted);
  EXPECT_EQ(out.report.base.status, GPGP_SUCCESS) << what;
  ASSERT_EQ(out.report.terminals, cpu.terminals) << what;
  ASSERT_EQ(out.report.keyHash[0], cpu.keyHash[0]) << what;
  ASSERT_EQ(out.report.vertices, 4 * quads) << what;
  ASSERT_EQ(out.report.verticesWritten, 4 * quads) << what;
  EXPECT_EQ(out.count, 6 * quads);
  EXPECT_EQ(out.draws[0].indexCount, 6 * quads);
  EXPECT_EQ(out.draws[0].instanceCount, kPoison);
  EXPECT_EQ(out.draws[0].vertexOffset, 77);
  const uint32_t stride = layout.stride / 4;
  expectEqual(quadsOf(cpu.vertexWords, 0, quads, stride), quadsOf(out.vertices, 0, quads, stride), layout, what);
  expectIndices(out, 0, quads, false);
  expectUntouched(out, quads, quads + 7, layout);
}

TEST_F(VerticesTest, OwnGrammarsEqualTheEvaluator) {
  for (const std::string& name : ownGrammarNames()) {
    checkAll(*this, name, bake(ownGrammar(name)), axioms(3, 12, 16, 10), fullVertex());
    if (HasFatalFailure()) return;
  }
}

TEST_F(VerticesTest, ShapesOfAllKindsInOtherFormats) {
  const auto words = bake("axiom Quad A; terminal T (0,0); A = Replicate() { T | Extrude(2) P | B };\n"
                          "B = SetAsDynamicConvexPolygon((-0.5,-0.5),(0.5,-0.4),(0.3,0.5),(-0.2,0.5),(-0.4,0.2)) "
                          "Replicate() { T | Extrude(3) P };\n"
                          "P = Replicate() { T | CompSplit() T };\n");
  checkAll(*this, "narrow", words, axioms(40, 3, 4, 0), narrowVertex());
  checkAll(*this, "small", words, axioms(40, 3, 4, 0), smallVertex());
  VertexFormat half = wideVertex();
  half.indexType = VK_INDEX_TYPE_UINT16;
  checkAll(*this, "wide, 16 bits", words, axioms(40, 3, 4, 0), half);
  checkAll(*this, "concave ones", shapesGrammar(), axioms(40, 3, 4, 2), wideVertex());
}

TEST_F(VerticesTest, HalfPrecisionPositionsAndUnsignedNormals) {
  VertexFormat layout{};
  layout.indexType = VK_INDEX_TYPE_UINT32;
  layout.stride = 12;
  layout.attributeCount = 2;
  layout.attributes[0] = {GPGP_VERTEX_POSITION, VK_FORMAT_R16G16B16A16_SFLOAT, 0};
  layout.attributes[1] = {GPGP_VERTEX_NORMAL, VK_FORMAT_R8G8B8A8_UNORM, 8};
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = 6;
  const Output out = run(bake("axiom Box A; terminal T (0,0); A = T;"), {makeAxiom(2, 4, 8)}, wanted);
  const uint32_t* top = out.vertices.data(); // its first face: (-1, 2, 4), (1, 2, 4), (1, 2, -4), (-1, 2, -4)
  const uint32_t expected[4][2] = {
      {0x4000bc00, 0x3c004400}, {0x40003c00, 0x3c004400}, {0x40003c00, 0x3c00c400}, {0x4000bc00, 0x3c00c400}};
  for (uint32_t corner = 0; corner < 4; ++corner) {
    EXPECT_EQ(top[3 * corner], expected[corner][0]);
    EXPECT_EQ(top[3 * corner + 1], expected[corner][1]);
    EXPECT_NEAR(double(top[3 * corner + 2] & 255), 127.5, 0.6);
    EXPECT_EQ(top[3 * corner + 2] >> 8 & 255, 255u);
  }
}

TEST_F(VerticesTest, HundredThousandBoxesEqualTheEvaluator) {
  const auto words = bake("axiom Box A; terminal T (1, 0);\n"
                          "A = Translate(1, 0, 0) Rotate(0, 10, 0) Repeat(X, 0.5, ADJUST_TO_FILL) "
                          "SubDiv(Y) { -1: T | -1: T };\n");
  const auto all = axioms(500, 50, 1, 1);
  ASSERT_EQ(spawn::derive(words, all).terminals, 100000u);
  checkAll(*this, "100 000 boxes", words, all, smallVertex());
}

/// One of the own grammars with a kernel for it.
std::vector<uint32_t> bakeWithKernel(const std::string& name) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  const std::string text = ownGrammar(name);
  source.text = text.data();
  source.size = text.size();
  source.flags = GPGP_COMPILE_KERNEL;
  GpgpBlob blob{};
  EXPECT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
  std::vector<uint32_t> words(blob.size / 4);
  std::memcpy(words.data(), blob.data, blob.size);
  gpgpFreeBlob(&blob);
  EXPECT_GT(words.size(), words[kHeaderWords]);
  return words;
}

TEST_F(VerticesTest, GeneratedKernelsWriteTheSame) {
  VertexFormat layout = fullVertex();
  checkAll(*this, "building", bakeWithKernel("building.pga"), axioms(5, 12, 16, 10), layout);
  layout.stride = 64; // which is not staged
  checkAll(*this, "building", bakeWithKernel("building.pga"), axioms(5, 12, 16, 10), layout);
}

TEST_F(VerticesTest, WithCollidersToo) {
  maxColliders = 1000;
  const auto words = bake("axiom Box A; terminal T (1,0); terminal U (1,1);\n"
                          "A = Scale(60,1,3) Repeat(X,6,ADJUST_TO_FILL) Collider(1) Replicate() { T | Repeat(Y,0.25,"
                          "ADJUST_TO_FILL) Scale(-1.5,-1,-1) IfCollides(1) { U | T } };\n");
  const auto all = axioms(30, 1, 1, 1); // some pieces reach into the next one, and some axioms into others
  EXPECT_GT(spawn::derive(words, all).buckets[1], 500u);
  checkAll(*this, "colliders", words, all, wideVertex());
}

TEST_F(VerticesTest, WhatDoesNotFitIsCountedAndNeverTorn) {
  // Boxes and quads with seeds of their own, so that quads can be told apart by terminal.
  const auto words =
      bake("axiom Box A; terminal T (0,0); A = Repeat(X,0.1,ADJUST_TO_FILL) Repeat(Y,0.1,ADJUST_TO_FILL) B;"
           "B = RandomRule(ShapeSeed()) { 0.5: T | 0.5: CompSplit() { T | T | Discard() } };");
  const auto all = axioms(3, 3, 2, 1);
  VertexFormat layout = wideVertex();
  const auto cpu = evaluate(words, all, layout);
  const uint32_t quads = sum(cpu.quads);
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> whole; // axiom and seed: quads
  for (size_t i = 0; i < cpu.instances.size(); ++i)
    whole[{cpu.instances[i].axiomId, cpu.instances[i].seed}] += cpu.quads[i];
  for (const uint32_t capacity : {1001u, 1002u, 1003u, 1004u, 1005u, 1006u, 3u, quads - 1}) {
    SCOPED_TRACE(capacity);
    Wanted wanted;
    wanted.vertices = &layout;
    wanted.quads = quads;
    wanted.indexQuads = capacity;
    const Output out = run(words, all, wanted);
    const uint32_t written = out.report.verticesWritten / 4;
    EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_EQ(out.report.vertices, 4 * quads);
    EXPECT_LE(written, capacity);
    EXPECT_GT(written + 6, capacity);
    EXPECT_EQ(out.draws[0].indexCount, 6 * written);
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> found;
    for (uint32_t q = 0; q < written; ++q) ++found[{out.vertices[q * 48 + 9], out.vertices[q * 48 + 11]}];
    for (const auto& [key, count] : found) {
      ASSERT_EQ(whole.count(key), 1u);
      EXPECT_EQ(whole[key], count);
    }
    expectIndices(out, 0, written, false);
    for (size_t i = 6 * written; i < 6 * capacity; ++i) ASSERT_EQ(out.indices[i], kPoison);
    for (size_t i = written * 48; i < out.vertices.size(); ++i)
      ASSERT_EQ(out.vertices[i], kPoison) << i << " of " << written * 48;
  }
}

TEST_F(VerticesTest, SixteenBitIndicesEndWhereTheyReach) {
  const auto words = bake("axiom Box A; terminal T (0,0); A = Repeat(X,1,ADJUST_TO_FILL) T;");
  VertexFormat layout = smallVertex();
  layout.indexType = VK_INDEX_TYPE_UINT16;
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = 20000;
  const Output out = run(words, {makeAxiom(3000, 1, 1)}, wanted);
  EXPECT_EQ(out.report.vertices, 72000u);
  EXPECT_EQ(out.report.verticesWritten, 4u * 6u * (16383u / 6u));
  EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
  expectIndices(out, 0, out.report.verticesWritten / 4, false);
}

TEST_F(VerticesTest, NoVerticesWithoutAxioms) {
  const VertexFormat layout = wideVertex();
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = 10;
  const Output out = run(bake(ownGrammar("building.pga")), {}, wanted);
  EXPECT_EQ(out.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(out.draws[0].indexCount, 0u);
  expectUntouched(out, 0, 10, layout);
}

// ---------------------------------------------------------------- in order

/// The evaluator's terminals in order of bucket and path key, and where each one's quads begin.
struct InOrder {
  Quads quads;
  std::vector<uint32_t> starts, buckets; // a start more than buckets
};
InOrder inOrder(const spawn::Derivation& cpu, uint32_t strideWords) {
  std::vector<size_t> order(cpu.instances.size()), firsts;
  std::iota(order.begin(), order.end(), size_t{0});
  size_t first = 0;
  for (const uint32_t quads : cpu.quads) {
    firsts.push_back(first);
    first += quads;
  }
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    const GpgpInstance &x = cpu.instances[a], &y = cpu.instances[b];
    return std::tie(x.bucket, x.key[0], x.key[1]) < std::tie(y.bucket, y.key[0], y.key[1]);
  });
  InOrder result;
  for (const size_t i : order) {
    result.starts.push_back(static_cast<uint32_t>(result.quads.size()));
    result.buckets.push_back(cpu.instances[i].bucket);
    const Quads own = quadsOf(cpu.vertexWords, firsts[i], cpu.quads[i], strideWords);
    result.quads.insert(result.quads.end(), own.begin(), own.end());
  }
  result.starts.push_back(static_cast<uint32_t>(result.quads.size()));
  return result;
}
Quads firstOf(const Quads& quads, size_t begin, size_t end) {
  return {quads.begin() + std::ptrdiff_t(begin), quads.begin() + std::ptrdiff_t(end)};
}

TEST_F(VerticesTest, OrderedVerticesLieInOrder) {
  flags = GPGP_SPAWNER_ORDERED;
  for (VertexFormat layout : {wideVertex(), narrowVertex()})
    for (const std::string& name : ownGrammarNames()) {
      SCOPED_TRACE(name);
      const auto words = bake(ownGrammar(name));
      auto all = axioms(3, 12, 16, 10);
      const spawn::Derivation cpu = evaluate(words, all, layout);
      const InOrder expected = inOrder(cpu, layout.stride / 4);
      const uint32_t quads = sum(cpu.quads);
      layout.indexType = VK_INDEX_TYPE_UINT32; // reaches all
      Wanted wanted;
      wanted.vertices = &layout;
      wanted.quads = quads + 7;
      const Output out = run(words, all, wanted);
      EXPECT_EQ(out.report.base.status, GPGP_SUCCESS);
      ASSERT_EQ(out.report.terminals, cpu.terminals);
      ASSERT_EQ(out.report.keyHash[0], cpu.keyHash[0]);
      ASSERT_EQ(out.report.vertices, 4 * quads);
      ASSERT_EQ(out.report.verticesWritten, 4 * quads);
      EXPECT_EQ(out.count, 6 * quads);
      EXPECT_EQ(out.draws[0].indexCount, 6 * quads);
      EXPECT_EQ(out.draws[0].vertexOffset, 77);
      expectInOrder(expected.quads, quadsOf(out.vertices, 0, quads, layout.stride / 4), layout, name);
      expectIndices(out, 0, quads, false);
      expectUntouched(out, quads, quads + 7, layout);
      std::reverse(all.begin(), all.end()); // does not matter
      ASSERT_EQ(run(words, all, wanted).vertices, out.vertices);
      if (HasFatalFailure()) return;
    }
}

TEST_F(VerticesTest, OrderedVerticesDependOnNoSchedule) {
  flags = GPGP_SPAWNER_ORDERED;
  const VertexFormat layout = wideVertex();
  const auto words = bake(ownGrammar("building.pga"));
  const auto all = axioms(40, 12, 16, 10);
  const InOrder expected = inOrder(evaluate(words, all, layout), layout.stride / 4);
  const uint32_t quads = expected.starts.back();
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = quads;
  const Output out = run(words, all, wanted);
  expectInOrder(expected.quads, quadsOf(out.vertices, 0, quads, layout.stride / 4), layout, "interpreter");
  for (int again = 0; again < 3; ++again) {
    const Output other = run(words, all, wanted);
    ASSERT_EQ(other.vertices, out.vertices);
    ASSERT_EQ(other.indices, out.indices);
  }
  auto shuffled = all; // other workgroups take other shapes
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  ASSERT_EQ(run(words, shuffled, wanted).vertices, out.vertices);
  const Output kernel = run(bakeWithKernel("building.pga"), all, wanted); // equal but for rounding
  expectInOrder(expected.quads, quadsOf(kernel.vertices, 0, quads, layout.stride / 4), layout, "a kernel");
  ASSERT_EQ(kernel.indices, out.indices);
}

TEST_F(VerticesTest, OrderedVerticesSurviveFromTheFront) {
  flags = GPGP_SPAWNER_ORDERED;
  const auto words =
      bake("axiom Box A; terminal T (0,0); A = Repeat(X,0.1,ADJUST_TO_FILL) Repeat(Y,0.1,ADJUST_TO_FILL) B;"
           "B = RandomRule(ShapeSeed()) { 0.5: T | 0.5: CompSplit() { T | T | Discard() } };");
  const auto all = axioms(3, 3, 2, 1);
  const VertexFormat layout = wideVertex();
  const InOrder expected = inOrder(evaluate(words, all, layout), 12);
  const uint32_t quads = expected.starts.back();
  for (const uint32_t capacity : {1001u, 1002u, 1003u, 1004u, 1005u, 1006u, 3u, 64u, quads - 1}) {
    SCOPED_TRACE(capacity);
    // The terminals up to the first one that does not fit.
    const uint32_t written = *(std::upper_bound(expected.starts.begin(), expected.starts.end(), capacity) - 1);
    for (const bool ofIndices : {false, true}) { // which buffer is short
      Wanted wanted;
      wanted.vertices = &layout;
      wanted.quads = ofIndices ? quads : capacity;
      wanted.indexQuads = ofIndices ? capacity : quads;
      const Output out = run(words, all, wanted);
      EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
      EXPECT_EQ(out.report.vertices, 4 * quads);
      ASSERT_EQ(out.report.verticesWritten, 4 * written);
      EXPECT_EQ(out.draws[0].indexCount, 6 * written);
      expectInOrder(firstOf(expected.quads, 0, written), quadsOf(out.vertices, 0, written, 12), layout, "front");
      expectIndices(out, 0, written, false);
      for (size_t i = 6 * written; i < out.indices.size(); ++i) ASSERT_EQ(out.indices[i], kPoison);
      for (size_t i = written * 48; i < out.vertices.size(); ++i) ASSERT_EQ(out.vertices[i], kPoison);
    }
  }
}

TEST_F(VerticesTest, OrderedVerticesFillTheirRegionsFromTheFront) {
  flags = GPGP_SPAWNER_ORDERED;
  const auto words = bake("axiom Box A; terminal S (0,0); terminal T (0,1); terminal U (0,2);"
                          "A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { S | CompSplit() T | T };");
  const std::vector<GpgpAxiom> all{makeAxiom(100, 1, 1, 5), makeAxiom(7, 1, 1, 6, 1)};
  for (VertexFormat layout : {wideVertex(), narrowVertex()}) {
    const uint32_t stride = layout.stride / 4;
    const InOrder expected = inOrder(evaluate(words, all, layout), stride);
    Wanted wanted;
    wanted.vertices = &layout;
    wanted.flags = GPGP_SPAWN_REGIONS;
    wanted.withNeeded = true;
    wanted.quads = 1000;
    wanted.draws = {{1, 2, 6 * 4, 4, 5}, {1, 2, 6 * 303, 4, 5}, {1, 2, 6 * 990, 4, 5}};
    const Output out = run(words, all, wanted);
    EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
    EXPECT_EQ(out.needed, (std::vector<uint32_t>{107 * 36, 107 * 72, 0}));
    const uint32_t starts[4] = {4, 303, 990, 1000};
    uint32_t all3 = 0;
    for (uint32_t bucket = 0; bucket < 3; ++bucket) {
      SCOPED_TRACE(bucket);
      const size_t first =
          size_t(std::lower_bound(expected.buckets.begin(), expected.buckets.end(), bucket) - expected.buckets.begin());
      size_t last = first;
      const uint32_t capacity = starts[bucket + 1] - starts[bucket];
      while (last < expected.buckets.size() && expected.buckets[last] == bucket &&
             expected.starts[last + 1] - expected.starts[first] <= capacity)
        ++last;
      const uint32_t count = expected.starts[last] - expected.starts[first];
      ASSERT_EQ(out.draws[bucket].indexCount, 6 * count);
      EXPECT_EQ(out.draws[bucket].vertexOffset, int32_t(4 * starts[bucket]));
      expectInOrder(firstOf(expected.quads, expected.starts[first], expected.starts[last]),
                    quadsOf(out.vertices, starts[bucket], count, stride), layout, "region");
      expectIndices(out, starts[bucket], count, true);
      expectUntouched(out, starts[bucket] + count, starts[bucket + 1], layout);
      all3 += count;
    }
    EXPECT_EQ(out.report.verticesWritten, 4 * all3);
    EXPECT_EQ(out.count, 6 * all3);
    EXPECT_EQ(run(words, all, wanted).vertices, out.vertices);
  }
}

TEST_F(VerticesTest, ManyOrderedVerticesAndFewRecords) {
  flags = GPGP_SPAWNER_ORDERED;
  const VertexFormat layout = smallVertex();
  const auto words = bake("axiom Box A; terminal S (1, 0); terminal T (1, 1);\n"
                          "A = Repeat(X, 0.5, ADJUST_TO_FILL) SubDiv(Y) { -1: T | -1: CompSplit() { S | T | S } };\n");
  const auto all = axioms(300, 50, 1, 1);
  const InOrder expected = inOrder(evaluate(words, all, layout), 4);
  const uint32_t quads = expected.starts.back();
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = quads;
  const Output out = run(words, all, wanted);
  ASSERT_EQ(out.report.verticesWritten, 4 * quads);
  expectInOrder(expected.quads, quadsOf(out.vertices, 0, quads, 4), layout, "many");
  // Records for a part only: which ones is not said, but what is written has no holes and the rest is counted.
  maxTerminals = 1000;
  const Output few = run(words, all, wanted);
  EXPECT_EQ(few.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(few.report.terminals, expected.buckets.size());
  EXPECT_EQ(few.report.vertices, 4 * quads);
  EXPECT_GE(few.report.verticesWritten, 4000u);
  EXPECT_LE(few.report.verticesWritten, 24000u);
  expectIndices(few, 0, few.report.verticesWritten / 4, false);
  expectUntouched(few, few.report.verticesWritten / 4, quads, layout);
  maxTerminals = 0;
  EXPECT_EQ(run(words, {}, wanted).report.vertices, 0u);
}

TEST_F(VerticesTest, OrderedVerticesOfEqualKeysLieByAxiom) {
  flags = GPGP_SPAWNER_ORDERED;
  const VertexFormat layout = wideVertex();
  const auto words = bake("axiom Box A; terminal T (1, 0); A = Repeat(X, 1, ADJUST_TO_FILL) T;\n");
  std::vector<GpgpAxiom> alike(300, makeAxiom(3, 1, 1, 7, 7));
  for (size_t i = 0; i < alike.size(); ++i) alike[i].transform[3] = static_cast<float>(i);
  const InOrder expected = inOrder(evaluate(words, alike, layout), 12);
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = expected.starts.back();
  const Output out = run(words, alike, wanted);
  expectInOrder(expected.quads, quadsOf(out.vertices, 0, wanted.quads, 12), layout, "alike");
}

// ---------------------------------------------------------------- regions, and counting first

TEST_F(VerticesTest, CountThenEmitGivesTheSortedInstances) {
  for (const char* name : {"building.pga", "tree.pga", "sponge.pga"}) {
    SCOPED_TRACE(name);
    const auto words = bake(ownGrammar(name));
    const auto all = axioms(5, 12, 16, 10);
    const auto cpu = spawn::derive(words, all);
    const uint32_t total = uint32_t(cpu.terminals), buckets = words[kHeaderBuckets];
    Wanted count;
    count.withNeeded = true;
    const Output counted = run(words, all, count);
    EXPECT_EQ(counted.report.base.status, GPGP_SUCCESS);
    EXPECT_EQ(counted.report.terminals, total);
    EXPECT_EQ(counted.report.instancesWritten, 0u);
    EXPECT_EQ(counted.count, 0u);
    EXPECT_EQ(counted.needed, cpu.buckets);
    Wanted emit;
    emit.flags = GPGP_SPAWN_REGIONS;
    emit.instances = total;
    emit.draws = counted.draws;
    const Output emitted = run(words, all, emit);
    Wanted sort;
    sort.instances = total;
    const Output sorted = run(words, all, sort);
    EXPECT_EQ(emitted.report.base.status, GPGP_SUCCESS);
    EXPECT_EQ(emitted.count, total);
    const auto less = [](const GpgpInstance& a, const GpgpInstance& b) {
      return std::memcmp(a.key, b.key, 8) ? std::memcmp(a.key, b.key, 8) < 0 : std::memcmp(&a, &b, sizeof a) < 0;
    };
    auto a = emitted.instances, b = sorted.instances;
    for (uint32_t bucket = 0; bucket < buckets; ++bucket) {
      const auto &one = emitted.draws[bucket], &other = sorted.draws[bucket];
      EXPECT_EQ(one.firstInstance, other.firstInstance);
      EXPECT_EQ(one.instanceCount, other.instanceCount);
      EXPECT_EQ(one.indexCount, kPoison);
      std::sort(a.begin() + one.firstInstance, a.begin() + one.firstInstance + one.instanceCount, less);
      std::sort(b.begin() + one.firstInstance, b.begin() + one.firstInstance + one.instanceCount, less);
    }
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
  }
}

TEST_F(VerticesTest, InstancesBeyondTheirRegionAreCounted) {
  const auto words = bake("axiom Box A; terminal S (1,0); terminal T (1,1); terminal U (1,2);"
                          "A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { S | T | T | U };");
  Wanted wanted;
  wanted.flags = GPGP_SPAWN_REGIONS;
  wanted.withNeeded = true;
  wanted.instances = 1000;
  wanted.draws = {{1, 2, 3, 4, 10}, {1, 2, 3, 4, 200}, {1, 2, 3, 4, 500}};
  const Output out = run(words, {makeAxiom(300, 1, 1, 5)}, wanted);
  EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(out.report.terminals, 1200u);
  EXPECT_EQ(out.report.instancesWritten, 190u + 300u + 300u);
  EXPECT_EQ(out.needed, (std::vector<uint32_t>{300, 600, 300}));
  const uint32_t counts[3] = {190, 300, 300};
  std::vector<int> owner(1000, -1);
  for (int bucket = 0; bucket < 3; ++bucket) {
    const auto& draw = out.draws[size_t(bucket)];
    EXPECT_EQ(draw.firstInstance, wanted.draws[size_t(bucket)].firstInstance);
    EXPECT_EQ(draw.instanceCount, counts[bucket]);
    EXPECT_EQ(draw.firstIndex, 3u);
    EXPECT_EQ(draw.vertexOffset, 4);
    for (uint32_t i = 0; i < draw.instanceCount; ++i) owner[draw.firstInstance + i] = bucket;
  }
  for (size_t i = 0; i < 1000; ++i) {
    ASSERT_EQ(out.instances[i].bucket, owner[i] < 0 ? kPoison : uint32_t(owner[i])) << i;
  }
}

TEST_F(VerticesTest, BoundsLeaveOutTheRoomBetweenRegions) {
  const auto words = bake("axiom Box A; terminal S (1,0); terminal T (1,1); terminal U (1,2);"
                          "A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { S | T | T | Translate(0,7,0) U };");
  Wanted wanted;
  wanted.flags = GPGP_SPAWN_REGIONS;
  wanted.instances = 2000;
  wanted.draws = {{1, 2, 3, 4, 10}, {1, 2, 3, 4, 400}, {1, 2, 3, 4, 1500}};
  const Output out = run(words, {makeAxiom(300, 1, 1, 5)}, wanted); // compares the boxes
  EXPECT_EQ(out.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(out.count, 1200u);
}

TEST_F(VerticesTest, OrderedInstancesFillTheirRegionsFromTheFront) {
  flags = GPGP_SPAWNER_ORDERED;
  const auto words = bake("axiom Box A; terminal S (1,0); terminal T (1,1); terminal U (1,2);"
                          "A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { S | T | T | U };");
  const std::vector<GpgpAxiom> all{makeAxiom(300, 1, 1, 5)};
  std::vector<std::vector<uint64_t>> keys(3);
  for (const GpgpInstance& i : spawn::derive(words, all).instances)
    keys[i.bucket].push_back(uint64_t(i.key[0]) << 32 | i.key[1]);
  for (auto& bucket : keys) std::sort(bucket.begin(), bucket.end());
  Wanted wanted;
  wanted.flags = GPGP_SPAWN_REGIONS;
  wanted.withNeeded = true;
  wanted.instances = 1000;
  wanted.draws = {{1, 2, 3, 4, 10}, {1, 2, 3, 4, 200}, {1, 2, 3, 4, 500}};
  const Output out = run(words, all, wanted);
  EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(out.needed, (std::vector<uint32_t>{300, 600, 300}));
  const uint32_t counts[3] = {190, 300, 300};
  for (uint32_t bucket = 0; bucket < 3; ++bucket) {
    EXPECT_EQ(out.draws[bucket].instanceCount, counts[bucket]);
    for (uint32_t i = 0; i < counts[bucket]; ++i) {
      const GpgpInstance& instance = out.instances[wanted.draws[bucket].firstInstance + i];
      ASSERT_EQ(instance.bucket, bucket) << i;
      ASSERT_EQ(uint64_t(instance.key[0]) << 32 | instance.key[1], keys[bucket][i]) << i;
    }
  }
  for (const uint32_t i : {0u, 9u, 800u, 999u}) EXPECT_EQ(out.instances[i].bucket, kPoison) << i;
}

TEST_F(VerticesTest, CountThenEmitGivesEachBucketItsVertices) {
  for (const VertexFormat& layout : {wideVertex(), narrowVertex()}) {
    const auto words = bake(ownGrammar("building.pga"));
    const auto all = axioms(2, 12, 16, 10);
    const auto cpu = evaluate(words, all, layout);
    const uint32_t total = sum(cpu.quads), buckets = words[kHeaderBuckets], stride = layout.stride / 4;
    std::vector<Quads> expected(buckets);
    for (size_t i = 0, first = 0; i < cpu.instances.size(); first += cpu.quads[i++]) {
      const Quads own = quadsOf(cpu.vertexWords, first, cpu.quads[i], stride);
      auto& list = expected[cpu.instances[i].bucket];
      list.insert(list.end(), own.begin(), own.end());
    }
    Wanted count;
    count.vertices = &layout;
    const Output counted = run(words, all, count);
    EXPECT_EQ(counted.report.vertices, 4 * total);
    EXPECT_EQ(counted.report.verticesWritten, 0u);
    Wanted emit = count;
    emit.flags = GPGP_SPAWN_REGIONS;
    emit.quads = total;
    emit.draws = counted.draws;
    const Output out = run(words, all, emit);
    EXPECT_EQ(out.report.base.status, GPGP_SUCCESS);
    EXPECT_EQ(out.report.verticesWritten, 4 * total);
    uint32_t first = 0;
    for (uint32_t bucket = 0; bucket < buckets; ++bucket) {
      const auto& draw = out.draws[bucket];
      ASSERT_EQ(draw.firstIndex, 6 * first);
      ASSERT_EQ(draw.vertexOffset, int32_t(4 * first));
      ASSERT_EQ(draw.indexCount, 6 * expected[bucket].size());
      ASSERT_EQ(draw.indexCount, counted.draws[bucket].indexCount);
      ASSERT_EQ(draw.firstInstance, kPoison);
      expectEqual(expected[bucket], quadsOf(out.vertices, first, draw.indexCount / 6, stride), layout, "bucket");
      expectIndices(out, first, draw.indexCount / 6, true);
      first += draw.indexCount / 6;
    }
    ASSERT_EQ(first, total);
  }
}

TEST_F(VerticesTest, VerticesBeyondTheirRegionAreCounted) {
  const auto words = bake("axiom Box A; terminal S (0,0); terminal T (0,1);"
                          "A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { S | CompSplit() T | T };");
  const VertexFormat layout = wideVertex();
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.flags = GPGP_SPAWN_REGIONS;
  wanted.withNeeded = true;
  wanted.quads = 1000;
  wanted.draws = {{1, 2, 6 * 4, 4, 5}, {1, 2, 6 * 303, 4, 5}};
  const Output out = run(words, {makeAxiom(100, 1, 1, 5)}, wanted);
  EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(out.needed, (std::vector<uint32_t>{3600, 7200}));
  EXPECT_EQ(out.draws[0].indexCount, 6u * 294u); // 49 boxes; 299 quads would fit
  EXPECT_GT(out.draws[1].indexCount, 6u * (697 - 6));
  EXPECT_LE(out.draws[1].indexCount, 6u * 697);
  EXPECT_EQ(out.report.verticesWritten, 4 * (out.draws[0].indexCount + out.draws[1].indexCount) / 6);
  for (uint32_t bucket = 0; bucket < 2; ++bucket) {
    const uint32_t first = out.draws[bucket].firstIndex / 6, count = out.draws[bucket].indexCount / 6;
    EXPECT_EQ(out.draws[bucket].vertexOffset, int32_t(4 * first));
    for (uint32_t v = 4 * first; v < 4 * (first + count); ++v) ASSERT_EQ(out.vertices[v * 12 + 8], bucket);
    expectIndices(out, first, count, true);
    expectUntouched(out, first + count, bucket ? 1000 : 303, layout);
  }
  expectUntouched(out, 0, 4, layout);
}

TEST_F(VerticesTest, BadOutputsAreRefusedWithAReason) {
  const auto words = bake(ownGrammar("building.pga"));
  const VertexFormat format = wideVertex();
  const GpgpRecorder spawners[2] = {spawnerFor(nullptr), spawnerFor(&format)};
  const GpgpAsset grammar = makeGrammar(words, spawners[0]);
  const host::Buffer buffer(device, 65536, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const GpgpFrame f = advance();
  const auto refused = [&](uint32_t spawner, auto change) {
    GpgpVertexOutput output{buffer.range(), buffer.range(), VK_INDEX_TYPE_UINT32};
    GpgpSpawnInfo info = GPGP_SPAWN_INFO_INIT;
    info.grammar = grammar;
    if (spawner)
      info.vertices = &output;
    else
      info.instances = buffer.range();
    change(info, output);
    device.submitAndWait([&](VkCommandBuffer cmd) {
      EXPECT_EQ(gpgpRecordPrepareSpawn(spawners[spawner], cmd, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
    });
    const std::string text = lastMessage().substr(lastMessage().find(": ") + 2);
    messages.clear();
    return text;
  };
  EXPECT_EQ(refused(1, [](auto& i, auto&) { i.vertices = nullptr; }),
            "vertices is NULL; the spawner was made for vertices");
  EXPECT_EQ(refused(0, [](auto& i, auto& v) { i.vertices = &v; }),
            "vertices is set; the spawner was made for instances");
  EXPECT_EQ(refused(0, [](auto& i, auto&) { i.instances = {}; }),
            "instances.buffer is NULL, and draws.buffer, where a recording could count");
  EXPECT_EQ(refused(0, [](auto& i, auto&) { i.flags = GPGP_SPAWN_REGIONS; }),
            "GPGP_SPAWN_REGIONS is set, draws.buffer is NULL");
  EXPECT_EQ(refused(0, [&](auto& i, auto&) { i.needed = buffer.range(); }),
            "needed.buffer is set, but there are no regions to fill");
  EXPECT_EQ(refused(1, [](auto&, auto& v) { v.indexType = VK_INDEX_TYPE_NONE_KHR; }),
            "vertices->indexType is neither UINT16 nor UINT32");
  EXPECT_EQ(refused(0,
                    [&](auto& i, auto&) {
                      i.axiomCounter = GpgpBuffer{buffer.handle(), 0, 2, {}, {}};
                    }),
            "axiomCounter.size is below 4 bytes");
  EXPECT_EQ(refused(0,
                    [&](auto& i, auto&) {
                      i.axiomCounter = buffer.range();
                      i.axiomCount = 0;
                    }),
            "axiomCounter.buffer is set, and axiomCount, the most, is 0");
  EXPECT_EQ(refused(0,
                    [&](auto& i, auto&) {
                      i.bounds = GpgpBuffer{buffer.handle(), 0, 20, {}, {}};
                    }),
            "bounds.size is 20 bytes, the grammar's 14 buckets need 336");
  EXPECT_EQ(refused(0,
                    [&](auto& i, auto&) {
                      i.bounds = i.draws = buffer.range();
                      i.instances = {};
                    }),
            "bounds.buffer is set, but the recording only counts");
  gpgpDestroyAsset(grammar);
}

TEST_F(VerticesTest, BadLayoutsAreRefusedWithAReason) {
  const auto refusedLayout = [&](auto change) {
    VertexFormat layout = wideVertex();
    change(layout);
    GpgpSpawnerCreateInfo info = spawnerInfo(nullptr);
    info.vertices = &layout;
    GpgpRecorder spawner = nullptr;
    EXPECT_EQ(gpgpCreateSpawner(context, &info, &spawner), GPGP_ERROR_INVALID_ARGUMENT);
    const std::string text = lastMessage().substr(lastMessage().find(": ") + 2);
    messages.clear();
    return text;
  };
  EXPECT_EQ(refusedLayout([](auto& v) { v.stride = 46; }),
            "vertices->stride is 46; it must be a multiple of 4, at most 64");
  EXPECT_EQ(refusedLayout([](auto& v) { v.attributeCount = 9; }), "vertices->attributeCount is 9; it must be 1 to 8");
  EXPECT_EQ(refusedLayout([](auto& v) { v.attributes[1].semantic = 8; }),
            "vertices->attributes[1].semantic is unknown (8)");
  EXPECT_EQ(refusedLayout([](auto& v) { v.attributes[3].format = VK_FORMAT_R32G32_SFLOAT; }),
            "vertices->attributes[3].format (103) is not one for its semantic");
  EXPECT_EQ(
      refusedLayout([](auto& v) { v.attributes[0].offset = 40; }),
      "vertices->attributes[0].offset is 40; it must be a multiple of 4, and the attribute must lie in the vertex");
}

TEST_F(VerticesTest, TerminalsBeyondTheRecordsAreCounted) {
  const auto words = bake("axiom Box A; terminal T (0,0); terminal U (0,1);"
                          "A = Repeat(X,1,ADJUST_TO_FILL) Replicate() { T | CompSplit() { U | U | Discard() } };");
  const auto all = axioms(4, 100, 1, 1); // 400 boxes, 800 quads
  const VertexFormat layout = wideVertex();
  maxTerminals = 500;
  Wanted wanted;
  wanted.vertices = &layout;
  wanted.quads = 4000;
  const Output out = run(words, all, wanted);
  const uint32_t written = out.report.verticesWritten / 4;
  EXPECT_EQ(out.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(out.report.terminals, 1200u);
  EXPECT_EQ(out.report.vertices, 4u * (400 * 6 + 800));
  EXPECT_GE(written, 500u);
  EXPECT_LE(written, 100u + 6 * 400);
  EXPECT_EQ(out.draws[0].indexCount, 6 * written);
  expectIndices(out, 0, written, false);
  expectUntouched(out, written, 4000, layout);
  // Counting needs no records, and regions are told what they would have needed.
  wanted.quads = 0;
  wanted.withNeeded = true;
  const Output counted = run(words, all, wanted);
  EXPECT_EQ(counted.report.base.status, GPGP_SUCCESS);
  EXPECT_EQ(counted.needed, (std::vector<uint32_t>{6 * 2400, 6 * 800}));
  wanted.quads = 3200;
  wanted.flags = GPGP_SPAWN_REGIONS;
  wanted.draws = counted.draws;
  const Output regions = run(words, all, wanted);
  EXPECT_EQ(regions.report.base.status, GPGP_BUDGET_EXCEEDED);
  EXPECT_EQ(regions.needed, counted.needed);
  EXPECT_EQ(regions.draws[0].indexCount + regions.draws[1].indexCount, regions.report.verticesWritten / 4 * 6);
  EXPECT_EQ(regions.draws[0].indexCount / 36 + regions.draws[1].indexCount / 6, 500u);
}

} // namespace
