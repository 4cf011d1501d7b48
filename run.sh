#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# On a fresh Debian: installs what is missing, builds, and renders the default scene into out/.
#
#   ./run.sh                     120 frames at 1280x720, the render scale sweeping 0.5, 1, 0.71; methods beside truth
#   ./run.sh --list-scenes       anything else is handed to quincunx-render instead of that
set -euo pipefail
cd "$(dirname "$0")"
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}"
configure_and_build default quincunx-render

if (($# > 0)); then
  exec build/release/bin/quincunx-render "$@"
fi

say "Rendering 120 frames of the default scene into out/ (half a minute on two cores)."
started=$SECONDS
build/release/bin/quincunx-render --frames 120 --fps 30 --output 1280x720 --scale-path sweep \
  --out "out/frame.%04d.png" --contact-sheet out/contact_sheet.png --exr-frame 60 --report out/report
say "Drawing once more by three methods, and truth: out/why.png (half a minute)."
build/release/bin/quincunx-render -q --why out/why.png
say
say "Done in $((SECONDS - started)) s. Look at:"
say "  out/why.png             half the resolution by three methods, beside truth, with the time and error of each"
say "  out/contact_sheet.png   the whole run at a glance"
say "  out/report.txt          what each pass cost, and which devices did the work (report.json: every frame)"
say "  out/frame.0000.png ...  the frames; one more as .exr with colour, depth and velocity"
say "Next: ./run.sh --help, ./run.sh --list-scenes, or your own model with ./run.sh --scene FILE.glb --out out/mine.%04d.png"
