#!/usr/bin/env bash
# Builds every fuzz target with libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer (preset `fuzz`, clang 14 with
# libclang-rt-14-dev) and runs each on its corpus for a while, one process a target. Prints a line for each: inputs run,
# edges covered, and OK or the file that fails.
#
#   tests/fuzz/run.sh [SECONDS [TARGET...]]   default: 1800 seconds each, all targets
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:-1800}
shift || true
cmake --preset fuzz >/dev/null
mapfile -t all < <(grep -o '^build fuzz_[a-z_]*:' build/fuzz/build.ninja | sed 's/^build //; s/:$//' | sort)
targets=("$@")
[[ ${#targets[@]} -gt 0 ]] || targets=("${all[@]}")
cmake --build --preset fuzz --target "${targets[@]}" --parallel "$(nproc)"
failed=0
for target in "${targets[@]}"; do
  work=build/fuzz/corpus/$target
  mkdir -p "$work"
  # What is found goes into the first folder; the others are what tests have for all parsers: each takes what it can.
  corpus=(tests/data/{grammars,graphs,lsystems,cga,svg,lottie,path_data,css,text,cases} samples/{gml,cga,grammars})
  log=build/fuzz/$target.log
  if "build/fuzz/$target" "$work" "${corpus[@]}" -max_total_time="$seconds" -max_len=16384 -timeout=20 \
    -rss_limit_mb=3000 -close_fd_mask=2 -artifact_prefix="build/fuzz/$target-" >"$log" 2>&1; then
    state=OK
  else
    state="FAILED, see $log"
    failed=1
  fi
  printf '%-22s %s: %s\n' "$target" "$(grep -o 'cov: [0-9]*' "$log" | tail -1), $(grep -o '^#[0-9]*' "$log" | tail -1 | tr -d '#') inputs" "$state"
done
exit $failed
