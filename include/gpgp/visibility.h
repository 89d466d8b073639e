/* gpgp visibility: the potentially visible set (PVS) of a scene, computed on the GPU in the frame, for shading in
 * object space.
 *
 *   geometry set (asset)             The mesh table: which ranges of the engine's index buffer are meshes. No vertex
 *                                    data is copied.
 *   visibility recorder (recorder)   Samples triangle IDs and gathers the visible set. Its budgets set its size.
 *   camera history                   Keeps which triangles a camera saw, to tell what has changed since.
 *
 *   gpgpCreateGeometrySet, gpgpCreateVisibilityRecorder [, gpgpCreateCameraHistory] -> gpgpPrewarm
 *   -> each frame: gpgpRecordUpload -> gpgpRecordPrepareVisibility -> visible bits, lists, indirect arguments
 *   -> frames later: gpgpGetVisibilityReport
 *
 * Triangles are numbered by the engine: GpgpVisibilityDraw::firstTriangle is the number of a draw's first triangle.
 * Bits, lists, counts and sizes are indexed by these numbers. Numbers in parentheses, such as (6.1.3), are sections and
 * equations of the thesis: M. Dokter, Applications of Massively Parallel Geometry Processing, TU Graz, 2019.
 */
#ifndef GPGP_VISIBILITY_H
#define GPGP_VISIBILITY_H
#include <gpgp/core.h>
#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------- geometry set */

/** One indexed triangle mesh in the engine's vertex and index buffers. */
typedef struct GpgpMesh {
  uint32_t firstIndex;   /**< in indices, from the start of GpgpVisibilityInfo::indices */
  uint32_t indexCount;   /**< a multiple of 3 */
  uint32_t vertexOffset; /**< added to each index */
} GpgpMesh;

typedef struct GpgpGeometrySetCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;      /**< for messages and debug names; copied */
  const GpgpMesh* meshes; /**< GpgpVisibilityDraw::mesh is an index into this array. */
  uint32_t meshCount;     /**< 0 is allowed */
} GpgpGeometrySetCreateInfo;
#define GPGP_GEOMETRY_SET_CREATE_INFO_INIT GPGP_INIT(GpgpGeometrySetCreateInfo, GPGP_STRUCTURE_GEOMETRY_SET_CREATE_INFO)

/** Checks the mesh table and queues it for upload. A recording that uses the geometry set returns NOT_READY until
 *  gpgpRecordUpload has uploaded it.
 *  Errors: INVALID_ARGUMENT (the message names the index of the mesh), UNSUPPORTED (the table, 16 bytes a mesh, exceeds
 *  maxStorageBufferRange), INVALID_STRUCT, OUT_OF_..._MEMORY.
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGeometrySet(GpgpContext context, const GpgpGeometrySetCreateInfo* info,
                                                    GpgpAsset* geometrySet);

/** Computes an order of a mesh's triangles in which consecutive triangles lie near each other and face the same way.
 *  With such an order most clusters (GpgpVisibilityInfo::clusters) face one way, so that of a closed mesh nearly half
 *  are skipped. Meant for the time when meshes are built.
 *  - positions: three floats each, positionStride bytes apart. positionStride is at least 12.
 *  - indices: indexCount of them, a multiple of 3.
 *  - order: out, indexCount / 3 numbers. order[i] is the old number of the triangle that becomes the i-th. Data that
 *    the engine keeps by triangle number moves in the same way.
 *  Errors: INVALID_ARGUMENT (the message names an index that is out of range).
 *  @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpOrderTriangles(const float* positions, uint32_t positionStride, uint32_t vertexCount,
                                                 const uint32_t* indices, uint32_t indexCount, uint32_t* order);

/* ---------------------------------------------------------------- visibility recorder */

