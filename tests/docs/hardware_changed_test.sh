#!/usr/bin/env bash
# tests/hardware.sh changed, in a small repository of its own: no run on record, the same shaders, and shaders that have
# changed since, committed or not. And tests/hardware.sh merge.
#
#   hardware_changed_test.sh SOURCE_DIR
set -euo pipefail
command -v git >/dev/null || { echo "skipped: git is missing" >&2; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch"/{tests,docs/results,shaders/core,src/{core,spawn,vector,visibility}}
cp "$1/tests/hardware.sh" "$scratch/tests/"
cd "$scratch"
for folder in shaders/core src/core src/spawn src/vector src/visibility; do echo one >"$folder/file"; done
commit() {
  git add -A
  git -c user.name=test -c user.email=test@example.org -c commit.gpgsign=false commit -qm "$1"
}
git -c init.defaultBranch=main init -q
commit one
# expect WORDS: in what the script says
expect() {
  local said
  said=$(tests/hardware.sh changed)
  [[ $said == *"$1"* ]] || { echo "FAILED: expected '$1', but it says: $said" >&2; exit 1; }
}

expect "No whole run on hardware is recorded"
printf '{\n "device": "Some GPU",\n "driver": "1",\n "commit": "abc",\n "hash": "%s",\n "date": "2026-01-02",\n "tests": {}\n}\n' \
  "$(tests/hardware.sh hash)" >docs/results/hardware.json
expect "are those of the last run on hardware (Some GPU, 2026-01-02, commit abc)"
echo other >README.md
commit "nothing that a device runs"
expect "are those of"
echo two >shaders/core/file
expect "have CHANGED since the last run on hardware (Some GPU, 2026-01-02, commit abc)"
commit two
expect "have CHANGED since"
git checkout -q HEAD~1 -- shaders
commit "as before"
expect "are those of"
echo two >src/vector/file
commit "how shaders are recorded"
expect "have CHANGED since"

# part NAME COMMIT: the record of a run of one test and one benchmark
part() {
  printf '{\n "device": "D",\n "driver": "1",\n "commit": "%s",\n "hash": "h",\n "date": "2026-01-02",\n "tests": {\n' "$2"
  printf '  "%s": {"passed": 3, "failed": 0, "skipped": 0, "exit code": 0}\n },\n "benchmarks": [\n' "$1"
  printf '  {"command": "%s", "output": [\n    "1 ms"]}\n ]\n}\n' "$1"
}
part a_test c >a.json
part b_test c >b.json
part b_test other >c.json
merged=$(tests/hardware.sh merge a.json b.json)
whole=$(part a_test c | sed -e '/"a_test": {/s/$/,\n  "b_test": {"passed": 3, "failed": 0, "skipped": 0, "exit code": 0}/' \
  -e '/"1 ms"/s/$/,\n  {"command": "b_test", "output": [\n    "1 ms"]}/')
[[ $merged == "$whole" ]] || { printf 'FAILED: merged\n%s\n' "$merged" >&2; exit 1; }
[[ $(tests/hardware.sh merge a.json) == "$(cat a.json)" ]] || { echo "FAILED: one file merged" >&2; exit 1; }
! tests/hardware.sh merge a.json c.json >merged 2>&1 || { echo "FAILED: other commits are merged" >&2; exit 1; }
grep -q "different devices or commits" merged
echo "10 cases"
