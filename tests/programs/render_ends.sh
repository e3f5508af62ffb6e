#!/bin/bash
# How ibrdf_render ends where it cannot or must not finish: at once, with a
# status and one line that say why, and nothing half-done.
#
#     tests/programs/render_ends.sh IBRDF_RENDER
set -euo pipefail
render=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "${work}"' EXIT
cd "${work}"
fail() { echo "FAILED: $*" >&2; exit 1; }

# Minutes long but for `quick`.
cat >scene.yaml <<'SCENE'
image: {width: 2048, height: 2048}
geometry: {sphere: {}}
reflectance: {known: {cook_torrance: {roughness: 0.2}}}
illumination: {known: {sky: {}}, width: 128, height: 64}
effects: none
SCENE
quick=(--quality preview --set image.width=8 --set image.height=8)

refused() {  # refused WORD ARGUMENT...: with status 2, a line and no render
  local word=$1 code=0
  shift
  timeout 30 "${render}" --scene scene.yaml --quiet "$@" 2>words || code=$?
  [ "${code}" -eq 2 ] || fail "$*: status ${code}"
  [ "$(wc -l <words)" -eq 1 ] || fail "$*: $(cat words)"
  grep -qF -- "${word}" words || fail "$*: $(cat words)"
}

# Paths that cannot be written are known before the render.
mkdir -p folder.exr
refused folder.exr --out folder.exr
refused words: --out words/out.exr
if [ "$(id -u)" -ne 0 ]; then
  mkdir -p locked
  chmod 500 locked
  refused locked --out locked/out.exr
fi

# And so are those of what the scene is made from.
"${render}" --scene scene.yaml --quiet "${quick[@]}" --out small.exr \
  --illumination-out map.exr
cp map.exr copy.exr
known=(--set 'illumination={known: map.exr}')
refused illumination.known "${known[@]}" --out map.exr
refused illumination.known "${known[@]}" --out out.exr \
  --illumination-out ./map.exr
cmp map.exr copy.exr || fail "an input was changed"

# Several views go to a folder, each to its own.
views=(--set 'views=[{name: a}, {name: b, camera: {type: perspective}}]')
refused --out "${quick[@]}" "${views[@]}" --out views.exr
refused --mask "${quick[@]}" "${views[@]}" --out views --mask mask.png
"${render}" --scene scene.yaml --quiet "${quick[@]}" "${views[@]}" --out views \
  --brdf-out views/brdf.binary
for view in a b; do
  for file in render.exr render.png mask.png; do
    [ -s "views/views/${view}/${file}" ] || fail "no ${file} of view ${view}"
  done
done
[ -s views/brdf.binary ] || fail "no BRDF of the views"
"${render}" --scene scene.yaml --quiet "${quick[@]}" --out a.exr
cmp a.exr views/views/a/render.exr || fail "a view is not its render"

# A signal ends a render with nothing written.
for signal in INT TERM; do
  timeout 60 "${render}" --scene scene.yaml --quiet --threads 1 \
    --out "${signal}/out.exr" 2>words &
  sleep 1.5
  kill -s "${signal}" "$(pgrep -P $!)"
  code=0
  wait $! || code=$?
  [ "${code}" -eq 130 ] || fail "${signal}: status ${code}"
  [ -z "$(ls "${signal}")" ] || fail "${signal}: left $(ls "${signal}")"
  grep -q interrupted words || fail "${signal}: $(cat words)"
done
