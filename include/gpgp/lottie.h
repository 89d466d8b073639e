/* gpgp lottie: reads Lottie animations (.json, .lottie) and returns each frame as paths, groups and layers. In
 * libgpgp_compiler.
 *
 *   gpgpCreateLottie(&source, &lottie)               reads and checks the file once
 *   gpgpEvaluateLottie(lottie, frame, &picture)      what a frame shows, as gpgpCreateDrawing takes it
 *   gpgpCreateDrawing(context, ...paths, groups...)  converts it, for canvases with room for layers (layers.h)
 *
 * Frame numbers are those of the file and may be fractions. Nothing here needs a context or a device.
 */
#ifndef GPGP_LOTTIE_H
#define GPGP_LOTTIE_H
#include <gpgp/vector.h>
#ifdef __cplusplus
extern "C" {
#endif

/** An animation that was read. */
typedef struct GpgpLottie_T* GpgpLottie;

typedef struct GpgpLottieSource {
  GpgpStructureType sType;
  const void* pNext;
  const char* name; /**< file name, for messages */
  const void* data; /**< JSON, or a .lottie archive, whose first animation is taken; at most 64 MiB of JSON */
  size_t size;
  /** Receives errors. Also receives one warning for each kind of unsupported feature, with the first place that uses
   *  it. The message's label is "file:line:column" if the file is not JSON, otherwise "file: place", for example
   *  "spinner.json: layers[2].shapes[0].it[1]". Also called by gpgpEvaluateLottie and gpgpCompileLottieFrame. */
  GpgpMessageFn messageFn;
  void* messageUserData;
  /** Optional: accepts images, as for an SVG, at most GPGP_MAX_IMAGES. NULL: images are reported as unsupported. */
  GpgpSvgImageFn imageFn;
  void* imageUserData;
  /** Optional: reads images by paths relative to the animation's folder. Paths that lead out of this folder are not
   *  read. At most 64 MiB of images are read. */
  const GpgpFileSystem* fileSystem;
  /** Optional: shapes text of fonts whose glyphs the file does not hold. Called by gpgpEvaluateLottie and
   *  gpgpCompileLottieFrame. NULL: such text is reported as unsupported. */
  GpgpSvgTextFn textFn;
  void* textUserData;
  /** Largest scale at which frames are shown, pixels per unit of the composition; 0: 1. Up to this scale strokes are
   *  accurate to a twentieth of a pixel. */
  float scale;
} GpgpLottieSource;
#define GPGP_LOTTIE_SOURCE_INIT GPGP_INIT(GpgpLottieSource, GPGP_STRUCTURE_LOTTIE_SOURCE)

/** Reads an animation. In libgpgp_compiler. Destroy it with gpgpDestroyLottie.
 *  Errors: INVALID_DATA (not a Lottie file; the message says where), INVALID_ARGUMENT, INVALID_STRUCT,
 *  OUT_OF_HOST_MEMORY. @threads any @lifetime call; messageFn, textFn and their userData: handle */
GPGP_API GpgpResult GPGP_CALL gpgpCreateLottie(const GpgpLottieSource* source, GpgpLottie* lottie);

/** Destroys an animation and everything that its last frame points to. In libgpgp_compiler. NULL is ignored. @threads
 *  handle */
GPGP_API void GPGP_CALL gpgpDestroyLottie(GpgpLottie lottie);

typedef struct GpgpLottieInfo {
  GpgpStructureType sType;
  void* pNext;
  float width, height;         /**< of the composition; drawings of its frames have it at (0, 0) */
  double frameRate;            /**< frames per second */
  double firstFrame, endFrame; /**< The animation shows frames from firstFrame on, and ends before endFrame. */
  uint32_t layers;             /**< of all compositions */
  uint32_t images;             /**< that imageFn accepted */
} GpgpLottieInfo;
#define GPGP_LOTTIE_INFO_INIT GPGP_INIT(GpgpLottieInfo, GPGP_STRUCTURE_LOTTIE_INFO)

/** Returns what the file says about itself. In libgpgp_compiler. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpGetLottieInfo(GpgpLottie lottie, GpgpLottieInfo* info);

typedef struct GpgpLottieFrame {
  GpgpStructureType sType;
  void* pNext;
  const GpgpPath* paths; /**< for GpgpDrawingCreateInfo: strokes are made into fills */
  uint32_t pathCount;
  const GpgpPathGroup* groups;
  uint32_t groupCount;
  /** Frames with the same paths and groups have the same number, so engines can cache drawings by this number. The
   *  numbers of different frames are equal with a probability of 2^-64. */
  uint64_t content;
} GpgpLottieFrame;
#define GPGP_LOTTIE_FRAME_INIT GPGP_INIT(GpgpLottieFrame, GPGP_STRUCTURE_LOTTIE_FRAME)

/** Evaluates a frame. In libgpgp_compiler. A frame outside the animation shows its first or last moment. Pointers in
 *  the result stay valid until the next call for this handle. Content that would exceed a limit is left out, and a
 *  message says so. Errors: INVALID_HANDLE, INVALID_ARGUMENT (the frame is not finite), INVALID_STRUCT,
 *  OUT_OF_HOST_MEMORY.
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpEvaluateLottie(GpgpLottie lottie, double frame, GpgpLottieFrame* result);

/** Evaluates a frame and converts it to a baked drawing (.gpgpv), whose page is the composition. In
 *  libgpgp_compiler. Free the blob with
 *  gpgpFreeBlob. jobSystem is optional: it converts paths in parallel.
 *  Errors: INVALID_HANDLE, INVALID_ARGUMENT, UNSUPPORTED, OUT_OF_HOST_MEMORY. @threads handle @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCompileLottieFrame(GpgpLottie lottie, double frame, const GpgpJobSystem* jobSystem,
                                                     GpgpBlob* blob);

#ifdef __cplusplus
}
#endif
#endif
