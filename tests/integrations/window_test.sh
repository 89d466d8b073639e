#!/usr/bin/env bash
# A sample in a window of a virtual display, under the validation layer: it says that all is well, and its last frame is
# a picture that is not of one colour. SAME_AS is the picture of another toolkit's window, which has to be equal.
#
#   window_test.sh XVFB_RUN SAMPLE PICTURE [SAME_AS]
set -euo pipefail
xvfb=$1 sample=$2 picture=$3 other=${4-}
rm -f "$picture"
SDL_VIDEODRIVER=x11 "$xvfb" -a -s "-screen 0 800x600x24" "$sample" --frames 4 --size 480x270 --validate --picture "$picture"
size=$(stat -c %s "$picture")
[[ $size -gt $((480 * 270 * 3)) ]] || { echo "FAILED: the picture has $size bytes" >&2; exit 1; }
colours=$(tail -c +200 "$picture" | od -An -v -tx4 -w4 | sort -u | wc -l)
[[ $colours -gt 100 ]] || { echo "FAILED: the picture has $colours colours" >&2; exit 1; }
echo "$colours colours"
if [[ -n $other ]] && ! cmp "$picture" "$other"; then
  echo "FAILED: it differs from the picture of the other toolkit's window" >&2
  exit 1
fi
