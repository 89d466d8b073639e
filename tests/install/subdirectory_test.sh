#!/usr/bin/env bash
# Builds and runs a project that has gpgp as a subdirectory, with the services given and no other; the libraries must
# have the functions of those services and of no other. No optimisation: what counts is that it builds and links. The
# services' shaders are those in SHADERS, which the build under test has compiled; the core alone compiles its own.
#
#   subdirectory_test.sh SOURCE_DIR SCRATCH_DIR TEST_DIR CMAKE CC CXX NM SHADERS [--compiler] SERVICE...
set -euo pipefail
source=$1 scratch=$2 tests=$3 cmake=$4 cc=$5 cxx=$6 nm=$7 shaders=$8
shift 8
options=(-DGPGP_BUILD_SHARED=OFF -DGPGP_WITH_TEXT=OFF)
if (($#)); then options+=("-DGPGP_SHADERS_FROM=$shaders"); fi
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
else
  options+=(-DGPGP_PRECOMPILED_HEADERS=ON)
fi
compiler=OFF
if [[ ${1:-} == --compiler ]]; then
  compiler=ON
  shift
fi
options+=(-DGPGP_WITH_COMPILER=$compiler)
for service in spawn vector visibility; do
  value=OFF
  for wanted in "$@"; do [[ $wanted != "$service" ]] || value=ON; done
  options+=("-DGPGP_WITH_${service^^}=$value")
done
"$cmake" -S "$tests/add_subdirectory" -B "$scratch" -G Ninja -DGPGP_SOURCE="$source" -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" "${options[@]}"
"$cmake" --build "$scratch"
"$scratch/consumer"
if [[ " $* " == *" spawn "* ]]; then set -- "$@" spawn_builder lsystem tiles fit scatter detail; fi # services in several headers
if [[ " $* " == *" vector "* ]]; then set -- "$@" ui svg lottie; fi
if [[ " $* " == *" visibility "* ]]; then set -- "$@" atlas; fi
symbols=("$tests/../abi/symbols_test.sh" "$nm" "$source/include" "$tests/../abi")
"${symbols[@]}" run-time "$scratch/gpgp/src/libgpgp.a" core "$@"
if [[ $compiler == ON ]]; then "${symbols[@]}" compiler "$scratch/gpgp/src/libgpgp_compiler.a" core "$@"; fi
