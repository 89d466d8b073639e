#include "vector/ui/hit.h"

#include "vector/shared/triangle.h"

#include <algorithm>
#include <cstring>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::BoxedPath;
using shader::SegmentRecord;
using shader::ShapeRecord;
using shader::vec4;

double number(float v) { return static_cast<double>(v); }

/// The point that a map takes to (x, y). False where there is none in front of the eye.
bool unmap(const Map& m, double x, double y, Point& to) {
  const double determinant =
      m.a * (m.d * m.r - m.f * m.q) - m.c * (m.b * m.r - m.f * m.p) + m.e * (m.b * m.q - m.d * m.p);
  const double u = (m.d * m.r - m.f * m.q) * x + (m.e * m.q - m.c * m.r) * y + (m.c * m.f - m.e * m.d);
  const double v = (m.f * m.p - m.b * m.r) * x + (m.a * m.r - m.e * m.p) * y + (m.e * m.b - m.a * m.f);
  const double w = (m.b * m.q - m.d * m.p) * x + (m.c * m.p - m.a * m.q) * y + (m.a * m.d - m.c * m.b);
  if (!(w / determinant > 0)) return false;
  to = {u / w, v / w};
  return std::isfinite(to.x) && std::isfinite(to.y);
}

/// Whether the segment lies left of the point in its row; level ones do not.
bool isLeft(const SegmentRecord& s, Point p) {
  if (p.y < number(s.ends.y) || p.y >= number(s.ends.w)) return false;
  const auto [least, most] = std::minmax({s.first.x, s.first.z, s.second.x, s.second.z});
  if (p.x < number(least)) return false;
  if (p.x >= number(most)) return true;
  const double x0 = number(s.first.x), y0 = number(s.first.y), x3 = number(s.second.z), y3 = number(s.second.w);
  if (s.line) return x0 + (x3 - x0) * ((p.y - y0) / (y3 - y0)) <= p.x;
  const double t = parameterAt(number(s.first.w) - y0, number(s.second.y) - y0, y3 - y0, p.y - y0), u = 1 - t;
  return u * u * u * x0 + 3 * u * u * t * number(s.first.z) + 3 * u * t * t * number(s.second.x) + t * t * t * x3 <=
         p.x;
}

bool inBox(const vec4& box, Point p) {
  return p.x >= number(box.x) && p.x <= number(box.z) && p.y >= number(box.y) && p.y <= number(box.w);
}

bool inPath(const Outlines& outlines, size_t path, Point p) {
  if (!inBox(outlines.boxes[path], p)) return false;
  bool inside = false;
  for (size_t i = path ? outlines.ends[path - 1] : 0; i < outlines.ends[path]; ++i) {
    const SegmentRecord& s = outlines.segments[i];
    if (number(s.ends.y) > p.y) break; // sorted by where they begin
    inside ^= isLeft(s, p);
  }
  return inside;
}

/// The topmost path at the point, as the engine counts them; false where there is none.
bool hitDrawing(const DrawingAsset::Shown& shown, Point p, GpgpHit& hit) {
  uint32_t hidden = 0;
  for (const ClipRecord& clip : shown.clips) hidden = std::max(hidden, clip.firstPath + clip.pathCount);
  for (size_t i = shown.paths.size(); i > hidden; --i) {
    if (!inPath(shown.outlines, i - 1, p)) continue;
    bool visible = true;
    for (uint32_t clip = shown.paths[i - 1].clip; clip && visible;) {
      const ClipRecord& record = shown.clips[clip - 1];
      visible = false;
      for (uint32_t k = 0; k < record.pathCount && !visible; ++k)
        visible = inPath(shown.outlines, record.firstPath + k, p);
      clip = record.parent;
    }
    if (!visible) continue;
    hit.path = static_cast<uint32_t>(i - 1) - hidden;
    return true;
  }
  return false;
}

