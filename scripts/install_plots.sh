#!/usr/bin/env bash
# Installs what the plots of experiments/ need and the build does not:
# Debian's python3-matplotlib.
#   install_plots.sh
# Calls apt, as root or through sudo, only when something is missing.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

if [ "$#" -ne 0 ]; then
  echo "usage: $0" >&2
  exit 2
fi
install_packages python3-matplotlib