/** Budgets of a visibility recorder. "Scratch" says what each adds to the scratch memory of a recording. */
typedef struct GpgpVisibilityRecorderCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecorderCreateInfo base;
  /** Largest viewport in pixels, at most 8192 each; 0: 2048. Scratch: 8 bytes a pixel and camera; with the conservative
   *  method 52 bytes, with the exact method 16.2 bytes. */
  uint32_t maxWidth, maxHeight;
  uint32_t maxCameras; /**< cameras of one recording, at most 128; 0: 1 */
  uint32_t maxDraws;   /**< draws of one recording, all cameras together; 0: 65536. Scratch: 56 bytes each */
  /** Triangles of one recording, all draws and cameras together; at most 2^30; 0: 4194304. Triangles beyond the budget
   *  are not sampled, and the report says BUDGET_EXCEEDED. Scratch: 4 * T + T / 8 bytes. With the exact method:
   *  max(8 * T, 4 * P) + T / 8 bytes. T is maxTriangles and P is maxPairs; where these are 0, T and P are their
   *  defaults. */
  uint32_t maxTriangles;
  uint32_t methods; /**< GPGP_SAMPLING_..._BIT of all methods that recordings will use; 0: standard */
  /** Samples per pixel in each direction that one recording takes, a power of two up to 64; 0: 1. Scratch: the 8 bytes
   *  a pixel and camera (maxWidth) become 8 * maxSamples * maxSamples bytes. */
  uint32_t maxSamples;
  /** Exact method: room for candidates, the triangles that may be visible and those that may hide them. 0: a quarter of
   *  maxTriangles, at least 65536. Scratch: 64 bytes each */
  uint32_t maxCandidates;
  /** Exact method: room for pairs of a candidate and a pixel, and for half as many pairs of a candidate and a tile
   *  of 8 x 8 pixels. 0: 4 for each candidate and 4 for each pixel of each camera, but no more than the device's
   *  maxStorageBufferRange holds. Scratch: 8 bytes each; see maxTriangles for 4 more. */
  uint32_t maxPairs;
  /** Room for triangles on the screen of draws that are alpha-tested or see-through; at most maxTriangles; 0: none.
   *  Those beyond it count as visible and hide nothing, and the report says BUDGET_EXCEEDED. Scratch: 4 bytes each.
   *  Each takes the room of two candidates. */
  uint32_t maxNonOpaque;
} GpgpVisibilityRecorderCreateInfo;
#define GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT                                                                      \
  GPGP_INIT(GpgpVisibilityRecorderCreateInfo, GPGP_STRUCTURE_VISIBILITY_RECORDER_CREATE_INFO)

/** Makes a visibility recorder and allocates scratch for its budgets. It samples any geometry set of the context.
 *  Prewarm it before its first recording.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT, UNSUPPORTED (budgets that the device cannot bind), OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateVisibilityRecorder(GpgpContext context,
                                                           const GpgpVisibilityRecorderCreateInfo* info,
                                                           GpgpRecorder* recorder);

/* ---------------------------------------------------------------- camera history */

typedef struct GpgpCameraHistoryCreateInfo {
  GpgpStructureType sType;
  const void* pNext;
  const char* label;     /**< for messages and debug names; copied */
  uint32_t maxTriangles; /**< largest triangleCount of its recordings, at most 2^31; one bit each; 0: 4194304 */
  /** Exact method, one camera: recordings take over decisions of this history's previous recording. 0: each decides
   *  all triangles anew. 0.0001 to 0.05, such as 0.005: the share of the visible triangles that may be late, which the
   *  recordings aim at as a mean over a movement, by what they measure. A triangle is late if a recording finds it only
   *  up to seven recordings after it came into sight, or keeps it so long after it was hidden. Triangles at pixel
   *  centres, and those that come onto the screen, are never late. A recording of exactly the same triangles, viewport
   *  and camera as the previous one, without alpha tests, returns what a recording without reuse would; after a jump of
   *  the camera everything is decided. The history has four bits a triangle instead of one. Recordings of another
   *  method, with several cameras, `accumulate` or `reach` decide all. */
  float maxLate;
} GpgpCameraHistoryCreateInfo;
#define GPGP_CAMERA_HISTORY_CREATE_INFO_INIT                                                                           \
  GPGP_INIT(GpgpCameraHistoryCreateInfo, GPGP_STRUCTURE_CAMERA_HISTORY_CREATE_INFO)

/** Makes the history of one camera. Before its first recording no triangle counts as seen. It is ready once
 *  gpgpRecordUpload has cleared it.
 *  Errors: INVALID_ARGUMENT, UNSUPPORTED (its bits exceed maxStorageBufferRange), INVALID_STRUCT, OUT_OF_..._MEMORY.
 *  @threads context @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpCreateCameraHistory(GpgpContext context, const GpgpCameraHistoryCreateInfo* info,
                                                      GpgpHistory* history);

/* ---------------------------------------------------------------- draws and cameras */

/** One draw of one mesh, 64 bytes, std430, in a buffer of the engine. Draws may share triangle numbers: a triangle's
 *  bit is set if any of these draws shows it. A mirroring transform (determinant -2^-126 or less) keeps the mesh's
 *  front faces: it does not turn them into back faces. */
