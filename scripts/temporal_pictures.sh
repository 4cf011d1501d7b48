#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/temporal_*.png and layers_*.png anew: what each stage of the temporal upscaler sees, for
# docs/temporal.md, and its two layers, for docs/layers.md.
#
#   scripts/temporal_pictures.sh     about two minutes
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump

work=build/temporal
rm -rf "$work"
mkdir -p "$work" docs/images

# dump SCENE NAME STAGES ARGUMENT...: stages of frame 39 into $work/SCENE-NAME.
dump() {
  local scene=$1 name=$2 stages=$3
  shift 3
  build/release/bin/quincunx-dump -q --scene "$scene" --output 640x360 --scale 0.5 --start 1 --frames 40 --frame 39 \
    --stages "$stages" --format png --out "$work/$scene-$name" "$@"
}

# crop SCENE NAME STAGE GEOMETRY LABEL: adds a labelled crop to `tiles`. Captions below a picture are cut off first.
crop() {
  local file="$work/$1-$2-$3.png"
  convert "$work/$1-$2/frame.0039.$3.png" -crop 640x360+0+0 +repage -crop "$4" +repage -filter point -resize 200% "$file"
  tiles+=(-label "$5" "$file")
}

# draw SCENE GEOMETRY: eight crops of one frame, twice as large.
draw() {
  local scene=$1 geometry=$2 view tiles=()
  dump "$scene" point depth,velocity,presented --method point --jitter halton
  crop "$scene" point presented "$geometry" "one frame"
  crop "$scene" point depth "$geometry" depth
  crop "$scene" point velocity "$geometry" velocity
  for view in phase rejection confidence; do
    dump "$scene" "$view" resolved --method temporal --view "$view" --tone-map clamp --exposure 1
    crop "$scene" "$view" resolved "$geometry" "--view $view"
  done
  dump "$scene" picture presented,truth --method temporal --truth 8
  crop "$scene" picture presented "$geometry" temporal
  crop "$scene" picture truth "$geometry" "truth, 64 samples"
  montage "${tiles[@]}" -tile 4x -geometry +4+4 -font DejaVu-Sans -pointsize 16 -depth 8 "docs/images/temporal_$scene.png"
  say "docs/images/temporal_$scene.png"
}

draw pan 192x120+0+130
draw occluders 192x120+160+200
draw shadows 192x120+20+150

# draw_layers SCENE GEOMETRY: one layer, two and truth; what layers there are.
draw_layers() {
  local scene=$1 geometry=$2 view tiles=()
  dump "$scene" fast presented --method temporal:fast
  crop "$scene" fast presented "$geometry" "one layer (fast)"
  dump "$scene" picture presented,truth --method temporal --truth 8
  crop "$scene" picture presented "$geometry" "two layers (balanced)"
  crop "$scene" picture truth "$geometry" "truth, 64 samples"
  for view in layers near far; do
    dump "$scene" "$view" resolved --method temporal --view "$view" --tone-map clamp --exposure 1
    crop "$scene" "$view" resolved "$geometry" "--view $view"
  done
  montage "${tiles[@]}" -tile 3x -geometry +4+4 -font DejaVu-Sans -pointsize 16 -depth 8 "docs/images/layers_$scene.png"
  say "docs/images/layers_$scene.png"
}

draw_layers wheel 192x120+220+110
