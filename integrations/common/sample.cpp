#include "sample.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

namespace gpgp::sample {
namespace {

/// False: wrong says what is.
bool parse(int argc, char** argv, Options& options, std::string& wrong) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--validate") {
      options.validate = true;
      continue;
    }
    wrong = name;
    if (i + 1 == argc) return false;
    wrong += std::string(" ") + argv[i + 1];
    const char* value = argv[++i];
    char rest = 0;
    if (name == "--svg")
      options.svg = value;
    else if (name == "--font")
      options.font = value;
    else if (name == "--fallback")
      options.fallbacks.emplace_back(value);
    else if (name == "--text")
      options.text = value;
    else if (name == "--device")
      options.device = value;
    else if (name == "--picture")
      options.picture = value;
    else if (name == "--frames") {
      if (std::sscanf(value, "%u%c", &options.frames, &rest) != 1 || options.frames == 0) return false;
    } else if (name != "--size" || std::sscanf(value, "%ux%u%c", &options.width, &options.height, &rest) != 2 ||
               options.width == 0 || options.height == 0 || options.width > options.maxWidth ||
               options.height > options.maxHeight) {
      return false;
    }
  }
  return true;
}

} // namespace

int sampleMain(int argc, char** argv, const char* name, const char* help, Options options, int (*run)(const Options&)) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) {
      std::fputs(help, stdout);
      return 0;
    }
  if (std::string wrong; !parse(argc, argv, options, wrong)) {
    std::fprintf(stderr, "%s\n%s: wrong: %s\n", help, name, wrong.c_str());
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 1;
  }
}

GpgpResult need(GpgpResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
  return result;
}

void GPGP_CALL onMessage(void*, const GpgpMessage* message) {
  std::fprintf(stderr, "%s: %s: %s\n", message->function, message->label, message->text);
}

bool isThere(const std::string& file) { return std::ifstream(file).good(); }

Drawing loadDrawing(GpgpContext context, const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  auto source = init<GpgpSvgSource>();
  source.name = file.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  source.messageFn = onMessage;
  const Blob baked = take(compileSvg(source), "gpgpCompileSvg");
  auto info = init<GpgpDrawingCreateInfo>();
  info.label = "drawing";
  info.data = baked.data();
  info.size = baked.size();
  return take(Drawing::create(context, info), "gpgpCreateDrawing");
}

} // namespace gpgp::sample
