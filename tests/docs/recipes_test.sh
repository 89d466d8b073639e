#!/usr/bin/env bash
# What docs/CONTRIBUTING.md names is there: files and folders by their paths, files by their names alone, and of each
# "`name` in `path`" and "`name` (`path`)" the name in that file.
#
#   recipes_test.sh SOURCE_DIR
set -euo pipefail
cd "$1"
page=docs/CONTRIBUTING.md
files=$(find docs include samples shaders src tests -path tests/data/fetched -prune -o -type f -print)
failed=0
fail() {
  echo "FAILED: $page names $1" >&2
  failed=1
}
text=$(tr '\n' ' ' <$page | sed -E 's/ +/ /g') # sentences have line breaks
paths=$(grep -oE '`[A-Za-z0-9_./]+`' <<<"$text" | tr -d '`' | sort -u | grep -E '/|[a-z]\.(cpp|h|hpp|comp|glsl|md|sh|txt|cmake|json|pga)$')
[[ $(wc -l <<<"$paths") -ge 40 ]] || { echo "FAILED: $page was not read" >&2; exit 1; }
while read -r path; do
  [[ -e $path ]] || grep -qE "(^|/)${path//./\\.}\$" <<<"$files" || fail "'$path', which is not there"
done <<<"$paths"
pairs=$(grep -oE '`[A-Za-z_]+`,? (in |of |\()`[a-z_/]+\.(cpp|h)`' <<<"$text" | sed -E 's/`([A-Za-z_]+)`,? (in |of |\()`(.*)`/\1 \3/')
[[ $(wc -l <<<"$pairs") -ge 6 ]] || { echo "FAILED: $page has no pairs" >&2; exit 1; }
while read -r name file; do
  [[ $file == */* ]] || file=$(grep -E "/${file//./\\.}\$" <<<"$files" | head -n 1)
  [[ -f $file ]] && grep -qw -- "$name" "$file" || fail "'$name' in '$file', where it is not"
done <<<"$pairs"
exit $failed
