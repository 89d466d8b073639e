/* The plugin's functions for scripts: Gpgp.cs calls these. C99.
 *
 * Objects (drawings, fonts, texts, canvases) have numbers above 0. Functions that make one return it, or a negative
 * GpgpResult; what went wrong then waits in gpgpUnityTakeMessage. All may be called from any thread. What is shown
 * changes with the next event that is issued for the canvas. */
#ifndef GPGP_UNITY_H
#define GPGP_UNITY_H
#include <stdint.h>

#if defined(_WIN32)
#define GPGP_UNITY_CALL __stdcall
#define GPGP_UNITY_API __declspec(dllexport)
#else
#define GPGP_UNITY_CALL
#define GPGP_UNITY_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum {
  GPGP_UNITY_OFF = 0,  /* Unity does not render with Vulkan, or has not begun to */
  GPGP_UNITY_READY = 1 /* negative: a GpgpResult that tells why not; a message says more */
};
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityGetState(void);
/** The oldest message, terminated, as much of it as fits; returns its length, 0 where there is none. At most 64 wait,
 *  later ones are dropped. */
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityTakeMessage(char* text, int32_t capacity);

/** For CommandBuffer.IssuePluginEventAndData: the function, the event's id; its data is the canvas's number. */
GPGP_UNITY_API void* GPGP_UNITY_CALL gpgpUnityGetEvent(void);
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityGetEventId(void);

/** What a frame may take, for all canvases together; 0: as it is (2048 x 2048 pixels a canvas, and
 * GpgpCanvasCreateInfo's own). Makes pipelines: while a level loads, not in a frame. */
typedef struct GpgpUnityBudgets {
  uint32_t maxWidth, maxHeight, maxTileEntries, maxPaths, maxGlyphs;
  uint32_t maxItems;  /* drawings and texts; a text with emoji that are pictures counts twice */
  uint32_t maxShapes; /* emoji that are pictures, at each place that they are shown at */
} GpgpUnityBudgets;
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnitySetBudgets(const GpgpUnityBudgets* budgets);

/** From an SVG file's bytes, or from a baked drawing's (baked != 0). */
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityCreateDrawing(const void* data, int32_t size, int32_t baked);
/** The page of a drawing (x, y, width, height), or the box of a text's lines, in its units. */
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityGetBox(int32_t object, float* box);
/** From a font file's bytes, which are copied. */
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityCreateFont(const void* data, int32_t size);
/** Fonts for what this one does not have, asked in their order, in texts that are laid out from now on. Where one of
 *  the fonts of a text is destroyed, the text is left out until it is set anew. */
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnitySetFallbacks(int32_t font, const int32_t* fallbacks, int32_t count);

typedef struct GpgpUnityText {
  const char* text; /* UTF-8 */
  int32_t size;     /* bytes */
  int32_t font;
  float pixels;   /* an em */
  float color[4]; /* linear, straight alpha */
  float width;    /* lines break to fit; 0: only where the text says */
  int32_t align;  /* GpgpTextAlign */
} GpgpUnityText;
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityCreateText(const GpgpUnityText* text);
/** Another text in place of it. */
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnitySetText(int32_t object, const GpgpUnityText* text);

typedef struct GpgpUnityItem {
  int32_t object;     /* a drawing or a text */
  float transform[6]; /* its units to pixels, y down: x' = t0 x + t2 y + t4, y' = t1 x + t3 y + t5 */
  float opacity;
} GpgpUnityItem;

enum {
  GPGP_UNITY_FLIP = 1,       /* the first row of pixels is the lowest, as Unity samples render textures */
  GPGP_UNITY_ENCODE_SRGB = 2 /* colours are stored sRGB-encoded, and mix so: a project in gamma space */
};
typedef struct GpgpUnityCanvas {
  void* texture; /* RenderTexture.GetNativeTexturePtr: R8G8B8A8_UNorm or R16G16B16A16_SFloat, enableRandomWrite, one
                    sample. NULL: nothing is drawn; say so before the texture is released */
  uint32_t flags;
  float background[4]; /* premultiplied */
  const GpgpUnityItem* items;
  int32_t itemCount;
} GpgpUnityCanvas;
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnityCreateCanvas(void);
GPGP_UNITY_API int32_t GPGP_UNITY_CALL gpgpUnitySetCanvas(int32_t canvas, const GpgpUnityCanvas* info);

/** Any object. Its number is never used again; items that name it are left out. */
GPGP_UNITY_API void GPGP_UNITY_CALL gpgpUnityDestroy(int32_t object);

#ifdef __cplusplus
}
#endif
#endif
