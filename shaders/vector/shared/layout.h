// What lies in the vector service's buffers, and what its shaders and their CPU reference agree on.
//
// All members are 4-byte scalars or 16-byte vectors at multiples of 16, so std430 and C++ lay them out alike.
#ifndef GPGP_SHADERS_VECTOR_LAYOUT_H
#define GPGP_SHADERS_VECTOR_LAYOUT_H
#include "core/shared.h"
#include "gpgp/shaders/ramp.h"

GPGP_SHADER_BEGIN

// Bindings of descriptor set 0, which are the numbers of the canvas's resources: 0 to 7 drawings, then these.
GPGP_CONST int kBindHistory = 8;
GPGP_CONST int kBindImage8 = 9; // targets
GPGP_CONST int kBindImage16 = 10;
GPGP_CONST int kBindConstants = 11; // from the host
GPGP_CONST int kBindPaths = 12;
GPGP_CONST int kBindWords = 13;
GPGP_CONST int kBindBins = 14;
GPGP_CONST int kBindEntries = 15;
GPGP_CONST int kBindCounters = 16;
GPGP_CONST int kBindItems = 17;
GPGP_CONST int kBindImages = 18; // the first; textures, in descriptor set 1
GPGP_CONST int kBindFlatSegments = 26;
GPGP_CONST int kBindRows = 27;
GPGP_CONST int kBindShapes = 28;
GPGP_CONST int kBindAside = 29;
GPGP_CONST int kBindImageColors = 33; // behind those of layers (layers/operation.h)
GPGP_CONST int kBindPatchBlocks = 34;
GPGP_CONST int kBindTilePatches = 35;

// A curve of a drawing: a cubic that never turns in x or y, from its top point down (lines and quadratics elevated).
// Control points are relative to the start, which keeps their low bits.
struct CurveRecord {
  vec4 ends;        // start x, y; end - start
  vec4 controls;    // first control - start, second control - start
  float bend;       // how far the cubic is from a parabola at most (drawing units); negative: a straight line
  float endX, endY; // the end, bit for bit as other curves begin there
  float weight;     // of an arc of a circle or ellipse, as a rational quadratic: cos of half its angle; 0: no arc
};

// A CPatch: what lies between top and bottom (half-open), right of the left curve and left of the right one.
// Its four bounding curves are two entries of the curve table and two horizontal lines.
struct PatchRecord {
  uint left, right;  // curves
  float top, bottom; // y of the lines
  float x0, x1;      // the box's other sides
  uint path;         // in the drawing
  uint item;         // 0
};

struct PathRecord {
  vec4 color; // linear RGB, straight alpha; where a gradient gives the colour, only alpha counts: it multiplies the
              // gradient's
  uint paint; // 1 + index of the gradient or image; 0: none
  uint clip;  // 1 + index of its ClipRecord; 0: none
  uint layer; // 1 + index of its LayerRecord; 0: none
  uint flags; // kForeground
};

// A path in the device's buffer, beside the box that it lies in: left, top, right, bottom; turned over without ink.
struct BoxedPath {
  vec4 box;
  PathRecord path;
};

// Paths of the drawing outside of whose union nothing is shown. They lie before all others, and paint nothing.
struct ClipRecord {
  uint firstPath, pathCount;
  uint parent; // 1 + index of an earlier clip that applies as well; 0: none
  uint depth;  // 1 without a parent, else one more than the parent's
};

// Paths that are composited with each other before what is behind them: those of a drawing's group, or of items.
struct LayerRecord {
  float opacity; // below 1
  uint parent;   // 1 + index of the earlier layer that holds it; 0: none
  uint depth;    // as a clip's
  uint pad0;
};

// Where a ramp has which colour; offsets never fall from one stop to the next.
struct StopRecord {
  vec4 color; // straight alpha; linear RGB, or as sRGB encodes it with kInterpolateSrgb (interpolated so, then decoded)
  float offset; // 0 to 1
  uint pad0, pad1, pad2;
};

