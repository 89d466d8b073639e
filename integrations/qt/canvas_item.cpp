#include "window_state.h"

#include <exception>

namespace gpgp::qt {

CanvasRenderer::~CanvasRenderer() = default;

void CanvasRenderer::synchronize(CanvasItem&) {}

CanvasItem::CanvasItem(QQuickItem* parent) : QQuickItem(parent) {
  setFlag(ItemHasContents);
  if (window()) WindowState::of(*window()); // itemChange was called before this was a CanvasItem
}

CanvasItem::~CanvasItem() = default;

void CanvasItem::geometryChange(const QRectF& to, const QRectF& from) {
  QQuickItem::geometryChange(to, from);
  if (to.size() != from.size()) update();
}

void CanvasItem::itemChange(ItemChange change, const ItemChangeData& data) {
  QQuickItem::itemChange(change, data);
  if (change == ItemSceneChange && data.window) WindowState::of(*data.window);
  if (change == ItemDevicePixelRatioHasChanged) update();
}

QSGNode* CanvasItem::updatePaintNode(QSGNode* old, UpdatePaintNodeData*) {
  auto* node = static_cast<CanvasNode*>(old);
  if (width() <= 0 || height() <= 0) {
    delete node;
    return nullptr;
  }
  WindowState& state = WindowState::of(*window());
  QString why;
  try {
    if (!node) {
      std::unique_ptr<CanvasRenderer> renderer;
      if (state.begin(why)) {
        renderer = createRenderer(state.context());
        if (!renderer) why = QStringLiteral("createRenderer returned nullptr");
      }
      if (!renderer) {
        state.fail(this, why);
        return nullptr;
      }
      node = new CanvasNode(state, std::move(renderer));
      node->item = this;
    }
    if (!node->setSize(size(), window()->effectiveDevicePixelRatio(), why)) {
      state.fail(this, why);
      if (node->picture().image()) return node; // it keeps its picture
      delete node;
      return nullptr;
    }
    node->renderer().synchronize(*this);
    node->dirty = true;
  } catch (const std::exception& error) {
    state.fail(this, QString::fromUtf8(error.what()));
  }
  return node;
}

void setBudgets(QQuickWindow& window, const WindowBudgets& budgets) { WindowState::of(window).setBudgets(budgets); }

GpgpContextCreateInfo contextInfo(QVulkanInstance& instance, VkPhysicalDevice physicalDevice, VkDevice device) {
  auto info = init<GpgpContextCreateInfo>();
  info.instance = instance.vkInstance();
  info.physicalDevice = physicalDevice;
  info.device = device;
  info.getInstanceProcAddr =
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(instance.getInstanceProcAddr("vkGetInstanceProcAddr"));
  return info;
}

} // namespace gpgp::qt
