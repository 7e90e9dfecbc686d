# shellcheck shell=bash
# Sourced in the repository's root, as root: creates a system with Debian 13 in build/debian13, for programs that Debian 12 lacks.
# Sets SYSTEM, its folder; `in_debian13` runs commands there.
scripts/setup.sh cross-debian13
SYSTEM=$PWD/build/debian13
if [ ! -e "$SYSTEM" ]; then
  rm -rf "$SYSTEM.new"
  debootstrap --variant=minbase trixie "$SYSTEM.new"
  mv "$SYSTEM.new" "$SYSTEM"
fi
mount -t proc proc "$SYSTEM/proc"
trap 'umount "$SYSTEM/proc"' EXIT
in_debian13() { chroot "$SYSTEM" env LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
