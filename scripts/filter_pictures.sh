#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/filters_*.png anew: crops of each method beside truth, at scales 0.5 and 0.71, for docs/filters.md.
#
#   scripts/filter_pictures.sh     about two minutes
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump

methods=(point bilinear b-spline catmull-rom mitchell lanczos2 lanczos3 noise noise-offset quincunx:mean quincunx:velocity
  quincunx:reprojected)
work=build/filters
rm -rf "$work"
mkdir -p "$work" docs/images

# draw SCENE SCALE CROP: one row of crops, three times as large, each with its name.
draw() {
  local scene=$1 scale=$2 crop=$3 method tiles=()
  for method in "${methods[@]}" truth; do
    local stage=presented name=${method/:/-}
    if [[ $method == truth ]]; then
      stage=truth
      build/release/bin/quincunx-dump -q --scene "$scene" --output 640x360 --scale "$scale" --start 1 --frames 8 --frame 6 \
        --truth 8 --stages truth --format png --out "$work/$name"
    else
      build/release/bin/quincunx-dump -q --scene "$scene" --output 640x360 --scale "$scale" --start 1 --frames 8 --frame 6 \
        --method "$method" --stages presented --format png --out "$work/$name"
    fi
    convert "$work/$name/frame.0006.$stage.png" -crop "$crop" +repage -filter point -resize 300% \
      "$work/$scene-$scale-$name.png"
    tiles+=(-label "$method" "$work/$scene-$scale-$name.png")
  done
  montage "${tiles[@]}" -tile 4x -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 \
    "docs/images/filters_${scene}_${scale/./}.png"
  say "docs/images/filters_${scene}_${scale/./}.png"
}

for scale in 0.5 0.71; do
  draw chart "$scale" 96x64+204+62
  draw courtyard "$scale" 96x64+300+170
done
