#version 450
// One triangle over the whole picture; each corner knows where it looks.
layout(push_constant) uniform Push {
  mat4 fromClip;
  vec4 eye;
} push;
layout(location = 0) out vec3 direction;

void main() {
  vec2 p = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  vec4 far = push.fromClip * vec4(p, 1.0, 1.0);
  direction = far.xyz / far.w - push.eye.xyz;
  gl_Position = vec4(p, 1.0, 1.0);
}
