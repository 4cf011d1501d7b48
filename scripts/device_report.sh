#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What Quincunx does on this machine's best OpenCL device: the kernel, service and interop tests, tuning, the kernel
# benchmark at 720p, 1080p and 4K, a short comparison of speed and error, and frames from OpenGL. It leaves a folder
# whose report.md becomes docs/devices/NAME.md. Unattended, without a network, in ten minutes.
#
#   scripts/device_report.sh --name h100                    what was built in build/release, into out/devices/h100
#   scripts/device_report.sh --name pocl --icd pocl.icd     only the driver of this file of /etc/OpenCL/vendors
#   scripts/device_report.sh --pack FILE.tar.xz             the programs with the libraries that they load, for a
#                                                           machine without them; unpack it there, run the same script
#
#   --build FOLDER          the build (default: build/release)
#   --out FOLDER            instead of out/devices/NAME
#   --minutes N             for all of it (default: 10); every part gets its share, and what is not done then is cut off
#   --tests PATTERN         of kernel_tests, as --gtest_filter takes it (default: all)
#   --tune-cases NAMES      of quincunx-bench --tune (default: all)
#   --kernels NAME          only these of quincunx-kernel-bench, as its --filter takes them (default: all)
#   --frames-only           of all this, only frames from OpenGL
#   --frames N              of each of their runs (default: 200)
#   --sizes SIZES           of those and of the kernel benchmark (default: "1280x720 1920x1080 3840x2160")
#   --probe PROGRAM         run first, its output kept: one that prints what the drivers offer for sharing memory
#   --measure-with COMMAND  before each command that measures: "chrt -f 20" on a machine that others use
set -euo pipefail
cd "$(dirname "$0")/.."

programs=(kernel_tests service_tests interop_tests quincunx-bench quincunx-kernel-bench quincunx-render)
build=build/release name="" out="" icd="" minutes=10 pattern="*" pack="" cases="" filter=() measure=()
frames_only="" probe="" count=200 sizes=(1280x720 1920x1080 3840x2160)

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

while (($# > 0)); do
  if [[ "$1" == --frames-only ]]; then
    frames_only=yes
    shift
    continue
  fi
  [[ "$1" =~ ^--(name|icd|pack|build|out|minutes|tests|tune-cases|kernels|frames|sizes|probe|measure-with)$ && $# -ge 2 ]] ||
    fail "'$1' is no option, or its value is missing; the head of scripts/device_report.sh lists them."
  case "$1" in
    --name) name=$2 ;;
    --icd) icd=$2 ;;
    --pack) pack=$2 ;;
    --build) build=$2 ;;
    --out) out=$2 ;;
    --minutes) minutes=$2 ;;
    --tests) pattern=$2 ;;
    --tune-cases) cases=$2 ;;
    --kernels) filter=(--filter "$2") ;;
    --frames) count=$2 ;;
    --sizes) read -ra sizes <<<"$2" ;;
    --probe) probe=$2 ;;
    --measure-with) read -ra measure <<<"$2" ;;
  esac
  shift 2
done
for program in "${programs[@]}"; do
  [[ -x "$build/bin/$program" ]] || fail "$build/bin/$program is not there; build it, or name another build by --build."
done

# hide_semaphores FILE: a library that, loaded first, keeps OpenGL's semaphores from programs, so that the host waits.
hide_semaphores() {
  cc -shared -fPIC -o "$1" -xc - <<'C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdbool.h>
#include <string.h>
bool epoxy_has_gl_extension(const char* name) {
  bool (*real)(const char*) = dlsym(RTLD_NEXT, "epoxy_has_gl_extension");
  return strcmp(name, "GL_EXT_semaphore_fd") != 0 && real(name);
}
C
}

