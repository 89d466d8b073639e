// A small engine that uses all three gpgp services in one frame: a city from a grammar, a head-up display from SVG
// drawings, and a model whose visible triangles are found and coloured.
#include "engine.h"
#include "game.h"
#include "live_script.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr const char* kHelp = R"(mini_engine: one frame with a spawned city, a vector HUD and sampled visibility

  --out FOLDER     write city.png and side.png there (default: pictures; of a window: only where it is given)
  --frames N       render N frames before the pictures are written (default 3)
  --size WxH       picture size, from 64x64 on (default 1280x720)
  --window         open a window instead; Escape closes it (with --frames: after N frames)
  --device NAME    GPU: part of its name, or an index (default: $GPGP_DEVICE, else the software device)
  --screen         a game's screen instead: crest, score, map, dialogue, menu, an inventory that hangs in the world;
                   screen.png. In a window: arrows and Enter, or the mouse
  --input LIST     for the screen, before the second frame: up, down, enter, click, or XxY, where the mouse moves to:
                   --input down,enter,134x350,click; in a window as its events; prints what happened. For --decoupled
                   its keys: --input f,3
  --score N        on the screen at the beginning, at most 9999999
  --stereo         the screen for two eyes, side by side, each half of the picture
  --watch          compile the city's grammar again whenever its file changes; errors are printed and change nothing
  --live FILE      edit a grammar (.pga) or a .cga file while it is shown: its variables or attributes as sliders,
                   seen in the next frame; a saved file is seen at once, or its errors over the picture while the old
                   city stays. The camera stands still
  --budget N       the city's rules see the camera, whose detail is chosen so that they derive at most N instances,
                   which fade; the camera moves, with --live too: --live samples/world/wood.pga --budget 9000
  --script FILE    live: what happens, a line each: set NAME VALUE, write FILE (saves its text as the grammar),
                   frames N, picture FILE
  --decoupled      object-space shading of the model alone: what gpgp finds visible is shaded in compute, into a
                   record a triangle, and displayed from other poses; shaded.png is the last display
  --method NAME    of decoupled shading: standard, conservative or exact (default); M changes it in a window
  --rate N         decoupled: frames displayed for one of shading (default 4)
  --freeze N       decoupled: no shading after N frames; F does it in a window
  --farther F      decoupled: the shading's camera is F times as far away (default 1)
  --show WHAT      decoupled: shaded (magenta: nothing was shaded); overlay (green: standard sampling finds it, too,
                   grey: the method alone, red: not in the reference, blue: missed); density (red: a pixel and less,
                   blue: 64). 1, 2, 3 in a window
  --reference N        decoupled overlay: N x N samples a pixel (default 16), a few slices a frame; shading waits
                   for them, so that 16 x 16 need 17 frames
  --path           decoupled: the same path with standard and exact sampling; prints what displays missed, and times
  --table          the path with all configurations of the thesis's table 6.1, too
  --data FOLDER    test data (default: the source tree's)
  --validate       run under the Khronos validation layer; any message of it is an error

Exit code 0: all is well; 1: an error, a validation message or an exceeded budget; 2: wrong usage.
)";

struct Options {
  std::string out, device, data = MINI_ENGINE_DATA, live, script;
  uint32_t frames = 0, budget = 0;
  VkExtent2D size{1280, 720};
  bool screen = false, stereo = false;
  uint32_t score = 0;
  std::vector<mini::Input> inputs;
  bool window = false, validate = false, watch = false, path = false, table = false;
  mini::DecoupledOptions decoupled;
  bool method = false, reference = false; // given
  std::string ofDecoupled;                // the last option that belongs to --decoupled
};

/// Its place among the names; -1: it is none of them.
int indexOf(const char* name, std::initializer_list<const char*> names) {
  int index = 0;
  for (const char* known : names) {
    if (std::strcmp(name, known) == 0) return index;
    ++index;
  }
  return -1;
}

