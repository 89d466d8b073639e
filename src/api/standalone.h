// The C functions of libraries that have no context: handles, messages to those who made the object, and arrays that
// are filled as far as there is room.
#pragma once
#include "api/deliver.h"
#include "core/host_memory.h"
#include "core/result.h"

#include <gpgp/core.h>

#include <algorithm>
#include <new>
#include <utility>

namespace gpgp::api::standalone {
using api::deliver;

/// Who gets the message of a call.
struct Receiver {
  GpgpMessageFn messageFn = nullptr;
  void* userData = nullptr;
  const char* label = "";

  void tell(const char* function, const core::Error& error) const {
    const GpgpMessage message{GPGP_SEVERITY_ERROR, error.code, function, label, error.text};
    if (messageFn) messageFn(userData, &message);
  }
};

/// Runs body() -> core::Result<void>; errors become a message and a result, nothing is thrown past the ABI. An error
/// without a text has had its messages.
template <class To, class Body> GpgpResult guarded(const char* function, const To& to, Body&& body) noexcept {
  const auto finish = [&](const core::Error& error) {
    if (error.code < 0 && error.text[0]) to.tell(function, error);
    return error.code;
  };
  try {
    const core::Result<void> result = body();
    return result ? GPGP_SUCCESS : finish(result.error());
  } catch (...) {
    return finish(core::makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of host memory"));
  }
}

inline core::Error invalid(const char* what) { return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s", what); }

template <class Object, class Handle> Object* objectOf(Handle handle) {
  auto* object = reinterpret_cast<Object*>(handle);
  return object && object->magic == Object::kMagic ? object : nullptr;
}
inline core::Error notA(const char* name, const char* kind) {
  return core::makeError(GPGP_ERROR_INVALID_HANDLE, "%s is NULL or destroyed; expected %s", name, kind);
}

/// Objects lie in memory of the callbacks, too.
template <class Object, class... Args> Object* make(core::HostMemory& memory, Args&&... args) {
  void* storage = memory.allocate(sizeof(Object), alignof(Object));
  try {
    return new (storage) Object(std::forward<Args>(args)...);
  } catch (...) {
    memory.deallocate(storage, sizeof(Object), alignof(Object));
    throw;
  }
}
template <class Object> void destroy(core::HostMemory& memory, Object* object) {
  object->magic = 0;
  object->~Object();
  memory.deallocate(object, sizeof(Object), alignof(Object));
}

} // namespace gpgp::api::standalone
