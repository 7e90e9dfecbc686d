#!/usr/bin/env bash
# Trains the controls decoder of a network on an accelerator within ten minutes, from streamed features that travel in one file.
# usage: models/training/mien_training/phase2/on_gpu.sh pack  basenet|hifinet FOLDER      where stream_features.py ran: FOLDER/NETWORK.npz, 56 MB at most
#        models/training/mien_training/phase2/on_gpu.sh train basenet|hifinet FOLDER OUT  on the accelerator, which needs this checkout, FOLDER and PyTorch
# OUT gets NETWORK_decoders.pt, and the same after every sixth of the steps: seven files, together below 16 MB. Training begins with the
# decoder of models/ and stops after MINUTES. compare_decoders.py selects a checkpoint, export.py writes it.
# PYTHON (default python3), DEVICE (cuda), STEPS (12000), MINUTES (8), MEGABYTES (56); OPTIONS of train_decoders.py
set -euo pipefail
[ $# -ge 3 ] || { sed -n '2,7s/^# //p' "$0" >&2; exit 64; }
what=$1 network=$2 folder=$(realpath -m "$3")
root=$(realpath "$(dirname "$0")/../../../..")
export PYTHONPATH=$root/models/training:$root/apps/convert
python=${PYTHON:-python3} steps=${STEPS:-12000}

pack() {
  mkdir -p "$folder"
  "$python" -m mien_training.phase2.pack_features pack --network "$network" --megabytes "${MEGABYTES:-56}" "$folder/$network.npz"
}

train() {  # OUTPUT_FOLDER
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  "$python" -m mien_training.phase2.pack_features unpack --network "$network" "$folder/$network.npz" "$scratch"
  "$python" -m mien_training.networks.shipped_checkpoints "$scratch/shipped"
  # shellcheck disable=SC2086
  "$python" -m mien_training.phase2.train_decoders --network "$network" --stream "$scratch" --start-from "$scratch/shipped/${network}_decoders.pt" \
    --out "$1/${network}_decoders.pt" --device "${DEVICE:-cuda}" --steps "$steps" --keep-every $(((steps + 5) / 6)) \
    --minutes "${MINUTES:-8}" ${OPTIONS:-}
}

case $what in
  pack) pack ;;
  train)
    [ $# -ge 4 ] || { echo "on_gpu.sh: OUT: the folder for checkpoints is missing" >&2; exit 64; }
    train "$(realpath -m "$4")"
    ;;
  *) echo "on_gpu.sh: unknown command (got $what, expected pack or train)" >&2; exit 64 ;;
esac
