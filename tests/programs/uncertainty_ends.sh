#!/bin/bash
# ibrdf_uncertainty as a user runs it: files, statuses, and cameras that
# ibrdf_render takes back.
#
#     tests/programs/uncertainty_ends.sh IBRDF_UNCERTAINTY IBRDF_RENDER
set -euo pipefail
uncertainty=$(realpath "$1")
render=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "${work}"' EXIT
cd "${work}"
fail() { echo "FAILED: $*" >&2; exit 1; }

light='illumination: {width: 32, height: 16, known: {sky: {}}}'
front='camera: {type: perspective, fov_degrees: 32, from: [0, 0, 4]}'
side='camera: {type: perspective, fov_degrees: 32, from: [4, 0, 0]}'
cat >scene.yaml <<SCENE
image: {width: 24, height: 24}
geometry: {sphere: {}}
reflectance: {known: {principled: {roughness: 0.5}}}
${light}
views: [{name: front, ${front}}, {name: side, ${side}}]
quality: preview
SCENE
cat >views.yaml <<VIEWS
problem: textures
geometry: {sphere: {}}
${light}
views:
  - {name: front, file: renders/views/front/render.exr, ${front}}
  - {name: side, file: renders/views/side/render.exr, ${side}}
texture: {width: 24, height: 12}
VIEWS
"${render}" --scene scene.yaml --quiet --out renders

refused() {  # refused WORD ARGUMENT...: with status 2, a line and no result
  local word=$1 code=0
  shift
  timeout 30 "${uncertainty}" --quiet --out none "$@" 2>words || code=$?
  [ "${code}" -eq 2 ] || fail "$*: status ${code}"
  [ "$(wc -l <words)" -eq 1 ] || fail "$*: $(cat words)"
  grep -qF -- "${word}" words || fail "$*: $(cat words)"
  [ ! -e none/result.json ] || fail "$*: a result"
}
refused 'problem: expected textures' --problem scene.yaml
refused 'geometry: expected' --problem views.yaml \
  --set 'geometry={normals: renders/views/front/render.exr}'
refused 'expected one that sees' --problem views.yaml --set \
  "views=[{name: a, file: renders/views/front/render.exr, camera: {type: perspective, from: [0, 0, 4], to: [0, 0, 8]}}]"
refused --candidates --problem views.yaml --add 1 --candidates sphere:0
code=0
"${render}" --scene views.yaml --quiet --out other 2>words || code=$?
[ "${code}" -eq 2 ] && grep -qF "ibrdf_uncertainty" words ||
  fail "ibrdf_render: $(cat words)"

"${uncertainty}" --problem views.yaml --out map --add 2 --candidates sphere:8 \
  >told
grep -q 'next view: candidate_' told || fail "$(cat told)"
for file in entropy.exr entropy.png alpha.exr ks.exr below_band_limit.png \
  observed_views.exr next_views.json result.json report.html \
  views/front/entropy.exr views/side/entropy.png; do
  [ -s "map/${file}" ] || fail "no ${file}"
done
# The same cameras as COLMAP has them, x right, y down, z forward: what a list
# of views says.
mkdir sparse photos
cp renders/views/front/render.exr photos/front.exr
cp renders/views/side/render.exr photos/side.exr
cat >sparse/cameras.txt <<CAMERAS
# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]
1 SIMPLE_PINHOLE 24 24 41.848973 12 12
CAMERAS
cat >sparse/images.txt <<IMAGES
1 0 1 0 0 0 0 4 1 front.exr

2 0 0.70710678 0 -0.70710678 0 0 4 1 side.exr

IMAGES
"${uncertainty}" --problem views.yaml --out of_colmap \
  --set 'views={colmap: sparse, images: photos}' >told_of_colmap
[ "$(head -1 told)" = "$(head -1 told_of_colmap)" ] ||
  fail "$(cat told told_of_colmap)"
sed -i 's/SIMPLE_PINHOLE 24 24 41.848973 12 12/OPENCV 24 24 42 42 12 12 0 0 0 0/' \
  sparse/cameras.txt
refused 'cameras.txt: camera 1: expected PINHOLE' --problem views.yaml \
  --set 'views={colmap: sparse, images: photos}'
# A sphere hides no light from itself.
"${uncertainty}" --problem views.yaml --out open \
  --set uncertainty.shadows=none >told_open
cmp map/entropy.exr open/entropy.exr

"${render}" --scene scene.yaml --quiet --out next \
  --set 'views={transforms: map/next_views.json}'
[ "$(ls next/views | wc -l)" -eq 2 ] || fail "$(ls next/views)"
