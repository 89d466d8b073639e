#!/usr/bin/env bash
# Makes the stored pictures anew, with the release build on the default device (lavapipe). Look at them before you
# commit them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build/release/mini_engine --frames 3 --size 640x360 --out tests/golden
