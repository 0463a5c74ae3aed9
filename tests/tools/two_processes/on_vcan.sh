#!/bin/sh
# on_vcan.sh TESTS SOAK: runs both where vcan0 is. The soak takes ten minutes in the long form.
set -u
failed=0
"$1" --durations yes || failed=1
seconds=8
[ -z "${HOOF_FULL_TESTS:-}" ] || seconds=600
"$2" --bus vcan0 --seconds "$seconds" || failed=1
exit "$failed"
