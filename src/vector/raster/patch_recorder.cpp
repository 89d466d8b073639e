#include "vector/raster/patch_recorder.h"

#include "shaders/vector_patches_frag_00.spv.h"
#include "shaders/vector_patches_frag_01.spv.h"
#include "shaders/vector_patches_frag_10.spv.h"
#include "shaders/vector_patches_frag_11.spv.h"
#include "shaders/vector_patches_vert_00.spv.h"
#include "shaders/vector_patches_vert_01.spv.h"
#include "shaders/vector_patches_vert_10.spv.h"
#include "shaders/vector_patches_vert_11.spv.h"
#include "vector/in_pass/recording.h"
#include "vector/patch/patches.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::PatchHeader;
using shader::PatchPlacement;
using shader::PatchView;

constexpr uint32_t kOneDrawing = 0, kSeveralDrawings = 1; // forms

uint32_t orDefault(uint32_t value) { return value ? value : 1024; }

/// A matrix's rows x, y and w as they act on (x, y, 1), and the inverse; false where nothing can be seen through it.
struct Plane {
  double m[3][3], inverse[3][3];
};
bool invert(Plane& plane) {
  const auto& m = plane.m;
  const auto minor = [&](int r, int c) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  if (!(std::abs(determinant) > 0)) return false;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(plane.inverse[r][c] = minor(c, r) / determinant)) return false;
  return true;
}

/// Points are counted from what lies in the middle of the viewport, where the plane can be seen there.
bool viewOf(const float* clip, PatchView& view) {
  Plane plane;
  const int rows[3] = {0, 1, 3};
  double z[3];
  for (int c = 0; c < 3; ++c) {
    const float* column = clip + (c == 2 ? 12 : c * 4);
    for (int r = 0; r < 3; ++r) plane.m[r][c] = static_cast<double>(column[rows[r]]);
    z[c] = static_cast<double>(column[2]);
  }
  if (!invert(plane)) return false;
  double origin[2] = {};
  const double w = plane.inverse[2][2]; // of the middle: the point is there where this is above 0
  if (w > 0)
    for (int i = 0; i < 2; ++i) {
      const double at = plane.inverse[i][2] / w;
      const volatile float rounded = static_cast<float>(at); // g++ 12 may drop the rounding of a pair
      if (std::abs(at) <= 4e7) origin[i] = static_cast<double>(rounded);
    }
  const auto column = [&](int c) {
    double v[4];
    for (int r = 0; r < 4; ++r) {
      const auto of = [&](int k) { return r == 2 ? z[k] : plane.m[r == 3 ? 2 : r][k]; };
      v[r] = of(c) + (c == 2 ? of(0) * origin[0] + of(1) * origin[1] : 0);
    }
    return shader::vec4(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
                        static_cast<float>(v[3]));
  };
  view.column0 = column(0), view.column1 = column(1), view.column2 = column(2);
  const auto inverse = [&](int c) {
    const double h = plane.inverse[2][c];
    return shader::vec4(static_cast<float>(plane.inverse[0][c] - origin[0] * h),
                        static_cast<float>(plane.inverse[1][c] - origin[1] * h), static_cast<float>(h), 0);
  };
  view.inverse0 = inverse(0), view.inverse1 = inverse(1), view.inverse2 = inverse(2);
  view.inverse0.w = static_cast<float>(origin[0]);
  view.inverse1.w = static_cast<float>(origin[1]);
  return true;
}

/// Along which axis a pixel spreads less at a point of the view's plane, and how far there; 0: it lies behind the eye.
float spreadAt(const PatchView& view, const GpgpPatchDrawInfo& info, float x, float y) {
  const float px = x - view.inverse0.w, py = y - view.inverse1.w;
  const float w = view.column0.w * px + view.column1.w * py + view.column2.w;
  if (!(w > 0)) return 0;
  const float across = 2 * w / info.viewport[2], down = 2 * w / std::abs(info.viewport[3]);
  const auto spread = [&](float acrossOf, float downOf, float p) {
    return std::abs(acrossOf - p * view.inverse0.z) * across + std::abs(downOf - p * view.inverse1.z) * down;
  };
  return std::min(spread(view.inverse0.x, view.inverse1.x, px), spread(view.inverse0.y, view.inverse1.y, py));
}
bool affine(const PatchView& view) { return view.column0.w == 0 && view.column1.w == 0; }
/// Whether no path has cells that are large enough on the screen to be drawn (gpgpShowsCells).
bool small(const PatchQuads& quads, float size, float spread) { return quads.largestPixel * size < spread; }

Result<void> checkMatrix(const float* matrix, uint32_t item, const char* name) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(matrix[i]))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].%s holds a number that is not finite", item, name);
  return {};
}
} // namespace

