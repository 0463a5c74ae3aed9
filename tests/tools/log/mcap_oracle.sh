#!/bin/sh
# Installs the MCAP reader (npm @mcap/core) into FOLDER where it is missing and runs
# mcap_oracle.mjs with a file that MCAP_PROGRAM writes of the recordings in RECORDINGS.
#
# usage: mcap_oracle.sh FOLDER MCAP_PROGRAM RECORDINGS
set -eu
here=$(dirname "$0")
folder=$1
mcap_program=$2
recordings=$3
reader=@mcap/core@2.2.2

skip() {
  echo "SKIPPED: $1" >&2
  exit 77
}
command -v node >/dev/null || skip "no node: install it to check MCAP files with $reader"
command -v npm >/dev/null || skip "no npm: install it to check MCAP files with $reader"

mkdir -p "$folder"
if [ ! -d "$folder/node_modules/@mcap/core" ]; then
  npm install --prefix "$folder" --ignore-scripts --no-audit --no-fund --no-progress \
    --fetch-retries=1 --fetch-timeout=20000 "$reader" >"$folder/npm.log" 2>&1 ||
    skip "npm could not install $reader: $(tail -n 1 "$folder/npm.log")"
fi
for recording in "$recordings"/*/; do
  "$mcap_program" "$recording" "$folder/file.mcap" "$folder/frames.jsonl"
  node "$here/mcap_oracle.mjs" "$folder" "$folder/file.mcap" "$folder/frames.jsonl"
done
