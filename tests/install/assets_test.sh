#!/usr/bin/env bash
# gpgp_add_assets in a project that finds an installed gpgp: what is baked when, with which options, and that an error in a
# grammar fails the build.
#
#   assets_test.sh PREFIX SCRATCH_DIR CMAKE
set -euo pipefail
font=$(cd "$(dirname "$0")/../data" && pwd)/fetched/fonts/DejaVuSans.ttf # where tests/data/fetch.sh has been
prefix=$1 scratch=$2 cmake=$3
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch/parts"
cd "$scratch"
tower='axiom Box A;\nterminal Floor (1, 0);\nvar height = 3;\nA = Repeat(Y, height, ADJUST_TO_FILL) Floor;\n'
# shellcheck disable=SC2059
printf "$tower" | tee tower.pga parts/tower.pga >small.pga
printf '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M0 0h9v9z"/></svg>' >hud.svg
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(engine C)
find_package(gpgp REQUIRED)
add_custom_target(engine ALL)
gpgp_add_assets(engine tower.pga parts/tower.pga hud.svg NO_KERNEL OUTPUTS baked)
gpgp_add_assets(engine small.pga DESTINATION small SET height=2 OUTPUTS small)
file(GENERATE OUTPUT list.txt CONTENT "${baked};${small}\n")
END
build() { "$cmake" --build build >log 2>&1; }

"$cmake" -S . -B build -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >log 2>&1 || { cat log; fail "configuring"; }
build || { cat log; fail "building"; }
IFS=';' read -ra baked <build/list.txt
[[ ${#baked[@]} == 4 ]] || fail "OUTPUTS names ${#baked[@]} files: ${baked[*]}"
for file in "${baked[@]}"; do [[ -s $file ]] || fail "$file was not baked"; done
same() { cmp "$1" <("$prefix/bin/gpgp" bake "${@:2}" -o -) || fail "$1 is not what gpgp bake makes of ${*:2}"; }
same build/assets/tower.pga.gpgp tower.pga --no-kernel
same build/assets/parts/tower.pga.gpgp parts/tower.pga --no-kernel
same build/assets/hud.svg.gpgpv hud.svg
same build/small/small.pga.gpgp small.pga --set height=2
[[ $(head -c 4 build/assets/tower.pga.gpgp) == gppg ]] || fail "no baked grammar"

build
grep -q 'no work to do' log || { cat log; fail "nothing changed, and something was baked"; }
sed -i 's/height = 3/height = 4/' parts/tower.pga
build
[[ $(grep -c 'Baking' log) == 1 ]] || { cat log; fail "one file changed; expected one to be baked"; }
same build/assets/parts/tower.pga.gpgp parts/tower.pga --no-kernel

printf 'B = Nowhere;\n' >>small.pga
if build; then fail "a grammar with an error was built"; fi
grep -q 'small.pga:5:5: .*Nowhere' log || { cat log; fail "the error has no place"; }

if [[ -e $font ]] && "$prefix/bin/gpgp" bake --help | grep -q -- --ranges; then
  mkdir -p fonts
  cp "$font" fonts/Sans.TTF
  echo 'Score: é' >fonts/strings.txt
  cat >fonts/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(fonts C)
find_package(gpgp REQUIRED)
add_custom_target(fonts ALL)
gpgp_add_assets(fonts Sans.TTF RANGES U+0030-0039,U+20AC U+41 CHARACTERS_FILES strings.txt OUTLINE 0.1)
END
  "$cmake" -S fonts -B fonts/build -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >log 2>&1 ||
    { cat log; fail "configuring fonts"; }
  wanted=(fonts/Sans.TTF --ranges U+30-39,U+20AC,U+41 --outline 0.1 --characters)
  "$cmake" --build fonts/build >log 2>&1 || { cat log; fail "building fonts"; }
  same fonts/build/assets/Sans.TTF.gpgpf "${wanted[@]}" 'Score: é'
  echo 'Tore: é' >fonts/strings.txt
  "$cmake" --build fonts/build >log 2>&1 || { cat log; fail "building fonts again"; }
  same fonts/build/assets/Sans.TTF.gpgpf "${wanted[@]}" 'Tore: é'
fi

refused() { # ARGUMENTS EXPECTED
  mkdir -p refused
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(x C)\nfind_package(gpgp REQUIRED)\nadd_custom_target(x)\n%s\n' \
    "gpgp_add_assets($1)" >refused/CMakeLists.txt
  if "$cmake" -S refused -B refused/build -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >log 2>&1; then fail "accepted: $1"; fi
  tr -s '\n ' ' ' <log | grep "$2" >/dev/null || { cat log; fail "$1: another error than '$2'"; }
}
refused 'y a.pga' 'there is no target y'
refused 'x' 'there are no files'
refused 'x nowhere.pga' 'there is no file .*nowhere.pga'
refused 'x ../tower.pga ../parts/tower.pga' 'two files would become'
echo "gpgp_add_assets: ${#baked[@]} files"
