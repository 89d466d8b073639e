#!/usr/bin/env bash
# Each C header alone, and all their structs, compile as C99, C11, C17, C++11, C++17 and C++20; the C++ headers, each
# alone, as C++17 and C++20; warnings are errors; with every compiler named.
#
#   headers_test.sh INCLUDE_DIRS SOURCE_DIR CC:CXX...     INCLUDE_DIRS: separated by colons
set -uo pipefail
IFS=: read -ra includes <<<"$1"
sources=$2
shift 2
flags=(-fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wundef -Wold-style-cast -Werror)
for include in "${includes[@]}"; do flags+=(-I "$include"); done
gpgp=${includes[0]}/gpgp
[[ -f $gpgp/gpgp.h && -f $gpgp/gpgp.hpp ]] || { echo "no headers in $gpgp" >&2; exit 1; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
checked=0
failed=0

# compile STANDARD LANGUAGE COMPILER FILE NAME
compile() {
  local warnings=("${flags[@]}")
  if [[ $2 == c ]]; then warnings=("${warnings[@]/-Wold-style-cast/-Wstrict-prototypes}"); fi
  checked=$((checked + 1))
  if ! "$3" "-std=$1" -x "$2" "${warnings[@]}" "$4"; then
    echo "FAILED: $5 as $1 with $3" >&2
    failed=$((failed + 1))
  fi
}

for pair in "$@"; do
  cc=${pair%%:*} cxx=${pair##*:}
  for compiler in "$cc" "$cxx"; do
    command -v "$compiler" >/dev/null || { echo "no compiler $compiler" >&2; exit 1; }
  done
  for path in "$gpgp"/*.h; do
    header=$(basename "$path" .h)
    echo "#include <gpgp/$header.h>" >"$scratch/$header.c"
    # Once more after all others, so that no header minds another before it.
    printf '#include <gpgp/gpgp.h>\n#include <gpgp/%s.h>\n' "$header" >>"$scratch/$header.c"
    for standard in c99 c11 c17; do compile "$standard" c "$cc" "$scratch/$header.c" "gpgp/$header.h"; done
    for standard in c++11 c++17 c++20; do compile "$standard" c++ "$cxx" "$scratch/$header.c" "gpgp/$header.h"; done
  done
  for standard in c99 c11 c17; do compile "$standard" c "$cc" "$sources/structs.c" structs; done
  for standard in c++11 c++17 c++20; do compile "$standard" c++ "$cxx" "$sources/structs.c" structs; done
  for standard in c++17 c++20; do compile "$standard" c++ "$cxx" "$sources/wrapper.cpp" gpgp/gpgp.hpp; done
  for path in "$gpgp"/*.hpp; do # each alone
    header=$(basename "$path" .hpp)
    echo "#include <gpgp/$header.hpp>" >"$scratch/$header.cpp"
    for standard in c++17 c++20; do compile "$standard" c++ "$cxx" "$scratch/$header.cpp" "gpgp/$header.hpp"; done
  done
done
echo "$checked compilations, $failed failed"
[[ $checked -gt 0 && $failed -eq 0 ]]
