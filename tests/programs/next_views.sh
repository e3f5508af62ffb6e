#!/bin/bash
# ibrdf_solve --add as a user runs it: files, statuses, candidates of a file,
# and cameras that ibrdf_render takes back.
#
#     tests/programs/next_views.sh IBRDF_SOLVE IBRDF_RENDER
set -euo pipefail
solve=$(realpath "$1")
render=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "${work}"' EXIT
cd "${work}"
fail() { echo "FAILED: $*" >&2; exit 1; }

camera='camera: {type: perspective, fov_degrees: 32, from: [0, 0, 4]}'
cat >scene.yaml <<SCENE
image: {width: 12, height: 12}
geometry: {sphere: {}}
${camera}
reflectance: {known: {cook_torrance: {diffuse: 0.3, specular: 0.5, roughness: 0.3, f0: 0.05}}}
illumination: {width: 32, height: 16, known: {sky: {}}}
SCENE
cat >joint.yaml <<JOINT
problem: joint
image: {file: photo.exr}
geometry: {sphere: {}}
${camera}
reflectance: {model: default, variation: none}
illumination: {width: 32, height: 16}
solver: {max_iterations: 1, seconds: 1000}
JOINT
pose() {  # pose NAME AXES Z: a frame whose camera stands on the z axis
  echo "{\"file_path\": \"$1\", \"transform_matrix\": [[$2,0,0,0],[0,1,0,0],[0,0,$2,$3],[0,0,0,1]]}"
}
lens='"camera_angle_x": 0.56'
echo "{${lens}, \"frames\": [$(pose front.exr 1 4), $(pose back.exr -1 -4), $(pose away.exr -1 4), $(pose inside.exr 1 0)]}" >candidates.json
echo "{${lens}, \"frames\": [$(pose away.exr -1 4)]}" >blind.json
"${render}" --scene scene.yaml --quiet --out photo.exr

refused() {  # refused WORD ARGUMENT...: with status 2, a line and no result
  local word=$1 code=0
  shift
  timeout 60 "${solve}" --quiet --out none --problem joint.yaml "$@" 2>words ||
    code=$?
  [ "${code}" -eq 2 ] || fail "$*: status ${code}"
  [ "$(wc -l <words)" -eq 1 ] || fail "$*: $(cat words)"
  grep -qF -- "${word}" words || fail "$*: $(cat words)"
  [ ! -e none ] || fail "$*: a result"
}
refused --candidates --add 1 --candidates sphere:x
refused 'a camera that sees the object' --add 1 --candidates blind.json
refused 'none.json' --add 1 --candidates none.json
refused 'problem: expected joint' --add 1 --set problem=reflectance \
  --set 'illumination={known: {sky: {}}, width: 32, height: 16}'

"${solve}" --problem joint.yaml --out out --add 2 --candidates candidates.json \
  >told
grep -q 'next view: back, adds' told || fail "$(cat told)"
# The other side first; of the two that remain and see the object one has it
# around itself.
grep -q '"candidate": "back"' out/result.json || fail "no view in result.json"
grep -q 'photographs to take next' out/report.html || fail "the page"
grep -v '^camera' scene.yaml >from_next.yaml
"${render}" --scene from_next.yaml --quiet --out again \
  --set 'views={transforms: out/next_views.json}' ||
  fail "cameras that ibrdf_render refuses"
[ -e again/views/back/render.exr ] || fail "no render of the view"

# A run that chooses nothing leaves no cameras of an earlier one.
"${solve}" --quiet --problem joint.yaml --out out --set problem=illumination \
  --set 'reflectance={known: {cook_torrance: {diffuse: 0.3, specular: 0.5, roughness: 0.3, f0: 0.05}}}'
[ ! -e out/next_views.json ] || fail "next_views.json of another run"
grep -q '"next_views": {}' out/result.json || fail "views of nobody's asking"
