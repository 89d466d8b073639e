// The C functions of ui.h.
#include "api/items.h"
#include "vector/ui/hit.h"
#include "vector/ui/panel.h"

using namespace gpgp;
using namespace gpgp::api;
using namespace gpgp::vector;

namespace {
/// What every function of a list does around its call.
template <class Body> GpgpResult withList(const char* function, GpgpList handle, Body&& body) noexcept {
  return guarded(function, [&](Call& call) -> Result<void> {
    const auto list = resolve<List>(call, handle, Kind::list, "list");
    if (!list) return list.error();
    return body(call, **list);
  });
}
} // namespace

GpgpResult GPGP_CALL gpgpCreateList(GpgpContext handle, const GpgpListCreateInfo* info, GpgpList* list) {
  return guarded("gpgpCreateList", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_LIST_CREATE_INFO, "info"); !ok) return ok;
    if (!list) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "list is NULL");
    auto made = List::create(**context, *info);
    if (!made) return made.error();
    *list = adopt<GpgpList>(**context, std::move(*made));
    return {};
  });
}

void GPGP_CALL gpgpDestroyList(GpgpList handle) {
  if (!handle) return;
  withList("gpgpDestroyList", handle, [](Call&, List& list) -> Result<void> {
    list.context.retire(list);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpResetList(GpgpList handle) {
  return withList("gpgpResetList", handle, [](Call&, List& list) -> Result<void> {
    list.reset();
    return {};
  });
}

GpgpResult GPGP_CALL gpgpPushTransform(GpgpList handle, const float* transform, const float* perspective) {
  return withList("gpgpPushTransform", handle, [&](Call&, List& list) -> Result<void> {
    if (!transform) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "transform is NULL");
    return list.pushTransform(transform, perspective);
  });
}

GpgpResult GPGP_CALL gpgpPushClip(GpgpList handle, const float* box, const float* radii) {
  return withList("gpgpPushClip", handle, [&](Call&, List& list) -> Result<void> {
    if (!box) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "box is NULL");
    return list.pushClip(box, radii);
  });
}

GpgpResult GPGP_CALL gpgpPushOpacity(GpgpList handle, float opacity) {
  return withList("gpgpPushOpacity", handle, [&](Call&, List& list) { return list.pushOpacity(opacity); });
}

GpgpResult GPGP_CALL gpgpPushGroup(GpgpList handle, float opacity) {
  return withList("gpgpPushGroup", handle, [&](Call&, List& list) { return list.pushGroup(opacity); });
}

GpgpResult GPGP_CALL gpgpPushLayer(GpgpList handle, const GpgpListLayer* layer) {
  return withList("gpgpPushLayer", handle, [&](Call&, List& list) -> Result<void> {
    if (!layer) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "layer is NULL");
    return list.pushLayer(*layer);
  });
}

GpgpResult GPGP_CALL gpgpPushMask(GpgpList handle, uint32_t* mask) {
  return withList("gpgpPushMask", handle, [&](Call&, List& list) -> Result<void> {
    if (!mask) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "mask is NULL");
    const auto made = list.pushMask();
    if (!made) return made.error();
    *mask = *made;
    return {};
  });
}

GpgpResult GPGP_CALL gpgpPopState(GpgpList handle) {
  return withList("gpgpPopState", handle, [](Call&, List& list) { return list.pop(); });
}

GpgpResult GPGP_CALL gpgpAddShapes(GpgpList handle, const GpgpListShape* shapes, uint32_t count) {
  return withList("gpgpAddShapes", handle, [&](Call&, List& list) -> Result<void> {
    if (count && !shapes) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "shapes is NULL, but count is %u", count);
    return list.addShapes({shapes, count});
  });
}

GpgpResult GPGP_CALL gpgpAddTriangles(GpgpList handle, const GpgpListTriangles* triangles) {
  return withList("gpgpAddTriangles", handle, [&](Call&, List& list) -> Result<void> {
    if (!triangles) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "triangles is NULL");
    if (triangles->vertexCount && !triangles->vertices)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices is NULL, but vertexCount is %u", triangles->vertexCount);
    return list.addTriangles(*triangles);
  });
}

