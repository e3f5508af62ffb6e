# shellcheck shell=bash
# Sourced by the scripts beside it: where the project is, steps with times, and
# Debian packages.

# shellcheck disable=SC2034  # used by those scripts
project_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

# step DESCRIPTION COMMAND...: runs the command and prints how long it took.
step() {
  local description="$1" begin=$SECONDS status=0
  shift
  echo "==> ${description}"
  "$@" || status=$?
  if [ "${status}" -ne 0 ]; then
    echo "==> ${description}: failed with status ${status}" \
         "after $((SECONDS - begin)) s" >&2
    return "${status}"
  fi
  echo "==> ${description}: done in $((SECONDS - begin)) s"
}

# install_packages PACKAGE...: installs those Debian packages that are missing.
# Calls apt, as root or through sudo, only when something is missing.
install_packages() {
  local name package missing=() as_root=() apt
  name="$(basename "$0")"
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "${name}: no apt on this system; install what these" \
         "Debian packages hold yourself: $*" >&2
    return 1
  fi
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}' "${package}" 2>/dev/null |
      grep -qx installed || missing+=("${package}")
  done
  if [ "${#missing[@]}" -eq 0 ]; then
    echo "all $# packages are installed"
    return
  fi
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "${name}: neither root nor sudo; as root, run:" \
           "apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get)
  echo "installing ${missing[*]}"
  "${apt[@]}" update -q
  "${apt[@]}" install -q -y --no-install-recommends "${missing[@]}"
}
