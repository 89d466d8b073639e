#!/usr/bin/env bash
# Runs every test that uses a device, and the headline benchmarks, on one hardware GPU, and writes what came of them.
#
#   tests/hardware.sh pack FILE.tar.xz [--only REGEX] [PART...]   packs build/release for a machine that has a driver but
#                                        no compiler: tests (those whose names match), benchmarks, the command, the
#                                        libraries that they need, the validation layer, the test data, this script.
#                                        PARTs of tests/data/fetched that are packed: svg models (default), fonts or
#                                        one of them (fonts/DejaVuSans.ttf), w3c-svg, openclipart
#   tests/hardware.sh run [OPTION...]    in the project's folder, or where such a file was unpacked:
#     --device NAME     part of the device's name, or its index (default: $GPGP_DEVICE, else NVIDIA)
#     --out FOLDER      hardware.json and a log for each test (default: build/hardware)
#     --only REGEX      tests whose names match
#     --jobs N          tests at once (default: half the processors)
#     --no-benchmarks   tests alone
#   tests/hardware.sh merge FILE...      one hardware.json of several, of runs of the same commit on the same device
#   tests/hardware.sh hash               of shaders/ and of the code that records them, as in hardware.json
#   tests/hardware.sh changed [FILE]     a sentence: whether they have changed since the run in FILE
#                                        (default: docs/results/hardware.json, the last whole run; tests/run.sh asks)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/release
list=$build/device_tests.txt # a name, a tab, a program: made by tests/CMakeLists.txt

die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}
usage() { sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; }

sourceHash() {
  git ls-files -s shaders src/core src/spawn src/vector src/visibility | sha256sum | cut -c1-16
}

changed() {
  local file=${1:-docs/results/hardware.json} shown
  if [[ ! -f $file ]]; then
    echo "No whole run on hardware is recorded in ${file#"$PWD"/}: copy build/hardware/hardware.json of 'tests/hardware.sh run' there."
    return
  fi
  value() { sed -nE "s/^ *\"$1\": \"(.*)\",?$/\1/p" "$file" | head -n1; }
  shown="the last run on hardware ($(value device), $(value date), commit $(value commit))"
  if ! git rev-parse --git-dir >/dev/null 2>&1; then
    echo "This is no git checkout, so nothing is known of changes since $shown."
  elif [[ $(sourceHash) == "$(value hash)" ]] &&
    git diff --quiet HEAD -- shaders src/core src/spawn src/vector src/visibility; then
    echo "Shaders and the code that records them are those of $shown."
  else
    echo "Shaders or the code that records them have CHANGED since $shown: run tests/hardware.sh run."
  fi
}

