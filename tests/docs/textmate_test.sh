#!/usr/bin/env bash
# Every word of a language is in its TextMate grammar (integrations/editors): what the tables of the front ends list.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
failed=no

# check LANGUAGE WORD...: each is an alternative in a pattern. Points are escaped there.
check() {
  local file=integrations/editors/$1.tmLanguage.json language=$1 count=0
  shift
  for word in "$@"; do
    count=$((count + 1))
    if ! grep -qF -e "(${word//./\\\\.}|" -e "|${word//./\\\\.}|" -e "|${word//./\\\\.})" "$file"; then
      echo "$file lacks '$word'" >&2
      failed=yes
    fi
  done
  if ((count < 20)); then
    echo "found only $count words of $language in its sources" >&2
    failed=yes
  fi
}

# rows MACRO FILE: the first column of a table, or the text in its second one.
rows() { sed -n "/define $1(X)/,/[^\\\\]\$/p" "$2" | grep -oE '\bX\(\w+(, "\w+")?' | sed -E 's/X\(//; s/.*"(.*)"/\1/'; }

mapfile -t words < <(tr -d '\n' <<<"$(cat src/spawn/gml/operators_*.cpp)" |
  grep -oE '\{"[a-z0-9]+", +"[a-zA-Z*]*", +[0-9]' | sed -E 's/^\{"([a-z0-9]+)".*/\1/' | sort -u)
check gml "${words[@]}" X Y Z ADJUST_TO_FILL ANCHOR_TO_START ANCHOR_TO_END

mapfile -t words < <(grep -oE '\{"\w+", (&Parser|GPGP_SHAPE)' src/spawn/lsystem/parser.cpp | cut -d'"' -f2
  grep -oE '\{"\w+",' src/spawn/lsystem/expressions.cpp | cut -d'"' -f2)
# What headings of other languages are called within: no word of a file.
mapfile -t words < <(printf '%s\n' "${words[@]}" | grep -vxE 'depth|endcode|arrays')
check lsys "${words[@]}"

names=src/spawn/cga/names.h
mapfile -t words < <(
  { rows GPGP_CGA_OPERATIONS $names; rows GPGP_CGA_SETTABLE $names; rows GPGP_CGA_FUNCTIONS $names
    rows GPGP_CGA_MATH shaders/spawn/cga/program_format.h; } | sed -E \
    -e '/^(scope|geometry|pivot|split|comp|initialShape|material|trim|edgeAttr)_/s/_/./g' -e 's/^printed$/print/' \
    -e '/^(componentValues|arrayRows|sequence|eachAnd|eachOr|eachNot|componentResult)$/d')
check cga "${words[@]}" attr const import style extends case else version
[[ $failed == no ]]
