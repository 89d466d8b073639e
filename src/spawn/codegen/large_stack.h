// Work that recurs as deep as its input says: compilers and optimisers of others.
#pragma once
#include <functional>

namespace gpgp::spawn {

constexpr size_t kLargeStack = size_t(512) << 20; ///< bytes; systems give memory only to what is used of them

/// Does the work on a thread of its own with a stack of kLargeStack, and waits for it. Exceptions come through. False,
/// without the work done, where there can be no such thread.
bool onLargeStack(const std::function<void()>& work);

} // namespace gpgp::spawn
