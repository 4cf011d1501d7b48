#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# On a fresh Debian: installs what is missing, builds with g++ and with clang++, and runs all checks and tests.
#
#   ./test.sh                everything
#   ./test.sh -R service     anything else is handed to ctest; the format check and the clang build are then left out
set -euo pipefail
cd "$(dirname "$0")"
source scripts/packages.sh

ensure_packages "${build_packages[@]}" "${run_packages[@]}" "${test_packages[@]}"
# After the others, because only then is the list of what the archive has sure to be there.
mapfile -t optional < <(known_packages "${optional_test_packages[@]}")
ensure_packages "${optional[@]}"

if (($# == 0)); then
  # First, because it fails within seconds.
  if clang-format --version | grep -q 'version 14\.'; then
    configure_and_build release format-check
  else
    say "The format is checked with clang-format 14 only; this is $(clang-format --version)."
  fi
fi
configure_and_build release

left_out=()
if ! command -v oclgrind >/dev/null; then
  say "This Debian has no oclgrind, so kernel_tests_oclgrind (memory checks of the kernels) is left out."
  left_out=(-E '^kernel_tests_oclgrind$')
fi
# A skipped test counts as failed: this machine has all that they need.
QUINCUNX_NO_SKIP=1 ctest --test-dir build/release --output-on-failure --no-tests=error -j2 "${left_out[@]}" "$@"

if (($# == 0)); then
  say "Building everything once more, with clang++."
  configure_and_build clang
  say "All checks and tests passed."
fi
