// Baked drawings (.gpgpv): a header of 26 words, then curves, patches, paths, paints, the stops of gradients,
// clips, layers, and the plan of what is composited by itself (layers.h); and, if they are asked for, the words that
// draws inside a render pass read, which have a version of their own. A drawing for these alone has neither curves nor
// patches.
//
// Little-endian, as all targets are. What is loaded is checked as strictly as what a stranger sends: a shader may
// then index without asking again.
#include "vector/patch/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace gpgp::vector {
namespace {
using core::makeError;

struct Header {
  char magic[4];
  uint32_t version;
  uint64_t checksum; // of all bytes after it
  uint32_t curves, patches, paths, paints, stops, clips, layers, words;
  uint32_t runs, tokens, sequences, nodes, steps, tables;
  float bounds[4], viewport[4];
};
static_assert(sizeof(Header) == 104);
constexpr char kMagic[4] = {'G', 'P', 'V', 'D'};
constexpr uint32_t kVersion = 6;
constexpr size_t kSummedFrom = 16;

bool sane(float v) { return std::abs(v) <= 4 * kMaxCoordinate; } // false for NaN
bool sane(const shader::vec4& v) { return sane(v.x) && sane(v.y) && sane(v.z) && sane(v.w); }

core::Result<void> checkContents(const Drawing& d, std::pmr::memory_resource* memory) {
  for (size_t i = 0; i < d.curves.size(); ++i) {
    const CurveRecord& c = d.curves[i];
    if (!sane(c.ends) || !sane(c.controls) || !sane(c.bend) || !(c.ends.w >= 0) || !sane(c.endX) || !sane(c.endY) ||
        !(c.weight >= 0 && c.weight <= 1))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: curve %zu is not a curve", i);
  }
  uint32_t path = 0;
  for (size_t i = 0; i < d.patches.size(); ++i) {
    const PatchRecord& p = d.patches[i];
    // Curves lie in the order in which patches first use them, so the first n patches need at most 2 n of them: the
    // canvas sizes its table by that.
    const size_t most = std::min(d.curves.size(), 2 * (i + 1));
    if (p.left >= most || p.right >= most || p.path >= d.paths.size() || p.path < path)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: patch %zu refers to something that does not exist", i);
    if (!sane(p.top) || !sane(p.bottom) || !sane(p.x0) || !sane(p.x1) || !(p.top < p.bottom) || p.item)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: patch %zu is not a patch", i);
    path = p.path;
  }
  for (size_t i = 0; i < d.paths.size(); ++i)
    if (!inColorRange(&d.paths[i].color.x))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: the colour of path %zu is out of range", i);
  for (size_t i = 0; i < d.paths.size(); ++i)
    if (d.paths[i].paint > d.paints.size() || d.paths[i].clip > d.clips.size() || d.paths[i].layer > d.layers.size() ||
        d.paths[i].flags > shader::kForeground)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: path %zu refers to something that does not exist", i);
  for (size_t i = 0; i < d.paints.size(); ++i) {
    const PaintRecord& p = d.paints[i];
    const bool image = p.kind == shader::kPaintImage;
    if (image && (p.firstStop >= GPGP_MAX_IMAGES || p.stopCount || p.spread || p.flags))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: paint %zu is not an image", i);
    if (!image && (!p.stopCount || p.firstStop > d.stops.size() || p.stopCount > d.stops.size() - p.firstStop))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: paint %zu refers to something that does not exist", i);
    bool good = p.kind <= shader::kPaintImage && p.spread <= shader::kSpreadReflect &&
                p.flags <= shader::kInterpolateSrgb && p.startRadius >= 0 && std::isfinite(p.startRadius) &&
                std::isfinite(p.tangent) && p.slices == 0;
    for (int k = 0; k < 4; ++k) good = good && std::isfinite(p.matrix[k]) && std::isfinite(p.origin[k]);
    if (!good) return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: paint %zu is not a gradient or an image", i);
    for (uint32_t k = 1; k < p.stopCount; ++k)
      if (!(d.stops[p.firstStop + k - 1].offset <= d.stops[p.firstStop + k].offset))
        return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: the stops of paint %zu are not in order", i);
  }
  if (auto ok = checkPlan(d.plan, d.paths.size(), memory); !ok) return ok;
  // Clipped paths lie behind all clips of their run: where paths are left out at the end, no clip is missing.
  size_t clipPaths = 0, run = 0;
  std::pmr::vector<uint32_t> runs(d.clips.size(), 0, memory); // of clips
  for (size_t i = 0; i < d.clips.size(); ++i) {
    const ClipRecord& c = d.clips[i];
    const uint32_t above = c.parent && c.parent <= i ? d.clips[c.parent - 1].depth : 0;
    bool good = c.parent <= i && c.depth == above + 1 && c.depth <= shader::kMaxClipDepth &&
                c.firstPath <= d.paths.size() && c.pathCount <= d.paths.size() - c.firstPath;
    if (!d.plan.empty()) {
      const auto& all = d.plan.runs;
      while (run + 1 < all.size() && all[run + 1].firstPath <= c.firstPath) ++run;
      good = good && c.firstPath >= all[run].firstPath &&
             c.firstPath + uint64_t(c.pathCount) <= uint64_t(all[run].firstPath) + all[run].pathCount &&
             (!c.parent || runs[c.parent - 1] == run);
      clipPaths = std::max<size_t>(clipPaths, all[run].firstPath);
      runs[i] = static_cast<uint32_t>(run);
    }
    for (; good && clipPaths < c.firstPath + size_t(c.pathCount); ++clipPaths) good = d.paths[clipPaths].clip == 0;
    if (!good) return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: clip %zu is not a clip", i);
  }
  run = 0;
  for (size_t i = 0; i < d.paths.size() && !d.plan.empty(); ++i) {
    const auto& all = d.plan.runs;
    while (i >= all[run].firstPath + size_t(all[run].pathCount)) ++run;
    if (d.paths[i].clip && runs[d.paths[i].clip - 1] != run)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: path %zu refers to another run's clip", i);
  }
  for (size_t i = 0; i < d.layers.size(); ++i) {
    const LayerRecord& l = d.layers[i];
    const uint32_t above = l.parent && l.parent <= i ? d.layers[l.parent - 1].depth : 0;
    if (!(l.opacity >= 0 && l.opacity < 1) || l.parent > i || l.depth != above + 1 || l.depth > shader::kMaxLayerDepth)
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: layer %zu is not a layer", i);
  }
  for (size_t i = 0; i < d.stops.size(); ++i) {
    const StopRecord& s = d.stops[i];
    if (!(s.offset >= 0 && s.offset <= 1 && inColorRange(&s.color.x)))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: stop %zu is out of range", i);
  }
  for (int k = 0; k < 4; ++k)
    if (!sane(d.bounds[k]) || !sane(d.viewport[k]))
      return makeError(GPGP_ERROR_INVALID_DATA, "baked drawing: bounds or viewport are not finite");
  return {};
}
} // namespace

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

