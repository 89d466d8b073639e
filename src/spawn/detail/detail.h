// Level of detail within a budget (gpgp/detail.h): a search for the detail whose cost is just below the budget, one
// recording a step.
//
// The cost rises with the detail. What is known of the current view is a detail within the budget (`safe`) and one
// beyond it (`excess`). A step goes along the straight line between them, in logarithms of detail and cost, and away
// from `safe` by the elasticity that was seen last where `excess` is not known. From beyond the budget it always
// goes back to `safe`. A report that contradicts what is known says that the view has changed: then that is forgotten.
#pragma once
#include <gpgp/detail.h>

namespace gpgp::spawn {

bool isValid(const GpgpDetailBudget& budget);
/// The largest share of its budget that anything takes; 1 is all of it.
double costOf(const GpgpDetailBudget& budget, const GpgpSpawnReport& report, double milliseconds);
/// False: the budget is exceeded with the least detail.
bool adapt(const GpgpDetailBudget& budget, const GpgpSpawnReport* report, double milliseconds, GpgpDetail& state);

/// By products and sums alone, the same bits everywhere: log2(x) for normal x > 0 to 1e-7, 2^x for |x| < 1000 to 1e-7
/// of its value.
double logarithm(double x);
double power(double x);

} // namespace gpgp::spawn
