// gpgp in Qt Quick: a canvas between rectangles of QML, animated by QML.
#include "drawing_item.h"
#include "sample_instance.h"

#include <QtGui/QGuiApplication>
#include <QtQml/QQmlComponent>
#include <QtQml/QQmlEngine>
#include <QtQuick/QQuickWindow>

#include <cstdio>
#include <memory>

namespace gpgp::sample {
namespace {

constexpr const char* kHelp = R"(gpgp_qt_quick_sample: a canvas of gpgp between rectangles of QML

  --svg FILE       the drawing (default: the HUD of the mini-engine)
  --font FILE      the text's font (default: DejaVu Sans, where it is installed); without one there is no text
  --text TEXT      the line
  --frames N       ends after N frames; otherwise closing the window does
  --size WxH       of the window (default 960x540)
  --picture FILE   at the end, the window with the animation at a quarter, as PNG or BMP
  --validate       under the Khronos validation layer; any message of it is an error

QT_VK_PHYSICAL_DEVICE_INDEX chooses the GPU.
Exit code 0: all is well; 1: an error or a validation message; 2: wrong usage.
)";

constexpr const char* kQml = R"(
import QtQuick
import gpgp.sample
Window {
  title: "gpgp in Qt Quick"
  color: "#10202c"
  Rectangle { // below the canvas
    x: parent.width * 0.1; y: parent.height * 0.45; width: parent.width * 0.35; height: parent.height * 0.3
    radius: 12; color: "#2a6f4d"
  }
  Drawing {
    objectName: "canvas"
    anchors.fill: parent
    NumberAnimation on time { objectName: "animation"; from: 0; to: 1; duration: 4000; loops: Animation.Infinite }
  }
  Rectangle { // above it
    x: parent.width * 0.6; y: parent.height * 0.25; width: parent.width * 0.3; height: parent.height * 0.3
    radius: 12; color: "#8030a0ff"; rotation: 8
    Text { anchors.centerIn: parent; text: "Qt above gpgp"; color: "white"; font.pixelSize: parent.height / 6 }
  }
}
)";

int run(const Options& options) {
  int argc = 1;
  char name[] = "gpgp_qt_quick_sample";
  char* argv[] = {name, nullptr};
  QGuiApplication application(argc, argv);
  QQuickWindow::setGraphicsApi(QSGRendererInterface::Vulkan);
  SampleInstance instance(options.validate);
  qmlRegisterType<DrawingItem>("gpgp.sample", 1, 0, "Drawing");
  QQmlEngine engine;
  QQmlComponent component(&engine);
  component.setData(kQml, QUrl());
  const std::unique_ptr<QObject> root(component.create());
  auto* window = qobject_cast<QQuickWindow*>(root.get());
  if (!window) throw std::runtime_error(component.errorString().toStdString());
  window->setVulkanInstance(&instance.get());
  window->resize(static_cast<int>(options.width), static_cast<int>(options.height));
  qt::WindowBudgets budgets;
  budgets.canvas.maxWidth = budgets.canvas.maxHeight = 4096;
  qt::setBudgets(*window, budgets);
  auto* item = window->findChild<DrawingItem*>("canvas");
  item->options = options;

  int code = 0;
  QObject::connect(item, &qt::CanvasItem::failed, [&](const QString& why) {
    std::fprintf(stderr, "gpgp_qt_quick_sample: %s\n", qPrintable(why));
    code = 1;
    application.exit();
  });
  uint32_t shown = 0;
  const auto count = [&] { // on the GUI thread
    if (++shown == options.frames) application.exit();
    if (shown < options.frames) window->update(); // whatever the animation does
  };
  QObject::connect(window, &QQuickWindow::frameSwapped, &application, count, Qt::QueuedConnection);
  window->show();
  application.exec();
  if (code == 0 && !options.picture.empty()) {
    window->findChild<QObject*>("animation")->setProperty("running", false);
    item->setTime(0.25);
    if (!window->grabWindow().save(QString::fromStdString(options.picture)))
      throw std::runtime_error("cannot write " + options.picture);
  }
  window->hide();
  window->releaseResources();
  if (options.validate) std::printf("validation  %u messages\n", instance.validationMessages());
  return code == 0 && instance.validationMessages() == 0 ? 0 : 1;
}

} // namespace
} // namespace gpgp::sample

int main(int argc, char** argv) {
  gpgp::sample::Options options;
  options.text = "gpgp in Qt Quick";
  options.width = 960;
  options.height = 540;
  options.maxWidth = options.maxHeight = 4096;
  return gpgp::sample::sampleMain(argc, argv, "gpgp_qt_quick_sample", gpgp::sample::kHelp, options, gpgp::sample::run);
}
