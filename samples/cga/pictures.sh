#!/usr/bin/env bash
# Makes the pictures of docs/guide/cga_reference.md: one for each rule of operators.cga that shows an operation.
#   samples/cga/pictures.sh [GPGP [FOLDER]]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
gpgp=${1:-build/release/gpgp}
folder=${2:-docs/pictures/cga}
mkdir -p "$folder"
for rule in $(grep -oE '^[A-Z][A-Za-z]+ --> Ground' samples/cga/operators.cga | cut -d' ' -f1); do
  name=${rule,}
  "$gpgp" spawn samples/cga/operators.cga --start "$rule" --axiom-size 24,1,18 --seed 4 --device cpu \
    --image "$folder/$name.png" --image-size 200x150 --yaw 30 --pitch 32 --zoom 1.15 >/dev/null
  echo "$folder/$name.png"
done
