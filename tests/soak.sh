#!/usr/bin/env bash
# The long form of tests/soak: builds it in the preset `release`, runs 2 000 frames under validation, then many without,
# and prints what memory was held, a line for every tenth of the run.
#
#   tests/soak.sh [FRAMES]   default: 100000, some hours on lavapipe
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
frames=${1:-100000}
cmake --build --preset release --target soak --parallel "$(nproc)"
export MESA_SHADER_CACHE_DIR=$PWD/build GALLIVM_PERF=${GALLIVM_PERF-nopt}
build/release/soak --frames 2000
build/release/soak --frames "$frames" --plain --seed 2 --csv build/soak.csv
awk -F, -v frames="$frames" 'NR == 1 {print; next} $1 % (frames / 10) == 0 {print}' build/soak.csv
