#!/bin/sh
# can_utils_test.sh HOOF: the tools people have, on the bus of a run. Runs where vcan0 is.
set -u
hoof=$1
folder=$(mktemp -d "$PWD/can_utils.XXXXXX")
trap 'rm -rf "$folder"' EXIT
. "$(dirname "$0")/check.sh"

# Until the candump started last listens: the kernel's list of those who want every frame names it.
await_listener() {
  tries=0
  until grep -q 'vcan0.* raw' /proc/net/can/rcvlist_all || [ "$tries" -ge 100 ]; do
    sleep 0.1
    tries=$((tries + 1))
  done
}

# candump hears the run, and its log is lines of our bus.log's format.
candump -L vcan0 >"$folder/heard.log" &
listener=$!
await_listener
"$hoof" sinkage --terrain rigid --bus vcan0 --quiet --out "$folder/run" >"$folder/run.txt" 2>&1
check "a run over vcan0 ends well" test $? -eq 0
sleep 0.5
kill "$listener"
heard=$(wc -l <"$folder/heard.log")
sent=$(wc -l <"$folder/run/bus.log")
echo "candump heard $heard frames of $sent"
check "candump heard frames" test "$heard" -gt 100
check "with SYNC among them" grep -q ' 010#' "$folder/heard.log"

# cansniffer shows the identifiers of a run.
"$hoof" sinkage --terrain rigid --bus vcan0 --quiet --out "$folder/sniffed" >"$folder/sniff.txt" 2>&1 &
run=$!
(sleep 3; printf 'q\n') | timeout 10 cansniffer vcan0 >"$folder/sniffer.out" 2>&1
wait "$run"
check "a run beside cansniffer ends well" test $? -eq 0
check "cansniffer shows SYNC" grep -aq '010' "$folder/sniffer.out"

# log2asc reads our log: a line for each frame, and its head.
log2asc -I "$folder/run/bus.log" -O "$folder/run.asc" can0 can1 vcan0
check "log2asc takes every frame" test "$(grep -c ' Rx ' "$folder/run.asc")" -eq "$sent"

# canplayer puts the log back on the wire; candump hears the same payloads in the same order.
head -n 500 "$folder/run/bus.log" | sed 's/) [a-z0-9]* /) can0 /' >"$folder/part.log"
candump -r 2000000 -L -n 500 -T 20000 vcan0 >"$folder/again.log" &
listener=$!
await_listener
canplayer -t -g 1 -I "$folder/part.log" vcan0=can0
wait "$listener"
cut -d' ' -f3 "$folder/part.log" >"$folder/a"
cut -d' ' -f3 "$folder/again.log" >"$folder/b"
echo "canplayer played $(wc -l <"$folder/a") frames, candump heard $(wc -l <"$folder/b")"
diff "$folder/a" "$folder/b" | head -n 4
check "canplayer and candump give the log again" cmp -s "$folder/a" "$folder/b"

# cansend presses the e-stop once the run goes, again and again until it is over: it ends, and says
# why.
(candump -n 1 vcan0,010:7FF >/dev/null; while sleep 0.02; do cansend vcan0 001#010000; done) &
presser=$!
"$hoof" sinkage --terrain rigid --bus vcan0 --quiet --out "$folder/stopped" >"$folder/stop.txt" 2>&1
status=$?
kill "$presser"
check "cansend's e-stop ends a run" test "$status" -eq 3
check "and the run says so" grep -q emergency_stop "$folder/stop.txt"

# cangen with frames that are nobody's: the run does not mind.
cangen vcan0 -g 1 -I 7FF -L 8 &
stranger=$!
"$hoof" sinkage --terrain rigid --bus vcan0 --quiet --out "$folder/flooded" >"$folder/flood.txt" 2>&1
status=$?
kill "$stranger"
check "a run beside cangen ends well" test "$status" -eq 0
check "cangen was heard" grep -q ' 7FF#' "$folder/flooded/bus.log"
[ "$failed" -eq 0 ] || cat "$folder"/*.txt
exit "$failed"