# What the programs load, the loader, the C library and what finds the drivers with it. Those are the machine's own.
pack_programs() {
  local folder
  folder=$(mktemp -d)
  mkdir -p "$folder"/quincunx/{"$build/bin",scripts,lib,kernels}
  cp "${programs[@]/#/$build/bin/}" "$folder/quincunx/$build/bin"
  strip "$folder/quincunx/$build/bin"/*
  cp scripts/device_report.sh "$folder/quincunx/scripts"
  cp kernels/variants.txt "$folder/quincunx/kernels"
  {
    ldd "${programs[@]/#/$build/bin/}"
    ldconfig -p | grep -E 'lib(EGL|OpenGL|GLdispatch|GLESv2|vulkan)\.so\.[0-9]+ .*x86-64'
  } | grep -oE '/[^ ]+\.so[^ :]*' | sort -u | xargs cp -Lt "$folder/quincunx/lib"
  hide_semaphores "$folder/quincunx/lib/no_semaphores.so"
  git rev-parse --short HEAD >"$folder/quincunx/commit"
  tar -C "$folder" -caf "$pack" quincunx
  rm -r "$folder"
  ls -l "$pack"
}
if [[ -n "$pack" ]]; then
  pack_programs
  exit
fi

[[ "$name" =~ ^[A-Za-z0-9._-]+$ ]] || fail "--name is '$name'; it must be letters, digits, '.', '_' and '-'."
[[ "$minutes" =~ ^[1-9][0-9]*$ ]] || fail "--minutes is '$minutes'; it must be a whole number from 1 on."
out=$(realpath -m "${out:-out/devices/$name}")
rm -rf "$out"
mkdir -p "$out"
export QUINCUNX_CACHE_DIR=$out/cache  # nothing of earlier runs, and a profile that is in the report
if [[ -n "$icd" ]]; then
  mkdir "$out/vendors"
  cp "/etc/OpenCL/vendors/$icd" "$out/vendors/" || fail "--icd is '$icd'; there is no such file in /etc/OpenCL/vendors."
  export OCL_ICD_VENDORS=$out/vendors/
fi
loader=()
if compgen -G "lib/ld-linux-*" >/dev/null; then
  loader=("$(compgen -G "$PWD/lib/ld-linux-*")" --library-path "$PWD/lib")
fi

# limited PERCENT LOG PROGRAM OPTION...: with that share of the time; what it says goes to LOG, its exit status to
# $code. Tests are dealt to as many processes as $shards says.
limited() {
  local seconds=$((minutes * 60 * $1 / 100)) log=$out/$2 program=$3 started=$SECONDS shards=${shards:-1} shard running=()
  shift 3
  printf '%s %s\n' "$program" "$*" >&2
  for ((shard = 0; shard < shards; shard++)); do
    GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$shard timeout -k 5 "$seconds" "${prefix[@]}" "${loader[@]}" \
      "$build/bin/$program" "$@" >"$log.$shard" 2>"$log.$shard.err" &
    running+=($!)
  done
  code=0
  for shard in "${running[@]}"; do
    wait "$shard" || code=$?
  done
  took=$((SECONDS - started))
  cat "$log".[0-9]* >"$log"
  rm "$log".[0-9]*
}
outcome() {
  case $code in
    0) printf 'done' ;;
    124 | 137) printf 'cut off after %s s' "$took" ;;
    *) printf 'exit status %s' "$code" ;;
  esac
}

report=$out/report.md
say() { printf '%s\n' "$@" >>"$report"; }
# block LOG: as it is, but for the folder's name; nothing where it is empty.
block() { [[ ! -s "$out/$1" ]] || say '' '```' "$(sed "s|$out/||g" "$out/$1" | fold -s -w 118 | sed 's/ *$//')" '```'; }

# told COMMAND: how it ended.
told() { say '' "$(fold -s -w 118 <<<"\`$1\`: $(outcome)." | sed 's/ *$//')"; }

# test_row SHARE PROGRAM OPTION...
test_row() {
  local share=$1 program=$2 log=$2.log
  shift 2
  shards=$(nproc) limited "$share" "$log" "$program" "$@"
  local count_of='grep -c -E'
  say "| \`$program${*:+ $*}\` | $($count_of '^\[       OK' "$out/$log" || true) | $(
    sed -n 's/^\[  FAILED  \] \(.*\) (.*ms)$/\1/p' "$out/$log" | wc -l) | $(
    $count_of '^\[  SKIPPED \] .*ms' "$out/$log" || true) | $took | $(outcome) |"
}

commit=$(cat commit 2>/dev/null || git rev-parse --short HEAD)
prefix=()
limited 3 devices.log quincunx-render --list-devices
say "# $name" '' \
  "Made by \`scripts/device_report.sh\` from commit $commit on $(date -u '+%Y-%m-%d %H:%M UTC'), in at most $minutes minutes." \
  "$(sed -n 's/^model name[^:]*: /Processor: /p' /proc/cpuinfo | head -n 1), $(nproc) of them; load of the last minute" \
  "$(cut -d ' ' -f 1 /proc/loadavg) as it began."
block devices.log
if [[ -n "$probe" ]]; then
  timeout 60 "$probe" >"$out/probe.log" 2>&1 || true
  say '' '## What the drivers offer'
  block probe.log
fi

if [[ -z "$frames_only" ]]; then
  # One frame, so that the device's clock is judged before many processes use it at once.
  limited 3 first.log quincunx-render --frames 1 --out "$out/first.png"
  say '' '## Tests' '' '| command | passed | failed | skipped | s | |' '|---|---|---|---|---|---|'
  test_row 25 kernel_tests "--gtest_filter=$pattern"
  test_row 7 service_tests
  test_row 7 interop_tests
  failed=$(sed -n 's/^\[  FAILED  \] \(.*\) (.*ms)$/- `\1`/p' "$out"/*_tests.log)
  [[ -z "$failed" ]] || say '' 'Failed:' '' "$failed"

  prefix=("${measure[@]}")
  limited 28 tune.log quincunx-bench --tune --out "$out" ${cases:+--tune-cases "$cases"}
  grep -q '"passes"' "$out/tune.json" 2>/dev/null && cp "$QUINCUNX_CACHE_DIR"/device_profile-*.json "$out/profile.json"
  say '' '## Tuned'
  told "quincunx-bench --tune${cases:+ --tune-cases $cases}"
  block tune.log

  limited 12 kernels.log quincunx-kernel-bench --no-peers --output "${sizes[@]}" --scales 0.5 --rounds 5 "${filter[@]}" \
    --json "$out/kernels.json"
  say '' '## Kernels'
  told "quincunx-kernel-bench --no-peers --output ${sizes[*]} --scales 0.5 --rounds 5${filter[*]:+ ${filter[*]}}"
  block kernels.log

  limited 12 bench.log quincunx-bench --quick --scenes courtyard --out "$out/bench"
  say '' '## Speed against error'
  told "quincunx-bench --quick --scenes courtyard"
  block bench.log
fi

# The same frames by each way are the same pictures.
say '' '## Frames from OpenGL'
prefix=("${measure[@]}")
hidden=$PWD/lib/no_semaphores.so
[[ -e "$hidden" ]] || hidden=$out/no_semaphores.so
[[ -e "$hidden" ]] || hide_semaphores "$hidden" || fail "cc, which --pack and this need, is not there."
share=$((${#frames_only} > 0 ? 6 : 2))
# frames_by WAY LOG OPTION...: `waits` is `external` without semaphores.
frames_by() {
  local way=$1 log=$2 hide=()
  shift 2
  [[ "$way" != waits ]] || hide=(env LD_PRELOAD="$hidden")
  prefix=("${measure[@]}" "${hide[@]}")
  limited "$share" "$log" quincunx-render --interop "${way/waits/external}" --scene courtyard --method temporal \
    --scale-path random --frames "$count" "$@"
}
for way in gl external waits copy; do
  frames_by "$way" "pictures_$way.log" --output "${sizes[0]}" --out "$out/$way/frame.%04d.png"
  told "quincunx-render --interop ${way/waits/external (semaphores hidden)} --scale-path random --frames $count"
  block "pictures_$way.log"
done
for way in gl external waits; do
  [[ -d "$out/$way" && -d "$out/copy" ]] || continue
  say '' "Pictures of $way and copy: $(diff -rq "$out/$way" "$out/copy" >/dev/null && echo 'the same bits' || echo 'different bits')."
done
say '' 'Medians, ms: the host draws and hands over, waits for the frame, takes the picture; then OpenCL events, all passes.' \
  '`waits` is `external` where no semaphores are found.' '' \
  '| output | way | draw, submit | wait | present | passes | frames a second |' '|---|---|---|---|---|---|---|'
for size in "${sizes[@]}"; do
  for way in copy waits external; do
    frames_by "$way" "frames_$way.log" --output "$size"
    say "| $size | $way | $(awk '/^  draw and submit/ { d = $4 } /^  wait for the frame/ { w = $5 }
      /^  present .*host clock$/ { p = $2 } /OpenCL event$/ { c += $2 } / a second, files included$/ { f = $(NF - 4) }
      END { printf "%s | %s | %s | %.3f | %s", d, w, p, c, f }' "$out/frames_$way.log") |"
  done
done
printf 'The report: %s\n' "$report" >&2
