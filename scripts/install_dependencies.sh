#!/usr/bin/env bash
# Installs the Debian packages that the build needs and that are missing.
#   install_dependencies.sh [--tests] [--benchmarks]
#   --tests, --benchmarks: those of the tests, of the benchmarks too
# Calls apt, as root or through sudo, only when something is missing.
set -euo pipefail

packages=(
  g++ cmake make
  libceres-dev libopenblas-dev libeigen3-dev libgoogle-glog-dev libembree-dev
  libopenexr-dev libpng-dev libassimp-dev
  libopencv-core-dev libopencv-imgproc-dev
  libyaml-cpp-dev libcli11-dev nlohmann-json3-dev
)
for option in "$@"; do
  case "${option}" in
    --tests) packages+=(libgtest-dev) ;;
    --benchmarks) packages+=(libbenchmark-dev) ;;
    *) echo "usage: $0 [--tests] [--benchmarks]" >&2; exit 2 ;;
  esac
done

is_installed() {
  dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null | grep -qx installed
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_dependencies.sh: no apt on this system; install what these" \
       "Debian packages hold yourself: ${packages[*]}" >&2
  exit 1
fi
missing=()
for package in "${packages[@]}"; do
  is_installed "${package}" || missing+=("${package}")
done
if [ "${#missing[@]}" -eq 0 ]; then
  echo "all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_dependencies.sh: neither root nor sudo; as root, run:" \
         "apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get)
echo "installing ${missing[*]}"
"${apt[@]}" update -q
"${apt[@]}" install -q -y --no-install-recommends "${missing[@]}"
