#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. With CI=true
# a compiler warning is an error.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "${project_dir}"

warnings_as_errors=OFF
[ "${CI:-}" = true ] && warnings_as_errors=ON

step "Install missing packages" scripts/install_dependencies.sh --tests
step "Configure" cmake --preset release -DIBRDF_BUILD_TESTS=ON \
  -DIBRDF_WARNINGS_AS_ERRORS="${warnings_as_errors}"
step "Build" cmake --build --preset release -j "$(nproc)"
echo "==> Test"
# Not a step: what ctest prints last is the last line.
exec ctest --test-dir build/release --output-on-failure -j "$(nproc)"
