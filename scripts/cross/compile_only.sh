#!/usr/bin/env bash
# Compiles the whole library for Android and iOS with Zig's clang instead of their SDKs, and checks which functions the objects
# import. Nothing runs. scripts/package/android.sh and scripts/package/xcframework.sh pack the results.
# usage: scripts/cross/compile_only.sh [--full]      --full: also for the iOS simulator
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build cross-compile-only
. scripts/cross/zig_targets.sh
if ! install_zig; then
  echo "compile-only: SKIPPED: Zig could not be installed from PyPI"
  exit
fi

# Allowed imports: memory, mathematics and reading of files from the C library, new and delete that do not throw, CPU features, and the
# compiler's run-time library; no exceptions, RTTI, guarded initialization or static constructors. libc++ without exceptions calls abort
# instead of throwing.
allowed='^_?(abort|mem(cpy|move|set|cmp|chr)|bcmp|(__)?bzero|strlen|aligned_alloc|free|fread'
allowed+='|(exp|log|log10|sin|cos|tan|acos|asin|atan|atan2|sqrt|pow|floor|ceil|round|nearbyint|lround|llround|hypot|tanh|erf|erfc)f?'
allowed+='|___?sincosf?(_stret)?|sincosf?|_Zn[wa][mj](St11align_val_t)?RKSt9nothrow_t|_Zd[la]Pv([mj])?(St11align_val_t)?|_ZSt7nothrow'
allowed+='|getauxval|sysctlbyname'
allowed+='|__exp10f?|memset_pattern16|__stack_chk_(fail|guard)|__aeabi_[a-z0-9_]+|_GLOBAL_OFFSET_TABLE_)$'

bad=0
check() {  # target
  build_library "$1"
  local library=build/zig/library-$1/tracker/libmien.a imports others
  imports=$(comm -23 <(llvm-nm -u -j "$library" 2>/dev/null | grep -v ':$' | sort -u) \
    <(llvm-nm --defined-only -j "$library" 2>/dev/null | sort -u))
  [ -n "$imports" ] || { echo "compile_only.sh: no symbols read from $library" >&2; exit 1; }
  others=$(grep -vE "$allowed" <<<"$imports" || true)
  if [ -n "$others" ]; then
    echo "compile_only.sh: $1: unexpected imports: $others" >&2
    bad=1
  fi
  if llvm-nm "$library" 2>/dev/null | grep -E '_GLOBAL__sub_I|__cxa_guard|_ZTI|_ZTS|__gxx_personality|_Unwind_Resume'; then
    echo "compile_only.sh: $1: the library throws, has RTTI, or runs code before main" >&2
    bad=1
  fi
  echo "compiled: $1, $(llvm-ar t "$library" | wc -l) objects, $(wc -w <<<"$imports") imported functions"
}

targets=(android-arm64-v8a android-armeabi-v7a android-x86_64 ios-arm64)
[ "${1:-}" != --full ] || targets+=(ios-simulator-arm64 ios-simulator-x64)
for target in "${targets[@]}"; do
  check "$target"
done
echo "compile-only: every source of the library was compiled for ${targets[*]}; nothing was linked to their systems or run"
exit $bad
