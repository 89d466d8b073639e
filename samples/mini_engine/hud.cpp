// Drawings become a canvas in each frame; the canvas is one blended rectangle in the forward pass.
#include "hud.h"

#include "target.h"

#include <algorithm>

namespace mini {
namespace {

struct Rectangle {
  float x, y, width, height;
};

/// Drawing space to pixels: puts one rectangle into another, undistorted, in its middle.
void fit(const Rectangle& from, const Rectangle& to, float (&transform)[6]) {
  const float scale = std::min(to.width / from.width, to.height / from.height);
  transform[0] = transform[3] = scale;
  transform[1] = transform[2] = 0.0f;
  transform[4] = to.x + (to.width - from.width * scale) * 0.5f - from.x * scale;
  transform[5] = to.y + (to.height - from.height * scale) * 0.5f - from.y * scale;
}

} // namespace

Hud::Hud(Device&, Gpgp& gpgp, const Forward& forward, const std::string& frameFile, const std::string& pictureFile)
    : gpgp_(gpgp) {
  load(frameFile, true);
  load(pictureFile, false);
  auto info = gpgp::init<GpgpCanvasCreateInfo>();
  info.base = gpgp.recorder("hud canvas");
  info.maxWidth = kMaxExtent.width;
  info.maxHeight = kMaxExtent.height;
  info.maxPaths = 8192;
  info.maxTileEntries = 32768;
  info.targets = GPGP_CANVAS_TARGET_HISTORY;
  canvas_ = gpgp.take(gpgp::Canvas::create(gpgp.context, info), "gpgpCreateCanvas");
  gpgp.shareScratch(canvas_);
  target_ = gpgp::init<GpgpTargetInfo>();
  target_.renderPass = forward.renderPass();
  target_.samples = Forward::kSamples;
  auto prewarm = gpgp::init<GpgpPrewarmInfo>();
  prewarm.targets = &target_;
  prewarm.targetCount = 1;
  gpgp.check(canvas_.prewarm(prewarm), "gpgpPrewarm");
}

void Hud::load(const std::string& file, bool isFrame) {
  Item item;
  item.drawing = gpgp_.loadSvg(file, isFrame ? "hud frame" : "hud picture");
  if (!item.drawing) return;
  item.info = gpgp_.take(item.drawing.info(), "gpgpGetDrawingInfo");
  item.isFrame = isFrame;
  items_.push_back(std::move(item));
}

void Hud::resize(VkExtent2D extent) {
  extent_ = extent;
  auto info = gpgp::init<GpgpCanvasHistoryCreateInfo>();
  info.label = "hud";
  info.width = extent.width;
  info.height = extent.height;
  info.maxKept = 64; // more than its drawings: where they stay as they are, nothing is rasterised again
  view_ = gpgp_.take(gpgp::CanvasHistory::create(gpgp_.context, info), "gpgpCreateCanvasHistory");
  prepared_ = false;
}

void Hud::prepare(VkCommandBuffer commands, const GpgpFrame& frame) {
  const float width = static_cast<float>(extent_.width), height = static_cast<float>(extent_.height);
  std::vector<GpgpCanvasItem> items;
  for (const Item& item : items_) {
    GpgpCanvasItem entry{};
    entry.drawing = item.drawing;
    entry.opacity = 1.0f;
    const float* page = item.info.viewport;
    const float* ink = item.info.bounds;
    if (item.isFrame) // its whole page covers the picture
      fit({page[0], page[1], page[2], page[3]}, {0, 0, width, height}, entry.transform);
    else // what is drawn, without the page's margins, fills the panel
      fit({ink[0], ink[1], ink[2] - ink[0], ink[3] - ink[1]},
          {height * 0.028f, height * 0.028f, height * 0.283f, height * 0.283f}, entry.transform);
    items.push_back(entry);
  }
  auto info = gpgp::init<GpgpCanvasInfo>();
  info.base.tag = frame.current;
  info.base.scratch = gpgp_.scratch();
  info.width = extent_.width;
  info.height = extent_.height;
  info.items = items.data();
  info.itemCount = static_cast<uint32_t>(items.size());
  info.history = view_;
  info.keep = VK_TRUE;
  if (gpgp_.check(canvas_.recordPrepare(commands, frame, info), "gpgpRecordPrepareCanvas") == GPGP_SUCCESS)
    prepared_ = true;
}

void Hud::draw(VkCommandBuffer commands, const GpgpFrame& frame) {
  if (!prepared_) return;
  auto info = gpgp::init<GpgpCanvasDrawInfo>();
  info.history = view_;
  info.target = &target_;
  info.width = extent_.width;
  info.height = extent_.height;
  info.clip[0] = 2.0f / static_cast<float>(extent_.width); // canvas pixels to clip space: both have +Y down
  info.clip[5] = 2.0f / static_cast<float>(extent_.height);
  info.clip[10] = info.clip[15] = 1.0f;
  info.clip[12] = info.clip[13] = -1.0f;
  gpgp_.check(canvas_.recordDraw(commands, frame, info), "gpgpRecordDrawCanvas");
}

void Hud::collect() {
  for (auto next = canvas_.report(); next; next = canvas_.report()) {
    if (next->tilesDrawn || reports_ == 0) report_ = *next; // else nothing was to be done
    ++reports_;
  }
}

} // namespace mini
