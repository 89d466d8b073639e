#include "icons.h"

#include <cmath>

namespace mini {

void addIcon(Painter& painter, Icon icon, const Box& box) {
  // Coordinates of 0 to 10 in the box.
  const float unit = box.width() / 10;
  const auto x = [&](float v) { return box.left + v * unit; };
  const auto y = [&](float v) { return box.top + v * unit; };
  const auto part = [&](float l, float t, float r, float b) { return Box{x(l), y(t), x(r), y(b)}; };
  const auto line = [&](float x0, float y0, float x1, float y1, float width, const Color& color) {
    painter.line(x(x0), y(y0), x(x1), y(y1), width * unit, color);
  };
  const Color steel = rgb(0xc3d0da), dark = rgb(0x6c7f8d), gold = rgb(0xffc857), paper = rgb(0xe8dcc0);
  switch (icon) {
  case Icon::none: return;
  case Icon::gear:
    for (int tooth = 0; tooth < 8; ++tooth) {
      const float angle = static_cast<float>(tooth) * 0.7853982f;
      const float dx = std::cos(angle), dy = std::sin(angle);
      line(5 + 3.2f * dx, 5 + 3.2f * dy, 5 + 4.3f * dx, 5 + 4.3f * dy, 1.3f, steel);
    }
    painter.ellipse(part(1.4f, 1.4f, 8.6f, 8.6f), steel, 2.2f * unit);
    return;
  case Icon::flask:
    painter.ellipse(part(1.6f, 3, 8.4f, 9.8f), rgb(0xbfe6f2, 0.5f));
    painter.clip(part(1, 6, 9, 10));
    painter.ellipse(part(2.1f, 3.5f, 7.9f, 9.3f), rgb(0xf2a03d));
    painter.end();
    painter.fill(part(4, 0.9f, 6, 3.8f), rgb(0xbfe6f2, 0.6f));
    painter.fill(part(3.5f, 0.2f, 6.5f, 1.5f), rgb(0x9a6b3f), 0.4f * unit);
    return;
  case Icon::key:
    line(5.4f, 5.4f, 9, 9, 1.2f, gold);
    line(8.2f, 8.2f, 9.2f, 7.2f, 1.1f, gold);
    line(6.9f, 6.9f, 7.7f, 6.1f, 1.1f, gold);
    painter.ellipse(part(0.6f, 0.6f, 6, 6), gold, 1.3f * unit);
    return;
  case Icon::coins:
    for (int coin = 0; coin < 4; ++coin) {
      const float up = 1.5f * static_cast<float>(coin);
      painter.ellipse(part(1.2f, 6.4f - up, 8.8f, 9.8f - up), rgb(0x9a6a16));
      painter.ellipse(part(1.2f, 5.8f - up, 8.8f, 9.1f - up), gold);
    }
    painter.ellipse(part(3, 2.1f, 7, 3.9f), rgb(0xd9982b));
    return;
  case Icon::wrench:
    line(3.2f, 6.8f, 7, 3, 1.7f, steel);
    painter.ellipse(part(0.4f, 5.2f, 4.8f, 9.6f), steel, 1.4f * unit);
    painter.ellipse(part(5.4f, 0.4f, 9.6f, 4.6f), steel, 1.4f * unit);
    return;
  case Icon::cell:
    painter.fill(part(2.4f, 1.4f, 7.6f, 9.8f), dark, unit);
    painter.fill(part(3.8f, 0.2f, 6.2f, 1.4f), steel);
    painter.fill(part(3.2f, 5.4f, 6.8f, 9), rgb(0x6fdc8c), 0.5f * unit);
    return;
  case Icon::map:
    painter.fill(part(0.6f, 1.4f, 9.4f, 8.6f), paper, 0.5f * unit);
    for (const float fold : {3.4f, 6.5f}) line(fold, 1.6f, fold, 8.4f, 0.25f, rgb(0xb8a57c));
    line(1.8f, 7, 4, 4.6f, 0.5f, rgb(0x3d6f9c));
    line(4, 4.6f, 6.2f, 5.6f, 0.5f, rgb(0x3d6f9c));
    line(7.3f, 3, 8.3f, 4, 0.55f, rgb(0xc23b2e));
    line(8.3f, 3, 7.3f, 4, 0.55f, rgb(0xc23b2e));
    return;
  }
}

} // namespace mini
