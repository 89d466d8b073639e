#include "window_state.h"

#include <QtQuick/QSGRendererInterface>
#include <QtQuick/QSGTexture>

#include <algorithm>
#include <exception>

namespace gpgp::qt {
namespace {

/// The family of the queue that Qt draws on. Qt does not tell: it is the first with graphics that can present to the
/// window, unless the program has made the device. `queue` proves it.
bool findFamily(QVulkanInstance& instance, VkPhysicalDevice physical, VkDevice device, VkQueue queue, QWindow& window,
                uint32_t& family, VkQueueFlags& flags) {
  uint32_t count = 0;
  instance.functions()->vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  instance.functions()->vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (uint32_t i = 0; i < count; ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) || !instance.supportsPresent(physical, i, &window)) continue;
    VkQueue first = VK_NULL_HANDLE;
    instance.deviceFunctions(device)->vkGetDeviceQueue(device, i, 0, &first);
    family = i;
    flags = families[i].queueFlags;
    return first == queue;
  }
  return false;
}

} // namespace

WindowState& WindowState::of(QQuickWindow& window) {
  if (auto* found = window.findChild<WindowState*>(QString(), Qt::FindDirectChildrenOnly)) return *found;
  return *new WindowState(window); // the window's
}

WindowState::WindowState(QQuickWindow& window) : QObject(&window), window_(window) {
  connect(
      &window, &QQuickWindow::beforeRendering, this, [this] { beforeRendering(); }, Qt::DirectConnection);
  connect(
      &window, &QQuickWindow::sceneGraphInvalidated, this, [this] { sceneGraphInvalidated(); }, Qt::DirectConnection);
}

WindowState::~WindowState() = default; // the scene graph was invalidated before

void WindowState::onMessage(void* user, const GpgpMessage* message) {
  const QString text =
      QStringLiteral("%1: %2").arg(QString::fromUtf8(message->function), QString::fromUtf8(message->text));
  if (message->severity == GPGP_SEVERITY_ERROR)
    static_cast<WindowState*>(user)->message_ = text;
  else
    qWarning("gpgp: %s", qPrintable(text));
}

bool WindowState::findDevice(QString& why) {
  const QSGRendererInterface* renderer = window_.rendererInterface();
  if (renderer->graphicsApi() != QSGRendererInterface::Vulkan) {
    why = QStringLiteral("Qt Quick does not draw with Vulkan: call "
                         "QQuickWindow::setGraphicsApi(QSGRendererInterface::Vulkan) first");
    return false;
  }
  instance_ = window_.vulkanInstance();
  const auto get = [&](QSGRendererInterface::Resource resource) { return renderer->getResource(&window_, resource); };
  const auto* physical = static_cast<VkPhysicalDevice*>(get(QSGRendererInterface::PhysicalDeviceResource));
  const auto* device = static_cast<VkDevice*>(get(QSGRendererInterface::DeviceResource));
  const auto* queue = static_cast<VkQueue*>(get(QSGRendererInterface::CommandQueueResource));
  if (!instance_ || !physical || !device || !queue) {
    why = QStringLiteral("the window has no Vulkan device");
    return false;
  }
  physical_ = *physical;
  device_ = *device;
  VkQueueFlags flags = 0;
  if (!findFamily(*instance_, physical_, device_, *queue, window_, family_, flags)) {
    why = QStringLiteral("the family of Qt's queue is unknown: it is not the first that can draw to this window");
    return false;
  }
  if (!(flags & VK_QUEUE_COMPUTE_BIT)) {
    why = QStringLiteral("Qt's queue cannot compute");
    return false;
  }
  return true;
}

