#!/usr/bin/env bash
# tests/fuzz/run.sh SECONDS [PARSER...]: fuzzes each parser (default: all) for
# that long, one after another, from seeds and what earlier runs kept in
# build/fuzz/corpus. One line a parser: executions, features covered, findings.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=build/fuzz/bin
corpus=build/fuzz/corpus
seconds=${1:?usage: tests/fuzz/run.sh SECONDS [PARSER...]}
shift
parsers=("$@")
if [ ${#parsers[@]} -eq 0 ]; then
  parsers=(exr hdr png merl obj ply problem model)
fi
mkdir -p build/fuzz/findings
"${bin}/fuzz_seeds" "${corpus}"
for parser in "${parsers[@]}"; do
  log=build/fuzz/${parser}.log
  # Memory: an image of the largest size that is accepted takes 0.8 GiB. Time: a
  # whole MERL table takes half a second, and much more on a busy machine.
  status=0
  nice -n 15 "${bin}/fuzz_${parser}" -max_total_time="${seconds}" \
    -max_len=16384 -timeout=120 -rss_limit_mb=2560 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/findings/${parser}-" \
    "${corpus}/${parser}" > "${log}" 2>&1 || status=$?
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "${log}")
  features=$(grep -o 'ft: [0-9]*' "${log}" | tail -n 1 | cut -c5- || true)
  echo "${parser}: ${executions:-0} executions, ${features:-0} features," \
       "exit status ${status}"
done
