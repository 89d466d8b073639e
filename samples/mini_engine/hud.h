// The head-up display: SVG drawings, rasterised by gpgp vector outside the pass and drawn inside it.
#pragma once
#include "forward.h"
#include "gpgp_glue.h"

namespace mini {

class Hud {
public:
  /// frameFile is stretched to the picture's height; pictureFile, a drawing, is hung in the panel. A file that is not
  /// there is left out with a message.
  Hud(Device& device, Gpgp& gpgp, const Forward& forward, const std::string& frameFile, const std::string& pictureFile);
  /// A new view for another picture size.
  void resize(VkExtent2D extent);
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame);
  void draw(VkCommandBuffer commands, const GpgpFrame& frame);
  void collect();
  const GpgpCanvasReport& report() const { return report_; }
  uint32_t reports() const { return reports_; }

private:
  struct Item {
    gpgp::Drawing drawing;
    GpgpDrawingInfo info{};
    bool isFrame = false;
  };
  void load(const std::string& file, bool isFrame);
  Gpgp& gpgp_;
  std::vector<Item> items_;
  gpgp::Canvas canvas_;
  gpgp::CanvasHistory view_;
  GpgpTargetInfo target_{};
  VkExtent2D extent_{};
  bool prepared_ = false;
  uint32_t reports_ = 0;
  GpgpCanvasReport report_{};
};

} // namespace mini
