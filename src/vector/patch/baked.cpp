// Baked drawings (.gpgpv): a header of 16 words, then curves, patches and paths as the GPU reads them.
//
// Little-endian, as all targets are. What is loaded is checked as strictly as what a stranger sends: a shader may
// then index without asking again.
#include "vector/patch/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gpgp::vector {
namespace {
using core::makeError;

struct Header {
  char magic[4];
  uint32_t version;
  uint64_t checksum; // of all bytes after it
  uint32_t curves, patches, paths, reserved;
  float bounds[4], viewport[4];
};
static_assert(sizeof(Header) == 64);
constexpr char kMagic[4] = {'G', 'P', 'V', 'D'};
constexpr uint32_t kVersion = 1;
constexpr size_t kSummedFrom = 16;

/// FNV-1a over 8-byte words: every input bit reaches the result.
uint64_t checksum(std::span<const std::byte> bytes) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (size_t i = 0; i < bytes.size(); i += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<size_t>(8, bytes.size() - i));
    hash = (hash ^ word) * 0x100000001b3u;
    hash ^= hash >> 29;
  }
  return hash ^ bytes.size();
}

bool sane(float v) { return std::abs(v) <= 4 * kMaxCoordinate; } // false for NaN
bool sane(const shader::vec4& v) { return sane(v.x) && sane(v.y) && sane(v.z) && sane(v.w); }

core::Result<void> checkContents(const Drawing& d) {
  for (size_t i = 0; i < d.curves.size(); ++i) {
    const CurveRecord& c = d.curves[i];
    if (!sane(c.ends) || !sane(c.controls) || !sane(c.bend) || !(c.ends.w >= 0) || c.pad0 || c.pad1 || c.pad2)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: curve %zu is not a curve", i);
  }
  uint32_t path = 0;
  for (size_t i = 0; i < d.patches.size(); ++i) {
    const PatchRecord& p = d.patches[i];
    // Curves lie in the order in which patches first use them, so the first n patches need at most 2 n of them: the
    // canvas sizes its table by that.
    const size_t most = std::min(d.curves.size(), 2 * (i + 1));
    if (p.left >= most || p.right >= most || p.path >= d.paths.size() || p.path < path)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: patch %zu refers to what is not there", i);
    if (!sane(p.top) || !sane(p.bottom) || !sane(p.x0) || !sane(p.x1) || !(p.top < p.bottom) || p.item)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: patch %zu is not a patch", i);
    path = p.path;
  }
  for (size_t i = 0; i < d.paths.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (!(d.paths[i].color[k] >= 0 && d.paths[i].color[k] <= 1))
        return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: the colour of path %zu is out of range", i);
  for (int k = 0; k < 4; ++k)
    if (!sane(d.bounds[k]) || !sane(d.viewport[k]))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: bounds or viewport are not finite");
  return {};
}
} // namespace

std::pmr::vector<std::byte> bake(const Drawing& drawing, std::pmr::memory_resource* memory) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kVersion;
  header.curves = static_cast<uint32_t>(drawing.curves.size());
  header.patches = static_cast<uint32_t>(drawing.patches.size());
  header.paths = static_cast<uint32_t>(drawing.paths.size());
  std::memcpy(header.bounds, drawing.bounds, sizeof header.bounds);
  std::memcpy(header.viewport, drawing.viewport, sizeof header.viewport);
  const auto curves = std::as_bytes(std::span(drawing.curves));
  const auto patches = std::as_bytes(std::span(drawing.patches));
  const auto paths = std::as_bytes(std::span(drawing.paths));
  std::pmr::vector<std::byte> bytes(sizeof header, std::byte{}, memory);
  bytes.reserve(sizeof header + curves.size() + patches.size() + paths.size());
  for (const auto part : {curves, patches, paths}) bytes.insert(bytes.end(), part.begin(), part.end());
  std::memcpy(bytes.data(), &header, sizeof header);
  header.checksum = checksum(std::span(bytes).subspan(kSummedFrom));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

core::Result<Drawing> loadBaked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
  Header header;
  if (bytes.size() < sizeof header)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: %zu bytes are too few", bytes.size());
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0)
    return makeError(GPGP_ERROR_INVALID_DATA, "these bytes are not a baked drawing (no \"GPVD\" at the start)");
  if (header.version != kVersion)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: version %u, this library reads %u; bake it again",
                     header.version, kVersion);
  const uint64_t size = sizeof header + uint64_t(header.curves) * sizeof(CurveRecord) +
                        uint64_t(header.patches) * sizeof(PatchRecord) + uint64_t(header.paths) * sizeof(PathRecord);
  if (size != bytes.size())
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: %zu bytes, the header says %llu", bytes.size(),
                     static_cast<unsigned long long>(size));
  if (header.checksum != checksum(bytes.subspan(kSummedFrom)))
    return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: the checksum is wrong; the file is damaged");
  Drawing drawing(memory);
  const std::byte* next = bytes.data() + sizeof header;
  const auto take = [&next](auto& records, uint32_t count) {
    records.resize(count);
    const size_t length = count * sizeof records[0];
    if (length) std::memcpy(records.data(), next, length);
    next += length;
  };
  take(drawing.curves, header.curves);
  take(drawing.patches, header.patches);
  take(drawing.paths, header.paths);
  std::memcpy(drawing.bounds, header.bounds, sizeof header.bounds);
  std::memcpy(drawing.viewport, header.viewport, sizeof header.viewport);
  if (auto ok = checkContents(drawing); !ok) return ok.error();
  return drawing;
}

} // namespace gpgp::vector
