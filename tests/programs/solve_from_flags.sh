#!/usr/bin/env bash
# solve_from_flags.sh SOLVE RENDER: a photograph on the command line, the file that it makes, and the look before.
set -euo pipefail
solve=$(realpath "$1") render=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "FAILED: $*" >&2; exit 1; }

cat > scene.yaml <<'YAML'
image: {width: 24, height: 24}
geometry: {sphere: {}}
reflectance: {known: {cook_torrance: {diffuse: 0.3}}}
illumination: {known: {sky: {}}, width: 64, height: 32}
quality: preview
noise: 0.02
YAML
"$render" --quiet --scene scene.yaml --out "it's #1.exr" --mask 'a mask.png' --illumination-out map.exr
photo=("it's #1.exr" --mask 'a mask.png' --known-light map.exr --threads 1)

"$solve" "${photo[@]}" --check --out 'a check' > said.txt
grep -q 'no --normals and no --mesh: the object is taken for a sphere' said.txt || fail "the sphere is not said"
grep -q '^  its pixels .* used; 0 clipped' said.txt || fail "pixels are not counted"
for file in check.png check.json problem.yaml; do [[ -s "a check/$file" ]] || fail "no $file"; done
[[ ! -e 'a check/result.json' ]] || fail "--check solved"

# The file that the flags make gives the same bits, from anywhere.
"$solve" "${photo[@]}" --quiet --out one --set solver.max_iterations=3 2> /dev/null || [[ $? == 3 ]]
[[ $(head -c 30 one/problem.yaml) == '# Made by: '* ]] || fail "the file does not begin with the command"
(cd / && "$solve" --problem "$folder/one/problem.yaml" --quiet --threads 1 --out "$folder/two" 2> /dev/null) || [[ $? == 3 ]]
for file in brdf.binary render.exr; do cmp "one/$file" "two/$file" || fail "$file differs"; done
grep -q '"check": {' two/result.json || fail "result.json has no check"

# One or the other.
status=0
"$solve" "${photo[@]}" --problem one/problem.yaml 2> error.txt || status=$?
[[ $status == 2 ]] || fail "status $status of both"
grep -q 'command line: --problem: expected either' error.txt || fail "both: $(cat error.txt)"
# A file of the user's own stays.
mkdir mine && echo 'image: {file: x.exr}' > mine/problem.yaml
status=0
"$solve" "${photo[@]}" --check --out mine > /dev/null 2> error.txt || status=$?
[[ $status == 2 ]] || fail "status $status of a file of one's own"
[[ $(cat mine/problem.yaml) == 'image: {file: x.exr}' ]] || fail "a file of one's own was replaced"
