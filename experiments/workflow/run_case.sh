#!/usr/bin/env bash
# One case of a sweep, from its start to its rows:
#   run_case.sh ROWS COUNT PART SETTINGS TABLE MAP COMMAND...
# COMMAND is ibrdf_bench without --out, which becomes PART. ROWS, the table of
# this case alone, COUNT rows, appears at once and whole. PART keeps the rows as
# well: what the workflow lost track of, or what was finished when the case was
# killed, is taken from there, unless SETTINGS changed or TABLE or MAP are newer.
# PART/attempts.log says when each attempt began, where, and how it ended.
set -euo pipefail

if [ "$#" -lt 7 ]; then
  echo "usage: $0 ROWS COUNT PART SETTINGS TABLE MAP COMMAND..." >&2
  exit 2
fi
rows="$1" count="$2" part="$3" settings="$4" table="$5" map="$6"
shift 6
mkdir -p "${part}" "$(dirname "${rows}")"

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
# Not before old rows are gone, lest they pass for some of these settings.
printf '%s\n' "${settings}" >"${part}/settings"

# The table, or with `status` that column alone, without rows that are no
# result: the solver was killed from outside (also for its memory) or never
# started. Any other failure of the solver is one, and its row says so. Fails
# where there is no such column.
finished() {
  awk -F, -v what="$1" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "status") column = i
              if (!column) exit 1 }
    NR > 1 && $column ~ /^(signal_.*|not_executable)$/ { next }
    what == "status" { if (NR > 1) print $column; next }
    { print }' "${results}"
}
rows_finished() { finished status | grep -c . || true; }

if [ -f "${results}" ] && [ "$(rows_finished)" -eq "${count}" ]; then
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
if ! finished table >"${results}.part"; then
  rm -f "${results}" "${results}.part"
  note "failed: expected a table with a status"
  echo "${results}: expected a table with a status" >&2
  exit 1
fi
if ! cmp -s "${results}" "${results}.part"; then
  note "lost: the solver was ended from outside"
  echo "the solver was ended from outside: no result" >&2
fi
mv -f "${results}.part" "${results}"
if [ "$(rows_finished)" -ne "${count}" ]; then
  note "failed: $(rows_finished) rows of ${count}"
  echo "${results}: $(rows_finished) rows of ${count}" >&2
  # A table without a row would pass for a finished one to the sweep.
  [ "$(rows_finished)" -gt 0 ] || rm -f "${results}"
  exit 1
fi
if ! cmp -s "${results}" "${rows}"; then
  cp "${results}" "${rows}.part"
  mv -f "${rows}.part" "${rows}"
fi
note "done $(finished status | sort | uniq -c | xargs)"
