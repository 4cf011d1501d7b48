#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/checkerboard.png anew: crops of a frame of which half the pixels are shaded, as drawn, filled and
# accumulated, beside whole frames of as many samples, for docs/checkerboard.md.
#
#   scripts/checkerboard_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

# crop LABEL STAGE [OPTION ...]
crop() {
  local label=$1 stage=$2
  shift 2
  add_crop "$label" "$stage" 96x64+300+170 300 --scene courtyard --start 1 --frames 32 --frame 30 --warm-up 24 "$@"
}

crop "checkerboard, as drawn" colour --shading checkerboard --method bilinear
crop "checkerboard, filled" presented --shading checkerboard --method bilinear
crop "checkerboard, temporal" presented --shading checkerboard --method temporal
crop "truth" truth --truth 8
crop "whole frame, scale 1" presented --method bilinear
crop "whole frame, scale 0.71, bilinear" presented --method bilinear --scale 0.71
crop "whole frame, scale 0.71, temporal" presented --method temporal --scale 0.71
crop "whole frame, scale 1, temporal" presented --method temporal
sheet checkerboard.png 4
