// The panel of live editing: a file's attributes as sliders, switches, lists and colours, by group, and the errors of
// its file over the picture. Dear ImGui, drawn by gpgp::imgui in the forward pass; where that is not built
// (no_live.cpp), there is no panel.
#pragma once
#include "forward.h"
#include "gpgp_glue.h"
#include "live_file.h"
#include "target.h"

namespace mini {

class LivePanel {
public:
  LivePanel(Device& device, Gpgp& gpgp, const Forward& forward, VkFormat format, const std::string& dataFolder);
  ~LivePanel();
  LivePanel(const LivePanel&) = delete;
  LivePanel& operator=(const LivePanel&) = delete;

  void input(const Input& input);
  /// Shows the file as it is, and sets what the person changes, for the next frame.
  void update(LiveFile& file, const std::string& summary, VkExtent2D extent);
  /// Outside of render passes.
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame);
  /// Inside the forward pass, last.
  void draw(VkCommandBuffer commands, const GpgpFrame& frame);
  void collect();
  bool well() const;
  /// Where the errors stand: left, top, right, bottom, pixels; all 0: there are none.
  const float (&errorBox() const)[4];

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace mini
