#!/usr/bin/env bash
# Builds the documents as a site in build/site, with the reference of the C++
# library in build/site/api. Installs what is missing.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cd "${project_dir}"

step "Install missing packages" install_packages mkdocs doxygen
step "Check the links" docs/check_links.py
step "Build the site" mkdocs build --quiet --strict
step "Build the C++ reference" doxygen docs/Doxyfile
echo "The site starts at build/site/index.html"
