#include "cli/visibility/camera_times.h"

#include "cli/shared/command.h"
#include "cli/shared/median.h"

#include <map>

namespace gpgp::cli {
namespace {
using Passes = std::vector<std::pair<std::string, double>>;

/// Calls use(place in `passes`, milliseconds) for each of a list of which some may not have run: a pass is found again
/// by its name and how many of that name come before it, and added where it is new.
template <class Use> void match(Passes& passes, const Passes& others, const Use& use) {
  std::map<std::string, size_t> seen;
  size_t next = 0; // behind the last one found
  for (const auto& [name, time] : others) {
    size_t number = seen[name]++, at = 0;
    for (; at < passes.size(); ++at)
      if (passes[at].first == name && number-- == 0) break;
    if (at == passes.size()) {
      at = next;
      passes.insert(passes.begin() + static_cast<std::ptrdiff_t>(at), {name, 0.0});
    }
    next = at + 1;
    use(at, time);
  }
}
} // namespace

void CameraTimes::add(const GpuTimes& view) {
  repeats = view.totals.size();
  median += view.median();
  least += view.least();
  match(passes, view.passes, [&](size_t p, double time) { passes[p].second += time; });
}

Json CameraTimes::json() const {
  Json list = Json::array();
  for (const auto& [name, time] : passes) list.push_back({{"name", name}, {"milliseconds", time}});
  return {{"repeats", repeats}, {"median", median}, {"least", least}, {"passes", list}};
}

Json CameraTimes::passesByName() const {
  Json sums = Json::object();
  for (const auto& [name, time] : passes) sums[name] = sums.value(name, 0.0) + time;
  return sums;
}

CameraTimes medianOf(const std::vector<CameraTimes>& cameras) {
  const auto over = [&](const auto& number) {
    std::vector<double> values;
    for (const CameraTimes& camera : cameras) values.push_back(number(camera));
    return medianOf(std::move(values));
  };
  if (cameras.empty()) return {};
  CameraTimes result = cameras.front();
  result.median = over([](const CameraTimes& camera) { return camera.median; });
  result.least = over([](const CameraTimes& camera) { return camera.least; });
  result.passes.clear();
  for (const CameraTimes& camera : cameras) match(result.passes, camera.passes, [](size_t, double) {});
  std::vector<std::vector<double>> times(result.passes.size()); // 0 where a camera did not run it
  for (const CameraTimes& camera : cameras) {
    std::vector<double> own(times.size());
    match(result.passes, camera.passes, [&](size_t p, double time) { own[p] = time; });
    for (size_t p = 0; p < own.size(); ++p) times[p].push_back(own[p]);
  }
  for (size_t p = 0; p < times.size(); ++p) result.passes[p].second = medianOf(std::move(times[p]));
  return result;
}

} // namespace gpgp::cli
