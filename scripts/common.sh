# shellcheck shell=bash
# Sourced by the scripts beside it: where the project is, and steps with times.

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
