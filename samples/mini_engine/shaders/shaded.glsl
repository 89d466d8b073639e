// The model's buffers, and the record that each of its triangles has.
struct Draw { // GpgpVisibilityDraw
  vec4 row0, row1, row2;
  uint mesh, firstTriangle, flags, reserved;
};
struct Record {
  uvec2 corners[3]; // colours as halves
  uint shading;       // of the shading that made it
  uint unused;
};
layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Normals { float normals[]; };
layout(set = 0, binding = 2, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 3, std430) readonly buffer Draws { Draw draws[]; };

struct Vertex {
  vec3 world, normal;
};
Vertex vertexOf(Draw draw, uint index) {
  uint i = index * 3u;
  vec4 p = vec4(positions[i], positions[i + 1u], positions[i + 2u], 1.0);
  vec3 n = vec3(normals[i], normals[i + 1u], normals[i + 2u]);
  return Vertex(vec3(dot(draw.row0, p), dot(draw.row1, p), dot(draw.row2, p)),
                vec3(dot(draw.row0.xyz, n), dot(draw.row1.xyz, n), dot(draw.row2.xyz, n)));
}
