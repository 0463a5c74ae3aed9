# hoof firmware: the image of the board. Read by tools/hoof, whose functions and variables it uses.

firmware_help() {
  cat <<'HELP'
The image of the board (STM32F405): cross-compiled, measured, flashed.

  tools/hoof firmware build     compiles it; prints flash, RAM, worst-case stack and what must not be
                                in it; exit status 1 where a bound is missed
  tools/hoof firmware size      the same of what was compiled last
  tools/hoof firmware flash     builds, then writes it to a board; refused where a bound is missed

  tools/hoof firmware emulate   runs it in an emulator on a CAN bus, as a flashed board would run there
  tools/hoof firmware run       the same firmware as a program of this machine

  --by TOOL     openocd (default), st-flash or dfu-util
  --dry-run     shows the commands and the wiring, writes nothing

Examples:
  tools/hoof firmware build
  tools/hoof firmware flash --dry-run
  tools/hoof firmware flash --by dfu-util

Bounds: 128 KB of flash, 64 KB of RAM, 4 KB of stack. Parameters and fault log on the board (flash
sectors 1 to 3) are kept. Pins, wiring and memory: firmware/board/stm32f405/README.md.
HELP
}

firmware_usage() {
  say "$1; known are build, size, flash, emulate and run, e.g. tools/hoof firmware build"
  exit 2
}

prepare_image() {
  install_packages "build firmware"  # cmake and ninja are of the first
  [[ -f "$build_dir/build.ninja" ]] || configure stm32f405
  build hoof-stm32f405
}

firmware_report() {
  local image="$build_dir/hoof-stm32f405"
  [[ -f "$image.elf" ]] || { say "nothing is built here; run tools/hoof firmware build"; exit 2; }
  python3 "$tools_dir/firmware/report.py" "$image.elf" --build "$build_dir" \
    --bin "$image-start.bin" "$image-app.bin"
}

firmware_wiring() {
  case "$1" in
    openocd | st-flash)
      say "wire an ST-Link: SWDIO to PA13, SWCLK to PA14, GND to GND, its VTref to 3.3 V" ;;
    dfu-util)
      say "hold BOOT0 at 3.3 V and reset; USB: D- to PA11, D+ to PA12, GND; then BOOT0 back to GND" ;;
  esac
}

# firmware_flash TOOL DRY_RUN. The part with the vectors goes last: a board whose flashing was cut
# short before that still starts its former vectors, and the drives stay off for want of commands.
firmware_flash() {
  local image app start commands=() each
  image="$(printf '%q' "$build_dir/hoof-stm32f405")"
  app="$image-app.bin" start="$image-start.bin"
  case "$1" in
    openocd)
      commands=("openocd -f interface/stlink.cfg -f target/stm32f4x.cfg -c program\\ {$image.elf}\\ verify\\ reset\\ exit") ;;
    st-flash)
      commands=("st-flash write $app 0x08010000" "st-flash --reset write $start 0x08000000") ;;
    dfu-util)
      commands=("dfu-util -d 0483:df11 -a 0 -s 0x08010000 -D $app"
        "dfu-util -d 0483:df11 -a 0 -s 0x08000000:leave -D $start") ;;
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
  local action="${1:-}" tool=openocd dry_run=""
  case "$action" in
    -h | --help) firmware_help; exit 0 ;;
    build | size | flash) shift ;;
    "") firmware_usage "firmware what?" ;;
    *) firmware_usage "unknown word '$action' after firmware" ;;
  esac
  while (($# > 0)); do
    case "$action $1" in
      *" -h" | *" --help") firmware_help; exit 0 ;;
      "flash --dry-run") dry_run=yes; shift ;;
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
