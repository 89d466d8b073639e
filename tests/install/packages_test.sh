#!/usr/bin/env bash
# Debian packages as a system gets them: made by CPack, installed by dpkg into a bare root whose database knows this
# machine's packages, used by consumers, and removed again.
#
#   packages_test.sh BUILD_DIR SCRATCH_DIR TEST_DIR CPACK CMAKE CC
set -euo pipefail
build=$1 scratch=$2 tests=$3 cpack=$4 cmake=$5 cc=$6
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch/debs"
if ! (cd "$scratch/debs" && "$cpack" -G DEB --config "$build/CPackConfig.cmake" -B "$scratch/debs") >"$scratch/cpack.log" 2>&1; then
  cat "$scratch/cpack.log"
  fail "cpack"
fi
field() { dpkg-deb -f "$1" "$2"; }
declare -A deb
for file in "$scratch"/debs/*.deb; do deb[$(field "$file" Package)]=$file; done
echo "packages: ${!deb[*]}"
header=$(sed -nE 's/^#define GPGP_VERSION_(MAJOR|MINOR|PATCH) ([0-9]+)$/\2/p' "$tests/../../include/gpgp/core.h" | paste -sd.)
soname=${header%.*}
[[ ${soname%%.*} == 0 ]] || soname=${soname%%.*}
runtime=libgpgp$soname
[[ -n ${deb[$runtime]-} && -n ${deb[libgpgp-dev]-} ]] || fail "no $runtime or no libgpgp-dev"

# What they say.
for package in "${!deb[@]}"; do
  [[ $(field "${deb[$package]}" Version) == "$header" ]] || fail "$package is not of version $header"
  depends=$(field "${deb[$package]}" Depends)
  echo "$package: $(stat -c %s "${deb[$package]}") bytes, needs ${depends:-nothing}"
  if grep -iE 'libvulkan1|validation|glslang-tools|Not found' <<<"$depends"; then fail "$package needs what it must not"; fi
  case $package in
  libgpgp-dev)
    for library in "${!deb[@]}"; do
      [[ $library != libgpgp*"$soname" ]] || grep -qF "$library (= $header)" <<<"$depends" || fail "libgpgp-dev goes with any $library"
    done
    grep -q libvulkan-dev <<<"$depends" || fail "libgpgp-dev does not need the Vulkan headers"
    ;;
  *) grep -q 'libc6 (>=' <<<"$depends" || fail "$package does not say which C library it needs" ;;
  esac
done
grep -qE 'libfreetype|libicu|libpugixml' <<<"$(field "${deb[$runtime]}" Depends)" && fail "$runtime needs what only text and compilers need"
dpkg-deb -I "${deb[$runtime]}" shlibs | grep -qE "^libgpgp +$soname +$runtime" || fail "$runtime has no shlibs entry of its soname"

# A bare root. Its database says that what Debian has is there, so that dpkg checks every name and version.
root=$scratch/root
mkdir -p "$root"/var/lib/dpkg/{info,updates,triggers}
cp /var/lib/dpkg/status "$root/var/lib/dpkg/status"
touch "$root/var/lib/dpkg/available"
inRoot() { dpkg --root="$root" --force-not-root --force-script-chrootless --log=/dev/null "$@"; }
inRoot -i "${deb[@]}" >"$scratch/dpkg.log" 2>&1 || { cat "$scratch/dpkg.log"; fail "dpkg -i"; }
find "$root/usr" -type f -o -type l | sed "s|^$root||" | sort >"$scratch/files"
while read -r file; do
  inRoot -S "$file" >/dev/null 2>&1 || fail "$file is no package's"
done <"$scratch/files"
library=$(find "$root/usr/lib" -name libgpgp.so)
[[ -L $library ]] || fail "libgpgp-dev has no libgpgp.so"
libraries=$(dirname "$library")
for package in "${!deb[@]}"; do
  [[ -s $root/usr/share/doc/$package/copyright ]] || fail "$package has no copyright file"
done
if readelf -S "$libraries"/libgpgp.so.$header | grep -q '\.debug_'; then fail "libgpgp is not stripped"; fi

# Consumers, by CMake and by pkg-config.
"$cmake" -S "$tests/find_package" -B "$scratch/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$root/usr" -DCMAKE_C_COMPILER="$cc" \
  -DCMAKE_BUILD_TYPE=Release -DCONSUMER_OF_SHARED_LIBRARIES=ON >"$scratch/consumer.log" 2>&1 &&
  "$cmake" --build "$scratch/consumer" --target consumer_gpgp >>"$scratch/consumer.log" 2>&1 ||
  { cat "$scratch/consumer.log"; fail "find_package"; }
export PKG_CONFIG_PATH=$libraries/pkgconfig
ran=0
for package in gpgp gpgp_compiler gpgp_text; do
  pkg-config --exists "$package" || continue
  needs=(gpgp)
  define=()
  [[ $package == gpgp ]] || needs=("$package" gpgp)
  [[ $package != gpgp_compiler ]] || define=(-DCONSUMER_USES_COMPILER)
  [[ $package != gpgp_text ]] || define=(-DCONSUMER_USES_TEXT)
  # shellcheck disable=SC2046
  "$cc" -std=c99 "${define[@]}" $(pkg-config --cflags "${needs[@]}") "$tests/consumer.c" $(pkg-config --libs "${needs[@]}") \
    -o "$scratch/consumer_$package"
  LD_LIBRARY_PATH=$libraries "$scratch/consumer_$package" || fail "consumer_$package returned $?"
  ran=$((ran + 1))
done
[[ $ran -ge 1 ]] || fail "no consumer was built"

# Whoever runs a program needs the library's package alone, and dpkg keeps what is needed.
if [[ -n ${deb[gpgp]-} ]]; then
  "$root/usr/bin/gpgp" --version
  inRoot -r gpgp >>"$scratch/dpkg.log" 2>&1
  [[ ! -e $root/usr/bin/gpgp ]] || fail "gpgp was removed and is there"
fi
if inRoot -r "$runtime" >>"$scratch/dpkg.log" 2>&1; then fail "$runtime was removed from below libgpgp-dev"; fi
inRoot -r libgpgp-dev >>"$scratch/dpkg.log" 2>&1
[[ ! -e $root/usr/include/gpgp ]] || fail "libgpgp-dev was removed and its headers are there"
LD_LIBRARY_PATH=$libraries "$scratch/consumer/consumer_gpgp" || fail "a consumer needs more than $runtime"
inRoot -r "$runtime" >>"$scratch/dpkg.log" 2>&1
if LD_LIBRARY_PATH=$libraries "$scratch/consumer/consumer_gpgp" 2>/dev/null; then fail "the consumer did not use $runtime"; fi
rm -rf "$scratch/debs" "$root"
