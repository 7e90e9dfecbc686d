#!/usr/bin/env bash
# Fetches ffmpeg.exe (4.1) and ffprobe.exe (5.1) from npm, for scripts/cross/windows.sh, into ${MIEN_CACHE:-~/.cache/mien}/windows-ffmpeg,
# and says this folder.
# usage: scripts/cross/install_windows_ffmpeg.sh        Needs npm.
set -euo pipefail
work=${MIEN_CACHE:-$HOME/.cache/mien}/windows-ffmpeg
mkdir -p "$work"
cd "$work"

fetch() {  # program, package, its SHA-512, which is the integrity that npm has of it
  [ ! -f "$1.exe" ] || return 0
  command -v npm >/dev/null || { echo "install_windows_ffmpeg.sh: needs npm" >&2; return 1; }
  local archive
  archive=$(npm pack --silent "$2")  # npm would not install for a system that is not this one
  sha512sum --check --quiet <<<"$3  $archive"
  tar xzf "$archive" "package/$1.exe"
  mv "package/$1.exe" .
  rm -r package "$archive"
}

fetch ffmpeg @ffmpeg-installer/win32-x64@4.1.0 \
  0ebb79bb6bf30e720e35fe191242ad1656efc23eab237931c350a4f5fa6e766b606992070f8b9cb160769426415d1c4981747ed88312b62fb8aed3380b8ad782
fetch ffprobe @ffprobe-installer/win32-x64@5.1.0 \
  8cc198780824add9f87b6bef62dfea6a4807444dc23e3bb86e7e5399d3dfa009b50655f5998f5cc8c77c81fe6f4b323c807f19ab959003202499e917ffc4d24e
pwd
