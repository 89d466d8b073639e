#!/usr/bin/env bash
# What the libraries define and need, by nm:
#   - no undefined vk* symbol: Vulkan comes from the engine's vkGetInstanceProcAddr alone
#   - a shared library exports the GPGP_API functions of what was built, each of them and nothing else
#   - a static library defines the same functions; its other strong symbols are in namespace gpgp
#
#   symbols_test.sh NM INCLUDE_DIR TEST_DIR KIND LIBRARY HEADER...
#
# KIND: run-time, compiler, evaluator or text; HEADER: whose functions of that kind LIBRARY must have (core spawn vector ...).
set -euo pipefail
nm=$1 include=$2 tests=$3 kind=$4 library=$5
shift 5
failed=no
fail() {
  echo "FAILED: $library: $*" >&2
  failed=yes
}

headers=()
for header in "$@"; do headers+=("$include/gpgp/$header.h"); done
expected=$(awk -f "$tests/declarations.awk" "${headers[@]}" | awk -F'\t' -v kind="$kind" \
  '(index($3, "In libgpgp_compiler") > 0) == (kind == "compiler") { print $1 }' | LC_ALL=C sort)
# The names of results and the version are in each library, so that each can be used alone.
expected=$(printf '%s\n' "$expected" gpgpGetVersion gpgpResultString | LC_ALL=C sort -u)
[[ -n $expected ]] || fail "the headers declare no $kind function"

dynamic=()
case $library in *.so*) dynamic=(-D) ;; esac
undefined=$("$nm" "${dynamic[@]}" --undefined-only "$library" 2>/dev/null | awk 'NF == 2 { print $2 }')
defined=$("$nm" "${dynamic[@]}" --extern-only --defined-only --demangle "$library" 2>/dev/null |
  sed -nE 's/^[0-9a-f]+ ([A-Za-z]) (.*)$/\1 \2/p')
[[ -n $defined ]] || fail "nm lists no symbol"

vulkan=$(grep -E '^vk[A-Z]' <<<"$undefined" || true)
[[ -z $vulkan ]] || fail "needs Vulkan symbols:" $vulkan

functions=$(sed -nE 's/^T (gpgp[A-Z][A-Za-z0-9]*)$/\1/p' <<<"$defined" | LC_ALL=C sort -u)
missing=$(LC_ALL=C comm -23 <(echo "$expected") <(echo "$functions"))
[[ -z $missing ]] || fail "declared in a header but not defined:" $missing
undeclared=$(LC_ALL=C comm -13 <(echo "$expected") <(echo "$functions"))
[[ -z $undeclared ]] || fail "defined but declared in no header of what was built:" $undeclared

if [[ ${#dynamic[@]} -gt 0 ]]; then
  foreign=$(grep -vE '^T gpgp[A-Z][A-Za-z0-9]*$' <<<"$defined" || true)
else # weak symbols are inline functions of the standard library; the linker merges them
  special='(typeinfo|vtable|guard variable|non-virtual thunk|construction vtable)[a-z ]* gpgp::'
  foreign=$(grep -vE "^(T gpgp[A-Z][A-Za-z0-9]*$|[WVu] |. (gpgp::|$special))" <<<"$defined" || true)
fi
[[ -z $foreign ]] || fail "foreign symbols:"$'\n'"$foreign"

echo "$library: $(wc -w <<<"$functions") functions, $(grep -c . <<<"$undefined") undefined symbols"
[[ $failed == no ]]
