/* The plugin's functions without a device, for the package's scripts: every object can be made, and the box of any is
 * what the last canvas was told: its texture's number, its items, the opacity of the last, the background's alpha. */
#include "gpgp_unity.h"

static int32_t objects;
static float told[4];

int32_t gpgpUnityGetState(void) { return GPGP_UNITY_READY; }
int32_t gpgpUnityTakeMessage(char* text, int32_t capacity) {
  if (capacity > 0) text[0] = 0;
  return 0;
}
void* gpgpUnityGetEvent(void) { return told; }
int32_t gpgpUnityGetEventId(void) { return 1; }
int32_t gpgpUnityCreateDrawing(const void* data, int32_t size, int32_t baked) {
  (void)data, (void)size, (void)baked;
  return ++objects;
}
int32_t gpgpUnityGetBox(int32_t object, float* box) {
  for (int i = 0; i < 4; ++i) box[i] = told[i];
  return object > 0 ? 0 : -1;
}
int32_t gpgpUnityCreateCanvas(void) { return ++objects; }
int32_t gpgpUnitySetCanvas(int32_t canvas, const GpgpUnityCanvas* info) {
  told[0] = (float)(intptr_t)info->texture;
  told[1] = (float)info->itemCount;
  told[2] = info->itemCount ? info->items[info->itemCount - 1].opacity : 0;
  told[3] = info->background[3];
  return canvas > 0 ? 0 : -1;
}
void gpgpUnityDestroy(int32_t object) { (void)object; }
