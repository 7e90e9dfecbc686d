#!/usr/bin/env bash
# Installs the Debian packages that building, testing and running mien need.
# usage: scripts/setup.sh [build] [test] [demo] [train] [convert] [python] [rust] [csharp] [java] [swift] [release] [cross-x86] [cross-arm] [cross-wasm] [cross-windows] [cross-compile-only] [cross-musl] [cross-zig] [cross-debian13] [cross-i386] [cross-s390x] [coverage] [rtsan] [compilers] [valgrind] [convert-fuzz] [web] [web-test] [docs]
#        (default: build test demo)
# As root or with sudo; does nothing if all are installed.
set -euo pipefail

declare -A PACKAGES=(
  [build]="g++ cmake ninja-build libcli11-dev nlohmann-json3-dev libstb-dev zlib1g-dev"
  [test]="libgtest-dev libgmock-dev clang clang-format clang-tidy libclang-rt-dev ccache python3 python3-numpy python3-venv ffmpeg chromium binutils git pkgconf shellcheck abigail-tools libsimde-dev locales valgrind"
  [demo]="ffmpeg python3"
  [convert]="python3-onnx python3-numpy python3-pip unzip"
  [python]="clang g++ cmake ninja-build libcli11-dev nlohmann-json3-dev libstb-dev zlib1g-dev python3 python3-venv python3-pip ffmpeg"
  [rust]="clang cargo rustc ffmpeg python3"
  [csharp]="clang mono-mcs mono-runtime libmono-system-core4.0-cil ffmpeg python3"
  [java]="clang openjdk-17-jdk-headless kotlin unzip ffmpeg python3"
  [swift]="swiftlang libc6-dev ffmpeg python3 git clang"
  [cross-debian13]="debootstrap git"
  [release]="dpkg-dev git python3-venv"
  [cross-arm]="g++-aarch64-linux-gnu g++-arm-linux-gnueabihf qemu-user googletest binutils llvm llvm-19 clang clang-tidy"
  [cross-x86]="qemu-user"
  [cross-wasm]="emscripten node-acorn nodejs llvm clang-tidy git googletest chromium python3 ffmpeg"
  [web]="emscripten node-acorn nodejs npm"
  [docs]="doxygen git python3-venv"
  [web-test]="chromium ffmpeg"
  [cross-windows]="g++-mingw-w64-x86-64-posix binutils-mingw-w64-x86-64 libz-mingw-w64-dev wine wine64 googletest ffmpeg python3 python3-pip unzip"
  [cross-musl]="python3-venv googletest binutils"
  [cross-zig]="qemu-user wine wine64 musl unzip file llvm ffmpeg python3 python3-venv"
  [cross-i386]="g++-i686-linux-gnu libc6-i386 googletest binutils"
  [cross-s390x]="g++ g++-s390x-linux-gnu"
  [coverage]="clang llvm python3"
  [rtsan]="clang-22 libclang-rt-22-dev"
  [compilers]="g++-11 clang-13 clang-22 ffmpeg"
  [valgrind]="valgrind ffmpeg"
  [convert-fuzz]="python3-onnx python3-numpy python3-venv python3-pip"
  [cross-compile-only]="clang lld llvm libc++-dev musl-dev"
  [train]="python3-torch libopenblas0-serial python3-opencv python3-scipy python3-pil python3-matplotlib python3-tqdm espeak-ng libespeak-ng1 flite festival festvox-kdlpc16k festvox-us-slt-hts python3-pocketsphinx pocketsphinx-en-us libopus0 ffmpeg"
)

wanted=("$@")
[ $# -gt 0 ] || wanted=(build test demo)
missing=()
for group in "${wanted[@]}"; do
  [ -n "${PACKAGES[$group]:-}" ] || { echo "setup.sh: unknown group '$group'" >&2; exit 2; }
  for package in ${PACKAGES[$group]}; do
    [ "$package" != npm ] || ! command -v npm >/dev/null || continue  # nodejs from elsewhere than Debian brings its own
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep "ok installed" >/dev/null || missing+=("$package")
  done
done
[ ${#missing[@]} -gt 0 ] || exit 0

if ! command -v apt-get >/dev/null; then
  echo "setup.sh: no apt-get here; please install: ${missing[*]}" >&2
  exit 1
fi
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"
