#!/usr/bin/env bash
# Line and branch coverage of firmware/safety and firmware/protocol by their own unit tests. Fails
# where a line is missed, or more branches than the one that no test can reach.
# Needs gcovr (Debian package) and GCC.
#
# usage: tests/firmware/coverage.sh [BUILD_FOLDER]
set -euo pipefail

root="$(cd "$(dirname "$0")/../.." && pwd)"
build="${1:-$root/build-coverage}"
command -v gcovr >/dev/null || { echo "coverage: needs gcovr (package gcovr)" >&2; exit 2; }

# One branch remains, in codec.h: the exception edge of the call to crc8, which the compiler makes
# because tests are built with exceptions (the board is not).
readonly least_branch_percent=99

cmake -S "$root" -B "$build" -G Ninja -DHOOF_BUILD_TESTS=ON -DHOOF_BUILD_FUZZERS=OFF \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O0 -g --coverage" >"$build.log"
cmake --build "$build" --target hoof_test_safety hoof_test_protocol >>"$build.log"
find "$build" -name '*.gcda' -delete
"$build/tests/firmware/safety/hoof_test_safety" >>"$build.log"
"$build/tests/firmware/protocol/hoof_test_protocol" >>"$build.log"

report() {
  gcovr --root "$root" --filter "$root/firmware/(safety|protocol)/" --exclude-throw-branches \
    "$@" "$build"
}
report --branches
report --fail-under-line 100 --fail-under-branch "$least_branch_percent"
