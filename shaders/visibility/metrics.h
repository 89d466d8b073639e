// What counts as true and as false when visible triangles are compared with a truth, a word of 32 triangles at a time
// (6.3: coverage and overestimation).
#ifndef GPGP_SHADERS_VISIBILITY_METRICS_H
#define GPGP_SHADERS_VISIBILITY_METRICS_H
#include "visibility/layout.h"

GPGP_SHADER_BEGIN

/// The truth, with what was claimed too much and yet shows in a finer sampling.
GPGP_FN uint truthWith(uint visible, uint truth, uint recheck) { return truth | (visible & recheck); }
GPGP_FN uint falsePositives(uint visible, uint truth) { return visible & ~truth; }
GPGP_FN uint falseNegatives(uint visible, uint truth) { return truth & ~visible; }

GPGP_SHADER_END
#endif
