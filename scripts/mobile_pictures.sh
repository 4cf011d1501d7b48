#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/mobile.png anew: frames from RGBA16F and from RGBA8 colour and how they differ, for docs/mobile.md.
#
#   scripts/mobile_pictures.sh     under a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

# draw SCENE METHOD GEOMETRY: crops of both, twice as large, and 16 times their difference.
draw() {
  local scene=$1 method=$2 geometry=$3 colour
  for colour in rgba16f rgba8; do
    dump "$scene-$colour" --scene "$scene" --scale 0.71 --frames 30 --frame 26 --no-dither --method "$method" \
      --colour "$colour" --stages presented
    add_tile "$scene, $method, $colour" "$work/$scene-$colour/frame.0026.presented.png" "$geometry" 200
  done
  convert "$work/$scene-rgba16f/frame.0026.presented.png" "$work/$scene-rgba8/frame.0026.presented.png" \
    -compose difference -composite -evaluate multiply 16 "$work/$scene-difference.png"
  add_tile "16 x the difference" "$work/$scene-difference.png" "$geometry" 200
}

draw courtyard bilinear 192x120+160+120
draw sparkles temporal 192x120+220+120
sheet mobile.png 3
