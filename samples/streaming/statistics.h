// Numbers over frames, printed and as JSON.
#pragma once
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace streaming {

class Series {
public:
  void add(double value) {
    sum_ += value;
    worst_ = std::max(worst_, value);
    least_ = count_ ? std::min(least_, value) : value;
    ++count_;
  }
  double mean() const { return count_ ? sum_ / static_cast<double>(count_) : 0; }
  double worst() const { return worst_; }
  double least() const { return least_; }
  uint64_t count() const { return count_; }
  double sum() const { return sum_; }
  nlohmann::json json() const { return {{"mean", mean()}, {"worst", worst()}, {"count", count_}}; }

private:
  double sum_ = 0, worst_ = 0, least_ = 0;
  uint64_t count_ = 0;
};

/// Named series in the order in which they were first added to.
class Table {
public:
  void add(const std::string& name, double value);
  const Series& operator[](const std::string& name) const;
  nlohmann::json json() const;
  /// A line for each: name, mean, worst.
  void print(const char* title) const;

private:
  std::vector<std::pair<std::string, Series>> rows_;
};

void writeJson(const std::string& file, const nlohmann::json& json);

} // namespace streaming