/// The topmost path of the topmost glyph at the point.
Result<bool> hitGlyphs(const GlyphSet& set, std::span<const GpgpGlyphInstance> glyphs, Point p, GpgpHit& hit) {
  for (size_t i = glyphs.size(); i > 0; --i) {
    const GpgpGlyphInstance& from = glyphs[i - 1];
    if (from.glyph == GPGP_GLYPH_NONE || !(from.size > 0)) continue;
    const GlyphSet::Glyph* glyph = set.glyph(from.glyph);
    if (!glyph)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                       ".glyphs[%zu].glyph is not, or no longer, in the set: it was evicted", i - 1);
    const Point at{(p.x - number(from.x)) / number(from.size), (p.y - number(from.y)) / number(from.size)};
    const std::byte* segments = set.block(*glyph).data();
    const std::byte* paths = segments + glyph->segments * sizeof(SegmentRecord);
    for (uint32_t path = glyph->paths; path > 0; --path) {
      BoxedPath boxed;
      std::memcpy(&boxed, paths + (path - 1) * sizeof boxed, sizeof boxed);
      if (!inBox(boxed.box, at)) continue;
      bool inside = false;
      for (uint32_t k = 0; k < glyph->segments; ++k) {
        SegmentRecord segment;
        std::memcpy(&segment, segments + k * sizeof segment, sizeof segment);
        if (segment.path == path - 1) inside ^= isLeft(segment, at);
      }
      if (!inside) continue;
      hit.glyph = static_cast<uint32_t>(i - 1);
      hit.path = path - 1;
      return true;
    }
  }
  return false;
}

/// Whether the point lies in a rectangle `inset` inside the shape's, with its corners.
bool inContour(const ShapeRecord& s, Point p, double inset) {
  const double left = number(s.box.x) + inset, top = number(s.box.y) + inset, right = number(s.box.z) - inset,
               bottom = number(s.box.w) - inset;
  if (p.x < left || p.x >= right || p.y < top || p.y >= bottom) return false;
  if (!s.kind) return true;
  const float radii[4] = {s.radii.x, s.radii.y, s.radii.z, s.radii.w};
  for (int k = 0; k < 4; ++k) {
    const double rx = number(radii[k]) - inset, ry = number(radii[k]) * number(s.ratio) - inset;
    if (rx <= 0 || ry <= 0) continue;
    const double u = (k == 0 || k == 3 ? left + rx - p.x : p.x - (right - rx)) / rx;
    const double v = (k < 2 ? top + ry - p.y : p.y - (bottom - ry)) / ry;
    if (u > 0 && v > 0 && u * u + v * v > 1) return false;
  }
  return true;
}

bool inTriangle(const ShapeRecord& s, Point p) {
  bool inside = false;
  for (uint32_t k = 0; k < 3; ++k) inside ^= isLeft(shader::triangleSegment(s, k), p);
  return inside;
}

bool inShape(const ShapeRecord& s, Point p) {
  if (shader::isTriangle(s)) return inTriangle(s, p);
  const double dx = p.x - number(s.frame.x), dy = p.y - number(s.frame.y);
  const double ax = number(s.frame.z), ay = number(s.frame.w);
  const Point at{dx * ax + dy * ay, dy * ax - dx * ay};
  return inContour(s, at, 0) && !(s.border > 0 && inContour(s, at, number(s.border)));
}

/// Whether a clip and all around it show the point.
bool clipsShow(const List& list, uint32_t clip, const Map& map, double x, double y) {
  for (; clip; clip = list.clips()[clip - 1].parent) {
    const List::Clip& c = list.clips()[clip - 1];
    Point at{};
    if (!unmap(compose(map, list.bases()[c.base]), x, y, at) || !inShape(c.shape, at)) return false;
  }
  return true;
}

/// The layers that a command lies in: their clips and boxes count; masks, filters and opacities do not.
struct PicturesAround {
  std::array<uint32_t, GPGP_MAX_LAYER_DEPTH> layers; ///< their commands
  uint32_t count = 0;
  bool masked = false; ///< it is part of a mask
  bool shows(const List& list, const Map& map, double x, double y) const {
    for (uint32_t k = 0; k < count; ++k) {
      const List::Command& command = list.commands()[layers[k]];
      const List::Layer& layer = list.layers()[command.first];
      if (!clipsShow(list, command.space.clip, map, x, y)) return false;
      if (!layer.bounded) continue;
      Point at{};
      const Map whole = compose(compose(map, list.bases()[command.space.base]), command.space.map());
      const float* b = layer.bounds;
      if (!unmap(whole, x, y, at) || !inBox({b[0], b[1], b[2], b[3]}, at)) return false;
    }
    return true;
  }
};
PicturesAround picturesAround(const List& list, const List::Command& command) {
  PicturesAround around;
  for (uint32_t open = command.picture; open;) {
    const List::Command& c = list.commands()[open - 1];
    around.masked = around.masked || c.kind == List::Kind::mask;
    if (c.kind == List::Kind::layer) around.layers[around.count++] = open - 1;
    open = c.picture;
  }
  return around;
}

