// gpgp::qt: what a window of Qt Quick shows of a canvas, beside the same canvas drawn by gpgp alone on a device of its
// own and put together with what lies behind and above by hand. On a virtual display, under the validation layer with
// synchronisation checks. GPGP_QT_PICTURES=FOLDER writes what is compared. QT_SCALE_FACTOR=2 runs all of it on a scaled
// display.
#include "drawing_item.h"
#include "sample_instance.h"
#include "sample_window.h"
#include "stage.h"

#include <QtCore/QDeadlineTimer>
#include <QtCore/QThread>
#include <QtGui/QGuiApplication>
#include <QtQuick/QQuickWindow>
#include <QtQuick/QSGSimpleRectNode>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace {

using namespace gpgp;
using sample::DrawingItem;

sample::SampleInstance* instance = nullptr; // main()'s, as Qt's application is
constexpr QColor kBehind(200, 120, 40), kAbove(20, 60, 220);
constexpr QSize kItem(300, 200); // units

sample::Options options() {
  sample::Options options;
  options.text = "Qt Quick";
  return options;
}

/// gpgp alone: a canvas on a device of its own.
class Alone : test::Stage {
public:
  Alone() : Stage(VK_FORMAT_R8G8B8A8_UNORM, 800, 600, VK_IMAGE_USAGE_STORAGE_BIT), scene_(context, options()) {
    auto info = init<GpgpCanvasCreateInfo>();
    info.base.queueFamily = device.family;
    info.targets = GPGP_CANVAS_TARGET_RGBA8;
    canvas_ = *Canvas::create(context, info);
    EXPECT_EQ(canvas_.prewarm(), GPGP_SUCCESS);
  }
  ~Alone() { vkDeviceWaitIdle(device.device); }

  /// The scene: premultiplied, as sRGB encodes it. Over a linear colour, if there is one, colours mix in linear light.
  QImage draw(float time, QSize pixels, const float* over = nullptr) {
    std::vector<GpgpCanvasItem> items;
    VkCommandBuffer commands = frames.begin();
    EXPECT_EQ(context.advance(frames.number()), GPGP_SUCCESS);
    auto info = init<GpgpCanvasInfo>();
    info.width = static_cast<uint32_t>(pixels.width());
    info.height = static_cast<uint32_t>(pixels.height());
    scene_.fill(time, static_cast<float>(info.width), static_cast<float>(info.height), items);
    EXPECT_EQ(context.recordUpload(commands, frames.number()).code(), GPGP_SUCCESS);
    info.items = items.data();
    info.itemCount = static_cast<uint32_t>(items.size());
    info.exactArea = info.encodeSrgb = VK_TRUE;
    info.blendSrgb = over ? VK_FALSE : VK_TRUE;
    if (over) std::copy_n(over, 4, info.background);
    const GpgpAccess after{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    info.target = {image, view, format, 0, 0, width, height, {}, after};
    EXPECT_EQ(canvas_.recordPrepare(commands, frames.number(), info), GPGP_SUCCESS);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {info.width, info.height, 1};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
    frames.submit();
    vkDeviceWaitIdle(device.device);
    const QImage shared(static_cast<const uchar*>(mapped), pixels.width(), pixels.height(), pixels.width() * 4,
                        QImage::Format_RGBA8888_Premultiplied);
    return shared.copy();
  }

private:
  sample::Scene scene_;
  Canvas canvas_;
};

/// A rectangle of Qt's own.
class RectItem : public QQuickItem {
public:
  RectItem(QQuickItem* parent, QRectF rect, QColor color) : QQuickItem(parent), color_(color) {
    setFlag(ItemHasContents);
    setPosition(rect.topLeft());
    setSize(rect.size());
  }

protected:
  QSGNode* updatePaintNode(QSGNode* old, UpdatePaintNodeData*) override {
    auto* node = old ? static_cast<QSGSimpleRectNode*>(old) : new QSGSimpleRectNode;
    node->setRect(boundingRect());
    node->setColor(color_);
    return node;
  }

private:
  QColor color_;
};

struct QtQuick : testing::Test {
  static std::unique_ptr<Alone> reference;
  static void SetUpTestSuite() { reference = std::make_unique<Alone>(); }
  static void TearDownTestSuite() { reference.reset(); }
  static QImage alone(float time, QSize pixels) { return reference->draw(time, pixels); }

  QQuickWindow window;
  DrawingItem item{window.contentItem()};
  std::vector<QString> failures;
  int invalidated = 0;

  QtQuick() {
    window.setVulkanInstance(&instance->get());
    window.setColor(kBehind);
    window.resize(360, 260);
    item.options = options();
    item.setPosition({24, 16});
    item.setSize(kItem);
    QObject::connect(&item, &qt::CanvasItem::failed, &item, [this](const QString& why) { failures.push_back(why); });
    QObject::connect(
        &window, &QQuickWindow::sceneGraphInvalidated, &item, [this] { ++invalidated; }, Qt::DirectConnection);
  }
  ~QtQuick() override {
    window.destroy();
    EXPECT_EQ(instance->validationMessages(), 0u);
    for (const QString& why : failures) ADD_FAILURE() << why.toStdString();
  }

