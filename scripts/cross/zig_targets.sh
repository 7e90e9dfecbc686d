# shellcheck shell=bash
# Sourced in the repository's root, also by functions: Zig's compiler from PyPI, and the targets that mien is built for with it (scripts/cross/zig.sh).

# shellcheck disable=SC2034  # used by the scripts that source this file
declare -gA ZIG_TARGETS=(
  [linux-x64]=x86_64-linux-musl
  [linux-arm64]=aarch64-linux-musl
  [linux-armv7]=arm-linux-musleabihf
  [macos-x64]=x86_64-macos.13.3
  [macos-arm64]=aarch64-macos.13.3
  [windows-x64]=x86_64-windows-gnu
  [windows-arm64]=aarch64-windows-gnu
)
# Libraries for SDKs that Zig does not have, to be linked with their own C++ library.
# shellcheck disable=SC2034
declare -gA LIBRARY_TARGETS=(
  [android-arm64-v8a]=aarch64-linux-android28
  [android-armeabi-v7a]=armv7a-linux-androideabi28
  [android-x86_64]=x86_64-linux-android28
  [macos-arm64]=arm64-apple-macos13.0
  [macos-x64]=x86_64-apple-macos13.0
  [ios-arm64]=arm64-apple-ios15.0
  [ios-simulator-arm64]=arm64-apple-ios15.0-simulator
  [ios-simulator-x64]=x86_64-apple-ios15.0-simulator
)

# Sets MIEN_ZIG, and folders for Zig's caches. Fails if PyPI cannot be reached.
install_zig() {
  local venv=$PWD/build/zig/python requirement
  requirement="ziglang==0.17.1 --hash=sha256:ea6cc5d87b033cf0aedfbc8f9549a908cae6c50ac31f1698188fa48a74524b54"
  if [ "$(cat "$venv/installed" 2>/dev/null)" != "$requirement" ]; then
    python3 -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check --only-binary=:all: --require-hashes --no-compile -r /dev/stdin <<<"$requirement" || return 1
    echo "$requirement" >"$venv/installed"
  fi
  MIEN_ZIG=$("$venv/bin/python" -c 'import os, ziglang; print(os.path.join(os.path.dirname(ziglang.__file__), "zig"))')
  export MIEN_ZIG ZIG_GLOBAL_CACHE_DIR=$PWD/build/zig/cache ZIG_LOCAL_CACHE_DIR=$PWD/build/zig/cache
  unset CMAKE_C_COMPILER_LAUNCHER CMAKE_CXX_COMPILER_LAUNCHER  # Zig caches objects itself
}

# The newest of Debian's LLVM tools with a name, which may not be on PATH.
llvm_tool() {  # name
  printf '%s\n' /usr/lib/llvm-*/bin/"$1" | sort -V | tail -1
}

# Prints the emulator, if needed, that runs programs of a target on this machine; fails if it is missing.
zig_emulator() {  # target
  case $1 in
    linux-x64) [ "$(uname -m)" = x86_64 ] ;;
    linux-arm64) echo qemu-aarch64 ;;
    linux-armv7) echo qemu-arm ;;
    windows-x64) echo wine ;;
    *) return 1 ;;
  esac
}

check_machine() {  # target, file: a program or library of that target's system and processor
  local -A formats=([linux-x64]="ELF 64-bit.*x86-64" [linux-arm64]="ELF 64-bit.*aarch64" [linux-armv7]="ELF 32-bit.*ARM, EABI5"
    [windows-x64]="PE32\+.*x86-64" [windows-arm64]="PE32\+.*Aarch64")
  case $1 in
    macos-arm64) tests/package/check_macho.py "$2" arm64 --signed "${@:3}" ;;
    macos-x64) tests/package/check_macho.py "$2" x86_64 "${@:3}" ;;
    *) file -bL "$2" | grep -E "${formats[$1]}" >/dev/null || { echo "zig_targets.sh: $2: wrong machine (got $(file -bL "$2"), expected $1)" >&2; return 1; } ;;
  esac
}

# The program that tests the amalgamation, stripped.
build_amalgamated() {  # target, folder of the amalgamation, program, options of the compiler
  local compiler=(scripts/cross/zig_cc.sh c++ -target "${ZIG_TARGETS[$1]}" -std=c++20 -O2 "${@:4}") sources=()
  [[ $1 != linux-* ]] || compiler+=(-fPIE -pie)
  [ "$1" != linux-armv7 ] || compiler+=(-march=armv7-a -mfpu=neon-vfpv4)
  mapfile -t sources < <(find "$2" -name 'mien*.cpp' | sort)
  case $1 in
    linux-arm64 | windows-arm64)  # Zig switches half precision off in a way that a pragma cannot undo
      "${compiler[@]}" -march=armv8.2-a+fp16 -c "$2/mien_neonfp16.cpp" -o "$3.neonfp16.o"
      "${compiler[@]}" -march=armv8.2-a+fp16+dotprod -c "$2/mien_neondot.cpp" -o "$3.neondot.o"
      "${compiler[@]}" -march=armv8.2-a+fp16+i8mm -c "$2/mien_neoni8mm.cpp" -o "$3.neoni8mm.o"
      mapfile -t sources < <(find "$2" -name 'mien*.cpp' ! -name mien_neonfp16.cpp ! -name mien_neondot.cpp ! -name mien_neoni8mm.cpp | sort)
      sources+=("$3.neonfp16.o" "$3.neondot.o" "$3.neoni8mm.o") ;;
  esac
  "${compiler[@]}" -s -I"$2" tests/package/amalgamated/main.cpp "${sources[@]}" -o "$3"
}