typedef struct GpgpVisibilityDraw {
  float transform[12]; /**< rows of a 3x4 matrix, object to world; relative to an origin if there are origins */
  uint32_t mesh;       /**< index into the geometry set */
  /** Number of the draw's first triangle in the visible bits and lists. With a multiple of 32, draws share no word of
   *  the bits, so that each can be cleared alone. */
  uint32_t firstTriangle;
  uint32_t flags; /**< GPGP_DRAW_... */
  /** Index into GpgpVisibilityInfo::origins: the origin that transform is relative to. With an index out of range, the
   *  draw's triangles are skipped and counted. Not read if there are no origins. */
  uint32_t origin;
} GpgpVisibilityDraw;
#define GPGP_DRAW_TWO_SIDED 1u /**< Back faces can be visible, too. */
/** Front faces are those whose corners run clockwise on the screen; without this flag, counter-clockwise. With it, a
 *  mesh that is modelled counter-clockwise shows its back faces only. An engine whose mirrored draws turn their faces
 *  inside out sets the flag for these draws. */
#define GPGP_DRAW_CLOCKWISE 2u
/** Triangles of the draw can be visible but hide nothing: glass, particles, both levels of detail of a cross-fade. Each
 *  is visible where no triangle that hides others lies in front of it. Needs maxNonOpaque. */
#define GPGP_DRAW_SEE_THROUGH 4u
/** The draw is not sampled and appears in no list by draw. Its triangles still count against maxTriangles. */
#define GPGP_DRAW_DISABLED 8u
/** The draw is alpha-tested by GpgpVisibilityInfo::alphaTests[i], i from 0 to 15: its triangles exist only where the
 *  texture's alpha is at least the cutoff. Elsewhere they are not visible and hide nothing. With an i out of range, the
 *  draw's triangles are skipped and counted. Needs maxNonOpaque. */
#define GPGP_DRAW_ALPHA_TEST(i) (((i) + 1u) << 8)
/** Layers that the draw is in, bits of a mask of 16: cameras with a layerMask sample it only if they have a bit in
 *  common. 0: every camera samples it. */
#define GPGP_DRAW_LAYERS(mask) ((uint32_t)(mask) << 16)

typedef int32_t GpgpSamplingMethod;
enum {
  /** The triangle that is nearest at each sample of a grid of `samples` x `samples` a pixel; 1: the pixel's centre
   *  (6.1.1). */
  GPGP_SAMPLING_STANDARD = 0,
  /** Standard, and also each triangle that is nearest at one of 64 x 64 samples in a pixel. Limits: see
   *  gpgpRecordPrepareVisibility. */
  GPGP_SAMPLING_EXACT = 1,
  /** A grid of `samples` x `samples` a pixel and the pixel's centre, by brute force and in slices (6.1.2). Meant for
   *  grading the other methods. */
  GPGP_SAMPLING_REFERENCE = 2,
  /** The thesis's method (6.1.3): the triangles at pixel centres, and those of the triangles touching a pixel that
   *  `heuristics` accept beside the triangle at its centre. */
  GPGP_SAMPLING_CONSERVATIVE = 3,
  /** The triangles at pixel centres, and those that may be seen from up to `reach` away: a superset, several times as
   *  many as can be seen. Further recordings of a view cell sample only this superset. Perspective cameras only. */
  GPGP_SAMPLING_NEARBY = 4
};
#define GPGP_SAMPLING_STANDARD_BIT 1u
#define GPGP_SAMPLING_EXACT_BIT 2u
#define GPGP_SAMPLING_REFERENCE_BIT 4u
#define GPGP_SAMPLING_CONSERVATIVE_BIT 8u
#define GPGP_SAMPLING_NEARBY_BIT 16u

/** Conditions on which the conservative method takes a triangle that touches a pixel for visible. With no flag, every
 *  such triangle is visible.
 *  IN_CIRCLE: the radius of its in-circle is at most one pixel (6.1).
 *  DEPTH: its depths in the pixel differ by less than epsilon from those of the triangle at the pixel's centre. If
 *  there is no triangle at the centre, it is not visible (6.2 to 6.4).
 *  KEEP_FRONT, with DEPTH: a triangle in front of the centre's triangle, or in front of the background, is visible
 *  whatever its distance. Not in the thesis. It keeps wires and leaves. */
#define GPGP_HEURISTIC_IN_CIRCLE 1u
#define GPGP_HEURISTIC_DEPTH 2u
#define GPGP_HEURISTIC_KEEP_FRONT 4u
#define GPGP_HEURISTICS_DEFAULT (GPGP_HEURISTIC_IN_CIRCLE | GPGP_HEURISTIC_DEPTH) /**< those of the thesis */

/** A camera. Near and far plane are those of the projection; the far plane may be infinitely far away. Clip space is
 *  Vulkan's, with y down: an engine whose viewports have a negative height negates the second row of the matrix.
 *
 *  Large worlds: at 10^5 m from the world's origin, floats are 8 mm apart. Such a world gives each camera an origin
 *  near it, usually its position, and each draw an origin near it (GpgpVisibilityInfo::origins). Floats then hold only
 *  what is relative to these origins. */
