# SPDX-License-Identifier: MIT
# Sourced by scripts that try something in a bare Debian: makes such a system in a folder and enters it. Needs root and
# debootstrap.
#
# QUINCUNX_DEBIAN_FOLDER  where the systems are kept (default: build/debian)
# QUINCUNX_DEBIAN_MIRROR  the mirror (default: the first that apt's sources of this machine name)

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

# suite_of NUMBER: the name of a release that we know; nothing for another.
suite_of() {
  case "$1" in
    12) echo bookworm ;;
    13) echo trixie ;;
  esac
}

# The first address in apt's sources, in either of their forms; a mirror of Debian has all its suites.
mirror_of_this_machine() {
  grep -shoE '^(URIs:|deb ).*' /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list /etc/apt/sources.list.d/* |
    grep -m 1 -oE 'https?://[^ ]+' || true
}

# In the reverse order of mounting; also before a removal, which must never go through a mount.
unmount_all() {
  local path
  for path in dev/shm dev/pts dev sys/fs/cgroup sys proc; do
    if mountpoint -q "$root/$path"; then
      umount -R "$root/$path" || umount -l "$root/$path"
    fi
  done
}

# make_system SUITE NAME FRESH: sets `root` to a system of that suite. FRESH `yes`: a new one; else that of the last
# time, if any.
make_system() {
  local suite=$1 name=$2 fresh=$3 tool mirror
  ((EUID == 0)) || fail "Making and entering another system needs root: please run this as root."
  for tool in debootstrap git; do
    command -v "$tool" >/dev/null || fail "This needs $tool: apt-get install $tool"
  done
  mirror=${QUINCUNX_DEBIAN_MIRROR:-$(mirror_of_this_machine)}
  [[ -n "$mirror" ]] || fail "apt's sources name no mirror: please set QUINCUNX_DEBIAN_MIRROR."
  root=$(realpath -m "${QUINCUNX_DEBIAN_FOLDER:-build/debian}")/$name
  unmount_all
  if [[ "$fresh" == yes || ! -e "$root/.ready" ]]; then
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
}

# enter_system: mounts what programs in `root` need, until this script ends.
enter_system() {
  trap unmount_all EXIT
  if [[ -e /etc/resolv.conf ]]; then
    cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  fi
  mount -t proc proc "$root/proc"
  ln -sf /proc/self/mounts "$root/etc/mtab"  # Blender asks for it
  mount -t sysfs -o ro sysfs "$root/sys"  # PoCL learns from it how much memory and how many processors there are
  mount --rbind --make-rslave /sys/fs/cgroup "$root/sys/fs/cgroup"  # Slurm 22.05 does not begin without
  mount -t tmpfs -o mode=755,size=1M tmpfs "$root/dev"
  mkdir "$root/dev/pts" "$root/dev/shm"
  local node
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
}

# inside COMMAND: as a login there has it: nothing of this machine's compilers, caches or drivers.
inside() {
  env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    chroot "$root" bash -c "$1"
}
