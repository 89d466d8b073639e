// The same as consumer.c through the C++ wrapper.
#include <gpgp/gpgp.hpp>

#include <cstdio>

int main() {
  const auto context = gpgp::Context::create(gpgp::init<GpgpContextCreateInfo>());
  if (context || *context || context.code() != GPGP_ERROR_INVALID_ARGUMENT) return 1;
  std::puts(context.name());
  return 0;
}
