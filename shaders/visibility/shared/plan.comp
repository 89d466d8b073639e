// Numbers the work: each draw's first item (triangle) and first chunk are the sums over the draws before it. A chunk
// holds triangles of one draw only, so that a workgroup reads one transform. One workgroup goes through the draws of
// all cameras (or the indirect commands, whose instances expand_commands.comp writes): each invocation sums a run, the
// sums are scanned, and the runs are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindDraws) readonly buffer DrawBuffer { Draw draws[]; };
layout(std430, set = 0, binding = kBindMeshes) readonly buffer MeshBuffer { Mesh meshes[]; };
layout(std430, set = 0, binding = kBindCommands) readonly buffer CommandBuffer { uint commands[]; };
layout(std430, set = 0, binding = kBindCommandCount) readonly buffer CommandCountBuffer { uint commandCount; };
layout(std430, set = 0, binding = kBindCounters) buffer CounterBuffer { Counters counters; };
layout(std430, set = 0, binding = kBindTable) writeonly buffer TableBuffer { uint table[]; };
#include "visibility/shared/table_write.glsl"

const uint kRun = 4u; // units of an invocation at a time

shared uvec4 sums[256]; // entries, items, chunks; draws that are skipped

/// Draws of one camera.
uint drawsGiven() { return params.hasDrawCount != 0u ? min(commandCount, params.drawCount) : params.drawCount; }

uint unitsGiven() {
  if (params.hasCommands == 0u) return drawsGiven() * params.cameraCount;
  return params.hasDrawCount != 0u ? min(commandCount, params.commandCount) : params.commandCount;
}

/// What a unit is: a draw or a command.
struct Unit {
  uvec4 size; // entries, triangles, chunks, and what it skips: a draw (none where there is no such mesh), or instances
  DrawEntry entry;
};

Unit unitOf(uint unit, uint givenDraws) {
  Unit u;
  u.entry.draw = 0u;
  u.entry.camera = 0u;
  u.entry.firstIndex = 0u;
  u.entry.indexCount = 0u;
  u.entry.vertexOffset = 0u;
  if (params.hasCommands != 0u) {
    uint at = unit * params.commandWords;
    uint first = commands[at + 4u];
    uint instances = min(commands[at + 1u], params.drawCount - min(first, params.drawCount));
    uint triangles = commands[at] / 3u;
    u.size = uvec4(instances, saturatedProduct(instances, triangles), saturatedProduct(instances, chunksOf(triangles)),
                   commands[at + 1u] - instances);
    return u;
  }
  u.entry.draw = unit % givenDraws;
  u.entry.camera = unit / givenDraws;
  uint mesh = draws[u.entry.draw].mesh;
  u.size = uvec4(1u, 0u, 0u, 1u);
  if (mesh >= params.meshCount) return u;
  u.entry.firstIndex = meshes[mesh].firstIndex;
  u.entry.indexCount = meshes[mesh].indexCount;
  u.entry.vertexOffset = meshes[mesh].vertexOffset;
  uint triangles = u.entry.indexCount / 3u;
  u.size = uvec4(1u, triangles, chunksOf(triangles), 0u);
  return u;
}

uvec4 sumOf(uvec4 a, uvec4 b) {
  return uvec4(saturatedSum(a.x, b.x), saturatedSum(a.y, b.y), saturatedSum(a.z, b.z), saturatedSum(a.w, b.w));
}

void write(uint unit, Unit u, uvec4 start) {
  if (params.hasCommands == 0u) {
    writeEntry(unit, start.y, start.z, u.entry);
    return;
  }
  uint at = params.maxEntries * kTableCommands + unit * 3u;
  table[at] = start.x;
  table[at + 1u] = start.y;
  table[at + 2u] = start.z;
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint givenDraws = drawsGiven();
  uint units = unitsGiven();
  uvec4 before = uvec4(0u);
  for (uint base = 0u; base < units; base += 256u * kRun) {
    uint first = base + lane * kRun;
    Unit run[kRun]; // read together: a unit's reads depend on each other
    for (uint k = 0u; k < kRun; ++k) run[k] = unitOf(min(first + k, units - 1u), givenDraws);
    uvec4 own = uvec4(0u);
    for (uint k = 0u; k < kRun; ++k)
      if (first + k < units) own = sumOf(own, run[k].size);
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
      uvec4 left = lane >= step ? sums[lane - step] : uvec4(0u);
      barrier();
      sums[lane] = sumOf(sums[lane], left);
      barrier();
    }
    uvec4 start = lane == 0u ? before : sumOf(before, sums[lane - 1u]);
    for (uint k = 0u; k < kRun; ++k) {
      if (first + k < units) write(first + k, run[k], start);
      start = sumOf(start, run[k].size);
    }
    before = sumOf(before, sums[255]);
    barrier();
  }
  if (params.hasCommands == 0u)
    for (uint i = units + lane; i < params.entryCount; i += 256u) writeNone(i);
  if (lane == 255u) {
    uvec4 all_ = before;
    if (params.hasCommands != 0u) {
      counters.draws = all_.x;
      counters.drawsGiven = min(all_.x, params.entryCount / params.cameraCount);
      counters.drawChunks = all_.z;
      all_.y = saturatedProduct(all_.y, params.cameraCount);
      all_.z = saturatedProduct(all_.z, params.cameraCount);
      all_.w = saturatedProduct(all_.w, params.cameraCount);
    } else {
      counters.draws = givenDraws;
      counters.drawsGiven = givenDraws;
      counters.drawChunks = all_.z / params.cameraCount;
    }
    counters.items = all_.y;
    counters.chunks = all_.z;
    counters.skippedDraws = all_.w;
    counters.hasList = params.hasList;
    // The shaders stride beyond kMaxGroups. Later passes raise the x of the other dispatches.
    counters.smallArgs[0] = min(all_.z, kMaxGroups);
    counters.smallArgs[1] = 1u;
    counters.smallArgs[2] = 1u;
    counters.keptArgs[0] = params.clusterCount != 0u ? 0u : counters.smallArgs[0];
    counters.keptArgs[1] = 1u;
    counters.keptArgs[2] = 1u;
    counters.unfoldArgs[1] = 1u;
    counters.unfoldArgs[2] = 1u;
    counters.mediumArgs[1] = 1u;
    counters.mediumArgs[2] = 1u;
    counters.largeArgs[1] = 1u;
    counters.largeArgs[2] = 1u;
    counters.selectLargeArgs[1] = 1u;
    counters.selectLargeArgs[2] = 1u;
    counters.binLargeArgs[1] = 1u;
    counters.binLargeArgs[2] = 1u;
    counters.openArgs[1] = 1u;
    counters.openArgs[2] = 1u;
    counters.longArgs[1] = 1u;
    counters.longArgs[2] = 1u;
    counters.winnerArgs[1] = 1u;
    counters.winnerArgs[2] = 1u;
    counters.onScreenArgs[1] = 1u;
    counters.onScreenArgs[2] = 1u;
    counters.overlapArgs[1] = 1u;
    counters.overlapArgs[2] = 1u;
    counters.nonOpaqueArgs[1] = kNonOpaqueSplit;
    counters.nonOpaqueArgs[2] = 1u;
    counters.splitArgs[1] = kLargeSplit;
    counters.splitArgs[2] = 1u;
    counters.leftArgs[1] = kLargeSplit;
    counters.leftArgs[2] = 1u;
  }
}
