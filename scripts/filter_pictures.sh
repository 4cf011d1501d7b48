#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/filters_*.png anew: crops of each method beside truth, at scales 0.5 and 0.71, for docs/filters.md.
#
#   scripts/filter_pictures.sh     about two minutes
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

methods=(point bilinear b-spline catmull-rom mitchell lanczos2 lanczos3 noise noise-offset quincunx:mean quincunx:velocity
  quincunx:reprojected)

# draw SCENE SCALE GEOMETRY: a crop for each method, three times as large.
draw() {
  local scene=$1 scale=$2 geometry=$3 method
  local frame=(--scene "$scene" --scale "$scale" --start 1 --frames 8 --frame 6)
  for method in "${methods[@]}"; do
    add_crop "$method" presented "$geometry" 300 "${frame[@]}" --method "$method"
  done
  add_crop truth truth "$geometry" 300 "${frame[@]}" --truth 8
  sheet "filters_${scene}_${scale/./}.png" 4
}

for scale in 0.5 0.71; do
  draw chart "$scale" 96x64+204+62
  draw courtyard "$scale" 96x64+300+170
done
