#!/usr/bin/env bash
# Builds Python's wheels for several systems with Zig's compiler, and checks their files, sizes and tags. pip installs each into an empty
# folder; on this machine, under qemu or under Wine, those that can run track a clip. The last line of each target tells what ran.
# usage: scripts/package/wheels.sh [-o FOLDER] [TARGET...]      default: build/wheels, all targets
#   TARGET   manylinux-x64, manylinux-arm64, musllinux-x64, musllinux-arm64, windows-x64, macos-x64, macos-arm64
set -euo pipefail
cd "$(dirname "$0")/../.."
out=build/wheels
if [ "${1:-}" = -o ]; then
  out=$2
  shift 2
fi
. scripts/cross/zig_targets.sh
. scripts/package/wheel_pythons.sh
ZIG_TARGETS+=(
  [manylinux-x64]=x86_64-linux-gnu.2.28
  [manylinux-arm64]=aarch64-linux-gnu.2.28
  [musllinux-x64]=x86_64-linux-musl
  [musllinux-arm64]=aarch64-linux-musl)
# pip knows no minor versions of macOS since 11, and the library needs 13.3.
declare -A PLATFORMS=([manylinux-x64]=manylinux_2_28_x86_64 [manylinux-arm64]=manylinux_2_28_aarch64 [musllinux-x64]=musllinux_1_2_x86_64
  [musllinux-arm64]=musllinux_1_2_aarch64 [windows-x64]=win_amd64 [macos-x64]=macosx_14_0_x86_64 [macos-arm64]=macosx_14_0_arm64)