typedef struct GpgpCamera {
  float viewProjection[16]; /**< world space minus origin, to clip space; column-major */
  VkBool32 reversedDepth;   /**< VK_TRUE: depth 1 is near, 0 is far */
  double origin[3];         /**< world space, each below 1e30 in magnitude; 0, 0, 0: the world's origin */
  uint32_t layerMask;       /**< 16 bits: the layers that the camera sees (GPGP_DRAW_LAYERS); 0: all */
} GpgpCamera;

/** A view cell: a region that the viewer may be in until the next recording. The union of what several cameras in the
 *  cell see is the potentially visible set of the cell (6.3.5). */
typedef struct GpgpViewCellInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpCamera camera; /**< in the middle of the cell; perspective or parallel */
  /** Size of a grid of view points in pixels, 1 to 64 each, centred on the middle (figure 6.13); both 0: no grid. */
  uint32_t columns, rows;
  uint32_t skip;   /**< takes one view point for every `skip` pixels of the grid in each direction; 0: 1 */
  uint32_t height; /**< of the viewport, in pixels; above 0 with a grid */
  /** The viewing distance, in units of clip space's w, at which a step of one grid pixel shifts the picture by one
   *  pixel of the viewport. Above 0 with a grid. Parallel cameras ignore the value: all distances shift alike. */
  float distance;
  /** Further view points, three finite floats each: world units from the middle to the camera's right, up, and back
   *  towards the viewer. */
  const float* points;
  uint32_t pointCount;
  /** Number of further view points in a square perpendicular to the viewing direction; at most 1024; 0: none. They are
   *  denser near its border, from where most is seen. */
  uint32_t walkCount;
  float walkDistance; /**< half the side of that square, in world units; above 0 with walkCount */
} GpgpViewCellInfo;
#define GPGP_VIEW_CELL_INFO_INIT GPGP_INIT(GpgpViewCellInfo, GPGP_STRUCTURE_VIEW_CELL_INFO)

/** Makes the cameras of a view cell, in this order: the middle, the grid row by row, the square, the points. Use them
 *  in one recording with several cameras, or in several recordings that accumulate.
 *  - count: in, the capacity of cameras; out, the number of all cameras. If that exceeds the capacity, the result is
 *    INCOMPLETE, and the first cameras are written.
 *  - cameras: may be NULL to ask for the count.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetViewCellCameras(const GpgpViewCellInfo* info, uint32_t* count,
                                                     GpgpCamera* cameras);

/** How a viewer may move and turn between the pose for which a result is computed and the last time at which that
 *  result is displayed. */
typedef struct GpgpViewMotionInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpCamera camera;      /**< The camera at the pose; perspective. For two eyes, the camera halfway between them. */
  uint32_t width, height; /**< The viewer's viewport in pixels, at most 16384 each. */
  float velocity[3];      /**< The velocity at the pose, in world units per second along the world's axes. */
  float acceleration;     /**< How fast the velocity may change, in any direction; world units per second squared. */
  float turnRate;         /**< Fastest turn about the camera's up axis, to either side; radians per second. */
  float tiltRate;         /**< Fastest turn about its right axis, up or down; radians per second. */
  float earliest, latest; /**< When the result is displayed, in seconds after the pose; 0 to 10. */
  float eyeDistance;      /**< Distance of two eyes in world units; 0: one eye. */
} GpgpViewMotionInfo;
#define GPGP_VIEW_MOTION_INFO_INIT GPGP_INIT(GpgpViewMotionInfo, GPGP_STRUCTURE_VIEW_MOTION_INFO)

/** Where the eyes may be, and what the cameras of gpgpGetViewMotionCameras cover. Positions are relative to the camera
 *  of the pose, in world units to its right, up, and back towards the viewer. */
typedef struct GpgpViewMotionCoverage {
  uint32_t cameraCount;
  /** The viewport for the first camera, in pixels. The camera has a wider field of view than the viewer. Its pixels are
   *  as fine as the viewer's where that takes at most twice as many. */
  uint32_t width, height;
  uint32_t cornerWidth, cornerHeight; /**< The viewport for the other cameras, for method exact. */
  float middle[3], extent[3];         /**< The box in which the eyes stay: its middle, and half its extents. */
  /** Turns that are covered, radians to either side. They are reduced where the field of view would exceed 160 degrees.
   */
  float turn, tilt;
  /** Largest distance from a place in the box to its nearest camera. 0: one camera covers the whole box. */
  float reach;
} GpgpViewMotionCoverage;

