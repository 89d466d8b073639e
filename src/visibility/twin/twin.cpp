// The sampler in plain loops, pass after pass.
#include "visibility/twin/twin.h"

#include <algorithm>
#include <bit>

namespace gpgp::visibility {
namespace {
using namespace shader;

/// False where an index or the vertex that it names lies outside its range.
bool fetchVertex(const TwinInput& in, const Mesh& mesh, uint32_t index, vec3& position) {
  const Params& params = in.params;
  if (index >= params.indexCount) return false;
  uint32_t vertex = in.indices[params.shortIndices ? index / 2 : index];
  if (params.shortIndices) vertex = index % 2 ? vertex >> 16 : vertex & 0xffffu;
  if (vertex > UINT32_MAX - mesh.vertexOffset) return false;
  vertex += mesh.vertexOffset;
  if (vertex >= params.vertexCount) return false;
  const size_t word = size_t(vertex) * params.strideWords;
  for (int i = 0; i < 3; ++i) {
    const float v = uintBitsToFloat(in.positions[word + static_cast<size_t>(i)]);
    if (!isModerate(v)) return false;
    position[i] = v;
  }
  return true;
}

void draw(TwinResult& out, const Params& params, const ScreenTriangle& t, uint32_t id) {
  const Grid grid = gridOf(params);
  const auto width = static_cast<size_t>(samplesOf(grid).x);
  for (int y = t.bounds.y; y < t.bounds.w; ++y)
    for (int x = t.bounds.x; x < t.bounds.z; ++x) {
      const ivec2 point = samplePoint(ivec2(x, y), grid);
      if (!coversWide(t, point)) continue;
      const uint32_t key = depthKey(depthWide(t, point), params.reversedDepth != 0);
      const size_t at = size_t(y) * width + static_cast<size_t>(x);
      if (key < out.depth[at])
        out.depth[at] = key, out.ids[at] = id;
      else if (key == out.depth[at])
        out.ids[at] = std::min(out.ids[at], id);
    }
}
} // namespace

shader::Grid gridOf(const Params& params) {
  return {ivec2(static_cast<int>(params.width), static_cast<int>(params.height)), static_cast<int>(params.gridShift),
          ivec2(static_cast<int>(params.gridX), static_cast<int>(params.gridY))};
}

TwinTriangle placeTriangle(const TwinInput& in, const Draw& draw, uint32_t localTriangle) {
  TwinTriangle result;
  const Mesh& mesh = in.meshes[draw.mesh];
  vec4 clip[3];
  for (uint32_t i = 0; i < 3; ++i) {
    vec3 position;
    if (!fetchVertex(in, mesh, mesh.firstIndex + localTriangle * 3 + i, position)) {
      result.fate = kSkipped;
      return result;
    }
    clip[i] = transformToClip(draw, in.params, position);
  }
  const Grid grid = gridOf(in.params);
  const bool mirrored = mirrors(draw), twoSided = (draw.flags & kTwoSided) != 0;
  ScreenTriangle triangle;
  result.fate = classify(clip[0], clip[1], clip[2], grid, mirrored, twoSided, triangle);
  if (result.fate == kWhole) result.pieces.push_back(triangle);
  if (result.fate != kClipped) return result;
  ScreenPolygon polygon;
  result.fate = clipTriangle(clip[0], clip[1], clip[2], grid, mirrored, twoSided, polygon);
  if (result.fate == kClipped)
    for (int k = 0; k + 2 < polygon.count; ++k)
      if (fanPiece(polygon, k, grid, triangle)) result.pieces.push_back(triangle);
  return result;
}

/// From bits to list and counts.
void finish(const TwinInput& in, TwinResult& out) {
  const Params& params = in.params;
  Counters& counters = out.counters;
  for (size_t word = 0; word < out.bits.size(); ++word)
    for (uint32_t rest = out.bits[word]; rest; rest &= rest - 1)
      out.list.push_back(static_cast<uint32_t>(word * 32) + static_cast<uint32_t>(std::countr_zero(rest)));
  counters.visible = static_cast<uint32_t>(out.list.size());
  counters.hasList = params.hasList;
  counters.listed = std::min(counters.visible, params.listCapacity);
  for (size_t word = 0; params.viewWords && word < std::max(out.bits.size(), in.previousBits.size()); ++word) {
    const uint32_t now = word < out.bits.size() ? out.bits[word] : 0;
    const uint32_t before = word < in.previousBits.size() ? in.previousBits[word] : 0;
    counters.appeared += static_cast<uint32_t>(std::popcount(now & ~before));
    counters.disappeared += static_cast<uint32_t>(std::popcount(before & ~now));
  }
}

TwinResult sampleOnCpu(const TwinInput& in) {
  const Params& params = in.params;
  TwinResult out;
  const ivec2 samples = samplesOf(gridOf(params));
  const size_t pixels = static_cast<size_t>(samples.x) * static_cast<size_t>(samples.y);
  out.depth.assign(pixels, kFarthest);
  out.ids.assign(pixels, kNoTriangle);
  out.bits.assign((size_t(params.triangleCount) + 31) / 32, 0);
  Counters& counters = out.counters;

  uint64_t items = 0;
  for (const Draw& d : in.draws) {
    if (d.mesh >= params.meshCount) {
      ++counters.skippedDraws;
      continue;
    }
    const uint32_t triangles = in.meshes[d.mesh].indexCount / 3;
    for (uint32_t local = 0; local < triangles && items + local < params.maxItems; ++local) {
      if (d.firstTriangle >= params.triangleCount || local >= params.triangleCount - d.firstTriangle) {
        ++counters.skippedTriangles;
        continue;
      }
      const TwinTriangle placed = placeTriangle(in, d, local);
      counters.skippedTriangles += placed.fate == kSkipped;
      counters.triangles += placed.fate == kWhole || placed.fate == kClipped;
      for (const ScreenTriangle& piece : placed.pieces) draw(out, params, piece, d.firstTriangle + local);
    }
    items += triangles;
  }
  counters.items = static_cast<uint32_t>(std::min<uint64_t>(items, UINT32_MAX));

  for (const uint32_t id : out.ids) {
    if (id == kNoTriangle) continue;
    ++counters.coveredPixels;
    out.bits[id / 32] |= 1u << (id % 32);
  }
  finish(in, out);
  return out;
}

} // namespace gpgp::visibility
