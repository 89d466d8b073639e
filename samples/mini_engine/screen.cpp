// Two layers on one canvas recorder, each with a view: the world's is drawn at its panel's depth, the front's flat.
#include "screen.h"

#include "level.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace mini {
namespace {

using Clock = std::chrono::steady_clock;
double microsecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

enum Tag : uint64_t { tagWorld, tagFront };

} // namespace

Screen::Screen(Device& device, Gpgp& gpgp, const Forward& forward, const std::string& dataFolder, uint32_t score,
               uint32_t eyes)
    : gpgp_(gpgp), text_(device, gpgp, dataFolder + "/fetched/fonts"), frame_(device), houses_(levelAxioms()),
      eyes_(eyes) {
  world_.parts = eyes;
  game_.score = score;
  pictures_.crest = gpgp.loadSvg(dataFolder + "/svg/crest.svg", "crest");
  pictures_.portrait = gpgp.loadSvg(dataFolder + "/fetched/svg/tiger.svgz", "portrait");
  makeArrow();
  auto info = gpgp::init<GpgpCanvasCreateInfo>();
  info.base = gpgp.recorder("screen canvas");
  info.maxWidth = kMaxExtent.width;
  info.maxHeight = kMaxExtent.height;
  info.maxGlyphs = 2048;
  info.maxPaths = 8192;
  info.maxTileEntries = 32768;
  info.targets = GPGP_CANVAS_TARGET_HISTORY;
  canvas_ = gpgp.take(gpgp::Canvas::create(gpgp.context, info), "gpgpCreateCanvas");
  gpgp.shareScratch(canvas_);
  for (Layer* layer : {&world_, &front_}) {
    auto list = gpgp::init<GpgpListCreateInfo>();
    list.label = layer == &world_ ? "inventory" : "screen";
    list.shapes = 512;
    list.glyphs = 1024;
    list.commands = 1024;
    layer->list = gpgp.take(gpgp::List::create(gpgp.context, list), "gpgpCreateList");
    layer->target = gpgp::init<GpgpTargetInfo>();
    layer->target.renderPass = forward.renderPass();
    layer->target.samples = Forward::kSamples;
    for (GpgpCanvasItem& item : layer->items) {
      item.list = layer->list;
      item.opacity = 1.0f;
      item.transform[0] = item.transform[3] = 1.0f;
    }
  }
  world_.target.depthTest = VK_TRUE;
  world_.target.depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
  const GpgpTargetInfo targets[] = {world_.target, front_.target};
  auto prewarm = gpgp::init<GpgpPrewarmInfo>();
  prewarm.targets = targets;
  prewarm.targetCount = 2;
  gpgp.check(canvas_.prewarm(prewarm), "gpgpPrewarm");
}

/// The camera on the map, a drawing made from a path: points up, its middle in the middle.
void Screen::makeArrow() {
  static constexpr GpgpPathVerb kVerbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE,
                                            GPGP_PATH_CLOSE};
  static constexpr float kPoints[] = {0, -10, 8, 9, 0, 4, -8, 9};
  static constexpr float kFrame[] = {-10, -10, 10, -10, 10, 10, -10, 10};
  GpgpPath paths[2] = {};
  for (GpgpPath& path : paths) {
    path.verbs = kVerbs;
    path.verbCount = 5;
    path.pointCount = 4;
  }
  paths[0].points = kFrame; // nothing to be seen: the page that the arrow turns in
  paths[1].points = kPoints;
  const Color color = rgb(0x7fe3ff);
  std::copy(color.begin(), color.end(), paths[1].color);
  auto info = gpgp::init<GpgpDrawingCreateInfo>();
  info.label = "arrow";
  info.paths = paths;
  info.pathCount = 2;
  info.hitTestable = VK_TRUE;
  pictures_.arrow = gpgp_.take(gpgp::Drawing::create(gpgp_.context, info), "gpgpCreateDrawing");
}

