# hoof firmware: the image of the board. Read by tools/hoof, whose functions and variables it uses.

pack_flags=()  # of tools/firmware/pack.py build

firmware_help() {
  cat <<'HELP'
The image of the board (STM32F405): cross-compiled, measured, flashed.

  tools/hoof firmware build     compiles, signs and packs it; prints flash, RAM, worst-case stack and
                                what must not be in it; exit status 1 where a bound is missed
  tools/hoof firmware size      the same of what was compiled last
  tools/hoof firmware flash     builds, then writes it to a board; refused where a bound is missed
  tools/hoof firmware update    brings a new image to a foot over CAN; see update --help
  tools/hoof firmware keygen FILE           makes a key to sign with, FILE, and its public half, FILE.pub
  tools/hoof firmware sign --image FILE --key KEY [--version N] [--out FILE]
                                signs an update file (hoof-stm32f405.update) anew

  tools/hoof firmware emulate   runs it in an emulator on a CAN bus, as a flashed board would run there
  tools/hoof firmware run       the same firmware as a program of this machine

  --key FILE    build, flash: signs with it, and the boot loader takes nothing else; without it a
                development key, made once in the build folder
  --version N   build, flash: an update must have a higher one than what runs (default 1)
  --by TOOL     openocd (default), st-flash or dfu-util
  --dry-run     shows the commands and the wiring, writes nothing

Examples:
  tools/hoof firmware build
  tools/hoof firmware keygen ~/foot.key
  tools/hoof firmware build --key ~/foot.key --version 2
  tools/hoof firmware flash --dry-run
  tools/hoof firmware flash --by dfu-util

Bounds: 128 KB of flash for an image, 64 KB of RAM, 4 KB of stack; 16 KB for the boot loader.
Parameters and fault log on the board (flash sectors 1 to 3) are kept. Pins, wiring and memory: firmware/board/stm32f405/README.md.
HELP
}

firmware_usage() {
  say "$1; known are build, size, flash, update, keygen, sign, emulate and run, e.g. tools/hoof firmware build"
  exit 2
}

prepare_image() {
  install_packages "build firmware"  # cmake and ninja are of the first
  [[ -f "$build_dir/build.ninja" ]] || configure stm32f405
  build hoof-stm32f405
  python3 "$tools_dir/firmware/pack.py" build --dir "$build_dir" "${pack_flags[@]}" || exit $?
}

firmware_report() {
  local image="$build_dir/hoof-stm32f405"
  [[ -f "$image.elf" ]] || { say "nothing is built here; run tools/hoof firmware build"; exit 2; }
  python3 "$tools_dir/firmware/report.py" "$build_dir/hoof-slot-a.elf" --build "$build_dir" \
    --boot "$build_dir/hoof-boot.elf" \
    --bin "$image.elf" "$image-boot.bin" "$image-slot-a.bin" "$image-spare.bin" "$image.update"
}

firmware_wiring() {
  case "$1" in
    openocd | st-flash)
      say "wire an ST-Link: SWDIO to PA13, SWCLK to PA14, GND to GND, its VTref to 3.3 V" ;;
    dfu-util)
      say "hold BOOT0 at 3.3 V and reset; USB: D- to PA11, D+ to PA12, GND; then BOOT0 back to GND" ;;
  esac
}

# firmware_flash TOOL DRY_RUN. The boot loader goes last: where flashing was cut short before that, the
# former one looks at what is there and starts it, or nothing. -spare empties the other slot, whose
# image might else be the newer one.
firmware_flash() {
  local image a boot spare commands=() each
  image="$(printf '%q' "$build_dir/hoof-stm32f405")"
  a="$image-slot-a.bin" boot="$image-boot.bin" spare="$image-spare.bin"
  case "$1" in
    openocd)
      commands=("openocd -f interface/stlink.cfg -f target/stm32f4x.cfg -c program\\ {$image.elf}\\ verify\\ reset\\ exit") ;;
    st-flash)
      commands=("st-flash write $spare 0x08040000" "st-flash write $a 0x08020000"
        "st-flash --reset write $boot 0x08000000") ;;
    dfu-util)
      commands=("dfu-util -d 0483:df11 -a 0 -s 0x08040000 -D $spare"
        "dfu-util -d 0483:df11 -a 0 -s 0x08020000 -D $a"
        "dfu-util -d 0483:df11 -a 0 -s 0x08000000:leave -D $boot") ;;
  esac
  firmware_wiring "$1"
  if [[ -n "$2" ]]; then printf '%s\n' "${commands[@]}"; return; fi
  if ! command -v "$1" >/dev/null; then
    local package="$1"
    if [[ "$1" == st-flash ]]; then package=stlink-tools; fi
    apt_install "$package"
  fi
  for each in "${commands[@]}"; do
    say "$each"
    bash -c "$each" || fail "that failed; the board may hold a part of the image: flash it again"
  done
}

run_firmware() {
  local action="${1:-}" tool=openocd dry_run="" pack_flags=()
  case "$action" in
    -h | --help) firmware_help; exit 0 ;;
    build | size | flash) shift ;;
    keygen | sign)
      install_packages "build firmware"
      exec python3 "$tools_dir/firmware/pack.py" "$@" ;;
    "") firmware_usage "firmware what?" ;;
    *) firmware_usage "unknown word '$action' after firmware" ;;
  esac
  while (($# > 0)); do
    case "$action $1" in
      *" -h" | *" --help") firmware_help; exit 0 ;;
      "flash --dry-run") dry_run=yes; shift ;;
      "build --key" | "flash --key" | "build --version" | "flash --version")
        if [[ -z "${2:-}" ]]; then say "$1 needs a value"; exit 2; fi
        pack_flags+=("$1" "$2"); shift 2 ;;
      "flash --by")
        case "${2:-}" in
          openocd | st-flash | dfu-util) tool="$2"; shift 2 ;;
          *) say "--by takes openocd, st-flash or dfu-util, not '${2:-}'"; exit 2 ;;
        esac ;;
      *) say "firmware $action does not take '$1'"; exit 2 ;;
    esac
  done
  build_dir="$build_dir/stm32f405"
  log="$build_dir/hoof-build.log"
  mkdir -p "$build_dir"
  if [[ "$action" != size ]]; then locked prepare_image; fi
  if [[ "$action" != flash ]]; then
    firmware_report
    exit
  fi
  firmware_report >"$build_dir/report.txt" || fail "not flashed: see $build_dir/report.txt"
  firmware_flash "$tool" "$dry_run"
}
