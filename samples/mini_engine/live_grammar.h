// Live editing: a grammar file that is followed, with its variables as values that change while the engine runs.
//
// Both are seen in the frame in which update() finds them: it compiles, which takes milliseconds, before the frame's
// uploads. A file with errors changes nothing: the last good grammar stays, and errors() tells what is wrong and where.
//
// Variables are read from the text. A comment behind one says its range and its group:
//
//   var floorHeight = 3; // 2.5 to 5, storeys
#pragma once
#include <gpgp/gpgp.hpp>

#include <optional>
#include <string>
#include <vector>

namespace mini {

struct LiveAttribute {
  std::string name, group;
  float value = 0, min = 0, max = 0;
  float written = 0; ///< in the file
};

/// The variables of a text, in its order. Without a range in a comment: from 0 to twice the value.
std::vector<LiveAttribute> attributesOf(const std::string& text);

struct LiveError {
  std::string file, text;
  uint32_t line = 0, column = 0; ///< from 1; 0: none
  std::string source;            ///< the line in the file
  std::string place() const;
};

class LiveGrammar {
public:
  LiveGrammar(GpgpContext context, std::string file);

  const std::string& file() const { return file_; }
  const std::vector<LiveAttribute>& attributes() const { return attributes_; }
  /// Clamped to the attribute's range. False: there is none of this name.
  bool set(const std::string& name, float value);
  /// Once a frame, between gpgpAdvance and the uploads: the grammar to use from this frame on, if it is another one.
  std::optional<gpgp::Grammar> update();
  /// Of the file as it is; empty: it is what is shown.
  const std::vector<LiveError>& errors() const { return errors_; }
  /// Counts up whenever something else is to be seen: another grammar, or other errors.
  uint64_t version() const { return version_; }
  /// That the last compilation took.
  double compileMilliseconds() const { return compileMilliseconds_; }

private:
  std::optional<gpgp::Grammar> compile(const std::string& text, const std::vector<LiveAttribute>& attributes);

  const GpgpContext context_;
  const std::string file_;
  std::string good_, tried_; // texts: shown, and found last
  std::vector<LiveAttribute> attributes_;
  std::vector<LiveError> errors_, found_;
  bool changed_ = false; // an attribute
  uint64_t version_ = 0;
  double compileMilliseconds_ = 0;
};

} // namespace mini
