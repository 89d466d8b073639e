// One invocation a triangle: which class its block should have, and how many blocks of each size are asked for.
//
// A triangle whose pair has changed loses its block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "visibility/atlas/buffers.glsl"
layout(local_size_x = 256) in;

layout(std430, set = 0, binding = kAtlasSizes) readonly buffer SizeBuffer { uint sizes[]; };

shared uint counts[kKeys * kVariants];

float texelsOf(uint triangle) {
  return texelsFor(sizes[triangle * 3u], sizes[triangle * 3u + 1u], sizes[triangle * 3u + 2u], params.scale);
}

void main() {
  uint lane = gl_LocalInvocationIndex;
  for (uint i = lane; i < kKeys * kVariants; i += 256u) counts[i] = 0u;
  barrier();
  for (uint round = 0u; round < 4u; ++round) {
    uint triangle = gl_WorkGroupID.x * kAtlasGroup + round * 256u + lane;
    bool there = triangle < params.maxTriangles;
    uint before = there ? history[codeAt(triangle)] : 0u;
    uint now = there && params.findsPairs != 0u ? codes[triangle / 16u] : before;
    barrier();
    if (there && triangle % 16u == 0u && now != before) history[codeAt(triangle)] = now;
    uint code = codeIn(now, triangle);
    if (there && code != codeIn(before, triangle)) history[stateAt(triangle)] = 0u;
    uint plan = 0u;
    if (there && (code == 0u || triangle % 2u == 0u)) {
      bool visible = isVisible(triangle);
      bool other = code != 0u && isVisible(triangle + 1u);
      if (code != 0u) plan = kPlanPaired;
      if (visible || other) {
        float texels = max(visible ? texelsOf(triangle) : 0.0, other ? texelsOf(triangle + 1u) : 0.0);
        uint desired = classWithHysteresis(desiredOf(history[stateAt(triangle)]), texels);
        uint key = keyFor(texels, triangle);
        plan |= desired | key << kPlanKeyShift | kPlanVisible;
        if (visible && other) plan |= kPlanBoth;
        atomicAdd(counts[key * kVariants + variantOf(desired, key)], 1u);
      }
    }
    if (there) plans[triangle] = plan;
  }
  barrier();
  for (uint i = lane; i < kKeys * kVariants; i += 256u)
    if (counts[i] != 0u) atomicAdd(histogram[i], counts[i]);
}
