/* What a program that only just found gpgp can do: ask the library for its version, and get a clear error from a call
 * without a device. Also proves that header and library belong together. */
#include <gpgp/gpgp.h>

#include <stdio.h>
#include <string.h>

#ifdef CONSUMER_OF_TEXT_ALONE
/* A tool that only sets text links libgpgp_text and nothing else. */
int main(void) {
  GpgpShaperCreateInfo text = GPGP_SHAPER_CREATE_INFO_INIT;
  GpgpShaper shaper = NULL;
  const GpgpResult result = gpgpCreateShaper(&text, &shaper);
  printf("%s\n", gpgpResultString(result));
  gpgpDestroyShaper(shaper);
  return result == GPGP_SUCCESS ? 0 : 4;
}
#else
int main(void) {
  GpgpContextCreateInfo info = GPGP_CONTEXT_CREATE_INFO_INIT;
  GpgpContext context = NULL;
  const GpgpResult result = gpgpCreateContext(&info, &context);
#ifdef CONSUMER_USES_COMPILER
  GpgpBlob blob = {NULL, 0};
  gpgpFreeBlob(&blob);
#endif
#ifdef CONSUMER_USES_TEXT
  GpgpShaperCreateInfo text = GPGP_SHAPER_CREATE_INFO_INIT;
  GpgpShaper shaper = NULL;
  if (gpgpCreateShaper(&text, &shaper) != GPGP_SUCCESS) return 4;
  gpgpDestroyShaper(shaper);
#endif
  if (gpgpGetVersion() != GPGP_VERSION) return 1;
  if (result != GPGP_ERROR_INVALID_ARGUMENT || context) return 2;
  if (strcmp(gpgpResultString(result), "GPGP_ERROR_INVALID_ARGUMENT") != 0) return 3;
  printf("gpgp %u.%u\n", (unsigned)(gpgpGetVersion() >> 22), (unsigned)(gpgpGetVersion() >> 12 & 1023));
  return 0;
}
#endif
