// gpgp::qt: an item of Qt Quick that shows a gpgp canvas, and what a QVulkanWindow needs.
//
//   CanvasItem      a QQuickItem. Derive from it and return a renderer of your own, as with QQuickFramebufferObject
//   CanvasRenderer  lives on the render thread and says what the canvas shows
//   contextInfo     gpgp's context on a device of Qt's
//
// Compute work is recorded into Qt's command buffer before its render pass (QQuickWindow::beforeRendering). The result
// is a texture, which Qt draws at the item's place: order, opacity, clips, transforms, layers and effects are Qt's own.
// Errors are texts of CanvasItem::failed. Nothing here throws, and there is no global state.
#pragma once
#include <gpgp/gpgp.hpp>

#include <QtCore/QSize>
#include <QtGui/QVulkanInstance>
#include <QtQuick/QQuickGraphicsConfiguration>
#include <QtQuick/QQuickItem>

#include <memory>
#include <vector>

namespace gpgp::qt {

/// The frame that a renderer is asked for.
struct CanvasFrame {
  VkCommandBuffer commands = VK_NULL_HANDLE; ///< outside render passes; for uploads of the renderer's own
  GpgpFrame frame{};
  QSize size;      ///< of the canvas in pixels
  qreal scale = 1; ///< pixels per unit of the item: the window's device pixel ratio
};

/// What the canvas shows. Coordinates are pixels of the canvas.
struct CanvasContents {
  std::vector<GpgpCanvasItem> items;   ///< in painting order, the first at the bottom
  std::vector<GpgpCanvasImage> images; ///< that items paint with
  float background[4] = {};            ///< premultiplied, encoded as sRGB; transparent
  bool exactArea = true;               ///< GpgpCanvasInfo::exactArea
  bool again = false;                  ///< asks for another frame at once, as an animation of the renderer's own does
};

class CanvasItem;

/// What a canvas shows. Made, called and destroyed on the window's render thread.
class CanvasRenderer {
public:
  CanvasRenderer() = default;
  virtual ~CanvasRenderer();
  CanvasRenderer(const CanvasRenderer&) = delete;
  CanvasRenderer& operator=(const CanvasRenderer&) = delete;

  /// After each QQuickItem::update, with the GUI thread blocked: copies what has changed from the item.
  virtual void synchronize(CanvasItem& item);
  /// Fills the contents, which are empty. Called between gpgpAdvance and gpgpRecordUpload of a frame, in frames after
  /// an update, a resize or CanvasContents::again. The GUI thread runs meanwhile. May throw std::exception: the canvas
  /// then keeps its picture, and CanvasItem::failed says why.
  virtual void render(const CanvasFrame& frame, CanvasContents& contents) = 0;
};

/// An item whose picture is a canvas of its size in device pixels.
class CanvasItem : public QQuickItem {
  Q_OBJECT
public:
  explicit CanvasItem(QQuickItem* parent = nullptr);
  ~CanvasItem() override;

Q_SIGNALS:
  /// On the GUI thread. The item keeps the picture that it had, if any. Call update() to have it try again.
  void failed(const QString& why);

protected:
  /// Makes the renderer and its assets. Called on the render thread with the GUI thread blocked; again after the scene
  /// graph was invalidated, with a new context. Returns nullptr or throws std::exception on failure.
  virtual std::unique_ptr<CanvasRenderer> createRenderer(GpgpContext context) = 0;

  QSGNode* updatePaintNode(QSGNode* old, UpdatePaintNodeData* data) override;
  void geometryChange(const QRectF& to, const QRectF& from) override;
  void itemChange(ItemChange change, const ItemChangeData& data) override;
};

/// What all items of a window share.
struct WindowBudgets {
  /// Of the recorder, one for all items of the window: a canvas is no larger than maxWidth x maxHeight (0: 2048).
  /// base.queueFamily, base.queueFlags and targets are ignored.
  GpgpCanvasCreateInfo canvas = GPGP_CANVAS_CREATE_INFO_INIT;
  /// Items that are drawn anew in one frame, 1 to 4096. Those beyond follow in the next frames.
  uint32_t itemsPerFrame = 16;
};

/// Sets the budgets of a window. Call it on the GUI thread before the first item of gpgp::qt is in the window.
void setBudgets(QQuickWindow& window, const WindowBudgets& budgets);

/// All of a context's create info but maxFramesInFlight, label and callbacks, for a device of Qt's. The instance must
/// have been created with QVulkanInstance::setApiVersion(1.2) or higher. Qt's devices have no features that gpgp would
/// use beyond Vulkan 1.2: whoever makes the device (QQuickGraphicsDevice::fromDeviceObjects) may declare some.
GpgpContextCreateInfo contextInfo(QVulkanInstance& instance, VkPhysicalDevice physicalDevice, VkDevice device);

} // namespace gpgp::qt
