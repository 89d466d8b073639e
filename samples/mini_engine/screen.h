// The game's screen: panels on top of the picture, and the inventory hanging in the world behind what stands before it.
// Lists are filled anew every frame; texts are laid out and glyphs converted when they are first shown.
#pragma once
#include "forward.h"
#include "frame.h"
#include "panels.h"

namespace mini {

class Screen {
public:
  /// A file that is not there is left out with a message.
  Screen(Device& device, Gpgp& gpgp, const Forward& forward, const std::string& dataFolder, uint32_t score,
         uint32_t eyes);
  /// New views for another picture size, of which each eye has its part, side by side.
  void resize(VkExtent2D extent);
  /// A key or the pointer, as it lies over the picture drawn last. Says what happened.
  std::string input(const Input& input);
  /// Fills the lists; before gpgpRecordUpload, which takes new glyphs along.
  void update(const Camera* eyes);
  /// Outside render passes.
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame);
  /// Inside the forward pass, after what hides the inventory, in the eye's part of the picture.
  void draw(VkCommandBuffer commands, const GpgpFrame& frame, uint32_t eye);
  void collect();
  Game& game() { return game_; }
  const GpgpCanvasReport& report() const { return report_; }
  bool allWell() const { return reports_ > 0 && well_; }
  void printSummary() const;

private:
  struct Layer { // a list on a canvas: of an eye's size, or one that has a part for each eye
    gpgp::List list;
    gpgp::CanvasHistory view;
    GpgpTargetInfo target{};
    uint32_t parts = 1;
    GpgpCanvasItem items[2]{};
    float clips[2][16] = {};
    bool shown = false, prepared = false;
  };
  void makeArrow();
  float scale() const; // pixels a unit
  Page page() const;
  void hang(const Camera* eyes);
  void record(VkCommandBuffer commands, const GpgpFrame& frame, Layer& layer);
  Under under(float x, float y);

  Gpgp& gpgp_;
  Text text_;
  Pictures pictures_;
  FramePicture frame_;
  std::vector<GpgpAxiom> houses_;
  gpgp::Canvas canvas_;
  Layer world_, front_;
  Game game_;
  uint32_t eyes_ = 1;
  VkExtent2D extent_{}; // of an eye's part
  float pointer_[2] = {-1, -1};
  // What frames cost.
  uint32_t frames_ = 0, settled_ = 0, lastConversion_ = 0, glyphsBefore_ = 0, reports_ = 0;
  uint64_t allocations_ = 0; // gpgp's, on the host, by lists and records
  uint32_t lastAllocation_ = 0;
  double filling_ = 0, recording_ = 0, fillingNow_ = 0; // microseconds
  bool well_ = true;
  GpgpCanvasReport report_{}; // of the front
};

} // namespace mini
