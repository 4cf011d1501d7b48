#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# On a fresh Debian: installs what is missing, builds, and runs all checks and tests. About 20 minutes on two cores,
# about 14 when it is built already.
#
#   ./test.sh                everything
#   ./test.sh -R service     anything else is handed to ctest; the format check is then left out
#   QUINCUNX_PRESET=ci ./test.sh    another preset of CMakePresets.json; ci: warnings are errors
set -euo pipefail
cd "$(dirname "$0")"
source scripts/packages.sh
preset=${QUINCUNX_PRESET:-release}

ensure_packages "${build_packages[@]}" "${run_packages[@]}" "${test_packages[@]}"
# After the others, because only then is the list of what the archive has sure to be there.
mapfile -t optional < <(known_packages "${optional_test_packages[@]}")
ensure_packages "${optional[@]}"

if (($# == 0)); then
  # First, because it fails within seconds.
  if clang-format --version | grep -q 'version 14\.'; then
    configure_and_build "$preset" format-check
  else
    say "The format is checked with clang-format 14 only; this is $(clang-format --version)."
  fi
fi
started=$SECONDS
configure_and_build "$preset"
say "Built in $((SECONDS - started)) s."

left_out=()
if ! command -v oclgrind >/dev/null; then
  say "This Debian has no oclgrind, so kernel_tests_oclgrind_* (memory checks of the kernels) is left out."
  left_out+=('kernel_tests_oclgrind_[18]')
fi
if [[ ! -x /usr/sbin/slurmd || ! -x /usr/sbin/munged ]]; then
  say "Slurm is not installed, so farm_tests (the script for render farms) is left out."
  left_out+=(farm_tests)
fi
if ! command -v blender >/dev/null; then
  say "Blender is not installed, so blender_tests (the add-on in Blender itself) is left out."
  left_out+=(blender_tests)
fi
excluded=()
if ((${#left_out[@]})); then
  excluded=(-E "^($(IFS='|'; printf '%s' "${left_out[*]}"))\$")
fi
started=$SECONDS
results=$PWD/build/$preset/tests.xml
status=0
# A skipped test counts as failed: this machine has all that they need.
QUINCUNX_NO_SKIP=1 ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j2 \
  --output-junit "$results" "${excluded[@]}" "$@" || status=$?
say "Tested in $((SECONDS - started)) s. The slowest:"
sed -n 's/.*<testcase name="\([^"]*\)".* time="\([0-9.]*\)".*/\2 \1/p' "$results" | sort -rn | head -n 10 |
  while read -r seconds name; do printf '%8.1f s  %s\n' "$seconds" "$name"; done
((status == 0)) || exit "$status"
if (($# == 0)); then
  say "All checks and tests passed."
fi
