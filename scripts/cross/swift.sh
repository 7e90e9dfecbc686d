#!/usr/bin/env bash
# Tests the Swift package in Debian 13, whose packages contain a Swift compiler.
# usage: scripts/cross/swift.sh      (as root)
set -euo pipefail
cd "$(dirname "$0")/../.."
. scripts/cross/debian13.sh
rm -rf "$SYSTEM/mien"
mkdir "$SYSTEM/mien"
git ls-files -z --cached --others --exclude-standard | xargs -0 cp -p --parents -t "$SYSTEM/mien"
git -C "$SYSTEM/mien" init -q  # tests list the files of a repository
in_debian13 /mien/scripts/setup.sh build swift
in_debian13 /mien/bindings/swift/test.sh
