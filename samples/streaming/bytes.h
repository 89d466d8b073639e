// Values in messages, little-endian as both machines are, and reading that never leaves the message.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

namespace streaming {

using Bytes = std::vector<uint8_t>;
using ByteSpan = std::span<const uint8_t>;

class Writer {
public:
  template <class T> void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(&value, sizeof value);
  }
  /// Of a tuple of references: what getEach reads.
  template <class Fields> void putEach(const Fields& fields) {
    std::apply([&](const auto&... field) { (put(field), ...); }, fields);
  }
  template <class T> void putAll(const std::vector<T>& values) { add(values.data(), values.size() * sizeof(T)); }
  void putBytes(ByteSpan values) { add(values.data(), values.size()); }
  Bytes bytes;

private:
  void add(const void* data, size_t size) {
    const auto* from = static_cast<const uint8_t*>(data);
    bytes.insert(bytes.end(), from, from + size);
  }
};

/// After a read beyond the end all values are zero and ended() is false.
class Reader {
public:
  explicit Reader(ByteSpan bytes) : rest_(bytes) {}
  template <class T> T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    const ByteSpan from = take(sizeof value);
    if (!from.empty()) std::memcpy(static_cast<void*>(&value), from.data(), sizeof value);
    return value;
  }
  template <class Fields> void getEach(const Fields& fields) {
    std::apply([&](auto&... field) { ((field = get<std::remove_reference_t<decltype(field)>>()), ...); }, fields);
  }
  template <class T> std::vector<T> getAll(size_t count) {
    std::vector<T> values;
    if (count > rest_.size() / sizeof(T)) {
      well_ = false;
      return values;
    }
    const ByteSpan from = take(count * sizeof(T));
    values.resize(count);
    if (count) std::memcpy(static_cast<void*>(values.data()), from.data(), from.size());
    return values;
  }
  ByteSpan take(size_t size) {
    if (!well_ || size > rest_.size()) {
      well_ = false;
      rest_ = {};
      return {};
    }
    const ByteSpan taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }
  bool well() const { return well_; }
  /// All was read, and nothing was missing.
  bool ended() const { return well_ && rest_.empty(); }
  size_t left() const { return rest_.size(); }

private:
  ByteSpan rest_;
  bool well_ = true;
};

} // namespace streaming