/// What a file holds behind its header.
static std::array<std::span<const std::byte>, 14> partsOf(const Drawing& d) {
  const LayerPlan& plan = d.plan;
  return {std::as_bytes(std::span(d.curves)),    std::as_bytes(std::span(d.patches)),
          std::as_bytes(std::span(d.paths)),     std::as_bytes(std::span(d.paints)),
          std::as_bytes(std::span(d.stops)),     std::as_bytes(std::span(d.clips)),
          std::as_bytes(std::span(d.layers)),    std::as_bytes(std::span(plan.runs)),
          std::as_bytes(std::span(plan.tokens)), std::as_bytes(std::span(plan.sequences)),
          std::as_bytes(std::span(plan.nodes)),  std::as_bytes(std::span(plan.steps)),
          std::as_bytes(std::span(plan.tables)), std::as_bytes(std::span(d.words))};
}

size_t bakedSize(const Drawing& drawing) {
  size_t size = sizeof(Header);
  for (const auto part : partsOf(drawing)) size += part.size();
  return size;
}

void bake(const Drawing& drawing, std::span<std::byte> bytes) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kVersion;
  header.curves = static_cast<uint32_t>(drawing.curves.size());
  header.patches = static_cast<uint32_t>(drawing.patches.size());
  header.paths = static_cast<uint32_t>(drawing.paths.size());
  header.paints = static_cast<uint32_t>(drawing.paints.size());
  header.stops = static_cast<uint32_t>(drawing.stops.size());
  header.clips = static_cast<uint32_t>(drawing.clips.size());
  header.layers = static_cast<uint32_t>(drawing.layers.size());
  header.words = static_cast<uint32_t>(drawing.words.size());
  const LayerPlan& plan = drawing.plan;
  header.runs = static_cast<uint32_t>(plan.runs.size());
  header.tokens = static_cast<uint32_t>(plan.tokens.size());
  header.sequences = static_cast<uint32_t>(plan.sequences.size());
  header.nodes = static_cast<uint32_t>(plan.nodes.size());
  header.steps = static_cast<uint32_t>(plan.steps.size());
  header.tables = static_cast<uint32_t>(plan.tables.size());
  std::memcpy(header.bounds, drawing.bounds, sizeof header.bounds);
  std::memcpy(header.viewport, drawing.viewport, sizeof header.viewport);
  std::byte* next = bytes.data() + sizeof header;
  for (const auto part : partsOf(drawing)) {
    if (!part.empty()) std::memcpy(next, part.data(), part.size());
    next += part.size();
  }
  std::memcpy(bytes.data(), &header, sizeof header);
  header.checksum = checksum(bytes.subspan(kSummedFrom));
  std::memcpy(bytes.data(), &header, sizeof header);
}

