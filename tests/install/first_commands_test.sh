#!/usr/bin/env bash
# The first commands on a new machine: what samples/run.sh, tests/run.sh and cmake by hand configure, and what they say
# is missing, on machines with different sets of Debian packages.
#
# A machine is a mount namespace whose /usr lacks the headers, programs and CMake and pkg-config files of some packages,
# and whose dpkg does not list them. apt-get is a stand-in that brings packages back, building and ctest are stand-ins
# that do nothing, the sources are a copy on write; nothing outside is changed. Skipped (77) where the system gives no
# such namespace.
#
#   first_commands_test.sh SOURCE
set -euo pipefail
self=$(realpath "$0")
source=$(realpath "$1")
machine=${2:-}

skip() {
  echo "skipped: $*"
  exit 77
}
fail() {
  printf 'FAILED on machine %s: %s\n' "$machine" "$*"
  printf '%s\n' "--- output" "${output:-}" "--- calls" "$(cat "$scratch/calls" 2>/dev/null)"
  exit 1
}
packagesIn() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$@" | sort -u; }

if [[ -z $machine ]]; then
  for tool in unshare mount dpkg-query cmake ninja setpriv; do
    command -v "$tool" >/dev/null || skip "no $tool"
  done
  while read -r package; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      skip "a machine with everything is one with $package"
  done < <(packagesIn "$source/samples/packages.txt" && echo libgtest-dev && echo libcairo2-dev)
  namespace=(unshare --mount)
  ((EUID == 0)) || namespace=(unshare --map-root-user --mount)
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  export scratch
  "${namespace[@]}" bash "$self" "$source" probe >"$scratch/probe" 2>&1 ||
    skip "no mount namespace with overlays: $(tail -n 1 "$scratch/probe")"
  for machine in ${GPGP_TEST_MACHINES:-bare googletest everything sudo}; do
    echo "machine $machine"
    "${namespace[@]}" bash "$self" "$source" "$machine"
  done
  exit 0
fi

# overlay LOWER PLACE: a copy on write of a folder.
overlay() {
  local layers=$scratch/layers/$((++layer))
  mkdir -p "$layers/upper" "$layers/work"
  local options=lowerdir=$1,upperdir=$layers/upper,workdir=$layers/work
  mount -t overlay overlay -o "$options" "$2" 2>/dev/null || mount -t overlay overlay -o "userxattr,$options" "$2"
}
layer=0
cmake=$(command -v cmake)
mount -t tmpfs -o mode=755 tmpfs "$scratch"
mkdir -p "$scratch"/{bin,usr,source,dpkg,layers}
mount --bind /usr "$scratch/usr"
overlay "$scratch/usr" /usr
overlay "$source" "$scratch/source"
[[ $machine != probe ]] || exit 0
mkdir -p "$scratch/source/build"
mount -t tmpfs -o mode=1777 tmpfs "$scratch/source/build"
cd "$scratch/source"

# Packages: `gone` names those that are not there.
export DPKG_ADMINDIR=$scratch/dpkg
ln -s /var/lib/dpkg/info "$DPKG_ADMINDIR/info"
mkdir "$DPKG_ADMINDIR/updates"
: >"$scratch/gone"
: >"$scratch/calls"
chmod 666 "$scratch/gone" "$scratch/calls"
chmod 777 "$scratch/dpkg"
cat >"$scratch/packages.sh" <<'END'
filesOf() { # those that a configuration finds
  env -u DPKG_ADMINDIR dpkg-query -L "$1" 2>/dev/null | grep -E '^/usr/(bin|include|share/cmake|share/pkgconfig)/|/cmake/|/pkgconfig/' || true
}
writeStatus() {
  awk -v RS= -v ORS='\n\n' 'FNR == NR { n = split($0, names, "\n"); for (i = 1; i <= n; ++i) gone[names[i]]; next }
    !($2 in gone)' "$scratch/gone" /var/lib/dpkg/status >"$DPKG_ADMINDIR/status"
  chmod 666 "$DPKG_ADMINDIR/status" 2>/dev/null || true
}
END
# shellcheck disable=SC1091
source "$scratch/packages.sh"
takeAway() { # PACKAGE...: tools that any of this needs stay, though dpkg does not list them
  local package file
  for package in "$@"; do
    [[ ! $package =~ ^(tar|util-linux)$ ]] || continue
    echo "$package" >>"$scratch/gone"
    [[ ! $package =~ ^(g\+\+|cmake|ninja-build|pkg-config|binutils)$ ]] || continue
    while read -r file; do
      [[ -d $file ]] || rm -f "$file"
    done < <(filesOf "$package")
  done
  writeStatus
}