// A part of a curve on the boundary of a path's filled region. All of a path's form closed outlines, level ones
// included.
struct SegmentRecord {
  vec4 first, second; // the whole curve: start and first control, second control and end; it runs down or is level
  vec4 ends;          // where the segment begins and ends on it
  uint path;
  float side; // 1: the region lies right of it (below a level one that runs to the left), -1: left of it
  uint line;  // 1: straight
  uint pad0;
};

// A drawing, or a glyph of a text, placed on the canvas.
struct ItemRecord {
  vec4 inverse;   // pixel to drawing: x = inverse.x px + inverse.z py + offsets.x, y = inverse.y px + inverse.w py +
                  // offsets.y
  vec4 transform; // drawing to pixel, the same way with offsets.z, offsets.w
  vec4 offsets;
  // Projective items (PROJECTIVE shaders): both maps give x w and y w, and w = perspective.x x + perspective.y y +
  // perspective.z of the drawing's point, 1 / w = eye.x px + eye.y py + eye.z of the pixel. Only what lies at w >=
  // perspective.w is drawn; that line lies beyond the canvas. perspective.w is 0 for affine items.
  vec4 perspective;
  vec4 eye;             // w: 1 where the line at w = perspective.w passes left of the canvas
  vec4 color;           // straight: what kForeground paths take; alpha is the opacity of all its paths
  vec4 scissor;         // pixels: what lies outside is not drawn; left, top, right, bottom
  float side;           // -1 where the transform mirrors, else 1
  uint slot;            // of its asset: kAssetBit
  uint firstSegment;    // of the item's segments in the recording; they end where the next item's begin
  uint firstPath;       // of the item's paths in the recording
  uint segments, paths; // where they begin in the slot's buffer, in vec4: SegmentRecord, BoxedPath
  uint firstImage;      // of the recording
  uint whole;           // 1: all of its paths are drawn or none
  uint clip;            // 1 + index of its ItemClipRecord; 0: none
  uint layer;           // 1 + index of the LayerRecord of the recording's own that holds it; 0: none
  uint smallGlyph; // 1: a small glyph of one path, whose segments are not among the recording's (small_glyphs.comp)
  uint pad0;
};

// What the host writes for each item: where the one that it names is placed, in the units of that one.
struct PlacementRecord {
  float x, y, size;
  uint source; // of the recording's sources: ItemRecords without a place of their own;
               // in its bits from kSlotBit on, the slot; kSmallGlyphBit: it is a small glyph
  vec4 color;  // straight; alpha multiplies
  uint firstSegment, firstPath, segments, paths; // as an item's
};

// A rectangle with round corners, or what lies between two of them, in a frame of its own: the point (x, y) of the
// frame lies at origin + x axis + y (-axis.y, axis.x). Radii are of the corners top left, top right, bottom right,
// bottom left. Or a triangle (triangle.h).
struct ShapeRecord {
  vec4 box;     // left, top, right, bottom
  vec4 radii;   // along x
  vec4 frame;   // origin, axis (of length 1)
  float border; // width of what is painted inside the edge; 0: everything
  float ratio;  // of radii along y to those along x
  uint paint;   // 1 + index of the gradient or image; 0: none
  uint kind;    // kShapeRound, kShapeTriangle
};

// A clip of items: a path of the recording that paints nothing.
struct ItemClipRecord {
  uint path;
  uint parent; // 1 + index of another that applies as well; 0: none
  uint pad0, pad1;
};

// An asset that a recording shows: where its tables begin in its buffer, in vec4.
struct SlotRecord {
  uint paints, stops, clips, layers;
};

// A path on the canvas that paints with an image of a recording with more than a page of them: its colours are found
// before the raster, tile by tile of its box (images.comp).
struct StoredImage {
  uint path, paint; // as the path's paint was
  uint firstTile;   // of its colours, 64 pixels each
  uint pad0;
};

// A path on the canvas.
struct PlacedPath {
  uint left, top, right, bottom; // the box of its tiles, right and bottom exclusive
  uint firstWord;                // of its tile words; one row of tiles has wordsOf(left, right) of them
  uint item, paint;              // paint: 1 + the paint's vec4 in the slot's buffer; 0: none; and kPaints...
  uint group;                    // 1 + the vec4 of its clip and layer (PathRecord) in the slot's buffer; 0: neither;
                                 // and kItemGrouped where its item has a clip or a layer
  vec4 color;                    // premultiplied, times the item's opacity
};

