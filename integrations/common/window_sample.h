// The sample that gpgp::sdl2 and gpgp::glfw share: a window with a drawing and a line of text, both by gpgp.
#pragma once
#include "gpgp_device.hpp"
#include "sample.h"

#include <functional>

namespace gpgp::sample {

/// main() of it: reads the command line and calls `run`, which opens a window and calls runInWindow.
int windowMain(int argc, char** argv, const char* name, int (*run)(const Options&));

/// Draws frames until pollEvents returns false or options.frames are done. Returns the exit code.
int runInWindow(const Options& options, integration::Window& window, const std::function<bool()>& pollEvents);

} // namespace gpgp::sample
