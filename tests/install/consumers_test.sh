#!/usr/bin/env bash
# Installs gpgp into a prefix, moves the prefix, and builds and runs a consumer of what lies there.
#
#   consumers_test.sh WAY BUILD_DIR SCRATCH_DIR TEST_DIR CMAKE CC CXX
#
# WAY: install (first), find_package, pkg_config
set -euo pipefail
way=$1 build=$2 scratch=$3 tests=$4 cmake=$5 cc=$6 cxx=$7
prefix=$scratch/moved
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

case $way in
install)
  rm -rf "$scratch"
  mkdir -p "$scratch"
  if ! "$cmake" --install "$build" --prefix "$scratch/prefix" >"$scratch/install.log"; then
    cat "$scratch/install.log"
    exit 1
  fi
  mv "$scratch/prefix" "$prefix" # what is installed must not know where
  texts=$(find "$prefix" \( -name '*.cmake' -o -name '*.pc' -o -name '*.h' -o -name '*.hpp' \))
  [[ -n $texts ]] || fail "nothing was installed"
  source=$(sed -nE 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
  # shellcheck disable=SC2086
  if grep -lF -e "$build" -e "$source" -e "$scratch" $texts; then fail "installed files name places of the build"; fi
  for library in "$prefix"/lib*/libgpgp*.so "$prefix"/lib*/*/libgpgp*.so; do
    [[ -e $library ]] || continue
    name=$(basename "$library")
    major=$(sed -nE 's/^#define GPGP_VERSION_MAJOR ([0-9]+)$/\1/p' "$prefix/include/gpgp/core.h")
    [[ $major != 0 ]] || major=0.$(sed -nE 's/^#define GPGP_VERSION_MINOR ([0-9]+)$/\1/p' "$prefix/include/gpgp/core.h")
    dynamic=$(readelf -d "$library")
    grep -q "SONAME.*\[$name\.$major\]" <<<"$dynamic" || fail "$name: the soname is not $name.$major"
    if grep -E 'RPATH|RUNPATH' <<<"$dynamic"; then fail "$name has a run-time search path"; fi
    if grep -E 'NEEDED.*(vulkan|glslang|SPIRV)' <<<"$dynamic"; then fail "$name needs a library that it must not"; fi
  done
  if command -v glslangValidator >/dev/null; then # the shaders that engines include stand alone
    glslangValidator -V --quiet -I"$prefix/include" -o "$scratch/glsl.spv" "$tests/../vector/material.frag"
    glslangValidator -D -V -S frag -e main --quiet -I"$prefix/include" -o "$scratch/hlsl.spv" "$tests/../vector/material.hlsl"
  fi
  if [[ -x $prefix/bin/gpgp ]]; then "$prefix/bin/gpgp" --version; fi
  version=$(sed -nE 's/^#define GPGP_VERSION_(MAJOR|MINOR|PATCH) ([0-9]+)$/\2/p' "$prefix/include/gpgp/core.h" | paste -sd.)
  described=$(sed -nE 's/^Version: //p' $(find "$prefix" -name gpgp.pc))
  [[ $version == "$described" ]] || fail "the header says version $version, gpgp.pc says $described"
  echo "installed: $(find "$prefix" -type f | wc -l) files"
  ;;
find_package)
  rm -rf "$scratch/find_package"
  "$cmake" -S "$tests/find_package" -B "$scratch/find_package" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_C_COMPILER="$cc" -DCMAKE_BUILD_TYPE=Release
  "$cmake" --build "$scratch/find_package"
  "$cmake" -S "$tests/find_package" -B "$scratch/find_package_cxx" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCONSUMER_CXX=ON
  "$cmake" --build "$scratch/find_package_cxx" --target consumer_cxx
  ran=0
  for consumer in "$scratch"/find_package/consumer_gpgp* "$scratch"/find_package_cxx/consumer_{cxx,glyphs}; do
    [[ -e $consumer || $consumer != *consumer_glyphs ]] || continue # where there is no libgpgp_text
    "$consumer" || fail "$(basename "$consumer") returned $?"
    ran=$((ran + 1))
  done
  [[ $ran -ge 2 ]] || fail "no consumer was built"
  # Who only derives on the CPU has nothing of Vulkan.
  for consumer in "$scratch"/find_package/consumer_gpgp_evaluator*_alone; do
    [[ -e $consumer ]] || continue
    if nm "$consumer" | grep -E ' vk[A-Z]'; then fail "$(basename "$consumer") has Vulkan symbols"; fi
    if readelf -d "$consumer" | grep -E 'NEEDED.*(vulkan|glslang|SPIRV|libgpgp\.so)'; then
      fail "$(basename "$consumer") needs a library that it must not"
    fi
  done
  # The shared libraries are found without what the static ones link.
  if [[ -e $scratch/find_package/consumer_gpgp ]]; then
    "$cmake" -S "$tests/find_package" -B "$scratch/find_package_alone" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
      -DCMAKE_C_COMPILER="$cc" -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_FIND_PACKAGE_pugixml=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_ZLIB=ON -DCONSUMER_OF_SHARED_LIBRARIES=ON
    "$cmake" --build "$scratch/find_package_alone" --target consumer_gpgp
  fi
  # Another version that may have another ABI is refused.
  for other in 99 0.2; do
    mkdir -p "$scratch/other_$other"
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(other NONE)\nfind_package(gpgp %s REQUIRED)\n' "$other" \
      >"$scratch/other_$other/CMakeLists.txt"
    if "$cmake" -S "$scratch/other_$other" -B "$scratch/other_$other/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
      >"$scratch/other_$other/log" 2>&1; then
      fail "find_package(gpgp $other) was accepted"
    fi
    if ! tr -s '\n ' ' ' <"$scratch/other_$other/log" | grep "compatible with requested version \"$other\"" >/dev/null; then
      cat "$scratch/other_$other/log"
      fail "find_package(gpgp $other) failed for another reason than its version"
    fi
  done
  ;;
pkg_config)
  directory=$(dirname "$(find "$prefix" -name gpgp.pc)")
  export PKG_CONFIG_PATH=$directory
  mkdir -p "$scratch/pkg_config"
  ran=0
  for package in gpgp gpgp_compiler gpgp_evaluator gpgp_text; do
    pkg-config --exists "$package" || continue
    libraries=$(pkg-config --variable=libdir "$package")
    needs=(gpgp)
    define=()
    if [[ $package == gpgp_compiler ]]; then
      needs=(gpgp_compiler gpgp)
      define=(-DCONSUMER_USES_COMPILER)
    elif [[ $package == gpgp_evaluator ]]; then
      needs=(gpgp_evaluator)
      define=(-DCONSUMER_OF_EVALUATOR_ALONE)
    elif [[ $package == gpgp_text ]]; then
      needs=(gpgp_text gpgp)
      define=(-DCONSUMER_USES_TEXT)
    fi
    if [[ -e $libraries/lib$package.so ]]; then
      # shellcheck disable=SC2046
      "$cc" -std=c99 "${define[@]}" $(pkg-config --cflags "${needs[@]}") "$tests/consumer.c" \
        $(pkg-config --libs "${needs[@]}") -o "$scratch/pkg_config/shared_$package"
      LD_LIBRARY_PATH=$libraries "$scratch/pkg_config/shared_$package" || fail "shared_$package returned $?"
      ran=$((ran + 1))
    fi
    if [[ -e $libraries/lib$package.a ]]; then # --static names all that it needs; only gpgp itself is forced static
      flags=$(pkg-config --static --libs "${needs[@]}")
      for name in gpgp_compiler gpgp_evaluator gpgp_text gpgp; do flags=" $flags "; flags=${flags// -l$name / -l:lib$name.a }; done
      # shellcheck disable=SC2046,SC2086
      "$cc" -std=c99 "${define[@]}" $(pkg-config --cflags "$package") "$tests/consumer.c" $flags \
        -o "$scratch/pkg_config/static_$package"
      "$scratch/pkg_config/static_$package" || fail "static_$package returned $?"
      ran=$((ran + 1))
    fi
  done
  [[ $ran -ge 1 ]] || fail "no consumer was built"
  [[ $(pkg-config --modversion gpgp) == $(sed -nE 's/^Version: //p' "$directory/gpgp.pc") ]]
  ;;
*) fail "unknown way $way" ;;
esac
