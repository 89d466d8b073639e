#include "spawn/fit/fit.h"

#include "core/random.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpgp::spawn {
namespace {
constexpr uint32_t kFields = 5;
constexpr float kMostSeed = 16777215.0f;
/// Of a step of annealing, as parts of a parameter's range, in the first and the last round.
constexpr float kLongStep = 0.5f, kShortStep = 0.02f;

/// What a number is drawn for, beside the parameters' own.
enum Draw : uint32_t { kWhich = 100, kAccept, kValue = 200, kOther = 300, kChange = 400 };
float drawn(const GpgpFit& fit, uint32_t round, uint32_t candidate, uint32_t draw) {
  using namespace shader;
  return unitFloat(childSeed(childSeed(childSeed(childSeed(fit.seed, 0x66697400u), round), candidate), draw));
}

/// 0 in the first round, 1 in the last.
float progress(const GpgpFit& fit, uint32_t round) {
  return fit.rounds > 1 ? static_cast<float>(round) / static_cast<float>(fit.rounds - 1) : 1.0f;
}

float stepOf(const GpgpFitParameter& parameter) {
  return parameter.field == GPGP_FIT_SEED ? std::max(std::floor(parameter.step), 1.0f) : parameter.step;
}
/// The nearest value that a parameter may have.
float allowed(const GpgpFitParameter& parameter, float value) {
  const float step = stepOf(parameter);
  if (step > 0) {
    const float most = std::floor((parameter.max - parameter.min) / step);
    value = parameter.min + step * std::clamp(std::floor((value - parameter.min) / step + 0.5f), 0.0f, most);
  }
  return std::clamp(value, parameter.min, parameter.max);
}
/// u is in [0, 1). All values of a parameter with steps are as likely.
float anyValue(const GpgpFitParameter& parameter, float u) {
  const float range = parameter.max - parameter.min, step = stepOf(parameter);
  return allowed(parameter, step > 0 ? parameter.min + step * std::floor(u * (std::floor(range / step) + 1))
                                     : parameter.min + u * range);
}

float valueOf(const GpgpAxiom& axiom, GpgpFitField field) {
  if (field <= GPGP_FIT_SIZE_Z) return axiom.size[field];
  return field == GPGP_FIT_ATTRIBUTE ? axiom.attribute : static_cast<float>(axiom.seed);
}
void set(GpgpAxiom& axiom, GpgpFitField field, float value) {
  if (field <= GPGP_FIT_SIZE_Z)
    axiom.size[field] = value;
  else if (field == GPGP_FIT_ATTRIBUTE)
    axiom.attribute = value;
  else
    axiom.seed = static_cast<uint32_t>(value);
}

float moved(const GpgpFit& fit, uint32_t round, uint32_t candidate, uint32_t number, float value) {
  const GpgpFitParameter& parameter = fit.parameters[number];
  const float u = drawn(fit, round, candidate, kValue + number);
  if (parameter.field == GPGP_FIT_SEED) return anyValue(parameter, u);
  const float both = u + drawn(fit, round, candidate, kOther + number) - 1; // more often near 0 than far
  const float width = kLongStep + (kShortStep - kLongStep) * progress(fit, round);
  float by = both * width * (parameter.max - parameter.min);
  const float step = stepOf(parameter);
  if (step > 0 && std::abs(by) < step) by = both < 0 ? -step : step; // else nothing would change
  return allowed(parameter, value + by);
}
} // namespace

