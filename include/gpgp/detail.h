/* gpgp detail: level of detail within a budget. GpgpSpawnCamera::detail makes everything count as larger or smaller on
 * the picture than it is. gpgpAdaptDetail chooses it, so that what a camera's recordings derive stays within a number
 * of instances or vertices, or within GPU time that the engine measures.
 *
 *   gpgpGetSpawnReport        what a recording derived, and with which detail
 *   gpgpAdaptDetail           the detail of the next recording
 *   gpgpRecordPrepareSpawn    with that detail in GpgpSpawnInfo::camera
 *
 * It steers grammars whose rules read ScreenSize(), and assumes that they derive more where that is larger. While the
 * camera stands still:
 *
 * - The detail ends where the cost is 0.9 to 1 of the budget, or within 4 % of the largest detail that does not exceed
 *   it, or at GpgpDetailBudget::maxDetail; wherever it began. There it stays.
 * - What has exceeded the budget is followed by a detail that did not, if one is known. If none is, as after a cut, by
 *   one that is enough if a quarter of the detail halves the cost; and if that is not enough, by the least.
 *
 * While the camera moves, the detail is lowered before the budget is exceeded, where the cost rises slowly enough.
 *
 * The function keeps nothing between calls, allocates nothing and uses arithmetic that is the same everywhere: the same
 * reports give the same details on every machine.
 */
#ifndef GPGP_DETAIL_H
#define GPGP_DETAIL_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** What a recording may cost. 0: as much as it likes. At least one of the four is given. The cost is the largest share
 *  of its budget that any of them takes. */
typedef struct GpgpDetailBudget {
  GpgpStructureType sType;
  const void* pNext;
  uint32_t instances;  /**< Of GpgpSpawnReport::terminals. */
  uint32_t vertices;   /**< Of GpgpSpawnReport::vertices. */
  uint32_t shapes;     /**< Of GpgpSpawnReport::peakShapes, as GpgpSpawnerCreateInfo::maxShapes. */
  double milliseconds; /**< Of the time that gpgpAdaptDetail is given. */
  float minDetail;     /**< 0: 1/64. */
  float maxDetail;     /**< 0: 1. At least minDetail. */
} GpgpDetailBudget;
#define GPGP_DETAIL_BUDGET_INIT GPGP_INIT(GpgpDetailBudget, GPGP_STRUCTURE_DETAIL_BUDGET)

/** The state of a camera's detail. All zeros at the beginning: the first detail is then the least. An engine may set
 *  detail alone to begin elsewhere. 44 bytes. */
typedef struct GpgpDetail {
  float detail;               /**< For GpgpSpawnCamera::detail of the next recording. */
  float safe, safeCost;       /**< The last detail within the budget, and its cost. 0: none is known of this view. */
  float excess, excessCost;   /**< The least detail that exceeded it. 0: none is known of this view. */
  float lastDetail, lastCost; /**< Of the last report. */
  float elasticity;  /**< How many times as fast as the detail the cost was seen to change, as a power. 0: not seen. */
  uint32_t exceeded; /**< Details in a row that exceeded the budget. */
  uint32_t searched; /**< Steps between `safe` and `excess` of this view. */
  uint32_t rises;    /**< 1: the camera moves to where the same detail costs more. */
} GpgpDetail;

/** Takes a report, and chooses the detail of the next recording. Call it for every report of the camera's recordings,
 *  or with NULL before there is one; then record with state->detail. Reports about another detail than state->detail
 *  change nothing: they belong to recordings that were made before the last change. So the detail changes at most once
 *  in as many frames as reports take.
 *
 *  milliseconds: what the recording of the report took on the GPU, as the engine measured it; not read without a budget
 *  for it. Times that vary by more than some percent from frame to frame should be medians of a few.
 *
 *  Reports that were not executed, or are errors, change nothing. One that is BUDGET_EXCEEDED for another reason than
 *  these budgets counts as twice the cost that is allowed: something was dropped, and how much is not known.
 *
 *  Returns BUDGET_EXCEEDED if the budget is exceeded with minDetail: no detail keeps it.
 *  Errors: INVALID_ARGUMENT, INVALID_STRUCT. @threads any @lifetime call */
GPGP_API GpgpResult GPGP_CALL gpgpAdaptDetail(const GpgpDetailBudget* budget, const GpgpSpawnReport* report,
                                              double milliseconds, GpgpDetail* state);

#ifdef __cplusplus
}
#endif
#endif
