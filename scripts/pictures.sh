#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws pictures of docs/images anew: labelled crops of frames, on sheets.
#
#   scripts/pictures.sh [NAME ...]     all, or those named; under three minutes each
#
#   checkerboard  a frame of which half the pixels are shaded, as drawn, filled and accumulated, beside whole frames
#   dual          a frame whose output has the display's size, .8 and .5 of it
#   faults        what mistakes in the input of temporal look like
#   filters       each method, at scales 0.5 and 0.71
#   focus         an object in focus in a frame at scale 0.35
#   mobile        frames from RGBA16F and from RGBA8 colour, and how they differ
#   parts         frames whose shadow map or particles have a scale of their own
#   sky           what --sky-motion makes of a sky without motion
#   temporal      what each stage of the temporal upscaler sees, and its two layers
#   two_way       a shot's first frame, by itself and knowing those that follow
#   wires         the moving picture of the README
#
# scripts/blender_pictures.sh and the two *_diagram.py draw the others.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

all=(checkerboard dual faults filters focus mobile parts sky temporal two_way wires)
tiles=()  # of the sheet that is being made: labels and files, as montage takes them
tile_count=0

# dump FOLDER OPTION ...: what quincunx-dump draws of a frame of 640x360, into $work/FOLDER.
dump() {
  local folder=$1
  shift
  build/release/bin/quincunx-dump -q --output 640x360 --format png --out "$work/$folder" "$@"
}

# add_tile LABEL FILE GEOMETRY PERCENT: a crop of a picture of 640x360; captions below it are cut off first.
add_tile() {
  local crop=$work/tile-$((++tile_count)).png
  convert "$2" -crop 640x360+0+0 +repage -crop "$3" +repage -filter point -resize "$4%" "$crop"
  tiles+=(-label "$1" "$crop")
}

# crop LABEL STAGE [OPTION ...]: a tile of a stage of the frame that quincunx-dump draws with the options and those in
# $frame, `--frame` N among them. $geometry is the place, $percent its size.
crop() {
  local label=$1 stage=$2 folder=crop-$tile_count
  shift 2
  dump "$folder" --stages "$stage" "${frame[@]}" "$@"
  add_tile "$label" "$work/$folder/"frame.*."$stage.png" "$geometry" "$percent"
}

# sheet NAME COLUMNS: docs/images/NAME from the tiles; the next sheet begins without any.
sheet() {
  montage "${tiles[@]}" -tile "$2x" -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 "docs/images/$1"
  say "docs/images/$1"
  tiles=()
}

draw_checkerboard() {
  local geometry=96x64+300+170 percent=300
  local frame=(--scene courtyard --start 1 --frames 32 --frame 30 --warm-up 24)
  crop "checkerboard, as drawn" colour --shading checkerboard --method bilinear
  crop "checkerboard, filled" presented --shading checkerboard --method bilinear
  crop "checkerboard, temporal" presented --shading checkerboard --method temporal
  crop "truth" truth --truth 8
  crop "whole frame, scale 1" presented --method bilinear
  crop "whole frame, scale 0.71, bilinear" presented --method bilinear --scale 0.71
  crop "whole frame, scale 0.71, temporal" presented --method temporal --scale 0.71
  crop "whole frame, scale 1, temporal" presented --method temporal
  sheet checkerboard.png 4
}

draw_dual() {
  local geometry=96x64+300+170 percent=300
  local frame=(--scene courtyard --scale 0.5 --start 1 --frames 32 --frame 30 --warm-up 24)
  crop "temporal, output 640x360" presented --method temporal
  crop "temporal, output .8" presented --method temporal --dual 0.8
  crop "temporal, output .5" presented --method temporal --dual 0.5
  crop "truth" truth --truth 8
  crop "quincunx, output 640x360" presented --method quincunx
  crop "quincunx, output .8" presented --method quincunx --dual 0.8
  crop "quincunx, output .5" presented --method quincunx --dual 0.5
  crop "bilinear, output 640x360" presented --method bilinear
  sheet dual.png 4
}

