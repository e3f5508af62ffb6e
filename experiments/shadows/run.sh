#!/usr/bin/env bash
# Estimates from images with shadows or bounces, with and without them in the
# model.
# usage: experiments/shadows/run.sh DATA TABLES OUT
#   DATA    folder with meshes/*.obj and envmaps/*.hdr
#   TABLES  folder with MERL .binary files
#   OUT     images, estimates and results.csv
# BIN (folder of the programs), MODEL, MESHES, MATERIALS, MAPS, SECONDS_EACH,
# ROUNDS, THREADS, IMAGE (effects that the images show) and EFFECTS (those of
# the estimates) may be set in the environment.
set -euo pipefail
data=$(realpath "$1") tables=$(realpath "$2")
mkdir -p "$3"
out=$(realpath "$3")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
bin=${BIN:-$root/build/release/bin}
seconds=${SECONDS_EACH:-30}  # of an estimate of reflectance
rounds=${ROUNDS:-14}         # of one of light: the same for both models
model=${MODEL:-default}
threads=${THREADS:-0}

# Into the torus' hole; the side of the bunny, head and paws before its body.
torus="camera={type: perspective, fov_degrees: 32, from: [0, 1.6, 3.6]}"
bunny="camera={type: orthographic}"

csv=$out/results.csv
if [[ ! -e $csv ]]; then
  echo "problem,mesh,material,map,effects,simulated,seconds,misfit,brdf_log_rmse,brdf_log_rmse_below80,illumination_relative_log_rmse,illumination_relative_log_rmse_aligned" >"$csv"
fi

row() {  # FOLDER CASE...: one line from its result.json
  python3 - "$@" >>"$csv" <<'PY'
import json, sys
folder, *case = sys.argv[1:]
result = json.load(open(folder + "/result.json"))
m = result["metrics"]
names = ["seconds", "misfit", "brdf_log_rmse", "brdf_log_rmse_below80",
         "illumination_relative_log_rmse",
         "illumination_relative_log_rmse_aligned"]
plan = result["effects_plan"]
bounces = plan["interreflection"]["bounces"]
simulated = "%d-bounce" % bounces if bounces else plan["visibility"]["simulated"]
print(",".join(case + [str(simulated).lower()] +
               ["%.4f" % m[n] if m.get(n) is not None else "" for n in names]))
PY
}

solve() {  # PROBLEM MESH MATERIAL MAP EFFECTS KEY=VALUE...
  local problem=$1 mesh=$2 material=$3 map=$4 effects=$5
  local case=$mesh-$material-$map
  local to=$out/$case/$problem-$effects
  shift 5
  [[ -e $to/result.json ]] && return
  echo "$case: $problem, effects $effects"
  local status=0
  "$bin/ibrdf_solve" --problem "$out/$case/problem.yaml" --out "$to" \
    --threads "$threads" --seed 1 --set problem="$problem" \
    --set effects="$effects" "$@" >"$out/$case/$problem-$effects.log" || status=$?
  # 3: not better than its initial guess; a result all the same.
  [[ $status == 0 || $status == 3 ]] || return "$status"
  row "$to" "$problem" "$mesh" "$material" "$map" "$effects"
}

for mesh in ${MESHES:-torus bunny}; do
  for material in ${MATERIALS:-red-plastic green-latex}; do
    for map in ${MAPS:-studio}; do
      folder=$out/$mesh-$material-$map
      mkdir -p "$folder"
      cat >"$folder/scene.yaml" <<YAML
image: {width: 96, height: 96}
geometry: {mesh: $data/meshes/$mesh.obj}
reflectance: {known: $tables/$material.binary}
illumination: {known: $data/envmaps/$map.hdr, frame: ibrdf_0_1}
quality: reference
noise: 0.02
YAML
      cat >"$folder/problem.yaml" <<YAML
image: {file: input.exr, mask: mask.png}
geometry: {mesh: $data/meshes/$mesh.obj}
truth: {brdf: $tables/$material.binary, illumination: $data/envmaps/$map.hdr, frame: ibrdf_0_1}
solver: {seconds: $seconds}
YAML
      if [[ ! -e $folder/input.exr ]]; then
        "$bin/ibrdf_render" --scene "$folder/scene.yaml" --threads "$threads" \
          --seed 1 --set "${!mesh}" --set effects="${IMAGE:-visibility}" \
          --out "$folder/input.exr" --mask "$folder/mask.png"
      fi
      for effects in ${EFFECTS:-none visibility}; do
        solve reflectance "$mesh" "$material" "$map" "$effects" \
          --set "${!mesh}" --set reflectance.model="$model" \
          --set "illumination={known: $data/envmaps/$map.hdr, frame: ibrdf_0_1}"
        solve illumination "$mesh" "$material" "$map" "$effects" \
          --set "${!mesh}" --set solver.seconds=600 \
          --set solver.max_iterations="$rounds" \
          --set "illumination={width: 64, height: 32}" \
          --set "reflectance={known: $tables/$material.binary}"
      done
    done
  done
done
column -s, -t "$csv"