/** Makes the cameras of a viewer in motion: in the middle of the box in which the eyes stay, then in two opposite
 *  corners, with a field of view that contains every view from there. Use them in recordings that accumulate, the first
 *  one with a viewport of its own.
 *  - count: in, the capacity of cameras; out, the number of all cameras: 1 or 3. If that exceeds the capacity, the
 *    result is INCOMPLETE, and the first cameras are written.
 *  - cameras, coverage: may be NULL.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpGetViewMotionCameras(const GpgpViewMotionInfo* info, uint32_t* count,
                                                       GpgpCamera* cameras, GpgpViewMotionCoverage* coverage);

/* ---------------------------------------------------------------- recording */

/** Projected size of a triangle. Only the part counts that lies between near and far plane and at most three viewports
 *  beyond each side of the viewport. */
typedef struct GpgpTriangleSize {
  float area;          /**< pixels */
  float width, height; /**< of its bounding box, pixels */
} GpgpTriangleSize;

/** The texture of an alpha test. The engine makes its contents visible to sampling in compute shaders. */
typedef struct GpgpAlphaTest {
  VkImageView view;     /**< 2D; its alpha is read: a view of a format without alpha maps another component to it */
  VkSampler sampler;    /**< filters and address modes are used; anisotropy and mip bias are not */
  VkImageLayout layout; /**< current layout: SHADER_READ_ONLY_OPTIMAL, GENERAL, ... */
  float cutoff;         /**< The triangle exists where alpha is at least this. */
  float level;          /**< mip level that is sampled, from 0 to 32, the same at every distance */
} GpgpAlphaTest;

/** One recording: what is sampled, how, and where the results go. Buffers marked "out" are written, all others are only
 *  read, except clusters. An optional buffer is left out by leaving it zero. */
