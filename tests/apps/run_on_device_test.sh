#!/usr/bin/env bash
# Tests of scripts/run_on_device.sh with fake adb, ssh and qemu that use folders of this machine.
# usage: run_on_device_test.sh MIEN_CONFORMANCE
set -euo pipefail
source_dir=$(cd "$(dirname "$0")/../.." && pwd)
script=$source_dir/scripts/run_on_device.sh
program=$1

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/phone" "$work/models"
cp "$source_dir/models/proposal.mien" "$work/models/" 2>/dev/null || true
export PHONE=$work/phone MIEN_MODELS=$work/models
export PATH=$work/bin:$PATH

# adb: /data/local/tmp is a local folder. As on old devices, the exit code of a shell command is lost.
cat >"$work/bin/adb" <<'ADB'
#!/usr/bin/env bash
[ "$1" != -s ] || { [ "$2" = here ] || exit 1; shift 2; }
here() { sed "s|/data/local/tmp|$PHONE|g" <<<"$1"; }
case $1 in
  get-state) [ ! -e "$PHONE/unplugged" ] ;;
  devices) printf 'List of devices attached\nhere\tdevice\n' ;;
  shell) bash -c "$(here "$2")"; exit 0 ;;
  push) cp "${@:2:$#-2}" "$(here "${*: -1}")" ;;
  pull) cp "$(here "$2")" "$3" ;;
esac
ADB
cat >"$work/bin/ssh" <<'SSH'
#!/usr/bin/env bash
[ "$1" != -o ] || shift 2
[ "$1" = board ] || exit 255
shift
exec bash -c "$*"
SSH
cat >"$work/bin/qemu-x86_64" <<'QEMU'
#!/usr/bin/env bash
[ "$1" != -cpu ] || { echo "cpu $2"; shift 2; }
[ "$1" != -L ] || shift 2
exec "$@"
QEMU
chmod +x "$work"/bin/*

expect() {  # exit code, text in the output, command...
  local wanted=$1 text=$2 got=0
  shift 2
  "$@" >"$work/output" 2>&1 || got=$?
  if [ $got -ne "$wanted" ] || ! grep -qF -- "$text" "$work/output"; then
    echo "wanted exit code $wanted and '$text', got $got from: $*" >&2
    cat "$work/output" >&2
    exit 1
  fi
}

for device in adb adb:here ssh:board; do
  expect 0 "softmax" "$script" "$device" "$program" --filter 'softmax'
  if "$program" --list --filter softmax | grep -v ' ref$' >/dev/null; then  # the reference is not compared with itself
    expect 0 "network/proposal" "$script" "$device" "$program" --list --filter 'network/*'
  fi
  expect 3 "no match (got 'two words')" "$script" "$device" "$program" --filter 'two words'
  expect 0 "0 failed" "$script" "$device" "$program" --filter 'lstm' --json "$work/lstm.json"
  grep -q '"name": "lstm"' "$work/lstm.json"
  rm "$work/lstm.json"
done
[ -z "$(ls "$work/phone")" ] || { echo "files remain on the phone" >&2; exit 1; }

if [ "$(uname -m)" = x86_64 ]; then
  expect 0 "cpu Haswell" "$script" qemu:Haswell "$program" --filter 'softmax'
  expect 2 "unknown tier" "$script" qemu "$program" --tier mmx
fi

touch "$work/phone/unplugged"
expect 67 "no device responds to adb" "$script" adb "$program"
expect 67 "cannot be reached" "$script" ssh:elsewhere "$program"
expect 65 "no such file" "$script" adb "$work/missing"
expect 65 "is not an ELF program" "$script" qemu "$0"
expect 64 "neither adb" "$script" carrier-pigeon "$program"
expect 64 "wrong usage" "$script" adb
MIEN_MODELS=$work/nowhere expect 65 "is not a folder" "$script" adb "$program"
