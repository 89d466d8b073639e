// The scene on the GPU, and how its surfaces look: a pattern by material, one sun with shadow, the sky, and a lantern
// that is carried about. The server shades texels with it, the client only pictures to compare with.
struct Draw { // GpgpVisibilityDraw
  vec4 row0, row1, row2;
  uint mesh, firstTriangle, flags, origin;
};
layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Normals { float normals[]; };
layout(set = 0, binding = 2, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 3, std430) readonly buffer Draws { Draw draws[]; };
layout(set = 0, binding = 4, std430) readonly buffer Meshes { uint meshes[]; };       // GpgpMesh
layout(set = 0, binding = 5, std430) readonly buffer Materials { vec4 materials[]; }; // colour, pattern

vec3 vectorOf(uint index, bool normal) {
  uint i = index * 3u;
  return normal ? vec3(normals[i], normals[i + 1u], normals[i + 2u])
                : vec3(positions[i], positions[i + 1u], positions[i + 2u]);
}
vec3 placed(Draw draw, vec3 p) {
  return vec3(dot(draw.row0, vec4(p, 1.0)), dot(draw.row1, vec4(p, 1.0)), dot(draw.row2, vec4(p, 1.0)));
}

#ifdef WITH_LIGHT
layout(set = 0, binding = 6, std430) readonly buffer Shadow { uvec4 shadow[]; }; // the sun's picture: visible.frag

const vec3 kSun = vec3(0.4805, 0.7208, 0.5006);
const uint kShadowSide = 2048u; // scene_gpu.h
const float kBricks = 1.0, kPlanks = 2.0, kTiles = 3.0, kGrass = 4.0;

// Draws lie in the order of their triangles' numbers.
uint drawOf(uint triangle, uint drawCount) {
  uint first = 0u, last = drawCount - 1u;
  for (uint step = 0u; step < 32u && first < last; ++step) {
    uint middle = (first + last + 1u) / 2u;
    if (draws[middle].firstTriangle <= triangle) first = middle;
    else last = middle - 1u;
  }
  return first;
}

struct Corners {
  vec3 world[3], normal[3];
};
Corners cornersOf(uint triangle, uint drawNumber) {
  Draw draw = draws[drawNumber];
  uint index = meshes[draw.mesh * 3u] + (triangle - draw.firstTriangle) * 3u;
  Corners corners;
  for (uint c = 0u; c < 3u; ++c) {
    uint vertex = meshes[draw.mesh * 3u + 2u] + indices[index + c];
    vec3 n = vectorOf(vertex, true);
    corners.world[c] = placed(draw, vectorOf(vertex, false));
    corners.normal[c] = vec3(dot(draw.row0.xyz, n), dot(draw.row1.xyz, n), dot(draw.row2.xyz, n));
  }
  return corners;
}
vec3 blend(vec3 corners[3], vec3 weights) {
  return corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
}
vec3 normalOf(Corners corners, vec3 weights) {
  vec3 n = blend(corners.normal, weights);
  if (dot(n, n) < 1e-8) n = cross(corners.world[1] - corners.world[0], corners.world[2] - corners.world[0]);
  return n / max(length(n), 1e-20);
}

float hash(vec2 p) { return fract(sin(dot(floor(p), vec2(12.9898, 78.233))) * 43758.5453); }
// 1 on lines of a grid of unit cells, as wide as `line` and as soft as the footprint.
float lines(vec2 p, vec2 line, vec2 footprint) {
  vec2 to = 0.5 - abs(fract(p) - 0.5);
  vec2 on = 1.0 - smoothstep(line - footprint, line + footprint, to);
  return max(on.x, on.y);
}
// A factor with mean 1 for the material's colour. footprint: the width in metres of what one sample stands for; what is
// finer fades away.
float patternOf(float kind, vec3 world, vec3 normal, float footprint) {
  vec2 at = abs(normal.y) > 0.75 ? world.xz : vec2(abs(normal.x) > abs(normal.z) ? world.z : world.x, world.y);
  vec2 cell = vec2(0.6, 0.2);
  if (kind == kPlanks) cell = vec2(0.16, 3.0);
  if (kind == kTiles) cell = vec2(0.35, 0.3);
  if (kind == kGrass) cell = vec2(0.9, 0.7);
  if (kind < kBricks) return 1.0;
  vec2 p = at / cell;
  if (kind == kBricks || kind == kTiles) p.x += 0.5 * mod(floor(p.y), 2.0);
  float amount = 1.0 - smoothstep(0.2, 0.7, footprint / min(cell.x, cell.y));
  if (kind == kGrass) return 1.0 + amount * 0.22 * (sin(p.x * 5.1 + 1.3 * sin(p.y * 4.3)) * sin(p.y * 6.7));
  float line = lines(p, vec2(0.02) / cell, vec2(max(footprint, 0.002)) / cell);
  return 1.0 + amount * (0.24 * (hash(p) - 0.5) - 0.3 * line);
}

float sunlight(vec3 world, vec3 normal, mat4 sun) {
  vec3 at = (sun * vec4(world + normal * 0.08, 1.0)).xyz;
  vec2 texel = (at.xy * 0.5 + 0.5) * float(kShadowSide) - 0.5;
  if (any(lessThan(texel, vec2(0.0))) || any(greaterThanEqual(texel, vec2(float(kShadowSide) - 1.0)))) return 1.0;
  uvec2 first = uvec2(texel);
  vec4 lit;
  for (uint i = 0u; i < 4u; ++i) {
    uvec4 seen = shadow[(first.y + i / 2u) * kShadowSide + first.x + i % 2u];
    lit[i] = seen.x == 0u || at.z <= uintBitsToFloat(seen.w) + 0.0006 ? 1.0 : 0.0;
  }
  vec2 part = fract(texel);
  return mix(mix(lit.x, lit.y, part.x), mix(lit.z, lit.w, part.x), part.y);
}

// Linear colour of a surface; it does not depend on the viewer. lantern: place, and reach in metres.
vec3 surface(uint drawNumber, vec3 world, vec3 normal, float footprint, mat4 sun, vec4 lantern) {
  vec4 material = materials[drawNumber];
  vec3 light = vec3(1.15, 1.05, 0.9) * (max(dot(normal, kSun), 0.0) * sunlight(world, normal, sun)) +
               vec3(0.30, 0.36, 0.46) * (0.75 + 0.25 * normal.y);
  vec3 to = lantern.xyz - world;
  float near = clamp(1.0 - dot(to, to) / (lantern.w * lantern.w), 0.0, 1.0);
  light += vec3(1.6, 1.0, 0.45) * (near * near * (0.35 + 0.65 * abs(dot(normal, to)) / max(length(to), 1e-3)));
  return material.rgb * light * patternOf(material.a, world, normal, footprint);
}

// RGBA8, sRGB-encoded.
uint encoded(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  vec3 s = mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
  return packUnorm4x8(vec4(s, 1.0));
}
#endif
