#!/usr/bin/env bash
# Compiles and links mien for Linux, macOS and Windows with Zig's clang, and runs those programs that this machine or an emulator can
# run. The last line of each target tells which ran and which were only linked.
# usage: scripts/cross/zig.sh [--full] [TARGET...]
#   --full   also the library, mien-conformance and the program mien; default: the amalgamation in a small program
#   TARGET   linux-x64, linux-arm64, linux-armv7, macos-x64, macos-arm64, windows-x64, windows-arm64; default: all
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/cross/zig_targets.sh
full=0
[ "${1:-}" != --full ] || { full=1; shift; }
targets=("$@")
[ $# -gt 0 ] || mapfile -t targets < <(printf '%s\n' "${!ZIG_TARGETS[@]}" | sort)
for target in "${targets[@]}"; do
  [ -n "${ZIG_TARGETS[$target]:-}" ] || { echo "zig.sh: TARGET: unknown target (got $target, expected one of ${!ZIG_TARGETS[*]})" >&2; exit 2; }
done

scripts/setup.sh build test cross-zig
if ! install_zig; then
  echo "linux, macos, windows: SKIPPED: Zig could not be installed from PyPI"
  exit
fi
export WINEDEBUG=-all WINEPREFIX=$PWD/build/cross/wine
mkdir -p "$WINEPREFIX"
work=$PWD/build/zig
frames=$work/frames.rgb clip=$work/clip.y4m
ffmpeg -nostdin -v error -y -i tests/data/demo.mp4 -frames:v 30 -s 640x480 -pix_fmt rgb24 -f rawvideo "$frames"
scripts/package/amalgamate.py -o "$work/amalgamation" >/dev/null

amalgamation() {  # target, emulator or "none"
  local program=$work/$1/amalgamated.exe  # Windows requires this ending
  mkdir -p "$work/$1"
  build_amalgamated "$1" "$work/amalgamation" "$program" -Wall -Wextra -Werror
  check_machine "$1" "$program"
  [ "$2" = none ] || $2 "$program" models "$frames"
}

programs() {  # target, emulator or "none"
  local build=$work/$1 suffix=
  [[ $1 != windows-* ]] || suffix=.exe
  configure_zig "$1"
  cmake --build "$build" --target mien_static mien_shared mien_conformance_program mien_program -- --quiet
  local file
  for file in "$build/apps/mien/mien$suffix" "$build/apps/conformance/mien-conformance$suffix" "$build"/tracker/libmien.*so "$build"/tracker/libmien.*dylib "$build"/tracker/*mien.dll; do
    [ ! -f "$file" ] || check_machine "$1" "$file"
  done
  [ "$2" != none ] || return 0
  $2 "$build/apps/conformance/mien-conformance$suffix" --models models | tail -n 1
  $2 "$build/apps/mien/mien$suffix" track "$clip" --quiet --models models -o "$build/clip.csv"
  scripts/cross/compare_curves.py "$build/clip.csv" "$work/clip.csv"
  [ "$1" != linux-x64 ] || single_file
}

# The program with the weights inside, from a folder without any.
single_file() {
  configure_zig linux-x64 -DMIEN_EMBED_MODELS=ON
  cmake --build "$work/linux-x64" --target mien_program -- --quiet
  local folder
  folder=$(mktemp -d)
  cp "$work/linux-x64/apps/mien/mien" "$folder"
  (cd "$folder" && env -u MIEN_MODELS ./mien track "$clip" --quiet -o clip.csv)
  scripts/cross/compare_curves.py "$folder/clip.csv" "$work/clip.csv"
  rm -rf "$folder"
}

universal() {  # programs of both builds for macOS
  local file
  mkdir -p "$work/macos"
  for file; do
    [ -f "$work/macos-arm64/$file" ] || continue
    [ -f "$work/macos-x64/$file" ] || continue
    "$(llvm_tool llvm-lipo)" -create "$work/macos-arm64/$file" "$work/macos-x64/$file" -output "$work/macos/${file##*/}"
    tests/package/check_macho.py "$work/macos/${file##*/}" arm64 x86_64 --signed
    echo "macos: ${file##*/}: universal program in build/zig/macos, linked, never run"
  done
}

[ $full -eq 0 ] || { make_clip; make_expected_curves; }
built="the amalgamation"
[ $full -eq 0 ] || built+=", the library, mien-conformance and the program mien"
for target in "${targets[@]}"; do
  echo "== $target"
  emulator=$(zig_emulator "$target") || emulator=none
  amalgamation "$target" "$emulator"
  [ $full -eq 0 ] || programs "$target" "$emulator"
  if [ "$emulator" = none ]; then
    echo "$target: linked, never run: $built"
  else
    echo "$target: linked and ran${emulator:+ under $emulator}: $built"
  fi
done
if [[ " ${targets[*]}" == *" macos-"* ]]; then
  files=(amalgamated.exe)
  [ $full -eq 0 ] || files+=(apps/mien/mien apps/conformance/mien-conformance)
  universal "${files[@]}"
fi
