# Sourced by the shell tests on a vcan0: what is held, a line each; `failed` is 1 once something is not so.
failed=0
check() { # WHAT CONDITION...
  what=$1
  shift
  if "$@"; then echo "ok: $what"; else echo "FAILED: $what"; failed=1; fi
}
