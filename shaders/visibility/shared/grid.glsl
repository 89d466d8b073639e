// Which samples are drawn. Needs the camera block `params`.
#ifndef GPGP_SHADERS_VISIBILITY_GRID_GLSL
#define GPGP_SHADERS_VISIBILITY_GRID_GLSL
layout(constant_id = 2) const bool kHasMargins = true; // some recordings look below the pixel

Grid gridOf(uint camera) {
  Grid g;
  g.pixels = ivec2(int(params.width), int(params.height));
  g.shift = int(params.gridShift);
  g.offset = ivec2(int(params.gridX), int(params.gridY));
  g.top = int(camera * params.height);
  g.margin = kHasMargins ? marginOfMethod(params.method) : 0;
  return g;
}

/// Which number is drawn: surfaces.comp needs to know which draw's triangle it is.
uint drawnId(uint id, uint item) { return params.method == kConservative ? item : id; }

/// For what does not depend on the camera.
Grid grid() { return gridOf(0u); }
#endif
