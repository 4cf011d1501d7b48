#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/far_motion.png anew: what --far makes of a sky without motion, for docs/sequences.md.
#
#   scripts/sequence_pictures.sh     less than a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump quincunx-resolve

work=build/sequence
rm -rf "$work"
mkdir -p "$work" docs/images
bin=build/release/bin
run=(-q --scene backdrop --output 640x360 --scale 0.5 --start 1 --frames 25)
sun=96x72+430+120      # of the picture, three times as large
wheel=288x216+340+50   # of the errors
tiles=()

# tile FILE GEOMETRY ZOOM LABEL: adds a labelled crop to `tiles`; captions below a picture are cut off first.
tile() {
  local file="$work/tile-${#tiles[@]}.png"
  convert "$1" -crop 640x360+0+0 +repage -crop "$2" +repage -filter point -resize "$3" "$file"
  tiles+=(-label "$4" "$file")
}

"$bin/quincunx-dump" "${run[@]}" --jitter halton --sequence "$work/frame.%04d.exr"
"$bin/quincunx-dump" "${run[@]}" --frame 24 --stages truth --truth 8 --exposure 1 --format png --out "$work"
truth=$work/frame.0024.truth.png
for far in drawn camera evidence; do
  "$bin/quincunx-resolve" "$work/frame.%04d.exr" --frames 24 -q --method temporal --far "$far" \
    --out "$work/$far.%04d.png"
  tile "$work/$far.0024.png" "$sun" 300% "--far $far"
  convert "$work/$far.0024.png" \( "$truth" -crop 640x360+0+0 +repage \) -compose difference -composite \
    -colorspace gray -level 0,12% "$work/$far.error.png"
done
tile "$truth" "$sun" 300% "truth, 64 samples"
for far in drawn camera evidence; do
  tile "$work/$far.error.png" "$wheel" 100% "its error, 8 times"
done
"$bin/quincunx-resolve" "$work/frame.%04d.exr" --frames 24 -q --method point --out "$work/point.%04d.png"
tile "$work/point.0024.png" "$sun" 300% "one frame"
montage "${tiles[@]}" -tile 4x -geometry +4+4 -font DejaVu-Sans -pointsize 16 -depth 8 docs/images/far_motion.png
say "docs/images/far_motion.png"
