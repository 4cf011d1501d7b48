#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/focus.png anew: an object in focus in a frame at scale 0.35, beside the same without, a whole frame
# at scale 1 and truth, for docs/focus.md.
#
#   scripts/focus_pictures.sh     about a minute
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/pictures.sh

begin_pictures

# crop LABEL STAGE [OPTION ...]
crop() {
  local label=$1 stage=$2
  shift 2
  add_crop "$label" "$stage" 190x178+430+180 200 --scene courtyard --start 0.5 --frames 32 --frame 30 --warm-up 24 \
    --method temporal "$@"
}

crop "scale 0.35" presented --scale 0.35
crop "scale 0.35, the notice in focus" presented --scale 0.35 --focus "notice: quincunx"
crop "scale 1" presented
crop "truth" truth --truth 8
sheet focus.png 2