void Screen::resize(VkExtent2D extent) {
  extent_ = {extent.width / eyes_, extent.height};
  text_.forget();
  for (Layer* layer : {&world_, &front_}) {
    auto info = gpgp::init<GpgpCanvasHistoryCreateInfo>();
    info.label = layer == &world_ ? "inventory" : "screen";
    info.width = extent_.width * layer->parts;
    info.height = extent_.height;
    layer->view = gpgp_.take(gpgp::CanvasHistory::create(gpgp_.context, info), "gpgpCreateCanvasHistory");
    layer->prepared = false;
  }
  float* clip = front_.clips[0];
  std::fill_n(clip, 16, 0.0f);
  clip[0] = 2.0f / static_cast<float>(extent_.width); // canvas pixels to clip space: both have +Y down
  clip[5] = 2.0f / static_cast<float>(extent_.height);
  clip[10] = clip[15] = 1.0f;
  clip[12] = clip[13] = -1.0f;
}

float Screen::scale() const {
  return std::min(static_cast<float>(extent_.height) / kHeight, static_cast<float>(extent_.width) / kNarrowest);
}

Page Screen::page() const {
  return {static_cast<float>(extent_.width) / scale(), static_cast<float>(extent_.height) / scale()};
}

/// The inventory in the world: metres.
void Screen::hang(const Camera* eyes) {
  constexpr float kWidth = 31.0f, kTurn = -0.35f, kTilt = 0.28f; // radians around the vertical, and back
  const float unit = kWidth / kInventory[0];
  const glm::vec3 across(std::cos(kTurn), 0, -std::sin(kTurn)), back(across.z, 0, -across.x), middle(30, 25.5f, -9);
  const glm::vec3 down = -std::cos(kTilt) * glm::vec3(0, 1, 0) - std::sin(kTilt) * back;
  const glm::vec3 corner = middle - across * (0.5f * kWidth) - down * (0.5f * kInventory[1] * unit);
  GpgpPanel panel{};
  for (int axis = 0; axis < 3; ++axis) {
    panel.corner[axis] = corner[axis];
    panel.across[axis] = across[axis] * unit;
    panel.down[axis] = down[axis] * unit;
  }
  for (uint32_t eye = 0; eye < eyes_; ++eye) {
    const uint32_t viewport[4] = {eye * extent_.width, 0, extent_.width, extent_.height};
    gpgp_.check(gpgpPlacePanel(&panel, glm::value_ptr(eyes[eye].viewProjection), viewport, &world_.items[eye],
                               world_.clips[eye]),
                "gpgpPlacePanel");
  }
  const bool fromBehind = glm::dot(eyes[0].eye - corner, glm::cross(down, across)) < 0;
  Painter painter(world_.list, text_, gpgp_, 1.0f);
  if (fromBehind)
    addInventoryBack(painter);
  else
    addInventory(painter, game_);
}

void Screen::update(const Camera* eyes) {
  const uint64_t allocations = gpgp_.hostMemory.allocations();
  const Clock::time_point start = Clock::now();
  ++frames_;
  game_.tick();
  for (Layer* layer : {&world_, &front_}) gpgp_.check(layer->list.clear(), "gpgpResetList");
  world_.shown = game_.inventory;
  if (world_.shown) hang(eyes);
  front_.shown = true;
  const Page all = page();
  Painter painter(front_.list, text_, gpgp_, scale());
  addStatus(painter, game_, pictures_);
  addScore(painter, game_, all);
  addMap(painter, eyes[0], houses_, pictures_, all);
  addDialogue(painter, game_, pictures_, all);
  addMenu(painter, game_);
  fillingNow_ = microsecondsSince(start);
  const uint32_t glyphs = text_.glyphCount();
  if (glyphs != glyphsBefore_) lastConversion_ = frames_;
  glyphsBefore_ = glyphs;
  if (gpgp_.hostMemory.allocations() != allocations) lastAllocation_ = frames_;
}

void Screen::record(VkCommandBuffer commands, const GpgpFrame& frame, Layer& layer) {
  if (!layer.shown) return;
  auto info = gpgp::init<GpgpCanvasInfo>();
  info.base.tag = &layer == &world_ ? tagWorld : tagFront;
  info.base.scratch = gpgp_.scratch();
  info.width = extent_.width * layer.parts;
  info.height = extent_.height;
  info.items = layer.items;
  info.itemCount = layer.parts;
  info.history = layer.view;
  info.exactArea = VK_TRUE; // small letters want it
  GpgpCanvasImage images[2] = {frame_.image()};
  const std::optional<GpgpCanvasImage> text = text_.image();
  if (text) images[kTextImage] = *text;
  info.images = images;
  info.imageCount = text ? 2 : 1;
  if (gpgp_.check(canvas_.recordPrepare(commands, frame, info), "gpgpRecordPrepareCanvas") == GPGP_SUCCESS)
    layer.prepared = true;
}

