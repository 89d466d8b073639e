// Draws a small triangle with one invocation. Needs pixels.glsl.
/// True where it was the nearest so far in any pixel.
bool drawSmall(ScreenTriangle t, uint id) {
  int margin = marginOf(t, grid().margin);
  bool won = false;
  for (int y = t.bounds.y; y < t.bounds.w; ++y)
    for (int x = t.bounds.x; x < t.bounds.z; ++x) {
      float z;
      bool covers = coversCompact(t, margin, samplePoint(ivec2(x, y), grid()), z);
      if (covers && coverPixel(t, true, ivec2(x, y), z, id)) won = true;
    }
  return won;
}
