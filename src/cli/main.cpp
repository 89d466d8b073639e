// The `gpgp` command: what the library does, from the command line. One file per subcommand.
#include "cli/shared/command.h"
#include "cli/shared/messages.h"
#include "core/suggest.h"

#include <gpgp/core.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <utility>
#include <vector>

namespace {

using namespace gpgp::cli;

constexpr const char* kExamples = R"(
Examples:
  gpgp info                                   what this machine offers and gpgp would use
  gpgp spawn city.pga --axioms 64 --axiom-size 20,60,20 --spacing 24 --image city.png
  gpgp graph city.pga --schedule rules --format svg -o city.svg
  gpgp vector tiger.svg --size 800x800 --out tiger.png
  gpgp text DejaVuSans.ttf "Hello, world" hello.png --size 48
  gpgp visibility engine.glb --size 1280x720 --image seen.png
  gpgp spawn city.pga --json | jq .terminals  one object on standard output, nothing else there

`gpgp SUBCOMMAND --help` explains each one. Exit codes: 0 success, 1 the work failed, 2 wrong usage.)";

struct Subcommand {
  CLI::App* app = nullptr;
  CommonOptions options;
  Work work;
};

/// Names the first argument that looks like an option and is none of the command's, nor the value of one. Empty where
/// there is none.
std::string unknownOption(const CLI::App& command, int argc, char** argv) {
  bool isValue = false;
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i) {
    const std::string_view argument = argv[i];
    const std::string name(argument.substr(0, argument.find('=')));
    if (std::exchange(isValue, false) || !argument.starts_with("-")) continue;
    if (const CLI::Option* option = command.get_option_no_throw(name)) {
      isValue = option->get_items_expected_max() > 0 && name.size() == argument.size();
      continue;
    }
    if (!argument.starts_with("--")) continue;
    gpgp::core::Suggestion suggestion(name);
    for (const CLI::Option* option : command.get_options())
      for (const std::string& known : option->get_lnames()) suggestion.offer("--" + known);
    return "there is no option '" + name + "'" + suggestion.text();
  }
  return {};
}

/// The last line on standard error of a command that failed. errorsShown: which lines before it say what failed.
void say(const std::string& command, const std::string& failure, size_t errorsShown) {
  const std::string count = std::to_string(errorsShown) + (errorsShown == 1 ? " error" : " errors");
  std::fprintf(stderr, "gpgp %s: %s\n", command.c_str(), errorsShown ? count.c_str() : failure.c_str());
}

int run(int argc, char** argv) {
  CLI::App app("gpgp: grammars, vector graphics and triangle visibility on the GPU", "gpgp");
  app.footer(kExamples);
  app.allow_windows_style_options(false); // what begins with / is a file, there as elsewhere
  app.require_subcommand(1);
  app.set_version_flag("--version", "gpgp " + std::to_string(GPGP_VERSION_MAJOR) + "." +
                                        std::to_string(GPGP_VERSION_MINOR) + "." + std::to_string(GPGP_VERSION_PATCH));
  std::vector<Subcommand> subcommands;
  subcommands.reserve(9); // options are bound by address
  const auto add = [&](Work (*adder)(CLI::App&), bool records = false) {
    Subcommand& subcommand = subcommands.emplace_back();
    subcommand.work = adder(app);
    subcommand.app = app.get_subcommands([](CLI::App*) { return true; }).back();
    addCommonOptions(*subcommand.app, subcommand.options);
    if (records) addDumpOptions(*subcommand.app, subcommand.options);
  };
  add(addInfo);
#ifdef GPGP_CLI_SPAWN
  add(addSpawn, true);
  add(addFit, true);
  add(addGraph);
  add(addTune);
#endif
#ifdef GPGP_CLI_VECTOR
  add(addVector, true);
#endif
#ifdef GPGP_CLI_TEXT
  add(addText, true);
#endif
#if defined GPGP_CLI_SPAWN || defined GPGP_CLI_VECTOR
  add(addBake);
#endif
#ifdef GPGP_CLI_VISIBILITY
  add(addVisibility, true);
#endif

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) { // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    const std::string first = argc > 1 ? argv[1] : "";
    std::string all, help = "gpgp", option;
    bool known = false;
    gpgp::core::Suggestion command(first);
    for (const Subcommand& subcommand : subcommands) {
      const std::string name = subcommand.app->get_name();
      all += (all.empty() ? "" : ", ") + name;
      command.offer(name);
      if (name != first && !subcommand.app->parsed()) continue;
      known = true;
      help = "gpgp " + name;
      option = unknownOption(*subcommand.app, argc, argv);
    }
    if (!known && !first.empty() && first[0] != '-')
      std::fprintf(stderr, "there is no command \"%s\"; there are %s%s\n", printable(first).c_str(), all.c_str(),
                   command.text().c_str());
    else
      std::fprintf(stderr, "%s\n", printable(option.empty() ? error.what() : option).c_str());
    std::fprintf(stderr, "Run `%s --help` for more information.\n", help.c_str());
    return 2;
  }
  for (const Subcommand& subcommand : subcommands) {
    if (!subcommand.app->parsed()) continue;
    const std::string name = subcommand.app->get_name();
    try {
      const Outcome outcome = subcommand.work(subcommand.options);
      Json object = {{"command", name}, {"ok", outcome.failure.empty()}};
      object.update(outcome.json);
      if (!outcome.failure.empty()) object["error"] = outcome.failure;
      const std::string text = subcommand.options.json ? object.dump(2) + "\n" : outcome.text;
      if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw Failure("cannot write to standard output");
      if (outcome.failure.empty()) return 0;
      say(name, outcome.failure, outcome.errorsShown);
      return 1;
    } catch (const Usage& error) {
      std::fprintf(stderr, "gpgp %s: %s\n", name.c_str(), printable(error.what()).c_str());
      return 2;
    } catch (const std::exception& error) {
      const std::string text = printable(error.what());
      const auto* shown = dynamic_cast<const ErrorsShown*>(&error);
      say(name, text, shown ? shown->count : 0);
      if (subcommand.options.json) {
        const Json object = {{"command", name}, {"ok", false}, {"error", text}};
        std::printf("%s\n", object.dump(2).c_str());
      }
      return 1;
    }
  }
  return 2;
}

} // namespace

int main(int argc, char** argv) {
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN); // a file that may not grow is an error like a full disk, and cleaned up after
#endif
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gpgp: %s\n", error.what());
    return 1;
  }
}