# draw_filter_sheet SCENE SCALE GEOMETRY: a crop for each method.
draw_filter_sheet() {
  local scene=$1 scale=$2 geometry=$3 percent=300 method
  local frame=(--scene "$scene" --scale "$scale" --start 1 --frames 8 --frame 6)
  for method in point bilinear b-spline catmull-rom mitchell lanczos2 lanczos3 noise noise-offset quincunx:mean \
    quincunx:velocity quincunx:reprojected; do
    crop "$method" presented --method "$method"
  done
  crop truth truth --truth 8
  sheet "filters_${scene}_${scale/./}.png" 4
}

draw_filters() {
  local scale
  for scale in 0.5 0.71; do
    draw_filter_sheet chart "$scale" 96x64+204+62
    draw_filter_sheet courtyard "$scale" 96x64+300+170
  done
}

draw_focus() {
  local geometry=190x178+430+180 percent=200
  local frame=(--scene courtyard --start 0.5 --frames 32 --frame 30 --warm-up 24 --method temporal)
  crop "scale 0.35" presented --scale 0.35
  crop "scale 0.35, the notice in focus" presented --scale 0.35 --focus "notice: quincunx"
  crop "scale 1" presented
  crop "truth" truth --truth 8
  sheet focus.png 2
}

# draw_formats SCENE METHOD GEOMETRY: crops from both colour formats, and 16 times their difference.
draw_formats() {
  local scene=$1 method=$2 geometry=$3 colour
  for colour in rgba16f rgba8; do
    dump "$scene-$colour" --scene "$scene" --scale 0.71 --frames 30 --frame 26 --no-dither --method "$method" \
      --colour "$colour" --stages presented
    add_tile "$scene, $method, $colour" "$work/$scene-$colour/frame.0026.presented.png" "$geometry" 200
  done
  convert "$work/$scene-rgba16f/frame.0026.presented.png" "$work/$scene-rgba8/frame.0026.presented.png" \
    -compose difference -composite -evaluate multiply 16 "$work/$scene-difference.png"
  add_tile "16 x the difference" "$work/$scene-difference.png" "$geometry" 200
}

draw_mobile() {
  draw_formats courtyard bilinear 192x120+160+120
  draw_formats sparkles temporal 192x120+220+120
  sheet mobile.png 3
}

draw_parts() {
  local percent=300 geometry
  local frame=(--frames 32 --frame 30 --method bilinear --scene shadows)
  geometry=112x72+340+272
  crop "shadow map 1: 2048 texels" presented
  crop "0.5: 1024" presented --shadow-scale 0.5
  crop "0.25: 512" presented --shadow-scale 0.25
  crop "0.125: 256" presented --shadow-scale 0.125
  sheet part_scales.png 4

  frame=(--frames 32 --frame 30 --method bilinear --scene flight --start 8.3)
  for geometry in 112x72+365+30 112x72+285+230; do  # smoke, spray
    crop "particles in the frame" presented
    crop "of their own: 0.5" presented --particle-scale 0.5
    crop "0.25" presented --particle-scale 0.25
    crop "0.125" presented --particle-scale 0.125
  done
  sheet part_scales_particles.png 4
}

draw_sky() {
  local sun=96x72+430+120 wheel=288x216+340+50 far  # the places of the picture and of the errors
  local run=(--scene backdrop --scale 0.5 --start 1 --frames 25) truth=$work/frame.0024.truth.png
  local resolve=(build/release/bin/quincunx-resolve "$work/frame.%04d.exr" --frames 24 --two-way 0 -q)
  build/release/bin/quincunx-dump -q --output 640x360 "${run[@]}" --jitter halton --sequence "$work/frame.%04d.exr"
  dump . "${run[@]}" --frame 24 --stages truth --truth 8 --exposure 1
  for far in as-drawn camera evidence; do
    "${resolve[@]}" --out "$work/$far.%04d.png" --method temporal --sky-motion "$far"
    add_tile "--sky-motion $far" "$work/$far.0024.png" "$sun" 300
    convert "$work/$far.0024.png" \( "$truth" -crop 640x360+0+0 +repage \) -compose difference -composite \
      -colorspace gray -level 0,12% "$work/$far.error.png"
  done
  add_tile "truth, 64 samples" "$truth" "$sun" 300
  for far in as-drawn camera evidence; do
    add_tile "its error, 8 times" "$work/$far.error.png" "$wheel" 100
  done
  "${resolve[@]}" --out "$work/point.%04d.png" --method point
  add_tile "one frame" "$work/point.0024.png" "$sun" 300
  sheet far_motion.png 4
}

