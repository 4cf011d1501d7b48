# SPDX-License-Identifier: MIT
# Sourced by the scripts that draw docs/images with quincunx-dump: labelled crops of frames, on sheets.
source scripts/packages.sh

tiles=()  # of the sheet that is being made: labels and files, as montage takes them

# begin_pictures [TARGET ...]: installs and builds what draws, and empties $work.
begin_pictures() {
  ensure_packages "${build_packages[@]}" "${run_packages[@]}" imagemagick
  configure_and_build release quincunx-dump "$@"
  work=build/pictures/$(basename "$0" .sh)
  rm -rf "$work"
  mkdir -p "$work" docs/images
}

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
tile_count=0

# add_crop LABEL STAGE GEOMETRY PERCENT OPTION ...: a crop of a stage of the frame that quincunx-dump draws with the
# options, `--frame` N among them.
add_crop() {
  local label=$1 stage=$2 geometry=$3 percent=$4 folder=crop-$tile_count
  shift 4
  dump "$folder" --stages "$stage" "$@"
  add_tile "$label" "$work/$folder/"frame.*."$stage.png" "$geometry" "$percent"
}

# sheet NAME COLUMNS: docs/images/NAME from the tiles; the next sheet begins without any.
sheet() {
  montage "${tiles[@]}" -tile "$2x" -geometry +4+4 -font DejaVu-Sans -pointsize 14 -depth 8 "docs/images/$1"
  say "docs/images/$1"
  tiles=()
}
