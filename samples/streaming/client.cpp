// The client of figure 3.2: sends its poses, and displays at its own rate what it has of the atlas.
#include "assembly.h"
#include "figures.h"
#include "options.h"
#include "transport.h"
#include "window.h"

#include <chrono>
#include <deque>
#include <future>
#include <optional>

using namespace streaming;

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  WorldOptions world;
  RelayOptions network;
  std::string address = "127.0.0.1";
  uint16_t port = 4242;
  double display = 60, seconds = 10, wait = 120, fieldOfView = 60;
  std::string size = "640x360";
  uint32_t width = 0, height = 0, compare = 8, frames = 0;
  bool mark = false, window = false;
};

class Client {
public:
  explicit Client(const Options& options)
      : options_(options), world_(options.world.load()), stage_(options.world.device, options.world.validate) {
    std::string address = options.address;
    uint16_t port = options.port;
    if (options.network.isNeeded()) {
      relay_ = std::make_unique<Relay>(address, port, options.network);
      address = "127.0.0.1";
      port = relay_->port();
    }
    endpoint_.emplace(Endpoint::connectTo(address, port, 20));
  }

  int run() {
    greet();
    if (options_.window) window_.emplace("gpgp streaming client", options_.width, options_.height);
    begin_ = Clock::now();
    double next = 0;
    bool goesOn = true;
    while (goesOn && !interrupted && now() < options_.seconds &&
           (!options_.frames || latency_["decoding"].count() < options_.frames)) {
      do {
        const double left = std::max(next - now(), 0.0);
        poll(static_cast<uint32_t>(std::min(left * 1000, 4.0)));
        takeFrames();
        askAgain();
      } while (now() < next);
      if (!endpoint_->isConnected()) break;
      next = std::max(next + 1 / options_.display, now());
      displayOnce();
      if (window_) goesOn = window_->show(renderer_->picture());
    }
    const double seconds = now();
    const bool left = !endpoint_->isConnected();
    endpoint_->disconnect();
    relay_.reset();
    const bool well = report(seconds);
    if (left) throw std::runtime_error("the server has left");
    stage_.checkMessages();
    return well ? 0 : 1;
  }

private:
  double now() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  void poll(uint32_t milliseconds) {
    endpoint_->poll(milliseconds, [this](ByteSpan message) { take(message); });
  }

  void greet() {
    const float fieldOfView = radiansOf(options_.fieldOfView);
    endpoint_->send(write(Hello{world_.hash(), options_.width, options_.height, fieldOfView}), true);
    while (!welcome_ && refusal_.empty() && endpoint_->isConnected() && !interrupted && now() < options_.wait) poll(10);
    if (!refusal_.empty()) throw std::runtime_error("refused: " + refusal_);
    if (!welcome_) throw std::runtime_error("no welcome from the server");
    if (welcome_->triangleCount != world_.model.triangleCount ||
        welcome_->drawColours.size() != world_.model.draws.size())
      throw std::runtime_error("the server has another scene");
    state_.emplace(*welcome_);
    auto made = std::async(std::launch::async, [&] { // the connection is kept alive meanwhile
      auto renderer =
          std::make_unique<DisplayRenderer>(stage_, world_, *welcome_, options_.width, options_.height, fieldOfView);
      renderer->upload(*state_);
      renderer->render(walkAt(0, world_), 0, DisplayRenderer::compare); // software devices compile pipelines now
      return renderer;
    });
    while (made.wait_for(std::chrono::seconds(0)) != std::future_status::ready) poll(5);
    renderer_ = made.get();
  }

  void take(ByteSpan message) {
    const auto type = typeOf(message);
    bool well = false;
    if (type == MessageType::part) {
      const auto part = parsePart(message);
      well = part && assembly_.add(*part, now());
    } else if (type == MessageType::welcome) {
      const auto welcome = parseWelcome(message);
      well = welcome.has_value();
      if (well && !welcome_) welcome_ = welcome;
    } else if (type == MessageType::refusal) {
      const auto refusal = parseRefusal(message);
      well = refusal.has_value();
      if (well) refusal_ = *refusal;
    }
    if (!well) ++refused_;
  }

