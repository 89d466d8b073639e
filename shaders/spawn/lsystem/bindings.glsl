// The deriver's one descriptor set (layout.h has the bindings), and how shared functions read strings.
#include "spawn/lsystem/layout.h"
layout(set = 0, binding = kLsysBindTable, std430) readonly buffer Table { uint tableWords[]; };
layout(set = 0, binding = kLsysBindAxioms, std430) readonly buffer Axioms { uvec4 axioms[]; }; // GpgpAxiom: six each
layout(set = 0, binding = kLsysBindInstances, std430) writeonly buffer Instances { uvec4 instances[]; }; // six each
layout(set = 0, binding = kLsysBindDraws, std430) writeonly buffer Draws { uint draws[]; };
layout(set = 0, binding = kLsysBindCorners, std430) writeonly buffer Corners { vec4 corners[]; };
layout(set = 0, binding = kLsysBindModulesOut, std430) writeonly buffer ModulesOut { uvec4 modulesOut[]; };
layout(set = 0, binding = kLsysBindParametersOut, std430) writeonly buffer ParametersOut { uint parametersOut[]; };
layout(set = 0, binding = kLsysBindCount, std430) writeonly buffer Count { uint instanceCount; };
layout(set = 0, binding = kLsysBindModules, std430) buffer Modules { uvec4 modules[]; };
layout(set = 0, binding = kLsysBindParameters, std430) buffer Parameters { uint parameters[]; };
layout(set = 0, binding = kLsysBindChosen, std430) buffer Chosen { uint chosen[]; };
layout(set = 0, binding = kLsysBindTiles, std430) buffer Tiles { uvec4 tiles[]; };
layout(set = 0, binding = kLsysBindCounters, std430) buffer Counters {
  LsysState state;
  uint arguments[];
};
layout(set = 0, binding = kLsysBindConstants, std140) uniform Constants { LsysConstants record; };
layout(set = 0, binding = kLsysBindNodes, std430) buffer Nodes { uvec4 nodes[]; };
layout(set = 0, binding = kLsysBindMarks, std430) buffer Marks { uvec4 marks[]; };
layout(set = 0, binding = kLsysBindOrder, std430) buffer Order { uint order[]; };
layout(set = 0, binding = kLsysBindHistogram, std430) buffer Histogram { uint histogram[]; };
layout(set = 0, binding = kLsysBindFrames, std430) buffer Frames { vec4 frames[]; };
layout(set = 0, binding = kLsysBindBranches, std430) buffer Branches { vec4 branches[]; };
layout(set = 0, binding = kLsysBindParents, std430) buffer Parents { uint parents[]; };

uint sourceHalf = 0; // the string that the functions below read

uint lsysWord(uint at) { return tableWords[at]; }
uvec4 lsysModule(uint at) { return modules[sourceHalf * record.maxModules + at]; }
float lsysParameter(uint at) { return uintBitsToFloat(parameters[sourceHalf * record.maxParameters + at]); }
uvec4 lsysNode(uint at) { return nodes[at]; }
uint lsysLeaves() { return record.leaves; }

uint phaseOf(uint step) { return (record.phases[step >> 6][(step >> 4) & 3u] >> (2u * (step & 15u))) & 3u; }
uint modulesOf(uint side) { return side == 0u ? state.modulesA : state.modulesB; }

// Fields of order[].
uint orderAt(uint place) { return (state.deep != 0u ? record.maxModules : 0u) + place; }
uint placeAt(uint module) { return 2u * record.maxModules + module; }
uint instanceAt(uint module) { return 3u * record.maxModules + module; }
// Fields of parents[].
uint parentAt(uint side, uint branch) { return side * record.maxBranches + branch; }
uint branchAt(uint place) { return 2u * record.maxBranches + place; }
uint walkerAt(uint side, uint index) { return 2u * record.maxBranches + record.maxModules * (1u + side) + index; }
