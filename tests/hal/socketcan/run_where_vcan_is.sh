#!/bin/sh
# run_where_vcan_is.sh WITH_VCAN SECONDS [--virtual-time-if-slow] PROGRAM [ARGS...]
#
# Runs a test program where vcan0 is: on this machine, or in the guest that with-vcan starts. Exit
# status is the program's; 77 (CTest: skipped) with a loud reason when there is no such place.
set -u
with_vcan=$1 seconds=$2
shift 2
time=
case $1 in --virtual-time*) time=$1; shift;; esac
"$with_vcan" --timeout "$seconds" $time --dir "$(dirname "$1")" -- "$@"
status=$?
if [ "$status" -eq 125 ]; then
  echo "SKIPPED, NOT TESTED: $1: no CAN here. The kernel has no vcan and with-vcan could not" \
       "start a guest that has one (its reason is above)."
  exit 77
fi
exit "$status"
