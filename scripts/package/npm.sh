#!/usr/bin/env bash
# Builds the npm package of bindings/js with module and weights, installs it in another folder, and uses it there.
# usage: scripts/package/npm.sh [FOLDER]      the package is build/npm/mien-VERSION.tgz; FOLDER: your project, default a temporary folder
set -euo pipefail
if [ $# -gt 0 ]; then
  mkdir -p "$1"
  user=$(realpath "$1")
else
  user=$(mktemp -d)
  trap 'rm -rf "$user"' EXIT
fi
cd "$(dirname "$0")/../.."
scripts/web.sh build

rm -rf build/npm
mkdir -p build/npm/package/models
cp bindings/js/*.js bindings/js/mien.d.ts bindings/js/package.json bindings/js/README.md LICENSE build/wasm/tracker/mien.wasm build/npm/package
cp models/*.mien build/npm/package/models
(cd build/npm && npm pack --silent ./package)

package=$(echo "$PWD"/build/npm/mien-*.tgz)
cd "$user"
[ -e package.json ] || npm init -y >/dev/null
npm install --silent --no-audit --no-fund --offline "$package"
node --input-type=module --eval "
import {createTracker} from 'mien';
const tracker = await createTracker();
const {status} = await tracker.track({width: 64, height: 64, data: new Uint8Array(64 * 64 * 4)});
if (status !== 'searching') throw new Error('a black image has no face');
console.log('mien ' + tracker.mien.version + ' works from its package');"
echo "$package: $(stat -c %s "$package") bytes"
