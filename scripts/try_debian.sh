#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tries ./run.sh and ./test.sh in a bare Debian, from a clean clone of HEAD. Needs root, git and debootstrap.
#
#   scripts/try_debian.sh 12             Debian 12 (bookworm); 13: Debian 13 (trixie)
#   scripts/try_debian.sh --fresh 13     from a new system; else the packages of the last try are there already
#   scripts/try_debian.sh 13 run.sh      only that one, or only test.sh
#
# scripts/debian_system.sh has the environment variables that say where the systems are kept and come from.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/debian_system.sh

fresh=no
if [[ "${1:-}" == --fresh ]]; then
  fresh=yes
  shift
fi
suite=$(suite_of "${1:-}")
[[ -n "$suite" ]] || fail "Usage: scripts/try_debian.sh [--fresh] 12|13 [run.sh|test.sh]..."
shift
commands=("$@")
if ((${#commands[@]} == 0)); then
  commands=(run.sh test.sh)
fi
for command in "${commands[@]}"; do
  [[ "$command" == run.sh || "$command" == test.sh ]] || fail "'$command' is neither run.sh nor test.sh."
done
make_system "$suite" "$suite" "$fresh"
enter_system
rm -rf "$root/tmp/quincunx"
git clone -q --no-local . "$root/tmp/quincunx"

failed=()
lines=()
for command in "${commands[@]}"; do
  printf '\n=== Debian %s: ./%s\n' "$suite" "$command"
  started=$SECONDS
  outcome=passed
  inside "cd /tmp/quincunx && ./$command" </dev/null || {
    outcome=FAILED
    failed+=("$command")
  }
  lines+=("./$command $outcome after $((SECONDS - started)) s, installing what was missing included")
done

printf '\nDebian %s (%s), commit %s\n' "$(cat "$root/etc/debian_version")" "$suite" "$(git rev-parse --short HEAD)"
inside "dpkg-query -W -f='  \${Package} \${Version}\n' g++ pocl-opencl-icd libgl1-mesa-dri 2>/dev/null" || true
printf '  %s\n' "${lines[@]}"
((${#failed[@]} == 0)) || fail "Failed: ${failed[*]}"
