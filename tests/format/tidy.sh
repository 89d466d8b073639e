#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy. By default on what everything else rests on, and without the static
# analyser: seconds, so that it can be a test. Needs a build directory with compile_commands.json and the shader headers.
#
#   tests/format/tidy.sh BUILD_DIR          src/core and src/api
#   tests/format/tidy.sh BUILD_DIR --all    every source of src/, samples/, integrations/ and tests/, static analyser included: minutes
set -euo pipefail
build=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
clang_tidy=${CLANG_TIDY:-$(command -v clang-tidy-14 || command -v clang-tidy)}
# What the other compiler is told that clang does not know: its precompiled headers, a warning.
commands=$(mktemp -d)
trap 'rm -rf "$commands"' EXIT
sed -E 's/ -Winvalid-pch//g; s/ -include [^ ]*cmake_pch\.hxx//g; s/ -Wno-(restrict|stringop-over(flow|read))//g' "$build/compile_commands.json" \
  >"$commands/compile_commands.json"
options=(-p "$commands" --quiet)
if [[ ${2:-} == --all ]]; then
  mapfile -t sources < <(find src samples integrations tests -name '*.cpp' | LC_ALL=C sort)
else
  mapfile -t sources < <(find src/core src/api -name '*.cpp' | LC_ALL=C sort)
  options+=(--checks=-clang-analyzer-*)
fi
# Only what this build compiles: a service that is switched off has no command.
compiled=()
for source in "${sources[@]}"; do
  if grep -qF "/$source\"" "$build/compile_commands.json"; then compiled+=("$source"); fi
done
[[ ${#compiled[@]} -gt 0 ]]
# The notes on standard error count warnings of system headers; what matters is on standard output and in the exit code.
printf '%s\0' "${compiled[@]}" | xargs -0 -n 1 -P "$(nproc)" "$clang_tidy" "${options[@]}" 2>/dev/null
echo "${#compiled[@]} files"
