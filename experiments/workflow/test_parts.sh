#!/usr/bin/env bash
# The workflow with a stand-in for ibrdf_bench, in seconds: what run_case.sh
# and gather_rows.py promise, then the local profile (where snakemake is
# installed). test_workflow.sh runs the real programs on Slurm.
#   test_parts.sh
# Exit status: 0 passed, 1 failed, 77 skipped for want of Python or snakemake
# after the rest passed.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
work="$(mktemp -d "${TMPDIR:-/tmp}/ibrdf_parts.XXXXXX")"
trap 'rm -rf "${work}"' EXIT
cd "${work}"

fail() { echo "FAILED: $*" >&2; exit 1; }
if ! command -v python3 >/dev/null; then
  echo "SKIPPED: no python3" >&2
  exit 77
fi

# The stand-in: lists cases, or appends a row unless there is one. The first
# estimate of the material `killed` is killed; `calls` counts estimates.
mkdir bin data maps
touch data/{plain,killed}.binary maps/{dusk,night_2k}.hdr
cat >bin/ibrdf_bench <<'BENCH'
#!/usr/bin/env bash
set -euo pipefail
shift
dry=0 materials=plain,killed maps=dusk,night_2k seed=1 priors=
while [ "$#" -gt 0 ]; do
  case "$1" in
    --dry-run) dry=1; shift; continue ;;
    --out) out="$2" ;;
    --data) data="$2" ;;
    --materials) materials="$2" ;;
    --map-names) maps="$2" ;;
    --maps) folder="$2" ;;
    --seed) seed="$2" ;;
    --priors) priors="$2" ;;
  esac
  shift 2
