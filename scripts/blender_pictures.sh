#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures the Blender add-on on a small shot of Cycles, and draws its pictures anew, for docs/sequences.md:
# docs/images/blender_result.png, blender_panel.png and blender_loaded.png. Prints scores and times.
#
#   scripts/blender_pictures.sh     about 5 minutes on two idle cores
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" blender imagemagick xvfb xauth
configure_and_build default quincunx-resolve

work=$PWD/build/blender
bin=$PWD/build/release/bin
frames=24
samples=16
width=480
height=270
export PATH=$bin:$PATH
rm -rf "$work"
mkdir -p "$work" docs/images

# blend WORD...: Blender without a display, and without its chatter.
blend() { blender -b "$@" >>"$work/log" 2>&1 || fail "Blender failed; see $work/log"; }
# as_frame SAMPLES PERCENT NAME FRAMES: as Blender renders by itself.
as_frame() {
  blend "$work/shot.blend" -F OPEN_EXR -o "$work/$3.####" --python-expr "import bpy; scene = bpy.context.scene
scene.cycles.samples, scene.render.resolution_percentage = $1, $2
scene.frame_start, scene.frame_end = $4" -a
}
# timed NAME WORD...: prints how long the rest took.
timed() {
  local TIMEFORMAT="$1: %R s, of processor time %U s + %S s"
  time "${@:2}"
}
# scaled_by NAME PATTERN METHOD WORD...: quincunx-resolve on the last frame alone.
scaled_by() {
  "$bin/quincunx-resolve" "$work/$2" --frames $frames --method "$3" --jitter none --output ${width}x$height "${@:4}"
}
# score NAME PATTERN METHOD: against the truth.
score() {
  scaled_by "$@" --json --truth "$work/truth.%04d.exr" 2>>"$work/log" | python3 -c "
import json, sys
row = json.load(sys.stdin)['scores']['frames'][0]
print('$1: %.2f dB tone-mapped, %.2f dB linear, SSIM %.3f, FLIP %.3f' % tuple(
    row[name] for name in ('psnr_tone_mapped', 'psnr_linear', 'ssim', 'flip')))"
}
# show NAME PATTERN METHOD: as a PNG.
show() { scaled_by "$@" -q --tone-map reinhard --out "$work/$1.%04d.png"; }

blend --factory-startup --python tests/blender/make_scene.py -- "$work/shot.blend" $width $height $frames $samples
add_on="import sys; sys.path.append('$PWD/host/tools/blender'); import quincunx_blender; quincunx_blender.run"
blend "$work/shot.blend" --python-expr "$add_on()"  # kernels are compiled, and kept, before anything is timed
timed "add-on" blend "$work/shot.blend" --python-expr "$add_on()"
timed "Blender alone, full size" as_frame $samples 100 full "1, $frames"
as_frame $samples 50 small "$frames, $frames"
as_frame 256 100 truth "$frames, $frames"
score full full.%04d.exr point
for what in score show; do
  $what scaled small.%04d.exr catmull-rom
  $what resolved out/shot_%04d.exr point
done
show truth truth.%04d.exr point

tiles=()
for crop in 160x90+60+40 160x90+240+85; do
  for name in scaled resolved truth; do
    convert "$work/$name.00$frames.png" -crop $crop +repage -filter point -resize 300% "$work/$name-$crop.png"
    tiles+=(-label "$name" "$work/$name-$crop.png")
  done
done
montage "${tiles[@]}" -tile 3x -geometry +4+4 -font DejaVu-Sans -pointsize 16 -depth 8 docs/images/blender_result.png

xvfb-run -a -s "-screen 0 1600x900x24" blender "$work/shot.blend" --window-geometry 0 0 1600 900 \
  --python scripts/blender_panel.py -- "$PWD/host/tools/blender" "$work" >>"$work/log" 2>&1 ||
  fail "Blender's window failed; see $work/log"
for name in panel resolving; do
  convert "$work/$name.png" -crop 245x510+1355+365 +repage "$work/$name-crop.png"
done
convert "$work/panel-crop.png" "$work/resolving-crop.png" +append docs/images/blender_panel.png
convert "$work/loaded.png" -resize 1200x docs/images/blender_loaded.png
say "docs/images/blender_result.png, blender_panel.png, blender_loaded.png"