PatchRecorder::PatchRecorder(core::Context& owner, const GpgpPatchRecorderCreateInfo& info)
    : Recorder(owner, core::Kind::patchRecorder, info.base, GPGP_SERVICE_VECTOR), maxItems_(orDefault(info.maxItems)),
      maxGlyphs_(orDefault(info.maxGlyphs)) {}

Result<core::Unique<PatchRecorder>> PatchRecorder::create(core::Context& context,
                                                          const GpgpPatchRecorderCreateInfo& info) {
  if (info.maxItems > 65536)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxItems is %u; at most 65536", info.maxItems);
  if (info.maxGlyphs > 1u << 20)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "maxGlyphs is %u; at most 1048576", info.maxGlyphs);
  auto recorder = core::makeUnique<PatchRecorder>(context.host(), context, info);
  core::PassList list(&context.host());
  constexpr const char* kNames[shader::kPatchBuffers] = {"drawing 0", "drawing 1", "drawing 2", "drawing 3",
                                                         "drawing 4", "drawing 5", "drawing 6", "drawing 7"};
  for (const char* name : kNames) list.add({.name = name, .kind = core::ResourceKind::buffer, .optional = true});
  const VkDeviceSize bytes = sizeof(PatchHeader) + VkDeviceSize(recorder->maxItems_) * 2 * sizeof(PatchView) +
                             (VkDeviceSize(recorder->maxItems_) + recorder->maxGlyphs_) * sizeof(PatchPlacement);
  list.add({.name = "recording", .kind = core::ResourceKind::constants, .bytes = bytes});
  const DrawShaders draws[] = {{{"patches.vert", vector_patches_vert_10},
                                {"patches.frag", vector_patches_frag_10},
                                {"patches.vert, multiview", vector_patches_vert_11},
                                {"patches.frag, multiview", vector_patches_frag_11}},
                               {{"patches.vert, several", vector_patches_vert_00},
                                {"patches.frag, several", vector_patches_frag_00},
                                {"patches.vert, several, multiview", vector_patches_vert_01},
                                {"patches.frag, several, multiview", vector_patches_frag_01}}};
  if (auto ok = recorder->init(std::move(list), draws); !ok) return ok.error();
  return recorder;
}

Result<void> PatchRecorder::begin(const GpgpPatchDrawInfo& info) {
  for (const float v : info.viewport)
    if (!std::isfinite(v)) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "viewport holds a number that is not finite");
  if (!(info.viewport[2] > 0) || info.viewport[3] == 0)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the viewport has no area");
  if (info.target->samples > VK_SAMPLE_COUNT_1_BIT && !context.device.limits.standardSampleLocations)
    return makeError(GPGP_ERROR_UNSUPPORTED, "this device has no standardSampleLocations, which several samples need");
  bound_ = {};
  slots_ = views_ = placements_ = glyphs_ = 0;
  quads_ = 0;
  place_ = constants();
  if (!place_)
    return makeError(GPGP_ERROR_TOO_MANY_RECORDINGS,
                     "the context was made for %u recordings per frame and recorder, and %u frames in flight",
                     context.maxRecordingsPerFrame, context.maxFramesInFlight);
  return {};
}

uint32_t PatchRecorder::slotOf(const core::Resident& asset) {
  for (uint32_t i = 0; i < slots_; ++i)
    if (bound_[i]->buffer() == asset.buffer()) return i;
  if (slots_ < shader::kPatchBuffers) bound_[slots_] = &asset;
  return slots_ < shader::kPatchBuffers ? slots_++ : shader::kPatchBuffers;
}

