#!/usr/bin/env bash
# Installs what experiments/workflow runs on and the build does not need:
# snakemake, and a Slurm for one machine (slurm-wlm, munge).
#   install_workflow.sh [--no-slurm]
#   --no-slurm: only snakemake, for this machine's cores or a cluster's own Slurm
# Calls apt, as root or through sudo, only when something is missing.
set -euo pipefail

packages=(snakemake slurm-wlm munge)
for option in "$@"; do
  case "${option}" in
    --no-slurm) packages=(snakemake) ;;
    *) echo "usage: $0 [--no-slurm]" >&2; exit 2 ;;
  esac
done

is_installed() {
  dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null | grep -qx installed
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_workflow.sh: no apt on this system; install what these" \
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
    echo "install_workflow.sh: neither root nor sudo; as root, run:" \
         "apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get)
echo "installing ${missing[*]}"
"${apt[@]}" update -q
"${apt[@]}" install -q -y --no-install-recommends "${missing[@]}"
