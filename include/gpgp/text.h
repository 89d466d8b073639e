/* gpgp text: fonts, shaping and layout on the CPU. It has a library of its own, libgpgp_text (FreeType, HarfBuzz,
 * FriBidi, ICU). The library needs neither a device nor a context: use it with libgpgp, in a tool, or alone.
 *
 *   font     A face of a font file at chosen values of its variation axes: metrics, and glyphs as GpgpPath.
 *   shaper   Turns runs of characters into glyphs and caches the results within a budget. Used by one thread at a time.
 *   layout   A text with styles, broken into lines: placed glyphs, decorations, carets, selections, hit tests.
 *
 *   gpgpCreateFont -> gpgpCreateShaper -> gpgpCreateLayout -> gpgpSetLayoutText, again for each new text
 *   -> gpgpGetLayoutInfo -> gpgpGetGlyphOutline for each glyph that the renderer does not have yet -> draw the glyphs
 *
 * Layout space: pixels, +X right, +Y down, origin at the layout's top left corner.
 * Glyph space: em (1 is the font's size), +X right, +Y down, origin on the baseline. A point p of a glyph lies at
 * (x, y) + size * p in layout space.
 * Positions in a text are byte offsets into the UTF-8 that was given. Text is horizontal.
 *
 * Memory comes from the C++ heap; FreeType, HarfBuzz, FriBidi and ICU use their own allocators. Destroyed handles are
 * not recognised, since there is no context: using one is undefined behaviour.
 */
#ifndef GPGP_TEXT_H
#define GPGP_TEXT_H
#include <gpgp/vector.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct GpgpFont_T* GpgpFont;
typedef struct GpgpShaper_T* GpgpShaper;
typedef struct GpgpLayout_T* GpgpLayout;

/** Four letters that name a variation axis or an OpenType feature, for example GPGP_TAG('w', 'g', 'h', 't'). */
typedef uint32_t GpgpTag;
#define GPGP_TAG(a, b, c, d)                                                                                           \
  (((uint32_t)(uint8_t)(a) << 24) | ((uint32_t)(uint8_t)(b) << 16) | ((uint32_t)(uint8_t)(c) << 8) |                   \
   (uint32_t)(uint8_t)(d))

/* ---------------------------------------------------------------- fonts */

/** The value of one variation axis. */
typedef struct GpgpFontAxisValue {
  GpgpTag tag;
  float value;
} GpgpFontAxisValue;

typedef struct GpgpFontCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label; /**< for messages; NULL: the file path */
  /* Give exactly one of data and filePath. */
  const void* data; /**< a TTF, OTF (CFF, CFF2) or TTC file in memory */
  size_t size;
  VkBool32 keepData; /**< VK_TRUE: data stays in place until the font is destroyed. VK_FALSE: data is copied. */
  const char* filePath;
  const GpgpFileSystem* fileSystem; /**< reads filePath; NULL: the C library does */
  uint32_t face;                    /**< index of the face in a collection */
  const GpgpFontAxisValue* axes;    /**< Axes that are not listed keep their default. */
  uint32_t axisCount;
  /** Receives the errors of this font's calls, and warnings about unsupported parts of glyphs. */
  GpgpMessageFn messageFn;
  void* messageUserData;
} GpgpFontCreateInfo;
#define GPGP_FONT_CREATE_INFO_INIT GPGP_INIT(GpgpFontCreateInfo, GPGP_STRUCTURE_FONT_CREATE_INFO)

/** Opens a face of a font.
 *  Errors: INVALID_DATA (not a font), UNSUPPORTED (a font without OpenType tables), INVALID_ARGUMENT (no such face or
 *  axis, or a value outside the axis's range), IO, INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call; data with keepData: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateFont(const GpgpFontCreateInfo* info, GpgpFont* font);

/** Closes a font. Layouts keep their glyphs and still answer all queries, but the font handles in them become invalid.
 *  No other thread may be using the font. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyFont(GpgpFont font);

/** A variation axis of a font. */
typedef struct GpgpFontAxis {
  GpgpTag tag;
  const char* name; /**< in English if the font has an English name */
  float minimum, normal, maximum;
  float value; /**< this font's value */
} GpgpFontAxis;

