#!/usr/bin/env bash
# Builds the amalgamation with a single compiler command and tracks with it: the results equal those of the library, bit for bit.
# usage: amalgamated_test.sh BUILD_DIR      (CXX: that of the build)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mien=$(cd "$here/../.." && pwd)
build=$(cd "$1" && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$mien/scripts/package/amalgamate.py" -o "$work/mien"
ffmpeg -nostdin -v error -i "$mien/tests/data/demo.mp4" -frames:v 30 -s 640x480 -pix_fmt rgb24 -f rawvideo "$work/frames.rgb"

cd "$work/mien"
cp "$here/amalgamated/main.cpp" .
launcher=()
! ccache --show-stats >/dev/null 2>&1 || launcher=(ccache)
echo "== one command, without warnings"
"$CXX" -std=c++20 -O3 -Wall -Wextra -Werror main.cpp mien*.cpp -o "$work/amalgamated"
"$work/amalgamated" "$mien/models" "$work/frames.rgb" | tee "$work/amalgamated.txt"

if "$CXX" --version | grep "Free Software Foundation" >/dev/null && command -v clang++ >/dev/null; then
  echo "== one command of clang"
  clang++ -std=c++20 -O2 -Wall -Wextra -Werror main.cpp mien*.cpp -o "$work/by_clang"
  "$work/by_clang" "$mien/models" "$work/frames.rgb"
fi

echo "== the library"
"${launcher[@]}" "$CXX" -std=c++20 -O2 -I"$mien/include/mien" main.cpp "$build/tracker/libmien.a" -o "$work/library"
"$work/library" "$mien/models" "$work/frames.rgb" >"$work/library.txt"
diff "$work/library.txt" "$work/amalgamated.txt" && echo "bit-identical"
for program in library amalgamated; do
  strip "$work/$program"
  echo "$program: $(stat -c %s "$work/$program") bytes"
done
