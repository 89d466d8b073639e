// What all compilers of libgpgp_compiler share.
#include <gpgp/core.h>

#include <cstdlib>

void GPGP_CALL gpgpFreeBlob(GpgpBlob* blob) {
  if (!blob) return;
  std::free(blob->data);
  *blob = GpgpBlob{};
}