done
for m in ${materials//,/ }; do
  for k in ${maps//,/ }; do
    if [ "${dry}" -eq 1 ]; then
      runs="${priors:-estimate}"
      for p in ${runs//,/ }; do
        printf '%s\t%s\t%s\t%s\n' "${m}_${k}" "${data}/${m}.binary" \
          "${folder}/${k}.hdr" "${p}"
      done
      continue
    fi
    # One row a prior; the material `killed` loses the last one's once.
    for p in ${priors//,/ }; do
      table="${out}/results.csv"
      [ -f "${table}" ] || echo 'material,map,prior,status' >"${table}"
      ! grep -q "^${m},${k},${p}," "${table}" || continue
      echo "${m} ${k} ${p}" >>"${CALLS}"
      status=ok
      if [ "${m},${p}" = killed,none ] && [ ! -f "${out}/was_killed" ]; then
        status=signal_9
        touch "${out}/was_killed"
      fi
      echo "${m},${k},${p},${status}" >>"${table}"
    done
    [ -z "${priors}" ] || continue
    [ ! -f "${out}/results.csv" ] || continue
    echo "${m} ${k} ${seed}" >>"${CALLS}"
    status=ok
    if [ "${m}" = killed ] && [ ! -f "${out}/was_killed" ]; then
      status=signal_9
      touch "${out}/was_killed"
    fi
    printf 'material,map,status,seed\n%s,%s,%s,%s\n' "${m}" "${k}" \
      "${status}" "${seed}" >"${out}/results.csv"
  done
done
BENCH
chmod +x bin/ibrdf_bench
export CALLS="${work}/calls"
calls() { grep -c . "${CALLS}" || true; }
: >"${CALLS}"

run_case() {  # run_case MATERIAL SEED
  local settings="joint --materials $1 --map-names dusk --seed $2" words
  read -ra words <<<"${settings}"
  "${here}/run_case.sh" "one/$1.csv" 1 "one/parts/$1" "${settings}" \
    "data/$1.binary" maps/dusk.hdr bin/ibrdf_bench "${words[@]}" \
    --data data --maps maps --threads 1
}
run_case plain 1
grep -qx 'plain,dusk,ok,1' one/plain.csv || fail "no row of a case"
rm one/plain.csv
run_case plain 1
[ "$(calls)" -eq 1 ] || fail "a finished case was computed again"
grep -qx 'plain,dusk,ok,1' one/plain.csv || fail "a kept row did not come back"
run_case plain 2
grep -qx 'plain,dusk,ok,2' one/plain.csv || fail "other settings, the old row"
touch -d '1 hour' data/plain.binary
run_case plain 2
[ "$(calls)" -eq 3 ] || fail "a newer table, the old row"
touch -d '1 hour ago' data/plain.binary
run_case killed 1 2>/dev/null && fail "a killed solver passed for a result"
[ ! -e one/killed.csv ] || fail "a killed solver left a row"
run_case killed 1
grep -qx 'killed,dusk,ok,1' one/killed.csv || fail "no row after a second try"

# Two runs a case: the one that was finished is not computed again.
run_both() {  # run_both MATERIAL
  local settings="joint --materials $1 --map-names dusk --priors unet,none"
  local words
  read -ra words <<<"${settings}"
  "${here}/run_case.sh" "one/$1.both.csv" 2 "one/both/$1" "${settings}" \
    "data/$1.binary" maps/dusk.hdr bin/ibrdf_bench "${words[@]}" \
    --data data --maps maps --threads 1
}
: >"${CALLS}"
run_both killed 2>/dev/null && fail "half a case passed for a result"
[ ! -e one/killed.both.csv ] || fail "half a case left rows"
run_both killed
diff one/killed.both.csv - <<'TABLE' || fail "the rows of both runs"
material,map,prior,status
killed,dusk,unet,ok
killed,dusk,none,ok
TABLE
[ "$(calls)" -eq 3 ] || fail "$(calls) runs of 2, one of them killed"

gather="${here}/gather_rows.py"
mkdir rows
printf 'status,map,material,extra\nok,b,y,7\n' >rows/1.csv
printf 'material,map,prior,status\nx,c,none,ok\nx,c,unet,ok\n' >rows/4.csv
"${gather}" rows joined.csv
diff joined.csv - <<'TABLE' || fail "a file of two rows is joined wrongly"
material,map,prior,status,extra
x,c,none,ok,
x,c,unet,ok,
y,b,,ok,7
TABLE
rm rows/4.csv
printf 'material,map,status\nx,c,ok\n' >rows/2.csv
"${gather}" rows joined.csv
diff joined.csv - <<'TABLE' || fail "columns or rows are joined wrongly"
material,map,status,extra
x,c,ok,
y,b,ok,7
TABLE
cp rows/2.csv rows/3.csv
"${gather}" rows joined.csv 2>/dev/null && fail "a case twice was accepted"
printf 'material,map,status\nx,d\n' >rows/3.csv
"${gather}" rows joined.csv 2>message && fail "a cut row was accepted"
grep -q rows/3.csv message || fail "the message does not name the file"
grep -q '^y,b' joined.csv || fail "a failure harmed the table"

if ! command -v snakemake >/dev/null; then
  echo "SKIPPED: no snakemake; scripts/install_workflow.sh installs it" >&2
  exit 77
fi
config() {
  cat <<CONFIG
{bin: bin, data: data, maps: maps, out: all,
 resources: {threads: 1, mem_mb: 10, runtime: 1},
 sweeps: {tiny: {experiment: joint, flags: {seed: $1}}}}
CONFIG
}
sweep() {
  snakemake --snakefile "${here}/Snakefile" --profile "${here}/profiles/local" \
    --configfile config.yaml >log 2>&1
}
: >"${CALLS}"
config 1 >config.yaml
sweep || fail "the sweep: $(tail -n 20 log)"
[ "$(calls)" -eq 6 ] || fail "$(calls) estimates of 4 cases, 2 of them killed"
diff all/tiny/results.csv - <<'TABLE' || fail "the table of the sweep"
material,map,status,seed
killed,dusk,ok,1
killed,night_2k,ok,1
plain,dusk,ok,1
plain,night_2k,ok,1
TABLE
rm all/tiny/rows/plain/dusk.csv
sweep || fail "the second run: $(tail -n 20 log)"
[ "$(calls)" -eq 6 ] || fail "a kept case was computed again"
config 2 >config.yaml
sweep || fail "another seed: $(tail -n 20 log)"
[ "$(calls)" -eq 10 ] || fail "another seed did not compute every case"
grep -qx 'plain,dusk,ok,2' all/tiny/results.csv || fail "rows of the old seed"
cat >config.yaml <<'CONFIG'
{bin: bin, data: data, maps: maps, out: all,
 resources: {threads: 1, mem_mb: 10, runtime: 1},
 sweeps: {both: {experiment: known-brdf, flags: {priors: "unet,none"}}}}
CONFIG
: >"${CALLS}"
sweep || fail "the sweep of two runs a case: $(tail -n 20 log)"
[ "$(calls)" -eq 10 ] || fail "$(calls) runs of 8, 2 of them killed"
[ "$(grep -c ,ok all/both/results.csv)" -eq 8 ] || fail "rows of both runs"
echo "passed"
