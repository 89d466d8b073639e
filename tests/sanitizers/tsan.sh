#!/usr/bin/env bash
# Builds the test of threads for ThreadSanitizer in the preset `release` (what else it needs is built already there) and
# runs it on lavapipe: loading threads create assets of all kinds while frames are advanced and recorded. Fails at the
# first report that tests/sanitizers/tsan.supp does not name.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
cmake --build --preset release --target threads_tsan --parallel "${1:-$(nproc)}"
# Addresses of one layout: ThreadSanitizer of GCC 12 does not find its shadow where kernels spread them further.
TSAN_OPTIONS="suppressions=$PWD/tests/sanitizers/tsan.supp:halt_on_error=1:second_deadlock_stack=1" \
  setarch "$(uname -m)" --addr-no-randomize build/release/threads_tsan
