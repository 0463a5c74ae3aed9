#!/usr/bin/env bash
# Tests tools/hoof with impostors of the programs it calls (dpkg-query, apt-get, cmake, ninja,
# ctest): each writes down how it was called. Usage: launcher_test.sh ROOT
set -euo pipefail

root="$1"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
export HOOF_BUILD_DIR="$scratch/build" CALLS="$scratch/calls" INSTALLED="$scratch/installed"
export PATH="$scratch/bin:$PATH"

impostor() { printf '#!/usr/bin/env bash\necho "%s $*" >>"$CALLS"\n%s\n' "$1" "$2" >"$scratch/bin/$1"; chmod +x "$scratch/bin/$1"; }
impostor dpkg-query 'sed "s/^/installed /" "$INSTALLED"; exit 1'
impostor sudo 'exec "$@"'
impostor apt-get '[[ ! -e $CALLS.apt-fails ]] || { echo "E: no such package"; exit 100; }'
impostor cmake '[[ ! -e $CALLS.cmake-fails ]] || { echo "CMake Error: spoilt"; exit 1; }
mkdir -p "$HOOF_BUILD_DIR"; touch "$HOOF_BUILD_DIR/build.ninja" "$HOOF_BUILD_DIR/CMakeCache.txt"'
impostor ninja '[[ ! -e $CALLS.ninja-fails ]] || { echo "[1/2] Building x.o"; echo "x.cpp: error"; exit 1; }
mkdir -p "$HOOF_BUILD_DIR/tools/cli"
printf "#!/usr/bin/env bash\necho program \"\$@\"; exit 42\n" >"$HOOF_BUILD_DIR/tools/cli/hoof"
chmod +x "$HOOF_BUILD_DIR/tools/cli/hoof"'
impostor ctest 'echo "full=${HOOF_FULL_TESTS:-}" >>"$CALLS"; exit 8'

failures=0
check() { # check WHAT CONDITION...
  local what="$1"; shift
  if "$@"; then return; fi
  echo "FAILED: $what"; failures=$((failures + 1))
  echo "--- calls"; cat "$CALLS"; echo "--- output ($status)"; cat "$scratch/output"
}
called() { grep -qE -- "$1" "$CALLS"; }
not_called() { ! called "$1"; }
printed() { grep -qF -- "$1" "$scratch/output"; }
exited() { [[ $status -eq $1 ]]; }
hoof() { : >"$CALLS"; status=0; "$launcher" "$@" >"$scratch/output" 2>&1 || status=$?; }
start_afresh() { rm -rf "$HOOF_BUILD_DIR" "$CALLS".*; awk '$1 ~ /^(build|test|firmware)$/ { print $2 }' "$root/tools/packages.txt" >"$INSTALLED"; }

# By a link and from another folder, as a user with ~/bin/hoof would.
cd "$scratch"
ln -s "$root/tools/hoof" "$scratch/link"
launcher="$scratch/link"

start_afresh
hoof --help
check "help before the first build builds nothing" not_called 'cmake|ninja|apt-get'
check "help before the first build names the commands" printed "  report"
check "help succeeds" exited 0

hoof version --flag "two words"
check "first call configures the release preset" called '^cmake --preset release'
check "only the program is built" called '^ninja .* hoof_cli$'
check "nothing is installed where all is there" not_called 'apt-get'
check "the program gets its arguments" printed "program version --flag two words"
check "the exit status is the program's" exited 42

hoof version
check "a later call does not configure" not_called '^cmake'
check "a later call does not ask for packages" not_called 'dpkg-query'

hoof test -R toe
check "tests are switched on in the same folder" called '^cmake --preset release .*HOOF_BUILD_TESTS=ON'
check "all is built for the tests" called '^ninja .* all$'
check "CTest gets the filter, shows failures, writes JUnit" \
  called '^ctest .*--output-on-failure .*--output-junit .*label-exclude .*-R toe$'
check "the exit status is CTest's" exited 8
check "long forms are off" called '^full=$'

hoof test --full
check "--full switches the long forms on" called '^full=1$'
check "--full excludes nothing" not_called 'label-exclude|ctest.*--full'

start_afresh
hoof test
check "tests on a clean checkout use the test preset" called '^cmake --preset test'

start_afresh
sed -i '/^libode-dev$/d; /^chromium$/d' "$INSTALLED"
hoof version
check "what is missing is installed" called 'apt-get .*install .*libode-dev'
check "packages of the tests are not" not_called 'chromium'
check "it says what and why" printed "libode-dev"
check "it says why" printed "rigid bodies"
if [[ $EUID -ne 0 ]]; then check "sudo is used where not root" called '^sudo env .*apt-get'; fi

start_afresh
sed -i '/^libode-dev$/d' "$INSTALLED"; touch "$CALLS.apt-fails"
hoof version
check "a failed installation fetches the lists and tries again" called 'apt-get .* update'
check "and then fails with what apt said" printed "E: no such package"
check "naming the log" printed "hoof-build.log"
check "with status 3" exited 3
rm "$CALLS.apt-fails"
hoof version
check "the next call tries again" called 'apt-get .*install .*libode-dev'

start_afresh
touch "$CALLS.cmake-fails"
hoof version
check "a failed configuration shows why" printed "CMake Error: spoilt"
check "and ends with status 3" exited 3

start_afresh
touch "$CALLS.ninja-fails"
hoof version
check "a failed build shows why" printed "x.cpp: error"
check "and ends with status 3" exited 3
check "and starts no program" not_called '^program'

((failures == 0)) || { echo "$failures checks failed"; exit 1; }
echo "all checks passed"