typedef struct GpgpVisibilityInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  GpgpAsset geometrySet;
  GpgpHistory history; /**< optional: of this camera. The report then says what changed since its previous recording. */
  GpgpSamplingMethod method;
  GpgpCamera camera;
  /** Further cameras with the same viewport size and reversedDepth, such as the other eye of a stereo pair or the views
   *  of a cell. A triangle is visible if any camera sees it. */
  const GpgpCamera* moreCameras;
  uint32_t moreCameraCount; /**< less than maxCameras */
  uint32_t width, height;   /**< viewport of each camera, pixels; exact: at most 229376 rows of all cameras */
  /** Standard, reference: samples per pixel and direction, a power of two up to 256; standard: at most maxSamples.
   *  0: 1 for standard, 64 for reference. */
  uint32_t samples;
  /** Reference: index of the slice that this recording takes, 0 to n * n, with n = max(samples / maxSamples, 1). Slices
   *  0 to n * n - 1 are parts of the grid, slice n * n is the pixel centres. All slices together are the reference. */
  uint32_t slice;
  /** VK_TRUE: adds to visibleBits, pixelCounts and triangleSizes instead of overwriting them. This unites slices,
   *  cameras and the recordings of a view cell. */
  VkBool32 accumulate;
  /** Conservative: factor of width and height, 0.25 to 1, rounded to whole pixels; 0: 1 */
  float resolution;
  uint32_t heuristics; /**< conservative: GPGP_HEURISTIC_... */
  /** Conservative: the constant part of epsilon (6.2), in units of clip space's w, which for a perspective projection
   *  is distance along the view. For a parallel projection, where w is 1, the unit is that of clip space's z. */
  float epsilonStatic;
  float epsilonDynamic; /**< conservative: added to epsilon times 1 - |cosine| of the two triangles' normals */
  /** Conservative: how many times gaps are closed, at most 4. Each time takes 8 x 8 samples in every pixel. Samples
   *  that no visible triangle covers are gaps. In each quarter of a pixel, the nearest triangle that covers a gap
   *  becomes visible. */
  uint32_t refinements;
  /** Nearby: how far from the camera the viewer may be, in units of clip space's w; 0 or more.
   *  Exact: also marks what a move of the camera by that length would uncover within a pixel. Meant for view cells
   *  whose view points are twice as far apart. 0: nothing more. Above 0, and for the method nearby, all cameras must be
   *  perspective. */
  float reach;
  GpgpBuffer positions; /**< vertex positions; STORAGE usage; for 16-bit formats the size is a multiple of 4 */
  /** R32G32B32_SFLOAT, R16G16B16_SFLOAT, R16G16B16_SNORM, or one of these with A, which is not read. UNDEFINED:
   *  R32G32B32_SFLOAT */
  VkFormat positionFormat;
  uint32_t positionOffset; /**< bytes from the start of a vertex to its position; a multiple of a component's size */
  uint32_t positionStride; /**< bytes, a multiple of a component's size; 0: three components */
  /** Textures of alpha-tested draws (GPGP_DRAW_ALPHA_TEST), at most 16. Devices filter with different precision, so
   *  results can differ between them where alpha is near the cutoff. */
  const GpgpAlphaTest* alphaTests;
  uint32_t alphaTestCount; /**< above 0: the recorder has maxNonOpaque */
  /** With alphaTests: texture coordinates by vertex, like positions; STORAGE usage; the size is a multiple of 4.
   *  Coordinates that lie outside the buffer, are not finite or reach 2^100 are read as 0. */
  GpgpBuffer textureCoordinates;
  VkFormat textureCoordinateFormat; /**< R32G32_SFLOAT, R16G16_SFLOAT or R16G16_UNORM; UNDEFINED: R32G32_SFLOAT */
  uint32_t textureCoordinateOffset; /**< bytes from the start of a vertex; a multiple of a component's size */
  uint32_t textureCoordinateStride; /**< bytes, a multiple of a component's size; 0: two components */
  GpgpBuffer indices;               /**< STORAGE usage; the size is a multiple of 4, for UINT16 too */
  VkIndexType indexType;            /**< UINT16 or UINT32 */
  /** Optional, not together with commands; STORAGE usage. 48 bytes for each cluster: 64 consecutive triangles of a
   *  mesh; the last cluster of a mesh may have fewer. The recording computes the bounds and normal cones of all
   *  clusters and stores them here, if drawCount is above 0 (without draws it has no positions). It then skips
   *  clusters that are outside the view or face away. The result is the same. Worth it for meshes of more than a few
   *  clusters; see gpgpOrderTriangles. */
  GpgpBuffer clusters;
  /** VK_TRUE: clusters hold what an earlier recording stored for this geometry set with the same positions and indices,
   *  and are not computed again. VK_FALSE where any of these may have changed. */
  VkBool32 keepClusters;
  GpgpBuffer draws; /**< GpgpVisibilityDraw[drawCount]; STORAGE usage */
  uint32_t drawCount;
  /** Optional: points in world space that the draws' transforms are relative to (GpgpVisibilityDraw::origin), such as
   *  the centres of the world's sectors. Three numbers each, below 1e30 in magnitude. The difference between the
   *  origins of draw and camera is exact to 2^-46 of an origin's magnitude and to 2^-24 of the difference. */
  const double* origins;
  uint32_t originCount; /**< at most 32; 0: transforms are relative to the world's origin */
  /** Optional: VkDrawIndexedIndirectCommand[commandCount] of the engine; STORAGE usage. The instances of these commands
   *  are drawn instead of `draws`. Instance i of a command uses the command's indices, and transform, flags and
   *  triangle numbers of draws[firstInstance + i], whose `mesh` is not read. Instances beyond `draws` are skipped and
   *  counted. */
  GpgpBuffer commands;
  uint32_t commandCount;  /**< number of commands; with drawCountBuffer, the largest number */
  uint32_t commandStride; /**< bytes, a multiple of 4, at least 20; 0: 20 */
  /** Optional, with commands: triangle numbers per primitive, uint32_t, indexed by firstIndex / 3 + primitive. They
   *  override firstTriangle. A recording can thus sample what another one listed: its drawCommands, drawIndices and
   *  drawTriangles become commands, indices and triangleNumbers. STORAGE usage */
  GpgpBuffer triangleNumbers;
  GpgpBuffer drawCountBuffer; /**< optional: uint32_t, the number of commands, or without commands of draws; STORAGE */
  uint32_t triangleCount;     /**< one more than the largest triangle number of all draws; at most 2^31 */
  GpgpBuffer visibleBits;     /**< out: one bit per triangle, ceil(triangleCount / 32) words; see accumulate */
  /** Out, optional: uint32_t per triangle, the number of samples that show it. Exact: pixel centres. Reference: at most
   *  2^32 - 1. With a resolution below 1: samples of the smaller picture. */
  GpgpBuffer pixelCounts;
  /** Out, optional: uint32_t numbers of the visible triangles, ascending. The buffer's size is the budget. */
  GpgpBuffer visibleList;
  /** Out, optional, with history: uint32_t[4], then uint32_t numbers of triangles: those that have appeared since the
   *  history's previous recording, ascending, followed by those that have disappeared, ascending. [0] and [1] are the
   *  two counts, whether or not the buffer holds all numbers; [2] and [3] are 0. The buffer's size is the budget.
   *  STORAGE usage */
  GpgpBuffer changedList;
  /** Out, optional: uint32_t[4]. [0] is the number of visible triangles, whether or not the list holds them. [1] to [3]
   *  are a VkDispatchIndirectCommand with a workgroup for each 64 listed triangles, in rows of 65535:
   *  workgroup y * 65535 + x. The last row may extend beyond the list. With drawCommands there is a fifth word: the
   *  number of draw commands. STORAGE usage */
  GpgpBuffer visibleCount;
  /** Out, optional: VkDrawIndexedIndirectCommand over drawIndices for each draw: one instance of its visible triangles,
   *  or none. firstInstance is the draw's index in `draws`. With commands: one for each of their instances, in order.
   *  STORAGE usage */
  GpgpBuffer drawCommands;
  /** Out, optional: uint32_t[3] for each visible triangle of each draw, with the values of the engine's indices. The
   *  triangles of a draw are contiguous, in no particular order. The buffer's size is the budget. */
  GpgpBuffer drawIndices;
  /** Out, optional: uint32_t triangle number for each triangle in drawIndices. The number of primitive i of a draw
   *  command is at firstIndex / 3 + i. The buffer's size is the budget. */
  GpgpBuffer drawTriangles;
  /** Out, optional: GpgpTriangleSize per triangle. A visible triangle has the largest size of all cameras and draws, in
   *  pixels of the viewport times resolution. Others have 0. */
  GpgpBuffer triangleSizes;
} GpgpVisibilityInfo;
#define GPGP_VISIBILITY_INFO_INIT GPGP_INIT(GpgpVisibilityInfo, GPGP_STRUCTURE_VISIBILITY_INFO)

