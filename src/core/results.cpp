// Version and result names.
#include <gpgp/core.h>

uint32_t GPGP_CALL gpgpGetVersion(void) { return GPGP_VERSION; }

const char* GPGP_CALL gpgpResultString(GpgpResult result) {
  switch (result) {
#define GPGP_NAME(value)                                                                                               \
  case value: return #value
    GPGP_NAME(GPGP_SUCCESS);
    GPGP_NAME(GPGP_NOT_READY);
    GPGP_NAME(GPGP_BUDGET_EXCEEDED);
    GPGP_NAME(GPGP_NOT_EXECUTED);
    GPGP_NAME(GPGP_INCOMPLETE);
    GPGP_NAME(GPGP_CANCELLED);
    GPGP_NAME(GPGP_ERROR_INVALID_ARGUMENT);
    GPGP_NAME(GPGP_ERROR_INVALID_STRUCT);
    GPGP_NAME(GPGP_ERROR_INVALID_HANDLE);
    GPGP_NAME(GPGP_ERROR_MISSING_FEATURE);
    GPGP_NAME(GPGP_ERROR_OUT_OF_HOST_MEMORY);
    GPGP_NAME(GPGP_ERROR_OUT_OF_DEVICE_MEMORY);
    GPGP_NAME(GPGP_ERROR_DEVICE_LOST);
    GPGP_NAME(GPGP_ERROR_TOO_MANY_RECORDINGS);
    GPGP_NAME(GPGP_ERROR_INVALID_DATA);
    GPGP_NAME(GPGP_ERROR_UNSUPPORTED);
    GPGP_NAME(GPGP_ERROR_IO);
    GPGP_NAME(GPGP_ERROR_VULKAN);
#undef GPGP_NAME
  default: return "GPGP_UNKNOWN";
  }
}
