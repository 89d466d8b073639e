// Options that server and client share.
#pragma once
#include "world.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <string>

namespace streaming {

struct WorldOptions {
  uint32_t houses = 6;
  std::string model, device, json, out;
  bool validate = false;

  void addTo(CLI::App& app) {
    app.add_option("--village", houses, "houses on each side of the village's street")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    app.add_option("--model", model, "a binary glTF 2 file instead of the village; both sides need the same one");
    app.add_option("--device", device, "GPU: part of its name, or an index (default: $GPGP_DEVICE, else software)");
    app.add_option("--json", json, "write all figures to this file");
    app.add_option("--out", out, "write PNG pictures into this folder");
    app.add_flag("--validate", validate, "run under the Khronos validation layer; any message of it is an error");
  }
  World load() const { return model.empty() ? makeVillage(houses) : loadWorld(model); }
};

/// Ctrl+C and SIGTERM end the program as its own end does.
inline volatile std::sig_atomic_t interrupted = 0;
inline void endOnSignals() {
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });
}

/// Parses, runs, and prints what went wrong. 0: all is well; 1: an error; 2: wrong usage.
template <class Run> int mainOf(CLI::App& app, int argc, char** argv, const Run& run) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) ? 2 : 0;
  }
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 1;
  }
}

} // namespace streaming
