// Live editing: a file of rules that is followed while the engine runs, with its attributes as values that a person or
// a script sets. LiveGrammar is one of .pga files, LiveCga one of .cga files.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mini {

struct LiveAttribute {
  enum Kind { number, boolean, choice, colour } kind = number;
  std::string name, group, description;
  float value = 0, min = 0, max = 0; ///< 0 or 1 of booleans; an index of choices
  float step = 0;                    ///< 0: any number
  std::vector<std::string> choices;  ///< as texts
  std::array<float, 3> rgb{};        ///< of a colour: 0 to 1, sRGB
  std::string written;               ///< in the file
  bool given = false;                ///< somebody has set it

  /// As the file would write it.
  std::string text() const;
  /// Clamped to its range, and to steps. False: this is no value of it.
  bool parse(const std::string& text);
};

struct LiveError {
  std::string file, text;
  uint32_t line = 0, column = 0; ///< from 1; 0: none
  std::string source;            ///< the line in the file
  std::string place() const;
};

class LiveFile {
public:
  explicit LiveFile(std::string file) : file_(std::move(file)) {}
  virtual ~LiveFile() = default;
  LiveFile(const LiveFile&) = delete;
  LiveFile& operator=(const LiveFile&) = delete;

  const std::string& file() const { return file_; }
  const std::vector<LiveAttribute>& attributes() const { return attributes_; }
  /// False: there is none of this name, or it has no such value.
  bool set(const std::string& name, const std::string& text);
  /// Of the file as it is; empty: it is what is shown.
  const std::vector<LiveError>& errors() const { return errors_; }
  /// Counts up whenever something else is to be seen: another scene, or other errors.
  uint64_t version() const { return version_; }
  /// That the last compilation took, and derivation on the CPU.
  double compileMilliseconds() const { return compileMilliseconds_; }

protected:
  /// What was set stays so, where the file has not set it otherwise.
  void keepValues(std::vector<LiveAttribute>& attributes) const;
  /// The file could not be used: its errors are shown if it is the same at the next look, and not only in the midst of
  /// being written.
  void showErrors() {
    if (found_.empty()) return;
    errors_ = std::exchange(found_, {});
    ++version_;
  }

  const std::string file_;
  std::vector<LiveAttribute> attributes_;
  std::vector<LiveError> errors_, found_;
  bool changed_ = false; ///< an attribute
  uint64_t version_ = 0;
  double compileMilliseconds_ = 0;
};

/// Nothing where the file is away for the moment, as while an editor replaces it.
std::optional<std::string> readText(const std::string& path);
std::string lineOf(const std::string& text, uint32_t line);

} // namespace mini
