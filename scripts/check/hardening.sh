#!/usr/bin/env bash
# Programs and shared library are built as distributions build theirs (scripts/package/hardening.cmake): addresses that no program
# knows beforehand, nothing that is both written and executed, tables of pointers read-only once it runs, guarded stacks and
# copies, and on x86-64 landing pads for jumps. Read from the files themselves.
# usage: scripts/check/hardening.sh BUILD_DIR      a Release build
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:?build directory}

faults() {  # file: what is missing, a line each
  local headers dynamic symbols
  headers=$(readelf -lW "$1") dynamic=$(readelf -dW "$1") symbols=$(nm -D --undefined-only "$1")
  grep -q 'GNU_RELRO' <<<"$headers" || echo "no read-only relocations"
  grep -qE 'BIND_NOW|Flags:.*NOW' <<<"$dynamic" || echo "functions are looked up when they are called"
  grep -qE 'GNU_STACK .* RW +0x' <<<"$headers" || echo "its stack can be executed"
  ! grep -qE 'LOAD .* RWE ' <<<"$headers" || echo "some of it can be written and executed"
  ! grep -q 'TEXTREL' <<<"$dynamic" || echo "its code is written to when it is loaded"
  grep -q 'Type: *DYN' <<<"$(readelf -hW "$1")" || echo "it lies at a fixed address"
  grep -q '__stack_chk_fail' <<<"$symbols" || echo "its stacks are not guarded"
  # shellcheck disable=SC2016  # $ORIGIN is the loader's word
  grep -E 'R(UN)?PATH' <<<"$dynamic" | grep -vE '\[(\$ORIGIN|'"$PWD"')' | sed 's/^/it looks for libraries elsewhere: /' || true
}

# The checks have to notice a program that has none of it, before their silence counts.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo 'int main(void) { return 0; }' >"$work/soft.c"
cc -no-pie -fno-stack-protector -Wl,-z,norelro -Wl,-z,lazy -Wl,-z,execstack -o "$work/soft" "$work/soft.c" 2>/dev/null
[ "$(faults "$work/soft" | wc -l)" -eq 5 ] || { echo "check/hardening.sh: it does not notice a program without any of it" >&2; exit 1; }

bad=0
for file in apps/mien/mien apps/conformance/mien-conformance tracker/libmien.so; do
  while read -r fault; do
    echo "$build/$file: $fault" >&2
    bad=1
  done < <(faults "$build/$file")
done
grep -qE '__[a-z]+_chk@' <<<"$(nm -D --undefined-only "$build/apps/mien/mien")" || { echo "$build/apps/mien/mien: copies are not guarded" >&2; bad=1; }

# Landing pads serve where everything has them, the C library's first objects too, which is up to the distribution. Ours have.
if [ "$(uname -m)" = x86_64 ]; then
  while read -r object; do
    grep -q 'IBT, SHSTK' <<<"$(readelf -nW "$object" 2>/dev/null)" || { echo "$object: has no landing pads" >&2; bad=1; }
  done < <(ninja -C "$build" -t targets all | grep -oE '^(kernels|formats|engine|audio|tracker|apps/mien)/.*\.cpp\.o' | sed "s|^|$build/|")
fi
exit $bad
