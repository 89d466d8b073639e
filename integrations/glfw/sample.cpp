// A drawing and a line of text in a window of GLFW's: what gpgp::glfw is for.
#include "gpgp_glfw.hpp"
#include "window_sample.h"

namespace {

int run(const gpgp::sample::Options& options) {
  gpgp::glfw::Window window({"gpgp", options.width, options.height});
  return gpgp::sample::runInWindow(options, window, [&] { return window.pollEvents(); });
}

} // namespace

int main(int argc, char** argv) { return gpgp::sample::windowMain(argc, argv, "gpgp_glfw_sample", run); }
