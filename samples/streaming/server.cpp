// The server of figure 3.2: receives poses, shades what may be seen, sends the atlas. One client; ends when it leaves.
#include "assembly.h"
#include "frame_source.h"
#include "options.h"
#include "quality.h"
#include "statistics.h"
#include "transport.h"

#include <chrono>
#include <future>

using namespace streaming;

namespace {

using Clock = std::chrono::steady_clock;
double secondsNow() {
  static const Clock::time_point kBegin = Clock::now();
  return std::chrono::duration<double>(Clock::now() - kBegin).count();
}

struct Options {
  WorldOptions world;
  ShadingOptions shading;
  EncoderOptions coding;
  std::string address = "127.0.0.1";
  uint16_t port = 4242;
  double rate = 30, wait = 600;
};

class Server {
public:
  explicit Server(const Options& options)
      : options_(options), world_(options.world.load()), hash_(world_.hash()),
        stage_(options.world.device, options.world.validate),
        endpoint_(Endpoint::listenAt(options.address, options.port)) {}

  int run() {
    std::printf("%s: %u triangles, %zu draws, on %s\n", world_.model.name.c_str(), world_.model.triangleCount,
                world_.model.draws.size(), stage_.device.properties.deviceName);
    std::printf("listening on port %u\n", endpoint_.port());
    std::fflush(stdout);
    const double begin = secondsNow();
    double next = 0;
    bool was = false;
    while (!interrupted) {
      const double now = secondsNow();
      poll(source_ && !frame_.valid() && now < next ? std::min(static_cast<uint32_t>((next - now) * 1000), 2u) : 2);
      was = was || endpoint_.isConnected();
      if (was && !endpoint_.isConnected()) break; // the client has left
      if (!was && now - begin > options_.wait) throw std::runtime_error("no client came");
      if (preparing_.valid() && preparing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        source_ = preparing_.get();
        endpoint_.send(write(source_->welcome()), true);
      }
      if (frame_.valid()) {
        if (frame_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) sendFrame();
        continue;
      }
      if (!source_ || !fresh_ || secondsNow() < next) continue;
      next = std::max(next + 1 / options_.rate, secondsNow());
      beginFrame();
    }
    if (preparing_.valid()) preparing_.wait();
    if (frame_.valid()) frame_.wait();
    endpoint_.disconnect();
    report();
    stage_.checkMessages();
    return 0;
  }

private:
  void poll(uint32_t milliseconds) {
    endpoint_.poll(milliseconds, [this](ByteSpan message) { take(message); });
  }

  void take(ByteSpan message) {
    bool well = false;
    const auto type = typeOf(message);
    if (type == MessageType::hello) {
      if (const auto hello = parseHello(message)) {
        well = true;
        greet(*hello);
      }
    } else if (type == MessageType::pose) {
      if (const auto pose = parsePose(message)) {
        well = true;
        if (!hasPose_ || pose->number > pose_.number) {
          pose_ = *pose;
          poseTime_ = secondsNow();
          hasPose_ = fresh_ = true;
        }
      }
    } else if (type == MessageType::missing) {
      if (const auto missing = parseMissing(message)) {
        well = true;
        const std::vector<Bytes> parts = store_.answer(*missing);
        for (const Bytes& part : parts) endpoint_.send(part, false);
        resent_ += parts.size();
      }
    } else if (type == MessageType::refresh) {
      well = true;
      restarts_ = true;
      ++refreshes_;
    }
    if (!well) ++refused_;
  }

  void greet(const Hello& hello) {
    if (preparing_.valid() || source_) return;
    if (hello.world != hash_) {
      endpoint_.send(writeRefusal("the server has another scene: give both the same --village or --model"), true);
      return;
    }
    ShadingOptions shading = options_.shading;
    shading.width = hello.width;
    shading.height = hello.height;
    shading.fieldOfView = hello.fieldOfView;
    // Pipelines take a while; the connection is kept alive meanwhile.
    preparing_ = std::async(std::launch::async, [this, shading] {
      auto source = std::make_unique<FrameSource>(stage_, world_, shading, options_.coding);
      source->warmUp();
      return source;
    });
  }

  /// In a thread of its own, so that the network is served meanwhile.
  void beginFrame() {
    const auto waited = static_cast<float>((secondsNow() - poseTime_) * 1000);
    fresh_ = false;
    if (restarts_) source_->restart();
    restarts_ = false;
    frame_ = std::async(std::launch::async, [this, pose = pose_, waited] { return source_->next(pose, waited); });
  }

