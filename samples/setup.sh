# Sourced by samples/run.sh and tests/run.sh: one clear line per step, missing Debian packages, the compiler cache.
# Works as root or through sudo, asks nothing, and does nothing where everything is there.

say() { printf '\n== %s\n' "$*"; }
note() { printf '   %s\n' "$*"; }
die() {
  printf '\nerror: %s\n' "$*" >&2
  exit 1
}

# packagesIn FILE...: the names, without comments.
packagesIn() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$@"; }

isInstalled() { [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

# installMissing FILE...: installs those of the listed packages that are not there.
installMissing() {
  command -v dpkg-query >/dev/null || die "this script installs Debian packages; elsewhere install what $* name and run cmake"
  local package missing=() root=()
  while read -r package; do
    isInstalled "$package" || missing+=("$package")
  done < <(packagesIn "$@")
  if ((${#missing[@]} == 0)); then
    note "all packages are there"
    return
  fi
  note "installing: ${missing[*]}"
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "not root and no sudo; as root run: apt-get install ${missing[*]}"
    root=(sudo)
  fi
  local apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0)
  local log
  log=$(mktemp)
  # Old lists name files that are gone from the mirror: so first fresh lists, then the packages.
  if ! { "${apt[@]}" update && "${apt[@]}" install --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    rm -f "$log"
    die "apt-get could not install the packages (its last lines are above)"
  fi
  rm -f "$log"
}

# configure PRESET [-D...]: through ccache where that is installed, with precompiled headers elsewhere.
configure() {
  local preset=$1
  shift
  local cache=(-DGPGP_PRECOMPILED_HEADERS=ON) log
  log=$(mktemp)
  if command -v ccache >/dev/null; then
    cache=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DGPGP_PRECOMPILED_HEADERS=OFF)
  fi
  cmake --preset "$preset" "${cache[@]}" "$@" >"$log" 2>&1 || {
    cat "$log" >&2
    rm -f "$log"
    die "cmake could not configure the preset $preset"
  }
  rm -f "$log"
}

# jobCount: how many at once: all processors, but no more than 1.5 GB of memory each allows.
jobCount() {
  local cpus memory
  cpus=$(nproc)
  memory=$(awk '/^MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo 2>/dev/null || echo "$cpus")
  ((memory >= 1)) || memory=1
  echo $((cpus < memory ? cpus : memory))
}
