#version 450
#extension GL_GOOGLE_include_directive : require
// The display of object-space shading: the colours in the triangles' records, from any pose. Or what gpgp knows of each
// triangle: the thesis's figure 6.2 (overlay) and figure 6.1 (density).
#include "shaded.glsl"
layout(set = 0, binding = 4, std430) readonly buffer Records { Record records[]; };
layout(set = 0, binding = 5, std430) readonly buffer Found { uint found[]; };
layout(set = 0, binding = 6, std430) readonly buffer Standard { uint standard[]; };
layout(set = 0, binding = 7, std430) readonly buffer Positives { uint falsePositives[]; };
layout(set = 0, binding = 8, std430) readonly buffer Negatives { uint falseNegatives[]; };
layout(set = 0, binding = 9, std430) readonly buffer Sizes { float sizes[]; }; // GpgpTriangleSize

layout(push_constant) uniform Push {
  mat4 viewProjection;
  uint draw, firstIndex, vertexOffset, shading, show;
} push;
const uint kShaded = 0u, kOverlay = 1u, kOverlayWithoutReference = 3u; // else density

layout(location = 0) out vec3 colour;

bool has(uint word, uint triangle) { return (word >> (triangle & 31u) & 1u) != 0u; }

vec3 overlay(uint triangle) {
  uint word = triangle >> 5;
  if (push.show == kOverlay) {
    if (has(falsePositives[word], triangle)) return vec3(0.80, 0.02, 0.02);
    if (has(falseNegatives[word], triangle)) return vec3(0.02, 0.06, 0.90);
  }
  return has(standard[word], triangle) ? vec3(0.05, 0.55, 0.08) : vec3(0.35);
}

// Blue for 64 pixels and more, green for a few, red for one and less.
vec3 density(float area) {
  float heat = clamp((6.0 - log2(max(area, 1e-6))) / 6.0, 0.0, 1.0);
  return clamp(vec3(heat * 2.0 - 0.8, 1.0 - abs(heat * 2.0 - 1.0), 1.0 - heat * 2.0), 0.0, 1.0);
}

void main() {
  Draw draw = draws[push.draw];
  Vertex v = vertexOf(draw, push.vertexOffset + indices[push.firstIndex + uint(gl_VertexIndex)]);
  uint triangle = draw.firstTriangle + uint(gl_VertexIndex) / 3u, corner = uint(gl_VertexIndex) % 3u;
  gl_Position = push.viewProjection * vec4(v.world, 1.0);
  if (push.show == kShaded) {
    uvec2 packed = records[triangle].corners[corner];
    // Without a record of the last shading there is nothing to show: a disocclusion.
    colour = records[triangle].shading == push.shading ? vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x)
                                                   : vec3(0.9, 0.0, 0.8);
    return;
  }
  uint word = triangle >> 5;
  bool shown = has(found[word], triangle);
  if (push.show == kOverlay || push.show == kOverlayWithoutReference) {
    shown = shown || (push.show == kOverlay && has(falseNegatives[word], triangle));
    colour = overlay(triangle);
  } else {
    colour = density(sizes[triangle * 3u]);
  }
  if (!shown) gl_Position = vec4(0.0, 0.0, 2.0, 1.0); // all three corners beyond the far plane
}
