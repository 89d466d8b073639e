// The textures of alpha tests. Needs `params` and texture.h.
#ifdef GPGP_ALPHA_TESTS
#define TEXTURE(n) layout(set = 1, binding = n) uniform sampler2D alpha##n;
TEXTURE(0) TEXTURE(1) TEXTURE(2) TEXTURE(3) TEXTURE(4) TEXTURE(5) TEXTURE(6) TEXTURE(7)
TEXTURE(8) TEXTURE(9) TEXTURE(10) TEXTURE(11) TEXTURE(12) TEXTURE(13) TEXTURE(14) TEXTURE(15)

// Which one may only be chosen by a constant.
#define CASE(n) case n: return textureLod(alpha##n, place, level).a;
float alphaAt(uint test, vec2 place, float level) {
  switch (test) {
    CASE(0) CASE(1) CASE(2) CASE(3) CASE(4) CASE(5) CASE(6) CASE(7)
    CASE(8) CASE(9) CASE(10) CASE(11) CASE(12) CASE(13) CASE(14)
  default: return textureLod(alpha15, place, level).a;
  }
}
#endif

/// Whether a triangle is there at a point. test: alphaTestOf() its draw's flags.
bool passesAlpha(uint test, TexturePlane plane, ivec2 point) {
#ifdef GPGP_ALPHA_TESTS
  vec2 place;
  if (test == 0u || !texturePlace(plane, point, place)) return true;
  uint i = test - 1u;
  vec4 both = params.alphaTests[i / 2u];
  vec2 own = (i & 1u) == 0u ? both.xy : both.zw;
  return alphaAt(i, place, own.y) >= own.x;
#else
  return true;
#endif
}
