#!/usr/bin/env bash
# The layout of all source: clang-format for C and C++ (shader headers included), lines of at most 120 characters in
# shaders, no tabs or blanks at line ends, no notes of unfinished work.
#
#   tests/format/format.sh          says what is wrong; exits 1 where anything is
#   tests/format/format.sh --fix    lets clang-format mend what it can, then the same
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
clang_format=${CLANG_FORMAT:-$(command -v clang-format-14 || command -v clang-format)}
folders=(include src shaders samples integrations tests)
failed=no

# list EXTENSION...: the files below the folders.
list() {
  local pattern=$1
  shift
  pattern+=$(printf '|%s' "$@")
  find "${folders[@]}" CMakeLists.txt -type f | grep -E "\.($pattern)$" | LC_ALL=C sort
}

mapfile -t sources < <(list h hpp c cpp)
[[ ${#sources[@]} -gt 0 ]]
if [[ ${1:-} == --fix ]]; then "$clang_format" -i "${sources[@]}"; fi
if ! report=$("$clang_format" --dry-run -Werror "${sources[@]}" 2>&1); then
  echo "clang-format would change (tests/format/format.sh --fix does):" >&2
  grep -oE '^[^ :]+:[0-9]+: error|^[^ :]+:[0-9]+:[0-9]+: error' <<<"$report" | sed -E 's/: error$//' | sort -u >&2
  failed=yes
fi

# complain MESSAGE PATTERN FILE...: lists what matches.
complain() {
  local message=$1 pattern=$2 found
  shift 2
  found=$(LC_ALL=C.UTF-8 grep -nE "$pattern" "$@" | cut -c1-160 || true)
  if [[ -n $found ]]; then
    printf '%s\n%s\n' "$message:" "$found" >&2
    failed=yes
  fi
}
mapfile -t shaders < <(list h comp vert frag glsl)
mapfile -t texts < <(list h hpp c cpp comp vert frag glsl cmake sh awk txt)
complain "lines longer than 120 characters" '^.{121,}' "${shaders[@]}"
complain "tabs, or blanks at the end of a line" $'\t| $' "${texts[@]}"
complain "notes of unfinished work" '\b(TO[D]O|FIX[M]E|X[X]X|HA[C]K)\b' "${texts[@]}"

echo "${#sources[@]} files through clang-format, ${#texts[@]} through the other checks"
[[ $failed == no ]]