draw_two_way() {
  local place=120x80+250+140 ahead
  local run=(--scene courtyard --scale 0.5 --start 1 --frames 9)
  build/release/bin/quincunx-dump -q --output 640x360 "${run[@]}" --jitter halton --sequence "$work/frame.%04d.exr"
  dump . "${run[@]}" --frame 0 --stages truth --truth 8 --exposure 1
  for ahead in 0 8; do
    build/release/bin/quincunx-resolve "$work/frame.%04d.exr" --frames 0 --two-way "$ahead" -q --out "$work/$ahead.%04d.png"
    add_tile "--two-way $ahead" "$work/$ahead.0000.png" "$place" 200
  done
  add_tile "truth, 64 samples" "$work/frame.0000.truth.png" "$place" 200
  sheet two_way.png 3
}

# fault LABEL [OPTION ...]: a tile of the last of the frames in $work, resolved with the options.
fault() {
  local label=$1 out=$work/fault-$tile_count
  shift
  build/release/bin/quincunx-resolve "$work/frame.%04d.exr" --frames 24 --two-way 0 -q --method temporal \
    --out "$out.%04d.png" "$@"
  add_tile "$label" "$out.0024.png" "$geometry" 200
}

# jitters FILE X Y LATER: those that were drawn with, times X and Y, of frames that many later.
jitters() {
  python3 - "$work/whole.json" "$2" "$3" "$4" >"$1" <<'END'
import json, sys
x, y, later = map(float, sys.argv[2:])
frames = json.load(open(sys.argv[1]))["per_frame"]
for i, frame in enumerate(frames):
    jitter = frames[min(max(i + int(later), 0), len(frames) - 1)]["jitter"]
    print(frame["frame"], x * jitter[0], y * jitter[1])
END
}

draw_faults() {
  local run=(--scene pan --scale 0.5 --start 1 --fps 30 --frames 25 --jitter halton --exposure 1)
  local geometry=104x76+228+178
  local motion=(--velocity backward.u,backward.v)
  local sequence=(build/release/bin/quincunx-dump -q --output 640x360 "${run[@]}" --sequence "$work/frame.%04d.exr")
  "${sequence[@]}"
  build/release/bin/quincunx-resolve "$work/frame.%04d.exr" --diagnose --json >"$work/whole.json"
  jitters "$work/sign.txt" -1 -1 0
  jitters "$work/last.txt" 1 1 -1
  jitters "$work/double.txt" 2 2 0
  fault "as it should be"
  fault "velocity: the other direction" "${motion[@]}" --velocity-scale 0.003125,-0.0055556
  fault "velocity: axes swapped" --velocity backward.v,backward.u --velocity-convention nuke
  fault "velocity: twice as long" "${motion[@]}" --velocity-scale -0.00625,0.0111111
  fault "velocity: none" --velocity none
  fault "velocity: the jitter is in it" --velocity-jittered
  fault "jitter: the other sign" --jitter "$work/sign.txt"
  fault "jitter: of the last frame" --jitter "$work/last.txt"
  fault "jitter: output's pixels" --jitter "$work/double.txt"
  fault "jitter: not told" --jitter none
  fault "depth: of the other kind" --depth-kind device-reversed
  "${sequence[@]}" --dilate-velocity
  fault "velocity: dilated"
  sheet faults.png 4
}

# dump_view SCENE VIEW: what --view shows of frame 39, into $work/SCENE-VIEW.
dump_view() {
  dump "$1-$2" "${frame[@]}" --stages resolved --method temporal --view "$2" --tone-map clamp --exposure 1
  add_tile "--view $2" "$work/$1-$2/frame.0039.resolved.png" "$geometry" 200
}

