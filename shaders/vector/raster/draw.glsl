// Where a rectangle of canvas pixels lies, by view: of a matrix, the columns of x, y and 1, as z is 0.
#if MULTIVIEW
#extension GL_EXT_multiview : require
#define DRAWN_VIEW uint(gl_ViewIndex)
#else
#define DRAWN_VIEW 0u
#endif
layout(push_constant) uniform Draw {
  vec4 columns[6]; // three for each view
  uvec4 size;      // width, height, row stride
  uvec2 begins;    // of each view: the column at which its part begins
  uint encode;     // 1: to sRGB, which is then multiplied by alpha
};
