#!/usr/bin/env bash
# Packs an AAR with prefab: classes, weights as assets, and a library for each machine.
# usage: bindings/android/aar.sh OUTPUT.aar CLASSES_FOLDER ABI=libmien_jni.so...     ABI: arm64-v8a, armeabi-v7a, x86_64
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
output=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

module=$work/prefab/modules/mien
mkdir -p "$module/include" "$work/assets/mien"
cp "$here/prefab/AndroidManifest.xml" "$work/"
cp "$here/prefab/prefab.json" "$work/prefab/"
cp "$here/prefab/module.json" "$module/"
cp -R "$here/../../include/mien" "$module/include/"
cp "$here"/../../models/*.mien "$work/assets/mien/"
touch "$work/R.txt"
jar --create --file "$work/classes.jar" -C "$2" .
for library in "${@:3}"; do
  abi=${library%%=*}
  mkdir -p "$work/jni/$abi" "$module/libs/android.$abi"
  cp "${library#*=}" "$work/jni/$abi/libmien_jni.so"
  cp "${library#*=}" "$module/libs/android.$abi/libmien_jni.so"
  echo "{\"abi\": \"$abi\", \"api\": 28, \"ndk\": 26, \"stl\": \"none\", \"static\": false}" >"$module/libs/android.$abi/abi.json"
done
rm -f "$output"
jar --create --no-manifest --file "$output" -C "$work" .
echo "$output: $(stat -c %s "$output") bytes"
