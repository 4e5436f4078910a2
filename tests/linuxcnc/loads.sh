#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# loads.sh INI OUT: starts LinuxCNC headless on INI and writes its pins and signals to OUT (`halcmd show`).
# DISPLAY becomes `hold`, and a HALFILE that needs a screen (axis_manualtoolchange.hal) is left out. Nothing in INI's folder changes.
# Exit status 0: LinuxCNC came up and went down again; 99: it did not (its log goes to stderr); 77: cannot run here.
set -u
here=$(cd "$(dirname "$0")" && pwd)
command -v linuxcnc >/dev/null && command -v halcmd >/dev/null || { echo "linuxcnc is not installed" >&2; exit 77; }
[ "$(id -u)" = 0 ] && unshare --ipc --pid --fork --mount true 2>/dev/null || {
  echo "namespaces are not permitted" >&2; exit 77; }
ini=$(readlink -f "$1"); name=$(basename "$ini")
D=$(mktemp -d /var/tmp/loads.XXXXXX); export D name
mkdir -p "$D/home" "$D/tmp"
cp -rL "$(dirname "$ini")" "$D/cfg"; mkdir -p "$D/cfg/bin"
cp "$here/../../scripts/linuxcnc/hold" "$D/cfg/bin/"; chmod 755 "$D/cfg/bin/hold"
sed -i 's/^\( *DISPLAY *=\).*/\1 hold/;/axis_manualtoolchange.hal/d;/^TOOL_TABLE/s/=.*/= loads.tbl/;/^PARAMETER_FILE/s/=.*/= loads.var/;/^DB_PROGRAM/d;/^INTRO_/d' "$D/cfg/$name"
echo "T1 P1 Z0 D0" >"$D/cfg/loads.tbl"
for p in 5161 5162 5163 5164 5165 5166 5167 5168 5169 5181 5182 5183 5184 5185 5186 5187 5188 5189 5210 \
  5211 5212 5213 5214 5215 5216 5217 5218 5219 5220 $(seq 5221 5230) $(seq 5241 5250) $(seq 5261 5270) $(seq 5281 5290) \
  $(seq 5301 5310) $(seq 5321 5330) $(seq 5341 5350) $(seq 5361 5370) $(seq 5381 5390); do
  v=0; [ $p = 5220 ] && v=1; printf '%s\t%s\n' $p $v; done >"$D/cfg/loads.var"
chown -R 65534:65534 "$D"; chmod 755 "$D"; chmod 1777 "$D/tmp"
unshare --ipc --pid --fork --kill-child --mount --mount-proc bash -c '
  mount --bind "$D/tmp" /tmp
  U="setpriv --reuid=65534 --regid=65534 --clear-groups env -i PATH=/usr/bin:/bin HOME=$D/home LANG=C"
  $U linuxcnc -r "$D/cfg/$name" </dev/null >"$D/linuxcnc.log" 2>&1 & L=$!
  ok=; for i in $(seq 500); do
    kill -0 $L 2>/dev/null || break
    [ "$($U halcmd getp joint.0.active 2>/dev/null)" = TRUE ] &&
      [ "$($U halcmd getp halui.mode.is-manual 2>/dev/null)" = TRUE ] && { ok=1; break; }
    sleep .02; done
  [ -n "$ok" ] || { echo "loads: LinuxCNC did not come up" >&2; cat "$D/linuxcnc.log" "$D"/home/linuxcnc_*.txt >&2; exit 99; }
  for what in pin sig funct thread; do $U halcmd show $what; done >"$D/out"
  kill -TERM $(pgrep -P $L -x hold); wait $L'
rc=$?
[ $rc = 0 ] && cp "$D/out" "$2"
rm -rf "$D"
exit $rc
