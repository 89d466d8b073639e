#version 450
// A mesh in world space.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertexNormal;
layout(location = 2) in vec3 vertexColour; // linear

layout(push_constant) uniform Push {
  mat4 viewProjection;
  vec4 eye;
} push;

layout(location = 0) out vec3 world;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 colour;

void main() {
  world = position;
  normal = vertexNormal;
  colour = vertexColour;
  gl_Position = push.viewProjection * vec4(position, 1.0);
}
