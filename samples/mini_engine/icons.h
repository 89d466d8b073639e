// Small pictures of things, made of a few shapes each.
#pragma once
#include "painter.h"

namespace mini {

enum class Icon { none, gear, flask, key, coins, wrench, cell, map };

void addIcon(Painter& painter, Icon icon, const Box& box);

} // namespace mini
