// What files of the command share that need neither its options nor JSON: how work fails, options that all subcommands
// have, sizes and input files.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

namespace gpgp::cli {

using Json = nlohmann::ordered_json;
struct Outcome;

/// The work failed: exit code 1, and the text for the person.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The same of errors that are on standard error already, each with its place: there they are only counted. The text,
/// for
/// --json, is that of the first.
struct ErrorsShown : Failure {
  ErrorsShown(const std::string& first, size_t errors)
      : Failure(first + (errors > 1 ? " (and " + std::to_string(errors - 1) + " more)" : "")), count(errors) {}
  size_t count;
};
/// The command was used wrongly: exit code 2. For what CLI11's own checks cannot know.
struct Usage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct CommonOptions {
  std::string device;
  bool json = false;
  bool validate = false;
  std::string dumpPass, dumpFolder; ///< of the commands that record passes
};

struct Size {
  uint32_t width = 0, height = 0;
};
/// "1280x720"; throws CLI::ValidationError otherwise. At most 16384 a side.
Size parseSize(const std::string& text);
/// "X,Y,Z" of positive numbers.
std::array<float, 3> parseTriple(const std::string& text);

/// Names a file, or standard input.
inline constexpr const char* kStandard = "-";
/// The bytes of a file, or of standard input.
std::string readInput(const std::string& file);
/// What messages call it.
std::string inputName(const std::string& file);

} // namespace gpgp::cli
