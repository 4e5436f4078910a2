#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# demo.sh, inside the namespaces: LinuxCNC, then the layer and the program, until Ctrl-C. D: the demo's folder.
set -u
cut=
trap '[ -z "$cut" ] || kill -TERM "$cut" 2>/dev/null; asked=1' INT TERM
asked=
# Its own session: Ctrl-C must not end it before the layer has handed back.
setsid linuxcnc -r "$D/mill/mill.ini" </dev/null >"$D/linuxcnc.log" 2>&1 &
linuxcnc=$!
up() { [ "$(halcmd getp joint.2.active 2>/dev/null)" = TRUE ] && [ "$(halcmd getp halui.mode.is-manual 2>/dev/null)" = TRUE ]; }
left=500
until up; do
  left=$((left - 1))
  if [ -n "$asked" ] || [ $left = 0 ] || ! kill -0 $linuxcnc 2>/dev/null; then
    [ -n "$asked" ] && exit 0
    cat "$D/linuxcnc.log" >&2
    echo "LinuxCNC did not come up" >&2
    exit 1
  fi
  sleep 0.02
done
cd "$D/mill" || exit 1
# shellcheck disable=SC2086 # nothing where it is not given
setsid /usr/bin/python3 "$D/cut_again.py" "$D/mill/part.ngc" "$D/steadyrest" run --machine machine.toml --mode act --record "$D/kept" \
  --socket "$D/layer.sock" --listen "$LISTEN" ${FOR_S:+--for-s $FOR_S} --json >"$D/kept/run.json" &
cut=$!
[ -z "$asked" ] || kill -TERM $cut
code=0
while kill -0 $cut 2>/dev/null; do
  wait $cut
  code=$?
done
for display in $(pgrep -x hold); do kill -TERM "$display"; done
wait $linuxcnc
exit $code
