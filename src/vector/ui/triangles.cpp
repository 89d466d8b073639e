// Triangles of a list (shaders/vector/shared/triangle.h): checked, placed, and as a canvas takes them.
#include "vector/shared/color.h"
#include "vector/shared/triangle.h"
#include "vector/ui/list.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/packing.hpp>

namespace gpgp::vector {
namespace {
using core::makeError;
using core::Result;
using shader::ShapeRecord;
using shader::vec3;
using shader::vec4;

bool inside(float value, float limit) { return value >= -limit && value <= limit; }

uint32_t indexAt(const GpgpListTriangles& from, uint32_t i) {
  if (!from.indices) return i;
  if (from.indexType == VK_INDEX_TYPE_UINT16) {
    uint16_t index;
    std::memcpy(&index, static_cast<const std::byte*>(from.indices) + size_t(i) * sizeof index, sizeof index);
    return index;
  }
  uint32_t index;
  std::memcpy(&index, static_cast<const std::byte*>(from.indices) + size_t(i) * sizeof index, sizeof index);
  return index;
}

/// The words of a record that hold its colours: two for each corner. A list has the given bytes in the first of them.
std::array<float*, 6> colorWords(ShapeRecord& s) {
  return {&s.radii.z, &s.radii.w, &s.frame.x, &s.frame.y, &s.frame.z, &s.frame.w};
}

/// A colour with eight bits a channel as the canvas mixes it.
vec4 mixed(uint32_t bytes, bool encoded, bool straight, bool blendSrgb) {
  const vec4 color = glm::unpackUnorm4x8(bytes);
  if (encoded == blendSrgb || color.w == 0) return color;
  if (straight) return {shader::convertSrgb(vec3(color), blendSrgb), color.w};
  return shader::convert(glm::min(color, vec4(color.w)), blendSrgb);
}
} // namespace

ShapeRecord List::toRecord(const ShapeRecord& triangle, bool blendSrgb) {
  ShapeRecord record = triangle;
  const uint32_t flags = shader::floatBitsToUint(triangle.ratio);
  const auto words = colorWords(record);
  for (size_t k = 0; k < words.size(); k += 2) {
    const vec4 color = mixed(shader::floatBitsToUint(*words[k]), flags & shader::kTriangleEncoded,
                             flags & shader::kTriangleStraight, blendSrgb);
    *words[k] = shader::uintBitsToFloat(glm::packUnorm2x16({color.x, color.y}));
    *words[k + 1] = shader::uintBitsToFloat(glm::packUnorm2x16({color.z, color.w}));
  }
  return record;
}

Result<void> List::addTriangles(const GpgpListTriangles& from) {
  const uint32_t corners = from.indices ? from.indexCount : from.vertexCount;
  if (corners % 3)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s is %u; it must be a multiple of 3",
                     from.indices ? "indexCount" : "vertexCount", corners);
  if (from.indices && from.indexType != VK_INDEX_TYPE_UINT16 && from.indexType != VK_INDEX_TYPE_UINT32)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indexType is %d; expected UINT16 or UINT32", from.indexType);
  if (from.encoding < GPGP_IMAGE_LINEAR || from.encoding > GPGP_IMAGE_SRGB)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "encoding is %d", from.encoding);
  const bool textured = from.image != GPGP_IMAGE_NONE;
  if (textured && from.image >= GPGP_MAX_IMAGES)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "image is %u; it must be below %u, or GPGP_IMAGE_NONE", from.image,
                     GPGP_MAX_IMAGES);
  for (uint32_t i = 0; i < corners; ++i)
    if (const uint32_t index = indexAt(from, i); index >= from.vertexCount)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "indices[%u] is %u, but vertexCount is %u", i, index,
                       from.vertexCount);
  const Space& space = state_.space;
  const auto placed = [&](float v, double move) {
    return static_cast<float>(space.scale * static_cast<double>(v) + move);
  };
  for (uint32_t i = 0; i < from.vertexCount; ++i) {
    const GpgpListVertex& v = from.vertices[i];
    const bool here = inside(v.x, kMaxCoordinate) && inside(v.y, kMaxCoordinate) &&
                      inside(placed(v.x, space.x), kMaxCoordinate) && inside(placed(v.y, space.y), kMaxCoordinate);
    if (!here || (textured && !(inside(v.u, 1e6f) && inside(v.v, 1e6f))))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices[%u]: %s", i,
                       here ? "u or v is not a number within 1e6" : "x or y is not a number within 1e7");
  }
  if (corners / 3 > UINT32_MAX - shapes_.size())
    return makeError(GPGP_ERROR_UNSUPPORTED, "a list holds fewer than 2^32 shapes and triangles");

  const size_t before = shapes_.size(), paints = paints_.paints.size();
  const auto reserve = [](auto& values, size_t more) {
    if (values.capacity() - values.size() < more) values.reserve(std::max(values.size() + more, 2 * values.capacity()));
  };
  reserve(shapes_, corners / 3);
  if (textured) reserve(paints_.paints, corners / 3);
  reserve(commands_, 1);
  const uint32_t flags =
      (from.premultiplied ? 0 : shader::kTriangleStraight) | (from.encoding ? shader::kTriangleEncoded : 0);
  for (uint32_t i = 0; i < corners; i += 3) {
    const GpgpListVertex* v[3];
    for (uint32_t k = 0; k < 3; ++k) v[k] = &from.vertices[indexAt(from, i + k)];
    ShapeRecord record{};
    record.kind = shader::kShapeTriangle;
    record.box = {placed(v[0]->x, space.x), placed(v[0]->y, space.y), placed(v[1]->x, space.x),
                  placed(v[1]->y, space.y)};
    record.radii = {placed(v[2]->x, space.x), placed(v[2]->y, space.y), 0, 0};
    record.ratio = shader::uintBitsToFloat(flags);
    const double ux = double(record.box.z) - double(record.box.x), uy = double(record.box.w) - double(record.box.y),
                 vx = double(record.radii.x) - double(record.box.x), vy = double(record.radii.y) - double(record.box.y);
    if (ux * vy == uy * vx) continue;
    if (v[0]->color[3] + v[1]->color[3] + v[2]->color[3] == 0) continue;
    const auto words = colorWords(record);
    for (size_t k = 0; k < 3; ++k) {
      const uint8_t* c = v[k]->color;
      *words[2 * k] = shader::uintBitsToFloat(c[0] | uint32_t(c[1]) << 8 | uint32_t(c[2]) << 16 | uint32_t(c[3]) << 24);
    }
    if (textured) {
      PaintRecord paint{};
      paint.kind = shader::kPaintImage;
      paint.firstStop = from.image;
      paint.matrix = {v[0]->u, v[0]->v, v[1]->u, v[1]->v};
      paint.origin = {v[2]->u, v[2]->v, 0, 0};
      paints_.paints.push_back(paint);
      record.paint = static_cast<uint32_t>(paints_.paints.size());
    }
    shapes_.push_back({record, {1, 1, 1, state_.opacity}, i / 3});
  }
  Command& command = addCommand(Kind::triangles);
  command.first = static_cast<uint32_t>(before);
  command.count = static_cast<uint32_t>(shapes_.size() - before);
  command.id = from.id;
  if (paints_.paints.size() > paints) images_ = std::max(images_, from.image + 1);
  ++entries_;
  return {};
}

} // namespace gpgp::vector
