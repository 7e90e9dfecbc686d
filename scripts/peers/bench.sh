#!/usr/bin/env bash
# Times mien and its peers interleaved, one thread each: networks in other engines, whole frames beside MediaPipe, sound beside Silero VAD.
# Writes docs/results/peers.md, or performance.md, and their .json. Peers that cannot be installed are reported and skipped.
# usage: scripts/peers/bench.sh [ROUNDS] [peers|performance]...      default: 7, both documents
#        scripts/peers/bench.sh [ROUNDS] avx2|avx2+vnni|avx512...    encoders and frames as on CPUs of these classes, on x86-64 Linux:
#                                                                    CPUID hides newer instruction sets, where the CPU can trap it; writes docs/results/cpu_classes.md
# Makes a Release build unless MIEN_PROGRAM names a program to time. MIEN_DATA: folder of the data packs, for MediaPipe's model and for speech.
set -euo pipefail
cd "$(dirname "$0")/../.."

rounds=${1:-7}
documents=() classes=()
for word in "${@:2}"; do
  case $word in
    avx*) classes+=("$word") ;;
    *) documents+=("$word") ;;
  esac
done
[ ${#documents[@]} -gt 0 ] || [ ${#classes[@]} -gt 0 ] || documents=(peers performance)
export PYTHONPATH=$PWD/models/training:$PWD/apps/convert:$PWD/bindings/python/src:$PWD/scripts/peers
export MIEN_DATA=${MIEN_DATA:-$PWD/../shared/data}
work=${MIEN_CACHE:-$HOME/.cache/mien}/peers
python=$work/venv/bin/python
clip=tests/data/demo.mp4
mkdir -p "$work"

scripts/setup.sh build train
. scripts/ccache.sh
cmake --preset release -DMIEN_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target mien_shared mien_program
export MIEN_LIBRARY=$PWD/build/release/tracker/libmien.so
program=${MIEN_PROGRAM:-build/release/apps/mien/mien}

first=(taskset -c $(($(nproc) - 1)))  # one processor, and before others where that is allowed
[ "$(nice -n -10 nice 2>/dev/null)" != -10 ] || first=(nice -n -10 "${first[@]}")

run() {
  case $1 in
    mien) "${first[@]}" "$program" bench --json ;;
    unfused | sound) "${first[@]}" "$program" bench --"$1" --json ;;
    levels) "${first[@]}" "$program" bench --levels $clip --json ;;
    mediapipe) "${first[@]}" "$python" scripts/peers/mediapipe_frames.py $clip "$MIEN_DATA/teacher/face_landmarker.task" ;;
    voice_*) "${first[@]}" "$python" scripts/peers/voice_scores.py "${1#voice_}" "$work" ;;
    *) "${first[@]}" "$python" scripts/peers/engines.py "$1" "$work" ;;
  esac
}

convert() {
  rm -f "$work"/*_encoder.* "$work"/*_decoder.*
  /usr/bin/python3 -W ignore scripts/peers/export_onnx.py "$work" 2>"$work/export.log"
  local file engine pnnx  # the program itself, because its Python launcher needs PyTorch
  pnnx=$("$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/pnnx/pnnx
  for file in "$work"/*.onnx; do "$pnnx" "$file" fp16=0 >"$file.log" 2>&1 || echo "NOT MEASURED: $file in ncnn" >&2; done
  for file in basenet_encoder hifinet_encoder; do
    "$python" scripts/peers/onnx_to_tflite.py "$work/$file.onnx" "$work/$file.tflite" || echo "NOT MEASURED: $file in LiteRT" >&2
  done
  for engine in onnxruntime openvino litert; do
    "$python" scripts/peers/quantize.py $engine "$work" >"$work/quantize_$engine.log" 2>&1 || echo "NOT MEASURED: $engine in 8 bits" >&2
  done
}

scripts/peers/install_python.sh
convert
/usr/bin/python3 scripts/peers/voice_sets.py "$work" || echo "NOT MEASURED: how well speech is found" >&2

time_in_turns() {  # folder, names; sets timed
  local folder=$1 name round
  mkdir -p "$folder"
  timed=()
  for name in "${@:2}"; do
    if run "$name" >"$folder/${name}_0.json" 2>"$work/$name.log"; then
      [ "$name" = voice_mien ] || timed+=("$name")
    else
      echo "NOT MEASURED: $name: $(tail -n 1 "$work/$name.log")" >&2
    fi
  done
  for ((round = 0; round < rounds; ++round)); do
    for name in "${timed[@]}"; do run "$name" >"$folder/${name}_$round.json" 2>"$work/$name.log"; done
  done
  cp /proc/loadavg "$folder/load"
  "${first[@]}" "$python" scripts/peers/tier_errors.py "$program" "$work" "$folder/mien_0.json" >"$folder/errors_0.json" || rm "$folder/errors_0.json"
}

engines=(onnxruntime onnxruntime_int8 openvino openvino_bf16 openvino_int8 ncnn ncnn_16bit litert litert_int8)
cc -O1 -shared -fPIC -o "$work/mask_cpuid.so" tests/apps/mask_cpuid.c
for class in "${classes[@]}"; do
  echo "== $class"
  (
    first+=(env MIEN_CPU_CLASS="$class" LD_PRELOAD="$work/mask_cpuid.so")
    time_in_turns "$work/$class" mien levels mediapipe "${engines[@]}"
    printf '%s\n' "${timed[@]}" >"$work/$class/timed"
  )
  if grep -qx mien "$work/$class/timed"; then
    /usr/bin/python3 scripts/peers/cpu_classes.py "$work/$class" "$rounds" docs/results "$class"
  fi
done
[ ${#documents[@]} -gt 0 ] || exit 0
time_in_turns "$work" mien levels sound unfused "${engines[@]}" mediapipe voice_mien voice_silero
for document in "${documents[@]}"; do /usr/bin/python3 "scripts/peers/$document.py" "$work" "$rounds" docs/results "${timed[@]}"; done
