#!/usr/bin/env bash
# Installs the Debian packages that the build needs and that are missing.
#   install_dependencies.sh [--tests] [--benchmarks]
#   --tests, --benchmarks: those of the tests, of the benchmarks too
# Calls apt, as root or through sudo, only when something is missing.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(
  g++ cmake make
  libceres-dev libopenblas-dev libeigen3-dev libgoogle-glog-dev libembree-dev
  libopenexr-dev libpng-dev libjpeg-dev libtiff-dev
  libopencv-core-dev libopencv-imgproc-dev
  libyaml-cpp-dev libcli11-dev nlohmann-json3-dev
)
for option in "$@"; do
  case "${option}" in
    --tests) packages+=(libgtest-dev librapidcheck-dev python3) ;;
    --benchmarks) packages+=(libbenchmark-dev) ;;
    *) echo "usage: $0 [--tests] [--benchmarks]" >&2; exit 2 ;;
  esac
done

install_packages "${packages[@]}"
