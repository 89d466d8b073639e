// Files inside a zip archive (APPNOTE 6.3: stored and deflated, without encryption and without ZIP64).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::vector::lottie {

class Archive {
public:
  static bool is(std::span<const std::byte> bytes);
  /// Nothing where the central directory is not valid, or has more than 4096 entries.
  static std::optional<Archive> open(std::span<const std::byte> bytes);
  /// Nothing where there is no such file, where it is damaged, or where it holds more than `limit` bytes.
  std::optional<std::string> read(std::string_view name, size_t limit) const;
  const std::vector<std::string>& names() const { return names_; }

private:
  struct Entry {
    size_t offset, packed, size;
    uint32_t method, checksum;
  };
  std::span<const std::byte> bytes_;
  std::vector<std::string> names_;
  std::vector<Entry> entries_;
};

} // namespace gpgp::vector::lottie
