#!/usr/bin/env bash
# Makes the files of a release of HEAD, reproducibly: the same compilers give the same bytes.
# usage: scripts/package/release.sh [-o FOLDER] [-DCMAKE_OPTION]... [PART]...      default: build/release-files, all parts
#   source        mien-VERSION.tar.gz, the repository
#   amalgamation  mien-VERSION-amalgamation.tar.gz, headers and a source for each tier
#   binary        mien-VERSION-linux-MACHINE.tar.gz, the files of cmake --install
#   deb           mien_VERSION_MACHINE.deb
#   wheel         the Python wheel (build tools from PyPI, pinned by hash)
#   npm           the JavaScript package (needs Emscripten; scripts/setup.sh web)
#   conformance   mien-VERSION-conformance-SYSTEM.tar.gz for macOS, Windows and Android (built by Zig from PyPI)
#   static        mien-VERSION-linux-x64-static.tar.gz, the program in one file, with musl and the weights inside (Zig)
#   windows       mien-VERSION-windows-x64.zip, a folder that runs from anywhere (Zig)
#   wheels        Python wheels for other systems (Zig)
#   android       mien-VERSION.aar (Zig, Java)
#   apple         mien-VERSION.xcframework.zip (Zig)
# and an SBOM of these files, mien-VERSION.spdx.json, and SHA256SUMS.
set -euo pipefail
cd "$(dirname "$0")/../.."
out=build/release-files
if [ "${1:-}" = -o ]; then
  out=$2
  shift 2
fi
options=()
while [[ "${1:-}" == -D* ]]; do
  options+=("$1")
  shift
