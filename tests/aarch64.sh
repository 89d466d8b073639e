#!/usr/bin/env bash
# Cross-builds gpgp for Linux on aarch64, every warning an error, and runs what needs no GPU under qemu-user.
#
#   tests/aarch64.sh            libgpgp, libgpgp_compiler, libgpgp_text and the tests
#   tests/aarch64.sh --install  installs the packages that it needs: a compiler and qemu-user
#
#   GPGP_SHADERS_FROM=folder    generated/ of a build of these sources, whose shaders are taken (build/release's)
#
# Exit codes: 0 all is well, 1 it is not, 77 packages are missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=samples/setup.sh
source samples/setup.sh
root=$PWD build=$PWD/build/aarch64
for argument in "$@"; do
  case $argument in
  --install)
    installMissing tests/aarch64_packages.txt
    exit 0
    ;;
  -h | --help)
    sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
    exit 0
    ;;
  *)
    echo "tests/aarch64.sh: unknown option '$argument' (see --help)" >&2
    exit 2
    ;;
  esac
done
missing=()
while read -r package; do isInstalled "$package" || missing+=("$package"); done < <(packagesIn tests/aarch64_packages.txt)
if ((${#missing[@]})); then
  echo "left out, as packages are missing: ${missing[*]} (tests/aarch64.sh --install)"
  exit 77
fi

say "libraries for aarch64 (build/aarch64-sysroot)"
src/cmake/toolchains/aarch64_sysroot.sh
say "build (build/aarch64)"
shaders=${GPGP_SHADERS_FROM:-$root/build/release/generated}
[[ -d $shaders/shaders ]] || shaders=
configure aarch64 -DGPGP_PRECOMPILED_HEADERS=OFF -DGPGP_BUILD_TESTS=ON "-DGPGP_SHADERS_FROM=$shaders" -DGPGP_BUILD_CLI=ON
libraries=(src/libgpgp src/libgpgp_compiler src/libgpgp_evaluator src/libgpgp_text)
tests=(spawn_evaluator_test vector_patch_test vector_text_{shape,layout,query}_test visibility_cpu_reference_test)
cmake --build "$build" --parallel "$(jobCount)" --target "${libraries[@]/%/.so}" "${tests[@]}" >"$build/build.log" 2>&1 || {
  grep -E -A 5 'error|FAILED' "$build/build.log" | head -n 60 >&2
  die "gpgp does not build for aarch64 ($build/build.log)"
}
for name in "${libraries[@]}"; do
  library=$build/$name.so
  echo "$(basename "$name").so: $(($(stat -Lc %s "$library") / 1024)) KiB"
done

say "tests under qemu"
failed=no
sysroot=${GPGP_SYSROOT:-$root/build/aarch64-sysroot}
emulator=(qemu-aarch64 -L /usr/aarch64-linux-gnu
  -E "LD_LIBRARY_PATH=$sysroot/usr/lib/aarch64-linux-gnu:$sysroot/lib/aarch64-linux-gnu")
for name in "${tests[@]}"; do
  begin=$SECONDS code=0
  timeout 900 "${emulator[@]}" "$build/$name" >"$build/$name.log" 2>&1 || code=$?
  ran=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) tests?\..*/\1/p' "$build/$name.log")
  if ((code == 0)) && [[ ${ran:-0} != 0 ]]; then
    echo "passed  $name: $ran tests ($((SECONDS - begin)) s)"
  else
    grep -vE '^\[ (RUN|      OK) ' "$build/$name.log" | tail -n 40 >&2
    echo "FAILED  $name (exit code $code)" >&2
    failed=yes
  fi
done
[[ $failed == no ]]
