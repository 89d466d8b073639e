#include "vector/import/lottie/archive.h"

#include <algorithm>
#include <cstdint>
#include <zlib.h>

namespace gpgp::vector::lottie {
namespace {
uint32_t number(std::span<const std::byte> bytes, size_t at, int count) {
  uint32_t value = 0;
  for (int i = 0; i < count; ++i) value |= std::to_integer<uint32_t>(bytes[at + static_cast<size_t>(i)]) << (8 * i);
  return value;
}
constexpr size_t kEndBytes = 22, kDirectoryBytes = 46, kLocalBytes = 30, kMaxEntries = 4096;
} // namespace

bool Archive::is(std::span<const std::byte> bytes) { return bytes.size() >= 4 && number(bytes, 0, 4) == 0x04034b50; }

std::optional<Archive> Archive::open(std::span<const std::byte> bytes) {
  if (bytes.size() < kEndBytes) return std::nullopt;
  size_t end = bytes.size() - kEndBytes; // a comment of at most 64 KiB may follow
  const size_t lowest = end - std::min<size_t>(end, 65535);
  while (number(bytes, end, 4) != 0x06054b50)
    if (end-- == lowest) return std::nullopt;
  const size_t count = number(bytes, end + 10, 2);
  size_t at = number(bytes, end + 16, 4);
  if (count > kMaxEntries) return std::nullopt;
  Archive archive;
  archive.bytes_ = bytes;
  for (size_t i = 0; i < count; ++i) {
    if (at > bytes.size() || bytes.size() - at < kDirectoryBytes || number(bytes, at, 4) != 0x02014b50)
      return std::nullopt;
    const size_t name = number(bytes, at + 28, 2), extra = number(bytes, at + 30, 2), note = number(bytes, at + 32, 2);
    if (bytes.size() - at - kDirectoryBytes < name + extra + note) return std::nullopt;
    archive.names_.emplace_back(reinterpret_cast<const char*>(bytes.data() + at + kDirectoryBytes), name);
    archive.entries_.push_back({number(bytes, at + 42, 4), number(bytes, at + 20, 4), number(bytes, at + 24, 4),
                                number(bytes, at + 8, 2) & 1 ? UINT32_MAX : number(bytes, at + 10, 2),
                                number(bytes, at + 16, 4)});
    at += kDirectoryBytes + name + extra + note;
  }
  return archive;
}

std::optional<std::string> Archive::read(std::string_view name, size_t limit) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  const Entry& entry = entries_[static_cast<size_t>(found - names_.begin())];
  if (entry.size > limit || entry.offset > bytes_.size() || bytes_.size() - entry.offset < kLocalBytes ||
      number(bytes_, entry.offset, 4) != 0x04034b50)
    return std::nullopt;
  const size_t begin =
      entry.offset + kLocalBytes + number(bytes_, entry.offset + 26, 2) + number(bytes_, entry.offset + 28, 2);
  if (begin > bytes_.size() || bytes_.size() - begin < entry.packed) return std::nullopt;
  const auto* packed = reinterpret_cast<const Bytef*>(bytes_.data() + begin);
  std::string result;
  if (entry.method == 0) {
    if (entry.packed != entry.size) return std::nullopt;
    result.assign(reinterpret_cast<const char*>(packed), entry.packed);
  } else if (entry.method == 8) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt;
    stream.next_in = const_cast<Bytef*>(packed);
    stream.avail_in = static_cast<uInt>(entry.packed);
    char chunk[16384];
    int state = Z_OK;
    while (state == Z_OK && result.size() <= entry.size) { // grows with what is there, not with what is promised
      stream.next_out = reinterpret_cast<Bytef*>(chunk);
      stream.avail_out = sizeof chunk;
      state = inflate(&stream, Z_NO_FLUSH);
      result.append(chunk, sizeof chunk - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state != Z_STREAM_END || result.size() != entry.size) return std::nullopt;
  } else {
    return std::nullopt;
  }
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(result.data()), static_cast<uInt>(result.size()));
  return sum == entry.checksum ? std::optional(std::move(result)) : std::nullopt;
}

} // namespace gpgp::vector::lottie
