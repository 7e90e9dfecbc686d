#!/usr/bin/env bash
# Zig's clang for libraries of iOS, macOS and Android that use the C++ library of their SDK, which Zig does not have: with its headers of macOS
# and of musl. It compiles but does not link programs.
# usage: MIEN_ZIG=PROGRAM scripts/cross/zig_library_cc.sh cc|c++ TRIPLE OPTION...
set -euo pipefail
language=$1 triple=$2
shift 2
lib=$(dirname "$MIEN_ZIG")/lib
musl=0
case $triple in
  *-apple-*) headers=(any-darwin-any) ;;
  aarch64-linux-android*) headers=(aarch64-linux-musl generic-musl) musl=1 ;;
  armv7a-linux-android*) headers=(arm-linux-musl generic-musl) musl=1 ;;
  x86_64-linux-android*) headers=(x86_64-linux-musl generic-musl) musl=1 ;;
  *) echo "zig_library_cc.sh: TRIPLE: unknown target (got $triple)" >&2; exit 2 ;;
esac
options=(--no-default-config -target "$triple" -nostdinc)
if [ "$language" = c++ ]; then
  options+=(--driver-mode=g++ -nostdinc++ -isystem "$lib/libcxx/include" -isystem "$lib/libcxxabi/include"
    -D_LIBCPP_ABI_VERSION=1 -D_LIBCPP_ABI_NAMESPACE=__1 -D_LIBCPP_HAS_THREADS=1 -D_LIBCPP_HAS_MONOTONIC_CLOCK -D_LIBCPP_HAS_TERMINAL
    "-D_LIBCPP_HAS_MUSL_LIBC=$musl" -D_LIBCPP_HAS_VENDOR_AVAILABILITY_ANNOTATIONS=0 -D_LIBCPP_HAS_FILESYSTEM=1 -D_LIBCPP_HAS_RANDOM_DEVICE
    -D_LIBCPP_HAS_LOCALIZATION -D_LIBCPP_HAS_UNICODE -D_LIBCPP_HAS_WIDE_CHARACTERS -D_LIBCPP_HAS_NO_STD_MODULES -D_LIBCPP_PSTL_BACKEND_SERIAL
    -D_LIBCPP_HARDENING_MODE=_LIBCPP_HARDENING_MODE_NONE -D_LIBCPP_ASSERTION_SEMANTIC_DEFAULT=_LIBCPP_ASSERTION_SEMANTIC_IGNORE
    "-D_LIBCPP_VERBOSE_ABORT(...)=__builtin_abort()")  # whose function old systems lack
fi
options+=(-isystem "$lib/include")
for folder in "${headers[@]}"; do
  options+=(-isystem "$lib/libc/include/$folder")
done
exec "$MIEN_ZIG" clang "${options[@]}" "$@"
