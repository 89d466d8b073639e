#!/usr/bin/env bash
# The recipes of vcpkg and Conan, as far as can be seen without either: their version is the header's, every option that
# they set is one of CMakeLists.txt, what they name is there, and they parse.
#
#   recipes_test.sh SOURCE_DIR CMAKE SCRATCH_DIR
set -euo pipefail
source=$1 cmake=$2 scratch=$3
port=$source/src/cmake/packages/vcpkg/gpgp recipe=$source/src/cmake/packages/conan/conanfile.py
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
mkdir -p "$scratch"
version=$(sed -nE 's/^#define GPGP_VERSION_(MAJOR|MINOR|PATCH) ([0-9]+)$/\2/p' "$source/include/gpgp/core.h" | paste -sd.)
options=$(sed -nE 's/^option\((GPGP_[A-Z_]+).*/\1/p' "$source/CMakeLists.txt" "$source/src/cmake/package.cmake")

# vcpkg: the port runs with vcpkg's functions replaced by ones that print their arguments.
cat >"$scratch/port.cmake" <<END
file(READ "$port/vcpkg.json" json)
string(JSON version GET "\${json}" version-semver)
message("version \${version}")
string(JSON count LENGTH "\${json}" features)
math(EXPR last "\${count} - 1")
foreach(i RANGE \${last})
  string(JSON name MEMBER "\${json}" features \${i})
  message("feature \${name}")
endforeach()
set(CURRENT_PORT_DIR "$port")
set(VCPKG_LIBRARY_LINKAGE dynamic)
set(CURRENT_PACKAGES_DIR "$scratch/packages")
function(vcpkg_check_features)
  message("features \${ARGN}")
endfunction()
function(vcpkg_cmake_configure)
  message("configure \${ARGN}")
endfunction()
function(vcpkg_install_copyright)
  message("copyright \${ARGN}")
endfunction()
foreach(name find_acquire_program add_to_path cmake_install cmake_config_fixup fixup_pkgconfig copy_pdbs)
  cmake_language(EVAL CODE "function(vcpkg_\${name})\nendfunction()")
endforeach()
include("$port/portfile.cmake")
END
"$cmake" -P "$scratch/port.cmake" >"$scratch/port.log" 2>&1 || { cat "$scratch/port.log"; fail "the port does not run"; }
grep -qx "version $version" "$scratch/port.log" || fail "vcpkg.json is not of version $version"
grep -q "SOURCE_PATH;$source;" "$scratch/port.log" || fail "the port's sources are not $source"
grep -q -- "-DGPGP_BUILD_SHARED=1;-DGPGP_BUILD_STATIC=0" "$scratch/port.log" || { cat "$scratch/port.log"; fail "linkage"; }
for name in $(grep -oE 'GPGP_[A-Z_]+' "$scratch/port.log" | sort -u); do
  grep -qx "$name" <<<"$options" || fail "the port sets $name, which CMakeLists.txt does not have"
done
for feature in $(sed -nE 's/^feature //p' "$scratch/port.log"); do
  grep -qE "^features .*;$feature;GPGP_" "$scratch/port.log" || fail "feature $feature sets no option"
done

# Conan.
if command -v python3 >/dev/null; then
  python3 -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' "$recipe" || fail "conanfile.py does not parse"
fi
for name in $(grep -oE '"GPGP_[A-Z]+_[A-Z]+"' "$recipe" | tr -d '"' | sort -u) $(sed -nE 's/.*for part in \((.*)\):/\1/p' "$recipe" | tr -d '",' |
  xargs printf 'GPGP_BUILD_%s '); do
  grep -qx "$name" <<<"$options" || fail "the recipe sets $name, which CMakeLists.txt does not have"
done
for name in $(sed -nE 's/.*for pattern in \((.*)\):/\1/p' "$recipe" | tr -d '",*'); do
  [[ -e $source/$name ]] || fail "the recipe exports $name, which does not exist"
done
if command -v conan >/dev/null; then
  [[ $(CONAN_HOME=$scratch/conan conan inspect "$recipe" | sed -nE 's/^version: //p') == "$version" ]] || fail "conan reads another version"
else
  echo "No conan: its recipe was parsed, not run"
fi
