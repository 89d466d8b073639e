// Kernels behind graphs, in tests.
#pragma once
#include "spawn/codegen/compile_kernel.h"
#include "spawn/codegen/generate.h"
#include "spawn/graph/blob.h"
#include "spawn/graph/kernel.h"

#include <gtest/gtest.h>

#include <vector>

namespace gpgp::test {

/// The grammar with one more kernel's bytes behind it; fails the test and adds none where it does not compile.
inline std::vector<uint32_t> withKernel(std::vector<uint32_t> words, const spawn::KernelSource& source,
                                        spawn::KernelTarget target, const spawn::Fit& fit = {},
                                        spawn::Queues queues = spawn::Queues::mixed) {
  const auto code = spawn::compileKernel(source, target);
  if (!code) {
    ADD_FAILURE() << code.error().text;
    return words;
  }
  spawn::KernelInfo info;
  info.target = target;
  info.fit = fit;
  info.queues = queues;
  const auto kernel = spawn::serialize(info, *code, words[shader::kHeaderChecksum], std::pmr::new_delete_resource());
  words.insert(words.end(), kernel.begin(), kernel.end());
  return words;
}

} // namespace gpgp::test
