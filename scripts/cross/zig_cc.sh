#!/usr/bin/env bash
# Zig's C and C++ compiler with gcc's names of ARM instruction sets, which Zig does not know, and without -fPIE for shared libraries,
# which it refuses.
# usage: MIEN_ZIG=PROGRAM scripts/cross/zig_cc.sh cc|c++ -target TARGET OPTION...
set -euo pipefail
arguments=()
for argument; do
  case $argument in
    -march=armv8.2-a+fp16) arguments+=(-mcpu=generic+v8_2a+fullfp16) ;;
    -march=armv8.2-a+fp16+dotprod) arguments+=(-mcpu=generic+v8_2a+fullfp16+dotprod) ;;
    -march=armv8.2-a+fp16+i8mm) arguments+=(-mcpu=generic+v8_2a+fullfp16+i8mm) ;;
    -march=armv7-a) arguments+=(-mcpu=generic+v7a+neon+vfp4) ;;
    -mfpu=neon-vfpv4) ;;
    -fPIE) [[ " $* " == *" -shared "* ]] || arguments+=(-fPIE) ;;
    *) arguments+=("$argument") ;;
  esac
done
exec "$MIEN_ZIG" "${arguments[@]}"
