#include "panels.h"

#include "frame.h"
#include "icons.h"

#include <algorithm>
#include <cmath>

namespace mini {
namespace {

const Color kText = rgb(0xf3f6f9), kMuted = rgb(0xa9bccb), kAmber = rgb(0xffb84d);
const Color kRim = rgb(0x7fb6cf, 0.6f);
constexpr float kMargin = 24;

/// The plate that everything lies on.
void plate(Painter& painter, const Box& box, float radius = 12) {
  painter.fade(box, rgb(0x16273a, 0.965f), rgb(0x060c12, 0.965f), radius);
  painter.border(box, kRim, radius);
}

void bar(Painter& painter, const Box& box, float share, const Color& above, const Color& below) {
  const float radius = box.height() * 0.5f;
  painter.fill(box, rgb(0x02060a, 0.95f), radius);
  const Box inner = box.inset(2);
  painter.clip({inner.left, inner.top, inner.left + inner.width() * share, inner.bottom});
  painter.fade(inner, above, below, radius - 2);
  painter.end();
}

} // namespace

void addStatus(Painter& painter, const Game& game, const Pictures& pictures) {
  plate(painter, Box::sized(kMargin, kMargin, 356, 112));
  if (pictures.crest) painter.drawing(pictures.crest, Box::sized(36, 32, 84, 96));
  painter.text("Ironvale Guard", Box::sized(136, 32, 176, 28), {19, kText, true});
  painter.text("Lv 7", Box::sized(312, 32, 52, 28), {15, kAmber, true, GPGP_TEXT_ALIGN_RIGHT});
  painter.text("Health", Box::sized(136, 64, 64, 24), {14, kMuted});
  bar(painter, Box::sized(204, 68, 160, 16), game.health(), rgb(0xff7a6b), rgb(0xb3261e));
  painter.text("Stamina", Box::sized(136, 92, 64, 24), {14, kMuted});
  bar(painter, Box::sized(204, 96, 160, 16), game.stamina(), rgb(0x8ef0b0), rgb(0x1e8a4c));
}

Box scoreBox(const Page& page) { return Box::sized(page.width - kMargin - 188, 52, 172, 42); }

void addScore(Painter& painter, const Game& game, const Page& page) {
  plate(painter, Box::sized(page.width - kMargin - 204, kMargin, 204, 80));
  painter.text("SCORE", Box::sized(page.width - kMargin - 188, 32, 172, 22), {13, kMuted, true, GPGP_TEXT_ALIGN_RIGHT});
  painter.number(game.score, 7, scoreBox(page), {36, kText, true, GPGP_TEXT_ALIGN_RIGHT});
}

void addMap(Painter& painter, const Camera& camera, const std::vector<GpgpAxiom>& houses, const Pictures& pictures,
            const Page& page) {
  constexpr float kRadius = 84, kMetres = 112; // from the middle to the rim
  const float x = page.width - kMargin - kRadius, y = page.height - kMargin - kRadius, scale = kRadius / kMetres;
  const Box round{x - kRadius, y - kRadius, x + kRadius, y + kRadius};
  painter.ellipse(round, rgb(0x060c12, 0.965f));
  painter.clip(round.inset(3), kRadius - 3);
  painter.fill(round, rgb(0x22313c));
  for (const GpgpAxiom& house : houses) {
    const float hx = x + house.transform[3] * scale, hy = y + house.transform[11] * scale;
    const float w = house.size[0] * 0.5f * scale, d = house.size[2] * 0.5f * scale;
    if (std::hypot(hx - x, hy - y) > kRadius + w + d) continue;
    const float tall = std::clamp(house.size[1] / 50.0f, 0.0f, 1.0f);
    painter.fill({hx - w, hy - d, hx + w, hy + d},
                 {0.08f + 0.22f * tall, 0.12f + 0.25f * tall, 0.16f + 0.26f * tall, 1.0f}, 1);
  }
  painter.fill(Box::sized(x - 20, y - 6, 40, 12), kAmber, 3); // the engine on the square
  const float eyeX = x + camera.eye.x * scale, eyeY = y + camera.eye.z * scale;
  if (pictures.arrow) {
    painter.place(eyeX, eyeY, std::atan2(-camera.eye.x, camera.eye.z));
    painter.drawing(pictures.arrow, {-11, -11, 11, 11});
    painter.end();
  }
  painter.end();
  painter.ellipse(round, kRim, 3);
  painter.ellipse(Box::sized(x - 12, y - kRadius - 12, 24, 24), rgb(0x14222e));
  painter.ellipse(Box::sized(x - 12, y - kRadius - 12, 24, 24), kRim, 1.5f);
  painter.text("N", Box::sized(x - 12, y - kRadius - 12, 24, 24), {13, kText, true, GPGP_TEXT_ALIGN_CENTER});
}

void addDialogue(Painter& painter, const Game& game, const Pictures& pictures, const Page& page) {
  static constexpr const char* kLines[] = {
      "The east cylinder runs hot again 🔥. Climb to the roof, open the valve, and be back before the bells ring six.\n"
      "الأسطوانة الشرقية ساخنة مرة أخرى. اصعد إلى السطح، وافتح الصمام، وعُد قبل أن تدق الأجراس السادسة.",
      "東のシリンダーがまた過熱している。屋上へ行って弁を開け、鐘が六つ鳴る前に戻ってきてくれ。\n"
      "If the gauge is past the red mark, do not touch the wheel with bare hands: take the long key from the workshop, "
      "turn it twice against the clock, and wait until the whistle stops. Nobody has come back who did not wait."};
  const Box box = Box::sized((page.width - 680) * 0.5f, page.height - kMargin - 148, 680, 148);
  plate(painter, box, 16);
  // The picture of who speaks, cut round.
  const Box face = Box::sized(box.left + 20, box.top + 22, 104, 104);
  painter.ellipse(face, rgb(0x24323d));
  if (pictures.portrait) {
    painter.clip(face.inset(2), 50);
    painter.drawing(pictures.portrait, face.inset(3), true);
    painter.end();
  }
  painter.ellipse(face, kAmber, 2.5f);
  // The name, on a tag across the rim.
  const Box tag = Box::sized(box.left + 148, box.top - 16, 208, 32);
  painter.fade(tag, rgb(0xffcf7d), rgb(0xe09a2b), 8);
  painter.text("Tigris · دجلة", tag, {16, rgb(0x1a1206), true, GPGP_TEXT_ALIGN_CENTER});
  painter.text(kLines[game.line], {box.left + 148, box.top + 26, box.right - 28, box.bottom - 14},
               {17, kText, false, GPGP_TEXT_ALIGN_START, true});
}

Box menuBox(uint32_t item) { return Box::sized(kMargin + 12, 228 + 48.0f * static_cast<float>(item), 196, 40); }

void addMenu(Painter& painter, const Game& game) {
  const Box last = menuBox(menuItems - 1);
  plate(painter, {kMargin, 176, kMargin + 220, last.bottom + 48});
  painter.text("MENU", Box::sized(kMargin + 28, 186, 160, 36), {14, kMuted, true});
  for (uint32_t item = 0; item < menuItems; ++item) {
    const bool on = item == game.highlighted;
    const Box box = menuBox(item);
    const uint64_t id = kMenuId + item;
    if (on)
      painter.fade(box, rgb(0xffcf7d), rgb(0xe8a135), 8, id);
    else
      painter.fill(box, rgb(0x253a4d), 8, id);
    painter.text(game.menuLabel(item), {box.left + 16, box.top, box.right - 16, box.bottom},
                 {17, on ? rgb(0x1a1206) : kText, true}, id);
  }
  painter.text("↑ ↓ choose   ↵ enter", {kMargin + 28, last.bottom + 8, kMargin + 208, last.bottom + 40}, {13, kMuted});
}

void addInventory(Painter& painter, const Game& game) {
  struct Thing {
    const char *name, *about;
    uint32_t count;
    Icon icon;
  };
  static constexpr Thing kThings[Game::kSlots] = {
      {"Gear", "Fits the small crane and nothing else.", 12, Icon::gear},
      {"Lamp oil", "Burns for an hour.", 3, Icon::flask},
      {"Long valve key 🗝️", "Opens the pressure valve on the roof of the east cylinder, if the gauge allows.", 1,
       Icon::key},
      {"Coins", "What the city pays its guards.", 86, Icon::coins},
      {"Wrench", "Older than the engine.", 1, Icon::wrench},
      {"Cell", "Half full.", 2, Icon::cell},
      {"Map", "Streets from before the square was cleared.", 1, Icon::map},
      {"", "An empty place.", 0, Icon::none},
  };
  const Box all{0, 0, kInventory[0], kInventory[1]};
  constexpr float kBorder = static_cast<float>(FramePicture::kBorder) / static_cast<float>(FramePicture::kSide);
  painter.slices(all, {kFrameImage, {0, 0, 1, 1}, {kBorder, kBorder, kBorder, kBorder}, {15, 15, 15, 15}, {}, {}});
  painter.text("Inventory", {24, 12, 240, 52}, {24, kText, true});
  painter.text("108 of 120", {240, 12, 416, 52}, {17, kMuted, false, GPGP_TEXT_ALIGN_RIGHT});
  for (uint32_t i = 0; i < Game::kSlots; ++i) {
    const Box slot =
        Box::sized(24 + 100.0f * static_cast<float>(i % 4), 114 + 86.0f * static_cast<float>(i / 4), 92, 78);
    const bool on = i == game.slot;
    painter.fill(slot, on ? rgb(0x3d5a6c) : rgb(0x1c2f3c), 10);
    painter.border(slot, on ? kAmber : rgb(0x4a6577), 10, on ? 3.0f : 1.5f);
    addIcon(painter, kThings[i].icon, Box::sized(slot.left + 20, slot.top + 13, 52, 52));
    if (kThings[i].count > 1) {
      const uint32_t digits = kThings[i].count > 9 ? 2 : 1;
      painter.number(kThings[i].count, digits, {slot.left, slot.bottom - 24, slot.right - 8, slot.bottom - 2},
                     {16, kText, true, GPGP_TEXT_ALIGN_RIGHT});
    }
    painter.fill(slot, {0, 0, 0, 0}, 10, kSlotId + i); // unseen, on top of all: wherever the slot is hit, it says so
  }
  const Thing& thing = kThings[game.slot];
  painter.text(thing.name, {24, 54, 416, 80}, {19, kAmber, true});
  painter.text(thing.about, {24, 80, 416, 104}, {17, kText});
}

void addInventoryBack(Painter& painter) {
  const Box all{0, 0, kInventory[0], kInventory[1]};
  painter.fill(all, rgb(0x22313c), 18);
  painter.border(all, rgb(0x4a6577), 18, 3);
}

} // namespace mini
