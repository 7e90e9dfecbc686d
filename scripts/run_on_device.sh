#!/usr/bin/env bash
# Runs mien-conformance on another machine: a phone over adb, a board over ssh, or an emulator here.
# usage: scripts/run_on_device.sh adb[:SERIAL] PROGRAM [OPTION...]
#        scripts/run_on_device.sh ssh:[USER@]HOST PROGRAM [OPTION...]
#        scripts/run_on_device.sh qemu[:CPU] PROGRAM [OPTION...]     CPU: as `qemu-aarch64 -cpu help` lists them
#        scripts/run_on_device.sh wine PROGRAM.exe [OPTION...]
#        scripts/run_on_device.sh node PROGRAM.js [OPTION...]
# PROGRAM is mien-conformance built for that machine. Also copies the weight files of models/, to check whole
# networks; MIEN_MODELS names another folder, MIEN_MODELS= disables that. OPTIONs are those of
# mien-conformance; the file of --json FILE is copied back.
# Exit codes are those of mien-conformance (docs/conformance.md), and 64: wrong usage, 65: the program is missing
# or for another machine, 66: the tool for this kind of device is missing, 67: the device cannot be reached,
# 68: the files cannot be copied.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)

fail() {  # exit code, message
  echo "run_on_device.sh: $2" >&2
  exit "$1"
}
need() {  # program, package
  command -v "$1" >/dev/null || fail 66 "$1 is missing; Debian: apt-get install $2"
}

[ $# -ge 2 ] || fail 64 "wrong usage; see the first lines of $0"
device=$1
program=$2
shift 2
[ -f "$program" ] || fail 65 "$program: no such file; build it for the device first (docs/conformance.md)"
models=${MIEN_MODELS-$here/models}
[ -z "$models" ] || [ -d "$models" ] || fail 65 "MIEN_MODELS: $models is not a folder"
weights=()
shopt -s nullglob
[ -z "$models" ] || weights=("$models"/*.mien)

# --json FILE is written on the device and fetched from there.
json=
options=()
while [ $# -gt 0 ]; do
  case $1 in
    --json)
      [ $# -ge 2 ] || fail 64 "--json needs a file"
      json=$2
      shift
      ;;
    --json=*) json=${1#--json=} ;;
    *) options+=("$1") ;;
  esac
  shift
done

quoted() {  # words for a remote shell
  [ $# -eq 0 ] || printf ' %q' "$@"
}

# The machine of an ELF file, by qemu's name.
machine_of() {
  local number
  number=$(od -An -tu1 -j18 -N1 "$1" | tr -d ' ')
  case $(head -c 4 "$1" | tail -c 3):$number in
    ELF:183) echo aarch64 ;;
    ELF:40) echo arm ;;
    ELF:62) echo x86_64 ;;
    ELF:3) echo i386 ;;
    ELF:243) echo riscv64 ;;
    ELF:*) fail 65 "$1 is for an unknown machine (ELF number $number)" ;;
    *) fail 65 "$1 is not an ELF program" ;;
  esac
}

run_here() {  # COMMAND...: runs an emulator, which shares this machine's files
  local more=()
  [ -z "$json" ] || more+=(--json "$json")
  [ ${#weights[@]} -eq 0 ] || more+=(--models "$models")
  exec "$@" "$program" "${options[@]}" "${more[@]}"
}

# Chooses a folder on the device for the program and the weights. Sets `run` to the command line to run there.
remote=
prepare_command() {  # folder
  remote=$1
  run="cd $remote && chmod +x mien-conformance && ./mien-conformance$(quoted "${options[@]}")"
  [ ${#weights[@]} -eq 0 ] || run+=" --models models"
  [ -z "$json" ] || run+=" --json result.json"
}

on_adb() {  # SERIAL or ""
  need adb adb
  local adb=(adb)
  [ -z "$1" ] || adb+=(-s "$1")
  "${adb[@]}" get-state >/dev/null 2>&1 ||
    fail 67 "no device responds to adb${1:+ -s $1}; is it plugged in, and USB debugging allowed? Known: $(adb devices | tail -n +2 | tr '\n' ' ')"
  prepare_command /data/local/tmp/mien-conformance.d
  "${adb[@]}" shell "rm -rf $remote && mkdir -p $remote/models" || fail 68 "$remote cannot be created on the device"
  "${adb[@]}" push "$program" "$remote/mien-conformance" >/dev/null || fail 68 "$program cannot be copied"
  if [ ${#weights[@]} -gt 0 ]; then
    "${adb[@]}" push "${weights[@]}" "$remote/models/" >/dev/null || fail 68 "$models cannot be copied"
  fi
  # Prints the exit code, because old devices do not return it.
  local code
  "${adb[@]}" shell "($run); echo exit code \$? >$remote/code" || true
  [ -z "$json" ] || "${adb[@]}" pull "$remote/result.json" "$json" >/dev/null || echo "run_on_device.sh: no results could be copied back" >&2
  code=$("${adb[@]}" shell "cat $remote/code; rm -rf $remote" | tr -d '\r' | sed -n 's/^exit code //p')
  [ -n "$code" ] || fail 67 "the connection to the device was lost"
  exit "$code"
}

on_ssh() {  # [user@]host
  need ssh openssh-client
  need tar tar
  ssh -o BatchMode=yes "$1" true || fail 67 "$1 cannot be reached by ssh without a password"
  prepare_command "$(ssh "$1" 'mktemp -d /tmp/mien-conformance.XXXXXX')" || fail 68 "no folder can be created on $1"
  # shellcheck disable=SC2029  # expanded here on purpose
  {
    tar -cf - -C "$(dirname "$program")" --transform 's|.*|mien-conformance|' "$(basename "$program")" |
      ssh "$1" "tar -xf - -C $remote"
    if [ ${#weights[@]} -gt 0 ]; then
      tar -cf - -C "$models" --transform 's|^|models/|' "${weights[@]##*/}" | ssh "$1" "tar -xf - -C $remote"
    fi
  } || fail 68 "the files cannot be copied to $1"
  local code=0
  # shellcheck disable=SC2029
  ssh "$1" "$run" || code=$?
  # shellcheck disable=SC2029
  [ -z "$json" ] || ssh "$1" "cat $remote/result.json" >"$json" || echo "run_on_device.sh: no results could be copied back" >&2
  # shellcheck disable=SC2029
  ssh "$1" "rm -rf $remote" || true
  [ $code -ne 255 ] || fail 67 "the connection to $1 was lost"
  exit $code
}

on_qemu() {  # CPU or ""
  local machine root
  machine=$(machine_of "$program")
  need "qemu-$machine" qemu-user
  local command=("qemu-$machine")
  [ -z "$1" ] || command+=(-cpu "$1")
  # Debian's folders for the libraries of the other machine.
  for root in /usr/"$machine"-linux-gnu /usr/"$machine"-linux-gnueabihf; do
    [ ! -d "$root/lib" ] || command+=(-L "$root")
  done
  run_here "${command[@]}"
}

case $device in
  adb) on_adb "" ;;
  adb:?*) on_adb "${device#adb:}" ;;
  ssh:?*) on_ssh "${device#ssh:}" ;;
  qemu) on_qemu "" ;;
  qemu:?*) on_qemu "${device#qemu:}" ;;
  wine)
    need wine wine
    run_here wine
    ;;
  node)
    need node nodejs
    run_here node
    ;;
  *) fail 64 "$device: neither adb, ssh:HOST, qemu, wine nor node" ;;
esac
