#!/bin/bash
# update_on_vcan_test.sh RUN_WHERE_VCAN_IS WITH_VCAN HOOF EMULATE PACK BOARD_FOLDER CHECKS
#
# The tools as people call them and the board's image, two programs on a real vcan0: parameters,
# faults, a new image that the supply cuts off and one of a stranger's key. In the long form also the
# whole update, and an image that resets itself.
set -u

if [ "$1" != --there ]; then # makes the images, then goes where vcan0 is
  run=$1 with_vcan=$2 hoof=$3 emulate=$4 pack=$5 board=$6 checks=$7
  folder=$(mktemp -d "$PWD/update_on_vcan.XXXXXX")
  trap 'rm -rf "$folder"' EXIT
  python3 "$pack" sign --image "$board/hoof-stm32f405.update" --key "$board/development.key" \
    --version 2 --out "$folder/good.update" >"$folder/pack.txt" || exit 1
  python3 - "$(dirname "$pack")" "$board" "$folder" <<'P' || exit 1
import struct, sys
sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
import pack
from sodium import Key
board, folder = sys.argv[2:]
with open(board + "/hoof-stm32f405.update", "rb") as file:
    fields = pack.images_of(file.read(), "")[0][0]
# Wherever it is entered: AIRCR = 0x05FA0004, a reset by software. ldr, ldr, str, b to itself.
entry = pack.SLOT_B + pack.HEADER_BYTES + 0x190 | 1
code = struct.pack("<4H2I", 0x4801, 0x4902, 0x6001, 0xE7FE, 0xE000ED0C, 0x05FA0004)
body = struct.pack("<100I", 0x20001000, *[entry] * 99) + code
for name, key in (("resets", Key.read(board + "/development.key")),
                  ("strange", Key.generate(folder + "/strange.key"))):
    pack.write(f"{folder}/{name}.update", pack.signed(body, 1, 3, fields[7], key))
P
  limit=300
  [ -z "${HOOF_FULL_TESTS:-}" ] || limit=3600
  cp "$0" "$folder/test.sh"
  cp "$checks" "$folder/check.sh"
  "$run" "$with_vcan" "$limit" --virtual-time-if-slow "$folder/test.sh" --there "$hoof" "$emulate" \
    "$board" "$folder"
  exit $?
fi

hoof=$2 emulate=$3 board=$4 folder=$5
kept=/tmp
[ ! -w /dev/shm ] || kept=/dev/shm
flash=$(mktemp -u "$kept/update_on_vcan.XXXXXX")
trap 'rm -f "$flash"; [ -z "${foot:-}" ] || kill -KILL "$foot" 2>/dev/null' EXIT
. "$folder/check.sh"
ask() { # FILE COMMAND...: what hoof says
  said="$folder/$1"
  shift
  timeout 300 "$hoof" "$@" --bus vcan0 >"$said" 2>&1
}
says() { grep -q "$1" "$said"; }

switch_on() {
  "$emulate" --bus vcan0 --image "$board/hoof-stm32f405.elf" --flash "$flash" --set toe_kp_Nm_rad=240 \
    >>"$folder/board.txt" 2>&1 &
  foot=$!
  # Time that follows the work leaps while all wait for a file, here for the board's image: that a
  # time-out is over says nothing, so look again.
  for _ in $(seq 300); do
    candump -n 1 -T 1000 vcan0,050:7FF >"$folder/heartbeat.txt"
    [ ! -s "$folder/heartbeat.txt" ] && kill -0 "$foot" 2>/dev/null || break
  done
}
switch_off() {
  kill -KILL "$foot"
  wait "$foot" 2>/dev/null
}

switch_on
check "a board that is switched on tells it" grep -q 050 "$folder/heartbeat.txt"
ask parameters.txt param list
check "its parameters can be read" test $? -eq 0
check "and are those that it was given" grep -q '^toe_kp_Nm_rad *240 ' "$said"
ask faults.txt faults
check "its fault log can be read" test $? -eq 0
sleep 2.5 # 25 heartbeats: their counter has come round
ask status.txt firmware update --status
check "after a while it still answers: one image" says 'slot A runs: version 1'
check "and none in the other slot" says 'slot B: no image'

"$hoof" firmware update --bus vcan0 --image "$folder/good.update" >"$folder/cut.txt" 2>&1 &
client=$!
# Behind the erase, 200 words on the way.
candump -n 200 -T 60000 vcan0,043:7FF >"$folder/words.txt"
switch_off
wait "$client"
check "a tool whose foot lost its supply says so" test $? -eq 3
check "in the middle of the image" test "$(wc -l <"$folder/words.txt")" -eq 200
switch_on
ask after_cut.txt firmware update --status
check "the former image starts after a power cut" says 'slot A runs: version 1'
check "and what was brought is none" says 'slot B: no image'

if [ -n "${HOOF_FULL_TESTS:-}" ]; then
  ask update.txt firmware update --image "$folder/good.update"
  check "the whole update" test $? -eq 0
  cat "$said"
  ask after.txt firmware update --status
  check "runs, confirmed" grep -qx 'slot B runs: version 2' "$said"
  switch_off
  switch_on
  ask again.txt firmware update --status
  check "and after a power cut" says 'slot B runs: version 2'
  switch_off
  rm -f "$flash"
  switch_on
fi

# What the foot does with an image that is no good. Where an emulator is emulated its starts, with
# their signatures, take longer than the tool waits for one.
goes_back() { # NAME WHY
  ask "$1.txt" firmware update --image "$folder/$1.update"
  check "$1: that is no update" test $? -eq 3
  ask "$1_status.txt" firmware update --status --timeout 60
  check "$1: the former image runs" says 'slot A runs: version 1'
  check "$1: and tells why the new one does not" says "version 3, refused: .*$2"
}
goes_back strange signature
if [ -n "${HOOF_FULL_TESTS:-}" ]; then
  switch_off
  rm -f "$flash"
  switch_on
  goes_back resets confirmed
fi
kill -INT "$foot"
wait "$foot"
check "Ctrl-C ends the board well" test $? -eq 0
foot=
[ "$failed" -eq 0 ] || tail -n 20 "$folder"/*.txt
exit "$failed"
