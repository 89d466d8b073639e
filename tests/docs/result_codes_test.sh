#!/usr/bin/env bash
# Every result code of core.h has its row in docs/guide/troubleshooting.md, with a cause, and nothing else has one.
#
#   result_codes_test.sh SOURCE_DIR
set -euo pipefail
page=$1/docs/guide/troubleshooting.md
codes=$(awk '/^typedef int32_t GpgpResult;/ { inside = 1 } inside && /^};/ { exit } inside' "$1/include/gpgp/core.h" |
  sed -nE 's/^ *(GPGP_[A-Z_]+) = -?[0-9]+.*/\1/p' | sort)
rows=$(sed -nE 's/^\| `(GPGP_[A-Z_]+)` \|.*/\1/p' "$page" | sort)
[[ $(wc -l <<<"$codes") -ge 18 ]] || { echo "FAILED: core.h was not read" >&2; exit 1; }
if ! diff <(echo "$codes") <(echo "$rows") >&2; then
  echo "FAILED: < has no row in $page, > is no result code, or has two" >&2
  exit 1
fi
if grep -nE '^\| `GPGP_[A-Z_]+` \|( *\|)* *$' "$page" >&2; then
  echo "FAILED: a row says nothing" >&2
  exit 1
fi
echo "$(wc -l <<<"$codes") result codes"
