#!/usr/bin/env bash
# Compiles the classes, the JNI library and the Kotlin sample, passes the tests on a desktop, runs the README's example and packs an AAR.
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

# The sample, against declarations of Android and CameraX; its analyzer runs on the clip.
if command -v kotlinc >/dev/null; then
  find bindings/android/tests/declarations -name '*.java' -exec javac --release 9 -Xlint:all,-options -Werror -d "$out/declarations" {} +
  kotlinc -Werror -no-reflect -jvm-target 1.8 -cp "$classes:$out/declarations" -d "$out/sample" bindings/android/sample/src/main/kotlin
  sample=$classes:$out/declarations:$out/sample:/usr/share/java/kotlin-stdlib.jar
  javac --release 17 -Xlint:all -Werror -cp "$sample" -d "$out/tests" bindings/android/tests/SampleTest.java
  ffmpeg -nostdin -v error -y -i tests/data/demo.mp4 -frames:v 60 -s 640x480 -pix_fmt yuv420p -f rawvideo "$out/clip.yuv"
  "${run[@]}" -cp "$sample:$out/tests" SampleTest "$out/clip.yuv"
else
  echo "NOT TESTED: the Kotlin sample, for which there is no kotlinc (scripts/setup.sh java)"
fi

tests/docs/paths_test.py java

bindings/android/aar.sh "$out/mien.aar" "$classes" x86_64="$out/jni/libmien_jni.so"
unzip -l "$out/mien.aar" >"$out/aar.txt"
for file in classes.jar assets/mien/basenet.mien jni/x86_64/libmien_jni.so prefab/modules/mien/{include/mien/mien.h,libs/android.x86_64/abi.json}; do
  grep -q " $file$" "$out/aar.txt"
done
