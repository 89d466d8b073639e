// Live editing without gpgp::imgui.
#include "live_panel.h"

namespace mini {

struct LivePanel::Impl {
  float errorBox[4] = {};
};

LivePanel::LivePanel(Device&, Gpgp&, const Forward&, VkFormat, const std::string&) {
  throw std::runtime_error("built without Dear ImGui (Debian: libimgui-dev); there is no live editing");
}
LivePanel::~LivePanel() = default;
void LivePanel::input(const Input&) {}
void LivePanel::update(LiveFile&, const std::string&, VkExtent2D) {}
void LivePanel::prepare(VkCommandBuffer, const GpgpFrame&) {}
void LivePanel::draw(VkCommandBuffer, const GpgpFrame&) {}
void LivePanel::collect() {}
bool LivePanel::well() const { return true; }
const float (&LivePanel::errorBox() const)[4] { return impl_->errorBox; }

} // namespace mini