/** Bits: the kinds of colour glyphs in a font. */
typedef uint32_t GpgpFontColors;
enum {
  GPGP_FONT_COLOR_LAYERS = 1,  /**< COLR version 0: filled paths */
  GPGP_FONT_COLOR_PAINTS = 2,  /**< COLR version 1: filled paths and gradients */
  GPGP_FONT_COLOR_BITMAPS = 4, /**< CBDT or sbix: images */
  GPGP_FONT_COLOR_SVG = 8      /**< SVG glyphs; these are not read */
};

/** Names and metrics of a font. Lengths are in em. ascent reaches up from the baseline and descent down from it; both
 *  are usually positive. underlinePosition and strikePosition are y of the line's middle, +Y down from the baseline.
 *  Pointers stay valid until the font is destroyed. */
typedef struct GpgpFontInfo {
  GpgpStructureType sType;
  void* pNext;
  const char *family, *style;
  uint32_t unitsPerEm, glyphCount, face, faceCount;
  float ascent, descent, lineGap;
  float capHeight, xHeight; /**< 0: the font does not state it */
  float underlinePosition, underlineThickness;
  float strikePosition, strikeThickness;
  float subscript, superscript; /**< how far below and above the baseline they lie */
  GpgpFontColors colors;
  uint32_t paletteCount;
  const GpgpFontAxis* axes;
  uint32_t axisCount;
} GpgpFontInfo;
#define GPGP_FONT_INFO_INIT GPGP_INIT(GpgpFontInfo, GPGP_STRUCTURE_FONT_INFO)

/** Returns a font's names, and its metrics at the values of its axes. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetFontInfo(GpgpFont font, GpgpFontInfo* info);

/** Returns the glyph that a font maps a character (a code point) to, before any shaping; 0 if it has none.
 *  @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetNominalGlyph(GpgpFont font, uint32_t character, uint32_t* glyph);

/* ---------------------------------------------------------------- glyphs */

/** Replaces one colour of a palette. */
typedef struct GpgpPaletteColor {
  uint32_t entry; /**< index in the palette */
  float color[4]; /**< linear RGB, straight alpha */
} GpgpPaletteColor;

typedef struct GpgpGlyphOutlineInfo {
  GpgpStructureType sType;
  const void* pNext;
  uint32_t glyph;
  VkBool32 plain; /**< VK_TRUE: the plain outline, also of a colour glyph */
  /** The text's colour: linear RGB, straight alpha, 0 to 1; all 0: opaque black. For a glyph set make it opaque, as
   *  each instance brings its own alpha. */
  float color[4];
  uint32_t palette;               /**< palette of a colour font; if the font does not have it, its first palette */
  const GpgpPaletteColor* colors; /**< replace colours of the palette */
  uint32_t colorCount;
  /** Outlined text: every path is stroked with this. Lengths are in em, `scale` is in pixels per em. The glyph's plain
   *  outline is used. A glyph without paths has no stroke. NULL: the glyph is filled. */
  const GpgpStroke* stroke;
} GpgpGlyphOutlineInfo;
#define GPGP_GLYPH_OUTLINE_INFO_INIT GPGP_INIT(GpgpGlyphOutlineInfo, GPGP_STRUCTURE_GLYPH_OUTLINE_INFO)

/** A glyph that is an image. */
typedef struct GpgpGlyphImage {
  const uint8_t* pixels; /**< RGBA, 8 bits each, sRGB, straight alpha; rows from the top, without gaps */
  uint32_t width, height;
  float box[4]; /**< where the image lies: left, top, right, bottom in em */
} GpgpGlyphImage;

/** A glyph as paths in em, +Y down, origin on the baseline. Outlines are not hinted. Quadratic curves stay quadratic,
 *  and cubics cubic. Paths are filled by non-zero winding and painted in order. A blank glyph has neither paths nor
 *  image. */
