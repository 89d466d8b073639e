/* gpgp ui.hpp: C++17 wrapper of ui.h. The rules of the wrapper are in core.hpp. */
#ifndef GPGP_UI_HPP
#define GPGP_UI_HPP

#include <gpgp/core.hpp>
#include <gpgp/ui.h>

#include <cstdint>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpListCreateInfo, GPGP_STRUCTURE_LIST_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpHitTestInfo, GPGP_STRUCTURE_HIT_TEST_INFO);

namespace detail {
template <> struct Destroy<GpgpList> {
  void operator()(GpgpList handle) const noexcept { gpgpDestroyList(handle); }
};
} // namespace detail

/// Shapes, text and drawings in painting order, filled anew every frame or kept (gpgpCreateList).
///
///   list.clear();
///   list.pushTransform(map);
///   list.add(shape);
///   list.pop();
class List : public Handle<GpgpList> {
public:
  using Handle::Handle;
  static Result<List> create(GpgpContext context,
                             const GpgpListCreateInfo& info = init<GpgpListCreateInfo>()) noexcept {
    return detail::create<List>(gpgpCreateList, context, info);
  }
  /// gpgpResetList
  GpgpResult clear() noexcept { return gpgpResetList(get()); }
  /// gpgpPushTransform. transform holds 6 numbers; perspective holds 3 or is nullptr.
  GpgpResult pushTransform(const float* transform, const float* perspective = nullptr) noexcept {
    return gpgpPushTransform(get(), transform, perspective);
  }
  /// gpgpPushClip. box is left, top, right, bottom; radii holds 4 numbers or is nullptr.
  GpgpResult pushClip(const float* box, const float* radii = nullptr) noexcept {
    return gpgpPushClip(get(), box, radii);
  }
  GpgpResult pushOpacity(float opacity) noexcept { return gpgpPushOpacity(get(), opacity); }
  GpgpResult pushGroup(float opacity) noexcept { return gpgpPushGroup(get(), opacity); }
  GpgpResult pushLayer(const GpgpListLayer& layer) noexcept { return gpgpPushLayer(get(), &layer); }
  /// gpgpPushMask. The value is the mask's number.
  Result<uint32_t> pushMask() noexcept {
    uint32_t mask = 0;
    const GpgpResult code = gpgpPushMask(get(), &mask);
    return Result<uint32_t>(code, mask);
  }
  /// gpgpPopState
  GpgpResult pop() noexcept { return gpgpPopState(get()); }
  /// gpgpAddShapes with one shape.
  GpgpResult add(const GpgpListShape& shape) noexcept { return gpgpAddShapes(get(), &shape, 1); }
  GpgpResult add(const GpgpListShape* shapes, uint32_t count) noexcept { return gpgpAddShapes(get(), shapes, count); }
  /// gpgpAddTriangles
  GpgpResult add(const GpgpListTriangles& triangles) noexcept { return gpgpAddTriangles(get(), &triangles); }
  /// gpgpAddText. glyphSet is a GlyphSet or its C handle.
  GpgpResult add(GpgpAsset glyphSet, const GpgpGlyphInstance* glyphs, uint32_t count, uint64_t id = 0) noexcept {
    return gpgpAddText(get(), glyphSet, glyphs, count, id);
  }
  /// gpgpAddDrawing. drawing is a Drawing or its C handle.
  GpgpResult add(GpgpAsset drawing, uint32_t firstImage = 0, uint64_t id = 0) noexcept {
    return gpgpAddDrawing(get(), drawing, firstImage, id);
  }
};

/// gpgpHitTest: what lies under a pointer. The value's item is GPGP_HIT_NONE if nothing is hit.
inline Result<GpgpHit> hitTest(GpgpContext context, const GpgpHitTestInfo& info) noexcept {
  GpgpHit value = GpgpHit();
  const GpgpResult code = gpgpHitTest(context, &info, &value);
  return Result<GpgpHit>(code, value);
}

} // namespace gpgp

#endif
