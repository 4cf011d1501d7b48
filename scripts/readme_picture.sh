#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws docs/images/wires.webp anew, the moving picture of the README: wires under a slow camera, from half the
# resolution with bilinear filtering and with the temporal upscaler, and truth.
#
#   scripts/readme_picture.sh     about three minutes
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick webp
configure_and_build release quincunx-render

first=24 last=71  # the frames that are shown; those before them fill the history
crop=316x300+230+20
work=build/readme
rm -rf "$work"
mkdir -p "$work"

# render NAME ARGUMENT...: the run into $work/NAME.
render() {
  local name=$1
  shift
  say "Rendering $name."
  build/release/bin/quincunx-render -q --scene wires --output 640x360 --start 1 --frames $((last + 1)) "$@" \
    --out "$work/$name/%04d.png"
}

render bilinear --scale 0.5 --method bilinear
render temporal --scale 0.5 --method temporal --jitter halton
render truth --truth 8

frames=()
for ((i = first; i <= last; ++i)); do
  frame=$(printf '%04d.png' "$i")
  montage -label 'bilinear, from 320×180' "$work/bilinear/$frame" -label 'quincunx, from 320×180' "$work/temporal/$frame" \
    -label 'truth, 64 samples a pixel' "$work/truth/$frame" -crop "$crop" +repage -tile 3x1 -geometry +2+2 \
    -font DejaVu-Sans -pointsize 15 -depth 8 "$work/$frame"
  frames+=("$work/$frame")
done
img2webp -loop 0 -d 50 -lossy -q 75 -m 6 "${frames[@]}" -o docs/images/wires.webp >/dev/null
say "docs/images/wires.webp: $(stat -c %s docs/images/wires.webp) bytes"
