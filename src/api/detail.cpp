// The C function of detail.h: a pure function on the host.
#include "spawn/detail/detail.h"
#include "api/check_struct.h"

#include <gpgp/detail.h>

using namespace gpgp;

GpgpResult GPGP_CALL gpgpAdaptDetail(const GpgpDetailBudget* budget, const GpgpSpawnReport* report, double milliseconds,
                                     GpgpDetail* state) {
  if (const auto ok = api::checkStruct(budget, GPGP_STRUCTURE_DETAIL_BUDGET, "budget"); !ok) return ok.error().code;
  if (report)
    if (const auto ok = api::checkStruct(report, GPGP_STRUCTURE_SPAWN_REPORT, "report"); !ok) return ok.error().code;
  // Not less than 0, which includes what is no number.
  if (!state || !spawn::isValid(*budget) || (report && budget->milliseconds > 0 && !(milliseconds >= 0)) ||
      !(state->detail >= 0))
    return GPGP_ERROR_INVALID_ARGUMENT;
  return spawn::adapt(*budget, report, milliseconds, *state) ? GPGP_SUCCESS : GPGP_BUDGET_EXCEEDED;
}
