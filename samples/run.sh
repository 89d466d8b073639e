#!/usr/bin/env bash
# Builds and runs a first picture, then the mini-engine: pictures always, a window too when there is a display.
#
# Installs what is missing (Debian 12, as root or through sudo), asks nothing, can be run again. Options are handed to
# the mini-engine: samples/run.sh --help shows them once it is built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=samples/setup.sh
source samples/setup.sh

case ${1:-} in
-h | --help)
  sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  if [[ -x build/release/mini_engine ]]; then build/release/mini_engine --help; fi
  exit 0
  ;;
esac

say "1/5 Debian packages (samples/packages.txt)"
installMissing samples/packages.txt

say "2/5 a first picture: a town, by the spawn service alone (build/release)"
configure release -DGPGP_BUILD_TESTS=OFF # these need more packages: tests/run.sh
build() { cmake --build --preset release --target "$@" --parallel "$(jobCount)"; }
pictures=build/release/pictures
mkdir -p "$pictures"
build first_picture
build/release/first_picture "$pictures/first_picture.png"
note "picture: $PWD/$pictures/first_picture.png"

say "3/5 a glTF model and a drawing (tests/data/fetch.sh), and the mini-engine"
if ! tests/data/fetch.sh --only models svg; then
  note "could not be fetched; the mini-engine uses its own small model and drawing instead"
fi
build mini_engine

say "4/5 run the mini-engine"
build/release/mini_engine --out "$pictures" "$@"
for picture in "$pictures"/*.png; do
  if [[ -f $picture ]]; then note "picture: $PWD/$picture"; fi
done

say "5/5 build the gpgp command and the other samples"
build demo
if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} && $# -eq 0 ]]; then
  note "opening a window; close it or press Escape to end"
  build/release/mini_engine --window || note "no window could be opened; the pictures are there all the same"
fi

say "Next"
note "build/release/mini_engine --help                       what else it shows"
note "build/release/gpgp spawn samples/grammars/city.pga --axioms 16 --axiom-size 20,60,20 --spacing 24 --image $pictures/spawned_city.png"
note "docs/guide/integrate_in_ten_minutes.md                 gpgp in your engine"
