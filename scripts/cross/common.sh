# shellcheck shell=bash
# Sourced by the scripts of this folder, in the repository's root, with their arguments. --full: 50 seeds of
# mien-conformance instead of 3.
. scripts/ccache.sh

# shellcheck disable=SC2034  # used by the scripts that source this
full=0
seeds=3
# shellcheck disable=SC2034
if [ "${1:-}" = --full ]; then
  full=1
  seeds=50
fi

build() {  # build folder, targets: prints messages of compilers only
  cmake --build "$1" --target "${@:2}" -- --quiet
}

# Tests and mien-conformance for another machine. Debian has GoogleTest for its own architecture only, but its source for all.
configure() {  # build folder, folder for GoogleTest, toolchain file, options
  local googletest=$PWD/$2
  if [ ! -d "$googletest/lib/cmake/GTest" ]; then
    cmake -S /usr/src/googletest -B "$googletest-build" -G Ninja --toolchain "$3" -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_INSTALL_PREFIX="$googletest" -DCMAKE_INSTALL_LIBDIR=lib >/dev/null
    build "$googletest-build" install >/dev/null
  fi
  local packages=$PWD/scripts/cross/packages
  cmake -S . -B "$1" -G Ninja --toolchain "$3" -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF \
    -DMIEN_BUILD_TESTS=ON -DCLI11_DIR="$packages" -Dnlohmann_json_DIR="$packages" -DGTest_DIR="$googletest/lib/cmake/GTest" \
    "${@:4}" >/dev/null
}

# Prints the tiers and the summary; everything after a failure.
conformance() {  # device as of scripts/run_on_device.sh, program, options
  local output
  echo "-- mien-conformance ${*:3}, $1"
  output=$(scripts/run_on_device.sh "$@" 2>&1) || { echo "$output"; return 1; }
  sed -n '/^mien /p;/^guard pages/p;$p' <<<"$output"
}

# Ends the script successfully on a machine that cannot run x86-64 programs.
x86_64_only() {  # name of the target
  if [ "$(uname -m)" != x86_64 ]; then
    echo "$1: nothing ran: this is not an x86-64 machine"
    exit
  fi
}