GpgpResult GPGP_CALL gpgpAddText(GpgpList handle, GpgpAsset glyphSet, const GpgpGlyphInstance* glyphs, uint32_t count,
                                 uint64_t id) {
  return withList("gpgpAddText", handle, [&](Call& call, List& list) -> Result<void> {
    const auto set = resolve<GlyphSet>(call, glyphSet, Kind::glyphSet, "glyphSet", &list.context);
    if (!set) return set.error();
    if (!((*set)->methods() & GPGP_DRAWING_FLATTENED))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the glyph set was made without GPGP_DRAWING_FLATTENED");
    if (count && !glyphs) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyphs is NULL, but count is %u", count);
    return list.addText(**set, {glyphs, count}, id);
  });
}

GpgpResult GPGP_CALL gpgpAddDrawing(GpgpList handle, GpgpAsset asset, uint32_t firstImage, uint64_t id) {
  return withList("gpgpAddDrawing", handle, [&](Call& call, List& list) -> Result<void> {
    const auto drawing = resolve<DrawingAsset>(call, asset, Kind::drawing, "drawing", &list.context);
    if (!drawing) return drawing.error();
    if (!((*drawing)->methods() & GPGP_DRAWING_FLATTENED))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "the drawing was made without GPGP_DRAWING_FLATTENED");
    list.addDrawing(**drawing, firstImage, id);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpPlacePanel(const GpgpPanel* panel, const float* viewProjection, const uint32_t* viewport,
                                    GpgpCanvasItem* item, float* clip) {
  if (!panel || !viewProjection || !viewport || !item || viewport[2] == 0 || viewport[3] == 0 ||
      !allFinite(panel->corner) || !allFinite(panel->across) || !allFinite(panel->down) ||
      !allFinite(std::span(viewProjection, 16)))
    return GPGP_ERROR_INVALID_ARGUMENT;
  return placePanel(*panel, viewProjection, viewport, *item, clip) ? GPGP_SUCCESS : GPGP_ERROR_INVALID_ARGUMENT;
}

GpgpResult GPGP_CALL gpgpHitTest(GpgpContext handle, const GpgpHitTestInfo* info, GpgpHit* hit) {
  return guarded("gpgpHitTest", [&](Call& call) -> Result<void> {
    const auto context = resolve(call, handle);
    if (!context) return context.error();
    if (auto ok = checkStruct(info, GPGP_STRUCTURE_HIT_TEST_INFO, "info"); !ok) return ok;
    if (!hit) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "hit is NULL");
    if (info->itemCount && !info->items)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items is NULL, but itemCount is %u", info->itemCount);
    if (!std::isfinite(info->x) || !std::isfinite(info->y))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "x or y is not finite");
    GpgpHit found{};
    for (uint32_t i = info->itemCount; i > 0; --i) {
      const GpgpCanvasItem& item = info->items[i - 1];
      const auto asset = resolveItem(call, item, i - 1, **context);
      if (!asset) return asset.error();
      if (!allFinite(item.transform) || !allFinite(item.perspective))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u] holds a number that is not finite", i - 1);
      if (item.glyphCount && !item.glyphs)
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].glyphs is NULL, but glyphCount is %u", i - 1,
                         item.glyphCount);
      if (!allFinite(item.scissor))
        return makeError(GPGP_ERROR_INVALID_ARGUMENT, "items[%u].scissor holds a number that is not finite", i - 1);
      const auto hits = hitItem(item, *asset, static_cast<double>(info->x), static_cast<double>(info->y), found);
      if (!hits) return makeError(hits.error().code, "items[%u]%s", i - 1, hits.error().text);
      if (!*hits) continue;
      found.item = i - 1;
      *hit = found;
      return {};
    }
    *hit = {};
    hit->item = GPGP_HIT_NONE;
    return {};
  });
}
