#include "live_script.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace mini {
namespace fs = std::filesystem;

std::vector<LiveCommand> readLiveScript(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + " cannot be read");
  std::vector<LiveCommand> commands;
  size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::istringstream words(line);
    std::string verb, rest;
    if (!(words >> verb) || verb[0] == '#') continue;
    LiveCommand command;
    bool well = true;
    if (verb == "set") {
      command.kind = LiveCommand::set;
      well = static_cast<bool>(words >> command.name >> command.value);
    } else if (verb == "write" || verb == "picture") {
      command.kind = verb == "write" ? LiveCommand::write : LiveCommand::picture;
      well = static_cast<bool>(words >> command.name);
      command.name = (fs::path(file).parent_path() / command.name).string();
    } else {
      well = verb == "frames" && static_cast<bool>(words >> command.count);
    }
    if (!well || words >> rest)
      throw std::runtime_error(file + ":" + std::to_string(number) +
                               ": expected set NAME VALUE, write FILE, frames N or picture FILE");
    commands.push_back(std::move(command));
  }
  return commands;
}

void saveAs(const std::string& from, const std::string& to) {
  fs::copy_file(from, to + ".new", fs::copy_options::overwrite_existing);
  fs::rename(to + ".new", to);
}

} // namespace mini
