#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/dual.png anew: crops of one frame whose output has the display's size, .8 and .5 of it, beside
# truth, for docs/dual.md.
#
#   scripts/dual_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

# crop LABEL STAGE [OPTION ...]
crop() {
  local label=$1 stage=$2
  shift 2
  add_crop "$label" "$stage" 96x64+300+170 300 --scene courtyard --scale 0.5 --start 1 --frames 32 --frame 30 \
    --warm-up 24 "$@"
}

crop "temporal, output 640x360" presented --method temporal
crop "temporal, output .8" presented --method temporal --dual 0.8
crop "temporal, output .5" presented --method temporal --dual 0.5
crop "truth" truth --truth 8
crop "quincunx, output 640x360" presented --method quincunx
crop "quincunx, output .8" presented --method quincunx --dual 0.8
crop "quincunx, output .5" presented --method quincunx --dual 0.5
crop "bilinear, output 640x360" presented --method bilinear
sheet dual.png 4
