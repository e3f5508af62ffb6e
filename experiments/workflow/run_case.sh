#!/usr/bin/env bash
# One case of a sweep, from its start to its row:
#   run_case.sh ROW PART SETTINGS TABLE MAP COMMAND...
# COMMAND is ibrdf_bench without --out, which becomes PART. ROW, the table of
# this case alone, appears at once and whole. PART keeps the row as well: when
# the workflow lost track of a case that finished, it is taken from there,
# unless SETTINGS changed or TABLE or MAP are newer.
# PART/attempts.log says when each attempt began, where, and how it ended.
set -euo pipefail

if [ "$#" -lt 6 ]; then
  echo "usage: $0 ROW PART SETTINGS TABLE MAP COMMAND..." >&2
  exit 2
fi
row="$1" part="$2" settings="$3" table="$4" map="$5"
shift 5
mkdir -p "${part}" "$(dirname "${row}")"

# A job that a dead workflow left behind may still compute this case: wait for
# it. The lock passes on to the programs below and is free when all have ended.
exec 9>"${part}/lock"
flock 9

note() {
  echo "$(date -u +%FT%TZ) $(uname -n) job=${SLURM_JOB_ID:-local} pid=$$ $*" \
    >>"${part}/attempts.log"
}

results="${part}/results.csv"
if [ "$(cat "${part}/settings" 2>/dev/null)" != "${settings}" ] ||
   [ "${table}" -nt "${results}" ] || [ "${map}" -nt "${results}" ]; then
  rm -f "${results}"
fi
# Not before the old row is gone, lest it pass for one of these settings.
printf '%s\n' "${settings}" >"${part}/settings"

# The cell of a table's only row, by name of its column.
cell() {
  awk -F, -v name="$1" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) column = i }
    NR == 2 { value = $column }
    END { if (NR != 2 || !column) exit 1; print value }' "${results}"
}

if [ -f "${results}" ]; then
  note kept
else
  note begin
  code=0
  "$@" --out "${part}" || code=$?
  if [ "${code}" -ne 0 ]; then
    note "failed with status ${code}"
    exit "${code}"
  fi
fi
if ! status="$(cell status)"; then
  rm -f "${results}"
  note "failed: expected one row with a status"
  echo "${results}: expected one row with a status" >&2
  exit 1
fi
case "${status}" in
  # Killed from outside (also for its memory) or never started: no result.
  # Any other failure of the solver is one, and its row says so.
  signal_* | not_executable)
    rm -f "${results}"
    note "lost: ${status}"
    echo "the solver ended by ${status}: no result" >&2
    exit 1 ;;
esac
if ! cmp -s "${results}" "${row}"; then
  cp "${results}" "${row}.part"
  mv -f "${row}.part" "${row}"
fi
note "done ${status}"
