// Runs what a program does at run time with the n-th allocation failing, or that and all after it, for every n: each
// call that fails says so, has changed nothing or emptied what its documentation says, and succeeds when made again.
#pragma once
#include "aligned.h"
#include "counting_new.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace gpgp::test {

/// An engine's host allocator that fails with operator new, by one count; counts what lives.
struct FailingHost {
  int64_t living = 0;
  GpgpHostAllocator callbacks() {
    return {this,
            [](void* user, size_t size, size_t alignment) -> void* {
              if (allocationFails()) return nullptr;
              ++static_cast<FailingHost*>(user)->living;
              return allocateAligned(size, alignment);
            },
            [](void* user, void* memory, size_t, size_t) {
              --static_cast<FailingHost*>(user)->living;
              freeAligned(memory);
            }};
  }
};

/// Messages of severity ERROR, which the library may send while there is no memory.
struct ErrorCount {
  uint32_t errors = 0;
  char last[256] = "no error";
  template <class Message> static void GPGP_CALL count(void* user, const Message* message) {
    if (message->severity != GPGP_SEVERITY_ERROR) return;
    ErrorCount& self = *static_cast<ErrorCount*>(user);
    ++self.errors;
    std::snprintf(self.last, sizeof self.last, "%s", message->text);
  }
};

struct FaultJob {
  std::function<void()> begin = [] {};            ///< leads to the same state each time
  std::vector<std::function<GpgpResult()>> calls; ///< in turn; any of them may run out of memory
  std::function<std::string()> state;             ///< of all that the calls work on; works at any time
  std::function<void()> end = [] {};              ///< destroys what begin and the calls have made
  std::string emptied;                            ///< not empty: what a call that fails may leave, too
  bool newsAreOurs = true;                        ///< no driver allocates beside the calls
  const ErrorCount* messages = nullptr;           ///< where not null, each failure sends at most one
};

inline void sweepFaults(const FaultJob& job) {
  std::vector<std::string> states;    // before each call, and at the end
  for (int run = 0; run < 2; ++run) { // the first run fills what is kept for ever
    states.clear();
    job.begin();
    for (const auto& call : job.calls) {
      states.push_back(job.state());
      ASSERT_EQ(call(), GPGP_SUCCESS) << "call " << states.size() - 1 << ": "
                                      << (job.messages ? job.messages->last : "");
    }
    states.push_back(job.state());
    job.end();
  }
  uint64_t failures = 0;
  for (const bool onwards : {false, true})
    for (uint64_t n = 1;; ++n) {
      ASSERT_LT(n, 20000u) << "it never ends";
      const int64_t before = livingNews();
      job.begin();
      bool failed = false;
      uint64_t tried = 0;
      for (size_t i = 0; i < job.calls.size(); ++i) {
        const uint32_t messages = job.messages ? job.messages->errors : 0;
        if (!failed) failAllocations(n > tried ? n - tried : 0, onwards);
        GpgpResult result = GPGP_SUCCESS;
        try {
          result = job.calls[i]();
        } catch (...) {
          failAllocations(0, false);
          FAIL() << "call " << i << " threw, n = " << n << (onwards ? " and all after it" : "");
        }
        if (!failed) tried += allocationsTried();
        failAllocations(0, false);
        if (result == GPGP_ERROR_OUT_OF_HOST_MEMORY && !failed) {
          failed = true;
          ++failures;
          if (job.messages) {
            ASSERT_LE(job.messages->errors, messages + 1) << "more than a message for an error, call " << i;
          }
          if (const std::string left = job.state(); job.emptied.empty() || left != job.emptied) {
            ASSERT_EQ(left, states[i]) << "call " << i << " failed and changed something, n = " << n;
          }
          result = job.calls[i]();
        }
        ASSERT_EQ(result, GPGP_SUCCESS) << "call " << i << ", n = " << n << (onwards ? " and all after it" : "");
      }
      ASSERT_EQ(job.state(), states.back()) << "n = " << n << (onwards ? " and all after it" : "");
      job.end();
      if (canFailNew() && job.newsAreOurs) {
        ASSERT_EQ(livingNews(), before) << "leaked, n = " << n << (onwards ? " and all after it" : "");
      }
      if (!failed && tried < n) break;
    }
  if (canFailNew()) {
    EXPECT_GT(failures, 0u) << "the sweep provoked nothing";
  }
}

} // namespace gpgp::test
