#!/usr/bin/env bash
# The code of docs/guide/integrate_in_ten_minutes.md compiles: its C blocks as one C99 file, its C++ blocks as one C++17
# file; and so does the C of the guides of spawn, worlds, levels of detail, fields, fits, scattering, vector, Lottie and user interfaces.
# The links of README.md, of all pages below docs/ and of the integrations' pages lead to files, and to headings of
# these where a link names one; docs/README.md lists each page, and docs/guide/integrations.md each integration's, which
# has the sections that they all have.
# Guides have at most 12 KB, internals 16, results 10: what does not fit is not for that reader.
#
#   pages_test.sh INCLUDE_DIRS DOCS CC CXX     INCLUDE_DIRS: separated by colons
set -euo pipefail
IFS=: read -ra includes <<<"$1"
docs=$2 cc=$3 cxx=$4
page=$docs/guide/integrate_in_ten_minutes.md
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
for guide in spawn world level_of_detail fields fit scatter vector lottie patches ui; do
  [[ $(page=$docs/guide/$guide.md code c | grep -c .) -gt 15 ]] || { echo "no code in guide/$guide.md" >&2; exit 1; }
  echo "guide/$guide.md"
  page=$docs/guide/$guide.md code c | "$cc" -std=c99 "${flags[@]}" -x c -
done
for limit in guide:12 internals:16 results:10; do
  for from in "$docs/${limit%:*}"/*.md; do
    [[ $(wc -c <"$from") -le $((${limit#*:} * 1024)) ]] ||
      { echo "FAILED: $from has more than ${limit#*:} KB" >&2; failed=yes; }
  done
done
# anchors PAGE: of its headings, as GitHub makes them: lower case, spaces to hyphens, punctuation dropped.
anchors() {
  awk '/^```/ { code = !code } !code && /^#+ / { sub(/^#+ +/, ""); print tolower($0) }' "$1" |
    sed -E 's/\]\([^)]*\)//g; s/[^[:alnum:] _-]//g; s/ /-/g'
}
for from in "$docs/../README.md" "$docs"/*.md "$docs"/*/*.md "$docs"/../integrations/*/README.md; do
  while read -r link; do
    target=$(dirname "$from")/${link%%#*}
    [[ $link != '#'* ]] || target=$from
    [[ -e $target ]] || { echo "FAILED: $from links to $link, which does not exist" >&2; failed=yes; continue; }
    [[ $target != *.md || $link != *'#'* ]] || anchors "$target" | grep -xF -e "${link#*#}" >/dev/null ||
      { echo "FAILED: $from links to $link, a heading that is not there" >&2; failed=yes; }
  done < <(grep -oE '\]\([^)]+\)' "$from" | sed -E 's/^\]\(|\)$//g' | grep -vE '^(https?:|mailto:)')
  name=${from#"$docs/"}
  grep -qF "($name)" "$docs/README.md" || [[ $name == README.md || $name == /* || $name == ../* ]] ||
    { echo "FAILED: docs/README.md does not list $name" >&2; failed=yes; }
done
for from in "$docs"/../integrations/*/README.md; do
  name=$(basename "$(dirname "$from")")
  grep -qF "(../../integrations/$name/README.md)" "$docs/guide/integrations.md" ||
    { echo "FAILED: docs/guide/integrations.md does not list $name" >&2; failed=yes; }
  for section in "Ten minutes" "Where in the frame to record" "Which barriers" "What is trashed" "Known limits"; do
    grep -q "^## $section$" "$from" || { echo "FAILED: $from has no section $section" >&2; failed=yes; }
  done
  grep -q '^\*\*Support: ' "$from" || { echo "FAILED: $from does not say its support level" >&2; failed=yes; }
done
[[ $failed == no ]]
echo "$(code c | grep -c .) lines of C, $(code cpp | grep -c .) lines of C++"
