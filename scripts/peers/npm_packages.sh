#!/usr/bin/env bash
# Fetches packages from npm into ${MIEN_CACHE:-~/.cache/mien}/FOLDER, which has no other packages, unless they are there.
# usage: scripts/peers/npm_packages.sh FOLDER PACKAGE...        Needs npm (nodejs).
set -euo pipefail
work=${MIEN_CACHE:-$HOME/.cache/mien}/$1
[ ! -f "$work/node_modules/.package-lock.json" ] || exit 0  # npm writes it last: without it, an install was interrupted
command -v npm >/dev/null || { echo "npm_packages.sh: needs node and npm" >&2; exit 1; }
mkdir -p "$work"
cd "$work"
rm -rf node_modules
npm install --ignore-scripts --no-audit --no-fund "${@:2}"