// 32 tiles of a row of a path's box: one bit each.
struct TileWord {
  uint edges;      // the path's boundary passes through the tile
  uint inside;     // the tile's first sample row is inside at its left edge
  uint firstEntry; // of the tiles with edges, in order
  uint smallGlyph; // 1: a small glyph's
};

struct CanvasHeader {
  uint width, height, tilesX, tilesY;
  uint segmentCount, pathCount, itemCount, pathWords; // pathWords: 32 paths each
  uint wordLimit, entryLimit, samples, flags;         // entryLimit: without those of small glyphs; flags: kWrite...
  uint pathsDropped, binsX, binCount, pathsNeeded;
  uint groupSegments, listWords; // segments of a workgroup; words of a tile's list on software devices (lists.glsl)
  uint images;                   // what each holds: kImageBits bits of kImage..., the first one's lowest
  uint binShift;                 // a bin is a square of 2^binShift tiles
  uint rowLimit;
  uint sourceCount;
  uint glyphs, glyphLimit;
  uint shapes, shapeLimit; // needed; room for as many
  uint sources, sourceLimit;
  uint shapeTables;                  // vec4: ShapeRecords, their paints, stops, clips and layers, SlotRecords of all
                                     // assets: behind placements
  uint binWords;                     // of a bin: kBinHead, then a bit for each path
  uint binListLimit;                 // paths in all bins' lists
  uint zero;                         // 0, which no compiler knows (raster.comp)
  uint layerPixels, layerOperations; // needed
  uint assets;                       // where the SlotRecords begin, in vec4
  uint patchTable;                   // where the PatchTableRecord lies, in vec4; 0: patches draw no item
  uint imageTiles;                   // room for as many of StoredImages; 0: the recording has at most a page of images
  uint damage;                       // where in the bins it says which tiles are drawn (damaged()); 0: all are
  uint pad0, pad1;
  vec4 background;
};

// Counters of a recording and its report.
struct CanvasCounters {
  uint words, entries;        // needed
  uint cutPath, pathsDropped; // paths from cutPath on are left out
  uint wordsGiven, entriesGiven;
  uint placed, allocated; // workgroups that are done; the latter on software devices pieces (pieces.glsl)
  uint paths;             // needed
  uint rows; // needed: of the lists between mark and fill; on software devices flattened segments (pieces.glsl)
  uint fillX, fillY, fillZ; // workgroups of the pass that does without those lists
  uint glyphs, glyphsGiven; // needed; room for as many
  uint shapes, shapesGiven, items, itemsGiven;
  uint listed;                 // paths in bins' lists; of small glyphs alone those that tiles' lists had no room for;
                               // on software devices tiles that are painted by rows
  uint rowsX, rowsY, rowsZ;    // workgroups of the pass that fills from lists
  uint cleared;                // entries that mark clears: as many as the recording before had
  uint smallGlyph;             // entries of small glyphs, behind the others
  uint tilesX, tilesY, tilesZ; // workgroups of the pass that paints tiles by rows
  uint rowsTaken;              // of tiles, by fill on software devices
  uint ended;                  // 1: the device has ended loops before their time (core/turns.h)
  uint layerPixels, layerOperations; // needed
  uint patchBlocks;                  // listed: squares of 8 x 8 tiles that a patch's curves pass
  uint tilePatches;                  // needed: patches in tiles that their curves pass
  uint patchesX, patchesY, patchesZ; // workgroups of the pass that fills from them
  uint imageTiles, storedImages;     // needed; those that have room
  uint imagesDropped;                // paths whose images have none
};

// A CPatch (patches/tile.h) of a drawing's table: the box that it lies in: left, top, right, bottom; up to
// kMaxTileCurves curves, by number (gpgp/shaders/patches.h), those on the left first.
struct TilePatchRecord {
  vec4 box;
  uvec4 curves[2];
  uint curveCount, lefts;
  uint path; // in the drawing
  uint pad0;
};