std::pmr::vector<std::byte> bake(const Drawing& drawing, std::pmr::memory_resource* memory) {
  std::pmr::vector<std::byte> bytes(bakedSize(drawing), std::byte{}, memory);
  bake(drawing, bytes);
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
  const auto sum = [](auto... parts) { return (uint64_t(0) + ... + parts); };
  const uint64_t size =
      sum(sizeof header, uint64_t(header.curves) * sizeof(CurveRecord), uint64_t(header.patches) * sizeof(PatchRecord),
          uint64_t(header.paths) * sizeof(PathRecord), uint64_t(header.paints) * sizeof(PaintRecord),
          uint64_t(header.stops) * sizeof(StopRecord), uint64_t(header.clips) * sizeof(ClipRecord),
          uint64_t(header.layers) * sizeof(LayerRecord), uint64_t(header.runs) * sizeof(LayerRun),
          uint64_t(header.tokens) * sizeof(LayerToken), uint64_t(header.sequences) * sizeof(LayerSequence),
          uint64_t(header.nodes) * sizeof(LayerNode), uint64_t(header.steps) * sizeof(LayerStep),
          uint64_t(header.tables) * sizeof(float), uint64_t(header.words) * sizeof(shader::uvec4));
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
  take(drawing.paints, header.paints);
  take(drawing.stops, header.stops);
  take(drawing.clips, header.clips);
  take(drawing.layers, header.layers);
  take(drawing.plan.runs, header.runs);
  take(drawing.plan.tokens, header.tokens);
  take(drawing.plan.sequences, header.sequences);
  take(drawing.plan.nodes, header.nodes);
  take(drawing.plan.steps, header.steps);
  take(drawing.plan.tables, header.tables);
  take(drawing.words, header.words);
  std::memcpy(drawing.bounds, header.bounds, sizeof header.bounds);
  std::memcpy(drawing.viewport, header.viewport, sizeof header.viewport);
  if (auto ok = checkContents(drawing, memory); !ok) return ok.error();
  if (!drawing.words.empty())
    if (auto ok = checkPatches(drawing.words, static_cast<uint32_t>(drawing.paths.size()) - clipPaths(drawing), memory);
        !ok)
      return ok.error();
  return drawing;
}

} // namespace gpgp::vector
