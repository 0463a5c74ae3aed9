#!/usr/bin/env bash
# Records the runs of this folder anew. usage: record.sh [PROGRAM], by default tools/hoof
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
hoof="${1:-$here/../../../tools/hoof}"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

# record NAME LAST_TICK COMMAND [flags]
record() {
  local name="$1" last_tick="$2"
  shift 2
  "$hoof" "$@" --terrain rigid --quiet --out "$scratch/$name" >/dev/null
  mkdir -p "$here/$name"
  "$hoof" log cut "$scratch/$name" --to-tick "$last_tick" --out "$here/$name/bus.log" --force
  cp "$scratch/$name/recording.json" "$here/$name/"
  "$hoof" replay "$here/$name" | sed -n 's/^same as recorded; answers sha256 //p' \
    >"$here/$name/answers.sha256"
}

record sinkage-bionic 700 sinkage
record traction-bionic 699 traction
