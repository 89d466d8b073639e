// A line of a .lsys file with what continues it, and the reader that takes modules and expressions from it.
#pragma once
#include "spawn/lsystem/syntax.h"

#include <set>

namespace gpgp::spawn::lsystem {

/// Text without comments, and where each of its characters stands.
struct Line {
  std::string text;
  std::vector<Place> places; ///< one more than characters
};

/// Lines that say something. Comments are # and // behind a blank or at the start of a line (// also before a blank),
/// and /* */ behind a blank. An indented line without an arrow and without a name and ':' continues the one before.
std::vector<Line> linesOf(std::string_view text);

/// Where a production's arrow begins (-->, ->) and how long it is; npos where there is none.
std::pair<size_t, size_t> arrowIn(std::string_view text);

class Reader {
public:
  Reader(const Line& line, size_t begin, size_t end, Diagnostics& diagnostics, const std::set<std::string>& names)
      : line_(line), at_(begin), end_(end), diagnostics_(diagnostics), names_(names) {}

  bool atEnd();
  Place place() const { return line_.places[std::min(at_, line_.places.size() - 1)]; }
  /// What the reader stands at, as messages call it.
  std::string found();
  char peek();
  /// Takes a character if it is next, blanks aside.
  bool take(char c);
  bool take(std::string_view text);
  /// Modules up to one of the characters, or the end. declares: arguments are names.
  ModuleString modules(std::string_view stops, bool declares);
  std::optional<Module> module(bool declares);
  /// An expression; a number 0 after an error, which was reported.
  Expression expression();
  /// The same without binary operators, for lists that blanks divide: 0 -1 are two values.
  Expression value() { return unary(0); }
  std::string identifier();
  std::string word(); ///< up to a blank
  void error(std::string text) { errorAt(place(), std::move(text)); }
  void errorAt(Place place, std::string text) {
    if (failed_) return; // the rest of the line would only be more of the same
    failed_ = true;
    diagnostics_.error(place, std::move(text));
  }
  bool failed() const { return failed_; }

private:
  Expression binary(size_t level, uint32_t depth);
  Expression unary(uint32_t depth);
  Expression primary(uint32_t depth);
  Expression choice(uint32_t depth);
  void blanks();

  const Line& line_;
  size_t at_, end_;
  Diagnostics& diagnostics_;
  const std::set<std::string>& names_; ///< modules of several letters
  bool failed_ = false;
};

} // namespace gpgp::spawn::lsystem
