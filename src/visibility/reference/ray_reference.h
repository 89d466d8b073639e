// Which triangles a camera sees, by rays: a reference that shares no rounding with the recorder. All of it is double
// precision; corners are not snapped.
//
// Rays go through the middles of samples x samples parts of each pixel, and through its centre. A triangle has the
// points inside its outline and on it, so that a ray through an edge that two triangles share meets at least one of
// them, and the nearest triangle is what a ray sees; where two are equally near (to 2^-30 of their distance) the lower
// number. Triangles that face away are not there. A rim as wide as the corners' rounding to float numbers, at most
// 1/1024 pixel, hides what lies behind it but is not seen itself: nothing shows through the crack between an edge and a
// corner that was meant to lie on it. Alpha-tested triangles are there where their texture says so. A see-through one
// hides nothing, and all rays see it that nothing stops before it.
#pragma once
#include "visibility/reference/ray_scene.h"

#include <functional>

namespace gpgp::visibility {

/// Does work(i) for each i below count, on any threads.
using ForEach = std::function<void(size_t count, const std::function<void(size_t)>& work)>;

class RayReference {
public:
  /// The scene's buffers must outlive it. Triangles with a corner that is not finite or reaches 2^100 are left out.
  RayReference(const RayScene& scene, ForEach forEach);

  /// Adds what a camera sees. `told` hears, on any thread, how many of how many parts of the picture are done.
  void add(const GpgpCamera& camera, uint32_t width, uint32_t height, uint32_t samples,
           const std::function<void(size_t, size_t)>& told = {});

  /// By triangle number: the rays of all cameras that see it, at most 2^32 - 1.
  std::vector<uint32_t> areas() const;
  /// A bit for each that any ray sees.
  std::vector<uint32_t> bits() const;

private:
  const RayTriangles triangles_;
  ForEach forEach_;
  std::vector<uint64_t> counts_;
};

} // namespace gpgp::visibility
