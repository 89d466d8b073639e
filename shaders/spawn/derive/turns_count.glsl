// Whether the device counts turns of loops (core/turns.h). Pipelines of other devices contain nothing of it.
#ifndef GPGP_SHADERS_SPAWN_TURNS_COUNT_GLSL
#define GPGP_SHADERS_SPAWN_TURNS_COUNT_GLSL
#ifdef GPGP_SOFTWARE
const bool turnsCount = true;
#else
layout(constant_id = 4) const bool turnsCount = false;
#endif
#endif