typedef struct GpgpGlyphOutline {
  uint32_t glyph;
  const GpgpPath* paths;
  uint32_t pathCount;
  /** One for each path. VK_TRUE: painted in the text's colour. VK_FALSE: painted in a colour of the font's. */
  const VkBool32* foreground;
  /** Box of the paths' points, control points included: left, top, right, bottom; all 0 without paths. A stroke
   *  reaches half its width beyond the box, and its miters further. */
  float box[4];
  /** Bitmap glyphs, and colour glyphs whose paints paths cannot show (sweep gradients, composite modes other than
   *  source-over, shapes in shapes): the image, instead of paths. Otherwise NULL. */
  const GpgpGlyphImage* image;
  /** VK_TRUE: part of the glyph is not supported (variations of paints, SVG). A warning names the glyph. */
  VkBool32 incomplete;
  /** VK_TRUE: the glyph is broken in the font. This is then the outline of glyph 0, or empty if that is broken too. A
   *  warning (INVALID_DATA) names the glyph. */
  VkBool32 broken;
} GpgpGlyphOutline;
/** Receives a glyph, on the thread that asked for it. @lifetime call */
typedef void(GPGP_CALL* GpgpGlyphFn)(void* userData, const GpgpGlyphOutline* outline);

/** Calls glyphFn once with a glyph's outline, colour layers or image. A broken glyph is not an error; see
 *  GpgpGlyphOutline::broken.
 *  Errors: INVALID_ARGUMENT (glyph >= glyphCount; a colour outside 0 to 1; a number of the stroke that is not finite,
 *  negative, or too large), INVALID_HANDLE. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetGlyphOutline(GpgpFont font, const GpgpGlyphOutlineInfo* info, GpgpGlyphFn glyphFn,
                                                  void* userData);

/** Characters (code points) from first to last, both included. */
typedef struct GpgpCharacterRange {
  uint32_t first, last; /**< at most 0x10ffff */
} GpgpCharacterRange;

/** Lists every glyph that a text of these characters can need, in any order, direction or language and with any
 *  features. Use it to choose what to bake, or what to add to a glyph set beforehand. Glyphs are sorted by number.
 *  They are:
 *
 *  - glyph 0, and the glyphs that the font maps the characters to;
 *  - composed characters and their parts, and mirrored brackets;
 *  - what GSUB makes of all these: ligatures, Arabic and Indic forms, small capitals, alternates;
 *  - what a layout adds: space, hyphens, ellipsis, dotted circle.
 *
 *  A font that substitutes glyphs with AAT tables returns all its glyphs.
 *
 *  count in: capacity of glyphs, out: number needed.
 *  INCOMPLETE: the capacity is too small. glyphs NULL asks for the count.
 *  Errors: INVALID_ARGUMENT (a range that ends before it begins, or beyond 0x10ffff), INVALID_HANDLE.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetGlyphClosure(GpgpFont font, const GpgpCharacterRange* ranges, uint32_t rangeCount,
                                                  uint32_t* count, uint32_t* glyphs);

/* ---------------------------------------------------------------- shaper */

typedef struct GpgpShaperCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  size_t cacheBytes;       /**< budget for shaped runs; the least recently used are evicted; 0: 1 MiB */
  GpgpMessageFn messageFn; /**< receives errors of the shaper's and its layouts' calls */
  void* messageUserData;
} GpgpShaperCreateInfo;
#define GPGP_SHAPER_CREATE_INFO_INIT GPGP_INIT(GpgpShaperCreateInfo, GPGP_STRUCTURE_SHAPER_CREATE_INFO)

/** Makes a shaper. The shaper and its layouts may be used by one thread at a time. Fonts may be shared between shapers
 *  of different threads.
 *  Errors: INVALID_STRUCT, OUT_OF_HOST_MEMORY, UNSUPPORTED (ICU does not find its data).
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateShaper(const GpgpShaperCreateInfo* info, GpgpShaper* shaper);

/** Destroys a shaper. Its layouts keep what they hold, but cannot take new text, and carets can no longer move by
 *  words. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyShaper(GpgpShaper shaper);

/** The shaper's cache of runs: totals since the shaper was made, and its present size. */
typedef struct GpgpShaperReport {
  GpgpStructureType sType;
  void* pNext;
  uint64_t hits, misses, evictions; /**< totals */
  size_t runs, bytes, cacheBytes;   /**< now; cacheBytes is the budget */
} GpgpShaperReport;
#define GPGP_SHAPER_REPORT_INIT GPGP_INIT(GpgpShaperReport, GPGP_STRUCTURE_SHAPER_REPORT)

/** Returns the state of the shaper's cache. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetShaperReport(GpgpShaper shaper, GpgpShaperReport* report);

/* ---------------------------------------------------------------- layout */

