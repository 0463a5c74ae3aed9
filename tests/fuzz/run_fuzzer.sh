#!/bin/sh
# Searches with one libFuzzer target, starting from its corpus. A minute; ten with
# HOOF_FULL_TESTS=1; HOOF_FUZZ_SECONDS says otherwise. The seed is fixed: HOOF_FUZZ_SEED.
# New inputs and findings go to the scratch folder, never to the corpus.
#
# usage: run_fuzzer.sh PROGRAM CORPUS_FOLDER SCRATCH_FOLDER
set -eu
program=$1
corpus=$2
scratch=$3

if [ ! -x "$program" ]; then
  echo "SKIPPED: $program is not built: needs clang++ (packages clang, libclang-rt-14-dev)" >&2
  exit 77
fi

seconds=60
[ "${HOOF_FULL_TESTS:-0}" = 1 ] && seconds=600
seconds=${HOOF_FUZZ_SECONDS:-$seconds}
seed=${HOOF_FUZZ_SEED:-1}

mkdir -p "$scratch"
echo "seed $seed, $seconds s"
exec "$program" -seed="$seed" -max_total_time="$seconds" -max_len=512 -timeout=10 \
  -print_final_stats=1 -artifact_prefix="$scratch/" "$scratch" "$corpus"
