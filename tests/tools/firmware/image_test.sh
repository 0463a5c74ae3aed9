#!/usr/bin/env bash
# The board's image as a user makes it: within its bounds, the same bytes from another folder, and
# the commands that would flash it. Usage: image_test.sh ROOT BUILD_DIR
set -euo pipefail

root="$1"
export HOOF_BUILD_DIR="$2"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
hoof="$root/tools/hoof"
image="$HOOF_BUILD_DIR/stm32f405/hoof-stm32f405"

failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
expect() { # expect TEXT COMMAND...: the command succeeds and prints the text
  local text="$1"; shift
  "$@" >"$scratch/output" 2>&1 || fail "$*: exit status $?"
  grep -qF -- "$text" "$scratch/output" || { fail "$* does not print: $text"; cat "$scratch/output"; }
}
expect_exit() { # expect_exit STATUS TEXT COMMAND...
  local wanted="$1" text="$2" status=0; shift 2
  "$@" >"$scratch/output" 2>&1 || status=$?
  [[ $status -eq $wanted ]] || fail "$*: exit status $status instead of $wanted"
  grep -qF -- "$text" "$scratch/output" || { fail "$* does not print: $text"; cat "$scratch/output"; }
}

expect "software doubles  none" "$hoof" firmware build
cat "$scratch/output"
cp "$scratch/output" "$scratch/built"
expect "boot loader" "$hoof" firmware size
expect "$(sha256sum "$image.elf" | cut -d' ' -f1)" "$hoof" firmware size
cmp "$scratch/built" <(grep -v '^hoof: ' "$scratch/output") >/dev/null ||
  grep -v -e '^hoof: ' -e '^building ' "$scratch/built" | cmp - "$scratch/output" ||
  fail "size prints something else than build"

# What runs first stands where the core looks: stack pointer and reset vector.
vectors="$(od -An -tx4 -N8 "$image-boot.bin" | tr -s ' ')"
[[ "$vectors" =~ ^\ 20001000\ 0800[0-3][0-9a-f]{3}$ ]] || fail "vectors begin with$vectors"
# Behind each header of the update file those of that slot, and no word of a slot's header is left out.
second=$(($(stat -c %s "$image.update") / 2))
for at in 0 $second; do
  vectors="$(od -An -tx4 -j$((at + 512)) -N8 "$image.update" | tr -s ' ')"
  slot=$((at == 0 ? 2 : 4))
  [[ "$vectors" =~ ^\ 20001000\ 080[$slot$((slot + 1))][0-9a-f]{4}$ ]] || fail "slot's vectors begin with$vectors"
done
cmp -n "$second" "$image.update" "$image-slot-a.bin" || fail "the update file begins with another image than slot A has"

mkdir -p "$scratch/another folder"
cp -r "$root/CMakeLists.txt" "$root/CMakePresets.json" "$root/firmware" "$root/hal" "$scratch/another folder/"
(cd "$scratch/another folder" && cmake --preset stm32f405 && ninja -C build/stm32f405) >"$scratch/log" 2>&1 ||
  { fail "the build in another folder"; tail -n 20 "$scratch/log"; }
for file in hoof-slot-a.elf hoof-slot-b.elf hoof-boot.elf; do
  cmp "$HOOF_BUILD_DIR/stm32f405/$file" "$scratch/another folder/build/stm32f405/$file" ||
    fail "$file depends on where it is built"
done

expect "openocd -f interface/stlink.cfg -f target/stm32f4x.cfg -c program\\ {$image.elf}\\ verify\\ reset\\ exit" \
  "$hoof" firmware flash --dry-run
expect "st-flash --reset write $image-boot.bin 0x08000000" "$hoof" firmware flash --by st-flash --dry-run
grep -qF "st-flash write $image-slot-a.bin 0x08020000" "$scratch/output" || fail "st-flash writes no application"
grep -qF "st-flash write $image-spare.bin 0x08040000" "$scratch/output" || fail "st-flash leaves the other slot"
expect "dfu-util -d 0483:df11 -a 0 -s 0x08020000 -D $image-slot-a.bin" "$hoof" firmware flash --dry-run --by dfu-util

# Keys and versions, in a build folder of their own.
key="$scratch/foot.key" packed="$scratch/packed"
mkdir "$packed"
cp "$HOOF_BUILD_DIR"/stm32f405/hoof-{slot-a,slot-b,boot}.elf "$packed"
expect "public half $key.pub" "$hoof" firmware keygen "$key"
[[ "$(stat -c %a "$key")" == 600 ]] || fail "a key that others may read"
expect_exit 2 "a key is never written over" "$hoof" firmware keygen "$key"
pack=(python3 "$root/tools/firmware/pack.py" build --dir "$packed" --key "$key")
"${pack[@]}" --version 7 || fail "packing with a key"
cp "$packed/hoof-stm32f405.update" "$scratch/seven"
[[ "$(od -An -tx1 -v "$packed/hoof-stm32f405-boot.bin" | tr -d ' \n')" == *"$(cat "$key.pub")"* ]] ||
  fail "the boot loader has not the key's public half"
"${pack[@]}" --version 7 && cmp "$packed/hoof-stm32f405.update" "$scratch/seven" || fail "packed twice it differs"
expect "signed as version 8" "$hoof" firmware sign --image "$scratch/seven" --key "$key" --version 8 --out "$scratch/eight"
"${pack[@]}" --version 8 && cmp "$packed/hoof-stm32f405.update" "$scratch/eight" || fail "signed anew it differs from packed"
head -c 100000 "$scratch/seven" >"$scratch/cut"
expect_exit 2 "cut or damaged" "$hoof" firmware sign --image "$scratch/cut" --key "$key"
expect_exit 2 "not a key" "$hoof" firmware sign --image "$scratch/seven" --key "$scratch/seven"
expect "Examples:" "$hoof" firmware --help
expect "Examples:" "$hoof" firmware flash --help
expect "firmware build" "$hoof" --help
expect_exit 2 "known are build, size, flash" "$hoof" firmware
expect_exit 2 "unknown word 'burn'" "$hoof" firmware burn
expect_exit 2 "--by takes openocd, st-flash or dfu-util, not 'jlink'" "$hoof" firmware flash --by jlink
expect_exit 2 "firmware build does not take '--dry-run'" "$hoof" firmware build --dry-run

[[ $failures -eq 0 ]] || { echo "$failures failed"; exit 1; }
