#!/usr/bin/env bash
# Builds the libraries that gpgp links for Windows, from Debian's source packages, with the toolchain file mingw.cmake.
# They are static, so that what is linked with them needs no DLL of theirs. What was built once is not built again.
#
#   dependencies.sh [PART...]    base (the default), compiler, text, all
#
#   base      what libgpgp, the command without compilers and the tests need: headers, zstd, zlib, libpng,
#             tinygltf, GoogleTest, an import library of the Vulkan loader
#   compiler  libgpgp_compiler: pugixml, SPIRV-Tools, glslang. Not built to its end yet: expect to mend it.
#   text      libgpgp_text: FreeType, HarfBuzz, FriBidi, ICU
#
#   GPGP_DEPENDENCIES=folder     where they go (build/mingw-dependencies)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
export GPGP_DEPENDENCIES=${GPGP_DEPENDENCIES:-$root/build/mingw-dependencies}
prefix=$GPGP_DEPENDENCIES
work=$prefix/work
jobs=${GPGP_JOBS:-$(nproc)}
mkdir -p "$work/lists/partial" "$prefix/include" "$prefix/lib/pkgconfig" "$prefix/lib/cmake"

die() {
  echo "error: $*" >&2
  exit 1
}

# Debian's archive as the system knows it, with its sources; the system's own lists stay as they are.
apt=(apt-get -q -o APT::Sandbox::User=root -o "Dir::Etc::SourceList=$work/sources.list" -o Dir::Etc::SourceParts=/dev/null
  -o "Dir::State::Lists=$work/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=)
prepareSources() {
  [[ ! -e $work/sources.list ]] || return 0
  local mirror suite
  # shellcheck disable=SC1091
  suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mirror=$(grep -rhoE 'https?://[^ ]+/debian/?( |$)' /etc/apt/sources.list /etc/apt/sources.list.d 2>/dev/null | head -n 1) || true
  mirror=${mirror:-http://deb.debian.org/debian}
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] ${mirror% } $suite main" >"$work/sources.list.new"
  sed 's/^deb-src/deb/' "$work/sources.list.new" >>"$work/sources.list.new.deb"
  cat "$work/sources.list.new.deb" >>"$work/sources.list.new"
  rm "$work/sources.list.new.deb"
  mv "$work/sources.list.new" "$work/sources.list"
  "${apt[@]}" update >"$work/update.log" 2>&1 || { cat "$work/update.log" >&2; rm "$work/sources.list"; die "no lists of source packages"; }
}
# unpacked PACKAGE: with Debian's patches, in $work/PACKAGE
unpacked() {
  [[ ! -d $work/$1 ]] || return 0
  prepareSources
  (
    mkdir -p "$work/download"
    cd "$work/download"
    "${apt[@]}" source --download-only "$1" && dpkg-source --no-check -x "$1"_*.dsc "$work/$1.new"
  ) >"$work/$1.log" 2>&1 || { tail -n 20 "$work/$1.log" >&2; die "no source package $1"; }
  mv "$work/$1.new" "$work/$1"
}

# once NAME COMMAND...: unless that has been done.
once() {
  local name=$1
  shift
  [[ ! -e $work/$name.done ]] || return 0
  echo "-- $name"
  local begin=$SECONDS
  (set -e; "$@") >"$work/$name.build.log" 2>&1 || { tail -n 40 "$work/$name.build.log" >&2; die "$name was not built"; }
  echo "   $((SECONDS - begin)) s"
  touch "$work/$name.done"
}
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
# cmakeConfigure NAME SOURCE [-D...], cmakeInstall with the same
cmakeConfigure() {
  local name=$1 from=$2
  shift 2
  cmake -S "$from" -B "$work/build-$name" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$here/mingw.cmake" "${launcher[@]}" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=OFF "$@"
}
cmakeInstall() {
  cmakeConfigure "$@"
  cmake --build "$work/build-$1" --parallel "$jobs"
  cmake --install "$work/build-$1"
}
# plain NAME SOURCE: a library that plain/ compiles
plain() { cmakeInstall "$1" "$here/plain" -DLIBRARY="$1" -DSOURCE="$2"; }
# pkgConfig NAME VERSION FLAGS
pkgConfig() {
  printf 'prefix=${pcfiledir}/../..\nName: %s\nDescription: %s\nVersion: %s\nCflags: -I${prefix}/include %s\nLibs: -L${prefix}/lib %s\n' \
    "$1" "$1" "$2" "$4" "$3" >"$prefix/lib/pkgconfig/$1.pc"
}

# Headers that have nothing to compile: those of the packages that are installed here, with how CMake finds them.
headers() {
  local package file
  for package in libvulkan-dev libvulkan-volk-dev libglm-dev libcli11-dev nlohmann-json3-dev libtinygltf-dev libstb-dev; do
    dpkg-query -W "$package" >/dev/null || die "install $package (samples/packages.txt)"
    while read -r file; do
      [[ -f $file ]] || continue
      case $file in
      /usr/include/*) install -D -m 644 "$file" "$prefix/include/${file#/usr/include/}" ;;
      /usr/share/cmake/*) install -D -m 644 "$file" "$prefix/share/cmake/${file#/usr/share/cmake/}" ;;
      esac
    done < <(dpkg -L "$package")
  done
}
# Functions that the loader exports: those of core Vulkan, of surfaces and of swapchains.
vulkanLoader() {
  {
    echo "LIBRARY vulkan-1.dll"
    echo EXPORTS
    awk '/^#define VK_(VERSION_1_[0-3]|KHR_surface|KHR_swapchain) 1/ { on = 1; next } /^#define VK_[A-Z]+_[a-z0-9_]+ 1/ { on = 0 }
      on && /VKAPI_CALL vk/ { sub(/^.*VKAPI_CALL /, ""); sub(/\(.*/, ""); print }' "$prefix/include/vulkan/vulkan_core.h"
  } >"$work/vulkan-1.def"
  x86_64-w64-mingw32-dlltool -d "$work/vulkan-1.def" -l "$prefix/lib/libvulkan-1.dll.a"
}

