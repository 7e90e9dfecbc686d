#!/usr/bin/env bash
# Builds the documentation as a site, build/site/html. A link without a target is an error.
# usage: scripts/site.sh [serve]      serve: also serves it on http://localhost:8000
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh docs
site=build/site

[ -x $site/venv/bin/pip ] || /usr/bin/python3 -m venv $site/venv
$site/venv/bin/pip install --quiet --disable-pip-version-check -r scripts/package/site_requirements.txt
rm -rf $site/pages $site/html
mkdir -p $site/pages/docs
git ls-files -z '*.md' 'docs/*' 'include/*' 'apps/examples/*' 'bindings/*/sample/*' 'bindings/*/Examples/*' '*.d.ts' |
  xargs -0 cp --parents -t $site/pages
# In tables, GitHub requires a backslash before a pipe in code; Python-Markdown would display it.
find $site/pages -name '*.md' -exec sed -i '/^|/s/\\|/|/g' {} +
doxygen docs/Doxyfile
# Not --quiet, which would hide the warnings that --strict turns into errors.
NO_MKDOCS_2_WARNING=1 $site/venv/bin/mkdocs build --strict --config-file docs/mkdocs.yml
if grep -rlF --include='*.html' '\|' $site/html/docs; then
  echo "site.sh: these pages show a backslash before a pipe" >&2
  exit 1
fi
echo "$(find $site/html -name '*.html' | wc -l) pages in $site/html"
[ "${1:-}" != serve ] || exec $site/venv/bin/python -m http.server --directory $site/html 8000
