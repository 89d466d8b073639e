#!/usr/bin/env bash
# Cross-builds gpgp for Windows and runs it under Wine, on the software device (lavapipe through Wine's Vulkan). The
# host's validation layer listens; any message of it is a failure.
#
#   tests/windows.sh            libgpgp with all services: its exports, a consumer, and some tests; tests/run.sh does that
#   tests/windows.sh --all      libgpgp_text and more tests, too
#   tests/windows.sh --compilers  --all with libgpgp_compiler, and with it the whole command and the mini-engine
#   tests/windows.sh --install  installs the packages that it needs: a compiler, Wine and a virtual display
#
#   GPGP_SHADERS_FROM=folder    generated/ of a build of these sources, whose shaders are taken (build/release's)
#
# Exit codes: 0 all is well, 1 it is not, 77 packages are missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=samples/setup.sh
source samples/setup.sh
root=$PWD build=$PWD/build/mingw
all=no compilers=OFF
for argument in "$@"; do
  case $argument in
  --all) all=yes ;;
  --compilers) all=yes compilers=ON ;;
  --install)
    installMissing tests/windows_packages.txt
    exit 0
    ;;
  -h | --help)
    sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    exit 0
    ;;
  *)
    echo "tests/windows.sh: unknown option '$argument' (see --help)" >&2
    exit 2
    ;;
  esac