bool WindowState::begin(QString& why) {
  if (context_) return true;
  if (!findDevice(why)) return false;
  message_.clear();
  GpgpContextCreateInfo info = contextInfo(*instance_, physical_, device_);
  info.label = "Qt Quick";
  info.maxFramesInFlight = static_cast<uint32_t>(window_.graphicsStateInfo().framesInFlight);
  info.maxRecordingsPerFrame = budgets_.itemsPerFrame;
  info.messageFn = onMessage;
  info.messageUserData = this;
  auto context = Context::create(info);
  GpgpResult code = context.code();
  if (code == GPGP_SUCCESS) {
    context_ = *std::move(context);
    GpgpCanvasCreateInfo canvasInfo = budgets_.canvas;
    if (!canvasInfo.base.label) canvasInfo.base.label = "Qt Quick";
    canvasInfo.base.queueFamily = family_;
    canvasInfo.base.queueFlags = 0;
    canvasInfo.targets = GPGP_CANVAS_TARGET_RGBA8;
    auto canvas = Canvas::create(context_, canvasInfo);
    code = canvas.code();
    if (code == GPGP_SUCCESS) {
      canvas_ = *std::move(canvas);
      code = canvas_.prewarm();
    }
  }
  if (code >= 0) return true;
  why = message_.isEmpty() ? QString::fromUtf8(gpgpResultString(code)) : message_;
  canvas_.reset();
  context_.reset();
  return false;
}

QSize WindowState::maxSize() const {
  const auto side = [](uint32_t asked) { return static_cast<int>(asked ? asked : 2048); };
  return {side(budgets_.canvas.maxWidth), side(budgets_.canvas.maxHeight)};
}

VkResult WindowState::makePicture(QSize size, Picture& picture) {
  return picture.create(*instance_, physical_, device_, size);
}

void WindowState::retire(Picture picture) {
  // Qt destroys its view of the image some frames later.
  if (picture.image()) retired_.push_back({picture, frame_.current + 1});
}

void WindowState::fail(const QPointer<CanvasItem>& item, const QString& why) {
  QMetaObject::invokeMethod(
      this,
      [item, why] {
        if (item) Q_EMIT item->failed(why);
      },
      Qt::QueuedConnection);
}

void WindowState::takeReports() {
  for (auto report = canvas_.report(); report; report = canvas_.report())
    if (report->base.status < 0 || report->base.status == GPGP_BUDGET_EXCEEDED)
      qWarning("gpgp: a canvas of Qt Quick: %s, %u of %u paths were left out (gpgp::qt::setBudgets)",
               gpgpResultString(report->base.status), report->pathsDropped, report->paths);
}

// Qt has waited for the frame that used this frame's slot, and records the next command buffer.
void WindowState::beforeRendering() {
  if (!context_) return;
  const auto inFlight = static_cast<uint64_t>(window_.graphicsStateInfo().framesInFlight);
  ++frame_.current;
  if (frame_.current > inFlight) frame_.safe = std::max(frame_.safe, frame_.current - inFlight);
  const GpgpResult advanced = context_.advance(frame_);
  for (Retired& retired : retired_)
    if (retired.frame < frame_.safe) retired.picture.destroy();
  std::erase_if(retired_, [](const Retired& retired) { return !retired.picture.image(); });
  takeReports();
  std::vector<CanvasNode*> drawn;
  bool fresh = false; // pictures that Qt samples, though nothing has been drawn yet
  for (CanvasNode* node : nodes_) {
    if (node->dirty && drawn.size() < budgets_.itemsPerFrame) drawn.push_back(node);
    fresh |= !node->picture().cleared();
  }
  // Those that wait are first in the next frame.
  if (drawn.size() == budgets_.itemsPerFrame)
    std::rotate(nodes_.begin(), std::find(nodes_.begin(), nodes_.end(), drawn.back()) + 1, nodes_.end());
  if (drawn.empty() && !fresh) return;

  window_.beginExternalCommands();
  const auto* resource = static_cast<VkCommandBuffer*>(
      window_.rendererInterface()->getResource(&window_, QSGRendererInterface::CommandListResource));
  const VkCommandBuffer commands = resource ? *resource : VK_NULL_HANDLE;
  GpgpResult code = advanced;
  if (code >= 0 && !commands) code = GPGP_ERROR_INVALID_ARGUMENT;
  if (commands)
    for (CanvasNode* node : nodes_) node->picture().recordClear(commands);
  bool more = false;
  std::vector<CanvasNode*> filled;
  for (CanvasNode* node : drawn) {
    node->dirty = false;
    if (code < 0) continue;
    node->contents = {};
    try {
      node->renderer().render({commands, frame_, node->size(), node->scale()}, node->contents);
      filled.push_back(node);
    } catch (const std::exception& error) {
      fail(node->item, QString::fromUtf8(error.what()));
    }
  }
  if (code >= 0) code = context_.recordUpload(commands, frame_).code();
  for (CanvasNode* node : filled) {
    if (code < 0) break;
    const CanvasContents& contents = node->contents;
    auto info = init<GpgpCanvasInfo>();
    info.width = static_cast<uint32_t>(node->size().width());
    info.height = static_cast<uint32_t>(node->size().height());
    info.items = contents.items.data();
    info.itemCount = static_cast<uint32_t>(contents.items.size());
    info.images = contents.images.data();
    info.imageCount = static_cast<uint32_t>(contents.images.size());
    std::copy_n(contents.background, 4, info.background);
    info.exactArea = contents.exactArea ? VK_TRUE : VK_FALSE;
    info.blendSrgb = info.encodeSrgb = VK_TRUE; // as all of Qt Quick is
    info.target = node->picture().target();
    const GpgpResult result = canvas_.recordPrepare(commands, frame_, info);
    if (result < 0) fail(node->item, message_);
    node->dirty = contents.again || result == GPGP_NOT_READY;
  }
  if (code < 0)
    for (CanvasNode* node : drawn)
      fail(node->item, message_.isEmpty() ? QString::fromUtf8(gpgpResultString(code)) : message_);
  window_.endExternalCommands();
  for (CanvasNode* node : nodes_) more |= node->dirty;
  if (more) window_.update();
}

