#!/usr/bin/env bash
# Line and branch coverage of firmware/safety and firmware/protocol by their own unit tests. Fails
# where a line or a branch is missed. Built without exceptions, as the board's image is: otherwise
# every call would have a second way out that no test can take.
# Needs gcovr (Debian package) and GCC. Exit status: 0 all covered, 77 no gcovr, else not covered.
#
# usage: tests/firmware/coverage.sh [BUILD_FOLDER]
set -euo pipefail

root="$(cd "$(dirname "$0")/../.." && pwd)"
build="${1:-$root/build-coverage}"
command -v gcovr >/dev/null || { echo "coverage: needs gcovr (package gcovr)" >&2; exit 77; }
mkdir -p "$build"
log="$build/coverage.log"
trap 'status=$?; ((status == 0)) || { tail -n 40 "$log"; exit "$status"; }' EXIT

CXX=g++ cmake -S "$root" -B "$build" -G Ninja -DHOOF_BUILD_TESTS=ON -DHOOF_BUILD_FUZZERS=OFF \
  -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O0 -g --coverage -fno-exceptions" >"$log"
cmake --build "$build" --target hoof_test_safety hoof_test_protocol >>"$log"
find "$build" -name '*.gcda' -delete
"$build/tests/firmware/safety/hoof_test_safety" >>"$log"
"$build/tests/firmware/protocol/hoof_test_protocol" >>"$log"

report() {
  gcovr --root "$root" --filter "$root/firmware/(safety|protocol)/" "$@" "$build"
}
report
report --branches --fail-under-line 100 --fail-under-branch 100