# zlib for a target, from Debian's source package: build/zig/zlib/TARGET/libz.a and headers in build/zig/zlib/source.
build_zlib() {  # target
  local folder=$PWD/build/zig/zlib
  local library=$folder/$1/libz.a
  [ ! -f "$library" ] || return 0
  [ -f "$folder/source/zlib.h" ] || fetch_zlib "$folder" || return 1
  mkdir -p "$folder/$1"
  local source
  # zlib before 1.3.1 defines fdopen to NULL on macOS unless it is a macro, which the system's header cannot be compiled with.
  for source in "$folder"/source/{adler32,crc32,deflate,inffast,inflate,inftrees,trees,zutil}.c; do
    "$MIEN_ZIG" cc -target "${ZIG_TARGETS[$1]}" -O2 -fPIC -w -Dfdopen=fdopen -c "$source" -o "$folder/$1/$(basename "$source" .c).o"
  done
  "$MIEN_ZIG" ar rcs "$library" "$folder/$1"/*.o
}

# apt-get with a copy of the machine's package sources, for other kinds of packages, with its own lists and caches.
separate_apt() {  # folder, deb or deb-src, architecture, arguments of apt-get
  mkdir -p "$1/lists/partial" "$1/sources.d"
  cp /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list /etc/apt/sources.list "$1/sources.d/" 2>/dev/null || true
  sed -i "s/^Types:.*/Types: $2/; s/^deb /$2 /" "$1"/sources.d/*
  apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$1/sources.d" -o "Dir::State::lists=$1/lists" -o "Dir::Cache=$1" \
    -o Dir::State::status=/dev/null -o "APT::Architecture=$3" -o "APT::Architectures=$3" -o APT::Sandbox::User=root "${@:4}"
}

fetch_zlib() {  # folder
  separate_apt "$1/apt" deb-src "$(dpkg --print-architecture)" update
  (cd "$1/apt" && separate_apt "$1/apt" deb-src "$(dpkg --print-architecture)" source --download-only zlib)
  mkdir -p "$1/source"
  tar -xf "$1"/apt/zlib_*.orig.tar.* -C "$1/source" --strip-components=1
}

# A short clip for programs of all targets: build/zig/clip.y4m.
make_clip() {
  ffmpeg -nostdin -v error -y -i tests/data/demo.mp4 -frames:v 10 -pix_fmt yuv420p build/zig/clip.y4m
}

# Its curves from the release build of this machine, for comparison: build/zig/clip.csv.
make_expected_curves() (  # a subshell, because Zig must not be started by ccache
  . scripts/ccache.sh
  cmake --preset release >/dev/null
  cmake --build --preset release --target mien_program -- --quiet
  build/release/apps/mien/mien track build/zig/clip.y4m --quiet -o build/zig/clip.csv
)

# Configures the library, mien-conformance and the program in build/zig/TARGET, or below ZIG_BUILD.
configure_zig() {  # target, options of CMake
  local packages=$PWD/scripts/cross/packages zlib=$PWD/build/zig/zlib
  build_zlib "$1"
  cmake -S . -B "${ZIG_BUILD:-build/zig}/$1" -G Ninja --toolchain "$PWD/scripts/cross/zig.cmake" -DMIEN_ZIG_TARGET="${ZIG_TARGETS[$1]}" \
    -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_TESTS=OFF -DMIEN_UNITY_BUILD=ON -DCLI11_DIR="$packages" -Dnlohmann_json_DIR="$packages" \
    -DZLIB_LIBRARY="$zlib/$1/libz.a" -DZLIB_INCLUDE_DIR="$zlib/source" "${@:2}" >/dev/null
}

# The static library for the system's own C++ library: build/zig/library-TARGET/tracker/libmien.a.
build_library() {  # target
  cmake -S . -B "build/zig/library-$1" -G Ninja --toolchain "$PWD/scripts/cross/zig_library.cmake" -DMIEN_TRIPLE="${LIBRARY_TARGETS[$1]}" \
    -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_APPS=OFF -DMIEN_INSTALL=OFF -DMIEN_BUILD_CONFORMANCE=OFF -DMIEN_BUILD_TESTS=OFF >/dev/null
  cmake --build "build/zig/library-$1" --target mien_static -- --quiet
}
