// Quads that a draw of patches is made of: each pixel's coverage and each sample is painted by one quad of a path, and
// together they are what the path's cells say, under any map. What shaders run is run here on the CPU.
#include "oracle.h"
#include "vector/patch/patch_reader.h"
#include "vector/patch/patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using shader::PatchReader;
using shader::vec2;
using shader::vec4;

vector::Patches patchesOf(const GpgpPath& path) {
  std::pmr::memory_resource* heap = std::pmr::get_default_resource();
  const auto drawing = vector::makeDrawing(std::span(&path, 1), heap);
  EXPECT_TRUE(drawing) << drawing.error().text;
  auto patches = vector::makePatches(*drawing, heap);
  EXPECT_TRUE(patches) << patches.error().text;
  return std::move(*patches);
}

std::vector<PatchReader::GpgpPatchQuad> quadsOf(const vector::Patches& patches, PatchReader& reader) {
  std::vector<PatchReader::GpgpPatchQuad> quads;
  for (uint32_t i = 0; i < patches.quads; ++i)
    quads.push_back(reader.gpgpUnpackQuad(patches.words[patches.words[1].x + i]));
  return quads;
}

/// As the vertex stage grows it.
bool reaches(const PatchReader::GpgpPatchQuad& quad, const vec4& box, vec2 at, vec2 spread, bool sampled) {
  const auto grown = [&](uint32_t side) {
    return !sampled && (quad.flags & side) ? PatchReader::kPatchGrown : PatchReader::kPatchOverlap;
  };
  const float more = sampled ? 0.5f : 0; // any of its samples may lie within
  return at.x >= box.x - (grown(PatchReader::kPatchQuadLeft) + more) * spread.x &&
         at.y >= box.y - (grown(PatchReader::kPatchQuadTop) + more) * spread.y &&
         at.x <= box.z + (grown(PatchReader::kPatchQuadRight) + more) * spread.x &&
         at.y <= box.w + (grown(PatchReader::kPatchQuadBottom) + more) * spread.y;
}

TestPath shapeOf(uint32_t seed) {
  TestPath path;
  if (seed == 1) return path.move(0, 0).line(30, 0).line(30, 20).line(0, 20).close();
  if (seed == 2) { // a frame: solid cells beside empty ones
    path.move(0, 0).line(90, 0).line(90, 90).line(0, 90).close();
    return path.move(10, 10).line(10, 80).line(80, 80).line(80, 10).close().move(30, 30).cubic(60, 30, 60, 60, 30, 60);
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(0, 90);
  const auto c = [&] { return at(random); };
  path.move(c(), c());
  for (int i = 0; i < 5; ++i) {
    const float a = c(), b = c(), d = c(), e = c(), f = c(), g = c();
    i % 2 ? path.line(a, b) : path.cubic(a, b, d, e, f, g);
  }
  return path.close();
}

TEST(PatchQuads, EachPixelHasOneOwnerAndItsCoverage) {
  size_t cellQuads = 0, edges = 0;
  for (uint32_t seed = 1; seed <= 8; ++seed) {
    const TestPath shape = shapeOf(seed);
    const vector::Patches patches = patchesOf(shape.view());
    PatchReader reader(patches.words);
    const auto path = reader.gpgpLoadPath(0, 0, 0);
    const auto quads = quadsOf(patches, reader);
    cellQuads += quads.size() - 1;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int map = 0; map < 3; ++map) {
      const float angle = static_cast<float>(map) * 0.7f,
                  step = std::min(path.cell.x, path.cell.y) / (path.smallest * (map == 1 ? 3.0f : 1.5f) + 1e-3f);
      const vec2 dx{step * std::cos(angle), step * std::sin(angle)}, dy{-dx.y, dx.x};
      const vec2 spread{std::abs(dx.x) + std::abs(dy.x), std::abs(dx.y) + std::abs(dy.y)};
      ASSERT_EQ(reader.gpgpShowsCells(path, spread), quads.size() > 1) << "seed " << seed;
      std::vector<const PatchReader::GpgpPatchQuad*> shown;
      for (const auto& quad : quads)
        if (quads.size() == 1 || !(quad.flags & PatchReader::kPatchQuadWhole)) shown.push_back(&quad);
      const vec2 origin{unit(random) * 40, unit(random) * 40};
      for (int i = 0; i < 1500; ++i) {
        const float spare = 3 * step;
        const vec2 at{path.box.x - spare + unit(random) * (path.box.z - path.box.x + 2 * spare) - origin.x,
                      path.box.y - spare + unit(random) * (path.box.w - path.box.y + 2 * spare) - origin.y};
        float covered = 0;
        uint32_t owners = 0, mask = 0, wanted = 0;
        for (const auto* quad : shown) {
          const vec4 box = reader.gpgpQuadBox(path, *quad, origin);
          if (reaches(*quad, box, at, spread, false) &&
              reader.gpgpQuadOwns(0, path, *quad, origin, at, reader.gpgpPixelReach(dx, dy))) {
            ++owners;
            covered += reader.gpgpQuadCoverage(0, path, *quad, origin, at, dx, dy);
          }
          if (!reaches(*quad, box, at, spread, true)) continue;
          const uint32_t own = reader.gpgpQuadMask(0, path, *quad, origin, at, dx, dy, 8);
          EXPECT_EQ(own & mask, 0u) << "seed " << seed << ", map " << map;
          mask |= own;
        }
        const float whole = reader.gpgpPathCoverage(0, path, origin, at, dx, dy);
        EXPECT_LE(owners, 1u) << "seed " << seed << ", map " << map;
        EXPECT_NEAR(covered, whole, 2e-3f) << "seed " << seed << ", map " << map << " at " << at.x << " " << at.y;
        for (uint32_t s = 0; s < 8; ++s)
          wanted |= reader.gpgpPatchesAt(0, path, origin, reader.gpgpSamplePoint(8, s, at, dx, dy)) << s;
        EXPECT_EQ(mask, wanted) << "seed " << seed << ", map " << map;
        edges += whole > 0 && whole < 1;
      }
    }
  }
  EXPECT_GT(cellQuads, 100u);
  EXPECT_GT(edges, 1000u);
}

/// Standard locations as Vulkan lists them: each in a row and a column of its own.
TEST(PatchQuads, SamplesStandWhereVulkanSays) {
  const std::vector<shader::uvec4> none;
  PatchReader reader(none);
  for (const uint32_t samples : {2u, 4u, 8u, 16u}) {
    std::set<float> columns, rows;
    for (uint32_t i = 0; i < samples; ++i) {
      const vec2 p = reader.gpgpSampleAt(samples, i);
      columns.insert(p.x), rows.insert(p.y);
    }
    EXPECT_EQ(columns.size(), samples);
    EXPECT_EQ(rows.size(), samples);
  }
  const vec2 first = reader.gpgpSampleAt(4, 0), last = reader.gpgpSampleAt(16, 15);
  EXPECT_EQ(first.x, 6.0f / 16 - 0.5f);
  EXPECT_EQ(first.y, 2.0f / 16 - 0.5f);
  EXPECT_EQ(last.x, 1.0f / 16 - 0.5f);
  EXPECT_EQ(last.y, -0.5f);
}

} // namespace
