#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests: release, then what tests run again in other forms (on
# a second device, by passes of other devices, with fewer services), then a build of all but the tests with the second
# compiler, then libgpgp for Windows under Wine, then loading threads under ThreadSanitizer, then all again under
# AddressSanitizer and UndefinedBehaviorSanitizer.
# Works as root or through sudo, asks nothing, can be run again. Ends with a summary, which also says whether shaders
# have changed since the last run on hardware; exits 1 where anything failed.
#
#   tests/run.sh            everything
#   tests/run.sh --quick    release only
#   GPGP_TEST_MINUTES=80    what there is time for: what would take longer by what release took is left out, which the
#                           summary says (default: 80; 0: no limit)
#   GPGP_DEVICE=name        runs the tests on another device than lavapipe
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=samples/setup.sh
source samples/setup.sh

quick=no
for argument in "$@"; do
  case $argument in
  --quick) quick=yes ;;
  -h | --help)
    sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    exit 0
    ;;
  *)
    echo "tests/run.sh: unknown option '$argument' (see --help)" >&2
    exit 2
    ;;
  esac
done

started=$SECONDS
summary=()
failed=no
# step NAME COMMAND...: runs it, notes how it went and goes on. Exit code 77: packages are missing that it can do without.
step() {
  local name=$1 begin=$SECONDS code=0
  shift
  say "$name"
  ("$@") || code=$? # a shell of its own: what gives up in there ends the step, not the run
  if ((code == 0)); then
    summary+=("passed  $name ($((SECONDS - begin)) s)")
  elif ((code == 77)); then
    summary+=("LEFT OUT  $name: packages are missing")
  else
    summary+=("FAILED  $name ($((SECONDS - begin)) s)")
    failed=yes
    return 1
  fi
}

# buildPreset PRESET [TESTS]: ON or OFF
buildPreset() {
  configure "$1" -DGPGP_BUILD_TESTS="${2:-ON}" && cmake --build --preset "$1" --parallel "$(jobCount)"
}
# Most of the tests' time is the software device's compiler, which takes one processor. What it compiled is kept for the
# tests that follow, wherever the home folder is and whether or not it can be written to.
export MESA_SHADER_CACHE_DIR=$PWD/build
# And it leaves out its optimiser, which takes longer than it saves. GALLIVM_PERF= in the environment has it back.
export GALLIVM_PERF=${GALLIVM_PERF-nopt}
testPreset() { ctest --preset "$1" --parallel "$(jobCount)" "${@:2}"; }
buildAndTest() {
  if step "build $1 (build/$1)" buildPreset "$1"; then step "tests, $1" testPreset "$1" -LE forms || true; fi
}

# As every source stands: without headers that others have included.
buildWithClang() {
  configure clang -DGPGP_BUILD_TESTS=OFF -DGPGP_PRECOMPILED_HEADERS=OFF && cmake --build --preset clang --parallel "$(jobCount)"
}
windowsUnderWine() { tests/windows.sh --install && tests/windows.sh; }

# hasTimeFor PERCENT NAME: whether that much of what release took is left of the time; if not, notes it.
minutes=${GPGP_TEST_MINUTES:-80}
hasTimeFor() {
  if ((minutes == 0 || (SECONDS - started) + released * $1 / 100 <= minutes * 60)); then return 0; fi
  summary+=("LEFT OUT  $2: no time after $(((SECONDS - started) / 60)) of $minutes minutes (GPGP_TEST_MINUTES)")
  return 1
}

# Prints the summary and ends.
finish() {
  say "summary, after $(((SECONDS - started) / 60)) min $(((SECONDS - started) % 60)) s"
  printf '   %s\n' "${summary[@]}"
  printf '   %s\n' "$(tests/hardware.sh changed)"
  [[ $failed == no ]] || exit 1
  exit 0
}

step "Debian packages (samples/packages.txt, tests/packages.txt)" \
  installMissing samples/packages.txt tests/packages.txt || finish
step "real test data (tests/data/fetch.sh)" tests/data/fetch.sh || true
releaseBegins=$SECONDS
buildAndTest release
released=$((SECONDS - releaseBegins))
if [[ -f build/release/CTestTestfile.cmake ]] && hasTimeFor 30 "tests of other forms, release"; then
  step "tests of other forms, release" testPreset release -L forms || true
fi
if [[ $quick == no ]]; then
  if hasTimeFor 35 "build with clang"; then
    step "build with clang, without tests (build/clang)" buildWithClang || true
  fi
  if hasTimeFor 75 "Windows, under Wine"; then
    step "Windows, under Wine (tests/windows.sh)" windowsUnderWine || true
  fi
  if hasTimeFor 30 "ThreadSanitizer"; then
    step "ThreadSanitizer (tests/sanitizers/tsan.sh)" tests/sanitizers/tsan.sh "$(jobCount)" || true
  fi
  if hasTimeFor 170 "build and tests, asan-ubsan"; then buildAndTest asan-ubsan; fi
fi

finish
