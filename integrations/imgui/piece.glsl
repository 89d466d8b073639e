layout(push_constant) uniform Place {
  ivec4 rect; // left, top, right, bottom in pixels
  vec2 scale; // 2 / framebuffer size
  int down;   // from the screen to the layer
}
place;
