// The recorder in plain loops, pass after pass.
#include "visibility/cpu_reference/cpu_reference.h"

#include "visibility/conservative/conservative.h"
#include "visibility/outputs/extent.h"
#include "visibility/shared/candidate.h"
#include "visibility/shared/position.h"

#include <algorithm>
#include <bit>

namespace gpgp::visibility {
using namespace shader;

bool fetchPlace(const CpuInput& in, const DrawEntry& e, uint32_t index, uint32_t& vertex) {
  const Params& params = in.params;
  if (index >= params.indexCount) return false;
  vertex = in.indices[params.shortIndices ? index / 2 : index];
  if (params.shortIndices) vertex = index % 2 ? vertex >> 16 : vertex & 0xffffu;
  int64_t place = int64_t(vertex) + e.vertexOffset;
  if (params.hasCommands) place = int64_t(vertex) + static_cast<int32_t>(e.vertexOffset);
  vertex = static_cast<uint32_t>(place);
  return place >= 0 && place < params.vertexCount;
}

namespace {
bool fetchVertex(const CpuInput& in, const DrawEntry& e, uint32_t index, vec3& position) {
  const Params& params = in.params;
  uint32_t vertex = 0;
  if (!fetchPlace(in, e, index, vertex)) return false;
  const size_t at = size_t(vertex) * params.positionStride + params.positionOffset;
  for (int i = 0; i < 3; ++i) {
    const size_t byte = at + static_cast<size_t>(i) * (params.positionFormat == kFloats ? 4 : 2);
    const uint32_t word = in.positions[byte / 4], half = byte % 4 ? word >> 16 : word & 0xffffu;
    const float v = params.positionFormat == kFloats   ? uintBitsToFloat(word)
                    : params.positionFormat == kHalves ? halfToFloat(half)
                                                       : snormToFloat(half);
    if (!isModerate(v)) return false;
    position[i] = v;
  }
  return true;
}

/// Whether a triangle of a draw has three numbers of indices below 2^32.
bool hasIndices(const DrawEntry& e, uint32_t local) { return uint64_t(e.firstIndex) + local * 3ull + 2 <= UINT32_MAX; }

void draw(CpuResult& out, const CpuInput& in, const ScreenTriangle& t, uint32_t id, const CpuNonOpaque* open) {
  const Params& params = in.params;
  const Grid grid = gridOf(params);
  const auto width = static_cast<size_t>(samplesOf(grid).x);
  const int margin = marginOf(t, grid.margin);
  for (int y = t.bounds.y; y < t.bounds.w; ++y)
    for (int x = t.bounds.x; x < t.bounds.z; ++x) {
      const ivec2 point = samplePoint(ivec2(x, y), grid);
      if (!coversWide(t, margin, point)) continue;
      if (open && !passesAlpha(in, *open, point)) continue;
      const uint32_t key = depthKey(depthWide(t, point), params.reversedDepth != 0);
      const size_t at = size_t(y) * width + static_cast<size_t>(x);
      if (key < out.depth[at])
        out.depth[at] = key, out.ids[at] = id;
      else if (key == out.depth[at])
        out.ids[at] = std::min(out.ids[at], id);
    }
}
} // namespace

shader::Grid gridOf(const Params& params, uint32_t camera) {
  return {ivec2(static_cast<int>(params.width), static_cast<int>(params.height)), static_cast<int>(params.gridShift),
          ivec2(static_cast<int>(params.gridX), static_cast<int>(params.gridY)),
          static_cast<int>(camera * params.height), marginOfMethod(params.method)};
}

std::vector<DrawEntry> entriesOf(const CpuInput& in, CpuEntries& about) {
  const Params& params = in.params;
  std::vector<DrawEntry> one;
  about = {};
  if (params.hasCommands) {
    const uint32_t given = std::min(in.drawCount, params.commandCount);
    for (uint32_t i = 0; i < given; ++i) {
      const std::span<const uint32_t> c = in.commands.subspan(size_t(i) * params.commandWords, 5);
      const uint32_t valid = std::min(c[1], params.drawCount - std::min(c[4], params.drawCount));
      about.skipped += c[1] - valid;
      about.draws += valid;
      about.items += uint64_t(valid) * (c[0] / 3);
      for (uint32_t k = 0; k < valid && one.size() < params.entryCount / params.cameraCount; ++k)
        one.push_back({c[4] + k, 0, c[2], c[0], c[3]});
    }
    about.given = static_cast<uint32_t>(one.size());
  } else {
    for (uint32_t i = 0; i < std::min(in.drawCount, params.drawCount); ++i) {
      const uint32_t mesh = in.draws[i].mesh;
      about.skipped += mesh >= params.meshCount;
      const Mesh m = mesh < params.meshCount ? in.meshes[mesh] : Mesh{};
      about.items += m.indexCount / 3;
      one.push_back({i, 0, m.firstIndex, m.indexCount, m.vertexOffset});
    }
    about.draws = about.given = static_cast<uint32_t>(one.size());
  }
  std::vector<DrawEntry> all;
  for (uint32_t camera = 0; camera < params.cameraCount; ++camera)
    for (DrawEntry e : one) {
      e.camera = camera;
      all.push_back(e);
    }
  about.skipped *= params.cameraCount;
  return all;
}

void forEachTriangle(const CpuInput& in, const std::function<void(const DrawEntry&, uint32_t, uint32_t)>& visit) {
  CpuEntries about;
  const std::vector<DrawEntry> entries = entriesOf(in, about);
  uint64_t first = 0;
  for (size_t i = 0; i < entries.size(); ++i) {
    // Commands beyond the draw table keep their numbers.
    if (about.given && i % about.given == 0) first = i / about.given * about.items;
    const uint32_t triangles = entries[i].indexCount / 3;
    for (uint32_t local = 0; local < triangles && first + local < in.params.maxItems; ++local)
      visit(entries[i], local, static_cast<uint32_t>(first + local));
    first += triangles;
  }
}

bool isSampled(const CpuInput& in, const DrawEntry& e) {
  return isSampledBy(in.draws[e.draw].flags, in.params.cameraLayers[e.camera]);
}

bool numberOf(const CpuInput& in, const DrawEntry& e, uint32_t local, uint32_t& id) {
  const uint32_t first = in.draws[e.draw].firstTriangle;
  id = first + local;
  if (!in.params.hasNumbers) return first < in.params.triangleCount && local < in.params.triangleCount - first;
  const uint64_t place = uint64_t(e.firstIndex / 3) + local;
  if (place >= in.params.numberCount) return false;
  id = in.numbers[place];
  return id < in.params.triangleCount;
}

CpuTriangle placeTriangle(const CpuInput& in, const Draw& draw, uint32_t localTriangle) {
  const Mesh& mesh = in.meshes[draw.mesh];
  const auto record = static_cast<uint32_t>(&draw - in.draws.data());
  return placeTriangle(in, DrawEntry{record, 0, mesh.firstIndex, mesh.indexCount, mesh.vertexOffset}, localTriangle);
}

CpuTriangle placeTriangle(const CpuInput& in, const DrawEntry& entry, uint32_t localTriangle) {
  CpuTriangle result;
  if (alphaTestOf(in.draws[entry.draw].flags) > in.params.alphaTestCount) {
    result.fate = kSkipped;
    return result;
  }
  if (in.params.originCount && in.draws[entry.draw].origin >= in.params.originCount) {
    result.fate = kSkipped;
    return result;
  }
  const auto originAt = [](const float* parts, uint32_t i) {
    return std::pair(vec3(parts[i * 8], parts[i * 8 + 1], parts[i * 8 + 2]),
                     vec3(parts[i * 8 + 4], parts[i * 8 + 5], parts[i * 8 + 6]));
  };
  Draw draw = in.draws[entry.draw];
  if (in.params.hasOrigins) {
    const auto [fromHigh, fromLow] = originAt(in.params.cameraOrigins, entry.camera);
    std::pair<vec3, vec3> own(vec3(0), vec3(0));
    if (in.params.originCount) own = originAt(in.params.origins, draw.origin);
    moveDraw(draw, originFrom(own.first, own.second, fromHigh, fromLow));
  }
  vec4 clip[3];
  mat4 viewProjection;
  for (int i = 0; i < 16; ++i) viewProjection[i / 4][i % 4] = in.params.viewProjection[entry.camera * 16 + uint(i)];
  for (uint32_t i = 0; i < 3; ++i) {
    vec3 position;
    if (!hasIndices(entry, localTriangle) ||
        !fetchVertex(in, entry, entry.firstIndex + localTriangle * 3 + i, position)) {
      result.fate = kSkipped;
      return result;
    }
    result.world[i] = transformToWorld(draw, position);
    clip[i] = transformToClip(viewProjection, result.world[i]);
  }
  std::copy_n(clip, 3, result.clip);
  const Grid grid = gridOf(in.params, entry.camera);
  const bool mirrored = turnsFaces(draw), twoSided = (draw.flags & kTwoSided) != 0;
  ScreenTriangle triangle;
  result.fate = classify(clip[0], clip[1], clip[2], grid, mirrored, twoSided, triangle);
  const bool perspective = isPerspective(viewProjection);
  if (result.fate == kWhole) {
    result.pieces.push_back(triangle);
    result.depths.push_back(wholeDepths(clip[0], clip[1], clip[2], triangle, grid, perspective));
  }
  if (result.fate != kClipped) return result;
  result.wasClipped = true;
  ScreenPolygon polygon;
  result.fate = clipTriangle(clip[0], clip[1], clip[2], grid, mirrored, twoSided, polygon);
  if (result.fate == kClipped)
    for (int k = 0; k + 2 < polygon.count; ++k)
      if (fanPiece(polygon, k, grid, triangle)) {
        result.pieces.push_back(triangle);
        result.depths.push_back(pieceDepths(polygon, k, triangle, perspective));
      }
  return result;
}

/// The lists by draw, and triangles' sizes.
void listDraws(const CpuInput& in, CpuResult& out) {
  CpuEntries about;
  const std::vector<DrawEntry> entries = entriesOf(in, about);
  const auto isSeen = [&](uint32_t id) {
    return id < in.params.triangleCount && (out.bits[id / 32] >> (id % 32) & 1) != 0;
  };
  for (uint32_t i = 0; i < about.given; ++i) {
    const DrawEntry& e = entries[i];
    const bool listed = isSampledBy(in.draws[e.draw].flags, in.params.allLayers);
    const auto first = static_cast<uint32_t>(out.drawTriangles.size());
    for (uint32_t local = 0; local < e.indexCount / 3; ++local) {
      uint32_t id = 0;
      if (!listed || !numberOf(in, e, local, id) || !isSeen(id) || !hasIndices(e, local)) continue;
      uint32_t vertex = 0, corner[3];
      bool valid = true;
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t index = e.firstIndex + local * 3 + k;
        valid = valid && fetchPlace(in, e, index, vertex);
        if (!valid) break;
        corner[k] = in.indices[in.params.shortIndices ? index / 2 : index];
        if (in.params.shortIndices) corner[k] = index % 2 ? corner[k] >> 16 : corner[k] & 0xffffu;
      }
      if (!valid) continue;
      out.drawTriangles.push_back(id);
      out.drawIndices.insert(out.drawIndices.end(), corner, corner + 3);
    }
    const uint32_t count = static_cast<uint32_t>(out.drawTriangles.size()) - first;
    for (const uint32_t word : {count * 3, count ? 1u : 0u, first * 3, e.vertexOffset, e.draw})
      out.drawCommands.push_back(word);
  }
  out.counters.draws = static_cast<uint32_t>(std::min<uint64_t>(about.draws, UINT32_MAX));
  out.counters.drawsGiven = about.given;
  out.counters.drawTriangles = static_cast<uint32_t>(out.drawTriangles.size());
  out.extents.assign(size_t(in.params.triangleCount) * 3, 0);
  forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t) {
    uint32_t id = 0;
    if (!isSampled(in, e) || !numberOf(in, e, local, id) || !isSeen(id)) return;
    Extent extent = noExtent();
    for (const ScreenTriangle& t : placeTriangle(in, e, local).pieces) extent = withPiece(extent, t);
    const uvec3 bits = extentBits(extent);
    for (int k = 0; k < 3; ++k)
      out.extents[size_t(id) * 3 + size_t(k)] = std::max(out.extents[size_t(id) * 3 + size_t(k)], bits[k]);
  });
}