done
missing=()
while read -r package; do isInstalled "$package" || missing+=("$package"); done < <(packagesIn tests/windows_packages.txt)
if ((${#missing[@]})); then
  echo "left out, as packages are missing: ${missing[*]} (tests/windows.sh --install)"
  exit 77
fi
# Wine's Vulkan needs a display.
[[ -n ${GPGP_INSIDE_XVFB:-} ]] || GPGP_INSIDE_XVFB=yes exec xvfb-run -a -s "-screen 0 640x480x24 -noreset" "$0" "$@"

failures=()
fail() {
  echo "FAILED: $*" >&2
  failures+=("$*")
}

# ---------------------------------------------------------------- build

say "libraries for Windows (build/mingw-dependencies)"
parts=(base)
[[ $all == no ]] || parts+=(text)
[[ $compilers == OFF ]] || parts+=(compiler)
src/cmake/toolchains/dependencies.sh "${parts[@]}"
say "build (build/mingw)"
shaders=${GPGP_SHADERS_FROM:-$root/build/release/generated}
[[ -d $shaders/shaders ]] || shaders=
# Without pkg-config libgpgp_text is not found to be possible, while all else is compiled in the same way.
withoutText=ON
[[ $all == no ]] || withoutText=OFF
configure mingw -DGPGP_PRECOMPILED_HEADERS=OFF -DGPGP_BUILD_TESTS=ON "-DGPGP_SHADERS_FROM=$shaders" -DGPGP_BUILD_CLI=ON -DGPGP_WITH_TEXT=ON \
  -DGPGP_WITH_COMPILER=$compilers -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=$withoutText
targets=(gpgp gpgp_static gpgp_evaluator gpgp_evaluator_static gpgp_cli paths_test core_test contract_test wrong_call)
[[ $all == no ]] || targets+=(gpgp_text gpgp_text_static vector_text_{shape,layout,query}_test visibility_edge_test
  vector_cpu_reference_test vector_patch_test visibility_cpu_reference_test)
[[ $compilers == OFF ]] || targets=(all)
cmake --build "$build" --parallel "$(jobCount)" --target "${targets[@]}" >"$build/build.log" 2>&1 || {
  grep -E -A 5 'error|FAILED' "$build/build.log" | head -n 60 >&2
  die "gpgp does not build for Windows ($build/build.log)"
}

# ---------------------------------------------------------------- exports

say "exports"
# exports DLL KIND HEADER...: the functions of the headers, each of them and nothing else (as tests/abi/symbols_test.sh)
exports() {
  local library=$1 kind=$2 header headers=() expected found
  shift 2
  for header in "$@"; do headers+=("include/gpgp/$header.h"); done
  expected=$(awk -f tests/abi/declarations.awk "${headers[@]}" | awk -F'\t' -v kind="$kind" \
    '(index($3, "In libgpgp_compiler") > 0) == (kind == "compiler") { print $1 }' | cat - <(printf 'gpgpGetVersion\ngpgpResultString\n') | LC_ALL=C sort -u)
  found=$(x86_64-w64-mingw32-objdump -p "$library" | sed -nE '/Ordinal\/Name/,/^$/s/^\t\[.*\] (\S+)$/\1/p' | LC_ALL=C sort -u)
  [[ -n $found && $found == "$expected" ]] ||
    fail "$(basename "$library") does not export what the headers declare:"$'\n'"$(diff <(echo "$expected") <(echo "$found"))"
  echo "$(basename "$library"): $(wc -w <<<"$found") functions, $(($(stat -c %s "$library") / 1024)) KiB;" \
    "needs $(x86_64-w64-mingw32-objdump -p "$library" | sed -n 's/^.*DLL Name: //p' | paste -sd' ')"
}
exports "$build/libgpgp.dll" run-time core spawn detail fit scatter lsystem tiles paths vector ui layers visibility atlas
if [[ $compilers == ON ]]; then
  exports "$build/libgpgp_compiler.dll" compiler core spawn spawn_builder lsystem vector svg lottie
fi
exports "$build/libgpgp_evaluator.dll" evaluator evaluator cga
if [[ $all == yes ]]; then exports "$build/libgpgp_text.dll" text text; fi

# ---------------------------------------------------------------- under Wine

export WINEPREFIX=$build/wine WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml=" GALLIVM_PERF=${GALLIVM_PERF-nopt}
export MESA_SHADER_CACHE_DIR=${MESA_SHADER_CACHE_DIR:-$root/build}
messages=$build/validation.txt
cat >"$build/vk_layer_settings.txt" <<SETTINGS
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.report_flags = error,warn
khronos_validation.log_filename = $messages
khronos_validation.enables = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
SETTINGS
wine wineboot --init >/dev/null 2>&1 || true
trap 'wineserver -k >/dev/null 2>&1 || true' EXIT
# windows PROGRAM ARGUMENT...: without validation
windows() { timeout 900 wine "$@"; }
# validated PROGRAM ARGUMENT...: with the host's layer
validated() {
  rm -f "$messages"
  VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LAYER_SETTINGS_PATH=$build/vk_layer_settings.txt \
    GPGP_VALIDATION=outside windows "$@"
}
# test_ NAME [FILTER]
test_() {
  local begin=$SECONDS code=0
  validated "$build/$1.exe" "--gtest_filter=${2:-*}" >"$build/$1.log" 2>&1 || code=$?
  local ran
  ran=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) tests?\..*/\1/p' "$build/$1.log")
  if ((code != 0)) || [[ ${ran:-0} == 0 ]]; then
    grep -vE '^\[ (RUN|      OK) ' "$build/$1.log" | tail -n 40 >&2
    fail "$1 (exit code $code)"
  elif [[ -s $messages ]]; then
    head -n 20 "$messages" >&2
    fail "$1: messages of the validation layer"
  else
    echo "passed  $1: $ran tests ($((SECONDS - begin)) s)"
  fi
}

say "a consumer of the installed libraries"
scratch=$build/consumer
rm -rf "$scratch"
cmake --install "$build" --prefix "$scratch/with spaces" >"$build/install.log" 2>&1 || { cat "$build/install.log" >&2; fail "install"; }
if cmake -S tests/install/find_package -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_TOOLCHAIN_FILE="$root/src/cmake/toolchains/mingw.cmake" -DCMAKE_PREFIX_PATH="$scratch/with spaces" \
  >"$scratch/configure.log" 2>&1 && cmake --build "$scratch/build" >"$scratch/build.log" 2>&1; then
  for consumer in "$scratch"/build/consumer_*.exe; do
    # the loader finds DLLs in PATH, which Wine appends WINEPATH to
    WINEPATH="$(winepath -w "$scratch/with spaces/bin")" windows "$consumer" || fail "$(basename "$consumer") returned $?"
  done
else
  tail -n 30 "$scratch"/*.log >&2
  fail "the consumer does not build"
fi

say "tests"
validated "$build/wrong_call.exe" || fail "wrong_call returned $?"
if [[ -s $messages ]]; then echo "passed  a wrong call is seen by the validation layer"; else fail "the validation layer does not work"; fi
test_ paths_test
test_ core_test
if [[ $all == no ]]; then
  test_ contract_test '*RecordingOnlyRecords*:*Uploading*:*LeavesExactly*:*PlacesTheDocumented*:*ADropped*:*ThreeFrames*'
fi
if [[ $all == yes ]]; then
  for name in shape layout query; do test_ vector_text_${name}_test; done
  test_ visibility_edge_test '*EdgeTest*'
  test_ vector_cpu_reference_test 'CpuTest.*'
  for name in vector_patch_test visibility_cpu_reference_test contract_test; do test_ $name; done
fi
if [[ $compilers == ON ]]; then
  test_ spawn_evaluator_test
  test_ spawn_gpu_test '*KernelsEqualTheEvaluator*:*EqualsTheEvaluator*'
fi

# ---------------------------------------------------------------- beside Linux

# same NAME ARGUMENT...: `gpgp ARGUMENT...` of both systems writes the same picture, byte for byte, and the same report
# but for numbers with a fraction, times among them. {out} is where the picture goes.
same() {
  local name=$1 system code argument arguments
  shift
  for system in linux windows; do
    arguments=()
    for argument in "$@"; do arguments+=("${argument//\{out\}/$folder/$name.$system.png}"); done
    code=0
    if [[ $system == linux ]]; then
      "$linux" "${arguments[@]}" --json >"$folder/$name.json" || code=$?
    else
      windows "$build/gpgp.exe" "${arguments[@]}" --json >"$folder/$name.json" || code=$?
    fi
    sed -E -e 's/: -?[0-9]+\.[0-9e+-]+(,?)$/: #\1/' -e "s/\.$system\.png/.png/" "$folder/$name.json" >"$folder/$name.$system.txt"
    ((code == 0)) || fail "$name: gpgp for $system returned $code"
  done
  if ! cmp "$folder/$name.linux.png" "$folder/$name.windows.png"; then
    fail "$name: other pixels than on Linux"
  elif ! diff "$folder/$name.linux.txt" "$folder/$name.windows.txt"; then
    fail "$name: another report than on Linux"
  else
    echo "passed  $name: picture and report are those of Linux"
  fi
}
say "pictures and reports beside Linux"
linux=$root/build/release/gpgp folder="$build/Pfäde δρόμος 路 🛤"
mkdir -p "$folder"
if [[ ! -x $linux ]]; then
  note "left out: there is no build/release/gpgp"
elif [[ ! -e tests/data/fetched/models/bunny.obj ]]; then
  note "left out: tests/data/fetch.sh has not been run"
else
  cp tests/data/fetched/models/bunny.obj "$folder/ein Häschen 兎.obj"
  for method in standard exact; do
    same "visibility $method" visibility "$folder/ein Häschen 兎.obj" --method $method --size 320x180 --image "{out}"
  done
  if [[ $compilers == ON ]]; then
    same vector vector tests/data/svg/hud.svg --size 512x512 --out "{out}"
    same spawn spawn samples/grammars/simple_house.pga --size 320x180 --image "{out}"
    same text text tests/data/fetched/fonts/DejaVuSans.ttf "Grüße, κόσμε" "{out}" --size 32
    same lsystem spawn samples/lsystems/fern.lsys --size 320x180 --image "{out}"
  fi
fi

if ((${#failures[@]})); then
  printf '\n%d failed:\n' "${#failures[@]}"
  printf '   %s\n' "${failures[@]}"
  exit 1
fi
