// Triangles of RmlUi, and the boxes with round corners that they stand for.
#pragma once
#include <gpgp/ui.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace gpgp::rmlui {

using Box = std::array<float, 4>; ///< left, top, right, bottom
Box meet(const Box& a, const Box& b);
inline bool empty(const Box& box) { return !(box[0] < box[2] && box[1] < box[3]); }

struct RoundBox {
  Box box{};
  std::array<float, 4> radii{}; ///< top left, top right, bottom right, bottom left
};

/// Colours are premultiplied and sRGB, texture coordinates are RmlUi's.
struct Geometry {
  std::vector<GpgpListVertex> vertices;
  std::vector<uint32_t> indices;
  std::optional<RoundBox> shape; ///< the triangles fill it
};
using GeometryPointer = std::shared_ptr<const Geometry>;

/// The box with round corners that triangles fill, as RmlUi's backgrounds do: a clip or a gradient in it then has exact
/// curves and needs no picture. Nothing: they fill something else.
std::optional<RoundBox> findShape(std::span<const GpgpListVertex> vertices, std::span<const uint32_t> indices);

Box boundsOf(const Geometry& geometry);
/// Two opaque white triangles.
GeometryPointer boxGeometry(const Box& box);

} // namespace gpgp::rmlui