typedef struct GpgpFontFeature {
  GpgpTag tag;    /**< an OpenType feature, for example GPGP_TAG('s', 'm', 'c', 'p') */
  uint32_t value; /**< 0: off; 1: on; more: which alternate */
} GpgpFontFeature;

typedef struct GpgpTextStyle {
  /** Fonts in order of preference. Each grapheme takes the first font that has all its characters, with these
   *  exceptions:
   *
   *  - An emoji takes the first such font in colour. A character followed by U+FE0E takes the first without colour.
   *  - Digits, (C) and other characters that are text unless U+FE0F follows avoid colour fonts that have no letters.
   *    They take such a font only if no other font has them.
   *  - White space stays in the font of the preceding text, except after a colour emoji.
   *  - If no font has the whole grapheme, it begins in the font that has the most of its first characters. Each
   *    remaining mark takes the first font that has it.
   *  - A character that no font has is shaped with the preceding text and reported as missing. */
  const GpgpFont* fonts;
  uint32_t fontCount;
  float size;     /**< pixels per em; above 0, at most 100000 */
  float color[4]; /**< of glyphs and decorations; linear RGB, straight alpha, 0 to 1; all 0: opaque black */
  /** Pixels added after each grapheme, -100000 to 100000; negative values bring letters together. Any value other than
   *  0 disables optional ligatures. Ignored in scripts whose letters join. */
  float letterSpacing;
  /** BCP 47 tag such as "ja" or "tr"; NULL: none. It chooses forms of glyphs. The language of a paragraph's first
   *  character also decides where its lines may break. */
  const char* language;
  const GpgpFontFeature* features; /**< in addition to the features that are on by default */
  uint32_t featureCount;
  VkBool32 underline, strike;
  /** Outlined text: width in pixels, 0 to 100000, of a line along the glyphs' edges; 0: none. The line lies behind all
   *  glyphs of the text, so half its width shows around them.
   *
   *  The layout only checks outlineWidth and outlineColor; it reserves no space for the line. The engine finds them
   *  through a glyph's span, and draws each glyph once more. GpgpGlyphOutlineInfo::stroke is then outlineWidth / size
   *  em wide. */
  float outlineWidth;
  float outlineColor[4]; /**< linear RGB, straight alpha, 0 to 1; all 0: opaque black */
} GpgpTextStyle;

/** A part of the text with its own style. Where spans overlap, the later one counts. A grapheme takes the style of its
 *  first character. */
typedef struct GpgpTextSpan {
  uint32_t begin, end; /**< bytes */
  GpgpTextStyle style;
} GpgpTextSpan;

typedef int32_t GpgpTextDirection;
enum {
  GPGP_TEXT_AUTO = 0, /**< from each paragraph's first strong character; left to right if it has none */
  GPGP_TEXT_LEFT_TO_RIGHT = 1,
  GPGP_TEXT_RIGHT_TO_LEFT = 2
};

typedef int32_t GpgpTextAlign;
enum {
  GPGP_TEXT_ALIGN_START = 0, /**< left in a left-to-right paragraph, right in a right-to-left one */
  GPGP_TEXT_ALIGN_END = 1,   /**< the opposite of START */
  GPGP_TEXT_ALIGN_LEFT = 2,
  GPGP_TEXT_ALIGN_CENTER = 3,
  GPGP_TEXT_ALIGN_RIGHT = 4,
  /** Spaces and gaps between ideographs grow until the line is full. A paragraph's last line is aligned as START. */
  GPGP_TEXT_ALIGN_JUSTIFY = 5
};

