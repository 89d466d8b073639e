#include "game.h"

#include <algorithm>
#include <cmath>

namespace mini {

void Game::tick() {
  if (paused) return;
  ++ticks;
  score = std::min(score + 7 + static_cast<uint32_t>(ticks % 5) * 3, kMaxScore);
}

float Game::health() const { return 0.72f + 0.10f * std::sin(static_cast<float>(ticks) * 0.05f); }
float Game::stamina() const { return 0.55f + 0.35f * std::cos(static_cast<float>(ticks) * 0.03f); }

const char* Game::menuLabel(uint32_t item) const {
  switch (item) {
  case menuPause: return paused ? "Resume" : "Pause";
  case menuNight: return night ? "Day" : "Night";
  case menuInventory: return inventory ? "Hide inventory" : "Show inventory";
  case menuTalk: return "Next line";
  default: return "Quit";
  }
}

void Game::choose(uint32_t item) {
  switch (item) {
  case menuPause: paused = !paused; break;
  case menuNight: night = !night; break;
  case menuInventory: inventory = !inventory; break;
  case menuTalk: line = 1 - line; break;
  default: quit = true;
  }
}

std::string Game::take(const Input& input, const Under& under) {
  const bool onMenu = under.menu < menuItems;
  switch (input.kind) {
  case Input::up:
  case Input::down:
    highlighted = (highlighted + (input.kind == Input::down ? 1u : menuItems - 1u)) % menuItems;
    return std::string("highlighted ") + menuLabel(highlighted);
  case Input::move:
    if (onMenu) highlighted = under.menu;
    if (under.slot < kSlots) slot = under.slot;
    return "over " + (onMenu                ? std::string(menuLabel(under.menu))
                      : under.slot < kSlots ? "slot " + std::to_string(under.slot)
                                            : "nothing");
  case Input::enter:
  case Input::click: {
    if (input.kind == Input::click && !onMenu) return "nothing";
    const uint32_t item = input.kind == Input::click ? under.menu : highlighted;
    const std::string said = std::string("chose ") + menuLabel(item);
    choose(item);
    return said;
  }
  default: return "nothing";
  }
}

} // namespace mini
