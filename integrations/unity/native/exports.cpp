// What Unity and its scripts call. Unity's callbacks have no user data, so the plugin is the process's one.
#include "plugin.h"

#include <memory>
#include <new>

namespace {

std::unique_ptr<gpgp::unity::Plugin> plugin;

/// Nothing is thrown into Unity.
template <class Work> int32_t guarded(Work&& work) noexcept {
  if (!plugin) return GPGP_ERROR_INVALID_HANDLE;
  try {
    return work(*plugin);
  } catch (const std::bad_alloc&) {
    return GPGP_ERROR_OUT_OF_HOST_MEMORY;
  } catch (...) {
    return GPGP_ERROR_VULKAN;
  }
}

void UNITY_INTERFACE_API onDeviceEvent(UnityGfxDeviceEventType type) {
  guarded([&](auto& p) { return p.onDeviceEvent(type), GPGP_SUCCESS; });
}

void UNITY_INTERFACE_API onRenderEvent(int eventId, void* data) {
  const auto canvas = static_cast<int32_t>(reinterpret_cast<intptr_t>(data));
  guarded([&](auto& p) { return p.onRenderEvent(eventId, canvas), GPGP_SUCCESS; });
}

} // namespace

extern "C" {

UNITY_INTERFACE_EXPORT void UNITY_INTERFACE_API UnityPluginLoad(IUnityInterfaces* interfaces) {
  if (!interfaces || plugin) return; // a second time: it is there
  try {
    plugin = std::make_unique<gpgp::unity::Plugin>(*interfaces, onDeviceEvent);
  } catch (...) { // out of memory: the plugin stays off
  }
}

UNITY_INTERFACE_EXPORT void UNITY_INTERFACE_API UnityPluginUnload() { plugin.reset(); }

int32_t gpgpUnityGetState(void) { return plugin ? plugin->state() : GPGP_UNITY_OFF; }
int32_t gpgpUnityTakeMessage(char* text, int32_t capacity) { return plugin ? plugin->takeMessage(text, capacity) : 0; }
void* gpgpUnityGetEvent(void) { return reinterpret_cast<void*>(onRenderEvent); }
int32_t gpgpUnityGetEventId(void) { return plugin ? plugin->eventId() : 0; }

int32_t gpgpUnitySetBudgets(const GpgpUnityBudgets* budgets) {
  return guarded([&](auto& p) { return budgets ? p.setBudgets(*budgets) : GPGP_ERROR_INVALID_ARGUMENT; });
}
int32_t gpgpUnityCreateDrawing(const void* data, int32_t size, int32_t baked) {
  return guarded([&](auto& p) {
    return data && size > 0 ? p.createDrawing(data, static_cast<size_t>(size), baked != 0)
                            : GPGP_ERROR_INVALID_ARGUMENT;
  });
}
int32_t gpgpUnityGetBox(int32_t object, float* box) {
  return guarded([&](auto& p) { return p.getBox(object, box); });
}
int32_t gpgpUnityCreateFont(const void* data, int32_t size) {
  return guarded([&](auto& p) {
    return data && size > 0 ? p.createFont(data, static_cast<size_t>(size)) : GPGP_ERROR_INVALID_ARGUMENT;
  });
}
int32_t gpgpUnitySetFallbacks(int32_t font, const int32_t* fallbacks, int32_t count) {
  return guarded([&](auto& p) {
    return count >= 0 && (fallbacks || count == 0) ? p.setFallbacks(font, fallbacks, static_cast<size_t>(count))
                                                   : GPGP_ERROR_INVALID_ARGUMENT;
  });
}
int32_t gpgpUnityCreateText(const GpgpUnityText* text) {
  return guarded([&](auto& p) { return text ? p.createText(*text) : GPGP_ERROR_INVALID_ARGUMENT; });
}
int32_t gpgpUnitySetText(int32_t object, const GpgpUnityText* text) {
  return guarded([&](auto& p) { return text ? p.setText(object, *text) : GPGP_ERROR_INVALID_ARGUMENT; });
}
int32_t gpgpUnityCreateCanvas(void) {
  return guarded([](auto& p) { return p.createCanvas(); });
}
int32_t gpgpUnitySetCanvas(int32_t canvas, const GpgpUnityCanvas* info) {
  return guarded([&](auto& p) { return info ? p.setCanvas(canvas, *info) : GPGP_ERROR_INVALID_ARGUMENT; });
}
void gpgpUnityDestroy(int32_t object) {
  if (plugin) plugin->destroy(object);
}
}
