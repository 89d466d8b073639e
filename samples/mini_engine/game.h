// What the game knows and what its menu does. Nothing here is drawn.
#pragma once
#include "target.h"

namespace mini {

enum MenuItem : uint32_t { menuPause, menuNight, menuInventory, menuTalk, menuQuit, menuItems };

/// What lies under the pointer; nothing: neither.
struct Under {
  uint32_t menu = UINT32_MAX, slot = UINT32_MAX;
};

constexpr uint32_t kMaxScore = 9999999; // seven digits have room

struct Game {
  uint32_t score = 0, line = 0; // line: of the dialogue
  uint64_t ticks = 0;           // frames that the game went on
  bool paused = false, night = false, inventory = true, quit = false;
  uint32_t highlighted = menuPause; // the menu's item that Enter chooses
  uint32_t slot = 2;                // of the inventory, below kSlots
  static constexpr uint32_t kSlots = 8;

  /// A frame goes by.
  void tick();
  float health() const; // 0 to 1
  float stamina() const;
  const char* menuLabel(uint32_t item) const;
  /// A key or the pointer, with what lies under it; says what happened.
  std::string take(const Input& input, const Under& under);

private:
  void choose(uint32_t item);
};

} // namespace mini
