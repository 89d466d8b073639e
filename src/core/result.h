// Errors as values, inside the library. Nothing here allocates: an error about memory must not need memory.
#pragma once
#include <gpgp/core.h>

#include <cstdarg>
#include <cstdio>
#include <optional>
#include <utility>

namespace gpgp::core {

/// A result code with the text a person reads. Text is cut at the buffer's size, never lost whole.
struct Error {
  GpgpResult code = GPGP_SUCCESS;
  char text[480]; // up to its end: what succeeds does not pay for the rest
  Error() { text[0] = 0; }
};

[[gnu::format(printf, 2, 3)]] inline Error makeError(GpgpResult code, const char* format, ...) {
  Error error;
  error.code = code;
  std::va_list args;
  va_start(args, format);
  std::vsnprintf(error.text, sizeof error.text, format, args);
  va_end(args);
  return error;
}

/// A value or an error. `if (!r) return r.error();` is the idiom.
template <class T> class [[nodiscard]] Result {
public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(error) {}
  explicit operator bool() const { return value_.has_value(); }
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }
  const Error& error() const { return error_; }

private:
  std::optional<T> value_;
  Error error_;
};

template <> class [[nodiscard]] Result<void> {
public:
  Result() = default;
  Result(Error error) : error_(error) {}
  explicit operator bool() const { return error_.code == GPGP_SUCCESS; }
  const Error& error() const { return error_; }

private:
  Error error_;
};

} // namespace gpgp::core
