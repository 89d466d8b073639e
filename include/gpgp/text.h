/* gpgp text: fonts, shaping and layout on the CPU. In a library of its own, libgpgp_text (FreeType, HarfBuzz, FriBidi,
 * ICU), which knows no device and no context: use it with libgpgp, in a tool, or alone.
 *
 *   font     a face of a font file at chosen variation axes: metrics, and glyphs as GpgpPath
 *   shaper   turns runs of characters into glyphs and keeps them within a budget; one thread's
 *   layout   a text with styles, broken into lines: glyphs with places, decorations, carets, selections, hit tests
 *
 *   gpgpCreateFont -> gpgpCreateShaper -> gpgpCreateLayout -> gpgpSetLayoutText, again for each new text
 *   -> gpgpGetLayoutInfo -> for each glyph that is new: gpgpGetGlyphOutline -> draw at its places
 *
 * Spaces: a layout is in pixels, x right, y down, origin at its upper left corner. A glyph is in em (1 is the font's
 * size), x right, y down, origin on the baseline: a point of a glyph lies at (x, y) + size * point of the layout.
 * Places in a text are byte offsets into the UTF-8 that was given. Text is horizontal.
 *
 * Memory: the C++ heap; the libraries behind use theirs. A destroyed handle must not be used: there is no context that
 * could tell.
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

/** Four letters that name an axis or a feature: GPGP_TAG('w', 'g', 'h', 't'). */
typedef uint32_t GpgpTag;
#define GPGP_TAG(a, b, c, d)                                                                                           \
  (((uint32_t)(uint8_t)(a) << 24) | ((uint32_t)(uint8_t)(b) << 16) | ((uint32_t)(uint8_t)(c) << 8) |                   \
   (uint32_t)(uint8_t)(d))

/* ---------------------------------------------------------------- fonts */

typedef struct GpgpFontAxisValue {
  GpgpTag tag;
  float value;
} GpgpFontAxisValue;

typedef struct GpgpFontCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label; /**< for messages; NULL: the file path */
  /* exactly one of data and filePath: */
  const void* data; /**< TTF, OTF (CFF, CFF2), TTC */
  size_t size;
  VkBool32 keepData; /**< data stays where it is until the font is destroyed; else it is copied */
  const char* filePath;
  const GpgpFileSystem* fileSystem; /**< reads filePath; NULL: the C library */
  uint32_t face;                    /**< of a collection */
  const GpgpFontAxisValue* axes;    /**< those that are not named keep their default */
  uint32_t axisCount;
  GpgpMessageFn messageFn; /**< errors of this font's calls, and as warnings what a glyph has that is not supported */
  void* messageUserData;
} GpgpFontCreateInfo;
#define GPGP_FONT_CREATE_INFO_INIT GPGP_INIT(GpgpFontCreateInfo, GPGP_STRUCTURE_FONT_CREATE_INFO)

/** Opens a face of a font.
 *  Errors: INVALID_DATA (not a font), UNSUPPORTED (a font without OpenType tables), INVALID_ARGUMENT (a face that is
 *  not there, an axis that it has not, a value beyond the axis), IO, INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads any @lifetime call; data with keepData: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateFont(const GpgpFontCreateInfo* info, GpgpFont* font);

/** Closes a font. Layouts keep their glyphs and answer as before, but the font that these name is gone. NULL is
 *  ignored. No other thread may be using the font. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyFont(GpgpFont font);

typedef struct GpgpFontAxis {
  GpgpTag tag;
  const char* name; /**< English where the font has that */
  float minimum, normal, maximum;
  float value; /**< of this font */
} GpgpFontAxis;

typedef uint32_t GpgpFontColors;
enum {
  GPGP_FONT_COLOR_LAYERS = 1,  /**< COLR version 0: filled paths */
  GPGP_FONT_COLOR_PAINTS = 2,  /**< COLR version 1: filled paths and gradients */
  GPGP_FONT_COLOR_BITMAPS = 4, /**< CBDT, sbix: images */
  GPGP_FONT_COLOR_SVG = 8      /**< SVG: not read */
};

/** What a font says of itself. Lengths are in em, y down: ascent is above, descent below the baseline, both positive
 *  as a rule; positions are those of a line's middle. Pointers live as long as the font. */