Result<bool> hitList(const List& list, const Map& map, double x, double y, GpgpHit& hit) {
  if (list.depth())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, ".list: %u of its pushes are not popped", list.depth());
  uint32_t base = UINT32_MAX, clip = UINT32_MAX;
  bool shown = false, mapped = false;
  Point p{};
  for (size_t i = list.commands().size(); i > 0; --i) {
    const List::Command& command = list.commands()[i - 1];
    const List::Space& space = command.space;
    if (command.kind == List::Kind::layer || command.kind == List::Kind::mask) continue;
    const auto around = picturesAround(list, command);
    if (around.masked) continue;
    if (space.clip != clip) shown = clipsShow(list, clip = space.clip, map, x, y);
    if (!around.shows(list, map, x, y)) continue;
    if (space.base != base) mapped = unmap(compose(map, list.bases()[base = space.base]), x, y, p);
    if (!shown || !mapped || command.id == GPGP_ID_NOT_HIT) continue;
    hit.entry = command.firstEntry;
    hit.id = command.id;
    bool found = false;
    Point at = p;
    if (command.kind == List::Kind::shapes) {
      const auto shapes = list.shapes().subspan(command.first, command.count);
      size_t k = shapes.size();
      while (k > 0 && (shapes[k - 1].id == GPGP_ID_NOT_HIT || !inShape(shapes[k - 1].record, p))) --k;
      if (!k) continue;
      found = true;
      hit.entry += static_cast<uint32_t>(k - 1);
      hit.id = shapes[k - 1].id;
    } else if (command.kind == List::Kind::triangles) {
      const auto triangles = list.shapes().subspan(command.first, command.count);
      size_t k = triangles.size();
      while (k > 0 && !inShape(triangles[k - 1].record, p)) --k;
      if (!k) continue;
      found = true;
      hit.path = static_cast<uint32_t>(triangles[k - 1].id);
    } else {
      const core::Object* asset = command.asset();
      if (!asset)
        return makeError(GPGP_ERROR_INVALID_HANDLE, ".list, entry %u: its drawing or glyph set was destroyed",
                         command.firstEntry);
      if (command.kind == List::Kind::text) {
        const auto glyphs = list.glyphs().subspan(command.first, command.count);
        const auto hits = hitGlyphs(static_cast<const GlyphSet&>(*asset), glyphs, p, hit);
        if (!hits) return makeError(hits.error().code, ".list, entry %u%s", command.firstEntry, hits.error().text);
        found = *hits;
      } else {
        const auto tables = static_cast<const DrawingAsset&>(*asset).shown();
        if (!tables)
          return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           ".list, entry %u: its drawing was made neither hitTestable nor editable",
                           command.firstEntry);
        at = {(p.x - space.x) / space.scale, (p.y - space.y) / space.scale};
        found = hitDrawing(*tables, at, hit);
      }
    }
    if (!found) continue;
    hit.x = static_cast<float>((p.x - space.x) / space.scale);
    hit.y = static_cast<float>((p.y - space.y) / space.scale);
    return true;
  }
  return false;
}
} // namespace

Result<bool> hitItem(const GpgpCanvasItem& item, const ItemAsset& asset, double x, double y, GpgpHit& hit) {
  const Map map = toMap(item.transform, item.perspective);
  hit.entry = hit.glyph = hit.path = 0;
  hit.id = 0;
  const float* s = item.scissor;
  const bool cut = s[0] != 0 || s[1] != 0 || s[2] != 0 || s[3] != 0;
  if (cut && !(x >= number(s[0]) && x < number(s[2]) && y >= number(s[1]) && y < number(s[3]))) return false;
  if (asset.list) return hitList(*asset.list, map, x, y, hit);
  Point p{};
  const bool mapped = unmap(map, x, y, p);
  hit.x = static_cast<float>(p.x);
  hit.y = static_cast<float>(p.y);
  if (asset.glyphSet) {
    if (!mapped) return false;
    return hitGlyphs(*asset.glyphSet, {item.glyphs, item.glyphCount}, p, hit);
  }
  const auto tables = asset.drawing->shown();
  if (!tables) return makeError(GPGP_ERROR_INVALID_ARGUMENT, ": its drawing was made neither hitTestable nor editable");
  return mapped && hitDrawing(*tables, p, hit);
}

} // namespace gpgp::vector
