#!/usr/bin/env bash
# tests/fuzz/run.sh AMOUNT [PARSER...]: fuzzes each parser (default: all, the
# quickest first), one after another, from seeds and what earlier runs kept in
# build/fuzz/corpus. AMOUNT is a time for each, as 300s, or a number of
# executions: those that executions.csv counts of earlier runs are left out.
# Prints and adds to executions.csv by parser: executions, seconds, features
# covered, and findings (build/fuzz/findings), at one of which a parser ends.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=build/fuzz/bin
corpus=build/fuzz/corpus
table=tests/fuzz/executions.csv
slice=600  # seconds; what an interruption loses at most
amount=${1:?usage: tests/fuzz/run.sh SECONDSs|EXECUTIONS [PARSER...]}
shift
parsers=("$@")
if [ ${#parsers[@]} -eq 0 ]; then
  parsers=(checkpoint results trace hdr merl npy pfm exif icc stl png photo_png
           photo_jpeg photo_tiff depth normals colmap_binary colmap_text
           transforms ply model obj exr photo_exr map
           glb config flags problem)
fi
# What the seeds take and more.
declare -A max_len=(
  [checkpoint]=256 [colmap_binary]=1024 [colmap_text]=512 [config]=1024 [depth]=2048 [exif]=512 [exr]=4096 [flags]=1024
  [glb]=4096 [hdr]=1024 [icc]=2048 [map]=2048 [merl]=1200 [model]=4096 [normals]=2048
  [npy]=512 [obj]=1024 [pfm]=512 [photo_exr]=4096 [photo_jpeg]=2048 [photo_png]=2048
  [photo_tiff]=4096 [ply]=1024 [png]=1024 [problem]=2048 [results]=512 [stl]=1024
  [trace]=1024 [transforms]=1024)
mkdir -p build/fuzz/findings
[ -f "${table}" ] || echo "parser,executions,seconds,features,findings" > "${table}"
# What is freed goes to the system soon: small inputs, large tables of libraries.
export ASAN_OPTIONS=quarantine_size_mb=8:malloc_context_size=8

# column PARSER NUMBER: of the table; 0 where it has no row.
column() {
  awk -F, -v parser="$1" -v c="$2" '$1 == parser { v = $c } END { print v + 0 }' "${table}"
}

# fuzz PARSER SECONDS EXECUTIONS: up to either; adds to the table.
fuzz() {
  local parser=$1 log=build/fuzz/$1.log status=0 begin=$SECONDS row
  # Memory: what a file of a few kilobytes may claim at once.
  nice -n 19 "${bin}/fuzz_${parser}" -max_total_time="$2" -runs="$3" \
    -max_len="${max_len[${parser}]}" -timeout=60 -rss_limit_mb=2048 \
    -malloc_limit_mb=128 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/findings/${parser}-" \
    "${corpus}/${parser}" > "${log}" 2>&1 || status=$?
  row=${parser},$(($(column "${parser}" 2) +
    $(awk '/number_of_executed_units/ { n = $2 } END { print n + 0 }' "${log}")))
  row+=,$(($(column "${parser}" 3) + SECONDS - begin))
  row+=,$(grep -o 'ft: [0-9]*' "${log}" | tail -n 1 | cut -c5- || true)
  row+=,$(find build/fuzz/findings -name "${parser}-*" | wc -l)
  (
    flock 9  # other runs, of other parsers
    { grep -v "^${parser}," "${table}"; echo "${row}"; } > "${table}.new"
    mv "${table}.new" "${table}"
  ) 9> build/fuzz/table.lock
  echo "${row}"
  return "${status}"
}

"${bin}/fuzz_seeds" "${corpus}"
found=0
for parser in "${parsers[@]}"; do
  if [ "${amount%s}" != "${amount}" ]; then
    fuzz "${parser}" "${amount%s}" -1 || found=1
    continue
  fi
  while left=$((amount - $(column "${parser}" 2))) && [ "${left}" -gt 0 ]; do
    fuzz "${parser}" "${slice}" "${left}" || { found=1; break; }
  done
done
exit "${found}"