bool isValid(const GpgpFit& fit) {
  if (!fit.parameters || fit.parameterCount == 0 || fit.parameterCount > kFields || !fit.candidates || !fit.rounds)
    return false;
  if (fit.method > GPGP_FIT_ANNEALING || !(fit.startTemperature >= 0) || !(fit.endTemperature >= 0) ||
      !std::isfinite(fit.startTemperature) || !std::isfinite(fit.endTemperature))
    return false;
  uint32_t seen = 0;
  for (uint32_t i = 0; i < fit.parameterCount; ++i) {
    const GpgpFitParameter& p = fit.parameters[i];
    if (p.field >= kFields || (seen >> p.field & 1)) return false;
    seen |= 1u << p.field;
    if (!std::isfinite(p.min) || !std::isfinite(p.max) || !(p.min <= p.max) || !(p.step >= 0) ||
        !std::isfinite(p.max - p.min) || !std::isfinite(p.step))
      return false;
    if (p.field <= GPGP_FIT_SIZE_Z && !(p.min > 0)) return false;
    if (p.field == GPGP_FIT_SEED && (p.min < 0 || p.max > kMostSeed || p.min != std::floor(p.min))) return false;
  }
  return true;
}

GpgpAxiom propose(const GpgpFit& fit, uint32_t round, uint32_t candidate, const GpgpAxiom* current) {
  GpgpAxiom axiom = fit.base;
  axiom.id = candidate;
  const bool all = round == 0 || fit.method == GPGP_FIT_MONTE_CARLO;
  const uint32_t count = fit.parameterCount;
  const uint32_t which =
      std::min(static_cast<uint32_t>(drawn(fit, round, candidate, kWhich) * static_cast<float>(count)), count - 1);
  for (uint32_t i = 0; i < count; ++i) {
    const GpgpFitParameter& parameter = fit.parameters[i];
    if (all) {
      set(axiom, parameter.field, anyValue(parameter, drawn(fit, round, candidate, kValue + i)));
      continue;
    }
    const float value = valueOf(*current, parameter.field);
    const bool changes = i == which || drawn(fit, round, candidate, kChange + i) * static_cast<float>(2 * count) < 1;
    set(axiom, parameter.field, changes ? moved(fit, round, candidate, i, value) : value);
  }
  const float rise = 0.5f * (axiom.size[1] - fit.base.size[1]);
  for (int row = 0; row < 3; ++row) axiom.transform[4 * row + 3] += rise * fit.base.transform[4 * row + 1];
  return axiom;
}

void accept(const GpgpFit& fit, uint32_t round, const GpgpAxiom* proposed, const double* scores,
            GpgpFitCandidate* current, GpgpFitCandidate* best) {
  const double temperature =
      fit.method == GPGP_FIT_ANNEALING
          ? double(fit.startTemperature) +
                (double(fit.endTemperature) - double(fit.startTemperature)) * double(progress(fit, round))
          : 0.0;
  for (uint32_t i = 0; i < fit.candidates; ++i) {
    const double score = std::isnan(scores[i]) ? std::numeric_limits<double>::infinity() : scores[i];
    if (best && ((round == 0 && i == 0) || score < best->score)) *best = {proposed[i], score};
    if (round > 0 && score > current[i].score) {
      if (!(temperature > 0)) continue;
      if (double(drawn(fit, round, i, kAccept)) >= decay((score - current[i].score) / temperature)) continue;
    }
    current[i] = {proposed[i], score};
  }
}

double scoreOf(const GpgpFitTarget& target, const GpgpAxiomMeasures& measures) {
  double score = 0;
  for (uint32_t m = 0; m < GPGP_MAX_MEASURES; ++m)
    if (target.sumWeights[m] != 0)
      score += target.sumWeights[m] * std::abs(static_cast<double>(measures.sums[m]) / 65536 - target.sums[m]);
  if (target.occupancyWeight != 0) {
    const double wrong =
        static_cast<double>(measures.occupiedCells) + target.targetCells - 2.0 * measures.matchingCells;
    score += target.occupancyWeight * wrong / std::max(target.targetCells, 1u);
  }
  return score;
}

double decay(double x) {
  if (!(x < 700)) return 0;
  constexpr int kHalvings = 26; // 1 - x / 2^26, squared as often
  double value = 1 - x / (1 << kHalvings);
  for (int i = 0; i < kHalvings; ++i) value *= value;
  return value;
}

} // namespace gpgp::spawn