typedef struct GpgpFontInfo {
  GpgpStructureType sType;
  void* pNext;
  const char *family, *style;
  uint32_t unitsPerEm, glyphCount, face, faceCount;
  float ascent, descent, lineGap;
  float capHeight, xHeight; /**< 0: the font does not say */
  float underlinePosition, underlineThickness;
  float strikePosition, strikeThickness;
  GpgpFontColors colors;
  uint32_t paletteCount;
  const GpgpFontAxis* axes;
  uint32_t axisCount;
} GpgpFontInfo;
#define GPGP_FONT_INFO_INIT GPGP_INIT(GpgpFontInfo, GPGP_STRUCTURE_FONT_INFO)

/** Names and metrics of a font, at its axes. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetFontInfo(GpgpFont font, GpgpFontInfo* info);

/** The glyph that a font has for a character (a code point), before any shaping; 0 where it has none.
 *  @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetNominalGlyph(GpgpFont font, uint32_t character, uint32_t* glyph);

/* ---------------------------------------------------------------- glyphs */

/** A colour in place of a palette's. */
typedef struct GpgpPaletteColor {
  uint32_t entry;
  float color[4]; /**< linear RGB, straight alpha */
} GpgpPaletteColor;

typedef struct GpgpGlyphOutlineInfo {
  GpgpStructureType sType;
  const void* pNext;
  uint32_t glyph;
  VkBool32 plain;                 /**< the outline without colours, also of a colour glyph */
  float color[4];                 /**< linear RGB, straight alpha, 0 to 1, of what is painted in the text's colour; all
                                       0: opaque black. For a glyph set opaque: an instance's alpha comes to it */
  uint32_t palette;               /**< of a colour font; one that it has not: its first */
  const GpgpPaletteColor* colors; /**< in place of the palette's */
  uint32_t colorCount;
  const GpgpStroke* stroke; /**< outline text: lengths in em, scale in pixels an em. Set on each path as it is, and
                                 the glyph is then plain; a glyph without paths has none; NULL: filled */
} GpgpGlyphOutlineInfo;
#define GPGP_GLYPH_OUTLINE_INFO_INIT GPGP_INIT(GpgpGlyphOutlineInfo, GPGP_STRUCTURE_GLYPH_OUTLINE_INFO)

/** A glyph that is a picture. */
typedef struct GpgpGlyphImage {
  const uint8_t* pixels; /**< RGBA, sRGB, straight alpha, rows from the top without gaps */
  uint32_t width, height;
  float box[4]; /**< where it belongs: left, top, right, bottom in em */
} GpgpGlyphImage;

/** A glyph as paths in em, y down, origin on the baseline; unhinted, quadratics as quadratics and cubics as cubics,
 *  filled by non-zero winding, to be painted in order. Nothing for a glyph without ink. */
typedef struct GpgpGlyphOutline {
  uint32_t glyph;
  const GpgpPath* paths;
  uint32_t pathCount;
  const VkBool32* foreground; /**< for each path: it is painted in the text's colour, not one of the font's */
  float box[4]; /**< of the paths' points, control points too: left, top, right, bottom; 0 without paths. A stroke
                     reaches half its width beyond, and its miters further */
  const GpgpGlyphImage* image; /**< instead of paths, for bitmap glyphs; NULL otherwise */
  VkBool32 incomplete; /**< it has something that is not supported (sweep gradients, composite modes other than source
                            over, SVG); a warning names the glyph */
  VkBool32 broken; /**< the font is broken there, and this is glyph 0's outline, or nothing where that is broken, too;
                        a warning (INVALID_DATA) names the glyph */
} GpgpGlyphOutline;
/** Receives a glyph, on the thread that asked for it. @lifetime call */
typedef void(GPGP_CALL* GpgpGlyphFn)(void* userData, const GpgpGlyphOutline* outline);

/** Hands a glyph's outline, colour layers or image to `glyphFn`, once. A glyph that is broken is no error: see
 *  GpgpGlyphOutline::broken.
 *  Errors: INVALID_ARGUMENT (a glyph beyond glyphCount; a colour that is not 0 to 1; a stroke's number that is not
 *  finite, negative, or too large), INVALID_HANDLE.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetGlyphOutline(GpgpFont font, const GpgpGlyphOutlineInfo* info, GpgpGlyphFn glyphFn,
                                                  void* userData);

/** Characters (code points) from the first to the last, both included. */
typedef struct GpgpCharacterRange {
  uint32_t first, last; /**< at most 0x10ffff */
} GpgpCharacterRange;

