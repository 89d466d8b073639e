#version 460
// Brings the patches, curves and paths of all items into one table each. Push constant: 0 patches, 1 curves, 2 paths.
#extension GL_GOOGLE_include_directive : require
#include "canvas.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Pass { uint mode; };
DRAWING(0) DRAWING(1) DRAWING(2) DRAWING(3) DRAWING(4) DRAWING(5) DRAWING(6) DRAWING(7)

uint word(uint slot, uint i) {
  switch (slot) {
  case 0: return drawing0[i];
  case 1: return drawing1[i];
  case 2: return drawing2[i];
  case 3: return drawing3[i];
  case 4: return drawing4[i];
  case 5: return drawing5[i];
  case 6: return drawing6[i];
  default: return drawing7[i];
  }
}
float number(uint slot, uint i) { return uintBitsToFloat(word(slot, i)); }
vec4 four(uint slot, uint i) {
  return vec4(number(slot, i), number(slot, i + 1), number(slot, i + 2), number(slot, i + 3));
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (mode == 0) {
    if (i >= header.patchCount) return;
    uint item = 0;
    while (item + 1 < header.itemCount && items[item + 1].firstPatch <= i) ++item;
    const uint slot = items[item].slot;
    const uint w = slots[slot].patchWords + (i - items[item].firstPatch) * 8;
    PatchRecord p;
    p.left = slots[slot].firstCurve + word(slot, w);
    p.right = slots[slot].firstCurve + word(slot, w + 1);
    p.top = number(slot, w + 2);
    p.bottom = number(slot, w + 3);
    p.x0 = number(slot, w + 4);
    p.x1 = number(slot, w + 5);
    p.path = items[item].firstPath + word(slot, w + 6);
    p.item = item;
    patches[i] = p;
  } else if (mode == 1) {
    if (i >= header.curveCount) return;
    uint slot = 0;
    while (slot + 1 < kMaxSlots && slots[slot].curveEnd <= i) ++slot;
    const uint w = (i - slots[slot].firstCurve) * 12;
    CurveRecord c;
    c.ends = four(slot, w);
    c.controls = four(slot, w + 4);
    c.bend = number(slot, w + 8);
    c.pad0 = c.pad1 = c.pad2 = 0;
    curves[i] = c;
  } else {
    if (i >= header.pathCount) return;
    uint item = 0;
    while (item + 1 < header.itemCount && items[item + 1].firstPath <= i) ++item;
    const uint slot = items[item].slot;
    vec4 color = four(slot, slots[slot].pathWords + (i - items[item].firstPath) * 4);
    color.a *= items[item].opacity;
    paths[i].color = vec4(color.rgb * color.a, color.a);
  }
}