// Before the PatchItemRecords of a recording.
struct PatchTableRecord {
  uint items, patches; // how many there are
  uint groupPatches;   // of a workgroup
  uint limit;          // patches in tiles, at most
  uint firstPath;      // of the first item
  uint pad0, pad1, pad2;
};

// An item that patches draw. Points of the drawing count from an origin near to what the canvas shows, pixels from one
// near to its middle.
struct PatchItemRecord {
  vec4 inverse0, inverse1, inverse2; // pixel to drawing: x w, y w and w are the sums of x, y, z times the pixel's
                                     // coordinates and 1; .w: the origin's x and y; 1: projective
  vec4 forward0, forward1, forward2; // drawing to pixel, the same; .w: the middle's x and y
  uint item, firstPatch;             // of the recording
  uint patches, curves;              // where they begin in the slot's buffer, in vec4
};

// A patch's square of tiles, or single tile, that its curves pass.
struct PatchPlaceRecord {
  uint path;   // of the recording
  uint place;  // tile, y in the upper half; of squares the first one's
  uint record; // vec4 of its TilePatchRecord
  uint what;   // curves and edges (kPatchRows...) that pass, and from kPatchItemBit on the PatchItemRecord
};

// A flattened segment between mark and fill.
struct FlatSegmentRecord {
  vec2 top, bottom;
  float slope;
  uint path; // and in the highest bits whether the region begins right of the flattened segment, and whether there is a
             // scissor
};

GPGP_CONST uint kPageImages = 8u; // that a shader can name
GPGP_CONST uint kImageBits = 4u;
GPGP_CONST uint kImagePremultiplied = 1u; // its colours have been multiplied by its alpha
GPGP_CONST uint kImageEncoded = 2u;       // what sampling gives is encoded as sRGB encodes light
GPGP_CONST uint kImageByTexel = 4u;       // its texels are converted before they are mixed (paint.glsl)
GPGP_CONST uint kMaxClipDepth = 16u;
GPGP_CONST uint kMaxLayerDepth = 4u;
GPGP_CONST uint kForeground = 1u; // takes the colour of the item
// A slot: in its lowest bits the binding of a buffer, in which any number of drawings and glyph sets lie, and from
// kAssetBit on which of the recording's assets it is. Asset 0 is what the recording itself has, in a buffer of its own.
GPGP_CONST uint kMaxBuffers = 8u;
GPGP_CONST uint kBufferMask = 15u, kAssetBit = 4u, kMaxAssets = 2047u;
GPGP_CONST uint kShapeSlot = kMaxBuffers;
GPGP_CONST uint kSlots = 2u; // whose records lie behind the header: of asset 0 and, for recordings of one, of asset 1
GPGP_CONST uint kSlotBit = 16u, kSmallGlyphBit = 31u;
GPGP_CONST uint kShapeRound = 1u, kShapeTriangle = 2u;
GPGP_CONST uint kTriangleStraight = 1u; // its colours are multiplied by their alpha where they are painted
GPGP_CONST uint kTriangleEncoded = 2u;  // on the host: they are encoded as sRGB encodes them
GPGP_CONST uint kPaintsTriangle = 0x80000000u;
GPGP_CONST uint kPaintsStored = 0x40000000u; // with the index of a StoredImage
GPGP_CONST float kUnbounded = 1e30f;         // sides of a scissor that is none
GPGP_CONST uint kItemGrouped = 0x80000000u;
GPGP_CONST uint kWriteView = 1u;
GPGP_CONST uint kEncodeSrgb = 2u;
GPGP_CONST uint kExactArea = 4u;     // of a pixel's first edge
GPGP_CONST uint kBlendSrgb = 8u;     // colours mix as sRGB encodes them
GPGP_CONST uint kSplitRich = 16u;    // what has groups or projective gradients is listed for the general shader
GPGP_CONST uint kKeepEncoding = 32u; // the view receives colours as they mix: it is a layer's picture
GPGP_CONST uint kTileSize = 8u;      // pixels: what one entry holds of a path
GPGP_CONST uint kMinBinShift = 2u, kMaxBinShift = 4u; // tiles: the upper level of the hierarchy
// An entry: for each pair of pixels of a tile's row, whose samples change sides there (16 bits a pixel), then by how
// much the pixel's area differs from its samples (16 signed bits a pixel, in 1/256 of a sample). On software devices a
// word for each pixel, with the samples in its lower half and the area in its upper one.
GPGP_CONST uint kEntryWords = 64u;
// At the beginning of the bins, indirect arguments and how many: for tiles painted from lists and for crowded ones, and
// for those of either kind that take the general shader.
GPGP_CONST uint kPaintedArguments = 0u;
GPGP_CONST uint kCrowdedArguments = 4u;
GPGP_CONST uint kRichArguments = 8u;
GPGP_CONST uint kRichCrowdedArguments = 12u;
GPGP_CONST uint kFirstItems = 1024u;     // segments at whose items it is known to search
GPGP_CONST uint kManyItems = 256u;       // where that is worth it
GPGP_CONST uint kTilesAside = 4096u;     // painted by the general shader beside the other tiles
GPGP_CONST uint kClearGroups = 256u;     // workgroups of mark that clear entries
GPGP_CONST uint kMostSegments = 64u;     // of a workgroup, a power of two
GPGP_CONST uint kSmallGlyphTiles = 16u;  // of a small path, at most
GPGP_CONST uint kSmallGlyphPairs = 128u; // of its pixels
GPGP_CONST uint kFirstBin = 16u;
// Of recordings of small glyphs alone, in place of bins: for each tile how many paths it has, nothing, and for as many
// as there is room for what they do to it and which they are. Others follow all tiles: tile, what, which.
GPGP_CONST uint kTileListWords = 32u;
GPGP_CONST uint kTileListPaths = 15u;
GPGP_CONST uint kBinHead = 3u;    // 0, or 1 + how many paths the bin has as a list (pack.comp); where that lies; and:
GPGP_CONST uint kBinGrouped = 2u; // 1: one of its paths may need the general shader
GPGP_CONST uint kMaxTileCurves = 8u;                          // of a TilePatchRecord
GPGP_CONST uint kPatchBlockTiles = 8u, kPatchBlocks = 65536u; // side of a square; room for as many
GPGP_CONST uint kTilePatchSize = 4u;                          // vec4
GPGP_CONST uint kPatchItemBit = 10u;
GPGP_CONST uint kFillPatches = 4u;             // of a workgroup of patches/fill.comp
GPGP_CONST uint kEntryPatch = (1u << 29) - 1u; // patches of a drawing, at most

