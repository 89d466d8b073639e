// What the screen is made of, each a function that adds to a list. Units: a page is 720 high, or kNarrowest wide where
// that makes things smaller; the inventory has its own, kInventory wide and high.
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

/// Of a picture, in units.
struct Page {
  float width = 0, height = 0;
};

/// Ids for hit tests: these and the index of the item or slot.
constexpr uint64_t kMenuId = 1, kSlotId = 100;
constexpr float kHeight = 720, kNarrowest = 1120; // dialogue and map beside each other
constexpr float kInventory[2] = {440, 300};

/// Where things are that a test or a person asks for.
Box menuBox(uint32_t item);
Box scoreBox(const Page& page);

void addStatus(Painter& painter, const Game& game, const Pictures& pictures);
void addScore(Painter& painter, const Game& game, const Page& page);
void addMap(Painter& painter, const Camera& camera, const std::vector<GpgpAxiom>& houses, const Pictures& pictures,
            const Page& page);
void addDialogue(Painter& painter, const Game& game, const Pictures& pictures, const Page& page);
void addMenu(Painter& painter, const Game& game);
void addInventory(Painter& painter, const Game& game);
/// What is seen of it from behind.
void addInventoryBack(Painter& painter);

} // namespace mini
