// A line of a .lsys file with what continues it, and the reader that takes modules and expressions from it.
#pragma once
#include "spawn/lsystem/statements.h"
#include "spawn/lsystem/syntax.h"

#include <functional>
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

/// Whether a file is written for the plant modellers cpfg and lpfg: it has a line "lsystem: 1", "derivation length: 5",
/// "maximum depth: 2" or "endlsystem".
bool isOfPlantModeller(std::string_view text);
/// Lines of such a file in this language: macros are replaced, comments are /* */ alone, lines that belong to one
/// production are joined, headings have their names here. What has no meaning here is reported.
std::vector<Line> plantModellerLines(std::string_view text, Diagnostics& diagnostics, const ReadFile& read);
/// A file in L+C as one line, behind the preprocessor; macros that are numbers are constants of it.
Line preprocessedC(std::string_view text, Diagnostics& diagnostics, const ReadFile& read);

/// A file of L-Py as text in L+C, each character at the place that it comes from.
struct LpyText {
  Line code;
  float angle = 60; ///< of a turn without another one
  bool hasLength = false;
};
LpyText translateLpy(std::string_view text, Diagnostics& diagnostics);

/// Where a production's arrow begins (-->, ->) and how long it is; npos where there is none.
std::pair<size_t, size_t> arrowIn(std::string_view text);

/// Words of C that begin declarations, and those of integers.
bool isTypeName(std::string_view name);
bool isWholeType(std::string_view name);

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
  /// { statements }.
  std::vector<Statement> block();
  void statement(std::vector<Statement>& into, uint32_t depth);
  /// Modules as L+C writes them: names of several letters, each with or without values in parentheses.
  ModuleString calls();
  /// name = value, behind a type.
  void declaration(std::vector<Statement>& into, bool isWhole);
  void passOverArguments();
  /// What code has declared, and the value of an expression that is known when the file is read.
  void know(Declared& declared, const std::function<std::optional<float>(const Expression&)>& fixed) {
    declared_ = &declared;
    fixed_ = fixed;
  }
  size_t at() const { return at_; }
  void goTo(size_t at) { at_ = at; }
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
  std::string surfaceInQuotes();
  Expression call(Expression e, uint32_t depth);
  Expression elementAt(const std::string& array);
  Expression element(const std::string& array, const Expression& index);
  Expression condition();
  std::vector<Statement> branch(uint32_t depth);
  void assignment(std::vector<Statement>& into, Statement& s);
  void change(std::vector<Statement>& into, Statement& s, const std::string& name, uint32_t code, Expression value);
  void arrayValues(std::vector<Statement>& into, const Statement& s);
  void endOfStatement();
  bool isC() const { return declared_ && declared_->isC; }
  void blanks();

  const Line& line_;
  size_t at_, end_;
  Diagnostics& diagnostics_;
  const std::set<std::string>& names_; ///< modules of several letters
  bool failed_ = false;
  bool inHeader_ = false; ///< of a loop
  Declared* declared_ = nullptr;
  std::function<std::optional<float>(const Expression&)> fixed_;
};

} // namespace gpgp::spawn::lsystem
