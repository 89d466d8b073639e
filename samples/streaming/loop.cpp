// Server and client in one process and in the scene's own time: frames arrive after exactly so many milliseconds,
// however long they took. So pictures, bit rates and missing pixels do not depend on the machine.
#include "assembly.h"
#include "figures.h"
#include "frame_source.h"
#include "options.h"

#include <deque>
#include <map>

using namespace streaming;

namespace {

struct Options {
  WorldOptions world;
  ShadingOptions shading;
  EncoderOptions coding;
  double rate = 30, display = 60, seconds = 2, latency = 100, begin = 0, fieldOfView = 60;
  uint32_t compare = 4, atlas = 2048;
  std::string size = "640x360";
};

int run(const Options& options) {
  const World world = options.world.load();
  Stage stage(options.world.device, options.world.validate);
  FrameSource source(stage, world, options.shading, options.coding);
  const Welcome welcome = source.welcome();
  StreamState state(welcome);
  DisplayRenderer renderer(stage, world, welcome, options.shading.width, options.shading.height,
                           options.shading.fieldOfView);
  struct Flying {
    double arrival;
    Bytes frame;
  };
  std::deque<Flying> flying;
  DisplayFigures figures;
  Table table;
  double worst = -1;
  Picture worstMarked;
  const double latency = options.latency * 1e-3;
  uint64_t serverFrames = 0, bytes = 0;
  const auto viewAt = [&](double time) { return walkAt(options.begin + time, world); };
  for (uint64_t n = 0;; ++n) {
    const double time = latency + static_cast<double>(n) / options.display; // the first frame is there
    if (time - latency >= options.seconds || interrupted) break;
    for (; static_cast<double>(serverFrames) / options.rate <= time; ++serverFrames) {
      PoseMessage pose;
      pose.number = static_cast<uint32_t>(serverFrames + 1);
      const double made = static_cast<double>(serverFrames) / options.rate;
      pose.seconds = options.begin + made;
      pose.view = viewAt(made);
      pose.earliest = static_cast<float>(latency);
      pose.latest = static_cast<float>(latency + 1 / options.rate);
      flying.push_back({made + latency, source.next(pose, 0)});
      bytes += flying.back().frame.size();
      table.add("visibility, ms", static_cast<double>(source.header().times.visibility));
      table.add("allocation, ms", static_cast<double>(source.header().times.allocation));
      table.add("shading, ms", static_cast<double>(source.header().times.shading));
      table.add("encoding, ms", static_cast<double>(source.header().times.encoding));
      table.add("visible triangles", source.header().visible);
      table.add("blocks", source.header().blocks);
      table.add("blocks smaller than asked for", source.header().lowered);
      table.add("tiles shaded", source.header().tiles);
      table.add("kilobytes", static_cast<double>(flying.back().frame.size()) * 1e-3);
    }
    bool changed = false;
    for (; !flying.empty() && flying.front().arrival <= time + 1e-9; flying.pop_front()) {
      const auto frame = parseFrame(flying.front().frame, welcome.triangleCount);
      if (!frame || !state.apply(*frame)) throw std::runtime_error("a frame was refused");
      changed = true;
    }
    if (changed) renderer.upload(state);
    const bool compares = options.compare && n % options.compare == 0;
    const uint32_t flags = compares ? uint32_t{DisplayRenderer::compare} : 0;
    figures.add(renderer.render(viewAt(time), options.begin + time, flags));
    if (compares) figures.add(compare(renderer.picture(), renderer.local()));
    if (options.world.out.empty() || figures.lastFallback() <= worst) continue;
    worst = figures.lastFallback();
    writePicture(options.world.out + "/worst.png", renderer.picture());
    renderer.render(viewAt(time), options.begin + time, DisplayRenderer::mark | DisplayRenderer::compare);
    writePicture(options.world.out + "/worst_marked.png", renderer.picture());
    writePicture(options.world.out + "/worst_local.png", renderer.local());
  }
  const double megabits = static_cast<double>(bytes) * 8e-6 * options.rate / static_cast<double>(serverFrames);
  table.print("server");
  figures.print();
  std::printf("%.2f Mbit/s at %g Hz; %u triangles in the scene\n", megabits, options.rate, world.model.triangleCount);
  if (!options.world.out.empty()) {
    const Atlas& atlas = source.renderer().atlas();
    writePicture(options.world.out + "/atlas.png", {atlas.width, atlas.height, atlas.texels});
  }
  if (!options.world.json.empty())
    writeJson(options.world.json,
              {{"server", table.json()}, {"shown", figures.json()}, {"megabitsPerSecond", megabits}});
  stage.checkMessages();
  return figures.allShaded() ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The streaming sample without network, in the scene's own time. docs/guide/streaming.md",
               "streaming_loop");
  options.world.addTo(app);
  addShadingOptions(app, options.shading, options.coding, options.atlas);
  app.add_option("--rate", options.rate, "server frames per second")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  app.add_option("--display", options.display, "displays per second")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "of the walk")->check(CLI::Range(0.01, 1e4))->capture_default_str();
  app.add_option("--begin", options.begin, "where in the walk, seconds")->capture_default_str();
  app.add_option("--latency", options.latency, "ms from a pose to the first display of its frame")
      ->check(CLI::Range(0.0, 2000.0))
      ->capture_default_str();
  app.add_option("--compare", options.compare, "render every N-th display locally, too, and compare; 0: none")
      ->capture_default_str();
  app.add_option("--size", options.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  app.add_option("--fov", options.fieldOfView, "vertical field of view, degrees")
      ->check(CLI::Range(20.0, 100.0))
      ->capture_default_str();
  return mainOf(app, argc, argv, [&] {
    parseSize(options.size, options.shading.width, options.shading.height);
    options.shading.fieldOfView = radiansOf(options.fieldOfView);
    setAtlas(options.shading, options.atlas);
    options.coding.rate = options.rate;
    endOnSignals();
    return run(options);
  });
}
