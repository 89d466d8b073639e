#include "spawn/schedule/vertices.h"

namespace gpgp::spawn {
namespace {
using namespace shader;

static_assert(GPGP_VERTEX_POSITION == kVertexPosition && GPGP_VERTEX_NORMAL == kVertexNormal &&
              GPGP_VERTEX_UV == kVertexUv && GPGP_VERTEX_BUCKET == kVertexBucket && GPGP_VERTEX_RULE == kVertexRule &&
              kVertexRule == kVertexSemantics - 1 && GPGP_MAX_VERTEX_ATTRIBUTES == kMaxVertexAttributes);

constexpr uint32_t kUnknown = UINT32_MAX;
uint32_t formatOf(VkFormat format) {
  switch (format) {
  case VK_FORMAT_R32G32B32_SFLOAT: return kVertexFloat3;
  case VK_FORMAT_R32G32_SFLOAT: return kVertexFloat2;
  case VK_FORMAT_R16G16B16A16_SFLOAT: return kVertexHalf4;
  case VK_FORMAT_R8G8B8A8_SNORM: return kVertexSnorm4;
  case VK_FORMAT_R8G8B8A8_UNORM: return kVertexUnorm4;
  case VK_FORMAT_R32_UINT: return kVertexUint;
  default: return kUnknown;
  }
}
} // namespace

core::Result<VertexLayout> layoutOf(const GpgpVertexLayout& wanted) {
  VertexLayout layout;
  if (wanted.stride == 0 || wanted.stride % 4 || wanted.stride > 4 * kMaxVertexWords)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                           "vertices->stride is %u; it must be a multiple of 4, at most %u", wanted.stride,
                           4 * kMaxVertexWords);
  if (wanted.attributeCount == 0 || wanted.attributeCount > GPGP_MAX_VERTEX_ATTRIBUTES)
    return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices->attributeCount is %u; it must be 1 to %u",
                           wanted.attributeCount, GPGP_MAX_VERTEX_ATTRIBUTES);
  layout.strideWords = wanted.stride / 4;
  layout.attributeCount = wanted.attributeCount;
  for (uint32_t i = 0; i < wanted.attributeCount; ++i) {
    const GpgpVertexAttribute& attribute = wanted.attributes[i];
    const uint32_t format = formatOf(attribute.format);
    if (attribute.semantic >= kVertexSemantics)
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "vertices->attributes[%u].semantic is unknown (%u)", i,
                             attribute.semantic);
    if (format == kUnknown || (format == kVertexUint) != (attribute.semantic >= kVertexBucket))
      return core::makeError(GPGP_ERROR_INVALID_ARGUMENT,
                             "vertices->attributes[%u].format (%d) is not one for its semantic", i,
                             static_cast<int>(attribute.format));
    if (attribute.offset % 4 || attribute.offset >= wanted.stride ||
        attribute.offset + 4 * attributeWords(format) > wanted.stride)
      return core::makeError(
          GPGP_ERROR_INVALID_ARGUMENT,
          "vertices->attributes[%u].offset is %u; it must be a multiple of 4, and the attribute must "
          "lie in the vertex",
          i, attribute.offset);
    layout.attributes[i] = vertexAttribute(attribute.offset / 4, attribute.semantic, format);
  }
  return layout;
}

} // namespace gpgp::spawn