/** Every glyph that a text of these characters may need, whatever its order, direction, language and features, in the
 *  order of their numbers: what to bake, or to add beforehand. That is glyph 0; the characters' own glyphs; what is
 *  composed of them, and their parts; mirrored brackets; what GSUB makes of these (ligatures, forms of Arabic and Indic
 *  letters, small capitals, alternates); and what a layout adds: space, hyphens, ellipsis, dotted circle. A font that
 *  substitutes by AAT's tables gives all its glyphs.
 *  count: in: room in glyphs, out: needed; INCOMPLETE where that is more. glyphs NULL: only counts.
 *  Errors: INVALID_ARGUMENT (a range that ends before it begins, or beyond 0x10ffff), INVALID_HANDLE.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetGlyphClosure(GpgpFont font, const GpgpCharacterRange* ranges, uint32_t rangeCount,
                                                  uint32_t* count, uint32_t* glyphs);

/* ---------------------------------------------------------------- shaper */

typedef struct GpgpShaperCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;
  size_t cacheBytes;       /**< for shaped runs, the least recently used leave first; 0: 1 MiB */
  GpgpMessageFn messageFn; /**< errors of the shaper's and its layouts' calls */
  void* messageUserData;
} GpgpShaperCreateInfo;
#define GPGP_SHAPER_CREATE_INFO_INIT GPGP_INIT(GpgpShaperCreateInfo, GPGP_STRUCTURE_SHAPER_CREATE_INFO)

/** Makes a shaper. It and its layouts belong to one thread at a time; fonts may be shared with other threads' shapers.
 *  Errors: INVALID_STRUCT, OUT_OF_HOST_MEMORY, UNSUPPORTED (ICU finds no data). @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateShaper(const GpgpShaperCreateInfo* info, GpgpShaper* shaper);

/** Destroys a shaper; its layouts keep what they have but take no new text and know no words. NULL is ignored. @threads
 * handle */
GPGP_API void GPGP_CALL gpgpDestroyShaper(GpgpShaper shaper);

/** Since the shaper was made; runs and bytes: now. */
typedef struct GpgpShaperReport {
  GpgpStructureType sType;
  void* pNext;
  uint64_t hits, misses, evictions;
  size_t runs, bytes, cacheBytes;
} GpgpShaperReport;
#define GPGP_SHAPER_REPORT_INIT GPGP_INIT(GpgpShaperReport, GPGP_STRUCTURE_SHAPER_REPORT)

/** How the cache of runs does. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetShaperReport(GpgpShaper shaper, GpgpShaperReport* report);

/* ---------------------------------------------------------------- layout */

typedef struct GpgpFontFeature {
  GpgpTag tag;    /**< of OpenType, e.g. GPGP_TAG('s', 'm', 'c', 'p') */
  uint32_t value; /**< 0: off, 1: on, more: which alternate */
} GpgpFontFeature;

typedef struct GpgpTextStyle {
  /** A grapheme takes the first font that has all its characters. Emoji take the first of those in colour, and what
   *  U+FE0E wants as text the first of the others. Digits, (C) and other characters that are text unless U+FE0F follows
   *  take a font in colour without letters only where no other has them. White space goes with what is before it, but
   *  for emoji in colour. A grapheme that no font has whole begins in the font that has most of its beginning; marks
   *  that are left take the first that has them. What none has is shaped with what is before it, and is reported as
   *  missing. */
  const GpgpFont* fonts;
  uint32_t fontCount;
  float size;           /**< pixels an em; more than 0, at most 100000 */
  float color[4];       /**< linear RGB, straight alpha, 0 to 1, of glyphs and decorations; all 0: opaque black */
  float letterSpacing;  /**< pixels after each grapheme, -100000 to 100000, negative ones bring letters together; other
                             than 0, optional ligatures are off. Not in scripts that join their letters */
  const char* language; /**< BCP 47, e.g. "ja" or "tr"; chooses forms of glyphs and, of a paragraph's first character,
                             where lines break; NULL: none */
  const GpgpFontFeature* features; /**< beyond those that are on by default */
  uint32_t featureCount;
  VkBool32 underline, strike;
  /** Of outlined text: a line along the glyphs' edges, painted below all glyphs of the text, so that half its width
   *  shows around them. It takes no room and is not used by the layout, which checks it: the engine finds it by a
   *  glyph's span and draws each glyph once more, with GpgpGlyphOutlineInfo::stroke as wide as outlineWidth / size. */
  float outlineWidth;    /**< pixels, 0 to 100000; 0: none */
  float outlineColor[4]; /**< linear RGB, straight alpha, 0 to 1; all 0: opaque black */
} GpgpTextStyle;

/** A part of the text with a style of its own. Where spans overlap the later counts. A grapheme is shaped in the style
 *  of its first character. */
typedef struct GpgpTextSpan {
  uint32_t begin, end; /**< bytes */
  GpgpTextStyle style;
} GpgpTextSpan;