void gather(const CpuInput& in, CpuResult& out) {
  out.sizes.assign(in.params.triangleCount, 0);
  for (const uint32_t id : out.ids) {
    if (id == kNoTriangle) continue;
    ++out.counters.coveredPixels;
    ++out.sizes[id];
    out.bits[id / 32] |= 1u << (id % 32);
  }
}

void finish(const CpuInput& in, CpuResult& out) {
  const Params& params = in.params;
  Counters& counters = out.counters;
  const auto isTriangle = [&](size_t word) { // of a word's bits
    return word + 1 == out.bits.size() ? ~0u >> (out.bits.size() * 32 - params.triangleCount) : ~0u;
  };
  for (size_t word = 0; word < out.bits.size(); ++word)
    for (uint32_t rest = out.bits[word] & isTriangle(word); rest; rest &= rest - 1)
      out.list.push_back(static_cast<uint32_t>(word * 32) + static_cast<uint32_t>(std::countr_zero(rest)));
  listDraws(in, out);
  counters.visible = static_cast<uint32_t>(out.list.size());
  counters.hasList = params.hasList;
  counters.listed = std::min(counters.visible, params.listCapacity);
  std::vector<uint32_t> gone;
  out.changed.clear();
  const auto add = [](std::vector<uint32_t>& list, size_t word, uint32_t rest) {
    for (; rest; rest &= rest - 1)
      list.push_back(static_cast<uint32_t>(word * 32) + static_cast<uint32_t>(std::countr_zero(rest)));
  };
  for (size_t word = 0; params.viewWords && word < std::max(out.bits.size(), in.previousBits.size()); ++word) {
    const uint32_t now = word < out.bits.size() ? out.bits[word] : 0;
    const uint32_t before = word < in.previousBits.size() ? in.previousBits[word] : 0;
    counters.appeared += static_cast<uint32_t>(std::popcount(now & ~before));
    counters.disappeared += static_cast<uint32_t>(std::popcount(before & ~now));
    add(out.changed, word, now & ~before);
    add(gone, word, before & ~now);
  }
  out.changed.insert(out.changed.end(), gone.begin(), gone.end());
}

