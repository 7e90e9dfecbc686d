#!/usr/bin/env bash
# Builds Mien.xcframework: the static library for iOS, its simulator and macOS, with headers and a module map. Zig's clang compiles with
# Apple's headers of macOS. The part for macOS is linked into a program with Zig; those for iOS are only compiled. Nothing has run.
# usage: scripts/package/xcframework.sh      the result is build/apple/Mien.xcframework
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-compile-only
. scripts/cross/zig_targets.sh
if ! install_zig; then
  echo "xcframework: SKIPPED: Zig could not be installed from PyPI"
  exit
fi
out=build/apple/Mien.xcframework
rm -rf "$out"
mkdir -p "$out"

slice() {  # folder of the framework, targets
  local target thin=()
  mkdir -p "$out/$1/Headers"
  for target in "${@:2}"; do
    build_library "$target"
    # The format that Apple's linker expects: aligned members and a sorted index, without times.
    # It warns of members with equal names, which linkers do not mind.
    "$(llvm_tool llvm-libtool-darwin)" -static -D -o "build/apple/$target.a" "build/zig/library-$target/tracker/libmien.a" 2>"build/apple/$target.log" ||
      { cat "build/apple/$target.log" >&2; return 1; }
    thin+=("build/apple/$target.a")
  done
  "$(llvm_tool llvm-lipo)" -create "${thin[@]}" -output "$out/$1/libmien.a"
  cp -R include/mien "$out/$1/Headers/"
  cp scripts/package/apple/module.modulemap "$out/$1/Headers/"
}

slice ios-arm64 ios-arm64
slice ios-arm64_x86_64-simulator ios-simulator-arm64 ios-simulator-x64
slice macos-arm64_x86_64 macos-arm64 macos-x64
scripts/package/apple/info_plist.py "$out"
tests/package/check_xcframework.py "$out"

# The library of macOS in a program, whose C++ library is Zig's.
for target in macos-arm64 macos-x64; do
  scripts/cross/zig_cc.sh cc -target "${ZIG_TARGETS[$target]}" -I"$out/macos-arm64_x86_64/Headers" -c -o "build/apple/$target.o" tests/package/c/main.c
  scripts/cross/zig_cc.sh c++ -target "${ZIG_TARGETS[$target]}" "build/apple/$target.o" "build/apple/$target.a" -o "build/apple/$target"
done
tests/package/check_macho.py build/apple/macos-arm64 arm64 --signed
tests/package/check_macho.py build/apple/macos-x64 x86_64
echo "xcframework: compiled for iOS, its simulator and macOS; linked for macOS; never run"
