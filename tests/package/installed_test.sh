#!/usr/bin/env bash
# Installs a build to a temporary prefix, moves that, and uses it from there as strangers would.
# usage: installed_test.sh BUILD_DIR VERSION    (CC, CXX, FLAGS: those of the build)
set -euo pipefail
consumers=$(cd "$(dirname "$0")" && pwd)
build=$1
version=$2
FLAGS=${FLAGS:-}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/moved
cmake --install "$build" --prefix "$work/installed" >/dev/null
mv "$work/installed" "$prefix"
unset MIEN_MODELS

strict="-Wall -Wextra -Wpedantic -Werror"
find_package() {  # consumer, flags for C++
  cmake -S "$consumers/$1" -B "$work/$1" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_C_FLAGS="$FLAGS $strict" -DCMAKE_CXX_FLAGS="$FLAGS $strict ${2:-}" --no-warn-unused-cli
  cmake --build "$work/$1"
  ctest --test-dir "$work/$1" --output-on-failure --no-tests=error
}
echo "== find_package, with no C++ compiler on the machine"
CXX=/nowhere find_package c
echo "== find_package, C++ without exceptions and RTTI"
find_package cpp "-fno-exceptions -fno-rtti"

echo "== the CMake project of apps/examples/README.md"
mkdir "$work/readme"
"$consumers/../docs/code_blocks.py" apps/examples/README.md c >"$work/readme/app.c"
"$consumers/../docs/code_blocks.py" apps/examples/README.md cmake >"$work/readme/CMakeLists.txt"
cmake -S "$work/readme" -B "$work/readme/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_FLAGS="$FLAGS" --no-warn-unused-cli
cmake --build "$work/readme/build"
ffmpeg -v error -i "$consumers/../data/demo.mp4" -frames:v 20 -s 640x480 -pix_fmt rgb24 -f rawvideo "$work/readme/video"
"$work/readme/build/app" <"$work/readme/video" >"$work/readme/curves"
[ "$(grep -c ' jawOpen [01][.][0-9]' "$work/readme/curves")" -eq 20 ]

echo "== pkg-config"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name mien.pc)")
export PKG_CONFIG_PATH
pkg-config --exact-version "$version" mien
models=$(pkg-config --variable=modelsdir mien)
test -f "$models/basenet.mien"
test ! -e "$models/training"
libraries=$(pkg-config --variable=libdir mien)
read -ra flags <<<"$FLAGS $(pkg-config --cflags mien)"
read -ra link <<<"$(pkg-config --libs mien)"
read -ra link_static <<<"$(pkg-config --static --libs mien)"
"$CC" "${flags[@]}" "$consumers/c/main.c" -o "$work/shared" "${link[@]}"
LD_LIBRARY_PATH=$libraries "$work/shared" "$version"
link_static=("${link_static[@]/-lmien/-l:libmien.a}")
"$CC" "${flags[@]}" "$consumers/c/main.c" -o "$work/static" "${link_static[@]}"
"$work/static" "$version"

echo "== the shared library's name"
readelf -d "$libraries/libmien.so" | grep SONAME | grep -F "[libmien.so.${version%%.*}]"

echo "== exported symbols"
if nm -D --defined-only --demangle "$libraries/libmien.so" | awk '$2 != "A"' |
  grep -vE '^[0-9a-f]+ [A-Z] (mien_|mien::)'; then
  exit 1
fi

if [ -x "$prefix/bin/mien" ]; then
  echo "== the program"
  {
    printf 'YUV4MPEG2 W32 H32 F30:1 C420jpeg\nFRAME\n'
    head -c 1536 /dev/zero
  } | "$prefix/bin/mien" track - --quiet | grep -c searching
  grep -q "CLI11 Copyright" "$prefix/share/doc/mien/third_party.txt"  # its licence requires this
  grep -q '^\.TH ' "$prefix/share/man/man1/mien.1"
  bash -n "$prefix/share/bash-completion/completions/mien"
  grep -q '^#compdef mien' "$prefix"/share/zsh/*/_mien
  grep -q '^complete -c mien' "$prefix/share/fish/vendor_completions.d/mien.fish"
fi

if [ -x "$prefix/bin/mien-conformance" ]; then
  echo "== the conformance program"
  "$prefix/bin/mien-conformance" --list --filter 'network/*' | grep -E 'mini_encoder +ref'
  "$prefix/bin/mien-conformance" --filter softmax
fi