typedef struct GpgpTextInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* text;    /**< UTF-8. Invalid bytes are replaced by U+FFFD and reported. */
  size_t size;         /**< bytes, below 2^31 */
  GpgpTextStyle style; /**< the style outside of spans */
  const GpgpTextSpan* spans;
  uint32_t spanCount;
  GpgpTextDirection direction;
  GpgpTextAlign align;
  /* The lengths below are 0 to 1e9. */
  /** Width in pixels into which lines are broken (UAX #14); a word that is longer is broken too. 0: lines end only at
   *  line breaks in the text. */
  float width;
  float height;      /**< height in pixels; lines that do not fit are cut off, except the first; 0: no limit */
  uint32_t maxLines; /**< 0: no limit */
  float lineSpacing; /**< factor on the fonts' own line distance; 0: 1 */
  float lineHeight;  /**< distance of lines in pixels, instead of the fonts'; 0: the fonts' */
  float tabWidth;    /**< distance of tab stops in pixels; 0: eight spaces */
  /** Null-terminated text at the end of a text that was cut off; NULL: U+2026, or three full stops if no font has
   *  that.
   *
   *  The last line is filled up to the ellipsis, within a word if necessary. The ellipsis takes the style of what
   *  precedes it, and is ordered as a separate part of its paragraph. Line breaks and tabs in it become spaces. It is
   *  shown whole, even if it is wider than the width. */
  const char* ellipsis;
} GpgpTextInfo;
#define GPGP_TEXT_INFO_INIT GPGP_INIT(GpgpTextInfo, GPGP_STRUCTURE_TEXT_INFO)

/** Makes an empty layout. Use it for one text after another: it keeps its memory. It belongs to the shaper's thread.
 *  Errors: INVALID_HANDLE, OUT_OF_HOST_MEMORY. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateLayout(GpgpShaper shaper, GpgpLayout* layout);

/** Destroys a layout. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyLayout(GpgpLayout layout);

/** Lays out a text, which replaces the previous one. After an error the layout still holds the previous text. Only
 *  after OUT_OF_HOST_MEMORY is it empty.
 *  Errors: INVALID_ARGUMENT (a style without a font, a number or colour out of range, a span beyond the text; the
 *  message names the span and the field), INVALID_HANDLE (a font, the shaper), INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpSetLayoutText(GpgpLayout layout, const GpgpTextInfo* info);

/** A placed glyph. Glyphs are sorted by line, and within a line from left to right. */
typedef struct GpgpTextGlyph {
  GpgpFont font;
  uint32_t glyph; /**< 0: the font's glyph for a missing character */
  float x, y;     /**< origin of the glyph, pixels */
  float size;     /**< pixels per em */
  float color[4];
  /** Byte offset of the first character that the glyph stands for. Several glyphs may share a character, and a glyph
   *  may stand for several characters. */
  uint32_t cluster;
  uint32_t line;
  uint32_t span; /**< 0: the style of the text; otherwise 1 + the index of the span */
} GpgpTextGlyph;

typedef struct GpgpTextLine {
  uint32_t begin, end;   /**< bytes, with the line break; a line that was cut off ends at its ellipsis */
  float left, width;     /**< without white space at the line's end, which hangs beyond it */
  float top, height;     /**< pixels */
  float baseline;        /**< y, pixels */
  float ascent, descent; /**< the largest of the line's fonts, pixels */
  uint32_t firstGlyph, glyphCount;
  VkBool32 rightToLeft; /**< the paragraph's direction */
  VkBool32 hardBreak;   /**< VK_TRUE: the line ends at a line break or at the end of the text */
} GpgpTextLine;

/** Pixels. x and y are the top left corner. */
typedef struct GpgpTextRect {
  float x, y, width, height;
} GpgpTextRect;

/** An underline, to be painted below the text's glyphs, or a strike, to be painted over them. */
typedef struct GpgpTextDecoration {
  GpgpTextRect rect;
  float color[4];
  uint32_t line, span; /**< as in GpgpTextGlyph */
  VkBool32 strike;     /**< VK_TRUE: a strike; VK_FALSE: an underline */
} GpgpTextDecoration;

typedef struct GpgpMissingCharacter {
  uint32_t offset;    /**< bytes */
  uint32_t character; /**< code point */
} GpgpMissingCharacter;

/** A text after layout. Pointers stay valid until the layout takes its next text. */
typedef struct GpgpLayoutInfo {
  GpgpStructureType sType;
  void* pNext;
  float width;  /**< of the widest line, pixels */
  float height; /**< of all lines, pixels */
  const GpgpTextGlyph* glyphs;
  uint32_t glyphCount;
  const GpgpTextLine* lines; /**< at least one for any text; the line of an empty text has its style's height */
  uint32_t lineCount;
  const GpgpTextDecoration* decorations;
  uint32_t decorationCount;
  /** Characters that no font of their style has. A missing character of the ellipsis has the ellipsis's offset. */
  const GpgpMissingCharacter* missing;
  uint32_t missingCount;
  const uint32_t* invalid; /**< byte offsets at which the text is not UTF-8 */
  uint32_t invalidCount;
  VkBool32 truncated; /**< VK_TRUE: maxLines or height cut something off */
} GpgpLayoutInfo;
#define GPGP_LAYOUT_INFO_INIT GPGP_INIT(GpgpLayoutInfo, GPGP_STRUCTURE_LAYOUT_INFO)

