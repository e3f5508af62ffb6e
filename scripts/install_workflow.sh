#!/usr/bin/env bash
# Installs what experiments/workflow runs on and the build does not need:
# snakemake, and a Slurm for one machine (slurm-wlm, munge).
#   install_workflow.sh [--no-slurm]
#   --no-slurm: only snakemake, for this machine's cores or a cluster's own Slurm
# Calls apt, as root or through sudo, only when something is missing.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(snakemake slurm-wlm munge)
for option in "$@"; do
  case "${option}" in
    --no-slurm) packages=(snakemake) ;;
    *) echo "usage: $0 [--no-slurm]" >&2; exit 2 ;;
  esac
done

install_packages "${packages[@]}"
