// A window that shows finished pictures; without SDL2 it cannot be made.
#pragma once
#include "display.h"

#ifdef GPGP_SDL2_WINDOW
#include <SDL.h>
#endif

namespace streaming {

class Window {
public:
#ifdef GPGP_SDL2_WINDOW
  Window(const char* title, uint32_t width, uint32_t height) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) throw std::runtime_error(SDL_GetError());
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    window_ = SDL_CreateWindow(title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, w, h, 0);
    if (window_) renderer_ = SDL_CreateRenderer(window_, -1, 0);
    if (renderer_) texture_ = SDL_CreateTexture(renderer_, SDL_PIXELFORMAT_ABGR8888, SDL_TEXTUREACCESS_STREAMING, w, h);
    if (!texture_) throw std::runtime_error(SDL_GetError());
  }
  ~Window() { SDL_Quit(); } // and all of its windows
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  /// False: the person wants to end.
  bool show(const Picture& picture) {
    SDL_UpdateTexture(texture_, nullptr, picture.pixels.data(), static_cast<int>(picture.width * 4));
    SDL_RenderCopy(renderer_, texture_, nullptr, nullptr);
    SDL_RenderPresent(renderer_);
    SDL_Event event;
    while (SDL_PollEvent(&event))
      if (event.type == SDL_QUIT || (event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE)) return false;
    return true;
  }

private:
  SDL_Window* window_ = nullptr;
  SDL_Renderer* renderer_ = nullptr;
  SDL_Texture* texture_ = nullptr;
#else
  Window(const char*, uint32_t, uint32_t) { throw std::runtime_error("built without SDL2; there is no window"); }
  bool show(const Picture&) { return true; }
#endif
};

} // namespace streaming