CpuResult sampleOnCpu(const CpuInput& in) {
  const Params& params = in.params;
  CpuResult out;
  const ivec2 samples = samplesOf(gridOf(params));
  const size_t pixels = static_cast<size_t>(samples.x) * static_cast<size_t>(samples.y) * params.cameraCount;
  out.depth.assign(pixels, kFarthest);
  out.ids.assign(pixels, kNoTriangle);
  out.bits.assign((size_t(params.triangleCount) + 31) / 32, 0);
  Counters& counters = out.counters;

  forEachTriangle(in, [&](const DrawEntry& e, uint32_t local, uint32_t item) {
    uint32_t id = 0;
    if (!isSampled(in, e)) return;
    if (!numberOf(in, e, local, id)) {
      ++counters.skippedTriangles;
      return;
    }
    const CpuTriangle placed = placeTriangle(in, e, local);
    counters.skippedTriangles += placed.fate == kSkipped;
    counters.triangles += placed.fate == kWhole || placed.fate == kClipped;
    const uint32_t flags = in.draws[e.draw].flags;
    if (isNonOpaque(flags)) {
      bool reaches = placed.fate == kClipped;
      for (const ScreenTriangle& piece : placed.pieces) {
        const ivec4 b = pixelBounds(piece.p0, piece.p1, piece.p2, gridOf(params, e.camera));
        reaches = reaches || !isEmpty(piece) || (params.method == kExact && b.x < b.z && b.y < b.w);
      }
      counters.nonOpaque += reaches;
      if (reaches && !params.maxNonOpaque) out.bits[id / 32] |= 1u << (id % 32);
      if (!params.maxNonOpaque || isSeeThrough(flags)) return;
    }
    const CpuNonOpaque open = isNonOpaque(flags) ? nonOpaqueOf(in, e, local, placed) : CpuNonOpaque();
    for (const ScreenTriangle& piece : placed.pieces)
      draw(out, in, piece, params.method == kConservative ? item : id, isNonOpaque(flags) ? &open : nullptr);
  });
  CpuEntries about;
  entriesOf(in, about);
  counters.skippedDraws = static_cast<uint32_t>(std::min<uint64_t>(about.skipped, UINT32_MAX));
  counters.items = static_cast<uint32_t>(std::min<uint64_t>(about.items * params.cameraCount, UINT32_MAX));
  if (params.method == kConservative) return out;

  gather(in, out);
  showThrough(in, out);
  finish(in, out);
  return out;
}

} // namespace gpgp::visibility