# draw_stages SCENE GEOMETRY: eight crops of one frame, twice as large.
draw_stages() {
  local scene=$1 geometry=$2 view
  local frame=(--scene "$scene" --scale 0.5 --start 1 --frames 40 --frame 39)
  dump "$scene-point" "${frame[@]}" --stages depth,velocity,presented --method point --jitter halton
  add_tile "one frame" "$work/$scene-point/frame.0039.presented.png" "$geometry" 200
  add_tile depth "$work/$scene-point/frame.0039.depth.png" "$geometry" 200
  add_tile velocity "$work/$scene-point/frame.0039.velocity.png" "$geometry" 200
  for view in phase rejection confidence; do
    dump_view "$scene" "$view"
  done
  dump "$scene-picture" "${frame[@]}" --stages presented,truth --method temporal --truth 8
  add_tile temporal "$work/$scene-picture/frame.0039.presented.png" "$geometry" 200
  add_tile "truth, 64 samples" "$work/$scene-picture/frame.0039.truth.png" "$geometry" 200
  sheet "temporal_$scene.png" 4
}

# draw_layers SCENE GEOMETRY: one layer, two and truth; what layers there are.
draw_layers() {
  local scene=$1 geometry=$2 view
  local frame=(--scene "$scene" --scale 0.5 --start 1 --frames 40 --frame 39)
  dump "$scene-fast" "${frame[@]}" --stages presented --method temporal:fast
  add_tile "one layer (fast)" "$work/$scene-fast/frame.0039.presented.png" "$geometry" 200
  dump "$scene-picture" "${frame[@]}" --stages presented,truth --method temporal --truth 8
  add_tile "two layers (balanced)" "$work/$scene-picture/frame.0039.presented.png" "$geometry" 200
  add_tile "truth, 64 samples" "$work/$scene-picture/frame.0039.truth.png" "$geometry" 200
  for view in layers near far; do
    dump_view "$scene" "$view"
  done
  sheet "layers_$scene.png" 3
}

draw_temporal() {
  draw_stages pan 192x120+0+130
  draw_stages occluders 192x120+160+200
  draw_stages shadows 192x120+20+150
  draw_layers wheel 192x120+220+110
}

# render NAME ARGUMENT ...: the run of the README's picture into $work/NAME.
render() {
  local name=$1
  shift
  say "Rendering $name."
  build/release/bin/quincunx-render -q --scene wires --output 640x360 --start 1 --frames $((last + 1)) "$@" \
    --out "$work/$name/%04d.png"
}

draw_wires() {
  local first=24 last=71 frames=() frame i  # the frames that are shown; those before them fill the history
  render bilinear --scale 0.5 --method bilinear
  render temporal --scale 0.5 --method temporal --jitter halton
  render truth --truth 8
  for ((i = first; i <= last; ++i)); do
    frame=$(printf '%04d.png' "$i")
    montage -label 'bilinear, from 320×180' "$work/bilinear/$frame" -label 'quincunx, from 320×180' \
      "$work/temporal/$frame" -label 'truth, 64 samples a pixel' "$work/truth/$frame" -crop 316x300+230+20 +repage \
      -tile 3x1 -geometry +2+2 -font DejaVu-Sans -pointsize 15 -depth 8 "$work/$frame"
    frames+=("$work/$frame")
  done
  img2webp -loop 0 -d 50 -lossy -q 75 -m 6 "${frames[@]}" -o docs/images/wires.webp >/dev/null
  say "docs/images/wires.webp: $(stat -c %s docs/images/wires.webp) bytes"
}

names=("$@")
((${#names[@]} > 0)) || names=("${all[@]}")
for name in "${names[@]}"; do
  [[ " ${all[*]} " == *" $name "* ]] || fail "There is no picture '$name'; there are ${all[*]}."
done
ensure_packages "${build_packages[@]}" "${run_packages[@]}" libgtest-dev imagemagick webp
configure_and_build release quincunx-dump quincunx-resolve quincunx-render
mkdir -p docs/images
for name in "${names[@]}"; do
  work=build/pictures/$name
  rm -rf "$work"
  mkdir -p "$work"
  "draw_$name"
done