typedef int32_t GpgpTextDirection;
enum {
  GPGP_TEXT_AUTO = 0, /**< of each paragraph's first strong character; left to right where there is none */
  GPGP_TEXT_LEFT_TO_RIGHT = 1,
  GPGP_TEXT_RIGHT_TO_LEFT = 2
};

typedef int32_t GpgpTextAlign;
enum {
  GPGP_TEXT_ALIGN_START = 0, /**< left in a paragraph from left to right */
  GPGP_TEXT_ALIGN_END = 1,
  GPGP_TEXT_ALIGN_LEFT = 2,
  GPGP_TEXT_ALIGN_CENTER = 3,
  GPGP_TEXT_ALIGN_RIGHT = 4,
  GPGP_TEXT_ALIGN_JUSTIFY = 5 /**< spaces, and gaps between ideographs, grow; a paragraph's last line is at its start */
};

typedef struct GpgpTextInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* text;    /**< UTF-8. Bytes that are not are replaced by U+FFFD and reported */
  size_t size;         /**< bytes, below 2^31 */
  GpgpTextStyle style; /**< where there is no span */
  const GpgpTextSpan* spans;
  uint32_t spanCount;
  GpgpTextDirection direction;
  GpgpTextAlign align;
  /* lengths: 0 to 1e9 */
  float width;  /**< lines break to fit this (UAX #14; within a word that is longer); 0: only where the text says */
  float height; /**< lines that do not fit this are cut off, but for the first; 0: any */
  uint32_t maxLines;    /**< 0: any */
  float lineSpacing;    /**< times the fonts' own distance of lines; 0: 1 */
  float lineHeight;     /**< pixels between lines instead; 0: the fonts' */
  float tabWidth;       /**< pixels between tab stops; 0: eight spaces */
  const char* ellipsis; /**< terminated; ends a text that was cut off, whose last line is filled up to it, with a part
                             of a word, too; in the style of what is before it, ordered as a part of its paragraph by
                             itself, line breaks and tabs as spaces, whole also where it is wider than the width; NULL:
                             U+2026, or three full stops where no font has that */
} GpgpTextInfo;
#define GPGP_TEXT_INFO_INIT GPGP_INIT(GpgpTextInfo, GPGP_STRUCTURE_TEXT_INFO)

/** Makes an empty layout, to be used for one text after another: it keeps its memory. It is of the shaper's thread.
 *  Errors: INVALID_HANDLE, OUT_OF_HOST_MEMORY. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateLayout(GpgpShaper shaper, GpgpLayout* layout);

/** Destroys a layout. NULL is ignored. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyLayout(GpgpLayout layout);

/** Lays out a text in place of the one before, which stays where there is an error, but where memory runs out: then
 *  the layout is empty.
 *  Errors: INVALID_ARGUMENT (a style without font, a number or colour out of its range, a span beyond the text; names
 *  the span and what of it),
 *  INVALID_HANDLE (a font, the shaper), INVALID_STRUCT, OUT_OF_HOST_MEMORY.
 *  @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpSetLayoutText(GpgpLayout layout, const GpgpTextInfo* info);

/** A glyph at its place. Lines follow each other; within a line glyphs go from left to right. */
typedef struct GpgpTextGlyph {
  GpgpFont font;
  uint32_t glyph; /**< 0: the font's sign for a missing character */
  float x, y;     /**< of its origin, pixels */
  float size;     /**< pixels an em */
  float color[4];
  uint32_t cluster; /**< byte offset of the first character that it stands for, together with others maybe */
  uint32_t line;
  uint32_t span; /**< 0: the style of the text, else 1 + the index of the span */
} GpgpTextGlyph;

typedef struct GpgpTextLine {
  uint32_t begin, end; /**< bytes, with the line break; of a line that was cut off: up to the ellipsis */
  float left, width;   /**< without white space at its end, which hangs out */
  float top, height;
  float baseline;        /**< y */
  float ascent, descent; /**< the largest of its fonts, pixels */
  uint32_t firstGlyph, glyphCount;
  VkBool32 rightToLeft; /**< the paragraph's direction */
  VkBool32 hardBreak;   /**< ends where the text says, or the text ends */
} GpgpTextLine;

typedef struct GpgpTextRect {
  float x, y, width, height;
} GpgpTextRect;

/** An underline, to be painted below the glyphs of the text, or a strike, over them. */
typedef struct GpgpTextDecoration {
  GpgpTextRect rect;
  float color[4];
  uint32_t line, span;
  VkBool32 strike; /**< through the text; else under it */
} GpgpTextDecoration;

