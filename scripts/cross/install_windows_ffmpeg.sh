#!/usr/bin/env bash
# Fetches ffmpeg.exe (7.1, from PyPI's imageio-ffmpeg) and ffprobe.exe (5.1, from npm), for scripts/cross/windows.sh, into
# ${MIEN_CACHE:-~/.cache/mien}/windows-ffmpeg-7.1, and prints this folder.
# usage: scripts/cross/install_windows_ffmpeg.sh        Needs pip, unzip and npm.
set -euo pipefail
work=${MIEN_CACHE:-$HOME/.cache/mien}/windows-ffmpeg-7.1
mkdir -p "$work"
cd "$work"

fetch_ffmpeg() {
  [ ! -f ffmpeg.exe ] || return 0
  echo "imageio-ffmpeg==0.6.0 --hash=sha256:02fa47c83703c37df6bfe4896aab339013f62bf02c5ebf2dce6da56af04ffc0a" >wanted.txt
  python3 -m pip download --quiet --no-deps --only-binary=:all: --platform win_amd64 --require-hashes -r wanted.txt
  unzip -q -p imageio_ffmpeg-*.whl 'imageio_ffmpeg/binaries/ffmpeg-win-x86_64-v7.1.exe' >ffmpeg.part
  mv ffmpeg.part ffmpeg.exe
  rm wanted.txt imageio_ffmpeg-*.whl
}

fetch_ffprobe() {
  [ ! -f ffprobe.exe ] || return 0
  command -v npm >/dev/null || { echo "install_windows_ffmpeg.sh: needs npm" >&2; return 1; }
  local archive
  archive=$(npm pack --silent @ffprobe-installer/win32-x64@5.1.0)  # npm would not install for a system that is not this one
  sha512sum --check --quiet <<<"8cc198780824add9f87b6bef62dfea6a4807444dc23e3bb86e7e5399d3dfa009b50655f5998f5cc8c77c81fe6f4b323c807f19ab959003202499e917ffc4d24e  $archive"
  tar xzf "$archive" package/ffprobe.exe
  mv package/ffprobe.exe .
  rm -r package "$archive"
}

fetch_ffmpeg >&2
fetch_ffprobe
pwd
