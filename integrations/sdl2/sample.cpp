// A drawing and a line of text in a window of SDL2's: what gpgp::sdl2 is for.
#include "gpgp_sdl2.hpp"
#include "window_sample.h"

namespace {

int run(const gpgp::sample::Options& options) {
  gpgp::sdl2::Window window({"gpgp", options.width, options.height});
  return gpgp::sample::runInWindow(options, window, [&] { return window.pollEvents(); });
}

} // namespace

int main(int argc, char** argv) { return gpgp::sample::windowMain(argc, argv, "gpgp_sdl2_sample", run); }