/** Returns everything that a renderer needs of a layout. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetLayoutInfo(GpgpLayout layout, GpgpLayoutInfo* info);

/* ---------------------------------------------------------------- layout: carets, selections, hit tests */

/** Returns rectangles that cover the characters between two byte offsets. Rectangles are as high as their lines.
 *  Within a line they are sorted from left to right, and adjacent ones are joined. Line breaks have no width. count
 *  in: capacity of rects, out: number needed.
 *  INCOMPLETE: the capacity is too small. rects NULL asks for the count. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetSelection(GpgpLayout layout, uint32_t begin, uint32_t end, uint32_t* count,
                                               GpgpTextRect* rects);

/** Position of a caret at an offset. Where the direction changes, two places belong to one offset: where the character
 *  at the offset begins (x), and where the preceding character ends (splitX). Where a line wraps, there are two places
 *  as well; gpgpGetCaret takes which one is meant. */
typedef struct GpgpCaret {
  float x, top, height; /**< pixels */
  uint32_t line;
  VkBool32 rightToLeft; /**< VK_TRUE: the character at the offset runs right to left, so it lies left of the caret */
  VkBool32 split;       /**< VK_TRUE: the preceding character ends elsewhere, at splitX */
  float splitX;
  VkBool32 splitRightToLeft; /**< direction of the preceding character */
} GpgpCaret;

/** Returns the caret at a byte offset. An offset within a grapheme counts as its start, and one beyond the text as the
 *  text's end.
 *
 *  trailing VK_TRUE: the caret belongs to the character before the offset. Where a line wraps, it then stands at the
 *  end of that line, not at the start of the next. Elsewhere trailing makes no difference. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetCaret(GpgpLayout layout, uint32_t offset, VkBool32 trailing, GpgpCaret* caret);

typedef struct GpgpTextHit {
  uint32_t offset;    /**< of the grapheme at the point, or of the nearest one in the nearest line */
  uint32_t insertion; /**< where a caret goes: the start of the grapheme or its end */
  /** VK_TRUE: the point lies in the half where the grapheme ends. Pass it with `insertion` to gpgpGetCaret to get a
   *  caret in this line. */
  VkBool32 trailing;
  VkBool32 inside; /**< VK_TRUE: the point lies on the grapheme and in its line */
  uint32_t line;
} GpgpTextHit;

/** Finds the grapheme at a point, given in pixels of the layout. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpHitTestLayout(GpgpLayout layout, float x, float y, GpgpTextHit* hit);

typedef int32_t GpgpCaretMove;
enum {
  GPGP_CARET_NEXT = 0,          /**< to the next grapheme in the order of the text */
  GPGP_CARET_PREVIOUS = 1,      /**< to the previous grapheme in the order of the text */
  GPGP_CARET_NEXT_WORD = 2,     /**< to the start of the next word (UAX #29), or to the end of the text */
  GPGP_CARET_PREVIOUS_WORD = 3, /**< to the start of this word, or of the previous one if the caret is there already */
  GPGP_CARET_WORD_BEGIN = 4,    /**< to the start of what a double click selects: a word, white space, or a sign */
  GPGP_CARET_WORD_END = 5,      /**< to the end of what a double click selects */
  GPGP_CARET_LINE_BEGIN = 6,
  /** To the end of the line: before its line break, or before the white space at which it wraps. If it wraps without
   *  white space, to its end with trailing set. */
  GPGP_CARET_LINE_END = 7
};

/** Returns the offset to which a caret moves. trailing in: as in gpgpGetCaret, for the caret at offset; out: for the
 *  caret at moved. NULL: VK_FALSE in, not returned. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpMoveCaret(GpgpLayout layout, uint32_t offset, GpgpCaretMove move, uint32_t* moved,
                                            VkBool32* trailing);

#ifdef __cplusplus
}
#endif
#endif
