// What every subcommand of `gpgp` shares: options, the exit code, and the one JSON object.
//
// Standard output carries results only: text for people, or with --json exactly one object. Everything else (progress,
// warnings, errors) goes to standard error. Exit codes: 0 success, 1 the work failed, 2 the command was used wrongly.
#pragma once
#include "cli/shared/common.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace gpgp::cli {

/// A finished piece of work: the object for --json, and the same for people.
struct Outcome {
  Json json;
  std::string text;
  std::string failure;    ///< what was done is not what was asked for
  size_t errorsShown = 0; ///< where the failure tells of errors that are on standard error already: how many
};
using Work = std::function<Outcome(const CommonOptions&)>;

/// Adds --device, --json and --validate, and remembers what to do when this subcommand was chosen.
void addCommonOptions(CLI::App& command, CommonOptions& options);

/// Adds --dump-pass and --dump-folder.
void addDumpOptions(CLI::App& command, CommonOptions& options);

/// A callback option that holds a size.
CLI::Option* addSize(CLI::App& command, const std::string& name, Size& size, const std::string& help);

/// The name of a picture to be written: PNG is the only format.
CLI::Validator pngFile();
/// And of triangles: binary glTF.
CLI::Validator glbFile();

/// A check for options: a file that is there, or -.
CLI::Validator existingInput();
/// As CLI::Range, but what is no number is not within.
CLI::Validator within(double low, double high);

// One file per subcommand. Each adds itself to the app and returns what it does when chosen.
Work addInfo(CLI::App& app);
Work addSpawn(CLI::App& app);
Work addFit(CLI::App& app);
Work addGraph(CLI::App& app);
Work addTune(CLI::App& app);
Work addVector(CLI::App& app);
Work addText(CLI::App& app);
Work addBake(CLI::App& app);
Work addVisibility(CLI::App& app);

} // namespace gpgp::cli