/// "down,enter,640x360,click", or keys: "f,3"
bool parseInputs(const std::string& list, std::vector<mini::Input>& inputs) {
  for (size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = list.find(',', begin);
    const std::string token = list.substr(begin, end == std::string::npos ? end : end - begin);
    mini::Input input;
    char rest = 0;
    const int named = indexOf(token.c_str(), {"up", "down", "enter", "click"});
    if (named >= 0)
      input.kind = std::array{mini::Input::up, mini::Input::down, mini::Input::enter,
                              mini::Input::click}[static_cast<size_t>(named)];
    else if (token.size() == 1)
      input.character = token[0];
    else if (std::sscanf(token.c_str(), "%fx%f%c", &input.x, &input.y, &rest) == 2 && std::isfinite(input.x) &&
             std::isfinite(input.y))
      input.kind = mini::Input::move;
    else
      return false;
    inputs.push_back(input);
  }
  return true;
}

/// Nothing but a number's digits.
bool parseNumber(const char* text, uint32_t& number) {
  const char* end = text + std::strlen(text);
  const auto [at, error] = std::from_chars(text, end, number);
  return at == end && error == std::errc();
}

/// False: wrong says what is.
bool parse(int argc, char** argv, Options& options, std::string& wrong) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--window") {
      options.window = true;
      continue;
    }
    if (name == "--watch") {
      options.watch = true;
      continue;
    }
    if (name == "--screen") {
      options.screen = true;
      continue;
    }
    if (name == "--stereo") {
      options.stereo = true;
      continue;
    }
    if (name == "--validate") {
      options.validate = true;
      continue;
    }
    if (name == "--decoupled" || name == "--path" || name == "--table") {
      options.decoupled.on = true;
      options.table = options.table || name == "--table";
      options.path = options.path || name != "--decoupled";
      continue;
    }
    wrong = name;
    if (i + 1 == argc) return false;
    wrong += std::string(" ") + argv[i + 1];
    const char* value = argv[++i];
    char rest = 0;
    int chosen = -1;
    if (indexOf(name.c_str(), {"--method", "--show", "--rate", "--freeze", "--reference", "--farther"}) >= 0)
      options.ofDecoupled = name;
    options.method = options.method || name == "--method";
    options.reference = options.reference || name == "--reference";
    if (name == "--out")
      options.out = value;
    else if (name == "--device")
      options.device = value;
    else if (name == "--data")
      options.data = value;
    else if (name == "--live")
      options.live = value;
    else if (name == "--script")
      options.script = value;
    else if (name == "--budget" && parseNumber(value, options.budget) && options.budget > 0)
      continue;
    else if (name == "--input" && parseInputs(value, options.inputs))
      continue;
    else if (name == "--score" && parseNumber(value, options.score) && options.score <= mini::kMaxScore)
      continue;
    else if (name == "--method" && (chosen = indexOf(value, {"standard", "exact", "reference", "conservative"})) >= 0 &&
             chosen != GPGP_SAMPLING_REFERENCE)
      options.decoupled.method = chosen;
    else if (name == "--show" && (chosen = indexOf(value, {"shaded", "overlay", "density"})) >= 0)
      options.decoupled.show = static_cast<mini::DecoupledOptions::Show>(chosen);
    else if (name == "--rate" && parseNumber(value, options.decoupled.rate) && options.decoupled.rate > 0)
      continue;
    else if (name == "--freeze" && parseNumber(value, options.decoupled.freezeAfter))
      continue;
    else if (name == "--reference" && parseNumber(value, options.decoupled.reference) &&
             options.decoupled.reference >= 2 && options.decoupled.reference <= 256 &&
             !(options.decoupled.reference & (options.decoupled.reference - 1)))
      continue;
    else if (name == "--farther" && std::sscanf(value, "%f%c", &options.decoupled.farther, &rest) == 1 &&
             options.decoupled.farther >= 0.1f && options.decoupled.farther <= 8)
      continue;
    else if (name == "--frames" && parseNumber(value, options.frames) && options.frames > 0)
      continue;
    else if (name == "--size" && std::sscanf(value, "%ux%u%c", &options.size.width, &options.size.height, &rest) == 2 &&
             options.size.width >= 64 && options.size.height >= 64 && options.size.width <= mini::kMaxExtent.width &&
             options.size.height <= mini::kMaxExtent.height)
      continue;
    else
      return false;
  }
  wrong.clear();
  if (!options.ofDecoupled.empty() && !options.decoupled.on) wrong = options.ofDecoupled + " without --decoupled";
  const bool overlay = options.decoupled.show == mini::DecoupledOptions::overlay;
  if (options.path && options.method) wrong = "--method beside --path or --table, which choose methods";
  if (options.path && overlay) wrong = "--show overlay beside --path or --table: shading would wait for the reference";
  if (options.watch && options.decoupled.on) wrong = "--watch beside --decoupled, which shows no city";
  if (!options.live.empty() && (options.watch || options.decoupled.on || options.screen || options.stereo))
    wrong = "--live beside --watch, --decoupled or --screen";
  if (options.budget && (options.decoupled.on || options.stereo || mini::LiveCga::takes(options.live)))
    wrong = "--budget beside --decoupled, --stereo or a .cga file";
  if (!options.script.empty() && (options.live.empty() || options.frames))
    wrong = "--script without --live, or --frames";
  bool showsOverlay = overlay || (options.window && !options.path);
  for (const mini::Input& input : options.inputs)
    if (input.kind == mini::Input::key && options.decoupled.on) {
      if (!std::strchr("fm123", input.character)) wrong = std::string("--input: there is no key ") + input.character;
      showsOverlay = showsOverlay || input.character == '2';
    }
  if (options.reference && !showsOverlay) wrong = "--reference without an overlay";
  if (options.screen && options.decoupled.on) wrong = "--screen beside --decoupled";
  if (options.frames == 1 && !options.inputs.empty()) wrong = "--input with --frames 1: it comes before the second";
  if (!options.screen && (options.score || options.stereo)) wrong = "--score or --stereo without --screen";
  for (const mini::Input& input : options.inputs)
    if (input.kind == mini::Input::key ? !options.decoupled.on || options.path : !options.screen)
      wrong = "--input: keys are for --decoupled without --path or --table, all else for --screen";
  return wrong.empty();
}

