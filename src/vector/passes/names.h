// What the canvas's passes and its recordings name each other by: resources, workgroup counts, conditions.
#pragma once
#include "core/recorder.h"

namespace gpgp::vector {

// Workgroup counts and conditions of a recording.
enum Groups : uint32_t {
  kBegin,
  kPaths,
  kSegments,
  kWords,
  kRaster,
  kTiles,
  kSift,
  kPacks,
  kSplits,
  kSmallGlyphs,
  kOnce,
  kClear,
  kFill,
  kPresents,
  kImageTiles
};
constexpr uint32_t kNoImage = 0, kHasImage8 = 1, kHasImage16 = 2; // added to those that are multiples of three
enum Conditions : uint32_t {
  kPlain = 0,
  kPaints = 3,
  kPaintsOne = 6,
  kRich = 9,
  kRichOne = 12,
  kImages = 15,
  kRichImages = 18,
  kAny = 21,
  kGlyphs = 24, // small ones alone
  kOneDrawing = 27,
  kDrawings,
  kProjective,
  kSplit,
  kSplitOne,
  kAside,
  kAsideOne,
  kAsideImages,
  kMarkSixteen, // samples, of one drawing
  kMarkOne,
  kMarkDrawings,
  kMarkProjective,
  kSmallGlyphOne,
  kSmallGlyphDrawings,
  kPlaced,
  kAlone,
  kAloneSixteen, // samples, of one drawing
  kAloneOne,
  kAloneDrawings,
  kSiftPlain,
  kImagePages,  // of images, more than one
  kPresent = 48 // by target
};
static_assert(kPresent + 2 < core::kMaxConditions);

inline uint32_t divide(uint64_t a, uint32_t b) { return static_cast<uint32_t>((a + b - 1) / b); }

} // namespace gpgp::vector
