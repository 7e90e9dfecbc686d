#!/usr/bin/env bash
# Compiles the package with Debian's mono and runs its tests, including the README's example.
# usage: bindings/csharp/test.sh      (scripts/setup.sh build csharp)
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v mcs >/dev/null || ! command -v mono >/dev/null; then
  echo "NOT TESTED: bindings/csharp, for which there is no mono (scripts/setup.sh csharp)"
  exit 0
fi
. bindings/library.sh
out=build/bindings/csharp
mkdir -p "$out"
mcs -warnaserror -warn:4 -target:library -out:"$out/Mien.dll" bindings/csharp/Runtime/*.cs
mcs -warnaserror -warn:4 -r:"$out/Mien.dll" -out:"$out/tests.exe" bindings/csharp/Tests/*.cs
# Fields that Unity's editor sets are never assigned here.
mcs -warnaserror -warn:4 -nowarn:649 -target:library -r:"$out/Mien.dll" -out:"$out/Webcam.dll" bindings/csharp/Samples~/Webcam/*.cs bindings/csharp/Tests/Unity/*.cs
export LD_LIBRARY_PATH=$MIEN_LIBRARY_DIR
mono "$out/tests.exe"

# The assembly that Unity compiles for Android loads the library of the AAR.
mkdir -p "$out/android"
mcs -define:UNITY_ANDROID -target:library -out:"$out/android/Mien.dll" bindings/csharp/Runtime/*.cs
cp "$out/tests.exe" "$out/android/"
cp -L "$MIEN_LIBRARY_DIR/libmien.so" "$out/android/libmien_jni.so"
LD_LIBRARY_PATH=$out/android mono "$out/android/tests.exe"
tests/docs/paths_test.py csharp
