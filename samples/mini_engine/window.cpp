// Pictures go to a window of gpgp::sdl2.
#include "target.h"

#include <SDL_events.h>
#include <SDL_rect.h>
#include <SDL_video.h>

namespace mini {
namespace {

class Window : public Target {
public:
  Window(Device& device, gpgp::sdl2::Window& window, bool keepPictures)
      : device_(device), window_(window), swapchain_(device, window, {kMaxExtent}), keepPictures_(keepPictures) {}
  ~Window() override { destroyFramebuffers(); }
  VkFormat format() const override { return swapchain_.format(); }
  VkImageLayout finalLayout() const override { return VK_IMAGE_LAYOUT_PRESENT_SRC_KHR; }
  VkExtent2D extent() const override { return swapchain_.extent(); }

  void attach(Forward& forward) override {
    destroyFramebuffers();
    swapchain_.resize();
    forward.resize(swapchain_.extent());
    for (const auto& image : swapchain_.images()) framebuffers_.push_back(forward.makeFramebuffer(image.view));
    if (keepPictures_) picture_.emplace(device_, swapchain_);
  }

  std::optional<Acquired> acquire(uint32_t slot) override {
    acquired_ = swapchain_.acquire(slot);
    if (!acquired_) return std::nullopt;
    return Acquired{acquired_->index, framebuffers_[acquired_->index], acquired_->available,
                    swapchain_.images()[acquired_->index].rendered};
  }

  void present(const Acquired&) override { swapchain_.present(*acquired_); }

  bool pollEvents() override {
    return window_.pollEvents([this](const SDL_Event& event) {
      if (event.type == SDL_KEYDOWN) pressed(event.key.keysym.sym);
      if (event.type == SDL_MOUSEMOTION) moved(event.motion.x, event.motion.y);
      if (event.type == SDL_MOUSEBUTTONDOWN && event.button.button == SDL_BUTTON_LEFT) {
        moved(event.button.x, event.button.y);
        inputs_.push_back({Input::click});
      }
      if (event.type == SDL_MOUSEBUTTONUP && event.button.button == SDL_BUTTON_LEFT)
        inputs_.push_back({Input::release});
    });
  }
  void play(const std::vector<Input>& inputs) override {
    for (const Input& input : inputs) {
      SDL_Event event{};
      if (input.kind == Input::move) {
        event.type = SDL_MOUSEMOTION;
        pointer_ = windowPoint(input.x, input.y);
        event.motion.x = pointer_.x;
        event.motion.y = pointer_.y;
      } else if (input.kind == Input::click) {
        event.type = SDL_MOUSEBUTTONDOWN;
        event.button.button = SDL_BUTTON_LEFT;
        event.button.x = pointer_.x;
        event.button.y = pointer_.y;
      } else {
        event.type = SDL_KEYDOWN;
        SDL_Keycode& key = event.key.keysym.sym;
        key = SDLK_RETURN;
        if (input.kind == Input::key) key = input.character;
        if (input.kind == Input::up) key = SDLK_UP;
        if (input.kind == Input::down) key = SDLK_DOWN;
      }
      if (SDL_PushEvent(&event) != 1) throw std::runtime_error(std::string("no room for an event: ") + SDL_GetError());
    }
  }
  void keep(VkCommandBuffer commands, const Acquired& acquired) override {
    if (picture_) picture_->record(commands, acquired.index);
  }
  void writePicture(const std::string& file) override {
    if (picture_) writePng(file, extent(), picture_->rgba().data());
  }
  void setTitle(const std::string& title) override { SDL_SetWindowTitle(window_.handle(), title.c_str()); }

private:
  void pressed(SDL_Keycode key) {
    if (key == SDLK_UP)
      inputs_.push_back({Input::up});
    else if (key == SDLK_DOWN)
      inputs_.push_back({Input::down});
    else if (key == SDLK_RETURN || key == SDLK_KP_ENTER)
      inputs_.push_back({Input::enter});
    else if (key > 0 && key < 128)
      inputs_.push_back({Input::key, static_cast<char>(key)});
  }
  /// The window's own coordinates may be coarser than pixels.
  void moved(int x, int y) {
    const SDL_Point size = windowSize();
    inputs_.push_back(
        {Input::move, 0,
         (static_cast<float>(x) + 0.5f) * static_cast<float>(extent().width) / static_cast<float>(size.x),
         (static_cast<float>(y) + 0.5f) * static_cast<float>(extent().height) / static_cast<float>(size.y)});
  }
  SDL_Point windowPoint(float x, float y) const {
    const SDL_Point size = windowSize();
    return {static_cast<int>(x * static_cast<float>(size.x) / static_cast<float>(extent().width)),
            static_cast<int>(y * static_cast<float>(size.y) / static_cast<float>(extent().height))};
  }
  SDL_Point windowSize() const {
    SDL_Point size{1, 1};
    SDL_GetWindowSize(window_.handle(), &size.x, &size.y);
    return size;
  }
  void destroyFramebuffers() {
    for (VkFramebuffer framebuffer : framebuffers_) vkDestroyFramebuffer(device_.device, framebuffer, nullptr);
    framebuffers_.clear();
  }
  Device& device_;
  gpgp::sdl2::Window& window_;
  gpgp::sdl2::Swapchain swapchain_;
  std::vector<VkFramebuffer> framebuffers_;
  std::optional<gpgp::sdl2::Swapchain::Acquired> acquired_;
  const bool keepPictures_;
  std::optional<gpgp::sdl2::Screenshot> picture_;
  SDL_Point pointer_{}; // as it was played
};

} // namespace

std::unique_ptr<Target> makeWindow(Device& device, gpgp::sdl2::Window& window, bool keepPictures) {
  return std::make_unique<Window>(device, window, keepPictures);
}

} // namespace mini
