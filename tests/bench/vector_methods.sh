#!/usr/bin/env bash
# Tables 5.1 and 5.2 of the thesis by method, as Markdown: what drawings cost as flattened outlines and as patches in a
# canvas, and as patches in the engine's pass; and how near their pictures are to 256 samples a pixel.
#
#   tests/bench/vector_methods.sh [--repeat N] [--device NAME] FILE...
#
# FILEs are SVGs; `vector_bench --svg FOLDER map page panels` writes generated ones. Of the first, zooms of 16 and 256 are
# measured as well, and its pictures. Times are medians of whole recordings on the GPU, in milliseconds.
set -euo pipefail
command=$(dirname "${BASH_SOURCE[0]}")/../../build/release/gpgp
repeat=60
while [[ ${1:-} == --* ]]; do
  case $1 in
  --repeat) repeat=${2:?how often} ;;
  --device) export GPGP_DEVICE=${2:?a device} ;;
  *) sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
  esac
  shift 2
done
[[ $# -gt 0 ]] || { echo "error: no drawing is given" >&2 && exit 2; }
result=$(mktemp)
trap 'rm -f "$result"' EXIT

# value KEY: a number of the last run; a dash where it has none
value() { sed -nE "s/^ *\"$1\": ([0-9.e+-]+),?$/\1/p" "$result" | head -n1 | grep . || echo -; }
# draw FILE ZOOM METHOD AA [OPTION...]
draw() {
  local file=$1 zoom=$2 method=$3 aa=$4
  shift 4
  "$command" vector "$file" --size 1024x1024 --zoom "$zoom" --method "$method" --aa "$aa" --background white --json "$@" \
    >"$result" 2>/dev/null || true
}
short() { if [[ $1 == - ]]; then printf -- -; else printf "%.${2:-4}f" "$1"; fi; }

echo "| drawing | zoom | flattened, 1 | flattened, 16 | patches, 1 | patches, 16 | in-pass, area | in-pass, 4 |"
echo "|---|---|---|---|---|---|---|---|"
first=$1
for file in "$@"; do
  for zoom in 1 16 256; do
    [[ $zoom == 1 || $file == "$first" ]] || continue
    printf '| %s | %s' "$(basename "$file")" "$zoom"
    for method in "flattened 1" "flattened 16" "patches 1" "patches 16" "in-pass area" "in-pass 4"; do
      # shellcheck disable=SC2086 # two words
      draw "$file" "$zoom" $method --repeat "$repeat"
      printf ' | %s' "$(short "$(value gpu_ms_median)")"
    done
    echo " |"
  done
done
echo
echo "| drawing | paths | curves | patches | converted, ms | baked, bytes: for canvases | in-pass | both |"
echo "|---|---|---|---|---|---|---|---|"
for file in "$@"; do
  draw "$file" 1 flattened 16
  printf '| %s | %s | %s | %s | %s' "$(basename "$file")" "$(value paths)" "$(value curves)" "$(value patches)" \
    "$(short "$(value convert_ms)" 1)"
  for method in flattened in-pass both; do
    "$command" bake "$file" --method "$method" --out "$result.gpgpv" >/dev/null 2>&1 || true
    printf ' | %s' "$(stat -c %s "$result.gpgpv" 2>/dev/null || echo -)"
    rm -f "$result.gpgpv"
  done
  echo " |"
done
echo
echo "| $(basename "$first"), PSNR in dB | zoom 1 | 16 | 256 |"
echo "|---|---|---|---|"
for method in "flattened 16" "flattened area" "patches 16" "patches area" "in-pass area"; do
  printf '| %s' "$method"
  for zoom in 1 16 256; do
    # shellcheck disable=SC2086 # two words
    draw "$first" "$zoom" $method --reference
    printf ' | %s' "$(short "$(value psnr_db)" 1)"
  done
  echo " |"
done