# Stand-ins.
cat >"$scratch/bin/apt-get" <<'END'
#!/usr/bin/env bash
source "$scratch/packages.sh"
while (($#)) && [[ $1 == -* ]]; do [[ $1 != -o ]] || shift; shift; done
echo "apt-get $*" >>"$scratch/calls"
[[ $1 != update ]] || exit 0
[[ $1 == install && ! -e $scratch/offline ]] || exit 100
shift
for package in "$@"; do
  [[ $package != -* ]] || continue
  for file in $(filesOf "$package"); do
    [[ -e $file ]] || cp -a "$scratch$file" "$file"
  done
  left=$(grep -vxF "$package" "$scratch/gone")
  echo "$left" >"$scratch/gone"
done
writeStatus
END
cat >"$scratch/bin/cmake" <<END
#!/usr/bin/env bash
if [[ \$1 == --build ]]; then
  echo "cmake \$*" >>"$scratch/calls"
  printf '#!/bin/sh\n' | tee build/release/first_picture >build/release/mini_engine
  exec chmod +x build/release/first_picture build/release/mini_engine
fi
exec "$cmake" "\$@"
END
printf '#!/bin/sh\necho "ctest $*" >>"%s/calls"\n' "$scratch" >"$scratch/bin/ctest"
printf '#!/bin/sh\necho "sudo $*" >>"%s/calls"\nexec "$@"\n' "$scratch" >"$scratch/bin/sudo"
chmod 755 "$scratch"/bin/*
export PATH=$scratch/bin:$PATH

# run COMMAND...: its output and exit status
run() {
  : >"$scratch/calls"
  status=0
  output=$("$@" 2>&1) || status=$?
}
succeeds() { run "$@" && ((status == 0)) || fail "$* ends with $status"; }
refuses() { run "$@" && ((status != 0)) || fail "$* goes through"; }
says() { [[ $output == *"$1"* ]] || fail "it does not say '$1'"; }
saysNot() { [[ $output != *"$1"* ]] || fail "it says '$1'"; }
testsAre() {
  grep -q "^GPGP_BUILD_TESTS:BOOL=$1\$" build/release/CMakeCache.txt || fail "the tests are not $1"
  if [[ $1 == OFF ]]; then ! grep -q gtest build/release/build.ninja; else grep -q gtest build/release/build.ninja; fi ||
    fail "the build is not one with tests $1"
}
callsInstall() { # PACKAGE...: just these
  local called
  called=$(sed -n 's/^apt-get install --no-install-recommends //p' "$scratch/calls" | tr ' ' '\n' | sort -u)
  [[ $called == "$(printf '%s\n' "$@" | sort -u)" ]] || fail "it does not install just: $*"
}
callsNothing() { ! grep -q "apt-get install" "$scratch/calls" || fail "it installs something"; }
mapfile -t samples < <(packagesIn samples/packages.txt)
mapfile -t tests < <(packagesIn tests/packages.txt | grep -vxE 'tar|util-linux' | comm -23 - <(packagesIn samples/packages.txt))

case $machine in
bare)
  takeAway "${samples[@]}" "${tests[@]}"
  refuses cmake --preset release
  for package in libvulkan-dev glslang-tools libglm-dev libpng-dev libgtest-dev libcairo2-dev; do says "$package"; done
  rm -rf build/release
  succeeds samples/run.sh
  callsInstall "${samples[@]}"
  testsAre OFF
  ;;
googletest)
  takeAway $(printf '%s\n' "${tests[@]}" | grep -vx libgtest-dev)
  refuses cmake --preset release
  says "tests need: libcairo2-dev"
  saysNot "libgtest-dev"
  saysNot "No package 'cairo'"
  succeeds samples/run.sh # over what that configuration has left behind
  callsNothing
  testsAre OFF
  touch "$scratch/offline"
  refuses tests/run.sh --quick
  says libcairo2-dev
  rm "$scratch/offline"
  run tests/run.sh --quick # ends with 1 where there is no data to test with
  callsInstall $(printf '%s\n' "${tests[@]}" | grep -vx libgtest-dev)
  testsAre ON
  grep -q '^ctest --preset release' "$scratch/calls" || fail "no tests are run"
  ;;
everything)
  takeAway
  run tests/run.sh --quick
  testsAre ON
  takeAway libcairo2-dev
  succeeds samples/run.sh
  callsNothing
  testsAre OFF
  ;;
sudo)
  takeAway vulkan-validationlayers
  anyone=(setpriv --reuid=65534 --regid=65534 --clear-groups)
  "${anyone[@]}" true 2>/dev/null || anyone=(unshare --user)
  chmod 755 .
  succeeds "${anyone[@]}" samples/run.sh
  callsInstall vulkan-validationlayers
  grep -q '^sudo env .* apt-get .* install' "$scratch/calls" || fail "it does not go through sudo"
  testsAre OFF
  takeAway vulkan-validationlayers
  rm -f "$scratch/bin/sudo" /usr/bin/sudo
  refuses "${anyone[@]}" samples/run.sh
  says "as root run: apt-get install vulkan-validationlayers"
  ;;
esac
