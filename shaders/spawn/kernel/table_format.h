// A generated kernel's table: what its operators do as rows of numbers, so that a GPU runs the same instructions for
// all shapes, in whichever rule they are. src/spawn/codegen/table.cpp writes it, shaders/spawn/kernel/table.glsl reads
// it; it lies behind the graph's words, and offsets are in units of four words from its start.
//
// First a word for each node: the offset of its family, 0 where it has none.
#ifndef GPGP_SHADERS_SPAWN_TABLE_FORMAT_H
#define GPGP_SHADERS_SPAWN_TABLE_FORMAT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

// frame, of a step: Translate, Rotate and Scale, each at most once and in this order. A component of translation or
// scale is (a + d * n) * f + c, where n is drawn (drawnNumber) and f is an axis of the shape's size or one. Words:
GPGP_CONST uint kFrameTranslation = 0u; // a, d and c, four words apart
GPGP_CONST uint kFrameFlags = 3u;
GPGP_CONST uint kFrameScale = 12u;    // the same
GPGP_CONST uint kFrameRotation = 24u; // three columns, or angles in degrees: a and d
GPGP_CONST uint kFrameWords = 36u;
GPGP_CONST uint kFrameFactors = 0xfffu; // flags: f of the six components, two bits each
GPGP_CONST uint kFrameNoFactor = 3u;    // f is one
GPGP_CONST uint kFrameTranslates = 1u << 12;
GPGP_CONST uint kFrameRotates = 1u << 13;
GPGP_CONST uint kFrameScales = 1u << 14;
GPGP_CONST uint kFrameAdded = 1u << 15; // some c of translation or scale is not zero
// A component draws a number, whose d may be zero; x, y and z one after the other. A rotation that does is by angles.
GPGP_CONST uint kFrameTranslationDraws = 1u << 16;
GPGP_CONST uint kFrameRotationDraws = 1u << 19;
GPGP_CONST uint kFrameScaleDraws = 1u << 22;

// family, of an operator that multiplies by a known number, with all such operators and choices on static edges behind
// it. Words of its first entry: the number of children, and 1 for a Repeat, which makes as many in each of its copies.
// Behind a choice there are as many as most of its successors make. An entry of four words for each: offset of its
// first step, steps and their program, target as Shape::node and kEdgeRecursive, kEnd value. step: from a shape to one
// of its children, or as the last one a choice (kOpIf, whichever it is), which goes on with another entry. Words:
// operator and flags, number of the child or offset of the choice's entries by edge, length of SubDiv's fixed parts or
// the choice's node, frame that follows or 0; SubDiv's part.
GPGP_CONST uint kStepSize = 2u;           // in four words
GPGP_CONST uint kStepAxis = 8u;           // shift
GPGP_CONST uint kStepWeighted = 1u << 16; // is there only where a length remains
GPGP_CONST uint kStepFixed = 1u << 17;    // some of SubDiv's parts have a fixed length
GPGP_CONST uint kEntryProgram = 8u;       // shift: the number of the code that takes these steps
GPGP_CONST uint kStepOperator = 0xffu;
GPGP_CONST uint kEntrySteps = 0xffu;

GPGP_SHADER_END
#endif
