#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the Debian packages in one Debian, from a clean clone of HEAD, and tries them in another that has nothing of us:
# lintian finds no error, the programs run, and the clients of tests/install build by CMake and by pkg-config and run.
# Needs root, git and debootstrap; about a quarter of an hour, most of it for what is built.
#
#   scripts/try_packages.sh 12             Debian 12 (bookworm); 13: Debian 13 (trixie)
#   scripts/try_packages.sh 13 try         only that, with the packages of the last time; or only make
#   scripts/try_packages.sh --fresh 13     from new systems; else the ones of the last time, without what was tried then
#
# The packages are in build/packages/SUITE then. DEBFULLNAME and DEBEMAIL say who made them (default: HEAD's author).
# scripts/debian_system.sh has the environment variables that say where the systems are kept and come from.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/packages.sh
source scripts/debian_system.sh

fresh=no
if [[ "${1:-}" == --fresh ]]; then
  fresh=yes
  shift
fi
suite=$(suite_of "${1:-}")
[[ -n "$suite" && "${2:-make}" =~ ^(make|try)$ && $# -le 2 ]] ||
  fail "Usage: scripts/try_packages.sh [--fresh] 12|13 [make|try]"
steps=${2:-make try}
packages=$PWD/build/packages/$suite
install="DEBIAN_FRONTEND=noninteractive apt-get install -q=2 -y --no-install-recommends"

# stage TITLE COMMAND: inside the system; what it says is shown where it fails.
stage() {
  say "=== $1, Debian $suite"
  inside "set -e; $2" </dev/null || fail "Debian $suite: $1 failed; the reason is above."
}

make_packages() {
  local name=${DEBFULLNAME:-$(git log -1 --format=%an)} email=${DEBEMAIL:-$(git log -1 --format=%ae)}
  make_system "$suite" "build-$suite" "$fresh"
  enter_system
  stage "what the build needs" "apt-get update -q=2; $install lintian file help2man ${build_packages[*]} >/dev/null"
  rm -rf "$root/tmp/quincunx" "$packages"
  git clone -q --no-local . "$root/tmp/quincunx"
  stage "build" "cd /tmp/quincunx; cmake --preset package >/dev/null; cmake --build --preset package"
  stage "cpack" "cd /tmp/quincunx; export DEBFULLNAME='$name' DEBEMAIL='$email'; cmake --preset package >/dev/null
    cd build/package; cpack >/dev/null; ls *.deb"
  stage "lintian" "cd /tmp/quincunx/build/package; lintian --fail-on error --tag-display-limit 0 --allow-root *.deb"
  mkdir -p "$packages"
  cp "$root"/tmp/quincunx/build/package/*.deb "$packages"
  unmount_all
}

# A copy of a bare system, in which only what the packages ask for is installed.
try_packages() {
  [[ -d "$packages" ]] || fail "There are no packages in $packages; scripts/try_packages.sh makes them."
  make_system "$suite" "bare-$suite" "$fresh"
  local bare=$root
  root=${bare%/*}/clean-$suite
  unmount_all
  rm -rf --one-file-system "$root"
  cp -a "$bare" "$root"
  enter_system
  mkdir "$root/tmp/packages" "$root/tmp/work"
  cp "$packages"/*.deb "$root/tmp/packages"
  cp -r tests/install/client docs/examples "$root/tmp/"
  stage "programs" "apt-get update -q=2; cd /tmp/packages; $install ./quincunx-tools_*.deb ./libquincunx*1_*.deb >/dev/null
    $install libgl1-mesa-dri libegl1 >/dev/null  # a driver, as on a machine with a display
    cd /tmp/work
    for program in resolve render dump bench; do quincunx-\$program --version; done
    quincunx-render --frames 3 --output 320x180 --scale 0.5 --out 'frame.%04d.exr' -q
    quincunx-dump --output 320x180 --scale 0.5 --frames 4 --sequence 'seq.%04d.exr' -q
    quincunx-resolve 'seq.%04d.exr' --out 'up.%04d.exr' -q
    quincunx-bench --quick --scenes wires --methods bilinear --scales 0.5 --frames 1 --rounds 1 --out bench -q
    ls frame.0002.exr up.0003.exr bench/bench.html"
  stage "a client of control, without OpenCL" "cd /tmp/packages
    $install ./libquincunx-control-dev_*.deb ./libquincunx-control1_*.deb g++ cmake make pkg-config >/dev/null
    cmake -S /tmp/client -B /tmp/work/control -D CONTROL_ALONE=ON >/dev/null; make -C /tmp/work/control 2>&1 >/dev/null
    /tmp/work/control/control_client"
  stage "clients by CMake" "cd /tmp/packages
    $install ./libquincunx-dev_*.deb ./libquincunx*1_*.deb >/dev/null
    cmake -S /tmp/client -B /tmp/work/client -D EXAMPLES=/tmp/examples -D GL_INTEROP=ON >/dev/null; cd /tmp/work/client; make 2>&1 >/dev/null
    ./minimal; ./minimal_c; ./gl_client"
  stage "clients by pkg-config" "mkdir /tmp/work/by_pkg_config; cd /tmp/work/by_pkg_config
    cc -std=c99 /tmp/examples/minimal.c -o minimal_c \$(pkg-config --cflags --libs quincunx) -lm
    c++ -std=c++20 /tmp/examples/minimal.cpp -o minimal \$(pkg-config --cflags --libs quincunx)
    c++ -std=c++20 /tmp/client/gl_client.cpp -o gl_client \$(pkg-config --cflags --libs quincunx-gl)
    ./minimal_c; ./minimal; ./gl_client"
  stage "Python, manual pages, completion, texts" "cd /tmp/packages
    $install ./python3-quincunx_*.deb ./quincunx-doc_*.deb man-db zsh fish >/dev/null; cd /tmp/work
    python3 -c 'import numpy, quincunx
print(quincunx.Resolver((64, 48), method=\"bilinear\").resolve(numpy.ones((20, 30, 4))).mean())'
    for program in bench dump render resolve; do
      test -z \"\$(man --warnings=w -l /usr/share/man/man1/quincunx-\$program.1.gz 2>&1 >/dev/null)\"
      . /usr/share/bash-completion/completions/quincunx-\$program; complete -p quincunx-\$program
      zsh -n /usr/share/zsh/vendor-completions/_quincunx-\$program
      fish -n /usr/share/fish/vendor_completions.d/quincunx-\$program.fish
    done
    test -s /usr/share/doc/quincunx/docs/integrate.md"
  say "The packages of Debian $suite hold; they are in $packages."
}

for step in $steps; do
  "${step}_packages"
done
