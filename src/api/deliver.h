// Arrays that the caller brings, filled as far as there is room.
#pragma once
#include "core/result.h"

#include <algorithm>
#include <cstdint>

namespace gpgp::api {

/// As many as there is room for, by item(i); *count becomes how many there are.
template <class T, class Item>
core::Result<void> deliver(uint32_t all, uint32_t* count, T* to, const char* what, const Item& item) {
  if (!count) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "count is NULL");
  const uint32_t written = to ? std::min(*count, all) : 0;
  for (uint32_t i = 0; i < written; ++i) to[i] = item(i);
  *count = all;
  if (to && written < all) return core::makeError(GPGP_INCOMPLETE, "%s is too small", what);
  return {};
}

} // namespace gpgp::api
