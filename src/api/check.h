// What every C function does around its call into a service: resolve handles, check struct types, translate errors
// and exceptions into a result and one message.
#pragma once
#include "api/check_struct.h"
#include "core/context.h"
#include "core/recorder.h"
#include "core/resident.h"

#include <cmath>
#include <span>
#include <vector>

namespace gpgp::api {

using core::Context;
using core::Error;
using core::Kind;
using core::makeError;
using core::Result;

/// What a call is about, for its message. Context and label are filled in as they become known.
struct Call {
  const char* function;
  const Context* context = nullptr;
  const char* label = "";
};

inline GpgpResult finish(const Call& call, const Error& error) {
  // A negative code is an error; a positive one (NOT_READY, INCOMPLETE) is a status that engines poll.
  if (error.code < 0 && call.context)
    call.context->message(GPGP_SEVERITY_ERROR, error.code, call.function, call.label, error.text);
  // NOT_READY has several causes, each of which is said once.
  if (error.code == GPGP_NOT_READY && error.text[0] && call.context &&
      call.context->isNew({call.function, call.label, error.text}))
    call.context->message(GPGP_SEVERITY_INFO, error.code, call.function, call.label, error.text);
  return error.code;
}

/// Runs body(call) -> Result<void>, at the edge of the C ABI: nothing is thrown past it.
template <class Body> GpgpResult guarded(const char* function, Body&& body) noexcept {
  Call call{function};
  try {
    const Result<void> result = body(call);
    return result ? GPGP_SUCCESS : finish(call, result.error());
  } catch (const std::bad_alloc&) {
    return finish(call, makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "the host allocator returned NULL"));
  } catch (...) {
    return finish(call, makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of host memory"));
  }
}

/// A context handle, checked as far as that is possible.
inline Result<Context*> resolve(Call& call, GpgpContext handle) {
  Context* context = reinterpret_cast<Context*>(handle);
  if (!context || context->magic != Context::kMagic)
    return makeError(GPGP_ERROR_INVALID_HANDLE, "context is not a GpgpContext");
  call.context = context;
  call.label = context->label.text;
  return context;
}

/// The object behind an asset, recorder or history handle, null for NULL and destroyed handles. Where `context` is
/// still null it receives the handle's, also of a destroyed one: it gets the message.
template <class Handle> core::Object* objectOf(Handle handle, const Context** context) {
  const uintptr_t bits = reinterpret_cast<uintptr_t>(handle);
  core::Slot* slot = reinterpret_cast<core::Slot*>(bits & ~uintptr_t(alignof(core::Slot) - 1));
  if (!slot || slot->magic != core::Slot::kMagic) return nullptr;
  if (!*context) *context = slot->context;
  if (!slot->object) return nullptr;
  return slot->generation == (bits & (alignof(core::Slot) - 1)) ? slot->object : nullptr;
}
template <class Handle> Handle handleOf(const core::Slot* slot) {
  return reinterpret_cast<Handle>(reinterpret_cast<uintptr_t>(slot) | slot->generation);
}

/// A handle that must be of a kind (and, where given, of a context). `name` is the argument's name for the message.
template <class T, class Handle>
Result<T*> resolve(Call& call, Handle handle, Kind kind, const char* name, const Context* context = nullptr) {
  core::Object* object = objectOf(handle, &call.context);
  if (!object)
    return makeError(GPGP_ERROR_INVALID_HANDLE, "%s is %s; expected a %s", name, handle ? "destroyed" : "NULL",
                     core::kindName(kind));
  if (!call.label[0]) call.label = object->name();
  if (object->kind != kind)
    return makeError(GPGP_ERROR_INVALID_HANDLE, "%s is a %s; expected a %s", name, core::kindName(object->kind),
                     core::kindName(kind));
  if (context && &object->context != context)
    return makeError(GPGP_ERROR_INVALID_HANDLE, "%s belongs to another context", name);
  return static_cast<T*>(object);
}

/// The common beginning of every recording function, after the recorder was resolved.
inline Result<void> checkRecord(const core::Recorder& recorder, const GpgpFrame* frame) {
  if (auto ok = recorder.context.checkAlive(); !ok) return ok;
  if (auto ok = recorder.context.checkFrame(frame); !ok) return ok;
  if (!recorder.ready()) return makeError(GPGP_NOT_READY, "call gpgpPrewarm first");
  return {};
}

/// Engines poll for reports: that there is none has no message.
inline Error noReport() {
  Error none;
  none.code = GPGP_NOT_READY;
  return none;
}

template <class T> bool allFinite(const T& values) {
  for (const float value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

/// Bytes that a create info gives as data or as a file.
struct GivenBytes {
  std::pmr::vector<std::byte> file;
  std::span<const std::byte> bytes; ///< those of `file`, or the caller's
};
inline Result<GivenBytes> givenBytes(Context& context, const void* data, size_t size, const char* filePath) {
  GivenBytes given{std::pmr::vector<std::byte>(&context.host()), {}};
  if (!filePath) {
    given.bytes = {static_cast<const std::byte*>(data), data ? size : 0};
    return given;
  }
  auto read = context.readFile(filePath);
  if (!read) return read.error();
  given.file = std::move(*read); // keeps its place when the struct is moved
  given.bytes = given.file;
  return given;
}

/// Gives a created object its handle.
template <class Handle, class T> Handle adopt(Context& context, core::Unique<T> object) {
  return handleOf<Handle>(context.adopt(core::upcast<core::Object>(std::move(object))));
}

} // namespace gpgp::api
