#!/usr/bin/env bash
# Continues the training of a network of models/: the encoder on stills that are rendered meanwhile, streamed features, decoders. It keeps
# what exists, so the same command resumes, and continues with more HOURS. It does not change models/; mien_training.networks.export does.
# usage: models/training/mien_training/phase2/continue_training.sh basenet|hifinet HOURS [NAME]
#   HOURS   of training of the encoder, 0 for decoders only
#   NAME    of the run, default NETWORK_continued: checkpoints in $MIEN_CACHE/runs/NAME, features in $MIEN_CACHE/stream/NAME
# MIEN_DATA, MIEN_CACHE, PYTHON (default python3, with PyTorch), PROCESSES (default: one per processor); learning RATE (8e-4) of the encoder;
# PEOPLE (800) and VALIDATION (192) people of the features; STEPS (150) of the controls decoder: more memorize these people
set -euo pipefail
cd "$(dirname "$0")/../../../.."
network=$1 hours=$2 name=${3:-$1_continued}
python=${PYTHON:-python3} processes=${PROCESSES:-$(nproc)} validation=${VALIDATION:-192} steps=${STEPS:-150}
export PYTHONPATH=$PWD/models/training:$PWD/apps/convert OMP_NUM_THREADS=1  # after nproc, which obeys it
cache=${MIEN_CACHE:-$HOME/.cache/mien}
run=$cache/runs/$name stream=$cache/stream/$name shipped=$cache/runs/shipped before=$cache/stream/shipped
scripts/setup.sh train
mkdir -p "$run/encoders" "$stream"

once() {  # file that a command creates, module, arguments
  [ -e "$1" ] || "$python" -m "mien_training.$2" "${@:3}"
}
# No function: in the background it would be a shell, and not the program, that ends when killed.
stills=("$python" -m mien_training.data.make_synthetic --framing "$network" --kind stills --leaning 0.6 --apart 0.4 --turned 0.25 --alike 4)

once "$cache/faces/misplaced.npy" data.faces
once "$cache/portrait_skins/fits.npz" renderer.portrait_fit
once "$cache/portrait_skins/whole" renderer.portrait_skins --workers "$processes"
touch "$cache/portrait_skins/whole"
once "$shipped/hifinet_decoders.pt" networks.shipped_checkpoints "$shipped"
cp "$shipped"/{basenet,hifinet}.pt "$run/encoders"
decoders=$shipped/${network}_decoders.pt

if [ "$hours" != 0 ]; then
  "${stills[@]}" --split val --count 2000 --workers "$processes"
  "${stills[@]}" --split train --count 4000 --workers "$processes"
  once "$run/start.pt" networks.warm_start --network "$network" --out "$run/start.pt"
  lessons=(--keep 12)  # what the losses on portraits do not teach
  if [ "$network" = basenet ]; then
    once "$shipped/distilled.npz" phase2.distil_controls
    lessons+=(--distil "$shipped/distilled.npz")
  fi
  "${stills[@]}" --split train --keep 20 >"$run/stills.log" 2>&1 &  # the encoder uses each a few times
  trap 'kill %1 2>/dev/null || true' EXIT
  # A run that is complete ends immediately when it is resumed.
  nice -n 15 "$python" -m torch.distributed.run --standalone --nproc_per_node "$processes" -m mien_training.phase1.train_encoder \
    --network "$network" --name "$name" --start-from "$run/start.pt" --through "$decoders" "${lessons[@]}" --real-share 0.4 \
    --rate "${RATE:-8e-4}" --hours "$hours" --samples 100000000 --report-every 150000 --resume
  kill %1
  cp "$run/last.pt" "$run/encoders/$network.pt"
  if [ "$run/last.pt" -nt "$stream/train" ]; then  # features and decoders of an earlier encoder
    rm -rf "$stream" "$run"/{pose,trained}.pt
  fi
fi

features() {  # stream, checkpoints of the encoders, parts of renders
  local part worker
  for part in "${@:3}"; do
    for ((worker = 0; worker < processes; ++worker)); do
      "$python" -m mien_training.phase2.stream_features --checkpoints "$2" --out "$1" --split "${part%:*}" --count "${part#*:}" --worker "$worker/$processes" &
      workers[worker]=$!
    done
    wait "${workers[@]}"
    "$python" -m mien_training.phase2.portrait_stream --checkpoints "$2" --out "$1" --split "${part%:*}"
  done
}
features "$stream" "$run/encoders" "train:${PEOPLE:-800}" "val:$validation"
if [ "$hours" = 0 ]; then
  before=$stream  # the same encoder's
else
  features "$before" "$shipped" "val:$validation"
fi

train() {  # decoder, checkpoint to start from, output, steps, learning rate
  "$python" -m mien_training.phase2.train_decoders --network "$network" --stream "$stream" --decoder "$1" --start-from "$2" --out "$3" --steps "$4" --rate "$5"
}
if [ "$network" = basenet ] && [ "$hours" != 0 ]; then  # HiFiNet has no head pose
  train pose "$decoders" "$run/pose.pt" 300 2e-4
  decoders=$run/pose.pt
fi
train controls "$decoders" "$run/trained.pt" "$steps" 2e-5
cp "$decoders" "$run/kept.pt"
for each in kept trained; do
  "$python" -m mien_training.phase2.refit_outputs --network "$network" --stream "$stream" --decoders "$run/$each.pt" --out "$run/${each}_refitted.pt"
done
"$python" -m mien_training.phase2.compare_decoders --network "$network" --stream "$stream" --before-stream "$before" "$shipped/${network}_decoders.pt" \
  "$run"/{kept,kept_refitted,trained,trained_refitted}.pt | tee "$run/compared.txt"
echo "$network: export the best: $python -m mien_training.networks.export $network $run/encoders/$network.pt DECODERS.pt"
echo "then compare it with models/: $python -m mien_training.phase2.check_encoder models EXPORTED"
