#!/usr/bin/env bash
# The three services and the samples on SwiftShader, a second Vulkan implementation whose subgroups have 4 invocations,
# beside the default device: the same counts, keys and pictures. Skipped (77) where tests/data/fetch.sh has not been.
#
#   second_device_test.sh COMMAND COMPARE_PICTURES SOURCE OUT [MINI_ENGINE OTHER_SAMPLE...]
set -euo pipefail
gpgp=$1 compare=$2 source=$3 out=$4
samples=("${@:5}")
library=$source/tests/data/fetched/swiftshader/libvk_swiftshader.so
[[ -f $library ]] || {
  echo "skipped: no $library; 'tests/data/fetch.sh --only swiftshader' fetches it"
  exit 77
}
rm -rf "$out"
mkdir -p "$out"
cat >"$out/swiftshader.json" <<END
{"file_format_version": "1.0.0", "ICD": {"library_path": "$(realpath "$library")", "api_version": "1.3.0"}}
END

fail() {
  echo "FAILED: $*"
  exit 1
}
# onSwiftShader COMMAND...
onSwiftShader() {
  env -u GPGP_DEVICE VK_DRIVER_FILES="$out/swiftshader.json" VK_ICD_FILENAMES="$out/swiftshader.json" "$@"
}
# both NAME COMMAND...: runs it on both devices, with {} replaced by a place for its files; output in NAME.{1,2}.txt
both() {
  local name=$1 began=$SECONDS
  shift
  "${@//\{\}/$out/$name.1}" >"$out/$name.1.txt" 2>&1 ||
    fail "$name on the default device: $(tail -n 3 "$out/$name.1.txt")"
  onSwiftShader "${@//\{\}/$out/$name.2}" >"$out/$name.2.txt" 2>&1 ||
    fail "$name on SwiftShader: $(tail -n 3 "$out/$name.2.txt")"
  echo "$name: $((SECONDS - began)) s"
}
# sameFields NAME FIELD...: fields of the JSON that both runs printed
sameFields() {
  local name=$1 field first second
  shift
  grep -q '"device": "SwiftShader' "$out/$name.2.txt" || fail "$name did not run on SwiftShader"
  for field in "$@"; do
    first=$(grep -m 1 "\"$field\":" "$out/$name.1.txt") || fail "$name prints no $field"
    second=$(grep -m 1 "\"$field\":" "$out/$name.2.txt") || fail "$name prints no $field on SwiftShader"
    [[ $first == "$second" ]] || fail "$name:$first on the default device,$second on SwiftShader"
  done
}
samePictures() { cmp "$1" "$2" || fail "$1 and $2 differ"; }

both spawn "$gpgp" spawn "$source/samples/grammars/menger_sponge_3.pga" --json
sameFields spawn terminals key_hash
both vector "$gpgp" vector "$source/tests/data/svg/hud.svg" --size 512x512 --out {}.png --json
sameFields vector paths patches tile_entries
# A gradient may be rounded otherwise; coverage may not.
"$compare" "$out/vector.1.png" "$out/vector.2.png" 1 0 || fail "the drawing's pictures differ"
# Thin frames along the page, at widths of 256 to 2048, beside cairo's tile by tile.
pages=$(dirname "$gpgp")/vector_page_test
if [[ -x $pages ]]; then
  onSwiftShader "$pages" --gtest_filter='PageTest.*:*AtAnySize*' >"$out/pages.txt" 2>&1 ||
    fail "pages on SwiftShader: $(grep -m 3 -A 3 Failure "$out/pages.txt")"
fi
both visibility "$gpgp" visibility "$source/tests/data/cases/visibility/rooms.obj" --method exact --size 256x256 --json
sameFields visibility visible coveredPixels
if ((${#samples[@]})); then
  both mini_engine "${samples[0]}" --frames 2 --size 320x180 --out {}
  for picture in "$out"/mini_engine.1/*.png; do
    # The engine's own edges and far windows alias, each device in its way: up to 15 of 255 in a tile's mean.
    "$compare" "$picture" "$out/mini_engine.2/$(basename "$picture")" 16 0 8 || fail "$(basename "$picture") differs"
  done
  for program in "${samples[@]:1}"; do both "$(basename "$program")" "$program"; done
fi
echo "all equal"
