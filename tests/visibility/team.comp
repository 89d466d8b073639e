#version 460
#extension GL_GOOGLE_include_directive : require
// What the invocations of a team say to each other (visibility/exact/team.glsl), each by itself: team_test.cpp.
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
const uint kBatch = GPGP_TEAM;
#include "visibility/exact/team.glsl"

struct Said {
  uint value;
  uint lane; // whose values the invocation asks for
  uint flag;
};
layout(set = 0, binding = 0, std430) readonly buffer Input { Said said[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Output { uint heard[]; }; // twelve words each
shared uint values[kBatch];

void main() {
  const uint i = gl_WorkGroupID.x * kBatch + laneOf(), v = said[i].value, from = said[i].lane;
  values[laneOf()] = v;
  sync();
  const uint other = values[from];
  sync();
  const uvec2 two = fromLane(uvec2(v, ~v), from);
  const uvec4 four = fromLane(uvec4(v, v ^ 1u, v ^ 2u, v ^ 4u), from);
  const uint results[12] = uint[](lanesWith(said[i].flag != 0u), orAll(v), minAll(v), maxAll(v), sumUpTo(v), other,
                                  two.x, two.y, four.x, four.y, four.z, four.w);
  for (uint k = 0u; k < 12u; ++k) heard[i * 12u + k] = results[k];
}
