// One frame: advance, upload, prepare three services, draw everything in one pass.
#include "engine.h"

#include "level.h"
#include "live_script.h"

#include <chrono>
#include <cmath>
#include <cstdio>

namespace mini {
Engine::Engine(Device& device, Target& target, const EngineOptions& options)
    : device_(device), target_(target), forward_(device, target.format(), target.finalLayout()),
      gpgp_(device, kFramesInFlight), sight_(device, gpgp_, forward_, levelModel(options.dataFolder)),
      farther_(options.decoupled.farther), eyes_(options.stereo ? 2 : 1), script_(options.inputs),
      frames_(device, kFramesInFlight) {
  if (options.decoupled.on)
    decoupled_ =
        std::make_unique<Decoupled>(device, gpgp_, forward_, levelModel(options.dataFolder), options.decoupled);
  else if (options.screen)
    screen_ = std::make_unique<Screen>(device, gpgp_, forward_, options.dataFolder, options.score, eyes_);
  else
    hud_ = std::make_unique<Hud>(device, gpgp_, forward_, options.dataFolder + "/svg/hud.svg",
                                 options.dataFolder + "/fetched/svg/tiger.svgz");
  if (LiveCga::takes(options.live))
    town_ = std::make_unique<Town>(device, forward_);
  else
    city_ = std::make_unique<City>(
        device, gpgp_, forward_,
        CityOptions{options.live.empty() ? options.dataFolder + "/grammars/building.pga" : options.live, options.watch,
                    options.budget});
  if (!options.live.empty()) {
    if (town_)
      live_ = (cga_ = std::make_unique<LiveCga>(options.live, townLots())).get();
    else
      live_ = (grammar_ = std::make_unique<LiveGrammar>(gpgp_.context, options.live)).get();
    moves_ = options.budget != 0; // which is of what the camera sees
    panel_ = std::make_unique<LivePanel>(device, gpgp_, forward_, target.format(), options.dataFolder);
  }
  resize();
}

void Engine::resize() {
  check(vkDeviceWaitIdle(device_.device), "vkDeviceWaitIdle");
  target_.attach(forward_);
  if (hud_) hud_->resize(target_.extent());
  if (screen_) screen_->resize(target_.extent());
}

/// Around the square: angle in radians, distance and height of the eye in metres, and how far it is to the right.
Camera Engine::orbit(float angle, float distance, float height, float fieldOfView, float aside) const {
  const VkExtent2D size = target_.extent();
  const float aspect = static_cast<float>(size.width / eyes_) / static_cast<float>(size.height);
  angle += 0.24f + 0.01f * static_cast<float>(step_);
  const glm::vec3 right = aside * glm::vec3(std::cos(angle), 0, -std::sin(angle));
  Camera camera = lookAt(glm::vec3(std::sin(angle) * distance, height, std::cos(angle) * distance) + right,
                         glm::vec3(0, 12, 0) + right, fieldOfView, aspect, 1.0f, 900.0f);
  if (screen_ && screen_->game().night) camera.daylight = 0;
  return camera;
}

void Engine::take(const std::vector<Input>& inputs) {
  for (const Input& input : inputs) {
    if (decoupled_ && input.kind == Input::key) decoupled_->key(input.character);
    if (panel_) panel_->input(input);
    if (!screen_) continue;
    const std::string happened = screen_->input(input);
    if (!script_.empty()) std::printf("input       %s\n", happened.c_str());
  }
}

void Engine::run(uint32_t frames) {
  for (uint32_t i = 0; frames == 0 || i < frames; ++i) {
    if (i == 1) target_.play(script_);
    if (!target_.pollEvents()) break;
    take(target_.takeInputs());
    if (screen_ && screen_->game().quit) break;
    frame();
    if (i % 30 == 29 && decoupled_) {
      target_.setTitle("gpgp mini engine: " + std::to_string(decoupled_->shadingReport().visible) +
                       " triangles shaded (F freezes, M method, 1 shaded, 2 overlay, 3 density)");
    } else if (i % 30 == 29) {
      target_.setTitle("gpgp mini engine: " +
                       (town_ ? std::to_string(town_->triangles()) + " triangles, "
                              : std::to_string(city_->report().terminals) + " spawned, ") +
                       std::to_string((screen_ ? screen_->report() : hud_->report()).paths) + " paths, " +
                       std::to_string(sight_.report().visible) + " triangles visible");
    }
  }
  frames_.finish(); // one more advance makes the last reports ready
  gpgp_.check(gpgp_.context.advance(frames_.number()), "gpgpAdvance");
  collect();
}

void Engine::frame() {
  VkCommandBuffer commands = frames_.begin();
  if (moves_ && (!screen_ || !screen_->game().paused)) ++step_;
  std::optional<Acquired> acquired = target_.acquire(frames_.slot());
  while (!acquired) {
    resize();
    acquired = target_.acquire(frames_.slot());
  }
  gpgp_.check(gpgp_.context.advance(frames_.number()), "gpgpAdvance");
  collect();
  record(commands, *acquired);
  target_.keep(commands, *acquired);
  frames_.submit(acquired->available, acquired->rendered);
  target_.present(*acquired);
}

void Engine::runScript(const std::string& file) {
  using Clock = std::chrono::steady_clock;
  for (const LiveCommand& command : readLiveScript(file)) {
    const uint64_t version = live_->version();
    const Clock::time_point start = Clock::now();
    switch (command.kind) {
    case LiveCommand::frames:
      for (uint32_t i = 0; i < command.count; ++i) frame();
      continue;
    case LiveCommand::set:
      if (!live_->set(command.name, command.value))
        throw std::runtime_error(live_->file() + " has no attribute " + command.name + " that can be " + command.value);
      break;
    case LiveCommand::write: saveAs(command.name, live_->file()); break;
    case LiveCommand::picture:
      for (uint32_t i = 0; i <= kFramesInFlight; ++i) frame(); // reports are of this state
      check(vkDeviceWaitIdle(device_.device), "vkDeviceWaitIdle");
      target_.writePicture(command.name);
      if (town_)
        std::printf("live        %s: %u triangles, mesh hash %016llx", command.name.c_str(), town_->triangles(),
                    static_cast<unsigned long long>(town_->hash()));
      else
        std::printf("live        %s: %u instances, key hash %08x%08x", command.name.c_str(),
                    city_->report().instancesWritten, city_->report().keyHash[1], city_->report().keyHash[0]);
      std::printf(", errors at %.0f,%.0f to %.0f,%.0f\n", static_cast<double>(panel_->errorBox()[0]),
                  static_cast<double>(panel_->errorBox()[1]), static_cast<double>(panel_->errorBox()[2]),
                  static_cast<double>(panel_->errorBox()[3]));
      for (const LiveError& error : live_->errors())
        std::printf("error       %s: %s\n", error.place().c_str(), error.text.c_str());
      continue;
    }
    uint32_t frames = 0;
    while (live_->version() == version && ++frames <= 100) frame();
    check(vkDeviceWaitIdle(device_.device), "vkDeviceWaitIdle");
    std::printf("change      %s: in the picture after %u frames, %.1f ms; %.1f ms of them to compile%s\n",
                command.name.c_str(), frames, std::chrono::duration<double, std::milli>(Clock::now() - start).count(),
                live_->compileMilliseconds(), town_ ? " and derive" : "");
  }
}

void Engine::comparePaths(uint32_t frames, bool table) {
  struct {
    const char* name;
    GpgpSamplingMethod method;
    float resolution;
    bool always;
  } const configurations[] = {{"standard", GPGP_SAMPLING_STANDARD, 1, true},
                              {"conservative 0.25", GPGP_SAMPLING_CONSERVATIVE, 0.25f, false},
                              {"conservative 0.5", GPGP_SAMPLING_CONSERVATIVE, 0.5f, false},
                              {"conservative 0.75", GPGP_SAMPLING_CONSERVATIVE, 0.75f, false},
                              {"conservative 1", GPGP_SAMPLING_CONSERVATIVE, 1, false},
                              {"exact", GPGP_SAMPLING_EXACT, 1, true}};
  double standard = 0; // milliseconds
  const auto follow = [&](GpgpSamplingMethod method, float resolution) {
    decoupled_->restart(method, resolution, 2.0f); // the table's epsilons
    step_ = 0;
    run(frames);
  };
  follow(GPGP_SAMPLING_STANDARD, 1); // not counted: a device's clock rises with its work
  for (const auto& c : configurations) {
    if (!table && !c.always) continue;
    follow(c.method, c.resolution);
    const Decoupled::Misses& misses = decoupled_->misses();
    const double displays = std::max(misses.displays, 1u);
    std::printf(
        "path        %-17s %u displays, %u triangles shaded last: without shading %.3f %% of the model's pixels "
        "(at most %.3f %%), %.0f triangles a display\n",
        c.name, misses.displays, decoupled_->shadingReport().visible, 100 * misses.pixels / displays,
        100 * misses.worst, misses.triangles / displays);
    const Decoupled::Times& times = decoupled_->times();
    const double visibility = times.visibility / std::max(times.shadings, 1u),
                 shading = times.shading / std::max(times.shadings, 1u),
                 display = times.display / std::max(times.displays, 1u), frame = visibility + shading + display;
    if (standard == 0) standard = frame;
    std::printf("GPU times   visibility %.3f ms, shading %.3f ms, display %.3f ms: %.3f ms, %.2f times as long as with "
                "standard sampling\n",
                visibility, shading, display, frame, standard > 0 ? frame / standard : 0.0);
  }
}

/// Shading from one pose, display from another.
void Engine::recordDecoupled(VkCommandBuffer commands, const Acquired& acquired) {
  const Camera display = orbit(0.0f, 84.0f, 36.0f, 0.80f);
  const Camera shading = orbit(0.0f, 84.0f * farther_, 36.0f * farther_, 0.80f);
  gpgp_.check(gpgp_.context.recordUpload(commands, frames_.number()).code(), "gpgpRecordUpload");
  decoupled_->prepare(commands, frames_.number(), shading, display, target_.extent());
  forward_.begin(commands, acquired.framebuffer);
  forward_.drawBackdrop(commands, display);
  decoupled_->draw(commands, display);
  vkCmdEndRenderPass(commands);
}

/// What this frame shows.
void Engine::updateLive() {
  if (grammar_)
    if (auto next = grammar_->update()) city_->use(std::move(*next));
  if (cga_)
    if (auto next = cga_->update()) town_->use(*std::move(next), frames_.number());
  panel_->update(*live_,
                 town_ ? std::to_string(town_->triangles()) + " triangles"
                       : std::to_string(city_->report().instancesWritten) + " instances",
                 target_.extent());
}

void Engine::record(VkCommandBuffer commands, const Acquired& acquired) {
  if (decoupled_) {
    recordDecoupled(commands, acquired);
    return;
  }
  const Camera camera = orbit(0.0f, 84.0f, 36.0f, 0.80f);
  const Camera side = orbit(2.5f, 74.0f, 26.0f, 0.56f); // what the camera cannot see lies here
  constexpr float kEyes = 1.6f;                         // metres between them, as a giant's
  Camera eyes[2];
  for (uint32_t eye = 0; eye < eyes_; ++eye)
    eyes[eye] = orbit(0.0f, 84.0f, 36.0f, 0.80f, eyes_ == 1 ? 0.0f : (static_cast<float>(eye) - 0.5f) * kEyes);
  if (screen_) screen_->update(eyes);
  if (live_) updateLive();
  gpgp_.check(gpgp_.context.recordUpload(commands, frames_.number()).code(), "gpgpRecordUpload");
  if (city_) city_->prepare(commands, frames_.number(), camera, target_.extent().height);
  sight_.prepare(commands, frames_.number(), camera, target_.extent());
  if (screen_)
    screen_->prepare(commands, frames_.number());
  else
    hud_->prepare(commands, frames_.number());
  if (panel_) panel_->prepare(commands, frames_.number());

  forward_.begin(commands, acquired.framebuffer);
  const uint32_t eyeWidth = forward_.extent().width / eyes_;
  for (uint32_t eye = 0; eye < eyes_; ++eye) {
    if (eyes_ > 1)
      forward_.setArea(commands, {{static_cast<int32_t>(eye * eyeWidth), 0}, {eyeWidth, forward_.extent().height}});
    forward_.drawBackdrop(commands, eyes[eye]);
    if (city_) city_->draw(commands, eyes[eye]);
    if (town_) town_->draw(commands, eyes[eye]);
    sight_.draw(commands, eyes[eye]);
    if (screen_) screen_->draw(commands, frames_.number(), eye);
  }
  if (screen_) {
    vkCmdEndRenderPass(commands);
    return;
  }
  // The same model from the side, in a corner: what the main camera cannot see stays dark.
  const VkExtent2D extent = forward_.extent();
  const VkExtent2D inset{extent.width * 3 / 10, extent.height * 3 / 10};
  const VkRect2D corner{{static_cast<int32_t>(extent.width - inset.width - extent.height * 3 / 100),
                         static_cast<int32_t>(extent.height - inset.height - extent.height * 3 / 100)},
                        inset};
  forward_.setArea(commands, corner, true);
  forward_.drawBackdrop(commands, side);
  sight_.draw(commands, side);
  forward_.setArea(commands, {{0, 0}, extent});
  hud_->draw(commands, frames_.number());
  if (panel_) panel_->draw(commands, frames_.number());
  vkCmdEndRenderPass(commands);

  if (const auto* offscreen = dynamic_cast<const Offscreen*>(&target_)) {
    forward_.begin(commands, offscreen->sideFramebuffer());
    forward_.drawBackdrop(commands, side);
    sight_.draw(commands, side);
    vkCmdEndRenderPass(commands);
  }
}

void Engine::collect() {
  if (decoupled_) {
    decoupled_->collect();
    return;
  }
  if (city_) city_->collect();
  if (town_) town_->collect(frames_.number());
  if (hud_) hud_->collect();
  if (screen_) screen_->collect();
  if (panel_) panel_->collect();
  sight_.collect();
}

bool Engine::allWell() const {
  if (decoupled_) return decoupled_->allWell();
  return (town_ ? town_->triangles() > 0 : city_->report().base.status == GPGP_SUCCESS && city_->reports() > 0) &&
         (screen_ ? screen_->allWell() : hud_->report().base.status == GPGP_SUCCESS && hud_->reports() > 0) &&
         (!panel_ || panel_->well()) && sight_.report().base.status == GPGP_SUCCESS && sight_.reports() > 0;
}

void Engine::printSummary() const {
  const GpgpVisibilityReport& sample = sight_.report();
  const auto line = [](const char* service, const GpgpReportHeader& base) {
    std::printf("%-11s %-20s frame %llu: ", service, gpgpResultString(base.status),
                static_cast<unsigned long long>(base.frame));
  };
  std::printf("device      %s\n", device_.properties.deviceName);
  if (decoupled_) {
    const GpgpVisibilityReport& shading = decoupled_->shadingReport();
    const Decoupled::Misses& misses = decoupled_->misses();
    std::printf("shading     %s: %u of %u triangles, %u times\n", gpgpResultString(shading.base.status),
                shading.visible, sight_.model().triangleCount, decoupled_->shadings());
    std::printf("display     %u displays, %.3f %% of the model's pixels without shading, at most %.3f %%\n",
                misses.displays, 100 * misses.pixels / std::max(misses.displays, 1u), 100 * misses.worst);
    if (const auto& reference = decoupled_->referenceReport())
      std::printf("reference       %u triangles: coverage %.2f %%, overestimation %.2f %% (not sampled again)\n",
                  reference->reference, 100 * static_cast<double>(reference->coverage),
                  100 * static_cast<double>(reference->overestimation));
    else if (const auto [slices, all] = decoupled_->referenceSlices(); all)
      std::printf(
          "reference       %u of %u slices sampled: the overlay lacks red and blue; more --frames make the others\n",
          slices, all);
    return;
  }
  if (town_) {
    std::printf("town        %u triangles of %zu lots, mesh hash %016llx\n", town_->triangles(), townLots().size(),
                static_cast<unsigned long long>(town_->hash()));
  } else {
    const GpgpSpawnReport& spawn = city_->report();
    line("spawn", spawn.base);
    std::printf("%u buildings became %u instances in %u rounds, key hash %08x%08x\n", city_->buildings(),
                spawn.instancesWritten, spawn.rounds, spawn.keyHash[1], spawn.keyHash[0]);
    if (city_->budget())
      std::printf("detail      %.3f of the camera, for at most %u instances; %u of %u reports had more\n",
                  static_cast<double>(spawn.detail), city_->budget(), city_->exceeded(), city_->reports());
  }
  const GpgpCanvasReport& canvas = screen_ ? screen_->report() : hud_->report();
  line("vector", canvas.base);
  std::printf("%u paths, %u tile entries\n", canvas.paths, canvas.tileEntries);
  line("visibility", sample.base);
  std::printf("%u of %u triangles of %s visible, %u pixels covered, %u appeared, %u disappeared\n", sample.visible,
              sight_.model().triangleCount, sight_.model().name.c_str(), sample.coveredPixels, sample.appeared,
              sample.disappeared);
  if (screen_) screen_->printSummary();
  const double held = static_cast<double>(gpgp_.memory.bytes()), shared = static_cast<double>(gpgp_.scratchBytes());
  std::printf("memory      gpgp has %.1f MiB: %.1f in %u allocations, and %.1f of scratch that its recorders share\n",
              (held + shared) / 1048576.0, held / 1048576.0, gpgp_.memory.allocations(), shared / 1048576.0);
}

} // namespace mini
