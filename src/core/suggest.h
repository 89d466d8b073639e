// "Did you mean": of the names that could stand somewhere, the one that a wrong name is most like.
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace gpgp::core {

/// Keeps the candidate with the least distance: letters to insert, remove, replace or exchange with their neighbour,
/// whatever their case. Of names as far away the first is kept. Names of up to two letters differ in case only, longer
/// ones in one letter for each three, three letters at most.
class Suggestion {
public:
  explicit Suggestion(std::string_view wrong)
      : wrong_(lowerCase(wrong)), distance_(std::min(wrong.size() / 3, kMostDistance) + 1) {}

  void offer(std::string_view candidate) {
    if (distance_ == 0 || wrong_.size() > kMostLetters || candidate.size() > kMostLetters) return;
    const size_t distance = distanceOf(wrong_, lowerCase(candidate), distance_ - 1);
    if (distance >= distance_) return;
    distance_ = distance;
    best_ = candidate;
  }

  /// "; did you mean 'Translate'?", or nothing.
  std::string text() const { return best_.empty() ? std::string() : "; did you mean '" + best_ + "'?"; }

private:
  static constexpr size_t kMostDistance = 3, kMostLetters = 64; // longer names are not compared

  static std::string lowerCase(std::string_view text) {
    std::string result(text);
    for (char& c : result)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
  }

  /// Optimal string alignment distance, row by row; or something above most, where it is above most.
  static size_t distanceOf(std::string_view a, std::string_view b, size_t most) {
    if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > most) return most + 1;
    using Row = std::array<size_t, kMostLetters + 1>;
    std::array<Row, 3> rows{};
    for (size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
      Row& row = rows[i % 3];
      const Row &before = rows[(i + 2) % 3], &twoBefore = rows[(i + 1) % 3];
      size_t least = row[0] = i;
      for (size_t j = 1; j <= b.size(); ++j) {
        row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
        if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
          row[j] = std::min(row[j], twoBefore[j - 2] + 1);
        least = std::min(least, row[j]);
      }
      if (least > most) return most + 1;
    }
    return rows[a.size() % 3][b.size()];
  }

  std::string wrong_; // in lower case
  size_t distance_;   // of the best one; what is as far away is not like it
  std::string best_;
};

} // namespace gpgp::core
