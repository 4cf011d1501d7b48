#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/temporal_*.png and layers_*.png anew: what each stage of the temporal upscaler sees, for
# docs/temporal.md, and its two layers, for docs/layers.md.
#
#   scripts/temporal_pictures.sh     about two minutes
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

# stages SCENE NAME STAGES OPTION ...: stages of frame 39 into $work/SCENE-NAME.
stages() {
  local scene=$1 name=$2 stages=$3
  shift 3
  dump "$scene-$name" --scene "$scene" --scale 0.5 --start 1 --frames 40 --frame 39 --stages "$stages" "$@"
}

# crop SCENE NAME STAGE GEOMETRY LABEL
crop() {
  add_tile "$5" "$work/$1-$2/frame.0039.$3.png" "$4" 200
}

# draw SCENE GEOMETRY: eight crops of one frame, twice as large.
draw() {
  local scene=$1 geometry=$2 view
  stages "$scene" point depth,velocity,presented --method point --jitter halton
  crop "$scene" point presented "$geometry" "one frame"
  crop "$scene" point depth "$geometry" depth
  crop "$scene" point velocity "$geometry" velocity
  for view in phase rejection confidence; do
    stages "$scene" "$view" resolved --method temporal --view "$view" --tone-map clamp --exposure 1
    crop "$scene" "$view" resolved "$geometry" "--view $view"
  done
  stages "$scene" picture presented,truth --method temporal --truth 8
  crop "$scene" picture presented "$geometry" temporal
  crop "$scene" picture truth "$geometry" "truth, 64 samples"
  sheet "temporal_$scene.png" 4
}

draw pan 192x120+0+130
draw occluders 192x120+160+200
draw shadows 192x120+20+150

# draw_layers SCENE GEOMETRY: one layer, two and truth; what layers there are.
draw_layers() {
  local scene=$1 geometry=$2 view
  stages "$scene" fast presented --method temporal:fast
  crop "$scene" fast presented "$geometry" "one layer (fast)"
  stages "$scene" picture presented,truth --method temporal --truth 8
  crop "$scene" picture presented "$geometry" "two layers (balanced)"
  crop "$scene" picture truth "$geometry" "truth, 64 samples"
  for view in layers near far; do
    stages "$scene" "$view" resolved --method temporal --view "$view" --tone-map clamp --exposure 1
    crop "$scene" "$view" resolved "$geometry" "--view $view"
  done
  sheet "layers_$scene.png" 3
}

draw_layers wheel 192x120+220+110
