#!/usr/bin/env bash
# The code of docs/integrate_in_ten_minutes.md compiles: its C blocks as one C99 file, its C++ blocks as one C++17 file;
# and so does the C of docs/ui.md.
# The links of README.md and of all pages beside that one lead to files, and docs/README.md lists each page.
#
#   pages_test.sh INCLUDE_DIRS PAGE CC CXX     INCLUDE_DIRS: separated by colons
set -euo pipefail
IFS=: read -ra includes <<<"$1"
page=$2 cc=$3 cxx=$4
flags=(-fsyntax-only -Wall -Wextra -Wpedantic -Werror -Wno-unused-function)
for include in "${includes[@]}"; do flags+=(-I "$include"); done
# code LANGUAGE: the blocks of the page in that language; other lines are left empty, so that errors name the page's lines.
code() {
  awk -v open="\`\`\`$1" '$0 == open { inside = 1; print ""; next } /^```/ { inside = 0 } { print inside ? $0 : "" }' "$page"
}
[[ $(code c | grep -c .) -gt 50 && $(code cpp | grep -c .) -gt 5 ]] || { echo "no code in $page" >&2; exit 1; }
code c | "$cc" -std=c99 "${flags[@]}" -x c -
code cpp | "$cxx" -std=c++17 "${flags[@]}" -x c++ -
failed=no
docs=$(dirname "$page")
[[ $(page=$docs/ui.md code c | grep -c .) -gt 15 ]] || { echo "no code in $docs/ui.md" >&2; exit 1; }
page=$docs/ui.md code c | "$cc" -std=c99 "${flags[@]}" -x c -
for from in "$docs/../README.md" "$docs"/*.md; do
  while read -r link; do
    target=$(dirname "$from")/${link%%#*}
    [[ -e $target ]] || { echo "FAILED: $from links to $link, which is not there" >&2; failed=yes; }
  done < <(grep -oE '\]\([^)]+\)' "$from" | sed -E 's/^\]\(|\)$//g' | grep -vE '^(https?:|mailto:|#)')
  name=$(basename "$from")
  grep -q "($name)" "$docs/README.md" || [[ $name == README.md ]] ||
    { echo "FAILED: docs/README.md does not list $name" >&2; failed=yes; }
done
[[ $failed == no ]]
echo "$(code c | grep -c .) lines of C, $(code cpp | grep -c .) lines of C++"
