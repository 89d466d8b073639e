// Baked glyphs are a header of 8 words, a key and a number of paths for each glyph, and a baked drawing of all paths.
#include "vector/patch/glyphs.h"

#include <algorithm>
#include <cstring>

namespace gpgp::vector {
namespace {
using core::makeError;

struct Header {
  char magic[4];
  uint32_t version;
  uint64_t checksum; // of all bytes after it
  uint32_t glyphs, reserved;
  uint64_t drawingBytes;
};
static_assert(sizeof(Header) == 32 && sizeof(Glyphs::Entry) == 16);
constexpr char kMagic[4] = {'G', 'P', 'V', 'F'};
constexpr uint32_t kVersion = 1;
constexpr size_t kSummedFrom = 16;

core::Result<void> checkGlyph(const GpgpGlyph& glyph, size_t index) {
  if (glyph.pathCount && !glyph.paths)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyphs[%zu].paths is NULL, but pathCount is %u", index,
                     glyph.pathCount);
  for (uint32_t k = 0; k < glyph.pathCount; ++k) {
    const GpgpPath& path = glyph.paths[k];
    if (path.image || path.group)
      return makeError(GPGP_ERROR_UNSUPPORTED,
                       "glyphs[%zu].paths[%u] has an image or a group; glyphs are painted in colours and gradients",
                       index, k);
  }
  return {};
}
} // namespace

core::Result<Glyphs> makeGlyphs(std::span<const GpgpGlyph> glyphs, std::pmr::memory_resource* memory,
                                const GpgpJobSystem* jobs) {
  Glyphs made(memory);
  made.entries.reserve(glyphs.size());
  std::pmr::vector<GpgpPath> paths(memory);
  for (size_t i = 0; i < glyphs.size(); ++i) {
    if (auto ok = checkGlyph(glyphs[i], i); !ok) return ok.error();
    made.entries.push_back({glyphs[i].key, glyphs[i].pathCount});
    if (glyphs[i].pathCount) paths.insert(paths.end(), glyphs[i].paths, glyphs[i].paths + glyphs[i].pathCount);
  }
  auto drawing = makeDrawing(paths, memory, jobs);
  if (!drawing) { // once more, to say where
    for (size_t i = 0; i < glyphs.size(); ++i)
      if (const auto one = makeDrawing(std::span(glyphs[i].paths, glyphs[i].pathCount), memory); !one)
        return makeError(one.error().code, "glyphs[%zu].%s", i, one.error().text);
    return drawing.error();
  }
  size_t path = 0;
  for (const GpgpGlyph& glyph : glyphs)
    for (uint32_t k = 0; k < glyph.pathCount; ++k, ++path)
      drawing->paths[path].flags = !glyph.foreground || glyph.foreground[k] ? shader::kForeground : 0;
  made.drawing = std::move(*drawing);
  return made;
}

std::pmr::vector<std::byte> bakeGlyphs(const Glyphs& glyphs, std::pmr::memory_resource* memory) {
  const auto drawing = bake(glyphs.drawing, memory);
  const auto entries = std::as_bytes(std::span(glyphs.entries));
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kVersion;
  header.glyphs = static_cast<uint32_t>(glyphs.entries.size());
  header.drawingBytes = drawing.size();
  std::pmr::vector<std::byte> bytes(sizeof header, std::byte{}, memory);
  bytes.reserve(sizeof header + entries.size() + drawing.size());
  bytes.insert(bytes.end(), entries.begin(), entries.end());
  bytes.insert(bytes.end(), drawing.begin(), drawing.end());
  std::memcpy(bytes.data(), &header, sizeof header);
  header.checksum = checksum(std::span(bytes).subspan(kSummedFrom));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

core::Result<Glyphs> loadBakedGlyphs(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
  Header header;
  if (bytes.size() < sizeof header)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked glyphs: %zu bytes are too few", bytes.size());
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0)
    return makeError(GPGP_ERROR_INVALID_DATA, "these bytes are not baked glyphs (no \"GPVF\" at the start)");
  if (header.version != kVersion)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked glyphs: version %u, this library reads %u; bake them again",
                     header.version, kVersion);
  const uint64_t before = sizeof header + uint64_t(header.glyphs) * sizeof(Glyphs::Entry);
  if (before > bytes.size() || header.drawingBytes != bytes.size() - before)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked glyphs: %zu bytes are not what the header says", bytes.size());
  if (header.checksum != checksum(bytes.subspan(kSummedFrom)))
    return makeError(GPGP_ERROR_INVALID_DATA, "baked glyphs: the checksum is wrong; the file is damaged");
  auto drawing = loadBaked(bytes.subspan(before), memory);
  if (!drawing) return drawing.error();
  Glyphs glyphs(memory);
  glyphs.entries.resize(header.glyphs, Glyphs::Entry{});
  if (header.glyphs) std::memcpy(glyphs.entries.data(), bytes.data() + sizeof header, before - sizeof header);
  uint64_t paths = 0;
  std::pmr::vector<uint64_t> keys(memory);
  for (const Glyphs::Entry& entry : glyphs.entries) {
    paths += entry.paths;
    keys.push_back(entry.key);
  }
  std::sort(keys.begin(), keys.end());
  if (std::adjacent_find(keys.begin(), keys.end()) != keys.end())
    return makeError(GPGP_ERROR_INVALID_DATA, "baked glyphs: a key is there twice");
  const bool images = std::any_of(drawing->paints.begin(), drawing->paints.end(),
                                  [](const PaintRecord& paint) { return paint.kind >= shader::kPaintImage; });
  if (paths != drawing->paths.size() || !drawing->clips.empty() || !drawing->layers.empty() || images)
    return makeError(GPGP_ERROR_INVALID_DATA, "baked glyphs: the drawing is not theirs");
  glyphs.drawing = std::move(*drawing);
  return glyphs;
}

} // namespace gpgp::vector
