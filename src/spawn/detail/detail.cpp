#include "spawn/detail/detail.h"

#include <algorithm>
#include <cmath>

namespace gpgp::spawn {
namespace {

constexpr double kAim = 0.95;      // what a step aims at, in parts of the budget
constexpr double kEnough = 0.9;    // from here on nothing is raised
constexpr double kNear = 0.955;    // from here on a cost that rises is lowered, to
constexpr double kBack = 0.935;    // this
constexpr double kRises = 1.0005;  // times the cost before: the camera moves, and nothing is raised
constexpr double kFar = 0.6;       // but for costs below this
constexpr double kDrift = 0.02;    // of the cost at the same detail: it is another view
constexpr double kNoise = 0.05;    // of a cost that is time
constexpr double kNarrow = 1.04;   // excess over safe: nothing is searched in between
constexpr double kFarthest = 4;    // times the detail, in one step
constexpr double kInside = 0.75;   // of the way from safe to excess, at most
constexpr uint32_t kLines = 2;     // steps along lines; later ones halve
constexpr double kElasticity = 2;  // of the cost where nothing is known: areas on the picture
constexpr double kSeen = 0.03;     // octaves of detail from which on an elasticity is measured
constexpr double kFlattest = 0.4;  // the least elasticity that a step up reckons with
constexpr double kSteepest = 8;    // the largest elasticity of one view
constexpr double kJump = 0.3;      // octaves of cost beyond that: it is another view
constexpr double kCaution = 1.25;  // times the elasticity that was seen, for a step up
constexpr double kInelastic = 0.5; // the least elasticity that one step down reckons with
constexpr double kCreep = 1.1;     // times the last cost of the same detail: the view has moved, it is no other one
constexpr double kCreeping = 0.8;  // the elasticity that is then reckoned with, where areas or more were seen

struct Range {
  float least, most;
  double drift; // of the cost
};
Range rangeOf(const GpgpDetailBudget& budget) {
  return {budget.minDetail > 0 ? budget.minDetail : 1.0f / 64, budget.maxDetail > 0 ? budget.maxDetail : 1.0f,
          budget.milliseconds > 0 ? kNoise : kDrift};
}

/// Of a detail, times 2^octaves, within the range.
float moved(float detail, double octaves, Range range) {
  return std::clamp(static_cast<float>(detail * power(octaves)), range.least, range.most);
}

/// A report about another detail than the one before says how much the cost depends on it.
void measure(GpgpDetail& state, double cost) {
  if (state.lastDetail > 0 && state.lastCost > 0) {
    const double octaves = logarithm(state.detail) - logarithm(state.lastDetail);
    if (std::abs(octaves) >= kSeen) {
      const double seen = std::clamp((logarithm(cost) - logarithm(state.lastCost)) / octaves, kFlattest, kSteepest);
      state.elasticity =
          static_cast<float>(state.elasticity > 0 ? (seen + static_cast<double>(state.elasticity)) / 2 : seen);
    }
  }
  state.lastDetail = state.detail;
  state.lastCost = static_cast<float>(cost);
}
double elasticityOf(const GpgpDetail& state) { return state.elasticity > 0 ? state.elasticity : kElasticity; }

float lower(GpgpDetail& state, double cost, Range range) {
  const float safe = state.safe < state.detail ? state.safe : 0;
  state.excess = state.detail;
  state.excessCost = static_cast<float>(cost);
  if (safe > 0 && (state.searched || logarithm(cost) - logarithm(state.safeCost) <=
                                         kSteepest * (logarithm(state.detail) - logarithm(safe)) + kJump))
    return safe;
  state.safe = state.safeCost = 0;
  state.searched = 0;
  if (state.exceeded > 1) return range.least;
  const bool creeps = state.detail == state.lastDetail && cost <= kCreep * static_cast<double>(state.lastCost);
  const double elasticity = creeps && elasticityOf(state) >= kElasticity ? kCreeping : kInelastic;
  const float next = moved(state.detail, (logarithm(kAim) - logarithm(cost)) / elasticity, range);
  return safe > 0 ? std::min(safe, next) : next;
}

float raise(GpgpDetail& state, double cost, Range range) {
  const double wanted = logarithm(kAim) - logarithm(cost);
  if (state.excess > 0) {
    if (state.excess <= kNarrow * static_cast<double>(state.detail)) return state.detail;
    const double whole = logarithm(state.excess) - logarithm(state.detail);
    const double rises = logarithm(state.excessCost) - logarithm(cost);
    const double part = state.searched++ < kLines ? std::clamp(wanted / rises, 1 - kInside, kInside) : 0.5;
    return moved(state.detail, part * whole, range);
  }
  return moved(state.detail, std::min(wanted / (kCaution * elasticityOf(state)), logarithm(kFarthest)), range);
}

/// Within the budget.
float keepOrRaise(GpgpDetail& state, double cost, Range range) {
  const float detail = state.detail;
  if (detail == state.safe) {
    state.rises = detail == state.lastDetail && cost > kRises * static_cast<double>(state.lastCost) ? 1 : 0;
    const double anchor = state.safeCost;
    if (std::abs(cost - anchor) > range.drift * anchor) {
      state.excess = state.excessCost = 0;
      state.searched = 0;
      state.safeCost = static_cast<float>(cost);
    }
  } else {
    state.safe = detail;
    state.safeCost = static_cast<float>(cost);
    if (detail >= state.excess) {
      state.excess = state.excessCost = 0;
      state.searched = 0;
    }
  }
  if (state.rises && cost > kNear)
    return moved(detail, (logarithm(kBack) - logarithm(cost)) / elasticityOf(state), range);
  if (cost >= (state.rises ? kFar : kEnough) || detail >= range.most) return detail;
  return raise(state, std::max(cost, 1e-6), range);
}

} // namespace

double logarithm(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent); // [0.5, 1)
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  const double t = (m - 1) / (m + 1), s = t * t; // ln m = 2 atanh t, |t| < 0.172
  const double series = 1 + s * (1.0 / 3 + s * (1.0 / 5 + s * (1.0 / 7 + s * (1.0 / 9))));
  return exponent + 2.8853900817779268 * (t * series);
}

