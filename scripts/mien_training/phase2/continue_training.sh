#!/usr/bin/env bash
# Continues the training of a network of models/: data, encoder, features, decoders. It keeps files that exist, so the same command resumes,
# also in the middle of training, and continues with more HOURS. It does not change models/; mien_training.networks.export does.
# usage: scripts/mien_training/phase2/continue_training.sh basenet|hifinet HOURS [NAME]
#   HOURS   of training of the encoder, 0 for decoders only; data, features and decoders take an hour on two cores
#   NAME    of the run, default NETWORK_continued: checkpoints in $MIEN_CACHE/runs/NAME, features in $MIEN_CACHE/features/NAME
# MIEN_DATA, MIEN_CACHE, PYTHON (default python3, with PyTorch), PROCESSES (default: one per processor); renders: STILLS (24000), SEQUENCES
# (264), SEED (11); learning RATE (8e-4).
set -euo pipefail
cd "$(dirname "$0")/../../.."
export PYTHONPATH=$PWD/scripts
network=$1 hours=$2 name=${3:-$1_continued}
python=${PYTHON:-python3} processes=${PROCESSES:-$(nproc)} seed=${SEED:-11}
cache=${MIEN_CACHE:-$HOME/.cache/mien}
runs=$cache/runs suffix=
[ "$network" = basenet ] || suffix=_hifinet
scripts/setup.sh train
export OMP_NUM_THREADS=1
mkdir -p "$runs/$name"

render() {  # arguments of make_synthetic.py
  "$python" -m mien_training.data.make_synthetic --workers "$processes" "$@"
}
once() {  # file that comes of it, command
  [ -e "$1" ] || "${@:2}"
}
since_training() {  # the same, of the encoder's last checkpoint
  [ "$1" -nt "$encoder" ] || "${@:2}"
}

once "$cache/faces/misplaced.npy" "$python" -m mien_training.data.faces
once "$cache/portrait_skins/fits.npz" "$python" -m mien_training.renderer.portrait_fit
once "$cache/portrait_skins/whole" "$python" -m mien_training.renderer.portrait_skins --workers "$processes"
touch "$cache/portrait_skins/whole"
render --framing "$network" --split val --kind sequences --count 44
render --framing "$network" --split val --kind sequences --count 88 --seed 91 --out "$cache/val2"
render --framing "$network" --split val --kind sequences --count 132 --seed 92 --out "$cache/val3"
render --framing "$network" --split val --kind stills --count 2000
render --framing "$network" --split train --kind stills --count "${STILLS:-24000}" --leaning 0.6 --apart 0.4 --turned 0.25 --seed "$seed"
render --framing "$network" --split train --kind sequences --count "${SEQUENCES:-264}" --frames 60 --seed "$seed"
# BaseNet places HiFiNet's crops; a few images with its own framing warm it up.
render --framing basenet --split train --kind stills --count 2000 --leaning 0.6 --apart 0.4 --turned 0.25 --seed "$seed"

for each in $(printf '%s\n' basenet "$network" | sort -u); do
  once "$runs/${each}_start.pt" "$python" -m mien_training.networks.warm_start --network "$each" --out "$runs/${each}_start.pt" --decoders "$runs/${each}_start_decoders.pt"
done
start=$runs/${network}_start.pt start_features=$cache/features/${network}_start before=$runs/${network}_start_decoders.pt
last=$start decoders=$before
[ "$hours" != 0 ] || start_features=$cache/features/$name  # the same encoder's

if [ "$hours" != 0 ]; then
  last=$runs/$name/last.pt decoders=$runs/$name/decoders.pt
  # An end that was reached is reached at once when it is resumed.
  nice -n 15 "$python" -m torch.distributed.run --standalone --nproc_per_node "$processes" -m mien_training.phase1.train_encoder --network "$network" --name "$name" \
    --start-from "$start" --through "$before" --decoders-learn --real-share 0.4 --rate "${RATE:-8e-4}" --hours "$hours" \
    --samples 100000000 --report-every 150000 --resume
fi

of_encoder() {  # checkpoint, folder that its features go to from here on
  encoder=$1 features=$2 checkpoints=(--checkpoint "$1")
  [ "$network" = basenet ] || checkpoints=(--checkpoint "$runs/basenet_start.pt" --hifinet "$1")
  mkdir -p "$features"
}
sequences() {  # output, arguments of sequences.py
  since_training "$features/$1.pt" "$python" -m mien_training.data.sequences "${checkpoints[@]}" --passes 1 --out "$features/$1.pt" "${@:2}"
}
portraits() {  # output, arguments of portrait_features.py
  since_training "$features/$1.pt" "$python" -m mien_training.phase2.portrait_features "${checkpoints[@]}" --out "$features/$1.pt" "${@:2}"
}
validation_people() {
  sequences val --plain --shards "$cache/synthetic/val_sequences$suffix"/*
  sequences val2 --plain --shards "$cache/val2/val_sequences$suffix"/*
  sequences val3 --plain --shards "$cache/val3/val_sequences$suffix"/*
  portraits portraits_val --hold 3 --plain --passes 1 --split val
}
of_encoder "$last" "$cache/features/$name"
stills=("$cache/synthetic/train_stills$suffix"/shard_*)
stills=("${stills[@]:0:16}") half=$(((${#stills[@]} + 1) / 2))  # 32,000 for the decoders: features of more take longer than they are worth
moving=("$cache/synthetic/train_sequences$suffix"/*)
(
  sequences train --shards "${moving[@]}"
  sequences held --hold 3 --seed 5 --shards "${stills[@]:0:half}"
  validation_people
  of_encoder "$start" "$start_features"
  validation_people
) &
sequences train_plain --plain --mirrored --seed 3 --shards "${moving[@]}"
portraits portraits --hold 2
sequences held_plain --hold 3 --plain --mirrored --shards "${stills[@]:half}"
wait $!

f=$features
seen=(--network "$network" --train "$f/train.pt" "$f/train_plain.pt" --held "$f/held.pt" "$f/held_plain.pt" --portraits "$f/portraits.pt"
  --val "$f"/val{,2,3}.pt --portraits-val "$f/portraits_val.pt")
decoders() {  # output, arguments of train_decoders.py
  since_training "$runs/$name/$1.pt" "$python" -m mien_training.phase2.train_decoders "${seen[@]}" --noise 0.2 --rate 1.5e-3 --steps 1200 --sides 1.5 --teacher 2 --frowns 20 \
    --out "$runs/$name/$1.pt" "${@:2}" >"$f/$1.log"
}
decoders decoders_whole --start-from "$decoders" &
decoders decoders_half --start-from "$decoders" --average-with-start 0.5
wait $!
since_training "$runs/$name/decoders_before.pt" "$python" -m mien_training.phase2.blend_decoders "$runs/$name/decoders_half.pt" "$before" 0.15 "$runs/$name/decoders_before.pt"
reduce_delay() {  # decoders, output
  since_training "$2" "$python" -m mien_training.phase2.reduce_delay "${seen[@]}" --decoders "$1" --out "$2" >"${2%.pt}.log"
}
reduce_delay "$runs/$name/decoders_before.pt" "$runs/$name/decoders_before_prompt.pt" &
reduce_delay "$decoders" "$runs/$name/decoders_prompt.pt"
wait $!

candidates=("$runs/$name"/decoders_{whole,half,before,before_prompt,prompt}.pt)
[ "$decoders" = "$before" ] || candidates+=("$decoders")
"$python" -m mien_training.phase2.compare_runs "$start_features" "$before" "$f" "${candidates[@]}" | tee "$runs/$name/compared.txt"