  void sendFrame() {
    const Bytes frame = frame_.get();
    const double now = secondsNow();
    const FrameHeader& header = source_->header();
    if (frame.size() > kMaxFrameBytes)
      throw std::runtime_error("a frame of " + std::to_string(frame.size()) + " bytes");
    const uint32_t parts = partCount(frame.size());
    for (uint32_t i = 0; i < parts; ++i) {
      endpoint_.send(write(partOf(frame, header.number, i)), false);
      if (i % 64 == 63) poll(0); // a burst that is larger than the socket's buffers would be lost
    }
    poll(0);
    store_.add(header.number, frame);
    const Shaded& shaded = source_->shaded();
    table_.add("waiting for a frame, ms", static_cast<double>(header.times.waiting));
    table_.add("visibility, ms", static_cast<double>(header.times.visibility));
    table_.add("allocation, ms", static_cast<double>(header.times.allocation));
    table_.add("shading, ms", static_cast<double>(header.times.shading));
    table_.add("reading back, ms", static_cast<double>(header.times.reading));
    table_.add("encoding, ms", static_cast<double>(header.times.encoding));
    table_.add("frame, kilobytes", static_cast<double>(frame.size()) * 1e-3);
    table_.add("visible triangles", header.visible);
    table_.add("blocks", header.blocks);
    table_.add("blocks smaller than asked for", header.lowered);
    table_.add("blocks dropped", header.dropped);
    table_.add("blocks new, changed or gone",
               shaded.atlas.newBlocks + shaded.atlas.changedBlocks + shaded.atlas.goneBlocks);
    table_.add("tiles shaded", shaded.tiles);
    table_.add("tiles changed", static_cast<double>(shaded.changedTiles.size()));
    table_.add("triangles undecided", shaded.visibility.unresolved);
    keys_ += header.key;
    if (frames_++ == 0) first_ = now;
    last_ = now;
  }

  void report() {
    const double seconds = std::max(last_ - first_, 1e-9);
    const double rate = frames_ > 1 ? static_cast<double>(frames_ - 1) / seconds : 0;
    const double megabits = static_cast<double>(endpoint_.sentBytes()) * 8e-6 / seconds;
    if (frames_) table_.print("server");
    std::printf(
        "%llu frames (%llu key frames) at %.1f Hz, %.2f Mbit/s sent; %llu parts sent again, %llu messages refused\n",
        static_cast<unsigned long long>(frames_), static_cast<unsigned long long>(keys_), rate, megabits,
        static_cast<unsigned long long>(resent_), static_cast<unsigned long long>(refused_));
    if (!options_.world.json.empty())
      writeJson(options_.world.json, {{"frames", frames_},
                                      {"keyFrames", keys_},
                                      {"hertz", rate},
                                      {"megabitsPerSecond", megabits},
                                      {"partsSentAgain", resent_},
                                      {"refreshes", refreshes_},
                                      {"messagesRefused", refused_},
                                      {"figures", table_.json()}});
    if (!options_.world.out.empty() && source_) {
      const Atlas& atlas = source_->renderer().atlas();
      writePicture(options_.world.out + "/atlas.png", {atlas.width, atlas.height, atlas.texels});
    }
  }

  const Options& options_;
  World world_;
  uint64_t hash_;
  Stage stage_;
  Endpoint endpoint_;
  std::future<std::unique_ptr<FrameSource>> preparing_;
  std::unique_ptr<FrameSource> source_;
  std::future<Bytes> frame_; ///< being made
  FrameStore store_;
  PoseMessage pose_;
  double poseTime_ = 0, first_ = 0, last_ = 0;
  bool hasPose_ = false, fresh_ = false, restarts_ = false;
  uint64_t frames_ = 0, keys_ = 0, resent_ = 0, refused_ = 0, refreshes_ = 0;
  Table table_;
};

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Shades what a client may see into gpgp's atlas and streams it. docs/guide/streaming.md",
               "streaming_server");
  options.world.addTo(app);
  app.add_option("--listen", options.address, "address to listen on")->capture_default_str();
  app.add_option("--port", options.port, "UDP port; 0: any free one, which is printed")->capture_default_str();
  app.add_option("--wait", options.wait, "seconds to wait for a client")->capture_default_str();
  app.add_option("--rate", options.rate, "frames per second at most")
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str();
  uint32_t side = 2048;
  addShadingOptions(app, options.shading, options.coding, side);
  return mainOf(app, argc, argv, [&] {
    setAtlas(options.shading, side);
    options.coding.rate = options.rate;
    endOnSignals();
    return Server(options).run();
  });
}
