#!/usr/bin/env bash
# Builds the release of HEAD twice, in clones with paths of different length and without a compiler cache, and compares the files.
# usage: scripts/package/check_reproducible.sh [-DCMAKE_OPTION]... [PART]...      parts of release.sh, default: all
set -euo pipefail
cd "$(dirname "$0")/../.."
options=()
while [[ "${1:-}" == -D* ]]; do
  options+=("$1")
  shift
done
scripts/setup.sh build release web
export CCACHE_DISABLE=1

work=$PWD/build/reproducible
rm -rf "$work"
for clone in "$work/a" "$work/at/a/deeper/place"; do
  git clone --quiet . "$clone"
  (cd "$clone" && scripts/package/release.sh -o "$work/files-${#clone}" "${options[@]}" "$@" >/dev/null)
done
cat "$work"/files-*/SHA256SUMS | sort | uniq --unique >"$work/different"
if [ -s "$work/different" ]; then
  echo "check_reproducible.sh: the files differ:" >&2
  cut -d' ' -f3 "$work/different" | sort -u >&2
  exit 1
fi
echo "identical files:"
cat "$work/files-${#clone}/SHA256SUMS"
