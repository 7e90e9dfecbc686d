#!/usr/bin/env bash
# Compiles the classes and the JNI library with Debian's OpenJDK, passes the tests on a desktop, runs the README's example and packs an AAR.
# usage: bindings/android/test.sh      (scripts/setup.sh build java)
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v javac >/dev/null; then
  echo "NOT TESTED: bindings/android, for which there is no javac (scripts/setup.sh java)"
  exit 0
fi
. bindings/library.sh
out=build/bindings/android
JAVA_HOME=${JAVA_HOME:-$(dirname "$(dirname "$(readlink -f "$(command -v javac)")")")}
export JAVA_HOME
classes=$out/classes
rm -rf "$classes"
javac --release 9 -Xlint:all,-options -Werror -d "$classes" bindings/android/java/org/mien/*.java
cmake -S bindings/android -B "$out/jni" -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$out/jni" --target mien_jni -- --quiet
javac --release 17 -Xlint:all -Werror -cp "$classes" -d "$out/tests" bindings/android/tests/ClipTest.java
run=(java -Xcheck:jni -Djava.library.path="$out/jni")
"${run[@]}" -cp "$classes:$out/tests" ClipTest

tests/docs/paths_test.py java

bindings/android/aar.sh "$out/mien.aar" "$classes" x86_64="$out/jni/libmien_jni.so"
unzip -l "$out/mien.aar" >"$out/aar.txt"
for file in classes.jar assets/mien/basenet.mien jni/x86_64/libmien_jni.so prefab/modules/mien/{include/mien/mien.h,libs/android.x86_64/abi.json}; do
  grep -q " $file$" "$out/aar.txt"
done
