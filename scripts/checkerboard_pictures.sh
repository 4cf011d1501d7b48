#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/checkerboard.png anew: crops of a frame of which half the pixels are shaded, as drawn, filled and
# accumulated, beside whole frames of as many samples, for docs/checkerboard.md.
#
#   scripts/checkerboard_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump

work=build/checkerboard
rm -rf "$work"
mkdir -p "$work" docs/images
tiles=()

# crop LABEL STAGE [OPTION ...]: adds one crop, three times as large.
crop() {
  local label=$1 stage=$2
  local name=$work/${#tiles[@]}
  shift 2
  build/release/bin/quincunx-dump -q --scene courtyard --output 640x360 --start 1 --frames 32 --frame 30 --warm-up 24 \
    --stages "$stage" --format png --out "$name" "$@"
  convert "$name/frame.0030.$stage.png" -crop 96x64+300+170 +repage -filter point -resize 300% "$name.png"
  tiles+=(-label "$label" "$name.png")
}

crop "checkerboard, as drawn" colour --shading checkerboard --method bilinear
crop "checkerboard, filled" presented --shading checkerboard --method bilinear
crop "checkerboard, temporal" presented --shading checkerboard --method temporal
crop "truth" truth --truth 8
crop "whole frame, scale 1" presented --method bilinear
crop "whole frame, scale 0.71, bilinear" presented --method bilinear --scale 0.71
crop "whole frame, scale 0.71, temporal" presented --method temporal --scale 0.71
crop "whole frame, scale 1, temporal" presented --method temporal
montage "${tiles[@]}" -tile 4x -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 docs/images/checkerboard.png
say "docs/images/checkerboard.png"
