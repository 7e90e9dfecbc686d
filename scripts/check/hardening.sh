#!/usr/bin/env bash
# Checks that programs and shared library have the hardening of distributions (scripts/package/hardening.cmake):
# position independent, no memory that is both writable and executable, read-only relocations, stack and buffer
# checks, and on x86-64 landing pads for jumps. Reads the files themselves.
# usage: scripts/check/hardening.sh BUILD_DIR      a Release build
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:?build directory}

faults() {  # FILE: prints each missing property on a line
  local headers dynamic symbols
  headers=$(readelf -lW "$1") dynamic=$(readelf -dW "$1") symbols=$(nm -D --undefined-only "$1")
  grep -q 'GNU_RELRO' <<<"$headers" || echo "no read-only relocations"
  grep -qE 'BIND_NOW|Flags:.*NOW' <<<"$dynamic" || echo "functions are bound lazily"
  grep -qE 'GNU_STACK .* RW +0x' <<<"$headers" || echo "the stack is executable"
  ! grep -qE 'LOAD .* RWE ' <<<"$headers" || echo "a segment is writable and executable"
  ! grep -q 'TEXTREL' <<<"$dynamic" || echo "the code has relocations"
  grep -q 'Type: *DYN' <<<"$(readelf -hW "$1")" || echo "the address is fixed"
  grep -q '__stack_chk_fail' <<<"$symbols" || echo "no stack protector"
  # shellcheck disable=SC2016  # the loader expands $ORIGIN
  grep -E 'R(UN)?PATH' <<<"$dynamic" | grep -vE '\[(\$ORIGIN|'"$PWD"')' | sed 's/^/run path outside the build folder: /' || true
}

# Checks that faults() detects a program without hardening.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo 'int main(void) { return 0; }' >"$work/soft.c"
cc -no-pie -fno-stack-protector -Wl,-z,norelro -Wl,-z,lazy -Wl,-z,execstack -o "$work/soft" "$work/soft.c" 2>/dev/null
[ "$(faults "$work/soft" | wc -l)" -eq 5 ] || { echo "check/hardening.sh: a program without hardening is not detected" >&2; exit 1; }

bad=0
for file in apps/mien/mien apps/conformance/mien-conformance tracker/libmien.so; do
  while read -r fault; do
    echo "$build/$file: $fault" >&2
    bad=1
  done < <(faults "$build/$file")
done
grep -qE '__[a-z]+_chk@' <<<"$(nm -D --undefined-only "$build/apps/mien/mien")" || { echo "$build/apps/mien/mien: no fortified functions" >&2; bad=1; }

# A program has landing pads only if all its objects have them, including those of the distribution, so this checks mien's objects.
if [ "$(uname -m)" = x86_64 ]; then
  while read -r object; do
    grep -q 'IBT, SHSTK' <<<"$(readelf -nW "$object" 2>/dev/null)" || { echo "$object: no landing pads" >&2; bad=1; }
  done < <(ninja -C "$build" -t targets all | grep -oE '^(kernels|formats|engine|audio|tracker|apps/mien)/.*\.cpp\.o' | sed "s|^|$build/|")
fi
exit $bad
