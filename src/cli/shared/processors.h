// Independent pieces of work on all processors.
#pragma once
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gpgp::cli {

/// work(i) for each i below count, in no stated order; the first exception is thrown again here.
template <class Work> void onAllProcessors(size_t count, const Work& work) {
  std::atomic<size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto run = [&] {
    for (size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
      }
  };
  std::vector<std::thread> threads;
  const size_t most = std::min<size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
  for (size_t t = 1; t < most; ++t) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
  if (error) std::rethrow_exception(error);
}

} // namespace gpgp::cli