/** Computes the potentially visible set of the cameras: samples triangle IDs and gathers bits, lists and counts. Of two
 *  triangles with the same depth, the one with the lower number is visible; conservative: the one of the earlier draw.
 *
 *  Exact: pixels in which more than 28 triangles intersect each other in depth, and pixels with more than about 1 500
 *  candidates, are resolved conservatively: triangles that were not decided are marked visible and counted in
 *  `unresolved`.
 *
 *  Draws, meshes and indices that refer to something that does not exist, and coordinates that are not finite or reach
 *  2^100, are skipped and counted in the report. With drawCount 0 the geometry buffers may be left out; with
 *  triangleCount 0 the visible bits, too.
 *
 *  NOT_READY: the geometry set or history is not resident, or the recorder is not prewarmed. Nothing is recorded.
 *  Errors: INVALID_ARGUMENT (the message names the field and what is allowed: a size, camera, method or epsilon that is
 *  out of range or not within the recorder's budgets; a buffer that is missing, too small, misaligned or larger than
 *  the device binds; fields that exclude each other; a triangleCount above the history's maxTriangles), INVALID_STRUCT,
 *  INVALID_HANDLE, TOO_MANY_RECORDINGS, DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareVisibility(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                          const GpgpFrame* frame, const GpgpVisibilityInfo* info);

/* ---------------------------------------------------------------- metrics */

/** Buffers of bits hold one bit per triangle in words of 32. All buffers have STORAGE usage. */
typedef struct GpgpVisibilityMetricsInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpRecordingInfo base;
  uint32_t triangleCount; /**< of all buffers; at most 2^31 */
  GpgpBuffer visibleBits; /**< what is graded: the bits of one recording, or of several that accumulated */
  /** The bits of recordings with method reference that accumulated: all slices, from every camera that contributed to
   *  visibleBits. */
  GpgpBuffer referenceBits;
  GpgpBuffer referenceCounts; /**< optional: pixelCounts of these recordings. Without them, shares by area are 0. */
  /** Optional: bits of a finer reference (256 samples). A triangle that is visible and in these bits is no false
   *  positive: it counts as part of the reference. A triangle that is only in these bits is ignored. */
  GpgpBuffer recheckBits;
  GpgpBuffer falsePositives; /**< out, optional: bits of triangles that are visible but not in the reference */
  GpgpBuffer falseNegatives; /**< out, optional: bits of triangles that are in the reference but not visible */
} GpgpVisibilityMetricsInfo;
#define GPGP_VISIBILITY_METRICS_INFO_INIT GPGP_INIT(GpgpVisibilityMetricsInfo, GPGP_STRUCTURE_VISIBILITY_METRICS_INFO)

/** Compares visible bits with a reference, triangle by triangle: coverage and overestimation (6.3). The numbers are in
 *  the report of this recording.
 *  NOT_READY: the recorder is not prewarmed.
 *  Errors: INVALID_ARGUMENT (a buffer is missing or too small; the message names it and the bytes that it needs),
 *  INVALID_STRUCT, INVALID_HANDLE, TOO_MANY_RECORDINGS, DEVICE_LOST.
 *  @threads handle @lifetime call; buffers: frame @pass outside
 *  @state compute pipeline, compute descriptor set 0, push constants */
GPGP_API GpgpResult GPGP_CALL gpgpRecordPrepareVisibilityMetrics(GpgpRecorder recorder, VkCommandBuffer commandBuffer,
                                                                 const GpgpFrame* frame,
                                                                 const GpgpVisibilityMetricsInfo* info);

/* ---------------------------------------------------------------- report */

