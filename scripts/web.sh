#!/usr/bin/env bash
# Builds the library for WebAssembly and the web page, and serves it on this machine. Installs the required packages.
# usage: scripts/web.sh [serve [PORT]]   builds and serves (default; port 8000)
#        scripts/web.sh build            builds apps/web/dist, which any web server can serve
#        scripts/web.sh test             builds, and tests the page, the face and the JavaScript binding in Chromium
#        scripts/web.sh screenshots      builds, draws docs/images/avatar.jpg and page.jpg, and writes screenshots of the page to out/web
#        scripts/web.sh animation        builds, and renders docs/images/demo.webp: the demo clip beside the avatar
#        scripts/web.sh measure          builds, measures the page in Chromium, and writes docs/results/web.md
set -euo pipefail
cd "$(dirname "$0")/.."

command=${1:-serve}
groups=(build web)
[ "$command" = serve ] || [ "$command" = build ] || groups+=(web-test)
scripts/setup.sh "${groups[@]}"
. scripts/ccache.sh
export NODE_PATH=/usr/share/nodejs  # Debian's folder of modules that Emscripten needs

module() {  # folder, options
  cmake -S . -B "$1" -G Ninja --toolchain scripts/cross/wasm.cmake -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_APPS=OFF \
    -DMIEN_BUILD_CONFORMANCE=OFF -DMIEN_BUILD_TESTS=OFF -DMIEN_INSTALL=OFF "${@:2}" >/dev/null
  cmake --build "$1" --target mien_module -- --quiet
}
build() {
  module build/wasm                              # for the npm package
  module build/wasm-page -DMIEN_TRIM_LAYERS=ON   # for the page, which does not run converted networks
  # Installs the versions and hashes of package-lock.json, without install scripts.
  [ apps/web/node_modules/.package-lock.json -nt apps/web/package-lock.json ] ||
    (cd apps/web && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error)
  (cd apps/web && node build.mjs ../../build/wasm-page/tracker/mien.wasm)
}

build
case $command in
  build) ;;
  serve) exec node apps/web/serve.mjs apps/web/dist "${2:-8000}" ;;
  test)
    for file in bindings/js/tests/*.test.mjs apps/web/tests/*.test.mjs; do  # one at a time, because each uses all processors
      echo "-- $file"
      node --test --test-reporter=spec "$file"
    done
    ;;
  screenshots)
    mkdir -p out/web
    (cd apps/web && node tests/contact_sheet.mjs ../../docs/images/avatar.jpg 180 && node tests/screenshots.mjs ../../out/web)
    ffmpeg -v error -y -i out/web/page.png -q:v 4 docs/images/page.jpg
    ;;
  animation)
    cmake --preset release >/dev/null
    cmake --build --preset release --target mien_program
    mkdir -p out/web
    build/release/apps/mien/mien track tests/data/demo.mp4 --start 1 --duration 5 -o out/web/demo.csv --overlay out/web/demo.mp4
    (cd apps/web && node tests/animation.mjs ../../out/web/demo.csv ../../out/web/frames 320 320)
    ffmpeg -v error -y -i out/web/demo.mp4 -framerate 30 -i out/web/frames/frame_%04d.png -an \
      -filter_complex "[0:v]scale=-2:320[clip];[clip][1:v]hstack,fps=15" -c:v libwebp -loop 0 -q:v 55 docs/images/demo.webp
    ;;
  measure) (cd apps/web && node tests/measure.mjs ../../docs/results/web.md) ;;
  *) echo "web.sh: unknown command '$command'" >&2; exit 2 ;;
esac