# Of its libraries the two that are linked: the others take as long again.
spirvTools() {
  cmakeConfigure spirv-tools "$work/spirv-tools" -DSPIRV-Headers_SOURCE_DIR="$work/spirv-headers/usr" \
    -DSPIRV_SKIP_TESTS=ON -DSPIRV_SKIP_EXECUTABLES=ON -DSPIRV_WERROR=OFF
  cmake --build "$work/build-spirv-tools" --parallel "$jobs" --target SPIRV-Tools-static SPIRV-Tools-opt
  cp "$work"/build-spirv-tools/source/libSPIRV-Tools.a "$work"/build-spirv-tools/source/opt/libSPIRV-Tools-opt.a "$prefix/lib/"
  cp -r "$work/spirv-tools/include/spirv-tools" "$prefix/include/"
}

base() {
  once headers headers
  once vulkan-loader vulkanLoader
  unpacked libzstd
  once zstd cmakeInstall zstd "$work/libzstd/build/cmake" -DZSTD_BUILD_PROGRAMS=OFF -DZSTD_BUILD_SHARED=OFF
  unpacked zlib
  once zlib plain zlib "$work/zlib"
  unpacked libpng1.6
  once libpng cmakeInstall libpng "$work/libpng1.6" -DPNG_SHARED=OFF -DPNG_TESTS=OFF
  once tinygltf plain tinygltf "$prefix/include"
  [[ -d /usr/src/googletest ]] || die "install libgtest-dev or googletest (tests/packages.txt)"
  once googletest cmakeInstall googletest /usr/src/googletest -DBUILD_GMOCK=OFF
}
compiler() {
  unpacked pugixml
  once pugixml cmakeInstall pugixml "$work/pugixml"
  unpacked spirv-tools
  if [[ ! -d $work/spirv-headers ]]; then
    prepareSources
    (cd "$work/download" && "${apt[@]}" download spirv-headers && dpkg-deb -x spirv-headers_*.deb "$work/spirv-headers") >"$work/spirv-headers.log" 2>&1 ||
      { cat "$work/spirv-headers.log" >&2; die "no package spirv-headers"; }
  fi
  once spirv-tools spirvTools
  unpacked glslang
  once glslang cmakeInstall glslang "$work/glslang" -DENABLE_CTEST=OFF -DENABLE_GLSLANG_BINARIES=OFF -DENABLE_OPT=OFF \
    -DENABLE_HLSL=ON
}
text() {
  unpacked freetype
  once freetype cmakeInstall freetype "$work/freetype" -DFT_DISABLE_BZIP2=ON -DFT_DISABLE_BROTLI=ON \
    -DFT_DISABLE_HARFBUZZ=ON -DFT_REQUIRE_PNG=ON -DFT_REQUIRE_ZLIB=ON
  unpacked harfbuzz
  once harfbuzz cmakeInstall harfbuzz "$work/harfbuzz" -DHB_BUILD_SUBSET=OFF -DHB_HAVE_GLIB=OFF
  unpacked fribidi
  once fribidi plain fribidi "$work/fribidi"
  unpacked icu
  once icu plain icu "$work/icu"
  pkgConfig freetype2 24.3.18 "-lfreetype -lpng -lz" '-I${prefix}/include/freetype2'
  pkgConfig harfbuzz 6.0.0 "-lharfbuzz" '-I${prefix}/include/harfbuzz'
  pkgConfig fribidi 1.0.8 "-lfribidi" '-I${prefix}/include/fribidi -DFRIBIDI_LIB_STATIC'
  pkgConfig icu-uc 72.1 "-licuuc" "-DU_STATIC_IMPLEMENTATION"
}

command -v x86_64-w64-mingw32-g++-posix >/dev/null || die "install g++-mingw-w64-x86-64-posix"
[[ $# -gt 0 ]] || set -- base
for part in "$@"; do
  case $part in
  base) base ;;
  compiler) base && compiler ;;
  text) base && text ;;
  all) base && compiler && text ;;
  -h | --help) sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}" ;;
  *) die "there is no part '$part' (see --help)" ;;
  esac
done