// How many segments lie between those of the table of first items.
GPGP_FN uint firstItemsStep(uint segmentCount) { return segmentCount / kFirstItems + 1u; }

GPGP_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(gpgp::shader::CurveRecord) == 48 && sizeof(gpgp::shader::PatchRecord) == 32);
static_assert(sizeof(gpgp::shader::PathRecord) == 32 && sizeof(gpgp::shader::PaintRecord) == 64 &&
              sizeof(gpgp::shader::StopRecord) == 32 && sizeof(gpgp::shader::SegmentRecord) == 64);
static_assert(sizeof(gpgp::shader::ItemRecord) == 160 && sizeof(gpgp::shader::ShapeRecord) == 64 &&
              sizeof(gpgp::shader::ItemClipRecord) == 16 && sizeof(gpgp::shader::PlacedPath) == 48 &&
              sizeof(gpgp::shader::ClipRecord) == 16 && sizeof(gpgp::shader::LayerRecord) == 16 &&
              sizeof(gpgp::shader::SlotRecord) == 16 && sizeof(gpgp::shader::PlacementRecord) == 48 &&
              sizeof(gpgp::shader::BoxedPath) == 48 && sizeof(gpgp::shader::TileWord) == 16 &&
              sizeof(gpgp::shader::CanvasHeader) == 176 && sizeof(gpgp::shader::CanvasCounters) == 160 &&
              sizeof(gpgp::shader::TilePatchRecord) == 64 && sizeof(gpgp::shader::PatchItemRecord) == 112 &&
              sizeof(gpgp::shader::PatchPlaceRecord) == 16 && sizeof(gpgp::shader::PatchTableRecord) == 32 &&
              sizeof(gpgp::shader::FlatSegmentRecord) == 24);
#endif
#endif