  /// Handles events until `done` is true or 20 s have passed.
  template <class Done> static bool wait(const Done& done) {
    const QDeadlineTimer deadline(20000);
    while (!done() && !deadline.hasExpired()) {
      QGuiApplication::processEvents();
      QThread::msleep(2);
    }
    return done();
  }
  void show() {
    window.show();
    ASSERT_TRUE(wait([&] { return window.isExposed(); }));
  }
  /// What the window shows once nothing changes any more.
  QImage grab(const char* name) {
    QImage last, now = grabOnce();
    for (int i = 0; i < 10 && now != last; ++i) {
      last = now;
      now = grabOnce();
    }
    if (const char* folder = std::getenv("GPGP_QT_PICTURES")) now.save(QString("%1/%2.png").arg(folder, name));
    return now;
  }
  QImage grabOnce() {
    QGuiApplication::processEvents();
    return window.grabWindow().convertToFormat(QImage::Format_RGBA8888);
  }
  qreal scale() const { return window.effectiveDevicePixelRatio(); }
  QSize pixels(QSizeF units) const {
    return {int(std::ceil(units.width() * scale())), int(std::ceil(units.height() * scale()))};
  }
  /// The largest difference of a channel between the shown pixels of `rect` (units of the window) and the canvas over
  /// `behind`, with `opacity`. The canvas begins at `at`.
  int difference(const QImage& shown, const QImage& canvas, QRectF rect, QPointF at, QColor behind,
                 double opacity = 1) const {
    int worst = 0;
    const QRect box(int(rect.x() * scale()), int(rect.y() * scale()), int(rect.width() * scale()),
                    int(rect.height() * scale()));
    EXPECT_GT(box.width() * box.height(), 0);
    for (int y = box.top(); y <= box.bottom(); ++y)
      for (int x = box.left(); x <= box.right(); ++x) {
        const uint8_t* over = canvas.constScanLine(y - int(at.y() * scale())) + 4 * (x - int(at.x() * scale()));
        const int under[3] = {behind.red(), behind.green(), behind.blue()};
        const uint8_t* is = shown.constScanLine(y) + 4 * x;
        for (int c = 0; c < 3; ++c)
          worst = std::max(
              worst,
              std::abs(int(std::lround(over[c] * opacity + under[c] * (1 - over[3] / 255.0 * opacity))) - is[c]));
      }
    return worst;
  }
};

std::unique_ptr<Alone> QtQuick::reference;

size_t colours(const QImage& picture) {
  std::set<QRgb> all;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) all.insert(picture.pixel(x, y));
  return all.size();
}

// The whole item, over the window's colour; around it there is nothing.
TEST_F(QtQuick, ShowsWhatGpgpDrawsAlone) {
  show();
  const QImage shown = grab("alone");
  const QImage canvas = alone(0, pixels(kItem));
  EXPECT_GT(colours(canvas), 200u);
  EXPECT_LE(difference(shown, canvas, {item.position(), QSizeF(kItem)}, item.position(), kBehind), 1);
  EXPECT_EQ(shown.pixelColor(int(20 * scale()), int(100 * scale())), kBehind);
  EXPECT_EQ(shown.pixelColor(int(340 * scale()), int(100 * scale())), kBehind);
}

// An animation of QML's sets a property; a larger item has a picture of its own size.
TEST_F(QtQuick, FollowsTimeAndSize) {
  show();
  for (const auto& [time, size] : {std::pair{0.4f, kItem}, {0.4f, QSize(331, 173)}, {0.7f, QSize(120, 90)}}) {
    item.setTime(double(time));
    item.setSize(size);
    const QImage shown = grab("sized");
    EXPECT_LE(difference(shown, alone(time, pixels(size)), {item.position(), QSizeF(size)}, item.position(), kBehind),
              1)
        << time << " " << size.width();
  }
}

// What Qt has below is seen through the canvas, what it has above hides it; parents clip and fade it as a whole.
TEST_F(QtQuick, LiesInQtsOrder) {
  RectItem parent(window.contentItem(), {24, 16, 200, 120}, Qt::transparent);
  parent.setClip(true);
  parent.setOpacity(0.5);
  const RectItem below(window.contentItem(), {24, 16, 320, 90}, kAbove);
  parent.setZ(1);
  RectItem above(window.contentItem(), {100, 40, 50, 50}, kAbove);
  above.setZ(2);
  item.setParentItem(&parent);
  item.setPosition({0, 0});
  show();
  const QImage shown = grab("order");
  const QImage canvas = alone(0, pixels(kItem));
  const QPointF at(24, 16);
  EXPECT_LE(difference(shown, canvas, {24, 16, 70, 90}, at, kAbove, 0.5), 2);    // over the rectangle below
  EXPECT_LE(difference(shown, canvas, {24, 106, 200, 30}, at, kBehind, 0.5), 2); // beside it
  EXPECT_EQ(shown.pixelColor(int(125 * scale()), int(65 * scale())), kAbove);    // under the one above
  for (const QPointF outside : {QPointF(230, 120), QPointF(100, 150)})           // clipped
    EXPECT_EQ(shown.pixelColor(int(outside.x() * scale()), int(outside.y() * scale())), kBehind);
}

