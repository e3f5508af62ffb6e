#!/usr/bin/env bash
# Families of another database left out in turn: trains on MERL and on the other
# families, then fits lobes of that flow to the tables of the family. Goes on
# where it was stopped.
#
#   families.sh MERL RGL OUT
#
# MERL, RGL: folders of .binary files (make_merl.py; RGL with --source rgl).
# Bins of RGL beyond 80 degrees are void: the networks behind them are not to be
# trusted there. OUT receives results.csv and the models: FAMILY.ibrdf has not
# seen the family. Fits with the default model and the baselines are there too.
set -euo pipefail

merl="$1" rgl="$2" out="$3"
bin="${IBRDF_BIN:-$(dirname "$0")/../../build/release/bin}"
steps="${STEPS:-24000}" lobes="${LOBES:-2}" threads="${THREADS:-1}"
# As in held_out.sh.
hard="black-obsidian,chrome-steel,red-metallic-paint,ss440"

# Comma-separated tables of RGL whose names begin so.
family() {
  find -L "${rgl}" -name '*.binary' -printf '%f\n' | sed 's/\.binary$//' |
    grep -E "^($1)" | sort | paste -sd, -
}

fit() {
  "${bin}/ibrdf_bench" merl-fit --data "${rgl}" --void-beyond 80 \
    --out "${out}" --threads "${threads}" --quiet "$@"
}

declare -A families=([felts]="acrylic_felt_" [papers]="paper_|cardboard"
  [wraps]="cc_|cg_|chm_|cm_" [paints]="aurora_|colodur_|ilm_|laika_")
mkdir -p "${out}"
for name in felts papers wraps paints; do
  materials=$(family "${families[${name}]}")
  model="${out}/${name}.ibrdf"
  if [ ! -e "${model}" ]; then
    "${bin}/ibrdf_train" --data "${merl}" --more-data "${rgl}" \
      --void-beyond 80 --leave-out "${hard},${materials}" --out "${model}" \
      --steps "${steps}" --threads "${threads}" --skip-lobes \
      > "${model%.ibrdf}.log" 2>&1
  fi
  fit --model "${model}" --methods flow,flow_lambertian --lobes "${lobes}" \
    --materials "${materials}"
  echo "${name}: done"
done
fit --methods flow,flow_lambertian --lobes "${lobes}"
fit --methods cook_torrance,dsbrdf --dsbrdf-lobes 3
