#!/bin/sh
# Installs the DBC parser (npm candied) into FOLDER where it is missing and runs dbc_oracle.mjs with
# what FRAMES_PROGRAM prints. HOOF_DBC_SEED chooses other random values.
#
# usage: dbc_oracle.sh FOLDER FRAMES_PROGRAM
set -eu
here=$(dirname "$0")
folder=$1
frames_program=$2
candied=candied@2.2.0

skip() {
  echo "SKIPPED: $1" >&2
  exit 77
}
command -v node >/dev/null || skip "no node: install it to check hoof.dbc with $candied"
command -v npm >/dev/null || skip "no npm: install it to check hoof.dbc with $candied"

mkdir -p "$folder"
if [ ! -d "$folder/node_modules/candied" ]; then
  npm install --prefix "$folder" --ignore-scripts --no-audit --no-fund --no-progress \
    --fetch-retries=1 --fetch-timeout=20000 "$candied" >"$folder/npm.log" 2>&1 ||
    skip "npm could not install $candied: $(tail -n 1 "$folder/npm.log")"
fi
"$frames_program" ${HOOF_DBC_SEED:+"$HOOF_DBC_SEED"} >"$folder/frames.json"
node "$here/dbc_oracle.mjs" "$folder" "$folder/frames.json"
