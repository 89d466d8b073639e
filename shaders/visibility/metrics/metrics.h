// What counts as true and as false when visible triangles are compared with a reference, a word of 32 triangles at a
// time (6.3: coverage and overestimation).
#ifndef GPGP_SHADERS_VISIBILITY_METRICS_H
#define GPGP_SHADERS_VISIBILITY_METRICS_H
#include "visibility/shared/layout.h"

GPGP_SHADER_BEGIN

/// The reference, with what was claimed too much and yet shows in a finer sampling.
GPGP_FN uint referenceWith(uint visible, uint reference, uint recheck) { return reference | (visible & recheck); }
GPGP_FN uint falsePositives(uint visible, uint reference) { return visible & ~reference; }
GPGP_FN uint falseNegatives(uint visible, uint reference) { return reference & ~visible; }

GPGP_SHADER_END
#endif
