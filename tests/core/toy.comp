#version 460
// The smallest recorder: output[i] = input[i] * factor, a sum, and a second pass with indirect arguments.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Input { uint inputs[]; };
layout(set = 0, binding = 1, std430) buffer Output { uint outputs[]; };
layout(set = 0, binding = 2, std430) buffer Counters { uint sum; uint passes; uint unused0; uint unused1; };
layout(set = 0, binding = 3, std430) buffer Arguments { uint x; uint y; uint z; };
layout(set = 0, binding = 4, std430) readonly buffer Constants { uint count; uint factor; };
layout(push_constant) uniform Pass { uint pass; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (pass == 0) {
    if (i == 0) {
      x = (count + 63) / 64;
      y = 1;
      z = 1;
    }
    if (i < count) outputs[i] = inputs[i] * factor;
  } else {
    if (i < count) atomicAdd(sum, outputs[i]);
    if (i == 0) atomicAdd(passes, 2);
  }
}
