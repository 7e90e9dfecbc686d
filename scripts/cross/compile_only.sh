#!/usr/bin/env bash
# Compiles the whole library for systems whose SDK is not at hand, Android and Apple's, with clang and stand-in headers,
# and looks at what the objects ask for. Nothing is run. Linking and running need the NDK or Xcode: docs/cross.md.
# usage: scripts/cross/compile_only.sh [--full]      --full: also the program for macOS, macOS on arm64 and the simulator, which differ from iOS in name
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-compile-only
. scripts/cross/common.sh

llvm=$(printf '%s\n' /usr/lib/llvm-*/include/c++/v1 | sort -V | tail -1)
llvm=${llvm%/include/c++/v1}
root=$PWD/build/cross/compile-only
musl=/usr/include/x86_64-linux-musl

# musl's headers are those of every machine but for a few under bits/: for 32 bits those with the sizes changed.
mkdir -p "$root/headers32/bits"
sed -E 's/^(#define _(Addr|Reg)) long/\1 int/; s/^(#define _Int64) long/\1 long long/; s/^#define __LONG_MAX .*/#define __LONG_MAX 0x7fffffffL/' \
  "$musl/bits/alltypes.h" >"$root/headers32/bits/alltypes.h"
sed -E 's/((INTPTR|PTRDIFF|SIZE)_M[A-Z]+ +U?)INT64/\1INT32/' "$musl/bits/stdint.h" >"$root/headers32/bits/stdint.h"

# Apple's 64-bit integers are long long, which clang insists on.
mkdir -p "$root/headers_apple/bits"
sed -E 's/^(#define _Int64) long/\1 long long/' "$musl/bits/alltypes.h" >"$root/headers_apple/bits/alltypes.h"

apple="$root/headers_apple -idirafter $PWD/scripts/cross/apple_headers -idirafter $musl"

# What an object may ask others for: memory, mathematics and reading files of the C library, new and delete that do not
# throw, std::to_chars of integers, what the CPU has, and the compiler's own run-time library. No exceptions, no type information, no guarded or early initialisation.
# abort is what libc++ has, without exceptions, where it would throw.
allowed='^_?(abort|mem(cpy|move|set|cmp|chr)|bcmp|(__)?bzero|strlen|aligned_alloc|free|fread'
allowed+='|(exp|log|log10|sin|cos|tan|acos|asin|atan|atan2|sqrt|pow|floor|ceil|round|nearbyint|lround|llround|hypot|tanh)f?'
allowed+='|___?sincosf?(_stret)?|sincosf?|_Zn[wa][mj](St11align_val_t)?RKSt9nothrow_t|_Zd[la]Pv([mj])?(St11align_val_t)?|_ZSt7nothrow'
allowed+='|_ZNSt3__16__itoa8__u(32|64)toaE[jmy]Pc|getauxval|sysctlbyname'
allowed+='|__exp10f?|memset_pattern16|__stack_chk_(fail|guard)|__aeabi_[a-z0-9_]+|_GLOBAL_OFFSET_TABLE_)$'

bad=0
configure_for() {  # build folder, triple, flags, headers, options
  rm -rf "$1"  # flags of the toolchain file are read once
  cmake -S . -B "$1" -G Ninja --toolchain "$PWD/scripts/cross/compile_only.cmake" -DMIEN_TRIPLE="$2" -DMIEN_FLAGS="$3" \
    -DMIEN_LLVM="$llvm" -DMIEN_HEADERS="$4" -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF \
    -DMIEN_BUILD_CONFORMANCE=OFF -DMIEN_BUILD_TESTS=OFF "${@:5}" >/dev/null
}