/** What one recording did, as the GPU counted it. With several cameras all counts are sums over the cameras, except
 *  visible, listed, appeared, disappeared, neededDraws and draws. */
typedef struct GpgpVisibilityReport {
  GpgpStructureType sType;
  void* pNext;
  GpgpReportHeader base;
  uint32_t triangles;        /**< sampled: in the view volume (near to far plane), facing the camera or two-sided */
  uint32_t visible;          /**< bits that are set */
  uint32_t listed;           /**< written to visibleList */
  uint32_t coveredPixels;    /**< samples that show a triangle; exact: pixel centres */
  uint32_t appeared;         /**< with a history: visible now but not in its previous recording */
  uint32_t disappeared;      /**< with a history: visible in its previous recording but not now */
  uint32_t neededTriangles;  /**< of all draws: maxTriangles of at least this is needed */
  uint32_t skippedTriangles; /**< an index, triangle number or origin out of range; a coordinate that is not finite or
                                  reaches 2^100 */
  uint32_t skippedDraws;     /**< of a mesh that is not in the geometry set; instances beyond `draws` */
  /** Triangles on the screen of alpha-tested and see-through draws: maxNonOpaque of at least this is needed. */
  uint32_t neededNonOpaque;
  uint32_t changed;          /**< numbers written to changedList; less than appeared + disappeared: it is too small */
  uint32_t neededCandidates; /**< exact: needed maxCandidates; a lower bound if there was too little room */
  uint32_t neededPairs;      /**< exact: needed maxPairs; a lower bound if there was too little room */
  uint32_t maxTriangles;     /**< the recorder's budget: as given at its creation, or the default */
  uint32_t maxCandidates;    /**< likewise */
  uint32_t maxPairs;         /**< likewise */
  /** Exact: triangles, and pairs of triangle and pixel, that were not decided. These triangles are marked visible, and
   *  triangles that they hide may be visible, too. There are three causes:
   *  - too little room: neededCandidates or neededPairs exceeds its budget;
   *  - pixels with too many triangles, whatever the budgets (see gpgpRecordPrepareVisibility);
   *  - more than 2^20 parts of candidates that are larger than 8 x 8 pixels. */
  uint32_t unresolved;
  /** Exact: triangles on the screen, but at no pixel's centre and behind no limit, that were decided, and pixels in
   *  which they were. reused: those whose last decision was taken over (GpgpCameraHistoryCreateInfo::maxLate);
   *  neededCandidates and neededPairs are then those of what was decided. */
  uint32_t decided, decidedPixels, reused;
  uint32_t neededDraws;         /**< of one camera: the number of draws, or of instances of commands */
  uint32_t draws;               /**< of these: sampled, and with drawCommands written */
  uint32_t neededDrawTriangles; /**< with lists by draw: the sum of all draws' visible triangles */
  uint32_t drawTriangles;       /**< of these: written */
  uint32_t reference;           /**< metrics: triangles in the reference. The fields below are metrics, too. */
  uint32_t falsePositives;      /**< triangles that are visible but not in the reference */
  uint32_t falseNegatives;      /**< triangles that are in the reference but not visible */
  float coverage;               /**< share of the reference's triangles that are visible, 0 to 1; 0 if it is empty */
  float overestimation;         /**< falsePositives divided by the reference's triangles; may exceed 1 */
  float coverageArea;           /**< share of the reference's samples with a triangle that show a visible one */
  float overestimationArea;     /**< falsePositives (one sample each) / the reference's samples with a triangle */
} GpgpVisibilityReport;
#define GPGP_VISIBILITY_REPORT_INIT GPGP_INIT(GpgpVisibilityReport, GPGP_STRUCTURE_VISIBILITY_REPORT)

/** Takes the oldest report that was not taken yet. NOT_READY: there is none.
 *  base.status is BUDGET_EXCEEDED if something did not fit; what is written is valid and consists of whole triangles:
 *  - more triangles than maxTriangles: see neededTriangles;
 *  - more draws than maxDraws or drawCommands hold: see neededDraws;
 *  - more visible triangles than visibleList holds: see visible;
 *  - more triangles than drawIndices or drawTriangles hold: see neededDrawTriangles;
 *  - more changes than changedList holds: see appeared and disappeared;
 *  - more triangles of alpha-tested and see-through draws than maxNonOpaque: see neededNonOpaque;
 *  - unresolved is not 0: larger budgets help only if neededCandidates or neededPairs exceeds its budget.
 *  base.status is ERROR_UNSUPPORTED if the device ended shader loops early, as software devices do.
 *  @threads handle */
GPGP_API GpgpResult GPGP_CALL gpgpGetVisibilityReport(GpgpRecorder recorder, GpgpVisibilityReport* report);

#ifdef __cplusplus
}
#endif
#endif
