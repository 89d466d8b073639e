// What all passes share: the sun, the sky, the haze.
const vec3 kSun = vec3(0.48, 0.72, 0.50);

vec3 skyColour(vec3 direction) {
  float up = clamp(direction.y, 0.0, 1.0);
  vec3 sky = mix(vec3(0.52, 0.62, 0.74), vec3(0.07, 0.20, 0.50), pow(up, 0.55));
  float glow = max(dot(direction, normalize(kSun)), 0.0);
  return sky + vec3(0.9, 0.6, 0.3) * (0.25 * pow(glow, 24.0));
}

vec3 haze(vec3 colour, vec3 eye, vec3 world) {
  vec3 ray = world - eye;
  float amount = 1.0 - exp(-length(ray) * 0.0012);
  return mix(colour, skyColour(vec3(0.0, 0.02, 0.0)), amount);
}

// What a person sees of a colour by day (1) or night (0).
vec3 byLight(vec3 colour, float daylight) {
  float grey = dot(colour, vec3(0.25, 0.60, 0.15));
  return mix(mix(vec3(grey), colour, 0.6) * vec3(0.045, 0.07, 0.13), colour, daylight);
}

// A surface under one sun and the sky, seen from the eye from either side.
vec3 lit(vec3 colour, vec3 world, vec3 normal, vec3 eye, float shine) {
  vec3 toEye = eye - world;
  vec3 n = normalize(normal);
  if (dot(n, toEye) < 0.0) n = -n;
  vec3 light = vec3(1.0, 0.93, 0.80) * (1.25 * max(dot(n, normalize(kSun)), 0.0)) +
               vec3(0.42, 0.50, 0.62) * (0.42 + 0.26 * n.y);
  light *= 0.55 + 0.45 * smoothstep(0.0, 14.0, world.y); // less of the sky is seen from down in the streets
  vec3 halfway = normalize(normalize(kSun) + normalize(toEye));
  return colour * light + vec3(shine) * pow(max(dot(n, halfway), 0.0), 40.0);
}
