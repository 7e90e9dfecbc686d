#!/usr/bin/env bash
# Builds the AAR with prefab: classes, weights, headers, and libmien_jni.so for every ABI. Without the NDK, Zig's clang compiles, and stand-ins
# for Android's libc.so and libm.so are linked, which name the functions that the library imports. The library links, but has never run.
# usage: scripts/package/android.sh [ABI...]      default: arm64-v8a armeabi-v7a x86_64; the result is build/android/mien.aar
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build java cross-compile-only
. scripts/cross/zig_targets.sh
if ! install_zig; then
  echo "android: SKIPPED: Zig could not be installed from PyPI"
  exit
fi
abis=("$@")
[ $# -gt 0 ] || abis=(arm64-v8a armeabi-v7a x86_64)
java_home=${JAVA_HOME:-$(dirname "$(dirname "$(readlink -f "$(command -v javac)")")")}
lib=$(dirname "$MIEN_ZIG")/lib
out=build/android

compile() {  # triple, cc or c++, object, source and options
  scripts/cross/zig_library_cc.sh "$2" "$1" -O2 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections -c -o "$3" "${@:4}"
}

# Stand-ins for Android's "libc.so" and "libm.so", which only define names for the linker.
stand_ins() {  # triple, folder, symbols that the library imports
  local math='^_*(exp|log|sin|cos|tan|sincos|acos|asin|atan|sqrt|pow|floor|ceil|round|nearbyint|lround|llround|hypot|tanh|erf)' name
  for name in libc libm; do
    case $name in
      libc) grep -vE "$math" "$3" ;;
      libm) grep -E "$math" "$3" || true ;;
    esac | sed 's/.*/void &(void); void &(void) {}/' >"$2/$name.c"
    compile "$1" cc "$2/$name.o" -fno-builtin -fvisibility=default -w "$2/$name.c"
    ld.lld -shared -soname $name.so -o "$2/$name.so" "$2/$name.o"
  done
}

link() {  # ABI
  local triple=${LIBRARY_TARGETS[android-$1]} work=$out/$1 library=build/zig/library-android-$1/tracker/libmien.a name
  local -A zig_targets=([arm64-v8a]=aarch64-linux-musl [armeabi-v7a]=arm-linux-musleabi [x86_64]=x86_64-linux-musl)
  mkdir -p "$work"
  build_library "android-$1"
  compile "$triple" cc "$work/jni.o" -Iinclude -I"$java_home/include" -I"$java_home/include/linux" -Wall -Wextra -Werror bindings/android/jni/mien_jni.c
  # operator new and delete, as the NDK's libc++_static.a has them.
  for name in new new_helpers new_handler; do
    compile "$triple" c++ "$work/$name.o" -std=c++23 -fno-exceptions -fno-rtti -w -D_LIBCPP_BUILDING_LIBRARY -DLIBCXX_BUILDING_LIBCXXABI \
      -I"$lib/libcxx/src" "$lib/libcxx/src/$name.cpp"
  done
  "$MIEN_ZIG" build-lib "$lib/compiler_rt.zig" -target "${zig_targets[$1]}" -O ReleaseSmall -fPIC -femit-bin="$work/compiler_rt.a" --name compiler_rt
  local objects=("$work"/{jni,new,new_helpers,new_handler}.o --whole-archive "$library" --no-whole-archive "$work/compiler_rt.a")
  local options=(-shared --gc-sections -z max-page-size=16384 -z relro -z now -z noexecstack)
  ld.lld "${options[@]}" --unresolved-symbols=ignore-all -o "$work/unresolved.so" "${objects[@]}"
  llvm-nm -D --undefined-only -j "$work/unresolved.so" | sed 's/@.*//' | sort -u >"$work/imports"
  stand_ins "$triple" "$work" "$work/imports"
  ld.lld "${options[@]}" --no-undefined --strip-all -soname libmien_jni.so -o "$work/libmien_jni.so" "${objects[@]}" "$work/libc.so" "$work/libm.so"
}

rm -rf "$out/classes"
mkdir -p "$out/classes"
javac --release 9 -Xlint:all,-options -Werror -d "$out/classes" bindings/android/java/org/mien/*.java
libraries=()
for abi in "${abis[@]}"; do
  link "$abi"
  libraries+=("$abi=$out/$abi/libmien_jni.so")
done
bindings/android/aar.sh "$out/mien.aar" "$out/classes" "${libraries[@]}"
tests/package/check_aar.py "$out/mien.aar" "${abis[@]}"
echo "android: the AAR was linked for ${abis[*]} against stand-ins for Android's libraries, and has never run"
