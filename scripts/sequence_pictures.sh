#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/far_motion.png anew: what --far makes of a sky without motion, for docs/sequences.md.
#
#   scripts/sequence_pictures.sh     less than a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures quincunx-resolve

sun=96x72+430+120      # of the picture, three times as large
wheel=288x216+340+50   # of the errors
run=(--scene backdrop --scale 0.5 --start 1 --frames 25)

# resolve NAME OPTION ...: the sequence's last frame, into $work/NAME.0024.png.
resolve() {
  local name=$1
  shift
  build/release/bin/quincunx-resolve "$work/frame.%04d.exr" --frames 24 -q --out "$work/$name.%04d.png" "$@"
}

build/release/bin/quincunx-dump -q --output 640x360 "${run[@]}" --jitter halton --sequence "$work/frame.%04d.exr"
dump . "${run[@]}" --frame 24 --stages truth --truth 8 --exposure 1
truth=$work/frame.0024.truth.png
for far in drawn camera evidence; do
  resolve "$far" --method temporal --far "$far"
  add_tile "--far $far" "$work/$far.0024.png" "$sun" 300
  convert "$work/$far.0024.png" \( "$truth" -crop 640x360+0+0 +repage \) -compose difference -composite \
    -colorspace gray -level 0,12% "$work/$far.error.png"
done
add_tile "truth, 64 samples" "$truth" "$sun" 300
for far in drawn camera evidence; do
  add_tile "its error, 8 times" "$work/$far.error.png" "$wheel" 100
done
resolve point --method point
add_tile "one frame" "$work/point.0024.png" "$sun" 300
sheet far_motion.png 4
