// What a script does to live editing, in place of a person with an editor: a command a line.
//
//   set NAME VALUE     an attribute, as its slider does: a number, true, false, a choice, or #rrggbb
//   write FILE         the grammar's file gets this file's text, as an editor saves it
//   frames N           N frames go by
//   picture FILE       the picture as it is, as PNG; prints what it shows
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace mini {

struct LiveCommand {
  enum Kind { set, write, frames, picture } kind = frames;
  std::string name; ///< of the attribute or the file
  std::string value;
  uint32_t count = 0;
};

/// Throws std::runtime_error with file and line. Files are relative to the script's folder, or absolute.
std::vector<LiveCommand> readLiveScript(const std::string& file);
/// As editors save: a new file beside it takes its name.
void saveAs(const std::string& from, const std::string& to);

} // namespace mini
