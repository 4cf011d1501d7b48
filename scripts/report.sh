#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures docs/report anew: bench.json, a line for each case, and bench.svg, which the README shows. The page with
# all plots and pictures lies in build/report and is not kept.
#
#   scripts/report.sh              about a quarter of an hour; on a machine that has nothing else to do
#   scripts/report.sh --quick      anything else is handed to quincunx-bench
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" libgtest-dev
configure_and_build release quincunx-bench
mkdir -p build/report docs/report
build/release/bin/quincunx-bench --output 480x270 --scales 0.5,0.71,1 --frames 3 --rounds 4 --truth 6 "$@" --out build/report
cp build/report/bench.json build/report/bench.svg docs/report/
say "docs/report is new; the page with all plots, tables and pictures: build/report/bench.html"
