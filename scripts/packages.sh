# SPDX-License-Identifier: MIT
# Sourced by run.sh and test.sh: which Debian packages the project needs, and how to install the missing ones.
# Names hold for Debian 12 (bookworm) and 13 (trixie).

build_packages=(
  g++ cmake ninja-build pkg-config
  libspdlog-dev libfmt-dev libcli11-dev nlohmann-json3-dev libglm-dev libxxhash-dev
  libopenimageio-dev libopenexr-dev libimath-dev libpng-dev
  libtinygltf-dev libstb-dev
  libepoxy-dev libegl-dev libgl-dev
  ocl-icd-opencl-dev opencl-clhpp-headers
  libglfw3-dev libimgui-dev libfreetype-dev   # the window; without them, all but the window is built
)
run_packages=(
  pocl-opencl-icd                        # an OpenCL device on every CPU
  libegl1 libegl-mesa0 libgl1-mesa-dri   # OpenGL without a window or a GPU
  libgles2                               # OpenGL ES, for --gl es3
  fonts-dejavu-core                      # captions of the contact sheet
  libjs-chart.js                         # plots of the pages; put into each when it is made
)
test_packages=(libgtest-dev clang clang-format python3 python3-numpy python3-cffi chromium
  help2man                               # manual pages
  mesa-opencl-icd                        # rusticl, a second OpenCL for the processor
  mesa-vulkan-drivers libvulkan-dev      # lavapipe, whose memory OpenGL and OpenCL import; its headers and loader
  glslang-tools                          # shaders of docs/examples/vulkan.cpp
  xvfb xdotool openbox                   # a display, a keyboard and a window manager for the window
)
optional_test_packages=(
  oclgrind                               # memory checks of kernels; Debian 13 has it no more
  slurm-wlm munge                        # a render farm of one node
  libopenscenegraph-dev                  # an engine, for docs/examples/openscenegraph.cpp
)

say() { printf '%s\n' "$*"; }
fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

# ensure_packages NAME...: installs those that are missing; does nothing, and needs no network, when all are there.
ensure_packages() {
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    fail "This script installs Debian packages with apt-get, which is not here. Please install the equivalents of: $*"
  local missing=() name
  for name in "$@"; do
    [[ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$name" 2>/dev/null)" == ?i* ]] || missing+=("$name")
  done
  if ((${#missing[@]} == 0)); then
    return
  fi
  say "Quincunx needs ${#missing[@]} Debian packages that are not installed yet:"
  say "  ${missing[*]}"
  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      fail "Installing them needs root. Please run as root: apt-get install ${missing[*]}"
    as_root=(sudo)
    say "Installing them needs root, so sudo may ask for your password; nothing else runs as root."
  fi
  say "Installing them with apt-get."
  # The package list may be older than the mirror, or not there at all on a fresh machine.
  "${as_root[@]}" apt-get update -q=2 ||
    say "apt-get update did not work (no network?); trying with the package list that is there."
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" ||
    fail "apt-get could not install the packages (see above). With a network, try again; or install them by hand."
}

# known_packages NAME...: prints those that are installed or that the archive has.
known_packages() {
  local name
  for name in "$@"; do
    if [[ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$name" 2>/dev/null)" == ?i* ]] ||
      apt-cache show "$name" >/dev/null 2>&1; then
      say "$name"
    fi
  done
}

# configure_and_build PRESET [TARGET...]: into build/PRESET, default into build/release, whose options it leaves as they
# are; shows CMake's words only on failure. With ccache, set CMAKE_CXX_COMPILER_LAUNCHER=ccache, which CMake reads;
# headers are then not precompiled.
configure_and_build() {
  local preset=$1 folder=build/${1/default/release} log
  shift
  mkdir -p "$folder"
  log="$folder/configure.log"
  if ! cmake --preset "$preset" >"$log" 2>&1; then
    cat "$log" >&2
    fail "cmake could not configure $folder; the reason is above."
  fi
  local targets=()
  if (($# > 0)); then
    targets=(--target "$@")
  fi
  cmake --build "$folder" "${targets[@]}" || fail "The build in $folder failed; the first error is above."
}
