#!/usr/bin/env bash
# Builds the classes, and libmien_jni.so for this machine.
# usage: bindings/android/build.sh      the results are build/java/classes and build/java/libmien_jni.so
set -euo pipefail
cd "$(dirname "$0")/../.."
scripts/setup.sh build java
. scripts/ccache.sh
export JAVA_HOME=${JAVA_HOME:-$(dirname "$(dirname "$(readlink -f "$(command -v javac)")")")}
out=build/java
cmake -S bindings/android -B $out -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build $out --target mien_jni
javac --release 9 -Xlint:-options -d $out/classes bindings/android/java/org/mien/*.java
