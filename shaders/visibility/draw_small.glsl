// Draws a small triangle with one invocation. Needs pixels.glsl.
/// True where it was the nearest so far in any pixel.
bool drawSmall(ScreenTriangle t, uint id) {
  bool won = false;
  for (int y = t.bounds.y; y < t.bounds.w; ++y)
    for (int x = t.bounds.x; x < t.bounds.z; ++x) {
      float z;
      if (coversCompact(t, samplePoint(ivec2(x, y), grid()), z) && coverPixel(t, true, ivec2(x, y), z, id)) won = true;
    }
  return won;
}
