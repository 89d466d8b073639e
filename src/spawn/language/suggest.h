// "Did you mean": of the names that could stand somewhere, the one that a wrong name is most like.
#pragma once
#include <string>
#include <string_view>

namespace gpgp::spawn {

/// Keeps the candidate with the least distance: letters to insert, remove, replace or exchange with their neighbour,
/// whatever their case. Of names as far away the first is kept. Names of up to two letters differ in case only, longer
/// ones in one letter for each three, three letters at most.
class Suggestion {
public:
  explicit Suggestion(std::string_view wrong);
  void offer(std::string_view candidate);
  /// "; did you mean 'Translate'?", or nothing.
  std::string text() const;

private:
  std::string wrong_; // in lower case
  size_t distance_;   // of the best one; what is as far away is not like it
  std::string best_;
};

} // namespace gpgp::spawn
