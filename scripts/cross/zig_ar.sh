#!/usr/bin/env bash
# Zig's archiver, for CMake, which expects a program without a first argument.
exec "$MIEN_ZIG" ar "$@"
