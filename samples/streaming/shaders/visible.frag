#version 450
layout(location = 0) flat in uint triangle;
layout(location = 1) in vec2 weights;
layout(location = 0) out uvec4 pixel; // triangle + 1; two of its barycentrics; depth

void main() { pixel = uvec4(triangle + 1u, floatBitsToUint(weights), floatBitsToUint(gl_FragCoord.z)); }
