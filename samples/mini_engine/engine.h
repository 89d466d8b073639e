// The frame loop: two frames in flight; what gpgp records goes into the engine's own command buffer.
#pragma once
#include "city.h"
#include "decoupled.h"
#include "hud.h"
#include "live_grammar.h"
#include "live_panel.h"
#include "screen.h"
#include "sight.h"
#include "target.h"
#include "town.h"

namespace mini {

struct EngineOptions {
  std::string dataFolder; // tests/data
  bool watch = false;     // grammars follow their files
  DecoupledOptions decoupled;
  bool screen = false;       // a game's screen instead of the HUD
  bool stereo = false;       // for two eyes, side by side
  uint32_t score = 0;        // on it at the beginning
  std::vector<Input> inputs; // for it, before the second frame
  std::string live;          // a file to edit, with a panel; empty: none
  uint32_t budget = 0;       // instances of the city, whose detail it chooses; 0: all of them, without a camera
};

class Engine {
public:
  static constexpr uint32_t kFramesInFlight = 2;
  Engine(Device& device, Target& target, const EngineOptions& options);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Renders frame after frame until `frames` are done (0: until the window closes), then waits.
  void run(uint32_t frames);
  /// Live editing by a script (live_script.h). The camera stands still.
  void runScript(const std::string& file);
  /// Decoupled shading: walks the same path with standard and with exact sampling and prints what displays missed, and
  /// times. table: with the other configurations of the thesis's table 6.1 as well.
  void comparePaths(uint32_t frames, bool table);
  void printSummary() const;
  /// Whether every record of every frame was executed and nothing exceeded its budget.
  bool allWell() const;

private:
  void frame();
  void record(VkCommandBuffer commands, const Acquired& acquired);
  void resize();
  void collect();
  void take(const std::vector<Input>& inputs);
  void updateLive();
  void recordDecoupled(VkCommandBuffer commands, const Acquired& acquired);
  Camera orbit(float angle, float distance, float height, float fieldOfView, float aside = 0) const;

  Device& device_;
  Target& target_;
  Forward forward_;
  Gpgp gpgp_;
  std::unique_ptr<City> city_;
  std::unique_ptr<Hud> hud_;
  std::unique_ptr<Screen> screen_; // instead of the HUD
  Sight sight_;
  std::unique_ptr<Decoupled> decoupled_; // instead of city, HUD and sight
  std::unique_ptr<Town> town_;           // instead of the city, of a .cga file
  std::unique_ptr<LiveGrammar> grammar_; // that is edited
  std::unique_ptr<LiveCga> cga_;         // or this
  LiveFile* live_ = nullptr;             // whichever of them
  std::unique_ptr<LivePanel> panel_;     // with live_
  bool moves_ = true;                    // the camera
  float farther_ = 1;
  uint32_t eyes_ = 1; // each has its part of the picture, side by side
  uint64_t step_ = 0; // on the camera's path
  std::vector<Input> script_;
  gpgp::sdl2::Frames frames_; // waits for its frames before what they use goes
};

} // namespace mini