targets=("$@")
[ $# -gt 0 ] || mapfile -t targets < <(printf '%s\n' "${!PLATFORMS[@]}" | sort)
for target in "${targets[@]}"; do
  [ -n "${PLATFORMS[$target]:-}" ] || { echo "wheels.sh: TARGET: unknown target (got $target, expected one of ${!PLATFORMS[*]})" >&2; exit 2; }
done

scripts/setup.sh build cross-zig
install_zig || { echo "SKIPPED: wheels: Zig could not be installed from PyPI"; exit; }
export WINEDEBUG=-all WINEPREFIX=$PWD/build/cross/wine
mkdir -p "$out" "$WINEPREFIX"
out=$(cd "$out" && pwd)
work=$PWD/build/zig/wheels clip=$PWD/build/zig/clip.y4m
python3 -m venv "$work/python"
python=$work/python/bin/python
"$python" -m pip install --quiet --quiet --disable-pip-version-check --require-hashes -r scripts/package/wheel_requirements.txt
make_clip

build_wheel() {  # target
  local options=() packages=$PWD/scripts/cross/packages zlib=$PWD/build/zig/zlib define linker=-s
  build_zlib "$1"
  [[ $1 != musllinux-* ]] || linker+=" -dynamic"
  for define in "CMAKE_TOOLCHAIN_FILE=$PWD/scripts/cross/zig.cmake" "MIEN_ZIG_TARGET=${ZIG_TARGETS[$1]}" MIEN_UNITY_BUILD=ON "CMAKE_EXE_LINKER_FLAGS=$linker" \
    "CLI11_DIR=$packages" "nlohmann_json_DIR=$packages" "ZLIB_LIBRARY=$zlib/$1/libz.a" "ZLIB_INCLUDE_DIR=$zlib/source"; do
    options+=("-Ccmake.define.$define")
  done
  rm -f "$out"/mien-*-"${PLATFORMS[$1]}".whl
  "$python" -m build --no-isolation --wheel --outdir "$out" "-Cbuild-dir=$work/$1" "-Cwheel.tags=py3-none-${PLATFORMS[$1]}" \
    -Cinstall.strip=false "${options[@]}" bindings/python >"$work/$1.log" 2>&1 || { cat "$work/$1.log" >&2; return 1; }
}

# The policy of a wheel for Linux, and the libraries of programs for other systems.
check_wheel() {  # target, wheel, folder of the package
  local file options=() foreign
  for file in "$3"/libmien.* "$3"/mien "$3"/mien.exe; do
    [ -f "$file" ] || continue
    [[ $1 != macos-* || $file != */mien ]] || options=(--library @rpath/libmien.dylib)
    check_machine "${1/#m*linux-/linux-}" "$file" "${options[@]}"
    [[ $1 == windows-* ]] || continue
    foreign=$("$(llvm_tool llvm-readobj)" --coff-imports "$file" | sed -n 's/^ *Name: *//p' |
      grep -viE '^(api-ms-win-.*|kernel32|ntdll|advapi32|ws2_32|shell32|user32|ole32|libmien)\.dll$' || true)
    [ -z "$foreign" ] || { echo "wheels.sh: $file: DLLs that Windows does not have (got $foreign)" >&2; return 1; }
  done
  [[ $1 != manylinux-* ]] || audit "$1" "$2"
  # musl's loader takes libc.so for itself under any distribution's name, but this check knows only Alpine's.
  [[ $1 != musllinux-* ]] || audit "$1" "$2" --ldpaths "$3"
}

audit() {  # target, wheel, options
  "$python" -m auditwheel show --json "${@:3}" "$2" | "$python" -c '
import json, re, sys
shown, wanted = json.load(sys.stdin), sys.argv[1]
musl = wanted.startswith("musl") and set(shown["external_libs"]) == {"libc.so"}
tag = shown["sym_tag" if musl else "overall_tag"]
(libc, got, machine), expected = (re.fullmatch(r"([a-z]+)_\d_(\d+)_(.*)|.*", text).groups() for text in (tag, wanted))
sys.exit(None if got and (libc, machine) == (expected[0], expected[2]) and int(got) <= int(expected[1]) else f"auditwheel: got {tag}, expected {wanted}")' \
    "${PLATFORMS[$1]}"
}

install_wheel() {  # target, wheel
  local version=3.11 wheels=("$2")
  [[ $1 != windows-* ]] || { version=3.13; wheels+=(numpy==2.1.3); }  # later ones call functions of Windows that Wine 8 lacks
  rm -rf "$work/$1.installed"
  "$python" -m pip install --quiet --quiet --disable-pip-version-check --target "$work/$1.installed" --platform "${PLATFORMS[$1]}" \
    --python-version $version --implementation cp --only-binary=:all: --no-compile "${wheels[@]}"
}

run_program() {  # target, command
  make_expected_curves
  "${@:2}" track "$clip" --quiet -o "$work/$1.csv"
  scripts/cross/compare_curves.py "$work/$1.csv" build/zig/clip.csv
}

run_manylinux_x64() {  # wheel
  [ "$(uname -m)" = x86_64 ] || return 0
  rm -rf "$work/fresh"
  python3 -m venv "$work/fresh"
  "$work/fresh/bin/pip" install --quiet --quiet --disable-pip-version-check "$1"
  "$work/fresh/bin/python" tests/package/wheel/track_clip.py "$clip"
  ran="ran in a fresh environment"
}

# Python starts the program through a script, because the kernel cannot start one for ARM.
run_manylinux_arm64() {
  local folder=$work/manylinux-arm64.installed/mien root=$work/python-arm64
  fetch_arm64_python || { echo "SKIPPED: Python for ARM could not be fetched from Debian"; return 0; }
  run_program manylinux-arm64 qemu-aarch64 -L "$root" "$folder/mien"
  mv "$folder/mien" "$folder/mien.program"
  # shellcheck disable=SC2016  # the script expands $@
  printf '#!/bin/sh\nexec qemu-aarch64 -L %s %s "$@"\n' "$root" "$folder/mien.program" >"$folder/mien"
  chmod +x "$folder/mien"
  PYTHONPATH=$work/manylinux-arm64.installed qemu-aarch64 -L "$root" "$root/usr/bin/python3.11" tests/package/wheel/track_clip.py "$clip"
  ran="ran in Debian's Python for ARM under qemu-aarch64"
}

run_musllinux_x64() {
  [ "$(uname -m)" = x86_64 ] || return 0
  run_program musllinux-x64 "$work/musllinux-x64.installed/mien/mien"
  ran="its program and library ran with musl, but in no Python"
}

run_musllinux_arm64() {
  fetch_arm64_musl || { echo "SKIPPED: musl for ARM could not be fetched from Debian"; return 0; }
  run_program musllinux-arm64 qemu-aarch64 -L "$work/musl-arm64" "$work/musllinux-arm64.installed/mien/mien"
  ran="its program and library ran with musl under qemu-aarch64, but in no Python"
}

run_windows_x64() {
  fetch_windows_python || { echo "SKIPPED: Python for Windows could not be fetched from PyPI"; return 0; }
  run_program windows-x64 wine "$work/windows-x64.installed/mien/mien.exe"
  printf '%s\r\n' python313.zip . '..\windows-x64.installed' >"$work/python-windows/python313._pth"
  # Under Wine, Python can only read from and write to pipes.
  : | wine "$work/python-windows/python.exe" tests/package/wheel/track_clip.py build/zig/clip.y4m 2>&1 | cat
  ran="ran in Python for Windows under Wine"
}

too_large=0
for target in "${targets[@]}"; do
  echo "== $target"
  build_wheel "$target"
  wheel=$(echo "$out"/mien-*-py3-none-"${PLATFORMS[$target]}".whl)
  "$python" scripts/package/shrink_wheel.py "$wheel"
  bytes=$(stat -c %s "$wheel")
  [ "$bytes" -le 5000000 ] || { echo "wheels.sh: $wheel: larger than 5 MB (got $bytes bytes)" >&2; too_large=1; }
  install_wheel "$target" "$wheel"
  check_wheel "$target" "$wheel" "$work/$target.installed/mien"
  ran="linked, never run"
  [[ $target == macos-* ]] || "run_${target//-/_}" "$wheel"
  echo "$target: $bytes bytes, $ran"
done
[ $too_large -eq 0 ]
