#!/usr/bin/env bash
# Tests that scripts/test.sh does not run and that take minutes: linters, bindings, documentation, binary interface, threads, other
# machines, clang's Release build, the memory sanitizer, short fuzzing, and the page. scripts/nightly.sh has those that take longer.
# usage: scripts/test_rest.sh [--within MINUTES]      skips and names parts that would end later
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=1000000
[ "${1:-}" != --within ] || minutes=$2
scripts/setup.sh build test convert python
. scripts/ccache.sh

build() {  # preset, targets
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1" --target "${@:2}"
}

linters() {
  shellcheck -x scripts/*.sh scripts/*/*.sh models/training/*/*/*.sh tests/*/*.sh bindings/*.sh bindings/*/*.sh
  scripts/check/format.sh
  cmake --preset tidy >/dev/null  # for clang, whose options clang-tidy understands, file by file
  scripts/check/tidy.py build/tidy
}
binding() {  # folder, group of scripts/setup.sh; the test reports missing packages
  scripts/setup.sh "$2" || echo "setup.sh: $2 could not be installed" >&2
  "bindings/$1/test.sh"
}
packages() {  # the library as a part of other projects, and as one file
  build release all
  ctest --preset release --label-regex compiles_again -j "$(nproc)" --output-log build/release/tests_compiling_again.log
}
threads() {
  build tsan tracker_threads_test
  build/tsan/tests/tracker/tracker_threads_test
}
clang() {
  build clang mien_conformance_program mien_shared
  build/clang/apps/conformance/mien-conformance --models models
}
cluster() (  # on this machine, with Ray from PyPI; a subshell, so that the trap removes the folder in any case
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  python3 -m venv "$folder"
  "$folder/bin/pip" install --quiet 'ray==2.60.0'
  "$folder/bin/python" tests/apps/track_on_ray_test.py
)
page() {  # with packages from npm
  scripts/setup.sh web web-test
  scripts/web.sh test
  tests/docs/paths_test.py javascript  # calls scripts/package/npm.sh
}

left_out=()
part() {  # minutes that it takes two processors without caches, name, command
  if [ $((SECONDS / 60 + $1)) -gt "$minutes" ]; then
    left_out+=("$2")
    return
  fi
  echo "== $2"
  local began=$SECONDS
  "${@:3}"
  echo "== $2 took $((SECONDS - began)) s"
}
part 1 "supply chain" scripts/check/supply_chain.sh
part 5 "Python binding" bindings/python/test.sh
part 1 Rust binding rust rust
part 1 "C#" binding csharp csharp
part 1 Java binding android java
part 1 Swift bindings/swift/test.sh  # whole in scripts/cross/swift.sh. JavaScript: see the page
part 1 documentation scripts/site.sh
part 1 words scripts/check/words.sh
part 1 Python scripts/check/python.sh
part 1 "batches on a cluster" cluster
part 1 "binary interface" scripts/check/abi.sh
part 2 threads threads
part 8 "the library inside other projects" packages
part 16 linters linters
part 5 "Release with clang" clang
part 5 "uninitialized memory" scripts/msan.sh
part 8 fuzzing scripts/fuzz.sh 2
part 2 "fuzzing of the converter" scripts/fuzz_convert.sh 1
part 10 "the page, and the npm package" page
part 20 "other machines than ARM" scripts/cross/all.sh wasm windows compile_only linux_x64 big_endian musl
part 25 "ARM" scripts/cross/all.sh arm64 armv7
[ ${#left_out[@]} -eq 0 ] || printf 'NOT TESTED, out of time: %s\n' "${left_out[@]}"
