#!/usr/bin/env bash
# Runs mien-conformance on emulated processors, whose instructions this one may lack. Bochs emulates a whole PC, so Linux starts in it.
# usage: scripts/cross/bochs.sh [MODEL...]      (as root; MODEL: of Bochs 3.0, default: one with each tier for x86-64)
set -euo pipefail
cd "$(dirname "$0")/../.."
models=("$@")
[ $# -gt 0 ] || models=(arrow_lake corei7_skylake_x tigerlake sapphire_rapids)  # avxvnni, avx512, avx512vnni, avx512fp16
scripts/setup.sh build
. scripts/ccache.sh
cmake --preset release >/dev/null
cmake --build --preset release --target mien_conformance_program
program=build/release/apps/conformance/mien-conformance
. scripts/cross/debian13.sh
in_debian13 apt-get install -y -qq --no-install-recommends bochs bochs-term bochsbios vgabios isolinux syslinux-common xorriso cpio busybox-static linux-image-amd64

work=$SYSTEM/bochs
rm -rf "$work"
mkdir -p "$work"/{disc,files/{proc,dev}}
cp scripts/cross/bochs/isolinux.cfg "$work/disc/"
cp "$SYSTEM"/boot/vmlinuz-* "$work/disc/vmlinuz"
cp "$SYSTEM"/usr/lib/{ISOLINUX/isolinux.bin,syslinux/modules/bios/ldlinux.c32} "$work/disc/"
cp scripts/cross/bochs/init "$SYSTEM/usr/bin/busybox" "$program" "$work/files/"
ldd $program | grep -o '/[^ ]*' | xargs cp -L --parents -t "$work/files"
cp -R models "$work/files/"
in_debian13 sh -c 'cd /bochs/files && find . | cpio -o -H newc --quiet | gzip -1 >../disc/initrd.gz'
in_debian13 xorriso -as mkisofs -quiet -o /bochs/disc.iso -b isolinux.bin -c boot.cat -no-emul-boot -boot-load-size 4 -boot-info-table /bochs/disc

for model in "${models[@]}"; do
  sed "s/MODEL/$model/" scripts/cross/bochs/bochsrc >"$work/bochsrc"
  rm -f "$work/output.txt"
  # Its display needs a terminal.
  TERM=xterm timeout 3600 script -qec "chroot $SYSTEM bochs -q -f /bochs/bochsrc -unlock" /dev/null >/dev/null || true
  grep -E 'supported|checks|failed|wrong' "$work/output.txt" || true
  grep -q '^status 0' "$work/output.txt" || { cat "$work/output.txt" && echo "bochs.sh: $model: mien-conformance failed" >&2 && exit 1; }
  echo "$model: mien-conformance passed"
done
