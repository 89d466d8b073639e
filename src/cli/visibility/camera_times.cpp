#include "cli/visibility/camera_times.h"

#include "cli/shared/median.h"

namespace gpgp::cli {

void CameraTimes::add(const GpuTimes& view) {
  repeats = view.totals.size();
  median += view.median();
  least += view.least();
  passes.resize(view.passes.size());
  for (size_t p = 0; p < passes.size(); ++p) {
    passes[p].first = view.passes[p].first;
    passes[p].second += view.passes[p].second;
  }
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
  for (size_t p = 0; p < result.passes.size(); ++p)
    result.passes[p].second = over([p](const CameraTimes& camera) { return camera.passes[p].second; });
  return result;
}

} // namespace gpgp::cli
