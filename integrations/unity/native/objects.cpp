// What scripts make: drawings, fonts, texts and canvases by their numbers.
#include "plugin.h"

#include <algorithm>
#include <cstring>

namespace gpgp::unity {

int32_t Plugin::state() {
  const std::scoped_lock lock(mutex_);
  return state_;
}

int32_t Plugin::takeMessage(char* text, int32_t capacity) {
  const std::scoped_lock lock(messageMutex_);
  if (messages_.empty() || !text || capacity < 1) return 0;
  const std::string message = std::move(messages_.front());
  messages_.pop_front();
  const size_t fits = std::min(message.size(), static_cast<size_t>(capacity) - 1);
  std::memcpy(text, message.data(), fits);
  text[fits] = 0;
  return static_cast<int32_t>(message.size());
}

int32_t Plugin::setBudgets(const GpgpUnityBudgets& budgets) {
  const std::scoped_lock lock(mutex_);
  const GpgpUnityBudgets before = budgets_;
  budgets_ = budgets;
  if (state_ != GPGP_UNITY_READY) return GPGP_SUCCESS; // those that the device begins with
  const GpgpResult result = makeCanvas();
  if (result < 0) budgets_ = before;
  return result;
}

int32_t Plugin::createDrawing(const void* data, size_t size, bool baked) {
  Blob blob;
  if (!baked) { // without the lock: it may take a while
    auto source = init<GpgpSvgSource>();
    source.name = "SVG";
    source.data = data;
    source.size = size;
    source.messageFn = onMessage;
    source.messageUserData = this;
    Result<Blob> compiled = compileSvg(source);
    if (!compiled) return compiled.code();
    blob = *std::move(compiled);
  }
  const std::scoped_lock lock(mutex_);
  if (state_ != GPGP_UNITY_READY) return GPGP_ERROR_INVALID_HANDLE;
  auto info = init<GpgpDrawingCreateInfo>();
  info.label = "drawing";
  info.data = baked ? data : blob.data();
  info.size = baked ? size : blob.size();
  Result<Drawing> made = Drawing::create(context_, info);
  if (!made) return made.code();
  drawings_.emplace(nextObject_, *std::move(made));
  return nextObject_++;
}

int32_t Plugin::createFont(const void* data, size_t size) {
  auto info = init<GpgpFontCreateInfo>();
  info.label = "font";
  info.data = data;
  info.size = size;
  info.messageFn = onMessage;
  info.messageUserData = this;
  Result<Font> made = Font::create(info);
  if (!made) return made.code();
  const std::scoped_lock lock(mutex_);
  fonts_.emplace(nextObject_, OpenFont{*std::move(made), {}});
  return nextObject_++;
}

int32_t Plugin::setFallbacks(int32_t font, const int32_t* fallbacks, size_t count) {
  const std::scoped_lock lock(mutex_);
  const auto found = fonts_.find(font);
  if (found == fonts_.end()) return GPGP_ERROR_INVALID_HANDLE;
  for (size_t i = 0; i < count; ++i)
    if (!fonts_.count(fallbacks[i])) {
      say("fallback " + std::to_string(i) + " is no font, or has been destroyed");
      return GPGP_ERROR_INVALID_HANDLE;
    }
  found->second.fallbacks.assign(fallbacks, fallbacks + count);
  return GPGP_SUCCESS;
}

GpgpResult Plugin::layOut(Text& to, const GpgpUnityText& text) {
  if (!fonts_.count(text.font)) {
    say("a text's font is none, or has been destroyed");
    return GPGP_ERROR_INVALID_HANDLE;
  }
  if ((!text.text && text.size > 0) || text.size < 0) return GPGP_ERROR_INVALID_ARGUMENT;
  std::vector<int32_t> numbers{text.font};
  for (const int32_t fallback : fonts_.at(text.font).fallbacks)
    if (fonts_.count(fallback)) numbers.push_back(fallback);
  std::vector<GpgpFont> fonts;
  fonts.reserve(numbers.size());
  for (const int32_t number : numbers) fonts.push_back(fonts_.at(number).font);
  auto info = init<GpgpTextInfo>();
  info.text = text.text ? text.text : "";
  info.size = static_cast<size_t>(text.size);
  info.style.fonts = fonts.data();
  info.style.fontCount = static_cast<uint32_t>(fonts.size());
  info.style.size = text.pixels;
  std::copy_n(text.color, 4, info.style.color);
  info.width = text.width;
  info.align = text.align;
  const GpgpResult result = to.layout.set(info); // errors are messages already
  if (result >= 0) to.fonts = std::move(numbers);
  return result;
}

int32_t Plugin::createText(const GpgpUnityText& text) {
  const std::scoped_lock lock(mutex_);
  if (!shaper_) return GPGP_ERROR_INVALID_HANDLE;
  Result<Layout> layout = shaper_.layout();
  if (!layout) return layout.code();
  Text made;
  made.layout = *std::move(layout);
  if (const GpgpResult result = layOut(made, text); result < 0) return result;
  texts_.emplace(nextObject_, std::move(made));
  return nextObject_++;
}

int32_t Plugin::setText(int32_t object, const GpgpUnityText& text) {
  const std::scoped_lock lock(mutex_);
  const auto found = texts_.find(object);
  return found == texts_.end() ? GPGP_ERROR_INVALID_HANDLE : layOut(found->second, text);
}

int32_t Plugin::getBox(int32_t object, float* box) {
  const std::scoped_lock lock(mutex_);
  if (!box) return GPGP_ERROR_INVALID_ARGUMENT;
  if (const auto drawing = drawings_.find(object); drawing != drawings_.end()) {
    const Result<GpgpDrawingInfo> info = drawing->second.info();
    if (info) std::copy_n(info->viewport, 4, box);
    return info.code();
  }
  if (const auto text = texts_.find(object); text != texts_.end()) {
    const Result<GpgpLayoutInfo> info = text->second.layout.info();
    if (!info) return info.code();
    const auto lines = integration::linesBox(*info);
    const float size[4] = {lines[0], 0, lines[2] - lines[0], lines[3]};
    std::copy_n(size, 4, box);
    return GPGP_SUCCESS;
  }
  return GPGP_ERROR_INVALID_HANDLE;
}

int32_t Plugin::createCanvas() {
  const std::scoped_lock lock(mutex_);
  surfaces_.try_emplace(nextObject_);
  return nextObject_++;
}

int32_t Plugin::setCanvas(int32_t object, const GpgpUnityCanvas& info) {
  const std::scoped_lock lock(mutex_);
  const auto found = surfaces_.find(object);
  if (found == surfaces_.end()) return GPGP_ERROR_INVALID_HANDLE;
  if (info.itemCount < 0 || (info.itemCount > 0 && !info.items)) return GPGP_ERROR_INVALID_ARGUMENT;
  Surface& surface = found->second;
  surface.texture = info.texture;
  surface.flags = info.flags;
  std::copy_n(info.background, 4, surface.background);
  surface.items.assign(info.items, info.items + info.itemCount);
  return GPGP_SUCCESS;
}

void Plugin::destroy(int32_t object) {
  const std::scoped_lock lock(mutex_);
  if (const auto font = fonts_.find(object); font != fonts_.end()) {
    glyphs_.forget(font->second.font);
    fonts_.erase(font);
  }
  drawings_.erase(object);
  texts_.erase(object);
  surfaces_.erase(object);
}

} // namespace gpgp::unity
