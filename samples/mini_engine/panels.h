// What the screen is made of, each a function that adds to a list. Units: a picture is 720 high; the inventory has its
// own, kInventory wide and high.
#pragma once
#include "camera.h"
#include "game.h"
#include "painter.h"

#include <gpgp/spawn.h>

namespace mini {

/// What drawings the screen shows; null where a file is missing.
struct Pictures {
  gpgp::Drawing crest, portrait, arrow;
};

/// Ids for hit tests: these and the index of the item or slot.
constexpr uint64_t kMenuId = 1, kSlotId = 100;
constexpr float kInventory[2] = {440, 300};

/// Where things are that a test or a person asks for.
Box menuBox(uint32_t item);
Box scoreBox(float width);

void addStatus(Painter& painter, const Game& game, const Pictures& pictures);
void addScore(Painter& painter, const Game& game, float width);
void addMap(Painter& painter, const Camera& camera, const std::vector<GpgpAxiom>& houses, const Pictures& pictures,
            float width);
void addDialogue(Painter& painter, const Game& game, const Pictures& pictures, float width);
void addMenu(Painter& painter, const Game& game);
void addInventory(Painter& painter, const Game& game);
/// What is seen of it from behind.
void addInventoryBack(Painter& painter);

} // namespace mini
