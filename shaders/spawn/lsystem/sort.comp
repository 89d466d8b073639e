#version 460
#extension GL_GOOGLE_include_directive : require
// A stable sort by one digit: counts of each tile, sums over the tiles, places. Sorted are modules by depth, so that
// every branch lies in a row, a digit after the other, or what they draw by terminal.
#include "spawn/lsystem/bindings.glsl"
layout(local_size_x = 256) in; // kLsysTile, kLsysDigits
layout(push_constant) uniform Push { uint stage, key; };
#include "spawn/lsystem/scan.glsl"
#include "spawn/lsystem/turtle.h"

shared uint digits[kLsysTile];

/// The module that lies at a place before this digit is sorted.
uint moduleAt(uint place) { return key == kLsysKeyDeep ? order[place] : place; }

uint digitOf(uint module) {
  if (key != kLsysKeyTerminal) {
    const uint depth = marks[module].x & 0xffffu;
    return key == kLsysKeyDepth ? depth & 255u : depth >> 8;
  }
  const uint symbol = lsysSymbolAt(lsysModule(module).x);
  const bool draws = lsysDraws(lsysWord(symbol + kSymbolTurtle), (marks[module].x & 0x10000u) != 0u);
  return draws ? lsysWord(symbol + kSymbolTerminal) : 255u;
}

/// Counts of a digit lie in a row, a tile each; their sum lies behind all rows.
uint rowAt(uint digit) { return digit * ((state.modules + kLsysTile - 1u) / kLsysTile); }
uint totalAt(uint digit) { return rowAt(kLsysDigits) + digit; }

void count() {
  const uint lane = gl_LocalInvocationIndex;
  digits[lane] = 0u;
  barrier();
  const uint place = gl_GlobalInvocationID.x;
  if (place < state.modules) atomicAdd(digits[digitOf(moduleAt(place))], 1u);
  barrier();
  histogram[rowAt(lane) + gl_WorkGroupID.x] = digits[lane];
}

void sumRow() {
  if (key == kLsysKeyDeep && state.deep == 0u) return;
  const uint lane = gl_LocalInvocationIndex;
  const uint digit = gl_WorkGroupID.x;
  const uint count = (state.modules + kLsysTile - 1u) / kLsysTile;
  uint before = 0u;
  for (uint first = 0u; first < count; first += kLsysTile) {
    const bool isThere = first + lane < count;
    const uint own = isThere ? histogram[rowAt(digit) + first + lane] : 0u;
    const uint upTo = sumUpTo(uvec4(own, 0u, 0u, 0u), false).x;
    if (isThere) histogram[rowAt(digit) + first + lane] = before + upTo - own;
    before += scanned[kLsysTile - 1u].x;
  }
  if (lane == 0u) histogram[totalAt(digit)] = before;
  if (lane == 0u && key == kLsysKeyTerminal && digit < 255u) atomicAdd(state.instances, before);
}

void scatter() {
  const uint lane = gl_LocalInvocationIndex;
  const uint place = gl_GlobalInvocationID.x;
  const bool isThere = place < state.modules;
  const uint module = isThere ? moduleAt(place) : 0u;
  const uint digit = isThere ? digitOf(module) : 0u;
  const uint total = histogram[totalAt(lane)];
  sumUpTo(uvec4(total, 0u, 0u, 0u), false);
  digits[lane] = isThere ? digit : 0xffffffffu;
  barrier();
  if (!isThere) return;
  uint rank = 0u;
  for (uint other = 0u; other < lane; ++other) rank += digits[other] == digit ? 1u : 0u;
  const uint start = digit == 0u ? 0u : scanned[digit - 1u].x;
  const uint to = start + histogram[rowAt(digit) + gl_WorkGroupID.x] + rank;
  if (key == kLsysKeyTerminal) {
    order[instanceAt(module)] = digit == 255u ? kLsysNowhere : to;
  } else {
    order[(key == kLsysKeyDeep ? record.maxModules : 0u) + to] = module;
    order[placeAt(module)] = to;
  }
}

void main() {
  sourceHalf = state.last;
  if (stage == kLsysSortCount)
    count();
  else if (stage == kLsysSortRows)
    sumRow();
  else
    scatter();
}
