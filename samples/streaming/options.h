// Options that server and client share.
#pragma once
#include "shading.h"
#include "world.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <map>
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

/// Of who shades. side: of the atlas; for setAtlas.
inline void addShadingOptions(CLI::App& app, ShadingOptions& shading, EncoderOptions& coding, uint32_t& side) {
  const std::map<std::string, GpgpSamplingMethod> methods = {{"standard", GPGP_SAMPLING_STANDARD},
                                                             {"conservative", GPGP_SAMPLING_CONSERVATIVE},
                                                             {"exact", GPGP_SAMPLING_EXACT}};
  app.add_option("--sampling", shading.method, "how visible triangles are found (default: exact)")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case));
  const std::map<std::string, Codec> codecs = {{"x264", Codec::x264}, {"zstd", Codec::zstd}};
  app.add_option("--codec", coding.codec, "x264 (default), or zstd: changed tiles without loss")
      ->transform(CLI::CheckedTransformer(codecs, CLI::ignore_case));
  app.add_option("--bitrate", coding.megabits, "Mbit/s for x264; 0: constant quality (CRF 20)")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  app.add_option("--atlas", side, "texels along the atlas's sides, a multiple of 128")
      ->check(CLI::Range(128, 4096))
      ->capture_default_str();
  app.add_option("--texels", shading.texelsPerPixel, "texels for each pixel")
      ->check(CLI::Range(0.01, 16.0))
      ->capture_default_str();
  app.add_option("--gutter", shading.gutter, "texels around blocks, 0 or 1, against codecs that blur")
      ->check(CLI::Range(0, 1))
      ->capture_default_str();
  app.add_option("--reshade", shading.reshade, "shade a block in one of N frames, new and changed ones always")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}
inline void setAtlas(ShadingOptions& shading, uint32_t side) {
  if (side % 128) throw std::runtime_error("--atlas is no multiple of 128");
  shading.atlasWidth = shading.atlasHeight = side;
}
/// Of who displays. Throws where the text is no size that a picture can have.
inline void parseSize(const std::string& text, uint32_t& width, uint32_t& height) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) != 2 || width < 16 || height < 16 || width > 4096 ||
      height > 4096)
    throw std::runtime_error("--size is WIDTHxHEIGHT, 16 to 4096 each");
}
inline float radiansOf(double degrees) { return static_cast<float>(degrees * 3.14159265358979 / 180); }

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