done
parts=("$@")
[ $# -gt 0 ] || parts=(source amalgamation binary deb wheel npm conformance static windows wheels android apple)

version=$(sed -n 's/^project(mien VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
[ -z "$(git status --porcelain)" ] || { echo "release.sh: there are changes that HEAD does not have" >&2; exit 1; }
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022
mkdir -p "$out"
out=$(cd "$out" && pwd)

# The compiled files contain neither the build folder nor the time.
export CFLAGS="-ffile-prefix-map=$PWD=." CXXFLAGS="-ffile-prefix-map=$PWD=."
build=$PWD/build/release-build

packed() {  # FOLDER NAME: NAME.tar.gz of the content of the folder, under NAME/
  tar --create --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --transform="s,^\.,$2," \
    -C "$1" . | gzip -n9 >"$out/$2.tar.gz"
}

zipped() {  # FOLDER FILE NAME...: a zip file of these names in the folder
  find "$1" -exec touch -d "@$SOURCE_DATE_EPOCH" {} +
  rm -f "$2"
  (cd "$1" && find "${@:3}" -type f | sed "s,^\./,," | sort | xargs cmake -E tar cf "$2" --format=zip --)
}

built() {
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DMIEN_BUILD_TESTS=OFF "${options[@]}" >/dev/null
  cmake --build "$build" -- --quiet
}

make_source() {
  git archive --format=tar --prefix="mien-$version/" HEAD | gzip -n9 >"$out/mien-$version.tar.gz"
}

make_amalgamation() {
  local folder=$build-amalgamation
  rm -rf "$folder"
  scripts/package/amalgamate.py -o "$folder" >/dev/null
  mkdir "$folder/models"
  cp LICENSE "$folder"
  cp models/*.* "$folder/models"
  packed "$folder" "mien-$version-amalgamation"
}

make_binary() {
  built
  rm -rf "$build-installed"
  DESTDIR=$build-installed cmake --install "$build" --strip >/dev/null
  packed "$build-installed/usr" "mien-$version-linux-$(uname -m)"
}

make_deb() {
  command -v dpkg-shlibdeps >/dev/null || { echo "SKIPPED: the .deb: dpkg-dev is not installed"; return 0; }
  built
  cpack -G DEB --config "$build/CPackConfig.cmake" -B "$build-deb" >/dev/null
  cp "$build-deb"/*.deb "$out"
}

make_wheel() {
  python3 -m venv "$build-python"
  "$build-python/bin/pip" install --quiet --quiet --disable-pip-version-check --require-hashes -r scripts/package/wheel_requirements.txt ||
    { echo "SKIPPED: the wheel: PyPI cannot be reached"; return 0; }
  "$build-python/bin/python" -m build --no-isolation --wheel --outdir "$out" bindings/python >"$build-python/log" 2>&1 || { cat "$build-python/log" >&2; return 1; }
  "$build-python/bin/python" scripts/package/shrink_wheel.py "$out/mien-$version"-py3-none-linux_*.whl
}

make_npm() {
  command -v emcc >/dev/null || { echo "SKIPPED: the npm package: Emscripten is not installed"; return 0; }
  scripts/package/npm.sh >/dev/null
  cp build/npm/mien-*.tgz "$out"
}

# Builds by Zig have their own folder, because of their compiler options.
export ZIG_BUILD=$build-zig
zig_build() {  # target, targets of CMake, options of CMake
  read -ra targets <<<"$2"
  (unset CFLAGS CXXFLAGS && configure_zig "$1" -DMIEN_INSTALL=OFF "${@:3}")  # scripts/cross/zig.cmake has these options
  cmake --build "$ZIG_BUILD/$1" --target "${targets[@]}" -- --quiet
}

with_zig() {
  scripts/setup.sh cross-zig
  . scripts/cross/zig_targets.sh
  install_zig || { echo "SKIPPED: $1: PyPI cannot be reached"; return 1; }
}

conformance_archive() {  # system, program
  local folder=$build-conformance/$1
  rm -rf "$folder"
  mkdir -p "$folder/models"
  cp "$2" LICENSE apps/third_party.txt "$folder"
  cp models/*.mien "$folder/models"
  cp "scripts/package/conformance/${1%%-*}.txt" "$folder/README.txt"
  if [[ $1 == android-* ]]; then
    install -D -m 755 scripts/run_on_device.sh "$folder/scripts/run_on_device.sh"
  fi
  packed "$folder" "mien-$version-conformance-$1"
}

make_conformance() {
  with_zig "mien-conformance" || return 0
  local target program=apps/conformance/mien-conformance
  for target in macos-arm64 macos-x64 windows-x64 windows-arm64 linux-arm64 linux-armv7; do
    zig_build $target mien_conformance_program
  done
  mkdir -p "$ZIG_BUILD/macos"
  "$(llvm_tool llvm-lipo)" -create "$ZIG_BUILD/macos-arm64/$program" "$ZIG_BUILD/macos-x64/$program" -output "$ZIG_BUILD/macos/mien-conformance"
  tests/package/check_macho.py "$ZIG_BUILD/macos/mien-conformance" arm64 x86_64 --signed >/dev/null
  conformance_archive macos "$ZIG_BUILD/macos/mien-conformance"
  conformance_archive windows-x64 "$ZIG_BUILD/windows-x64/$program.exe"
  conformance_archive windows-arm64 "$ZIG_BUILD/windows-arm64/$program.exe"
  # Android's kernel runs static programs of Linux.
  conformance_archive android-arm64 "$ZIG_BUILD/linux-arm64/$program"
  conformance_archive android-armv7 "$ZIG_BUILD/linux-armv7/$program"
}

make_static() {
  with_zig "the program in one file" || return 0
  zig_build linux-x64 mien_program -DMIEN_EMBED_MODELS=ON
  local folder=$build-static
  rm -rf "$folder"
  mkdir -p "$folder"
  cp "$ZIG_BUILD/linux-x64/apps/mien/mien" LICENSE apps/third_party.txt "$folder"
  packed "$folder" "mien-$version-linux-x64-static"
}

make_windows() {
  with_zig "the folder for Windows" || return 0
  zig_build windows-x64 mien_program
  local name=mien-$version-windows-x64
  local folder=$build-windows/$name
  rm -rf "$folder"
  mkdir -p "$folder/models"
  cp "$ZIG_BUILD/windows-x64/apps/mien/mien.exe" LICENSE apps/third_party.txt "$folder"
  cp models/*.mien "$folder/models"
  cp scripts/package/windows.txt "$folder/README.txt"
  zipped "$build-windows" "$out/$name.zip" "$name"
}

make_wheels() {
  with_zig "wheels for other systems" || return 0
  rm -rf "$build-wheels"
  (unset CFLAGS CXXFLAGS && scripts/package/wheels.sh -o "$build-wheels" >/dev/null)
  cp "$build-wheels"/*.whl "$out"
}

make_android() {
  with_zig "the AAR" || return 0
  (unset CFLAGS CXXFLAGS && scripts/package/android.sh >/dev/null)
  local folder=$build-android  # packed again without the times of jar
  rm -rf "$folder"
  mkdir -p "$folder/aar" "$folder/classes"
  (cd "$folder/aar" && cmake -E tar xf "$OLDPWD/build/android/mien.aar")
  (cd "$folder/classes" && cmake -E tar xf "$folder/aar/classes.jar")
  zipped "$folder/classes" "$folder/aar/classes.jar" .
  zipped "$folder/aar" "$out/mien-$version.aar" .
}

make_apple() {
  with_zig "the XCFramework" || return 0
  (unset CFLAGS CXXFLAGS && scripts/package/xcframework.sh >/dev/null)
  zipped "$PWD/build/apple" "$out/mien-$version.xcframework.zip" Mien.xcframework
}

for part in "${parts[@]}"; do
  "make_$part"
done
scripts/package/sbom.py "$version" "$out"
cd "$out"
rm -f SHA256SUMS
sums=$(sha256sum ./*)
tee SHA256SUMS <<<"${sums//  .\//  }"