double power(double x) {
  const double whole = std::floor(x + 0.5), y = (x - whole) * 0.69314718055994531; // |y| < 0.347
  const double series =
      1 + y * (1 + y * (1.0 / 2 + y * (1.0 / 6 + y * (1.0 / 24 + y * (1.0 / 120 + y * (1.0 / 720))))));
  return std::ldexp(series, static_cast<int>(whole));
}

bool isValid(const GpgpDetailBudget& budget) {
  const Range range = rangeOf(budget);
  const auto detail = [](float x) { return x == 0 || (x >= 1e-6f && x <= 1e6f); };
  return (budget.instances || budget.vertices || budget.shapes || budget.milliseconds > 0) &&
         budget.milliseconds >= 0 && std::isfinite(budget.milliseconds) && detail(budget.minDetail) &&
         detail(budget.maxDetail) && range.least <= range.most;
}

double costOf(const GpgpDetailBudget& budget, const GpgpSpawnReport& report, double milliseconds) {
  const auto share = [](double used, double of) { return of > 0 ? used / of : 0; };
  const double cost = std::max({share(report.terminals, budget.instances), share(report.vertices, budget.vertices),
                                share(report.peakShapes, budget.shapes), share(milliseconds, budget.milliseconds)});
  return report.base.status == GPGP_BUDGET_EXCEEDED && cost <= 1 ? 2 : cost;
}

bool adapt(const GpgpDetailBudget& budget, const GpgpSpawnReport* report, double milliseconds, GpgpDetail& state) {
  const Range range = rangeOf(budget);
  state.detail = state.detail > 0 ? std::clamp(state.detail, range.least, range.most) : range.least;
  if (!report || report->base.status < GPGP_SUCCESS || report->base.status == GPGP_NOT_EXECUTED ||
      report->detail != state.detail)
    return true;
  const double cost = costOf(budget, *report, milliseconds);
  const bool least = state.detail <= range.least, within = cost <= 1;
  state.exceeded = within ? 0 : state.exceeded + 1;
  const float next = within ? keepOrRaise(state, cost, range) : lower(state, cost, range);
  measure(state, std::max(cost, 1e-6));
  state.detail = next;
  return within || !least;
}

} // namespace gpgp::spawn
