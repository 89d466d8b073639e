#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_memory_scope_semantics : require
#ifdef GPGP_SUBGROUPS
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
// A round of derivation by the interpreter. Generated kernels put their own functions in the place of interpret.h.
#define GPGP_FIELDS // it runs every grammar
#include "spawn/shared/bindings.glsl"

#include "spawn/derive/interpret.h"

#include "spawn/derive/derive.glsl"
