#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# On a fresh Debian: installs what is missing, builds with g++ and with clang++, and runs all checks and tests.
#
#   ./test.sh                everything
#   ./test.sh -R service     anything else is handed to ctest; the format check and the clang build are then left out
set -euo pipefail
cd "$(dirname "$0")"
source scripts/packages.sh

mapfile -t optional < <(known_packages "${optional_test_packages[@]}")
ensure_packages "${build_packages[@]}" "${run_packages[@]}" "${test_packages[@]}" "${optional[@]}"

configure_and_build release
if (($# == 0)); then
  if clang-format --version | grep -q 'version 14\.'; then
    cmake --build build/release --target format-check
  else
    say "The format is checked with clang-format 14 only; this is $(clang-format --version)."
  fi
fi

# A skipped test counts as failed: this machine has all that they need.
QUINCUNX_NO_SKIP=1 ctest --test-dir build/release --output-on-failure --no-tests=error -j2 "$@"

if (($# == 0)); then
  say "Building everything once more, with clang++."
  configure_and_build clang
  say "All checks and tests passed."
fi
