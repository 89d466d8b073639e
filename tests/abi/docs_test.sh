#!/usr/bin/env bash
# Every GPGP_API function says what it does and:
#   @threads any|context|handle
#   @lifetime call|frame|handle   where it takes a pointer to read
#   Errors:                       where it creates an object
#   @pass outside|inside|any and @state, and a place in the integration contract, where it records commands
# The C++ headers call every function that takes a handle and know every descriptor struct; structs.c uses every _INIT
# macro.
#
#   docs_test.sh INCLUDE_DIR TEST_DIR DOCS_DIR
set -euo pipefail
include=$1 tests=$2 docs=$3
failed=no
while read -r macro type enumerator; do
  grep -qF "GPGP_STRUCTURE_OF($type, $enumerator);" "$include"/gpgp/*.hpp ||
    { echo "FAILED: no C++ header knows $type" >&2; failed=yes; }
  grep -qF "GPGP_USE($type, $macro);" "$tests/structs.c" || { echo "FAILED: structs.c lacks $macro" >&2; failed=yes; }
done < <(sed -E ':join; /\\$/ { N; s/ *\\\n */ /; b join }' "$include"/gpgp/*.h |
  sed -nE 's/^#define (GPGP_[A-Z_]+_INIT) GPGP_INIT\((\w+), (\w+)\)$/\1 \2 \3/p')
[[ $failed == no ]]

awk -f "$tests/declarations.awk" "$include"/gpgp/*.h | awk -F'\t' -v contract="$docs/guide/integration_contract.md" \
  -v wrapper="cat '$include'/gpgp/*.hpp" '
  function complain(what) { print "FAILED: " $1 ": " what; failed = 1 }
  BEGIN {
    while ((getline line < contract) > 0) text = text line "\n"
    while ((wrapper | getline line) > 0) wrapped = wrapped line "\n"
  }
  {
    ++functions
    words = $3
    gsub(/@[a-z]+ [^@]*/, "", words)
    if (split(words, unused, " ") < 3) complain("says nothing of what it does before its tags")
    if ($3 !~ /@threads (any|context|handle)/) complain("no @threads any|context|handle")
    if ($2 ~ /const [A-Za-z]+\*/ && $3 !~ /@lifetime (call|frame|handle)/) complain("no @lifetime call|frame|handle")
    if ($2 ~ /^Gpgp(Context|Asset|Recorder|History|List|GrammarBuilder|Font|Shaper|Layout|Evaluator|Evaluation|CgaProgram|CgaDerivation) / &&
        wrapped !~ $1 "[(,]") complain("not in any C++ header")
    if ($1 ~ /^gpgpCreate/ && $3 !~ /Errors: /) complain("no list of errors")
    if ($2 ~ /VkCommandBuffer/) {
      ++records
      if ($1 !~ /^gpgpRecord/) complain("takes a command buffer but is not named gpgpRecord...")
      if ($3 !~ /@pass (outside|inside|any)/) complain("no @pass outside|inside|any")
      if ($3 !~ /@state [a-z]/) complain("no @state")
      if (index(text, "`" $1 "`") == 0) complain("not in " contract)
    }
  }
  END {
    print functions " functions, " records " of them record"
    exit failed || functions == 0 || records == 0
  }'