  void takeFrames() {
    while (const auto bytes = assembly_.take()) {
      const double begin = now();
      const auto frame = parseFrame(*bytes, world_.model.triangleCount);
      if (!frame || !state_->apply(*frame)) {
        ++refused_;
        assembly_.waitForKey();
        refresh();
        continue;
      }
      frame_ = frame->header;
      changed_ = true;
      arrived_ = begin;
      const double decoding = (now() - begin) * 1000, server = static_cast<double>(frame_->times.sum());
      latency_.add("waiting for a server frame", static_cast<double>(frame_->times.waiting));
      latency_.add("visibility", static_cast<double>(frame_->times.visibility));
      latency_.add("allocation", static_cast<double>(frame_->times.allocation));
      latency_.add("shading", static_cast<double>(frame_->times.shading));
      latency_.add("reading back", static_cast<double>(frame_->times.reading));
      latency_.add("encoding", static_cast<double>(frame_->times.encoding));
      const double network = std::max(0.0, begin - frame_->seconds - server * 1e-3);
      roundTrip_ = std::min(roundTrip_ * 1.05, network); // the best of late: the others waited for what was lost
      latency_.add("network, both ways", network * 1000);
      latency_.add("decoding", decoding);
    }
  }

  void refresh() {
    endpoint_->send(writeRefresh(), true);
    ++refreshes_;
  }

  void askAgain() {
    const double roundTrip = std::clamp(roundTrip_ * 1.2, 0.02, 1.0);
    for (const Missing& missing : assembly_.missing(now(), roundTrip)) endpoint_->send(write(missing), false);
    if (assembly_.isStuck(now(), std::max(0.5, 5 * roundTrip))) refresh();
  }

  void displayOnce() {
    const double time = now();
    PoseMessage pose;
    pose.number = ++poses_;
    pose.seconds = time;
    pose.view = walkAt(time, world_);
    ageBounds(pose);
    endpoint_->send(write(pose), false);
    poll(0);
    const bool isNew = changed_;
    double begin = now();
    if (changed_) {
      renderer_->upload(*state_);
      changed_ = false;
      upload_.add((now() - begin) * 1000);
    }
    if (isNew) latency_.add("waiting for a display frame", (begin - arrived_) * 1000);
    begin = now();
    const bool compares = frame_ && options_.compare && figures_.displays() % options_.compare == 0;
    const uint32_t flags = (options_.mark ? DisplayRenderer::mark : 0u) | (compares ? DisplayRenderer::compare : 0u);
    const PixelCounts counts = renderer_->render(pose.view, time, flags);
    const double end = now();
    if (compares) figures_.add(streaming::compare(renderer_->picture(), renderer_->local()));
    if (isNew) latency_.add("display", (end - begin) * 1000);
    if (!frame_) {
      before_.add(counts);
      return;
    }
    if (figures_.displays() == 0) firstFrame_ = time;
    figures_.add(counts);
    displayed_.add((end - begin) * 1000);
    const double age = end - frame_->seconds;
    ages_.add(age * 1000);
    if (isNew) {
      latency_.add("pose to first display", age * 1000);
    }
    recentAges_.emplace_back(time, age);
    keepWorst(pose.view, time);
  }

  /// How old displayed frames were in the last second and a half.
  void ageBounds(PoseMessage& pose) {
    while (!recentAges_.empty() && recentAges_.front().first < pose.seconds - 1.5) recentAges_.pop_front();
    double least = 0.05, most = 0.3;
    if (!recentAges_.empty()) {
      const auto byAge = [](const auto& a, const auto& b) { return a.second < b.second; };
      least = std::min_element(recentAges_.begin(), recentAges_.end(), byAge)->second;
      most = std::max_element(recentAges_.begin(), recentAges_.end(), byAge)->second;
    }
    pose.earliest = static_cast<float>(std::clamp(least * 0.9, 0.0, 1.0));
    pose.latest = static_cast<float>(std::clamp(most * 1.1, 0.02, 1.5));
  }

  /// The picture with the largest share of fallback shades.
  void keepWorst(const View& view, double time) {
    const double share = figures_.lastFallback();
    if (options_.world.out.empty() || share <= worstShare_) return;
    worstShare_ = share;
    worst_ = renderer_->picture();
    renderer_->render(view, time, DisplayRenderer::mark);
    worstMarked_ = renderer_->picture();
  }

