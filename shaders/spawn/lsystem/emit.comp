#version 460
#extension GL_GOOGLE_include_directive : require
// Writes what each module draws, and the string itself where the engine asks for it.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile
#include "spawn/lsystem/frames.glsl"

shared uint hashes[2];

vec4 worldRow(uint axiom, uint row) { return uintBitsToFloat(axioms[axiom * 6u + row]); }

void emitModule(uint at) {
  const uvec4 module = lsysModule(at);
  const uint symbol = lsysSymbolAt(module.x);
  const uint turtle = lsysWord(symbol + kSymbolTurtle);
  const uint arity = lsysWord(symbol + kSymbolArity);
  uint hash = mixBits(module.x + 0x9e3779b9u * at);
  hash = mixBits(hash ^ module.z);
  hash = mixBits(hash ^ module.w);
  for (uint i = 0u; i < arity; ++i) hash = mixBits(hash ^ floatBitsToUint(lsysParameter(module.y + i)));
  atomicAdd(hashes[0], hash);
  atomicAdd(hashes[1], mixBits(hash + 1u));
  if (at < record.moduleCapacity) modulesOut[at] = module;
  for (uint i = 0u; i < arity; ++i)
    if (module.y + i < record.parameterCapacity)
      parametersOut[module.y + i] = floatBitsToUint(lsysParameter(module.y + i));

  const uint to = order[instanceAt(at)];
  const bool inPolygon = (marks[at].x & 0x10000u) != 0u;
  const bool corner = (lsysIsCorner(turtle) && inPolygon) || lsysIsSection(turtle);
  const bool draws = to < record.instanceCapacity;
  if (!draws && !corner) return;
  const LsysFrame f = frameOf(at);
  const uint axiom = marks[at].z;
  if (corner && marks[at].w < record.cornerCapacity) {
    const vec3 p = lsysCornerOf(f, module, turtle);
    corners[marks[at].w] = vec4(dot(worldRow(axiom, 0u), vec4(p, 1.0)), dot(worldRow(axiom, 1u), vec4(p, 1.0)),
                                dot(worldRow(axiom, 2u), vec4(p, 1.0)), f.l.w);
  }
  if (!draws) return;
  const vec3 extents = lsysExtents(f, module, turtle);
  const vec4 row0 = lsysUnitRow(f, 0u, extents);
  const vec4 row1 = lsysUnitRow(f, 1u, extents);
  const vec4 row2 = lsysUnitRow(f, 2u, extents);
  for (uint row = 0u; row < 3u; ++row)
    instances[to * 6u + row] = floatBitsToUint(lsysWorldRow(worldRow(axiom, row), row0, row1, row2));
  const uint terminal = lsysWord(symbol + kSymbolTerminal);
  const uint shape = lsysWord(lsysEntry(kLsysSectionTerminals, terminal, kTerminalWords) + kTerminalShape);
  instances[to * 6u + 3u] = uvec4(terminal, shape, axioms[axiom * 6u + 4u].x, terminal);
  instances[to * 6u + 4u] = uvec4(lsysSeed(module), floatBitsToUint(f.p.w), module.zw);
  const bool path = turtle == kTurtlePolygon || turtle == kTurtleCylinder;
  const float across = path ? float(chosen[at] - marks[at].w) : extents.x;
  instances[to * 6u + 5u] = uvec4(floatBitsToUint(across), floatBitsToUint(extents.y), floatBitsToUint(extents.x),
                                  path ? marks[at].w : 0xffffffffu);
}

void main() {
  sourceHalf = state.last;
  const uint lane = gl_LocalInvocationIndex;
  if (lane < 2u) hashes[lane] = 0u;
  barrier();
  const uint at = gl_GlobalInvocationID.x;
  if (at < state.modules) emitModule(at);
  barrier();
  if (lane == 0u) {
    atomicAdd(state.hashX, hashes[0]);
    atomicAdd(state.hashY, hashes[1]);
  }
}
