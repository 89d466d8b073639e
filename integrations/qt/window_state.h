// What gpgp has in a window of Qt Quick: a context on the window's device, a canvas recorder for all items, and the
// window's frames.
#pragma once
#include "gpgp_qt.hpp"
#include "picture.h"

#include <QtCore/QPointer>
#include <QtQuick/QQuickWindow>
#include <QtQuick/QSGImageNode>

namespace gpgp::qt {

class CanvasNode;

/// A child of its window, made on the GUI thread. Everything else happens on the render thread: while it synchronises,
/// and in its signals beforeRendering and sceneGraphInvalidated.
class WindowState : public QObject {
  Q_OBJECT
public:
  /// Of this window, made where there is none yet.
  static WindowState& of(QQuickWindow& window);
  explicit WindowState(QQuickWindow& window);
  ~WindowState() override;
  void setBudgets(const WindowBudgets& budgets) { budgets_ = budgets; }

  /// Makes context and canvas where there are none. False: `why` says what failed.
  bool begin(QString& why);
  GpgpContext context() const { return context_; }
  VkResult makePicture(QSize size, Picture& picture);
  QSize maxSize() const;
  /// Destroys it when no frame uses it any more.
  void retire(Picture picture);
  void add(CanvasNode* node) { nodes_.push_back(node); }
  void remove(CanvasNode* node) { std::erase(nodes_, node); }
  QQuickWindow& window() { return window_; }
  /// CanvasItem::failed, on the GUI thread.
  void fail(const QPointer<CanvasItem>& item, const QString& why);

private:
  void beforeRendering();
  void sceneGraphInvalidated();
  bool findDevice(QString& why);
  void takeReports();
  static void GPGP_CALL onMessage(void* user, const GpgpMessage* message);

  QQuickWindow& window_;
  WindowBudgets budgets_;
  QVulkanInstance* instance_ = nullptr;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  uint32_t family_ = 0;
  Context context_;
  Canvas canvas_;
  GpgpFrame frame_{};
  QString message_; // the last error of gpgp
  struct Retired {
    Picture picture;
    uint64_t frame = 0; // the last that may use it
  };
  std::vector<Retired> retired_;
  std::vector<CanvasNode*> nodes_;
};

/// Of an item in the scene graph: its renderer, its picture, and the node that shows it.
class CanvasNode : public QSGNode {
public:
  CanvasNode(WindowState& state, std::unique_ptr<CanvasRenderer> renderer);
  ~CanvasNode() override;
  CanvasRenderer& renderer() { return *renderer_; }
  /// With the GUI thread blocked. A new size makes a new picture.
  bool setSize(QSizeF units, qreal scale, QString& why);

  QPointer<CanvasItem> item;
  bool dirty = true; // to be drawn anew
  QSize size() const { return picture_.size(); }
  qreal scale() const { return scale_; }
  Picture& picture() { return picture_; }
  CanvasContents contents; // of the frame that is being recorded

private:
  WindowState& state_;
  std::unique_ptr<CanvasRenderer> renderer_;
  Picture picture_;
  qreal scale_ = 1;
  std::unique_ptr<QSGTexture> texture_;
  QSGImageNode* image_ = nullptr; // a child, owned by this node
};

} // namespace gpgp::qt
