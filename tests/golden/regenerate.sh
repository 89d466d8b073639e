#!/usr/bin/env bash
# Makes the stored pictures anew, with the release build on the default device (lavapipe). Look at them before you
# commit them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build/release/mini_engine --frames 3 --size 640x360 --out tests/golden
# Of the game's screen the test cuts out the panels; it fails where they are no longer what is stored.
build/release/golden_test --gtest_filter=Screen.PanelsLookAsStored || true
cp build/release/tests/golden/pictures-screen/stored/screen-*.png tests/golden
