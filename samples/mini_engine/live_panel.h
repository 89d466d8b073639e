// The panel of live editing: a grammar's variables as sliders, by group, and the errors of its file over the picture.
// Dear ImGui, drawn by gpgp::imgui in the forward pass; where that is not built (no_live.cpp), there is no panel.
#pragma once
#include "forward.h"
#include "gpgp_glue.h"
#include "live_grammar.h"
#include "target.h"

namespace mini {

class LivePanel {
public:
  LivePanel(Device& device, Gpgp& gpgp, const Forward& forward, VkFormat format, const std::string& dataFolder);
  ~LivePanel();
  LivePanel(const LivePanel&) = delete;
  LivePanel& operator=(const LivePanel&) = delete;

  void input(const Input& input);
  /// Shows the grammar as it is, and sets what the person changes, for the next frame.
  void update(LiveGrammar& grammar, const GpgpSpawnReport& report, VkExtent2D extent);
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
