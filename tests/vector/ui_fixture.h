// Lists with the calls of the API, and shapes with the closed forms that say what they cover.
#pragma once
#include "canvas_fixture.h"

#include <gpgp/ui.h>

#include <cstdlib>

namespace gpgp::test {

/// A list with the calls of the API, each of which must succeed.
struct TestList {
  GpgpList list = nullptr;
  explicit TestList(GpgpContext context) {
    const GpgpListCreateInfo info = GPGP_LIST_CREATE_INFO_INIT;
    EXPECT_EQ(gpgpCreateList(context, &info, &list), GPGP_SUCCESS);
  }
  ~TestList() { gpgpDestroyList(list); }
  TestList(const TestList&) = delete;
  TestList& operator=(const TestList&) = delete;

  TestList& reset() { return done(gpgpResetList(list)); }
  TestList& push(const std::array<float, 9>& t) { return done(gpgpPushTransform(list, t.data(), t.data() + 6)); }
  TestList& clip(const std::array<float, 4>& box) { return done(gpgpPushClip(list, box.data(), nullptr)); }
  TestList& clip(const std::array<float, 4>& box, const std::array<float, 4>& radii) {
    return done(gpgpPushClip(list, box.data(), radii.data()));
  }
  TestList& fade(float opacity) { return done(gpgpPushOpacity(list, opacity)); }
  TestList& layer(const GpgpListLayer& layer) { return done(gpgpPushLayer(list, &layer)); }
  TestList& group(float opacity) { return done(gpgpPushGroup(list, opacity)); }
  TestList& pop(int count = 1) {
    for (; count; --count) done(gpgpPopState(list));
    return *this;
  }
  TestList& add(const GpgpListShape& shape) { return done(gpgpAddShapes(list, &shape, 1)); }
  TestList& add(GpgpAsset drawing, uint64_t id = 0) { return done(gpgpAddDrawing(list, drawing, 0, id)); }
  TestList& add(GpgpAsset set, const std::vector<GpgpGlyphInstance>& glyphs, uint64_t id = 0) {
    return done(gpgpAddText(list, set, glyphs.data(), static_cast<uint32_t>(glyphs.size()), id));
  }
  TestList& add(const std::vector<GpgpListVertex>& triangles, bool premultiplied = false,
                uint32_t image = GPGP_IMAGE_NONE, GpgpImageEncoding encoding = GPGP_IMAGE_LINEAR, uint64_t id = 0) {
    const GpgpListTriangles info{triangles.data(),
                                 static_cast<uint32_t>(triangles.size()),
                                 nullptr,
                                 0,
                                 VK_INDEX_TYPE_UINT16,
                                 encoding,
                                 premultiplied,
                                 image,
                                 id};
    return done(gpgpAddTriangles(list, &info));
  }
  GpgpCanvasItem item() const {
    GpgpCanvasItem item{nullptr, {1, 0, 0, 1, 0, 0}, 1};
    item.list = list;
    return item;
  }

private:
  TestList& done(GpgpResult result) {
    EXPECT_EQ(result, GPGP_SUCCESS);
    return *this;
  }
};

inline GpgpHit hitAt(GpgpContext context, const std::vector<GpgpCanvasItem>& items, float x, float y,
                     GpgpResult expected = GPGP_SUCCESS) {
  GpgpHitTestInfo info = GPGP_HIT_TEST_INFO_INIT;
  info.items = items.data();
  info.itemCount = static_cast<uint32_t>(items.size());
  info.x = x;
  info.y = y;
  GpgpHit hit{};
  EXPECT_EQ(gpgpHitTest(context, &info, &hit), expected);
  return hit;
}

/// A set of one glyph, a random outline a unit wide; index: the glyph's.
inline GpgpAsset makeGlyphSet(GpgpContext context, uint32_t& index) {
  const GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  GpgpAsset set = nullptr;
  EXPECT_EQ(gpgpCreateGlyphSet(context, &info, &set), GPGP_SUCCESS);
  const TestPath outline = randomShape(3, 1);
  const GpgpPath path = outline.view();
  const GpgpGlyph glyph{1, &path, 1, nullptr};
  EXPECT_EQ(gpgpAddGlyphs(set, &glyph, 1, &index), GPGP_SUCCESS);
  return set;
}

inline GpgpListShape rectangle(float left, float top, float right, float bottom,
                               std::array<float, 4> color = {1, 1, 1, 1}) {
  GpgpListShape shape{};
  shape.kind = GPGP_LIST_RECTANGLE;
  std::copy_n(std::array{left, top, right, bottom}.data(), 4, shape.box);
  std::copy_n(color.data(), 4, shape.color);
  return shape;
}
inline GpgpListShape rounded(GpgpListShape shape, float a, float b, float c, float d, float border = 0) {
  std::copy_n(std::array{a, b, c, d}.data(), 4, shape.radii);
  shape.width = border;
  return shape;
}
inline GpgpListShape ellipse(GpgpListShape shape, float border = 0) {
  shape.kind = GPGP_LIST_ELLIPSE;
  shape.width = border;
  return shape;
}
inline GpgpListShape line(float x0, float y0, float x1, float y1, float width, GpgpCap cap) {
  GpgpListShape shape = rectangle(x0, y0, x1, y1);
  shape.kind = GPGP_LIST_LINE;
  shape.width = width;
  shape.cap = cap;
  return shape;
}
/// Whether a point lies in a rectangle with round corners: the closed form.
inline bool inRound(const GpgpListShape& s, double x, double y, double inset) {
  const double l = s.box[0] + inset, t = s.box[1] + inset, r = s.box[2] - inset, b = s.box[3] - inset;
  if (x < l || x > r || y < t || y > b) return false;
  for (int k = 0; k < 4; ++k) {
    const bool round = s.kind == GPGP_LIST_ELLIPSE;
    const double rx = (round ? 0.5 * (s.box[2] - s.box[0]) : static_cast<double>(s.radii[k])) - inset;
    const double ry = (round ? 0.5 * (s.box[3] - s.box[1]) : static_cast<double>(s.radii[k])) - inset;
    if (rx <= 0 || ry <= 0) continue;
    const double u = (k == 0 || k == 3 ? l + rx - x : x - r + rx) / rx, v = (k < 2 ? t + ry - y : y - b + ry) / ry;
    if (u > 0 && v > 0 && u * u + v * v > 1) return false;
  }
  return true;
}
inline bool inShape(const GpgpListShape& s, double x, double y) {
  if (s.kind != GPGP_LIST_LINE)
    return inRound(s, x, y, 0) && !(s.width > 0 && inRound(s, x, y, static_cast<double>(s.width)));
  const double dx = s.box[2] - s.box[0], dy = s.box[3] - s.box[1], length = std::hypot(dx, dy), half = s.width / 2;
  const double u = ((x - s.box[0]) * dx + (y - s.box[1]) * dy) / length;
  const double v = ((x - s.box[0]) * dy - (y - s.box[1]) * dx) / length;
  const double past = std::max({-u, u - length, 0.0});
  if (s.cap == GPGP_CAP_ROUND) return std::hypot(past, v) <= half;
  return std::abs(v) <= half && past <= (s.cap == GPGP_CAP_SQUARE ? half : 0);
}

inline TestPath rectanglePath(float left, float top, float right, float bottom) {
  TestPath path;
  path.move(left, top).line(right, top).line(right, bottom).line(left, bottom).close();
  path.color = {1, 1, 1, 1};
  return path;
}
inline std::array<float, 9> turned(float degrees, float scale, float x, float y) {
  const float a = degrees * 3.14159265f / 180, c = scale * std::cos(a), s = scale * std::sin(a);
  return {c, s, -s, c, x, y, 0, 0, 0};
}
inline const std::array<float, 9> kMaps[] = {{1, 0, 0, 1, 0, 0},
                                             {0.8f, 0.6f, -0.6f, 0.8f, 30, -10},
                                             {-0.7f, 0, 0, 1.3f, 80, -20},
                                             {0, 1.1f, 0.9f, 0, 3, 1}, // mirrored along the diagonal
                                             {1, 0, 0, 1, 0, 0, 0.004f, 0.002f, 0.8f},
                                             {0.9f, 0, 0, 1, -20, 0, 0.01f, 0, -0.2f}, // behind the eye left of x = 20
                                             {0.5f, 0.3f, 0.2f, 0.6f, -10, -30, 0.01f, 0.011f, -1}};

inline void show(const char* name, const std::vector<Rgba>& pixels, uint32_t width, uint32_t height) {
  if (const char* folder = std::getenv("GPGP_TEST_PICTURES"))
    host::writePng(std::string(folder) + "/" + name + ".png",
                   host::fromLinearPremultiplied(width, height, std::span(&pixels[0].r, pixels.size() * 4)));
}
inline bool same(const std::vector<Rgba>& a, const std::vector<Rgba>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgba)) == 0;
}

} // namespace gpgp::test