// The nodes are gone; the device still lives.
void WindowState::sceneGraphInvalidated() {
  if (!context_) return;
  if (instance_->deviceFunctions(device_)->vkDeviceWaitIdle(device_) == VK_ERROR_DEVICE_LOST)
    context_.notifyDeviceLost();
  for (Retired& retired : retired_) retired.picture.destroy();
  retired_.clear();
  canvas_.reset();
  context_.reset();
  frame_ = {};
}

CanvasNode::CanvasNode(WindowState& state, std::unique_ptr<CanvasRenderer> renderer)
    : state_(state), renderer_(std::move(renderer)) {
  state_.add(this);
}

CanvasNode::~CanvasNode() {
  state_.remove(this);
  renderer_.reset();
  state_.retire(picture_);
}

bool CanvasNode::setSize(QSizeF units, qreal scale, QString& why) {
  const QSize pixels(static_cast<int>(std::ceil(units.width() * scale)),
                     static_cast<int>(std::ceil(units.height() * scale)));
  if (pixels != picture_.size()) {
    const QSize most = state_.maxSize();
    if (pixels.width() > most.width() || pixels.height() > most.height()) {
      why =
          QStringLiteral("the item has %1 x %2 pixels, the canvas of its window at most %3 x %4 (gpgp::qt::setBudgets)")
              .arg(pixels.width())
              .arg(pixels.height())
              .arg(most.width())
              .arg(most.height());
      return false;
    }
    Picture made;
    if (const VkResult result = state_.makePicture(pixels, made); result != VK_SUCCESS) {
      why = QStringLiteral("no image of %1 x %2 pixels: VkResult %3")
                .arg(pixels.width())
                .arg(pixels.height())
                .arg(result);
      return false;
    }
    state_.retire(picture_);
    picture_ = made;
    std::unique_ptr<QSGTexture> texture(
        QNativeInterface::QSGVulkanTexture::fromNative(made.image(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                       &state_.window(), pixels, QQuickWindow::TextureHasAlphaChannel));
    if (!image_) {
      image_ = state_.window().createImageNode();
      image_->setFlag(QSGNode::OwnedByParent);
      image_->setFiltering(QSGTexture::Linear);
    }
    image_->setTexture(texture.get());
    texture_ = std::move(texture); // the old one goes now
    if (!image_->parent()) appendChildNode(image_);
  }
  scale_ = scale;
  image_->setRect(QRectF(0, 0, pixels.width() / scale, pixels.height() / scale));
  return true;
}

} // namespace gpgp::qt
