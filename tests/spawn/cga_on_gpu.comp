#version 460
// Runs expressions of CGA programs: that the machine's text is GLSL, with everything that shapes need left out.
#extension GL_GOOGLE_include_directive : require
#include "spawn/cga/functions.h"

layout(local_size_x = 64) in;
layout(binding = 0, std430) readonly buffer Program { uint words[]; };
layout(binding = 1, std430) readonly buffer Chunks { uint chunks[]; };
layout(binding = 2, std430) writeonly buffer Results { uvec2 results[]; };
layout(push_constant) uniform Push { uint count; };

CgaValue stack[96];
uint frames[32];
uvec2 key;
uint draws;

uint cgaWord(uint at) { return words[at]; }
CgaValue cgaStack(uint at) { return stack[at]; }
void cgaSetStack(uint at, CgaValue v) { stack[at] = v; }
uint cgaStackSize() { return 96u; }
uint cgaFrame(uint at) { return frames[at]; }
void cgaSetFrame(uint at, uint v) { frames[at] = v; }
uint cgaMostFrames() { return 16u; }
uint cgaMostTurns() { return 4096u; }
CgaValue cgaNone() { return cgaFloatValue(0.0); }
CgaValue cgaAttribute(uint slot) { return cgaNone(); }
void cgaSetAttribute(uint slot, CgaValue v) {}
float cgaRandom() { return drawnNumber(key, draws++); }
CgaValue cgaAddOther(CgaValue a, CgaValue b) { return cgaNone(); }
CgaValue cgaCompareOther(uint code, CgaValue a, CgaValue b) { return cgaBoolValue(a.bits == b.bits); }
CgaValue cgaEach(uint code, CgaValue a, CgaValue b) { return cgaNone(); }
CgaValue cgaFunction(uint f, uint first, uint n) { return cgaNone(); }
CgaValue cgaArray(uint first, uint n) { return cgaNone(); }
CgaValue cgaIndex(uint first, uint n) { return cgaNone(); }
CgaValue cgaRange(CgaValue a, CgaValue b) { return cgaNone(); }
bool cgaOperation(uint operation, uint first, uint n) { return false; }
bool cgaBlock(uint operation, uint first, uint n, uint table, uint base) { return false; }
bool cgaInvoke(uint chunk, uint first, uint n) { return false; }
bool cgaGoOn(uint chunk) { return false; }
bool cgaLeaf(uint name) { return false; }
void cgaNil() {}
bool cgaPushShape() { return false; }
bool cgaPopShape() { return false; }
bool cgaEnd() { return true; }
void cgaAt(uint at) {}
#include "spawn/cga/machine.h"

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  key = uvec2(i, 7u * i);
  draws = 0u;
  const uint how = cgaRun(chunks[i], 0u);
  results[i] = uvec2(how, how == kCgaDone ? stack[0].bits : 0u);
}
