#!/usr/bin/env bash
# Counts the instructions of other engines on ARM, from their wheels of PyPI under qemu, and writes docs/results/arm_peers.json.
# usage: scripts/cross/arm_peers.sh      after scripts/peers/bench.sh, which converts the networks
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$PWD/build/cross/peers
networks=${MIEN_CACHE:-$HOME/.cache/mien}/peers
scripts/setup.sh cross-arm cross-zig
. scripts/cross/zig_targets.sh
. scripts/package/wheel_pythons.sh
fetch_arm64_python
mkdir -p "$work/packages"
root=$PWD/build/zig/wheels/python-arm64
for package in numpy==2.4.6 onnxruntime==1.32.0 ncnn==1.0.20261020 ai-edge-litert==2.3.0; do
  python3 -m pip install --quiet --disable-pip-version-check --no-deps --only-binary=:all: --python-version 3.11 --platform manylinux2014_aarch64 \
    --platform manylinux_2_27_aarch64 --platform manylinux_2_28_aarch64 --target "$work/packages" --upgrade "$package" ||
    echo "NOT MEASURED: $package cannot be installed" >&2
done
# Engines read the processor's features there; qemu looks for files in the folder of -L first.
mkdir -p "$root/proc"
printf 'processor\t: 0\nFeatures\t: fp asimd atomics fphp asimdhp asimdrdm asimddp\nCPU implementer\t: 0x41\nCPU architecture: 8\nCPU variant\t: 0x3\nCPU part\t: 0xd0b\nCPU revision\t: 1\n\n' \
  >"$root/proc/cpuinfo"
gcc -O2 -Wall -Wextra -shared -fPIC scripts/cross/count_plugin.c -o "$work/libcount.so"
python3 scripts/cross/arm_peers.py "$work" "$root" "$networks" docs/results/arm_peers.json
