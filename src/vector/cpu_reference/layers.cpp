#include "vector/cpu_reference/layers.h"

#include "vector/layers/blend.h"

#include <glm/packing.hpp>

namespace gpgp::shader {
using glm::normalize;

namespace {
class Operator {
public:
  Operator(std::span<uvec2> pixels, std::span<const vector::AssetTable> assets) : pixels_(pixels), assets_(assets) {}

  void run(const OperationRecord& o) {
    for (int y = o.result.top; y < o.result.bottom; ++y)
      for (int x = o.result.left; x < o.result.right; ++x) {
        const vec4 color = resultAt(o, x, y);
        uvec2& pixel = pixels_[place(o.result, x, y)];
        pixel.x = glm::packHalf2x16({color.x, color.y});
        pixel.y = glm::packHalf2x16({color.z, color.w});
      }
  }

private:
  static size_t place(const PictureRecord& p, int x, int y) {
    return p.first + static_cast<size_t>(y - p.top) * p.stride + static_cast<size_t>(x - p.left);
  }
  vec4 texelAt(const PictureRecord& p, int x, int y) const {
    if (x < p.left || x >= p.right || y < p.top || y >= p.bottom) return vec4(0.0f);
    const uvec2 pixel = pixels_[place(p, x, y)];
    const vec2 a = glm::unpackHalf2x16(pixel.x), b = glm::unpackHalf2x16(pixel.y);
    return {a.x, a.y, b.x, b.y};
  }
  const vec4& tableAt(uint slot, uint entry) const { return vector::tableOf(assets_, slot)[entry]; }

#include "vector/layers/operate.h"

  vec4 resultAt(const OperationRecord& o, int x, int y) {
    switch (o.kind) {
    case kOperationComposite: return compositeAt(o, x, y);
    case kOperationBlur: return blurAt(o, x, y);
    case kOperationShrink: return shrinkAt(o, x, y);
    case kOperationGrow: return growAt(o, x, y);
    case kOperationTurbulence: return noiseAt(o, x, y) * inRegion(o, x, y);
    case kOperationLight: return lightAt(o, x, y) * inRegion(o, x, y);
    case kOperationMorphology:
    case kOperationConvolve:
    case kOperationDisplace:
    case kOperationTile: return neighbourhoodAt(o, x, y) * inRegion(o, x, y);
    default: return colorAt(o, x, y) * inRegion(o, x, y);
    }
  }

  std::span<uvec2> pixels_;
  std::span<const vector::AssetTable> assets_;
};
} // namespace
} // namespace gpgp::shader

namespace gpgp::vector {

void operateOnCpu(std::span<const shader::OperationRecord> operations, std::span<shader::uvec2> pixels,
                  std::span<const AssetTable> assets) {
  shader::Operator op(pixels, assets);
  for (const shader::OperationRecord& o : operations.subspan(1)) op.run(o);
}

} // namespace gpgp::vector
