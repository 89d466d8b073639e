/* gpgp/svg.h: SVG to baked drawings (vector.h). Everything here is in libgpgp_compiler. */
#ifndef GPGP_SVG_H
#define GPGP_SVG_H
#include <gpgp/paths.h>
#ifdef __cplusplus
extern "C" {
#endif

/** What gpgpCompileSvg found in an SVG, and how long it took. */
typedef struct GpgpSvgReport {
  uint32_t paths, curves, patches;
  double parseMilliseconds;   /**< from bytes to paths */
  double convertMilliseconds; /**< from paths to CPatches, strokes included */
} GpgpSvgReport;

/** Receives one stage of the conversion as an SVG file, for debugging. Its text is not null-terminated. @lifetime call
 */
typedef void(GPGP_CALL* GpgpStageFn)(void* userData, const char* stage, const char* svg, size_t size);

/** Receives an image of an `image` or `feImage` element: a PNG, JPEG or other file that the element embeds as a data:
 *  URI, or that `fileSystem` reads. An image that several elements share is passed once.
 *
 *  To accept the image, the callback writes its size in pixels and returns VK_TRUE. The drawing then paints with image
 *  number `index` (GpgpImagePaint::image), and the engine passes a texture of it to recordings. If the callback
 *  returns VK_FALSE, the element is reported as unsupported. @lifetime call */
typedef VkBool32(GPGP_CALL* GpgpSvgImageFn)(void* userData, uint32_t index, const void* data, size_t size,
                                            uint32_t* width, uint32_t* height);

/** A run of an SVG's text in one style. */
typedef struct GpgpSvgTextSpan {
  uint32_t begin, end;  /**< bytes of the text */
  const char* families; /**< as font-family lists them, for example "Arial, 'DejaVu Sans', serif"; may be empty */
  const char* language; /**< BCP 47; may be empty */
  float size;           /**< units per em, above 0 */
  float weight;         /**< 1 to 1000; 400 is regular */
  float letterSpacing;  /**< units after each grapheme */
  VkBool32 italic, smallCaps, unkerned; /**< unkerned: kerning is off */
  VkBool32 unligated;                   /**< optional ligatures are off */
  float stretch;                        /**< percent, as of font-stretch: 50 is ultra-condensed, 100 or 0 normal */
  VkBool32 vertical;                    /**< the line goes down: fonts may have glyphs of their own for it */
} GpgpSvgTextSpan;

/** A line of an SVG's text. Spans cover it without gaps, in order. */
typedef struct GpgpSvgText {
  const char* text; /**< UTF-8, not terminated */
  uint32_t size;    /**< bytes */
  const GpgpSvgTextSpan* spans;
  uint32_t spanCount;
  VkBool32 rightToLeft; /**< the direction of the whole line */
} GpgpSvgText;

/** A placed glyph of a line. */
typedef struct GpgpSvgGlyph {
  uint32_t cluster;      /**< offset of the first byte that the glyph stands for */
  float x, y;            /**< origin in units, relative to the left end of the line's baseline; +Y down */
  float advance;         /**< distance to the next cluster in units; 0 for all glyphs of a cluster but the first */
  float size;            /**< units per em */
  const GpgpPath* paths; /**< in em, +Y down, as gpgpGetGlyphOutline returns them */
  uint32_t pathCount;
  const VkBool32* foreground; /**< one for each path; VK_TRUE: painted as the SVG says. NULL: all are */
  /** Of the glyph's font, in em, as in GpgpFontInfo. */
  float ascent, descent, xHeight, underlinePosition, underlineThickness, strikePosition, strikeThickness;
  float subscript, superscript; /**< how far they lie below and above the baseline */
  VkBool32 incomplete;          /**< VK_TRUE: a part of the glyph is neither among the paths nor the image */
  /** A bitmap glyph's image, which goes to GpgpSvgSource::imageFn as a PNG file; NULL: it has none. RGBA, 8 bits each,
   *  sRGB, straight alpha; rows from the top, without gaps. */
  const uint8_t* image;
  uint32_t imageWidth, imageHeight;
  float imageBox[4]; /**< where it lies: left, top, right, bottom in em, +Y down */
  VkBool32 vertical; /**< VK_TRUE: the font's own glyph for vertical lines, in which it stands upright */
} GpgpSvgGlyph;
typedef void(GPGP_CALL* GpgpSvgGlyphFn)(void* glyphUserData, const GpgpSvgGlyph* glyph);
/** Shapes a line, and calls glyphFn for each of its glyphs from left to right. Any other result than SUCCESS leaves
 *  the line out, and a warning says so. */
typedef GpgpResult(GPGP_CALL* GpgpSvgTextFn)(void* userData, const GpgpSvgText* text, GpgpSvgGlyphFn glyphFn,
                                             void* glyphUserData);

typedef struct GpgpSvgSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< file name, for messages */
  const void* data; /**< an SVG file, plain or gzip-compressed (.svgz) */
  size_t size;
  /** Receives errors. Also receives warnings about unsupported elements (code UNSUPPORTED) and invalid ones
   *  (INVALID_DATA), which name the element. The message's label is the place, "file:line:column". The file may be a
   *  style sheet. Where no line is known, the label is the name alone. */
  GpgpMessageFn messageFn;
  void* messageUserData;
  const GpgpJobSystem* jobSystem; /**< optional: converts paths in parallel */
  GpgpSvgReport* report;          /**< optional: written when the import succeeds */
  GpgpStageFn stageFn;            /**< optional: called for "paths", "pieces", "crossings", "patches", in this order */
  void* stageUserData;
  /** Optional: accepts images, at most GPGP_MAX_IMAGES. NULL: images are reported as unsupported. */
  GpgpSvgImageFn imageFn;
  void* imageUserData;
  /** Largest scale at which the drawing is shown, pixels per pixel of its page; 0: 1. Up to this scale, strokes are
   *  accurate to a twentieth of a pixel and arcs to 1e-4. Non-scaling strokes have their stated width at this scale. */
  float scale;
  /** Optional: reads external style sheets and images. Paths are relative to the SVG's folder. Only files in that
   *  folder or below it are read, and nothing is fetched from a network. At most 64 style sheets of 16 MiB together and
   *  images of 64 MiB together are read. NULL: other files are reported as unsupported. */
  const GpgpFileSystem* fileSystem;
  /** Which representations the file holds; 0: GPGP_DRAWING_FLATTENED. Warnings name elements that patches cannot draw
   *  (GpgpDrawingCreateInfo::methods). With GPGP_DRAWING_IN_PASS, masks, filters and blend modes are left out, and
   *  warnings name them. */
  GpgpDrawingMethods methods;
  /** Optional: shapes text in the engine's fonts, for example with libgpgp_text. NULL: text is reported as
   *  unsupported. */
  GpgpSvgTextFn textFn;
  void* textUserData;
  /** VkPhysicalDeviceLimits::maxStorageBufferRange of the devices that the drawing is for; 0: 2^32 - 1. A drawing whose
   *  outlines need more than four times as many bytes is refused (UNSUPPORTED) as soon as that is known, not after all
   *  of it was converted. */
  uint32_t maxStorageBufferRange;
} GpgpSvgSource;
#define GPGP_SVG_SOURCE_INIT GPGP_INIT(GpgpSvgSource, GPGP_STRUCTURE_SVG_SOURCE)

/** Converts an SVG to a baked drawing (.gpgpv). In libgpgp_compiler. Free the blob with gpgpFreeBlob.
 *  Errors: INVALID_DATA (not an SVG), INVALID_ARGUMENT, UNSUPPORTED (too many outlines), OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileSvg(const GpgpSvgSource* source, GpgpBlob* blob);

#ifdef __cplusplus
}
#endif
#endif