  bool report(double seconds) {
    const double streamed = std::max(seconds - firstFrame_, 1e-9);
    const double megabits = static_cast<double>(endpoint_->receivedBytes()) * 8e-6 / seconds;
    const double frames = static_cast<double>(latency_["decoding"].count());
    const uint64_t displays = figures_.displays();
    latency_.print("latency of a server frame, ms");
    std::printf("%llu displays at %.1f Hz, %.1f ms each (worst %.1f); age of what is shown %.1f ms (worst %.1f)\n",
                static_cast<unsigned long long>(displays), static_cast<double>(displays) / streamed, displayed_.mean(),
                displayed_.worst(), ages_.mean(), ages_.worst());
    std::printf("%.0f server frames at %.1f Hz, %.2f Mbit/s; first one after %.1f s\n", frames, frames / streamed,
                megabits, firstFrame_);
    figures_.print();
    std::printf("%llu parts asked for again, %llu came twice, %llu key frames asked for, %llu messages refused\n",
                static_cast<unsigned long long>(assembly_.requestedParts()),
                static_cast<unsigned long long>(assembly_.duplicates()), static_cast<unsigned long long>(refreshes_),
                static_cast<unsigned long long>(refused_));
    if (!options_.world.json.empty())
      writeJson(options_.world.json, {{"latencyMilliseconds", latency_.json()},
                                      {"shown", figures_.json()},
                                      {"displaysBeforeFirstFrame", before_.displays()},
                                      {"displayHertz", static_cast<double>(displays) / streamed},
                                      {"displayMilliseconds", displayed_.json()},
                                      {"uploadMilliseconds", upload_.json()},
                                      {"ageMilliseconds", ages_.json()},
                                      {"serverFrames", frames},
                                      {"serverHertz", frames / streamed},
                                      {"megabitsPerSecond", megabits},
                                      {"partsAskedForAgain", assembly_.requestedParts()},
                                      {"keyFramesAskedFor", refreshes_},
                                      {"messagesRefused", refused_},
                                      {"heldBytes", assembly_.heldBytes()}});
    if (!options_.world.out.empty() && displays) {
      const View view = walkAt(seconds, world_);
      renderer_->render(view, seconds, DisplayRenderer::compare);
      const std::string folder = options_.world.out;
      writePicture(folder + "/display.png", renderer_->picture());
      writePicture(folder + "/local.png", renderer_->local());
      writePicture(folder + "/worst.png", worst_.width ? worst_ : renderer_->picture());
      writePicture(folder + "/worst_marked.png", worst_.width ? worstMarked_ : renderer_->picture());
    }
    if (frames == 0) std::fprintf(stderr, "streaming_client: no frame came\n");
    const bool shaded = figures_.allShaded() && before_.allShaded();
    if (!shaded) std::fprintf(stderr, "streaming_client: pixels of geometry were left without a shade\n");
    return frames > 0 && shaded;
  }

  const Options& options_;
  World world_;
  Stage stage_;
  std::unique_ptr<Relay> relay_;
  std::optional<Endpoint> endpoint_;
  std::optional<Window> window_;
  std::optional<Welcome> welcome_;
  std::string refusal_;
  std::optional<StreamState> state_;
  std::unique_ptr<DisplayRenderer> renderer_;
  FrameAssembly assembly_;
  std::optional<FrameHeader> frame_; ///< what is displayed
  Clock::time_point begin_ = Clock::now();
  bool changed_ = false;
  uint32_t poses_ = 0;
  uint64_t refused_ = 0, refreshes_ = 0;
  double arrived_ = 0, firstFrame_ = 0, worstShare_ = 0, roundTrip_ = 0.3;
  std::deque<std::pair<double, double>> recentAges_;
  Table latency_;
  Series displayed_, upload_, ages_;
  DisplayFigures before_, figures_; ///< before the first frame, and since
  Picture worst_, worstMarked_;
};

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Displays what a streaming_server shades. docs/guide/streaming.md", "streaming_client");
  options.world.addTo(app);
  app.add_option("--server", options.address, "the server's address")->capture_default_str();
  app.add_option("--port", options.port, "its UDP port")->capture_default_str();
  app.add_option("--size", options.size, "picture, WIDTHxHEIGHT")->capture_default_str();
  app.add_option("--fov", options.fieldOfView, "vertical field of view, degrees")
      ->check(CLI::Range(20.0, 100.0))
      ->capture_default_str();
  app.add_option("--display", options.display, "displays per second")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "how long the walk lasts")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  app.add_option("--frames", options.frames, "end after so many server frames, if that is sooner; 0: any number");
  app.add_option("--wait", options.wait, "seconds to wait until the server is ready")->capture_default_str();
  app.add_option("--compare", options.compare, "render every N-th display locally, too, and compare; 0: none")
      ->capture_default_str();
  app.add_option("--latency", options.network.latency, "emulated: ms that a round trip takes longer")
      ->check(CLI::Range(0.0, 2000.0));
  app.add_option("--jitter", options.network.jitter, "emulated: ms at most that a datagram takes longer still")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--loss", options.network.loss, "emulated: per cent of datagrams lost each way")
      ->check(CLI::Range(0.0, 90.0));
  app.add_option("--seed", options.network.seed, "which datagrams are lost and late")->capture_default_str();
  app.add_flag("--mark", options.mark, "fallback shades in magenta");
  app.add_flag("--window", options.window, "show the pictures in a window; Escape ends");
  return mainOf(app, argc, argv, [&] {
    parseSize(options.size, options.width, options.height);
    endOnSignals();
    return Client(options).run();
  });
}