Result<void> PatchRecorder::add(const GpgpPatchDrawInfo& info, uint32_t index, const ItemAsset& asset) {
  const GpgpPatchItem& item = info.items[index];
  if (!(item.opacity >= 0 && item.opacity <= 1))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].opacity is %g; it must be 0 to 1", index,
                     static_cast<double>(item.opacity));
  if (auto ok = checkMatrix(item.clip, index, "clip"); !ok) return ok;
  const float* second = info.target->viewMask && item.secondClip ? item.secondClip : item.clip;
  if (second != item.clip)
    if (auto ok = checkMatrix(second, index, "secondClip"); !ok) return ok;
  const GpgpDrawingMethods methods = asset.drawing ? asset.drawing->methods() : asset.glyphSet->methods();
  if (!(methods & GPGP_DRAWING_IN_PASS))
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].%s was made without GPGP_DRAWING_IN_PASS", index,
                     asset.drawing ? "drawing" : "glyphSet");
  if (asset.drawing && !asset.drawing->resident()) return makeError(GPGP_NOT_READY, "a drawing is not resident");
  if (item.glyphCount && asset.glyphSet && !item.glyphs)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].glyphs is NULL, but glyphCount is %u", index,
                     item.glyphCount);
  PatchView views[2] = {};
  const bool seen = viewOf(item.clip, views[0]), seenSecond = second == item.clip ? seen : viewOf(second, views[1]);
  if (second == item.clip) views[1] = views[0];
  if (!seen && !seenSecond) return {}; // edge on, or turned into nothing
  const core::Resident& resident = asset.drawing ? static_cast<const core::Resident&>(*asset.drawing) : *asset.glyphSet;
  const uint32_t slot = slotOf(resident);
  if (slot == shader::kPatchBuffers)
    return makeError(
        GPGP_ERROR_INVALID_ARGUMENT,
        "items[%u]: the drawings and glyph sets of a draw lie in more than %u of the buffers that assets share", index,
        shader::kPatchBuffers);
  const uint32_t view = views_ * 2;
  std::memcpy(place_ + sizeof(PatchHeader) + size_t(view) * sizeof(PatchView), views, sizeof views);
  ++views_;
  const size_t placements = sizeof(PatchHeader) + size_t(maxItems_) * 2 * sizeof(PatchView);
  const auto put = [&](PatchPlacement placement, const PatchQuads& quads, bool coarse) {
    placement.firstQuad = static_cast<uint32_t>(quads_); // finish() checks that it fits
    if (coarse) placement.slot |= shader::kPatchCoarse;
    std::memcpy(place_ + placements + size_t(placements_++) * sizeof placement, &placement, sizeof placement);
    quads_ += coarse ? quads.paths : quads.all;
  };
  const bool flat = affine(views[0]) && affine(views[1]); // then a pixel spreads everywhere as far
  const auto leastSpread = [&](float x, float y) {
    return std::min(spreadAt(views[0], info, x, y), spreadAt(views[1], info, x, y));
  };
  if (asset.drawing) {
    const PatchQuads& quads = asset.drawing->quads();
    if (quads.paths)
      put({{0, 0, 1, 0}, {0, 0, 0, item.opacity}, asset.drawing->patchWords(), 0, view, slot}, quads,
          quads.paths == quads.all || (flat && small(quads, 1, leastSpread(0, 0))));
    return {};
  }
  const float everywhere = flat ? leastSpread(0, 0) : 0;
  const auto table = asset.glyphSet->table();
  const uint64_t arrived = asset.glyphSet->arrived();
  for (uint32_t i = 0; i < item.glyphCount; ++i) {
    const GpgpGlyphInstance& g = item.glyphs[i];
    if (g.glyph == GPGP_GLYPH_NONE) continue;
    const GlyphSet::Glyph* glyph = GlyphSet::find(table, g.glyph);
    if (!glyph)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].glyphs[%u].glyph is not in the set, or no longer", index,
                       i);
    if (glyph->upload > arrived) return makeError(GPGP_NOT_READY, "a glyph is not resident");
    if (!(std::abs(g.x) <= 1e7f && std::abs(g.y) <= 1e7f && g.size >= 0 && g.size <= 1e7f) || !inColorRange(g.color))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].glyphs[%u] has a place, size or colour out of range",
                       index, i);
    glyph->use(context.current());
    const PatchQuads& quads = glyph->quads;
    if (!quads.paths || !(g.size > 0)) continue;
    if (glyphs_++ == maxGlyphs_)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "more glyphs than the recorder was made for: %u (maxGlyphs)",
                       maxGlyphs_);
    put({{g.x, g.y, g.size, 0},
         {g.color[0], g.color[1], g.color[2], g.color[3] * item.opacity},
         asset.glyphSet->firstRecord() + glyph->patches,
         0,
         view,
         slot},
        quads, quads.paths == quads.all || small(quads, g.size, flat ? everywhere : leastSpread(g.x, g.y)));
  }
  return {};
}

Result<void> PatchRecorder::finish(VkCommandBuffer commandBuffer, const GpgpPatchDrawInfo& info) {
  constexpr uint64_t kQuadVertices = 6; // as patches.vert takes them
  if (quads_ > UINT32_MAX / kQuadVertices)
    return makeError(GPGP_ERROR_UNSUPPORTED, "%llu quads are more than one draw can show",
                     static_cast<unsigned long long>(quads_));
  PatchHeader header{};
  header.placements = placements_;
  header.firstPlacement = maxItems_ * 2 * shader::kPatchViewSize;
  header.flags = info.encodeSrgb ? shader::kPatchEncodeSrgb : 0;
  header.half_ = {0.5f * info.viewport[2], 0.5f * info.viewport[3]};
  header.middle = {info.viewport[0] + header.half_.x, info.viewport[1] + header.half_.y};
  std::memcpy(place_, &header, sizeof header);
  core::DrawRecord r;
  r.commandBuffer = commandBuffer;
  for (uint32_t i = 0; i < slots_; ++i) {
    r.bindings[i].ownBuffer = bound_[i]->buffer();
    r.bindings[i].ownSize = bound_[i]->bufferSize();
  }
  r.target = info.target;
  r.vertexCount = static_cast<uint32_t>(kQuadVertices * quads_);
  r.form = slots_ > 1 ? kSeveralDrawings : kOneDrawing;
  return recordDraw(r);
}

} // namespace gpgp::vector
