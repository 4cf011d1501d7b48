#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/dual.png anew: crops of one frame whose output has the display's size, .8 and .5 of it, beside
# truth, for docs/dual.md.
#
#   scripts/dual_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump

work=build/dual
rm -rf "$work"
mkdir -p "$work" docs/images
tiles=()

# crop LABEL STAGE [OPTION ...]: adds one crop, three times as large.
crop() {
  local label=$1 stage=$2
  local name=$work/${#tiles[@]}
  shift 2
  build/release/bin/quincunx-dump -q --scene courtyard --output 640x360 --scale 0.5 --start 1 --frames 32 --frame 30 \
    --warm-up 24 --stages "$stage" --format png --out "$name" "$@"
  convert "$name/frame.0030.$stage.png" -crop 96x64+300+170 +repage -filter point -resize 300% "$name.png"
  tiles+=(-label "$label" "$name.png")
}

crop "temporal, output 640x360" presented --method temporal
crop "temporal, output .8" presented --method temporal --dual 0.8
crop "temporal, output .5" presented --method temporal --dual 0.5
crop "truth" truth --truth 8
crop "quincunx, output 640x360" presented --method quincunx
crop "quincunx, output .8" presented --method quincunx --dual 0.8
crop "quincunx, output .5" presented --method quincunx --dual 0.5
crop "bilinear, output 640x360" presented --method bilinear
montage "${tiles[@]}" -tile 4x -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 docs/images/dual.png
say "docs/images/dual.png"
