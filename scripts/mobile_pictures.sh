#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/mobile.png anew: frames from RGBA16F and from RGBA8 colour and how they differ, for docs/mobile.md.
#
#   scripts/mobile_pictures.sh     under a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump

work=build/mobile
rm -rf "$work"
mkdir -p "$work" docs/images

# draw SCENE METHOD GEOMETRY: crops of both, twice as large, and 16 times their difference.
draw() {
  local scene=$1 method=$2 geometry=$3 colour
  for colour in rgba16f rgba8; do
    build/release/bin/quincunx-dump -q --scene "$scene" --output 640x360 --scale 0.71 --frames 30 --frame 26 --no-dither \
      --method "$method" --colour "$colour" --stages presented --format png --out "$work/$scene-$colour"
    convert "$work/$scene-$colour/frame.0026.presented.png" -crop "$geometry" +repage -filter point -resize 200% \
      "$work/$scene-$colour.png"
    tiles+=(-label "$scene, $method, $colour" "$work/$scene-$colour.png")
  done
  convert "$work/$scene-rgba16f.png" "$work/$scene-rgba8.png" -compose difference -composite -evaluate multiply 16 \
    "$work/$scene-difference.png"
  tiles+=(-label "16 x the difference" "$work/$scene-difference.png")
}

tiles=()
draw courtyard bilinear 192x120+160+120
draw sparkles temporal 192x120+220+120
montage "${tiles[@]}" -tile 3x -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 docs/images/mobile.png
say "docs/images/mobile.png"