typedef struct GpgpMissingCharacter {
  uint32_t offset;
  uint32_t character; /**< code point */
} GpgpMissingCharacter;

/** A laid out text. Pointers live until the layout's next text. */
typedef struct GpgpLayoutInfo {
  GpgpStructureType sType;
  void* pNext;
  float width;  /**< of the widest line */
  float height; /**< of all lines */
  const GpgpTextGlyph* glyphs;
  uint32_t glyphCount;
  const GpgpTextLine* lines; /**< at least one for any text; an empty one's has its style's height */
  uint32_t lineCount;
  const GpgpTextDecoration* decorations;
  uint32_t decorationCount;
  const GpgpMissingCharacter* missing; /**< characters that no font of their style has; of an ellipsis: where it is */
  uint32_t missingCount;
  const uint32_t* invalid; /**< byte offsets where the text is not UTF-8 */
  uint32_t invalidCount;
  VkBool32 truncated; /**< something was cut off, by maxLines or height */
} GpgpLayoutInfo;
#define GPGP_LAYOUT_INFO_INIT GPGP_INIT(GpgpLayoutInfo, GPGP_STRUCTURE_LAYOUT_INFO)

/** All that a renderer needs of a layout. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetLayoutInfo(GpgpLayout layout, GpgpLayoutInfo* info);

/* ---------------------------------------------------------------- layout: carets, selections, hit tests */

/** Rectangles that cover the characters between two byte offsets, as high as their lines, from left to right within a
 *  line, neighbours joined; line breaks have no width. count: in: room in rects, out: needed; INCOMPLETE where that is
 *  more. rects NULL: only counts. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetSelection(GpgpLayout layout, uint32_t begin, uint32_t end, uint32_t* count,
                                               GpgpTextRect* rects);

/** Where a caret before the character at an offset stands. At a change of direction two places belong to one offset:
 *  where that character begins, and where the one before it ends. So they do where a line wraps, see gpgpGetCaret. */
typedef struct GpgpCaret {
  float x, top, height;
  uint32_t line;
  VkBool32 rightToLeft; /**< of the character at the offset: it lies left of the caret */
  VkBool32 split;       /**< the character before it ends elsewhere: at splitX */
  float splitX;
  VkBool32 splitRightToLeft; /**< of the character before */
} GpgpCaret;

/** The caret at a byte offset; within a grapheme: at its start; beyond the text: at its end. trailing: it belongs to
 * the character before the offset. Where a line wraps it then stands at that line's end, not at the next one's begin;
 *  elsewhere it is the same caret. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetCaret(GpgpLayout layout, uint32_t offset, VkBool32 trailing, GpgpCaret* caret);

typedef struct GpgpTextHit {
  uint32_t offset;    /**< of the grapheme that was hit; the nearest in the nearest line */
  uint32_t insertion; /**< where a caret goes: that offset, or the end of the grapheme */
  VkBool32 trailing;  /**< the half where it ends was hit; with `insertion` a caret of this line */
  VkBool32 inside;    /**< the point lies on the grapheme and in its line */
  uint32_t line;
} GpgpTextHit;

/** The grapheme at a point in pixels of the layout. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpHitTestLayout(GpgpLayout layout, float x, float y, GpgpTextHit* hit);

typedef int32_t GpgpCaretMove;
enum {
  GPGP_CARET_NEXT = 0,          /**< one grapheme on, in the order of the text */
  GPGP_CARET_PREVIOUS = 1,      /**< one grapheme back */
  GPGP_CARET_NEXT_WORD = 2,     /**< to the start of the next word (UAX #29), or the end of the text */
  GPGP_CARET_PREVIOUS_WORD = 3, /**< to the start of this word, or the one before */
  GPGP_CARET_WORD_BEGIN = 4,    /**< of what a double click selects: word, spaces or sign at the offset */
  GPGP_CARET_WORD_END = 5,
  GPGP_CARET_LINE_BEGIN = 6,
  GPGP_CARET_LINE_END = 7 /**< before the line break, or the white space where the line wraps; where it wraps without
                             any: its end, trailing */
};

/** The offset that a caret at an offset moves to. trailing: in: of the caret that moves, as in gpgpGetCaret, out: of
 *  the moved one; NULL: 0, and not asked for. @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpMoveCaret(GpgpLayout layout, uint32_t offset, GpgpCaretMove move, uint32_t* moved,
                                            VkBool32* trailing);

#ifdef __cplusplus
}
#endif
#endif
