// The plugin: one device of Unity's, the objects that scripts have made, and what is recorded at an event.
#pragma once
#include "gpgp_glyph_cache.hpp"
#include "gpgp_unity.h"
#include "unity_api.h"

#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace gpgp::unity {

constexpr uint64_t kFramesInFlight = 4;
constexpr uint32_t kPictures = 64; ///< glyphs that are pictures, at a time

class Plugin {
public:
  /// deviceEvent: calls onDeviceEvent.
  Plugin(IUnityInterfaces& interfaces, IUnityGraphicsDeviceEventCallback deviceEvent);
  ~Plugin();
  Plugin(const Plugin&) = delete;
  Plugin& operator=(const Plugin&) = delete;

  void onDeviceEvent(UnityGfxDeviceEventType type); ///< render thread
  void onRenderEvent(int eventId, int32_t canvas);  ///< render thread, while Unity records

  // gpgp_unity.h, from any thread
  int32_t state();
  int32_t takeMessage(char* text, int32_t capacity);
  int32_t eventId() const { return eventId_; }
  int32_t setBudgets(const GpgpUnityBudgets& budgets);
  int32_t createDrawing(const void* data, size_t size, bool baked);
  int32_t createFont(const void* data, size_t size);
  int32_t setFallbacks(int32_t font, const int32_t* fallbacks, size_t count);
  int32_t createText(const GpgpUnityText& text);
  int32_t setText(int32_t object, const GpgpUnityText& text);
  int32_t getBox(int32_t object, float* box);
  int32_t createCanvas();
  int32_t setCanvas(int32_t object, const GpgpUnityCanvas& info);
  void destroy(int32_t object);

private:
  /// The state of a canvas as the script has set it last.
  struct Surface {
    void* texture = nullptr;
    uint32_t flags = 0;
    float background[4] = {};
    std::vector<GpgpUnityItem> items;
    std::string complaint; ///< said already
  };
  struct OpenFont {
    Font font;
    std::vector<int32_t> fallbacks;
  };
  struct Text {
    Layout layout;
    std::vector<int32_t> fonts; ///< that it was laid out in
  };
  struct View { ///< of a texture in a frame
    VkImageView view = VK_NULL_HANDLE;
    uint64_t frame = 0;
  };
  static void GPGP_CALL onMessage(void* user, const GpgpMessage* message);
  void say(const std::string& message);
  void complain(Surface& surface, const std::string& message);
  void start();
  void stop();
  GpgpResult makeCanvas();
  GpgpResult layOut(Text& to, const GpgpUnityText& text);
  bool advance(Surface& surface, const UnityVulkanRecordingState& state);
  void record(Surface& surface, const UnityVulkanRecordingState& state, const UnityVulkanImage& image);
  bool fillList(Surface& surface, float height);
  GpgpResult addText(const Text& text, uint32_t& dropped);
  void freeViews(uint64_t safe);
  template <class Function> Function load(const char* name) const {
    return reinterpret_cast<Function>(device_.getInstanceProcAddr(device_.instance, name));
  }

  IUnityInterfaces& interfaces_;
  const IUnityGraphicsDeviceEventCallback deviceEvent_;
  IUnityGraphics* graphics_ = nullptr;
  IUnityGraphicsVulkan* vulkan_ = nullptr;
  IUnityGraphicsVulkanV2* vulkan2_ = nullptr;
  int eventId_ = 0;

  std::mutex messageMutex_; // messages come while mutex_ is held
  std::deque<std::string> messages_;

  std::mutex mutex_; // what follows: gpgp's context is one thread's at a time
  int32_t state_ = GPGP_UNITY_OFF;
  UnityVulkanInstance device_{};
  PFN_vkDestroyImageView destroyImageView_ = nullptr;
  Context context_;
  GpgpUnityBudgets budgets_{};
  Canvas canvas_;
  bool reportedBudget_ = false;
  bool complained_ = false; ///< in the event at hand
  Shaper shaper_;
  integration::GlyphCache glyphs_;
  List list_;                      ///< of the canvas at hand
  integration::PlacedText placed_; ///< of the text at hand
  uint64_t frame_ = 0;
  std::vector<View> views_;
  int32_t nextObject_ = 1;
  std::map<int32_t, Drawing> drawings_;
  std::map<int32_t, OpenFont> fonts_;
  std::map<int32_t, Text> texts_;
  std::map<int32_t, Surface> surfaces_;
};

} // namespace gpgp::unity