check() {  # triple, flags, headers, what for
  local build=$root/$1
  configure_for "$build" "$1" "$2" "$3"
  build "$build" mien_static
  local library=$build/tracker/libmien.a nm=$llvm/bin/llvm-nm
  local wanted
  wanted=$(comm -23 <("$nm" -u -j "$library" 2>/dev/null | grep -v ':$' | sort -u) \
    <("$nm" --defined-only -j "$library" 2>/dev/null | sort -u))
  [ -n "$wanted" ] || { echo "compile_only.sh: no symbols read from $library" >&2; exit 1; }
  local others
  others=$(grep -vE "$allowed" <<<"$wanted" || true)
  if [ -n "$others" ]; then
    echo "compile_only.sh: the library for $1 asks for: $others" >&2
    bad=1
  fi
  if "$nm" "$library" 2>/dev/null | grep -E '_GLOBAL__sub_I|__cxa_guard|_ZTI|_ZTS|__gxx_personality|_Unwind_Resume'; then
    echo "compile_only.sh: the library for $1 throws, has type information, or runs code before main" >&2
    bad=1
  fi
  echo "compiled: $1 ($4), $("$llvm/bin/llvm-ar" t "$library" | wc -l) objects; asks for $(wc -w <<<"$wanted") functions outside"
}

# The sources of the program; from 13.3 on macOS has all of the standard library that they use.
check_program() {  # triple
  local build=$root/program packages=$PWD/scripts/cross/packages
  configure_for "$build" "$1" "-D_GNU_SOURCE" "$apple" -DMIEN_BUILD_APPS=ON -DCMAKE_FIND_PACKAGE_PREFER_CONFIG=ON \
    -DCLI11_DIR="$packages" -Dnlohmann_json_DIR="$packages" -DZLIB_DIR="$packages"
  local objects
  mapfile -t objects < <(ninja -C "$build" -t targets all | sed -nE 's,^((apps/mien|formats)/.*\.obj): CXX_.*,\1,p')
  build "$build" "${objects[@]}"
  echo "compiled: $1 (the program mien), ${#objects[@]} objects"
}

# Android's loader wants segments apart by pages of 16 KB: are they, with what tracker/CMakeLists.txt tells the linker?
page_size=$(sed -nE 's/.*-Wl,-z,(max-page-size=[0-9]+).*/\1/p' tracker/CMakeLists.txt)
check_pages() {  # triple, emulation
  local so=$root/$1/libmien.so
  "$llvm/bin/ld.lld" -shared -m "$2" ${page_size:+-z "$page_size"} --unresolved-symbols=ignore-all --whole-archive \
    "$root/$1/tracker/libmien.a" -o "$so"
  if "$llvm/bin/llvm-readelf" -lW "$so" | awk '$1 == "LOAD" && $NF != "0x4000" {bad = 1} END {exit !bad}'; then
    echo "compile_only.sh: $so is not aligned to pages of 16 KB" >&2
    bad=1
  fi
}

check aarch64-linux-android28 "" "$musl" "Android arm64-v8a"
check armv7a-linux-androideabi28 "-mfpu=neon-vfpv4" "$root/headers32 -idirafter $musl" "Android armeabi-v7a"
check x86_64-linux-android28 "" "$musl" "Android x86_64"
check_pages aarch64-linux-android28 aarch64linux
check_pages armv7a-linux-androideabi28 armelf_linux_eabi
check_pages x86_64-linux-android28 elf_x86_64
check arm64-apple-ios15.0 "-D_GNU_SOURCE" "$apple" "iOS"
check x86_64-apple-macos13.0 "-D_GNU_SOURCE" "$apple" "macOS x86_64"
targets="Android arm64-v8a, armeabi-v7a and x86_64; iOS; macOS x86_64"
if [ $full -eq 1 ]; then
  check arm64-apple-ios15.0-simulator "-D_GNU_SOURCE" "$apple" "iOS simulator"
  check arm64-apple-macos13.0 "-D_GNU_SOURCE" "$apple" "macOS arm64"
  check_program arm64-apple-macos13.3
  targets+=", arm64; iOS simulator"
fi
echo "compile-only: every source of the library was compiled for $targets; nothing was linked to their systems or run"
exit $bad
