#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. With
# --sanitize the hard cases run under the sanitizers, in a second build. With
# CI=true a compiler warning is an error.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "${project_dir}"

sanitize=OFF
[ "${1:-}" = --sanitize ] && sanitize=ON
warnings_as_errors=OFF
[ "${CI:-}" = true ] && warnings_as_errors=ON
# Tests write gigabytes, flushed file by file: to memory, where there is room.
memory=/dev/shm
if [ -z "${TMPDIR:-}" ] && [ -w "${memory}" ] &&
   [ "$(df --output=avail -k "${memory}" | tail -n 1)" -gt 1000000 ]; then
  export TMPDIR="${memory}"
fi

step "Install missing packages" scripts/install_dependencies.sh --tests
step "Configure" cmake --preset release -DIBRDF_BUILD_TESTS=ON \
  -DIBRDF_SANITIZE_HARD_CASES="${sanitize}" \
  -DIBRDF_WARNINGS_AS_ERRORS="${warnings_as_errors}"
step "Build" cmake --build --preset release -j "$(nproc)"
echo "==> Test (those that pass are not listed)"
# Not a step: what ctest prints last is the last line.
ctest --test-dir build/release --output-on-failure -j "$(nproc)" |
  grep --line-buffered -vE '^ +Start +[0-9]+:|Test +#[0-9]+:.* Passed '
