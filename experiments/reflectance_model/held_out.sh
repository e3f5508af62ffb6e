#!/usr/bin/env bash
# Held-out fits: ten folds, each trained without a tenth of the materials, whose
# tables are then fitted by lobes of that flow. Goes on where it was stopped.
#
#   held_out.sh TABLES OUT [SHARE [SEED [SCORE_TABLES]]]
#
# TABLES: folder of MERL .binary files. SHARE: per cent of the other materials
# that train (100). SEED: of the folds' order, of what is dropped below 100 %
# and of the training (1). SCORE_TABLES: tables that each fit is scored on too.
# OUT receives results.csv (the model column says the share) and the models.
# MORE_DATA=DIR trains on all tables of another folder too, whose bins beyond
# VOID_BEYOND degrees (80) are void. FOLDS="0 1" makes these folds alone,
# METHODS=flow,flow_lambertian fits with a Lambertian lobe too, and SKIP_LOBES=1
# leaves the prior of joint estimates out of the models.
set -euo pipefail

tables="$1" out="$2" share="${3:-100}" seed="${4:-1}" score="${5:-}"
bin="${IBRDF_BIN:-$(dirname "$0")/../../build/release/bin}"
steps="${STEPS:-14000}" lobes="${LOBES:-2}" threads="${THREADS:-1}"
# Tables that sit on their floor over part of the domain: no mean counts them.
hard="black-obsidian|chrome-steel|red-metallic-paint|ss440"

# Names in an order that depends on the seed and the names alone.
shuffled() {
  while read -r name; do
    printf '%s %s\n' "$(printf '%s %s' "$1" "${name}" | md5sum | cut -c1-16)" \
      "${name}"
  done | sort | cut -d' ' -f2
}

mkdir -p "${out}"
mapfile -t all < <(find -L "${tables}" -name '*.binary' -printf '%f\n' |
  sed 's/\.binary$//' | sort)
mapfile -t hard_here < <(printf '%s\n' "${all[@]}" | grep -xE "${hard}")
mapfile -t names < <(printf '%s\n' "${all[@]}" | grep -vxE "${hard}" |
  shuffled "fold ${seed}")
more=()
if [ -n "${MORE_DATA:-}" ]; then
  more=(--more-data "${MORE_DATA}" --void-beyond "${VOID_BEYOND:-80}")
fi
for fold in ${FOLDS:-0 1 2 3 4 5 6 7 8 9}; do
  held=() others=()
  for i in "${!names[@]}"; do
    if [ $((i % 10)) -eq "${fold}" ]; then
      held+=("${names[i]}")
    else
      others+=("${names[i]}")
    fi
  done
  keep=$(((${#others[@]} * share + 50) / 100))
  mapfile -t dropped < <(printf '%s\n' "${others[@]}" |
    shuffled "share ${seed} ${fold}" | tail -n +$((keep + 1)))
  leave_out=$(printf '%s\n' "${hard_here[@]}" "${held[@]}" "${dropped[@]}" |
    sed '/^$/d' | paste -sd, -)
  model="${out}/fold${fold}/trained-on-${share}.ibrdf"
  mkdir -p "${out}/fold${fold}"
  if [ ! -e "${model}" ]; then
    "${bin}/ibrdf_train" --data "${tables}" "${more[@]}" --out "${model}" \
      --leave-out "${leave_out}" --steps "${steps}" --seed "${seed}" \
      --threads "${threads}" ${SKIP_LOBES:+--skip-lobes} \
      > "${model%.ibrdf}.log" 2>&1
  fi
  materials=$(IFS=,; echo "${held[*]}")
  "${bin}/ibrdf_bench" merl-fit --data "${tables}" --out "${out}" \
    --model "${model}" --methods "${METHODS:-flow}" --lobes "${lobes}" \
    --materials "${materials}" --threads "${threads}" --seed "${seed}" \
    ${score:+--score-data "${score}"} --quiet
  echo "fold ${fold}, trained on ${keep} materials: done"
done
