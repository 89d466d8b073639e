/* gpgp scatter: points at a distance from each other as axioms, by a density, on a terrain.
 *
 * The points are those of one pattern that covers the whole ground plane, a Poisson-disk pattern: no two are nearer
 * than a distance, and there is no room for many more: a square of that distance holds 0.59 points on average. A call
 * returns the points of a rectangle. Rectangles that meet share no point and leave none out, in whatever order they are
 * asked for, on any machine and any thread: a world is scattered tile by tile without seams.
 *
 * The function keeps nothing and calls no Vulkan. Arrays are read from host memory; what an engine has as a texture, it
 * hands over as it was loaded.
 */
#ifndef GPGP_SCATTER_H
#define GPGP_SCATTER_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** What is scattered where. */
typedef struct GpgpScatterInfo {
  GpgpStructureType sType;
  const void* pNext;
  GpgpAxiom base; /**< Of all axioms. Each point is added to where its transform moves. */
  float distance; /**< Metres, at least 1e-3. No two points are nearer, but for the rounding of places to floats. */
  uint32_t seed;  /**< Of the pattern. Other seeds are other patterns. */
  float min[2], max[2]; /**< The rectangle: x and z, metres, without its upper edges. At most 65536 distances from 0,
                         *   and 2048 distances wide and deep. */
  /** Optional. How many of the points are kept: 0 none, 1 all. Its values are finite. @lifetime call */
  const GpgpGroundField* density;
  /** Optional. Metres, finite. The axiom's lower face stands on it. Else 0. @lifetime call */
  const GpgpGroundField* heights;
  float minHeight, maxHeight; /**< Points whose ground is lower or higher are left out. Both 0: none are. */
} GpgpScatterInfo;
#define GPGP_SCATTER_INFO_INIT GPGP_INIT(GpgpScatterInfo, GPGP_STRUCTURE_SCATTER_INFO)

/** Makes the axioms of a rectangle: cell by cell, row after row. id and seed of each differ from those of all others
 *  nearby, and do not depend on the rectangle. count is the capacity of axioms on input and the number of all points on
 *  output. If axioms is NULL, only the count is returned. If it is too small, the function fills it and returns
 *  GPGP_INCOMPLETE. Errors: INVALID_ARGUMENT, INVALID_STRUCT, OUT_OF_HOST_MEMORY. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpScatterAxioms(const GpgpScatterInfo* info, uint32_t* count, GpgpAxiom* axioms);

#ifdef __cplusplus
}
#endif
#endif
