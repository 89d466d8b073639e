// The item of gpgp::qt's samples and tests: a scene whose time QML animates.
#pragma once
#include "gpgp_qt.hpp"
#include "scene.h"

namespace gpgp::sample {

class DrawingItem : public qt::CanvasItem {
  Q_OBJECT
  Q_PROPERTY(qreal time READ time WRITE setTime NOTIFY timeChanged)
public:
  using qt::CanvasItem::CanvasItem;

  Options options; ///< what the scene shows; set before the first frame

  qreal time() const { return time_; } ///< of the animation, 0 to 1
  void setTime(qreal time) {
    if (time_ == time) return;
    time_ = time;
    Q_EMIT timeChanged();
    update(); // the renderer is to look again
  }

Q_SIGNALS:
  void timeChanged();

protected:
  std::unique_ptr<qt::CanvasRenderer> createRenderer(GpgpContext context) override {
    return std::make_unique<Renderer>(context, options);
  }

private:
  class Renderer final : public qt::CanvasRenderer {
  public:
    Renderer(GpgpContext context, const Options& options) : scene_(context, options) {}
    void synchronize(qt::CanvasItem& item) override { time_ = static_cast<DrawingItem&>(item).time_; }
    void render(const qt::CanvasFrame& frame, qt::CanvasContents& contents) override {
      scene_.fill(static_cast<float>(time_), static_cast<float>(frame.size.width()),
                  static_cast<float>(frame.size.height()), contents.items);
    }

  private:
    Scene scene_;
    qreal time_ = 0; // a copy: the item belongs to the GUI thread
  };

  qreal time_ = 0;
};

} // namespace gpgp::sample
