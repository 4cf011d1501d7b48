#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/focus.png anew: an object in focus in a frame at scale 0.35, beside the same without, a whole frame
# at scale 1 and truth, for docs/focus.md.
#
#   scripts/focus_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
configure_and_build release quincunx-dump

work=build/focus
rm -rf "$work"
mkdir -p "$work" docs/images
tiles=()

# crop LABEL STAGE [OPTION ...]: adds one crop, twice as large.
crop() {
  local label=$1 stage=$2
  local name=$work/${#tiles[@]}
  shift 2
  build/release/bin/quincunx-dump -q --scene courtyard --output 640x360 --start 0.5 --frames 32 --frame 30 --warm-up 24 \
    --method temporal --stages "$stage" --format png --out "$name" "$@"
  convert "$name/frame.0030.$stage.png" -crop 190x178+430+180 +repage -filter point -resize 200% "$name.png"
  tiles+=(-label "$label" "$name.png")
}

crop "scale 0.35" presented --scale 0.35
crop "scale 0.35, the notice in focus" presented --scale 0.35 --focus "notice: quincunx"
crop "scale 1" presented
crop "truth" truth --truth 8
montage "${tiles[@]}" -tile 2x -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 docs/images/focus.png
say "docs/images/focus.png"
