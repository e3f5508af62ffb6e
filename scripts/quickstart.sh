#!/usr/bin/env bash
# From nothing to a first estimate: installs what is missing, builds the
# programs, renders a glossy sphere and estimates its reflectance and light.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "${project_dir}"

bin=build/release/bin
out=out/sphere
mkdir -p "${out}"

step "Install missing packages" scripts/install_dependencies.sh
step "Configure" cmake --preset release -DIBRDF_BUILD_TESTS=OFF
step "Build" cmake --build --preset release -j "$(nproc)" \
  --target ibrdf_render ibrdf_solve ibrdf_eval
step "Render the input" "${bin}/ibrdf_render" \
  --scene examples/sphere/scene.yaml \
  --out "${out}/input.exr" --mask "${out}/mask.png" \
  --illumination-out "${out}/truth_illumination.exr" \
  --brdf-out "${out}/truth_brdf.binary"
step "Estimate reflectance and illumination" "${bin}/ibrdf_solve" \
  --problem examples/sphere/joint.yaml --out "${out}"

echo
echo "Done in ${SECONDS} s. Pictures to look at:"
for picture in report.html overview.png input.png render.png residual.png \
               illumination.png brdf.png; do
  if [ -f "${out}/${picture}" ]; then
    echo "  ${project_dir}/${out}/${picture}"
  fi
done
