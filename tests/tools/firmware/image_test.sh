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
expect "$(sha256sum "$image.elf" | cut -d' ' -f1)" "$hoof" firmware size
cmp "$scratch/built" <(grep -v '^hoof: ' "$scratch/output") >/dev/null ||
  grep -v -e '^hoof: ' -e '^building ' "$scratch/built" | cmp - "$scratch/output" ||
  fail "size prints something else than build"

# What runs first stands where the core looks: stack pointer and reset vector.
vectors="$(od -An -tx4 -N8 "$image-start.bin" | tr -s ' ')"
[[ "$vectors" =~ ^\ 20001000\ 0800[0-3][0-9a-f]{3}$ ]] || fail "vectors begin with$vectors"

mkdir -p "$scratch/another folder"
cp -r "$root/CMakeLists.txt" "$root/CMakePresets.json" "$root/firmware" "$root/hal" "$scratch/another folder/"
(cd "$scratch/another folder" && cmake --preset stm32f405 && ninja -C build/stm32f405) >"$scratch/log" 2>&1 ||
  { fail "the build in another folder"; tail -n 20 "$scratch/log"; }
for file in hoof-stm32f405.elf hoof-stm32f405-start.bin hoof-stm32f405-app.bin; do
  cmp "$HOOF_BUILD_DIR/stm32f405/$file" "$scratch/another folder/build/stm32f405/$file" ||
    fail "$file depends on where it is built"
done

expect "openocd -f interface/stlink.cfg -f target/stm32f4x.cfg -c program\\ {$image.elf}\\ verify\\ reset\\ exit" \
  "$hoof" firmware flash --dry-run
expect "st-flash --reset write $image-start.bin 0x08000000" "$hoof" firmware flash --by st-flash --dry-run
grep -qF "st-flash write $image-app.bin 0x08010000" "$scratch/output" || fail "st-flash writes no application"
expect "dfu-util -d 0483:df11 -a 0 -s 0x08010000 -D $image-app.bin" "$hoof" firmware flash --dry-run --by dfu-util
expect "Examples:" "$hoof" firmware --help
expect "Examples:" "$hoof" firmware flash --help
expect "firmware build" "$hoof" --help
expect_exit 2 "known are build, size, flash" "$hoof" firmware
expect_exit 2 "unknown word 'burn'" "$hoof" firmware burn
expect_exit 2 "--by takes openocd, st-flash or dfu-util, not 'jlink'" "$hoof" firmware flash --by jlink
expect_exit 2 "firmware build does not take '--dry-run'" "$hoof" firmware build --dry-run

[[ $failures -eq 0 ]] || { echo "$failures failed"; exit 1; }
