#!/usr/bin/env bash
# A small sweep on a real Slurm of this machine, hurt on the way:
#   test_workflow.sh [--bin DIR] [--data DIR] [--maps DIR] [--work DIR]
# A solver is killed, a job is cancelled, then snakemake itself is killed; the
# same command must go on, compute no finished case again and give the table
# that the local profile gives. Takes about four minutes of two cores.
#   --bin   ibrdf_bench and ibrdf_solve (build/release/bin)
#   --data  MERL .binary tables (build/merl)
#   --maps  .hdr or .exr maps (../shared/data/envmaps)
#   --work  a folder to make and keep; by default a temporary one that is
#           removed when all went well
# Exit status: 0 passed, 1 failed, 77 skipped for want of a program or data.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
cd "${here}/../.."
bin=build/release/bin data=build/merl maps=../shared/data/envmaps work=
while [ "$#" -gt 0 ]; do
  case "$1" in
    --bin | --data | --maps | --work)
      [ "$#" -ge 2 ] || { echo "$0: $1 needs a folder" >&2; exit 2; }
      printf -v "${1#--}" %s "$2"
      shift 2 ;;
    *) echo "usage: $0 [--bin DIR] [--data DIR] [--maps DIR] [--work DIR]" >&2
       exit 2 ;;
  esac
