// The boxes of buckets, from instances.
#pragma once
#include <gpgp/spawn.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gpgp::test {

inline void expectBounds(const std::vector<GpgpSpawnBounds>& found, const std::vector<GpgpInstance>& instances) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<GpgpSpawnBounds> expected(found.size(),
                                        {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}});
  for (const GpgpInstance& i : instances) {
    ASSERT_LT(i.bucket, expected.size());
    for (int axis = 0; axis < 3; ++axis) {
      const float* row = i.transform + axis * 4;
      const float reach = 0.5f * (std::abs(row[0]) + std::abs(row[1]) + (i.size[2] == 0 ? 0 : std::abs(row[2])));
      GpgpSpawnBounds& b = expected[i.bucket];
      b.min[axis] = std::min(b.min[axis], row[3] - reach);
      b.max[axis] = std::max(b.max[axis], row[3] + reach);
    }
  }
  for (size_t bucket = 0; bucket < found.size(); ++bucket)
    for (int axis = 0; axis < 3; ++axis) {
      const float low = expected[bucket].min[axis], high = expected[bucket].max[axis];
      if (low > high) {
        ASSERT_EQ(found[bucket].min[axis], kInfinity) << "bucket " << bucket;
        ASSERT_EQ(found[bucket].max[axis], -kInfinity) << "bucket " << bucket;
      } else {
        const float near = 1e-5f * (1 + std::max(std::abs(low), std::abs(high)));
        ASSERT_NEAR(found[bucket].min[axis], low, near) << "bucket " << bucket << ", axis " << axis;
        ASSERT_NEAR(found[bucket].max[axis], high, near) << "bucket " << bucket << ", axis " << axis;
      }
    }
}

} // namespace gpgp::test
