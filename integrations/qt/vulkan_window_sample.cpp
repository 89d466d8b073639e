// gpgp in a QVulkanWindow.
#include "sample_instance.h"
#include "sample_window.h"

#include <QtGui/QGuiApplication>

#include <cstdio>

namespace gpgp::sample {
namespace {

constexpr const char* kHelp = R"(gpgp_qt_vulkan_window_sample: a canvas of gpgp in a QVulkanWindow

  --svg FILE       the drawing (default: the HUD of the mini-engine)
  --font FILE      the text's font (default: DejaVu Sans, where it is installed); without one there is no text
  --text TEXT      the line
  --frames N       ends after N frames; otherwise closing the window does
  --size WxH       of the window (default 960x540)
  --device INDEX   of the GPU (default 0)
  --picture FILE   at the end, the window with the animation at a quarter, as PNG or BMP
  --validate       under the Khronos validation layer; any message of it is an error

Exit code 0: all is well; 1: an error or a validation message; 2: wrong usage.
)";

int run(const Options& options) {
  int argc = 1;
  char name[] = "gpgp_qt_vulkan_window_sample";
  char* argv[] = {name, nullptr};
  QGuiApplication application(argc, argv);
  SampleInstance instance(options.validate);
  int code = 0;
  {
    SampleWindow window(options, [&](const std::string& why) {
      std::fprintf(stderr, "gpgp_qt_vulkan_window_sample: %s\n", why.c_str());
      code = 1;
      application.exit();
    });
    window.setVulkanInstance(&instance.get());
    if (!options.device.empty()) window.setPhysicalDeviceIndex(std::atoi(options.device.c_str()));
    window.resize(static_cast<int>(options.width), static_cast<int>(options.height));
    window.show();
    while (window.isVisible() && code == 0 &&
           (options.frames == 0 || !window.renderer || window.renderer->frames < options.frames))
      application.processEvents(QEventLoop::WaitForMoreEvents, 20);
    if (code == 0 && !options.picture.empty()) {
      window.renderer->fixedTime = 0.25f;
      if (!window.picture().save(QString::fromStdString(options.picture)))
        throw std::runtime_error("cannot write " + options.picture);
    }
    window.destroy(); // releases what it has on the device before its surface goes
  }
  if (options.validate) std::printf("validation  %u messages\n", instance.validationMessages());
  return code == 0 && instance.validationMessages() == 0 ? 0 : 1;
}

} // namespace
} // namespace gpgp::sample

int main(int argc, char** argv) {
  gpgp::sample::Options options;
  options.text = "gpgp in a QVulkanWindow";
  options.width = 960;
  options.height = 540;
  options.maxWidth = options.maxHeight = 4096;
  return gpgp::sample::sampleMain(argc, argv, "gpgp_qt_vulkan_window_sample", gpgp::sample::kHelp, options,
                                  gpgp::sample::run);
}
