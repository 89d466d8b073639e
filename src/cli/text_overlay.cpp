#include "cli/text_overlay.h"

#include <algorithm>
#include <cmath>

namespace gpgp::cli {
namespace {

/// left, top, right, bottom
PlacedPath rectangle(const float (&box)[4], const float (&color)[4], const GpgpImagePaint* image, float x = 0,
                     float y = 0, float size = 1) {
  constexpr GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  const float points[] = {box[0], box[1], box[2], box[1], box[2], box[3], box[0], box[3]};
  GpgpPath path{};
  path.verbs = verbs;
  path.verbCount = 5;
  path.points = points;
  path.pointCount = 4;
  std::copy(std::begin(color), std::end(color), path.color);
  path.image = image;
  return PlacedPath(path, x, y, size);
}

/// All bitmap glyphs in one picture, as a record paints with few: cells of one size with a clear border, a column of
/// them and the next. Colours are multiplied by alpha, so that filtering at edges darkens nothing.
struct Atlas {
  host::Picture picture;
  std::vector<std::optional<GpgpImagePaint>> paints; ///< for each glyph; from texture to em
};

Atlas makeAtlas(const PageGlyphs& all, float size) {
  std::vector<host::Picture> pictures;
  uint32_t count = 0, cellWidth = 0, cellHeight = 0;
  for (const PageGlyph& glyph : all.glyphs) {
    const double across = double(glyph.picture.width) / double((glyph.box[2] - glyph.box[0]) * size),
                 down = double(glyph.picture.height) / double((glyph.box[3] - glyph.box[1]) * size);
    pictures.push_back(glyph.picture.width ? shrunk(glyph.picture, across, down) : host::Picture{});
    if (glyph.picture.width) ++count;
    cellWidth = std::max(cellWidth, pictures.back().width + 2);
    cellHeight = std::max(cellHeight, pictures.back().height + 2);
  }
  Atlas atlas;
  atlas.paints.resize(pictures.size());
  if (count == 0) return atlas;
  const auto columns = static_cast<uint32_t>(std::ceil(std::sqrt(double(count)))),
             rows = (count + columns - 1) / columns;
  atlas.picture = {columns * cellWidth, rows * cellHeight, {}};
  const size_t stride = size_t{atlas.picture.width} * 4;
  atlas.picture.rgba.resize(stride * atlas.picture.height);
  uint32_t cell = 0;
  for (size_t i = 0; i < pictures.size(); ++i) {
    const host::Picture& from = pictures[i];
    if (from.width == 0) continue;
    const uint32_t left = cell % columns * cellWidth + 1, top = cell / columns * cellHeight + 1;
    ++cell;
    for (uint32_t y = 0; y < from.height; ++y)
      for (uint32_t x = 0; x < from.width; ++x) {
        const uint8_t* in = &from.rgba[(size_t{y} * from.width + x) * 4];
        uint8_t* out = &atlas.picture.rgba[(top + y) * stride + size_t{left + x} * 4];
        const float alpha = static_cast<float>(in[3]) / 255;
        for (size_t c = 0; c < 3; ++c) {
          const float linear = host::linearFromSrgb(static_cast<float>(in[c]) / 255) * alpha;
          out[c] = static_cast<uint8_t>(std::lround(host::srgbFromLinear(linear) * 255));
        }
        out[3] = in[3];
      }
    const float(&box)[4] = all.glyphs[i].box;
    const float texelX = (box[2] - box[0]) / static_cast<float>(from.width),
                texelY = (box[3] - box[1]) / static_cast<float>(from.height);
    atlas.paints[i] = GpgpImagePaint{
        0,
        {texelX * static_cast<float>(atlas.picture.width), 0, 0, texelY * static_cast<float>(atlas.picture.height),
         box[0] - texelX * static_cast<float>(left), box[1] - texelY * static_cast<float>(top)}};
  }
  return atlas;
}

} // namespace

TextOverlay makeOverlay(Session& session, const GpgpLayoutInfo& layout, const PageGlyphs& all) {
  std::vector<PlacedPath> paths;
  TextOverlay overlay;
  const Atlas atlas = makeAtlas(all, layout.glyphCount ? layout.glyphs[0].size : 1);
  for (uint32_t i = 0; i < layout.glyphCount; ++i) {
    const GpgpTextGlyph& at = layout.glyphs[i];
    const PageGlyph& glyph = all.glyphs[all.which[i]];
    if (const auto& paint = atlas.paints[all.which[i]])
      paths.push_back(rectangle(glyph.box, {0, 0, 0, at.color[3]}, &*paint, at.x, at.y, at.size));
  }
  for (uint32_t i = 0; i < layout.decorationCount; ++i) {
    const auto& [x, y, width, height] = layout.decorations[i].rect;
    paths.push_back(rectangle({x, y, x + width, y + height}, layout.decorations[i].color, nullptr));
  }
  if (paths.empty()) return overlay;
  std::vector<GpgpPath> views;
  for (const PlacedPath& path : paths) views.push_back(path.view());
  GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
  info.label = "overlay";
  info.paths = views.data();
  info.pathCount = static_cast<uint32_t>(views.size());
  overlay.drawing = session.take(Drawing::create(session.context(), info), "gpgpCreateDrawing");
  overlay.patches = session.take(overlay.drawing.info(), "gpgpGetDrawingInfo").patches;
  if (atlas.picture.width)
    overlay.atlas = std::make_unique<Textures>(session.device(), std::vector<host::Picture>{atlas.picture}, true);
  return overlay;
}

} // namespace gpgp::cli
