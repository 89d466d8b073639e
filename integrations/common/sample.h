// What the samples with a window share: their command line, errors as exceptions, and files.
#pragma once
#include <gpgp/gpgp.hpp>

#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace gpgp::sample {

struct Options {
  std::string svg = GPGP_SAMPLE_SVG, font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", text, device, picture;
  std::vector<std::string> fallbacks;
  uint32_t frames = 0, width = 0, height = 0, maxWidth = 0, maxHeight = 0;
  bool validate = false;
};

/// main(): prints `help` where it is asked for (exit code 0) or the arguments are wrong (2), errors (1), and else what
/// `run` returns. options: the defaults and limits.
int sampleMain(int argc, char** argv, const char* name, const char* help, Options options, int (*run)(const Options&));

/// The code of a call that failed, as an exception; statuses are handed back.
GpgpResult need(GpgpResult result, const char* what);

template <class T> T take(Result<T> result, const char* what) {
  need(result.code(), what);
  return *std::move(result);
}

/// To standard error.
void GPGP_CALL onMessage(void*, const GpgpMessage* message);

bool isThere(const std::string& file);
/// An SVG file.
Drawing loadDrawing(GpgpContext context, const std::string& file);

/// A font and what it falls back to, those that are there; files that are not are named on standard error. Inline, as
/// only samples with text are linked with libgpgp_text.
class FontChain {
public:
  explicit FontChain(const Options& options) {
    open(options.font);
    for (const std::string& file : options.fallbacks) open(file);
  }
  bool empty() const { return handles_.empty(); }
  void set(GpgpTextStyle& style) const {
    style.fonts = handles_.data();
    style.fontCount = static_cast<uint32_t>(handles_.size());
  }

private:
  void open(const std::string& file) {
    if (!isThere(file)) {
      std::fprintf(stderr, "%s is not there: no text in this font (--font, --fallback)\n", file.c_str());
      return;
    }
    auto info = init<GpgpFontCreateInfo>();
    info.filePath = file.c_str();
    info.messageFn = onMessage;
    fonts_.push_back(take(Font::create(info), "gpgpCreateFont"));
    handles_.push_back(fonts_.back());
  }
  std::vector<Font> fonts_;
  std::vector<GpgpFont> handles_;
};

} // namespace gpgp::sample