int run(const Options& options) {
  mini::DeviceOptions deviceOptions;
  deviceOptions.name = options.device;
  deviceOptions.validate = options.validate;
#ifdef GPGP_SDL2_WINDOW
  std::optional<gpgp::sdl2::Window> window; // made before the device, ended after it
  if (options.window) {
    window.emplace(gpgp::sdl2::WindowInfo{"gpgp mini engine", options.size.width, options.size.height});
    deviceOptions.instanceExtensions = window->instanceExtensions();
    deviceOptions.swapchain = true;
  }
#else
  if (options.window) throw std::runtime_error("built without SDL2; there is no window");
#endif
  if (!options.script.empty()) mini::readLiveScript(options.script); // wrong ones are said at once
  bool well = false;
  uint32_t messages = 0;
  {
    mini::Device device(deviceOptions);
    std::unique_ptr<mini::Target> target;
#ifdef GPGP_SDL2_WINDOW
    if (window) target = mini::makeWindow(device, *window, !options.out.empty());
#endif
    if (!target) target = std::make_unique<mini::Offscreen>(device, options.size);
    {
      mini::Engine engine(device, *target,
                          {options.data, options.watch, options.decoupled, options.screen, options.stereo,
                           options.score, options.inputs, options.live, options.budget});
      if (!options.script.empty()) engine.runScript(options.script);
      if (options.path)
        engine.comparePaths(options.frames ? options.frames : 40, options.table);
      else
        engine.run(options.frames ? options.frames : options.window && options.script.empty() ? 0 : 3);
      engine.printSummary();
      well = engine.allWell();
    }
    const std::string out = options.out.empty() && !options.window ? "pictures" : options.out;
    const auto* plain = options.screen ? "/screen.png" : options.decoupled.on ? "/shaded.png" : "/city.png";
    if (!out.empty()) {
      target->writePicture(out + plain);
      std::printf("picture     %s%s\n", out.c_str(), plain);
    }
    auto* offscreen = dynamic_cast<mini::Offscreen*>(target.get());
    if (offscreen && !options.decoupled.on && !options.screen) {
      offscreen->writeImage(1, out + "/side.png");
      std::printf("picture     %s/side.png: the model from the side\n", out.c_str());
    }
    messages = device.validationMessages();
  }
  if (options.validate) std::printf("validation  %u messages\n", messages);
  return well && messages == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) {
      std::fputs(kHelp, stdout);
      return EXIT_SUCCESS;
    }
  Options options;
  if (std::string wrong; !parse(argc, argv, options, wrong)) {
    std::fprintf(stderr, "%s\nmini_engine: wrong: %s\n", kHelp, wrong.c_str());
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mini_engine: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