void Screen::prepare(VkCommandBuffer commands, const GpgpFrame& frame) {
  const uint64_t allocations = gpgp_.hostMemory.allocations();
  const Clock::time_point start = Clock::now();
  text_.upload(commands, frame);
  record(commands, frame, world_);
  record(commands, frame, front_);
  if (frames_ != lastConversion_ && frames_ > 1) { // in the others texts are laid out, and lists make room
    ++settled_;
    filling_ += fillingNow_;
    recording_ += microsecondsSince(start);
  }
  if (gpgp_.hostMemory.allocations() != allocations) lastAllocation_ = frames_;
}

void Screen::draw(VkCommandBuffer commands, const GpgpFrame& frame, uint32_t eye) {
  for (Layer* layer : {&world_, &front_}) {
    if (!layer->shown || !layer->prepared) continue;
    auto info = gpgp::init<GpgpCanvasDrawInfo>();
    info.history = layer->view;
    info.target = &layer->target;
    info.width = extent_.width;
    info.height = extent_.height;
    const uint32_t part = eye % layer->parts;
    info.x = part * extent_.width;
    std::copy(std::begin(layer->clips[part]), std::end(layer->clips[part]), info.clip);
    gpgp_.check(canvas_.recordDraw(commands, frame, info), "gpgpRecordDrawCanvas");
  }
}

Under Screen::under(float x, float y) {
  GpgpCanvasItem items[2];
  auto info = gpgp::init<GpgpHitTestInfo>();
  for (const Layer* layer : {&world_, &front_})
    if (layer->shown) items[info.itemCount++] = layer->items[0];
  info.items = items;
  const float width = static_cast<float>(extent_.width); // a pointer over the other eye's part is over the same place
  info.x = eyes_ > 1 && x >= width ? x - width : x;
  info.y = y;
  const GpgpHit hit = gpgp_.take(gpgp::hitTest(gpgp_.context, info), "gpgpHitTest");
  Under under;
  if (hit.item == GPGP_HIT_NONE) return under;
  if (hit.id >= kMenuId && hit.id < kMenuId + menuItems) under.menu = static_cast<uint32_t>(hit.id - kMenuId);
  if (hit.id >= kSlotId && hit.id < kSlotId + Game::kSlots) under.slot = static_cast<uint32_t>(hit.id - kSlotId);
  return under;
}

std::string Screen::input(const Input& input) {
  if (input.kind == Input::move) {
    pointer_[0] = input.x;
    pointer_[1] = input.y;
  }
  return game_.take(input, under(pointer_[0], pointer_[1]));
}

void Screen::collect() {
  for (auto next = canvas_.report(); next; next = canvas_.report()) {
    if (next->base.tag == tagFront) report_ = *next;
    well_ = well_ && next->base.status == GPGP_SUCCESS;
    ++reports_;
  }
}

void Screen::printSummary() const {
  const float unit = scale();
  const auto at = [&](const Box& box) {
    char text[64];
    std::snprintf(text, sizeof text, "%.0f,%.0f to %.0f,%.0f", static_cast<double>(box.left * unit),
                  static_cast<double>(box.top * unit), static_cast<double>(box.right * unit),
                  static_cast<double>(box.bottom * unit));
    return std::string(text);
  };
  std::printf("screen      %u shapes, %u glyphs", report_.shapes, report_.glyphs);
  if (settled_ > 0)
    std::printf("; CPU a settled frame: %.0f us to fill lists, %.0f us to record", filling_ / settled_,
                recording_ / settled_);
  std::printf("\n");
  std::printf(
      "text        %u glyphs in the set, the last converted in frame %u of %u; gpgp allocated host memory last in "
      "frame %u\n",
      text_.glyphCount(), lastConversion_, frames_, lastAllocation_);
  std::printf("score       %u at %s\n", game_.score, at(scoreBox(page())).c_str());
  for (uint32_t item = 0; item < menuItems; ++item)
    std::printf("menu        %s at %s\n", game_.menuLabel(item), at(menuBox(item)).c_str());
}

} // namespace mini
