// Which samples are drawn. Needs the camera block `params`.
#ifndef GPGP_SHADERS_VISIBILITY_GRID_GLSL
#define GPGP_SHADERS_VISIBILITY_GRID_GLSL
ivec2 viewport() { return ivec2(int(params.width), int(params.height)); }

Grid grid() {
  Grid g;
  g.pixels = viewport();
  g.shift = int(params.gridShift);
  g.offset = ivec2(int(params.gridX), int(params.gridY));
  return g;
}
#endif
