// The pool's memory, and what statuses mean.
#include "spawn/geometry/geometry.h"

#include <algorithm>

namespace gpgp::spawn {

GeometryPool::GeometryPool(uint32_t capacityWords, uint32_t workWords)
    : words_(std::max(capacityWords, 1u)), work_(workWords) {
  words = words_.data();
  capacity = uint32_t(words_.size());
  work = work_.data();
  workCapacity = workWords;
}

void GeometryPool::clear() {
  used = needed = 1;
  dropped = workUsed = workNeeded = 0;
}

std::string_view describeStatus(Status status) {
  static constexpr std::string_view kTexts[] = {"",
                                                "nothing is left of the shape",
                                                "the geometry pool is full",
                                                "a face has more than 1024 corners, or the shape is too large",
                                                "the polygon touches or crosses itself",
                                                "the face does not lie in a plane",
                                                "an argument is outside of what the operation takes",
                                                "edges that move by different distances could not be followed"};
  return kTexts[std::min<size_t>(status, std::size(kTexts) - 1)];
}

} // namespace gpgp::spawn
