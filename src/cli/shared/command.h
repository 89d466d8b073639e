// What every subcommand of `gpgp` shares: options, the exit code, and the one JSON object.
//
// Standard output carries results only: text for people, or with --json exactly one object. Everything else (progress,
// warnings, errors) goes to standard error. Exit codes: 0 success, 1 the work failed, 2 the command was used wrongly.
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace gpgp::cli {

using Json = nlohmann::ordered_json;

/// The work failed: exit code 1, and the text for the person.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
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

/// A finished piece of work: the object for --json, and the same for people.
struct Outcome {
  Json json;
  std::string text;
  std::string failure; ///< what was done is not what was asked for
};
using Work = std::function<Outcome(const CommonOptions&)>;

/// Adds --device, --json and --validate, and remembers what to do when this subcommand was chosen.
void addCommonOptions(CLI::App& command, CommonOptions& options);

/// Adds --dump-pass and --dump-folder.
void addDumpOptions(CLI::App& command, CommonOptions& options);

struct Size {
  uint32_t width = 0, height = 0;
};
/// "1280x720"; throws CLI::ValidationError otherwise. At most 16384 a side.
Size parseSize(const std::string& text);
/// "X,Y,Z" of positive numbers.
std::array<float, 3> parseTriple(const std::string& text);
/// A callback option that holds a size.
CLI::Option* addSize(CLI::App& command, const std::string& name, Size& size, const std::string& help);

/// The name of a picture to be written: PNG is the only format.
CLI::Validator pngFile();
/// And of triangles: binary glTF.
CLI::Validator glbFile();

/// Names a file, or standard input.
inline constexpr const char* kStandard = "-";
/// A check for options: a file that is there, or -.
CLI::Validator existingInput();
/// The bytes of a file, or of standard input.
std::string readInput(const std::string& file);
/// What messages call it.
std::string inputName(const std::string& file);

/// As CLI::Range, but what is no number is not within.
CLI::Validator within(double low, double high);

// One file per subcommand. Each adds itself to the app and returns what it does when chosen.
Work addInfo(CLI::App& app);
Work addSpawn(CLI::App& app);
Work addGraph(CLI::App& app);
Work addTune(CLI::App& app);
Work addVector(CLI::App& app);
Work addText(CLI::App& app);
Work addBake(CLI::App& app);
Work addVisibility(CLI::App& app);

} // namespace gpgp::cli
