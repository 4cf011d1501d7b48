#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/part_scales.png and part_scales_particles.png anew: crops of frames whose shadow map or particles
# have a scale of their own, for docs/part_scales.md.
#
#   scripts/part_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

# crop LABEL STAGE GEOMETRY OPTION ...
crop() {
  local label=$1 stage=$2 geometry=$3
  shift 3
  add_crop "$label" "$stage" "$geometry" 300 --frames 32 --frame 30 --method bilinear "$@"
}

floor=(presented 112x72+340+272 --scene shadows)
crop "shadow map 1: 2048 texels" "${floor[@]}"
crop "0.5: 1024" "${floor[@]}" --shadow-scale 0.5
crop "0.25: 512" "${floor[@]}" --shadow-scale 0.25
crop "0.125: 256" "${floor[@]}" --shadow-scale 0.125
sheet part_scales.png 4

smoke=(112x72+365+30 --scene flight --start 8.3)
spray=(112x72+285+230 --scene flight --start 8.3)
for where in smoke spray; do
  declare -n place=$where
  crop "particles in the frame" presented "${place[@]}"
  crop "of their own: 0.5" presented "${place[@]}" --particle-scale 0.5
  crop "0.25" presented "${place[@]}" --particle-scale 0.25
  crop "0.125" presented "${place[@]}" --particle-scale 0.125
done
sheet part_scales_particles.png 4
