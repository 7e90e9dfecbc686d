# shellcheck shell=bash
# Sourced in the repository's root by the tests of bindings: builds both kinds of library, and writes the declarations of mien.h to a file.
# Sets MIEN_LIBRARY_DIR and MIEN_C_API, MIEN_MODELS and MIEN_CLIP (60 frames, 640x480, RGB).
. scripts/ccache.sh
cmake -S . -B build/bindings -G Ninja -DCMAKE_BUILD_TYPE=Release -DMIEN_BUILD_TESTS=OFF -DMIEN_BUILD_APPS=OFF -DMIEN_BUILD_CONFORMANCE=OFF >/dev/null
cmake --build build/bindings --target mien_static mien_shared -- --quiet
export MIEN_LIBRARY_DIR=$PWD/build/bindings/tracker MIEN_C_API=$PWD/build/bindings/c_api.txt
export MIEN_MODELS=$PWD/models MIEN_CLIP=$PWD/build/bindings/clip.rgb
bindings/c_api.py >"$MIEN_C_API"
ffmpeg -nostdin -v error -y -i tests/data/demo.mp4 -frames:v 60 -s 640x480 -pix_fmt rgb24 -f rawvideo "$MIEN_CLIP"
