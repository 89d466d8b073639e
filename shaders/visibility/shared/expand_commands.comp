// From the engine's indirect commands to entries of the draw table, an invocation each: every instance of a command is
// a draw of each camera, whose transform, flags and triangle numbers are those of its number in the engine's draws.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/shared/layout.h"
layout(local_size_x = 256) in;

layout(std140, set = 0, binding = kBindParams) uniform ParamsBuffer { Params params; };
layout(std430, set = 0, binding = kBindCommands) readonly buffer CommandBuffer { uint commands[]; };
layout(std430, set = 0, binding = kBindCommandCount) readonly buffer CommandCountBuffer { uint commandCount; };
layout(std430, set = 0, binding = kBindCounters) readonly buffer CounterBuffer { Counters counters; };
#define TABLE_ACCESS
#include "visibility/shared/table.glsl"
#include "visibility/shared/table_write.glsl"

/// The command that an entry is an instance of: the last one that starts at or before it.
uint findCommand(uint entry, uint count) {
  uint low = 0u;
  uint high = count - 1u;
  while (low < high) {
    uint middle = low + (high - low + 1u) / 2u;
    if (table[params.maxEntries * kTableCommands + middle * 3u] <= entry) low = middle;
    else high = middle - 1u;
  }
  return low;
}

void main() {
  uint given = params.hasDrawCount != 0u ? min(commandCount, params.commandCount) : params.commandCount;
  uint perCamera = counters.drawsGiven;
  // What all cameras have together, divided among them.
  uint items = counters.items / params.cameraCount;
  for (uint i = gl_GlobalInvocationID.x; i < params.entryCount; i += gl_NumWorkGroups.x * 256u) {
    if (i >= perCamera * params.cameraCount) {
      writeNone(i);
      continue;
    }
    uint camera = i / perCamera;
    uint entry = i % perCamera;
    uint command = findCommand(entry, given);
    uint start = params.maxEntries * kTableCommands + command * 3u;
    uint at = command * params.commandWords;
    uint instance = entry - table[start];
    uint triangles = commands[at] / 3u;
    DrawEntry e;
    e.draw = commands[at + 4u] + instance;
    e.camera = camera;
    e.firstIndex = commands[at + 2u];
    e.indexCount = commands[at];
    e.vertexOffset = commands[at + 3u];
    uint item = saturatedSum(saturatedSum(table[start + 1u], saturatedProduct(instance, triangles)),
                             saturatedProduct(camera, items));
    uint chunk = saturatedSum(saturatedSum(table[start + 2u], saturatedProduct(instance, chunksOf(triangles))),
                              saturatedProduct(camera, counters.drawChunks));
    writeEntry(i, item, chunk, e);
  }
}