pack() {
  local file=${1:?which file} programs=() stage only=.
  shift
  if [[ ${1:-} == --only ]]; then only=${2:?an expression} && shift 2; fi
  [[ $# -gt 0 ]] || set -- svg models
  [[ -f $list ]] || die "$list is missing: build the preset 'release' with tests first"
  stage=$(mktemp -d)
  # shellcheck disable=SC2064 # the folder as it is now
  trap "rm -rf '$stage'" EXIT
  mapfile -t programs < <(grep -E "^($only)" "$list" | cut -f2)
  local plugin=$build/integrations/unity/libgpgp_unity.so # loaded by unity_test
  if [[ -f $plugin ]]; then programs+=("$PWD/$plugin"); fi
  for name in gpgp mini_engine record_bench convert_bench vector_bench vector_tables spawn_bench visibility_bench; do
    if [[ -x $build/$name ]]; then programs+=("$PWD/$build/$name"); fi
  done
  mkdir -p "$stage/$build" "$stage/lib"
  local program layer=/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json
  for program in "${programs[@]}"; do
    install -D "$program" "$stage/${program#"$PWD"/}"
    strip "$stage/${program#"$PWD"/}"
  done
  cp "$list" "$stage/$build/"
  # The C and C++ run times are the other machine's own, which its driver is linked with.
  ldd "${programs[@]}" /usr/lib/x86_64-linux-gnu/libVkLayer_khronos_validation.so 2>/dev/null |
    awk '$2 == "=>" && $3 ~ /^\// {print $3}' | sort -u |
    grep -vE '/(libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s|ld-linux[^/]*)\.so' >"$stage/libraries"
  while read -r library; do cp -L "$library" "$stage/lib/"; done <"$stage/libraries"
  cp -L /usr/lib/x86_64-linux-gnu/libvulkan.so.1 /usr/lib/x86_64-linux-gnu/libVkLayer_khronos_validation.so "$stage/lib/"
  cp "$layer" "$stage/lib/"
  find "$stage/lib" -name '*.so*' -exec strip --strip-unneeded {} +
  git ls-files tests/data tests/golden samples shaders docs/guide docs/internals tests/hardware.sh | tar cf - -T - | tar xf - -C "$stage"
  mkdir -p "$stage/tests/data/fetched"
  local part
  for part in "$@"; do
    if [[ -e tests/data/fetched/$part ]]; then (cd tests/data/fetched && cp -rL --parents "$part" "$stage/tests/data/fetched/"); fi
  done
  {
    echo "root=$PWD"
    echo "commit=$(git rev-parse --short HEAD)$(git diff --quiet HEAD -- src shaders include tests || echo ' and changes')"
    echo "hash=$(sourceHash)"
  } >"$stage/packed"
  rm "$stage/libraries"
  mkdir -p "$(dirname "$file")"
  tar cf - -C "$stage" . | xz -T2 -3 --lzma2=preset=3,dict=256MiB >"$file"
  du -h "$file"
}

# quoted TEXT: as a JSON string
quoted() { printf '"%s"' "$(sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/\t/ /g' <<<"$1")"; }

runOne() { # NAME PROGRAM, by xargs
  local name=$1 program=$2 begin=$SECONDS code=0
  (cd "$root/$build" && timeout 540 "$program" --gtest_output="json:$out/$name.json") >"$out/$name.log" 2>&1 || code=$?
  echo "$code $((SECONDS - begin))" >"$out/$name.code"
}

run() {
  local device=${GPGP_DEVICE:-NVIDIA} only=. jobs benchmarks=yes
  jobs=$(($(nproc) / 2 > 1 ? $(nproc) / 2 : 1))
  out=$PWD/build/hardware
  while [[ $# -gt 0 ]]; do
    case $1 in
    --device) device=${2:?a device} && shift ;;
    --out) mkdir -p "${2:?a folder}" && out=$(cd "$2" && pwd) && shift ;;
    --only) only=${2:?an expression} && shift ;;
    --jobs) jobs=${2:?a number} && shift ;;
    --no-benchmarks) benchmarks=no ;;
    *) die "unknown option '$1' (see --help)" ;;
    esac
    shift
  done
  root=$PWD
  local commit hash
  if [[ -f packed ]]; then # programs know their data by the path where they were built
    # shellcheck source=/dev/null
    root=$(sed -n 's/^root=//p' packed)
    commit=$(sed -n 's/^commit=//p' packed)
    hash=$(sed -n 's/^hash=//p' packed)
    if [[ ! -e $root ]]; then mkdir -p "$(dirname "$root")" && ln -s "$PWD" "$root"; fi
    [[ $root -ef $PWD ]] || die "$root is something else than $PWD; the programs look for their data there"
    export LD_LIBRARY_PATH=$PWD/lib VK_LAYER_PATH=$PWD/lib
  else
    commit=$(git rev-parse --short HEAD)
    hash=$(sourceHash)
  fi
  [[ -f $list ]] || die "$list is missing: build the preset 'release' with tests first"
  mkdir -p "$out"
  export GPGP_DEVICE=$device GPGP_TEST_ON_HARDWARE=1 out root build
  export -f runOne
  local name driver failed=0
  name=$("$root/$build/gpgp" info 2>&1 | grep -m1 -i "$device" | sed 's/^[^[:alpha:]]*//' || true)
  driver=$(nvidia-smi --query-gpu=driver_version --format=csv,noheader 2>/dev/null | head -n1 || true)
  grep -E "^($only)" "$list" | tr '\t' '\n' | xargs -n2 -P"$jobs" bash -c 'runOne "$1" "$2"' runOne
  {
    printf '{\n "device": %s,\n "driver": %s,\n' "$(quoted "$name")" "$(quoted "$driver")"
    printf ' "commit": %s,\n "hash": %s,\n "date": %s,\n "tests": {' "$(quoted "$commit")" "$(quoted "$hash")" "$(quoted "$(date +%F)")"
    local first=yes test code seconds passed failures skipped
    while IFS=$'\t' read -r test _; do
      [[ -f $out/$test.code ]] || continue
      read -r code seconds <"$out/$test.code"
      passed=$(grep -c '^\[       OK \]' "$out/$test.log" || true)
      failures=$(grep -cE '^\[  FAILED  \] [^ ]+.*\([0-9]+ ms\)$' "$out/$test.log" || true)
      skipped=$(grep -cE '^\[  SKIPPED \] .*\([0-9]+ ms\)$' "$out/$test.log" || true)
      if [[ $code != 0 ]]; then
        failed=1
        printf 'FAILED %s (exit code %s): see %s\n' "$test" "$code" "$out/$test.log" >&2
        grep -E '^\[  FAILED  \]' "$out/$test.log" | sort -u | head -n 20 >&2 || true
      fi
      [[ $first == yes ]] || printf ','
      first=no
      printf '\n  "%s": {"passed": %s, "failed": %s, "skipped": %s, "exit code": %s}' "$test" "$passed" "$failures" "$skipped" "$code"
      printf '%-34s passed %4s failed %3s skipped %3s exit code %3s %4s s\n' "$test" "$passed" "$failures" "$skipped" "$code" "$seconds" >&2
    done <"$list"
    printf '\n },\n "benchmarks": ['
    first=yes
    if [[ $benchmarks == yes ]]; then
      while read -r command; do
        printf '\n== %s\n' "$command" >&2
        # shellcheck disable=SC2086 # words
        (cd "$root" && timeout 120 $build/$command) >"$out/benchmark.log" 2>&1 || printf 'FAILED %s\n' "$command" >&2
        cat "$out/benchmark.log" >&2
        [[ $first == yes ]] || printf ','
        first=no
        printf '\n  {"command": %s, "output": [' "$(quoted "$command")"
        local line sep=''
        while IFS= read -r line; do
          printf '%s\n    %s' "$sep" "$(quoted "$line")"
          sep=,
        done <"$out/benchmark.log"
        printf ']}'
      done < <(benchmarkCommands)
    fi
    printf '\n ]\n}\n'
  } >"$out/hardware.json"
  rm -f "$out"/*.code "$out/benchmark.log"
  return "$failed"
}

merge() {
  [[ $# -gt 0 ]] || die "which files"
  local file facts
  facts() { grep -E '^ "(device|driver|commit|hash)"' "$1"; }
  for file in "$@"; do
    [[ $(facts "$file") == "$(facts "$1")" ]] || die "$file and $1 are of different devices or commits"
  done
  joined() { sed -e 's/,$//' | sed -e '$!s/$/,/'; } # one entry a line
  sed -n '1,/^ "date"/p' "$1"
  echo ' "tests": {'
  cat "$@" | grep -E '^  "[a-z0-9_]+": \{"passed"' | sort -u -t'"' -k2,2 | joined
  printf ' },\n "benchmarks": ['
  local first=yes
  for file in "$@"; do
    local entries
    entries=$(sed '1,/^ "benchmarks": \[/d; /^ \]$/,$d' "$file")
    [[ -n $entries ]] || continue
    [[ $first == yes ]] || printf ','
    first=no
    printf '\n%s' "$entries"
  done
  printf '\n ]\n}\n'
}

# What docs/results names first of each service, each in less than two minutes.
benchmarkCommands() {
  local svg=tests/data/fetched/svg
  echo "vector_bench --repeat 40 map contours page $svg/tiger.svgz $svg/car.svgz $svg/gallardo.svgz"
  echo "vector_bench --repeat 40 --size 2048 $svg/tiger.svgz $svg/car.svgz $svg/gallardo.svgz"
  echo "vector_bench --repeat 40 --size 1920x1080 page"
  local name axioms x y z spacing rest
  while read -r name axioms x y z spacing rest; do
    echo "gpgp spawn samples/grammars/$name.pga --axioms $axioms --axiom-size $x,$y,$z --spacing $spacing --repeat 200 --json"
  done < <(grep -v '^#' samples/grammars/cases.txt)
  echo "spawn_bench --repeat 30 bounds"
  echo "visibility_bench --size 1920x1080 --repeat 20 --reference 0 --exact street colonnade foliage city bigcity"
}

case ${1:-} in
pack | run | changed | merge) "$@" ;;
hash) sourceHash ;;
-h | --help) usage ;;
*) usage >&2 && exit 2 ;;
esac
