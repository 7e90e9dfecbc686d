#!/usr/bin/env bash
# Tests the Swift package in Debian 13, whose packages contain a Swift compiler: in a system of its own in build/debian13.
# usage: scripts/cross/swift.sh      (as root)
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh cross-swift
system=build/debian13
[ -e $system/etc/debian_version ] || debootstrap --variant=minbase trixie $system
rm -rf $system/mien
mkdir $system/mien
git ls-files -z --cached --others --exclude-standard | xargs -0 cp -p --parents -t $system/mien
git -C $system/mien init -q  # tests list the files of a repository
chroot $system /mien/scripts/setup.sh build swift
mount -t proc proc $system/proc  # the compiler finds its files by it
trap 'umount $system/proc' EXIT
chroot $system env LANG=C.UTF-8 /mien/bindings/swift/test.sh
