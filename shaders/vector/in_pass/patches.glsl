// What the vertex and the fragment stage of patches share: buffers, the view and the placement.
#include "vector/in_pass/recording.h"
#if MULTIVIEW
#extension GL_EXT_multiview : require
#define DRAWN_VIEW uint(gl_ViewIndex)
#else
#define DRAWN_VIEW 0u
#endif
#define PATCHES(n) layout(std430, set = 0, binding = n) readonly buffer Patches##n { uvec4 words##n[]; };
PATCHES(0)
#if ONE_DRAWING
#define GPGP_PATCH_LOAD(slot, index) words0[index]
#else
PATCHES(1) PATCHES(2) PATCHES(3) PATCHES(4) PATCHES(5) PATCHES(6) PATCHES(7)
uvec4 loadPatches(uint slot, uint index) {
  switch (slot) {
  case 0: return words0[index];
  case 1: return words1[index];
  case 2: return words2[index];
  case 3: return words3[index];
  case 4: return words4[index];
  case 5: return words5[index];
  case 6: return words6[index];
  default: return words7[index];
  }
}
#define GPGP_PATCH_LOAD(slot, index) loadPatches(slot, index)
#endif
#include "gpgp/shaders/patch_quads.h"

layout(std430, set = 0, binding = kBindPatchRecording) readonly buffer Recording {
  PatchHeader header;
  vec4 recording[];
};

PatchView viewOf(uint view) {
  const uint first = (view + DRAWN_VIEW) * kPatchViewSize;
  return PatchView(recording[first], recording[first + 1], recording[first + 2], recording[first + 3],
                   recording[first + 4], recording[first + 5]);
}
PatchPlacement placementOf(uint index) {
  const uint first = header.firstPlacement + index * 3;
  const uvec4 kinds = floatBitsToUint(recording[first + 2]);
  return PatchPlacement(recording[first], recording[first + 1], kinds.x, kinds.y, kinds.z, kinds.w);
}