done
PATH="${PATH}:/usr/sbin:/sbin"
materials=(alum-bronze pearl-paint red-plastic)
map_names=(city forest)
num_cases=$((${#materials[@]} * ${#map_names[@]}))

skip() { echo "SKIPPED: $*" >&2; exit 77; }
for program in snakemake sbatch slurmctld slurmd munged; do
  command -v "${program}" >/dev/null ||
    skip "no ${program}; scripts/install_workflow.sh installs it"
done
for program in ibrdf_bench ibrdf_solve; do
  [ -x "${bin}/${program}" ] ||
    skip "no ${program} in ${bin}; build it or set --bin"
done
for material in "${materials[@]}"; do
  [ -f "${data}/${material}.binary" ] ||
    skip "no ${material}.binary in ${data}; set --data"
done
for map in "${map_names[@]}"; do
  [ -f "${maps}/${map}.hdr" ] || [ -f "${maps}/${map}.exr" ] ||
    skip "no map ${map} in ${maps}; set --maps"
done

# snakemake runs in the folder of the test, so that it leaves nothing here.
bin="$(cd "${bin}" && pwd -P)"
data="$(cd "${data}" && pwd -P)"
maps="$(cd "${maps}" && pwd -P)"

keep_work=1
if [ -z "${work}" ]; then
  work="$(mktemp -d "${TMPDIR:-/tmp}/ibrdf_workflow.XXXXXX")"
  keep_work=0
fi
mkdir -p "${work}"
work="$(cd "${work}" && pwd -P)"
chmod 711 "${work}"  # munge's socket is for all users
[ ! -e "${work}/slurm_out" ] ||
  { echo "$0: ${work} holds another test" >&2; exit 2; }

workflow_pid=
on_exit() {
  local status=$?
  [ -z "${workflow_pid}" ] || kill -9 "${workflow_pid}" 2>/dev/null || true
  "${here}/stop_slurm.sh" "${work}/slurm" >/dev/null || true
  if [ "${status}" -eq 0 ] && [ "${keep_work}" -eq 0 ]; then
    rm -rf "${work}"
  else
    echo "files are in ${work}"
  fi
}
trap on_exit EXIT

fail() { echo "FAILED: $*" >&2; exit 1; }
say() { printf '[%3d s] %s\n' "${SECONDS}" "$*"; }

# config OUT SEED: a configuration of the small sweep on stdout.
config() {
  local IFS=,
  cat <<CONFIG
bin: "${bin}"
data: "${data}"
maps: "${maps}"
out: "$1"
resources: {threads: 1, mem_mb: 700, runtime: 10}
sweeps:
  small:
    experiment: joint
    materials: [${materials[*]}]
    maps: [${map_names[*]}]
    flags: {size: 12, seed: $2, solver-seconds: 1}
CONFIG
}
out="${work}/slurm_out"
config "${out}" 1 >"${work}/slurm.yaml"
config "${out}" 2 >"${work}/other_seed.yaml"
config "${work}/local_out" 1 >"${work}/local.yaml"

workflow() {  # workflow PROFILE CONFIG ARGUMENTS...
  local profile="$1" config="$2"
  shift 2
  exec snakemake --snakefile "${here}/Snakefile" --directory "${work}" \
    --profile "${here}/profiles/${profile}" --configfile "${config}" "$@"
}

sweep="${out}/small"
finished() {  # the cases that have a row, as MATERIAL/MAP
  (cd "${sweep}/rows" 2>/dev/null && find . -name '*.csv' | sed 's|^./||;
    s|[.]csv$||' | sort) || true
}
count_finished() { finished | grep -c . || true; }
attempts() {  # attempts CASE WORD: lines of its log that say WORD
  grep -cw -- "$2" "${sweep}/parts/$1/attempts.log" 2>/dev/null || true
}
all_cases() {
  local material map
  for material in "${materials[@]}"; do
    for map in "${map_names[@]}"; do echo "${material}/${map}"; done
  done
}
# Prints "CASE PID" of a solver that runs.
running_solver() {
  local case pid
  for case in $(all_cases); do
    pid="$(pgrep -f -- "ibrdf_solve .*${sweep}/parts/${case}/" | head -n 1)" ||
      continue
    # Not its parent between fork and exec.
    [ "$(cat "/proc/${pid}/comm" 2>/dev/null)" = ibrdf_solve ] || continue
    echo "${case} ${pid}"
    return
  done
  return 1
}
# running_case NOT [new]: prints "CASE JOB" of a case under way other than NOT;
# with `new`, one that has not come to its solver and so cannot end meanwhile.
running_case() {
  local case last job
  for case in $(all_cases); do
    [ "${case}" != "$1" ] || continue
    last="$(tail -n 1 "${sweep}/parts/${case}/attempts.log" 2>/dev/null)" ||
      continue
    [[ "${last}" == *" begin" ]] || continue
    [ "${2:-}" != new ] || [ -z "$(find "${sweep}/parts/${case}" \
      -name solver.log 2>/dev/null)" ] || continue
    job="${last#*job=}"
    job="${job%% *}"
    [ "$(squeue -h -j "${job}" -o %T 2>/dev/null)" = RUNNING ] || continue
    echo "${case} ${job}"
    return
  done
  return 1
}
# wait_for WHAT COMMAND...: its output, once it succeeds; at most 5 minutes.
wait_for() {
  local what="$1" limit=$((SECONDS + 300)) answer
  shift
  while ! answer="$("$@")"; do
    [ "${SECONDS}" -lt "${limit}" ] || fail "no ${what} within 5 minutes"
    kill -0 "${workflow_pid}" 2>/dev/null ||
      fail "snakemake ended early; see ${work}/run1.txt"
    sleep 0.1
  done
  echo "${answer}"
}
at_least() { [ "$(count_finished)" -ge "$1" ]; }
identities() {  # of the given cases' rows: any rewrite changes them
  local case
  for case in "$@"; do
    stat -c '%n inode %i, written %y, %s bytes' \
      "${sweep}/rows/${case}.csv"
  done
}

say "start Slurm"
"${here}/start_slurm.sh" "${work}/slurm" >"${work}/start.txt" ||
  fail "Slurm does not start: $(cat "${work}/start.txt")"
# shellcheck disable=SC1091  # written by start_slurm.sh
source "${work}/slurm/env.sh"
again="$("${here}/start_slurm.sh" "${work}/slurm")"
[[ "${again}" == *"slurmd runs"* ]] ||
  fail "a second start_slurm.sh did not find what runs"
sinfo

say "sweep of ${num_cases} cases"
workflow slurm "${work}/slurm.yaml" >"${work}/run1.txt" 2>&1 &
workflow_pid=$!
wait_for "finished case" at_least 1 >/dev/null

victim="$(wait_for "solver" running_solver)"
killed="${victim% *}"
kill -9 "${victim#* }"
say "killed the solver of ${killed} (kill -9)"
victim="$(wait_for "other case" running_case "${killed}" new)"
cancelled="${victim% *}"
scancel "${victim#* }"
say "cancelled the job of ${cancelled} (scancel)"

wait_for "three finished cases" at_least 3 >/dev/null
wait_for "case under way" running_case none >"${work}/under_way.txt"
kill -9 "${workflow_pid}"
wait "${workflow_pid}" 2>/dev/null || true
workflow_pid=
mapfile -t before < <(finished)
identities "${before[@]}" >"${work}/before.txt"
jobs_left="$(squeue -h -t RUNNING | wc -l)"
say "killed snakemake (kill -9) with ${#before[@]} cases finished and" \
    "${jobs_left} jobs under way"

(workflow slurm "${work}/slurm.yaml" --unlock) >"${work}/unlock.txt" 2>&1 ||
  fail "snakemake --unlock: $(tail -n 3 "${work}/unlock.txt")"
(workflow slurm "${work}/slurm.yaml") >"${work}/run2.txt" 2>&1 ||
  fail "the second run; see ${work}/run2.txt"
say "the same command again: finished;" \
    "$(grep -c '^Submitted job' "${work}/run2.txt" || true) jobs submitted"

identities "${before[@]}" | cmp -s - "${work}/before.txt" ||
  fail "a finished case was written again"
for case in $(all_cases); do
  expected=1
  if [ "${case}" = "${killed}" ] || [ "${case}" = "${cancelled}" ]; then
    expected=2
  fi
  [ "$(attempts "${case}" begin)" -eq "${expected}" ] ||
    fail "${case}: computed $(attempts "${case}" begin) times, expected" \
         "${expected}"
done
[ "$(attempts "${killed}" signal_9)" -eq 1 ] ||
  fail "${killed}: its log does not tell of the killed solver"
say "rows of before were not touched; the two cases that were killed were" \
    "computed twice, all others once"

stat -c '%i %y' "${sweep}/results.csv" >"${work}/table.txt"
(workflow slurm "${work}/slurm.yaml") >"${work}/run3.txt" 2>&1 ||
  fail "the third run; see ${work}/run3.txt"
grep -q "Nothing to be done" "${work}/run3.txt" ||
  fail "the third run found something to do; see ${work}/run3.txt"
stat -c '%i %y' "${sweep}/results.csv" | cmp -s - "${work}/table.txt" ||
  fail "the third run wrote the table again"
say "a third run: nothing to be done"

(workflow slurm "${work}/other_seed.yaml" --dry-run) >"${work}/run4.txt" 2>&1
grep -qE "^case +${num_cases} " "${work}/run4.txt" ||
  fail "another seed does not recompute all cases; see ${work}/run4.txt"
say "another seed would compute all ${num_cases} cases"

(workflow local "${work}/local.yaml") >"${work}/local.txt" 2>&1 ||
  fail "the local profile; see ${work}/local.txt"
say "local profile: finished"

# What a time budget does not touch has to agree to the last digit: the name of
# the case, the baseline fitted to the rendered image, the constant map.
python3 - "${sweep}/results.csv" "${work}/local_out/small/results.csv" \
  "${materials[*]}" "${map_names[*]}" <<'PYTHON' || fail "the tables differ"
import csv
import sys

tables = []
for path in sys.argv[1:3]:
    with open(path, newline="") as file:
        tables.append(list(csv.DictReader(file)))
slurm, local = tables
wanted = sorted((m, k) for m in sys.argv[3].split() for k in sys.argv[4].split())
for name, table in (("slurm", slurm), ("local", local)):
    if [(row["material"], row["map"]) for row in table] != wanted:
        sys.exit(f"{name}: not each case once, in order")
    for row in table:
        # Within the second of its budget a solver may not get anywhere.
        if row["status"] not in ("ok", "no_improvement"):
            sys.exit(f"{name}: {row['material']}: status {row['status']}")
columns = [c for c in slurm[0]
           if c in ("material", "map", "geometry", "lobes", "method")
           or c.startswith(("cook_torrance_", "constant_map_"))]
for a, b in zip(slurm, local):
    for column in columns:
        if a[column] != b[column]:
            sys.exit(f"{a['material']} {a['map']} {column}: {a[column]} on "
                     f"Slurm, {b[column]} locally")
print(f"{len(wanted)} cases, each once, in both tables;",
      f"equal in {len(columns)} columns: {', '.join(columns)}")
PYTHON
say "PASSED"