// Qt drops all that the window has on the device, and makes it again.
TEST_F(QtQuick, ComesBackAfterTheSceneGraphWasInvalidated) {
  window.setPersistentGraphics(false);
  window.setPersistentSceneGraph(false);
  show();
  const QImage first = grab("before");
  window.hide();
  EXPECT_TRUE(wait([&] { return invalidated == 1; }));
  show();
  EXPECT_EQ(grab("after"), first);
  EXPECT_LE(difference(first, alone(0, pixels(kItem)), {item.position(), QSizeF(kItem)}, item.position(), kBehind), 1);
}

// Items that find no room in a frame's recordings are drawn in later frames; items that go leave the others.
TEST_F(QtQuick, ManyItemsShareAWindow) {
  qt::WindowBudgets budgets;
  budgets.itemsPerFrame = 2;
  item.setParentItem(nullptr);
  QQuickWindow many;
  many.setVulkanInstance(&instance->get());
  many.setColor(kBehind);
  many.resize(360, 260);
  qt::setBudgets(many, budgets);
  std::vector<std::unique_ptr<DrawingItem>> items;
  for (int i = 0; i < 7; ++i) {
    items.push_back(std::make_unique<DrawingItem>(many.contentItem()));
    items.back()->options = options();
    items.back()->setPosition({10 + 90.0 * (i % 3), 10 + 80.0 * (i / 3)});
    items.back()->setSize({80, 60});
    items.back()->setTime(0.1 * i);
  }
  many.show();
  ASSERT_TRUE(wait([&] { return many.isExposed(); }));
  const auto check = [&] {
    for (int i = 0; i < 5; ++i) { // two items a frame
      QGuiApplication::processEvents();
      many.grabWindow();
    }
    const QImage shown = many.grabWindow().convertToFormat(QImage::Format_RGBA8888);
    for (const auto& each : items)
      EXPECT_LE(difference(shown, alone(static_cast<float>(each->time()), pixels({80, 60})),
                           {each->position(), QSizeF(80, 60)}, each->position(), kBehind),
                1)
          << each->time();
  };
  check();
  items.erase(items.begin(), items.begin() + 3);
  items.back()->setTime(0.95);
  check();
  many.destroy();
}

// What cannot be is said, and the picture stays.
TEST_F(QtQuick, SaysWhatFails) {
  show();
  const QImage first = grab("small");
  item.setSize({4000, 100});
  grabOnce();
  ASSERT_TRUE(wait([&] { return !failures.empty(); }));
  EXPECT_TRUE(failures[0].contains("pixels, the canvas of its window at most 2048 x 2048 (gpgp::qt::setBudgets)"))
      << failures[0].toStdString();
  failures.clear();
  item.setSize(kItem);
  EXPECT_EQ(grab("small again"), first);
  EXPECT_TRUE(failures.empty());

  DrawingItem broken(window.contentItem());
  broken.options = options();
  broken.options.svg = "/nowhere.svg";
  broken.setSize({50, 50});
  std::vector<QString> why;
  QObject::connect(&broken, &qt::CanvasItem::failed, &broken, [&](const QString& text) { why.push_back(text); });
  grabOnce();
  ASSERT_TRUE(wait([&] { return !why.empty(); }));
  EXPECT_TRUE(why[0].contains("/nowhere.svg")) << why[0].toStdString();
}

// Drawn inside the window's own pass, at two sizes.
TEST_F(QtQuick, AQVulkanWindowShowsTheSame) {
  std::string error;
  const sample::Options shown = options();
  sample::SampleWindow plain(shown, [&](const std::string& why) { error = why; });
  plain.setVulkanInstance(&instance->get());
  for (const QSize size : {QSize(320, 200), QSize(240, 250)}) {
    plain.resize(size);
    plain.show();
    ASSERT_TRUE(wait([&] {
      return !error.empty() || (plain.isExposed() && plain.isValid() && plain.swapChainImageSize() == pixels(size) &&
                                plain.renderer->frames > 4);
    }));
    ASSERT_EQ(error, "");
    plain.renderer->fixedTime = 0.3f;
    const QImage picture = plain.picture(), canvas = reference->draw(0.3f, pixels(size), sample::kSampleSky);
    ASSERT_EQ(picture.size(), canvas.size());
    EXPECT_GT(colours(picture), 200u);
    int worst = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const QRgb a = picture.pixel(x, y), b = canvas.pixel(x, y);
        worst = std::max(
            {worst, std::abs(qRed(a) - qRed(b)), std::abs(qGreen(a) - qGreen(b)), std::abs(qBlue(a) - qBlue(b))});
      }
    EXPECT_LE(worst, 2);
  }
  plain.destroy();
}

} // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QGuiApplication application(argc, argv);
  QQuickWindow::setGraphicsApi(QSGRendererInterface::Vulkan);
  sample::SampleInstance made(true);
  instance = &made;
  return RUN_ALL_TESTS();
}
