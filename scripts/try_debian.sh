#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tries ./run.sh and ./test.sh in a bare Debian, from a clean clone of HEAD. Needs root, git and debootstrap.
#
#   scripts/try_debian.sh 12             Debian 12 (bookworm); 13: Debian 13 (trixie)
#   scripts/try_debian.sh --fresh 13     from a new system; else the packages of the last try are there already
#   scripts/try_debian.sh 13 run.sh      only that one, or only test.sh
#
# QUINCUNX_DEBIAN_FOLDER  where the systems are kept (default: build/debian)
# QUINCUNX_DEBIAN_MIRROR  the mirror (default: the first that apt's sources of this machine name)
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

fresh=no
if [[ "${1:-}" == --fresh ]]; then
  fresh=yes
  shift
fi
case "${1:-}" in
  12) suite=bookworm ;;
  13) suite=trixie ;;
  *) fail "Usage: scripts/try_debian.sh [--fresh] 12|13 [run.sh|test.sh]..." ;;
esac
shift
commands=("$@")
if ((${#commands[@]} == 0)); then
  commands=(run.sh test.sh)
fi
for command in "${commands[@]}"; do
  [[ "$command" == run.sh || "$command" == test.sh ]] || fail "'$command' is neither run.sh nor test.sh."
done
((EUID == 0)) || fail "Making and entering another system needs root: please run this as root."
for tool in debootstrap git; do
  command -v "$tool" >/dev/null || fail "This needs $tool: apt-get install $tool"
done

# The first address in apt's sources, in either of their forms; a mirror of Debian has all its suites.
mirror_of_this_machine() {
  grep -shoE '^(URIs:|deb ).*' /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list /etc/apt/sources.list.d/* |
    grep -m 1 -oE 'https?://[^ ]+' || true
}
mirror=${QUINCUNX_DEBIAN_MIRROR:-$(mirror_of_this_machine)}
[[ -n "$mirror" ]] || fail "apt's sources name no mirror: please set QUINCUNX_DEBIAN_MIRROR."
root=$(realpath -m "${QUINCUNX_DEBIAN_FOLDER:-build/debian}")/$suite

# In the reverse order of mounting; also before a removal, which must never go through a mount.
unmount_all() {
  local path
  for path in dev/shm dev/pts dev sys proc; do
    if mountpoint -q "$root/$path"; then
      umount "$root/$path" || umount -l "$root/$path"
    fi
  done
}
trap unmount_all EXIT
unmount_all
if [[ "$fresh" == yes ]]; then
  rm -rf --one-file-system "$root"
fi

if [[ ! -e "$root/.ready" ]]; then
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  printf 'Making a bare Debian %s in %s.\n' "$suite" "$root"
  debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$root.log" 2>&1 ||
    fail "debootstrap failed; its words are in $root.log and in $root/debootstrap/debootstrap.log."
  # Proxies of this machine's apt, which a mirror may need; its other settings are its own.
  apt-config dump 2>/dev/null | grep -iE '^Acquire::https?::.*Proxy' >"$root/etc/apt/apt.conf.d/90proxy" ||
    rm -f "$root/etc/apt/apt.conf.d/90proxy"
  touch "$root/.ready"
fi
if [[ -e /etc/resolv.conf ]]; then
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
fi

mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"  # PoCL learns from it how much memory and how many processors there are
mount -t tmpfs -o mode=755,size=1M tmpfs "$root/dev"
mkdir "$root/dev/pts" "$root/dev/shm"
for node in "null 3" "zero 5" "full 7" "random 8" "urandom 9"; do
  mknod -m 666 "$root/dev/${node% *}" c 1 "${node#* }"
done
mknod -m 666 "$root/dev/tty" c 5 0
ln -s /proc/self/fd "$root/dev/fd"
ln -s /proc/self/fd/0 "$root/dev/stdin"
ln -s /proc/self/fd/1 "$root/dev/stdout"
ln -s /proc/self/fd/2 "$root/dev/stderr"
mount -t devpts -o newinstance,ptmxmode=666,mode=620 devpts "$root/dev/pts"
ln -s pts/ptmx "$root/dev/ptmx"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"

rm -rf "$root/tmp/quincunx"
git clone -q --no-local . "$root/tmp/quincunx"
# Only what a login has: nothing of this machine's compilers, caches or drivers.
inside() {
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    chroot "$root" bash -c "cd /tmp/quincunx && $1"
}

failed=()
lines=()
for command in "${commands[@]}"; do
  printf '\n=== Debian %s: ./%s\n' "$suite" "$command"
  started=$SECONDS
  outcome=passed
  inside "./$command" </dev/null || {
    outcome=FAILED
    failed+=("$command")
  }
  lines+=("./$command $outcome after $((SECONDS - started)) s, installing what was missing included")
done

printf '\nDebian %s (%s), commit %s\n' "$(cat "$root/etc/debian_version")" "$suite" "$(git rev-parse --short HEAD)"
inside "dpkg-query -W -f='  \${Package} \${Version}\n' g++ pocl-opencl-icd libgl1-mesa-dri 2>/dev/null" || true
printf '  %s\n' "${lines[@]}"
((${#failed[@]} == 0)) || fail "Failed: ${failed[*]}"
